"""A picture of all fold angles along a motion."""

from __future__ import annotations

from itertools import groupby
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted, plural
from exactfold.app.pictures import svg
from exactfold.motion.curves.events import (
    CHANGE,
    CONTACT,
    FLAT_FOLD,
    LENGTH,
    NODE,
    PASSED,
    RETURN,
    SINGULAR,
    TURNING,
    Event,
)
from exactfold.motion.curves.in_motion import SheetInMotion

_WIDTH, _HEIGHT = 960.0, 600.0
_LEFT, _RIGHT, _TOP, _BOTTOM = 64.0, 92.0, 150.0, 52.0
_LABELLED: Final = 28
"""With up to this many folds, each fold has its own colour and label."""
_DRAWN: Final = 600
_APART: Final = 18.0
"""Names of events are at least this many pixels apart."""
_LONGEST: Final = 36
"""The name of an event has at most this many characters."""
_DASHES: Final = (None, "7 3", "2 2.5", "9 3 2 3")
_NAMES: Final = {
    CONTACT: "contact",
    FLAT_FOLD: "closed",
    NODE: "node",
    SINGULAR: "singular",
    RETURN: "flat again",
}


def angles_plot(motion: SheetInMotion, title: str = "") -> str:
    """All fold angles in degrees along a motion, as the text of an SVG file.

    Valleys are above 0, and mountains below. With up to 28 folds, each line has its own colour and
    label. With more, the colour of a line shows the direction in which the fold starts. With more
    than 600 folds, only those with the largest angles are drawn. Events are thin vertical lines.
    """
    times, angles = motion.sampled()
    degrees = np.degrees(angles)
    shown = _shown(degrees)
    reach = max(float(np.max(np.abs(degrees), initial=0.0)), 1.0)
    # The scale reaches from the least to the largest angle, with a margin; 0 is always in it.
    low, high = min(0.0, float(degrees.min())), max(0.0, float(degrees.max()))
    across = svg.Scale(0.0, motion.duration, _LEFT, _WIDTH - _RIGHT)
    down = svg.Scale(high + 0.04 * reach, low - 0.04 * reach, _TOP, _HEIGHT - _BOTTOM)
    few = len(shown) <= _LABELLED
    parts = [
        *_heading(motion, title, len(shown), degrees.shape[1]),
        *_axes(across, down, f"time ({motion.time_name})"),
        *_events(motion, across),
        *_lines(times, degrees, shown, across, down, few=few),
    ]
    if few:
        parts += _labels(motion, degrees, shown, down)
    name = f"Fold angles of {title or 'a sheet'} along {motion.name}"
    return svg.picture(_WIDTH, _HEIGHT, parts, name)


def _shown(degrees: FloatArray) -> list[int]:
    """The folds that are drawn: all, or those with the largest angles, in order."""
    sizes = np.max(np.abs(degrees), axis=0, initial=0.0)
    return sorted(int(k) for k in np.argsort(-sizes, kind="stable")[:_DRAWN])


def _heading(motion: SheetInMotion, title: str, shown: int, folds: int) -> list[str]:
    lead = f"{title}: " if title else ""
    drawn = counted(folds, "fold")
    if shown < folds:
        drawn = f"the {shown} of {drawn} with the largest angles"
    if shown > _LABELLED:
        drawn += ", blue where they start as valleys, orange where as mountains"
    return [
        svg.text(f"{lead}fold angles along {motion.name}", _LEFT, 28, size=17),
        svg.text(f"{drawn}; valley above 0, mountain below", _LEFT, 47, fill="#555555"),
    ]


def _axes(across: svg.Scale, down: svg.Scale, time_text: str) -> list[str]:
    parts = []
    bottom, right = _HEIGHT - _BOTTOM, _WIDTH - _RIGHT
    for angle in svg.ticks(down.high, down.low, 11, (1, 2, 5, 10, 15, 30, 45, 60, 90, 180)):
        y = down(angle)
        colour, width = ("#777777", 1.2) if not angle else (svg.FAINT, 1)
        parts.append(svg.line((_LEFT, y), (right, y), colour, width))
        parts.append(svg.text(f"{angle:g}°".replace("-", "−"), _LEFT - 8, y + 4, anchor="end"))
    for time in svg.ticks(0.0, across.high, 9):
        x = across(time)
        parts.append(svg.line((x, bottom), (x, bottom + 5), "#777777"))
        parts.append(svg.text(f"{time:g}", x, bottom + 19, anchor="middle"))
    parts.append(svg.line((_LEFT, bottom), (right, bottom), "#777777"))
    middle = (_LEFT + right) / 2
    parts.append(svg.text(time_text, middle, _HEIGHT - 12, anchor="middle", size=13))
    return parts


def _events(motion: SheetInMotion, across: svg.Scale) -> list[str]:
    """A vertical line for every time of events, and names for times that are not too close
    together.
    """
    parts, labels = [], []
    placed = [(across(event.time[1]), event) for event in motion.events]
    for x, group in groupby(placed, key=lambda item: round(item[0], 1)):
        events = [event for _, event in group]
        turning = all(event.kind in PASSED for event in events)
        parts.append(
            svg.line(
                (x, _TOP),
                (x, _HEIGHT - _BOTTOM),
                "#aaaaaa" if turning else svg.INK,
                0.8,
                stroke_dasharray="3 3" if turning else "none",
            )
        )
        labels.append((x, events))
    middle = across(0.7 * across.high)
    for x, events in _apart(labels):
        # Names lean away from the nearer border.
        turn, anchor = (-40, "start") if x < middle else (40, "end")
        where = f"translate({svg.number(x)} {svg.number(_TOP - 7)}) rotate({turn})"
        parts.append(svg.text(_name(events), 0, 0, size=11, anchor=anchor, transform=where))
    return parts


def _apart(labels: list[tuple[float, list[Event]]]) -> list[tuple[float, list[Event]]]:
    """Labels with some pixels between them; labels that are closer are joined."""
    joined: list[tuple[float, list[Event]]] = []
    for x, events in labels:
        if joined and x - joined[-1][0] < _APART:
            joined[-1] = (joined[-1][0], joined[-1][1] + events)
        else:
            joined.append((x, events))
    return joined


def _name(events: list[Event]) -> str:
    """A few words for events at about the same time."""
    words = []
    for kind, group in groupby(sorted(events, key=lambda e: e.kind == TURNING), lambda e: e.kind):
        events_of_kind = list(group)
        folds = [f"{i}-{j}" for event in events_of_kind for i, j in event.folds]
        if kind == TURNING:
            some = folds[0] if len(folds) == 1 else counted(len(folds), "fold")
            words.append(f"{some} {'turns' if len(folds) == 1 else 'turn'} back")
        elif kind == CHANGE:
            some = folds[0] if len(folds) == 1 else counted(len(folds), "fold")
            words.append(f"{some} through flat")
        elif kind in _NAMES:
            named = f"{', '.join(folds[:2])} " if kind == FLAT_FOLD and len(folds) <= 2 else ""
            words.append(f"{named}{_NAMES[kind]}")
        elif kind != LENGTH:
            words.append(f"{'fold' if len(folds) == 1 else plural('fold')} {', '.join(folds[:2])}")
    while len(words) > 1 and len("; ".join(words)) > _LONGEST:
        words = [*words[:-2], "..."] if words[-1] == "..." else [*words[:-1], "..."]
    return "; ".join(words)


def _lines(
    times: FloatArray,
    degrees: FloatArray,
    shown: list[int],
    across: svg.Scale,
    down: svg.Scale,
    *,
    few: bool,
) -> list[str]:
    xs = [across(float(t)) for t in times]
    parts = []
    for n, k in enumerate(shown):
        points = [(x, down(float(y))) for x, y in zip(xs, degrees[:, k], strict=True)]
        parts.append(
            svg.path(
                points,
                fill="none",
                stroke=_colour(n) if few else _direction(degrees[:, k]),
                stroke_width=1.8 if few else 0.9,
                stroke_opacity=1 if few else max(0.25, min(0.8, 30 / len(shown))),
                stroke_linejoin="round",
                stroke_dasharray=_dash(n) if few else "none",
            )
        )
    return parts


def _colour(place: int) -> str:
    return svg.COLOURS[place % len(svg.COLOURS)]


def _dash(place: int) -> str:
    return _DASHES[place // len(svg.COLOURS) % len(_DASHES)] or "none"


def _direction(angles: FloatArray) -> str:
    """The colour of a valley or a mountain, depending on how the fold starts."""
    first = float(angles[min(1, len(angles) - 1)])
    return svg.VALLEY if first > 0 else svg.MOUNTAIN


def _labels(
    motion: SheetInMotion, degrees: FloatArray, shown: list[int], down: svg.Scale
) -> list[str]:
    """The name of each fold beside the end of its line."""
    right, folds = _WIDTH - _RIGHT, motion.pattern.folds
    # The names of lines that end in one place are in the order in which the lines arrive there.
    late = degrees[len(degrees) * 2 // 3 :].mean(axis=0)
    ends = [down(float(degrees[-1, k] + 1e-3 * late[k])) for k in shown]
    parts = []
    for n, (k, end, place) in enumerate(
        zip(shown, ends, svg.spread(ends, 13, _TOP, _HEIGHT - _BOTTOM), strict=True)
    ):
        i, j = folds[k]
        colour = _colour(n)
        parts.append(svg.line((right + 2, end), (right + 16, place), colour, 0.8))
        parts.append(svg.text(f"{i}-{j}", right + 19, place + 4, fill=colour))
    return parts
