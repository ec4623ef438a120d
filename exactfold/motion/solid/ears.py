"""Polygons whose corners are known to lie in boxes: they are cut into triangles, with proof."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TypeAlias

from flint import arb

Spot: TypeAlias = tuple[arb, arb]


def turned(p: Spot, q: Spot, r: Spot) -> arb:
    """(q - p) x (r - p): positive if the three points turn left.

    >>> zero, one = arb(0), arb(1)
    >>> turned((zero, zero), (one, zero), (zero, one)) > 0
    True
    """
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def may_cross(spots: Sequence[Spot]) -> bool:
    """Whether two sides of a polygon that have no common corner are not known to be apart.

    Two sides are apart if both ends of one lie on the same side of the line through the other.
    """
    count = len(spots)
    for (a, b), (c, d) in combinations([(k, (k + 1) % count) for k in range(count)], 2):
        p, q, r, s = spots[a], spots[b], spots[c], spots[d]
        if not ({a, b} & {c, d} or _one_side(p, q, r, s) or _one_side(r, s, p, q)):
            return True
    return False


def ears(spots: Sequence[Spot]) -> tuple[tuple[int, int, int], ...] | None:
    """The triangles of a polygon that runs counter-clockwise, by numbers of its corners.

    An ear is a corner that turns left, with no other corner in the triangle of it and its two
    neighbours. One ear after the other is cut off. All triangles but the last are known to turn
    left. Returns None if no corner is known to be an ear.
    """
    ring, triangles = list(range(len(spots))), []
    while len(ring) > 3:
        k = next((k for k in range(len(ring)) if _is_ear(spots, ring, k)), None)
        if k is None:
            return None
        triangles.append((ring[k - 1], ring[k], ring[(k + 1) % len(ring)]))
        del ring[k]
    return (*triangles, (ring[0], ring[1], ring[2]))


def _one_side(p: Spot, q: Spot, r: Spot, s: Spot) -> bool:
    """Whether r and s are on one side of the line pq, for certain."""
    return bool(turned(p, q, r) * turned(p, q, s) > 0)


def _is_ear(spots: Sequence[Spot], ring: Sequence[int], k: int) -> bool:
    a, b, c = ring[k - 1], ring[k], ring[(k + 1) % len(ring)]
    if not turned(spots[a], spots[b], spots[c]) > 0:
        return False
    sides = ((a, b), (b, c), (c, a))
    others = (v for v in ring if v not in (a, b, c))
    return all(any(turned(spots[i], spots[j], spots[v]) < 0 for i, j in sides) for v in others)
