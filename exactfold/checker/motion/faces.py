"""Pairs of faces of a sheet in motion, and the tests that they do not touch (docs/motion.md, 16).

Two faces without a common vertex do not touch if a plane parts them. Two faces with one common
vertex touch only there if a plane through this vertex parts them. Two faces at a fold touch only
there unless the fold is closed.

Proof of Theorem 7 there. (a), (b): all points of the faces are convex combinations of corners; in
(b) those with n . (p - v) = 0 are v alone. (c): the faces lie in two half-planes with the common
boundary line i j, which are equal iff the fold is closed. With the angle a between them,
|l - r|^2 = c + 2 p q (1 - cos a), where p, q > 0 are the distances of l and r from the line and c
is the value for a = 0, a rational number of the flat sheet; the determinant is p q |j - i| sin a up
to its sign. (d): the projection is linear, n lies in the plane, and counter-clockwise projections
lie on different sides of that of the fold. (e): the line p q passes all three sides on the same
side, so it meets the inside of the face, between p and q. (f): the determinant changes its sign, so
sin a = 0 at some time, and cos a > 0 as |l - r|^2 is below its mean of a = 0 and a = pi; so a = 0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import combinations

from ..core.reading import at_most, require
from ..sheets.sheet import Edge
from .bounds import Vector
from .boxes import (
    Boxes,
    Curved,
    Direction,
    best_apart,
    best_corner,
    boxes_on,
    open_by_distance,
    parted,
    parted_at,
    upright,
    volume_sign,
)

_NARROWEST = 1 << 16  # width of the narrowest interval of x, over 2^GRID
_KEPT = 1 << 10  # stretches whose boxes are kept for the next pairs of faces

Hinge = tuple[int, int, int]
"""The corners left and right of a fold, and the square of their distance where the fold is closed,
rounded up, over 2^(2 GRID)."""


class FacePairs:
    """All pairs of triangles of a sheet, sorted by what they share.

    `bodies[k]` is the same for faces that move as one body; pairs in one body are left out.
    `names[k]` is the name of face k in messages. `flat` and `place` are as in `boxes_on`. `work` is
    the largest number of tests.
    """

    def __init__(
        self,
        faces: Sequence[tuple[int, ...]],
        names: Sequence[tuple[int, ...]],
        bodies: Sequence[int],
        folds: Mapping[Edge, Hinge],
        flat: dict[int, Vector],
        place: dict[int, int],
        work: int,
    ) -> None:
        self.faces, self.names, self.folds = faces, names, folds
        self.flat, self.place = flat, place
        self.work, self.spent = work, 0
        self.apart: list[tuple[int, int]] = []
        self.corner: list[tuple[int, int]] = []
        for i, j in combinations(range(len(faces)), 2):
            shared = len(set(faces[i]) & set(faces[j]))
            if shared < 2 and bodies[i] != bodies[j]:
                (self.corner if shared else self.apart).append((i, j))
        self.known: dict[tuple[int, int], Direction] = {}

    def spend(self, tests: int) -> None:
        """Count tests; raises `LimitError` if there are too many."""
        self.spent += tests
        at_most(self.spent, self.work, "the tests of contacts", "MOST_TESTS")

    def clear(self, path: Curved, low: int, high: int, planar: bool = False) -> None:
        """Raise unless for low <= x <= high no two faces touch beyond what they share."""
        may = self.may_touch(path, low, high, _NARROWEST, planar)
        require(not may, f"{may} may touch where the motion is claimed to be clear")

    def may_touch(
        self, path: Curved, low: int, high: int, narrowest: int, planar: bool = False
    ) -> str:
        """The names of two faces that are not proved to stay apart for low <= x <= high, or "".

        If a test fails on an interval, the interval is halved, down to the width `narrowest`.
        """
        boxes: dict[tuple[int, int], Boxes] = {}

        def on(a: int, b: int) -> Boxes:
            if (a, b) not in boxes:
                self.spend(len(self.flat))
                if len(boxes) >= _KEPT:
                    boxes.clear()
                boxes[a, b] = boxes_on(path, self.flat, self.place, a, b, planar)
            return boxes[a, b]

        tests = (
            (self._apart, self.apart),
            (self._at_corner, self.corner),
            (self._open, self.folds),
        )
        for test, pairs in tests:
            for i, j in pairs:
                stack = [(low, high)] if low <= high else []
                while stack:
                    a, b = stack.pop()
                    self.spend(1)
                    if test(on(a, b), i, j, planar):
                        continue
                    if b - a <= narrowest:
                        names = (i, j) if test == self._open else (self.names[i], self.names[j])
                        what = "the faces at {}-{}" if test == self._open else "the faces {} and {}"
                        return what.format(*names)
                    middle = (a + b) >> 1
                    stack += [(middle, b), (a, middle)]
        return ""

    def not_parted(self, boxes: Boxes) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
        """The rows of `apart` and of `corner` whose faces no plane is found to part."""
        self.spend(len(self.apart) + len(self.corner))
        return (
            [(i, j) for i, j in self.apart if not self._apart(boxes, i, j, False)],
            [(i, j) for i, j in self.corner if not self._at_corner(boxes, i, j, False)],
        )

    def _apart(self, boxes: Boxes, i: int, j: int, planar: bool) -> bool:
        """Whether a plane parts two faces. The direction that parted them last is tried first."""
        one, two = self.faces[i], self.faces[j]
        known = self.known.get((i, j))
        if known and not (planar and known[2]) and parted(boxes, one, two, known):
            return True
        self.spend(3)
        best = self.known[i, j] = best_apart(boxes, one, two, planar)
        return parted(boxes, one, two, best)

    def _at_corner(self, boxes: Boxes, i: int, j: int, planar: bool) -> bool:
        """Whether a plane through the common vertex of two faces parts them."""
        [v] = set(self.faces[i]) & set(self.faces[j])
        one, two = ([w for w in self.faces[k] if w != v] for k in (i, j))
        known = self.known.get((i, j))
        if known and not (planar and known[2]) and parted_at(boxes, v, one, two, known):
            return True
        self.spend(3)
        best = self.known[i, j] = best_corner(boxes, v, one, two, planar)
        return parted_at(boxes, v, one, two, best)

    def _open(self, boxes: Boxes, i: int, j: int, planar: bool) -> bool:
        """Whether the fold between two vertices is proved not to be closed."""
        left, right, closed = self.folds[i, j]
        if open_by_distance(boxes, left, right, closed):
            return True
        if planar:
            return upright(boxes, i, j, left) and upright(boxes, j, i, right)
        return volume_sign(boxes, i, j, left, right) != 0

    def crossing(self, path: Curved, s: Fraction, one: Sequence[int], two: Sequence[int]) -> bool:
        """Whether at a parameter a side of one of two faces is proved to run through the other."""
        boxes = self.at(path, s, s)
        for first, second in ((one, two), (two, one)):
            a, b, c = second
            for p, q in combinations(first, 2):
                if {p, q} & set(second):
                    continue
                ends = [volume_sign(boxes, v, a, b, c) for v in (p, q)]
                around = [volume_sign(boxes, p, q, *side) for side in ((a, b), (b, c), (c, a))]
                if ends[0] * ends[1] == -1 and abs(sum(around)) == 3:
                    return True
        return False

    def at(self, path: Curved, first: Fraction, last: Fraction) -> Boxes:
        """The boxes of all vertices between two parameters."""
        return boxes_on(path, self.flat, self.place, path.below(first), path.above(last), False)
