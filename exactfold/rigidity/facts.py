"""Everything exact that is known about a pattern without solving its branch system."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import (
    FoldText,
    Keywords,
    Natural,
    Rational,
    Several,
    Triangle,
    VertexText,
)
from exactfold._support.progress import Progress
from exactfold.exact.linalg import Inertia
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.near_degeneracy import WarningDocument, warnings
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.self_stress import rigidity_rank


class TriangulatedTriangle(TypedDict):
    """A ring of three folds or sides, and the vertices inside it."""

    corners: Triangle
    inside: Several[Natural]


class PatternFactsDocument(TypedDict):
    """The facts of a triangulated sheet."""

    format: Literal["exactfold info result"]
    version: Literal[2]
    pattern: PatternDocument
    triangles: Natural
    edges: Natural
    area: Rational
    convex: bool
    straight_boundary_vertices: list[Natural]
    chords: list[FoldText]
    """The folds between two boundary vertices."""
    degrees: dict[VertexText, Natural]
    """The number of folds at each interior vertex."""
    triangulated_triangles: list[TriangulatedTriangle]
    foldable_vertices: list[Natural]
    """The interior vertices that lie in no triangulated triangle."""
    rigidity_rank: Natural
    rigidity_rank_by: str
    """What proves the rank: elimination, or a theorem."""
    self_stresses: Natural
    inertia: dict[VertexText, Annotated[list[Natural], Keywords(minItems=3, maxItems=3)]]
    """The inertia of the curvature form of each interior vertex."""
    warnings: list[WarningDocument]


@dataclass(frozen=True)
class PatternFacts:
    """Exact facts about a pattern: counts, rank of the rigidity matrix, inertia of each vertex.

    `rank_by` says what proves the rank: "elimination", or for large sheets a "theorem" (see
    `exactfold.rigidity.self_stress.rigidity_rank`).
    """

    pattern: CreasePattern
    rigidity_rank: int
    self_stresses: int
    inertias: dict[int, Inertia]
    rank_by: str

    def __repr__(self) -> str:
        return (
            f"<PatternFacts: rank {self.rigidity_rank}, {self.self_stresses} self stresses, "
            f"{self.pattern!r}>"
        )

    def to_dict(self, name: str | None = None) -> PatternFactsDocument:
        """The object that `exactfold info --json` prints, without its forecast of a count."""
        pattern = self.pattern
        return {
            "format": "exactfold info result",
            "version": 2,
            "pattern": described(pattern, name),
            "triangles": len(pattern.triangles),
            "edges": len(pattern.edges),
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
            "rigidity_rank_by": self.rank_by,
            "self_stresses": self.self_stresses,
            "inertia": {str(v): list(i) for v, i in self.inertias.items()},
            "warnings": warnings(pattern),
        }

    @property
    def degree_counts(self) -> dict[int, int]:
        """The number of interior vertices of each degree."""
        return dict(sorted(Counter(self.pattern.degree(v) for v in self.pattern.interior).items()))


def pattern_facts(pattern: PatternLike, progress: Progress | None = None) -> PatternFacts:
    """The exact facts that `exactfold info` reports; every inertia is computed.

    >>> from exactfold.pattern.families import single_vertex
    >>> facts = pattern_facts(single_vertex(5))
    >>> facts.rigidity_rank, facts.self_stresses, facts.inertias
    (9, 1, {5: (1, 2, 3)})
    """
    pattern = as_pattern(pattern)
    rank, rank_by = rigidity_rank(pattern)
    inertias = {}
    for k, v in enumerate(pattern.interior):
        if progress is not None and k % 100 == 0:
            progress("curvature forms", k, pattern.Vi)
        inertias[v] = curvature_form(pattern, v).inertia
    return PatternFacts(pattern, rank, len(pattern.edges) - rank, inertias, rank_by)
