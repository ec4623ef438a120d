"""Gaussian elimination for vectors of fold densities, exactly in one field or in intervals.

The work of a search is counted here, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most
from ..core.towers import Number, Parts, Tower
from ..sheets.panels import Edge

MOST_ROOTS = limits.SPACE_ROOTS
MOST_STEPS = limits.SPACE_STEPS
SHORT = 16
BITS = 256

Vector = Mapping[Edge, Any]
"""For each fold a number of one field, or an interval; a fold that is left out has 0."""
Rows = list[tuple[Edge, Vector]]


class Work:
    """Counts products of densities; one with a number of n coefficients, of which m are not 0,
    counts m n steps.

    A product of two intervals is one step, and so are `SHORT` products of short numbers: residues
    modulo a prime, or numbers in floating point.
    """

    def __init__(self) -> None:
        self.steps = 0
        self._turn = MOST_STEPS

    def turn(self, steps: int) -> bool:
        """Allow so many steps more, if the limit does; say whether it allows more than these."""
        self._turn = self.steps + steps
        return self._turn < MOST_STEPS

    def count(self, products: int, value: Any) -> None:
        """Count products with this number or interval; raises `LimitError` if they are too many."""
        if isinstance(value, Number):
            products *= value.tower.size * max(1, sum(map(bool, value.parts)))
        self.steps += products
        most = min(self._turn, MOST_STEPS)
        at_most(self.steps, most, "the steps to the spaces of motions", "SPACE_STEPS")

    def count_short(self, products: int) -> None:
        """Count products of residues, or of numbers in floating point."""
        self.count(-(-products // SHORT), None)


def zero(value: Any) -> bool:
    """Whether a value is known to be 0; an interval never is."""
    return isinstance(value, Number) and not any(value.parts)


def rest_of(vector: Vector, rows: Rows, work: Work | None = None) -> Vector:
    """The vector minus multiples of the rows, so that the leading folds of all rows vanish."""
    rest = dict(vector)
    for lead, row in rows:
        if lead in rest:
            factor = rest[lead] / row[lead]
            if work is not None:
                work.count(len(row), factor)
            for fold, value in row.items():
                rest[fold] = rest[fold] - factor * value if fold in rest else -(factor * value)
            rest = {fold: value for fold, value in rest.items() if fold != lead and not zero(value)}
    return rest


def reduced(vectors: Iterable[Vector], work: Work | None = None) -> Rows:
    """A basis of the span; the leading fold of each row does not occur in the later rows.

    A vector of intervals is left out if it is not proved to be independent of the earlier rows.
    """
    rows: Rows = []
    for vector in vectors:
        rest = rest_of(vector, rows, work)
        lead = next((fold for fold in sorted(rest) if rest[fold].sign()), None)
        if lead is not None:
            rows.append((lead, rest))
    return rows


def enclosed(vector: Mapping[Edge, Number]) -> dict[Edge, Interval]:
    """The vector with an interval in place of each number."""
    return {fold: value.enclosed(BITS) for fold, value in vector.items()}


def in_floats(form: Sequence[tuple[Number, Sequence[Number]]]) -> list[list[float]]:
    """The matrix of a sum of squares d l^2 in floating point; l is given by its values."""
    size = len(form[0][1])
    total = [[0.0] * size for _ in range(size)]
    for weight, values in form:
        d, row = _float(weight), [_float(x) for x in values]
        for j, x in enumerate(row):
            for k, y in enumerate(row):
                total[j][k] += d * x * y
    return total


def _float(x: Number) -> float:
    interval = x.enclosed(BITS)
    return float(Fraction(interval.low + interval.high, 2 << BITS))


def inside(
    space: Sequence[Mapping[Edge, Number]],
    other: Sequence[Mapping[Edge, Number]],
    work: Work | None = None,
) -> bool:
    """Whether the span of `space` lies in the span of `other`, whose vectors are independent.

    Intervals refute it if they show that a vector of `space` is independent of `other`. Otherwise
    it is decided exactly, in one field.
    """
    folds = {fold for vector in other for fold in vector}
    if any(fold not in folds for vector in space for fold in vector):
        return False
    rows = reduced(map(enclosed, other), work)
    if len(rows) == len(other):
        rests = [rest_of(enclosed(vector), rows, work) for vector in space]
        if any(value.sign() for rest in rests for value in rest.values()):
            return False
    joined = Joined()
    exact = reduced([joined.vector(vector) for vector in other], work)
    return not any(rest_of(joined.vector(vector), exact, work) for vector in space)


def outside(
    place: Mapping[Edge, Interval], other: Sequence[Mapping[Edge, Number]], work: Work
) -> bool:
    """Whether intervals show that a motion does not lie in the span of independent vectors."""
    folds = {fold for vector in other for fold in vector}
    if any(value.sign() for fold, value in place.items() if fold not in folds):
        return True
    rows = reduced(map(enclosed, other), work)
    rest = rest_of(place, rows, work)
    return len(rows) == len(other) and any(value.sign() for value in rest.values())


class Joined:
    """One tower into which the numbers of several towers are mapped."""

    def __init__(self) -> None:
        self.tower = Tower()
        self._roots: dict[tuple[Parts, ...], Number] = {}

    def vector(self, vector: Mapping[Edge, Number]) -> dict[Edge, Number]:
        """The vector with its numbers mapped into the tower."""
        return {fold: self.of(value) for fold, value in vector.items()}

    def of(self, value: Number) -> Number:
        """The number mapped into the tower, to which levels are added if they are needed."""
        radicands = value.tower.radicands
        for k, radicand in enumerate(radicands):
            key = radicands[: k + 1]
            if key not in self._roots:
                self.tower, root = self.tower.adjoined(self._taken(radicand, radicands))
                roots = self.tower.size.bit_length() - 1
                at_most(roots, MOST_ROOTS, "the square roots that two spaces need", "SPACE_ROOTS")
                self._roots[key] = root
        return self.tower.number(self._taken(value.parts, radicands))

    def _taken(self, parts: Parts, radicands: tuple[Parts, ...]) -> Number:
        if len(parts) == 1:
            return self.tower.number(parts[0])
        half = len(parts) // 2
        low = self._taken(parts[:half], radicands)
        if not any(parts[half:]):
            return low
        root = self._roots[radicands[: half.bit_length()]]
        return low + self._taken(parts[half:], radicands) * root
