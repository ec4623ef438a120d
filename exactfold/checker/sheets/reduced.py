"""The part of a sheet that can fold: vertices inside 3-cycles are removed, a notch is closed."""

from __future__ import annotations

from typing import Any

from ..core.reading import items, keys, natural, require
from .sheet import Edge, Sheet, turn


def emptied_sheet(given: Sheet, points: dict[int, Any], evidence: Any) -> tuple[Sheet, set[int]]:
    """The sheet without the vertices inside the listed 3-cycles, and the set of these vertices.

    `points` are the coordinates to use, such as those of `given` scaled to integers.
    """
    removed: set[int] = set()
    added: list[tuple[int, ...]] = []
    edges = set(given.edges)
    for entry in items(evidence, "emptied"):
        keys(entry, "corners inside", "3-cycle")
        a, b, c = (natural(v, "corner") for v in items(entry["corners"], "corners", 3))
        for i, j in ((a, b), (b, c), (a, c)):
            require((min(i, j), max(i, j)) in edges, f"{i}-{j} is not an edge")
        for v in (natural(v, "vertex inside") for v in items(entry["inside"], "inside")):
            sides = [turn(points[i], points[j], points[v]) for i, j in ((a, b), (b, c), (c, a))]
            require(min(sides) > 0, f"vertex {v} is not inside {(a, b, c)}")
            removed.add(v)
        added.append((a, b, c))
    kept = [given.face(t) for t in given.triangles if removed.isdisjoint(t)]
    # `Sheet` verifies the rest again: it is one disk of counter-clockwise faces.
    rest = {v: p for v, p in points.items() if v not in removed}
    return Sheet(rest, [*kept, *added]), removed


def merged_sheet(sheet: Sheet, evidence: Any) -> tuple[Sheet, dict[int, Edge | None]]:
    """The sheet in which the listed triangles are single faces, and the vertices left out.

    A vertex on a side of such a triangle has this side, and a vertex inside has None. The boundary
    stays, and every face of the sheet lies in one face of the result: heights that are linear on
    the faces of the result are so on those of the sheet.
    """
    points = sheet.points
    places: dict[int, Edge | None] = {}
    added: list[tuple[int, ...]] = []
    groups: dict[int, list[set[int]]] = {}
    for entry in items(evidence, "merged"):
        keys(entry, "corners others", "merged triangle")
        a, b, c = (natural(v, "corner") for v in items(entry["corners"], "corners", 3))
        others = [natural(v, "vertex") for v in items(entry["others"], "others")]
        group = {a, b, c, *others}
        for v in others:
            groups.setdefault(v, []).append(group)
            sides = {(i, j): turn(points[i], points[j], points[v]) for i, j in _ends(a, b, c)}
            require(min(sides.values()) >= 0, f"vertex {v} is not in the triangle {(a, b, c)}")
            on = [(min(side), max(side)) for side, off in sides.items() if off == 0]
            if on or v not in places:
                places[v] = on[0] if on else None
        added.append((a, b, c))
    faces = [sheet.face(t) for t in sheet.triangles]
    for face in faces:
        near = [group for v in face for group in groups.get(v, [])]
        require(
            not near or any(group.issuperset(face) for group in near),
            "a face at a merged vertex lies in no merged triangle",
        )
    kept = [face for face in faces if places.keys().isdisjoint(face)]
    rest = Sheet({v: p for v, p in points.items() if v not in places}, [*kept, *added])
    require(rest.boundary == sheet.boundary, "merged triangles change the boundary")
    return rest, places


def _ends(a: int, b: int, c: int) -> tuple[Edge, Edge, Edge]:
    return (a, b), (b, c), (c, a)


def closed(sheet: Sheet) -> tuple[Sheet, int | None]:
    """The sheet with the notch at its reflex corner closed by a face, and this corner.

    If no corner is reflex: the sheet itself and None.
    """
    cycle = sheet.boundary
    for k, v in enumerate(cycle):
        before, after = cycle[k - 1], cycle[(k + 1) % len(cycle)]
        if turn(*(sheet.points[u] for u in (before, v, after))) < 0:
            faces = [sheet.face(t) for t in sheet.triangles]
            return Sheet(sheet.points, [*faces, (before, after, v)]), v
    return sheet, None


def check_convex(sheet: Sheet) -> None:
    """Raise unless the boundary is convex."""
    cycle = sheet.boundary
    for k, v in enumerate(cycle):
        corner = (cycle[k - 1], v, cycle[(k + 1) % len(cycle)])
        side = turn(*(sheet.points[u] for u in corner))
        require(side >= 0, "the boundary is not convex")
