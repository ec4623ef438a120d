"""The outlines of plates: the corners of panels that are cut back from their folds.

The corners of a plate are where the sides of its panel meet after all folds among them were moved
inwards by `trim`; where two sides in one line are moved by different widths, both ends of the step
are corners.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import Any

from ...core.intervals import Interval
from ...core.reading import keys, parse_rational, require
from ...sheets.panels import PanelSheet, cross, pair
from .drive import length
from .places import Carried
from .series import BITS, thin

Spot = tuple[Interval, Interval]
HINGES = "middle", "valley"
NEAR = 1 - Fraction(1, 1 << 30)
"""Corners are proved to be farther from a fold than this part of the trim."""


class Solid:
    """The thickness of the plates of a file, where their hinges lie, and how far they are cut back.

    All lengths are in the unit of the scaled sheet, of which `factor` is one.
    """

    def __init__(self, given: Any, factor: Fraction) -> None:
        keys(given, "thickness hinge trim", "plates")
        thickness, trim = (parse_rational(given[name]) for name in ("thickness", "trim"))
        require(thickness > 0, "the thickness is not positive")
        require(trim > 0, "the trim is not positive")
        require(given["hinge"] in HINGES, "the hinges are neither in the middle nor on one side")
        self.thickness, self.trim = thickness * factor, trim * factor
        upper = Fraction(0) if given["hinge"] == "valley" else self.thickness / 2
        self.heights = upper - self.thickness, upper

    def depth(self, letter: str) -> Fraction:
        """How far plates reach beyond the sheet on the side on which a fold closes."""
        return self.heights[1] if letter == "V" else -self.heights[0]


class Outlines:
    """The corners of all plates, and the triangles into which they are cut."""

    def __init__(self, sheet: PanelSheet, solid: Solid) -> None:
        self.sheet, self.solid = sheet, solid
        self.points: list[tuple[int, Spot]] = []
        self.triangles: list[list[tuple[int, int, int]]] = []
        self._folds = set(sheet.folds)
        for panel, corners in enumerate(sheet.panels):
            first = len(self.points)
            outline = self._outline(corners)
            self.points += [(panel, spot) for _, spot in outline]
            cut = self._cut(corners, outline)
            self.triangles.append([(a + first, b + first, c + first) for a, b, c in cut])

    def _width(self, i: int, j: int) -> Interval:
        trim = self.solid.trim if pair(i, j) in self._folds else Fraction(0)
        return Interval.of(trim, BITS)

    def _outline(self, corners: tuple[int, ...]) -> list[tuple[int, Spot]]:
        """The corners of a plate, each with the vertex from which it was moved."""
        sheet, outline = self.sheet, []
        for k, v in enumerate(corners):
            u, w = corners[k - 1], corners[(k + 1) % len(corners)]
            (px, py), (qx, qy) = self.direction(u, v), self.direction(v, w)
            before, after = self._width(u, v), self._width(v, w)
            x, y = map(thin, sheet.points[v])
            if cross(sheet.vector(u, v), sheet.vector(v, w)).sign():
                turn = px * qy - py * qx
                a, b = before / turn, after / turn
                outline.append((v, (x + a * qx - b * px, y + a * qy - b * py)))
                continue
            outline.append((v, (x - py * before, y + px * before)))
            if before.low != after.low:
                outline.append((v, (x - qy * after, y + qx * after)))
        return outline

    def direction(self, i: int, j: int) -> Spot:
        """The unit vector from one vertex to another."""
        size = length(self.sheet, i, j)
        x, y = (thin(c) / size for c in self.sheet.vector(i, j))
        return x, y

    def _cut(
        self, corners: tuple[int, ...], outline: list[tuple[int, Spot]]
    ) -> list[tuple[int, int, int]]:
        """Ears of an outline that is proved to be simple, with sides that point as before.

        As in the panel, they turn once, counter-clockwise.
        """
        spots, count = [spot for _, spot in outline], len(outline)
        sides = [(k, (k + 1) % count) for k in range(count)]
        gone = f"the panel {corners} cannot be cut back so far"
        for i, j in sides:
            v, w = outline[i][0], outline[j][0]
            if v != w:
                (px, py), (x, y) = self.direction(v, w), _way(spots[i], spots[j])
                require((px * x + py * y).sign() > 0, gone)
        for (a, b), (c, d) in combinations(sides, 2):
            p, q, r, s = (spots[k] for k in (a, b, c, d))
            apart = {a, b} & {c, d} or _one_side(p, q, r, s) or _one_side(r, s, p, q)
            require(apart, gone)
        left, triangles = list(range(count)), []
        while len(left) > 3:  # every simple polygon has an ear (`cut`)
            k = min(k for k in range(len(left)) if _is_ear(spots, left, k))
            triangles.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
            del left[k]
        a, b, c = left
        return [*triangles, (a, b, c)]

    @property
    def carried(self) -> list[Carried]:
        """Each corner below and above: its panel, its place in the flat sheet, and an error."""
        return [
            (panel, (*spot, Interval.of(height, BITS)))
            for panel, spot in self.points
            for height in self.solid.heights
        ]

    def far(self, triangle: tuple[int, int, int], i: int, j: int) -> bool:
        """Whether a triangle lies to the left of a line, farther than a part of the trim."""
        ux, uy = self.direction(i, j)
        x, y = map(thin, self.sheet.points[i])
        least = Interval.of(self.solid.trim * NEAR, BITS)
        return all(
            (ux * (q - y) - uy * (p - x) - least).sign() > 0
            for p, q in (self.points[k][1] for k in triangle)
        )


def _way(p: Spot, q: Spot) -> Spot:
    return q[0] - p[0], q[1] - p[1]


def _turn(p: Spot, q: Spot, r: Spot) -> Interval:
    (a, b), (c, d) = _way(p, q), _way(p, r)
    return a * d - b * c


def _one_side(p: Spot, q: Spot, r: Spot, s: Spot) -> bool:
    return _turn(p, q, r).sign() * _turn(p, q, s).sign() > 0


def _is_ear(spots: list[Spot], left: list[int], k: int) -> bool:
    a, b, c = (spots[m] for m in (left[k - 1], left[k], left[(k + 1) % len(left)]))
    if _turn(a, b, c).sign() <= 0:
        return False
    others = [
        spots[m] for n, m in enumerate(left) if (n - k) % len(left) not in (0, 1, len(left) - 1)
    ]
    return all(
        any(_turn(p, q, other).sign() < 0 for p, q in ((a, b), (b, c), (c, a))) for other in others
    )
