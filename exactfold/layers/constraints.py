"""What an order of layers has to satisfy: letters, creases against layers, and transitivity."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Literal, TypeAlias

import numpy as np

from exactfold.layers.overlaps import Inner, Overlaps
from exactfold.layers.sides import Indices
from exactfold.pattern.panel_pattern import Edge

Kind: TypeAlias = Literal[
    "letter", "taco-tortilla", "tortilla-tortilla", "taco-taco", "transitivity"
]
Clause: TypeAlias = tuple[int, ...]


@dataclass(frozen=True)
class Constraint:
    """One constraint on an order of layers (docs/flat.md, The conditions).

    `edges` are the creases or joints that meet, and `pieces` the pieces that take part: the two of
    a crease for "letter"; those of the edge and the one that it crosses for "taco-tortilla" and
    "tortilla-tortilla" of one edge; those of both edges for two; the three for "transitivity".
    """

    kind: Kind
    edges: tuple[Edge, ...]
    pieces: tuple[int, ...]


class Constraints:
    """The variables of a folded sheet, and all constraints but transitivity.

    There is a variable for each overlapping pair of pieces (i, j), i < j, numbered from 1: it is
    true if j lies above i. `equal` has the pairs of literals that are equal, `same` the constraint
    of each. `tacos` has the literals (AC, BC, AD, BD) of two creases with pieces A, B and C, D,
    `tacos_of` the constraint of each; the number of true ones is even, and AB and CD do not
    interleave. `given` has the literal that the letter of each crease gives.
    """

    def __init__(self, overlaps: Overlaps) -> None:
        self.overlaps = overlaps
        count = overlaps.count
        self._keys: Indices = overlaps.pairs[:, 0] * count + overlaps.pairs[:, 1]
        self.given: dict[Edge, int] = {}
        self._letters()
        self.equal: list[tuple[int, int]] = []
        self.same: list[Constraint] = []
        self.tacos: list[tuple[int, int, int, int]] = []
        self.tacos_of: list[Constraint] = []
        self._crossings()
        self._collinear()

    @property
    def variables(self) -> int:
        """The number of overlapping pairs."""
        return len(self._keys)

    def literal(self, lower: int, upper: int) -> int:
        """The literal that says that a piece lies above another one."""
        if lower < upper:
            return self._place[lower, upper] + 1
        return -self._place[upper, lower] - 1

    @cached_property
    def _place(self) -> dict[tuple[int, int], int]:
        return {(i, j): k for k, (i, j) in enumerate(self.overlaps.pairs.tolist())}

    @property
    def letters(self) -> list[Constraint]:
        """The constraints that the letters give."""
        creases = self.overlaps.images.pieces.creases
        return [Constraint("letter", (edge,), creases[edge]) for edge in self.given]

    def literals(self, lower: Indices, upper: Indices) -> Indices:
        """The literals for arrays of pieces; raises `KeyError` for pieces that do not overlap."""
        first, second = np.minimum(lower, upper), np.maximum(lower, upper)
        keys = first * self.overlaps.count + second
        place = np.searchsorted(self._keys, keys)
        if len(keys) and not np.array_equal(
            self._keys[np.minimum(place, len(self._keys) - 1)], keys
        ):
            raise KeyError("two pieces do not overlap")
        return np.where(lower < upper, place + 1, -place - 1)

    def _letters(self) -> None:
        pieces = self.overlaps.images.pieces
        for edge, (left, right) in pieces.creases.items():
            letter = pieces.letters[edge]
            if letter not in _UP:
                continue
            above = _UP[letter] * (-1 if self.overlaps.images.maps[left].flipped else 1)
            self.given[edge] = above * self.literal(left, right)

    def _crossings(self) -> None:
        found = list(self.overlaps.crossings())
        left, right, through = (
            np.array(some, dtype=np.int64)
            for some in (
                [edge.left for edge, _ in found],
                [edge.right for edge, _ in found],
                [piece for _, piece in found],
            )
        )
        self.equal += zip(
            self.literals(left, through).tolist(),
            self.literals(right, through).tolist(),
            strict=True,
        )
        self.same += [
            Constraint(
                "taco-tortilla" if edge.folded else "tortilla-tortilla",
                (edge.edge,),
                (edge.left, edge.right, piece),
            )
            for edge, piece in found
        ]

    def _collinear(self) -> None:
        for one, other in self.overlaps.collinear():
            if one.folded and other.folded:
                if one.sides[0] == other.sides[0]:
                    a, b, c, d = one.left, one.right, other.left, other.right
                    self.tacos.append(
                        (
                            self.literal(a, c),
                            self.literal(b, c),
                            self.literal(a, d),
                            self.literal(b, d),
                        )
                    )
                    self.tacos_of.append(
                        Constraint("taco-taco", (one.edge, other.edge), (a, b, c, d))
                    )
            elif one.folded or other.folded:
                taco, flat = (one, other) if one.folded else (other, one)
                c = flat.left if flat.sides[0] == taco.sides[0] else flat.right
                self.equal.append((self.literal(taco.left, c), self.literal(taco.right, c)))
                edges = (taco.edge, flat.edge)
                self.same.append(Constraint("taco-tortilla", edges, (taco.left, taco.right, c)))
            else:
                a, b = one.left, one.right
                c, d = _matched(one, other)
                self.equal.append((self.literal(a, c), self.literal(b, d)))
                self.same.append(
                    Constraint("tortilla-tortilla", (one.edge, other.edge), (a, b, c, d))
                )

    def clauses(self, constraint: Constraint) -> list[Clause]:
        """A constraint as clauses in literals."""
        if constraint.kind == "letter":
            return [(self.given[constraint.edges[0]],)]
        if constraint.kind == "transitivity":
            a, b, c = constraint.pieces
            x, y, z = self.literal(a, b), self.literal(b, c), self.literal(c, a)
            return [(x, y, z), (-x, -y, -z)]
        if constraint.kind == "taco-taco":
            a, b, c, d = constraint.pieces
            return taco_clauses(
                (self.literal(a, c), self.literal(b, c), self.literal(a, d), self.literal(b, d))
            )
        if len(constraint.pieces) == 3:
            a, b, c = constraint.pieces
            x, y = self.literal(a, c), self.literal(b, c)
        else:
            a, b, c, d = constraint.pieces
            x, y = self.literal(a, c), self.literal(b, d)
        return [(x, -y), (-x, y)]


_UP: Final = {"V": 1, "M": -1}
"""1 if the piece on the other side of a crease is folded on top of one that faces up."""


def taco_clauses(literals: tuple[int, int, int, int]) -> list[Clause]:
    """That two creases in one place with the pieces A, B and C, D do not cross: AB, CD do not
    interleave. The literals say that C lies above A and above B, D above A and above B.

    Each of the eight orders that interleave, such as A < C < B < D, is excluded by the three
    relations between neighbours; with transitivity, these are all.

    >>> len(taco_clauses((1, 2, 3, 4)))
    8
    """
    ac, bc, ad, bd = literals
    up = [(-ac, bc, -bd), (-ad, bd, -bc), (-bc, ac, -ad), (-bd, ad, -ac)]
    return [*up, *((-x, -y, -z) for x, y, z in up)]


def _matched(one: Inner, other: Inner) -> tuple[int, int]:
    """The pieces of the other edge on the side of the left and of the right piece of one edge."""
    if one.sides[0] == other.sides[0]:
        return other.left, other.right
    return other.right, other.left


def transitivity(pieces: Iterable[int]) -> Constraint:
    """The constraint that three pieces with a common interior point lie in an order."""
    return Constraint("transitivity", (), tuple(sorted(pieces)))
