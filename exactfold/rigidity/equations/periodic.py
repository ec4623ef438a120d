"""The exact equations of a periodic sheet that rolls up on cylinders of one direction."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd
from operator import mul
from typing import TypeVar

from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike, as_rational, integer_row
from exactfold.pattern.periodic.cells import Corner, Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.periodic.rigid_parts import RigidParts, without_rigid_parts
from exactfold.rigidity.curvature import star_matrix
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.rigidity.equations.sheet import power_of_two
from exactfold.rigidity.functionals import bend_weights
from exactfold.rigidity.timelike import round_slopes

Row = tuple[Fraction, ...]


def direction_of(given: Sequence[RationalLike]) -> tuple[int, int]:
    """The shortest integer vector of a direction; raises `UsageError` for anything but a direction.

    >>> direction_of(("3/2", 2))
    (3, 4)
    """
    if len(given) != 2:
        raise UsageError(f"a direction has two coordinates, not {len(given)}")
    x, y = map(as_rational, given)
    if x == 0 == y:
        raise UsageError("the vector 0,0 is no direction")
    p, q = x.numerator * y.denominator, y.numerator * x.denominator
    common = gcd(p, q)
    return p // common, q // common


T = TypeVar("T")


def in_chart(row: Sequence[T], place: int) -> list[T]:
    """A row on z as a row on (x, 1), where x are the entries of z other than z_place = 1.

    >>> in_chart([5, 6, 7], 1)
    [5, 7, 6]
    """
    return [*row[:place], *row[place + 1 :], row[place]]


def other_factor(form: Sequence[Row], row: Sequence[int]) -> Row | None:
    """The row m for which a form is the product of m and a given row, which is not 0; or None.

    >>> half = Fraction(1, 2)
    >>> other_factor([(Fraction(0), half), (half, Fraction(1))], (0, 1))
    (Fraction(1, 1), Fraction(1, 1))
    """
    pivot = next(k for k, c in enumerate(row) if c)
    lead = form[pivot][pivot] / row[pivot]
    factor = tuple((2 * x - c * lead) / row[pivot] for x, c in zip(form[pivot], row, strict=True))
    same = all(
        2 * form[i][j] == row[i] * factor[j] + row[j] * factor[i]
        for i in range(len(row))
        for j in range(i + 1)
    )
    return factor if same else None


@dataclass(frozen=True)
class PeriodicStar:
    """The form of one vertex, on the heights of its neighbours above it.

    `rows` are these heights as rows on z; `matrix` is K_v in them, and `cone` a vector near the
    round cone, with K_v(cone) > 0.
    """

    rows: tuple[Row, ...]
    matrix: tuple[Row, ...]
    cone: Row

    @cached_property
    def image(self) -> Row:
        """The coefficients of K_v(cone, .)."""
        return tuple(sum(map(mul, row, self.cone), Fraction(0)) for row in self.matrix)

    @cached_property
    def timelike(self) -> Fraction:
        """K_v(cone) > 0."""
        return sum(map(mul, self.image, self.cone), Fraction(0))

    @cached_property
    def form(self) -> tuple[Row, ...]:
        """K_v as a symmetric matrix on z."""
        return self.lifted(self.matrix)

    @cached_property
    def functional(self) -> Row:
        """K_v(cone, .) as a row on z."""
        columns = zip(*self.rows, strict=True)
        return tuple(sum(map(mul, self.image, column), Fraction(0)) for column in columns)

    @cached_property
    def deficiency(self) -> tuple[Row, ...]:
        """The positive semidefinite K_v(cone, .)^2 / K_v(cone) - K_v, as a matrix on z."""
        rest = [
            tuple(a * b / self.timelike - k for b, k in zip(self.image, row, strict=True))
            for a, row in zip(self.image, self.matrix, strict=True)
        ]
        return self.lifted(rest)

    def lifted(self, matrix: Sequence[Row]) -> tuple[Row, ...]:
        """A form in the heights of the neighbours, as a matrix on z."""
        columns = list(zip(*self.rows, strict=True))
        half = [[sum(map(mul, row, column), Fraction(0)) for column in columns] for row in matrix]
        turned = list(zip(*half, strict=True))
        return tuple(
            tuple(sum(map(mul, column, other), Fraction(0)) for other in turned)
            for column in columns
        )


def star_of(
    sheet: PeriodicPattern, vertex: int, height: Callable[[int, Fraction, Fraction], Row]
) -> PeriodicStar:
    """The form of a vertex, where `height(u, x, y)` is a row: the height of u moved to (x, y)."""
    spokes = sheet.spokes(vertex)
    hub = height(vertex, Fraction(0), Fraction(0))
    rows = [
        tuple(a - b for a, b in zip(height(u, *d), hub, strict=True))
        for (u, _, _), d in zip(sheet.star(vertex), spokes, strict=True)
    ]
    whole = star_matrix(spokes, lambda a, b: Fraction(a) / b)
    matrix = tuple(tuple(row[1:]) for row in whole[1:])

    def is_timelike(cone: Sequence[Fraction]) -> bool:
        images = (sum(map(mul, row, cone), Fraction(0)) for row in matrix)
        return sum(map(mul, images, cone), Fraction(0)) > 0

    cone = round_slopes([x * x + y * y for x, y in spokes], is_timelike)
    return PeriodicStar(tuple(rows), matrix, tuple(cone))


def bend_of(
    sheet: PeriodicPattern, edge: Side, height: Callable[[int, Fraction, Fraction], Row]
) -> Row:
    """The row that is positive where a fold is a valley: the jump of the slope across it."""
    u, v, i, j = edge
    corners: list[Corner] = [(u, 0, 0), (v, i, j), *sheet.opposite(edge)]
    places = [sheet.place(corner) for corner in corners]
    rows = (height(w, *at) for (w, _, _), at in zip(corners, places, strict=True))
    columns = zip(*rows, strict=True)
    weights = bend_weights(places)
    return tuple(sum(map(mul, weights, column), Fraction(0)) for column in columns)


@dataclass(frozen=True)
class PeriodicProblem:
    """K_v(h) = 0 for all vertices of a periodic sheet, on the heights that roll up across n.

    The heights are h = w + (b/2) (n . x)^2 with w the same at all translates of a vertex, and w = 0
    at the first one (docs/tessellations.md). They are z = (w_1, ..., w_m, c), m + 1 = V, where
    b = c `unit`; the unit makes all of them about equally large. In `sheet` each triangulated
    triangle is one face; vertex k of `sheet` is vertex `labels[k]` of `pattern`. The forms add up
    to 0, so that the first one is left out in the charts z_k = 1.

    >>> from exactfold.pattern.periodic.cell_files import read_cell
    >>> problem = PeriodicProblem.of(read_cell("waterbomb-cell"), (3, 4))
    >>> problem.size, problem.system(2)
    (2, <QuadraticSystem: 2 quadrics in 2 unknowns>)
    """

    pattern: PeriodicPattern
    parts: RigidParts
    direction: tuple[int, int]

    @classmethod
    def of(cls, pattern: PeriodicPattern, direction: Sequence[RationalLike]) -> PeriodicProblem:
        """The problem of a sheet and a direction; raises the errors of `direction_of`."""
        return cls(pattern, without_rigid_parts(pattern), direction_of(direction))

    @property
    def sheet(self) -> PeriodicPattern:
        """The sheet without rigid parts."""
        return self.parts.sheet

    @property
    def labels(self) -> tuple[int, ...]:
        """The vertices of the given sheet that the vertices of `sheet` are."""
        return self.parts.labels

    @property
    def size(self) -> int:
        """The number of unknowns, one less than the number of vertices of `sheet`."""
        return self.sheet.V - 1

    def height(self, vertex: int, x: Fraction, y: Fraction) -> Row:
        """The height of a vertex, moved to (x, y), modulo linear functions: a row on z."""
        along = self.direction[0] * x + self.direction[1] * y
        row = [Fraction(0)] * self.size + [along * along * self.unit / 2]
        if vertex:
            row[vertex - 1] = Fraction(1)
        return tuple(row)

    @cached_property
    def unit(self) -> Fraction:
        """A power of two near 1 / (|n|^2 times the area of a cell for each vertex)."""
        p, q = self.direction
        return power_of_two(self.sheet.V / (self.sheet.area * (p * p + q * q)))

    @cached_property
    def stars(self) -> tuple[PeriodicStar, ...]:
        """The form of every vertex of `sheet`."""
        return tuple(star_of(self.sheet, v, self.height) for v in range(self.sheet.V))

    def system(self, place: int) -> QuadraticSystem:
        """The forms of all vertices but the first, in the chart z_place = 1."""
        forms = [star.form for star in self.stars[1:]]
        return QuadraticSystem.from_rational(
            [in_chart([in_chart(row, place) for row in form], place) for form in forms]
        )

    @cached_property
    def bend(self) -> tuple[int, ...]:
        """The row on z that has the sign of b."""
        return (*[0] * self.size, 1)

    @cached_property
    def vertices(self) -> Mapping[int, tuple[int, ...]]:
        """Rows on z that are positive where a vertex pops up and negative where it pops down."""
        return {v: integer_row(star.functional) for v, star in enumerate(self.stars)}

    @cached_property
    def folds(self) -> Mapping[Side, tuple[int, ...]]:
        """Rows on z that are positive where a fold is a valley and negative for a mountain."""
        return {
            edge: integer_row(bend_of(self.sheet, edge, self.height)) for edge in self.sheet.edges
        }

    @cached_property
    def bends_at(self) -> tuple[tuple[Row, ...], ...]:
        """For each vertex the rows of its folds: all vanish exactly where its star is flat."""
        around: list[list[Row]] = [[] for _ in self.stars]
        for (u, v, _, _), row in self.folds.items():
            for end in {u, v}:
                around[end].append(tuple(map(Fraction, row)))
        return tuple(map(tuple, around))

    @cached_property
    def partners(self) -> Mapping[Side, tuple[tuple[int, ...], ...]]:
        """For each fold the rows m with K_v = m times the row of the fold, at an end v of it.

        On a solution the fold is flat wherever such an m is not 0. There is one at a vertex with
        four folds, two of which are in line, and at others for some directions.
        """
        found: dict[Side, tuple[tuple[int, ...], ...]] = {}
        for edge, row in self.folds.items():
            ends = sorted({*edge[:2]}) if any(row) else []
            factors = [other_factor(self.stars[v].form, row) for v in ends]
            found[edge] = tuple(integer_row(m) for m in factors if m is not None)
        return found
