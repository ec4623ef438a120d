"""A picture of the branches of a periodic sheet over the circle of directions."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.app.pictures import svg
from exactfold.branches.periodic.directions_result import DirectionsCount
from exactfold.branches.periodic.sampled import SampledBranch, sampled_directions

_WIDTH: Final = 960.0
_LEFT, _RIGHT = 64.0, 100.0
_TOP, _TALL = 74.0, 260.0
_ROW, _PANEL = 190.0, 140.0
_SAMPLES: Final = 180
_NAMED: Final = 16
"""With up to this many branches, or folds, each line has a label."""
_MOST: Final = 128
FIRST: Final = 8
"""The folds of so many branches are drawn unless another number is asked for."""
_DASHES: Final = (None, "7 3", "2 2.5", "9 3 2 3")


def directions_plot(
    result: DirectionsCount, title: str = "", most: int = FIRST, progress: Progress | None = None
) -> str:
    """b of all branches, and the fold angles of the first ones, by direction: an SVG file.

    All lines are in floating point and scaled so that the largest fold is 1. Branches that are one
    analytic sheet have one colour. Vertical lines are the crossings that are known. More than 128
    branches are not drawn.
    """
    angles, branches = sampled_directions(result.pattern, _SAMPLES, progress)
    drawn, shown = branches[:_MOST], branches[:most]
    rows = ceil(len(shown) / 2)
    height = _TOP + _TALL + 66 + rows * _ROW
    parts = [*_heading(result, title, len(branches)), *_bends(result, angles, drawn)]
    names = [f"{u}-{v}" + (f"({i},{j})" if i or j else "") for u, v, i, j in result.pattern.edges]
    place = dict(zip(_kept(result), range(len(result.pattern.edges)), strict=False))
    labels = [names[k] for k in place]
    for k, branch in enumerate(shown):
        corner = (_LEFT + (k % 2) * (_WIDTH / 2 - 10), _TOP + _TALL + 80 + k // 2 * _ROW)
        parts += _folds(result, angles, branch, k + 1, corner, labels)
    name = f"Branches of {title or 'a periodic sheet'} by direction"
    return svg.picture(_WIDTH, height, parts, name)


def _kept(result: DirectionsCount) -> list[int]:
    """The edges of the pattern that are not inside triangulated triangles, in order."""
    from exactfold.pattern.periodic.rigid_parts import without_rigid_parts

    gone = set(without_rigid_parts(result.pattern).rigid)
    return [k for k, (u, v, *_) in enumerate(result.pattern.edges) if not {u, v} & gone]


def _heading(result: DirectionsCount, title: str, number: int) -> list[str]:
    lead = f"{title}: " if title else ""
    if result.status is PROVED:
        crossings = len(result.crossings)
        sheets = len(result.cycles or ())
        known = (
            f"{crossings} {agreeing(crossings, 'crossing')} and "
            f"{sheets} analytic {agreeing(sheets, 'sheet')}, proved"
        )
    else:
        known = "crossings undecided"
    drawn = f", the first {_MOST} are drawn" if number > _MOST else ""
    return [
        svg.text(f"{lead}{counted(number, 'branch')} by direction", _LEFT, 28, size=17),
        svg.text(
            f"{known}; lines in floating point{drawn}. Curvature b of the cylinder times the root "
            "of the cell's area, where the largest fold is 1",
            _LEFT,
            47,
            fill="#555555",
        ),
    ]


def _frame(
    result: DirectionsCount, across: svg.Scale, down: svg.Scale, marks: Sequence[float]
) -> list[str]:
    parts = []
    for value in marks:
        y = down(value)
        colour, width = ("#777777", 1.2) if not value else (svg.FAINT, 1)
        parts.append(svg.line((across.start, y), (across.end, y), colour, width))
        name = f"{value:g}".replace("-", "−")
        parts.append(svg.text(name, across.start - 8, y + 4, anchor="end"))
    for angle in range(0, 181, 30):
        x = across(angle)
        parts.append(svg.line((x, down.end), (x, down.end + 5), "#777777"))
        parts.append(svg.text(f"{angle}°", x, down.end + 18, anchor="middle", size=11))
    parts.append(svg.line((across.start, down.end), (across.end, down.end), "#777777"))
    parts += [
        svg.line((x, down.start), (x, down.end), "#888888", 0.8, stroke_dasharray="3 3")
        for x in sorted({round(across(crossing.angle), 1) for crossing in result.crossings})
    ]
    return parts


def _bends(
    result: DirectionsCount, angles: FloatArray, branches: Sequence[SampledBranch]
) -> list[str]:
    values = np.array([branch.b for branch in branches])
    finite = values[np.isfinite(values)]
    low, high = min(0.0, float(finite.min())), max(0.0, float(finite.max()))
    margin = 0.05 * max(high - low, 1e-9)
    across = svg.Scale(0.0, 180.0, _LEFT, _WIDTH - _RIGHT)
    down = svg.Scale(high + margin, low - margin, _TOP, _TOP + _TALL)
    parts = _frame(result, across, down, svg.ticks(low, high, 9))
    colours = _colours(result, len(branches))
    for branch, colour in zip(branches, colours, strict=True):
        points = _points(angles, branch.b, across, down)
        parts.append(svg.path(points, fill="none", stroke=colour, stroke_width=1.6))
    if len(branches) <= _NAMED:
        ends = [down(float(branch.b[-1])) for branch in branches]
        ys = svg.spread(ends, 12, _TOP, _TOP + _TALL)
        for branch, colour, y in zip(branches, colours, ys, strict=True):
            parts.append(svg.text(branch.vertex_signs, _WIDTH - _RIGHT + 8, y + 4, fill=colour))
    middle = (across.start + across.end) / 2
    parts.append(
        svg.text(
            "direction across the axis of the cylinder", middle, _TOP + _TALL + 38, anchor="middle"
        )
    )
    return parts


def _colours(result: DirectionsCount, number: int) -> list[str]:
    """One colour for each analytic sheet; for each branch if the sheets are not known."""
    cycles = result.cycles or tuple((k + 1,) for k in range(number))
    of = {k: svg.COLOURS[n % len(svg.COLOURS)] for n, cycle in enumerate(cycles) for k in cycle}
    return [of[k + 1] for k in range(number)]


def _points(
    angles: FloatArray, values: FloatArray, across: svg.Scale, down: svg.Scale
) -> list[tuple[float, float]]:
    return [
        (across(float(x)), down(float(y)))
        for x, y in zip(angles, values, strict=True)
        if np.isfinite(y)
    ]


def _folds(
    result: DirectionsCount,
    angles: FloatArray,
    branch: SampledBranch,
    number: int,
    corner: tuple[float, float],
    names: Sequence[str],
) -> list[str]:
    left, top = corner
    across = svg.Scale(0.0, 180.0, left, left + _WIDTH / 2 - 150)
    down = svg.Scale(1.05, -1.05, top, top + _PANEL)
    parts = [
        svg.text(f"{number}  {branch.vertex_signs}: folds, valley above 0", left, top - 8, size=13),
        *_frame(result, across, down, (-1, 0, 1)),
    ]
    folds = branch.folds.T
    for k, values in enumerate(folds):
        parts.append(
            svg.path(
                _points(angles, values, across, down),
                fill="none",
                stroke=svg.COLOURS[k % len(svg.COLOURS)],
                stroke_width=1.3,
                stroke_dasharray=_DASHES[k // len(svg.COLOURS) % len(_DASHES)] or "none",
            )
        )
    if len(folds) <= _NAMED:
        ends = [down(float(values[-1])) for values in folds]
        for k, y in enumerate(svg.spread(ends, 10.5, top - 8, top + _PANEL - 4)):
            colour = svg.COLOURS[k % len(svg.COLOURS)]
            parts.append(svg.text(names[k], across.end + 6, y + 3, size=10, fill=colour))
    return parts
