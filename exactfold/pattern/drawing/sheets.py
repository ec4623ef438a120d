"""Finds the boundary of a drawing, and separates its sheets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import agreeing, counted
from exactfold.errors import DisconnectedError, FoldError, MalformedPatternError
from exactfold.pattern.drawing.cutting import pieces
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.joining import joined
from exactfold.pattern.drawing.mending import Repair, floats, lost, repair, used, with_lines

_NAMED: Final = 5


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
    round_it = {
        frozenset(pair)
        for part, outer in zip(parts, _enclosing(parts, places), strict=True)
        if not outer
        for pair in _sides(part.outline)
    }
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


def sheets(drawing: Drawing) -> tuple[tuple[Drawing, ...], list[Repair]]:
    """Each sheet of a drawing on its own, with the points that lie on its lines, and reports.

    The drawing must come from `repaired`: lines meet only in common ends, and the boundary is B.
    Cuts divide a sheet into pieces, and slits are opened (`pieces`). A hole inside one panel does
    not matter, since the panel is rigid. Holes, frames round a sheet and pieces without creases are
    left out.

    Raises `MalformedPatternError` if the lines enclose nothing or no piece has a crease,
    `NotADiskError` for a sheet that hangs together only by a point, and `FoldError` for a line B
    between two panels. Raises `DisconnectedError` for creases inside a panel that no line joins to
    the rest, and for lines that enclose nothing; such lines are not dropped here.
    """
    parts = _parts(drawing)
    if not parts:
        raise MalformedPatternError(
            "the lines of the drawing enclose no face: draw the boundary of the sheet as a closed "
            "line"
        )
    places = floats(drawing.points)
    _check_all(drawing, parts, places)
    drawing, parts, through = _joined(drawing, parts)
    places = floats(drawing.points)
    made: list[Drawing] = []
    alone: list[int] = []
    slits: list[int] = []
    farthest = 0.0
    enclosing = _enclosing(parts, places)
    framing = {k for outer in enclosing for k in outer}
    for k, part in enumerate(parts):
        alone_there = enclosing.count(enclosing[k]) == 1
        _check_nested(part, [parts[m] for m in enclosing[k]], alone_there, places, drawing.coloured)
        nested = enclosing[k] or k in framing
        if nested and (len(part.faces) == 1 or all(line.letter in "BC" for line in part.lines)):
            alone.append(part.outline[0])
        elif inside := _cuts(part, places, drawing.coloured):
            found, empty, moved = pieces(drawing, part.faces, part.lines)
            made += found
            alone += empty
            slits += [line.start for line in inside] if moved else []
            farthest = max(farthest, moved)
        else:
            made.append(_alone(drawing, part))
    if not made:
        raise MalformedPatternError(
            "no piece of the drawing has a crease: its lines are edges, cuts, holes or a frame"
        )
    empty_ones = (
        f"{counted(len(alone), 'piece')} without creases {agreeing(len(alone), 'is')} left out "
        "(holes, frames, or paper that falls out)"
    )
    opened = (
        f"cuts ({counted(len(slits), 'line')}) are opened: creases end {farthest:.2g} before "
        "them; no angle and no way to fold changes, and contacts are those of the open sheet"
    )
    slit = (
        f"{counted(len(through), 'slit')} through panels that go all round other creases: each "
        "stays one rigid panel, so that no way to fold changes"
    )
    points = drawing.points
    reports = repair("border", len(alone), alone, points, empty_ones)
    reports += repair("border", len(through), through, points, slit)
    cuts = repair("border", len(slits), slits, points, opened)
    reports += [replace(each, cuts=True) for each in cuts]
    return tuple(made), [replace(each, loud=True) for each in reports]


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


def _joined(drawing: Drawing, parts: list[_Part]) -> tuple[Drawing, list[_Part], list[int]]:
    """The drawing with slits to creases and cuts that a panel goes all round, and their ends."""
    through: list[int] = []
    while True:
        places = floats(drawing.points)
        enclosing = _enclosing(parts, places)
        for part, outer in zip(parts, enclosing, strict=True):
            if outer and _is_inside_a_panel(part):
                around = min(outer, key=lambda m: _area(places, parts[m].outline[::-1]))
                beside = [k for k, other in enumerate(enclosing) if other == outer]
                sides = [side for k in beside if parts[k] is not part for side in _rim(parts[k])]
                spot = places[part.outline[0]]
                face = next(
                    (f for f in parts[around].faces if _encloses(places[list(f)], spot)), ()
                )
                made = joined(drawing, _rim(part), [*_sides(face), *sides] if face else [])
                if made is not None:
                    through.append(len(drawing.points))
                    drawing, parts = made, _parts(made)
                    break
        else:
            return drawing, parts, through


def _rim(part: _Part) -> list[tuple[int, int]]:
    return _sides(part.outline)


def _is_inside_a_panel(part: _Part) -> bool:
    """Whether a part inside others has cuts between creases, which are round it, too."""
    boundary = {frozenset(pair) for pair in _rim(part)}
    letters = {line.letter for line in part.lines if frozenset(line[:2]) in boundary}
    return not letters <= {*"BC"} and any(line.letter == "C" for line in part.lines)


def _check_nested(
    part: _Part, outer: Sequence[_Part], is_alone: bool, places: FloatArray, coloured: bool
) -> None:
    """Raises an error if a part inside others is neither a hole nor a sheet there.

    Its outline tells: a hole and a sheet have boundary lines. Lines without a letter are a boundary
    inside frames, which have one face each, if nothing else lies there (`is_alone`).
    """
    boundary = {frozenset(pair) for pair in _sides(part.outline)}
    letters = {line.letter for line in part.lines if frozenset(line[:2]) in boundary}
    framed = is_alone and letters <= {*"BCU"} and all(len(other.faces) == 1 for other in outer)
    if outer and not framed and not letters <= {*"BC"}:
        v = part.outline[0]
        why = "leave out a frame round the drawing; a hole is drawn with boundary lines"
        if any(line.letter == "C" for line in part.lines):
            how = " by `--colours '#0f0=U,#ff0=U'`"
            why = (
                "a panel that goes all round other creases is not counted yet; draw a line F from "
                "them to the rest, or, to read this one without cuts, give its cuts and flat lines "
                "the letter U"
                f"{how if coloured else ''}"
            )
        raise DisconnectedError(
            f"creases near ({places[v][0]:.6g}, {places[v][1]:.6g}) lie inside a panel, and no "
            f"line joins them to the rest ({why})",
            vertices=[v],
        )


def _enclosing(parts: Sequence[_Part], places: FloatArray) -> list[list[int]]:
    """For each part, the parts inside whose outline it lies."""
    outlines = [places[list(part.outline)] for part in parts]
    low = np.array([outline.min(axis=0) for outline in outlines]).reshape(-1, 2)
    high = np.array([outline.max(axis=0) for outline in outlines]).reshape(-1, 2)
    found = []
    for k, outline in enumerate(outlines):
        near = ((low < outline[0]) & (outline[0] < high)).all(axis=1)
        near[k] = False
        found.append([int(m) for m in np.flatnonzero(near) if _encloses(outlines[m], outline[0])])
    return found


def _cuts(part: _Part, places: FloatArray, coloured: bool) -> list[Line]:
    """The cuts of a part: lines C between two faces, and lines B round a hole off the edge."""
    boundary = {frozenset(pair) for pair in _sides(part.outline)}
    inside = [
        line for line in part.lines if line.letter in "BC" and frozenset(line[:2]) not in boundary
    ]
    if not inside:
        return []
    closed = {frozenset(line[:2]) for line in inside}
    faces = [{frozenset(pair) for pair in _sides(face)} for face in part.faces]
    rim = set(part.outline)
    round_holes = {
        pair
        for face, corners in zip(faces, part.faces, strict=True)
        if face <= closed and rim.isdisjoint(corners)
        for pair in face
    }
    wrong = [
        line for line in inside if line.letter == "B" and frozenset(line[:2]) not in round_holes
    ]
    if wrong:
        ends = [[f"({places[v][0]:.6g}, {places[v][1]:.6g})" for v in line[:2]] for line in wrong]
        named = ", ".join(f"from {a} to {b}" for a, b in ends[:_NAMED])
        more = ", ..." if len(wrong) > _NAMED else ""
        how = " (`--colours black=U`, or black=C; all lines of this colour get the letter)"
        raise FoldError(
            f"{counted(len(wrong), 'boundary line')} {agreeing(len(wrong), 'is')} between two "
            f"panels ({named}{more}): give {'it' if len(wrong) == 1 else 'them'} the letter U for "
            f"a crease, C for a cut, or F for nothing{how if coloured else ''}"
        )
    return inside


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
    return replace(drawing, points=points, lines=lines, exact=False)
