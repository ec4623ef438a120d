"""Exact sheets of all kinds, and FOLD files of them with noise on every coordinate."""

from __future__ import annotations

import random
from fractions import Fraction
from math import cos, sin
from typing import Any

import panel_sheets

from exactfold.branches.counting.ways import count_ways
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import EXAMPLES
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern

Sheet = CreasePattern | PanelPattern

PANELS = {
    "miura of 3": panel_sheets.miura(3, 3),
    "mesh": panel_sheets.mesh(3, 3, 1),
    "tiling": panel_sheets.tiling(3, 3),
    "shifted columns": panel_sheets.shifted_columns(1),
    "twist of 6": panel_sheets.regular_twist(6, (Fraction(3), Fraction(-7))),
    "chicken wire": panel_sheets.chicken_wire(2, 2),
    "two stars": panel_sheets.two_stars(),
    "row of stars": panel_sheets.row_of_stars(),
    "crossed stars": panel_sheets.crossed_stars(),
    "joined twists": panel_sheets.joined_twists(),
}
SHEETS: dict[str, Sheet] = {
    **{name: open_sheet(name).sheet for name in EXAMPLES},
    **{name: make() for name, make in DEGENERATE.items()},
    **PANELS,
}


def noisy(sheet: Sheet, noise: float, seed: int = 0) -> dict[str, Any]:
    """A FOLD object of the sheet whose coordinates are off by up to `noise` of its size."""
    rng = random.Random(seed)
    points = [(float(x), float(y)) for x, y in sheet.vertices]
    size = max(max(axis) - min(axis) for axis in zip(*points, strict=True))
    plain = panels(sheet) if isinstance(sheet, CreasePattern) else sheet
    border = set(plain.boundary_edges)
    return {
        "vertices_coords": [
            [x + rng.uniform(-noise, noise) * size, y + rng.uniform(-noise, noise) * size]
            for x, y in points
        ],
        "edges_vertices": [list(edge) for edge in plain.edges],
        "edges_assignment": ["B" if edge in border else "U" for edge in plain.edges],
    }


def answer(sheet: Any) -> tuple[object, ...]:
    """What a count says: the status and all numbers."""
    result = count_ways(sheet)
    if isinstance(result, BranchCount):
        ways = result.families
        known = (result.status, result.distinct, result.connected_components is None)
        return known if ways is None else (*known, ways.second_order, ways.true)
    return result.status, result.second_order, result.true, result.rigid


def turned(document: dict[str, Any], angle: float = 0.3) -> dict[str, Any]:
    """The same sheet turned by an angle that no small numbers describe, and scaled."""
    c, s = 123.456 * cos(angle), 123.456 * sin(angle)
    points = [[c * x - s * y, s * x + c * y] for x, y in document["vertices_coords"]]
    return {**document, "vertices_coords": points}
