"""The inertia of the Jacobian: as many positive eigenvalues as vertices popped up (Theorem 4).

Write K_v(a, b) for the polar form and V_0 for the heights that vanish on the
boundary (docs/theorem.md).

Proof. Let C_v be the open up nappe of K_v, a convex cone, and M* the convex set of all n x n
matrices whose row v is w -> K_v(z_v, w) on V_0 with some z_v in C_v. Let E be a diagonal matrix of
signs e_v.

1. For M, A in M* and real y the matrix E M - i y A is nonsingular. Let the complex vector w be in
its kernel. Scale z, a in row v such that K = K_v is 1 at both: K(z, w) = i b K(a, w) with a real b.
For s = z + a and d = z - a this gives |K(s, w)| = |K(d, w)|, K(s, d) = 0 and K(s) + K(d) = 4; and
K(s) > 0, as s is in C_v. On the complement of s, which contains d and w' = w - (K(s, w)/K(s)) s,
the form is <= 0 by (L), and Cauchy and Schwarz give |K(d, w)|^2 = |K(d, w')|^2 <= K(d) K(w',
conj(w')). So K(w, conj(w)) = |K(s, w)|^2 / K(s) + K(w', conj(w')) <= (K(d)/K(s) + 1) K(w',
conj(w')) = 4 K(w', conj(w'))/K(s) <= 0. As K_v(w, conj(w)) = K_v(Re w) + K_v(Im w), the key lemma
for both parts gives w = 0.

2. A^-1 E M has as many eigenvalues with positive real part as E has signs +, and no imaginary ones.
By 1, none crosses the imaginary axis on the way (1 - s) M + s A in M*; at s = 1 the matrix is
similar to E.

3. Some A in M* has a positive definite A + A^T. A face with angle alpha and spokes of lengths l,
l', whose ends are p, p' above v, adds -1/2 tan(alpha/2) (p/l + p'/l') to the row K_v(t_v, .) of the
round cone. So in the matrix L of these rows the entry at v is positive, those at its neighbours are
negative, and with the boundary they add up to 0. By the maximum principle L is invertible and L^-1
>= 0. So x = L^-1 1 and y = L^-T 1 are positive. Put D = diag(y_v/x_v) and A = D L, with z_v a
multiple of t_v. No entry of A + A^T off the diagonal is positive, and (A + A^T) x = y/x + 1 > 0. A
symmetric matrix with these properties is positive definite.

4. If all K_v(h) > 0, let e be the vertex signs. Then J(h) = E M with z_v = e_v h. On the way A_r =
(1 - r) A + r I no eigenvalue of A_r^-1 J is imaginary: J w = i y A_r w, multiplied by conj(w)^T, is
real on the left, and on the right i y times a number with positive real part. So y = 0, and w = 0
by 1. So J has as many positive eigenvalues as A^-1 J has with positive real part: the number p(e)
of signs +.

5. If some K_v(h) = 0, let F be the set of flat vertices of h, and let h' have all K_v(h') > 0 and
vertex signs e that agree with those of h outside F (Theorem 2 (d)). So has h + eps h' for eps > 0.
The rank of J(h) is n - |F| by the proof of Theorem 3, and its number of positive eigenvalues is at
most p(e) and at least p(e) - |F|. Take e = - on F, then e = + on F.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.rings import ring

from exactfold import CreasePattern
from exactfold.exact.linalg import from_fmpq, inertia_by_elimination, to_flint
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity import curvature_form
from exactfold.rigidity.functionals import fold_functional
from exactfold.rigidity.timelike import round_cone
from proofs.chambers import jacobian, solve, vertex_signs
from proofs.framework import Proof, Script, run
from proofs.patterns import hostile_patterns
from proofs.potential import corner_polar

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
    _pencil(script)
    _round_cones(script)
    _count(script)
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


def fold_weight(pattern: CreasePattern, fold: Edge, heights: Mapping[int, Fraction]) -> Fraction:
    """The weight -K_v(h, e_w) = fold / (2 length) of the fold vw; it is positive at a mountain."""
    points, scale = pattern.integer_vertices
    value = sum((c * heights[v] for v, c in fold_functional(pattern, fold).items()), Fraction(0))
    areas = 1
    for side, corner in zip((fold, fold[::-1]), pattern.opposite(fold), strict=True):
        (ax, ay), (bx, by), (cx, cy) = (points[v] for v in (*side, corner))
        areas *= (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return -value * scale * scale / (2 * areas)


def _pencil(script: Script) -> None:
    """The lemma: K(z, w) = i b K(a, w) with K(z) = K(a) = 1 gives K(Re w) + K(Im w) <= 0."""
    _, *y = ring("k1 k2 k3 k4 k5 k6 z1 z2 z3 a1 a2 a3", QQ)
    matrix = ((y[0], y[1], y[2]), (y[1], y[3], y[4]), (y[2], y[4], y[5]))

    def polar(left: Any, right: Any) -> Any:
        return sum(left[i] * matrix[i][j] * right[j] for i, j in product(range(3), repeat=2))

    z, a = y[6:9], y[9:]
    double = script.alter("the parallelogram law without its factor", 2, 1)
    s = [p + q for p, q in zip(z, a, strict=True)]
    d = [p - q for p, q in zip(z, a, strict=True)]
    script.identity(
        "s = z + a, d = z - a: K(s, d) = K(z) - K(a), K(s) + K(d) = 2 K(z) + 2 K(a)",
        polar(s, d) - polar(z, z) + polar(a, a),
        polar(s, s) + polar(d, d) - double * (polar(z, z) + polar(a, a)),
        of="T.4",
    )
    _, p, q, b = ring("p q b", QQ)  # K(a, w) = p + i q, K(z, w) = i b (p + i q)
    turned = script.alter("a real factor for an imaginary one", -b * q, b * q)
    script.identity(
        "K(z, w) = i b K(a, w) with b real: |K(s, w)| = |K(d, w)|",
        (turned + p) ** 2 + (b * p + q) ** 2 - (turned - p) ** 2 - (b * p - q) ** 2,
        of="T.4",
    )
    _, size, x, k, rest = field("S x k r", QQ)  # K(s), K(s, w), K(w), K(w')
    mixed = script.alter("mixed term counted once", 2, 1)
    script.identity(
        "w' = w - (K(s, w) / K(s)) s: K(w) = K(s, w)^2 / K(s) + K(w')",
        k - x**2 / size - (k - mixed * x / size * x + (x / size) ** 2 * size),
        of="T.4",
    )
    total = script.alter("K(s) + K(d) = 0", 4, 0)
    script.identity(
        "with |K(s, w)|^2 <= K(d) K(w'), K(d) = 4 - K(s): the sum is at most 4 K(w') / K(s) <= 0",
        (total - size) * rest / size + rest - 4 * rest / size,
        of="T.4",
    )
    _, *y = ring("s1 s2 s3 s4 s5 s6 p1 p2 p3 q1 q2 q3", QQ)
    other = script.alter("S not symmetric", y[4], 2 * y[4])
    matrix = ((y[0], y[1], y[2]), (y[1], y[3], y[4]), (y[2], other, y[5]))
    left, right = y[6:9], y[9:]
    script.identity(
        "w* S w is real for real symmetric S: S w = i y A w with A + A^T > 0 only for y = 0",
        polar(left, right) - polar(right, left),
        of="T.4",
    )


def _round_cones(script: Script) -> None:
    """The matrix L of the round cones, and the matrix A = D L with A + A^T positive definite."""
    _, one, two, u, x, y = field("L M u x y", QQ)
    square = u**2 + 1
    side = script.alter("a cone that points down", -1, 1)
    script.identity(
        "a face with angle a and spokes of lengths L, M adds -tan(a/2)/2 (x/L + y/M) to the row "
        "K_v(t_v, .) of the round cone",
        corner_polar(
            (one, 0 * u), (two * (1 - u**2) / square, 2 * two * u / square), -one, -two, x, y
        )
        - side * u / 2 * (x / one + y / two),
        of="T.4",
    )
    scaled = script.alter("L without the scales D", True, False)
    script.cases(
        "A = D L with rational cones: entries off the diagonal at most 0, A + A^T positive "
        "definite",
        (_is_definite(p, scaled) for p in hostile_patterns(40)),
        of="T.4",
    )


def _is_definite(pattern: CreasePattern, scaled: bool) -> bool:
    matrix = round_matrix(pattern, scaled)
    whole = range(pattern.Vi)
    both = [[matrix[i][j] + matrix[j][i] for j in whole] for i in whole]
    return all(both[i][j] <= 0 for i in whole for j in whole if i != j) and (
        inertia_by_elimination(both) == (pattern.Vi, 0, 0)
    )


def round_matrix(pattern: CreasePattern, scaled: bool = True) -> list[list[Fraction]]:
    """The matrix A = D L of the proof, or L, with rational vectors near the round cones."""
    rows = []
    for v in pattern.interior:
        row = curvature_form(pattern, v).functional(round_cone(pattern, v, 64))
        rows.append([row.get(u, Fraction(0)) for u in pattern.interior])
    ones = to_flint([[Fraction(1)] for _ in rows])
    x, y = to_flint(rows).solve(ones), to_flint(rows).transpose().solve(ones)
    scales = [from_fmpq(y[k, 0] / x[k, 0]) if scaled else Fraction(1) for k in range(len(rows))]
    return [[scale * entry for entry in row] for scale, row in zip(scales, rows, strict=True)]


def _count(script: Script) -> None:
    """Eigenvalues of A^-1 E M, where the rows of M and A belong to points of the nappes."""
    wrong = script.alter("eigenvalues counted on the wrong side", 1, -1)
    script.cases(
        "A^-1 E M has as many eigenvalues with positive real part as E has signs + (Routh's "
        "array), rows of M and A from points of all chambers",
        (
            right_roots(pencil) == signs.count(wrong)
            for seed, p in enumerate(hostile_patterns(13))
            for pencil, signs in _pencils(p, seed)
        ),
        of="T.4",
    )


def _pencils(pattern: CreasePattern, seed: int) -> Iterator[tuple[list[Fraction], list[int]]]:
    """Characteristic polynomials of ten matrices A^-1 E M, highest coefficient first, and E."""
    source = random.Random(seed)
    points = solve(pattern, seed).points
    rows: list[list[list[Fraction]]] = [[] for _ in pattern.interior]
    for point in points:
        signs, matrix = vertex_signs(pattern, point), jacobian(pattern, point)
        for k, sign in enumerate(signs):
            rows[k].append([sign * entry for entry in matrix[k]])
    for _ in range(10):
        first, second = ([source.choice(some) for some in rows] for _ in range(2))
        signs = tuple(source.choice((1, -1)) for _ in rows)
        scales = [e * source.randint(1, 999) for e in signs]
        signed = [[c * entry for entry in row] for c, row in zip(scales, first, strict=True)]
        found = (to_flint(second).inv() * to_flint(signed)).charpoly().coeffs()
        yield [from_fmpq(c) for c in found[::-1]], list(signs)


def right_roots(coefficients: Sequence[Fraction]) -> int:
    """The number of roots with positive real part, by Routh's array.

    Highest coefficient first. Raises `ArithmeticError` if an entry of the first column is 0.

    >>> right_roots([Fraction(c) for c in (1, -3, 4, -2)])  # 1 and 1 + i, 1 - i
    3
    """
    above, row = list(coefficients[::2]), list(coefficients[1::2])
    changes = 0
    while row:
        if not row[0]:
            raise ArithmeticError("an entry of the first column is 0")
        changes += (above[0] > 0) != (row[0] > 0)
        padded = [*row, Fraction(0)]
        below = [a - above[0] / row[0] * b for a, b in zip(above[1:], padded[1:], strict=False)]
        above, row = row, below
    return changes


if __name__ == "__main__":
    sys.exit(run(prove()))
