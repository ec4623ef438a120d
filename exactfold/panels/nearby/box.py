"""All sheets with the panels of a drawing whose vertices lie near the drawn ones."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil, isqrt
from typing import Final

from exactfold.exact.numbers import decimal_above
from exactfold.exact.surds import Number, ball
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opened import Opened, panels
from exactfold.pattern.panel_pattern import PanelPattern

BITS: Final = 40
"""Points are rounded to multiples of 2^-40 of the size, and the radius grows by as much."""
_BALL_BITS: Final = 256
_TIMES: Final = 3
"""The sheet that was meant is looked for within this many times the amount of the noise."""


@dataclass(frozen=True)
class Box:
    """Every sheet with the panels of `sheet` whose vertices lie within a distance of its vertices.

    The distance is `within` times the larger side of `sheet`. "With the panels" means that the
    edges are the same and that the faces run round the same vertices, so that the folds at each
    vertex keep their cyclic order. All decisions are made in integers.
    """

    sheet: PanelPattern
    within: Fraction

    @cached_property
    def points(self) -> tuple[tuple[int, int], ...]:
        """The vertices of the sheet, rounded to whole multiples of 2^-40 of its size."""
        columns = tuple(zip(*self.sheet.vertices, strict=True))
        lows = [min(column) for column in columns]
        size = max(max(column) - low for column, low in zip(columns, lows, strict=True))
        rounded = (
            tuple(_rounded((c - low) / size) for c in column)
            for column, low in zip(columns, lows, strict=True)
        )
        return tuple(zip(*rounded, strict=True))

    @cached_property
    def radius(self) -> int:
        """No vertex of a sheet in the box is further than this from its point in `points`.

        Each coordinate of a point is rounded by at most one unit.
        """
        known: int = ceil(self.within * 2**BITS)
        return known + 2

    @property
    def text(self) -> str:
        """The sheets of the box in words."""
        return (
            f"sheet with these panels whose vertices lie within {float(self.within):g} of the size "
            "from those drawn"
        )

    def turn(self, vertex: int, first: int, second: int) -> int:
        """The sign of the bracket of the directions from a vertex to two others; 0 if the box
        leaves it open.

        The bracket is twice the area of a triangle. If its corners move by at most r, it changes by
        at most r times the perimeter plus 3 r^2.
        """
        o, a, b = (self.points[k] for k in (vertex, first, second))
        area = (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])
        perimeter = _above(o, a) + _above(a, b) + _above(b, o)
        change = self.radius * perimeter + 3 * self.radius**2
        return (area > change) - (area < -change)

    def may_be_straight(self, vertex: int, first: int, second: int) -> bool:
        """Whether the directions from a vertex to two others may be opposite in the box."""
        if self.turn(vertex, first, second):
            return False
        o, a, b = (self.points[k] for k in (vertex, first, second))
        along = (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1])
        r = 2 * self.radius  # by so much a direction changes
        return along <= r * (_above(o, a) + _above(o, b)) + r * r

    def length(self, i: int, j: int) -> int:
        """The distance of two points of the sheet, rounded down, in units of 2^-40."""
        (ax, ay), (bx, by) = self.points[i], self.points[j]
        return isqrt((bx - ax) ** 2 + (by - ay) ** 2)


def box_of(opened: Opened) -> Box | None:
    """The sheets near a drawing whose digits are too inexact to say which sheet was meant.

    They lie within three times the amount by which the drawing misses relations, rounded up to one
    digit. This amount is the noise level that was not believed, or, if a sheet was inferred, the
    largest defect of a relation that it nearly has. None if the digits are exact, or if the sheet
    that was meant is known.
    """
    meant = opened.meant
    if not opened.doubt or meant is None or not meant.left:
        return None
    missed = max(relation.defect for relation in meant.left)
    if meant.noise and not meant.inferred:
        missed = meant.noise
    sheet = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    return Box(sheet, Fraction(decimal_above(_TIMES * Fraction(repr(missed)), 1)))


def _above(a: tuple[int, int], b: tuple[int, int]) -> int:
    """The distance of two points, rounded up."""
    return isqrt((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) + 1


def _rounded(value: Number) -> int:
    """The number times 2^40, rounded to an integer that is less than one unit away."""
    if isinstance(value, (int, Fraction)):
        near: int = round(value * 2**BITS)
        return near
    bits = _BALL_BITS
    while True:
        scaled = ball(value, bits) * 2**BITS
        whole = scaled.mid().floor()
        if abs(scaled - whole) < 1:
            return int(whole.unique_fmpz())
        bits *= 2
