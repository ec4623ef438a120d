"""Which rays true motions join: the identities of docs/matching.md.

That page has the arguments; here the machine checks their formulas. The test
tests/motion/loops/test_matching.py compares labels and loops of actual sheets, in floats.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy
from sympy import QQ
from sympy.polys.rings import ring

from exactfold import CreasePattern, random_square
from exactfold.exact.linalg import to_flint
from exactfold.pattern import families
from exactfold.rigidity import curvature_form, rigidity_matrix, wheel_stress
from exactfold.rigidity.timelike import round_cone
from proofs.framework import Proof, Script, run
from proofs.patterns import DART, SPIKY

NAME = "matching"
TITLE = "The matching of rays: fans, H1 sheets, the parity law"
HYPOTHESES = (
    "a sheet with four boundary vertices, all branches simple (docs/matching.md)",
    "w: an interior vertex, x: a boundary vertex joined to w and the boundary vertices q, r only",
)
Vector = tuple[Any, Any, Any]


def prove(change: str | None = None) -> Proof:
    """Prove the formulas of docs/matching.md."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _four_bar(script)
    _fans(script)
    _last_vertex(script)
    _orientation(script)
    _nodes(script)
    return script.proof()


def _cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def _dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    return sum(p * q for p, q in zip(a, b, strict=True))


def _bracket(a: Vector, b: Vector) -> Any:
    return a[0] * b[1] - a[1] * b[0]


def _turned(axis: Vector, tau: Any, v: Vector) -> Vector:
    """(1 + tau^2 |axis|^2) times v turned about the axis by the angle 2 arctan(tau |axis|)."""
    square, side, along = _dot(axis, axis), _cross(axis, v), _dot(axis, v)
    a, b, c = (
        (1 - tau * tau * square) * v[k] + 2 * tau * tau * along * axis[k] + 2 * tau * side[k]
        for k in range(3)
    )
    return a, b, c


def _four_bar(script: Script) -> None:
    """One vertex: its configurations are a curve of bidegree (2, 2); where the curve crosses."""
    _, *gens = ring("p1,q1,p2,q2,p3,q3,p4,q4,x,y", QQ)
    zero = gens[0] * 0
    d1, d2, d3, d4 = ((gens[2 * k], gens[2 * k + 1], zero) for k in range(4))
    x, y = gens[8:]
    c12, c23, c34, c41 = (_bracket(a, b) for a, b in ((d1, d2), (d2, d3), (d3, d4), (d4, d1)))
    b13, b24 = _bracket(d1, d3), _bracket(d2, d4)
    q = c12 * (c34 * _dot(d1, d2) + c12 * _dot(d3, d4))
    curve = c41 * b13 * x**2 + 2 * c23 * c41 * x * y - c23 * b24 * y**2 - q * x**2 * y**2
    side = script.alter("both folds turned in the same sense", -x, x)
    kept = _dot(d3, d4) * (1 + x**2 * _dot(d1, d1)) * (1 + y**2 * _dot(d2, d2))
    script.identity(
        "folds 1 and 2 turned, the sector between folds 3 and 4 keeps its angle iff "
        "c41 b13 x^2 + 2 c23 c41 x y - c23 b24 y^2 = Q x^2 y^2",
        _dot(_turned(d2, y, d3), _turned(d1, side, d4)) - kept - 2 * curve,
    )
    factor = script.alter("discriminant without the shared sector", c12, 1)
    script.identity(
        "the quadratic form of its lowest terms has a quarter discriminant c12 c23 c34 c41 > 0: "
        "two modes",
        (c23 * c41) ** 2 + c41 * b13 * c23 * b24 - factor * c23 * c34 * c41,
    )
    u, v, big_q, a, b, c = sympy.symbols("u v Q a b c")
    square = (a + 2 * b * v + c * v**2) / (big_q * v ** script.alter("v not squared", 2, 1))
    script.identity(
        "with y = v x and a + 2 b v + c v^2 = Q v^2 x^2 the curve is a double cover of the line "
        "of the v, branched where v belongs to a mode",
        (a * u**2 + 2 * b * u**2 * v + c * u**2 * v**2 - big_q * u**4 * v**2).subs(
            u, sympy.sqrt(square)
        ),
    )


def _fans(script: Script) -> None:
    """How far apart the poles of a tetrahedron are when its fold is closed."""
    length, a, b, c, e, s = sympy.symbols("L a b c e s")
    flat = (a - c) ** 2 + (b + e) ** 2
    cosine = script.alter("fold angle measured from closed", s, -s)
    poles = (a - c) ** 2 + b**2 + e**2 + 2 * b * e * cosine
    script.identity(
        "poles (a, b) and (c, -e), fold along the first axis: |pq|^2 falls from the flat sheet by "
        "2 b e (1 - cos phi), strictly in |phi|",
        flat - poles - 2 * b * e * (1 - s),
    )
    closed = poles.subs(s, -1)
    share = script.alter("factor four dropped", 4, 1)
    areas = (length * b) * (length * e) / length**2
    script.identity(
        "closed it has fallen by 4 A B / L^2 with twice the areas A = L b, B = L e of its faces",
        flat - closed - share * areas,
    )
    p, q, alpha, beta = sympy.symbols("p q alpha beta")
    pole_p = (p * sympy.cos(alpha), p * sympy.sin(alpha))
    turned = script.alter("the second pole not reflected", 1, -1)
    pole_q = (q * sympy.cos(beta), turned * q * sympy.sin(beta))
    difference = sum((m - n) ** 2 for m, n in zip(pole_p, pole_q, strict=True))
    expected = p**2 + q**2 - 2 * p * q * sympy.cos(alpha - beta)
    script.identity(
        "at a vertex with sectors alpha, beta beside the fold the closed angle between the poles "
        "is |alpha - beta|",
        sympy.expand(sympy.simplify(difference - sympy.expand_trig(expected))),
    )


def _last_vertex(script: Script) -> None:
    """The curvature of w as a polynomial in the height of x."""
    _, *gens = ring("p1,q1,p2,q2,p3,q3", QQ)
    zero = gens[0] * 0
    d1, d2, d3 = ((gens[2 * k], gens[2 * k + 1], zero) for k in range(3))
    c1, c2, whole = _bracket(d1, d2), _bracket(d2, d3), _bracket(d1, d3)
    s1 = script.alter("the first cotangent dropped", _dot(d1, d2), zero)
    script.identity(
        "K_w = -(h_x^2 / 2)(cot a + cot b) / |d_x|^2 = -(h_x^2 / 2) [d_q, d_r] / (c_1 c_2) where "
        "only h_x differs from the plane of w, q, r: positive iff a + b > pi",
        s1 * c2 + _dot(d2, d3) * c1 - whole * _dot(d2, d2),
    )
    outcomes, factors, lowered = [], [], []
    sense = script.alter("the sector of x taken from the wrong side", 1, -1)
    least = script.alter("popping up raises the rim", 0, 10**9)
    below = script.alter("the row of w differentiated by another height", 0, 1)
    for pattern in _h1_sheets():
        x, w, q, r = _removable(pattern)
        form = curvature_form(pattern, w)
        raised = dict.fromkeys(form.labels, Fraction(0)) | {x: Fraction(1)}
        outcomes.append((form(raised) > 0) == (sense * _wedge(pattern, q, w, r) < 0))
        lowered.append(form.functional(round_cone(pattern, w))[x] < -least)
        factors.append(_factorises(pattern, x, w, (x, w)[below]))
    script.cases("the same for w, x of six H1 sheets, with the forms of the package", outcomes)
    script.cases("raising x lowers the sign functional of w", lowered)
    script.cases(
        "det [K_v(h, .); l] of the sheet = const (d K_w / d h_x) det [K_v(h, .); l] of the sheet "
        "without x, for any h and any functional l of the heights other than h_x",
        factors,
    )


def _h1_sheets() -> Iterator[CreasePattern]:
    for n, seed in ((2, 0), (3, 1), (4, 2), (5, 3)):
        yield families.h1_sequence(n, seed)
    for n in (2, 3):
        yield random_square(n, 1)


def _removable(pattern: CreasePattern) -> tuple[int, int, int, int]:
    """A boundary vertex x of degree 3, its interior neighbour w, its boundary neighbours q, r."""
    for x in pattern.boundary:
        star = pattern.star(x)
        inside = [v for v in star if v in pattern.interior_set]
        if len(star) == 3 and len(inside) == 1:
            q, r = (v for v in star if v != inside[0])
            ring_of_w = pattern.star(inside[0])
            at = ring_of_w.index(x)
            if ring_of_w[at - 1] != q:
                q, r = r, q
            return x, inside[0], q, r
    raise ValueError("no boundary vertex of degree 3")


def _wedge(pattern: CreasePattern, q: int, w: int, r: int) -> Fraction:
    """[d_q, d_r] at w, which is negative if and only if the angle from q over x to r exceeds pi."""
    (wx, wy), (qx, qy), (rx, ry) = (pattern.vertices[v] for v in (w, q, r))
    return Fraction((qx - wx) * (ry - wy) - (qy - wy) * (rx - wx))


def _heights(pattern: CreasePattern, seed: int) -> dict[int, Fraction]:
    source = random.Random(seed)
    return {v: Fraction(source.randint(-50, 50), 7) for v in range(len(pattern.vertices))}


def _rows(
    pattern: CreasePattern, vertices: Sequence[int], free: Sequence[int], h: dict[int, Fraction]
) -> list[list[Fraction]]:
    """The rows K_v(h, .) of some vertices v, in the coordinates `free`."""
    rows = []
    for v in vertices:
        row = curvature_form(pattern, v).functional(h)
        rows.append([row.get(u, Fraction(0)) for u in free])
    return rows


def _determinant(rows: list[list[Fraction]]) -> Fraction:
    value = to_flint(rows).det()
    return Fraction(int(value.p), int(value.q))


def _factorises(pattern: CreasePattern, x: int, w: int, by: int) -> bool:
    """Whether both determinants agree up to one sign, for three height vectors h.

    The three boundary vertices other than x have height 0. `by` is x; another vertex is wrong.
    """
    pinned = [v for v in pattern.boundary if v != x]
    others = [v for v in pattern.interior if v != w]
    free = list(pattern.interior)
    weights = [Fraction(3 * k * k + 1, k + 2) for k in range(len(free))]
    found = set()
    for seed in range(3):
        h = _heights(pattern, seed) | dict.fromkeys(pinned, Fraction(0))
        whole = [*_rows(pattern, [*others, w], [*free, x], h), [*weights, Fraction(0)]]
        small = [*_rows(pattern, others, free, h), weights]
        slope = curvature_form(pattern, w).functional(h)[by]
        found.add(_determinant(whole) / (slope * _determinant(small)))
    return found in ({Fraction(1)}, {Fraction(-1)})


def _orientation(script: Script) -> None:
    """The determinant of [J; X'] near the flat state, and that of the curvature forms."""
    t, h = sympy.symbols("t h")
    flat, u, du = (sympy.Matrix(sympy.symbols(f"{n}_x {n}_y")) for n in ("U", "u", "du"))
    dh = sympy.symbols("dh")
    order = script.alter("in-plane velocities of first order", 2, 1)
    velocity = t**order * du
    moved = flat + t**2 * u
    script.identity(
        "the row of an edge at X = U + t^2 u + t h z, applied to (t^2 du, t dh), is t^2 times "
        "that of the blown-up equations, (U + t^2 u).du + h dh",
        moved.dot(velocity) + t * h * t * dh - t**2 * (moved.dot(du) + h * dh),
    )
    columns = script.alter("2V - 3 in-plane unknowns", 6, 3)
    for_v, n = sympy.symbols("V n")
    script.identity(
        "with one triangle held there are 2V - 6 and V - 3 unknowns and 3V - 10 equations: n + 1 "
        "heights, and n more equations than in-plane unknowns",
        (3 * for_v - 10 - (2 * for_v - columns) - n).subs(for_v, n + 4),
    )
    half = script.alter("rows of another height", 0, 1)
    outcomes = [
        _same_ratio(pattern, half)
        for pattern in (
            families.single_vertex(4),
            families.two_vertex(),
            random_square(3, 0),
            random_square(5, 0),
            families.h1_sequence(4, 1),
            DART,
            SPIKY,
        )
    ]
    script.cases(
        "det [R, B(h); 0, h] = const det [K_v(h, .); h] for any heights h, the constant not 0: "
        "seven sheets, two with a reflex corner, three heights each",
        outcomes,
    )


def _same_ratio(pattern: CreasePattern, wrong: int) -> bool:
    held = set(pattern.triangles[0])
    free = [v for v in range(len(pattern.vertices)) if v not in held]
    edges = [k for k, e in enumerate(pattern.edges) if not held.issuperset(e)]
    plane = rigidity_matrix(pattern)
    ratios = set()
    for seed in range(3):
        h = _heights(pattern, seed) | dict.fromkeys(held, Fraction(0))
        other = _heights(pattern, seed + 10) if wrong else h
        rows = []
        for k in edges:
            i, j = pattern.edges[k]
            row = [plane[k][2 * v + axis] for v in free for axis in (0, 1)]
            bend = {i: h[i] - h[j], j: h[j] - h[i]}
            rows.append([*row, *(bend.get(v, Fraction(0)) for v in free)])
        rows.append([Fraction(0)] * (2 * len(free)) + [h[v] for v in free])
        forms = _rows(pattern, pattern.interior, free, other)
        forms.append([h[v] for v in free])
        ratios.add(_determinant(rows) / _determinant(forms))
    return len(ratios) == 1 and ratios != {Fraction(0)}


def _nodes(script: Script) -> None:
    """The form of a flat star, and the determinant along an arc through a node."""
    outcomes = []
    zero = script.alter("a stress of the spokes only", 0, 1)
    for pattern in (families.two_vertex(), random_square(3, 0), random_square(5, 0)):
        for v in pattern.interior:
            stress = {e: s for e, s in wheel_stress(pattern, v).items() if not zero or v in e}
            moment = [
                sum(
                    (
                        s
                        * (pattern.vertices[i][a] - pattern.vertices[j][a])
                        * (pattern.vertices[i][b] - pattern.vertices[j][b])
                        for (i, j), s in stress.items()
                    ),
                    Fraction(0),
                )
                for a, b in ((0, 0), (0, 1), (1, 1))
            ]
            outcomes.append(moment == [0, 0, 0])
    script.cases(
        "sum of w_e (U_i - U_j)(U_i - U_j)^T = 0 for the wheel stress: rigid motions of a flat "
        "star add nothing to its second-order form, which is 2 K_v of the heights over its plane",
        outcomes,
    )
    t, b, c, p, q, r = sympy.symbols("t b c p q r")
    # A form that vanishes on (1, 0), with terms of third order along the curve (t, p t^2).
    linear = sympy.Matrix([[b * p * t**2 + r * t**2, b * t + 2 * c * p * t**2 + q * t**2]])
    tangent = sympy.Matrix([[1, 2 * p * t]])
    determinant = sympy.Matrix.vstack(linear, tangent).det()
    power = script.alter("no sign change", 1, 2)
    script.identity(
        "k = 1: det [J; T] along an arc through a node is -b t + O(t^2), b the mixed term of the "
        "form: it changes its sign",
        sympy.Poly(determinant, t).coeff_monomial(t**power) + b,
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
