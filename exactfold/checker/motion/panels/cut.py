"""Cutting panels into triangles, so that the tests for triangles can be used for panels.

Every simple polygon with more than three corners has two ears: corners that turn left, strictly,
with no other corner in their closed triangle. Proof: let v be a strictly convex corner with the
neighbours u and w. A diagonal is u w or, if other corners are in the closed triangle u v w, the one
from v to one of these that is farthest from the line u w. It runs in the inside, so that both parts
are simple polygons. By induction diagonals cut the polygon into triangles. Two of these have two
sides of the polygon each. They have no other corner in them, because all corners are corners of
triangles, and these overlap in sides only.
"""

from __future__ import annotations

from ...core.reading import require
from ...sheets.panels import Edge, PanelSheet, cross

Triangle = tuple[int, int, int]


def cut(sheet: PanelSheet, panel: tuple[int, ...]) -> list[Triangle]:
    """Triangles that make up a panel, counter-clockwise; their corners are corners of the panel.

    Ears are cut off one after the other. An ear is a corner that turns left, with its two
    neighbours, such that no other remaining corner lies inside this triangle or on its sides. Every
    simple polygon has an ear.
    """
    require(len(set(panel)) == len(panel), f"the panel {panel} passes a corner twice")
    left, triangles = list(panel), []
    while len(left) > 3:
        k = next(k for k in range(len(left)) if _is_ear(sheet, left, k))
        triangles.append(_corner(left, k))
        del left[k]
    triangles.append(_corner(left, 1))
    return triangles


def _corner(walk: list[int], k: int) -> Triangle:
    return walk[k - 1], walk[k], walk[(k + 1) % len(walk)]


def _is_ear(sheet: PanelSheet, walk: list[int], k: int) -> bool:
    triangle = _corner(walk, k)
    if _turn(sheet, *triangle) <= 0:
        return False
    a, b, c = triangle
    others = [v for v in walk if v not in triangle]
    return not any(
        all(_turn(sheet, *side, v) >= 0 for side in ((a, b), (b, c), (c, a))) for v in others
    )


def _turn(sheet: PanelSheet, a: int, b: int, c: int) -> int:
    return cross(sheet.vector(a, b), sheet.vector(a, c)).sign()


def from_least(corners: tuple[int, ...]) -> tuple[int, ...]:
    """The corners of a panel in the same cyclic order, beginning with the smallest number."""
    first = corners.index(min(corners))
    return corners[first:] + corners[:first]


def panels_of(sheet: PanelSheet) -> dict[Edge, int]:
    """For each edge, in each of its two directions, the panel to its left."""
    return {
        side: k
        for k, panel in enumerate(sheet.panels)
        for side in zip(panel, (*panel[1:], panel[0]), strict=True)
    }
