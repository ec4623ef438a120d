"""Turned copies of sheets whose coordinates are small numbers."""

from __future__ import annotations

import random
from fractions import Fraction
from math import cos, sin
from typing import Any

import pytest
from panel_sheets import miura

from exactfold.pattern.drawing.meant.turning import turned_positions
from exactfold.pattern.families import two_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern


def turned(sheet: PanelPattern, noise: float) -> tuple[tuple[Fraction, Fraction], ...]:
    """The points, turned by 0.3, 100 times as large, with 15 decimals that are inexact."""
    rng = random.Random(4)
    c, s = 100 * cos(0.3), 100 * sin(0.3)
    places = [(float(x), float(y)) for x, y in sheet.vertices]

    def written(value: float) -> Fraction:
        return round(Fraction(value + 100 * noise * rng.uniform(-1, 1)), 15)

    return tuple((written(c * x - s * y), written(s * x + c * y)) for x, y in places)


def shape(points: Any) -> list[tuple[Any, Any]]:
    """The points in the frame of the first two: what no similarity changes."""
    (a, b), (c, d) = points[0], points[1]
    c, d = c - a, d - b
    square = Fraction(1) / (c * c + d * d)
    return [
        ((c * (x - a) + d * (y - b)) * square, (c * (y - b) - d * (x - a)) * square)
        for x, y in points
    ]


@pytest.mark.parametrize("sheet", [miura(3, 3), panels(two_vertex())], ids=["miura", "triangles"])
@pytest.mark.parametrize("noise", [1e-12, 1e-7])
def test_a_turned_sheet_is_found_up_to_a_similarity(sheet: PanelPattern, noise: float) -> None:
    written = turned(sheet, noise)
    points = turned_positions(written, sheet.edges, noise)
    assert points is not None
    size = max(float(max(axis) - min(axis)) for axis in zip(*written, strict=True))
    for point, near in zip(points, written, strict=True):
        assert all(abs(float(x - y)) < 10 * noise * size for x, y in zip(point, near, strict=True))
    assert shape(points) == shape(sheet.vertices)


def test_random_points_are_small_in_no_frame() -> None:
    rng = random.Random(1)
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points = [tuple(Fraction(c + rng.random() / 3) for c in corner) for corner in corners]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3)]
    assert turned_positions(tuple((x, y) for x, y in points), edges, 1e-9) is None
