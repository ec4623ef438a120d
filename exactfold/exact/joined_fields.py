"""Numbers from several fields of square roots, put into one common tower of fields."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from exactfold.errors import UsageError
from exactfold.exact.root_tower import Coefficients
from exactfold.exact.surds import RATIONALS, Number, Surd


class JoinedField:
    """A tower of square roots that grows until it contains all numbers it is given.

    >>> two, three = RATIONALS.adjoined(2).root, RATIONALS.adjoined(3).root
    >>> tower = JoinedField([two, three])
    >>> tower.number(two) * tower.number(three) < 3, tower.field.dimension
    (True, 4)
    """

    def __init__(self, values: Iterable[Number]) -> None:
        self.field = RATIONALS
        self._roots: dict[tuple[Coefficients, ...], Surd | None] = {}
        for value in values:
            if isinstance(value, Surd):
                for level in range(1, len(value.field.radicands) + 1):
                    self._root(value.field.radicands[:level])

    def number(self, value: Number) -> Surd:
        """The given number as an element of the tower."""
        if not isinstance(value, Surd):
            return self.field.number(value)
        return self._lifted(value.field.radicands, value.coefficients)

    def _lifted(self, radicands: tuple[Coefficients, ...], a: Coefficients) -> Surd:
        if len(a) == 1:
            return self.field.number(a[0])
        half, below = len(a) // 2, radicands[:-1]
        low = self._lifted(below, a[:half])
        if not any(a[half:]):
            return low
        return low + self._root(radicands) * self._lifted(below, a[half:])

    def _root(self, radicands: tuple[Coefficients, ...]) -> Surd:
        known = self._roots.get(radicands)
        if known is None:
            square = self._lifted(radicands[:-1], radicands[-1])
            self.field = self.field.adjoined(square)
            known = self.field.square_root(square)
            if known is None:
                raise UsageError(f"{square} has no square root in the field that was made for it")
            self._roots[radicands] = known
        return known


def joined(rows: Sequence[Sequence[Number]]) -> list[list[Number]]:
    """The entries of a matrix as numbers of one field; unchanged if at most one field occurs."""
    fields = {x.field for row in rows for x in row if isinstance(x, Surd)}
    if len(fields) < 2:
        return [list(row) for row in rows]
    tower = JoinedField(x for row in rows for x in row)
    return [[tower.number(x) for x in row] for row in rows]
