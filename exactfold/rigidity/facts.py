"""Everything exact that is known of a pattern without solving its branch system."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from flint import nmod_mat

from exactfold.exact.linalg import Inertia
from exactfold.exact.linalg import rank as rational_rank
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.framework import rigidity_matrix

_PRIME = (1 << 61) - 1


@dataclass(frozen=True)
class PatternFacts:
    """Exact facts of a pattern: counts, rank of the rigidity matrix, inertia of each vertex."""

    pattern: CreasePattern
    rigidity_rank: int
    self_stresses: int
    inertias: dict[int, Inertia]

    def to_dict(self) -> dict[str, Any]:
        """The object printed by `exactfold info --json`."""
        pattern = self.pattern
        return {
            "interior": pattern.Vi,
            "boundary": pattern.Ve,
            "triangles": len(pattern.triangles),
            "edges": len(pattern.edges),
            "folds": len(pattern.folds),
            "degrees_of_freedom": pattern.degrees_of_freedom,
            "area": format_rational(pattern.area),
            "convex": pattern.is_convex,
            "straight_boundary_vertices": [
                v for v, t in zip(pattern.boundary, pattern.boundary_turns, strict=True) if t == 0
            ],
            "chords": [f"{i}-{j}" for i, j in pattern.chords],
            "degrees": {str(v): pattern.degree(v) for v in pattern.interior},
            "triangulated_triangles": [
                {"corners": list(cycle), "inside": list(inside)}
                for cycle, inside in pattern.triangulated_triangles
            ],
            "foldable_vertices": list(pattern.foldable_vertices),
            "rigidity_rank": self.rigidity_rank,
            "self_stresses": self.self_stresses,
            "inertia": {str(v): list(i) for v, i in self.inertias.items()},
            "sha256": pattern.sha256,
        }

    @property
    def degree_counts(self) -> dict[int, int]:
        """How many interior vertices have each degree."""
        return dict(sorted(Counter(self.pattern.degree(v) for v in self.pattern.interior).items()))


def pattern_facts(pattern: CreasePattern) -> PatternFacts:
    """The exact facts that `exactfold info` reports.

    The rank of the rigidity matrix over Q is bounded below by its rank modulo a prime and above by
    2V - 3 (the rigid motions of the plane); for a triangulated disk the two meet.

    >>> from exactfold.pattern.families import single_vertex
    >>> facts = pattern_facts(single_vertex(5))
    >>> facts.rigidity_rank, facts.self_stresses, facts.inertias
    (9, 1, {5: (1, 2, 3)})
    """
    rank = rigidity_rank(pattern)
    inertias = {v: curvature_form(pattern, v).inertia for v in pattern.interior}
    return PatternFacts(pattern, rank, len(pattern.edges) - rank, inertias)


def rigidity_rank(pattern: CreasePattern) -> int:
    """Rank over Q of the rigidity matrix; exact (see `pattern_facts`)."""
    points, _ = pattern.integer_vertices
    columns = 2 * len(points)
    entries = [0] * (columns * len(pattern.edges))
    for row, (i, j) in enumerate(pattern.edges):
        for axis in (0, 1):
            difference = (points[i][axis] - points[j][axis]) % _PRIME
            entries[row * columns + 2 * i + axis] = difference
            entries[row * columns + 2 * j + axis] = -difference % _PRIME
    rank = int(nmod_mat(len(pattern.edges), columns, entries, _PRIME).rank())
    if rank == columns - 3:
        return rank
    return rational_rank(rigidity_matrix(pattern))
