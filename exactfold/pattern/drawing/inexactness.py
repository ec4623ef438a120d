"""Measures how inexact a drawing is: the distances by which points and lines miss each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from exactfold._support.arrays import FloatArray, IntArray
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.mending import floats, near_pairs, used
from exactfold.pattern.drawing.splitting import check_pairs, crossing_pairs

GAP: Final = 4.0
"""A distance d is clear if no other distance lies between d and this many times d."""
_SLACK: Final = 1 + 1e-6


def clear_distances(drawing: Drawing, least: float, most: float, gap: float = GAP) -> list[float]:
    """Distances from `least` to `most` that separate drawing errors from details of the design.

    Ends of lines, and crossings of lines whose ends are all well away, miss each other and other
    lines by distances d. Such a distance is clear if no other one lies in (d, `gap` d]. Then d, as
    an error, is far smaller than any distance that was meant. If `least` itself is clear, it comes
    first. The distances are sorted; the list is empty if errors and details overlap in size. All
    this uses floats, as it only proposes at what distance points are merged.

    >>> from exactfold.pattern.drawing.drawing import Line
    >>> points = [(0, 0), (10, 0), (10, 10), (0, 10), (5, 0.02), (5, 10)]
    >>> square = [Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B")]
    >>> clear_distances(Drawing(tuple(points), (*square, Line(4, 5, "M")), ""), 1e-5, 0.1)
    [1e-05, 0.02]
    """
    distances = np.sort(_misses(drawing, gap * most))
    distances = np.array([least, *distances[distances > least]])
    following = np.array([*distances[1:], np.inf])
    clear = (following > gap * distances) & (distances <= most)
    return [float(distance) for distance in distances[clear]]


def _misses(drawing: Drawing, within: float) -> FloatArray:
    """The distances up to `within` between points and lines that do not meet."""
    places, lines = floats(drawing.points), [line for line in drawing.lines if line[0] != line[1]]
    members = np.array(used(lines), dtype=np.intp)
    ends = places[members]
    beside, across = _beside(ends, places, lines, within)
    own = [lines[k][:2] for k in beside[1]]
    ending = [int(members[v]) in pair for v, pair in zip(beside[0], own, strict=True)]
    distances = [across[~np.array(ending, dtype=bool)]]
    touching = set(zip(members[beside[0]].tolist(), beside[1].tolist(), strict=True))
    clear = [
        (k, m)
        for k, m in crossing_pairs(places, lines)
        if not any((v, m) in touching for v in lines[k][:2])
        and not any((v, k) in touching for v in lines[m][:2])
    ]
    crossings = np.array([_crossing(places, lines[k], lines[m]) for k, m in clear]).reshape(-1, 2)
    spots, at = _beside(crossings, places, lines, within)
    through = [k in clear[v] for v, k in zip(*spots.tolist(), strict=True)]
    distances.append(at[~np.array(through, dtype=bool)])
    tree = cKDTree(ends)
    pairs = near_pairs(tree, within)
    distances.append(np.hypot(*(ends[pairs[:, 0]] - ends[pairs[:, 1]]).T))
    return np.concatenate(distances)


def _beside(
    spots: FloatArray, places: FloatArray, lines: Sequence[Line], within: float
) -> tuple[IntArray, FloatArray]:
    """Pairs of a spot and a line beside whose inside it lies, of shape (2, n); their distances."""
    near: list[IntArray] = [np.empty((2, 0), dtype=np.int64)]
    distances: list[FloatArray] = [np.empty(0)]
    if not len(spots) or not lines:
        return near[0], distances[0]
    order = np.argsort(spots[:, 0], kind="stable")
    xs, ys = spots[order].T
    ends = places[[line[:2] for line in lines]]
    reach = within * _SLACK  # a spot near a line lies in the bounding box widened by this
    low, high = ends.min(axis=1) - reach, ends.max(axis=1) + reach
    check_pairs(xs, low[:, 0], high[:, 0])
    first, last = np.searchsorted(xs, low[:, 0]), np.searchsorted(xs, high[:, 0], side="right")
    for k, (a, b, _) in enumerate(lines):
        chord = places[b] - places[a]
        length = float(np.hypot(*chord))
        beside = slice(first[k], last[k])
        here = order[beside][(ys[beside] >= low[k, 1]) & (ys[beside] <= high[k, 1])]
        offset = spots[here] - places[a]
        across = np.abs(offset[:, 0] * chord[1] - offset[:, 1] * chord[0]) / max(length, 1e-300)
        along = offset @ chord / max(length, 1e-300)
        hit = (across <= within) & (along > 0) & (along < length)
        near.append(np.array([here[hit], np.full(np.count_nonzero(hit), k)], dtype=np.int64))
        distances.append(across[hit])
    return np.concatenate(near, axis=1), np.concatenate(distances)


def _crossing(places: FloatArray, first: Line, second: Line) -> FloatArray:
    a, b = places[first.start], places[second.start]
    d, e = places[first.end] - a, places[second.end] - b
    t = ((b - a)[0] * e[1] - (b - a)[1] * e[0]) / (d[0] * e[1] - d[1] * e[0])
    crossing: FloatArray = a + t * d
    return crossing
