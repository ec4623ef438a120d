"""The length equations of a sheet with one triangle held, for curves in integers over 2^bits."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import lcm
from operator import add, mul, sub

from .krawczyk import inverse
from .motion_bounds import INVERSE_BITS, Columns, Vector, dot
from .motion_rim import Rim, Tie
from .reading import require
from .sheet import Sheet

ORDER = 8  # of the polynomial of a piece
SPARE = 60  # bits before the point
Curve = list[Vector]
"""Row k is the coefficient of s^k."""

Parts = list[list[tuple[int, ...]]]
"""The a_e of all edges for every coefficient of a curve."""

Coefficient = Callable[[Curve, Parts, int], Vector]


class LengthEquations:
    """g_e(d) = U_e . d_e + |d_e|^2 / 2 = 0 for every edge with a free end, a_e = a_i - a_j.

    With a rim its ties follow: linear equations of the d_z, `ties` over 2^bits.
    Lengths are such that all coordinates U, from the first pinned corner, are at most 1: `unit` is
    their unit in that of the sheet. The unknowns are d_x, d_y, d_z of the free vertices in turn.
    """

    def __init__(self, sheet: Sheet, pinned: list[int], bits: int, rim: Rim | None = None) -> None:
        require(frozenset(pinned) in sheet.triangles, "what is pinned is no face")
        denominator = lcm(*(x.denominator for point in sheet.points.values() for x in point))
        x, y = sheet.points[pinned[0]]
        flat = {
            v: (int((a - x) * denominator), int((b - y) * denominator))
            for v, (a, b) in sheet.points.items()
        }
        least = max(max(abs(a), abs(b)) for a, b in flat.values()).bit_length()
        needed = max(least, 60, 0 if rim is None else rim.bits)
        require(bits >= needed, "the coordinates need more bits")
        self.sheet, self.pinned, self.bits = sheet, pinned, bits
        self.unit = Fraction(1 << least, denominator)
        self.free = [v for v in sorted(flat) if v not in pinned]
        self.place = {v: 3 * k for k, v in enumerate(self.free)}
        self.size = 3 * len(self.free)
        self.edges = [e for e in sheet.edges if not set(pinned).issuperset(e)]
        up = bits - least
        self.flat = [
            ((flat[i][0] - flat[j][0]) << up, (flat[i][1] - flat[j][1]) << up, 0)
            for i, j in self.edges
        ]

        self.ties = [] if rim is None else [self._tie(tie, bits - rim.bits) for tie in rim.ties]

    def _tie(self, tie: Tie, up: int) -> Vector:
        row = [0] * self.size
        for v, c in tie.items():
            if v in self.place:
                row[self.place[v] + 2] = c << up
        return row

    def tied(self, row: Sequence[int]) -> Vector:
        """The left sides of the ties, over 2^(2 bits)."""
        return [dot(tie, row) for tie in self.ties]

    def last_rows(self, last: Sequence[int], more: int = 0) -> list[Sequence[int]]:
        """The ties, over 2^(bits + more), and one more row."""
        return [*([c << more for c in tie] for tie in self.ties), last]

    def along(self, row: Sequence[int]) -> list[tuple[int, ...]]:
        """a_e for all edges."""
        at: dict[int, tuple[int, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
        at |= {v: tuple(row[k : k + 3]) for v, k in self.place.items()}
        return [tuple(map(sub, at[i], at[j])) for i, j in self.edges]

    def columns(self, rows: Sequence[Sequence[int]], last: Sequence[Sequence[int]] = ()) -> Columns:
        """The matrix of d -> rows_e . d_e, and of more rows."""
        found: Columns = [[] for _ in range(self.size)]
        for e, ((i, j), row) in enumerate(zip(self.edges, rows, strict=True)):
            for v, sign in ((i, 1), (j, -1)):
                if v in self.place:
                    for a in range(3):
                        if row[a]:
                            found[self.place[v] + a].append((e, sign * row[a]))
        for n, line in enumerate(last, len(self.edges)):
            for k, x in enumerate(line):
                if x:
                    found[k].append((n, x))
        return found

    def weight_sums(self, weights: Sequence[int]) -> list[tuple[int, ...]]:
        """w_i + w_j in the three places of every edge."""
        at: dict[int, tuple[int, ...]] = dict.fromkeys(self.pinned, (0, 0, 0))
        at |= {v: tuple(weights[k : k + 3]) for v, k in self.place.items()}
        return [tuple(map(add, at[i], at[j])) for i, j in self.edges]

    def approximate_inverse(self, columns: Columns, bits: int) -> list[Vector]:
        """P for a matrix over 2^bits: any would do, as it is tested."""
        return approximate_inverse(columns, bits)


def approximate_inverse(columns: Columns, bits: int) -> list[Vector]:
    """A square matrix over 2^bits, nearly inverted, over 2^INVERSE_BITS."""
    size = len(columns)
    matrix = [[0.0] * size for _ in range(size)]
    for k, column in enumerate(columns):
        for e, x in column:
            matrix[e][k] = x / (1 << bits)
    found = [[round(x * 2**INVERSE_BITS) for x in row] for row in inverse(matrix)]
    largest = max(abs(x) for row in found for x in row)
    require(largest >> INVERSE_BITS + SPARE == 0, "a Jacobian is nearly singular")
    return found


def convolved(parts: Parts, axes: slice, k: int) -> Vector:
    """The coefficient of s^k of |e|^2 for every edge, on some axes; e = sum_k parts[k] s^k."""
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
    """A curve from the centre by Newton's method with P, coefficient by coefficient.

    `coefficient(curve, parts, k)` is that of s^k in the equations, over 2^(bits + extra). Nothing
    is claimed: any curve would do, as it is tested.
    """
    curve, parts = [centre], [equations.along(centre)]
    for k in range(1, ORDER + 1):
        curve.append([0] * len(centre))
        parts.append(equations.along(curve[k]))
        for _ in range(2):
            g = coefficient(curve, parts, k)
            down = INVERSE_BITS + extra
            curve[k] = [x - (dot(row, g) >> down) for x, row in zip(curve[k], p, strict=True)]
            parts[k] = equations.along(curve[k])
    return curve


def at(curve: Curve, s: Fraction) -> Vector:
    """The curve at s, rounded down to whole units."""
    powers = [s**k for k in range(len(curve))]
    low = powers[-1].denominator
    whole = [int(x * low) for x in powers]
    return [dot(column, whole) // low for column in zip(*curve, strict=True)]
