"""The sentences of Appendix D and the Discussion on angles between branches, each with a number."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from exactfold.studies.angles.pairs import BINS
from exactfold.studies.angles.statistics import (
    CENTRE,
    LEVEL,
    TAIL,
    AnglesOfSize,
    apart,
    between,
    ends_of,
    exchanged,
    p_values,
    tail_power,
    uniform,
)
from exactfold.studies.running.statistics import verdict
from exactfold.studies.running.study import Cell, StudyTable
from exactfold.studies.table1 import PAPER


def sentences(sizes: list[AnglesOfSize]) -> StudyTable:
    """A line for each sentence that these sizes can judge."""
    by_size = {s.size: s for s in sizes}
    lines: list[tuple[Cell, ...]] = [_less_orthogonal(sizes)]
    if 6 in by_size:
        lines += _six(by_size[6])
    for first, second, differ in ((6, 7, False), (6, 8, True), (7, 8, True)):
        if first in by_size and second in by_size:
            lines.append(_apart(by_size[first], by_size[second], differ))
    if 7 in by_size and 8 in by_size:
        lines += _data(by_size[7], by_size[8])
        if 6 in by_size:
            lines.append(_stands_out(by_size[6], by_size[7], by_size[8]))
    lines.append(_with_itself(sizes))
    return StudyTable(
        "sentences",
        "What the paper says",
        ("", "number", "verdict"),
        tuple(lines),
        (
            "The numbers are those of the tables above, for the squares of this run. A verdict is "
            "not decided if the interval allows both. Two sizes differ if the p of the distance "
            "or that of the tails is below 0.01.",
        ),
    )


def _apart(first: AnglesOfSize, second: AnglesOfSize, differ: bool) -> tuple[Cell, ...]:
    """Tests that two sizes very nearly coincide, or that they differ significantly."""
    words = "differ significantly" if differ else "very nearly coincide"
    seen = apart(first.mean, second.mean)
    p = p_values(seen, exchanged(first, second))
    number = f"distance {seen[0]:.3f}, p = {p[0]:.3f}; tails {100 * seen[1]:.2f} %, p = {p[1]:.3f}"
    holds = bool((p < LEVEL).any()) == differ
    return f"Vi = {first.size} and {second.size} {words}", number, verdict(holds)


def _data(seven: AnglesOfSize, eight: AnglesOfSize) -> list[tuple[Cell, ...]]:
    """Tests that there are enough data for Vi = 8, with the paper's numbers of squares."""
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
        seen = apart(seven.mean, eight.mean)
        most = np.quantile(exchanged(seven, eight, squares), 1 - LEVEL, axis=0)
        number = (
            f"distance {seen[0]:.3f}, tails {100 * seen[1]:.2f} %; chance, with these squares, "
            f"to {most[0]:.3f}, {100 * most[1]:.2f} %"
        )
        holds = bool((seen > most).any())
        lines.append(("Vi = 8 differs not for lack of data", number, verdict(holds)))
    return lines


def _stands_out(six: AnglesOfSize, seven: AnglesOfSize, eight: AnglesOfSize) -> tuple[Cell, ...]:
    """Tests that, in the tails, Vi = 8 is further from 7 than 7 is from 6."""
    tails = [s.resampled(s.shares)[:, :TAIL].sum(axis=1) for s in (six, seven, eight)]
    steps = [100 * (a - b) for a, b in pairwise(tails)]
    number = f"tails: 6 to 7 falls {between(steps[0], 2)} %, 7 to 8 {between(steps[1], 2)} %"
    return "Vi = 8 stands out, not 7", number, verdict(_above(ends_of(steps[1] - steps[0]), 0.0))


def _less_orthogonal(sizes: list[AnglesOfSize]) -> tuple[Cell, ...]:
    ends = {s.size: ends_of((s.size + 1) * s.resampled(s.squares)) for s in sizes}
    less = [size for size, (low, _) in ends.items() if low > 1]
    more = [size for size, (_, high) in ends.items() if high < 1]
    holds = None if not (less or more) else not more
    said = "agreed in part" if less and more else verdict(holds)
    number = f"less for Vi = {_listed(less)}; more for {_listed(more)}"
    return "branches are less orthogonal than uniform ones", number, said


def _with_itself(sizes: list[AnglesOfSize]) -> tuple[Cell, ...]:
    """Tests the share of the angles 0 and pi, which each branch has with itself if pairs count."""
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
        for part in (slice(BINS - CENTRE, BINS), slice(0, TAIL))
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
    """Whether an interval lies above a value; None if it contains the value."""
    if ends[0] > value:
        return True
    return False if ends[1] < value else None


def _listed(sizes: list[int]) -> str:
    """Sizes as a text; three or more consecutive sizes are written as first and last."""
    runs: list[list[int]] = []
    for size in sizes:
        if runs and size == runs[-1][-1] + 1:
            runs[-1].append(size)
        else:
            runs.append([size])
    texts = (f"{r[0]} to {r[-1]}" if len(r) > 2 else ", ".join(map(str, r)) for r in runs)
    return ", ".join(texts) or "none"
