"""Components of the motions of a sheet of panels: maximal sets of modes with no common vertex."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from ..core import limits
from ..core.reading import at_most

MOST_SETS = limits.MOST_SETS

Weighted = Sequence[tuple[tuple[int, ...], int]]
"""For each support its vertices, and the number of its modes."""


def components(supports: Weighted, free: int) -> dict[str, int]:
    """The numbers of components, as {dimension: number}.

    A component is the span of a maximal set of modes with no common vertex. `free` is the number of
    folds that are in no condition; each adds 1 to every dimension. Supports are grouped by common
    vertices, and each group is treated independently.
    """
    total = {free: 1}
    for group in _groups(supports):
        counts: dict[int, int] = {}
        for chosen in maximal_sets([supports[k][0] for k in group]):
            number = 1
            for k in chosen:
                number *= supports[group[k]][1]
            counts[len(chosen)] = counts.get(len(chosen), 0) + number
        total = _product(total, counts)
    return {str(dimension): total[dimension] for dimension in sorted(total)}


def times(counts: dict[str, int], others: Sequence[Mapping[int, int]]) -> dict[str, int]:
    """The components of independent parts together: dimensions add, numbers multiply."""
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
    """Group the supports: two are in one group if a chain of common vertices joins them."""
    users: dict[int, list[int]] = {}
    for k, (vertices, _) in enumerate(supports):
        for v in vertices:
            users.setdefault(v, []).append(k)
    groups, seen = [], set()
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
        groups.append(group)
    return groups


def maximal_sets(groups: list[tuple[int, ...]]) -> Iterator[list[int]]:
    """Yield each maximal set of supports with no common vertex.

    This is the search of Bron and Kerbosch, with one bit for each support. The supports in
    `open_ones` may still be added; those in `closed` were tried before.
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
