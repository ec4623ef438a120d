"""An exact motion of one vertex with given letters, made from the folds that show that it folds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from exactfold.design.panels.first_order_program import SIDES
from exactfold.exact.surds import Number, common_field, exact, real_root, sign
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.panels.vertex.vertex_motions import vertex_motion
from exactfold.pattern.panel_pattern import Edge

Motion = dict[Edge, Number]


def vertex_witness(star: Star, letters: Mapping[Edge, str]) -> Motion | None:
    """Densities of the folds of a vertex with these letters, at which its form vanishes; or None.

    The steps are those of the proof in `exactfold.checker.letters.vertices`. Three or four folds
    with one letter lie in no closed half-plane. Let them bend alone: there the form is positive.
    Let a fold with the other letter bend with its two neighbours among them: there the form is
    negative. A motion to first order that has all the letters is added to both, with a weight so
    small that the signs stay. Between the two points the form has a zero. A straight crease bends
    alone. None is returned exactly if the vertex has no motion with these letters; if no fold has a
    letter, some motion is returned.

    >>> directions = ((1, 0), (0, 1), (-1, 0), (0, -1), (1, -1))
    >>> star = Star(0, tuple((0, k) for k in range(1, 6)), directions)
    >>> motion = vertex_witness(star, dict(zip(star.folds, "VVVVM")))
    >>> star.form([motion[fold] for fold in star.folds]), [sign(motion[f]) for f in star.folds]
    (0, [1, 1, 1, 1, -1])
    """
    shown = vertex_motion(star, letters)
    if shown is None:
        return None
    place = {fold: k for k, fold in enumerate(star.folds)}
    base = [place[fold] for fold in shown.base]
    if shown.toe is None:
        return _straight(star, base, SIDES[shown.letters[shown.base[0]]])
    toe = place[shown.toe]
    alone = _closed(star, {k: SIDES[shown.letters[star.folds[k]]] for k in base})
    inner = _all_bent(star, shown.letters, base, alone)
    wing = _closed_by(star, toe, _neighbours(base, toe), SIDES[shown.letters[shown.toe]])
    weight = Fraction(1)
    while True:
        a, b = ([x + weight * y for x, y in zip(w, inner, strict=True)] for w in (alone, wing))
        at_a, at_b = star.form(a), star.form(b)
        if sign(at_a) > 0 > sign(at_b):
            break
        weight /= 2
    mixed = star.form([x + y for x, y in zip(a, b, strict=True)]) - at_a - at_b
    square = mixed * mixed - 4 * at_a * at_b
    s = (mixed + real_root(square, common_field([square, *a, *b]))) / (-2 * exact(at_b))
    return {fold: x + s * y for fold, x, y in zip(star.folds, a, b, strict=True)}


def _straight(star: Star, pair: Sequence[int], side: int) -> Motion:
    """The motion of a straight crease, all other folds being flat."""
    (a, b), (c, d) = (star.directions[k] for k in pair)
    motion: Motion = dict.fromkeys(star.folds, Fraction(0))
    motion[star.folds[pair[0]]] = Fraction(side)
    motion[star.folds[pair[1]]] = -side * (a / exact(c) if c else b / exact(d))
    return motion


def _closed(star: Star, sides: Mapping[int, int]) -> list[Number]:
    """Densities of three or four folds that lie in no closed half-plane, with these sides.

    Each fold lies opposite to a sector between two others, or to one other fold.
    """
    w: list[Number] = [Fraction(0)] * len(star.folds)
    for k, side in sides.items():
        for j, x in enumerate(_closed_by(star, k, _behind(star, sorted(sides), k), side)):
            w[j] = w[j] + x
    return w


def _all_bent(
    star: Star, letters: Mapping[Edge, str], base: Sequence[int], alone: Sequence[Number]
) -> list[Number]:
    """A motion to first order in which each fold with a letter bends its way.

    Every other fold is closed by folds of the base, and the base bends enough to outweigh that.
    """
    w: list[Number] = [Fraction(0)] * len(star.folds)
    for k, fold in enumerate(star.folds):
        if k not in base and letters[fold] in SIDES:
            for j, x in enumerate(
                _closed_by(star, k, _behind(star, base, k), SIDES[letters[fold]])
            ):
                w[j] = w[j] + x
    weight = Fraction(1)
    while True:
        total: list[Number] = [x + weight * y for x, y in zip(w, alone, strict=True)]
        if all(sign(total[k]) == sign(alone[k]) for k in base):
            return total
        weight *= 2


def _behind(star: Star, base: Sequence[int], k: int) -> tuple[int, int]:
    """Two neighbouring folds of the base, such that the direction opposite to fold k lies from the
    first, counter-clockwise, to before the second.
    """
    x, y = star.directions[k]
    back = (-x, -y)
    around = sorted(base)
    return next(
        (i, j)
        for i, j in zip(around, around[1:] + around[:1], strict=True)
        if sign(bracket(star.directions[i], back)) >= 0
        and sign(bracket(back, star.directions[j])) > 0
    )


def _neighbours(base: Sequence[int], toe: int) -> tuple[int, int]:
    """The last fold of the base before the toe, counter-clockwise, and the first behind it."""
    around = sorted(base)
    after = next((k for k in around if k > toe), around[0])
    return around[around.index(after) - 1], after


def _closed_by(star: Star, k: int, pair: tuple[int, int], side: int) -> list[Number]:
    """Densities of fold k and of two others with which they close up; that of fold k is +-1."""
    i, j = pair
    d = star.directions
    w: list[Number] = [Fraction(0)] * len(star.folds)
    size = exact(bracket(d[i], d[j]))
    w[k] = Fraction(side)
    w[i] = -side * bracket(d[k], d[j]) / size
    w[j] = -side * bracket(d[i], d[k]) / size
    return w
