"""The theorem of docs/theorem.md: all branches are real, one for each sign vector."""

from __future__ import annotations

import random
import sys
from collections.abc import Callable
from fractions import Fraction
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy
from sympy import QQ
from sympy.polys.fields import field

from exactfold import BranchCount, CreasePattern, random_square
from exactfold._support.verdict import PROVED
from exactfold.branches.values.roots import BoxRoot
from exactfold.pattern.families import flat_vertex_square
from exactfold.rigidity import BranchSystem, curvature_form, definite_stress
from exactfold.rigidity.definite_stresses import disk_multipliers
from exactfold.rigidity.equations.branch_system import Chart, notch_chart
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.solve import homotopy, isolate
from proofs.chambers import corner_sign, counted, solve
from proofs.framework import Proof, Script, run
from proofs.patterns import DART, SPIKY, darts, hostile_patterns, quadrilaterals

NAME = "all_real"
TITLE = "All branches are real: the central theorem"

Vector = tuple[Any, Any]


def prove(change: str | None = None) -> Proof:
    """Every identity and inequality of the proof, and its conclusions on hostile patterns."""
    script = Script(
        NAME,
        TITLE,
        (
            "a straight-line triangulation of a convex polygon; boundary angles of pi, chords, "
            "vertices of degree 3 and separating triangles allowed",
            "for four boundary vertices also a quadrilateral with a reflex corner",
        ),
        change,
    )
    _state(script)
    _corner_identity(script)
    _face_identities(script)
    _one_positive_direction(script)
    _wirtinger(script)
    _theorem_1_on_patterns(script)
    _five_corners(script)
    _conclusions_on_patterns(script)
    return script.proof()


def _state(script: Script) -> None:
    script.state(
        "T.1",
        "docs/theorem.md, Theorem 2 and section 4",
        r"2^{V_i}\text{ branches with multiplicity, all real, for every convex or reflex boundary "
        r"quadrilateral; distinct exactly when no vertex star is flat on any of them}",
        note="not only generic; the paper found B = 2^Vi, all real, by computing (Section III A)",
        code="decide_all_branches_real, count_branches",
        words="docs/theorem.md, Theorem 2 (a), (b), (e) and section 4",
    )
    script.state(
        "T.2",
        "docs/theorem.md, Theorem 2 (e) and section 4",
        r"\text{exactly two branches for each pair of opposite vertex sign patterns if no vertex "
        r"star is flat on any branch, told apart by the sign of the boundary saddle (convex) or of "
        r"the reflex corner in the closed sheet}",
        note="found by computing in the paper (Section III B): 'proving ... remains elusive'",
        code="BranchCount.sign_vectors",
        words="docs/theorem.md, Theorem 2 (e)",
    )


def _dot(d: Vector, e: Vector) -> Any:
    return d[0] * e[0] + d[1] * e[1]


def _turned(d: Vector) -> Vector:
    return -d[1], d[0]


def _minus(d: Vector, e: Vector) -> Vector:
    return d[0] - e[0], d[1] - e[1]


def _corner(d: Vector, e: Vector, g: Vector) -> Any:
    """The term of a face with spokes d, e (counter-clockwise) in the curvature form, by c and s."""
    c, s = _dot(_turned(d), e), _dot(d, e)
    x, y = _dot(g, d), _dot(g, e)
    return x * y / c - s / (2 * c) * (x**2 / _dot(d, d) + y**2 / _dot(e, e))


def _corner_identity(script: Script) -> None:
    _, *x = field("d1 d2 e1 e2 g1 g2", QQ)
    d, e, g = (x[0], x[1]), (x[2], x[3]), (x[4], x[5])
    sign = script.alter("sign of the corner term", 1, -1)

    def end(spoke: Vector) -> Any:
        return _dot(g, spoke) * _dot(g, _turned(spoke)) / _dot(spoke, spoke)

    script.identity(
        "(1): k = (1/2) [(g.d)(g.Jd)/|d|^2 - (g.d')(g.Jd')/|d'|^2] is the corner's part of K_v",
        _corner(d, e, g) - sign * (end(d) - end(e)) / 2,
        of="T.1",
    )
    r, angle = sympy.Function("r"), sympy.Symbol("theta")
    slope = sympy.Symbol("g1") * sympy.cos(angle) + sympy.Symbol("g2") * sympy.sin(angle)
    primitive = script.alter("sign of the primitive", -1, 1) * slope * sympy.diff(slope, angle)
    difference = slope**2 - sympy.diff(slope, angle) ** 2 - sympy.diff(primitive, angle)
    script.identity(
        "rho^2 - rho'^2 = (-rho rho')' for rho = g . e(theta)",
        sympy.simplify(sympy.expand(difference)),
        of="T.1",
    )
    picone = (sympy.diff(r(angle), angle) - r(angle) * sympy.cot(angle)) ** 2
    boundary = sympy.diff(r(angle) ** 2 * sympy.cot(angle), angle)
    sign = script.alter("sign in Picone's identity", 1, -1)
    script.identity(
        "Picone: rho'^2 - rho^2 = (rho' - rho cot)^2 + (rho^2 cot)'",
        sympy.expand(sympy.diff(r(angle), angle) ** 2 - sign * r(angle) ** 2 - picone - boundary),
        of="T.1",
    )


@cache
def _face_sums() -> tuple[list[Any], Any, Any, Any]:
    """For a general triangle and gradient: all k, sum |U_v|^2 k, 2 |T| |g|^2, and edge terms."""
    _, *x = field("a1 a2 b1 b2 p1 p2 g1 g2", QQ)
    corners, g = [(x[0], x[1]), (x[2], x[3]), (x[4], x[5])], (x[6], x[7])
    parts, moment, edges = [], 0 * x[0], 0 * x[0]
    for k in range(3):
        at, after, before = corners[k], corners[(k + 1) % 3], corners[k - 1]
        part = _corner(_minus(after, at), _minus(before, at), g)
        parts.append(part)
        moment += _dot(at, at) * part
        side = _minus(after, at)
        twice_middle = (after[0] + at[0], after[1] + at[1])
        edges += _dot(g, side) ** 2 * _dot(twice_middle, _turned(side)) / (2 * _dot(side, side))
    u, v = _minus(corners[1], corners[0]), _minus(corners[2], corners[0])
    return parts, moment, _dot(_turned(u), v) * _dot(g, g), edges


def _face_identities(script: Script) -> None:
    """(2) and (3) for a general triangle and any gradient; the centre c is the origin."""
    halves = script.alter("area halved", 2, 4)
    sign = script.alter("sign of the edge term", 1, -1)
    parts, moment, area, edges = _face_sums()
    count = script.alter("a corner left out", 3, 2)
    script.identity("(2): the three corners of a face add up to 0", sum(parts[:count]), of="T.1")
    script.identity(
        "(3): sum |U_v - c|^2 k + |T| |g|^2 + sum (g.d)^2 ((M - c).Jd)/|d|^2 = 0",
        moment + area / halves + sign * edges,
        of="T.1",
    )
    _, *x = field("d1 d2 m1 m2 g1 g2", QQ)
    d, m, g = (x[0], x[1]), (x[2], x[3]), (x[4], x[5])
    power = script.alter("slope along the edge not squared", 2, 1)
    there = _dot(g, d) ** power * _dot(m, _turned(d))
    back = _dot(g, (-d[0], -d[1])) ** power * _dot(m, _turned((-d[0], -d[1])))
    script.identity(
        "the edge term changes sign with the direction of the edge", there + back, of="T.1"
    )


def _one_positive_direction(script: Script) -> None:
    m = sympy.Symbol("m", integer=True, positive=True)
    angle = sympy.Symbol("theta")
    shift = script.alter("wrong Fourier weight", 1, 2)
    for name, wave in (("cos", sympy.cos(m * angle)), ("sin", sympy.sin(m * angle))):
        integral = sympy.integrate(wave**2 - sympy.diff(wave, angle) ** 2, (angle, 0, 2 * sympy.pi))
        script.identity(
            f"the integral of rho^2 - rho'^2 for rho = {name} m theta is pi (1 - m^2)",
            sympy.simplify(integral - sympy.pi * (shift - m**2)),
            of="T.1",
        )


def _wirtinger(script: Script) -> None:
    """The form of -A_b in the inner slopes has minors sin(S) prod csc > 0 while S < pi.

    With angles a_1, ..., a_k between consecutive spokes, the form is tridiagonal with diagonal
    (cot a_j + cot a_{j+1})/2 and off-diagonal -(csc a_{j+1})/2; in units of 1/2 its leading minors
    are D_j = sin(a_1 + ... + a_{j+1}) / (sin a_1 ... sin a_{j+1}). The base and the step of the
    induction are checked.
    """
    t, u, w = sympy.symbols("t u w")

    def half(parameter: sympy.Symbol) -> tuple[sympy.Expr, sympy.Expr]:
        return (1 - parameter**2) / (1 + parameter**2), 2 * parameter / (1 + parameter**2)

    (cs, ss), (ca, sa), (cb, sb) = half(t), half(u), half(w)  # S, a_j, a_{j+1}
    one_more = ss * ca + cs * sa
    two_more = one_more * cb + (cs * ca - ss * sa) * sb
    sign = script.alter("sign in the continuant", 1, -1)
    # D_{j-2} = sin S / P, D_{j-1} = sin(S + a) / (P sin a), D_j = sin(S + a + b) / (P sin a sin b)
    recurrence = (ca / sa + cb / sb) * one_more / sa - sign * ss / sa**2
    script.identity(
        "D_j = (cot a_j + cot a_{j+1}) D_{j-1} - csc^2 a_j D_{j-2}",
        recurrence - two_more / (sa * sb),
        of="T.1",
    )
    script.identity(
        "D_1 = cot a_1 + cot a_2 = sin(a_1 + a_2) csc a_1 csc a_2",
        ca / sa
        + cb / sb
        - (sa * cb + script.alter("sine of the difference", 1, -1) * ca * sb) / (sa * sb),
        of="T.1",
    )


def _theorem_1_on_patterns(script: Script) -> None:
    """Compare the identity of Theorem 1 with exactfold's own curvature forms, at any heights."""
    shift = script.alter("multipliers shifted", Fraction(0), Fraction(1, 7))

    def holds(pattern: CreasePattern, seed: int) -> bool:
        source = random.Random(seed)
        w = {v: Fraction(source.randint(-9, 9), source.randint(1, 5)) for v in pattern.interior}
        w |= dict.fromkeys(pattern.boundary, Fraction(0))
        weights = disk_multipliers(pattern)
        left = sum((weights[v] * curvature_form(pattern, v)(w) for v in pattern.interior), -shift)
        energy, corner = Fraction(0), Fraction(0)
        for a, b, c in pattern.triangles:
            part, gradient = _energy(pattern, w, (a, b, c))
            energy += part
            for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
                if i in pattern.boundary:
                    corner += weights[i] * _boundary_corner(pattern, gradient, i, j, k)
        return left == energy - corner

    script.cases(
        "Theorem 1: sum m_v K_v(w) = int |grad w|^2 - sum m_b A_b(w)",
        (holds(pattern, seed) for seed, pattern in enumerate(hostile_patterns(24))),
        of="T.1",
    )
    script.cases(
        "Key lemma: the disk multipliers give a definite stress (exact elimination)",
        (
            definite_stress(pattern) is not None
            for pattern in [*hostile_patterns(24), *script.alter("a reflex sheet", (), (SPIKY,))]
        ),
        of="T.1",
    )
    hub = {v: Fraction(int(v == 4)) for v in range(5)}
    convex = CreasePattern([(4, -4), (5, 0), *SPIKY.vertices[2:]], SPIKY.triangles)
    sheet = script.alter("the notch pushed out", SPIKY, convex)
    script.counterexample(
        "convexity is needed: hub (0,0) in (4,-4), (1/10,0), (4,4), (-4,0) has K(hub) < 0",
        curvature_form(sheet, 4)(hub) < 0 and definite_stress(sheet) is None,
        of="T.1",
    )


def _five_corners(script: Script) -> None:
    """The right-hand side 0 on a sheet that is not convex, with five boundary vertices."""
    notch = script.alter("the notch closed", (1, 0), (5, 0))
    sheet = CreasePattern(
        [(4, -4), notch, (4, 4), (-4, 2), (-4, -2), (0, 0)],
        [(k, (k + 1) % 5, 5) for k in range(5)],
    )
    form = curvature_form(sheet, 5)
    rim = {v: Fraction(v == 4) for v in range(6)}
    hub = {v: Fraction(v == 5) for v in range(6)}
    script.counterexample(
        "with five boundary vertices convexity is needed for right-hand side 0, too: hub (0,0) in "
        "(4,-4), (1,0), (4,4), (-4,2), (-4,-2) at heights 0, 0, 0, 0, 1 has K = -(38 x^2 + 8 x + "
        "1)/96 in its own height x, and no real solution",
        [96 * form(hub), 96 * 2 * form.polar(rim, hub), 96 * form(rim)] == [-38, -8, -1]
        and form.polar(rim, hub) ** 2 < form(hub) * form(rim),
        of="T.1",
    )


def _gradient(
    pattern: CreasePattern, w: dict[int, Fraction], face: tuple[int, int, int]
) -> tuple[Fraction, Fraction, Fraction]:
    """Gradient of w on a face, and twice the area."""
    (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in face)
    ux, uy, vx, vy = bx - ax, by - ay, cx - ax, cy - ay
    twice = ux * vy - uy * vx
    p, q = w[face[1]] - w[face[0]], w[face[2]] - w[face[0]]
    return (p * vy - q * uy) / twice, (q * ux - p * vx) / twice, twice


def _energy(
    pattern: CreasePattern, w: dict[int, Fraction], face: tuple[int, int, int]
) -> tuple[Fraction, tuple[Fraction, Fraction]]:
    gx, gy, twice = _gradient(pattern, w, face)
    return twice / 2 * (gx * gx + gy * gy), (gx, gy)


def _boundary_corner(
    pattern: CreasePattern, g: tuple[Fraction, Fraction], i: int, j: int, k: int
) -> Fraction:
    """(1) for the corner i of the counter-clockwise face ijk."""

    def end(j: int) -> Fraction:
        dx = pattern.vertices[j][0] - pattern.vertices[i][0]
        dy = pattern.vertices[j][1] - pattern.vertices[i][1]
        return (g[0] * dx + g[1] * dy) * (g[1] * dx - g[0] * dy) / (dx * dx + dy * dy)

    return (end(j) - end(k)) / 2


def _conclusions_on_patterns(script: Script) -> None:
    """Test (a), (b), (d), (e) and section 4 by a count that does not use the theorem."""
    extra = script.alter("one branch too many", 0, 1)

    def all_real(pattern: CreasePattern) -> bool:
        result = counted(pattern)
        right = result.with_multiplicity == (1 << pattern.Vi) + extra
        return result.status is PROVED and right and result.nonreal == 0

    squares = [random_square(n, seed) for n in (2, 3, 4) for seed in range(4)]
    script.cases(
        "section 4: 2^Vi branches with multiplicity, all real, convex and reflex quadrilaterals",
        (all_real(pattern) for pattern in [*squares, *quadrilaterals(12)]),
        of="T.1",
    )
    saddle_only = script.alter("the saddle as the label of a reflex sheet", False, True)
    by_vertex = script.alter("ends told apart by the first vertex", False, True)

    def one_each(result: BranchCount) -> bool:
        """Whether each sign vector occurs once, with saddle +1 or, if closed, reflex corner up."""
        vectors = set()
        for branch in result.branches:
            plain = result.pattern.is_convex or saddle_only
            side = 1 if plain else corner_sign(result.pattern, branch) or 0
            signs = [s for _, s in sorted(branch.vertex_signs.items())]
            vectors.add(tuple((signs[0] if by_vertex else side) * s for s in signs))
        return vectors == set(product((1, -1), repeat=result.pattern.Vi))

    everything = [DART, *squares, *quadrilaterals(16), *darts(40)]
    found = [counted(p) for p in everything if not p.Vt]
    generic = [r for r in found if all(0 not in b.vertex_signs.values() for b in r.branches)]
    reflex = [r for r in generic if not r.pattern.is_convex]
    script.cases(
        "(e): no vertex is flat and each sign vector occurs exactly once with saddle +1: convex "
        "sheets",
        (one_each(r) for r in generic if r.pattern.is_convex),
        of="T.2",
    )
    script.cases(
        "(e): no vertex is flat and each sign vector occurs exactly once with the reflex corner up "
        "in the closed sheet",
        (one_each(r) for r in reflex),
        of="T.2",
    )
    chart = script.alter("the chart of the saddle", notch_chart, lambda p: BranchSystem(p).chart)
    script.cases(
        "the same in the chart K_r(t, h) = 1 of the closed sheet: 2^Vi boxes, all sign vectors",
        (_one_each(chart, r.pattern) for r in reflex),
        of="T.2",
    )
    both = counted(DART).branches
    other = script.alter("the hub up on the other branch", "-", "+")
    script.counterexample(
        "the saddle is no label of a reflex sheet: hub (0,0) in (4,-4), (1,0), (4,4), (-4,0) has "
        "two branches, both with saddle + and the hub down",
        [(b.representative, b.sign_text) for b in both] == [("saddle", "-"), ("saddle", other)],
        of="T.2",
    )
    result = counted(flat_vertex_square())
    script.counterexample(
        "a flat vertex star: three branches, of multiplicities 1, 1, 2, instead of four",
        sorted(b.multiplicity or 0 for b in result.branches)
        == script.alter("four simple branches", [1, 1, 2], [1, 1, 1, 1]),
        of="T.1 T.2",
    )
    sign = script.alter("negative curvatures", 1, -1)
    script.cases(
        "(d): for positive curvatures one real solution for each sign vector, any boundary",
        (solve(p, seed, sign).is_one_each for seed, p in enumerate(hostile_patterns(8, 4))),
        of="T.2",
    )


@cache
def _one_each(chart_of: Callable[[CreasePattern], Chart], pattern: CreasePattern) -> bool:
    chart = chart_of(pattern)
    found = isolate(chart.system, homotopy(chart.system))
    rows = Functionals(chart).vertices.values()
    signs = {tuple(BoxRoot(box).sign(row) for row in rows) for box in found.boxes if box.is_real}
    everything = set(product((1, -1), repeat=pattern.Vi))
    return found.complete is PROVED and found.nonreal == 0 and signs == everything


if __name__ == "__main__":
    sys.exit(run(prove()))
