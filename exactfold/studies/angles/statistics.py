"""Statistics of the angles between branches: distributions by size, resampled and compared.

Pairs of one square are not independent, but squares are. So intervals come from squares drawn again
with replacement (bootstrap), and the test of two sizes from squares exchanged between them
(permutation), with a fixed seed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.studies.angles.pairs import BINS
from exactfold.studies.running.study import Row

RESAMPLED: Final = 400
"""The number of bootstrap samples, and of permutations."""

WIDTH: Final = np.pi / 2 / BINS
"""The width of a bin."""

TAIL: Final = BINS // 4
"""The tail consists of so many bins next to 0: up to pi / 8."""

CENTRE: Final = BINS // 8
"""Orthogonal are so many bins next to a right angle: up to pi / 16 from it."""

LEVEL: Final = 0.01
"""Sizes differ if a p-value is below this."""

_FIT = 3 * BINS // 4
"""The shape is fitted in so many bins: from 0 to 3 pi / 8."""
_POWERS = np.arange(0.05, 4.0001, 0.05)


@dataclass(frozen=True)
class AnglesOfSize:
    """The squares of one size: the share of pairs in each bin, one row for each square."""

    size: int
    shares: FloatArray
    squares: FloatArray
    pairs: int
    unclear: int

    @property
    def mean(self) -> FloatArray:
        """The mean distribution; every square has the same weight."""
        return np.asarray(self.shares.mean(axis=0))

    def resampled(self, values: FloatArray) -> FloatArray:
        """Bootstrap means of one value per square, over squares drawn again with replacement."""
        number = len(values)
        source = np.random.default_rng([self.size, number])
        weights = source.multinomial(number, np.full(number, 1 / number), size=RESAMPLED)
        return np.asarray(weights @ values / number)


def angles_by_size(rows: Iterable[Row]) -> list[AnglesOfSize]:
    """The rows that have pairs of branches, by size."""
    groups: dict[int, list[Row]] = defaultdict(list)
    for row in rows:
        if row["angles"] is not None and sum(row["angles"]):
            groups[row["interior"]].append(row)
    return [
        AnglesOfSize(
            size,
            np.array([np.array(r["angles"]) / sum(r["angles"]) for r in group]),
            np.array([r["mean_square"] for r in group]),
            sum(sum(r["angles"]) for r in group),
            sum(r["unclear"] for r in group),
        )
        for size, group in sorted(groups.items())
    ]


def uniform(size: int) -> FloatArray:
    """The share of each bin for independent uniform lines in `size` + 1 dimensions.

    The density of the angle is proportional to sin^(size - 1) (Cai, Fan and Jiang, Distributions of
    angles in random packing on spheres, JMLR 14 (2013), Lemma 12).

    >>> [round(float(x), 6) for x in uniform(1)[:2]], round(float(uniform(6).sum()), 12)
    ([0.015625, 0.015625], 1.0)
    """
    from scipy.special import betainc

    ends = np.sin(np.arange(BINS + 1) * WIDTH) ** 2
    return np.asarray(np.diff(betainc(size / 2, 0.5, ends)))


def ends_of(values: FloatArray) -> tuple[float, float]:
    """The ends of the interval that contains the middle 95 % of the values."""
    low, high = np.quantile(values, [0.025, 0.975])
    return float(low), float(high)


def between(values: FloatArray, digits: int = 3) -> str:
    """The ends of the middle 95 % of the values, as a text."""
    low, high = ends_of(values)
    return f"{low:.{digits}f} to {high:.{digits}f}"


def tail_power(means: FloatArray) -> FloatArray:
    """For each distribution, the p for which log share = a - b x^p fits best; x is from pi / 2.

    Least squares, weighted by the shares, in the bins from 0 to 3 pi / 8, for p from 0.05 to 4 in
    steps of 0.05. An exponential tail has p = 1, a Gaussian tail p = 2.
    """
    x = np.pi / 2 - (np.arange(_FIT) + 0.5) * WIDTH
    shares = np.maximum(means[:, :_FIT], 1e-12)
    target, misfits = np.log(shares), []
    for power in _POWERS:
        z = x**power
        total = shares.sum(axis=1)
        mz, mt = (shares @ z) / total, (shares * target).sum(axis=1) / total
        var = (shares @ z**2) / total - mz**2
        cov = (shares * target * z).sum(axis=1) / total - mz * mt
        spread = (shares * target**2).sum(axis=1) / total - mt**2
        misfits.append(spread - cov**2 / var)
    return np.asarray(_POWERS[np.argmin(misfits, axis=0)])


def distance(first: FloatArray, second: FloatArray) -> FloatArray:
    """The total variation distance of distributions, along the last axis."""
    return np.asarray(np.abs(first - second).sum(axis=-1) / 2)


def apart(first: FloatArray, second: FloatArray) -> FloatArray:
    """How far distributions are apart: total variation, and the difference of their tails.

    >>> apart(np.eye(BINS)[0], np.eye(BINS)[-1])
    array([1., 1.])
    """
    tails = np.abs((first - second)[..., :TAIL].sum(axis=-1))
    return np.stack([distance(first, second), tails], axis=-1)


def exchanged(
    first: AnglesOfSize, second: AnglesOfSize, numbers: tuple[int, int] | None = None
) -> FloatArray:
    """How far random choices of `numbers` squares from both sizes together are `apart`.

    By default these are the numbers of squares of the two sizes, so that squares are exchanged.
    """
    number, other = numbers or (len(first.shares), len(second.shares))
    both = np.vstack([first.shares, second.shares])
    source = np.random.default_rng([first.size, second.size])
    distances = []
    for _ in range(RESAMPLED):
        order = source.permutation(len(both))
        some, others = both[order[:number]], both[order[number : number + other]]
        distances.append(apart(some.mean(axis=0), others.mean(axis=0)))
    return np.array(distances)


def p_values(seen: FloatArray, by_chance: FloatArray) -> FloatArray:
    """For each column, the share of random values at least as large as the seen one, plus itself.

    >>> p_values(np.array([0.5, 1.0]), np.array([[0.25, 0.5], [0.5, 0.5], [0.75, 0.5]]))
    array([0.75, 0.25])
    """
    return np.asarray(((by_chance >= seen).sum(axis=0) + 1) / (len(by_chance) + 1))
