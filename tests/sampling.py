"""Parameters of tests of which some are enough for every run."""

from collections.abc import Iterable
from typing import Any

import pytest


def slow_after(number: int, values: Iterable[Any]) -> list[Any]:
    """All values as parameters; those after the first `number` are for slow tests only."""
    chosen = [*values]
    return chosen[:number] + [
        pytest.param(*(value if isinstance(value, tuple) else (value,)), marks=pytest.mark.slow)
        for value in chosen[number:]
    ]
