"""A crease pattern as a picture shows it: points in the picture, and a letter for each line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.drawing.drawing import Drawing

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

Drawable: TypeAlias = "CreasePattern | PanelPattern | Drawing"
"""What can be drawn: sheets of both kinds, and drawings that need not be sheets."""

_SHOWN: Final = {**{letter: letter for letter in "BMVF"}, "J": "F", "C": "B"}
"""The FOLD letters as they are drawn; all other letters are drawn as U."""
_ROUGH: Final = 1 << 60
"""Before exact points become floats, they are rounded to this fraction of the width of
the picture.
"""


@dataclass(frozen=True)
class CreaseLines:
    """Lines between numbered points; `letters[k]`, one of B, M, V, F and U, belongs to `edges[k]`.

    `points` have shape (V, 2) with y upwards; the lower left corner is 0, and the longer side has
    length 1. `interior` are the vertices inside the sheet. `vertices` says whether the points are
    vertices of a sheet.
    """

    points: FloatArray
    edges: tuple[Edge, ...]
    letters: tuple[str, ...]
    interior: tuple[int, ...]
    vertices: bool = True

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height; the larger is 1."""
        if not len(self.points):
            return 1.0, 1.0
        width, height = self.points.max(axis=0)
        return float(width), float(height)

    @cached_property
    def spacing(self) -> float:
        """The typical distance of neighbouring points: a low quantile of the lengths of
        the lines.
        """
        if not self.edges:
            return 1.0
        i, j = np.array(self.edges, dtype=np.intp).T
        lengths = np.linalg.norm(self.points[i] - self.points[j], axis=1)
        return float(np.quantile(lengths, 0.3))

    @cached_property
    def neighbours(self) -> Mapping[int, Sequence[int]]:
        """For each point with lines, the other ends of these lines."""
        around: dict[int, list[int]] = {}
        for i, j in self.edges:
            around.setdefault(i, []).append(j)
            around.setdefault(j, []).append(i)
        return around


def crease_lines(pattern: Drawable, letters: Mapping[Edge, str] | None = None) -> CreaseLines:
    """The lines of a pattern or a drawing, with the letters of its folds.

    Folds without an entry in `letters` have the letter U. A drawing has its own letters.

    >>> from exactfold.pattern.families import single_vertex
    >>> lines = crease_lines(single_vertex(4), {(0, 4): "M"})
    >>> "".join(lines.letters), lines.interior, lines.extent
    ('BBMBUBUU', (4,), (1.0, 1.0))
    """
    given = {} if letters is None else letters
    if isinstance(pattern, Drawing):
        pairs = tuple((line.start, line.end) for line in pattern.lines)
        own = tuple(_SHOWN.get(line.letter, "U") for line in pattern.lines)
        return CreaseLines(_unit(pattern.points), pairs, own, (), vertices=False)
    boundary = set(pattern.boundary_edges)
    own = tuple(
        "B" if edge in boundary else _SHOWN.get(given.get(edge, "U"), "U") for edge in pattern.edges
    )
    return CreaseLines(_unit(pattern.vertices), pattern.edges, own, pattern.interior)


def _unit(points: Sequence[tuple[Any, Any]]) -> FloatArray:
    """Exact points as floats, with the lower left corner at 0 and the longer side 1.

    Differences are computed before numbers become floats, because a small sheet may lie far away,
    and coordinates may exceed the range of floats.
    """
    if not points:
        return np.zeros((0, 2))
    values = [value for point in points for value in point]
    if all(isinstance(value, int | Fraction) for value in values):
        lows = [min(column) for column in zip(*points, strict=True)]
        moved = [[x - low for x, low in zip(point, lows, strict=True)] for point in points]
        span = max(max(point) for point in moved) or 1
        rows = [[int(x * _ROUGH / span) / _ROUGH for x in point] for point in moved]
    else:  # the coordinates contain square roots
        first = points[0]
        rows = [[float(x - low) for x, low in zip(point, first, strict=True)] for point in points]
    coordinates = np.array(rows, dtype=np.float64)
    coordinates = coordinates - coordinates.min(axis=0)
    size = float(coordinates.max(initial=0.0))
    return np.asarray(coordinates / (size or 1.0))
