"""Which pieces of a folded sheet overlap, and which folds run through pieces or along others.

Pieces are convex, and their images are convex polygons. Two of them overlap if they have an inner
point in common. If they do not, all of one lies on the outer side of the line of some side of the
other (separating axes: each side of the difference of two polygons is parallel to a side of one).
In the same way the image of a fold, without its ends, has a point inside a piece unless it lies on
the outer side of some side of the piece, or the piece lies on one side of the line of the fold.

Sets of pieces and folds are integers: with n pieces, bit k is piece k, and bit n + k is fold k.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cmp_to_key, reduce
from itertools import product
from operator import and_

from ..core.limits import FLAT_PAIRS, FLAT_SIDES
from ..core.reading import at_most
from .folding import FoldedSheet, sides
from .plane import Plane, compare


class Overlaps:
    """What overlaps in a folded sheet.

    `over[k]` is the set of the pieces that overlap piece k, and `through[k]` that of the pieces
    through whose inside fold k runs. `pairs` are all pairs of pieces that overlap, sorted, and
    `along` all pairs of folds whose images have more than a point in common.
    """

    def __init__(self, folded: FoldedSheet) -> None:
        self.folded, self.plane = folded, Plane(folded)
        self.pieces, self.folds = folded.pieces, folded.folds
        self._halves = [
            list(dict.fromkeys(self.plane.half(side) for side in sides(piece)))
            for piece in self.pieces
        ]
        lines = max(line for halves in self._halves for line, _ in halves) + 1
        work = len(self.plane.spots) * lines
        at_most(work, FLAT_SIDES, "the sides of points beside lines", "FLAT_SIDES")
        apart = self._apart(lines)
        inside = [
            reduce(and_, (apart[line][inner < 0] for line, inner in halves))
            for halves in self._halves
        ]
        everything = (1 << len(self.pieces)) - 1
        self.over = [
            sum(1 << m for m in members(near & everything) if m != k and inside[m] >> k & 1)
            for k, near in enumerate(inside)
        ]
        pairs = sum(map(int.bit_count, self.over)) // 2
        at_most(pairs, FLAT_PAIRS, "the pairs of pieces that overlap", "FLAT_PAIRS")
        self.through = []
        for k, fold in enumerate(self.folds, len(self.pieces)):
            left, right = apart[self.plane.line(fold)]
            across = members(left & right & everything)
            self.through.append(sum(1 << piece for piece in across if inside[piece] >> k & 1))
        self.pairs = [
            (k, other) for k, near in enumerate(self.over) for other in members(near >> k << k)
        ]
        self.along = list(self._along())

    def have_common_point(self, pieces: tuple[int, int, int]) -> bool:
        """Whether three pieces that overlap pairwise have a common inner point.

        By Helly's theorem they have none only if three open half planes of their sides have none.
        Two pieces overlap, so that these are half planes of one piece each.
        """
        return not any(
            self.plane.misses((a, b, c), (inner, other, third))
            for (a, inner), (b, other), (c, third) in product(*(self._halves[k] for k in pieces))
        )

    def _apart(self, lines: int) -> list[tuple[int, int]]:
        """For each line the pieces and folds with a corner or an end on its left, and right."""
        ends = [0] * len(self.plane.spots)
        for k, corners in enumerate((*self.pieces, *self.folds)):
            for v in corners:
                ends[self.plane.spot_of[v]] |= 1 << k
        apart = []
        for line in range(lines):
            left = right = 0
            for side, these in zip(self.plane.sides(line), ends, strict=True):
                if side > 0:
                    left |= these
                elif side < 0:
                    right |= these
            apart.append((left, right))
        return apart

    def _along(self) -> Iterator[tuple[int, int]]:
        key = cmp_to_key(compare)
        lines = defaultdict(list)
        for k, fold in enumerate(self.folds):
            lines[self.plane.line(fold)].append(k)
        count = 0
        for folds in lines.values():
            ends = {self.plane.spot_of[v] for k in folds for v in self.folds[k]}
            order = sorted(ends, key=lambda k: key(self.plane.spots[k]))
            rank = {spot: place for place, spot in enumerate(order)}
            active: list[tuple[int, int]] = []
            reach = (sorted(rank[self.plane.spot_of[v]] for v in self.folds[k]) for k in folds)
            for (first, last), k in sorted(zip(reach, folds, strict=True)):
                active = [(end, other) for end, other in active if end > first]
                count += len(active)
                at_most(count, FLAT_PAIRS, "the pairs of folds along each other", "FLAT_PAIRS")
                yield from ((other, k) for _, other in active)
                active.append((last, k))


def members(some: int) -> Iterator[int]:
    """The numbers of the bits of a set, in increasing order."""
    while some:
        lowest = some & -some
        yield lowest.bit_length() - 1
        some ^= lowest
