"""What was computed of a pattern, kept with the pattern itself."""

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

    Solvers, certifiers and signs ask for the same forms. As patterns do not change, what follows
    from one is kept in the object, as its cached properties are, and goes with it; it is not
    pickled. Values are shared, so they must not be changed.

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
