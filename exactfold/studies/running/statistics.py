"""Exact binomial intervals and tests that compare two samples."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import floor, log10

LEVEL = 0.95
"""The confidence level of intervals."""

AGREE = 0.01
"""Two samples agree if chance makes them differ as much with at least this probability."""


def interval(successes: int, number: int, level: float = LEVEL) -> tuple[float, float]:
    """The interval of Clopper and Pearson for a probability, from `successes` of `number` trials.

    For any probability, the interval contains it in at least `level` of all samples. Without trials
    it is (0, 1).

    >>> tuple(round(x, 4) for x in interval(0, 100)), tuple(round(x, 4) for x in interval(17, 1000))
    ((0.0, 0.0362), (0.0099, 0.0271))
    """
    from scipy.stats import binomtest

    if not number:
        return 0.0, 1.0
    bounds = binomtest(successes, number).proportion_ci(level, method="exact")
    return float(bounds.low), float(bounds.high)


def same_probability(first: tuple[int, int], second: tuple[int, int]) -> float:
    """Fisher's exact test of two samples (successes, number): the two-sided p-value.

    It is the probability of samples as different as these if both have the same probability.

    >>> round(same_probability((17, 1000), (28, 1000)), 3)
    0.131
    """
    from scipy.stats import fisher_exact

    table = [[successes, number - successes] for successes, number in (first, second)]
    return float(fisher_exact(table).pvalue)


@dataclass(frozen=True)
class Decay:
    """Shares ratio^k fitted to samples by k, and the p-value of a likelihood-ratio test."""

    ratio: float
    p: float


def decay(samples: Mapping[int, tuple[int, int]]) -> Decay | None:
    """The most likely ratio if the share of sample k is ratio^k, for k >= 1.

    `p` is the probability of samples that fit worse, by the chi-squared distribution of the
    likelihood ratio, whose degrees of freedom are one less than the number of samples. The result
    is None for fewer than two samples, and if all shares are 0 or all are 1.

    >>> fit = decay({1: (500, 1000), 2: (260, 1000), 3: (120, 1000)})
    >>> round(fit.ratio, 3), round(fit.p, 2)
    (0.501, 0.69)
    """
    from scipy.optimize import minimize_scalar
    from scipy.special import xlogy
    from scipy.stats import chi2

    used = {k: sample for k, sample in samples.items() if k >= 1}
    total = sum(successes for successes, _ in used.values())
    if len(used) < 2 or not 0 < total < sum(number for _, number in used.values()):
        return None

    def surprise(share: float, successes: int, number: int) -> float:
        return -float(xlogy(successes, share) + xlogy(number - successes, 1 - share))

    def misfit(ratio: float) -> float:
        return sum(surprise(ratio**k, *sample) for k, sample in used.items())

    best = minimize_scalar(
        misfit, bounds=(1e-9, 1 - 1e-9), method="bounded", options={"xatol": 1e-9}
    )
    least = sum(
        surprise(successes / number, successes, number) for successes, number in used.values()
    )
    twice = max(0.0, 2 * (float(best.fun) - least))
    return Decay(float(best.x), float(chi2.sf(twice, len(used) - 1)))


def one_share(samples: Iterable[tuple[int, int]]) -> float:
    """Pearson's chi-squared test that samples (successes, number) have one share: the p-value.

    It is 1 if there is nothing to compare: fewer than two samples, or all shares 0, or all 1.

    >>> round(one_share([(50, 100), (60, 100), (70, 100)]), 3), one_share([(0, 10), (0, 20)])
    (0.016, 1.0)
    """
    from scipy.stats import chi2_contingency

    table = [[successes, number - successes] for successes, number in samples if number]
    if len(table) < 2 or not all(map(sum, zip(*table, strict=True))):
        return 1.0
    return float(chi2_contingency(table, correction=False).pvalue)


def trend(samples: Mapping[int, tuple[int, int]]) -> tuple[float, float]:
    """The test of Cochran and Armitage for shares that change with a number: z and its p-value.

    z is positive if samples (successes, number) of larger keys have larger shares. The p-value is
    two-sided and uses the normal distribution. If nothing changes, the result is (0, 1).

    >>> z, p = trend({5: (12, 1000), 6: (33, 1000), 7: (43, 1000)})
    >>> round(z, 2), f"{p:.1e}"
    (4.11, '4.0e-05')
    """
    from scipy.stats import norm

    total = sum(number for _, number in samples.values())
    share = sum(successes for successes, _ in samples.values()) / total if total else 0.0
    mean = sum(k * number for k, (_, number) in samples.items()) / total if total else 0.0
    spread = sum(number * (k - mean) ** 2 for k, (_, number) in samples.items())
    variance = share * (1 - share) * spread
    if not variance:
        return 0.0, 1.0
    z = sum(successes * (k - mean) for k, (successes, _) in samples.items()) / variance**0.5
    return float(z), float(2 * norm.sf(abs(z)))


def p_text(p: float) -> str:
    """A p-value with two significant digits.

    >>> p_text(0.4519), p_text(0.0), p_text(1.0)
    ('0.45', '< 1e-15', '1')
    """
    return f"{p:.2g}" if p >= 1e-15 else "< 1e-15"


def p_equals(p: float) -> str:
    """A p-value as an equation.

    >>> p_equals(0.4519), p_equals(0.0)
    ('p = 0.45', 'p < 1e-15')
    """
    text = p_text(p)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def verdict(holds: bool | None) -> str:
    """The verdict of a number on a sentence; None means that the number does not decide.

    >>> verdict(True), verdict(False), verdict(None)
    ('agreed', 'not agreed', 'not decided')
    """
    return {True: "agreed", False: "not agreed", None: "not decided"}[holds]


def percent(part: float) -> str:
    """A share in per cent, with two significant digits, without the sign %.

    >>> percent(0.0271), percent(0.885), percent(0.0), percent(0.00031), percent(1.0)
    ('2.7', '88', '0', '0.031', '100')
    """
    value = 100 * part
    return f"{value:.0f}" if value >= 9.95 or not value else f"{value:.2g}"


def interval_text(successes: int, number: int) -> str:
    """The interval of a share in per cent, with as many digits as its width justifies.

    >>> interval_text(17, 1000), interval_text(7131, 20000), interval_text(8, 50)
    ('0.99 to 2.7', '35.0 to 36.3', '7.2 to 29')
    """
    ends = interval(successes, number)
    places = max(0, 1 - floor(log10(100 * (ends[1] - ends[0]))))
    low, high = (percent(x) if 100 * x < 9.95 else f"{100 * x:.{places}f}" for x in ends)
    return f"{low} to {high}"


def agreement(p: float) -> str:
    """Whether two samples agree or differ, by the p-value of a test."""
    return "agree" if p >= AGREE else "differ"
