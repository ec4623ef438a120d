"""Functions that several studies share: they sum up rows by size, and draw kinds of curves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from math import nan
from typing import Any, Protocol, TypeVar

from exactfold.studies.running.statistics import interval
from exactfold.studies.running.study import Row, of_size


class _Tally(Protocol):
    def add(self, row: Row) -> None:
        """Adds a row."""


T = TypeVar("T", bound=_Tally)
K = TypeVar("K", int, tuple[int, int])


def tallied(rows: Iterable[Row], empty: Callable[[], T], key: Callable[[Row], K]) -> dict[K, T]:
    """Adds the rows of each key to a tally of this key; the tallies in the order of the keys."""
    tallies: dict[K, T] = {}
    for row in rows:
        tallies.setdefault(key(row), empty()).add(row)
    return dict(sorted(tallies.items()))


def interior_of(row: Row) -> int:
    """The number of interior vertices of a row, which is the size in most studies."""
    return int(row["interior"])


def draw_distribution(axes: Any, values: Sequence[float], **style: Any) -> None:
    """Draws the share of values, in per cent, that are at most x, as a step curve from 0 to 100."""
    ordered = sorted(values)
    shares = [100 * k / len(ordered) for k in range(len(ordered) + 1)]
    ordered = [*ordered[:1], *ordered]
    axes.plot(ordered, shares, drawstyle="steps-post", **style)


def draw_distributions(axes: Any, values: Mapping[int, Sequence[float]]) -> None:
    """Draws the distribution of each size; all curves span from the least value to the largest."""
    every = [value for some in values.values() for value in some]
    for size, some in values.items():
        ordered = [min(every), *sorted(some), max(every)]
        shares = [100 * k / len(some) for k in range(len(some) + 1)]
        shares.append(100.0)
        label = f"$V_i = {size}$"
        axes.plot(ordered, shares, drawstyle="steps-post", label=label, **of_size(size))
    axes.set_ylim(-3, 103)


def draw_rare(
    axes: Any, places: Sequence[float], counts: Sequence[tuple[int, int]], **style: Any
) -> None:
    """Draws shares (successes, number) in per cent on a logarithmic axis.

    The bars are exact 95 % intervals. If a share has no successes, an open triangle marks the upper
    end of its interval.
    """
    style = {"marker": "o", **style}
    label = style.pop("label")
    some = [place for place, (successes, _) in zip(places, counts, strict=True) if successes]
    if some:
        kept = [(successes, number) if successes else (1, 0) for successes, number in counts]
        middle = [100 * successes / number if number else nan for successes, number in kept]
        bounds = [
            interval(successes, number) if number else (nan, nan) for successes, number in kept
        ]
        below = [m - 100 * low for m, (low, _) in zip(middle, bounds, strict=True)]
        above = [100 * high - m for m, (_, high) in zip(middle, bounds, strict=True)]
        axes.errorbar(places, middle, [below, above], label=label, **style)
    none = [
        (place, 100 * interval(0, number)[1])
        for place, (successes, number) in zip(places, counts, strict=True)
        if not successes
    ]
    if none:
        style |= {"marker": "v", "markerfacecolor": "none", "linestyle": "none"}
        axes.plot(*zip(*none, strict=True), label=None if some else label, **style)


def draw_shares(
    axes: Any, places: Sequence[float], counts: Sequence[tuple[int, int]], unit: float, **style: Any
) -> None:
    """Draws shares (successes, number) with exact 95 % intervals; `unit` is 100 for per cent."""
    middle = [unit * successes / number for successes, number in counts]
    bounds = [interval(successes, number) for successes, number in counts]
    below = [m - unit * low for m, (low, _) in zip(middle, bounds, strict=True)]
    above = [unit * high - m for m, (_, high) in zip(middle, bounds, strict=True)]
    axes.errorbar(places, middle, [below, above], marker="o", **style)
