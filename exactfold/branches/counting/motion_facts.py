"""Facts about a sheet of rigid panels that are known before its motions are decomposed."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Literal, TypedDict

from exactfold._support.documents import (
    Empty,
    FieldName,
    FoldText,
    Natural,
    Positive,
    Several,
    VertexText,
)
from exactfold._support.plurals import agreeing, counted
from exactfold.panels.vertex.holes import conditions, free_folds, vertices_of
from exactfold.pattern.described import PanelsDocument, described_panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.rigidity.facts import PatternFactsDocument


class PanelKeys(TypedDict):
    """The keys for facts that only sheets of panels have."""

    panels: Positive
    field: FieldName
    flat_folds: list[FoldText]
    free_folds: list[FoldText]
    parts: list[Several[Natural]]
    """Each part lists interior vertices, and those of holes, that folds that may fold connect."""


class PanelFactsDocument(PanelKeys):
    """The facts of a sheet of rigid panels; keys for triangulated sheets are null."""

    format: Literal["exactfold info result"]
    version: Literal[2]
    pattern: PanelsDocument
    edges: Natural
    degrees: dict[VertexText, Natural]
    triangles: None
    area: None
    convex: None
    straight_boundary_vertices: None
    chords: None
    triangulated_triangles: None
    foldable_vertices: None
    rigidity_rank: None
    rigidity_rank_by: None
    self_stresses: None
    inertia: None
    warnings: Empty
    expected: str


class DecomposedFactsDocument(PatternFactsDocument, PanelKeys):
    """The facts of a triangulated sheet whose motions are decomposed."""

    expected: str


@dataclass(frozen=True)
class PanelFacts:
    """Facts about a sheet of rigid panels that need no solving.

    `degrees` has the number of folds at each interior vertex. The folds `flat` stay flat in every
    real motion. The folds `free` have both ends on the boundary; if the sheet has holes, it falls
    apart without each of them. All other folds may fold: each of `parts` lists vertices that such
    folds connect, also those of holes, and `moving` has their number at each.
    """

    pattern: PanelPattern
    degrees: dict[int, int]
    flat: tuple[Edge, ...]
    free: tuple[Edge, ...]
    parts: tuple[tuple[int, ...], ...]
    moving: dict[int, int]

    @property
    def degree_counts(self) -> dict[int, int]:
        """How many interior vertices have each degree."""
        return dict(sorted(Counter(self.degrees.values()).items()))

    @property
    def expected(self) -> str:
        """What `count` will find or compute, in words."""
        if not self.parts:
            if not self.free:
                return "rigid: no fold can fold while the panels stay rigid"
            each = "folds" if len(self.free) == 1 else "each folds"
            return f"{counted(len(self.free), 'fold')} from boundary to boundary, {each} freely"
        round_holes = {v for hole in self.pattern.holes for v in hole}
        large = sum(
            any(v in round_holes or self.moving[v] > 4 for v in part) for part in self.parts
        )
        whole = f"{counted(len(self.parts), 'part')} with vertices that may fold"
        if round_holes:
            whole = f"{counted(len(self.parts), 'part')} with vertices or holes that may fold"
        where = f"{'holes or ' if round_holes else ''}vertices of more than four folds"
        if not large:
            return (
                f"{whole}, at most four folds at each: all ways to fold, by the structure theorem"
            )
        return (
            f"{whole}, {large} of them with {where}: all ways to fold by "
            "splitting linear spaces, where few enough motions are possible to first order"
        )

    def keys(self) -> PanelKeys:
        """The JSON keys for facts that only sheets of panels have."""
        return {
            "panels": len(self.pattern.faces),
            "field": self.pattern.field_name,
            "flat_folds": [f"{i}-{j}" for i, j in self.flat],
            "free_folds": [f"{i}-{j}" for i, j in self.free],
            "parts": [list(part) for part in self.parts],
        }

    def to_dict(self, name: str | None = None) -> PanelFactsDocument:
        """The object printed by `exactfold info --json`: `schema("info")`.

        Keys for triangulated sheets are null.
        """
        return {
            "format": "exactfold info result",
            "version": 2,
            "pattern": described_panels(self.pattern, name),
            "edges": len(self.pattern.edges),
            "degrees": {str(v): n for v, n in self.degrees.items()},
            "triangles": None,
            "area": None,
            "convex": None,
            "straight_boundary_vertices": None,
            "chords": None,
            "triangulated_triangles": None,
            "foldable_vertices": None,
            "rigidity_rank": None,
            "rigidity_rank_by": None,
            "self_stresses": None,
            "inertia": None,
            "warnings": [],
            **self.keys(),
            "expected": self.expected,
        }

    def __repr__(self) -> str:
        stay = agreeing(len(self.flat), "stays")
        return (
            f"<PanelFacts: {counted(len(self.parts), 'part')}, {counted(len(self.flat), 'fold')} "
            f"{stay} flat, {self.pattern!r}>"
        )


def panel_facts(pattern: PanelPattern) -> PanelFacts:
    """The facts about a sheet of panels that `exactfold info` reports.

    >>> cross = PanelPattern([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)])
    >>> panel_facts(cross)
    <PanelFacts: 1 part, 0 folds stay flat, <PanelPattern: 1 interior vertex, 4 folds, 4 panels>>
    >>> panel_facts(cross).expected
    '1 part with vertices that may fold, at most four folds at each: all ways to fold, by the
    structure theorem'
    """
    from exactfold.panels.decomposition import groups_of  # it loads NumPy

    moving = conditions(pattern)
    free = free_folds(pattern)
    active = {edge for star in moving.values() for edge in star.folds}
    return PanelFacts(
        pattern,
        {v: len(near) for v, near in pattern.stars.items()},
        tuple(edge for edge in pattern.folds if edge not in active and edge not in free),
        free,
        tuple(vertices_of(pattern, group) for group in groups_of(moving)),
        {v: len(star.folds) for v, star in moving.items()},
    )
