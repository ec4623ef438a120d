"""Proof that the faces of a sheet do not touch while it moves along a piece of a curve.

A plane separates two faces without a common vertex if some direction n has n.(x - y) > 0 for all
corners x of one face and y of the other. A plane separates two faces that share only the vertex v
if n.(x - v) > 0 and n.(v - y) > 0 for the other corners. Two faces with a common fold touch outside
the fold only if the fold is closed. Then the squared distance of their other corners is that in the
sheet folded over along the fold, which is a rational number. So sums of a few products decide
everything.

The sums are computed in floats, with u = 2^-53. Their rounding errors are bounded as follows.

- Positions are a + b (s - m) + e with |e| <= `error`, where a, b and m are floats, taken exactly.
  They come from c_0, ..., c_K with K <= 20 and sum |c_k| M^k < `_MOST` = 4 for every coordinate,
  where M = max |s|. If this bound fails, the error is infinite, and nothing is separated. The terms
  of the expansion at m are products of at most K + 2 factors, and each is rounded at most 3 K
  times. As |m| + half = M, the terms of all a, b, ... times the powers of half add up to at most 4,
  so their error is at most 240 u. The ulps of m and half move s by less than 2 u M, and so the
  position by less than 2 u K 4 = 160 u. The error of the remaining sum is less than 45 u of 4 =
  180 u, and the conversion of the coefficients adds 4 u of 4. In all this is less than 700 u <
  1e-13 = `_ROUND`.
- So a, b half and e are at most 4, and those of differences at most 8. With |n| <= 1 the three
  parts of a sum n.x are at most 8 sqrt(3) < 14 and are rounded less than 10 times. Their error is
  less than 30 u 14, and with the subtractions less than 60 u 14 < 1e-13. The squares and products
  of folds are sums of terms that add up to less than 1500, each rounded less than 20 times; their
  error is less than 4e-12. `MARGIN` is larger than both errors.
- The six products of a determinant add up to at most 3^(3/2) times the product of the lengths of
  its rows, and each is rounded less than 10 times. The relative errors of the two products of
  lengths are less than 40 u each. In all the error is less than 2e-14 of the product of the
  lengths; `_OF_VOLUME` of it is demanded.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache, partial
from itertools import combinations
from math import comb
from typing import Any, TypeAlias

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray, cross
from exactfold.motion.contacts.face_pairs import AnyPairs, Open
from exactfold.pattern.crease_pattern import Edge, Triangle

_MOST, _ROUND, MARGIN, _OF_VOLUME = 4.0, 1e-13, 1e-11, 1e-13
_MOST_ROWS = 21
_PRODUCTS = 2_000_000
_SUMS = "...k,k...vc->...vc"


@dataclass(frozen=True)
class Swept:
    """Positions of all vertices on |s - middle| <= half: a + b (s - middle) + e with |e| <= error.

    The arrays have shape (V, 3), in units of the framework. If `planar` is true, the third
    component is not bounded and must not be used. For many intervals at once, the arrays have one
    more axis in front.
    """

    start: FloatArray
    slope: FloatArray
    error: FloatArray
    half: Any
    planar: bool = False

    @classmethod
    def of(
        cls,
        coefficients: FloatArray,
        radius: FloatArray,
        low: Any,
        high: Any,
        *,
        planar: bool = False,
    ) -> Swept:
        """The positions given by p(s) = sum_k c_k s^k and |x - p| <= radius.

        The c_k have shape (order + 1, V, 3) and the radius (V, 3). The polynomial is expanded at
        the middle of the interval; all terms beyond the linear one go into the error. `low` and
        `high` are numbers, or arrays of shape (intervals, 1, 1). In the second case each interval
        may have its own polynomial and radius, of shapes (order + 1, intervals, V, 3) and
        (intervals, V, 3).
        """
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        most = np.maximum(np.abs(low), np.abs(high))
        count = len(coefficients)
        shape = np.broadcast_shapes(np.shape(middle), radius.shape)
        sizes = np.einsum(_SUMS, _powers(most, count), np.abs(coefficients))
        binomials, excess = _binomials(count)
        moved = binomials * _powers(middle, count)[..., excess]
        rows = np.einsum("...kj,j...vc->k...vc", moved, coefficients)  # p^(k)(middle) / k!
        rest = np.einsum(_SUMS, _powers(half, count)[..., 2:], np.abs(rows[2:]))
        error = np.broadcast_to(radius + rest, shape).copy()
        slope = rows[1] if count > 1 else np.zeros_like(rows[0])
        small = (np.broadcast_to(sizes, shape) + radius).max(axis=(-1, -2)) < _MOST
        error[~(small & (count <= _MOST_ROWS))] = np.inf
        start, slope = np.broadcast_to(rows[0], shape), np.broadcast_to(slope, shape)
        return cls(start, slope, error + _ROUND, half, planar)


Test: TypeAlias = "Callable[[Swept, Open], Open]"
"""Which of some pairs are not proved to stay apart on a stretch."""


def _powers(x: Any, count: int) -> FloatArray:
    """1, x, ..., x^(count - 1), computed by products, along a new last axis in place of the last
    two.
    """
    x = np.asarray(x, dtype=float)
    factors = np.ones((*x.shape[:-2], count))
    factors[..., 1:] = x.reshape(x.shape[:-2])[..., None]
    return np.asarray(np.cumprod(factors, axis=-1))


@cache
def _binomials(count: int) -> tuple[FloatArray, IndexArray]:
    """The binomial coefficient j over k in row k and column j, and max(j - k, 0)."""
    rows = range(count)
    return (
        np.array([[float(comb(j, k)) for j in rows] for k in rows]),
        np.array([[max(j - k, 0) for j in rows] for k in rows], dtype=np.intp),
    )


def not_separated(pairs: AnyPairs, swept: Swept, among: Open) -> Open:
    """The pairs that are not proved to stay apart on a stretch of the motion."""
    apart = np.array_split(among.apart, 1 + len(among.apart) * 9 * 23 // _PRODUCTS)
    triangles = pairs.triangles
    left = [part[~_apart(swept, triangles, pairs.apart[part])] for part in apart]
    return Open(
        np.concatenate(left),
        among.corner[~_at_corner(swept, pairs.corners[among.corner])],
        among.folds[~_open_folds(swept, pairs, among.folds)],
    )


def clear_until(
    pairs: AnyPairs | Test,
    coefficients: FloatArray,
    radius: FloatArray,
    low: float,
    high: float,
    *,
    planar: bool = False,
    among: Open | None = None,
    finest: float = 1e-6,
) -> tuple[float, Open]:
    """How far along a piece no two faces touch, and which pairs were not separated after that.

    The first value is proved. The piece is p(s) = sum_k c_k s^k for low <= s <= high, shape (order
    + 1, V, 3); every coordinate is within `radius` of it, shape (V, 3). Where a pair is not
    separated the piece is halved, down to the share `finest` of its length. The second value is
    empty if the whole piece is clear. Pairs named there may still be apart. `pairs` are those of
    triangles, or the test of other bodies, of which `among` says which are asked.
    """
    test = partial(not_separated, pairs) if isinstance(pairs, AnyPairs) else pairs
    shortest = finest * (high - low)
    if among is None:
        among = Open.all_of(pairs) if isinstance(pairs, AnyPairs) else Open.none()
    stack = [(low, high, among)]
    while stack:
        a, b, asked = stack.pop()
        swept = Swept.of(coefficients, radius, a, b, planar=planar)
        left = test(swept, asked)
        if not left:
            continue
        middle = 0.5 * (a + b)
        if b - a <= shortest or not a < middle < b:
            return a, left
        stack += [(middle, b, left), (a, middle, left)]
    return high, Open.none()


def _apart(swept: Swept, triangles: IndexArray, rows: IndexArray) -> BoolArray:
    """Whether planes separate pairs of faces without a common vertex."""
    one, two = triangles[rows[:, 0]], triangles[rows[:, 1]]
    axes = np.broadcast_to(np.eye(3)[: 2 if swept.planar else 3], (len(rows), 3 - swept.planar, 3))
    done = _separated(swept, one, two, axes)
    rest = np.flatnonzero(~done)
    if len(rest):
        a, b = swept.start[one[rest]], swept.start[two[rest]]
        done[rest] = _separated(swept, one[rest], two[rest], _axes(a, b, swept.planar))
    return done


def _at_corner(swept: Swept, rows: IndexArray) -> BoolArray:
    """Whether planes through the common vertex separate pairs of faces with one common vertex."""
    if not len(rows):
        return np.zeros(0, dtype=bool)
    v, one, two = rows[:, :1], rows[:, 1:3], rows[:, 3:]
    at = swept.start if not swept.planar else swept.start * np.array([1.0, 1.0, 0.0])
    axes = _nearest_points(unit(np.concatenate([at[one] - at[v], at[v] - at[two]], axis=1)))
    if swept.planar:
        axes = axes * np.array([1.0, 1.0, 0.0])
    # The plane passes through the moving vertex, so both sides are differences from it.
    left = least_gap(swept, axes, one, np.broadcast_to(v, one.shape))
    right = least_gap(swept, axes, np.broadcast_to(v, two.shape), two)
    return np.asarray((np.minimum(left, right) > MARGIN).any(axis=1))


def _open_folds(swept: Swept, pairs: AnyPairs, rows: IndexArray) -> BoolArray:
    """Whether folds are proved not to be closed."""
    hinges = pairs.hinges[rows]
    left, right = hinges[:, 2], hinges[:, 3]
    gap = swept.start[left] - swept.start[right]
    spread = swept.half * np.abs(swept.slope[left] - swept.slope[right])
    spread += swept.error[left] + swept.error[right]
    if swept.planar:
        gap, spread = gap[:, :2], spread[:, :2]
    # |gap + d|^2 >= |gap|^2 + 2 gap.d; the part that is linear in s is bounded as a whole.
    drift = swept.half * np.abs(
        (gap * (swept.slope[left] - swept.slope[right])[:, : gap.shape[1]]).sum(axis=1)
    )
    error = (np.abs(gap) * (swept.error[left] + swept.error[right])[:, : gap.shape[1]]).sum(axis=1)
    least = (gap * gap).sum(axis=1) - 2 * (drift + error)
    far = least > pairs.closed[rows] + MARGIN
    if swept.planar:
        i, j = hinges[:, 0], hinges[:, 1]
        return np.asarray(far | (_upright(swept, i, j, left) & _upright(swept, j, i, right)))
    return np.asarray(far | (bends(swept, hinges) != 0))


def _upright(swept: Swept, i: IndexArray, j: IndexArray, k: IndexArray) -> BoolArray:
    """Whether the projections of the faces ijk to the plane are proved to stay counter-clockwise.

    If the projections of both faces at a fold do, the faces are on different sides of the fold, and
    it is not closed.
    """
    a, b = (swept.start[v, :2] - swept.start[i, :2] for v in (j, k))
    u, v = (swept.slope[w, :2] - swept.slope[i, :2] for w in (j, k))
    e, f = ((swept.error[w, :2] + swept.error[i, :2]).sum(axis=1) for w in (j, k))
    size_a, size_b = (
        np.abs(p).max(axis=1) + swept.half * np.abs(q).max(axis=1) for p, q in ((a, u), (b, v))
    )
    least = _cross(a, b) - swept.half * np.abs(_cross(a, v) + _cross(u, b))
    least = least - swept.half**2 * np.abs(_cross(u, v)) - e * size_b - f * size_a - e * f
    return np.asarray(least > MARGIN)


def _cross(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def bends(swept: Swept, hinges: IndexArray) -> IndexArray:
    """1 for folds that are valleys all the time, -1 for mountains, 0 if neither is proved.

    The sign is that of det(j - i, left - i, right - i), the volume between the two faces.
    """
    if swept.planar:
        return np.zeros(len(hinges), dtype=np.intp)
    # A valley has the left corner above the right face: a positive volume.
    return _volume_signs(swept, hinges)


def through(swept: Swept, edge: Edge, face: Triangle) -> bool:
    """Whether an edge is proved to run through a face without touching the sides of the face."""
    (p, q), (a, b, c) = edge, face
    rows = [(p, a, b, c), (q, a, b, c), (p, q, a, b), (p, q, b, c), (p, q, c, a)]
    start, end, *sides = _volume_signs(swept, np.array(rows, dtype=np.intp))
    return bool(start * end == -1 and abs(sum(sides)) == 3)


def _volume_signs(swept: Swept, rows: IndexArray) -> IndexArray:
    """The sign of det(x_j - x_i, x_k - x_i, x_l - x_i) for rows (i, j, k, l); 0 if it is
    uncertain.
    """
    i = rows[:, 0]
    arms = [swept.start[rows[:, k]] - swept.start[i] for k in (1, 2, 3)]
    spreads = [
        swept.half * np.abs(swept.slope[rows[:, k]] - swept.slope[i])
        + swept.error[rows[:, k]]
        + swept.error[i]
        for k in (1, 2, 3)
    ]
    size = [np.linalg.norm(arm, axis=1) for arm in arms]
    most = [n + np.linalg.norm(spread, axis=1) for n, spread in zip(size, spreads, strict=True)]
    volume = (arms[0] * cross(arms[1], arms[2])).sum(axis=1)
    # |det(e + de, ...) - det(e, ...)| is at most the product of the larger lengths minus the
    # product of the smaller ones.
    product = most[0] * most[1] * most[2]
    change = product - size[0] * size[1] * size[2]
    clear = np.abs(volume) > change + _OF_VOLUME * product
    return np.where(clear, np.sign(volume), 0).astype(np.intp)


def _separated(swept: Swept, one: IndexArray, two: IndexArray, axes: FloatArray) -> BoolArray:
    """Whether some of the axes, shape (pairs, axes, 3), separates two faces, shape (pairs, 3)."""
    i, j = np.repeat(one, 3, axis=1), np.tile(two, (1, 3))
    best = np.maximum(least_gap(swept, axes, i, j), least_gap(swept, -axes, i, j))
    return np.asarray((best > MARGIN).any(axis=1))


def least_gap(swept: Swept, axes: FloatArray, i: IndexArray, j: IndexArray) -> FloatArray:
    """The least n.(x_i - x_j) over pairs of vertices, for each axis; shape (pairs, axes)."""
    at = np.einsum("pac,pkc->pak", axes, swept.start[i] - swept.start[j])
    drift = np.einsum("pac,pkc->pak", axes, swept.slope[i] - swept.slope[j])
    error = np.einsum("pac,pkc->pak", np.abs(axes), swept.error[i] + swept.error[j])
    return np.asarray((at - swept.half * np.abs(drift) - error).min(axis=2))


def _axes(a: FloatArray, b: FloatArray, planar: bool) -> FloatArray:
    """Directions, one of which separates two triangles (pairs, 3, 3) if any direction does.

    Their lengths are at most 1.
    """
    sides_a, sides_b = (np.roll(t, -1, axis=1) - t for t in (a, b))
    if planar:
        sides = np.concatenate([sides_a, sides_b], axis=1)
        return unit(np.stack([-sides[..., 1], sides[..., 0], np.zeros(sides.shape[:2])], axis=-1))
    normals = [cross(sides[:, :1], sides[:, 1:2]) for sides in (sides_a, sides_b)]
    crossed = cross(sides_a[:, :, None], sides_b[:, None]).reshape(len(a), 9, 3)
    across = [cross(sides, unit(n)) for sides, n in zip((sides_a, sides_b), normals, strict=True)]
    return unit(np.concatenate([*across, *normals, crossed], axis=1))


def _nearest_points(p: FloatArray) -> FloatArray:
    """The point nearest to 0 on each line and plane that four points span.

    The four points have shape (pairs, 4, 3). The inequalities n.p > 0 for all four points have a
    solution n exactly if 0 is not in their convex hull. Then the point of the hull nearest to 0 is
    a solution; it is one of the four points or one of the points returned here.
    """
    candidates = [p]
    for i, j in combinations(range(4), 2):
        side = p[:, j] - p[:, i]
        square = np.maximum((side * side).sum(axis=1), 1e-300)
        share = (p[:, i] * side).sum(axis=1) / square
        candidates.append((p[:, i] - share[:, None] * side)[:, None])
    for i, j, k in combinations(range(4), 3):
        normal = cross(p[:, j] - p[:, i], p[:, k] - p[:, i])
        candidates.append((normal * np.sign((normal * p[:, i]).sum(axis=1))[:, None])[:, None])
    return unit(np.concatenate(candidates, axis=1))


def unit(vectors: FloatArray) -> FloatArray:
    """Vectors of length just below 1 in the same directions; 0 for 0."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.maximum(length, 1e-300) * (1 - 1e-12))
