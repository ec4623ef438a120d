"""The convex pieces of a sheet whose folded creases are given: what is moved as a whole."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from exactfold.exact.surds import sign
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.pattern.validate import orientation


@dataclass(frozen=True, repr=False)
class Pieces:
    """A sheet as convex pieces, joined by folded creases and by edges that are not folded.

    `letters` has a letter for every fold of `sheet`: M, V, U (folded, either way) or F (not
    folded). Panels that are joined by F creases move as one. Such a part of the sheet is cut into
    convex polygons, with corners at vertices of the sheet; as few cuts are kept as a greedy choice
    needs. `polygons` are these pieces, counter-clockwise. `panels` says which panels lie in each
    piece, at least in part. `creases` maps each folded crease to the pieces on its left and on its
    right, seen from its first to its second vertex; `joints` does the same for edges, within the
    paper, that are not folded: creases and cuts between two pieces.
    """

    sheet: PanelPattern
    letters: Mapping[Edge, str]
    polygons: tuple[tuple[int, ...], ...]
    panels: tuple[tuple[int, ...], ...]
    creases: Mapping[Edge, tuple[int, int]]
    joints: Mapping[Edge, tuple[int, int]]

    @cached_property
    def of_panel(self) -> Mapping[int, tuple[int, ...]]:
        """The pieces that contain each panel, or its parts."""
        known: dict[int, list[int]] = {}
        for piece, some in enumerate(self.panels):
            for panel in some:
                known.setdefault(panel, []).append(piece)
        return {panel: tuple(some) for panel, some in known.items()}

    def __repr__(self) -> str:
        return f"<Pieces: {len(self.polygons)} of {self.sheet!r}>"


def pieces_of(sheet: PanelPattern, letters: Mapping[Edge, str]) -> Pieces:
    """The convex pieces of a sheet; folds without a letter are folded.

    >>> square = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2)],
    ...     [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)])
    >>> pieces_of(square, {(0, 2): "M"}).polygons, pieces_of(square, {(0, 2): "F"}).polygons
    (((0, 1, 2), (0, 2, 3)), ((0, 1, 2, 3),))
    """
    points = sheet.scaled_vertices
    parts: list[tuple[tuple[int, ...], frozenset[int]]] = []
    for number, face in enumerate(sheet.faces):
        parts += [(part, frozenset((number,))) for part in convex_parts(points, face)]
    given = {fold: letters.get(fold, "U") for fold in sheet.folds}
    folded = {fold for fold, letter in given.items() if letter != "F"}
    parts = _merged(points, parts, folded)
    sides: dict[tuple[int, int], int] = {}
    for k, (polygon, _) in enumerate(parts):
        for i, j in _sides(polygon):
            sides[i, j] = k
    both = {
        (i, j): (left, sides[j, i])
        for (i, j), left in sorted(sides.items())
        if i < j and (j, i) in sides
    }
    return Pieces(
        sheet,
        given,
        tuple(polygon for polygon, _ in parts),
        tuple(tuple(sorted(panels)) for _, panels in parts),
        {e: two for e, two in both.items() if e in folded},
        {e: two for e, two in both.items() if e not in folded},
    )


def _sides(polygon: Sequence[int]) -> Iterable[tuple[int, int]]:
    return zip(polygon, (*polygon[1:], polygon[0]), strict=True)


def _turn(points: Sequence[Sequence[object]], a: int, b: int, c: int) -> int:
    return sign(orientation(points[a], points[b], points[c]))


def convex_parts(
    points: Sequence[Sequence[object]], face: tuple[int, ...]
) -> list[tuple[int, ...]]:
    """A face, or its triangles if it is not convex: ears are cut off one after another."""
    count = len(face)
    if all(_turn(points, face[k - 1], face[k], face[(k + 1) % count]) >= 0 for k in range(count)):
        return [face]
    rest, triangles = list(face), []
    while len(rest) > 3:
        ear = next(k for k in range(len(rest)) if _is_ear(points, rest, k))
        triangles.append((rest[ear - 1], rest[ear], rest[(ear + 1) % len(rest)]))
        del rest[ear]
    return [*triangles, (rest[0], rest[1], rest[2])]


def _is_ear(points: Sequence[Sequence[object]], rest: Sequence[int], k: int) -> bool:
    a, b, c = rest[k - 1], rest[k], rest[(k + 1) % len(rest)]
    if _turn(points, a, b, c) <= 0:
        return False
    inside = (
        _turn(points, a, b, v) >= 0 and _turn(points, b, c, v) >= 0 and _turn(points, c, a, v) >= 0
        for v in rest
        if v not in (a, b, c)
    )
    return not any(inside)


def _merged(
    points: Sequence[Sequence[object]],
    parts: Sequence[tuple[tuple[int, ...], frozenset[int]]],
    folded: set[Edge],
) -> list[tuple[tuple[int, ...], frozenset[int]]]:
    """The parts joined across edges that are not folded, as long as the polygons stay convex."""
    polygons = dict(enumerate(parts))
    sides = {side: k for k, (polygon, _) in polygons.items() for side in _sides(polygon)}
    flat = [(i, j) for i, j in sorted(sides) if i < j and (j, i) in sides and (i, j) not in folded]
    for i, j in flat:
        one, other = sides.get((i, j)), sides.get((j, i))
        if one is None or other is None or one == other:
            continue  # joined before, with another edge
        joined = _joined(points, polygons[one][0], polygons[other][0], folded)
        if joined is None:
            continue
        panels = polygons[one][1] | polygons[other][1]
        for k in (one, other):
            for side in _sides(polygons[k][0]):
                del sides[side]
        del polygons[other]
        polygons[one] = joined, panels
        sides |= dict.fromkeys(_sides(joined), one)
    made = []
    for polygon, panels in polygons.values():
        first = polygon.index(min(polygon))
        made.append(((*polygon[first:], *polygon[:first]), panels))
    return sorted(made, key=lambda part: (min(part[1]), part[0]))


def _joined(
    points: Sequence[Sequence[object]],
    one: tuple[int, ...],
    other: tuple[int, ...],
    folded: set[Edge],
) -> tuple[int, ...] | None:
    """The union of two polygons with common sides, if it is convex; None if it is not.

    Convex polygons share sides on one line, which follow each other. All of them have to be
    unfolded.
    """
    theirs = set(_sides(other))
    common = [(i, j) for i, j in _sides(one) if (j, i) in theirs]
    if any((min(side), max(side)) in folded for side in common):
        return None
    starts, ends = {i for i, _ in common}, {j for _, j in common}
    (first,), (last,) = starts - ends, ends - starts
    k, m = one.index(last), other.index(first)
    mine, others = (*one[k:], *one[:k]), (*other[m:], *other[:m])
    union = (
        *mine[: mine.index(first)],
        *others[: others.index(last)],
    )
    at = (union.index(first), 0)
    count = len(union)
    if all(_turn(points, union[p - 1], union[p], union[(p + 1) % count]) >= 0 for p in at):
        return union
    return None
