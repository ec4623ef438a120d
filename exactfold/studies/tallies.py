"""What several studies do with their rows: adding them up by size, and two kinds of curves."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Protocol, TypeVar

from exactfold.studies.statistics import interval
from exactfold.studies.study import Row


class _Tally(Protocol):
    def add(self, row: Row) -> None:
        """One more row."""


T = TypeVar("T", bound=_Tally)
K = TypeVar("K", int, tuple[int, int])


def tallied(rows: Iterable[Row], empty: Callable[[], T], key: Callable[[Row], K]) -> dict[K, T]:
    """The rows of each key added to a tally of their own, in the order of the keys."""
    found: dict[K, T] = {}
    for row in rows:
        found.setdefault(key(row), empty()).add(row)
    return dict(sorted(found.items()))


def interior_of(row: Row) -> int:
    """The key of studies whose sizes are numbers of interior vertices."""
    return int(row["interior"])


def draw_distribution(axes: Any, values: Sequence[float], **style: Any) -> None:
    """The share of values, in per cent, that are no larger, as a curve of steps from 0 to 100."""
    ordered = sorted(values)
    shares = [100 * k / len(ordered) for k in range(len(ordered) + 1)]
    ordered = [*ordered[:1], *ordered]
    axes.plot(ordered, shares, drawstyle="steps-post", **style)


def draw_shares(
    axes: Any, places: Sequence[float], counts: Sequence[tuple[int, int]], unit: float, **style: Any
) -> None:
    """Shares (found, number) with exact 95 % intervals; `unit` is 100 for per cent."""
    middle = [unit * found / number for found, number in counts]
    bounds = [interval(found, number) for found, number in counts]
    below = [m - unit * low for m, (low, _) in zip(middle, bounds, strict=True)]
    above = [unit * high - m for m, (_, high) in zip(middle, bounds, strict=True)]
    axes.errorbar(places, middle, [below, above], marker="o", **style)
