"""Branch counts of Section II C: single vertices, rigid triangles, components for D >= 2."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from fractions import Fraction
from math import isqrt
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from exactfold import CreasePattern
from exactfold.branches import count_branches
from exactfold.exact.linalg import inertia
from exactfold.pattern import families
from exactfold.rigidity import BranchSystem, curvature_form, definite_stress
from exactfold.rigidity.functionals import fold_functional
from proofs.framework import Proof, Script, run
from proofs.statements import Severity

NAME = "branch_counts"
TITLE = "Single vertices, triangulated triangles, components"

Point = tuple[Fraction | int, Fraction | int]
SQUARE: list[Point] = [(0, 0), (1, 0), (1, 1), (0, 1)]

TWISTED = CreasePattern(
    [(0, 0), (4, 0), (0, 4), (1, 1), (2, 1), (1, 2)],
    [(3, 4, 5), (0, 1, 4), (1, 2, 5), (2, 0, 3), (0, 4, 3), (1, 5, 4), (2, 3, 5)],
)
"""A triangle around a parallel triangle, the three trapezoids cut by diagonals 04, 15, 23."""

TWO_CONES = CreasePattern(
    [(6, 0), (5, -5), (-4, -4), (-6, 4), (-6, 6), (0, 0), (1, 2)],
    [(0, 5, 1), (1, 5, 2), (2, 5, 6), (6, 5, 0), (2, 6, 3), (3, 6, 4), (4, 6, 0)],
)
"""Five boundary vertices, vertex 5 of degree four and vertex 6 of degree five; no crosses."""


def prove(change: str | None = None) -> Proof:
    """Count the branches of the simplest patterns, and show what a branch is for D >= 2."""
    script = Script(
        NAME, TITLE, ("curvature forms have inertia (1, N - 3, 3) (Appendix C)",), change
    )
    _single_vertex(script)
    _rigid_triangles(script)
    _components(script)
    _linear_branches(script)
    return script.proof()


def _single_vertex(script: Script) -> None:
    """The null cone of one vertex: only 0, then two lines, then one double cone, as N grows."""
    found = [count_branches(families.single_vertex(n)).distinct for n in range(3, 9)]
    script.example(
        "branches of a vertex with N = 3, 4, 5, 6, 7, 8 folds: 0, 2, 1, 1, 1, 1",
        found == [0, script.alter("one branch for N = 4", 2, 1), 1, 1, 1, 1],
        of="IIC.5 IIIA.10",
        against="IIC.5",
    )
    positive = script.alter("two positive directions", 1, 2)
    script.example(
        "modulo planes the form is Lorentzian on R^(N-2), its null cone in RP^(N-3) is the sphere "
        "S^(N-4): empty for N = 3, two points for N = 4, connected from N = 5 on",
        all(
            curvature_form(families.single_vertex(n), n).inertia == (positive, n - 2 - positive, 3)
            for n in range(3, 10)
        ),
        of="IIC.5 IIC.6",
    )
    conical = families.single_vertex(5)
    script.example(
        "five folds: Vi = 1, D = 2, three free heights",
        (conical.Vi, conical.D, len(BranchSystem(conical).variables))
        == (1, 2, 5 + 1 - script.alter("two pinned heights", 3, 2)),
        of="IIC.6",
    )
    script.state(
        "IIC.5",
        "Section II C, last paragraph",
        r"\text{``single-vertex origami structures have a single branch''}",
        r"\text{with five or more folds; there is no branch for }N=3,\text{ and there are two for }"
        r"N=4",
        "Section III B says itself that a 4-fold vertex has two branches",
        "count_branches",
        severity=Severity.CONSTANT,
    )
    script.state(
        "IIC.6",
        "Section II C and Fig. (conical)",
        r"\text{``where }V_i=1,D=2\text{, the branch is a double cone over a closed curve "
        r"in }\mathbb{RP}^2\text{'' \dots\ ``The axes correspond to the vertical "
        r"displacements of the three vertices labeled }4\text{--}6\text{''}",
    )
    script.state(
        "IIIA.10",
        "Section III A",
        r"\text{``3-fold vertices \dots\ are always rigid''}",
        note="Remark: the form of a vertex with N = 3 is definite modulo planes",
    )
    schematic = count_branches(families.two_vertex())
    halved = script.alter("one branch for each pair of sign patterns", 0, 1)
    script.example("two vertices: 2^2 branches", schematic.distinct == 2 ** (2 - halved), of="I.2")
    script.state(
        "I.2",
        "Introduction, Fig. (schematic)",
        r"\text{``In this example, }D=1\text{ so the configuration space is locally "
        r"curve-like almost everywhere; yet, }B=4\text{, which can be seen as four distinct "
        r"one-dimensional branches''}",
        note="for our coordinates; the paper gives none",
        code="families.two_vertex",
    )


def _rigid_triangles(script: Script) -> None:
    """Sheets with Ve = 3 are rigid: definite stresses, Schlegel diagrams, chords."""
    octahedron = CreasePattern(
        [(0, 0), (9, 0), (0, 9), *inner_points((0, 0), (9, 0), (0, 9))], OCTAHEDRON
    )
    triangles = [families.single_vertex(3), TWISTED, octahedron]
    freedom = script.alter("D = Ve - 4", 3, 4)
    script.example(
        "definite stresses of triangulated triangles (every convex boundary has one: "
        "docs/mathematics.md, 6): D = 0 and no folding to second order, hence rigid",
        all(p.D == p.Ve - freedom == 0 and definite_stress(p) is not None for p in triangles)
        and all(count_branches(p).distinct == 0 for p in triangles),
        of="IIC.7",
    )
    bends: dict[int, int] = {}
    sign = script.alter("a diagonal bent the other way", 1, -1)
    for fold, s in (((0, 4), 1), ((1, 5), 1), ((2, 3), sign)):
        for v, w in fold_functional(TWISTED, fold).items():
            bends[v] = bends.get(v, 0) + s * w
    script.counterexample(
        "twisted triangle: the bends of the three diagonals add up to 0 identically, so no lifting "
        "makes all folds valleys: it is no Schlegel diagram",
        not any(bends.values()),
        against="IIC.8",
    )
    script.state(
        "IIC.7",
        "Section II C, Ve = 3",
        r"\text{``Our count }D=0\text{ suggests that these should have 0 degrees of "
        r"freedom, i.e. that they should be rigid'' \dots\ ``the configuration space is "
        r"simply a point at the unfolded state (with multiplicity''}",
        note="multiplicity 2^Vi",
        code="definite_stress",
        words="docs/mathematics.md, 6 and 7",
    )
    script.state(
        "IIC.8",
        "Section II C, Ve = 3",
        r"\text{``Triangulated triangles are equivalent to planar projections (Schlegel "
        r"diagrams) of triangulations of spheres''}",
        r"\text{to planar projections of triangulated spheres; they are Schlegel diagrams iff they "
        r"have a convex lifting}",
        note="no convex lifting: corners (0,0), (4,0), (0,4), inner (1,1), (2,1), (1,2), diagonals "
        "04, 15, 23. "
        "Remark: up to combinatorial type the printed words hold (Steinitz), and nothing else "
        "is used",
        severity=Severity.CLAIM,
        cited="Steinitz (combinatorial type)",
    )
    chord = CreasePattern(
        [*SQUARE, *inner_points((0, 0), (1, 1), (0, 1))],
        [(0, 1, 2), *(tuple((0, 2, 3, 4, 5, 6)[k] for k in t) for t in OCTAHEDRON)],
    )
    count = count_branches(chord)
    script.example(
        "Fig. (triangle): a square with its diagonal and three vertices of degree four on one "
        "side of "
        "it: one branch, of multiplicity 8, in which the three are flat",
        (count.distinct, count.with_multiplicity, chord.Vt)
        == (1, script.alter("multiplicities added", 2**3, 2 * 3), 3)
        and {chord.degree(v) for v in chord.interior} == {4}
        and set(count.branches[0].vertex_signs.values()) == {0},
        of="IIC.9",
    )
    script.state(
        "IIC.9",
        "Fig. (triangle); Section III A, edges between opposite corners",
        r"\text{``the three vertices interior to the triangle are rigid even though they "
        r"each have four folds''}",
        code="CreasePattern.triangulated_triangles",
        rests="IIC.7",
    )
    minimal = script.alter("two vertices suffice", 3, 2)
    enough = [m for m in range(1, 6) if 3 * m + m * (m - 1) // 2 >= 4 * m and m >= 1]
    script.certificate(
        "m vertices in a triangle have 3m folds; if all degrees are >= 4 then 3m + (inner folds) "
        ">= 4m "
        "with at most m(m-1)/2 inner folds: m >= 3, and m = 3 is the flat octahedron",
        min(enough) == minimal,
        of="IIIA.11",
    )
    script.state(
        "IIIA.11",
        "Table (summary), caption",
        r"\text{systems with }V_t>0\text{: ``in all cases these were flat octahedra''}",
        note="Remark: the smallest case; consistent with none for Vi = 2, 3",
        code="families.flat_octahedron_in_square",
    )


def _components(script: Script) -> None:
    """For D >= 2 the branches are not the connected components of the solution set."""
    p = TWO_CONES
    free = [2, 3, 4, 6]
    # Modulo planes the heights at 5, 0 and 1 are 0, so that 5 is flat where h_2 = h_6 = 0
    first, second = (restricted(p, v, free) for v in (5, 6))
    a, b, c = first[0][0], first[0][3], first[3][3]
    root = _rational_root(b * b - a * c)
    slopes = [(-b + sign * root) / a for sign in (1, -1)]
    planes = [((0, 1, 0, 0), (0, 0, 1, 0), (slope, 0, 0, 1)) for slope in slopes]
    conics = [inertia(gram(second, plane)) for plane in planes]
    line = inertia(gram(second, [[0, 1, 0, 0], [0, 0, 1, 0]]))
    expected = script.alter("a definite form on the line", (1, 1, 0), (0, 2, 0))
    script.counterexample(
        "Ve = 5, one vertex of degree 4: its form splits into two planes of RP^3, each meets the "
        "other "
        "quadric in a real conic (inertia (1, 2)), and the conics meet in two real points: one "
        "connected component, two irreducible ones",
        root > 0 and conics == [(1, 2, 0)] * 2 and line == expected and not _crosses(p),
        against="IIC.10",
    )
    script.state(
        "IIC.10",
        "Section II C, definition of B",
        r"\text{``Let }B\text{ be the number of connected components of the solution set (counted "
        r"with "
        r"multiplicity) in }\mathbb{RP}^{V_i+D-1}\text{''}",
        r"\text{irreducible components, as in Section II A}",
        "two definitions of a branch that agree for D = 1. For D >= 2 components may meet away "
        "from the unfolded state: boundary (6,0), (5,-5), (-4,-4), (-6,4), (-6,6), inner (0,0) of "
        "degree 4 and (1,2) of degree 5 have two cones that share two lines, in which the vertex "
        "of degree 4 is flat",
        severity=Severity.CONDITION,
    )


TWO_LINES = CreasePattern(
    [(0, 0), (6, 1), (4, 4), (0, 6), (-2, 3), (2, 2), (0, 3)],
    [(0, 1, 5), (1, 2, 5), (0, 5, 6), (5, 2, 6), (2, 3, 6), (3, 4, 6), (4, 0, 6)],
)
"""Five boundary vertices; the straight crease paths 0-5-2 and 0-6-3 do not cross; no chords."""


def _linear_branches(script: Script) -> None:
    """A sheet with D = 2 and a branch that is a plane, along which the solutions are smooth."""
    p = TWO_LINES
    span = []
    end = script.alter("a line that is no crease path", 3, 4)
    start = 0 if end == 3 else 2
    for a, b in ((0, 2), (start, end)):  # bent along the line from a to b only
        (ax, ay), (bx, by) = p.vertices[a], p.vertices[b]
        sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for x, y in p.vertices]
        span.append(dict(enumerate(max(s, Fraction(0)) for s in sides)))
    first, second = span
    forms = [curvature_form(p, v) for v in p.interior]
    free = len(BranchSystem(p).variables)
    script.counterexample(
        "Ve = 5 without chords, two straight crease paths that do not cross: all sums of the two "
        "folded sheets solve the equations, a plane of dimension 2 = D",
        p.D == 2
        and not p.chords
        and free == 4
        and all(
            form(h) == form(k) == form.polar(h, k) == 0
            for form in forms
            for h, k in ((first, second),)
        ),
        against="IIC.15",
    )
    script.state(
        "IIC.15",
        "Section II C, branches as cones",
        r"\text{``the origins of these cones (singular when }D>1\text{)''}",
        r"\text{singular iff the cone is not a linear space}",
        "a cone is its own tangent cone at the origin. Singular for a single vertex with D > 1 "
        "(IIB.23); with two straight crease paths that do not cross one branch is a plane: corners "
        "(0,0), (6,1), (4,4), (0,6), (-2,3), inner (2,2), (0,3)",
        severity=Severity.CONDITION,
        words="a cone is its own tangent cone",
    )


OCTAHEDRON = [(0, 1, 3), (1, 2, 4), (2, 0, 5), (0, 3, 5), (1, 4, 3), (2, 5, 4), (3, 4, 5)]
"""A flat octahedron with corners 0, 1, 2 and inner vertices 3, 4, 5 across from 01, 12, 20."""


def inner_points(a: Point, b: Point, c: Point) -> list[Point]:
    """Three inner vertices of a flat octahedron, with barycentric coordinates 4:4:1."""
    mixes = ((4, 4, 1), (1, 4, 4), (4, 1, 4))
    return [
        (
            Fraction(p * a[0] + q * b[0] + r * c[0]) / 9,
            Fraction(p * a[1] + q * b[1] + r * c[1]) / 9,
        )
        for p, q, r in mixes
    ]


def restricted(pattern: CreasePattern, vertex: int, free: Sequence[int]) -> list[list[Fraction]]:
    """The matrix of K_vertex on the heights in `free`, the others zero."""
    form = curvature_form(pattern, vertex)
    at = {v: k for k, v in enumerate(form.labels)}
    return [
        [form.matrix[at[v]][at[w]] if v in at and w in at else Fraction(0) for w in free]
        for v in free
    ]


def gram(
    matrix: list[list[Fraction]], basis: Sequence[Sequence[Fraction | int]]
) -> list[list[Fraction]]:
    """The matrix of a form on the span of a basis."""
    size = range(len(matrix))
    return [
        [sum((x[i] * matrix[i][j] * y[j] for i in size for j in size), Fraction(0)) for y in basis]
        for x in basis
    ]


def _rational_root(square: Fraction) -> Fraction:
    """The square root of a rational square."""
    root = Fraction(isqrt(square.numerator), isqrt(square.denominator))
    if root * root != square:
        raise ValueError(f"{square} is not a square")
    return root


def _crosses(pattern: CreasePattern) -> bool:
    return bool(families.collinear_folds(pattern))


if __name__ == "__main__":
    sys.exit(run(prove()))
