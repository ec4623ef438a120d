"""Points and lines of a folded sheet, with exact signs.

Points that coincide have one number, and so have lines: coordinates in the field of the sheet are
unique. A line is a x + b y = c, with b = 1, or with a = 1 and b = 0. Its direction is (b, -a), and
a x + b y - c is positive on its left.

Signs are found with integers where these decide. A number z is given by an integer m with
|2^k z - m| <= 2 (`rounded`). If no m is larger than S, a product of n of them is off by at most
(S + 2)^n - S^n, in units of 2^-nk. So a x + b y - c is off by at most

    2 (|m_a| + |m_b| + |m_x| + |m_y|) + 8 + 2 * 2^k,

the cross product of two directions by 8 (S + 2), and the determinant of three lines, a sum of six
products, by 36 (S + 2)^2. What is not further from 0 is computed exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

from ..core.towers import Number, Parts
from ..sheets.panels import Edge, Vector
from .folding import FoldedSheet

Row = TypeVar("Row")
_BITS = 64  # of the larger coordinates, rounded to integers


class Line(NamedTuple):
    """The line a x + b y = c."""

    a: Number
    b: Number
    c: Number


class Spot(NamedTuple):
    """A point, and its coordinates as rounded integers."""

    x: Number
    y: Number
    mx: int
    my: int


class Plane:
    """The images of the vertices and edges of a folded sheet: numbered points and lines.

    `spots` are the points, `spot_of` has the number of the point of each vertex.
    """

    def __init__(self, folded: FoldedSheet) -> None:
        self.folded = folded
        self.bits = _BITS
        numbers = [c for point in folded.sheet.points for c in point]
        while max(abs(rounded(c, self.bits)) for c in numbers) >> _BITS // 2 == 0:
            self.bits += _BITS
        self.spots: list[Spot] = []
        self.spot_of: dict[int, int] = {}
        known: dict[tuple[Parts, Parts], int] = {}
        for v, (x, y) in sorted(folded.points.items()):
            number = known.setdefault((x.parts, y.parts), len(self.spots))
            if number == len(self.spots):
                self.spots.append(self.spot((x, y)))
            self.spot_of[v] = number
        self._largest = max(abs(m) for spot in self.spots for m in (spot.mx, spot.my))
        self._lines: list[tuple[Line, int, int, int, int]] = []
        self._known_lines: dict[tuple[Parts, Parts | None], int] = {}
        self._line_of: dict[Edge, int] = {}
        self._halves: dict[Edge, tuple[int, int]] = {}
        self._turns: dict[tuple[int, int], int] = {}
        self._determinants: dict[tuple[int, ...], int] = {}

    def spot(self, point: Vector) -> Spot:
        """A point with its rounded coordinates."""
        x, y = point
        return Spot(x, y, rounded(x, self.bits), rounded(y, self.bits))

    def line(self, edge: Edge) -> int:
        """The number of the line on which the image of an edge lies."""
        i, j = sorted(edge)
        if (i, j) not in self._line_of:
            p, q = (self.spots[self.spot_of[v]] for v in (i, j))
            dx, dy = q.x - p.x, q.y - p.y
            one, zero = (self.folded.tower.number(n) for n in (1, 0))
            if dx.sign():
                slope = dy / dx
                line = Line(-slope, one, p.y - slope * p.x)
                key: tuple[Parts, Parts | None] = line.a.parts, line.c.parts
            else:
                line = Line(one, zero, p.x)
                key = line.c.parts, None
            number = self._known_lines.setdefault(key, len(self._lines))
            if number == len(self._lines):
                ma, mb, mc = (rounded(c, self.bits) for c in line)
                bound = 2 * (abs(ma) + abs(mb)) + 8 + (2 << self.bits)
                self._lines.append((line, ma, mb, mc << self.bits, bound))
            self._line_of[i, j] = number
        return self._line_of[i, j]

    def half(self, side: Edge) -> tuple[int, int]:
        """The line of a directed side of a piece, and the side of it where the piece lies: 1 or -1.

        The piece is on the left of its side, or on the right if it is turned over; the side points
        in the direction of its line, or against it.
        """
        if side not in self._halves:
            p, q = (self.spots[self.spot_of[v]] for v in side)
            along = (q.x - p.x).sign() or (p.y - q.y).sign()
            inner = along if self.folded.up[self.folded.beside[side]] else -along
            self._halves[side] = self.line(side), inner
        return self._halves[side]

    def is_inside(self, spot: Spot, edge: Edge) -> bool:
        """Whether a point of the line of an edge lies between the two ends of its image."""
        p, q = (self.spots[self.spot_of[v]] for v in edge)
        return compare(p, spot) * compare(spot, q) > 0

    def side(self, line: int, spot: Spot) -> int:
        """1 if a point lies on the left of a line, -1 on its right, and 0 on the line."""
        exact, ma, mb, mc, bound = self._lines[line]
        value = ma * spot.mx + mb * spot.my - mc
        if abs(value) > bound + 2 * (abs(spot.mx) + abs(spot.my)):
            return 1 if value > 0 else -1
        return self._side_exactly(exact, spot)

    def sides(self, line: int) -> list[int]:
        """The sides on which all `spots` lie, as `side` finds them one by one."""
        exact, ma, mb, mc, bound = self._lines[line]
        bound += 4 * self._largest
        low, high = mc - bound, mc + bound
        values = [ma * spot.mx + mb * spot.my for spot in self.spots]
        return [
            1 if value > high else -1 if value < low else self._side_exactly(exact, spot)
            for value, spot in zip(values, self.spots, strict=True)
        ]

    def _side_exactly(self, line: Line, spot: Spot) -> int:
        if line.b.sign() == 0:
            return (spot.x - line.c).sign()
        return (line.a * spot.x + spot.y - line.c).sign()

    def misses(self, lines: tuple[int, int, int], inner: tuple[int, int, int]) -> bool:
        """Whether three open half planes, any two of which meet, have no point in common.

        Half plane k lies on the left of line k where inner[k] is 1, on its right where it is -1. It
        has the points z with n_k z > c_k. By Farkas' lemma there is no common point if and only if
        some numbers w_k >= 0, not all 0, have w_1 n_1 + w_2 n_2 + w_3 n_3 = 0 and
        w_1 c_1 + w_2 c_2 + w_3 c_3 >= 0. If the n_k are parallel, there is one: three open
        intervals of a line, any two of which meet. Otherwise the w_k are
        n_2 x n_3, n_3 x n_1, n_1 x n_2, up to a factor. If one of them is 0, the other two would be
        about two half planes that do not meet. So all have one sign, and the second condition is
        about the determinant of the three lines.
        """
        k, m, n = lines
        turns = (
            self._turn(m, n) * inner[1] * inner[2],
            self._turn(n, k) * inner[2] * inner[0],
            self._turn(k, m) * inner[0] * inner[1],
        )
        if turns not in ((1, 1, 1), (-1, -1, -1)):
            return False
        return self._determinant(k, m, n) * inner[0] * inner[1] * inner[2] * turns[0] >= 0

    def _turn(self, first: int, second: int) -> int:
        """The sign of the cross product of the normals (a, b) of two lines."""
        key = first, second
        if key not in self._turns:
            one, a, b, _, _ = self._lines[first]
            other, c, d, _, _ = self._lines[second]
            value = a * d - b * c
            if abs(value) <= 8 * (max(abs(a), abs(b), abs(c), abs(d)) + 2):
                value = (one.a * other.b - one.b * other.a).sign()
            self._turns[key] = (value > 0) - (value < 0)
        return self._turns[key]

    def _determinant(self, k: int, m: int, n: int) -> int:
        """The sign of the determinant of the coefficients (a, b, c) of three lines."""
        key = k, m, n
        if key not in self._determinants:
            rows = [self._lines[number] for number in key]
            integers = [(a, b, c >> self.bits) for _, a, b, c, _ in rows]
            most = max(abs(c) for row in integers for c in row)
            value = sum(p[2] * (q[0] * r[1] - q[1] * r[0]) for p, q, r in _cyclic(integers))
            if abs(value) <= 36 * (most + 2) ** 2:
                exact = [row[0] for row in rows]
                terms = [p.c * (q.a * r.b - q.b * r.a) for p, q, r in _cyclic(exact)]
                value = (terms[0] + terms[1] + terms[2]).sign()
            self._determinants[key] = (value > 0) - (value < 0)
        return self._determinants[key]


def _cyclic(rows: Sequence[Row]) -> list[tuple[Row, Row, Row]]:
    p, q, r = rows
    return [(p, q, r), (q, r, p), (r, p, q)]


def compare(p: Spot, q: Spot) -> int:
    """-1, 0 or 1 by the order of two points from left to right, or upwards on a vertical."""
    return (p.x - q.x).sign() or (p.y - q.y).sign()


def rounded(number: Number, bits: int) -> int:
    """An integer m with |2^bits z - m| <= 2, for a number z."""
    extra = 0
    while True:
        found = number.enclosed(bits + extra)
        if found.high - found.low <= 1 << extra:
            return found.low >> extra
        extra += 32
