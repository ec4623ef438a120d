"""Conditions on a sheet with holes that rounding may have made: lines that nearly depend on others.

Floats tell nearly from exactly. Nothing here is part of a proof: it says of which answers nobody
should claim that they are about the sheet that was meant.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.panels.vertex.holes import hole_of, rims
from exactfold.panels.vertex.stars import edge_of
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.rounding import size_of

_EXACT: Final = 1e-11
"""A smaller singular value, over the largest, is one of conditions that depend on each other."""
_MOST_FOLDS: Final = 2000
_MOST_MOTIONS: Final = 100
_STARTS: Final = 10
_NAMED: Final = 4
"""So many folds that nearly fold are named."""


def nearly_dependent(pattern: PanelPattern, limit: float, step: float) -> str:
    """A sentence on the hole whose lines are the nearest to depend on each other, but do not.

    They nearly pass through one point, are nearly parallel, or nearly one line. Singular values say
    by how much they miss that. The sentence is empty if no lines miss it by less than the limit, or
    by less than they turn where the ends of the shortest fold move by `step`, a share of the size.
    """
    nearest, at = 1.0, -1
    step *= 2 * size_of(pattern.scaled_vertices)
    for rim in rims(pattern):
        hole = hole_of(pattern, rim, frozenset())
        if hole.rank < 2:
            continue
        lines = np.array([[float(x) for x in twist] for twist in hole.twists])
        lengths = np.hypot(lines[:, 0], lines[:, 1])
        lines /= lengths[:, None]
        lines[:, 2] /= max(1e-300, float(np.abs(lines[:, 2]).max()))
        values = np.linalg.svd(lines, compute_uv=False)
        off = float(values[hole.rank - 1] / values[0])
        if off < min(nearest, max(limit, step / float(lengths.min()))):
            nearest, at = off, rim.vertices[0]
    if at < 0:
        return ""
    return (
        f"the lines of the folds round the hole at vertex {at} nearly pass through one point, or "
        f"are nearly parallel, off by {nearest:.1e}"
    )


def nearly_moves(pattern: PanelPattern, limit: float, *, rigid: bool) -> str:
    """A sentence on a motion that misses the conditions by less than the limit, but not exactly.

    To first order these are all conditions together: a singular value says by how much they miss
    to depend on each other, as where two panels hang together by folds of which two are nearly on
    one line. Of a `rigid` sheet floats look for a motion that nearly meets those of second order.
    The sentence is empty if there is none, or if the sheet is too large to look for it.
    """
    folds = {fold: k for k, fold in enumerate(pattern.folds)}
    if not folds or len(folds) > _MOST_FOLDS:
        return ""
    loops = [*_loops(pattern, folds)]
    rows = []
    for at, lines in loops:
        row = np.zeros((lines.shape[1], len(folds)))
        np.add.at(row.T, at, lines)
        rows.append(row)
    _, values, turned = np.linalg.svd(np.concatenate(rows))
    values /= values[0]
    near = np.flatnonzero((values > _EXACT) & (values < limit))
    if near.size:
        weights = np.abs(turned[near[0]])
        most = np.argsort(-weights, kind="stable")[:_NAMED]
        named = [pattern.folds[k] for k in most if weights[k] > weights.max() / 2]
        texts = ", ".join(f"{i}-{j}" for i, j in sorted(named))
        return (
            f"the lines of the folds nearly let {texts} fold, as where two folds between the same "
            f"panels are nearly on one line, off by {values[near[0]]:.1e}"
        )
    motions = turned[int((values > _EXACT).sum()) :].T
    if not rigid or not 0 < motions.shape[1] <= _MOST_MOTIONS:
        return ""
    forms = np.concatenate([_forms(motions[at], lines) for at, lines in loops])
    off = _least(forms)
    return (
        f"the panels nearly start to fold: a motion misses the second-order conditions by {off:.1e}"
        if off < limit
        else ""
    )


def _loops(
    pattern: PanelPattern, folds: dict[tuple[int, int], int]
) -> Iterator[tuple[list[int], FloatArray]]:
    """For each vertex and each hole: the numbers of its folds, and their lines.

    The lines round a hole are (x, y, m): a unit vector, and the moment about the first corner of
    the hole, over the largest.
    """
    size = size_of(pattern.scaled_vertices)
    for v in pattern.interior:
        rays = [fold for fold in pattern.folds if v in fold]
        ends = [fold[0] if fold[1] == v else fold[1] for fold in rays]
        lines = np.array([[float(x) for x in pattern.direction(v, u)] for u in ends])
        angles = np.argsort(np.arctan2(lines[:, 1], lines[:, 0]))
        lines = (lines / np.hypot(lines[:, 0], lines[:, 1])[:, None])[angles]
        yield [folds[rays[k]] for k in angles], lines
    for rim in rims(pattern):
        if not rim.crossed:
            continue
        twists = hole_of(pattern, rim, frozenset()).twists
        lines = np.array([[float(x) for x in twist] for twist in twists])
        lines /= np.hypot(lines[:, 0], lines[:, 1])[:, None]
        lines[:, 2] /= max(1e-9 * size, float(np.abs(lines[:, 2]).max()))
        yield [folds[edge_of(*crossed)] for crossed in rim.crossed], lines


def _forms(motions: FloatArray, lines: FloatArray) -> FloatArray:
    """The second-order conditions of a loop, as symmetric matrices on a space of motions."""
    later = np.triu(np.ones((len(lines), len(lines))), 1)
    axes = combinations(range(lines.shape[1]), 2)
    brackets = [
        (np.outer(lines[:, a], lines[:, b]) - np.outer(lines[:, b], lines[:, a])) * later
        for a, b in axes
    ]
    found = [motions.T @ (one + one.T) @ motions / 2 for one in brackets]
    return np.array(found)


def _least(forms: FloatArray) -> float:
    """The least largest value of the forms at unit vectors that a search from a few finds."""
    from scipy.optimize import least_squares

    def values(x: FloatArray) -> FloatArray:
        return np.append(x @ forms @ x, x @ x - 1)

    def slopes(x: FloatArray) -> FloatArray:
        return np.vstack([2 * (forms @ x), 2 * x])

    random = np.random.default_rng(0)
    starts = random.normal(size=(_STARTS, forms.shape[1]))
    ends = [least_squares(values, x / np.linalg.norm(x), slopes).x for x in starts]
    return min(float(np.abs(x @ forms @ x).max() / (x @ x)) for x in ends if x @ x > 0.25)
