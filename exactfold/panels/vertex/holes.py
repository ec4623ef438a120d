"""The conditions round the holes of a sheet of panels, written as stars of the same kind.

The panels round a hole are a loop. Let the folds that it crosses lie on the lines with directions
d_j, away from the hole, and moments m_j = p_j x d_j, and let w_j be fold angle / length. The loop
closes to first order if sum_j w_j (d_j, m_j) = 0, three equations. To second order, where the
panels have turned about the normal and moved in the plane, sum_{k<j} w_k w_j of the three minors of
(d_k, m_k) and (d_j, m_j) must vanish (docs/panels.md, Sheets with holes). These are the conditions
of three stars, whose directions are (x, y), (x, m) and (y, m) of the lines (x, y, m). If all lines
pass through one point, or are parallel, one star has all conditions, like a vertex.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

from exactfold.exact.joined_fields import joined
from exactfold.exact.surds import Number, sign
from exactfold.panels.vertex.stars import (
    Hole,
    Star,
    Twist,
    bracket,
    edge_of,
    flat_closure,
    stars,
)
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_AXES: Final = ((0, 1), (0, 2), (1, 2))


@dataclass(frozen=True)
class Rim:
    """The boundary of hole `number`, clockwise, and the folds that a way round it crosses.

    Each fold has the end on the rim, and the other end; they are counter-clockwise.
    """

    number: int
    vertices: tuple[int, ...]
    crossed: tuple[tuple[int, int], ...]


def conditions(pattern: PanelPattern, flat: Iterable[Edge] = ()) -> Mapping[int, Star]:
    """The stars of all interior vertices and holes at which some fold can fold.

    As `stars` does, this leaves out folds that cannot fold in any real motion. Those round a hole
    are flat, too, if their lines are independent. The stars of hole k have the numbers V + 3 k + a,
    where V is the number of vertices, and a is 0 for (x, y), 1 for (x, m) and 2 for (y, m).

    >>> ring = PanelPattern([(0, 0), (40, 0), (0, 40), (19, 13), (18, 19), (8, 18), (15, 3)],
    ...     [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (5, 6), (3, 6), (0, 5), (0, 6), (1, 6), (1, 3),
    ...      (1, 4), (2, 4), (2, 5)], holes=[(3, 4, 5, 6)])
    >>> [(v, len(star.folds)) for v, star in conditions(ring).items()]
    [(7, 7), (8, 7), (9, 7)]
    """
    if not pattern.holes:
        return stars(pattern, flat)
    pattern.check_positions()
    gone = set(flat)
    known = rims(pattern)
    while True:
        moving = dict(flat_closure(pattern, gone))
        before = len(gone)
        for rim in known:
            hole = hole_of(pattern, rim, gone)
            if hole.rank == len(hole.folds):
                gone.update(hole.folds)
            else:
                moving |= {star.vertex: star for star in stars_of(hole, len(pattern.vertices))}
        if len(gone) == before:
            return moving


def restricted(moving: Mapping[int, Star], folds: Set[Edge]) -> dict[int, Star]:
    """The stars of some folds alone; all others are held flat, which lowers the rank of holes."""
    kept: dict[int, Star] = {}
    for v, star in moving.items():
        if folds.isdisjoint(star.folds):
            continue
        if star.hole is None:
            kept[v] = star.only(folds)
            continue
        hole = star.hole
        start = v - _place(star, hole)
        if kept.keys().isdisjoint(range(start, start + 3)):
            some = [k for k, fold in enumerate(hole.folds) if fold in folds]
            part = _of_rank(
                hole.number,
                [hole.folds[k] for k in some],
                [hole.twists[k] for k in some],
            )
            kept |= {one.vertex: one for one in stars_of(part, start - 3 * hole.number)}
    return kept


def close_always(moving: Mapping[int, Star], densities: Mapping[Edge, Number]) -> bool:
    """Whether all vertices and holes close exactly with tau = T w for every T, with densities w.

    Here tau = tan(fold angle / 2) / length. All folds without a density are held flat. Such a line
    of motions folds (docs/panels.md, Sheets with holes).
    """
    rounds: dict[int, tuple[tuple[Edge, ...], tuple[Twist, ...]]] = {}
    for v, star in restricted(moving, densities.keys()).items():
        hole = star.hole
        if hole is None:
            rounds[v] = star.folds, tuple((x, y, 0) for x, y in star.directions)
        else:
            rounds[-1 - hole.number] = hole.folds, hole.twists
    return all(
        closes_always(twists, [densities[fold] for fold in folds])
        for folds, twists in rounds.values()
    )


def closes_always(twists: Sequence[Twist], values: Sequence[Number]) -> bool:
    """Whether turns about lines with tau_j = T values[j] have the product 1 for every T.

    A turn about the line (x, y, m) is the dual quaternion 1 + tau (x i + y j + m eps k), with
    eps^2 = 0. The product is 1 if its vector parts are 0, both that without eps and that with it.

    >>> upright = [(0, 1, 0), (0, -1, 2), (0, 1, 3), (0, -1, 5)]
    >>> closes_always(upright, (1, 1, 1, 1)), closes_always(upright, (1, 2, 2, 1))
    (False, False)
    >>> closes_always([(0, 1, 0), (0, 1, 1), (0, 1, 2)], (1, -1, 0))
    False
    >>> closes_always([(0, 1, 0), (0, 1, 1), (0, 1, 3), (0, 1, 2)], (1, -1, 1, -1))
    True
    """
    [*coordinates, weights] = joined([*zip(*twists, strict=True), values])
    product: list[list[Number]] = [[1, 0, 0, 0, 0, 0, 0, 0]]
    for x, y, m, weight in zip(*coordinates, weights, strict=True):
        p, q, r = weight * x, weight * y, weight * m
        turned: list[list[Number]] = []
        for s, a, b, c, t, d, e, f in product:
            plain = [-a * p - b * q, s * p - c * q, s * q + c * p, a * q - b * p]
            first = [-d * p - e * q, t * p - f * q, t * q + f * p, d * q - e * p]
            second = [-c * r, b * r, -a * r, s * r]
            turned.append([*plain, *(u + v for u, v in zip(first, second, strict=True))])
        zero: list[Number] = [0] * 8
        product = [
            [u + v for u, v in zip(one, other, strict=True)]
            for one, other in zip([*product, zero], [zero, *turned], strict=True)
        ]
    return all(part == 0 for dual in product for part in (*dual[1:4], *dual[5:]))


def _place(star: Star, hole: Hole) -> int:
    """Which two coordinates of the lines of its hole a star has."""
    pairs = [tuple((t[a], t[b]) for t in hole.twists) for a, b in _AXES]
    return pairs.index(star.directions)


def stars_of(hole: Hole, first: int) -> Iterator[Star]:
    """The stars of a hole; `first` is the number of the first star of hole 0."""
    if not hole.folds:
        return
    axes: Sequence[tuple[int, int]] = _AXES if hole.rank == 3 else _AXES[:1]
    if hole.rank == 2:
        one = hole.twists[0]
        axes = tuple(
            (a, b)
            for a, b in _AXES
            if any(bracket((one[a], one[b]), (t[a], t[b])) != 0 for t in hole.twists)
        )[:1]
    for a, b in axes:
        directions = tuple((t[a], t[b]) for t in hole.twists)
        place = first + 3 * hole.number + _AXES.index((a, b))
        yield Star(place, hole.folds, directions, hole)


def hole_of(pattern: PanelPattern, rim: Rim, flat: Set[Edge]) -> Hole:
    """The lines of the folds round a hole, without the `flat` ones, and how many depend on none."""
    folds, twists = [], []
    origin = rim.vertices[0]
    for v, u in rim.crossed:
        if edge_of(v, u) not in flat:
            d = pattern.direction(v, u)
            moment = bracket(pattern.direction(origin, v), d)
            folds.append(edge_of(v, u))
            twists.append((*d, moment))
    return _of_rank(rim.number, folds, twists)


def _of_rank(number: int, folds: Sequence[Edge], twists: Sequence[Twist]) -> Hole:
    return Hole(number, tuple(folds), tuple(twists), _rank(twists))


def _rank(twists: Sequence[Twist]) -> int:
    """The dimension of the span of lines, at most 3."""
    if not twists:
        return 0
    one = twists[0]
    normals = (_cross(one, t) for t in twists)
    normal = next((n for n in normals if any(x != 0 for x in n)), None)
    if normal is None:
        return 1
    heights = (sum((a * b for a, b in zip(normal, t, strict=True)), 0 * one[0]) for t in twists)
    return 3 if any(height != 0 for height in heights) else 2


def _cross(a: Twist, b: Twist) -> Twist:
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def free_folds(pattern: PanelPattern) -> tuple[Edge, ...]:
    """The folds that are in no condition: without them the sheet falls apart.

    In a sheet without holes these are the folds whose two ends lie on the boundary. A fold from a
    hole to the edge of the paper, or to another hole, is none of them.
    """
    if not pattern.holes:
        interior = set(pattern.interior)
        return tuple(e for e in pattern.folds if not interior.intersection(e))
    joined: dict[tuple[int, int], list[Edge]] = {}
    for i, j in pattern.folds:
        faces = sorted((pattern.sides[i, j], pattern.sides[j, i]))
        joined.setdefault((faces[0], faces[1]), []).append((i, j))
    import networkx as nx  # only sheets with holes need it

    graph = nx.Graph(list(joined))
    bridges = [joined[min(a, b), max(a, b)] for a, b in nx.bridges(graph)]
    return tuple(sorted(folds[0] for folds in bridges if len(folds) == 1))


def vertices_of(pattern: PanelPattern, group: Iterable[int]) -> tuple[int, ...]:
    """The vertices of a part: those inside the sheet, and those of its holes."""
    found: dict[int, None] = {}
    for v in group:
        beyond = v - len(pattern.vertices)
        found |= dict.fromkeys((v,) if beyond < 0 else pattern.holes[beyond // 3])
    return tuple(found)


def rims(pattern: PanelPattern) -> list[Rim]:
    """The boundaries of the holes, after all free folds have been cut open.

    A fold from a hole back to it makes a flap: the flap and its folds are in no loop round the
    hole.
    """
    following = {
        side: after
        for face in pattern.faces
        for side, after in pairwise([*_sides(face), _sides(face)[0]])
    }
    free = set(free_folds(pattern))

    def is_wall(side: tuple[int, int]) -> bool:
        return side[::-1] not in following or edge_of(*side) in free

    number = {v: k for k, hole in enumerate(pattern.holes) for v in hole}
    found: list[Rim] = []
    seen: set[tuple[int, int]] = set()
    for start in sorted(following):
        if start in seen or not is_wall(start):
            continue
        around: list[int] = []
        crossed: list[tuple[int, int]] = []
        side = start
        while side not in seen:
            seen.add(side)
            around.append(side[0])
            side = following[side]
            while not is_wall(side):
                crossed.append(side)
                side = following[side[::-1]]
        if _twice_area(pattern, around) < 0:
            found.append(Rim(number[around[0]], tuple(around), tuple(crossed[::-1])))
    return found


def _twice_area(pattern: PanelPattern, around: Sequence[int]) -> int:
    """The sign of the area inside a closed way; it is negative if it runs clockwise."""
    total: Number = 0
    for i, j in pairwise(around[1:]):
        total = total + bracket(pattern.direction(around[0], i), pattern.direction(around[0], j))
    return sign(total)


def _sides(face: Sequence[int]) -> list[tuple[int, int]]:
    return list(pairwise((*face, face[0])))
