"""What an order of layers has to satisfy: letters, creases against layers, and transitivity."""

from __future__ import annotations

from collections.abc import Sequence
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


_UP: Final = {"V": 1, "M": -1}
"""1 if the piece on the other side of a crease is folded on top of one that faces up."""


class Constraints:
    """The variables of a folded sheet, and all constraints but transitivity.

    There is a variable for each overlapping pair of pieces (i, j), i < j, numbered from 1: it is
    true if j lies above i. A literal is the number of a variable, or its negative. `given` has the
    literal that the letter of each crease gives. Each row of `equal` has two literals that are
    equal. Each row of `tacos` has the literals (AC, BC, AD, BD), "C lies above A" and so on, of two
    creases with the pieces A, B and C, D, which do not interleave. `equality` and `taco` say what a
    row means.
    """

    def __init__(self, overlaps: Overlaps) -> None:
        self.overlaps = overlaps
        self._keys: Indices = overlaps.pairs[:, 0] * overlaps.count + overlaps.pairs[:, 1]
        self.given: dict[Edge, int] = self._letters()
        inner = overlaps.inner
        self._left = np.array([one.left for one in inner], dtype=np.int64)
        self._right = np.array([one.right for one in inner], dtype=np.int64)
        folded = np.array([one.folded for one in inner], dtype=bool)
        side = np.array([one.sides[0] for one in inner], dtype=np.int64)
        self._through = overlaps.crossings()
        edge, piece = self._through.T
        made = [self._both(self._left[edge], piece, self._right[edge], piece)]
        one, other = overlaps.collinear().T
        both = folded[one] & folded[other] & (side[one] == side[other])
        self._tacos = np.stack([one[both], other[both]], axis=1)
        mixed = folded[one] != folded[other]
        taco = np.where(folded[one], one, other)[mixed]
        flat = np.where(folded[one], other, one)[mixed]
        beside = np.where(side[taco] == side[flat], self._left[flat], self._right[flat])
        self._beside = np.stack([taco, flat, beside], axis=1)
        made.append(self._both(self._left[taco], beside, self._right[taco], beside))
        flats = ~folded[one] & ~folded[other]
        one, other = one[flats], other[flats]
        same = side[one] == side[other]
        first = np.where(same, self._left[other], self._right[other])
        second = np.where(same, self._right[other], self._left[other])
        self._flats = np.stack([one, other, first, second], axis=1)
        made.append(self._both(self._left[one], first, self._right[one], second))
        self.equal: Indices = np.concatenate(made)
        (a, b), (c, d) = (
            (self._left[self._tacos[:, k]], self._right[self._tacos[:, k]]) for k in (0, 1)
        )
        pairs = ((a, c), (b, c), (a, d), (b, d))
        self.tacos: Indices = np.stack([self.literals(x, y) for x, y in pairs], axis=1)

    @property
    def variables(self) -> int:
        """The number of overlapping pairs."""
        return len(self._keys)

    def literals(self, lower: Indices, upper: Indices) -> Indices:
        """The literals that say that pieces lie above others; `KeyError` if some do not overlap."""
        first, second = np.minimum(lower, upper), np.maximum(lower, upper)
        keys = first * self.overlaps.count + second
        place = np.searchsorted(self._keys, keys)
        if len(keys) and not np.array_equal(self._keys.take(place, mode="clip"), keys):
            raise KeyError("two pieces do not overlap")
        return np.where(lower < upper, place + 1, -place - 1)

    def triples(self, triples: Indices) -> Indices:
        """The literals (AB, BC, CA) of triples of pieces: not all of them hold, and not none."""
        a, b, c = triples.T
        return np.stack([self.literals(x, y) for x, y in ((a, b), (b, c), (c, a))], axis=1)

    def letter(self, edge: Edge) -> Constraint:
        """The constraint that the letter of a crease gives."""
        return Constraint("letter", (edge,), self.overlaps.images.pieces.creases[edge])

    def equality(self, row: int) -> Constraint:
        """What a row of `equal` means."""
        if row < len(self._through):
            edge, piece = self._through[row].tolist()
            kind = self._inner[edge].folded
            pieces = (self._inner[edge].left, self._inner[edge].right, piece)
            return Constraint(_of_edge(kind), (self._inner[edge].edge,), pieces)
        row -= len(self._through)
        if row < len(self._beside):
            taco, flat, piece = self._beside[row].tolist()
            edges = (self._inner[taco].edge, self._inner[flat].edge)
            pieces = (self._inner[taco].left, self._inner[taco].right, piece)
            return Constraint("taco-tortilla", edges, pieces)
        one, other, first, second = self._flats[row - len(self._beside)].tolist()
        edges = (self._inner[one].edge, self._inner[other].edge)
        four = (self._inner[one].left, self._inner[one].right, first, second)
        return Constraint("tortilla-tortilla", edges, four)

    def taco(self, row: int) -> Constraint:
        """What a row of `tacos` means."""
        one, other = (self._inner[k] for k in self._tacos[row].tolist())
        pieces = (one.left, one.right, other.left, other.right)
        return Constraint("taco-taco", (one.edge, other.edge), pieces)

    @cached_property
    def _inner(self) -> Sequence[Inner]:
        return self.overlaps.inner

    def _letters(self) -> dict[Edge, int]:
        images = self.overlaps.images
        pieces = images.pieces
        lettered = [edge for edge in pieces.creases if pieces.letters[edge] in _UP]
        sides = np.array([pieces.creases[edge] for edge in lettered], dtype=np.int64).reshape(-1, 2)
        literals = self.literals(sides[:, 0], sides[:, 1]).tolist()
        return {
            edge: _UP[pieces.letters[edge]] * (-x if images.maps[left].flipped else x)
            for edge, x, left in zip(lettered, literals, sides[:, 0].tolist(), strict=True)
        }

    def _both(self, a: Indices, b: Indices, c: Indices, d: Indices) -> Indices:
        return np.stack([self.literals(a, b), self.literals(c, d)], axis=1)


def _of_edge(folded: bool) -> Kind:
    return "taco-tortilla" if folded else "tortilla-tortilla"


def taco_clauses(tacos: Indices) -> Indices:
    """That two creases in one place with the pieces A, B and C, D do not cross, as clauses.

    Each row has the literals AC, BC, AD, BD: C lies above A, and so on. Each of the eight orders
    that interleave, such as A < C < B < D, is excluded by the three relations between neighbours;
    with transitivity these are all. The eight clauses of a row follow each other.

    >>> taco_clauses(np.array([[1, 2, 3, 4]])).tolist()[0]
    [-1, 2, -4]
    """
    ac, bc, ad, bd = tacos.T
    up = [(-ac, bc, -bd), (-ad, bd, -bc), (-bc, ac, -ad), (-bd, ad, -ac)]
    rows = [np.stack(three, axis=1) for three in up]
    return np.stack([*rows, *(-three for three in rows)], axis=1).reshape(-1, 3)
