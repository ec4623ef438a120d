"""Which stars can be flat on exceptional sheets: docs/generic.md, Theorem 12.

Proof of Theorem 12, in its notation:

Proof of (a). The stars of vertices of F that are joined by edges in F lie in one plane. At a vertex
u that is not in F their faces fill one or more angles, whose sides are edges that do not end in F;
by (1) of docs/theorem.md what the faces of an angle add to K_u depends on the gradient and on its
sides only.

Proof of (b). Take the inside of C away and draw a diagonal e that lies in C. It is not an edge
already. Let n' interior vertices be left. A 3-cycle around e would have had the vertices inside C
in it; so Theorem 11 says that e is bent unless P_e = 0, also for complex positions (step 1). Now
let M be the set of all positions and solutions (U, h) near the given one. It is the zero set of n'
equations in 3 n' unknowns, with finitely many points over each U (Theorem 2 (a)). So all its
components have dimension 2n', and where omega_e = 0 as well the dimension is at least 2n' - 1. It
is not 2n', as P_e would vanish on an open set. By (a) the positions inside C are free.

Proof of (c). If the branch is flat inside C, w has three folds that may be bent: those to a, to c
and to the outer neighbour. There is no fold wb, also none outside of C, as these are opposite.
Three folds with the directions d_1, d_2, d_3 have stresses in balance that are proportional to
[d_2, d_3], [d_3, d_1], [d_1, d_2], where [d, d'] = d x d', and with these K_w = 1/2 [d_1, d_2]
[d_2, d_3] [d_3, d_1] [machine]. So if K_w = 0 and the star is not flat, two of them are opposite
and the third is flat. The fold to the outer neighbour is not opposite to wa or wc, as it is in a
face with each; so wa and wc are opposite. Conversely, if w lies on ac, it lies between a and c.
Replace the inside of C by the diagonal wb. Now w has four folds, two of them on a line, and K_w is
a product of two linear forms, one of which vanishes where wb and the fold to the outer neighbour
are flat [machine]. This linear equation and the other n' - 1 quadratic ones have a common zero in
P^n'. It is a solution, so it is real by Theorem 2, and C lies in a plane on it.

Proof of (d). Let h be the branch at the realization U_0. By the proof of Theorem 3 the equations
K_u = 0, u != v, have independent linear parts at h; their solutions near h, for U near U_0, form
curves that depend analytically on U. Let w be tangent to the curve of U_0 at h. By (L), K_u(w) <= 0
for u != v, so that K_v(w) > 0 by the key lemma. Write K_v = x_0^2 - x_1^2 - ... - x_(d-3)^2 with
linear forms in the heights that depend analytically on U, such that x_1, ..., x_(d-3) vanish on w
at U_0. Then x_0 does not, and is a parameter s of the curves. The branches near h are the solutions
s of

    s^2 = x_1(s, U)^2 + ... + x_(d-3)(s, U)^2,

and the star of v is flat where all x_i and s are 0, that is, x_1(0, U) = ... = x_(d-3)(0, U) = 0.

For d = 4 the two branches are s = x_1(s, U) and s = -x_1(s, U): both are analytic in U, and where
x_1 changes its sign they pass through each other, and on each v pops from one side to the other.
For d >= 5 they meet like the two halves of a cone.

Proof of (e). Follow what is flat from star to star. A star with one fold that is not known to be
flat is flat. One with two is flat, or they form a line. One with three is flat, or two of them form
a line and the third is flat, by the formula in (c). Two sides of a face do not form a line, and the
four corners do not lie in a plane. There are 1, 1, 2 and 6 such triangulations with 1, 2, 3 and 4
interior vertices, up to symmetry. In each, for each vertex whose star is flat, this leads to
finitely many cases. In all of them [machine] all stars inside an inner 4-cycle are flat, or two or
more vertices lie on lines through two of their neighbours. Each such line is one irreducible
condition on the positions, and different lines are different conditions, so that two have
codimension two.
"""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping
from fractions import Fraction
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import networkx as nx
import sympy

from exactfold import CreasePattern
from exactfold._support.verdict import PROVED
from exactfold.branches import count_branches, find_branches
from exactfold.pattern.crease_pattern import Edge
from proofs.disks import RIM, Disk, enclosed, graph, separating, to_the_left, triangulations
from proofs.framework import Proof, Script, run

NAME = "exceptions"
TITLE = "Exceptional sheets: flat stars and the 4-cycles around them"

SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))


def prove(change: str | None = None) -> Proof:
    """Check the cases behind docs/generic.md, Theorem 12, and examples on its hypersurfaces."""
    script = Script(
        NAME,
        TITLE,
        (
            "a triangulated quadrilateral without reflex corner, with no vertex inside a triangle "
            "of edges, given up to the positions of its interior vertices",
        ),
        change,
    )
    script.state(
        "T.12",
        "docs/generic.md, Theorem 12",
        r"V_i\le 4:\text{ in codimension one, a star is flat on a branch only with all stars "
        r"inside a 4-cycle other than the rim}",
        note="a flat star of degree d > 4 alone is d - 3 conditions on the positions",
        code="BranchCount.exceptional_vertices",
        words="docs/generic.md, Theorem 12",
    )
    _few_folds(script)
    _case_analysis(script)
    _straight_lines(script)
    _curved(script)
    return script.proof()


# --- the case analysis ---------------------------------------------------------------------------


class Case(NamedTuple):
    """A case of a branch with a flat star: points on lines, flat stars, and undecided stars.

    Each of `lines` is an interior vertex w with two of its neighbours a < c: w lies on ac.
    """

    lines: frozenset[tuple[int, int, int]]
    flat: frozenset[int]
    undecided: frozenset[int]


def cases(disk: Disk, v: int) -> set[Case]:
    """All cases of a branch with a flat star of v, followed from star to star.

    A star with one fold that is not yet flat is flat. A star with two such folds is flat, or the
    two form a line. A star with three such folds is flat, or two of them form a line and the third
    is flat. The four corners do not lie in a plane, and no line is a side of a face.
    """
    faces = [frozenset(face) for face in disk]
    third = to_the_left(disk)
    folds = [(a, b) for a, b in third if a < b and (b, a) in third]
    spokes = {w: frozenset(e for e in folds if w in e) for w in {*sum(disk, ())} - RIM}
    found: set[Case] = set()
    seen: set[tuple[frozenset[Edge], frozenset[tuple[int, int, int]]]] = set()

    def planar(flat: Collection[Edge]) -> bool:
        """Whether the faces that are joined by flat folds contain all four corners."""
        joined = nx.Graph()
        joined.add_nodes_from(faces)
        for a, b in flat:
            joined.add_edge(frozenset((a, b, third[a, b])), frozenset((a, b, third[b, a])))
        return any(frozenset().union(*part) >= RIM for part in nx.connected_components(joined))

    def follow(flat: frozenset[Edge], lines: frozenset[tuple[int, int, int]]) -> None:
        if (flat, lines) in seen or planar(flat):
            return
        seen.add((flat, lines))
        bent = {w: spokes[w] - flat for w in spokes}
        for open_folds in bent.values():
            if len(open_folds) == 1:
                return follow(flat | open_folds, lines)
        for w, open_folds in bent.items():
            choices = [
                ((w, *sorted({*p[0], *p[1]} - {w})), open_folds - set(p))
                for p in combinations(sorted(open_folds), 2)
            ]
            if len(open_folds) in (2, 3) and not any(line in lines for line, _ in choices):
                follow(flat | open_folds, lines)
                for line, rest in choices:
                    if frozenset(line) not in faces:
                        follow(flat | rest, lines | {(line[0], line[1], line[2])})
                return None
        found.add(
            Case(
                lines,
                frozenset(w for w in bent if not bent[w]),
                frozenset(w for w in bent if len(bent[w]) > 3),
            )
        )
        return None

    follow(spokes[v], frozenset())
    return found


def is_settled(disk: Disk, v: int, size: int = 4) -> bool:
    """Whether in every case with at most one line, all stars inside a 4-cycle round v are flat."""
    around = [part for part in enclosed(disk, size) if v in part]
    return all(
        len(case.lines) > 1 or any(part <= case.flat for part in around) for case in cases(disk, v)
    )


def _few_folds(script: Script) -> None:
    d = sympy.symbols("x1:4 y1:4")
    at = list(zip(d[:3], d[3:], strict=True))

    def cross(i: int, j: int) -> Any:
        return at[i][0] * at[j][1] - at[i][1] * at[j][0]

    w = cross(1, 2), cross(2, 0), cross(0, 1)
    form = (w[0] * w[1] * cross(0, 1) + w[0] * w[2] * cross(0, 2) + w[1] * w[2] * cross(1, 2)) / 2
    script.identity(
        "three folds with the directions d_1, d_2, d_3: the stresses in balance are multiples of "
        "[d_2,d_3], [d_3,d_1], [d_1,d_2], and K = [d_1,d_2][d_2,d_3][d_3,d_1]/2: 0 only if two "
        "directions are opposite, and then the third fold is flat",
        *(sum(w[i] * at[i][k] for i in range(3)) for k in range(2)),
        form - script.alter("one factor left out", w[0], 1) * w[1] * w[2] / 2,
        of="T.12",
    )
    ratio, s, t = sympy.symbols("lambda s t")
    at = [at[0], at[1], (-ratio * at[0][0], -ratio * at[0][1]), at[2]]
    stress = ratio * t - s * cross(1, 3), s * cross(0, 3), t, -s * cross(0, 1)
    form = sum(
        stress[j] * stress[k] * cross(j, k) for j in range(4) for k in range(j + 1, 4)
    ) / script.alter("the form doubled", 2, 1)
    script.identity(
        "four folds, the third opposite to the first, d_3 = -lambda d_1: the stresses in balance "
        "are (lambda t - s [d_2,d_4], s [d_1,d_4], t, -s [d_1,d_2]), and K = s [d_1,d_2][d_1,d_4]"
        "(2 lambda t - s [d_2,d_4])/2: one factor vanishes where the second and fourth are flat",
        *(sum(stress[i] * at[i][k] for i in range(4)) for k in range(2)),
        form - s * cross(0, 1) * cross(0, 3) * (2 * ratio * t - s * cross(1, 3)) / 2,
        of="T.12",
    )


def _case_analysis(script: Script) -> None:
    size = script.alter("triangles instead of 4-cycles", 4, 3)
    least = script.alter("three lines needed", 1, 3)
    stars = [(disk, v) for n in range(1, 5) for disk in triangulations(n) for v in range(4, 4 + n)]
    script.certificate(
        "up to 4 interior vertices, none inside a triangle of edges: if the star of a vertex is "
        "flat on a branch, two or more vertices are on lines through two neighbours, or all stars "
        "inside a 4-cycle around the vertex are flat",
        len(stars) == 33 and all(is_settled(disk, v, size) for disk, v in stars),
        of="T.12",
    )
    sides = script.alter("a diagonal of a 4-cycle joined", 4, 5)
    script.certificate(
        "up to 5 interior vertices: opposite vertices of a 4-cycle with vertices inside are not "
        "joined, neither inside it nor outside",
        all(
            graph(disk).subgraph(ring).number_of_edges() == sides
            for n in range(1, 6)
            for disk in triangulations(n)
            for ring in separating(disk, 4)
        ),
        of="T.12",
    )
    script.certificate(
        "up to 3 interior vertices: some vertex is then on a line through two neighbours",
        all(
            len(case.lines) >= least
            for disk, v in stars
            if len(disk) < 10
            for case in cases(disk, v)
        ),
        of="T.12",
    )


# --- sheets --------------------------------------------------------------------------------------


def placed(disk: Disk, between: Mapping[int, tuple[int, int]]) -> CreasePattern:
    """The disk drawn in the unit square.

    Each vertex of `between` lies halfway between two given neighbours. Every other inner vertex is
    a mean of its neighbours with unequal weights (Tutte).
    """
    inner = sorted({*sum(disk, ())} - RIM)
    edges = graph(disk)
    rows, right = [], []
    for v in inner:
        near = between.get(v, tuple(sorted(edges[v])))
        weight = {w: 1 if v in between else 1 + (3 * v + 5 * w) % 7 for w in near}
        rows.append([sum(weight.values()) * (u == v) - weight.get(u, 0) for u in inner])
        right.append([sum(weight.get(b, 0) * SQUARE[b][k] for b in RIM) for k in range(2)])
    points = sympy.Matrix(rows).LUsolve(sympy.Matrix(right))
    found = [(Fraction(str(x)), Fraction(str(y))) for x, y in points.tolist()]
    return CreasePattern([*SQUARE, *found], disk)


def _exceptional(disk: Disk, between: Mapping[int, tuple[int, int]]) -> set[int] | None:
    result = count_branches(placed(disk, between))
    return set(result.exceptional_vertices) if result.status is PROVED else None


def _straight_lines(script: Script) -> None:
    moved = script.alter("the vertex moved off the line", False, True)
    script.cases(
        "up to 3 interior vertices: if a vertex is halfway between two neighbours as in a case "
        "with one line, the stars of that case are flat on a branch",
        (
            _exceptional(disk, {} if moved else {w: (a, c)}) == flat
            for n in (2, 3)
            for disk in triangulations(n)
            for (w, a, c), flat in sorted(one_line(disk).items())
        ),
        of="T.12",
    )
    disk = triangulations(3)[0]
    second = script.alter("the second vertex not on it", {6: (3, 5)}, {})
    script.example(
        "a star of degree 5 inside no 4-cycle, vertex 4 with the ring 0, 1, 5, 6, 3, is flat on a "
        "branch of a sheet with 5 and 6 on the line 13; with 5 alone on the line 16 it is not",
        graph(disk).degree[4] == 5
        and 4 in (_exceptional(disk, {5: (1, 6), **second}) or ())
        and _exceptional(disk, {5: (1, 6)}) == set(),
        of="T.12",
    )
    disk = triangulations(4)[0]
    script.example(
        "a star of degree 5 inside a 4-cycle, vertex 5 with the ring 1, 2, 6, 7, 4, is flat with "
        "all stars inside 1, 2, 3, 4 where 4 is on the line 13",
        graph(disk).degree[5] == 5
        and _exceptional(disk, {4: script.alter("another line", (1, 3), (0, 5))}) == {5, 6, 7},
        of="T.12",
    )


def one_line(disk: Disk) -> dict[tuple[int, int, int], set[int]]:
    """For each line that is the only line of some case, the stars that are flat in this case."""
    found: dict[tuple[int, int, int], set[int]] = {}
    for v in {*sum(disk, ())} - RIM:
        for case in cases(disk, v):
            if len(case.lines) == 1:
                (line,) = case.lines
                found.setdefault(line, set()).update(case.flat)
    return found


CURVED = ((0, 1, 4), (0, 4, 5), (0, 5, 3), (1, 2, 4), (2, 6, 4), (2, 3, 6), (3, 5, 6), (4, 6, 5))
"""A disk with 4 interior vertices, the one inside the 4-cycle 1, 2, 6, 4 taken out."""


def _curved(script: Script) -> None:
    """The fold 24 of CURVED has different letters on branches with equal signs and saddles."""
    shift = script.alter("the first sheet twice", 0, 1)
    first = [("7/16", "41/64"), ("9/64", "37/64"), ("3/16", "13/16")]
    second = [("15/32", "5/16"), ("13/64", "15/32"), ("7/16", "11/16")]
    sheets = [CreasePattern([*SQUARE, *points], CURVED) for points in (first, second)]
    letters = [
        {branch.assignment[2, 4] for branch in find_branches(sheet, ("---", "--+"))}
        for sheet in (sheets[0], sheets[1 - shift])
    ]
    script.example(
        "4 interior vertices, 4 in the corner 1, 2, 6, 4 taken out: on two sheets the fold 24 has "
        "different letters on the branches with equal signs and saddles, so that it is flat on a "
        "sheet between them; the star inside the 4-cycle is flat there, with no folds on a line",
        all(len(found) == 1 for found in letters) and letters[0] != letters[1],
        of="T.12",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
