"""The eigenvector h_- of a vertex, the round cone, and the two nappes (Section II B).

K is the curvature form of a vertex, and h_- is the eigenvector of its only positive eigenvalue. In
the sign convention of Appendix C this is the only negative eigenvalue. The module `vertex_signs`
has what follows about popping.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import pairwise
from math import atan2
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import numpy as np

from exactfold.exact.linalg import inertia, nullspace
from exactfold.pattern.families import single_vertex
from exactfold.rigidity import curvature_form, wheel_stress
from exactfold.rigidity.timelike import round_cone
from proofs.framework import Proof, Script, run
from proofs.statements import Severity
from proofs.vertex_forms import cot, cross, csc, star, symbols, unit

NAME = "eigenvector"
TITLE = "The eigenvector h_- and the two nappes of a vertex"
HYPOTHESES = (
    "flat vertices, angles in (0, pi) with sum 2 pi, spokes of any lengths: inertia (1, N-3, 3)",
)
LARGEST = """
Theorem. Let h be an eigenvector of the positive eigenvalue l of K, popping up. Then its component
at the hub is larger than all others; so it is positive, as their sum is 0.

Proof. Let rho be the slope of h round the hub, on each sector the sinusoid with the slopes of its
two spokes; of all functions with these slopes it has the largest integral of rho^2 - rho'^2
(Picone). (1) No arc on which rho >= 0 is as long as pi: let g be sin x for 0 <= x <= pi on a half
circle in it and 0 elsewhere, the sheet folded along one straight valley, popping down. Then
K(h, g) = (rho(0) + rho(pi))/2 >= 0, but K(h, g) < 0 for h in the open up nappe and g in the closed
down nappe. (2) Hence clipping, h -> min(h, h_0), does not lower K: what is lost is an integral over
arcs with rho > 0, shorter than pi, and not positive (Wirtinger, docs/theorem.md, 2). (3) K does not
see constants, and K <= l |.|^2. If h_0 <= 0, min(h, h_0) - h_0 is nowhere larger than h in
magnitude and somewhere smaller; if h_0 > 0, so is min(h, h_0), unless all h_n <= h_0. As
l |h|^2 = K(h) <= K(clipped) <= l |clipped|^2, only h_0 > 0 and all h_n <= h_0 is left. (4) If h_n =
h_0 > 0, the slope at n is 0 and those beside it are not positive, so that the bend at n is not
positive; but row n of K h = l h says that it is 2 l L_n h_n > 0. QED
"""
LOYAL = [(-3, -1), (6, 0), (4, 1), (2, 3)]  # reflex at (4, 1); eigenvalue 163/180
SPIKY = [(1, 0), (3, 4), (-2, -1), (8, -2)]  # eigenvalues 4/5 and -31/8
EIGENVECTOR = [25, 15, -9, -26, -5]  # its h_-, hub first
CONVEX = [(0, -3), (2, 1), (1, 1), (-3, 1)]


def prove(change: str | None = None) -> Proof:
    """Statements on h_-, on the round cone and on the nappes."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _round_cone(script)
    _nappes(script)
    _curvature(script)
    _components(script)
    return script.proof()


def _round_cone(script: Script) -> None:
    s, t, L, M = symbols("s t L M")
    u, v = unit(s), unit(t)
    half = (t - s) / (1 + s * t)  # tan(a/2), where s and t are tangents of half the directions
    x, y = -L, -script.alter("cone up on one side, down on the other", M, -M)
    sector = (x / L) * (y / M) * csc(u, v) - cot(u, v) / 2 * ((x / L) ** 2 + (y / M) ** 2)
    script.identity(
        "round cone t_0 = 0, t_j = -L_j: each sector contributes csc a - cot a = tan(a/2) to K",
        sector - half,
        csc(u, v) - cot(u, v) - half,
        of="T.21",
    )
    plus = script.alter("a square for the product", 1, -1)
    script.identity(
        "(csc a - cot a)(csc a + cot a) = 1, and the two add up to 2 csc a: both are positive if "
        "sin a > 0",
        (csc(u, v) - cot(u, v)) * (csc(u, v) + plus * cot(u, v)) - 1,
        of="T.21",
    )
    form = curvature_form(star(*SPIKY), 4)
    raised = {v: Fraction(v == 4) for v in range(5)}
    cone = script.alter("the hub raised instead", round_cone(star(*SPIKY), 4), raised)
    script.example(
        "the library's round cone has K > 0 where raising the hub has K < 0",
        form(cone) > 0 and form(raised) == Fraction(-49, 48),
        of="T.21",
    )
    script.state(
        "T.21",
        "docs/mathematics.md, Signs of vertices",
        r"K_v(t)=\sum_j\tan(\alpha_{j,j+1}/2)>0\text{ for the round cone }t_j-t_v=-L_j",
        note="for every star with angles in (0, pi). Raising the hub alone has K = (1/2) sum_n "
        "A_n, negative for some stars: -49/48 for spokes (1,0), (3,4), (-2,-1), (8,-2)",
        code="round_cone",
    )


def _nappes(script: Script) -> None:
    T, H, P = symbols("T H P")  # K(t), K(h), K(t, h)
    script.identity(
        "K(T h - P t) = T (T H - P^2) with T = K(t), P = K(t, h), H = K(h)",
        T**2 * H - 2 * T * P * P + P**2 * T - T * (T * H - script.alter("P not squared", P**2, P)),
        of="IIB.24 IIIB.4",
    )
    # If T > 0, K is negative semidefinite on the complement of t and zero only on affine functions,
    # by the inertia (1, N-3, 3). So H = 0 = P only for affine h, and P does not vanish on a nappe.
    extra = script.alter("nullity 2", 0, 1)
    script.example(
        "inertia (1, N-3, 3), N = 3 to 8: if K(t) > 0, nothing but affine functions has K(h) = 0 "
        "= K(t, h)",
        all(
            curvature_form(single_vertex(n), n).inertia == (1, n - 3 + extra, 3 - extra)
            for n in range(3, 9)
        ),
        of="IIB.24 IIIB.4",
    )
    matrix = curvature_form(star(*SPIKY), 4).matrix
    value = script.alter("another eigenvalue", Fraction(4, 5), Fraction(5, 4))
    affine = [[1] * 5, [0, *(d[0] for d in SPIKY)], [0, *(d[1] for d in SPIKY)]]
    script.example(
        "K(h_-, h) = lambda h_- . h, and h_- . h = 0 for affine h (other eigenvalue): spokes "
        "(1,0), (3,4), (-2,-1), (8,-2) have lambda = 4/5 and h_- = (25; 15, -9, -26, -5)",
        all(_dot(row, EIGENVECTOR) == value * e for row, e in zip(matrix, EIGENVECTOR, strict=True))
        and all(_dot(function, EIGENVECTOR) == 0 for function in affine),
        of="IIB.24 IIB.26",
    )
    script.state(
        "IIB.24",
        "Section II B, on the eigenvector",
        r"\text{``Points on the two nappes can be distinguished by the sign of their dot "
        r"products with }\mathbf{h}_-\text{ since the plane normal to }\mathbf{h}_-\text{ "
        r"separates the nappes''}",
        note="Remark: h_- . h = K(h_-, h)/lambda with K(h_-) > 0. Any t with K(t) > 0 serves as "
        "well, with K(t, h) in place of the dot product; the dot product does not change when an "
        "affine function is added to h",
        code="vertex_sign_functional",
    )
    script.state(
        "IIIB.4",
        "Section III B, vertex sign pattern",
        r"\sigma_n=\textrm{sgn}[\mathbf{e}_n\cdot\mathbf{h}]\text{ \dots\ ``each of the "
        r"}\mathbf{e}_n\text{ defines a hyperplane separating the popped-up configurations "
        r"at }n\text{ from those popped-down there''}",
        note="Remark: by IIB.24; sigma_n = 0 iff the star of n is flat. On branches every other "
        "timelike vector that points up gives the same sign. e_n belongs to the negative "
        "eigenvalue in the sign of Appendix C (positive in that of Eq. (wheelstress), see IIB.21)",
        code="vertex_sign_functional",
    )


def _dot(a: Iterable[Fraction | int], b: Iterable[int]) -> Fraction:
    return sum((Fraction(x) * y for x, y in zip(a, b, strict=True)), Fraction(0))


def _curvature(script: Script) -> None:
    form = curvature_form(star(*SPIKY), 4)
    top = script.alter("not the largest eigenvalue", Fraction(4, 5), Fraction(3, 4))
    rest = [[top * (i == j) - form.matrix[i][j] for j in range(5)] for i in range(5)]
    script.example(
        "on unit vectors h = a h_- + y, K(h) = lambda a^2 + K(y) <= lambda: lambda I - K is "
        "positive semidefinite, here of inertia (4, 0, 1)",
        inertia(rest) == (4, 0, 1),
        of="IIB.25",
    )
    sign = script.alter("sign of Appendix C", 1, -1)
    matrices = [form.matrix, curvature_form(star(*CONVEX), 4).matrix]
    script.counterexample(
        "spokes (1,0), (3,4), (-2,-1), (8,-2) and, with convex link, (0,-3), (2,1), (1,1), "
        "(-3,1): one positive and one negative eigenvalue with sum -123/40 and -5/108, so that "
        "|K| is larger at the other",
        [sum(m[i][i] for i in range(5)) for m in matrices]
        == [sign * Fraction(-123, 40), sign * Fraction(-5, 108)]
        and all(inertia(m) == (1, 1, 3) for m in matrices),
        against="IIB.25",
    )
    script.state(
        "IIB.25",
        "Section II B, on the eigenvector",
        r"\text{``This eigenvector gives a set of displacements that maximizes the change "
        r"in the Gaussian curvature''}",
        r"\text{among displacements of one norm it maximizes the Gaussian curvature, and not "
        r"always the size of its change}",
        "the curvature can change more at an eigenvalue of the other sign, as for the spokes "
        "(0,-3), (2,1), (1,1), (-3,1), whose link is convex: the two eigenvalues of K that are not "
        "0 have the sum -5/108",
        "curvature_form",
        severity=Severity.CONDITION,
    )
    script.state(
        "IIB.26",
        "Section II B, Fig. (conical)(b)",
        r"\text{``The eigendeformation of the negative eigenvalue would, on its own, give "
        r"the vertex positive Gaussian curvature''}",
        note="negative in the sign of Appendix C, -2 K: K(h_-) = lambda |h_-|^2 > 0",
    )


def _components(script: Script) -> None:
    h0, x, y, c, A = symbols("h0 x y c A")
    rim = (x - y) ** 2 * (-1 / c) / 2
    spoke = A * (h0 - x) ** 2 / 2
    sign = script.alter("sign of the rim terms", 1, -1)
    script.identity(
        "off the diagonal K has + x_j x_{j+1}/c_j and - A_j h_0 x_j: with c_j > 0, A_j >= 0, "
        "replacing h by (|h_0|, -|h_1|, ..., -|h_N|) does not lower K and keeps |h|",
        rim - (sign * x * y / c - (x**2 + y**2) / (2 * c)),
        spoke - (-A * h0 * x + A * (h0**2 + x**2) / 2),
        of="IIB.27",
    )
    square = curvature_form(star((1, 0), (0, 1), (-1, 0), (0, -1)), 4)
    ones = (script.alter("the hub moves with its neighbours", -4, 4), 1, 1, 1, 1)
    # So that vector is h_- up to sign (simple eigenvalue). A zero at j would need, in row j of
    # K h_- = lambda h_-, zeros at its rim neighbours (1/c > 0), so all round, and then at the hub.
    script.example(
        "h_- is orthogonal to constants: |hub| = sum of the neighbours' magnitudes, all of the "
        "other sign, so each is smaller (N >= 3); e.g. four equal spokes: (-4, 1, 1, 1, 1)",
        [_dot(row, ones) for row in square.matrix] == [5 * e for e in ones] and sum(ones) == 0,
        of="IIB.27",
    )
    _largest(script)
    stress = wheel_stress(star(*SPIKY), 4)
    j = script.alter("another neighbour", 1, 3)
    script.counterexample(
        "spokes (1,0), (3,4), (-2,-1), (8,-2): neighbour (-2,-1) moves by -26, the hub by 25, "
        "neighbour (1,0) by +15; the link is reflex at (1,0)",
        abs(EIGENVECTOR[3]) > abs(EIGENVECTOR[0])
        and EIGENVECTOR[j] * EIGENVECTOR[0] > 0
        and [stress[j, 4] < 0 for j in range(4)] == [True, False, False, False],
        against="IIB.27",
    )
    script.state(
        "IIB.27",
        "Section II B, on the eigenvector",
        r"\text{``the component of largest magnitude in this eigenvector is the "
        r"displacement at the vertex itself and the neighboring vertices are moved by "
        r"smaller amounts in the opposite direction''}",
        r"h_0>h_n\text{ for all }n\text{, where }\mathbf h_-\text{ pops up; if the link polygon "
        r"has no reflex corner, also }h_n<0\text{ for all }n\text{, so that }|h_n|<h_0",
        note="the first part for every vertex (proof: LARGEST in proofs/eigenvector.py). With a "
        "reflex corner the printed words can fail: spokes (1,0), (3,4), (-2,-1), (8,-2), "
        "eigenvalue 4/5, h_- = (25; 15, -9, -26, -5): a neighbour moves more than the vertex, "
        "another one in the same direction. Remark: they "
        "can hold, too: (-3,-1), (6,0), (4,1), (2,3)",
        code="curvature_form, round_cone",
        severity=Severity.CLAIM,
        words="LARGEST in proofs/eigenvector.py",
    )


def _largest(script: Script) -> None:
    """The steps of the statement LARGEST, and what it claims, on stars with reflex links."""
    s, t, r, q, p = symbols("s t r q p")
    u, v = unit(s), unit(t)  # a sector; slopes r and q of h at its spokes
    polar = ((r * v[1] + q * u[1]) * csc(u, v) - cot(u, v) * (r * u[1] + q * v[1])) / 2
    end = script.alter("the ends of the half circle subtracted", 1, -1)
    script.identity(
        "(1): with g = sin x a sector from x to y gives K(h, g) the part (rho(x) cos x - rho(y) "
        "cos y)/2, over a half circle (rho(0) + rho(pi))/2",
        polar - (r * u[0] - end * q * v[0]) / 2,
        of="IIB.27",
    )
    q, p = symbols("q p")
    larger = script.alter("clipped from below", 1, -1)
    script.certificate(
        "(3): h_n = -(p + q), h_0 = -p <= 0: h_n^2 - (h_n - h_0)^2 = p^2 + 2 p q; h_n = p + q, h_0 "
        "= p > 0: h_n^2 - h_0^2 = q^2 + 2 p q; positive coefficients",
        all(
            c > 0
            for difference in ((p + q) ** 2 - q**2, larger * ((p + q) ** 2 - p**2))
            for c in difference.numer.coeffs()
        ),
        of="IIB.27",
    )
    stars = [SPIKY, LOYAL, *_random_stars(20)]
    order = script.alter("the hub smallest", 1, -1)
    script.cases(
        "h_0 > h_n for all n, by exact enclosures of h_-, on stars with reflex links",
        (_hub_is_largest(spokes, order) for spokes in stars),
        of="IIB.27",
    )
    matrix = curvature_form(star(*LOYAL), 4).matrix
    value = script.alter("another eigenvalue of the loyal star", Fraction(163, 180), Fraction(1))
    rest = [[k - value * (i == j) for j, k in enumerate(row)] for i, row in enumerate(matrix)]
    (loyal,) = nullspace(rest) or [[Fraction(1)] * 5]
    script.counterexample(
        "spokes (-3,-1), (6,0), (4,1), (2,3), link reflex at (4,1): the printed words hold, the "
        "hub moves most and all others against it",
        wheel_stress(star(*LOYAL), 4)[2, 4] < 0
        and all(x * loyal[0] < 0 and abs(x) < abs(loyal[0]) for x in loyal[1:]),
        of="IIB.27",
    )


def _random_stars(count: int) -> Iterator[list[tuple[int, int]]]:
    """Integer spokes in counter-clockwise order, all angles below pi, the link not convex."""
    source = random.Random(5)
    while count:
        size = source.randint(4, 7)
        spokes = [(source.randint(-9, 9), source.randint(-9, 9)) for _ in range(size)]
        spokes.sort(key=lambda d: atan2(d[1], d[0]))
        around = [*spokes, *spokes[:2]]
        if any(cross(a, b) <= 0 for a, b in pairwise(around)):
            continue
        sides = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(around)]
        if any(cross(a, b) < 0 for a, b in pairwise(sides)):
            count -= 1
            yield spokes


def _hub_is_largest(spokes: list[tuple[int, int]], order: int) -> bool:
    """Whether the eigenvector of the positive eigenvalue has its largest component at the hub.

    A floating point eigenvector h is taken as exact numbers. All other eigenvalues are at most 0,
    so with m = K(h)/|h|^2 and r = K h - m h an eigenvector is within |r|/m of h.
    """
    form = curvature_form(star(*spokes), len(spokes))
    _, vectors = np.linalg.eigh(np.array(form.matrix, dtype=float))
    h = [Fraction(float(x)) for x in vectors[:, -1]]
    image = [sum((a * x for a, x in zip(row, h, strict=True)), Fraction(0)) for row in form.matrix]
    m = sum(a * x for a, x in zip(image, h, strict=True)) / sum(x * x for x in h)
    error = sum((a - m * x) ** 2 for a, x in zip(image, h, strict=True)) / m**2
    cone = round_cone(star(*spokes), len(spokes))
    row = [cone[v] for v in form.labels]
    up = sum(a * x for a, x in zip(row, image, strict=True))
    functional = form.functional({v: cone[v] for v in form.labels})
    if up**2 <= error * sum(x * x for x in functional.values()):
        return False
    side = order if up > 0 else -order
    return m > 0 and all(side * (h[0] - x) > 0 and (h[0] - x) ** 2 > 4 * error for x in h[1:])


if __name__ == "__main__":
    sys.exit(run(prove()))
