"""Appendix D of the paper: how the branches of random squares lie in the space of fold angles.

A row is one random square: its pairs of branches by their angle, as lines, in bins of pi / 128.
What the paper says of these angles is tested with numbers (`exactfold.studies.angle_statistics`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.studies.angle_statistics import (
    WIDTH,
    AnglesOfSize,
    angles_by_size,
    distance,
    ends_of,
    exchanged,
    p_value,
    tail_power,
    uniform,
)
from exactfold.studies.lines import Lines
from exactfold.studies.pair_angles import BINS, pair_angles
from exactfold.studies.squares import square_of, square_recipes
from exactfold.studies.statistics import verdict
from exactfold.studies.study import Cell, Recipe, Row, Study, StudyFigure, StudyTable, of_size
from exactfold.studies.table1 import PAPER
from exactfold.verdict import PROVED

_CENTRE = BINS // 8
"""Bins next to a right angle that are called orthogonal here: up to pi / 16 from it."""
_TAIL = BINS // 4
"""Bins next to 0 that are called a tail: up to pi / 8."""
_LAST = max(PAPER)
"""The last size in the paper's figure of all sizes; larger ones have a panel of their own."""


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


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Orthogonality, tails, neighbouring sizes, and what the paper says of them."""
    sizes = angles_by_size(rows)
    if not sizes:
        return []
    made = (_orthogonal, _parts, _powers, _neighbours, _sentences)
    return [make(sizes) for make in made]


def _between(values: FloatArray, digits: int = 3) -> str:
    low, high = ends_of(values)
    return f"{low:.{digits}f} to {high:.{digits}f}"


def _between_of(values: FloatArray) -> str:
    """The same to four digits, for multiples of any size."""
    low, high = ends_of(values)
    return f"{low:#.4g} to {high:#.4g}"


def _orthogonal(sizes: list[AnglesOfSize]) -> StudyTable:
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


def _parts(sizes: list[AnglesOfSize]) -> StudyTable:
    lines: list[tuple[Cell, ...]] = []
    for s in sizes:
        flat, again = uniform(s.size), s.resampled(s.shares)
        cells: list[Cell] = [s.size]
        for part in (slice(BINS - _CENTRE, BINS), slice(0, _TAIL)):
            here, expected = s.mean[part].sum(), flat[part].sum()
            cells += [
                f"{100 * here:.2f}",
                f"{here / expected:#.4g}",
                _between_of(again[:, part].sum(axis=1) / expected),
            ]
        lines.append(tuple(cells))
    return StudyTable(
        "parts",
        "Pairs near a right angle and in the tails, as multiples of the uniform prediction",
        ("Vi", "orthogonal, %", "multiple", "interval", "tail, %", "multiple", "interval"),
        tuple(lines),
        ("orthogonal: within pi / 16 of pi / 2; tail: below pi / 8.",),
    )


def _powers(sizes: list[AnglesOfSize]) -> StudyTable:
    lines = []
    for s in sizes:
        power, expected = (tail_power(x[None])[0] for x in (s.mean, uniform(s.size)))
        ends = _between(tail_power(s.resampled(s.shares)), 2)
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


def _pairs(sizes: list[AnglesOfSize]) -> list[tuple[AnglesOfSize, AnglesOfSize]]:
    return [(a, b) for a, b in pairwise(sizes) if b.size == a.size + 1]


def _neighbours(sizes: list[AnglesOfSize]) -> StudyTable:
    lines = []
    for a, b in _pairs(sizes):
        seen, chance = float(distance(a.mean, b.mean)), exchanged(a, b)
        apart = distance(a.resampled(a.shares), b.resampled(b.shares))
        expected = distance(uniform(a.size), uniform(b.size))
        lines.append(
            (
                f"{a.size} and {b.size}",
                f"{seen:.4f}",
                _between(apart, 4),
                f"{np.median(chance):.4f}",
                f"{p_value(seen, chance):.3f}",
                f"{expected:.4f}",
            )
        )
    return StudyTable(
        "neighbours",
        "How far the distributions of neighbouring sizes are apart (total variation)",
        ("Vi", "distance", "interval", "chance", "p", "uniform"),
        tuple(lines),
        (
            "chance: the median distance after squares are exchanged at random between the two "
            "sizes; p: permutation test, where sizes differ if it is below 0.01. uniform: the "
            "distance of the uniform predictions. Where few squares are drawn the distance is "
            "large by chance alone, and the interval is not around the true one.",
        ),
    )


def _sentences(sizes: list[AnglesOfSize]) -> StudyTable:
    """What Appendix D and the Discussion say, with a number for each."""
    by_size = {s.size: s for s in sizes}
    lines: list[tuple[Cell, ...]] = [_less_orthogonal(sizes)]
    if 6 in by_size:
        lines += _six(by_size[6])
    for first, second, differ in ((6, 7, False), (6, 8, True), (7, 8, True)):
        if first in by_size and second in by_size:
            lines.append(_apart(by_size[first], by_size[second], differ))
    if 7 in by_size and 8 in by_size:
        lines += _data(by_size[7], by_size[8])
    lines.append(_with_itself(sizes))
    return StudyTable(
        "sentences",
        "What the paper says",
        ("", "number", "verdict"),
        tuple(lines),
        (
            "Numbers are those of the tables above, for the squares of this run. A verdict is not "
            "decided where the interval does not tell; sizes differ where p is below 0.01, as any "
            "two do once there are squares enough.",
        ),
    )


def _apart(first: AnglesOfSize, second: AnglesOfSize, differ: bool) -> tuple[Cell, ...]:
    """That two sizes very nearly coincide, or differ significantly."""
    words = "differ significantly" if differ else "very nearly coincide"
    seen, chance = float(distance(first.mean, second.mean)), exchanged(first, second)
    p = p_value(seen, chance)
    number = f"distance {seen:.3f}, by chance {np.median(chance):.3f}, p = {p:.3f}"
    return f"Vi = {first.size} and {second.size} {words}", number, verdict((p < 0.01) == differ)


def _data(seven: AnglesOfSize, eight: AnglesOfSize) -> list[tuple[Cell, ...]]:
    """That there are enough data for Vi = 8: the squares of the paper, whatever this run has."""
    squares = PAPER[7][0], PAPER[8][0]
    pairs = [s.pairs / len(s.shares) * n for s, n in zip((seven, eight), squares, strict=True)]
    ratio = pairs[1] / pairs[0]
    lines: list[tuple[Cell, ...]] = [
        (
            "Vi = 7 and 8 have comparable numbers of pairs",
            f"{ratio:.2f} as many, with {squares[1]} squares and {squares[0]}",
            verdict(0.5 <= ratio <= 2),
        )
    ]
    if len(seven.shares) >= squares[0] and len(eight.shares) >= squares[1]:
        seen = float(distance(seven.mean, eight.mean))
        most = float(np.quantile(exchanged(seven, eight, squares), 0.99))
        number = f"distance {seen:.3f}; {squares[1]} squares and {squares[0]}: chance to {most:.3f}"
        lines.append(("Vi = 8 differs not for lack of data", number, verdict(seen > most)))
    return lines


def _less_orthogonal(sizes: list[AnglesOfSize]) -> tuple[Cell, ...]:
    ends = {s.size: ends_of((s.size + 1) * s.resampled(s.squares)) for s in sizes}
    less = [size for size, (low, _) in ends.items() if low > 1]
    more = [size for size, (_, high) in ends.items() if high < 1]
    holds = None if not (less or more) else not more
    said = "agreed in part" if less and more else verdict(holds)
    number = f"less for Vi = {_listed(less)}; more for {_listed(more)}"
    return "branches are less orthogonal than uniform ones", number, said


def _with_itself(sizes: list[AnglesOfSize]) -> tuple[Cell, ...]:
    """Lines in both directions: a branch has the angles 0 and pi with itself, where pairs count."""
    own, others = [], []
    for s in sizes:
        branches = len(s.shares) * (1 << s.size)
        own.append(branches / (branches + 2 * s.pairs))
        others.append(2 * s.pairs * float(s.mean[0]) / (branches + 2 * s.pairs))
    first, last = sizes[0].size, sizes[-1].size
    number = (
        f"Vi = {first}: {100 * own[0]:.2g} % of pairs, others there {100 * others[0]:.2g} %; "
        f"Vi = {last}: {100 * own[-1]:.2g} % and {100 * others[-1]:.2g} %"
    )
    holds = all(a > b for a, b in pairwise(own)) and own[0] > others[0]
    return "small Vi: angles near 0 and pi, of each branch with itself", number, verdict(holds)


def _six(six: AnglesOfSize) -> list[tuple[Cell, ...]]:
    again, flat = six.resampled(six.shares), uniform(6)
    centre, tail = (
        ends_of(again[:, part].sum(axis=1) / flat[part].sum())
        for part in (slice(BINS - _CENTRE, BINS), slice(0, _TAIL))
    )
    low, high = ends_of(tail_power(again))
    prominent = None if tail[0] <= centre[1] and tail[1] >= centre[0] else tail[0] > centre[1]
    exponential = low <= 1 <= high
    return [
        (
            "Vi = 6: slightly more orthogonal branches than uniform",
            f"{centre[0]:.3f} to {centre[1]:.3f} times as many",
            verdict(_above(centre, 1.0)),
        ),
        (
            "Vi = 6: a more prominent enhancement at the tails",
            f"{tail[0]:.1f} to {tail[1]:.1f} times as many",
            verdict(prominent),
        ),
        (
            "Vi = 6: tails do not decay as a Gaussian",
            f"power {low:.2f} to {high:.2f}",
            verdict(_above((-high, -low), -2.0)),
        ),
        (
            "Vi = 6: tails decay exponentially",
            f"power {low:.2f} to {high:.2f}",
            verdict(exponential if high - low < 1 or not exponential else None),
        ),
    ]


def _above(ends: tuple[float, float], value: float) -> bool | None:
    """Whether an interval lies above a value; None if the value is in it."""
    if ends[0] > value:
        return True
    return False if ends[1] < value else None


def _listed(sizes: list[int]) -> str:
    """Sizes as a text, three or more in a row by the first and the last."""
    runs: list[list[int]] = []
    for size in sizes:
        if runs and size == runs[-1][-1] + 1:
            runs[-1].append(size)
        else:
            runs.append([size])
    texts = (f"{r[0]} to {r[-1]}" if len(r) > 2 else ", ".join(map(str, r)) for r in runs)
    return ", ".join(texts) or "none"


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """The distributions of all sizes, and that of six vertices beside the uniform one."""
    sizes = angles_by_size(rows)
    if not sizes:
        return []
    edges = np.arange(2 * BINS + 1) * WIDTH
    middles = (edges[:-1] + edges[1:]) / 2

    def density(shares: FloatArray) -> FloatArray:
        both = np.concatenate([shares, shares[::-1]]) / 2
        return np.where(both > 0, both / WIDTH, np.nan)

    parts = [[s for s in sizes if s.size <= _LAST], [s for s in sizes if s.size >= _LAST]]
    if sizes[-1].size <= _LAST or sizes[0].size >= _LAST:
        parts = [sizes]

    def everything(panels: Any) -> None:
        for axes, some in zip(panels if len(parts) > 1 else [panels], parts, strict=True):
            for s in some:
                axes.plot(middles, density(s.mean), label=f"$V_i = {s.size}$", **of_size(s.size))
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
            width=5.0 * len(parts),
            panels=(1, len(parts)),
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
    {7: 1000, 8: 1000, 9: 1000, 10: 1000, 11: 300, 12: 300, 13: 100, 14: 100},
    square_recipes,
    row,
    tables,
    figures,
)
