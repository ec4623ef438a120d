"""Splits lines at T-junctions and crossings, so that lines meet exactly in vertices."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import agreeing, counted
from exactfold.checker.core.limits import MOST_CROSSINGS, MOST_PAIRS
from exactfold.errors import TooLargeError
from exactfold.exact.surds import Number, Surd
from exactfold.pattern.drawing.construction import ExactLine, crossing
from exactfold.pattern.drawing.drawing import Drawing, Line, Point
from exactfold.pattern.drawing.mending import Repair, floats, groups_within, repair, used

Junctions: TypeAlias = dict[int, list[int]]
"""For each vertex inside lines, these lines."""

_FLATTEST: Final = 0.05
"""A crossing fixes a point only if the sine of its angle is larger than this."""
_LONGEST: Final = 1024
"""A vertex is not moved onto its line if a coordinate would then have more bits."""


def split(drawing: Drawing, within: float) -> tuple[Drawing, list[Repair]]:
    """Cuts lines where they cross and where a vertex lies within `within` of their inside.

    Crossings are computed exactly, in the field of the coordinates. A vertex near the inside of a
    line moves onto it: to the crossing of two such lines, or to the crossing with the only line
    that ends there, or to the foot of the perpendicular. If three lines nearly meet, only two can
    meet exactly. The third line then bends at the vertex by less than `within`, and a repair says
    so.
    """
    points, lines = list(drawing.points), drawing.lines
    junctions = _junctions(floats(points), lines, within)
    repairs = _moved_onto_lines(points, lines, junctions)
    places = floats(points)
    added = _crossings(points, places, lines, junctions, within)
    inside: dict[int, set[int]] = {}
    for v, hosts in (*junctions.items(), *added.items()):
        for k in hosts:
            inside.setdefault(k, set()).add(v)
    if not inside:
        return drawing, []
    places = floats(points)
    pieces: list[Line] = []
    for k, (a, b, letter) in enumerate(lines):
        along = places[b] - places[a]
        order = sorted(inside.get(k, ()), key=lambda v: float((places[v] - places[a]) @ along))
        pieces += [Line(c, d, letter) for c, d in zip([a, *order], [*order, b], strict=True)]
    cuts = sum(len(hosts) for hosts in junctions.values())
    bent = [
        v
        for v, hosts in (*junctions.items(), *added.items())
        if any(_offset(points, lines[k], v) != 0 for k in hosts)
    ]
    met = f"{counted(len(junctions), 'vertex')} inside of lines: {counted(cuts, 'line')} cut there"
    crossed = f"{counted(len(added), 'crossing')} of lines {agreeing(len(added), 'is')} a vertex"
    bend = (
        f"at {counted(len(bent), 'vertex')} a line bends by less than {within:.2g}, because more "
        "than two lines do not quite meet there"
    )
    reports = (
        repair("split", len(junctions), sorted(junctions), points, met)
        + repair("split", len(added), sorted(added), points, crossed)
        + repairs
        + repair("split", len(bent), sorted(bent), points, bend)
    )
    return replace(drawing, points=tuple(points), lines=tuple(pieces), exact=False), reports


def _junctions(places: FloatArray, lines: Sequence[Line], within: float) -> Junctions:
    members = np.array(used(lines), dtype=np.intp)
    members = members[np.argsort(places[members, 0], kind="stable")]
    spots = places[members]
    junctions: Junctions = {}
    pairs = np.array([line[:2] for line in lines], dtype=np.intp).reshape(-1, 2)
    ends = places[pairs][:, :, 0]
    check_pairs(spots[:, 0], ends.min(axis=1, initial=np.inf), ends.max(axis=1, initial=-np.inf))
    for k, (a, b, _) in enumerate(lines):
        chord = places[b] - places[a]
        length = float(np.hypot(*chord))
        if length <= within:
            continue
        low, high = min(places[a][0], places[b][0]), max(places[a][0], places[b][0])
        first = np.searchsorted(spots[:, 0], low - within, side="left")
        last = np.searchsorted(spots[:, 0], high + within, side="right")
        offset = spots[first:last] - places[a]
        across = np.abs(offset[:, 0] * chord[1] - offset[:, 1] * chord[0]) / length
        along = offset @ chord / length
        near = (across <= within) & (along > 0) & (along < length)
        for v in members[first:last][near]:
            if v not in (a, b):
                junctions.setdefault(int(v), []).append(k)
    return junctions


def _moved_onto_lines(
    points: list[Point], lines: Sequence[Line], junctions: Mapping[int, Sequence[int]]
) -> list[Repair]:
    """Moves each vertex onto its lines, starting with vertices whose lines no longer move."""
    ending: dict[int, list[int]] = {v: [] for v in junctions}
    for k, line in enumerate(lines):
        for v in line[:2]:
            if v in ending:
                ending[v].append(k)
    todo = dict(sorted(junctions.items()))
    moved: list[int] = []
    bent: list[int] = []
    farthest = 0.0
    while todo:
        ready = [
            v
            for v, hosts in todo.items()
            if not any(u in todo for k in hosts for u in lines[k][:2])
        ]
        for v in ready or [min(todo)]:
            hosts = todo.pop(v)
            if all(_offset(points, lines[k], v) == 0 for k in hosts):
                continue
            place = _on_lines(points, lines, v, hosts, ending[v])
            if _length(place) > _LONGEST:
                bent.append(v)
                continue
            dx, dy = (float(c - d) for c, d in zip(place, points[v], strict=True))
            farthest = max(farthest, float(np.hypot(dx, dy)))
            points[v] = place
            moved.append(v)
    sentence = (
        f"{counted(len(moved), 'vertex')} moved exactly onto a line, by at most {farthest:.2g}"
    )
    kept = (
        f"{counted(len(bent), 'vertex')} stayed beside a line, which bends there, because the "
        "crossing has too many digits"
    )
    return repair("split", len(moved), sorted(moved), points, sentence) + repair(
        "split", len(bent), sorted(bent), points, kept
    )


def _length(point: Point) -> int:
    """The number of bits of the longest numerator or denominator."""
    parts = [x for c in point for x in (c.coefficients if isinstance(c, Surd) else (c,))]
    return max(max(x.numerator.bit_length(), x.denominator.bit_length()) for x in parts)


def _on_lines(
    points: Sequence[Point],
    lines: Sequence[Line],
    v: int,
    hosts: Sequence[int],
    ending: Sequence[int],
) -> Point:
    through = [_supporting(points, lines[k]) for k in hosts]
    best, chosen = _FLATTEST, None
    for pair in combinations(through, 2):
        if (sine := _sine(*pair)) > best:
            best, chosen = sine, pair
    if chosen is not None:
        return crossing(*chosen)
    host = through[0]
    others = [_supporting(points, lines[k]) for k in ending]
    slanted = [line for line in others if _sine(host, line) > _FLATTEST]
    if slanted and all(_sine(slanted[0], line) < 1e-9 for line in slanted[1:]):
        return crossing(host, slanted[0])
    _, (dx, dy) = host
    return crossing(host, (points[v], (-dy, dx)))


def _crossings(
    points: list[Point],
    places: FloatArray,
    lines: Sequence[Line],
    junctions: Mapping[int, Sequence[int]],
    within: float,
) -> Junctions:
    """Appends the crossings to `points`, and returns the lines through each."""
    meets: list[set[int]] = [set(line[:2]) for line in lines]
    for v, hosts in junctions.items():
        for k in hosts:
            meets[k].add(v)
    through: dict[Point, set[int]] = {}
    for k, m in crossing_pairs(places, lines):
        if not meets[k] & meets[m]:
            point = crossing(_supporting(points, lines[k]), _supporting(points, lines[m]))
            through.setdefault(point, set()).update((k, m))
    crossings = list(through)
    for first, *rest in groups_within(floats(crossings), range(len(crossings)), within):
        for v in rest:
            through[crossings[first]] |= through.pop(crossings[v])
    start = len(points)
    points += through
    return {v: sorted(hosts) for v, hosts in enumerate(through.values(), start)}


def crossing_pairs(places: FloatArray, lines: Sequence[Line]) -> list[tuple[int, int]]:
    """Pairs of lines whose insides cross, by floats; each end lies well off the other line.

    Raises `TooLargeError` if there are too many.
    """
    if not lines:
        return []
    a = places[[line.start for line in lines]]
    d = places[[line.end for line in lines]] - a
    low, high = np.minimum(a, a + d), np.maximum(a, a + d)
    order = np.argsort(low[:, 0], kind="stable")
    starts = low[order, 0]
    check_pairs(starts, low[:, 0], high[:, 0])
    pairs: list[tuple[int, int]] = []
    for position, k in enumerate(order):
        last = np.searchsorted(starts, high[k, 0], side="right")
        near = order[position + 1 : last]
        near = near[(low[near, 1] <= high[k, 1]) & (high[near, 1] >= low[k, 1])]
        gap = a[near] - a[k]
        turn = d[k, 0] * d[near, 1] - d[k, 1] * d[near, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (gap[:, 0] * d[near, 1] - gap[:, 1] * d[near, 0]) / turn
            t = (gap[:, 0] * d[k, 1] - gap[:, 1] * d[k, 0]) / turn
            hit = (s > 0) & (s < 1) & (t > 0) & (t < 1)
        pairs += [(int(k), int(m)) for m in near[hit]]
        if len(pairs) > MOST_CROSSINGS:
            raise TooLargeError(
                f"the lines of the drawing cross each other more than {MOST_CROSSINGS} times, "
                "which is too much to read: give a part of the drawing"
            )
    return pairs


def check_pairs(spots: FloatArray, low: FloatArray, high: FloatArray) -> None:
    """Raises `TooLargeError` if the intervals together contain too many of the sorted spots."""
    held = np.searchsorted(spots, high, side="right") - np.searchsorted(spots, low, side="left")
    if (pairs := int(held.sum())) > MOST_PAIRS:
        raise TooLargeError(
            f"too many lines of the drawing lie above one another: {pairs} pairs would be "
            f"compared, but at most {MOST_PAIRS} are: give a part of the drawing"
        )


def _supporting(points: Sequence[Point], line: Line) -> ExactLine:
    (ax, ay), (bx, by) = points[line.start], points[line.end]
    return (ax, ay), (bx - ax, by - ay)


def _sine(first: ExactLine, second: ExactLine) -> float:
    (dx, dy), (ex, ey) = ((float(x), float(y)) for _, (x, y) in (first, second))
    return abs(dx * ey - dy * ex) / float(np.hypot(dx, dy) * np.hypot(ex, ey))


def _offset(points: Sequence[Point], line: Line, v: int) -> Number:
    (ax, ay), (dx, dy) = _supporting(points, line)
    x, y = points[v]
    return dx * (y - ay) - dy * (x - ax)
