"""What `exactfold check --list` prints of a certificate that holds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from rich.console import Group
from rich.text import Text

from exactfold.app.report.count import branch_table
from exactfold.exact.numbers import decimal_above, decimal_below, decimal_near, format_rational

if TYPE_CHECKING:
    from exactfold.branches.values.branch import Bounds, Branch

DIGITS = 12
"""The bounds of a height have this many significant digits."""

ANGLE_DIGITS = 6


def listing_report(branches: Sequence[Branch], *, heights: bool) -> Group:
    """The branches as `count` lists them; with `heights` also the heights and angles of each."""
    if not branches:
        return Group("", Text("No way to fold is a single line, so none is listed."))
    parts: list[Any] = ["", *branch_table(branches)]
    if heights:
        parts += ["", *(Text(line) for line in _heights(branches))]
    return Group(*parts)


def _heights(branches: Sequence[Branch]) -> Iterator[str]:
    yield (
        "Heights are given by bounds that are rounded outwards. Angles are approximate: how fast "
        "the folds start to bend, relative to the largest."
    )
    for k, branch in enumerate(branches, 1):
        bounds = ", ".join(f"{v}: {bounds_text(b)}" for v, b in sorted(branch.heights.items()))
        angles = ", ".join(f"{fold} {angle}" for fold, angle in angles_of(branch).items())
        yield f"way {k}, heights: {bounds}"
        yield f"way {k}, angles: {angles}"


def bounds_text(bounds: Bounds) -> str:
    """Bounds as decimals, rounded outwards; a single number if they are equal and it is short.

    >>> bounds_text((Fraction(1, 2), Fraction(1, 2))), bounds_text((Fraction(1, 3), Fraction(2, 3)))
    ('1/2', '0.333333333333 to 0.666666666667')
    """
    low, high = bounds
    if low == high and len(exact := format_rational(low)) <= DIGITS:
        return exact
    return f"{decimal_below(low, DIGITS)} to {decimal_above(high, DIGITS)}"


def angles_of(branch: Branch) -> dict[str, str]:
    """How fast each fold i-j starts to bend, relative to the largest; a valley is positive.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> angles_of(count_branches("single-vertex-4")["+"])["0-4"]
    '-1'
    """
    angles = branch.fold_angles
    largest = angles.largest or Fraction(1)
    return {
        f"{i}-{j}": decimal_near(bend / largest, ANGLE_DIGITS)
        for (i, j), bend in sorted(angles.bends.items())
    }
