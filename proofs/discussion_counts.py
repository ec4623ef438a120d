"""Freedoms and orthogonality: the Discussion (Section V)."""

from __future__ import annotations

import random
import sys
from collections.abc import Mapping
from fractions import Fraction
from functools import cache
from math import factorial
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.exact import QuadraticForm
from exactfold.exact.linalg import from_fmpq, inertia, nullspace, to_flint
from exactfold.pattern import families
from exactfold.rigidity import curvature_form
from exactfold.rigidity.functionals import fold_functional
from proofs.framework import Proof, Script, run
from proofs.statements import Severity
from proofs.vertex_forms import star

NAME = "discussion_counts"
TITLE = "Counts of the Discussion"

WIDE = star((1, 0), (0, 1), (-2, -1), (-1, -2), (1, -1))


def prove(change: str | None = None) -> Proof:
    """Rigid folds, and gradients that are orthogonal to all branches except one."""
    script = Script(NAME, TITLE, ("a triangulated disk with Vi, Ve vertices",), change)
    _rigid_folds(script)
    _orthogonality(script)
    return script.proof()


def _rigid_folds(script: Script) -> None:
    """The number D for origami that is not triangulated."""
    wheel = families.single_vertex(5)
    gram = _restricted(curvature_form(wheel, 5), fold_functional(wheel, (0, 5)))
    rigid = script.alter("D = Ve - 4 - E", 3, 4)
    script.counterexample(
        "a vertex of degree 5 with one fold made rigid: inertia (1, 1, 3), two lines, D = 1 = 5 - "
        "3 - 1",
        inertia(gram) == (1, 1, 3) and wheel.Ve - rigid - 1 == 1,
        against="V.1",
    )
    wide = curvature_form(WIDE, 5), fold_functional(WIDE, (1, 5))
    script.counterexample(
        "spokes (1,0), (0,1), (-2,-1), (-1,-2), (1,-1), the fold (0,1) between angles of sum > pi "
        "made rigid: inertia (0, 2, 3), so D = 0 and not 1",
        inertia(_restricted(*wide))
        == script.alter("a wide rigid face folds", (0, 2, 3), (1, 1, 3)),
        of="V.1",
    )
    side = 4
    points = [(x, y) for y in range(side + 1) for x in range(side + 1)]
    corners = [y * (side + 1) + x for y in range(side) for x in range(side)]
    triangles = [
        t for a in corners for t in ((a, a + 1, a + side + 2), (a, a + side + 2, a + side + 1))
    ]
    grid = CreasePattern(points, triangles)
    heights = {v: Fraction(abs(x - 2)) for v, (x, _) in enumerate(points)}
    diagonals = [(a, a + side + 2) for a in corners]
    flat = all(
        sum(w * heights[v] for v, w in fold_functional(grid, e).items()) == 0 for e in diagonals
    )
    script.counterexample(
        "4 x 4 squares: Ve - 3 - E = 16 - 3 - 16 < 0, and yet the sheet folds along a straight "
        "line",
        all(curvature_form(grid, v)(heights) == 0 for v in grid.interior)
        and flat
        and grid.Ve - 3 - len(diagonals) < script.alter("the formula is not negative", 0, -3),
        against="V.2",
    )
    extra = script.alter("a third triangle closes the notch", [(6, 3), (3, 6)], [(6, 3), (6, 6)])
    number = {p: v for v, p in enumerate(points)}
    first, second, hub = len(points), len(points) + 1, number[4, 4]
    flap = CreasePattern(
        [*points, *extra],
        [
            *triangles,
            (number[4, 3], first, hub),
            (first, second, hub),
            *([(second, number[3, 4], hub)] if extra[1] == (3, 6) else []),
        ],
    )
    form = curvature_form(flap, hub) if hub in flap.interior else None
    raised = [{v: Fraction(v == k) for v in range(len(flap.vertices))} for k in (first, second)]
    script.counterexample(
        "4 x 4 squares with two vertices (6,3), (3,6) and three triangles more round the corner "
        "(4,4): Ve - 3 - E = 17 - 3 - 16 < 0; with all squares flat the corner has a form of "
        "inertia (1, 1), two lines, and so has every sheet nearby",
        form is not None
        and inertia([[form.polar(a, b) for b in raised] for a in raised]) == (1, 1, 0)
        and flap.Ve - 3 - len(diagonals) == -2,
        against="V.2",
    )
    state = script.state
    script.formula(
        "V.1",
        "Section V, non-triangulated origami",
        r"D=V_e-4-E",
        r"D=V_e-3-E",
        at=_rigidified(),
        note="E = 0 must give Eq. (Dcount); a vertex of degree 5 with one rigid fold has D = "
        "1. Remark: like "
        "Eq. (Dcount) a count of equations: D can be larger (V.2), and smaller, if a rigid fold "
        "lies between angles of sum > pi: spokes (1,0), (0,1), (-2,-1), (-1,-2), (1,-1), fold "
        "(0,1), D = 0",
        severity=Severity.CONSTANT,
        rests="IIC.1",
    )
    state(
        "V.2",
        "Section V, non-triangulated origami",
        r"\text{``When this formula becomes negative \dots\ we instead take }D=0\text{''}",
        note="D can be positive when the formula is negative, for generic patterns, "
        "too: the formula adds up a part with too many constraints and one with too few. 4 x 4 "
        "unit squares with (6,3) and (3,6) joined to the corner (4,4), to each other and to the "
        "ends of its sides: Ve - 3 - E = -2 (as printed: -3), but the corner has four folds and "
        "moves while all squares stay flat, also after small changes of all vertices. "
        "Remark: the 4 x 4 squares alone (-3) fold along a straight line",
        severity=Severity.CLAIM,
    )
    state(
        "V.8",
        "Section V, non-triangulated origami",
        r"\text{``triangulate the origami, then add additional quadratic constraints to rigidify "
        r"certain folds''}",
        note="Remark: a bar across the fold: with it the two faces carry one self stress, whose "
        "equation (compat) is the square of the bend. The linear equation, bend = 0, says the same "
        "and counts no solution twice",
        code="fold_functional",
    )
    *ends, h1, h2, h3, h4 = sympy.symbols("x1 y1 x2 y2 x3 y3 x4 y4 h1:5")
    corners_ = [ends[2 * k : 2 * k + 2] for k in range(4)]

    def area(k: int) -> sympy.Expr:
        """The signed area of the triangle without corner k, with alternating sign.

        These areas are the coefficients of an affine dependency.
        """
        rows = [[1, *corners_[j]] for j in range(4) if j != k]
        return (-1) ** k * sympy.Matrix(rows).det()

    w, lift = [area(k) for k in range(4)], (h1, h2, h3, h4)
    bar = script.alter("the bar left out", 1, 0)
    pairs = [(i, j) for j in range(4) for i in range(j)]
    stress = {(i, j): w[i] * w[j] * (bar if (i, j) == (2, 3) else 1) for i, j in pairs}
    script.identity(
        "four points with all six bars carry the stress w_i w_j, w an affine dependency, and sum "
        "w_i w_j (h_i - h_j)^2 = -(sum w_i h_i)^2",
        sum(w),
        *(sum(x * p[k] for x, p in zip(w, corners_, strict=True)) for k in range(2)),
        *(
            sum(
                stress[min(i, j), max(i, j)] * (corners_[j][k] - corners_[i][k])
                for j in range(4)
                if j != i
            )
            for i in range(4)
            for k in range(2)
        ),
        sum(s * (lift[i] - lift[j]) ** 2 for (i, j), s in stress.items())
        + sum(x * h for x, h in zip(w, lift, strict=True)) ** 2,
        of="V.8",
    )


def _restricted(form: QuadraticForm, weights: Mapping[int, int | Fraction]) -> list[list[Fraction]]:
    """The Gram matrix of a form on the space where a functional vanishes."""
    kernel = nullspace([[Fraction(weights.get(v, 0)) for v in form.labels]])
    basis = [dict(zip(form.labels, row, strict=True)) for row in kernel]
    return [[form.polar(a, b) for b in basis] for a in basis]


def _orthogonality(script: Script) -> None:
    """Gradients that are orthogonal to all branches except one."""
    branches = count_branches(families.two_vertex()).branches
    rows = [[h for _, h in sorted(b.heights.items()) if any(h)] for b in branches]
    rows[3] = rows[script.alter("one branch counted twice", 3, 0)]
    triples = [[rows[i] for i in range(4) if i != k] for k in range(4)]
    script.example(
        "two vertices: any three of the four branches span R^3 (determinants of enclosures), so a "
        "gradient orthogonal to three undesired branches is orthogonal to the fourth",
        all(len(t[0]) == 3 and _independent(t) for t in triples),
        of="V.5",
    )
    spans = script.alter("no two spanning sets", 2, 3)
    script.cases(
        "random squares with Vi = 3, 4, 5: two disjoint sets of Vi + 1 branches are independent, "
        "so all branches but any one span the space of foldings",
        (_spanning_sets(n, seed) >= spans for n in (3, 4, 5) for seed in range(4)),
        of="V.5",
    )
    least = script.alter("an obstruction already for one vertex", 2, 1)
    script.example(
        "2^V - 1 >= V + 1 exactly for V >= 2 (2^(V+1) - 2^V = 2^V >= 1: by induction)",
        2**least - 1 >= least + 1 and 2 ** (least - 1) - 1 < least,
        of="V.5",
    )
    special = count_branches(families.flat_vertex_square(), method="groebner")
    script.counterexample(
        "the square with a flat vertex: two undesired branches do not span R^3",
        special.distinct == script.alter("four branches there", 3, 4),
        against="V.5",
    )
    folds = script.alter("printed number of folds", 1, 3)
    script.cases(
        "3 Vi + 1 folds",
        (
            len(p.folds) == 3 * p.Vi + folds
            for p in (families.two_vertex(), families.hypar(1), families.h1_sequence(5))
        ),
        of="V.3",
    )
    state = script.state
    state(
        "V.3",
        "Section V",
        r"\text{``in a triangulation, the number of internal folds is "
        r"}N_F=3V_i+const\text{''}",
        note="const = Ve - 3 = 1 for four boundary vertices",
    )
    state(
        "V.4",
        "Section V",
        r"\sum_{i=1}^{N_F}\frac{\partial E}{\partial\theta_i}\cdot\Delta\theta_i\ge0\text{ "
        r"\dots\ ``must then be perpendicular to all undesired branches''}",
        note="Remark: x >= 0 and -x >= 0 give x = 0",
        equation="12",
        words="x >= 0 and -x >= 0",
    )
    state(
        "V.5",
        "Section V",
        r"\text{``the number of internal folds is }N_F=3V_i+const\text{ with our finding "
        r"that the number of branches is }2^{V_i}\text{, we have thus shown that it is "
        r"impossible to satisfy the above orthogonality constraint''}",
        r"\text{impossible wherever the }2^{V_i}-1\text{ undesired branches span the }(V_i+1)"
        r"\text{-dimensional space of foldings}",
        note="the two numbers alone do not show it, as many vectors can lie in a hyperplane. That "
        "generic patterns with Vi >= 2 have such branches is tested, not proved. The square with a "
        "flat vertex has two undesired branches in R^3, and there it is possible",
        severity=Severity.CLAIM,
    )
    theta, target, k = sympy.symbols("theta target k")
    pull = script.alter("gradient with the wrong sign", -1, 1)
    script.identity(
        "the gradient of (1/2) k (theta - target)^2 at the unfolded state is -k target",
        sympy.diff(k * (theta - target) ** 2 / 2, theta).subs(theta, 0) - pull * k * target,
        of="V.6",
    )
    octahedron = families.flat_octahedron_in_square()
    script.counterexample(
        "Vi = 6 with a flat octahedron: 8 branches, an open set of geometries; without: 64",
        count_branches(octahedron).distinct == 2 ** (6 - octahedron.Vt) == 8
        and octahedron.Vi == script.alter("six interior vertices", 6, 3),
        of="V.7",
    )
    state(
        "V.6",
        "Section V, first displayed formula",
        r"E[x]=\frac12\sum_{(n,m)}k_{(n,m)}(\theta_{(n,m)}-\bar\theta_{(n,m)})^2",
        note="Remark: a definition: a weighted squared distance, with gradient -k theta-bar when "
        "unfolded",
        equation="11",
    )
    state(
        "V.10",
        "Section V, first paragraph",
        r"\text{``setting the equilibrium dihedral angle of each fold to a nonzero value''}",
        r"\text{the equilibrium folding angle, the deviation of the dihedral angle from }\pi",
        note="the dihedral angle of a fold is pi in the unfolded state, so that it is not 0 "
        "anyway. Remark: the formula that follows has folding angles, which are 0 there",
        severity=Severity.TYPO,
        contradiction="unfolded if all dihedral angles are pi (Section II A), and the folding "
        "angle in the first displayed formula of Section V",
    )
    state(
        "V.7",
        "Section V",
        r"\text{``in generic triangulated patterns with }D=1\text{, the number of branches "
        r"depends only on }V_i\text{ and not the geometry''}",
        note="with multiplicity, as in the definition of B. The number of distinct branches "
        "depends on Vi - Vt, and triangulated triangles persist under small changes of the "
        "vertices",
    )


def _independent(rows: list[list[tuple[Fraction, Fraction]]]) -> bool:
    """Whether the determinant of a square matrix of intervals cannot vanish.

    It differs from the determinant of the midpoints by at most n! n r M^(n-1), where r bounds the
    radii and M the entries.
    """
    size = len(rows)
    middle = [[(low + high) / 2 for low, high in row] for row in rows]
    radius = max(high - low for row in rows for low, high in row)
    largest = 1 + max(abs(x) for row in middle for x in row)
    error = factorial(size) * size * radius * largest ** (size - 1)
    return bool(abs(from_fmpq(to_flint(middle).det())) > error)


@cache
def _spanning_sets(interior: int, seed: int) -> int:
    """The number of disjoint spanning sets of branches that a search finds: 2, or else 0."""
    pattern = random_square(interior, seed)
    branches = count_branches(pattern).branches
    rows = [[h for _, h in sorted(b.heights.items()) if any(h)] for b in branches]
    source, size = random.Random(1), pattern.Vi + 1
    for _ in range(50):
        source.shuffle(rows)
        if _independent(rows[:size]) and _independent(rows[size : 2 * size]):
            return 2
    return 0


def _rigidified() -> list[dict[str, Any]]:
    """The freedoms of single vertices, by null cones; the first fold is rigid (E = 1) or free."""
    found = []
    for n in (5, 6, 7):
        wheel = families.single_vertex(n)
        form, fold = curvature_form(wheel, n), fold_functional(wheel, (0, n))
        for rigid in (0, 1):
            positive, negative, _ = inertia(_restricted(form, fold if rigid else {}))
            found.append({"D": positive + negative - 1, "V_e": n, "E": rigid})
    return found


if __name__ == "__main__":
    sys.exit(run(prove()))
