"""Whether one vertex folds with given letters: the theorem of Abel et al., decided exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from exactfold.exact.surds import sign
from exactfold.panels.stars import Star, bracket, dot
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
    'MMMV'
    """
    given = [letters.get(fold, "U") for fold in star.folds]
    moving = {k for k, letter in enumerate(given) if letter in "MV"}
    free = {k for k, letter in enumerate(given) if letter == "U"}
    for letter in _OTHER:
        base = {k for k in moving if given[k] == letter}
        if base == moving and (pair := _straight(star, moving, free)):
            return _motion(star, given, pair, None, letter)
        toes = sorted(moving - base)
        if toes:
            if foot := no_half_plane(star, base | free):
                return _motion(star, given, foot, toes[0], letter)
            continue
        for toe in sorted(free):
            if foot := no_half_plane(star, (base | free) - {toe}):
                return _motion(star, given, foot, toe, letter)
    return None


def no_half_plane(star: Star, chosen: set[int]) -> tuple[int, ...] | None:
    """Three or four of the chosen folds that lie in no closed half-plane; None if all lie in one.

    Folds are given by their positions in the star. The directions lie in no closed half-plane if
    and only if each is followed by another, counter-clockwise, at an angle less than pi. Then three
    of them do the same, or four do that form two straight lines (Steinitz).

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> no_half_plane(right, {0, 1, 2, 3}), no_half_plane(right, {0, 1, 2})
    ((0, 1, 2, 3), None)
    """
    d, around = star.directions, sorted(chosen)
    following = zip(around, around[1:] + around[:1], strict=True)
    if len(around) < 3 or any(sign(bracket(d[i], d[j])) <= 0 for i, j in following):
        return None
    first = around[0]
    side = {k: sign(bracket(d[first], d[k])) for k in around[1:]}
    left = max(k for k in side if side[k] > 0)
    right = min(k for k in side if side[k] < 0)
    if sign(bracket(d[left], d[right])) > 0:
        return first, left, right
    (middle,) = (k for k in side if side[k] == 0)
    if sign(dot(d[left], d[right])) < 0 and sign(bracket(d[left], d[right])) == 0:
        return first, left, middle, right
    return left, middle, right


def _straight(star: Star, moving: set[int], free: set[int]) -> tuple[int, int] | None:
    """Two folds that form a straight crease, among them all that have to move."""
    d = star.directions
    able = sorted(moving | free)
    for i in able:
        for j in able:
            if i < j and moving <= {i, j} and sign(bracket(d[i], d[j])) == 0:
                return i, j
    return None


def _motion(
    star: Star, given: Sequence[str], base: tuple[int, ...], toe: int | None, letter: str
) -> VertexMotion:
    letters = ["F" if x == "U" else x for x in given]
    for k in base:
        letters[k] = letter
    if toe is not None:
        letters[toe] = _OTHER[letter]
    return VertexMotion(
        star.vertex,
        tuple(star.folds[k] for k in base),
        None if toe is None else star.folds[toe],
        dict(zip(star.folds, letters, strict=True)),
    )
