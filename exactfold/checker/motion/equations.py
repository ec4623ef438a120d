"""The length equations of a sheet with one triangle held, on curves of integers over 2^bits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import lcm
from operator import add, mul, sub

from ..core.krawczyk import inverse
from ..core.reading import require
from ..sheets.sheet import Sheet
from .bounds import INVERSE_BITS, Columns, Vector, dot
from .restriction import Restriction, Tie

ORDER = 8  # the degree of the polynomial of a piece
SPARE = 60  # bits before the binary point
Curve = list[Vector]
"""A polynomial in s with vector coefficients; row k is the coefficient of s^k."""

Parts = list[list[tuple[int, ...]]]
"""For every coefficient of a curve, the differences a_e = a_i - a_j of all bars e = (i, j)."""

Coefficient = Callable[[Curve, Parts, int], Vector]


class LengthEquations:
    """The equations g_e(d) = U_e . d_e + |d_e|^2 / 2 = 0 for every edge e with a free end.

    U are the flat positions and d the displacements; a_e stands for a_i - a_j with e = (i, j). The
    unknowns are d_x, d_y, d_z of the free vertices in turn. A restriction may add `ties`, linear
    equations of the d_z over 2^bits. Or it adds equations between the g of its diagonals, which
    follow the edges in `bars`; then the values of all equations are multiplied by 2^`more`. The
    origin is the first pinned corner, and the unit of length, `unit` in that of the sheet, is
    chosen such that all coordinates of U are at most 1.
    """

    def __init__(
        self,
        sheet: Sheet,
        pinned: list[int],
        bits: int,
        restriction: Restriction | None = None,
    ) -> None:
        added = self.restriction = restriction or Restriction(sheet)
        require(frozenset(pinned) in sheet.triangles, "the pinned vertices are not those of a face")
        denominator = lcm(*(x.denominator for point in sheet.points.values() for x in point))
        x, y = sheet.points[pinned[0]]
        flat = {
            v: (int((a - x) * denominator), int((b - y) * denominator))
            for v, (a, b) in sheet.points.items()
        }
        least = max(max(abs(a), abs(b)) for a, b in flat.values()).bit_length()
        needed = max(least, 60, added.tie_bits)
        require(bits >= needed, "the coordinates need more bits")
        self.sheet, self.pinned, self.bits = sheet, pinned, bits
        self.unit = Fraction(1 << least, denominator)
        self.free = [v for v in sorted(flat) if v not in pinned]
        self.place = {v: 3 * k for k, v in enumerate(self.free)}
        self.size = 3 * len(self.free)
        self.edges = [e for e in sheet.edges if not set(pinned).issuperset(e)]
        self.mixed, self.more = added.rows, added.row_bits
        self.bars = [*self.edges, *added.diagonals]
        up = bits - least
        self.flat = [
            ((flat[i][0] - flat[j][0]) << up, (flat[i][1] - flat[j][1]) << up, 0)
            for i, j in self.bars
        ]
        self.ties = [self._tie(tie, bits - added.tie_bits) for tie in added.ties]

    def _tie(self, tie: Tie, up: int) -> Vector:
        row = [0] * self.size
        for v, c in tie.items():
            if v in self.place:
                row[self.place[v] + 2] = c << up
        return row

    def tied(self, row: Sequence[int]) -> Vector:
        """The values of the ties at a vector, over 2^(2 bits)."""
        return [dot(tie, row) for tie in self.ties]

    def last_rows(self, last: Sequence[int], more: int = 0) -> list[Sequence[int]]:
        """The rows of the ties over 2^(bits + more), followed by the row `last`."""
        return [*([c << more for c in tie] for tie in self.ties), last]

    def stacked(self, bars: Sequence[int], linear: Sequence[int]) -> Vector:
        """The values of all equations times 2^more, from those of the bars and linear equations."""
        diagonals = bars[len(self.edges) :]
        return [
            *(x << self.more for x in bars[: len(self.edges)]),
            *(dot(row, diagonals) for row in self.mixed),
            *(x << self.more for x in linear),
        ]

    def largest(self, squares: Sequence[int]) -> Vector:
        """Bounds for the equations that are not linear, from bounds for the bars."""
        diagonals = squares[len(self.edges) :]
        mixed = [dot(map(abs, row), diagonals) for row in self.mixed]
        return [*squares[: len(self.edges)], *(-(-x >> self.more) for x in mixed)]

    def along(self, row: Sequence[int]) -> list[tuple[int, ...]]:
        """The differences a_e of a vector a, for all bars e."""
        at: dict[int, tuple[int, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
        at |= {v: tuple(row[k : k + 3]) for v, k in self.place.items()}
        return [tuple(map(sub, at[i], at[j])) for i, j in self.bars]

    def columns(self, rows: Sequence[Sequence[int]], last: Sequence[Sequence[int]] = ()) -> Columns:
        """The matrix of d -> rows_e . d_e, with the rows `last` added, times 2^more."""
        columns: Columns = [[] for _ in range(self.size)]
        edges, one = len(self.edges), 1 << self.more
        for e, ((i, j), row) in enumerate(zip(self.bars, rows, strict=True)):
            factors = [(e, one)] if e < edges else self._factors(e - edges)
            for v, sign in ((i, 1), (j, -1)):
                if v in self.place:
                    for a in range(3):
                        if row[a]:
                            entries = [(n, sign * c * row[a]) for n, c in factors]
                            columns[self.place[v] + a] += entries
        for n, line in enumerate(last, edges + len(self.mixed)):
            for k, x in enumerate(line):
                if x:
                    columns[k].append((n, x * one))
        return columns

    def _factors(self, k: int) -> list[tuple[int, int]]:
        """The equations that contain diagonal k, each with the factor of the diagonal."""
        rows = enumerate(self.mixed, len(self.edges))
        return [(n, row[k]) for n, row in rows if row[k]]

    def weight_sums(self, weights: Sequence[int]) -> list[tuple[int, ...]]:
        """The sums w_i + w_j in the three coordinates, for every bar (i, j)."""
        at: dict[int, tuple[int, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
        at |= {v: tuple(weights[k : k + 3]) for v, k in self.place.items()}
        return [tuple(map(add, at[i], at[j])) for i, j in self.bars]

    def approximate_inverse(self, columns: Columns, bits: int) -> list[Vector]:
        """A matrix P for a matrix over 2^(bits + more); the test that uses P is valid for any P."""
        return approximate_inverse(columns, bits + self.more)


def approximate_inverse(columns: Columns, bits: int) -> list[Vector]:
    """An approximate inverse, over 2^INVERSE_BITS, of a square matrix over 2^bits."""
    size = len(columns)
    matrix = [[0.0] * size for _ in range(size)]
    for k, column in enumerate(columns):
        for e, x in column:
            matrix[e][k] += x / (1 << bits)
    nearly = [[round(x * 2**INVERSE_BITS) for x in row] for row in inverse(matrix)]
    largest = max(abs(x) for row in nearly for x in row)
    require(largest >> INVERSE_BITS + SPARE == 0, "a Jacobian is nearly singular")
    return nearly


def convolved(parts: Parts, axes: slice, k: int) -> Vector:
    """The coefficient of s^k of |e|^2 for every edge vector e = sum_k parts[k] s^k.

    Only the coordinates in `axes` count.
    """
    total = [0] * len(parts[0])
    top = len(parts) - 1
    for i in range(max(0, k - top), k // 2 + 1):
        twice = 1 if 2 * i == k else 2
        for n, (a, b) in enumerate(zip(parts[i], parts[k - i], strict=True)):
            total[n] += twice * sum(map(mul, a[axes], b[axes]))
    return total


def extended(
    equations: LengthEquations,
    centre: Vector,
    p: list[Vector],
    coefficient: Coefficient,
    extra: int,
) -> Curve:
    """Compute a curve from its centre, coefficient by coefficient, by Newton's method with P.

    `coefficient(curve, parts, k)` is the coefficient of s^k of the equations, over
    2^(bits + extra + more). The result is approximate; the tests that use it are valid for any
    curve.
    """
    curve, parts = [centre], [equations.along(centre)]
    for k in range(1, ORDER + 1):
        curve.append([0] * len(centre))
        parts.append(equations.along(curve[k]))
        for _ in range(2):
            g = coefficient(curve, parts, k)
            down = INVERSE_BITS + extra + equations.more
            curve[k] = [x - (dot(row, g) >> down) for x, row in zip(curve[k], p, strict=True)]
            parts[k] = equations.along(curve[k])
    return curve


def at(curve: Curve, s: Fraction) -> Vector:
    """The value of the curve at s, rounded down to whole units."""
    powers = [s**k for k in range(len(curve))]
    low = powers[-1].denominator
    whole = [int(x * low) for x in powers]
    return [dot(column, whole) // low for column in zip(*curve, strict=True)]
