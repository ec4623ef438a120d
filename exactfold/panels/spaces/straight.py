"""Straight creases from boundary to boundary: each folds by itself, whatever crosses it."""

from __future__ import annotations

from collections.abc import Mapping

from flint import fmpq

from exactfold.exact.surds import sign
from exactfold.panels.spaces.kernel import Entry, Rows, entry
from exactfold.panels.vertex.stars import Star, bracket, dot
from exactfold.pattern.panel_pattern import Edge


def straight_creases(stars: Mapping[int, Star]) -> list[Rows]:
    """The lines of motions in which one straight crease folds and every other fold stays flat.

    Such a crease passes each vertex along a straight pair of folds and ends on the boundary. The
    vertices may have any number of folds. The list is sorted by the first fold of each crease.

    >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-2, 0), (0, -1)))
    >>> straight_creases({0: right})
    [{(0, 1): [1], (0, 3): [1/2]}, {(0, 2): [1], (0, 4): [1]}]
    """
    beyond = {
        (v, edge): (other, ratio)
        for v, star in stars.items()
        for edge, other, ratio in _pairs(star)
    }
    creases: list[Rows] = []
    ended: set[Edge] = set()
    for first in sorted({edge for star in stars.values() for edge in star.folds}):
        inside = [v for v in first if v in stars]
        if len(inside) != 1 or first in ended:
            continue
        crease: Rows = {}
        fold, v = first, inside[0]
        at: Entry = fmpq(1)
        crease[fold] = [at]
        while v in stars and (v, fold) in beyond:
            fold, ratio = beyond[v, fold]
            at = at * ratio
            crease[fold] = [at]
            v = fold[0] + fold[1] - v
        if v not in stars:
            ended.add(fold)
            creases.append(crease)
    return creases


def _pairs(star: Star) -> list[tuple[Edge, Edge, Entry]]:
    """Each fold that a fold continues straight, and its density where the first has density 1."""
    pairs: list[tuple[Edge, Edge, Entry]] = []
    ends = list(zip(star.folds, star.directions, strict=True))
    for k, (edge, d) in enumerate(ends):
        for other, c in ends[:k]:
            if bracket(d, c) == 0 and sign(dot(d, c)) < 0:
                axis = 0 if d[0] != 0 else 1
                ratio = -entry(d[axis]) / entry(c[axis])
                pairs += [(edge, other, ratio), (other, edge, 1 / ratio)]
    return pairs
