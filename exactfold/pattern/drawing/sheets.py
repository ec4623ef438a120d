"""Finds the boundary of a drawing, and separates its sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import agreeing, counted
from exactfold.errors import DisconnectedError, FoldError, MalformedPatternError, NotADiskError
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.mending import Repair, floats, lost, repair, used, with_lines


@dataclass(frozen=True)
class _Part:
    """A connected set of lines: the cycles of their faces, and the outline around all of them."""

    lines: tuple[Line, ...]
    outline: tuple[int, ...]
    faces: tuple[tuple[int, ...], ...]


def bordered(drawing: Drawing) -> tuple[Drawing, list[Repair]]:
    """Gives the letter B to the lines round each sheet of the drawing, whatever letters they have.

    Creases that lie inside a panel keep their letters, as they are not round a sheet.
    """
    parts, places = _parts(drawing), floats(drawing.points)
    outer = [part for part in parts if not any(_nested(part, other, places) for other in parts)]
    round_it = {frozenset(pair) for part in outer for pair in _sides(part.outline)}
    lines = []
    changed = []
    for line in drawing.lines:
        if line.letter != "B" and frozenset(line[:2]) in round_it:
            changed.append(line)
            line = Line(line.start, line.end, "B")
        lines.append(line)
    sentence = (
        f"{counted(len(changed), 'line')} round the sheet {agreeing(len(changed), 'is')} "
        "taken for the boundary"
    )
    at = [line.start for line in changed]
    made = repair("border", len(changed), at, drawing.points, sentence)
    missed = lost(drawing, changed)
    return with_lines(drawing, lines), [replace(each, lost=missed) for each in made]


def sheets(drawing: Drawing) -> tuple[Drawing, ...]:
    """Each sheet of a drawing on its own, with the points that lie on its lines.

    The drawing must come from `repaired`: lines meet only in common ends, and the boundary is B.

    Raises `MalformedPatternError` if the lines enclose nothing, `NotADiskError` for a sheet with a
    hole, and `FoldError` for a line B or C between two panels. Raises `DisconnectedError` for
    creases inside a panel that no line joins to the rest, and for lines that enclose nothing; such
    lines are not dropped here.
    """
    parts = _parts(drawing)
    if not parts:
        raise MalformedPatternError(
            "the lines of the drawing enclose no face: draw the boundary of the sheet"
        )
    places = floats(drawing.points)
    _check_all(drawing, parts, places)
    for part in parts:
        _check_nested(part, parts, places)
        _check_inside(part, places)
    return tuple(_alone(drawing, part) for part in parts)


def _parts(drawing: Drawing) -> list[_Part]:
    places = floats(drawing.points)
    graph = nx.Graph()
    graph.add_edges_from((line.start, line.end) for line in drawing.lines if line.start != line.end)
    parts = []
    for members in sorted(nx.connected_components(graph), key=min):
        lines = tuple(line for line in drawing.lines if line.start in members)
        cycles = _cycles(places, lines)
        areas = [_area(places, cycle) for cycle in cycles]
        faces = tuple(c for c, area in zip(cycles, areas, strict=True) if area > 0)
        if faces:
            parts.append(_Part(lines, cycles[int(np.argmin(areas))], faces))
    return parts


def _cycles(places: FloatArray, lines: Sequence[Line]) -> list[tuple[int, ...]]:
    """The cycles of all faces, the outer one clockwise; angles in floats order the lines.

    The pattern that is made of the sheet traces and checks the exact faces.
    """
    around: dict[int, set[int]] = {}
    for a, b, _ in lines:
        around.setdefault(a, set()).add(b)
        around.setdefault(b, set()).add(a)
    clockwise: dict[tuple[int, int], int] = {}
    for v, near in around.items():
        offset = {u: places[u] - places[v] for u in near}
        order = sorted(near, key=lambda u: (float(np.arctan2(offset[u][1], offset[u][0])), u))
        for k, u in enumerate(order):
            clockwise[v, u] = order[k - 1]
    unseen = dict.fromkeys((v, u) for v in sorted(around) for u in sorted(around[v]))
    cycles = []
    for v, u in tuple(unseen):
        if (v, u) not in unseen:
            continue
        cycle = []
        while (v, u) in unseen:
            del unseen[v, u]
            cycle.append(v)
            v, u = u, clockwise[u, v]
        cycles.append(tuple(cycle))
    return cycles


def _area(places: FloatArray, cycle: Sequence[int]) -> float:
    x, y = places[list(cycle)].T
    x, y = x - x[0], y - y[0]
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def _sides(cycle: Sequence[int]) -> list[tuple[int, int]]:
    return list(zip(cycle, [*cycle[1:], cycle[0]], strict=True))


def _check_all(drawing: Drawing, parts: Sequence[_Part], places: FloatArray) -> None:
    held = {line for part in parts for line in part.lines}
    left = [line for line in drawing.lines if line not in held and line.start != line.end]
    if left:
        x, y = places[left[0].start]
        raise DisconnectedError(
            f"{counted(len(left), 'line')} {agreeing(len(left), 'is')} joined to no panel, the "
            f"first near ({x:.6g}, {y:.6g}): let lines meet in common ends",
            vertices=[left[0].start],
        )


def _check_nested(part: _Part, parts: Sequence[_Part], places: FloatArray) -> None:
    v = part.outline[0]
    for other in parts:
        if not _nested(part, other, places):
            continue
        where = f"near ({places[v][0]:.6g}, {places[v][1]:.6g})"
        boundary = {frozenset(pair) for pair in _sides(part.outline)}
        if all(line.letter in "BC" for line in part.lines if frozenset(line[:2]) in boundary):
            raise NotADiskError(f"the sheet has a hole {where}", vertices=part.outline)
        raise DisconnectedError(
            f"creases {where} lie inside a panel, and no line joins them to the rest",
            vertices=[v],
        )


def _nested(part: _Part, other: _Part, places: FloatArray) -> bool:
    return part is not other and _encloses(places[list(other.outline)], places[part.outline[0]])


def _check_inside(part: _Part, places: FloatArray) -> None:
    boundary = {frozenset(pair) for pair in _sides(part.outline)}
    inside = [
        line for line in part.lines if line.letter in "BC" and frozenset(line[:2]) not in boundary
    ]
    if not inside:
        return
    cut = {frozenset(line[:2]) for line in inside}
    for face in part.faces:
        if {frozenset(pair) for pair in _sides(face)} <= cut:
            x, y = places[list(face)].mean(axis=0)
            raise NotADiskError(
                f"the sheet has a hole near ({x:.6g}, {y:.6g}): boundary lines surround it",
                vertices=face,
            )
    a, b, letter = inside[0]
    raise FoldError(
        f"line {a}-{b} from ({places[a][0]:.6g}, {places[a][1]:.6g}) to ({places[b][0]:.6g}, "
        f"{places[b][1]:.6g}) is {'a cut' if letter == 'C' else 'a boundary line'} between "
        f"two panels ({counted(len(inside), 'such line')})"
    )


def _encloses(polygon: FloatArray, spot: FloatArray) -> bool:
    (x, y), ahead = spot, np.roll(polygon, -1, axis=0)
    above, next_above = polygon[:, 1] > y, ahead[:, 1] > y
    hit = above != next_above
    (ax, ay), (bx, by) = polygon[hit].T, ahead[hit].T
    return bool(np.count_nonzero(ax + (y - ay) * (bx - ax) / (by - ay) > x) % 2)


def _alone(drawing: Drawing, part: _Part) -> Drawing:
    members = used(part.lines)
    number = {v: k for k, v in enumerate(members)}
    lines = tuple(Line(number[a], number[b], letter) for a, b, letter in part.lines)
    points = tuple(drawing.points[v] for v in members)
    return Drawing(points, lines, drawing.source, drawing.remarks)
