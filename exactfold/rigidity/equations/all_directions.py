"""The exact equations of a periodic sheet that rolls up, for all directions together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.exact.linalg import from_fmpq, nullspace, to_flint
from exactfold.exact.numbers import integer_row
from exactfold.pattern.periodic.cells import Side
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.periodic.rigid_parts import RigidParts, without_rigid_parts
from exactfold.rigidity.equations.periodic import PeriodicStar, Row, bend_of, star_of
from exactfold.rigidity.equations.sheet import power_of_two


@dataclass(frozen=True)
class FlatStar:
    """The solutions at which one vertex is flat, in a chart: z = `lift` (y, 1).

    `forms` are those of the other vertices, as symmetric matrices on (y, 1).
    """

    lift: tuple[Row, ...]
    forms: tuple[tuple[Row, ...], ...]

    @property
    def unknowns(self) -> int:
        """The number of entries of y."""
        return len(self.lift[0]) - 1

    def on_chart(self, row: Sequence[Fraction]) -> Row:
        """A row on z as a row on (y, 1)."""
        columns = zip(*self.lift, strict=True)
        return tuple(
            sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0))
            for column in columns
        )


@dataclass(frozen=True)
class AllDirections:
    """K_v(h) = 0 for all vertices of a periodic sheet, on all heights w + x^T B x / 2.

    w is the same at all translates of a vertex, and 0 at the first one; B is any symmetric matrix.
    The sum of all K_v is the area of a cell times det B (docs/tessellations.md, Lemma 1), so that
    B = b n n^T on solutions. The heights are z = (w_1, ..., w_m, c_11, c_12, c_22), m + 1 = V, with
    B = c `unit`. In `sheet` each triangulated triangle is one face; vertex k of `sheet` is vertex
    `labels[k]` of `pattern`.

    >>> from exactfold.pattern.periodic.cell_files import read_cell
    >>> whole = AllDirections.of(read_cell("waterbomb-cell"))
    >>> len(whole.stars[0].form), whole.flat_star(0).unknowns
    (5, 0)
    """

    pattern: PeriodicPattern
    parts: RigidParts

    @classmethod
    def of(cls, pattern: PeriodicPattern) -> AllDirections:
        """The problem of a sheet."""
        return cls(pattern, without_rigid_parts(pattern))

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
        """The number of free heights w, one less than the number of vertices of `sheet`."""
        return self.sheet.V - 1

    @cached_property
    def unit(self) -> Fraction:
        """A power of two near 1 / the area of a cell for each vertex."""
        return power_of_two(self.sheet.V / self.sheet.area)

    def _row(self, vertex: int, x: Fraction, y: Fraction) -> Row:
        half = self.unit / 2
        row = [Fraction(0)] * self.size + [x * x * half, 2 * x * y * half, y * y * half]
        if vertex:
            row[vertex - 1] = Fraction(1)
        return tuple(row)

    @cached_property
    def stars(self) -> tuple[PeriodicStar, ...]:
        """The form of every vertex of `sheet`."""
        return tuple(star_of(self.sheet, v, self._row) for v in range(self.sheet.V))

    @cached_property
    def vertices(self) -> tuple[tuple[int, ...], ...]:
        """Rows on z that are positive where a vertex pops up and negative where it pops down."""
        return tuple(integer_row(star.functional) for star in self.stars)

    @cached_property
    def folds(self) -> Mapping[Side, tuple[int, ...]]:
        """Rows on z that are positive where a fold is a valley and negative for a mountain."""
        return {
            edge: integer_row(bend_of(self.sheet, edge, self._row)) for edge in self.sheet.edges
        }

    def flat_rows(self, vertex: int) -> list[Row]:
        """The rows of the folds of a vertex: all vanish exactly where its star is flat."""
        return [tuple(map(Fraction, row)) for edge, row in self.folds.items() if vertex in edge[:2]]

    def bend_rows(self) -> tuple[Row, Row, Row]:
        """Rows on z with the values c_11, c_12 and c_22."""
        width = self.size + 3
        first, second, third = (
            tuple(Fraction(int(k == self.size + place)) for k in range(width)) for place in range(3)
        )
        return first, second, third

    @cached_property
    def level(self) -> Row:
        """A row on z that is 1 in the charts: a positive multiple of b on all real solutions.

        It is the sum of l^T B l for the lattice vectors l.
        """
        total = [Fraction(0)] * 3
        for x, y in self.sheet.lattice:
            for place, value in enumerate((x * x, 2 * x * y, y * y)):
                total[place] += value
        scale = self.sheet.area
        return (*[Fraction(0)] * self.size, *(value / scale for value in total))

    def flat_star(self, vertex: int) -> FlatStar | None:
        """The solutions with b = 1, up to a factor, at which a vertex is flat.

        None if there are none, as its star is flat only where B = 0.
        """
        basis = nullspace(self.flat_rows(vertex))
        values = [_dot(self.level, vector) for vector in basis]
        pivot = next((k for k, value in enumerate(values) if value), None)
        if pivot is None:
            return None
        foot = [x / values[pivot] for x in basis[pivot]]
        others = [
            [x - value * f for x, f in zip(vector, foot, strict=True)]
            for k, (vector, value) in enumerate(zip(basis, values, strict=True))
            if k != pivot
        ]
        lift = list(zip(*others, foot, strict=True))
        matrix = to_flint(lift)
        forms = []
        for v, star in enumerate(self.stars):
            if v != vertex:
                form = (matrix.transpose() * to_flint(star.form) * matrix).tolist()
                forms.append(tuple(tuple(from_fmpq(x) for x in row) for row in form))
        return FlatStar(tuple(lift), tuple(forms))


def _dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))
