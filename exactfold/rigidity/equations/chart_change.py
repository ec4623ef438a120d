"""Converts approximate heights of sheets to points of a chart, and back."""

from __future__ import annotations

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.gauge import pattern_size

_INFINITY = 1e-12


def to_chart(chart: Chart, heights: FloatArray) -> FloatArray:
    """Points of the chart, shape (m, n), for sheets given by all heights, shape (m, V).

    Each sheet is tilted so that the pinned vertices have height 0, and scaled so that the
    functional is 1. Sheets at infinity of the chart, on which the functional vanishes, are left
    out.
    """
    pattern = chart.branch_system.pattern
    size, (x0, y0) = pattern_size(pattern), pattern.vertices[0]
    plane = np.array(
        [[float((x - x0) / size), float((y - y0) / size), 1.0] for x, y in pattern.vertices]
    )
    pinned = list(chart.branch_system.pinned)
    tilt = np.linalg.solve(plane[pinned], heights[:, pinned].T)
    level = heights - (plane @ tilt).T
    weights = np.zeros(len(plane))
    for v, weight in chart.functional.items():
        weights[v] = float(weight)
    values = level @ weights
    reached = np.abs(values) > _INFINITY * np.abs(level).max(axis=1, initial=0.0)
    return np.asarray((level[reached] / values[reached, None])[:, list(chart.variables)])


def between(start: Chart, end: Chart, points: FloatArray) -> FloatArray:
    """Converts points of one chart to another chart of the same sheet.

    Points at infinity of the other chart are left out.
    """
    return points if start == end else to_chart(end, from_chart(start, points))


def from_chart(chart: Chart, points: FloatArray) -> FloatArray:
    """The heights of all vertices, shape (m, V), at points of the chart, shape (m, n)."""
    count, n = len(chart.branch_system.pattern.vertices), points.shape[1]
    rows = np.zeros((count, n + 1))
    for v in range(count):
        for k, a in chart.row(v).items():
            rows[v, k] = float(a)
    return np.asarray(points @ rows[:, :n].T + rows[:, n])
