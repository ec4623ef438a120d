"""The eigenvector h_- of a vertex, the round cone, and the two nappes (Section II B).

K is the curvature form of a vertex; h_- is the eigenvector of its one positive eigenvalue, which is
the one negative eigenvalue in the sign of Appendix C. What it says of popping is in `vertex_signs`.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from exactfold.exact.linalg import inertia
from exactfold.pattern.families import single_vertex
from exactfold.rigidity import curvature_form, wheel_stress
from exactfold.rigidity.timelike import round_cone
from proofs.framework import Proof, Ruling, Script, run
from proofs.vertex_forms import cot, csc, star, symbols, unit

NAME = "eigenvector"
TITLE = "The eigenvector h_- and the two nappes of a vertex"
HYPOTHESES = (
    "flat vertices, angles in (0, pi) with sum 2 pi, spokes of any lengths: inertia (1, N-3, 3)",
)
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
    )
    plus = script.alter("a square for the product", 1, -1)
    script.identity(
        "(csc a - cot a)(csc a + cot a) = 1, and the two add up to 2 csc a: both are positive if "
        "sin a > 0",
        (csc(u, v) - cot(u, v)) * (csc(u, v) + plus * cot(u, v)) - 1,
    )
    form = curvature_form(star(*SPIKY), 4)
    raised = {v: Fraction(v == 4) for v in range(5)}
    cone = script.alter("the hub raised instead", round_cone(star(*SPIKY), 4), raised)
    script.example(
        "the library's round cone has K > 0 where raising the hub has K < 0",
        form(cone) > 0 and form(raised) == Fraction(-49, 48),
    )
    script.state(
        "T.21",
        "docs/conventions.md, vertex signs",
        r"K_v(t)=\sum_j\tan(\alpha_{j,j+1}/2)>0\text{ for the round cone }t_j-t_v=-L_j",
        Ruling.AS_PRINTED,
        note="for every star with angles in (0, pi). Raising the hub alone has K = (1/2) sum_n "
        "A_n, negative for some stars: -49/48 for spokes (1,0), (3,4), (-2,-1), (8,-2)",
        code="round_cone",
    )


def _nappes(script: Script) -> None:
    T, H, P = symbols("T H P")  # K(t), K(h), K(t, h)
    script.identity(
        "K(T h - P t) = T (T H - P^2) with T = K(t), P = K(t, h), H = K(h)",
        T**2 * H - 2 * T * P * P + P**2 * T - T * (T * H - script.alter("P not squared", P**2, P)),
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
    )
    matrix = curvature_form(star(*SPIKY), 4).matrix
    value = script.alter("another eigenvalue", Fraction(4, 5), Fraction(5, 4))
    affine = [[1] * 5, [0, *(d[0] for d in SPIKY)], [0, *(d[1] for d in SPIKY)]]
    script.example(
        "K(h_-, h) = lambda h_- . h, and h_- . h = 0 for affine h (other eigenvalue): spokes "
        "(1,0), (3,4), (-2,-1), (8,-2) have lambda = 4/5 and h_- = (25; 15, -9, -26, -5)",
        all(_dot(row, EIGENVECTOR) == value * e for row, e in zip(matrix, EIGENVECTOR, strict=True))
        and all(_dot(function, EIGENVECTOR) == 0 for function in affine),
    )
    script.state(
        "IIB.24",
        "Section II B, on the eigenvector",
        r"\text{points on the two nappes are distinguished by the sign of their dot product with }"
        r"\mathbf h_-\text{; the plane normal to it separates them}",
        Ruling.AS_PRINTED,
        note="h_- . h = K(h_-, h)/lambda with K(h_-) > 0. Any t with K(t) > 0 serves as well, "
        "with K(t, h) in place of the dot product; the dot product does not change when an affine "
        "function is added to h",
        code="vertex_sign_functional",
    )
    script.state(
        "IIIB.4",
        "Section III B, vertex sign pattern",
        r"\sigma_n=\mathrm{sgn}[\mathbf e_n\cdot\mathbf h]\text{; each }\mathbf e_n\text{ defines "
        r"a hyperplane separating popped-up from popped-down configurations at }n",
        Ruling.AS_PRINTED,
        note="by IIB.24; sigma_n = 0 iff the star of n is flat. On branches every other timelike "
        "vector that points up gives the same sign. e_n belongs to the negative eigenvalue in the "
        "sign of Appendix C (positive in that of Eq. (wheelstress), see IIB.21)",
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
    )
    script.state(
        "IIB.25",
        "Section II B, on the eigenvector",
        r"\mathbf h_-\text{ gives a set of displacements that maximizes the change in the "
        r"Gaussian curvature}",
        Ruling.AS_PRINTED,
        note="K among displacements of norm 1. Not always |K|: the eigenvalue of largest magnitude "
        "can be negative, as for spokes (0,-3), (2,1), (1,1), (-3,1)",
        code="curvature_form",
    )
    script.state(
        "IIB.26",
        "Section II B, Fig. (conical)(b)",
        r"\text{the eigendeformation of the negative eigenvalue gives the vertex positive "
        r"Gaussian curvature}",
        Ruling.AS_PRINTED,
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
    )
    square = curvature_form(star((1, 0), (0, 1), (-1, 0), (0, -1)), 4)
    ones = (script.alter("the hub moves with its neighbours", -4, 4), 1, 1, 1, 1)
    # So that vector is h_- up to sign (simple eigenvalue). A zero at j would need, in row j of
    # K h_- = lambda h_-, zeros at its rim neighbours (1/c > 0), so all round, and then at the hub.
    script.example(
        "h_- is orthogonal to constants: |hub| = sum of the neighbours' magnitudes, all of the "
        "other sign, so each is smaller (N >= 3); e.g. four equal spokes: (-4, 1, 1, 1, 1)",
        [_dot(row, ones) for row in square.matrix] == [5 * e for e in ones] and sum(ones) == 0,
    )
    stress = wheel_stress(star(*SPIKY), 4)
    j = script.alter("another neighbour", 1, 3)
    script.counterexample(
        "spokes (1,0), (3,4), (-2,-1), (8,-2): neighbour (-2,-1) moves by -26, the hub by 25, "
        "neighbour (1,0) by +15; the link is reflex at (1,0)",
        abs(EIGENVECTOR[3]) > abs(EIGENVECTOR[0])
        and EIGENVECTOR[j] * EIGENVECTOR[0] > 0
        and [stress[j, 4] < 0 for j in range(4)] == [True, False, False, False],
    )
    script.state(
        "IIB.27",
        "Section II B, on the eigenvector",
        r"\text{the component of largest magnitude is the displacement at the vertex itself; the "
        r"neighbouring vertices are moved by smaller amounts in the opposite direction}",
        Ruling.CORRECTED,
        r"\text{if the link polygon has no reflex corner (all spokes compressed or unstressed): "
        r"}h_0=-\sum_jh_j\text{ with all }h_j\ne0\text{ of the sign opposite to }h_0.\text{ False "
        r"for other links}",
        note="spokes (1,0), (3,4), (-2,-1), (8,-2), eigenvalue 4/5, h_- = (25; 15, -9, -26, -5): "
        "a neighbour moves more than the vertex, another one in the same direction",
        code="curvature_form, round_cone",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
