"""Zeros and minima of functions of one variable, in floats, by SciPy.

SciPy's optimisation is loaded when it is first needed. Loading it takes as long as following a
small sheet, and most loops are proved without it.
"""

from __future__ import annotations

from collections.abc import Callable

_WITHIN = 1e-15


def zero_of(function: Callable[[float], float], low: float, high: float) -> float:
    """A zero of a function between two numbers at which it has different signs, by
    Brent's method.
    """
    from scipy.optimize import brentq

    return float(brentq(function, low, high, xtol=_WITHIN))


def least_of(
    function: Callable[[float], float], low: float, high: float, within: float
) -> tuple[float, float]:
    """The place between two numbers where a function is least, up to `within`, and its
    value there.
    """
    from scipy.optimize import minimize_scalar

    minimum = minimize_scalar(
        function, bounds=(low, high), method="bounded", options={"xatol": within}
    )
    return float(minimum.x), float(minimum.fun)
