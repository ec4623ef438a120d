"""Motions on which the boundary keeps the ratio of given heights (docs/motion.md, 9).

The heights z_v of the boundary vertices are in the ratio of b if and only if, for some number l
called the factor, z_v = l b_v + an affine function of the flat vertex. These are Ve - 4 linear
equations for Ve boundary vertices.
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

_MOST_HEIGHTS = 8  # boundary heights that a summary or a message shows


class BoundaryClaim(BranchClaim):
    """The boundary is convex, and the heights of its vertices stay in the ratio of given heights.

    The given heights are in increasing order of the vertices. Heights are measured above the held
    face `pinned`, which the check returns. The side of the ray is the sign of the factor near the
    flat state.
    """

    names = ("rim",)

    def restriction(self, given: Sheet, sheet: Sheet) -> BoundaryHeights:
        """The linear equations of the ratio."""
        return BoundaryHeights(given, self.claims["rim"])

    def check(self, chain: Chain) -> None:
        """Say above which face the heights are measured; the equations already hold all along."""
        chain.facts["pinned"] = chain.equations.pinned

    @staticmethod
    def said(claims: Document) -> str:
        """The given heights, and the face above which they are measured."""
        face = "-".join(map(str, claims["pinned"]))
        return f", with the boundary in the ratio of {_shown(claims['rim'])} above the face {face}"


class BoundaryHeights(Restriction):
    """The equations `ties` that keep the ratio; the functional `factor` of the heights is l."""

    def __init__(self, sheet: Sheet, texts: Any) -> None:
        super().__init__(sheet)
        check_convex(sheet)
        boundary = sorted(sheet.boundary)
        values = [parse_rational(text) for text in items(texts, "rim", len(boundary))]
        heights = dict(zip(boundary, values, strict=True))
        base = _base(sheet, boundary)
        levels = {v: _level(sheet, base, v) for v in boundary if v not in base}
        above = {v: _value(row, heights) for v, row in levels.items()}
        bent = any(above.values())
        require(bent, f"the given heights {_shown(texts)} lie in one plane: there is no ratio")
        highest = max(levels, key=lambda v: abs(above[v]))
        self.factor = {v: c / above[highest] for v, c in levels[highest].items()}
        self.ties = [
            _whole(_less(row, self.factor, above[v])) for v, row in levels.items() if v != highest
        ]

        sizes = (abs(c).bit_length() for tie in self.ties for c in tie.values())
        self.tie_bits = max(sizes, default=0)

    def side(self, sign: Sign) -> int:
        """The sign of the factor at the flat state."""
        return sign(self.factor)


def _base(sheet: Sheet, boundary: list[int]) -> tuple[int, int, int]:
    """Three boundary vertices that are far apart and not on one line."""
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
