"""Exact binomial intervals and tests that compare two samples."""

from __future__ import annotations

LEVEL = 0.95
"""Of intervals."""

AGREE = 0.01
"""Two samples agree where the test would be as far off with at least this probability."""


def interval(found: int, number: int, level: float = LEVEL) -> tuple[float, float]:
    """The interval of Clopper and Pearson for a probability, from `found` of `number` trials.

    Whatever the probability is, the interval holds it in at least `level` of all samples. (0, 1)
    without trials.

    >>> tuple(round(x, 4) for x in interval(0, 100)), tuple(round(x, 4) for x in interval(17, 1000))
    ((0.0, 0.0362), (0.0099, 0.0271))
    """
    from scipy.stats import binomtest

    if not number:
        return 0.0, 1.0
    bounds = binomtest(found, number).proportion_ci(level, method="exact")
    return float(bounds.low), float(bounds.high)


def same_probability(first: tuple[int, int], second: tuple[int, int]) -> float:
    """Fisher's exact test of two samples (found, number): the two-sided p-value.

    The probability of samples as different as these if one probability is behind both.

    >>> round(same_probability((17, 1000), (28, 1000)), 3)
    0.131
    """
    from scipy.stats import fisher_exact

    table = [[found, number - found] for found, number in (first, second)]
    return float(fisher_exact(table).pvalue)


def percent(part: float) -> str:
    """A share in per cent, with two digits that count.

    >>> percent(0.0271), percent(0.885), percent(0.0), percent(0.00031), percent(1.0)
    ('2.7 %', '88 %', '0 %', '0.031 %', '100 %')
    """
    value = 100 * part
    return f"{value:.0f} %" if value >= 9.95 or not value else f"{value:.2g} %"


def interval_text(found: int, number: int) -> str:
    """The interval of a share in per cent.

    >>> interval_text(17, 1000)
    '0.99 % to 2.7 %'
    """
    low, high = interval(found, number)
    return f"{percent(low)} to {percent(high)}"


def agreement(p: float) -> str:
    """Whether a test with this p-value lets two samples agree."""
    return "agree" if p >= AGREE else "differ"
