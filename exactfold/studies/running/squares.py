"""Recipes of the paper's ensemble: random squares, each with its size and its own seed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.studies.running.study import Recipe

DENOMINATOR = 1024
"""Coordinates are multiples of 1/`DENOMINATOR`."""

_SIZES, _MOST = 100, 10_000_000


def square_recipes(seed: int, numbers: Mapping[int, int]) -> Iterator[Recipe]:
    """Yields, for each n, `numbers[n]` random squares with n interior vertices.

    Square k has the seed (100 seed + n) 10^7 + k of `random_square`. So no two sizes or seeds of a
    study share points, and a longer list begins with the squares of a shorter one. Raises
    `UsageError` for more than 10^7 squares of a size, and for sizes that are not from 1 to 99.

    >>> [recipe["seed"] for recipe in square_recipes(0, {2: 1, 3: 2})]
    [20000000, 30000000, 30000001]
    """
    if seed < 0:
        raise UsageError(f"the seed must not be negative: {seed}")
    for size, number in numbers.items():
        if not 0 < size < _SIZES:
            raise UsageError(f"random squares have from 1 to {_SIZES - 1} vertices, not {size}")
        if not 0 <= number <= _MOST:
            raise UsageError(f"a study has up to 10^7 squares of a size, not {number}")
    return (
        {"interior": size, "seed": (_SIZES * seed + size) * _MOST + k, "denominator": DENOMINATOR}
        for size, number in numbers.items()
        for k in range(number)
    )


def square_of(recipe: Recipe) -> CreasePattern:
    """The random square of a recipe; it is the same on every machine."""
    return random_square(int(recipe["interior"]), int(recipe["seed"]), int(recipe["denominator"]))
