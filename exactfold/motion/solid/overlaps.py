"""Where prisms are apart, and where they overlap: in floats, and with proof on stretches.

Two convex polyhedra are disjoint iff they are apart along a normal of a face of one of them or
along the cross product of an edge of each (the separating axes).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from flint import arb, ctx

from exactfold._support.arrays import FloatArray, IndexArray, cross
from exactfold.motion.contacts.face_pairs import Open
from exactfold.motion.contacts.separation import MARGIN, Swept, least_gap, unit

_AT_ONCE: Final = 4096
"""So many pairs of prisms are compared at once."""
_BITS: Final = 128
_ENLARGED: Final = 1e6
FACES: Final = ((0, 2, 1), (3, 4, 5), (0, 1, 3), (1, 2, 4), (2, 0, 5))
"""Three corners of each face of a prism, counter-clockwise from outside."""


def axes(a: FloatArray, b: FloatArray) -> FloatArray:
    """Directions, one of which parts two prisms if any does, of length just below 1.

    The prisms have the shape (pairs, 6, 3), the directions (pairs, 24, 3).
    """
    sides = [np.roll(p[:, :3], -1, axis=1) - p[:, :3] for p in (a, b)]
    normals = [unit(p[:, 3:4] - p[:, :1]) for p in (a, b)]
    edges = [np.concatenate([unit(s), n], axis=1) for s, n in zip(sides, normals, strict=True)]
    walls = [cross(s, n) for s, n in zip(sides, normals, strict=True)]
    crossed = cross(edges[0][:, :, None], edges[1][:, None]).reshape(len(a), 16, 3)
    return unit(np.concatenate([*normals, *walls, crossed], axis=1))


def widest(a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
    """For each pair of prisms the widest gap along an axis, and this axis, from b to a.

    The gap is negative if the prisms overlap.
    """
    n = axes(a, b)
    p, q = (np.einsum("pac,pkc->pak", n, x) for x in (a, b))
    ahead, behind = p.min(axis=2) - q.max(axis=2), q.min(axis=2) - p.max(axis=2)
    gaps = np.maximum(ahead, behind)
    # Parallel edges have no cross product: their axis is 0, and so is its gap.
    gaps[np.abs(n).max(axis=2) < 0.5] = -np.inf
    best = gaps.argmax(axis=1)
    rows = np.arange(len(best))
    turn = np.where(ahead[rows, best] >= behind[rows, best], 1.0, -1.0)
    return gaps[rows, best], n[rows, best] * turn[:, None]


def overlapping(places: FloatArray, prisms: IndexArray, pairs: IndexArray) -> IndexArray:
    """The rows of pairs of prisms that overlap in floats; `places` has the shape (corners, 3)."""
    boxes = places[prisms]
    low, high = boxes.min(axis=1), boxes.max(axis=1)
    one, two = pairs.T
    near = ((low[one] < high[two]) & (low[two] < high[one])).all(axis=1)
    rows = np.flatnonzero(near)
    found = []
    for some in np.array_split(rows, 1 + len(rows) // _AT_ONCE):
        gaps, _ = widest(boxes[one[some]], boxes[two[some]])
        found.append(some[gaps < 0])
    return np.concatenate(found)


def common_point(a: FloatArray, b: FloatArray) -> FloatArray | None:
    """The point of two prisms that is deepest in both, in floats; None if there is none.

    It is the centre of the largest ball in both, by linear programming. HiGHS is exact to 1e-7, so
    that lengths are enlarged.
    """
    from scipy.optimize import linprog

    first, scale = a[0].copy(), _ENLARGED / float(np.abs(a - a[0]).max())
    rows, most = [], []
    for prism in ((a - first) * scale, (b - first) * scale):
        for i, j, k in FACES:
            n = unit(cross(prism[j] - prism[i], prism[k] - prism[i]))
            rows.append([*n, 1.0])
            most.append(float(n @ prism[i]))
    bounds = [(None, None)] * 3 + [(0, None)]
    best = linprog([0, 0, 0, -1], A_ub=rows, b_ub=most, bounds=bounds)
    found = best.status == 0 and best.x[3] > 0
    return np.asarray(first + best.x[:3] / scale) if found else None


def not_parted(pairs: IndexArray, prisms: IndexArray, swept: Swept, among: Open) -> Open:
    """The pairs among the rows `among.apart` that no plane is proved to part on a stretch."""
    left = []
    for rows in np.array_split(among.apart, 1 + len(among.apart) // _AT_ONCE):
        one, two = prisms[pairs[rows, 0]], prisms[pairs[rows, 1]]
        _, n = widest(swept.start[one], swept.start[two])
        i, j = np.repeat(one, 6, axis=1), np.tile(two, (1, 6))
        parted = least_gap(swept, n[:, None], i, j)[:, 0] > MARGIN
        left.append(rows[~parted])
    return Open(np.concatenate(left), among.corner, among.folds)


def inside(swept: Swept, point: int, prism: IndexArray) -> bool:
    """Whether a point is proved to be inside a prism, at one time.

    With the sides d and e from a corner below, the wall along d is left in the direction
    d x (d x e) = d (d.e) - e (d.d), which is known better than the cross product of d and an edge
    as short as the plate is thick.
    """
    with ctx.workprec(_BITS):
        p, *corners = (_ball(swept, int(v)) for v in (point, *prism))
        up = _crossed(_minus(corners[1], corners[0]), _minus(corners[2], corners[0]))
        lifts = [_dot(up, _minus(p, corners[k])) for k in (0, 3)]
        walls = []
        for k in range(3):
            a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
            d, e, to = _minus(b, a), _minus(c, a), _minus(p, a)
            walls.append(_dot(d, d) * _dot(e, to) - _dot(d, e) * _dot(d, to))
        return bool(lifts[0] > 0 and lifts[1] < 0) and all(bool(wall > 0) for wall in walls)


def _ball(swept: Swept, v: int) -> list[arb]:
    pairs = zip(swept.start[v].tolist(), swept.error[v].tolist(), strict=True)
    return [arb(middle, radius) for middle, radius in pairs]


def _minus(a: list[arb], b: list[arb]) -> list[arb]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _dot(a: list[arb], b: list[arb]) -> arb:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _crossed(a: list[arb], b: list[arb]) -> list[arb]:
    return [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]
