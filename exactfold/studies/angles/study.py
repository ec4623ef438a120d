"""Appendix D of the paper: the directions of the branches of random squares in fold angle space.

A row is one random square: its pairs of branches by their angle, as lines, in bins of pi / 128.
The statistics (`exactfold.studies.angles.statistics`) test the paper's sentences on these angles.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED
from exactfold.studies.angles.pairs import BINS, pair_angles
from exactfold.studies.angles.sentences import sentences
from exactfold.studies.angles.statistics import (
    CENTRE,
    TAIL,
    WIDTH,
    AnglesOfSize,
    angles_by_size,
    apart,
    between,
    distance,
    ends_of,
    exchanged,
    p_values,
    tail_power,
    uniform,
)
from exactfold.studies.running.lines import Lines
from exactfold.studies.running.squares import square_of, square_recipes
from exactfold.studies.running.study import (
    Cell,
    Recipe,
    Row,
    Study,
    StudyFigure,
    StudyTable,
    of_size,
)
from exactfold.studies.table1 import PAPER

_MANY = 10_000
"""With fewer pairs a histogram shows chance, so that its line is thin."""
_LAST = max(PAPER)
"""The last size in the paper's figure of all sizes; larger sizes have their own panel."""


def row(recipe: Recipe) -> dict[str, Any]:
    """The angles of all pairs of branches of one random square.

    `angles` are the numbers of pairs in each bin of pi / 128 from 0 to pi / 2. `unclear` counts the
    pairs that may be in the next bin. `mean_square` is the mean of cos^2, to six digits.
    """
    lines = Lines.of(square_of(recipe))
    values: dict[str, Any] = {
        "status": str(lines.status),
        "lines": lines.distinct,
        "angles": None,
        "unclear": None,
        "mean_square": None,
    }
    if lines.status is PROVED:
        angles = pair_angles(lines)
        values["angles"] = list(angles.bins)
        values["unclear"] = angles.unclear
        values["mean_square"] = float(f"{angles.mean_square:.5e}")
    return values


def tables(rows: Iterable[Row]) -> list[StudyTable]:
    """Orthogonality, tails, neighbouring sizes, and the sentences of the paper."""
    sizes = angles_by_size(rows)
    if not sizes:
        return []
    made = (_orthogonal, _parts, _powers, _neighbours, sentences)
    return [make(sizes) for make in made]


def _multiple(value: float) -> str:
    """A number with four digits, or with all digits before the point."""
    return f"{value:#.4g}" if value < 1000 else f"{value:.0f}"


def _multiples(values: FloatArray) -> str:
    """Both ends of the interval of values, each as in `_multiple`."""
    return " to ".join(map(_multiple, ends_of(values)))


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
                between((s.size + 1) * s.resampled(s.squares)),
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
        for part in (slice(BINS - CENTRE, BINS), slice(0, TAIL)):
            here, expected = s.mean[part].sum(), flat[part].sum()
            cells += [
                f"{100 * here:.2f} %",
                _multiple(here / expected),
                _multiples(again[:, part].sum(axis=1) / expected),
            ]
        lines.append(tuple(cells))
    return StudyTable(
        "parts",
        "Pairs near a right angle and in the tails, as multiples of the uniform prediction",
        ("Vi", "orthogonal", "multiple", "interval", "tail", "multiple", "interval"),
        tuple(lines),
        ("orthogonal: within pi / 16 of pi / 2; tail: below pi / 8.",),
    )


def _powers(sizes: list[AnglesOfSize]) -> StudyTable:
    lines = []
    for s in sizes:
        power, expected = (tail_power(x[None])[0] for x in (s.mean, uniform(s.size)))
        ends = between(tail_power(s.resampled(s.shares)), 2)
        lines.append((s.size, f"{power:.2f}", ends, f"{expected:.2f}"))
    return StudyTable(
        "tails",
        "How the tails fall off: the p of exp(-b x^p), x the distance from pi / 2",
        ("Vi", "power", "interval", "uniform"),
        tuple(lines),
        (
            "1 is exponential, 2 Gaussian; fitted to the angles below 3 pi / 8, for p from 0.05 to "
            "4. uniform: the same for the uniform prediction.",
        ),
    )


def _pairs(sizes: list[AnglesOfSize]) -> list[tuple[AnglesOfSize, AnglesOfSize]]:
    return [(a, b) for a, b in pairwise(sizes) if b.size == a.size + 1]


def _neighbours(sizes: list[AnglesOfSize]) -> StudyTable:
    lines = []
    for a, b in _pairs(sizes):
        seen, chance = apart(a.mean, b.mean), exchanged(a, b)
        again = distance(a.resampled(a.shares), b.resampled(b.shares))
        p, tails = p_values(seen, chance)
        lines.append(
            (
                f"{a.size} and {b.size}",
                f"{seen[0]:.4f}",
                between(again, 4),
                f"{np.median(chance[:, 0]):.4f}",
                f"{p:.3f}",
                f"{distance(uniform(a.size), uniform(b.size)):.4f}",
                f"{100 * seen[1]:.2f}",
                f"{tails:.3f}",
            )
        )
    return StudyTable(
        "neighbours",
        "How far the distributions of neighbouring sizes are apart (total variation)",
        ("Vi", "distance", "interval", "chance", "p", "uniform", "tails, %", "p"),
        tuple(lines),
        (
            "chance: the median distance after squares are exchanged at random between the two "
            "sizes. uniform: the distance of the uniform predictions. tails: the difference of the "
            "shares of pairs below pi / 8. p: permutation tests of the distance and of the tails; "
            "sizes differ if one of them is below 0.01. With few squares the distance is large by "
            "chance alone, and the interval is not around the true one.",
        ),
    )


def figures(rows: Iterable[Row]) -> Sequence[StudyFigure]:
    """Two figures: the distributions of all sizes, and of six vertices beside the uniform one."""
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

    shown = np.array(
        [density(s.mean) for s in sizes if s.pairs > _MANY] or [density(sizes[0].mean)]
    )
    limits = max(float(np.nanmin(shown)) / 1.5, 1e-4), 3.0

    def everything(panels: Any) -> None:
        for axes, some in zip(panels if len(parts) > 1 else [panels], parts, strict=True):
            for s in some:
                style = {**of_size(s.size), "linewidth": 1.2 if s.pairs > _MANY else 0.5}
                axes.plot(middles, density(s.mean), label=f"$V_i = {s.size}$", **style)
            _angle_axis(axes)
            axes.set_ylim(*limits)

    one = next((s for s in sizes if s.size == 6), sizes[-1])

    def single(axes: Any) -> None:
        axes.plot(middles, density(one.mean), color="black", label="random squares")
        axes.plot(middles, density(uniform(one.size)), color="0.6", label="uniform")
        _angle_axis(axes)
        axes.set_ylim(bottom=1e-3)

    return [
        StudyFigure(
            "one",
            f"Angles between branches, Vi = {one.size}",
            "Pairs of different branches, each line in both directions, compared with independent "
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
