"""Refuted sets of signs, and the signs that follow from them for other vertices."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from typing import NamedTuple

from exactfold.design.refutations.refutation import Refutation

Signs = Mapping[int, int]

_LATER = 1.02
"""Each clause counts this much more than the one learned before it."""


class Refuted(NamedTuple):
    """Signs that no solution has all at once. If `refutation` is None, the star itself is the
    reason.
    """

    signs: Signs
    refutation: Refutation | None


class Forced(NamedTuple):
    """Signs together with all signs that follow from them.

    `steps` says how each new sign follows: (number of the refuted set, vertex). `contradicted` is
    the number of a refuted set that the signs contain, or None.
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
        """By vertex: a weighted number of sets that name it; small and later sets count more."""
        self._step = 1.0

    def learn(self, refuted: Refuted) -> None:
        """Keep a refuted set of signs."""
        number = len(self.known)
        self.known.append(refuted)
        self._step *= _LATER
        for v, sign in refuted.signs.items():
            self._with[v, sign].append(number)
            self.weight[v] += self._step / len(refuted.signs)
        if len(refuted.signs) < 2:
            self._alone.append(number)

    def forced(self, signs: Signs) -> Forced:
        """The signs that follow: where all signs of a set but one hold, the last one is the
        opposite.
        """
        known_signs, steps, fresh = dict(signs), list[tuple[int, int]](), list(signs.items())
        numbers = list(self._alone)
        while True:
            for number in numbers:
                clause = self.known[number].signs
                left = [v for v, sign in clause.items() if known_signs.get(v) != sign]
                if not left:
                    return Forced(known_signs, steps, number)
                if len(left) == 1 and left[0] not in known_signs:
                    (v,) = left
                    known_signs[v] = -clause[v]
                    steps.append((number, v))
                    fresh.append((v, known_signs[v]))
            if not fresh:
                return Forced(known_signs, steps, None)
            numbers = self._with[fresh.pop()]
