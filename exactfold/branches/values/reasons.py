"""The texts of `Branch.reason`."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from exactfold._support.plurals import agreeing
from exactfold.exact.numbers import decimal_above


def named(vertices: Sequence[int]) -> str:
    """Some vertices by their indices.

    >>> named([4]), named([4, 5, 6, 7, 8])
    ('vertex 4', 'vertices 4, 5, 6 and 2 more')
    """
    more = f" and {len(vertices) - 3} more" if len(vertices) > 3 else ""
    names = ", ".join(map(str, vertices[:3]))
    return f"{agreeing(len(vertices), 'vertex')} {names}{more}"


def proved(error: Fraction, flat: Sequence[int], reduced: bool, noun: str = "branch") -> str:
    """The text for a branch whose signs are all proved.

    The vertices in `flat` have sign 0 instead of the sign asked for.
    """
    what, kind = "these signs", "simple solution"
    if flat:
        what = f"the signs shown, 0 at {named(flat)}, where it is flat"
        kind = f"solution of multiplicity {2 ** len(flat) if len(flat) < 10 else f'2^{len(flat)}'}"
    inside = " of the pattern without its triangulated triangles" if reduced else ""
    where = f" within {decimal_above(error, 1)} of the heights given, in the norm of gradients"
    if not error:
        where = ", and the heights given are exact"
    return f"exactly one {noun} has {what}; it is a {kind}{inside}{where}"


def undecided(error: Fraction, loose: Sequence[int]) -> str:
    """The text for a solution that may be flat at some vertices."""
    within = decimal_above(error, 1)
    return f"the only solution with these signs is flat to within {within} at {named(loose)}"


def not_found(failed: Sequence[int]) -> str:
    """The text for heights that passed no test, with the vertices at which they failed,
    if known.
    """
    where = f": {named(failed)}" if failed else ""
    return f"no heights with curvature above the target everywhere were found{where}"
