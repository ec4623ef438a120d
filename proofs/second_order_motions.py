"""What second-order solutions say about true configurations (Section II A, last paragraphs)."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern
from exactfold._support.verdict import REFUTED
from exactfold.exact.linalg import rank
from exactfold.panels import decompose
from exactfold.pattern import PanelPattern, families
from exactfold.rigidity import curvature_form, rigidity_matrix
from exactfold.rigidity.functionals import fold_functional
from proofs.framework import Proof, Script, run
from proofs.length_equations import CROSS, Heights, is_solution
from proofs.statements import Severity

NAME = "second_order_motions"
TITLE = "Second-order solutions and true configurations"


def prove(change: str | None = None) -> Proof:
    """Extension of regular solutions, the order of the energy, and fold angles as coordinates."""
    script = Script(
        NAME, TITLE, ("a triangulated disk; a second-order solution X = U + t^2 u + t h z",), change
    )
    _extension(script)
    _not_true(script)
    _energy(script)
    _fold_angles(script)
    return script.proof()


def _extension(script: Script) -> None:
    """Regular second-order solutions are tangent to true configurations."""
    t, h = sympy.symbols("t h")
    U, u = sympy.Matrix(sympy.symbols("U_x U_y")), sympy.Matrix(sympy.symbols("u_x u_y"))
    X = U + t**2 * u
    power = script.alter("remainder of first order in t", 2, 1)
    script.identity(
        "(|X|^2 - L^2) / t^2 = 2 U.u + h^2 + t^2 |u|^2, analytic in (t, u, h)",
        (X.dot(X) + t**2 * h**2 - U.dot(U)) / t**2 - 2 * U.dot(u) - h**2 - t**power * u.dot(u),
        of="IIA.11",
    )
    s = sympy.Symbol("s")
    bound = script.alter("in-plane displacements of first order", 2, 1)
    script.identity(
        "configurations that tend to the flat one have |u| <= 2c s^2 with s = |h| (IIA.4); in "
        "units h = s h', u = s^2 u' the lengths read 2 U.u' + h'^2 + s^2 |u'|^2 = 0 with |h'| = 1 "
        "and u' bounded, so that a limit point is a folded second-order solution",
        ((U + s**2 * u).dot(U + s**2 * u) + (s * h) ** 2 - U.dot(U)) / s**bound
        - (2 * U.dot(u) + h**2 + s**2 * u.dot(u)),
        of="IIA.15",
    )
    script.state(
        "IIA.15",
        "Section II A, last paragraph",
        r"\text{``second-order rigidity implies rigidity''}",
        note="for the unfolded state; rigid: no other configurations, modulo motions, nearby",
        rests="IIA.4",
        words="the limit of scaled configurations",
    )
    w, hi, hj = sympy.symbols("w h_i h_j")
    two = script.alter("derivative without its factor", 2, 1)
    script.identity(
        "a left null vector of (2C | d(h_n - h_m)^2) is a self stress sum_v m_v w_v with "
        "sum_v m_v dK_v = 0: rows of the length equations are independent iff the dK_v are",
        sympy.diff(w * (hi - hj) ** 2 / 2, hi) * 2 - two * w * (hi - hj),
        of="IIA.11",
    )
    root: Heights = {0: Fraction(1), 1: Fraction(2), 2: Fraction(-1), 3: Fraction(1), 4: Fraction()}
    flat = dict.fromkeys(root, Fraction(0))
    right = script.alter("the flat state taken for regular", True, False)
    script.cases(
        "full row rank of the length equations iff full row rank of the dK_v (cross: branch, flat)",
        (
            is_solution(CROSS, point)
            and (_length_rank(CROSS, point) == len(CROSS.edges))
            == any(curvature_form(CROSS, 4).functional(point).values())
            == (regular == right)
            for point, regular in ((root, True), (flat, False))
        ),
        of="IIA.11",
    )
    script.state(
        "IIA.11",
        "Section II A, last paragraph",
        r"\text{``a second-order solution may not be a solution at all orders''}",
        note="but a regular solution always is: the length equations divided by t^2 are analytic "
        "with independent rows at t = 0, so the implicit function theorem gives an analytic curve "
        "of true configurations (docs/mathematics.md, 5)",
        code="BranchCount.true_branches",
        cited="the implicit function theorem",
        words="docs/mathematics.md, 5",
    )


def _not_true(script: Script) -> None:
    """A second-order solution of rigid panels without a true motion; the tangent space."""
    shape, inclined = (0, 2, 3, 8), script.alter("the second zigzag parallel to the first", 1, 0)
    points = [
        (Fraction(10 * i + shape[j] + i * inclined * j), Fraction(4 * j))
        for i in range(4)
        for j in range(4)
    ]
    sides = [(4 * i + j, 4 * i + j + 4) for i in range(3) for j in range(4)]
    sides += [(4 * i + j, 4 * i + j + 1) for i in range(4) for j in range(3)]
    found = decompose(PanelPattern(points, sides))
    verdicts = [mode.extends.verdict for mode in found.modes]
    script.counterexample(
        "3 x 3 panels, vertices (10 i + s_j + i j, 4 j) with s = 0, 2, 3, 8: a mode with both "
        "zigzags solves the equations of second order, and its loop of four vertices does not "
        "close at order 3",
        found.second_order == {1: 3, 2: 1}
        and found.true == {1: 2, 2: 1}
        and [m.extends.order for m in found.modes if m.extends.verdict is REFUTED] == [3]
        and len(verdicts) == 5,
        of="IIA.16 IIA.11",
    )
    script.state(
        "IIA.16",
        "Section II A, last paragraph",
        r"\text{``there are (non-triangulated) origami examples where second-order solutions do "
        r"not correspond to points lying in the true configuration space''}",
        note="Remark: cited in the paper; an exact example is two zigzags of one shape, the second "
        "sheared, crossed by straight rows",
        code="decompose",
    )
    lengths = script.alter("all lengths independent at the flat state", False, True)
    patterns = (families.single_vertex(4), families.waterbomb(), families.two_vertex())
    script.cases(
        "first-order motions at the flat state, 3 V - rank - 6, are D + Vi, more than D",
        (
            3 * len(p.vertices) - (len(p.edges) if lengths else rank(rigidity_matrix(p))) - 6
            == p.D + p.Vi
            > p.D
            for p in patterns
        ),
        of="IIC.14",
    )
    script.state(
        "IIC.14",
        "Section II C, after Eq. (Dcount)",
        r"\text{the unfolded configuration is a singular point, ``where the dimension of the "
        r"tangent space exceeds the dimension at other nearby points''}",
        note="Vi >= 1: by IIA.5 the lengths have rank 2 V - 3 there, so that D + Vi first-order "
        "motions are left. Nearby the dimension is at most D where the second-order solutions have "
        "dimension D (convex boundary: IIC.1). Where all of the sheet is a triangulated triangle "
        "there are no other points nearby",
        code="BranchSystem",
        rests="IIA.5 IIC.1",
    )


def _energy(script: Script) -> None:
    """The order of the sum of (|X| - L)^2 along X = U + t^2 u + t h z."""
    t, h, h2, L = sympy.symbols("t h h_2 L", positive=True)
    u = sympy.Matrix(sympy.symbols("u_x u_y"))
    u3 = sympy.Matrix(sympy.symbols("v_x v_y"))
    bend = -(h**2) / (2 * L)  # the second-order condition 2 U.u + h^2 = 0 with U = (L, 0)
    u = u.subs(u[0], bend)

    def order(displacement: sympy.Matrix, height: sympy.Expr) -> int:
        X = sympy.Matrix([L, 0]) + displacement
        error = sympy.Poly(sympy.expand(X.dot(X) + height**2 - L**2), t)
        return 2 * int(min(power for (power,) in error.monoms()))

    expected = script.alter("energy of sixth order", 8, 6)
    script.certificate(
        "squared length errors t^4 |u|^2: |X| - L = t^4 |u|^2 / (2L) + ..., energy of order 8",
        order(t**2 * u, t * h) == expected,
        of="IIA.12",
    )
    script.counterexample(
        "without the in-plane displacement: order 4",
        order(script.alter("in-plane displacement kept", 0, 1) * t**2 * u, t * h) == 4,
        against="IIA.12",
    )
    free = script.alter("no terms of third order", 1, 0)
    script.certificate(
        "with arbitrary terms of third order (and second-order heights): order 6",
        order(t**2 * u + free * t**3 * u3, t * h + free * t**2 * h2) == 6,
        of="IIA.12",
    )
    sign = script.alter("u_4 with the wrong sign", -1, 1)
    fourth = sympy.Matrix([sign * u.dot(u) / (2 * L), 0])
    script.certificate(
        "when the terms t^4 u_4, t^3 h_3 of the true configuration are added: order 12",
        order(t**2 * u + t**4 * fourth, t * h) == 12,
        of="IIA.12",
    )
    script.state(
        "IIA.12",
        "Section II A, last paragraph",
        r"\text{``can only change the stretching energy to at most sixth-order''}",
        r"\text{with the in-plane displacements that belong to them they change the stretching "
        r"energy at eighth order, and without them at fourth}",
        "along X = U + t^2 u + t h z the energy is t^8 sum |u_n - u_m|^4 / (4 L^2) to lowest "
        "order. Remark: it is of sixth order if arbitrary terms of third order are added, and of "
        "fourth if the displacements are vertical only",
        severity=Severity.CONSTANT,
    )


def _fold_angles(script: Script) -> None:
    """To first order the fold angles are linear functions of the heights, and determine them."""
    a, b, c, d = (sympy.Matrix(sympy.symbols(f"{n}_x {n}_y {n}_z")) for n in "abcd")
    e, f, g = b - a, c - a, d - a
    normals = e.cross(f).cross(g.cross(e))
    triple = sympy.Matrix.hstack(e, f, g).det()
    sign = script.alter("volume with the wrong sign", 1, -1)
    script.identity(
        "the normals of two faces at the fold e satisfy (e x f) x (g x e) = -det(e, f, g) e",
        *(normals + sign * triple * e),
        of="IIA.13",
    )
    free = script.alter("a position in the plane free too", 2, 0)
    script.certificate(
        "over fixed plane positions det(e, f, g) is linear in the four heights",
        sympy.Poly(triple, a[free], b[2], c[2], d[2]).total_degree() == 1,
        of="IIA.13",
    )
    motions = script.alter("six rigid motions of the heights", 3, 6)
    injective = []
    for pattern in (families.two_vertex(), families.waterbomb(), families.hypar(1)):
        rows = []
        for fold in pattern.folds:
            functional = fold_functional(pattern, fold)
            rows.append([functional.get(v, 0) for v in range(len(pattern.vertices))])
        injective.append(rank(rows) == len(pattern.vertices) - motions)
    script.cases(
        "the bends of all folds vanish only on affine heights (rank V - 3)", injective, of="IIA.13"
    )
    script.state(
        "IIA.13",
        "Section II A, second paragraph",
        r"\text{``one can linearize the fold angles as functions of the displacements''}",
        note="Remark: the linear map is injective modulo rigid motions: a piecewise linear "
        "function on a disk without bends is affine, so branches look alike in both coordinates",
        code="fold_functional",
    )


def _length_rank(pattern: CreasePattern, heights: Heights) -> int:
    """Rank of the length equations divided by t^2, in (u, h), at t = 0."""
    rows = []
    for row, (i, j) in zip(rigidity_matrix(pattern), pattern.edges, strict=True):
        vertical = [Fraction(0)] * len(pattern.vertices)
        vertical[i], vertical[j] = heights[i] - heights[j], heights[j] - heights[i]
        rows.append([*row, *vertical])
    return rank(rows)


if __name__ == "__main__":
    sys.exit(run(prove()))
