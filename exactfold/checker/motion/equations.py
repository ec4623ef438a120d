"""The length equations of a sheet with one triangle held, on curves of integers over 2^bits."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import chain
from math import lcm
from operator import add, mul, sub
from typing import Any, TypeVar

from ..core.krawczyk import inverse
from ..core.reading import require
from ..sheets.sheet import Sheet
from .bounds import INVERSE_BITS, Columns, Rounded, Vector, dot, product
from .packed import Lanes, coefficient, packed, unpacked, wide_enough
from .restriction import Restriction, Tie

Number = TypeVar("Number", int, float)

ORDER = 8  # the degree of the polynomial of a piece
SPARE = 60  # bits before the binary point
Curve = list[Vector]
"""A polynomial in s with vector coefficients; row k is the coefficient of s^k."""

Residual = Callable[[Vector, int], Vector]
"""The values of all equations on unknowns that are polynomials, packed with the given width."""


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
        self.factor = max([1 << self.more, *(sum(map(abs, row)) for row in self.mixed)])

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

    def beyond(self, rows: Iterable[Sequence[int]], more: int = 0) -> int:
        """A bound for all coefficients of the equations on a curve of degree `ORDER`.

        They are over 2^(2 bits + `more` + 1). `rows` are the curve and the vectors with which it is
        multiplied, with numbers below 2^top. A coefficient of one bar is less than 120 products of
        such numbers, and no value has more such parts than there are unknowns.
        """
        top = max(self.bits + 1, largest(rows).bit_length())
        return self.factor << 2 * top + 9 + self.size.bit_length() + more

    def largest(self, squares: Sequence[int]) -> Vector:
        """Bounds for the equations that are not linear, from bounds for the bars."""
        diagonals = squares[len(self.edges) :]
        mixed = [dot(map(abs, row), diagonals) for row in self.mixed]
        return [*squares[: len(self.edges)], *(-(-x >> self.more) for x in mixed)]

    def along(self, row: Sequence[Number]) -> list[tuple[Number, ...]]:
        """The differences a_e of a vector a, for all bars e."""
        at: dict[int, tuple[Any, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
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

    def slopes(
        self,
        p: list[Vector],
        rows: Sequence[Sequence[Sequence[int]]],
        last: Sequence[Sequence[int]],
        bits: int,
    ) -> list[Rounded]:
        """The coefficients of P DH - 1, by powers of s.

        `rows[k]` are the vectors of the bars in the coefficient of s^k of DH, and `last` the rows
        after these, for s = 0. All are over 2^bits.
        """
        sizes = [self.factor * largest(row) for row in rows]
        sizes[0] = max(sizes[0], largest(last) << self.more)
        lanes = Lanes(p, sizes)
        columns = self.columns(lanes.table(rows), lanes.table([last]))
        return lanes.read(product(p, columns), 1 << INVERSE_BITS + bits + self.more)

    def _factors(self, k: int) -> list[tuple[int, int]]:
        """The equations that contain diagonal k, each with the factor of the diagonal."""
        rows = enumerate(self.mixed, len(self.edges))
        return [(n, row[k]) for n, row in rows if row[k]]

    def weight_sums(self, weights: Sequence[int]) -> list[tuple[int, ...]]:
        """The sums w_i + w_j in the three coordinates, for every bar (i, j)."""
        at: dict[int, tuple[int, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
        at |= {v: tuple(weights[k : k + 3]) for v, k in self.place.items()}
        return [tuple(map(add, at[i], at[j])) for i, j in self.bars]

    def inverse(self, columns: Columns, bits: int) -> list[list[float]]:
        """Nearly the inverse of a matrix over 2^(bits + more), in floats."""
        return inverse_of(columns, bits + self.more)

    def taylor(self, inverse: list[list[float]]) -> list[list[float]]:
        """The coefficients of s, s^2, ... of the curve with T(x - c) = s, in floats.

        `inverse` is that of DH at c. The tests that use the result are valid for any curve.
        """
        rows = [[line[-1] for line in inverse]]
        parts: list[list[float]] = [[] for _ in range(3 * len(self.bars))]
        for _ in range(1, ORDER):
            flat = chain.from_iterable(self.along(rows[-1]))
            for part, x in zip(parts, flat, strict=True):
                part.append(x)
            squares = [sum(map(mul, part, reversed(part))) for part in parts]
            bars = [-sum(squares[e : e + 3]) / 2 for e in range(0, len(squares), 3)]
            right, diagonals = bars[: len(self.edges)], bars[len(self.edges) :]
            right += [sum(map(mul, row, diagonals)) / (1 << self.more) for row in self.mixed]
            rows.append([sum(map(mul, line, right)) for line in inverse])
        return rows


def inverse_of(columns: Columns, bits: int) -> list[list[float]]:
    """Nearly the inverse of a square matrix over 2^bits, in floats."""
    size, one = len(columns), 1 << bits
    matrix = [[0.0] * size for _ in range(size)]
    for k, column in enumerate(columns):
        for e, x in column:
            matrix[e][k] += x / one
    return inverse(matrix)


def rounded(matrix: list[list[float]]) -> list[Vector]:
    """An inverse over 2^INVERSE_BITS, called P; the test that uses P is valid for any P."""
    scale = 2.0**INVERSE_BITS
    nearly = [[round(x * scale) for x in row] for row in matrix]
    require(largest(nearly) >> INVERSE_BITS + SPARE == 0, "a Jacobian is nearly singular")
    return nearly


def extended(
    equations: LengthEquations,
    centre: Vector,
    p: list[Vector],
    residual: Residual,
    extra: int,
) -> Curve:
    """Compute a curve from its centre, coefficient by coefficient, by Newton's method with P.

    The values of `residual` are integers over 2^(bits + extra + more). The result is approximate;
    the tests that use it are valid for any curve.
    """
    down = INVERSE_BITS + extra + equations.more
    width = (equations.bits + extra + equations.more + SPARE + 23) // 8 * 8
    curve, x = [centre], centre
    for k in range(1, ORDER + 1):
        row = [0] * len(centre)
        for _ in range(2):
            g = [coefficient(value, width, k) for value in residual(x, width)]
            step = [dot(line, g) >> down for line in p]
            row = [a - d for a, d in zip(row, step, strict=True)]
            x = [a - (d << width * k) for a, d in zip(x, step, strict=True)]
        curve.append(row)
    return curve


def images(
    equations: LengthEquations,
    curve: Curve,
    p: list[Vector],
    residual: Residual,
    most: int,
    degree: int,
) -> list[Vector]:
    """The coefficients of P H(p(s), s), for the values H of `residual`, a polynomial in s.

    Its coefficients are at most `most` in size.
    """
    width = wide_enough(p, most)
    values = residual([packed(column, width) for column in zip(*curve, strict=True)], width)
    rows = [unpacked(dot(line, values), width, degree + 1) for line in p]
    return [list(column) for column in zip(*rows, strict=True)]


def nearest(centre: Vector, series: list[list[float]], bits: int) -> Curve:
    """The curve with this centre and the nearest integers over 2^bits to these coefficients."""
    return [centre, *([round(x * 2.0**60) << bits - 60 for x in row] for row in series)]


def largest(rows: Iterable[Sequence[int]]) -> int:
    """The largest size of an entry."""
    return max(max(max(row), -min(row)) for row in rows)


def at(curve: Curve, s: Fraction) -> Vector:
    """The value of the curve at s, rounded down to whole units."""
    powers = powers_of(s, len(curve) - 1)
    return [dot(column, powers) // powers[0] for column in zip(*curve, strict=True)]


def powers_of(s: Fraction, top: int) -> Vector:
    """The powers of s from 0 to `top`, all multiplied by that power of its denominator."""
    a, b = s.numerator, s.denominator
    return [a**k * b ** (top - k) for k in range(top + 1)]
