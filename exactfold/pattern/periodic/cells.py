"""Checks exactly that triangles and their translates cover the plane; errors name the culprit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from math import ceil, floor
from typing import Any, TypeAlias

from exactfold.checker.core.limits import MOST_MOVED
from exactfold.errors import (
    DegenerateFaceError,
    MalformedPatternError,
    NotPeriodicError,
    NumberError,
    OverlapError,
    TooLargeError,
)
from exactfold.exact.numbers import shown
from exactfold.pattern.crease_pattern import Point
from exactfold.pattern.validate import orientation

Corner: TypeAlias = tuple[int, int, int]
"""(v, i, j): vertex v, moved by i times the first and j times the second lattice vector."""
Face: TypeAlias = tuple[Corner, Corner, Corner]
Side: TypeAlias = tuple[int, int, int, int]
"""(u, v, i, j): from vertex u to vertex v moved by (i, j); the same for all translates."""


def pairs(
    given: Iterable[Any], what: str, convert: Callable[[object], Fraction]
) -> tuple[Point, ...]:
    """Exact points; an error names the one that is not a pair of numbers."""
    result: list[Point] = []
    for index, value in enumerate(given):
        entries = () if isinstance(value, str) or not isinstance(value, Iterable) else tuple(value)
        if len(entries) != 2:
            raise MalformedPatternError(
                f"{what} {index} is {shown(value)}, not a pair of coordinates", vertices=[index]
            )
        try:
            result.append((convert(entries[0]), convert(entries[1])))
        except NumberError as error:
            raise type(error)(f"{what} {index}: {error}") from None
    if not result:
        raise MalformedPatternError(f"a periodic pattern needs at least one {what}")
    return tuple(result)


def check_lattice(vectors: Sequence[Point]) -> None:
    """Checks that there are two lattice vectors, and that they are not parallel."""
    if len(vectors) != 2:
        raise MalformedPatternError(f"a lattice has two vectors, not {len(vectors)}")
    (ax, ay), (bx, by) = vectors
    if ax * by == ay * bx:
        raise NotPeriodicError("the lattice vectors 0 and 1 are parallel: they span no cell")


def corner_triples(faces: Iterable[Any], count: int) -> list[Face]:
    """Triples of corners (v, i, j) with v in range; an error names the face."""
    result: list[Face] = []
    for face, given in enumerate(faces):
        corners = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else ()
        if len(corners) != 3:
            raise MalformedPatternError(
                f"face {face} is {shown(given)}, not three corners", faces=[face]
            )
        read = [_corner(face, corner, count) for corner in corners]
        result.append((read[0], read[1], read[2]))
    if not result:
        raise MalformedPatternError("the cell has no faces")
    return result


def _corner(face: int, corner: Any, count: int) -> Corner:
    entries = tuple(corner) if isinstance(corner, Sequence) and not isinstance(corner, str) else ()
    if len(entries) != 3 or any(type(x) is not int for x in entries):
        raise MalformedPatternError(
            f"face {face}: {shown(corner)} is not a corner [vertex, i, j] of integers", faces=[face]
        )
    v, i, j = entries
    if not 0 <= v < count:
        raise MalformedPatternError(
            f"face {face} uses vertex {shown(v)}, but the cell has the vertices 0 to {count - 1}",
            faces=[face],
        )
    if max(abs(i), abs(j)) > MOST_MOVED:
        raise TooLargeError(
            f"face {face}: the corner {shown(corner)} is moved by more than {MOST_MOVED} lattice "
            "vectors, which is not read: take a nearer translate"
        )
    return v, i, j


def oriented(faces: Sequence[Face], place: Callable[[Corner], Point]) -> tuple[Face, ...]:
    """All faces counter-clockwise, each from its least vertex, which is not moved."""
    clockwise: list[int] = []
    counter: list[int] = []
    for k, face in enumerate(faces):
        area = orientation(*map(place, face))
        if area == 0:
            raise DegenerateFaceError(f"face {k} {face} has zero area", faces=[k])
        (counter if area > 0 else clockwise).append(k)
    if clockwise and counter:
        first, second = clockwise[0], counter[0]
        raise OverlapError(
            f"face {first} {faces[first]} is clockwise, face {second} {faces[second]} is "
            "counter-clockwise",
            faces=[first, second],
        )
    turned = [(a, c, b) if clockwise else (a, b, c) for a, b, c in faces]
    return tuple(map(from_least, turned))


def from_least(face: Face) -> Face:
    """The translate of a face that starts at its least corner, which is not moved.

    >>> from_least(((1, 0, 0), (0, 2, 1), (0, 2, 0)))
    ((0, 0, 0), (1, -2, 0), (0, 0, 1))
    """
    a, b, c = face
    start = min((a, b, c), (b, c, a), (c, a, b))
    _, i, j = start[0]
    p, q, r = ((v, k - i, m - j) for v, k, m in start)
    return p, q, r


def sides(face: Face) -> Iterator[Side]:
    """The sides of a face, counter-clockwise."""
    for (u, i, j), (v, k, m) in zip(face, (face[1], face[2], face[0]), strict=True):
        yield u, v, k - i, m - j


def check_cover(
    faces: Sequence[Face],
    count: int,
    place: Callable[[Corner], Point],
    area: Fraction,
) -> None:
    """Checks that counter-clockwise faces and their translates cover each point once.

    If each side has one face to its left and one to its right, the faces form a closed surface that
    is mapped onto the torus, locally one to one except perhaps at vertices. So each point is
    covered the same number of times, the total area of the faces divided by that of the cell.
    """
    left: dict[Side, int] = {}
    for k, face in enumerate(faces):
        for side in sides(face):
            if side in left:
                raise NotPeriodicError(
                    f"faces {left[side]} and {k} lie on the same side of the edge {named(side)}",
                    edges=[side[:2]],
                    faces=[left[side], k],
                )
            left[side] = k
    for (u, v, i, j), k in left.items():
        if (v, u, -i, -j) not in left:
            raise NotPeriodicError(
                f"the edge {named((u, v, i, j))} of face {k} has no face on its other side",
                edges=[(u, v)],
                faces=[k],
            )
    lonely = sorted(set(range(count)) - {v for v, *_ in left})
    if lonely:
        raise MalformedPatternError(f"vertex {lonely[0]} belongs to no face", vertices=lonely)
    twice = sum(orientation(*map(place, face)) for face in faces)
    if twice != 2 * area:
        times = twice / (2 * area)
        other = _overlapping(faces, place)
        raise NotPeriodicError(
            f"faces 0 and {other} overlap: the faces have {times} times the area of the cell",
            faces=[0, other],
        )


def known_edges(given: Iterable[Any], edges: Sequence[Side]) -> tuple[Side, ...]:
    """Edges (u, v, i, j) of a cell in the form in which they are listed, sorted.

    `MalformedPatternError` names one that is no edge.
    """
    known = set(edges)
    found: set[Side] = set()
    for entry in given:
        side = tuple(entry) if isinstance(entry, Sequence) and not isinstance(entry, str) else ()
        if len(side) != 4 or any(type(x) is not int for x in side):
            raise MalformedPatternError(f"the diagonal {shown(entry)} is not [u, v, i, j]")
        u, v, i, j = side
        edge = next((e for e in ((u, v, i, j), (v, u, -i, -j)) if e in known), None)
        if edge is None:
            raise MalformedPatternError(
                f"the diagonal {named((u, v, i, j))} is no edge of the cell", edges=[(u, v)]
            )
        found.add(edge)
    return tuple(sorted(found))


def named(side: Side) -> str:
    """An edge in a message: its ends, and how the second is moved.

    >>> named((0, 3, 1, 0)), named((0, 3, 0, 0))
    ('0-3 moved by (1, 0)', '0-3')
    """
    u, v, i, j = map(shown, side)
    return f"{u}-{v}" + (f" moved by ({i}, {j})" if (i, j) != ("0", "0") else "")


def _overlapping(faces: Sequence[Face], place: Callable[[Corner], Point]) -> int:
    """The first face with a translate that covers the middle of face 0, beside face 0 itself."""
    (ox, oy), (px, py), (qx, qy) = map(place, ((0, 0, 0), (0, 1, 0), (0, 0, 1)))
    ax, ay, bx, by = px - ox, py - oy, qx - ox, qy - oy
    whole = ax * by - ay * bx
    corners = [place(corner) for corner in faces[0]]
    x, y = (sum(point[axis] for point in corners) / 3 for axis in (0, 1))
    for k, face in enumerate(faces):
        spots = [place(corner) for corner in face]
        # Lattice coordinates of the middle, seen from each corner, bound the translations.
        along = [((x - u) * by - (y - v) * bx) / whole for u, v in spots]
        across = [(ax * (y - v) - ay * (x - u)) / whole for u, v in spots]
        for i in range(ceil(min(along)), floor(max(along)) + 1):
            for j in range(ceil(min(across)), floor(max(across)) + 1):
                moved = (x - i * ax - j * bx, y - i * ay - j * by)
                turns = [orientation(spots[n], spots[n - 2], moved) for n in range(3)]
                if min(turns) >= 0 and (k, i, j) != (0, 0, 0):
                    return k
    raise AssertionError("the middle of face 0 is covered once")
