"""Checks exactly that vertices and triangles form one flat disk; each error names its culprit."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from fractions import Fraction
from numbers import Integral
from typing import Any

from exactfold._support.plurals import agreeing, counted
from exactfold.errors import (
    DegenerateFaceError,
    DisconnectedError,
    InputError,
    MalformedPatternError,
    NotADiskError,
    NumberError,
    OverlapError,
)
from exactfold.exact.numbers import format_rational, shown
from exactfold.pattern.drawing.bounds import check_compared

Point = tuple[Fraction, Fraction]
IntPoint = tuple[int, int]
AnyPoint = Sequence[Any]
"""Two exact coordinates: integers, fractions or surds."""
Triangle = tuple[int, int, int]
Rotation = Mapping[int, Mapping[int, int]]


@contextmanager
def rounded_to(denominator: int) -> Iterator[None]:
    """Within this block, errors of the input say that the coordinates were rounded before."""
    try:
        yield
    except InputError as error:
        error.args = (
            f"{error}, after coordinates were rounded to multiples of 1/{denominator}",
            *error.args[1:],
        )
        raise


def orientation(a: Sequence[Any], b: Sequence[Any], c: Sequence[Any]) -> Any:
    """Twice the signed area of triangle abc, positive if counter-clockwise; exact."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def points(
    vertices: Iterable[Sequence[object]], convert: Callable[[object], Fraction]
) -> tuple[Point, ...]:
    """Distinct exact points; an error names the vertex that is not one."""
    result: list[Point] = []
    seen: dict[tuple[int, int, int, int], int] = {}  # by integers: fractions are slow to hash
    for index, vertex in enumerate(vertices):
        pair = _entries(vertex)
        if pair is None or len(pair) != 2:
            raise MalformedPatternError(
                f"vertex {index} is {shown(vertex)}, not a pair of coordinates", vertices=[index]
            )
        try:
            point = (convert(pair[0]), convert(pair[1]))
        except NumberError as error:
            raise type(error)(f"vertex {index}: {error}") from None
        x, y = point
        key = (x.numerator, x.denominator, y.numerator, y.denominator)
        if key in seen:
            raise MalformedPatternError(
                f"vertices {seen[key]} and {index} are at the same point "
                f"({_coordinate(point[0])}, {_coordinate(point[1])})",
                vertices=[seen[key], index],
            )
        seen[key] = index
        result.append(point)
    if len(result) < 3:
        raise MalformedPatternError(f"a pattern needs at least three vertices, not {len(result)}")
    return tuple(result)


def _entries(value: object) -> tuple[Any, ...] | None:
    """The entries of an iterable that is not text; None for all other objects."""
    if type(value) is tuple:
        return value
    if isinstance(value, str) or not isinstance(value, Iterable):
        return None
    return tuple(value)


def _coordinate(value: Fraction) -> str:
    text = format_rational(value)
    return text if len(text) <= 40 else text[:37] + "..."


def triples(triangles: Iterable[Sequence[int]], count: int) -> list[Triangle]:
    """Index triples in range, each with three different vertices; an error names the face."""
    result: list[Triangle] = []
    for face, given in enumerate(triangles):
        triangle = _entries(given)
        if triangle is None or len(triangle) != 3:
            raise MalformedPatternError(
                f"face {face} is {shown(given)}, not three indices", faces=[face]
            )
        for v in triangle:
            if type(v) is int and 0 <= v < count:
                continue
            if isinstance(v, bool) or not isinstance(v, Integral):
                raise MalformedPatternError(
                    f"face {face}: {shown(v)} is not a vertex index", faces=[face]
                )
            if not 0 <= int(v) < count:
                raise MalformedPatternError(
                    f"face {face} uses vertex {shown(v)}, but there "
                    f"{agreeing(count, 'is')} {counted(count, 'vertex')}",
                    faces=[face],
                )
        a, b, c = map(int, triangle)
        if a == b or b == c or c == a:
            raise DegenerateFaceError(
                f"face {face} repeats a vertex: {(a, b, c)}", vertices=(a, b, c), faces=[face]
            )
        result.append((a, b, c))
    if not result:
        raise MalformedPatternError("a pattern needs at least one triangle")
    return result


def oriented_triangles(
    vertices: Sequence[IntPoint], triangles: Sequence[Triangle]
) -> tuple[Triangle, ...]:
    """All triangles, counter-clockwise, each starting with its smallest index."""
    clockwise: list[int] = []
    counter: list[int] = []
    for face, (a, b, c) in enumerate(triangles):
        area = orientation(vertices[a], vertices[b], vertices[c])
        if area == 0:
            raise DegenerateFaceError(
                f"face {face} ({a}, {b}, {c}) has zero area", vertices=(a, b, c), faces=[face]
            )
        (counter if area > 0 else clockwise).append(face)
    if clockwise and counter:
        raise OverlapError(
            f"face {clockwise[0]} {triangles[clockwise[0]]} is clockwise, "
            f"face {counter[0]} {triangles[counter[0]]} is counter-clockwise",
            faces=[clockwise[0], counter[0]],
        )
    result = []
    for a, b, c in triangles:
        cycle = (a, c, b) if clockwise else (a, b, c)
        k = cycle.index(min(cycle))
        result.append((cycle[k], cycle[(k + 1) % 3], cycle[(k + 2) % 3]))
    return tuple(result)


def incidence(count: int, triangles: Sequence[Triangle]) -> None:
    """Checks that every vertex has a face, and that no edge has three faces or two on one side."""
    if _is_once_on_each_side(count, triangles):
        return
    sides: dict[tuple[int, int], list[int]] = {}
    directed: dict[tuple[int, int], int] = {}
    doubled: tuple[int, int, int, int] | None = None
    for face, (a, b, c) in enumerate(triangles):
        for i, j in ((a, b), (b, c), (c, a)):
            faces = sides.setdefault((min(i, j), max(i, j)), [])
            faces.append(face)
            if len(faces) > 2:
                raise NotADiskError(
                    f"edge {min(i, j)}-{max(i, j)} is on the faces {faces}, more than two",
                    edges=[(min(i, j), max(i, j))],
                    faces=faces,
                )
            if (i, j) in directed and doubled is None:
                doubled = (i, j, directed[i, j], face)
            directed[i, j] = face
    if doubled is not None:
        i, j, first, second = doubled
        raise OverlapError(
            f"faces {first} and {second} overlap: both lie on the same side of edge {i}-{j}",
            edges=[(min(i, j), max(i, j))],
            faces=[first, second],
        )
    used = {v for triangle in triangles for v in triangle}
    if len(used) < count:
        lonely = [v for v in range(count) if v not in used]
        raise MalformedPatternError(
            f"vertex {lonely[0]} belongs to no face" + _more(lonely), vertices=lonely
        )


def _is_once_on_each_side(count: int, triangles: Sequence[Triangle]) -> bool:
    """Whether `incidence` has nothing to refuse; without the names of culprits, this is quick."""
    directed: set[int] = set()  # edge (i, j) as i * count + j
    for a, b, c in triangles:
        directed |= {a * count + b, b * count + c, c * count + a}
    return (
        len(directed) == 3 * len(triangles) and len({edge // count for edge in directed}) == count
    )


def _more(items: Sequence[object]) -> str:
    return f" (and {len(items) - 1} more)" if len(items) > 1 else ""


def disk(rotation: Rotation, triangles: Sequence[Triangle]) -> None:
    """Checks that the sheet is connected, without a pinch, and has exactly one boundary cycle.

    If this boundary is a simple polygon (see `embedding`), the sheet is a disk.
    """
    reached, stack = {triangles[0][0]}, [triangles[0][0]]
    while stack:
        for a, b in rotation[stack.pop()].items():
            for v in (a, b):
                if v not in reached:
                    reached.add(v)
                    stack.append(v)
    if len(reached) < len(rotation):
        other = min(v for v in rotation if v not in reached)
        raise DisconnectedError(
            f"the sheet falls apart: no faces lead from vertex {triangles[0][0]} to {other}",
            vertices=[triangles[0][0], other],
        )
    follow: dict[int, int] = {}
    for v, fan in rotation.items():
        ends = fan.keys() - fan.values()  # spokes v-a that no face (v, b, a) precedes
        if len(ends) > 1 or _steps(fan, next(iter(ends or fan))) < len(fan):
            raise NotADiskError(
                f"the sheet hangs together by vertex {v} only: its faces form several fans; draw "
                "the parts apart, as sheets of their own",
                vertices=[v],
            )
        if ends:
            (follow[v],) = ends
    if not follow:
        raise NotADiskError("the faces form a closed surface without boundary")
    start = min(follow)
    cycle = [start]
    while (after := follow[cycle[-1]]) != start:
        cycle.append(after)
    if len(cycle) < len(follow):
        inner = min(set(follow) - set(cycle))
        raise NotADiskError(
            f"the sheet has a hole: vertices {start} and {inner} are on different boundaries",
            vertices=[start, inner],
        )


def _steps(fan: Mapping[int, int], start: int) -> int:
    steps, at = 1, fan[start]
    while at != start and at in fan:
        at = fan[at]
        steps += 1
    return steps


def embedding(
    vertices: Sequence[IntPoint], boundary: Sequence[int], triangles: Sequence[Triangle]
) -> None:
    """Checks that no faces overlap, by checking that the boundary is a simple polygon.

    This suffices. All triangles of the disk are positively oriented, so each point off the boundary
    is covered as often as the boundary winds around it (degree of a map).
    """
    sides = list(zip(boundary, [*boundary[1:], boundary[0]], strict=True))
    boxes = []
    for i, j in sides:
        (ax, ay), (bx, by) = vertices[i], vertices[j]
        boxes.append((min(ax, bx), max(ax, bx), min(ay, by), max(ay, by), i, j))
    boxes.sort()
    check_compared(boxes)
    active: list[tuple[int, int, int, int, int, int]] = []
    for box in boxes:
        active = [other for other in active if other[1] >= box[0]]
        for other in active:
            if other[2] <= box[3] and box[2] <= other[3] and _meet(vertices, box[4:], other[4:]):
                (i, j), (k, m) = box[4:], other[4:]
                third = {s: c for a, b, d in triangles for s, c in _sides(a, b, d)}
                raise OverlapError(
                    f"boundary edges {k}-{m} and {i}-{j} meet: the faces "
                    f"({k}, {m}, {third[k, m]}) and ({i}, {j}, {third[i, j]}) "
                    "overlap or touch",
                    edges=[(min(i, j), max(i, j)), (min(k, m), max(k, m))],
                )
        active.append(box)


def _sides(a: int, b: int, c: int) -> tuple[tuple[tuple[int, int], int], ...]:
    """The directed sides of a triangle, each with the third corner."""
    return ((a, b), c), ((b, c), a), ((c, a), b)


def _meet(vertices: Sequence[IntPoint], first: tuple[int, int], second: tuple[int, int]) -> bool:
    """Whether two boundary edges share a point other than a common end."""
    shared = set(first) & set(second)
    if shared:
        (v,) = shared
        (a,) = set(first) - shared
        (b,) = set(second) - shared
        p, q, r = vertices[v], vertices[a], vertices[b]
        dot = (q[0] - p[0]) * (r[0] - p[0]) + (q[1] - p[1]) * (r[1] - p[1])
        return orientation(p, q, r) == 0 and dot > 0
    return segments_meet(*(vertices[v] for v in (*first, *second)))


def segments_meet(a: AnyPoint, b: AnyPoint, c: AnyPoint, d: AnyPoint) -> bool:
    """Whether the closed segments ab and cd have a common point; exact on exact numbers."""
    abc, abd = _sign(orientation(a, b, c)), _sign(orientation(a, b, d))
    cda, cdb = _sign(orientation(c, d, a)), _sign(orientation(c, d, b))
    if abc * abd < 0 and cda * cdb < 0:
        return True
    return (
        (abc == 0 and _between(a, b, c))
        or (abd == 0 and _between(a, b, d))
        or (cda == 0 and _between(c, d, a))
        or (cdb == 0 and _between(c, d, b))
    )


def _sign(value: Any) -> int:
    return int(value > 0) - int(value < 0)


def _between(a: AnyPoint, b: AnyPoint, p: AnyPoint) -> bool:
    return bool(
        min(a[0], b[0]) <= p[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= p[1] <= max(a[1], b[1])
    )
