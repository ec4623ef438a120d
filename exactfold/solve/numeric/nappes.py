"""The equations of the nappes in exact rows, and Newton's method on them without arrays.

`dense_newton` states the equations. Arrays are much faster for many sign vectors, but to load NumPy
takes longer than to find all branches of a sheet of four vertices in plain floats.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import hypot, isfinite
from operator import mul

from exactfold.exact.linalg import integer_squares
from exactfold.exact.numbers import over_common_denominator
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.gauge import Gauge
from exactfold.rigidity.timelike import round_cone
from exactfold.solve.numeric.linear_start import start_size

Row = tuple[Fraction, ...]

_STEPS = 40
_CONVERGED = 1e-13


@dataclass(frozen=True)
class Nappe:
    """l_v and A_v of one vertex as exact rows on (x, 1).

    N_v is the sum of weight * (row . (x, 1))^2. A row is a tuple of integers and their common
    denominator; a weight is a pair of integers and stands for their quotient. They are long and
    hardly ever needed in lowest terms.
    """

    over_line: tuple[tuple[int, ...], int]
    over_squares: tuple[tuple[tuple[int, int], tuple[tuple[int, ...], int]], ...]

    @cached_property
    def line(self) -> Row:
        """The functional l_v as a row of fractions."""
        row, below = self.over_line
        return tuple(Fraction(c, below) for c in row)

    @cached_property
    def squares(self) -> tuple[tuple[Fraction, Row], ...]:
        """The weights and rows as fractions."""
        return tuple(
            (Fraction(*weight), tuple(Fraction(c, below) for c in row))
            for weight, (row, below) in self.over_squares
        )

    @property
    def float_line(self) -> list[float]:
        """The functional l_v, with each entry rounded once."""
        row, below = self.over_line
        return [c / below for c in row]

    @property
    def float_root(self) -> list[list[float]]:
        """The matrix A_v: each row times the root of its weight."""
        return [
            [(over / under) ** 0.5 * (c / below) for c in row]
            for (over, under), (row, below) in self.over_squares
        ]

    @property
    def form(self) -> list[list[float]]:
        """l_v^2 - N_v as a matrix on (x, 1), with each entry rounded once: scaled K_v minus k_v."""
        terms = [(Fraction(1), self.line), *((-weight, row) for weight, row in self.squares)]
        places = sorted({k for _, row in terms for k, c in enumerate(row) if c})
        matrix = [[0.0] * len(self.line) for _ in self.line]
        for i in places:
            for j in places:
                matrix[i][j] = float(sum((w * row[i] * row[j] for w, row in terms), Fraction(0)))
        return matrix


def nappes(gauge: Gauge) -> tuple[Nappe, ...]:
    """The exact data of the vertices of all unknowns; each l_v has coefficient 1 at the hub.

    Write K_v = M / d, and let t be a cone and p = M t, in integers. Then l_v is p . h divided by
    its coefficient p_v at the hub, and p_v^2 N_v = (p . h)^2 - (t . p) h^T M h.
    """
    size = len(gauge.unknowns) + 1
    heights, unit = over_common_denominator(gauge.boundary_heights.values())
    lift = {v: (k, unit) for k, v in enumerate(gauge.unknowns)}
    lift |= {v: (size - 1, h) for v, h in zip(gauge.boundary_heights, heights, strict=True) if h}
    rows = []
    for v in gauge.unknowns:
        form, cone = curvature_form(gauge.sheet, v), round_cone(gauge.sheet, v)
        t, _ = over_common_denominator(cone[u] for u in form.labels)
        p = [sum(map(mul, row, t)) for row in form.integers]
        top, hub = sum(map(mul, t, p)), p[form.labels.index(v)]
        rest = [
            [a * b - top * k for b, k in zip(p, row, strict=True)]
            for a, row in zip(p, form.integers, strict=True)
        ]
        places = [lift.get(u) for u in form.labels]
        squares = [
            ((lead, before * hub * hub), (_lifted(row, places, size), lead * unit))
            for lead, before, row in integer_squares(rest)
        ]
        if v == gauge.corner:
            level = gauge.corner_curvature * top * form.denominator / (hub * hub)
            last = tuple(int(k == size - 1) for k in range(size))
            squares.append((level.as_integer_ratio(), (last, 1)))
        rows.append(Nappe((_lifted(p, places, size), hub * unit), tuple(squares)))
    return tuple(rows)


def few_ends(gauge: Gauge, all_signs: Iterable[Sequence[int]]) -> tuple[list[list[float]], int]:
    """The zeros of g for vectors of signs of the unknowns, and the number of Newton steps.

    The steps are those of `dense_newton`, but not damped. Raises `ArithmeticError` at the first
    vector for which they do not converge.

    >>> from exactfold.pattern.families import single_vertex
    >>> ends, steps = few_ends(Gauge.of(single_vertex(4)), [[1], [-1]])
    >>> [[round(x, 6) for x in end] for end in ends]
    [[0.5], [-0.144043]]
    """
    rows = nappes(gauge)
    lines, roots = [nappe.float_line for nappe in rows], [nappe.float_root for nappe in rows]
    slopes, levels = [line[:-1] for line in lines], [line[-1] for line in lines]
    size = start_size(_solution(slopes, levels))
    ends, steps = [], 0
    for e in all_signs:
        x = _solution(slopes, [s * size - level for s, level in zip(e, levels, strict=True)])
        for _ in range(_STEPS):
            steps += 1
            change = _step(lines, roots, e, [*x, 1.0])
            x = [a - b for a, b in zip(x, change, strict=True)]
            if max(map(abs, change)) <= _CONVERGED * (1.0 + max(map(abs, x))):
                break
        else:
            raise ArithmeticError(f"Newton's steps for the signs {e} did not converge")
        ends.append(x)
    return ends, steps


def _step(
    lines: list[list[float]], roots: list[list[list[float]]], e: Sequence[int], z: list[float]
) -> list[float]:
    """The change of x in one step: the zero of the linear equations at z = (x, 1)."""
    jacobian, values = [], []
    for line, root, sign in zip(lines, roots, e, strict=True):
        products = [_dot(row, z) for row in root]
        norm = hypot(*products)
        if not isfinite(norm):
            raise ArithmeticError("the steps left the range of floats")
        row = line[:-1]
        for weight, square in zip(products, root, strict=True):
            if weight:
                row = [a - sign * weight / norm * b for a, b in zip(row, square, strict=False)]
        jacobian.append(row)
        values.append(_dot(line, z) - sign * norm)
    return _solution(jacobian, values)


def _dot(a: Sequence[float], b: Sequence[float]) -> float:
    return sum(map(mul, a, b), 0.0)


def _solution(matrix: list[list[float]], right: Sequence[float]) -> list[float]:
    """The solution of a square system, by elimination; `ArithmeticError` if it is singular."""
    rows = [[*row, value] for row, value in zip(matrix, right, strict=True)]
    for k in range(len(rows)):
        pivot = max(range(k, len(rows)), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        lead = rows[k][k]
        row = rows[k] = [value / lead for value in rows[k]]
        for i, other in enumerate(rows):
            if i != k and other[k]:
                factor = other[k]
                rows[i] = [a - factor * b for a, b in zip(other, row, strict=True)]
    return [row[-1] for row in rows]


def _lifted(
    row: Sequence[int], places: Sequence[tuple[int, int] | None], size: int
) -> tuple[int, ...]:
    """A row over a star as a row on (x, 1), with heights in units; other vertices have height 0."""
    full = [0] * size
    for value, placed in zip(row, places, strict=True):
        if placed is not None:
            place, height = placed
            full[place] += height * value
    return tuple(full)
