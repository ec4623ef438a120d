"""Components of the motions of a sheet of panels: maximal sets of modes without common vertex."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ..core import limits
from ..core.reading import at_most

MOST_SETS = limits.MOST_SETS

Weighted = Sequence[tuple[tuple[int, ...], int]]
"""The vertices of each support, and how many modes it stands for."""


def components(supports: Weighted, free: int) -> dict[str, int]:
    """{dimension: number} of the spans of maximal sets of modes without a common vertex.

    `free` folds in no condition add to each dimension. Supports that share no vertex, directly or
    by way of others, are chosen independently.
    """
    total = {free: 1}
    for group in _groups(supports):
        found: dict[int, int] = {}
        for chosen in _maximal([supports[k][0] for k in group]):
            number = 1
            for k in chosen:
                number *= supports[group[k]][1]
            found[len(chosen)] = found.get(len(chosen), 0) + number
        total = _product(total, found)
    return {str(dimension): total[dimension] for dimension in sorted(total)}


def times(counts: dict[str, int], others: Sequence[Mapping[int, int]]) -> dict[str, int]:
    """The components of independent parts: dimensions add, numbers multiply."""
    total = {int(dimension): number for dimension, number in counts.items()}
    for other in others:
        total = _product(total, other)
    return {str(dimension): total[dimension] for dimension in sorted(total)}


def _product(total: Mapping[int, int], other: Mapping[int, int]) -> dict[int, int]:
    product: dict[int, int] = {}
    for a, m in total.items():
        for b, n in other.items():
            product[a + b] = product.get(a + b, 0) + m * n
    return product


def _groups(supports: Weighted) -> list[list[int]]:
    """The supports, those together that are joined by common vertices."""
    users: dict[int, list[int]] = {}
    for k, (vertices, _) in enumerate(supports):
        for v in vertices:
            users.setdefault(v, []).append(k)
    found, seen = [], set()
    for start in range(len(supports)):
        if start in seen:
            continue
        seen.add(start)
        group, stack = [], [start]
        while stack:
            k = stack.pop()
            group.append(k)
            for v in supports[k][0]:
                fresh = [other for other in users.pop(v, ()) if other not in seen]
                seen.update(fresh)
                stack += fresh
        found.append(group)
    return found


def _maximal(groups: list[tuple[int, ...]]) -> Iterator[list[int]]:
    """Sets of supports without a common vertex to which no other can be added.

    Bron and Kerbosch's search, with bits for supports: `open_ones` may still be added, `closed`
    were tried before.
    """
    sets = [set(vertices) for vertices in groups]
    apart = [
        sum(1 << k for k, other in enumerate(sets) if k != j and sets[j].isdisjoint(other))
        for j in range(len(sets))
    ]
    stack: list[tuple[list[int], int, int]] = [([], (1 << len(sets)) - 1, 0)]
    steps = 0
    while stack:
        steps += 1
        at_most(steps, MOST_SETS, "the steps to the components", "MOST_SETS")
        chosen, open_ones, closed = stack.pop()
        if not open_ones:
            if not closed:
                yield chosen
            continue
        pivot = max(_bits(open_ones | closed), key=lambda k: (apart[k] & open_ones).bit_count())
        for k in _bits(open_ones & ~apart[pivot]):
            stack.append(([*chosen, k], open_ones & apart[k], closed & apart[k]))
            open_ones &= ~(1 << k)
            closed |= 1 << k


def _bits(mask: int) -> Iterator[int]:
    while mask:
        low = mask & -mask
        yield low.bit_length() - 1
        mask ^= low
