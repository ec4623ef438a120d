"""Linear spaces of motions of sheets with vertices of any degree, and the leaves of such spaces."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Final, TypeAlias

import networkx as nx
from flint import arb

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold.errors import TooManyModesError
from exactfold.exact.joined_fields import joined
from exactfold.exact.surds import Number, ball, common_field, rational
from exactfold.panels.spaces.kernel import Entry, Rows, entry, imposed, number
from exactfold.panels.spaces.quadratics import (
    Squares,
    Vector,
    is_semidefinite,
    row_rank,
    row_space,
    squares_of,
)
from exactfold.panels.vertex.stars import Star, incidence
from exactfold.pattern.panel_pattern import Edge

_BITS: Final = 53


Bounds: TypeAlias = tuple[Fraction, Fraction]
"""A lower and an upper bound of a number."""


@dataclass(frozen=True)
class Leaf:
    """A part of the motions: a linear space, or its points at which the remaining forms vanish.

    `rows` gives the density of each active fold as a linear function of `size` parameters.
    `vertices` are those whose form does not vanish on the space; each of these forms has one sign
    once and the other sign at least twice. `dimension` is that of the real solutions if they are
    one component; with two or more forms this has to be shown (docs/panels.md, Double covers).

    If those points are several lines, there is a leaf for each line, and `motion` has bounds of the
    parameters of one point of this line.
    """

    rows: Mapping[Edge, tuple[Number, ...]]
    size: int
    vertices: tuple[int, ...]
    motion: tuple[Bounds, ...] = ()

    def __repr__(self) -> str:
        if self.motion:
            return f"<Leaf: {counted(len(self.rows), 'fold')}, one line>"
        left = f", {counted(len(self.vertices), 'form')} left" if self.vertices else ""
        return f"<Leaf: {counted(len(self.rows), 'fold')}, dimension {self.size}{left}>"

    @property
    def dimension(self) -> int:
        """The dimension of the space minus the number of remaining forms."""
        return self.size - len(self.vertices)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The folds that are not flat on the whole leaf."""
        return tuple(sorted(self.rows))

    @property
    def densities(self) -> Mapping[Edge, Bounds]:
        """Bounds of the densities at `motion`; empty unless the leaf is one of several lines."""
        if not self.motion:
            return {}
        return {edge: bounds_of(map(rational, row), self.motion) for edge, row in self.rows.items()}


def bounds_of(row: Iterable[Fraction | int], known: Sequence[Bounds]) -> Bounds:
    """Bounds of a linear function of numbers with these bounds.

    >>> one = Fraction(1)
    >>> bounds_of([2, -1], [(one, one + 1), (one, one + 2)])
    (Fraction(-1, 1), Fraction(3, 1))
    """
    low = high = Fraction(0)
    for x, (least, most) in zip(row, known, strict=True):
        if x:
            low += x * (least if x > 0 else most)
            high += x * (most if x > 0 else least)
    return low, high


class LimitedSearch:
    """A search through spaces of motions, with a limit on its work.

    `until` is the work at which it stops, at first `most`. `sums` says whether a semidefinite form
    met was a sum of several squares. The complex zeros of such a form have a larger dimension than
    its kernel.
    """

    def __init__(self, stars: Mapping[int, Star], most: int, clock: Clock = UNLIMITED) -> None:
        self.stars = stars
        self.at = incidence(stars)
        self.most = self.until = most
        self.clock = clock
        self.work = 0
        self.sums = False

    def count(self, steps: int) -> None:
        """Add to the work done. A limit of work makes the search end in the same way on every
        machine, unless the clock ends it before.
        """
        self.clock.check()
        self.work += steps
        if self.work > self.until:
            raise TooManyModesError(
                "splitting its spaces of motions one by one takes more work than is allowed"
            )


class SubspaceSearch(LimitedSearch):
    """The replacing of semidefinite forms by their kernels."""

    def reduced(self, rows: Rows, size: int) -> tuple[Rows, int, list[Squares], list[int]]:
        """The space after all semidefinite forms; the forms that split; the vertices with other
        forms.
        """
        known: set[int] = set()
        while True:
            products: list[Squares] = []
            left: list[int] = []
            before = size
            weight = common_field(x for row in rows.values() for x in row).dimension ** 2
            for v in sorted({v for edge in rows for v in self.at[edge]} - known):
                self.count(len(self.stars[v].folds) * size * weight)
                squares = squares_of(self.stars[v], rows, size, self.clock)
                if is_semidefinite(squares):
                    self.sums = self.sums or len(squares) > 1
                    rows, size = imposed(rows, size, *(functional for _, functional in squares))
                if not squares or is_semidefinite(squares):
                    known.add(v)
                elif len(squares) == 2:
                    products.append(squares)
                else:
                    left.append(v)
            if size == before:
                return rows, size, products, left


def reduced(
    stars: Mapping[int, Star], rows: Rows, size: int, most: int, clock: Clock = UNLIMITED
) -> tuple[Rows, int, bool]:
    """The space after all semidefinite forms, and whether one of these was a sum of squares.

    It is unchanged if that takes more than `most` steps, or if the clock has passed.
    """
    search = SubspaceSearch(stars, most, clock)
    try:
        rows, size, _, _ = search.reduced(rows, size)
    except TooManyModesError:
        return rows, size, False
    return rows, size, search.sums


def made_leaf(rows: Rows, size: int, left: Iterable[int]) -> Leaf:
    """A leaf of these rows; `left` are the vertices whose forms remain."""
    zero = Fraction(0)
    numbers = {edge: tuple(number(x) if x else zero for x in row) for edge, row in rows.items()}
    return Leaf(numbers, size, tuple(left))


def direct_sum(a: Leaf, b: Leaf) -> Leaf:
    """The direct sum of two leaves on different parts of the sheet."""
    zeros_a, zeros_b = (Fraction(0),) * a.size, (Fraction(0),) * b.size
    rows = {edge: row + zeros_b for edge, row in a.rows.items()}
    rows.update({edge: zeros_a + row for edge, row in b.rows.items()})
    return Leaf(rows, a.size + b.size, tuple(sorted(a.vertices + b.vertices)))


def maximal(candidates: Iterable[Leaf], clock: Clock = UNLIMITED) -> list[Leaf]:
    """The leaves that lie in no other leaf; among equal leaves, the first.

    Raises `TooManyModesError` if the time is over.
    """
    kept: list[_Enclosed] = []
    for leaf in sorted(candidates, key=lambda leaf: (-leaf.size, len(leaf.vertices))):
        one = _Enclosed(leaf)
        around = (other for other in kept if leaf.rows.keys() <= other.leaf.rows.keys())
        if not any(one.lies_in(other, clock) for other in around):
            kept.append(one)
    return [one.leaf for one in kept]


class _Enclosed:
    """A leaf whose rows are enclosed in balls when they are first asked for."""

    def __init__(self, leaf: Leaf) -> None:
        self.leaf = leaf

    @cached_property
    def _rows(self) -> dict[Edge, list[tuple[int, arb]]]:
        rows = self.leaf.rows.items()
        return {edge: [(k, ball(x, _BITS)) for k, x in enumerate(row) if x] for edge, row in rows}

    @cached_property
    def _places(self) -> dict[int, Edge]:
        """A fold for each parameter, whose density it is."""
        places: dict[int, Edge] = {}
        for edge, row in self._rows.items():
            if len(row) == 1 and self.leaf.rows[edge][row[0][0]] == 1:
                places.setdefault(row[0][0], edge)
        return places

    @cached_property
    def _motion(self) -> dict[Edge, arb]:
        return {e: sum((x * (k + 1) for k, x in row), arb(0)) for e, row in self._rows.items()}

    def lies_in(self, other: _Enclosed, clock: Clock) -> bool:
        """Whether the motions of this leaf lie in the space of another, and so in the other leaf.

        A leaf contains all motions in its space, because the remaining forms vanish at every
        motion, too.
        """
        clock.check()
        return not self.is_outside(other) and _inside(self.leaf, other.leaf, other._places)

    def is_outside(self, other: _Enclosed) -> bool:
        """Whether balls show that some motion of this leaf does not lie in the space of another."""
        places, zero = other._places, arb(0)
        if len(places) < other.leaf.size:
            return False
        at = [self._motion.get(places[k], zero) for k in range(other.leaf.size)]
        return any(
            not (self._motion.get(e, zero) - sum((x * at[k] for k, x in row), zero)).contains(0)
            for e, row in other._rows.items()
        )


def _inside(leaf: Leaf, other: Leaf, places: Mapping[int, Edge]) -> bool:
    """Whether the motions of one leaf lie in the space of another.

    `places` has a fold for each parameter of the other leaf, whose density it is, as far as there
    are such folds. If all are there, their densities give those of all folds.
    """
    folds = list(other.rows)
    zero = (Fraction(0),) * leaf.size
    columns = [[*other.rows[edge], *leaf.rows.get(edge, zero)] for edge in folds]
    entries = [[entry(x) for x in row] for row in joined(columns)]
    if len(places) < other.size:
        return row_rank(_transposed(entries), len(folds)) == other.size
    at = dict(zip(folds, (row[other.size :] for row in entries), strict=True))
    return all(
        not sum((x * at[places[k]][j] for k, x in enumerate(row[: other.size]) if x), -value)
        for row in entries
        for j, value in enumerate(row[other.size :])
    )


def _transposed(rows: Sequence[Sequence[Entry]]) -> list[Vector]:
    return [list(column) for column in zip(*rows, strict=True)]


def independent_parts(rows: Rows, size: int, stars: Mapping[int, Star]) -> list[tuple[Rows, int]]:
    """The space as a direct sum over the parts of the sheet that active folds connect.

    It is one part if a condition on several vertices joins what active folds do not connect.
    """
    graph = nx.Graph()
    at = incidence(stars)
    for edge, row in rows.items():
        if any(row):
            ends = at.get(edge, ())
            graph.add_edges_from((edge, ("vertex", v)) for v in ends)
            graph.add_node(edge)
    groups = [
        sorted(node for node in group if node[0] != "vertex")
        for group in nx.connected_components(graph)
    ]
    if len(groups) == 1 and len(groups[0]) == len(rows):
        return [(rows, size)]
    parts = []
    for group in groups:
        basis, coordinates = row_space([rows[edge] for edge in group], size)
        parts.append((dict(zip(group, coordinates, strict=True)), len(basis)))
    return parts if sum(number for _, number in parts) == size else [(rows, size)]
