"""Traces the faces of a straight-line planar graph, by exact angular order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cmp_to_key

from exactfold.errors import (
    DisconnectedError,
    FoldError,
    MalformedPatternError,
)
from exactfold.exact.surds import float_bounds
from exactfold.pattern.drawing.bounds import check_compared
from exactfold.pattern.validate import AnyPoint, orientation, segments_meet

Edge = tuple[int, int]
Bounds = tuple[float, float]
"""Floats below and above a number."""


def trace_faces(points: Sequence[AnyPoint], edges: Iterable[Edge]) -> list[tuple[int, ...]]:
    """The bounded faces of a planar straight-line graph, sorted.

    `points` are integer points (scale rational ones by a common denominator). `edges` are index
    pairs; an edge that is given twice counts once. Each face is a cycle of vertices,
    counter-clockwise from its smallest index. At each vertex integer cross products sort the edges
    by direction. A face continues each edge with the next edge clockwise at its head (the rotation
    system of the embedding). The one cycle that is not counter-clockwise bounds the outer face.

    Raises `MalformedPatternError` for two vertices at one point and for a vertex on no edge;
    `FoldError` for edges that cross, for a vertex inside an edge, and for an edge with the same
    face on both sides; and `DisconnectedError`.

    >>> trace_faces([(0, 0), (2, 0), (2, 2), (0, 2)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    [(0, 1, 2), (0, 2, 3)]
    """
    graph = sorted({(min(i, j), max(i, j)) for i, j in edges})
    _check_points(points)
    for i, j in graph:
        if i == j:
            raise FoldError(f"edge {i}-{j} joins a vertex to itself")
    check_no_crossing(points, graph)
    neighbours: list[list[int]] = [[] for _ in points]
    for i, j in graph:
        neighbours[i].append(j)
        neighbours[j].append(i)
    _check_connected(neighbours)
    # clockwise[v][u] is the neighbour of v that follows u clockwise.
    clockwise: list[dict[int, int]] = []
    for v, around in enumerate(neighbours):
        order = counter_clockwise(points, v, around)
        clockwise.append({u: order[k - 1] for k, u in enumerate(order)})
    return _cycles(points, graph, clockwise)


def check_no_crossing(points: Sequence[AnyPoint], edges: Sequence[Edge]) -> None:
    """Raises `FoldError` if two edges meet anywhere but in a common end.

    A sweep over the x-ranges of the edges proposes pairs. The ranges are rounded outwards to
    floats, so that no pair that meets is left out. Every decision about a pair is the sign of an
    exact determinant, unless floats with an error bound determine the sign.
    """
    spots = [(float_bounds(x), float_bounds(y)) for x, y in points]
    boxes = []
    for i, j in edges:
        (ax, ay), (bx, by) = spots[i], spots[j]
        x, y = (min(ax[0], bx[0]), max(ax[1], bx[1])), (min(ay[0], by[0]), max(ay[1], by[1]))
        boxes.append((*x, *y, (i, j)))
    boxes.sort()
    check_compared(boxes)
    clear = _clear_turns(spots)
    active: list[tuple[float, float, float, float, Edge]] = []
    for box in boxes:
        active = [other for other in active if other[1] >= box[0]]
        for other in active:
            if other[2] <= box[3] and box[2] <= other[3] and not _apart(clear, other[4], box[4]):
                _check_pair(points, *sorted((other[4], box[4])))
        active.append(box)


def _clear_turns(spots: Sequence[tuple[Bounds, Bounds]]) -> Callable[[int, int, int], int]:
    """A function for the sign of an orientation, which returns 0 if floats cannot decide it.

    Let the coordinates have size at most M and errors at most d. Then the float determinant has an
    error below 16 M (d + 2^-48 M): it has two products of differences of size at most 2 M, and each
    difference has an error of at most 2 d + 2^-51 M.
    """
    size = max((abs(c) for spot in spots for bounds in spot for c in bounds), default=0.0)
    off = max((high - low for spot in spots for low, high in spot), default=0.0)
    slack = 16 * size * (off + 2.0**-48 * size) + 2.0**-1000  # 2^-1000 covers underflow
    places = [(x[0], y[0]) for x, y in spots]

    def clear(a: int, b: int, c: int) -> int:
        (ax, ay), (bx, by), (cx, cy) = places[a], places[b], places[c]
        turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        return (turn > slack) - (turn < -slack)

    return clear


def _apart(clear: Callable[[int, int, int], int], first: Edge, second: Edge) -> bool:
    """Whether floats prove that two edges have no common point but a common end."""
    for one, other in ((first, second), (second, first)):
        turns = [clear(*one, v) for v in other if v not in one]
        if len(turns) == 2 and turns[0] * turns[1] > 0:
            return True
        if len(turns) == 1 and turns[0] != 0:
            return True
    return False


def _check_pair(points: Sequence[AnyPoint], first: Edge, second: Edge) -> None:
    for one, other in ((first, second), (second, first)):
        for v in set(other) - set(one):
            if _inside_edge(points, v, one):
                raise FoldError(
                    f"vertex {v}, an end of edge {_name(other)}, lies inside edge {_name(one)}"
                )
    if set(first) & set(second):
        return
    if segments_meet(*(points[v] for v in (*first, *second))):
        raise FoldError(f"edges {_name(first)} and {_name(second)} cross")


def _inside_edge(points: Sequence[AnyPoint], v: int, edge: Edge) -> bool:
    (px, py), (ax, ay), (bx, by) = points[v], points[edge[0]], points[edge[1]]
    if orientation((ax, ay), (bx, by), (px, py)) != 0:
        return False
    return bool((ax - px) * (bx - px) + (ay - py) * (by - py) < 0)


def _check_points(points: Sequence[AnyPoint]) -> None:
    seen: dict[AnyPoint, int] = {}
    for v, point in enumerate(points):
        if point in seen:
            raise MalformedPatternError(
                f"vertices {seen[point]} and {v} are at the same point", vertices=[seen[point], v]
            )
        seen[point] = v


def _check_connected(neighbours: Sequence[Sequence[int]]) -> None:
    lonely = [v for v, around in enumerate(neighbours) if not around]
    if lonely:
        more = f" (and {len(lonely) - 1} more)" if len(lonely) > 1 else ""
        raise MalformedPatternError(f"vertex {lonely[0]} is on no edge{more}", vertices=lonely)
    for v, around in enumerate(neighbours):
        if len(around) == 1:
            raise FoldError(
                f"edge {_name((v, around[0]))} ends at vertex {v}, which is on no other edge"
            )
    reached, stack = {0}, [0]
    while stack:
        for v in neighbours[stack.pop()]:
            if v not in reached:
                reached.add(v)
                stack.append(v)
    if len(reached) < len(neighbours):
        other = min(set(range(len(neighbours))) - reached)
        raise DisconnectedError(
            f"the graph falls apart: no edges lead from vertex 0 to vertex {other}",
            vertices=[0, other],
        )


def counter_clockwise(points: Sequence[AnyPoint], v: int, around: Sequence[int]) -> list[int]:
    """The neighbours of a vertex in counter-clockwise order, starting from the direction of +x."""
    x, y = points[v]

    def half_edge(u: int) -> int:
        dx, dy = points[u][0] - x, points[u][1] - y
        return 0 if (dy, dx) > (0, 0) else 1

    def compare(a: int, b: int) -> int:
        turn = orientation((x, y), points[a], points[b])
        return half_edge(a) - half_edge(b) or (turn < 0) - (turn > 0)

    return sorted(around, key=cmp_to_key(compare))


def _cycles(
    points: Sequence[AnyPoint], edges: Sequence[Edge], clockwise: Sequence[dict[int, int]]
) -> list[tuple[int, ...]]:
    faces = []
    unseen = {half_edge for i, j in edges for half_edge in ((i, j), (j, i))}
    for start in sorted(unseen):
        if start not in unseen:
            continue
        cycle = []
        u, v = start
        while (u, v) in unseen:
            unseen.remove((u, v))
            cycle.append(u)
            u, v = v, clockwise[v][u]
        _check_both_sides(cycle)
        corners = [points[w] for w in cycle]
        twice_area = sum(
            orientation(corners[0], corners[k], corners[k + 1]) for k in range(1, len(cycle) - 1)
        )
        if twice_area > 0:
            first = cycle.index(min(cycle))
            faces.append((*cycle[first:], *cycle[:first]))
    return sorted(faces)


def _check_both_sides(cycle: Sequence[int]) -> None:
    half_edges = set(zip(cycle, [*cycle[1:], cycle[0]], strict=True))
    bridge = min(
        (half_edge for half_edge in half_edges if half_edge[::-1] in half_edges), default=None
    )
    if bridge is not None:
        raise FoldError(
            f"edge {_name(bridge)} has the same face on both sides: it is not a side of a face"
        )


def _name(edge: Edge) -> str:
    return f"{min(edge)}-{max(edge)}"
