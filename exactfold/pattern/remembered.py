"""Keeps values that were computed from a pattern, or from a sheet that was read, in it."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, Final, ParamSpec, TypeVar

REMEMBERED: Final = "_remembered"
"""The attribute that holds these values."""

S = TypeVar("S", bound=object)
P = ParamSpec("P")
R = TypeVar("R")


def remembered(
    function: Callable[Concatenate[S, P], R],
) -> Callable[Concatenate[S, P], R]:
    """A function of a pattern, or of another fixed object, that computes each value once for it.

    Solvers, certifiers and signs need the same forms. A pattern does not change, so the values are
    stored in the pattern object like its cached properties, and disappear with it. They are not
    pickled. Values are shared, so callers must not change them.

    >>> from exactfold.pattern.families import two_vertex
    >>> corners = remembered(lambda pattern, k: [object()] * k)
    >>> pattern = two_vertex()
    >>> corners(pattern, 2) is corners(pattern, 2), corners(two_vertex(), 2) is corners(pattern, 2)
    (True, False)
    """

    @wraps(function)
    def wrapped(pattern: S, /, *args: P.args, **kwargs: P.kwargs) -> R:
        known = vars(pattern).setdefault(REMEMBERED, {})
        key = (function, args, tuple(kwargs.items()))
        if key not in known:
            known[key] = function(pattern, *args, **kwargs)
        value: R = known[key]
        return value

    return wrapped
