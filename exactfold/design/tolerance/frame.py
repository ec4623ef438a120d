"""The sheet whose vertices may move: its doubles, and how far its shape allows moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, Verdict
from exactfold.design.tolerance.closing import Closing
from exactfold.design.tolerance.nearest import Candidate
from exactfold.design.tolerance.result import Tolerance
from exactfold.design.tolerance.shape import Shape, shape_of
from exactfold.errors import NotApplicableError
from exactfold.exact.surds import Number
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.panel_pattern import PanelPattern

LARGEST = 1e100
"""The width of the largest sheet, and one over that of the smallest."""
FARTHEST = 1e9
"""How far from the origin a sheet may lie, in its widths."""
DOWN = 1.0 - 2.0**-40
"""A factor by which a radius is rounded down."""


def check_extent(pattern: CreasePattern | PanelPattern) -> None:
    """Raise `NotApplicableError` for a sheet of a size or place that doubles do not hold well."""
    try:
        points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    except OverflowError:
        points = np.full((1, 2), inf)
    with np.errstate(all="ignore"):
        width = float(np.ptp(points, axis=0).max())
    if not (1 / LARGEST < width < LARGEST and np.abs(points).max() < FARTHEST * width):
        raise NotApplicableError(
            f"the test in doubles takes sheets from {1 / LARGEST:.0e} to {LARGEST:.0e} wide that "
            f"lie within {FARTHEST:.0e} widths of the origin: scale or move this one"
        )


@dataclass(frozen=True, eq=False)
class Frame:
    """The sheet as doubles, how far these are off, and how far its shape allows moves."""

    pattern: CreasePattern | PanelPattern
    points: FloatArray
    off: float
    shape: Shape
    shortest: float
    guard: float = inf
    guards: tuple[float, ...] = ()

    @classmethod
    def of(cls, pattern: CreasePattern | PanelPattern, polygons: Sequence[Sequence[int]]) -> Frame:
        """The frame of a sheet whose `polygons` have to stay simple."""
        points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
        edges = np.array(pattern.edges)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        off = max(_off(x, y, p) for (x, y), p in zip(pattern.vertices, points, strict=True))
        return cls(pattern, points, off, shape_of(points, polygons), float(lengths.min()))

    @property
    def largest(self) -> float:
        """The radius that the shape of the sheet and its flat folds allow."""
        return max(0.0, min(self.shape.all_move, self.guard) - 2 * self.off) * DOWN

    def alone(self, vertex: int) -> float:
        """The same for moves of one vertex."""
        guard = self.guards[vertex] if self.guards else inf
        return max(0.0, min(self.shape.one_moves[vertex], guard) - 2 * self.off) * DOWN

    def moved(self, candidate: Candidate) -> list[tuple[Number, Number]]:
        """The exact vertices of the sheet of a candidate."""
        pairs = zip(self.pattern.vertices, candidate.moves, strict=True)
        return [(x + dx, y + dy) for (x, y), (dx, dy) in pairs]

    def nothing(
        self,
        status: Verdict,
        reason: str,
        way: str,
        ways: int,
        limit: str,
        closings: tuple[tuple[int, Closing], ...] = (),
    ) -> Tolerance:
        """The result with the radius 0."""
        return Tolerance(
            self.pattern,
            status,
            reason,
            way,
            ways,
            0.0,
            0.0 if status is PROVED else None,
            None,
            limit,
            None,
            dict.fromkeys(range(len(self.points)), 0.0),
            closings,
            self.shortest,
        )

    def of_shape(self, reason: str, way: str, ways: int) -> Tolerance:
        """The result if nothing but the shape of the panels limits the radius."""
        return replace(
            self.nothing(PROVED, reason, way, ways, self.pinched),
            radius=self.largest,
            upper=self.upper,
            vertices={v: self.alone(v) for v in range(len(self.points))},
        )

    @property
    def upper(self) -> float:
        """A radius within which panels lose their shape, rounded up."""
        return (self.shape.all_move + self.off) * (1 + 2.0**-40)

    @property
    def pinched(self) -> str:
        """What happens at `upper`."""
        v, (a, b) = self.shape.pinched, sorted(self.shape.edge)
        return f"vertex {v} comes to lie on the line of edge {a}-{b}, and a panel has no shape"


def _off(x: Number, y: Number, point: FloatArray) -> float:
    """How far an exact point lies from its double, rounded up."""
    if isinstance(x, Fraction | int) and isinstance(y, Fraction | int):
        dx, dy = x - Fraction(float(point[0])), y - Fraction(float(point[1]))
        return float(abs(dx) + abs(dy)) * (1 + 2.0**-40)
    return float(np.abs(point).max()) * 2.0**-48
