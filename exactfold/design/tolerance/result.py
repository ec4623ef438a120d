"""How far the vertices of a sheet may move before the answer changes, with all that is proved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, TypedDict

from exactfold._support.documents import (
    Natural,
    NotNegative,
    Pair,
    Rational,
    VerdictText,
    VertexText,
)
from exactfold._support.verdict import Verdict
from exactfold.design.tolerance.closing import Closing, ClosingDocument
from exactfold.design.tolerance.sampling import Estimate
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PanelsDocument, PatternDocument, described, described_panels

if TYPE_CHECKING:
    from fractions import Fraction

    from exactfold.pattern.panel_pattern import PanelPattern


class ChangedDocument(TypedDict):
    """A sheet with another answer."""

    what: str
    """What is different there."""
    moves: dict[VertexText, Pair[Rational]]
    """By vertex, the exact displacement from the given sheet."""


class EstimateDocument(TypedDict):
    """A radius from random moves, in floating point."""

    radius: NotNegative
    """Within it, about one sheet in twenty has another answer."""
    samples: Natural
    """The number of random moves."""
    seed: Natural


class ToleranceDocument(TypedDict):
    """How far the vertices may move before the answer changes."""

    format: Literal["exactfold tolerance result"]
    version: Literal[1]
    pattern: PatternDocument | PanelsDocument
    status: VerdictText
    """`proved` if `radius` is positive, or proved to be 0."""
    reason: str
    way: str
    """The way whose letters are kept; empty for all ways."""
    ways: Natural
    """The number of ways that are kept."""
    radius: NotNegative
    """If all vertices move by less, the ways stay, with the same letters; in units of the
    coordinates, rounded down."""
    relative: NotNegative
    """`radius` as a share of the shortest edge, rounded down."""
    upper: NotNegative | None
    """Within this radius there is a sheet with another answer, or no sheet."""
    changed: ChangedDocument | None
    """The sheet that shows `upper`; null if panels lose their shape there."""
    limit: str
    """What happens at `upper`, or which relation is lost first."""
    estimate: EstimateDocument | None
    """From random moves; null without isolated ways."""
    vertices: dict[VertexText, NotNegative]
    """By vertex, a proved radius for moves of this vertex alone."""
    loops: list[ClosingDocument]
    """The relations that ways need, the most sensitive first."""
    shortest: NotNegative
    """The length of the shortest edge, in floating point."""
    seconds: NotNegative


@dataclass(frozen=True)
class Changed:
    """A sheet with another answer: what is different, and the exact displacements of vertices."""

    what: str
    moves: tuple[tuple[Fraction, Fraction], ...]

    def to_dict(self) -> ChangedDocument:
        """The object in the JSON output."""
        return {
            "what": self.what,
            "moves": {
                str(v): [format_rational(x), format_rational(y)]
                for v, (x, y) in enumerate(self.moves)
                if x or y
            },
        }


@dataclass(frozen=True, repr=False)
class Tolerance:
    """How far the vertices of a sheet may move before its ways, or their letters, change.

    All sheets whose vertices move by less than `radius`, each within a disk, have the same number
    of ways with the same letters, or, if `way` names one, this way with its letters
    (docs/tolerance.md, 1). `vertices` has such a radius for each vertex if the others stay. Both
    are 0 where nothing is proved; the status is PROVED if `radius` is positive or proved to be 0.
    Within `upper` some sheet has another answer: `changed` is one, or panels lose their shape
    there, and `limit` says what happens. `estimate` comes from random moves. `closings` are the
    relations that ways of rigid panels need, each with the number of the first way that needs it.
    `motions` are the densities of all folds on each way that is kept, in floats; it is empty where
    the sheet has several parts, or ways that are not real, as no certificate is known for these.
    """

    pattern: CreasePattern | PanelPattern
    status: Verdict
    reason: str
    way: str
    ways: int
    radius: float
    upper: float | None
    changed: Changed | None
    limit: str
    estimate: Estimate | None
    vertices: Mapping[int, float]
    closings: tuple[tuple[int, Closing], ...]
    shortest: float
    seconds: float = field(default=0.0, compare=False)
    motions: tuple[tuple[float, ...], ...] = field(default=(), compare=False)

    @property
    def relative(self) -> float:
        """The radius as a share of the shortest edge, rounded down."""
        return self.radius / self.shortest * (1 - 2.0**-40)

    def to_dict(self, name: str | None = None) -> ToleranceDocument:
        """The object printed by `exactfold tolerance --json`: `schema("tolerance")`."""
        pattern = self.pattern
        guessed = self.estimate
        return {
            "format": "exactfold tolerance result",
            "version": 1,
            "pattern": described(pattern, name)
            if isinstance(pattern, CreasePattern)
            else described_panels(pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "way": self.way,
            "ways": self.ways,
            "radius": self.radius,
            "relative": self.relative,
            "upper": self.upper,
            "changed": None if self.changed is None else self.changed.to_dict(),
            "limit": self.limit,
            "estimate": None
            if guessed is None
            else {
                "radius": guessed.radius,
                "samples": guessed.samples,
                "seed": guessed.seed,
            },
            "vertices": {str(v): radius for v, radius in sorted(self.vertices.items())},
            "loops": [closing.to_dict(way) for way, closing in self.closings],
            "shortest": self.shortest,
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        upper = "" if self.upper is None else f" of at most {self.upper:.3g}"
        what = f" of {self.way}" if self.way else ""
        return f"<Tolerance{what}: {self.status}, {self.radius:.3g}{upper}>"
