"""Maximal sets of modes without a common vertex, counted by trying all sets."""

from __future__ import annotations

import random
from collections import Counter
from itertools import combinations
from math import prod

import pytest

from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels import components as panel_components
from exactfold.checker.panels.components import components, times
from exactfold.checker.sheets.panels import connected

Weighted = list[tuple[tuple[int, ...], int]]


def by_trying(supports: Weighted, free: int) -> dict[str, int]:
    apart = [
        chosen
        for size in range(len(supports) + 1)
        for chosen in combinations(range(len(supports)), size)
        if all(not set(supports[i][0]) & set(supports[j][0]) for i, j in combinations(chosen, 2))
    ]
    found = Counter[int]()
    for chosen in apart:
        if not any(set(chosen) < set(other) for other in apart):
            found[len(chosen) + free] += prod(supports[k][1] for k in chosen)
    return {str(dimension): found[dimension] for dimension in sorted(found)}


@pytest.mark.parametrize("seed", range(40))
def test_components(seed: int) -> None:
    """Few large supports, or a path of pairs with some more, where many go together."""
    rng = random.Random(seed)
    supports: Weighted = []
    if seed % 2:
        supports = [((k, k + 1), rng.randint(1, 4)) for k in range(5)]
    for _ in range(rng.randint(0, 7 if seed % 2 == 0 else 4)):
        vertices = rng.sample(range(9), rng.randint(1, 2 if seed % 2 else 4))
        supports.append((tuple(sorted(vertices)), rng.randint(1, 4)))
    rng.shuffle(supports)
    free = rng.randint(0, 2)
    assert components(supports, free) == by_trying(supports, free)


def test_sets_that_are_not_maximal_are_told_deep_in_the_search() -> None:
    vertices = [(5, 8, 10), (0, 2), (7, 10), (0, 7, 8), (4, 5, 7), (0, 3), (2,), (6, 10, 15), (0,)]
    supports: Weighted = [(chosen, 1) for chosen in [*vertices, (1, 6, 7)]]
    assert components(supports, 0) == by_trying(supports, 0) == {"2": 1, "3": 5, "4": 4}


def test_the_bound_of_the_search(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel_components, "MOST_SETS", 2)
    assert components([((1, 2), 3)], 0) == {"1": 3}
    monkeypatch.setattr(panel_components, "MOST_SETS", 1)
    with pytest.raises(LimitError, match="the steps to the components, 2, are more than the limit"):
        components([((1, 2), 3)], 0)


def test_products() -> None:
    assert times({"1": 2, "3": 1}, [{0: 1}, {1: 3, 2: 5}]) == {"2": 6, "3": 10, "4": 3, "5": 5}
    assert times({"10": 1, "9": 2}, []) == {"9": 2, "10": 1}


def test_parts_of_a_graph() -> None:
    near = {5: [2, 9], 2: [5], 7: [9], 1: [8], 8: [1, 3], 3: [8]}
    assert connected(near) == [{1: [8], 3: [8], 8: [1, 3]}, {2: [5], 5: [2, 9]}, {7: [9]}]
