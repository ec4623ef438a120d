"""The length equations and their expansion at the unfolded state (Section II A)."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy
from sympy import QQ
from sympy.polys.fields import field

from exactfold import CreasePattern
from exactfold.exact.linalg import rank
from exactfold.pattern import families
from exactfold.rigidity import curvature_form, rigidity_matrix, self_stresses
from proofs.claims import is_zero
from proofs.formulas import Names
from proofs.framework import Proof, Script, run
from proofs.spokes import Vector, drawn, wheel
from proofs.statements import Severity
from proofs.wheel_stress import TRIANGLE, with_vertices

NAME = "length_equations"
TITLE = "The expansion of the length equations"

Heights = dict[int, Fraction]

CROSS = CreasePattern(
    [(1, 0), (0, 1), (-1, 0), (0, -1), (0, 0)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
)
"""A square whose two straight creases meet in its centre: K(h) = (x_0 + x_2)(x_1 + x_3) / 2."""


def prove(change: str | None = None) -> Proof:
    """Eqs. (length) to (compat): expansion, orders, rigidity in the plane, self stresses."""
    script = Script(
        NAME, TITLE, ("a triangulated disk in the plane; any displacements u and h",), change
    )
    _expansion(script)
    _in_plane(script)
    _stresses(script)
    return script.proof()


def _expansion(script: Script) -> None:
    """Eq. (expanded), first-order flexes, and the size of the in-plane displacement."""
    t, h = sympy.symbols("t h")
    U, u = sympy.Matrix(sympy.symbols("U_x U_y")), sympy.Matrix(sympy.symbols("u_x u_y"))
    factor = script.alter("factor two dropped", 2, 1)
    moved = (U + t**2 * u).dot(U + t**2 * u) + (t * h) ** 2 - U.dot(U)
    leading = t**2 * (factor * U.dot(u) + h**2)
    script.identity(
        "|X|^2 - L^2 = t^2 (2 U.u + h^2) + t^4 |u|^2",
        moved - leading - t**4 * u.dot(u),
        of="IIA.2 IIA.7",
    )
    two = script.alter("polarity without its factor", 2, 1)
    a, b = sympy.Matrix(sympy.symbols("a1:4")), sympy.Matrix(sympy.symbols("b1:4"))
    script.identity(
        "three lengths of a triangle fix the angle: 2 a.b = |a|^2 + |b|^2 - |a - b|^2",
        two * a.dot(b) - a.dot(a) - b.dot(b) + (a - b).dot(a - b),
        of="IIA.1",
    )
    order = script.alter("heights that count in the first order", 2, 1)
    tilt = U + t * u
    script.identity(
        "to first order in t the squared length changes by 2 U.u, which is 0 where u is",
        sympy.diff(tilt.dot(tilt) + t**order * h**2, t).subs(t, 0) - 2 * U.dot(u),
        of="IIA.3",
    )
    script.state(
        "IIA.1",
        "Section II A, Eq. (length)",
        r"|\mathbf X_n-\mathbf X_m|^2-L_{(n,m)}^2=0",
        note="Remark: the definition of a configuration; equal lengths imply equal face angles "
        "(polarity)",
        code="CreasePattern.edges",
        equation="1",
    )
    script.formula(
        "IIA.2",
        "Section II A, Eq. (expanded)",
        r"2\frac{\mathbf{U}_n-\mathbf{U}_m}{|\mathbf{U}_n-\mathbf{U}_m|}\cdot(\mathbf{u}_n"
        r"-\mathbf{u}_m)+\frac{(h_n-h_m)^2}{|\mathbf{U}_n-\mathbf{U}_m|}\approx 0",
        over=[_edge(*field("t U1 V1 U2 V2 u1 v1 u2 v2 h1 h2 length", QQ)[1:])],
        note="to lowest order in t, with in-plane displacements of order t^2; exact remainder "
        "t^4 |u_n - u_m|^2 / |U_n - U_m|",
        code="BranchSystem",
        equation="2",
    )
    script.state(
        "IIA.3",
        "Section II A, after Eq. (expanded)",
        r"\mathbf u_n=0\text{ for all }n\text{ preserves lengths to first order}",
    )


def _edge(t: Any, *free: Any) -> Names:
    """The names of one edge whose ends move by t^2 u in the plane and by t h out of it.

    The left side of Eq. (expanded) stands for the terms of order t^2 of the length equation
    divided by the length.
    """
    coordinates, length = free[:8], free[10]
    h = {1: free[8], 2: free[9]}
    side = (coordinates[0] - coordinates[2], coordinates[1] - coordinates[3])
    ends = {k: Vector(coordinates[2 * k - 2 : 2 * k], {side: length}) for k in (1, 2)}
    moves = {k: Vector(coordinates[2 * k + 2 : 2 * k + 4]) for k in (1, 2)}
    drift, rise = moves[1] - moves[2], t * (h[1] - h[2])
    bar = Vector(side) + t**2 * drift
    squared = bar * bar + rise * rise - Vector(side) * Vector(side)
    leading = (squared / t**2 - t**2 * (drift * drift)) / length
    return {
        "n": 1,
        "m": 2,
        "U": ends.__getitem__,
        "u": moves.__getitem__,
        "h": h.__getitem__,
        "zero": lambda difference: is_zero(difference + leading),
    }


def _sheet(names: Names) -> Names:
    """The names of a wheel whose vertices also move by u = (k^2, 3 - k) in the plane; hub 0."""
    n, ends = names["N"], [(0, 0), *names["ends"]]
    edges = [(k, 0) for k in range(1, n + 1)] + [(k, k % n + 1) for k in range(1, n + 1)]
    sides = {(i, j): Vector(ends[i]) - Vector(ends[j]) for i, j in edges}
    lengths = {(i, j): names["Delta L"](i, j) if j else names["L"](i) for i, j in edges}
    sizes = {sides[e].coordinates: lengths[e] for e in edges}
    moves = [Vector((k * k, 3 - k)) for k in range(n + 1)]
    stretch = {e: sides[e] * (moves[e[0]] - moves[e[1]]) / lengths[e] for e in edges}
    return {
        **names,
        "all": edges,
        "U": lambda k: Vector(ends[k], sizes),
        "u": moves.__getitem__,
        "sigma": lambda e: names["sigma"](*e) if e[1] else names["sigma"](e[0]),
        "stretch": lambda e: stretch[e],
    }


def _in_plane(script: Script) -> None:
    """ker C consists of rigid motions: triangles are rigid, and gluing along an edge keeps that."""
    p, q, r = sympy.symbols("p q r")
    x = sympy.Matrix(sympy.symbols("x1:4 y1:4")).reshape(2, 3)
    d = [sympy.Matrix(v) for v in ((p, 0), (q, r), (q - p, r))]
    pairs: tuple[tuple[int, int], ...] = ((0, 1), (0, 2), (1, 2))
    pairs = script.alter("a triangle with one side missing", pairs, pairs[:2])
    unknowns = list(x)
    rows = sympy.Matrix(
        [
            [sympy.diff(d[k].dot(x[:, j] - x[:, i]), z) for z in unknowns]
            for k, (i, j) in enumerate(pairs)
        ]
    )
    minor = rows.extract(list(range(len(pairs))), [1, 2, 5][: len(pairs)])
    rigid = len(pairs) == 3 and not sympy.simplify(minor.det() ** 2 - (p * p * r) ** 2)
    script.certificate(
        "a triangle (0,0), (p,0), (q,r) has rank 3: a 3 x 3 minor of C is +-p^2 r",
        rigid,
        of="IIA.5",
    )
    w, a, b = sympy.symbols("omega a b")
    arm = script.alter("both conditions at one end", p, 0)
    end = sympy.Matrix([a, b]) + w * sympy.Matrix([0, arm])
    solution = sympy.solve([a, b, *end], [w, a, b], dict=True)
    script.certificate(
        "a planar rigid motion that fixes both ends of an edge is zero, so motions of two pieces "
        "glued along an edge agree: rank 2V - 3 by induction over the triangles",
        solution == [{w: 0, a: 0, b: 0}],
        of="IIA.5",
    )
    motions = script.alter("four rigid motions", 3, 4)
    patterns = (families.waterbomb(), families.flat_vertex_square(), families.hypar(2))
    script.cases(
        "rank of the rigidity matrix is 2V - 3, and there are Vi self stresses",
        (
            rank(rigidity_matrix(f)) == 2 * len(f.vertices) - motions
            and len(self_stresses(f)) == f.Vi
            for f in patterns
        ),
        of="IIA.5",
    )
    norm, h, c = sympy.symbols("norm h c")
    share = script.alter("in-plane term not small", 2, 3)
    script.identity(
        "0 <= |u| <= c (|h|^2 + |u|^2) and |u| <= 1/(2c) give |u| <= 2c |h|^2, because "
        "2c|h|^2 - |u| = 2 [c (|h|^2 + |u|^2) - |u|] + |u| (1 - 2c|u|)",
        2 * c * h**2 - norm - 2 * (c * (h**2 + norm**2) - norm) - norm * (1 - share * c * norm),
        of="IIA.4",
    )
    script.state(
        "IIA.4",
        "Section II A, after Eq. (expanded)",
        r"\text{``we can safely neglect terms of order }\mathcal O(\mathbf u_n^2)\text{''}",
        note="Remark: C is injective modulo rigid motions, so |u| <= c(|h|^2 + |u|^2) on "
        "configurations: u = O(h^2) and u^2 = O(h^4)",
    )
    script.state(
        "IIA.5",
        "Section II A, after Eq. (expanded2)",
        r"\mathrm{ker}\,\mathbf{C}\text{ ``is generically generated by translations and "
        r"rotations only''}",
        note="true of every triangulated disk with non-degenerate triangles: neither Laman's "
        "theorem nor genericity is needed",
        code="rigidity_matrix",
    )


def _stresses(script: Script) -> None:
    """The rows of C belong to edges, not folds; Eq. (compat) and its meaning."""
    free = _sheet(wheel(3))
    one = script.alter("a rim without its stress", 0, 1)
    script.identity(
        "sigma . C u = 0 for the wheel stress of a free wheel and any u: of sigma . (2 C u + "
        "h^2/|U|) the sum of sigma h^2/|U| is left",
        sum(free["sigma"](e) * free["stretch"](e) for e in free["all"][: len(free["all"]) - one]),
        of="IIA.8",
    )
    kept = script.alter("rows for all edges", CROSS.folds, CROSS.edges)
    spokes_only = [
        row for e, row in zip(CROSS.edges, rigidity_matrix(CROSS), strict=True) if e in kept
    ]
    script.counterexample(
        "with rows for the folds (interior edges) only, a single vertex has no self stress, "
        "with rows for all edges it has one",
        rank(spokes_only) == len(spokes_only) and len(self_stresses(CROSS)) == 1,
        against="IIA.6",
    )
    (stress,) = self_stresses(CROSS)
    bent = {0: Fraction(1), 1: Fraction(0), 2: Fraction(-1), 3: Fraction(1), 4: Fraction(0)}
    terms = {e: w * (bent[e[0]] - bent[e[1]]) ** 2 for e, w in stress.items()}
    over = script.alter("sum over the folds only", CROSS.edges, CROSS.folds)
    script.counterexample(
        "on a branch of the cross the sum of Eq. (compat) is 0 over all edges, not over the folds",
        sum(terms[e] for e in over) == 0 and sum(terms[e] for e in CROSS.folds) != 0,
        of="IIA.6",
    )
    dx, dy, zi, zj = sympy.symbols("dx dy z_i z_j")
    level = script.alter("ends at different heights", zj, -zj)
    script.identity(
        "a self stress of the flat sheet in the plane is one in space: where z_i = z_j the squared "
        "length does not change with z_i to first order",
        sympy.diff(dx**2 + dy**2 + (zi - zj) ** 2, zi).subs(zi, level),
        of="IIA.9",
    )
    power = script.alter("height differences not squared", 2, 1)
    outcomes = []
    for pattern in (CROSS, families.two_vertex(), families.flat_vertex_square()):
        for k in range(12):
            heights = {
                v: Fraction((v * v * (k + 3) + 5 * k * v + k) % 7 - 3)
                for v in range(len(pattern.vertices))
            }
            outcomes.append(_solvable(pattern, heights, power) == is_solution(pattern, heights))
        flat = dict.fromkeys(range(len(pattern.vertices)), Fraction(0))
        outcomes.append(_solvable(pattern, flat, power))
    outcomes.append(_solvable(CROSS, bent, power) and is_solution(CROSS, bent))
    script.cases(
        "2 C u = -(h_n - h_m)^2 / L is solvable exactly if all K_v(h) = 0", outcomes, of="IIA.10"
    )
    script.state(
        "IIA.6",
        "Section II A, from Eq. (isometry) to Eq. (compat)",
        r"\text{``rows indexed by the unique folds'', ``one component per fold'', ``the sum is "
        r"taken over all folds in the network''}",
        r"\text{edges in place of folds, three times: boundary edges count as well}",
        "folds were defined as the edges in the interior of the disk; with their rows alone the "
        "four spokes of a single vertex carry no self stress. Cross (1,0), (0,1), (-1,0), (0,-1) "
        "about the origin with heights 1, 0, -1, 1, hub 0: the terms of the boundary edges in "
        "Eq. (compat) are not zero",
        "rigidity_matrix, stress_form",
        equation="3",
        severity=Severity.TYPO,
    )
    script.formula(
        "IIA.7",
        "Section II A, Eq. (expanded2)",
        r"2[\mathbf{C}\cdot\mathbf{u}]_{(n,m)}+\frac{(h_n-h_m)^2}{|\mathbf{U}_n-\mathbf{U}_m|}"
        r"\approx 0",
        over=[_by_rows(_edge(*field("t U1 V1 U2 V2 u1 v1 u2 v2 h1 h2 length", QQ)[1:]))],
        functions=[r"[\mathbf{C}\cdot\mathbf{u}]_{(n,m)}"],
        equation="4",
    )
    script.formula(
        "IIA.8",
        "Section II A, Eq. (compat)",
        r"\sum_{(n,m)}\frac{\sigma_{(n,m)}}{|\mathbf{U}_n-\mathbf{U}_m|}(h_n-h_m)^2=0",
        over=[_compatible(names) for names in (free, *map(_sheet, drawn(4, 5)))],
        note="with boundary edges among the folds (IIA.6). For the wheel stress the sum is 2 K_v",
        code="stress_form",
        equation="5",
    )
    script.state(
        "IIA.9",
        "Section II A, footnote",
        r"\text{``the space of self stresses does not depend on whether the unfolded "
        r"configuration is considered to be embedded in an ambient 2D or 3D space''}",
    )
    script.state(
        "IIA.10",
        "Section II A, after Eq. (compat)",
        r"\text{``these conditions which are necessary \dots\ are also sufficient''}",
        note="Remark: b is in the image of C exactly if every left null vector annihilates it",
        code="BranchSystem",
        cited="the Fredholm alternative",
    )


def _by_rows(names: Names) -> Names:
    """The same names, with the row of exactfold's rigidity matrix divided by the length."""
    ends, moves = ([names[x](k).coordinates for k in (1, 2)] for x in "Uu")
    triangle = with_vertices(TRIANGLE, [*ends, (0 * ends[0][0], 0 * ends[0][0])])
    row = rigidity_matrix(triangle)[triangle.edges.index((0, 1))]
    stretch = sum(a * b for a, b in zip(row, [*moves[0], *moves[1]], strict=False))
    length = abs(names["U"](1) - names["U"](2))
    return {**names, r"[\mathbf{C}\cdot\mathbf{u}]_{(n,m)}": stretch / length}


def _compatible(names: Names) -> Names:
    """The same names, where the right side 0 stands for 2 K_v(h) = 0."""
    return {**names, "zero": lambda d: is_zero(d + 2 * names["K"]())}


def _solvable(pattern: CreasePattern, heights: Heights, power: int) -> bool:
    """Whether some in-plane displacement compensates the heights to second order."""
    rows = rigidity_matrix(pattern)
    augmented = [
        [*row, (heights[i] - heights[j]) ** power]
        for row, (i, j) in zip(rows, pattern.edges, strict=True)
    ]
    return rank(rows) == rank(augmented)


def is_solution(pattern: CreasePattern, heights: Heights) -> bool:
    """Whether every curvature form vanishes."""
    return all(curvature_form(pattern, v)(heights) == 0 for v in pattern.interior)


if __name__ == "__main__":
    sys.exit(run(prove()))
