"""Multiplicity of triangulated triangles, and the number of distinct branches (Section III A).

Multiplicity theorem. Let m vertices lie inside triangulated triangles and w be their heights over
the planes of the corners, y the other heights in a chart. The m inner forms G(w) have only w = 0 in
common (definite stress), so they are a regular sequence and A = Q[w] / (G) is a local ring of
length 2^m. Modulo w the other forms F(y, w) are the forms F(y, 0) of the pattern without rigid
parts. If these have an isolated zero y0 of multiplicity k, they are a regular sequence on the
closed fibre of the flat A-algebra A[y], hence on A[y] near y0, with a flat quotient: (y0, 0) has
multiplicity 2^m k.

Theorem 3 (docs/theorem.md) says more: every multiplicity is 2^|F|, F the vertices whose star is
flat. It is compared here with Groebner bases and dual spaces, which know nothing of it.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field

from exactfold import CreasePattern
from exactfold.branches import count_branches
from exactfold.exact.linalg import inertia, nullspace
from exactfold.pattern import families
from exactfold.rigidity import BranchSystem, QuadraticSystem
from exactfold.rigidity.definite_stresses import disk_multipliers
from exactfold.rigidity.equations.branch_system import Chart, notch_chart
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.solve import groebner
from exactfold.solve.algebraic.exact_solution import ExactSolution, RootClass
from proofs.branch_counts import OCTAHEDRON, SQUARE, TWISTED, gram, inner_points, restricted
from proofs.chambers import jacobian
from proofs.dual_space import dual_space, taylor_expansions, unit_rank
from proofs.formulas import Names
from proofs.framework import Proof, Script, run
from proofs.patterns import degenerate_patterns, grid_quadrilaterals
from proofs.potential import corner_polar
from proofs.statements import Severity

NAME = "multiplicity"
TITLE = "Multiplicities and the number of distinct branches"

HUB = (Fraction(3, 7), Fraction(5, 9))


def prove(change: str | None = None) -> Proof:
    """Multiplicities are 2^Vt times those without rigid parts, and 2^(number of flat vertices)."""
    script = Script(
        NAME,
        TITLE,
        ("four boundary vertices; finitely many roots without rigid parts (docs/theorem.md)",),
        change,
    )
    _multiplicity(script)
    _flat_star(script)
    _transversality(script)
    _theorem_3(script)
    return script.proof()


def _multiplicity(script: Script) -> None:
    """The factor 2^Vt of rigid parts, and the number of distinct branches."""
    inner = CreasePattern(
        [(0, 0), (9, 0), (0, 9), *inner_points((0, 0), (9, 0), (0, 9))], OCTAHEDRON
    )
    for pattern, m in ((families.single_vertex(3), 1), (inner, 3), (TWISTED, 3)):
        forms = [restricted(pattern, v, pattern.interior) for v in pattern.interior]
        zero = Fraction(0)
        system = QuadraticSystem.from_rational(
            [[[*row, zero] for row in form] + [[zero] * (m + 1)] for form in forms]
        )
        solution = groebner(system)
        script.certificate(
            f"{m} inner forms: complete intersection, one zero of multiplicity 2^{m}",
            [c.multiplicity for c in solution.classes]
            == [2 ** script.alter(f"length of the inner ring, {pattern.sha256[:6]}", m, m + 1)],
            of="T.3",
        )
    octahedron = [tuple((0, 1, 4, 5, 6, 7)[k] for k in t) for t in OCTAHEDRON]
    wheel = [(1, 2, 4), (2, 3, 4), (3, 0, 4)]
    rigid = CreasePattern([*SQUARE, HUB, *inner_points((0, 0), (1, 0), HUB)], [*wheel, *octahedron])
    third = CreasePattern(
        [*SQUARE, HUB, (Fraction(1, 2), Fraction(1, 5))],
        [*wheel, (0, 1, 5), (1, 4, 5), (4, 0, 5)],
    )
    factor = script.alter("multiplicities not multiplied", 2, 1)
    script.certificate(
        "whole systems: hub and octahedron 2 roots of multiplicity 8, hub and degree-3 vertex 2 "
        "of 2",
        _multiplicities(rigid) == [factor**3] * 2 and _multiplicities(third) == [factor] * 2,
        of="T.3 IIIA.13",
    )
    flat = families.flat_vertex_square()
    extra = CreasePattern(
        [*flat.vertices, (Fraction(17, 30), Fraction(1, 15))],
        [*(t for t in flat.triangles if set(t) != {0, 1, 5}), (0, 1, 6), (1, 5, 6), (5, 0, 6)],
    )
    script.counterexample(
        "flat-vertex square: 3 roots of multiplicities 1, 1, 2, not 4; with a degree-3 vertex "
        "added "
        "2, 2, 4: twice those of the pattern without rigid parts, not all 2^Vt = 2",
        _multiplicities(flat) == [1, 1, 2]
        and _multiplicities(extra) == [factor * k for k in (1, 1, 2)]
        and (flat.Vi, flat.Vt, extra.Vt) == (2, 0, 1),
        of="IIIA.13",
        against="IIIA.12",
    )
    script.formula(
        "IIIA.12",
        "Section III A, Eq. (B distinct)",
        r"B_{distinct}=2^{V_i-V_t}",
        r"\sum_b2^{|F_b|}=2^{V_i},\quad B_{distinct}\le2^{V_i-V_t}\text{, where }b\text{ are the "
        r"distinct branches and }F_b\text{ the vertices that are flat on }b\text{; equality iff "
        r"these are those in triangulated triangles on every branch}",
        at=map(
            _with_flat_vertices,
            (
                families.two_vertex(),
                families.flat_octahedron_in_square(),
                families.flat_vertex_square(),
            ),
        ),
        note="called conjectural in the paper, and not restricted to generic patterns. Square with "
        "inner vertices (1/2,1/2), (7/10,1/5), triangles 015, 125, 245, 405, 234, 304: Vt = 0 "
        "and 3 branches. Remark: a straight crease path is the usual cause",
        code="BranchCount.distinct",
        equation="10",
        severity=Severity.CONDITION,
        rests="T.3",
    )
    script.state(
        "IIIA.13",
        "Section III A, before Eq. (B distinct)",
        r"\text{``the distinct roots of the quadratic equations had multiplicity }2^{V_t}\text{''}",
        note="reports the systems found; in general 2^|F|, F the vertices that are flat on the "
        "branch (docs/theorem.md, Theorem 3), that is 2^Vt times the multiplicity in the pattern "
        "without rigid parts. The square of IIIA.12 with a degree-3 vertex (17/30, 1/15) in 015 "
        "has multiplicities 2, 2, 4",
        code="Branch.multiplicity",
    )


def _with_flat_vertices(pattern: CreasePattern) -> Names:
    """The names in the count of distinct branches; `F_b` is a number of vertices."""
    branches = count_branches(pattern, method="groebner").branches
    flat = [list(branch.vertex_signs.values()).count(0) for branch in branches]
    return {
        "V_i": pattern.Vi,
        "V_t": pattern.Vt,
        "B_distinct": len(branches),
        "all": range(len(branches)),
        "F": flat.__getitem__,
    }


def _multiplicities(pattern: CreasePattern) -> list[int]:
    """The multiplicities of all roots of the branch system of the whole pattern, sorted."""
    classes = groebner(BranchSystem(pattern).chart.system).classes
    return sorted(c.multiplicity for c in classes for _ in range(c.degree))


def _flat_star(script: Script) -> None:
    """If the star of v is flat in h, then K_v(h, .) = 0 and K_v(h + w) = K_v(w)."""
    _, *z = field("d1 d2 e1 e2 g1 g2 x y", QQ)
    d, e, g, x, y = (z[0], z[1]), (z[2], z[3]), (z[4], z[5]), z[6], z[7]

    def end(spoke: tuple[Any, Any], slope: Any) -> Any:
        turned = g[1] * spoke[0] - g[0] * spoke[1]
        return turned * slope / (2 * (spoke[0] ** 2 + spoke[1] ** 2))

    sign = script.alter("the ends of a face added, not subtracted", 1, -1)
    at_d, at_e = (g[0] * spoke[0] + g[1] * spoke[1] for spoke in (d, e))
    script.identity(
        "on a face where h has the gradient g the corner of K_v(h, w) is [(g.Jd) x/|d|^2 - "
        "(g.Jd') x'/|d'|^2]/2; with one g for the whole star the sum is 0: K_v(h, .) = 0",
        corner_polar(d, e, at_d, at_e, x, y) - end(d, x) + sign * end(e, y),
        of="T.3 IIC.13",
    )


def _transversality(script: Script) -> None:
    """Hypersurfaces that touch along all branches, for an open set of sheets."""
    sheet = families.flat_octahedron_in_square()
    inside = [7, 8, 9]
    weights = {}  # of the corners at an inner vertex
    for v in inside:
        points = [(Fraction(1), *sheet.vertices[u]) for u in (4, 5, 6, v)]
        ((*mixed, last),) = nullspace([list(row) for row in zip(*points, strict=True)])
        weights[v] = [-w / last for w in mixed]
    free = script.alter("heights that bend the triangle", range(7), range(10))
    outcomes = []
    for k in free:
        heights = {v: Fraction(v == k) for v in range(7)}
        for v in inside:
            plane = sum(w * heights[c] for w, c in zip(weights[v], (4, 5, 6), strict=True))
            heights[v] = Fraction(plane) + (v == k)
        rows = jacobian(sheet, heights)
        outcomes.append(not any(any(row) for row in rows[3:]))
    script.counterexample(
        "flat octahedron in a square: wherever its triangle is flat, as on all branches, the "
        "differentials of the forms of its three inner vertices are 0",
        all(outcomes) and sheet.interior[3:] == (7, 8, 9),
        against="IIC.13",
    )
    script.state(
        "IIC.13",
        "Section II C, after Eq. (Dcount)",
        r"\text{``the hypersurfaces arising from Eq. (\ref{eq:compat}) for each of the "
        r"}V_i\text{ internal vertices intersect transversely'' \dots\ ``This should be "
        r"true generically, and in all of the numerical examples considered in this paper "
        r"this is indeed the case''}",
        r"\text{for a convex border, transversely along a branch iff no vertex star is flat on it; "
        r"for any border nowhere where }V_t>0",
        "triangulated triangles persist under small changes, and the paper's samples hold four. "
        "Remark: the dimension is D all the same for a convex border (IIC.1); nonsingular where no "
        "star is flat: docs/theorem.md, Theorem 2 (c), which is about convex borders; that generic "
        "patterns without triangulated triangles have no flat stars is not used here",
        "BranchSystem",
        severity=Severity.CONDITION,
        words="docs/theorem.md, Theorem 2 (c)",
    )


@lru_cache(maxsize=1)
def _solved() -> list[tuple[CreasePattern, Functionals, ExactSolution]]:
    """Degenerate quadrilaterals, convex and reflex, each in a chart with all its branches."""
    found = []
    for pattern in [*degenerate_patterns().values(), *grid_quadrilaterals(60, 4)]:
        chart = BranchSystem(pattern).chart if pattern.is_convex else notch_chart(pattern)
        found.append((pattern, Functionals(chart), groebner(chart.system)))
    return found


def _theorem_3(script: Script) -> None:
    script.state(
        "T.3",
        "docs/theorem.md, Theorem 3",
        r"\mu(h)=2^{|F|},\ F=\{v:\text{the star of }v\text{ is flat in }h\}",
        note="convex boundary, right-hand sides k_v >= 0; quadrilaterals with a reflex corner in "
        "the closed sheet. So the sum of 2^|F| over all branches is 2^Vi",
        code="Branch.multiplicity",
        words="docs/theorem.md, Theorem 3",
    )
    more = script.alter("one flat vertex too many", 0, 1)
    fewer = script.alter("only vertices in triangulated triangles counted", False, True)
    linear = script.alter("order one at flat vertices", 2, 1)
    outcomes: dict[str, list[bool]] = {"sum": [], "groebner": [], "dual": [], "initial": []}
    for pattern, functionals, solution in _solved():
        total = 0
        for root_class in solution.classes:
            flat = {v for v, row in functionals.vertices.items() if root_class.vanishes(row)}
            flat = flat & pattern.rigid_vertices if fewer else flat
            expected = 2 ** (len(flat) + more)
            total += root_class.degree * expected
            outcomes["groebner"].append(root_class.multiplicity == expected)
            dual = dual_space(solution.system, root_class, expected + 1)
            outcomes["dual"].append(dual.is_complete and dual.dimension == expected)
            gradients = [
                {a: c for a, c in terms.items() if sum(a) == 1}
                for terms in taylor_expansions(solution.system, root_class)
            ]
            order_two = {v for v, g in zip(pattern.interior, gradients, strict=True) if not g}
            rank = unit_rank(root_class.polynomial, gradients)
            independent = rank == pattern.Vi - len(flat) * (linear - 1)
            outcomes["initial"].append(order_two == flat and independent)
        outcomes["sum"].append(total == 2**pattern.Vi)
    script.cases(
        "the sum of 2^|F| over all branches is 2^Vi (exact zero tests)",
        outcomes["sum"],
        of="T.3 IIIA.12",
    )
    script.cases(
        "the multiplicity from a Groebner basis is 2^|F|, by class of roots",
        outcomes["groebner"],
        of="T.3",
    )
    script.cases("the dual space is complete, of dimension 2^|F|", outcomes["dual"], of="T.3")
    script.cases(
        "the equations of F are of order 2, the linear parts of the others independent",
        outcomes["initial"],
        of="T.3",
    )
    sign = script.alter("multipliers with the wrong sign", 1, -1)
    script.cases(
        "at rational branches of convex sheets: sum_F m_v K_v is positive definite on N, of "
        "dimension |F|, and the forms of F on N have one zero, of multiplicity 2^|F|",
        (
            _initial_forms(pattern, functionals.chart, root_class, sign)
            for pattern, functionals, solution in _solved()
            for root_class in solution.classes
            if pattern.is_convex and root_class.degree == 1 and root_class.multiplicity > 1
        ),
        of="T.3",
    )


def _initial_forms(pattern: CreasePattern, chart: Chart, root: RootClass, sign: int) -> bool:
    """The proof at one branch; N is the kernel of the linear forms of vertices not flat there."""
    heights = chart.heights([x[0] if x else Fraction(0) for x in root.coordinates])
    rows = jacobian(pattern, heights)
    flat = [v for v, row in zip(pattern.interior, rows, strict=True) if not any(row)]
    basis = nullspace(rows)
    multipliers = disk_multipliers(pattern)
    size = len(basis)
    total = [[Fraction(0)] * size for _ in basis]
    forms = []
    for v in flat:
        form = gram(restricted(pattern, v, pattern.interior), basis)
        for i, j in product(range(size), repeat=2):
            total[i][j] += sign * multipliers[v] * form[i][j]
        forms.append([[*row, Fraction(0)] for row in form] + [[Fraction(0)] * (size + 1)])
    if len(flat) != size or inertia(total) != (size, 0, 0):
        return False
    classes = groebner(QuadraticSystem.from_rational(forms)).classes
    return [c.multiplicity for c in classes] == [2**size]


if __name__ == "__main__":
    sys.exit(run(prove()))
