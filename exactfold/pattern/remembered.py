"""Keeps values that were computed from a pattern in the pattern itself."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

from exactfold.pattern.crease_pattern import CreasePattern

P = ParamSpec("P")
R = TypeVar("R")


def remembered(
    function: Callable[Concatenate[CreasePattern, P], R],
) -> Callable[Concatenate[CreasePattern, P], R]:
    """A function of a pattern that computes each value once for each pattern object.

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
    def wrapped(pattern: CreasePattern, /, *args: P.args, **kwargs: P.kwargs) -> R:
        known = vars(pattern).setdefault("_remembered", {})
        key = (function, args, tuple(kwargs.items()))
        if key not in known:
            known[key] = function(pattern, *args, **kwargs)
        value: R = known[key]
        return value

    return wrapped
