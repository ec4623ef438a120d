"""Which triangulations of a square are H1 (Section IV): all small ones, by enumeration.

A triangulation of a 4-gon without double edges is kept as the set of its triangles, with boundary
vertices 0, 1, 2, 3 and interior vertices numbered in the order in which a search from the edge 01
meets them; so equal sets are equal rooted triangulations. Every one with n >= 1 interior vertices
has an interior vertex of degree at most 5 (proved below), and removing it and filling the hole
without a double edge gives one with n - 1. Hence all arise by inserting vertices of degree 3, 4, 5.
Brown's formula counts them independently.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from math import factorial
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import networkx as nx

from exactfold.pattern import families
from exactfold.studies.triangulations import degrees, insertions
from proofs.framework import Proof, Script, run
from proofs.statements import Severity

NAME = "h1_triangulations"
TITLE = "H1 triangulations: counts, and all of them with few vertices"

Triangle = tuple[int, int, int]
Triangulation = frozenset[Triangle]
LARGEST = 4


def prove(change: str | None = None) -> Proof:
    """The claims on numbers of H1 triangulations; for Vi <= 3 all triangulations are H1."""
    script = Script(
        NAME, TITLE, ("triangulations of a 4-gon without double edges, chords excluded",), change
    )
    levels = _enumeration(script)
    _small(script, levels)
    _counts(script, levels)
    return script.proof()


def rooted(triangles: Triangulation) -> Triangulation:
    """The same triangulation with interior vertices renumbered by a search from the edge 01."""
    turn = {(a, b): c for t in triangles for a, b, c in (t, (*t[1:], t[0]), (*t[2:], *t[:2]))}
    names = {0: 0, 1: 1, 2: 2, 3: 3}
    queue, seen = [(0, 1)], set()
    for a, b in queue:
        if (a, b) in seen or (a, b) not in turn:
            continue
        c = turn[a, b]
        names.setdefault(c, len(names))
        seen |= {(a, b), (b, c), (c, a)}
        queue += [(c, b), (a, c)]
    return frozenset(_smallest_first(*(names[v] for v in t)) for t in triangles)


def boundary(triangles: Triangulation) -> list[int]:
    """Boundary vertices in counter-clockwise order."""
    sides = {(t[i], t[(i + 1) % 3]) for t in triangles for i in range(3)}
    follow = {a: b for a, b in sides if (b, a) not in sides}
    cycle = [min(follow)]
    while follow[cycle[-1]] != cycle[0]:
        cycle.append(follow[cycle[-1]])
    return cycle


def reverse_moves(triangles: Triangulation) -> Iterator[Triangulation]:
    """All reverse H1 moves: remove a boundary vertex w of degree 3 with an interior neighbour v2.

    v2 must keep degree at least 3.
    """
    rim = boundary(triangles)
    degree = degrees(triangles)
    for w in rim:
        gone = [t for t in triangles if w in t]
        (v2,) = set.intersection(*map(set, gone)) - {w} if len(gone) == 2 else (w,)
        if v2 not in rim and degree[v2] >= 4:
            yield triangles - set(gone)


def is_h1(triangles: Triangulation) -> bool:
    """Whether reverse H1 moves lead to a butterfly."""
    return len(triangles) == 2 or any(is_h1(smaller) for smaller in reverse_moves(triangles))


def _enumeration(script: Script) -> list[set[Triangulation]]:
    """All rooted triangulations with at most LARGEST interior vertices."""
    faces = script.alter("only vertices of degree 3 inserted", 5, 3)
    levels = [
        {rooted(frozenset({(0, 1, 2), (0, 2, 3)})), rooted(frozenset({(0, 1, 3), (1, 2, 3)}))}
    ]
    for n in range(LARGEST):
        levels.append(
            {
                rooted(larger)
                for smaller in levels[-1]
                for larger in insertions(smaller)
                if degrees(larger)[4 + n] <= faces
            }
        )
    total = script.alter("twelve, as for a sphere", 6, 12)
    script.example(
        "sum over interior vertices of (6 - d) plus sum over boundary vertices of (4 - d) is 6. "
        "Without chords boundary degrees are at least 3: the first sum is at least 2 (3 for a "
        "triangle), so some interior vertex has degree at most 5; a chord leaves two triangles",
        all(
            sum(6 - d for v, d in degrees(t).items() if v > 3)
            == total - sum(4 - d for v, d in degrees(t).items() if v <= 3)
            for level in levels
            for t in level
        ),
        of="IV.10",
    )
    script.certificate(
        "the numbers 2, 5, 20, 100, 570 of rooted triangulations with n = 0 to 4 agree with "
        "Brown's "
        "formula 40 (4n+3)! / (n! (3n+5)!)",
        [len(level) for level in levels]
        == [40 * factorial(4 * n + 3) // (factorial(n) * factorial(3 * n + 5)) for n in range(5)],
        of="IV.10",
    )
    return levels


def _eligible(level: set[Triangulation]) -> list[Triangulation]:
    """Whether a triangulation has no chords and no interior vertices of degree 3."""
    kept = []
    for t in level:
        degree = degrees(t)
        chord = any({0, 2} <= set(f) or {1, 3} <= set(f) for f in t)
        if not chord and all(d > 3 for v, d in degree.items() if v > 3):
            kept.append(t)
    return kept


def _small(script: Script, levels: list[set[Triangulation]]) -> None:
    """Up to three interior vertices all triangulations are H1; with four some are not."""
    shares = [
        (sum(map(is_h1, kept)), len(kept)) for kept in (_eligible(level) for level in levels[1:])
    ]
    last = script.alter("all with four interior vertices are H1", 3, 4)
    script.certificate(
        f"H1 among the rooted triangulations with Vi = 1, 2, 3, 4: {shares}",
        all(h1 == every > 0 for h1, every in shares[:last]) and shares[3][0] < shares[3][1],
        of="IV.10 IV.11",
    )
    hypar = families.hypar(1)
    script.counterexample(
        "Vi = 4: a square in a square, twisted, has no boundary vertex of degree 3",
        hypar.Vi == 4
        and min(hypar.degree(v) for v in hypar.boundary)
        > script.alter("a boundary vertex of degree 3", 3, 4)
        and not is_h1(frozenset(hypar.triangles)),
        of="IV.10",
    )
    inner = script.alter("vertices of degree 3 inside", 3, 2)
    chords = [
        t
        for t in levels[3]
        if t not in _eligible(levels[3]) and all(d > inner for v, d in degrees(t).items() if v > 3)
    ]
    script.counterexample(
        "Vi = 3: with a chord there are triangulations without interior vertices of degree 3, a "
        f"flat octahedron on one side of it ({len(chords)}, rooted), and none is H1",
        len(chords) == 4 and not any(map(is_h1, chords)),
        against="IV.10",
    )
    script.state(
        "IV.10",
        "Section IV",
        r"\text{``all }V_i=1,2,3\text{ triangulations are H1''}",
        r"\text{all triangulations of a square with }V_i=1,2,3\text{ without interior vertices of "
        r"degree 3 and without folds between corners are H1}",
        "by enumeration; rooted: (H1, all) = "
        f"{shares} for Vi = 1 to 4. It fails first at Vi = 4. With a fold between corners it fails "
        "for a flat octahedron on one side of it, and with five corners for a single vertex. "
        "Remark: Section II C leaves such folds out, but not in the butterflies of this section",
        "families.h1_sequence",
        severity=Severity.CONDITION,
    )
    script.state(
        "IV.11",
        "Section IV, fractions",
        r"\text{``starting from }0\%\text{ at }V_i=3\text{'' \dots\ ``from 1 at }"
        r"V_i=3\text{''}",
        note="Remark: the shares without boundary vertices of degree 3, and of H1 triangulations: "
        "follows from IV.10; the others are IV.15 and IV.16",
        rests="IV.10",
    )


def _counts(script: Script, levels: list[set[Triangulation]]) -> None:
    """Boundary, butterflies, degrees, and no triangulated triangles."""
    outcomes, flat = [], []
    for n, level in enumerate(levels[1:], start=1):
        for t in _eligible(level):
            for smaller in reverse_moves(t):
                lost = set(boundary(t)) - set(boundary(smaller))
                won = set(boundary(smaller)) - set(boundary(t))
                outcomes.append(len(lost) == len(won) == 1 and len(boundary(smaller)) == 4)
            if is_h1(t):
                flat.append(_has_triangulated_triangle(t))
                outcomes.append(len(t) == 2 * (n + 1))
    script.cases(
        "every reverse H1 move on these deletes one boundary vertex and puts one interior vertex "
        "in its place, so Ve = 4 throughout; 2 Vi + 2 triangles (in general: w leaves the boundary "
        "cycle v1 w v3, and v2, which was not on it, takes its place)",
        outcomes,
        of="IV.9 IV.13 IV.12",
    )
    extra = script.alter("the seed is not counted", 1, 0)
    script.example(
        "each move adds two triangles and one interior vertex to the two triangles of the seed: "
        "Vi + 1 butterflies",
        all(len(p.triangles) == 2 * (p.Vi + extra) for p in map(families.h1_sequence, (3, 5, 8))),
        against="IV.12",
    )
    script.example(
        "no H1 triangulation contains a triangulated triangle (here Vi <= 4). In general: the "
        "first "
        "vertex removed from one and its inside is a corner c of degree 3 whose middle neighbour "
        "is "
        "inside; then the opposite side becomes a chord, which only the seed has, and there v2 has "
        "degree 2",
        not any(flat) and bool(flat),
        of="IV.8",
    )
    sample = families.sample_h1_sequence(5, seed=2)
    middle = script.alter("the vertex attached, not v2", 1, 3)
    script.example(
        "families.sample_h1_sequence makes H1 triangulations: Ve = 4, degrees of all v2 at least 4",
        sample.pattern.Ve == 4
        and sample.pattern.Vi == len(sample.moves) == 5
        and all(sample.pattern.degree(move[middle]) >= 4 for move in sample.moves)
        and is_h1(frozenset(sample.pattern.triangles))
        and sample.pattern.Vt == 0,
        of="IV.8 IV.13",
    )
    script.state(
        "IV.8",
        "Section IV, definition of H1 moves",
        r"\text{``We will require that }v_2\text{ has degree at least 3''}",
        note="Remark: v2 gains one edge and becomes interior; at degree 2 it would become a "
        "degree-3 vertex. Consequence: H1 triangulations have no triangulated triangles at all",
    )
    script.state(
        "IV.9",
        "Section IV",
        r"\text{``each reverse H1 move results in the deletion of one boundary vertex and "
        r"the conversion of one internal vertex to a boundary vertex''}",
        note="when the middle neighbour is interior, that is, without chords",
    )
    script.formula(
        "IV.12",
        "Section IV",
        r"\text{``can be decomposed into a sequence of }V_i\text{ butterflies''}",
        r"\text{can be decomposed into a sequence of }V_i+1\text{ butterflies}",
        at=[
            {"V_i": p.Vi, "values": (len(p.triangles) // 2,)}
            for p in map(families.h1_sequence, (3, 5, 8))
        ],
        mentions=True,
        note="the seed included: 2 Vi + 2 triangles, two a butterfly. "
        "Remark: the figure counts so: (1) to "
        "(4) and the seed (5) for Vi = 4",
        severity=Severity.CONSTANT,
    )
    script.state(
        "IV.13",
        "Section IV",
        r"\text{``every H1 triangulation also has four boundary vertices''}",
        code="H1Triangulation",
    )


def _has_triangulated_triangle(triangles: Triangulation) -> bool:
    graph = nx.Graph([(t[i], t[i - 1]) for t in triangles for i in range(3)])
    faces = {frozenset(t) for t in triangles}
    return any(
        len(c) == 3 and frozenset(c) not in faces for c in nx.simple_cycles(graph, length_bound=3)
    )


def _smallest_first(a: int, b: int, c: int) -> Triangle:
    return min((a, b, c), (b, c, a), (c, a, b))


if __name__ == "__main__":
    sys.exit(run(prove()))
