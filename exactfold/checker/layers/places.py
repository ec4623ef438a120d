"""Clauses that hold in every flat-folded state, because of the layers at one place.

A place is a point of the plane, or a point of the line through the images of two corners. A clause
is a set of orders (a, b), "piece a lies below piece b", at least one of which holds; (b, a) is the
opposite of (a, b). The checker looks at the pieces that the clause names, and at those that are
joined to them at the place. It tries all orders of these layers, on each side of the line, and
leaves out those that cross there (`orders`, the definition). If each of the others fulfils the
clause, so does every state.

A piece has the place inside, or inside one of its sides, along the line. Then this is so at all
points of the line nearby, and some of them lie on the images of no vertex and of no edge in another
direction, as the definition demands. The same holds for a point of the plane.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import permutations, product
from typing import Any, NamedTuple

from ..core.limits import FLAT_LAYERS
from ..core.reading import (
    Coordinates,
    at_most,
    items,
    natural,
    require,
)
from ..sheets.panels import Edge
from .folding import sides
from .orders import Order
from .plane import Plane, Spot

Clause = tuple[Order, ...]


class Strand(NamedTuple):
    """What passes a place: its layers on the left and on the right of the line of the fold.

    A piece with the place inside is the same layer on both sides. A flat fold has a layer on each
    side, a folded fold two on one side, and the boundary of the sheet one.
    """

    left: tuple[int, ...]
    right: tuple[int, ...]


class Places:
    """The places that a file names, and how pieces pass them."""

    def __init__(self, plane: Plane, value: Any) -> None:
        self.plane, self.folded = plane, plane.folded
        self._numbers = Coordinates()
        self._places = [self._read(k, entry) for k, entry in enumerate(items(value, "places"))]
        self._known: dict[tuple[int, int], Strand] = {}
        self._answers: dict[tuple[tuple[Strand, ...], Clause], bool] = {}

    def read_clause(self, value: Any) -> Clause:
        """Read [place, clause]; raises unless the clause is true at the place."""
        number, orders = items(value, "a clause with its place", 2)
        place = natural(number, "the number of a place")
        require(place < len(self._places), f"there is no place {place}")
        clause = read_orders(orders, len(self.folded.pieces))
        strands = {self._strand(place, piece) for order in clause for piece in order}
        question = _renamed(sorted(strands), clause)
        if question not in self._answers:
            self._answers[question] = holds(*question)
        require(self._answers[question], f"{told(clause)} does not hold at place {place}")
        return clause

    def _read(self, number: int, value: Any) -> tuple[Spot, int | None]:
        """A place: [x, y], or [i, j, t], the share t of the way from corner i to corner j."""
        entry, tower, read = items(value, "a place"), self.folded.tower, self._numbers
        if len(entry) == 2:
            x, y = (tower.number(read(c)) for c in entry)
            return self.plane.spot((x, y)), None
        i, j = (natural(v, "a vertex") for v in items(entry[:2], "a fold", 2))
        share = read(items(entry[2:], f"place {number}", 1)[0])
        (px, py), (qx, qy), part = (*(self.folded.points[v] for v in (i, j)), tower.number(share))
        spot = self.plane.spot((px + part * (qx - px), py + part * (qy - py)))
        return spot, self.plane.line((i, j))

    def _strand(self, place: int, piece: int) -> Strand:
        if (place, piece) not in self._known:
            self._known[place, piece] = self._passing(place, piece)
        return self._known[place, piece]

    def _passing(self, place: int, piece: int) -> Strand:
        """How a piece passes a place; raises if it does not."""
        spot, line = self._places[place]
        on, along = False, list[Edge]()
        for side in sides(self.folded.pieces[piece]):
            own, inner = self.plane.half(side)
            beside = self.plane.side(own, spot) * inner
            inside = beside > 0 or (beside == 0 and own == line)
            require(inside, f"piece {piece} does not lie at place {place}")
            if beside == 0:
                on = True
                along += [side] if self.plane.is_inside(spot, side) else []
        if not on:
            return Strand((piece,), (piece,))
        require(along, f"place {place} is the end of a side of piece {piece}")
        layers: tuple[list[int], list[int]] = [], []
        for i, j in (along[0], along[0][::-1]):
            if (i, j) in self.folded.beside:
                number = self.folded.beside[i, j]
                layers[self.plane.half((i, j))[1] < 0].append(number)
        return Strand(tuple(sorted(layers[0])), tuple(sorted(layers[1])))


def read_orders(value: Any, count: int) -> Clause:
    """Read a list of orders [a, b], of two pieces each."""
    orders = []
    for entry in items(value, "orders"):
        a, b = (natural(piece, "a piece") for piece in items(entry, "an order", 2))
        require(a < count and b < count and a != b, f"[{a}, {b}] is not an order of two pieces")
        orders.append((a, b))
    return tuple(orders)


def holds(strands: Sequence[Strand], clause: Clause) -> bool:
    """Whether all orders of the layers of some strands that do not cross fulfil a clause."""
    most = max(sum(len(strand[side]) for strand in strands) for side in (0, 1))
    at_most(most, FLAT_LAYERS, "the layers at the place of a clause", "FLAT_LAYERS")
    return all(
        any(_is_below(a, b, left) or _is_below(a, b, right) for a, b in clause)
        for left, right in uncrossed(strands)
    )


def _renamed(strands: Sequence[Strand], clause: Clause) -> tuple[tuple[Strand, ...], Clause]:
    """The same question about pieces with numbers from 0: few questions are asked very often."""
    name: dict[int, int] = {}
    for strand in strands:
        for k in (*strand.left, *strand.right):
            name.setdefault(k, len(name))
    renamed = (Strand(*(tuple(name[k] for k in side) for side in strand)) for strand in strands)
    return tuple(renamed), tuple((name[a], name[b]) for a, b in clause)


def _is_below(a: int, b: int, layers: tuple[int, ...]) -> bool:
    return a in layers and b in layers and layers.index(a) < layers.index(b)


def uncrossed(strands: Sequence[Strand]) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """All orders of the layers on the left and on the right, from below, that do not cross.

    What goes on has the same order on both sides. A fold that turns back has no piece between its
    two that goes on, and both or none of another such fold.
    """
    goes_on = {k: s for s in strands if s.left and s.right for k in (*s.left, *s.right)}
    folds = [layers for s in strands for layers in s if len(layers) == 2]
    layers = ([k for s in strands for k in s.left], [k for s in strands for k in s.right])
    for both in product(*map(permutations, layers)):
        left, right = ([goes_on[k] for k in side if k in goes_on] for side in both)
        if left != right:
            continue
        between = [
            {*side[side.index(a) + 1 : side.index(b)], *side[side.index(b) + 1 : side.index(a)]}
            for a, b in folds
            for side in both
            if a in side
        ]
        if any(some & goes_on.keys() for some in between):
            continue
        if not any(len(some & {a, b}) == 1 for some in between for a, b in folds):
            yield both[0], both[1]


def told(clause: Clause) -> str:
    """A clause in words."""
    return " or ".join(f"{a} below {b}" for a, b in clause) or "the empty clause"
