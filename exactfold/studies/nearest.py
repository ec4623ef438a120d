"""Bounds the distance to an exceptional sheet: a vertex outside 3-cycles can stay flat on it.

Let four folds or sides form a strictly convex quadrilateral C with vertices inside. If the corners
of C lie in a plane on a branch, everything inside is flat (the key lemma of docs/theorem.md). So
on sheets without flat vertices the saddle of C is not 0 on any branch. Along a path of such sheets
the branch with given vertex signs changes continuously (Theorem 2), so that the saddle keeps its
sign. So if the saddle has different signs at both ends of a path, an exceptional sheet lies
between.

Floats look for the nearest place, to first order, where the saddle of some C vanishes on some
branch. Then the signs are proved at both ends of a segment that reaches slightly farther.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import isqrt
from typing import Any

import networkx as nx
import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.result import BranchCount
from exactfold.errors import PatternError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.validate import orientation

Cycle = tuple[int, int, int, int]
Vector = tuple[Fraction, Fraction]
Product = Callable[[Vector, Vector], Fraction]

_TRIED = 6
"""So many saddles are followed to where they vanish: the nearest ones, to first order."""
_STEPS = 12
_BEYOND = 1.001
"""The compared sheet is so far on the way, as a multiple of the way to where a saddle vanishes."""
_SCALE = 1 << 48
_TINY = 1e-30


@dataclass(frozen=True)
class Nearest:
    """The proof that an exceptional sheet lies between a sheet and `other`, or is `other`.

    `distance` is the root of the sum of the squared displacements of all vertices, rounded up. If
    `straight` is False, it is proved that no sheet on the way has two folds that continue each
    other at a vertex; otherwise the exceptional sheet may have such folds. On the way the saddle of
    the quadrilateral `cycle` changes its sign on the branch `signs`. Alternatively, `signs` is
    empty, and `other` can be folded along a straight path from corner to corner, the three vertices
    `cycle`.
    """

    distance: float
    straight: bool
    other: CreasePattern
    cycle: tuple[int, ...]
    signs: str


def nearest_exception(count: BranchCount) -> Nearest | None:
    """The nearest exceptional sheet that is found, with proof; None if none is found.

    `count` lists the branches of a sheet with four convex corners, without triangulated triangles
    and without flat vertices. The corners do not move. The result None does not mean that there is
    no such sheet, and a nearer one than the result is not excluded.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> nearest = nearest_exception(count_branches(random_square(5, seed=4)))
    >>> nearest.cycle, round(nearest.distance, 6), nearest.straight
    ((4, 5, 2, 3), 0.000402, False)
    """
    pattern = count.pattern
    exceptions = [_beside_a_path(pattern)]
    cycles = list(quadrilaterals(pattern))
    if cycles and count.branches:
        for signs, cycle, place in _SaddleSearch(count, cycles).nearest():
            moved = _moved(pattern, dict(zip(pattern.interior, place.tolist(), strict=True)))
            if moved is not None and proved_between(pattern, moved, cycle, signs):
                exceptions.append(_nearest(pattern, moved, cycle, signs))
                break
    return min(
        (one for one in exceptions if one is not None), key=lambda one: one.distance, default=None
    )


def quadrilaterals(pattern: CreasePattern) -> Iterator[Cycle]:
    """Yields the 4-cycles of folds and sides that are strictly convex and contain vertices.

    The boundary itself is left out. Corners are counter-clockwise.

    >>> from exactfold.pattern.families import two_vertex
    >>> sorted(quadrilaterals(two_vertex()))
    [(0, 1, 5, 3), (4, 1, 2, 3)]
    """
    boundary = set(pattern.boundary)
    points, _ = pattern.integer_vertices
    graph = nx.empty_graph(len(pattern.vertices))
    graph.add_edges_from((*pattern.folds, *pattern.boundary_edges))
    for cycle in nx.simple_cycles(graph, length_bound=4):
        if len(cycle) == 4 and set(cycle) != boundary:
            a, b, c, d = cycle
            turned: Cycle = (a, b, c, d) if _turn(points, a, b, c) > 0 else (d, c, b, a)
            if min(_turns(points, turned)) > 0 and any(
                all(side > 0 for side in _sides(points, turned, v)) for v in pattern.interior
            ):
                yield turned


def proved_between(pattern: CreasePattern, other: CreasePattern, cycle: Cycle, signs: str) -> bool:
    """Whether it is proved that an exceptional sheet lies on the segment between two sheets.

    Both have the same triangles. `signs` name the branch on which the saddle of `cycle` changes its
    sign. It is proved that all faces, and the corners of the cycle, keep their orientation on the
    way.
    """
    corners = [(cycle[k - 2], cycle[k - 1], cycle[k]) for k in range(4)]
    if not _same_faces(pattern, other) or not all(
        _stays_positive(pattern, other, corner) for corner in corners
    ):
        return False
    first, last = (_saddle_sign(sheet, cycle, signs) for sheet in (pattern, other))
    return first * last < 0


# --- exact ---------------------------------------------------------------------------------------


def _beside_a_path(pattern: CreasePattern) -> Nearest | None:
    """The nearest sheet with an interior vertex on a diagonal, joined to both its corners.

    If the sheet is folded along this diagonal alone, all other interior vertices are flat.
    """
    exceptions = []
    for v in pattern.interior if pattern.Vi > 1 else ():
        for a, b in zip(pattern.boundary[:2], pattern.boundary[2:], strict=True):
            if {a, b} <= set(pattern.star(v)):
                (ax, ay), (bx, by), (x, y) = (pattern.vertices[w] for w in (a, b, v))
                dx, dy = bx - ax, by - ay
                t = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)
                moved = _moved(pattern, {v: (ax + t * dx, ay + t * dy)})
                if moved is not None and _same_faces(pattern, moved):
                    exceptions.append(_nearest(pattern, moved, (a, v, b), ""))
    return min(exceptions, key=lambda one: one.distance, default=None)


def _nearest(
    pattern: CreasePattern, other: CreasePattern, cycle: tuple[int, ...], signs: str
) -> Nearest:
    square = sum(
        (a - b) ** 2
        for p, q in zip(pattern.vertices, other.vertices, strict=True)
        for a, b in zip(p, q, strict=True)
    )
    distance = (isqrt(int(square * _SCALE**2)) + 1) / _SCALE
    return Nearest(distance, not _never_straight(pattern, other), other, cycle, signs)


def _same_faces(first: CreasePattern, last: CreasePattern) -> bool:
    """Whether it is proved that all faces keep their orientation on the whole way."""
    return first.triangles == last.triangles and all(
        _stays_positive(first, last, triangle) for triangle in first.triangles
    )


def _never_straight(first: CreasePattern, last: CreasePattern) -> bool:
    """Whether it is proved that nowhere on the way two folds continue each other at a vertex."""
    return all(
        _stays_positive(first, last, (i, v, j)) or _stays_positive(first, last, (j, v, i))
        for v in first.interior
        for i, j in combinations(first.star(v), 2)
        if not _stays_acute(first, last, v, i, j)
    )


def _turn(points: Sequence[Sequence[int]], a: int, b: int, c: int) -> int:
    return int(orientation(points[a], points[b], points[c]))


def _turns(points: Sequence[Sequence[int]], cycle: Cycle) -> list[int]:
    return [_turn(points, *(cycle[(k + j) % 4] for j in range(3))) for k in range(4)]


def _sides(points: Any, cycle: Cycle, v: int) -> list[Any]:
    """On which side of each side of the cycle a vertex lies; 0 on its line."""
    return [orientation(points[cycle[k]], points[cycle[(k + 1) % 4]], points[v]) for k in range(4)]


def _stays_positive(first: CreasePattern, last: CreasePattern, triple: Sequence[int]) -> bool:
    """Whether it is proved that three vertices are counter-clockwise on the whole way."""
    a, b, c = triple
    return _positive_all_the_way(
        first, last, (a, b), (a, c), lambda u, v: u[0] * v[1] - u[1] * v[0]
    )


def _stays_acute(first: CreasePattern, last: CreasePattern, v: int, i: int, j: int) -> bool:
    """Whether it is proved that the angle of i, v and j is acute on the whole way."""
    return _positive_all_the_way(
        first, last, (v, i), (v, j), lambda u, w: u[0] * w[0] + u[1] * w[1]
    )


def _positive_all_the_way(
    first: CreasePattern, last: CreasePattern, one: Edge, other: Edge, product: Product
) -> bool:
    """Whether it is proved that a product of the vectors along two edges is always positive.

    The product is a quadratic polynomial in time. It is positive if its Bernstein coefficients are:
    the values at both ends, and the mean of the two mixed products.
    """

    def along(sheet: CreasePattern, edge: Edge) -> Vector:
        (ax, ay), (bx, by) = (sheet.vertices[v] for v in edge)
        return bx - ax, by - ay

    u, v = along(first, one), along(first, other)
    p, q = along(last, one), along(last, other)
    return min(product(u, v), product(u, q) + product(p, v), product(p, q)) > 0


def _saddle_sign(sheet: CreasePattern, cycle: Cycle, signs: str) -> int:
    """The proved sign of the saddle of four vertices on a branch; 0 if it is not proved.

    The branch is seen from the side on which the boundary saddle is positive.
    """
    branch = find_branch(sheet, signs)
    if (branch.status, branch.saddle, branch.sign_text) != (PROVED, 1, signs):
        return 0
    low = high = Fraction(0)
    for v, weight in zip(cycle, saddle(sheet.vertices, cycle), strict=True):
        ends = sorted(weight * height for height in branch.heights[v])
        low, high = low + ends[0], high + ends[1]
    return (low > 0) - (high < 0)


def saddle(points: Any, cycle: Cycle) -> list[Any]:
    """The affine dependency of four points, with signs + - + -; it is 0 on heights in a plane."""
    a, b, c, d = (points[v] for v in cycle)
    return [
        orientation(b, c, d),
        -orientation(a, c, d),
        orientation(a, b, d),
        -orientation(a, b, c),
    ]


def _moved(pattern: CreasePattern, places: Mapping[int, Sequence[Any]]) -> CreasePattern | None:
    """The sheet with some vertices moved, floats rounded to a grid; None if it is not a sheet."""
    points = list(pattern.vertices)
    for v, place in places.items():
        x, y = (Fraction(round(c * _SCALE), _SCALE) if isinstance(c, float) else c for c in place)
        points[v] = x, y
    try:
        return CreasePattern(points, pattern.triangles)
    except PatternError:
        return None


# --- floats --------------------------------------------------------------------------------------


class _SaddleSearch:
    """Searches, in floats, for the nearest places at which the saddle of some cycle vanishes.

    A derivative is the imaginary part of the value at a point with an imaginary part of 1e-30.
    """

    def __init__(self, count: BranchCount, cycles: Sequence[Cycle]) -> None:
        self.count, self.pattern, self.cycles = count, count.pattern, cycles
        self.inside = list(self.pattern.interior)
        self.size = len(self.inside)
        self.start = np.array([[float(x), float(y)] for x, y in self.pattern.vertices])

    def nearest(self) -> list[tuple[str, Cycle, FloatArray]]:
        """Branches, cycles and places slightly beyond the vanishing of a saddle, nearest first."""
        candidates = []
        for branch in self.count.branches:
            heights = np.array([branch.approx_heights[v] for v in range(len(self.start))])
            for distance, cycle, place in self._first_order(heights):
                candidates.append((distance, branch.sign_text, cycle, place, heights))
        candidates.sort(key=lambda candidate: candidate[0])
        ends = []
        for _, signs, cycle, place, heights in candidates[:_TRIED]:
            end = self._followed(cycle, place, heights)
            if end is not None:
                way = end - self.start[self.inside]
                beyond = self.start[self.inside] + _BEYOND * way
                ends.append((float(np.linalg.norm(way)), signs, cycle, beyond))
        return [end[1:] for end in sorted(ends, key=lambda end: end[0])]

    def _first_order(self, heights: FloatArray) -> Iterator[tuple[float, Cycle, FloatArray]]:
        """Yields, for each cycle, where its saddle vanishes to first order, and how far that is."""
        points, raised = self._stepped(self.start, heights)
        slopes = _curvatures(self.pattern, points, raised).imag / _TINY
        along, across = slopes[:, : 2 * self.size], slopes[:, 2 * self.size :]
        try:
            follows = -np.linalg.solve(across, along)
        except np.linalg.LinAlgError:
            return
        for cycle in self.cycles:
            value = _saddles(points, raised, cycle)
            slope = value.imag / _TINY
            gradient = slope[: 2 * self.size] + slope[2 * self.size :] @ follows
            square = float(gradient @ gradient)
            if square > 0:
                step = -float(value.real[0]) / square * gradient
                place = self.start[self.inside] + step.reshape(-1, 2)
                yield float(np.linalg.norm(step)), cycle, place

    def _followed(self, cycle: Cycle, place: FloatArray, heights: FloatArray) -> FloatArray | None:
        """The nearest places at which the cycle and its inside are flat; None if not found.

        There is one condition more than heights. So a combination of the conditions depends, to
        first order, on the places only. Newton's method goes to the nearest zero of its linear
        part.
        """
        origin = self.start[self.inside].ravel()
        points, now = self.start.copy(), heights.copy()
        spot = place.ravel()
        for _ in range(_STEPS):
            points[self.inside] = spot.reshape(-1, 2)
            value, along, across = self._conditions(points, now, cycle)
            left = np.linalg.svd(across)[0][:, -1]
            gradient = left @ along
            square = float(gradient @ gradient)
            if not np.isfinite(value).all() or square == 0:
                return None
            rest = -left @ value - gradient @ (origin - spot)
            after = origin + rest / square * gradient
            change = np.linalg.lstsq(across, -value - along @ (after - spot), rcond=None)[0]
            moved = float(np.linalg.norm(after - spot))
            now[self.inside] += change
            spot = after
            if moved < 1e-13:
                break
        return spot.reshape(-1, 2) if moved < 1e-9 else None

    def _conditions(
        self, points: FloatArray, heights: FloatArray, cycle: Cycle
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Curvatures outside the cycle, saddles inside; derivatives by places and by heights."""
        stepped, raised = self._stepped(points, heights)
        curved = _curvatures(self.pattern, stepped, raised)
        within = [all(s > 0 for s in _sides(self.start, cycle, v)) for v in self.inside]
        rows = [_saddles(stepped, raised, cycle)]
        for k, v in enumerate(self.inside):
            rows.append(_saddles(stepped, raised, (*cycle[:3], v)) if within[k] else curved[k])
        every = np.array(rows)
        slopes = every.imag / _TINY
        return every.real[:, 0], slopes[:, : 2 * self.size], slopes[:, 2 * self.size :]

    def _stepped(self, points: FloatArray, heights: FloatArray) -> tuple[Any, Any]:
        """Places (vertex, axis, step) and heights (vertex, step); each step has one i * 1e-30."""
        steps = 3 * self.size
        places = np.repeat(points[:, :, None].astype(complex), steps, axis=2)
        raised = np.repeat(heights[:, None].astype(complex), steps, axis=1)
        for k, v in enumerate(self.inside):
            places[v, 0, 2 * k] += 1j * _TINY
            places[v, 1, 2 * k + 1] += 1j * _TINY
            raised[v, 2 * self.size + k] += 1j * _TINY
        return places, raised


def _saddles(points: Any, heights: Any, cycle: Cycle) -> Any:
    return sum(w * heights[v] for w, v in zip(saddle(points, cycle), cycle, strict=True))


def _curvatures(pattern: CreasePattern, points: Any, heights: Any) -> Any:
    """For each interior vertex, the sum of fold stresses times differences of heights."""
    rows = []
    for v in pattern.interior:
        ring, total = pattern.star(v), 0.0
        for k, w in enumerate(ring):
            after, before = ring[(k + 1) % len(ring)], ring[k - 1]
            areas = orientation(points[v], points[w], points[after])
            areas = areas * orientation(points[v], points[before], points[w])
            bend = _saddles(points, heights, (v, before, w, after))
            total = total + bend / areas * (heights[w] - heights[v])
        rows.append(total)
    return np.array(rows)
