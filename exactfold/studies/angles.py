"""Appendix D of the paper: how the branches of random squares lie in the space of fold angles.

A row is one random square: its pairs of branches by their angle, as lines, in bins of pi / 128.
What the paper says of these angles is tested with numbers. Pairs of one square are not
independent, but squares are: intervals come from squares drawn again with replacement (bootstrap),
and the test of two sizes from squares exchanged between them (permutation), with a fixed seed.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.studies.lines import Lines
from exactfold.studies.pair_angles import BINS, pair_angles
from exactfold.studies.squares import square_of, square_recipes
from exactfold.studies.study import Cell, Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.table1 import PAPER
from exactfold.verdict import PROVED

RESAMPLED: Final = 400
"""Bootstrap samples, and permutations."""

_WIDTH = np.pi / 2 / BINS
_CENTRE = BINS // 8
"""Bins next to a right angle that are called orthogonal here: up to pi / 16 from it."""
_TAIL = BINS // 4
"""Bins next to 0 that are called a tail: up to pi / 8."""
_FIT = 3 * BINS // 4
"""Bins whose shape is fitted: from 0 to 3 pi / 8."""
_POWERS = np.arange(0.05, 4.0001, 0.05)


def row(recipe: Recipe) -> dict[str, Any]:
    """The angles of all pairs of branches of one random square.

    `angles`: pairs in each bin of pi / 128 from 0 to pi / 2; `unclear`: pairs that may be in the
    next bin. `mean_square`: the mean of cos^2, to six digits.
    """
    lines = Lines.of(square_of(recipe))
    found: dict[str, Any] = {
        "status": str(lines.status),
        "lines": lines.distinct,
        "angles": None,
        "unclear": None,
        "mean_square": None,
    }
    if lines.status is PROVED:
        angles = pair_angles(lines)
        found["angles"] = list(angles.bins)
        found["unclear"] = angles.unclear
        found["mean_square"] = float(f"{angles.mean_square:.5e}")
    return found


@dataclass(frozen=True)
class _Size:
    """The squares of one size: the share of pairs in each bin, one line a square."""

    size: int
    shares: FloatArray
    squares: FloatArray
    pairs: int
    unclear: int

    @property
    def mean(self) -> FloatArray:
        """The distribution: squares count alike."""
        return np.asarray(self.shares.mean(axis=0))

    def resampled(self, values: FloatArray) -> FloatArray:
        """Means of values of the squares, over squares drawn again with replacement."""
        number = len(values)
        source = np.random.default_rng([self.size, number])
        weights = source.multinomial(number, np.full(number, 1 / number), size=RESAMPLED)
        return np.asarray(weights @ values / number)


def _sizes(rows: Iterable[Row]) -> list[_Size]:
    groups: dict[int, list[Row]] = defaultdict(list)
    for found in rows:
        if found["angles"] is not None and sum(found["angles"]):
            groups[found["interior"]].append(found)
    return [
        _Size(
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

    ends = np.sin(np.arange(BINS + 1) * _WIDTH) ** 2
    return np.asarray(np.diff(betainc(size / 2, 0.5, ends)))


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Orthogonality, tails, neighbouring sizes, and what the paper says of them."""
    sizes = _sizes(rows)
    if not sizes:
        return []
    made = (_orthogonal, _parts, _powers, _neighbours, _sentences)
    return [make(sizes) for make in made]


def _ends(values: FloatArray) -> tuple[float, float]:
    low, high = np.quantile(values, [0.025, 0.975])
    return float(low), float(high)


def _between(values: FloatArray, digits: int = 3) -> str:
    low, high = _ends(values)
    return f"{low:.{digits}f} to {high:.{digits}f}"


def _orthogonal(sizes: list[_Size]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    for s in sizes:
        factor = (s.size + 1) * s.squares.mean()
        lines.append(
            (
                s.size,
                len(s.shares),
                s.pairs,
                s.unclear,
                f"{s.squares.mean():.4f}",
                f"{1 / (s.size + 1):.4f}",
                f"{factor:.3f}",
                _between((s.size + 1) * s.resampled(s.squares)),
            )
        )
    return StudyTable(
        "orthogonal",
        "How orthogonal branches are: the mean of cos^2 of their angle",
        ("Vi", "squares", "pairs", "unclear", "here", "uniform", "factor", "interval"),
        tuple(lines),
        (
            "uniform: independent uniform directions in Vi + 1 dimensions, 1 / (Vi + 1). A factor "
            "above 1 means less orthogonal. Intervals: bootstrap over squares, 95 %.",
        ),
    )


def _tail_power(means: FloatArray) -> FloatArray:
    """For each distribution the p for which log share = a - b x^p fits best, x from pi / 2.

    Least squares in the bins from 0 to 3 pi / 8, weighted by the shares, for p from 0.05 to 4 in
    steps of 0.05. 1 is an exponential tail, 2 that of a Gaussian.
    """
    x = np.pi / 2 - (np.arange(_FIT) + 0.5) * _WIDTH
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


def _parts(sizes: list[_Size]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    for s in sizes:
        flat, again = uniform(s.size), s.resampled(s.shares)
        cells: list[Cell] = [s.size]
        for part in (slice(BINS - _CENTRE, BINS), slice(0, _TAIL)):
            expected = flat[part].sum()
            cells += [
                f"{s.mean[part].sum() / expected:.3f}",
                _between(again[:, part].sum(axis=1) / expected),
            ]
        lines.append(tuple(cells))
    return StudyTable(
        "parts",
        "Pairs near a right angle and in the tails, as multiples of the uniform prediction",
        ("Vi", "orthogonal", "interval", "tail", "interval"),
        tuple(lines),
        ("orthogonal: within pi / 16 of pi / 2; tail: below pi / 8.",),
    )


def _powers(sizes: list[_Size]) -> StudyTable:
    lines = []
    for s in sizes:
        power, expected = (_tail_power(x[None])[0] for x in (s.mean, uniform(s.size)))
        ends = _between(_tail_power(s.resampled(s.shares)), 2)
        lines.append((s.size, f"{power:.2f}", ends, f"{expected:.2f}"))
    return StudyTable(
        "tails",
        "How the tails fall off: the p of exp(-b x^p), x the distance from pi / 2",
        ("Vi", "power", "interval", "uniform"),
        tuple(lines),
        (
            "1 is exponential, 2 Gaussian; fitted to the angles below 3 pi / 8, for p from 0.05 to "
            "4. uniform: the same of the uniform prediction.",
        ),
    )


def distance(first: FloatArray, second: FloatArray) -> FloatArray:
    """The total variation distance of distributions, along the last axis."""
    return np.asarray(np.abs(first - second).sum(axis=-1) / 2)


def _permuted(first: _Size, second: _Size) -> float:
    """The p-value of the distance of two sizes, squares exchanged at random."""
    both, number = np.vstack([first.shares, second.shares]), len(first.shares)
    source = np.random.default_rng([first.size, second.size])
    seen = distance(first.mean, second.mean)
    total, larger = both.sum(axis=0), 0
    for _ in range(RESAMPLED):
        some = both[source.permutation(len(both))[:number]].sum(axis=0)
        other = (total - some) / (len(both) - number)
        larger += bool(distance(some / number, other) >= seen)
    return (larger + 1) / (RESAMPLED + 1)


def _pairs(sizes: list[_Size]) -> list[tuple[_Size, _Size]]:
    return [(a, b) for a, b in pairwise(sizes) if b.size == a.size + 1]


def _neighbours(sizes: list[_Size]) -> StudyTable:
    lines = []
    for a, b in _pairs(sizes):
        apart = distance(a.resampled(a.shares), b.resampled(b.shares))
        expected = distance(uniform(a.size), uniform(b.size))
        lines.append(
            (
                f"{a.size} and {b.size}",
                f"{distance(a.mean, b.mean):.4f}",
                _between(apart, 4),
                f"{_permuted(a, b):.3f}",
                f"{expected:.4f}",
            )
        )
    return StudyTable(
        "neighbours",
        "How far the distributions of neighbouring sizes are apart (total variation)",
        ("Vi", "distance", "interval", "p", "uniform"),
        tuple(lines),
        (
            "p: permutation test; below 0.01 the sizes differ. uniform: the distance of the "
            "uniform predictions. Where few squares are drawn the distance is large by chance "
            "alone, and the interval is not around the true one.",
        ),
    )


def _sentences(sizes: list[_Size]) -> StudyTable:
    """What Appendix D and the Discussion say, with a number for each."""
    by_size = {s.size: s for s in sizes}
    lines: list[tuple[Cell, ...]] = [_less_orthogonal(sizes)]
    if 6 in by_size:
        lines += _six(by_size[6])
    for first, second, differ in ((6, 7, False), (7, 8, True)):
        if first in by_size and second in by_size:
            p = _permuted(by_size[first], by_size[second])
            words = "differ significantly" if differ else "very nearly coincide"
            apart = distance(by_size[first].mean, by_size[second].mean)
            number = f"distance {apart:.3f}, p = {p:.3f}"
            sentence = f"Vi = {first} and {second} {words}"
            lines.append((sentence, number, _VERDICTS[(p < 0.01) == differ]))
    return StudyTable(
        "sentences",
        "What the paper says",
        ("", "number", "verdict"),
        tuple(lines),
        (
            "Numbers are those of the tables above. A verdict is not decided where the interval "
            "does not tell; sizes differ where p is below 0.01.",
        ),
    )


_VERDICTS = {True: "agreed", False: "not agreed", None: "not decided"}


def _less_orthogonal(sizes: list[_Size]) -> tuple[Cell, ...]:
    ends = {s.size: _ends((s.size + 1) * s.resampled(s.squares)) for s in sizes}
    less = [size for size, (low, _) in ends.items() if low > 1]
    more = [size for size, (_, high) in ends.items() if high < 1]
    holds = None if not (less or more) else not more
    verdict = "agreed in part" if less and more else _VERDICTS[holds]
    number = f"less for Vi = {_listed(less)}; more for {_listed(more)}"
    return "branches are less orthogonal than uniform ones", number, verdict


def _six(six: _Size) -> list[tuple[Cell, ...]]:
    again, flat = six.resampled(six.shares), uniform(6)
    centre, tail = (
        _ends(again[:, part].sum(axis=1) / flat[part].sum())
        for part in (slice(BINS - _CENTRE, BINS), slice(0, _TAIL))
    )
    low, high = _ends(_tail_power(again))
    prominent = None if tail[0] <= centre[1] and tail[1] >= centre[0] else tail[0] > centre[1]
    exponential = low <= 1 <= high
    return [
        (
            "Vi = 6: slightly more orthogonal branches than uniform",
            f"{centre[0]:.3f} to {centre[1]:.3f} times as many",
            _VERDICTS[_above(centre, 1.0)],
        ),
        (
            "Vi = 6: a more prominent enhancement at the tails",
            f"{tail[0]:.1f} to {tail[1]:.1f} times as many",
            _VERDICTS[prominent],
        ),
        (
            "Vi = 6: tails do not decay as a Gaussian",
            f"power {low:.2f} to {high:.2f}",
            _VERDICTS[_above((-high, -low), -2.0)],
        ),
        (
            "Vi = 6: tails decay exponentially",
            f"power {low:.2f} to {high:.2f}",
            _VERDICTS[exponential if high - low < 1 or not exponential else None],
        ),
    ]


def _above(ends: tuple[float, float], value: float) -> bool | None:
    """Whether an interval lies above a value; None if the value is in it."""
    if ends[0] > value:
        return True
    return False if ends[1] < value else None


def _listed(sizes: list[int]) -> str:
    return ", ".join(map(str, sizes)) or "none"


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distributions of all sizes, and that of six vertices beside the uniform one."""
    sizes = _sizes(rows)
    if not sizes:
        return []
    edges = np.arange(2 * BINS + 1) * _WIDTH
    middles = (edges[:-1] + edges[1:]) / 2

    def density(shares: FloatArray) -> FloatArray:
        both = np.concatenate([shares, shares[::-1]]) / 2
        return np.where(both > 0, both / _WIDTH, np.nan)

    def everything(axes: Any) -> None:
        for s in sizes:
            style = of_size(s.size)
            axes.plot(middles, density(s.mean), label=f"$V_i = {s.size}$", **style)
        _angle_axis(axes)
        axes.legend(ncols=2)

    one = next((s for s in sizes if s.size == 6), sizes[-1])

    def single(axes: Any) -> None:
        axes.plot(middles, density(one.mean), color="black", label="random squares")
        axes.plot(middles, density(uniform(one.size)), color="0.6", label="uniform")
        _angle_axis(axes)
        axes.set_ylim(bottom=1e-3)
        axes.legend()

    return [
        StudyFigure(
            "one",
            f"Angles between branches, Vi = {one.size}",
            "Pairs of different branches, each line in both directions, against independent "
            "uniform directions.",
            single,
        ),
        StudyFigure(
            "all",
            "Angles between branches by the number of interior vertices",
            "Pairs of different branches, each line in both directions; every square counts alike.",
            everything,
        ),
    ]


def _angle_axis(axes: Any) -> None:
    axes.set_yscale("log")
    axes.set_xlabel("angle between branches")
    axes.set_ylabel("probability density")
    axes.set_xticks([0, np.pi / 4, np.pi / 2, 3 * np.pi / 4, np.pi])
    axes.set_xticklabels(["0", r"$\pi/4$", r"$\pi/2$", r"$3\pi/4$", r"$\pi$"])


STUDY: Final = Study(
    "angles",
    "Appendix D: angles between the branches of random squares",
    1,
    {size: number for size, (number, *_) in PAPER.items()},
    {7: 1000, 8: 1000, 9: 300, 10: 300, 11: 100, 12: 100, 13: 30, 14: 30},
    square_recipes,
    row,
    tables,
    figures,
)
