"""Linear equations over Q that arrive one after another, solved for as few unknowns as possible."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from fractions import Fraction
from typing import Generic, TypeVar

Unknown = TypeVar("Unknown", bound=Hashable)


class System(Generic[Unknown]):
    """Equations, each reduced by those before it; every unknown is a sum of free unknowns.

    An equation is solved for the unknown of least `weight` in it; an unknown whose weight is None
    stays free. `rank` counts the independent equations so far.

    >>> system = System({"a": 2, "b": 1}.get)
    >>> system.add({"a": 1, "b": -1}, Fraction(1, 2)), system.rank
    (True, 1)
    >>> system.expression("b")
    ({'a': Fraction(1, 1)}, Fraction(-1, 2))
    >>> system.add({"a": 2, "b": -2}, Fraction(1)), system.rest({"a": 2, "b": -2}, Fraction(0))
    (False, ({}, Fraction(-1, 1)))
    """

    def __init__(self, weight: Callable[[Unknown], float | None]) -> None:
        self._weight = weight
        self._sums: dict[Unknown, dict[Unknown, Fraction]] = {}
        self._constants: dict[Unknown, Fraction] = {}
        self._users: dict[Unknown, set[Unknown]] = {}
        self.rank = 0

    def is_solved(self, unknown: Unknown) -> bool:
        """Whether the unknown is a sum of others."""
        return unknown in self._sums

    def expression(self, unknown: Unknown) -> tuple[dict[Unknown, Fraction], Fraction]:
        """The unknown as a sum of multiples of free unknowns plus a constant."""
        if unknown in self._sums:
            return dict(self._sums[unknown]), self._constants[unknown]
        return {unknown: Fraction(1)}, Fraction(0)

    def rest(
        self, terms: Mapping[Unknown, int | Fraction], value: Fraction
    ) -> tuple[dict[Unknown, Fraction], Fraction]:
        """What is left of the equation sum = value after the equations so far are substituted."""
        left: dict[Unknown, Fraction] = {}
        for unknown, factor in terms.items():
            if unknown in self._sums:
                value -= factor * self._constants[unknown]
                for free, part in self._sums[unknown].items():
                    left[free] = left.get(free, Fraction(0)) + factor * part
            else:
                left[unknown] = left.get(unknown, Fraction(0)) + factor
        return {free: factor for free, factor in left.items() if factor}, value

    def add(self, terms: Mapping[Unknown, int | Fraction], value: Fraction) -> bool:
        """Adds the equation sum = value; False if no unknown that may be solved for is left in it.

        Then the equation changes nothing, and `rest` says whether it is implied or contradicts.
        """
        left, value = self.rest(terms, value)
        weights = {u: w for u in left if (w := self._weight(u)) is not None}
        if not weights:
            return False
        pivot = min(weights, key=lambda u: (weights[u], len(self._users.get(u, ()))))
        factor = left.pop(pivot)
        row = {free: -part / factor for free, part in left.items()}
        constant = value / factor
        for user in self._users.pop(pivot, set()):
            times = self._sums[user].pop(pivot)
            self._constants[user] += times * constant
            self._combine(user, row, times)
        self._sums[pivot] = {}
        self._constants[pivot] = constant
        self._combine(pivot, row, Fraction(1))
        self.rank += 1
        return True

    def _combine(self, user: Unknown, row: Mapping[Unknown, Fraction], times: Fraction) -> None:
        own = self._sums[user]
        for free, part in row.items():
            total = own.get(free, Fraction(0)) + times * part
            if total:
                own[free] = total
                self._users.setdefault(free, set()).add(user)
            else:
                del own[free]
                self._users[free].discard(user)
