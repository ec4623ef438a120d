"""Zeros and least values of functions of one number, in floats, by SciPy.

SciPy's optimisation is loaded where one is first sought: it takes as long to load as a small sheet
to follow, and most loops are proved without it.
"""

from __future__ import annotations

from collections.abc import Callable

_WITHIN = 1e-15


def zero_of(function: Callable[[float], float], low: float, high: float) -> float:
    """Where a function is zero that has different signs at two numbers, by Brent's method."""
    from scipy.optimize import brentq

    return float(brentq(function, low, high, xtol=_WITHIN))


def least_of(
    function: Callable[[float], float], low: float, high: float, within: float
) -> tuple[float, float]:
    """Where a function is least between two numbers, up to `within`, and its value there."""
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        function, bounds=(low, high), method="bounded", options={"xatol": within}
    )
    return float(found.x), float(found.fun)
