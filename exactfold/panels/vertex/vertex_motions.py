"""Whether one vertex folds with given letters: the theorem of Abel et al., decided exactly."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from exactfold.exact.surds import sign
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.pattern.panel_pattern import Edge

_OTHER = {"M": "V", "V": "M"}


@dataclass(frozen=True)
class VertexMotion:
    """The folds that show that a vertex folds, and letters with which it does.

    `base` are folds with one letter. Either they are the two halves of a straight crease and `toe`
    is None, or they are three or four folds that lie in no closed half-plane and `toe` is a fold
    with the opposite letter. `letters` has an M, V or F for every fold of the vertex.
    """

    vertex: int
    base: tuple[Edge, ...]
    toe: Edge | None
    letters: Mapping[Edge, str]


def vertex_motion(star: Star, letters: Mapping[Edge, str]) -> VertexMotion | None:
    """How one vertex folds with these letters, all other vertices left aside; None if it cannot.

    `star` has the folds of an interior vertex, counter-clockwise. A fold with "M" or "V" has to
    fold that way, a fold with "F" has to stay flat, and a fold with "U", or without a letter, may
    do anything. At least one fold has to move, so with "U" everywhere this decides whether any
    finite motion exists. The flat sheet itself has letters that are all "F" or "U".

    The answer is complete and exact. Let the folds that move have the letters M and V. The rigid
    panels around the vertex have configurations with these letters that come arbitrarily near to
    the flat sheet if and only if two folds move, which form a straight crease and have the same
    letter, or the folds with one letter lie in no closed half-plane and some fold has the other
    letter. Then a motion starts from the flat sheet, to first order already with these letters
    (Abel, Cantarella, Demaine, Eppstein, Hull, Ku, Lang, Tachi, Rigid origami vertices: conditions
    and forcing sets, J. Comput. Geom. 7, 2016; docs/vertices.md, Theorem 1).

    >>> star = Star(4, ((0, 4), (1, 4), (2, 4), (3, 4)), ((2, 1), (-1, 1), (-1, -1), (1, -2)))
    >>> motion = vertex_motion(star, dict(zip(star.folds, "MMMV")))
    >>> motion.base, motion.toe
    (((0, 4), (1, 4), (2, 4)), (3, 4))
    >>> vertex_motion(star, dict(zip(star.folds, "MVMV"))) is None
    True
    >>> "".join(vertex_motion(star, {}).letters.values())
    'MMVM'
    """
    given = [letters.get(fold, "U") for fold in star.folds]
    foot = Fan(star).foot(given)
    if foot is None:
        return None
    base, toe, letter = foot
    completed = ["F" if x == "U" else x for x in given]
    for k in base:
        completed[k] = letter
    if toe is not None:
        completed[toe] = _OTHER[letter]
    return VertexMotion(
        star.vertex,
        tuple(star.folds[k] for k in base),
        None if toe is None else star.folds[toe],
        dict(zip(star.folds, completed, strict=True)),
    )


class Fan:
    """The order of the folds of a vertex, which is all that its letters depend on.

    Folds are named by their positions in the star. `reach[k]` is the number of folds at angles
    between 0 and pi from fold k, counter-clockwise, and `opposite[k]` is the fold at the angle pi,
    or None. A fan answers for many letters in a row without any further arithmetic.

    >>> right = Fan(Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1))))
    >>> right.reach, right.opposite
    ([1, 1, 1, 1], [2, 3, 0, 1])
    >>> right.folds("MFMF"), right.folds("MMMV")
    (True, False)
    """

    def __init__(self, star: Star) -> None:
        self.count = count = len(star.folds)
        self.reach: list[int] = []
        self.opposite: list[int | None] = []
        for k, direction in enumerate(star.directions):
            turns = (
                sign(bracket(direction, star.directions[(k + step) % count]))
                for step in range(1, count)
            )
            reach, turn = 0, next(turns, -1)
            while turn > 0:
                reach, turn = reach + 1, next(turns, -1)
            self.reach.append(reach)
            self.opposite.append((k + reach + 1) % count if turn == 0 else None)

    def folds(self, letters: Sequence[str]) -> bool:
        """Whether the vertex folds with letters M, V, F and U in the order of its folds."""
        return self.foot(letters) is not None

    def foot(self, letters: Sequence[str]) -> tuple[tuple[int, ...], int | None, str] | None:
        """The base and the toe of `VertexMotion`, and the letter of the base; None if there is no
        motion.
        """
        moving = {k for k, letter in enumerate(letters) if letter in "MV"}
        free = {k for k, letter in enumerate(letters) if letter == "U"}
        for letter in _OTHER:
            base = {k for k in moving if letters[k] == letter}
            if base == moving and (pair := self._straight(moving, free)):
                return pair, None, letter
            if toes := moving - base:
                if foot := self.spanning(base | free):
                    return foot, min(toes), letter
                continue
            for toe in sorted(free):
                if foot := self.spanning((base | free) - {toe}):
                    return foot, toe, letter
        return None

    def spanning(self, chosen: Collection[int]) -> tuple[int, ...] | None:
        """Three or four of the chosen folds that lie in no closed half-plane; None if all lie in
        one.

        Directions lie in no closed half-plane if and only if each is followed by another,
        counter-clockwise, at an angle less than pi. Then three of them do the same, or four that
        form two straight lines (Steinitz).
        """
        around = sorted(chosen)
        following = zip(around, around[1:] + around[:1], strict=True)
        if len(around) < 3 or not all(self._after(i, j) for i, j in following):
            return None
        first = around[0]
        left = max(k for k in around if self._after(first, k))
        right = min(k for k in around if self._after(k, first))
        if self._after(left, right):
            return first, left, right
        middle = around[around.index(left) + 1]
        if self.opposite[left] == right:
            return first, left, middle, right
        return left, middle, right

    def _after(self, i: int, j: int) -> bool:
        """Whether fold j lies at an angle between 0 and pi from fold i, counter-clockwise."""
        return 0 < (j - i) % self.count <= self.reach[i]

    def _straight(self, moving: set[int], free: set[int]) -> tuple[int, int] | None:
        """Two folds that form a straight crease, among them all that have to move."""
        for k in sorted(moving or free):
            other = self.opposite[k]
            if other is not None and other in moving | free and moving <= {k, other}:
                return min(k, other), max(k, other)
        return None
