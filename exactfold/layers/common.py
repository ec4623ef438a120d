"""Which three pieces of a folded sheet have a common interior point, exactly."""

from __future__ import annotations

from functools import cached_property
from typing import Final

import numpy as np

from exactfold.exact.surds import Surd
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.sides import Flags, Indices, Signs

_ERROR: Final = 2.0**-46
"""Relative error of a float determinant of three lines, with numbers within 2^-52 each."""
_TINY: Final = 2.0**-800
_ROWS: Final = 1 << 16
_SAMPLES: Final = 17
_NEAR: Final = 0.97
"""How far samples lie on the way from the middle of a piece to its border."""


class Common:
    """Decides for triples of pieces that overlap in pairs whether they have a common open set.

    By Helly's theorem they have none if and only if three half-planes have none, one from a side of
    each piece. For lines n_i x + d_i > 0 this is so if numbers l_i > 0 exist with sum l_i n_i = 0
    and sum l_i d_i <= 0; the l_i are brackets of the normals, and the sum is a determinant
    (docs/flat.md, Three pieces). Its sign is that of a float with an error bound, or exact.
    """

    def __init__(self, overlaps: Overlaps) -> None:
        self.overlaps = overlaps
        self.exact_tests = 0
        self._known: dict[tuple[int, int, int], int] = {}

    def have(self, triples: Indices) -> Flags:
        """For each row of three pieces, whether they have a common open set."""
        have = np.zeros(len(triples), dtype=bool)
        for start in range(0, len(triples), _ROWS):
            rows = slice(start, start + _ROWS)
            some = triples[rows]
            seen = self._seen(some)
            seen[~seen] = self._some(some[~seen])
            have[rows] = seen
        return have

    def _seen(self, triples: Indices) -> Flags:
        """Whether one of the sample points of three pieces lies inside all of them."""
        seen = np.zeros(len(triples), dtype=bool)
        for one, two, three in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
            a, b, c = triples[:, one], triples[:, two], triples[:, three]
            seen |= (self._samples[self._place(a, b)] & self._samples[self._place(a, c)]) != 0
        return seen

    def _place(self, one: Indices, other: Indices) -> Indices:
        """The rows of `_samples` for pairs of overlapping pieces."""
        count = self.overlaps.count
        return np.searchsorted(self._keys, one * count + other)

    @cached_property
    def _keys(self) -> Indices:
        one, other = np.nonzero(self.overlaps.overlapping)
        return one * self.overlaps.count + other

    @cached_property
    def _samples(self) -> Indices:
        """For each ordered pair of overlapping pieces, the samples of the first in the second.

        The samples of a piece are its middle, and points near its corners and the middles of its
        sides. They are floats, and are counted only if the signs of all sides of the second piece
        are certain.
        """
        s, corners = self.overlaps.sides, self.overlaps.corners
        points = np.zeros((len(corners), _SAMPLES, 2))
        for k, some in enumerate(corners):
            xy = np.stack([s.x[some], s.y[some]], axis=1)
            middle = xy.mean(axis=0)
            near = np.concatenate([xy, (xy + np.roll(xy, 1, axis=0)) / 2])[: _SAMPLES - 1]
            points[k] = middle
            points[k, 1 : len(near) + 1] += _NEAR * (near - middle)
        lines, sides = self.overlaps.sides_table
        count = self.overlaps.count
        found = []
        for start in range(0, len(self._keys), _ROWS):
            one, other = np.divmod(self._keys[start : start + _ROWS], count)
            x, y = points[one, :, 0], points[one, :, 1]
            inside = np.ones(x.shape, dtype=bool)
            for k in range(lines.shape[1]):
                a, b, c = (v[lines[other, k], None] for v in (s.a, s.b, s.c))
                value = sides[other, k, None] * (a * x + b * y - c)
                margin = _ERROR * (abs(a * x) + abs(b * y) + abs(c)) + _TINY
                inside &= value > margin + self.overlaps.blur * np.hypot(a, b)
            found.append(inside @ (1 << np.arange(_SAMPLES)))
        return np.concatenate(found) if found else np.zeros(0, dtype=np.int64)

    def _some(self, triples: Indices) -> Flags:
        lines, sides = self.overlaps.sides_table
        common = np.ones(len(triples), dtype=bool)
        a, b, c = (triples[:, k] for k in range(3))
        most = lines.shape[1]
        for i in range(most):
            la, sa = lines[a, i], sides[a, i]
            for j in range(most):
                lb, sb = lines[b, j], sides[b, j]
                ab = sa * sb * self._turns[la, lb]
                for k in range(most):
                    rows = np.nonzero(common & (ab != 0))[0]
                    lc, sc = lines[c[rows], k], sides[c[rows], k]
                    turn = ab[rows]
                    around = sb[rows] * sc * self._turns[lb[rows], lc] == turn
                    around &= sc * sa[rows] * self._turns[lc, la[rows]] == turn
                    if not around.any():
                        continue
                    rows, lc, sc, turn = rows[around], lc[around], sc[around], turn[around]
                    sign = -sa[rows] * sb[rows] * sc * self._determinants(la[rows], lb[rows], lc)
                    common[rows[turn * sign <= 0]] = False
        return common

    def _determinants(self, la: Indices, lb: Indices, lc: Indices) -> Signs:
        """The signs of the determinants with the rows (c, a, b) of three lines."""
        s = self.overlaps.sides
        total, size = np.zeros(len(la)), np.zeros(len(la))
        for one, two, three in ((la, lb, lc), (lb, lc, la), (lc, la, lb)):
            first, second = s.a[two] * s.b[three], s.a[three] * s.b[two]
            total += s.c[one] * (first - second)
            size += abs(s.c[one]) * (abs(first) + abs(second))
        signs = np.sign(total).astype(np.int8)
        if self.overlaps.blur:
            length = np.hypot(s.a, s.b)
            small = self.overlaps.blur * length[la] * length[lb] * length[lc]
            return np.where(abs(total) < small, 0, signs).astype(np.int8)
        for row in np.nonzero(~(abs(total) > _ERROR * size + _TINY))[0]:
            signs[row] = self._exact(int(la[row]), int(lb[row]), int(lc[row]))
        return signs

    def _exact(self, la: int, lb: int, lc: int) -> int:
        order = sorted((la, lb, lc))
        key = (order[0], order[1], order[2])
        swaps = (la > lb) + (lb > lc) + (la > lc)
        if key not in self._known:
            self.exact_tests += 1
            one, two, three = (self.overlaps.sides.lines[k] for k in key)
            total: Surd = one.c * (two.a * three.b - three.a * two.b)
            total += two.c * (three.a * one.b - one.a * three.b)
            total += three.c * (one.a * two.b - two.a * one.b)
            self._known[key] = total.sign()
        return -self._known[key] if swaps % 2 else self._known[key]

    @cached_property
    def _turns(self) -> Signs:
        """The signs of the brackets of the normals of all lines."""
        s = self.overlaps.sides
        first, second = np.outer(s.a, s.b), np.outer(s.b, s.a)
        value, bound = first - second, _ERROR * (abs(first) + abs(second)) + _TINY
        signs = np.sign(value).astype(np.int8)
        slopes: dict[object, int] = {}
        kind = [
            slopes.setdefault(line.b / line.a if line.a else None, len(slopes)) for line in s.lines
        ]
        slope = np.array(kind)
        signs[slope[:, None] == slope[None, :]] = 0
        near = ~(abs(value) > bound) & (slope[:, None] != slope[None, :])
        for k, m in np.argwhere(near):
            one, two = s.lines[k], s.lines[m]
            signs[k, m] = (one.a * two.b - one.b * two.a).sign()
        return signs
