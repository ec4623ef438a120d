"""The number of connected components of sign vectors, where cubes of them are connected."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final, TypeAlias

import numpy as np

Cube: TypeAlias = tuple[int, int]
"""All sign vectors that agree with `value` on the bits of `mask`; value has no other bits."""

_MOST_LISTED: Final = 20
_MOST_STEPS: Final = 20_000


def components(size: int, cubes: Iterable[Cube]) -> tuple[int, int]:
    """Bounds of the number of components of the 2^size sign vectors, where each cube is connected.

    Two cubes meet if and only if they agree on the bits that both fix. A sign vector in no cube is
    a component by itself. The two bounds are equal, unless there are more than 20 signs and too
    many vectors outside all cubes to be counted.

    >>> components(2, []), components(2, [(0b01, 0b01)]), components(3, [(1, 1), (2, 0)])
    ((4, 4), (3, 3), (3, 3))
    """
    kept = _largest(cubes)
    clusters = _clusters(kept)
    if size <= _MOST_LISTED:
        vectors = np.arange(1 << size)
        alone = np.ones(1 << size, dtype=bool)
        for mask, value in kept:
            alone &= (vectors & mask) != value
        count = clusters + int(alone.sum())
        return count, count
    steps = [_MOST_STEPS]
    left = _outside(size, 0, kept, steps)
    if left is not None:
        return clusters + left, clusters + left
    covered = max(1 << (size - mask.bit_count()) for mask, _ in kept)
    return clusters, clusters + (1 << size) - covered


def _largest(cubes: Iterable[Cube]) -> list[Cube]:
    """The cubes that do not lie in another cube."""
    kept: list[Cube] = []
    for mask, value in sorted(set(cubes), key=lambda cube: (cube[0].bit_count(), cube)):
        if not any(m & mask == m and value & m == x for m, x in kept):
            kept.append((mask, value))
    return kept


def _clusters(cubes: list[Cube]) -> int:
    """The number of groups of cubes that meet, directly or through other cubes."""
    waiting = set(cubes)
    number = 0
    while waiting:
        number += 1
        reached = [waiting.pop()]
        while reached:
            mask, value = reached.pop()
            near = {(m, x) for m, x in waiting if not (x ^ value) & m & mask}
            waiting -= near
            reached += near
    return number


def _outside(size: int, fixed: int, cubes: list[Cube], steps: list[int]) -> int | None:
    """The number of sign vectors in no cube; None if counting them takes too many steps.

    The bits in `fixed` are already decided.
    """
    if not cubes:
        return 1 << (size - fixed.bit_count())
    if any(not mask for mask, _ in cubes):
        return 0
    steps[0] -= len(cubes)
    if steps[0] < 0:
        return None
    mask, _ = min(cubes, key=lambda cube: cube[0].bit_count())
    bit = mask & -mask
    total = 0
    for chosen in (0, bit):
        rest = [(m & ~bit, x & ~bit) for m, x in cubes if not m & bit or x & bit == chosen]
        part = _outside(size, fixed | bit, rest, steps)
        if part is None:
            return None
        total += part
    return total
