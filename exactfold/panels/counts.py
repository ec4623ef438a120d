"""Numbers of components of motions, by dimension."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import TypeAlias

from exactfold.panels.count_document import ByDimension

Counts: TypeAlias = Mapping[int, int]
"""{dimension: number of components}."""


def of_each_dimension(dimensions: Iterable[int]) -> dict[int, int]:
    """The number of components of each dimension, given the dimensions of all.

    >>> of_each_dimension([2, 1, 1])
    {1: 2, 2: 1}
    """
    return dict(sorted(Counter(dimensions).items()))


def product(counts: Iterable[Counts | None], free: int) -> Counts | None:
    """The components of independent parts together; None if those of some part are not known.

    Dimensions add, and numbers multiply. `free` folds move by themselves.

    >>> product([{1: 2, 2: 1}, {1: 3}], free=1)
    {3: 6, 4: 3}
    """
    total: dict[int, int] = {free: 1}
    for part in counts:
        if part is None:
            return None
        joined: dict[int, int] = {}
        for a, m in total.items():
            for b, n in part.items():
                joined[a + b] = joined.get(a + b, 0) + m * n
        total = joined
    return dict(sorted(total.items()))


def by_dimension(counts: Counts | None) -> ByDimension | None:
    """The numbers for JSON, whose keys are texts; None if they are not known."""
    return None if counts is None else {str(k): n for k, n in counts.items()}
