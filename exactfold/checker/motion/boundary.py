"""Given boundary heights, in the ratio of which it stays: the rim path (docs/motion.md, 9).

The heights z of the boundary vertices v are in the ratio of b iff z_v = l b_v + an affine function
of the flat vertex for some number l, the factor: Ve - 4 linear equations.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import gcd, lcm
from typing import Any

from ..core.reading import items, parse_rational, require
from ..sheets.reduced import check_convex
from ..sheets.sheet import Sheet, turn
from .chain import Chain
from .claims import BranchClaim, Document
from .restriction import Restriction, Sign, Tie

Row = dict[int, Fraction]

_MOST_HEIGHTS = 8  # of a boundary in a summary or a message


class BoundaryClaim(BranchClaim):
    """The boundary heights vertices of a convex boundary stay in the ratio of those given.

    They are given in the order of the vertices, and taken above the face `pinned` that is held,
    which is returned. The side of the ray is the sign of the factor near the flat state.
    """

    names = ("rim",)

    def restriction(self, given: Sheet, sheet: Sheet) -> BoundaryHeights:
        """The ties of the heights."""
        return BoundaryHeights(given, self.claims["rim"])

    def check(self, chain: Chain) -> None:
        """The ties hold all along; it remains to say above which face."""
        chain.facts["pinned"] = chain.equations.pinned

    @staticmethod
    def said(claims: Document) -> str:
        """The heights, and the face."""
        face = "-".join(map(str, claims["pinned"]))
        return f", with the boundary in the ratio of {_shown(claims['rim'])} above the face {face}"


class BoundaryHeights(Restriction):
    """The equations `ties` of given heights, and the factor l as a functional of the heights."""

    def __init__(self, sheet: Sheet, texts: Any) -> None:
        super().__init__(sheet)
        check_convex(sheet)
        boundary = sorted(sheet.boundary)
        values = [parse_rational(text) for text in items(texts, "rim", len(boundary))]
        heights = dict(zip(boundary, values, strict=True))
        base = _base(sheet, boundary)
        levels = {v: _level(sheet, base, v) for v in boundary if v not in base}
        above = {v: _value(row, heights) for v, row in levels.items()}
        require(any(above.values()), f"the rim {_shown(texts)} is in one plane: no ratio to keep")
        highest = max(levels, key=lambda v: abs(above[v]))
        self.factor = {v: c / above[highest] for v, c in levels[highest].items()}
        self.ties = [
            _whole(_less(row, self.factor, above[v])) for v, row in levels.items() if v != highest
        ]

        sizes = (abs(c).bit_length() for tie in self.ties for c in tie.values())
        self.tie_bits = max(sizes, default=0)

    def side(self, sign: Sign) -> int:
        """The sign of the factor."""
        return sign(self.factor)


def _base(sheet: Sheet, boundary: list[int]) -> tuple[int, int, int]:
    """Three boundary vertices that are not on one line, far apart."""
    points = sheet.points
    a = boundary[0]
    x, y = points[a]
    b = max(boundary, key=lambda v: (points[v][0] - x) ** 2 + (points[v][1] - y) ** 2)
    return a, b, max(boundary, key=lambda v: abs(turn(points[a], points[b], points[v])))


def _level(sheet: Sheet, base: tuple[int, int, int], v: int) -> Row:
    """The height of v above the plane through the base, as a functional of the heights."""
    p = sheet.points[v]
    a, b, c = (sheet.points[w] for w in base)
    whole = turn(a, b, c)
    parts = turn(p, b, c), turn(a, p, c), turn(a, b, p)
    row = {w: -part / whole for w, part in zip(base, parts, strict=True)}
    return row | {v: Fraction(1)}


def _value(row: Mapping[int, Fraction], heights: Mapping[int, Fraction]) -> Fraction:
    return sum((c * heights[v] for v, c in row.items()), Fraction(0))


def _less(row: Row, other: Row, times: Fraction) -> Row:
    return {v: row.get(v, Fraction(0)) - times * other.get(v, Fraction(0)) for v in row | other}


def _whole(row: Row) -> Tie:
    common = lcm(*(c.denominator for c in row.values()))
    whole = {v: int(c * common) for v, c in row.items() if c}
    divisor = gcd(*whole.values())
    return {v: c // divisor for v, c in whole.items()}


def _shown(heights: list[str]) -> str:
    return ", ".join(heights[:_MOST_HEIGHTS]) + ", ..." * (len(heights) > _MOST_HEIGHTS)
