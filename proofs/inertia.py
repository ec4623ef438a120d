"""The inertia of the Jacobian: as many positive eigenvalues as vertices popped up (Theorem 4)."""

from __future__ import annotations

import random
import sys
from fractions import Fraction
from itertools import combinations, product
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.rings import ring

from exactfold import CreasePattern, random_square
from exactfold.exact.linalg import inertia_by_elimination
from proofs.chambers import jacobian, vertex_signs
from proofs.framework import Proof, Script, run
from proofs.level_pairs import alternating, partners
from proofs.patterns import flipped, hostile_patterns
from proofs.potential import corner_polar
from proofs.tutte import drawing, equal_weights, fold_weight, lifting, mixed, own_weights

NAME = "inertia"
TITLE = "The inertia of the Jacobian: vertices up, down, flat"

Point = tuple[Any, Any]


def prove(change: str | None = None) -> Proof:
    """Prove every identity in the proof of Theorem 4; `inertia_cases` tests the theorem itself."""
    script = Script(
        NAME,
        TITLE,
        (
            "a straight-line triangulation of a convex polygon; K_v(h) >= 0 at every interior v",
            "a quadrilateral with a reflex corner: the sheet with its notch closed",
        ),
        change,
    )
    _state(script)
    _laplace_matrix(script)
    _all_up(script)
    _tensor(script)
    _midpoints(script)
    _level_pairs(script)
    return script.proof()


def _state(script: Script) -> None:
    script.state(
        "T.4",
        "docs/theorem.md, Theorem 4",
        r"\text{inertia of }J(h)=(K_v(h,e_u))_{u,v\in I}:\ "
        r"(\#\text{ popped up},\ \#\text{ popped down},\ \#\text{ flat})",
        note="flat vertices: h + eps h' with h' in a chamber that agrees with h off F has the "
        "inertia of that chamber; its signs on F are free, and J(h) has rank n - |F| (Theorem 3)",
        code="curvature_form",
        words="docs/theorem.md, Theorem 4",
    )


def _laplace_matrix(script: Script) -> None:
    """-K_v(h, e_w) at an edge vw with faces vwa, wvb, for all heights of the four corners."""
    _, *z = field("w1 w2 a1 a2 b1 b2 hv hw ha hb", QQ)
    w, a, b = (z[0], z[1]), (z[2], z[3]), (z[4], z[5])
    hv, hw, ha, hb = z[6:]

    def minus(p: Point, q: Point) -> Point:
        return p[0] - q[0], p[1] - q[1]

    def at(o: Point, ho: Any, first: int) -> Any:
        """K_o(h, e_w), summed over both faces; `first` is 1 if o = v, else the edge is ow = wv."""
        other, height = (w, hw) if first else ((0 * w[0], 0 * w[0]), hv)
        left, right = ((a, ha), (b, hb)) if first else ((b, hb), (a, ha))
        return corner_polar(
            minus(other, o), minus(left[0], o), height - ho, left[1] - ho, 1, 0
        ) + corner_polar(minus(right[0], o), minus(other, o), right[1] - ho, height - ho, 0, 1)

    origin = (0 * w[0], 0 * w[0])
    area_a, area_b = w[0] * a[1] - w[1] * a[0], b[0] * w[1] - b[1] * w[0]
    x, y, u = hw - hv, ha - hv, hb - hv
    gradient_a = ((x * a[1] - y * w[1]) / area_a, (y * w[0] - x * a[0]) / area_a)
    gradient_b = ((u * w[1] - x * b[1]) / area_b, (x * b[0] - u * w[0]) / area_b)
    jump = minus(gradient_a, gradient_b)
    sign = script.alter("fold with the wrong sign", 1, -1)
    weight = -at(origin, hv, 1)
    same = script.alter("J antisymmetric", 1, -1)
    script.identity(
        "K_v(h, e_w) = K_w(h, e_v): J is symmetric", weight + same * at(w, hw, 0), of="T.4"
    )
    script.identity(
        "the jump of the gradient across the edge d is -2 weight Jd, weight = -K_v(h, e_w): "
        "|weight| = fold/(2 length)",
        jump[0] - sign * 2 * weight * w[1],
        jump[1] + 2 * weight * w[0],
        of="T.4",
    )
    (_, p, q, r) = ring("p q r", QQ)
    relative = script.alter("sum of squares of sums", 1, -1)
    script.identity(
        "an edge with weight r adds r (p - q)^2 to w^T J(h) w, as constants are in the kernel",
        p * r * (p - q) + q * r * (q - p) - r * (p - relative * q) ** 2,
        of="T.4",
    )
    script.cases(
        "w^T J(h) w = sum weight (w_i - w_j)^2 for the package's forms, w = 0 on the boundary",
        (_is_laplacian(p, seed, relative) for seed, p in enumerate(hostile_patterns(14))),
        of="T.4",
    )


def _is_laplacian(pattern: CreasePattern, seed: int, sign: int) -> bool:
    source = random.Random(seed)
    h = {v: Fraction(source.randint(-9, 9)) for v in range(len(pattern.vertices))}
    w = {v: Fraction(source.randint(-9, 9) * (v in pattern.interior)) for v in h}
    matrix = jacobian(pattern, h)
    total = sum(
        (
            w[u] * x * w[v]
            for v, row in zip(pattern.interior, matrix, strict=True)
            for u, x in zip(pattern.interior, row, strict=True)
        ),
        Fraction(0),
    )
    return total == sum(
        fold_weight(pattern, (i, j), h) * (w[i] - sign * w[j]) ** 2 for i, j in pattern.folds
    )


def _all_up(script: Script) -> None:
    """Tutte's drawing, the drawings on the way to it, and its lifting, on sheets without chords."""
    sheets = [p for p in hostile_patterns(24) if not p.chords]
    sheets += [flipped(random_square(5, s), random.Random(s)) for s in range(6)]
    stress = script.alter("a lifting that is no equilibrium", Fraction(1), Fraction(0))

    def lifted(pattern: CreasePattern) -> bool:
        own, equal = own_weights(pattern), equal_weights(pattern)
        if drawing(pattern, own) != pattern or any(
            x <= 0 for r in own.values() for x in r.values()
        ):
            return False
        for t in (Fraction(1, 3), Fraction(2, 3)):
            drawing(pattern, mixed(own, equal, t))  # raises if it is not a triangulation
        last = drawing(pattern, mixed(own, equal, stress))
        heights = lifting(last)
        return (
            all(fold_weight(last, fold, heights) == 1 for fold in last.folds)
            and set(vertex_signs(last, heights)) == {1}
            and inertia_by_elimination(jacobian(last, heights)) == (pattern.Vi, 0, 0)
        )

    script.cases(
        "own weights are positive; the drawings on the way to Tutte's are triangulations; that has "
        "heights with all fold weights 1: all vertices up, J positive definite",
        (lifted(pattern) for pattern in sheets),
        of="T.4",
    )


def _tensor(script: Script) -> None:
    """The case K_u(a, b) = T(e_u, a, b), J = T(h, ., .), with any symmetric trilinear form T."""
    sign = script.alter("derivative of the tangent with the wrong sign", 1, -1)
    count = script.alter("K_u(w) counted twice", 1, 2)
    for n in (1, 2, 3, 4):
        triples = [(i, j, k) for i, j, k in product(range(n), repeat=3) if i <= j <= k]
        names = [f"t{i}{j}{k}" for i, j, k in triples]
        names += [f"{name}{i}" for name in "hwxz" for i in range(n)]
        _, *generators = ring(names, QQ)
        entry = dict(zip(triples, generators, strict=False))
        vectors = generators[len(triples) :]
        h, w, dw, z = (vectors[k * n : k * n + n] for k in range(4))

        def form(a: Any, b: Any, c: Any, entry: Any = entry, n: int = n) -> Any:
            return sum(
                entry[(t := sorted((i, j, k)))[0], t[1], t[2]] * a[i] * b[j] * c[k]
                for i, j, k in product(range(n), repeat=3)
            )

        units = [[int(i == k) for i in range(n)] for k in range(n)]
        moved = sum(w[u] * (form(units[u], z, w) + form(units[u], h, dw)) for u in range(n))
        rest = sum(dw[u] * form(units[u], h, w) for u in range(n))
        script.identity(
            f"n = {n}: sum_u w_u d/ds K_u(h, w) = T(z, w, w) + sum_u w'_u K_u(h, w) along h' = z; "
            "so where J w = 0 and K_u(h, w) = 0 stays for u != v, w_v x' = T(z, w, w)",
            moved - form(z, w, w) - sign * rest,
            of="T.4",
        )
        script.identity(
            f"n = {n}: T(z, w, w) = w^T J(z) w = sum_u z_u K_u(w)",
            form(z, w, w) - count * sum(z[u] * form(units[u], w, w) for u in range(n)),
            of="T.4",
        )


def _midpoints(script: Script) -> None:
    _, *y = ring("a b c d e f p1 p2 p3 q1 q2 q3", QQ)
    matrix = ((y[0], y[1], y[2]), (y[1], y[3], y[4]), (y[2], y[4], y[5]))

    def polar(left: Any, right: Any) -> Any:
        return sum(left[i] * matrix[i][j] * right[j] for i, j in product(range(3), repeat=2))

    one, two = y[6:9], y[9:]
    factor = script.alter("the midpoint without its factor", 1, 2)
    total = [a + b for a, b in zip(one, two, strict=True)]
    chord = [b - a for a, b in zip(one, two, strict=True)]
    script.identity(
        "K(q) - K(p) = 2 K((p + q)/2, q - p), K any quadratic form: a chord between points of "
        "equal K_u is in the kernel of the row of u at its midpoint",
        polar(two, two) - polar(one, one) - factor * polar(total, chord),
        of="T.4",
    )
    _, p0, q0, *x = ring("p0 q0 p1 p2 p3 q1 q2 q3", QQ)
    p, q = x[:3], x[3:]
    dot = sum(a * b for a, b in zip(p, q, strict=True))
    kp, kq = p0**2 - sum(a**2 for a in p), q0**2 - sum(b**2 for b in q)
    squares = sum((p[i] * q[j] - p[j] * q[i]) ** 2 for i, j in combinations(range(3), 2))
    sign = script.alter("the squares subtracted", 1, -1)
    script.identity(
        "(p0 q0)^2 - (p.q)^2 = K(p) q0^2 + |p|^2 K(q) + sum of squares, for K = x0^2 - |x|^2: on "
        "one nappe K(p, q) = p0 q0 - p.q > 0 and K((p + q)/2) > 0",
        (p0 * q0) ** 2 - dot**2 - (kp * q0**2 + sum(a**2 for a in p) * kq + sign * squares),
        of="T.4",
    )


def _level_pairs(script: Script) -> None:
    """The lemma on chords, for all orders of the critical values, on which alone it depends."""
    lone = script.alter("a maximum left over", 0, 1)
    checked = []
    for count in (1, 3, 5, 7):
        for values in alternating(count):
            found = partners(values)
            (free,) = (k for k, other in enumerate(found) if other is None)
            checked.append(
                free % 2 == lone
                and all(
                    other is None or (found[other] == k and (other - k) % 2 == 1)
                    for k, other in enumerate(found)
                )
            )
    script.cases(
        "level pairs a < b, f(a) = f(b), for every order of up to 7 different critical values: "
        "each curve joins a minimum to a maximum, but one that joins a minimum to infinity (in "
        "general: docs/theorem.md, 6, step 4)",
        checked,
        of="T.4",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
