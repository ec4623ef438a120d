"""The conditions of layers as clauses: which orders of pieces cannot hold together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations, product
from typing import TypeAlias

from exactfold.checker.layers.folding import FoldedSheet
from exactfold.checker.layers.overlaps import Overlaps, members
from exactfold.checker.layers.plane import Plane
from exactfold.layers.constraints import Constraint
from exactfold.layers.placing import Order, Placing
from exactfold.layers.proofs import Clause
from exactfold.pattern.panel_pattern import Edge

Orders: TypeAlias = tuple[Order, ...]


@dataclass(frozen=True)
class Axiom:
    """A clause that holds because of the layers where some pieces and folds meet.

    One fold and a piece through whose inside it runs, two folds along each other, or three pieces
    with a common inner point.
    """

    folds: tuple[Edge, ...]
    pieces: tuple[int, ...]
    orders: Orders

    def place(self, placing: Placing) -> int:
        """The number of a place for the clause."""
        if not self.folds:
            return placing.inside(self.pieces, self.orders)
        if len(self.folds) == 2:
            return placing.along(*self.folds, self.orders)
        return placing.through(self.folds[0], self.pieces[-1], self.orders)


class Clauses:
    """Makes the clauses of a folded sheet whose overlapping pairs of pieces are numbered.

    A literal k is the order of pair k - 1, "the piece with the smaller number lies below", and -k
    the opposite order. `axioms` says why each clause that was made holds.
    """

    def __init__(self, folded: FoldedSheet, pairs: Sequence[Order]) -> None:
        self.folded, self.pairs, self.plane = folded, list(pairs), Plane(folded)
        self.axioms: dict[Clause, Axiom] = {}
        self._literals = {pair: k for k, pair in enumerate(self.pairs, 1)}

    def literal(self, low: int, high: int) -> int:
        """The literal of an order."""
        return self._literals[low, high] if low < high else -self._literals[high, low]

    def order(self, literal: int) -> Order:
        """The order that a literal says."""
        low, high = self.pairs[abs(literal) - 1]
        return (low, high) if literal > 0 else (high, low)

    def orders(self, clause: Iterable[int]) -> list[list[int]]:
        """A clause as a certificate has it."""
        return [list(self.order(literal)) for literal in clause]

    def given(self) -> list[int]:
        """The literals that the letters of the folds say."""
        return [self.literal(*order) for order in self.folded.lettered.values()]

    def of(self, constraint: Constraint) -> Iterator[Clause]:
        """The clauses of one condition."""
        if constraint.kind == "transitivity":
            a, b, c = constraint.pieces
            return self.line(a, b, c)
        if constraint.kind == "letter":
            return iter(())
        if len(constraint.edges) == 2:
            return self.along(*constraint.edges)
        return self.through(constraint.edges[0], constraint.pieces[2])

    def crossings(self, overlaps: Overlaps) -> Iterator[Clause]:
        """All clauses about folds."""
        for fold, pieces in zip(overlaps.folds, overlaps.through, strict=True):
            for piece in members(pieces):
                yield from self.through(fold, piece)
        for one, other in overlaps.along:
            yield from self.along(overlaps.folds[one], overlaps.folds[other])

    def line(self, a: int, b: int, c: int) -> Iterator[Clause]:
        """Three pieces with a common point do not lie in a circle."""
        yield self._axiom(((a, b), (b, c), (c, a)), (), (a, b, c))
        yield self._axiom(((b, a), (c, b), (a, c)), (), (a, b, c))

    def along(self, fold: Edge, other: Edge) -> Iterator[Clause]:
        """What two folds along each other have to fulfil."""
        folds = fold, other
        one, two = self._sides(fold), self._sides(other)
        for mine, theirs in zip(one, two, strict=True):
            if len(mine) == len(theirs) == 2:
                yield from self._nested(mine, theirs, folds)
            elif len(mine) + len(theirs) == 3:
                (a, b), (c,) = (mine, theirs) if len(mine) == 2 else (theirs, mine)
                yield from self._equal((a, c), (b, c), folds, ())
        if len(one[0]) == len(two[0]) == 1:
            yield from self._equal((one[0][0], two[0][0]), (one[1][0], two[1][0]), folds, ())

    def through(self, fold: Edge, piece: int) -> Iterator[Clause]:
        """What a fold and a piece through whose inside it runs have to fulfil."""
        a, b = self.folded.pieces_of(fold)
        yield from self._equal((a, piece), (b, piece), (fold,), (piece,))

    def _equal(
        self, one: Order, other: Order, folds: tuple[Edge, ...], pieces: tuple[int, ...]
    ) -> Iterator[Clause]:
        """Two orders hold together, or none of them."""
        for a, b in ((one, other[::-1]), (one[::-1], other)):
            yield self._axiom((a, b), folds, pieces)

    def _nested(
        self, one: Sequence[int], other: Sequence[int], folds: tuple[Edge, ...]
    ) -> Iterator[Clause]:
        """The pieces of two folded folds along each other, on one side, do not interleave."""
        for (a, b), (c, d) in product(permutations(one), permutations(other)):
            yield self._axiom(((c, a), (b, c), (d, b)), folds, ())
            yield self._axiom(((a, c), (d, a), (b, d)), folds, ())

    def _axiom(self, orders: Orders, folds: tuple[Edge, ...], pieces: tuple[int, ...]) -> Clause:
        clause = tuple(self.literal(*order) for order in orders)
        self.axioms.setdefault(clause, Axiom(folds, pieces, orders))
        return clause

    def _sides(self, fold: Edge) -> tuple[list[int], list[int]]:
        """The pieces of a fold on the left, and on the right, of the line of its image."""
        beside: tuple[list[int], list[int]] = [], []
        for piece, side in zip(self.folded.pieces_of(fold), (fold, fold[::-1]), strict=True):
            beside[self.plane.half(side)[1] < 0].append(piece)
        return beside
