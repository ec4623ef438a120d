"""Noise levels to propose where no level is believed: the widest gaps between near relations."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import sqrt
from typing import Final

from exactfold.exact.numbers import decimal_near
from exactfold.pattern.drawing.meant.noise import TOLERANCE

_WIDE: Final = 1.25
"""A gap is proposed if the next defect is this many times as large."""
_FEWEST: Final = 3
_SHARE: Final = 10
"""At least one in so many of the near relations lies below a gap that is proposed."""
_MOST: Final = 4
_VAST: Final = 10.0
"""In a gap wider than this a second level is proposed, near its upper end."""
_UPPER: Final = 0.7
_TIMES_NOISE: Final = (10, 100)


def proposed_levels(defects: Sequence[float], beyond: float) -> list[float]:
    """Noise levels, for `--noise`, that separate the defects at their widest gaps, widest first.

    Relations that are no longer near are missed by at least `beyond`. A level accepts defects up to
    `TOLERANCE` times itself.

    >>> proposed_levels([1e-6, 2e-6, 3e-6, 4e-6, 1e-3, 1.1e-3], 2e-3)
    [6e-06, 7e-05, 0.00015, 3e-07]
    """
    missed = sorted(defect for defect in defects if 0 < defect < beyond)
    gaps = []
    for k, (below, above) in enumerate(pairwise([*missed, beyond]), 1):
        if above >= _WIDE * below and k >= max(_FEWEST, len(missed) / _SHARE):
            gaps.append((above / below, below, above))
    levels = []
    for quotient, below, above in sorted(gaps, reverse=True)[:_MOST]:
        levels.append(_level(below, above, sqrt(below * above)))
        if quotient > _VAST:
            levels.append(_level(below, above, _UPPER * above))
    return levels


def loop_levels(off: float) -> list[float]:
    """Noise levels, for `--noise`, that may explain that a loop of folds nearly closes.

    The product of its gains misses 1 by `off`. That is the noise, times a factor that is larger the
    shorter the folds are.

    >>> loop_levels(2.6e-8)
    [3e-09, 3e-10]
    """
    return [float(decimal_near(Fraction(off / times), 1)) for times in _TIMES_NOISE]


def _level(below: float, above: float, wanted: float) -> float:
    """A short number near the wanted one that accepts what is below a gap, and nothing above."""
    digits = 1
    while True:
        level = float(decimal_near(Fraction(wanted / TOLERANCE), digits))
        if below <= TOLERANCE * level < above:
            return level
        digits += 1
