"""Warns if relations between the creases of a pattern hold nearly, but not exactly.

If a coordinate is rounded, a straight crease path, a flat vertex or a corner of 180 degrees is
lost. The count of the rounded pattern is right, but says nothing about the pattern that was meant.
The warning is never part of a proof.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypedDict

from exactfold._support.documents import Natural, Several
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.meant.left import left_relations, nearly
from exactfold.pattern.drawing.meant.values import Relation
from exactfold.pattern.loading import PatternLike, as_pattern


class WarningDocument(TypedDict):
    """A warning: something nearly holds, and if it held exactly, the result might be another."""

    vertices: Several[Natural]
    """The vertices at which relations nearly hold or folds are nearly flat."""
    text: str
    """What is printed."""


@dataclass(frozen=True)
class NearDegeneracy:
    """The relations that a pattern nearly has but does not have exactly, the nearest first."""

    relations: tuple[Relation, ...]

    @property
    def text(self) -> str:
        """The warning in words: what nearly holds, and what it means for the answer."""
        return f"{nearly(self.relations)}, so that answers hold only for these digits"

    def to_dict(self) -> WarningDocument:
        """The warning as JSON: the vertices and the text."""
        shared = (set[int].intersection(*(set(e) for e, _ in r.terms)) for r in self.relations)
        vertices = sorted({v for vertices in shared for v in vertices})
        return {"vertices": vertices, "text": self.text}

    def __repr__(self) -> str:
        return f"<NearDegeneracy: {nearly(self.relations)}>"


def near_degenerate(pattern: PatternLike) -> NearDegeneracy | None:
    """The relations between creases that a pattern nearly has; None if there are none.

    These are straight paths, straight borders, and Kawasaki sums (`left_relations`). The result
    None does not mean that the pattern is generic, and a result does not mean that the pattern was
    meant to be degenerate.

    >>> rounded = CreasePattern(
    ...     [(0, 0), (3, 0), (2, 2), (0, 1), ("0.3333333333333", "0.3333333333333001")],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> near_degenerate(rounded)
    <NearDegeneracy: one relation nearly holds, straight@4:0-2, off by 3e-17 of the size>
    >>> near_degenerate("two-vertex") is None
    True
    """
    relations = left_relations(as_pattern(pattern))
    return NearDegeneracy(relations) if relations else None


def warnings(pattern: CreasePattern) -> list[WarningDocument]:
    """Warnings, as JSON, that a designer should read before the count; often there is none.

    >>> from exactfold.pattern.families import two_vertex
    >>> warnings(two_vertex())
    []
    """
    degeneracy = near_degenerate(pattern)
    return [] if degeneracy is None else [degeneracy.to_dict()]
