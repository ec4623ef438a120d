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


def bits_of(signs: Signs) -> int:
    """The signs as bits of an integer: bit 2 v stands for v down, bit 2 v + 1 for v up.

    >>> bin(bits_of({0: 1, 2: -1}))
    '0b10010'
    """
    return sum(1 << (2 * v + (sign > 0)) for v, sign in signs.items())


class Clauses:
    """The refuted sets of signs, numbered in the order in which they were learned."""

    def __init__(self) -> None:
        self.known: list[Refuted] = []
        self._bits: list[int] = []
        self._with: dict[tuple[int, int], list[int]] = defaultdict(list)
        self._alone: list[int] = []
        self.weight: dict[int, float] = defaultdict(float)
        """By vertex: a weighted number of sets that name it; small and later sets count more."""
        self._step = 1.0

    def learn(self, refuted: Refuted) -> None:
        """Keep a refuted set of signs."""
        number = len(self.known)
        self.known.append(refuted)
        self._bits.append(bits_of(refuted.signs))
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
        held = bits_of(known_signs)
        numbers = list(self._alone)
        while True:
            for number in numbers:
                left = self._bits[number] & ~held
                if not left:
                    return Forced(known_signs, steps, number)
                if left & (left - 1):  # more than one sign of the set does not hold
                    continue
                v, up = divmod(left.bit_length() - 1, 2)
                if v not in known_signs:
                    known_signs[v] = -1 if up else 1
                    held |= 1 << (2 * v + 1 - up)
                    steps.append((number, v))
                    fresh.append((v, known_signs[v]))
            if not fresh:
                return Forced(known_signs, steps, None)
            numbers = self._with[fresh.pop()]
