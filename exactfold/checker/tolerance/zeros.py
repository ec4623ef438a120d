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
from functools import cached_property

from ..sheets.panels import Edge
from .conditions import ONE, Conditions, P, Row, S, blocks, dot, gradients, lengths, up, whole

_STEPS, _ROUNDS = 12, 80
_WIDER = 1.0001
_Matrix = list[list[float]]


class Zero:
    """One zero, from its densities in floats, in the order of the folds; and the test for it."""

    def __init__(self, conditions: Conditions, densities: Sequence[float]) -> None:
        self.of = conditions
        n, folds = conditions.size, conditions.folds
        start = gradients(conditions, densities)
        for _ in range(_STEPS):
            rows = [[c / ONE for c in row] for row in self._jacobian([whole(c) for c in start])]
            value = self._floats(start)
            step = _product(_inverse(rows), [[c] for c in value])
            start = [c - s[0] for c, s in zip(start, step, strict=True)]
            if max(abs(s[0]) for s in step) < 1e-14:
                break
        self.x = [whole(c) for c in start]
        self.jacobian = self._jacobian(self.x)
        inverse = _inverse([[c / ONE for c in row] for row in self.jacobian])
        by_place = [[0.0] * (2 * len(conditions.points)) for _ in range(n)]
        for row, (i, j, left, right) in zip(by_place, folds, strict=False):
            for p in (0, 1):
                jump = (self.x[2 * left + p] - self.x[2 * right + p]) / ONE
                row[2 * j + p] += jump
                row[2 * i + p] -= jump
        self.by_place = [[whole(c) for c in row] for row in by_place]
        self.y = [[whole(c) for c in row] for row in inverse]
        self.n = [[-whole(c) for c in row] for row in _product(inverse, by_place)]

    def _jacobian(self, x: Row) -> list[Row]:
        """F_x, over 2^S."""
        conditions, rows = self.of, []
        for i, j, left, right in conditions.folds:
            row = [0] * conditions.size
            for p, c in enumerate(conditions.direction(i, j)):
                row[2 * left + p] += c
                row[2 * right + p] -= c
            rows.append(row)
        for p in (0, 1):
            rows.append([ONE * (k % 2 == p) for k in range(conditions.size)])
        for area in conditions.areas:
            row = [0] * conditions.size
            for p, q, sign in area:
                row[p] += sign * x[q]
                row[q] += sign * x[p]
            rows.append(row)
        return [*rows, list(x)]

    def values(self, x: Row) -> Row:
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
        values = [c / (1 << 2 * S) for c in self.values([whole(c) for c in x])]
        return [*values[:-1], values[-1] / 2]

    # --- bounds, over 2^P ------------------------------------------------------------------------

    @cached_property
    def _a(self) -> Row:
        values = self.values(self.x)
        return [up(abs(dot(row, values)), 3 * S - P) for row in self.y]

    @cached_property
    def _b(self) -> Row:
        columns = range(len(self.n[0]))
        inner = [
            [dot(row, [line[c] for line in self.n]) + (place[c] << S) for c in columns]
            for row, place in zip(self.jacobian, self.by_place, strict=True)
        ]
        rows = [[dot(y, [line[c] for line in inner]) for c in columns] for y in self.y]
        return [up(sum(lengths(row)), 3 * S - P) for row in rows]

    @cached_property
    def _k0(self) -> list[Row]:
        n = range(self.of.size)
        return [
            [
                up(
                    abs((i == j) * (1 << 2 * S) - dot(y, [row[j] for row in self.jacobian])),
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
    def _t(self) -> Row:
        bounds = []
        places = len(self.n[0])
        for y, form in zip(self.y, self._forms, strict=True):
            half: dict[int, Row] = {}
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
            bounds.append(up(blocks(whole), 3 * S - P))
        return bounds

    def _jump(self, left: int, right: int, p: int) -> Row:
        """N of the difference of two gradients, over 2^S; times 2^S, as in the other forms."""
        pairs = zip(self.n[2 * left + p], self.n[2 * right + p], strict=True)
        return [(a - b) << S for a, b in pairs]

    @cached_property
    def _k1(self) -> list[Row]:
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
            bounds.append([up(sum(lengths(row)), 2 * S - P) for row in rows])
        return bounds

    # --- the test --------------------------------------------------------------------------------

    def box(self, r: int) -> Row | None:
        """The sizes rho of a box with one zero for all moves up to r, over 2^P; None if none is
        found.
        """
        unit = 1 << P
        base = [
            a + up(r * b, P) + up(r * r * t, 2 * P)
            for a, b, t in zip(self._a, self._b, self._t, strict=True)
        ]
        linear = [
            [k + up(r * m, P) for k, m in zip(k0, k1, strict=True)]
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
                b + up(dot(row, rho), P) + up(sum(c * rho[p] * rho[q] for p, q, c in form), 2 * P)
                < s
                for b, row, form, s in zip(base, linear, forms, rho, strict=True)
            ):
                return rho
        return None

    def letters(self, r: int, rho: Row) -> dict[Edge, str]:
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
            steep = sum(up(sum(lengths(row)), 2 * S - P) for row in turned)
            lost = up(r * up(sum(lengths(linear)), 3 * S - P), P)
            lost += up(abs(d[0]) * wide[1] + abs(d[1]) * wide[0], S)
            lost += up(2 * r * (up(r * steep, P) + sum(wide)), P)
            bend = d[0] * jump[1] - d[1] * jump[0]
            size = abs(bend) >> 2 * S - P
            letters[i, j] = "" if size <= lost else "V" if bend > 0 else "M"
        return letters

    def differs(self, own: Row, other: Zero, rho: Row) -> bool:
        """Whether two zeros of the given sheet, in their boxes, are no multiples of each other."""
        mine, theirs = ([c << P - S for c in zero.x] for zero in (self, other))
        errors = [
            [s + up(self.of.off * sum(lengths(row)), S) for s, row in zip(box, zero.n, strict=True)]
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


# --- floats --------------------------------------------------------------------------------------


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
