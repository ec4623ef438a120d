"""A zero of the second-order conditions that stays, with its letters, while vertices move.

Every panel f has a gradient g_f. To second order the sheet moves iff (g_f - g_f') . (U_b - U_a) = 0
for each fold from a to b, between the panels f on its left and f' on its right, and
sum_k g_k x g_k+1 = 0 for the panels round each interior vertex, counter-clockwise. With two rows
that say that the gradients add up to 0 and one that fixes a factor, these are as many conditions
F(x, U) = 0 as unknowns x if there are 3 m + 1 folds and m interior vertices. F has degree 2 in x
and U together. With x = x_0 + N dU + xi, and any matrices N and Y,

    Y F = Y F(x_0) + Y (F_x N + F_U) dU + Y q(dU) + Y F_x xi + Y L(dU) xi + Y A(xi),

where q and A are quadratic, and L is linear in dU. Let |dU_v| <= r for all vertices, and let a, b,
t, k0, k1 and w bound the terms, with sums of lengths over vertices. If for all i

    a_i + r b_i + r^2 t_i + sum_j (k0 + r k1)_ij rho_j + 2 sum_jk w_ijk rho_j rho_k < rho_i,

then xi -> xi - Y F contracts the box |xi_j| <= rho_j into itself: there is exactly one zero in it,
a regular one, which depends continuously on dU. A fold is a valley if this product is positive, and
a mountain if it is negative: (U_b - U_a) x (g_f - g_f').

x_0, N and Y are found in floats, and none of them has to be right. The bounds are exact integers
over powers of two, rounded upwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from math import isqrt

from ..core.limits import TOLERANCE_UNKNOWNS
from ..core.reading import at_most, require
from ..core.towers import Number
from ..sheets.panels import Edge, PanelSheet

S = 48
"""Binary places of coordinates, gradients, N and Y."""
P = 60
"""Binary places of bounds."""
_ONE = 1 << S
_STEPS, _ROUNDS = 12, 80
_WIDER = 1.0001
_Row = list[int]
_Matrix = list[list[float]]


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
        x, y = sheet.points[sheet.panels[0][0]]
        moved = [(a - x, b - y) for a, b in sheet.points]
        bits, most = 32, 0
        while most < 1 << 16:  # until the largest coordinate is known to some digits
            bits += bits
            ends = [c.enclosed(bits) for point in moved for c in point]
            most = max(max(abs(c.low), abs(c.high)) for c in ends)
        self.scale = Fraction(1 << bits, 1 << most.bit_length())
        factor = sheet.tower.number(self.scale)
        self.points = [[_rounded(c * factor, S) for c in point] for point in moved]
        self.off = 2 << P - S

    def direction(self, i: int, j: int) -> _Row:
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
        border = _border(self.sheet)
        for polygon in [*self.sheet.panels, border]:
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


class Zero:
    """One zero, from its densities in floats, in the order of the folds; and the test for it."""

    def __init__(self, conditions: Conditions, densities: Sequence[float]) -> None:
        self.of = conditions
        n, folds = conditions.size, conditions.folds
        start = _gradients(conditions, densities)
        for _ in range(_STEPS):
            rows = [[c / _ONE for c in row] for row in self._jacobian([_whole(c) for c in start])]
            value = self._floats(start)
            step = _product(_inverse(rows), [[c] for c in value])
            start = [c - s[0] for c, s in zip(start, step, strict=True)]
            if max(abs(s[0]) for s in step) < 1e-14:
                break
        self.x = [_whole(c) for c in start]
        self.jacobian = self._jacobian(self.x)
        inverse = _inverse([[c / _ONE for c in row] for row in self.jacobian])
        by_place = [[0.0] * (2 * len(conditions.points)) for _ in range(n)]
        for row, (i, j, left, right) in zip(by_place, folds, strict=False):
            for p in (0, 1):
                jump = (self.x[2 * left + p] - self.x[2 * right + p]) / _ONE
                row[2 * j + p] += jump
                row[2 * i + p] -= jump
        self.by_place = [[_whole(c) for c in row] for row in by_place]
        self.y = [[_whole(c) for c in row] for row in inverse]
        self.n = [[-_whole(c) for c in row] for row in _product(inverse, by_place)]

    def _jacobian(self, x: _Row) -> list[_Row]:
        """F_x, over 2^S."""
        conditions, rows = self.of, []
        for i, j, left, right in conditions.folds:
            row = [0] * conditions.size
            for p, c in enumerate(conditions.direction(i, j)):
                row[2 * left + p] += c
                row[2 * right + p] -= c
            rows.append(row)
        for p in (0, 1):
            rows.append([_ONE * (k % 2 == p) for k in range(conditions.size)])
        for area in conditions.areas:
            row = [0] * conditions.size
            for p, q, sign in area:
                row[p] += sign * x[q]
                row[q] += sign * x[p]
            rows.append(row)
        return [*rows, list(x)]

    def values(self, x: _Row) -> _Row:
        """F(x), over 2^(2 S)."""
        conditions, values = self.of, []
        for i, j, left, right in conditions.folds:
            d = conditions.direction(i, j)
            values.append(sum((x[2 * left + p] - x[2 * right + p]) * d[p] for p in (0, 1)))
        values += [sum(x[p::2]) << S for p in (0, 1)]
        values += [sum(sign * x[p] * x[q] for p, q, sign in area) for area in conditions.areas]
        return [*values, sum(c * c for c in x) - (1 << 2 * S)]

    def _floats(self, x: Sequence[float]) -> list[float]:
        """F(x) with the factor fixed by x itself: half of the last condition, in floats."""
        values = [c / (1 << 2 * S) for c in self.values([_whole(c) for c in x])]
        return [*values[:-1], values[-1] / 2]

    # --- bounds, over 2^P ------------------------------------------------------------------------

    @cached_property
    def _a(self) -> _Row:
        values = self.values(self.x)
        return [_up(abs(_dot(row, values)), 3 * S - P) for row in self.y]

    @cached_property
    def _b(self) -> _Row:
        columns = range(len(self.n[0]))
        inner = [
            [_dot(row, [line[c] for line in self.n]) + (place[c] << S) for c in columns]
            for row, place in zip(self.jacobian, self.by_place, strict=True)
        ]
        rows = [[_dot(y, [line[c] for line in inner]) for c in columns] for y in self.y]
        return [_up(sum(_lengths(row)), 3 * S - P) for row in rows]

    @cached_property
    def _k0(self) -> list[_Row]:
        n = range(self.of.size)
        return [
            [
                _up(
                    abs((i == j) * (1 << 2 * S) - _dot(y, [row[j] for row in self.jacobian])),
                    2 * S - P,
                )
                for j in n
            ]
            for i, y in enumerate(self.y)
        ]

    @cached_property
    def _forms(self) -> list[dict[tuple[int, int], int]]:
        """For each row of Y the quadratic form in the gradients, over 2^S."""
        forms = []
        first = len(self.of.folds) + 2
        for y in self.y:
            form: dict[tuple[int, int], int] = {}
            for c, area in zip(y[first:], self.of.areas, strict=False):
                for p, q, sign in area:
                    key = (p, q) if p < q else (q, p)
                    form[key] = form.get(key, 0) + sign * c
            forms.append(form)
        return forms

    @cached_property
    def _t(self) -> _Row:
        bounds = []
        places = len(self.n[0])
        for y, form in zip(self.y, self._forms, strict=True):
            half: dict[int, _Row] = {}
            for (p, q), c in form.items():
                row = half.setdefault(p, [0] * places)
                half[p] = [s + c * m for s, m in zip(row, self.n[q], strict=True)]
            whole = [[0] * places for _ in range(places)]
            for p, row in half.items():
                for u, c in enumerate(self.n[p]):
                    if c:
                        whole[u] = [s + c * m for s, m in zip(whole[u], row, strict=True)]
            for c, (i, j, left, right) in zip(y, self.of.folds, strict=False):
                for p in (0, 1):
                    jump = self._jump(left, right, p)
                    for u, m in enumerate(jump):
                        whole[u][2 * j + p] += c * m
                        whole[u][2 * i + p] -= c * m
            bounds.append(_up(_blocks(whole), 3 * S - P))
        return bounds

    def _jump(self, left: int, right: int, p: int) -> _Row:
        """N of the difference of two gradients, over 2^S; times 2^S, as in the other forms."""
        pairs = zip(self.n[2 * left + p], self.n[2 * right + p], strict=True)
        return [(a - b) << S for a, b in pairs]

    @cached_property
    def _k1(self) -> list[_Row]:
        bounds = []
        places = len(self.n[0])
        for y, form in zip(self.y, self._forms, strict=True):
            rows = [[0] * places for _ in range(self.of.size)]
            for (p, q), c in form.items():
                rows[q] = [s + c * m for s, m in zip(rows[q], self.n[p], strict=True)]
                rows[p] = [s + c * m for s, m in zip(rows[p], self.n[q], strict=True)]
            for c, (i, j, left, right) in zip(y, self.of.folds, strict=False):
                for p in (0, 1):
                    for region, sign in ((left, 1), (right, -1)):
                        rows[2 * region + p][2 * j + p] += sign * c << S
                        rows[2 * region + p][2 * i + p] -= sign * c << S
            bounds.append([_up(sum(_lengths(row)), 2 * S - P) for row in rows])
        return bounds

    # --- the test --------------------------------------------------------------------------------

    def box(self, r: int) -> _Row | None:
        """The sizes rho of a box with one zero for all moves up to r, over 2^P; None if none is
        found.
        """
        unit = 1 << P
        base = [
            a + _up(r * b, P) + _up(r * r * t, 2 * P)
            for a, b, t in zip(self._a, self._b, self._t, strict=True)
        ]
        linear = [
            [k + _up(r * m, P) for k, m in zip(k0, k1, strict=True)]
            for k0, k1 in zip(self._k0, self._k1, strict=True)
        ]
        forms = [
            [(p, q, 2 * abs(c) << P - S) for (p, q), c in form.items()] for form in self._forms
        ]
        rho = [b + 1 for b in base]
        for _ in range(_ROUNDS):
            floats = [c / unit for c in rho]
            image = [
                b / unit
                + sum(k * s for k, s in zip(row, floats, strict=True)) / unit
                + sum(c * floats[p] * floats[q] for p, q, c in form) / unit
                for b, row, form in zip(base, linear, forms, strict=True)
            ]
            if not max(image) < 1:
                return None
            rho = [int(c * _WIDER * unit) + 4 for c in image]
            if all(
                b
                + _up(_dot(row, rho), P)
                + _up(sum(c * rho[p] * rho[q] for p, q, c in form), 2 * P)
                < s
                for b, row, form, s in zip(base, linear, forms, rho, strict=True)
            ):
                return rho
        return None

    def letters(self, r: int, rho: _Row) -> dict[Edge, str]:
        """The letter of each fold for all moves up to r; "" if it is not certain."""
        letters, conditions = {}, self.of
        for i, j, left, right in conditions.folds:
            d = conditions.direction(i, j)
            jump = [self.x[2 * left + p] - self.x[2 * right + p] for p in (0, 1)]
            turned = [self._jump(left, right, p) for p in (0, 1)]
            linear = [d[0] * b - d[1] * a for a, b in zip(*turned, strict=True)]
            for v, sign in ((j, 1), (i, -1)):
                linear[2 * v] += sign * jump[1] << 2 * S
                linear[2 * v + 1] -= sign * jump[0] << 2 * S
            wide = [rho[2 * left + p] + rho[2 * right + p] for p in (0, 1)]
            steep = sum(_up(sum(_lengths(row)), 2 * S - P) for row in turned)
            lost = _up(r * _up(sum(_lengths(linear)), 3 * S - P), P)
            lost += _up(abs(d[0]) * wide[1] + abs(d[1]) * wide[0], S)
            lost += _up(2 * r * (_up(r * steep, P) + sum(wide)), P)
            bend = d[0] * jump[1] - d[1] * jump[0]
            size = abs(bend) >> 2 * S - P
            letters[i, j] = "" if size <= lost else "V" if bend > 0 else "M"
        return letters

    def differs(self, own: _Row, other: Zero, rho: _Row) -> bool:
        """Whether two zeros of the given sheet, in their boxes, are no multiples of each other."""
        mine, theirs = ([c << P - S for c in zero.x] for zero in (self, other))
        errors = [
            [
                s + _up(self.of.off * sum(_lengths(row)), S)
                for s, row in zip(box, zero.n, strict=True)
            ]
            for zero, box in ((self, own), (other, rho))
        ]
        n = range(len(mine))
        p, q = max(
            ((p, q) for p in n for q in n if p < q),
            key=lambda pair: abs(mine[pair[0]] * theirs[pair[1]] - mine[pair[1]] * theirs[pair[0]]),
        )
        minor = abs(mine[p] * theirs[q] - mine[q] * theirs[p])
        lost = sum(
            abs(mine[a]) * errors[1][b]
            + abs(theirs[b]) * errors[0][a]
            + errors[0][a] * errors[1][b]
            for a, b in ((p, q), (q, p))
        )
        return minor > lost


# --- integers ------------------------------------------------------------------------------------


def _rounded(value: Number, places: int) -> int:
    """A number over 2^places, off by at most one."""
    bits = places
    while True:
        bits += bits
        wide, shift = value.enclosed(bits), bits - places
        if wide.high - wide.low < 1 << shift:
            return (wide.low + wide.high) >> shift + 1


def _border(sheet: PanelSheet) -> list[int]:
    """The corners of the sheet in order, counter-clockwise."""
    sides = {
        edge for panel in sheet.panels for edge in zip(panel, (*panel[1:], panel[0]), strict=True)
    }
    after = {i: j for i, j in sides if (j, i) not in sides}
    walk = [min(after)]
    while (v := after[walk[-1]]) != walk[0]:
        walk.append(v)
    return walk


def _whole(value: float) -> int:
    return round(value * _ONE)


def _up(value: int, places: int) -> int:
    """The quotient by a power of two, rounded up."""
    return -(-value >> places)


def _dot(a: Sequence[int], b: Sequence[int]) -> int:
    return sum([p * q for p, q in zip(a, b, strict=True)])


def _lengths(row: _Row) -> list[int]:
    """The lengths of the parts of a row that belong to each vertex, rounded up."""
    return [isqrt(x * x + y * y) + 1 for x, y in zip(row[::2], row[1::2], strict=True)]


def _blocks(form: list[_Row]) -> int:
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


# --- floats --------------------------------------------------------------------------------------


def _gradients(conditions: Conditions, densities: Sequence[float]) -> list[float]:
    """Gradients of panels with these densities of the folds, of length 1, in floats."""
    jumps: dict[int, list[tuple[int, float, float]]] = {}
    for (i, j, left, right), density in zip(conditions.folds, densities, strict=True):
        x, y = (c / _ONE for c in conditions.direction(i, j))
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


def _inverse(matrix: _Matrix) -> _Matrix:
    """The inverse, by Gauss-Jordan elimination; raises `ZeroDivisionError` if there is none."""
    n = len(matrix)
    rows = [[*row, *(float(i == k) for i in range(n))] for k, row in enumerate(matrix)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        head = rows[k][k]
        rows[k] = [c / head for c in rows[k]]
        for i in range(n):
            factor = rows[i][k]
            if i != k and factor:
                rows[i] = [c - factor * d for c, d in zip(rows[i], rows[k], strict=True)]
    return [row[n:] for row in rows]


def _product(a: _Matrix, b: _Matrix) -> _Matrix:
    columns = list(zip(*b, strict=True))
    return [
        [sum(p * q for p, q in zip(row, column, strict=True)) for column in columns] for row in a
    ]
