"""Letters of single vertices, decided for every sheet in a box."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final

from exactfold.panels.nearby.box import Box
from exactfold.panels.vertex.stars import edge_of
from exactfold.pattern.panel_pattern import Edge

_LETTERS: Final = "MV"


class NearbyFan:
    """The folds of one vertex in every sheet of a box (docs/vertices.md, Theorem 2).

    Folds are named by their positions, counter-clockwise. `turns[j][k]` is the sign of the bracket
    of folds j and k in all sheets of the box, and 0 if it is not the same in all.
    """

    def __init__(self, box: Box, vertex: int) -> None:
        ends = box.sheet.stars[vertex]
        self.folds = tuple(edge_of(vertex, end) for end in ends)
        self.turns = [[box.turn(vertex, a, b) for b in ends] for a in ends]
        self._straight = [
            [a != b and box.may_be_straight(vertex, a, b) for b in ends] for a in ends
        ]

    def may_fold(self, letters: Sequence[str]) -> bool:
        """Whether some sheet of the box may fold here with these letters M, V, F and U.

        False is a proof that none does. At least one fold has to move.
        """
        moving, free = _parted(letters)
        if self._may_form_a_crease(letters, moving, free):
            return True
        return self._has_foot(letters, moving, free, least=0)

    def must_fold(self, letters: Sequence[str]) -> bool:
        """Whether every sheet of the box is proved to fold here with these letters."""
        moving, free = _parted(letters)
        if not moving and len(free) >= 4 and self._spans(free, 1):
            return True
        return self._has_foot(letters, moving, free, least=1)

    def _has_foot(
        self, letters: Sequence[str], moving: set[int], free: set[int], least: int
    ) -> bool:
        """Whether folds with one letter lie in no closed half-plane, and some fold has the other.

        With `least` 0, neighbours among them may be less than pi apart in some sheet of the box;
        with 1 they are in all sheets.
        """
        for letter in _LETTERS:
            base = {k for k in moving if letters[k] == letter}
            if moving - base:
                if self._spans(base | free, least):
                    return True
            elif any(self._spans((base | free) - {toe}, least) for toe in free):
                return True
        return False

    def _spans(self, chosen: Collection[int], least: int) -> bool:
        around = sorted(chosen)
        following = zip(around, around[1:] + around[:1], strict=True)
        return len(around) >= 3 and all(self.turns[i][j] >= least for i, j in following)

    def _may_form_a_crease(self, letters: Sequence[str], moving: set[int], free: set[int]) -> bool:
        if len({letters[k] for k in moving}) > 1:
            return False
        some = moving | free
        return any(self._straight[j][k] and moving <= {j, k} for j in some for k in some if j < k)


def _parted(letters: Sequence[str]) -> tuple[set[int], set[int]]:
    moving = {k for k, letter in enumerate(letters) if letter in _LETTERS}
    return moving, {k for k, letter in enumerate(letters) if letter == "U"}


def still_folds(fans: Collection[NearbyFan], flat: Collection[Edge] = ()) -> frozenset[Edge]:
    """Folds that stay flat in every motion of every sheet in the box, and those in `flat`.

    A fold that cannot move at one of its ends is flat, which may hold others flat at its other end.
    """
    still = set(flat)
    before = -1
    while len(still) > before:
        before = len(still)
        for fan in fans:
            for k, fold in enumerate(fan.folds):
                letters = ["F" if other in still else "U" for other in fan.folds]
                if fold not in still and not fan.may_fold([*letters[:k], "M", *letters[k + 1 :]]):
                    still.add(fold)
    return frozenset(still)


def refuted_vertices(
    fans: Mapping[int, NearbyFan], letters: Mapping[Edge, str], still: Collection[Edge]
) -> list[int]:
    """The vertices that cannot have their letters in any sheet of the box.

    Folds in `still` are flat, whatever their letters are; one with the letter M or V refutes it.
    """
    refuted = []
    for v, fan in fans.items():
        given = [letters.get(fold, "U") for fold in fan.folds]
        held = ["F" if fold in still else x for fold, x in zip(fan.folds, given, strict=True)]
        lost = any(x in _LETTERS and y == "F" for x, y in zip(given, held, strict=True))
        moves = any(x in _LETTERS for x in given)
        if lost or (moves and not fan.may_fold(held)):
            refuted.append(v)
    return refuted
