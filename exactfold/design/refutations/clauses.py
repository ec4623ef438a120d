"""Sets of signs that are refuted, and what follows from them for other vertices."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import NamedTuple

from exactfold.design.refutations.refutation import Refutation

Signs = Mapping[int, int]

_LATER = 1.02
"""How much more a clause counts than the one before it."""


class Refuted(NamedTuple):
    """Signs that no solution has together; without a refutation, the star itself is the reason."""

    signs: Signs
    refutation: Refutation | None


class Forced(NamedTuple):
    """Signs with all that follow, and how: (number of the set, vertex) for each new sign.

    `contradicted` is the number of a set that is contained in the signs.
    """

    signs: dict[int, int]
    steps: list[tuple[int, int]]
    contradicted: int | None


class Clauses:
    """The refuted sets of signs, numbered in the order in which they were learned."""

    def __init__(self) -> None:
        self.known: list[Refuted] = []
        self._with: dict[tuple[int, int], list[int]] = defaultdict(list)
        self._alone: list[int] = []
        self.weight: dict[int, float] = defaultdict(float)
        """By vertex: how many sets name it; small ones, and those learned later, count for more."""
        self._step = 1.0

    def learn(self, refuted: Refuted) -> None:
        """Keep a set of signs."""
        number = len(self.known)
        self.known.append(refuted)
        self._step *= _LATER
        for v, sign in refuted.signs.items():
            self._with[v, sign].append(number)
            self.weight[v] += self._step / len(refuted.signs)
        if len(refuted.signs) < 2:
            self._alone.append(number)

    def forced(self, signs: Signs) -> Forced:
        """What follows from signs: where all of a set but one are there, the opposite of this."""
        found, steps, fresh = dict(signs), list[tuple[int, int]](), list(signs.items())
        numbers = list(self._alone)
        while True:
            for number in numbers:
                clause = self.known[number].signs
                left = [v for v, sign in clause.items() if found.get(v) != sign]
                if not left:
                    return Forced(found, steps, number)
                if len(left) == 1 and left[0] not in found:
                    (v,) = left
                    found[v] = -clause[v]
                    steps.append((number, v))
                    fresh.append((v, found[v]))
            if not fresh:
                return Forced(found, steps, None)
            numbers = self._with[fresh.pop()]
