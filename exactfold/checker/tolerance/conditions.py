"""The second-order conditions of a sheet in integers, and how they are rounded (`zeros`)."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isqrt

from ..core.limits import TOLERANCE_UNKNOWNS
from ..core.reading import at_most, require
from ..core.towers import Number
from ..sheets.panels import PanelSheet
from ..sheets.scaled import scaled

S = 48
"""Binary places of coordinates, gradients, N and Y."""
P = 60
"""Binary places of bounds."""
ONE = 1 << S
Row = list[int]


class Conditions:
    """The conditions of a sheet, moved to a corner and scaled by `scale`, a power of two.

    `points` are the vertices over 2^S, each within `off` of the true one, over 2^P. `folds` have
    their ends and the panels on their left and right, and `rings` the panels round each interior
    vertex.
    """

    def __init__(self, sheet: PanelSheet) -> None:
        self.sheet = sheet
        side = {
            edge: k
            for k, panel in enumerate(sheet.panels)
            for edge in zip(panel, (*panel[1:], panel[0]), strict=True)
        }
        self.folds = [(i, j, side[i, j], side[j, i]) for i, j in sheet.folds]
        self.rings = [[side[v, u] for u in sheet.around[v]] for v in sheet.interior]
        number = len(self.folds), 3 * len(self.rings) + 1
        require(number[0] == number[1], f"there are {number[0]} folds, not {number[1]}")
        self.size = 2 * len(sheet.panels)
        at_most(self.size, TOLERANCE_UNKNOWNS, "the unknowns of a zero", "TOLERANCE_UNKNOWNS")
        self.areas = [
            [
                (2 * a + p, 2 * b + 1 - p, 1 - 2 * p)
                for a, b in zip(ring, (*ring[1:], ring[0]), strict=True)
                for p in (0, 1)
            ]
            for ring in self.rings
        ]
        self.scale, points = scaled(sheet)
        self.points = [[rounded(c, S) for c in point] for point in points]
        self.off = 2 << P - S

    def direction(self, i: int, j: int) -> Row:
        """The way from one vertex to another, over 2^S."""
        return [b - a for a, b in zip(self.points[i], self.points[j], strict=True)]

    def radius(self, radius: Fraction) -> int:
        """A radius in the unit of the sheet, for moves from `points`, over 2^P, rounded up."""
        return -int(-(radius * self.scale * (1 << P)) // 1) + self.off

    def shape_stays(self, r: int) -> str:
        """What may lose its shape for moves up to r: "" if no panel does, and not the border.

        A polygon stays simple if all its corners turn left, or if a diagonal cuts it into two
        triangles that do, as then nothing of it can meet before some corner is straight.
        """
        for polygon in [*self.sheet.panels, border(self.sheet)]:
            if not self._stays(polygon, r):
                return f"the polygon {tuple(polygon)}"
        return ""

    def _stays(self, polygon: Sequence[int], r: int) -> bool:
        count = len(polygon)
        corners = [(polygon[k - 2], polygon[k - 1], polygon[k]) for k in range(count)]
        if all(self._turns(i, j, k, r) for i, j, k in corners):
            return True
        a, b, c, d = polygon if count == 4 else (0, 0, 0, 0)
        return count == 4 and any(
            self._turns(p, q, s, r) and self._turns(p, s, t, r)
            for p, q, s, t in ((a, b, c, d), (b, c, d, a))
        )

    def _turns(self, i: int, j: int, k: int, r: int) -> bool:
        """Whether three vertices turn left for all moves up to r."""
        a, b, c = self.direction(i, j), self.direction(i, k), self.direction(j, k)
        area = (a[0] * b[1] - a[1] * b[0]) << 2 * (P - S)
        around = sum(isqrt(x * x + y * y) + 1 for x, y in (a, b, c)) << P - S
        return area > r * around + 4 * r * r


# --- integers ------------------------------------------------------------------------------------


def rounded(value: Number, places: int) -> int:
    """A number over 2^places, off by at most one."""
    bits = places
    while True:
        bits += bits
        wide, shift = value.enclosed(bits), bits - places
        if wide.high - wide.low < 1 << shift:
            return (wide.low + wide.high) >> shift + 1


def border(sheet: PanelSheet) -> list[int]:
    """The corners of the sheet in order, counter-clockwise."""
    sides = {
        edge for panel in sheet.panels for edge in zip(panel, (*panel[1:], panel[0]), strict=True)
    }
    after = {i: j for i, j in sides if (j, i) not in sides}
    walk = [min(after)]
    while (v := after[walk[-1]]) != walk[0]:
        walk.append(v)
    return walk


def whole(value: float) -> int:
    """A float over 2^S, rounded."""
    return round(value * ONE)


def up(value: int, places: int) -> int:
    """The quotient by a power of two, rounded up."""
    return -(-value >> places)


def dot(a: Sequence[int], b: Sequence[int]) -> int:
    """The sum of products."""
    return sum([p * q for p, q in zip(a, b, strict=True)])


def lengths(row: Row) -> list[int]:
    """The lengths of the parts of a row that belong to each vertex, rounded up."""
    return [isqrt(x * x + y * y) + 1 for x, y in zip(row[::2], row[1::2], strict=True)]


def blocks(form: list[Row]) -> int:
    """A bound of |d M d| for |d_v| <= 1, from the norms of the blocks of the symmetric part."""
    total = 0
    for v in range(0, len(form), 2):
        for w in range(0, v + 1, 2):
            entries = [
                form[v + p][w + q] + (form[w + q][v + p] if w < v else 0)
                for p in (0, 1)
                for q in (0, 1)
            ]
            if w == v:
                entries[1] = entries[2] = (entries[1] + entries[2] + 1) // 2
            total += isqrt(sum(c * c for c in entries)) + 2
    return total


def gradients(conditions: Conditions, densities: Sequence[float]) -> list[float]:
    """Gradients of panels with these densities of the folds, of length 1, in floats."""
    jumps: dict[int, list[tuple[int, float, float]]] = {}
    for (i, j, left, right), density in zip(conditions.folds, densities, strict=True):
        x, y = (c / ONE for c in conditions.direction(i, j))
        jumps.setdefault(right, []).append((left, -density * y, density * x))
        jumps.setdefault(left, []).append((right, density * y, -density * x))
    found, waiting = {0: (0.0, 0.0)}, [0]
    for panel in waiting:
        for other, x, y in jumps.get(panel, []):
            if other not in found:
                a, b = found[panel]
                found[other] = a + x, b + y
                waiting.append(other)
    flat = [c for panel in range(conditions.size // 2) for c in found[panel]]
    means = [sum(flat[p::2]) / len(flat[p::2]) for p in (0, 1)]
    flat = [c - means[k % 2] for k, c in enumerate(flat)]
    size = sum(c * c for c in flat) ** 0.5
    return [c / size for c in flat]
