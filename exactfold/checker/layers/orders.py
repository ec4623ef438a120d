"""Orders of the layers of a folded sheet, and the proof that all of them are flat-folded states.

**Definition** (J. Justin, Towards a mathematical theory of origami, 1997; E. Demaine and
J. O'Rourke, Geometric folding algorithms, 2007, chapter 11). A *flat-folded state* orders, at each
point of the plane that lies on the image of no edge, the pieces that cover the point: which lies
below which. The order of two pieces changes nowhere inside their overlap. On both sides of a point
of the image of a fold, which is the image of no vertex and of no edge in another direction, the
layers do not cross: what goes on there, a piece or the two pieces of a flat fold, has the same
order on both sides; what turns back, the two pieces of a folded fold, has nothing that goes on
between them; and of two folded folds that turn back on the same side, one has both pieces or no
piece of the other between its own. If a fold has the letter V, the piece that is turned over lies
above the other one; if it has M, below (`FoldedSheet.lettered`).

Overlaps of convex pieces are connected, so that a state has one order for each pair of pieces that
overlap. These are a state if and only if

1. no three pieces with a common inner point lie in a circle (an order of all pairs of a finite set
   is an order of the set if it has no circle of three);
2. no piece lies between the two pieces of a fold that runs through its inside;
3. of two folds along each other, both folded, with their pieces on the same side, one has not
   exactly one piece of the other between its own; both flat, their pieces have the same order on
   both sides; one folded, the other flat: the piece of the flat one that is on the side of the
   folded one is not between the pieces of that one;
4. the letters are respected.

For what goes on at a point of a fold is a piece with this point inside, as in 2, or a flat fold
along it, as in 3. In 2, a piece has the same order with both pieces of the fold, whether it is
folded or flat: in both cases the piece is not between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations, product

from ..core.limits import FLAT_TESTS
from ..core.reading import at_most, require
from ..sheets.panels import Edge
from .overlaps import Overlaps, members

Order = tuple[int, int]
"""Two pieces that overlap, the lower one first."""


class Orders:
    """An order of each pair of pieces that overlap, for one state or for many at once.

    Some pairs have a fixed order. The others are in groups, and each group has several choices of
    the orders of its pairs. All choices, of one for each group, are meant.
    """

    def __init__(self, pieces: int) -> None:
        self.above = [0] * pieces
        """For each piece the set of those that may lie above it."""
        self.below = [0] * pieces
        self._choices: dict[Order, tuple[int, int]] = {}
        self._groups = 0

    def fix(self, order: Order) -> None:
        """Give a pair its only order."""
        self._add(order, 0, 1, 0)

    def choose(self, pairs: Sequence[Order], choices: Sequence[str]) -> None:
        """Give a group of pairs its choices: a text with one bit a pair, 1 for the order given."""
        self._groups += 1
        for order, column in zip(pairs, zip(*choices, strict=True), strict=True):
            text = "".join(column)
            chosen = int(text, 2)
            self._add(order, self._groups, chosen, (1 << len(text)) - 1 - chosen)

    def may_be(self, *orders: Order) -> bool:
        """Whether some choice has all these orders."""
        left: dict[int, int] = {}
        for order in orders:
            group, chosen = self._choices[order]
            left[group] = left.get(group, -1) & chosen
        return all(left.values())

    def _add(self, order: Order, group: int, chosen: int, others: int) -> None:
        low, high = order
        for one, other, some in ((low, high, chosen), (high, low, others)):
            self._choices[one, other] = group, some
            if some:
                self.above[one] |= 1 << other
                self.below[other] |= 1 << one


class Crossings:
    """Looks for crossings of layers, among all choices of orders."""

    def __init__(self, overlaps: Overlaps, orders: Orders) -> None:
        self.overlaps, self.orders = overlaps, orders
        self.folded = overlaps.folded
        self._sides = [self._pieces_beside(fold) for fold in overlaps.folds]
        self._tests = 0

    def _pieces_beside(self, fold: Edge) -> tuple[list[int], list[int]]:
        """The pieces of a fold on the left, and on the right, of the line of its image."""
        beside: tuple[list[int], list[int]] = [], []
        for piece, side in zip(self.folded.pieces_of(fold), (fold, fold[::-1]), strict=True):
            beside[self.overlaps.plane.half(side)[1] < 0].append(piece)
        return beside

    def check(self) -> None:
        """Raise unless every choice of the orders is a flat-folded state."""
        for fold, (low, high) in self.folded.lettered.items():
            wrong = self.orders.may_be((high, low))
            require(
                not wrong, f"{_name(fold)} does not have its letter {self.folded.letters[fold]}"
            )
        self._check_circles()
        self._check_folds()
        for first, second in self.overlaps.along:
            self._check_along(first, second)

    def _count(self, tests: int) -> None:
        self._tests += tests
        at_most(self._tests, FLAT_TESTS, "the tests of orders of layers", "FLAT_TESTS")

    def _check_circles(self) -> None:
        """No circle a < b < c < a, of which a has the smallest number."""
        above, below = self.orders.above, self.orders.below
        for a, over in enumerate(above):
            for b in members(over >> a << a):
                found = list(members((above[b] & below[a]) >> a << a))
                self._count(len(found))
                for c in found:
                    circle = self.orders.may_be((a, b), (b, c), (c, a))
                    crossing = circle and self.overlaps.have_common_point((a, b, c))
                    require(not crossing, f"pieces {a}, {b} and {c} lie in a circle")

    def _check_folds(self) -> None:
        """No piece lies between the two pieces of a fold that runs through its inside."""
        for fold, through in zip(self.overlaps.folds, self.overlaps.through, strict=True):
            one, other = self.folded.pieces_of(fold)
            for piece in members(through & self._between(one, other)):
                self._check_between(fold, piece)

    def _between(self, one: int, other: int) -> int:
        """The pieces that may lie between two pieces, if only one pair is considered at a time."""
        above, below = self.orders.above, self.orders.below
        return (above[one] & below[other]) | (above[other] & below[one])

    def _check_between(self, fold: Edge, piece: int) -> None:
        self._count(1)
        one, other = self.folded.pieces_of(fold)
        for low, high in ((one, other), (other, one)):
            crossing = self.orders.may_be((low, piece), (piece, high))
            require(not crossing, f"piece {piece} crosses {_name(fold)}")

    def _check_along(self, first: int, second: int) -> None:
        """Two folds along each other do not cross."""
        self._count(1)
        one, other = self._sides[first], self._sides[second]
        for side in (0, 1):
            if len(one[side]) == len(other[side]) == 2:
                self._check_nested(first, second, one[side], other[side])
            elif len(one[side]) == 2 and len(other[side]) == 1:
                self._check_between(self.overlaps.folds[first], other[side][0])
            elif len(one[side]) == 1 and len(other[side]) == 2:
                self._check_between(self.overlaps.folds[second], one[side][0])
        if len(one[0]) == len(other[0]) == 1:
            (a, b), (c, d) = (one[0][0], one[1][0]), (other[0][0], other[1][0])
            crossing = self.orders.may_be((a, c), (d, b)) or self.orders.may_be((c, a), (b, d))
            self._refuse_crossing(crossing, first, second)

    def _check_nested(
        self, first: int, second: int, one: Sequence[int], other: Sequence[int]
    ) -> None:
        """Of two folded folds on one side, one has both or no piece of the other inside."""
        if not self._may_cross(one, other):
            return
        for (a, b), (c, d) in product(permutations(one), permutations(other)):
            crossing = self.orders.may_be((a, c), (c, b), (b, d))
            self._refuse_crossing(crossing, first, second)
            crossing = self.orders.may_be((c, a), (a, d), (d, b))
            self._refuse_crossing(crossing, first, second)

    def _may_cross(self, one: Sequence[int], other: Sequence[int]) -> bool:
        """Whether a piece of the other fold may lie between two pieces, and the other one not."""
        above, below = self.orders.above, self.orders.below
        a, b = one
        inside = self._between(a, b)
        outside = (above[a] & above[b]) | (below[a] & below[b])
        c, d = other
        return bool((inside >> c & outside >> d | inside >> d & outside >> c) & 1)

    def _refuse_crossing(self, crossing: bool, first: int, second: int) -> None:
        one, other = (_name(self.overlaps.folds[k]) for k in (first, second))
        require(not crossing, f"{one} and {other} cross")


def _name(fold: Edge) -> str:
    return f"fold {fold[0]}-{fold[1]}"
