"""A frozen, validated, flat triangulated disk with rational vertices."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from types import MappingProxyType

from exactfold._support.notebook import Picture
from exactfold.exact.numbers import (
    RationalLike,
    as_rational,
    format_rational,
    over_common_denominator,
    snap,
)
from exactfold.pattern import large_disk, validate
from exactfold.pattern.triangulated_triangles import find_triangulated_triangles

Point = tuple[Fraction, Fraction]
Edge = tuple[int, int]
Triangle = tuple[int, int, int]


@dataclass(frozen=True)
class CreasePattern(Picture):
    """A flat sheet cut into triangles: the crease pattern of a triangulated origami.

    `vertices` are points with rational coordinates (anything that `as_rational` accepts).
    `triangles` are index triples in counter-clockwise order; if all of them are clockwise, all are
    reversed. The sheet must be one disk without overlap. Every vertex must belong to a triangle,
    and no two vertices may be at one point. Boundary angles of 180 degrees and edges that join two
    boundary vertices (`chords`) are allowed. Raises a subclass of `PatternError` that names the
    vertex, edge or face to blame.

    >>> square = CreasePattern(
    ...     [(0, 0), (1, 0), (1, 1), (0, 1), ("1/2", "1/3")],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    ... )
    >>> square.interior, square.boundary, square.degrees_of_freedom
    ((4,), (0, 1, 2, 3), 1)
    >>> square.folds
    ((0, 4), (1, 4), (2, 4), (3, 4))
    """

    vertices: tuple[Point, ...]
    triangles: tuple[Triangle, ...]

    def __init__(
        self,
        vertices: Iterable[Sequence[RationalLike]],
        triangles: Iterable[Sequence[int]],
    ) -> None:
        if not isinstance(vertices, Sequence):
            vertices = tuple(vertices)
        if not isinstance(triangles, Sequence):
            triangles = tuple(triangles)
        many = len(triangles) >= large_disk.MANY
        points = large_disk.distinct_points(vertices) if many else None
        if points is None:
            points = validate.points(vertices, as_rational)
        given = large_disk.index_triples(triangles, len(points)) if many else None
        if given is None:
            given = validate.triples(triangles, len(points))
        object.__setattr__(self, "vertices", points)
        disk = large_disk.oriented_disk(self.integer_vertices[0], given)
        if disk is not None:
            triples, vars(self)["boundary"] = disk
            object.__setattr__(self, "triangles", triples)
        else:
            triples = validate.oriented_triangles(self.integer_vertices[0], given)
            validate.incidence(len(points), triples)
            object.__setattr__(self, "triangles", triples)
            validate.disk(self._next, triples)
        validate.embedding(self.integer_vertices[0], self.boundary, triples)

    # --- combinatorics ---------------------------------------------------------------------------

    @cached_property
    def _next(self) -> Mapping[int, Mapping[int, int]]:
        """`_next[v][a] = b` for every triangle (v, a, b): the rotation around v."""
        rotation: dict[int, dict[int, int]] = {v: {} for v in range(len(self.vertices))}
        for a, b, c in self.triangles:
            rotation[a][b], rotation[b][c], rotation[c][a] = c, a, b
        return MappingProxyType(rotation)

    @cached_property
    def boundary(self) -> tuple[int, ...]:
        """The boundary vertices in counter-clockwise order, starting with the smallest index."""
        follow = {a: b for a, fan in self._next.items() for b in fan.keys() - fan.values()}
        cycle = [min(follow)]
        while (after := follow[cycle[-1]]) != cycle[0]:
            cycle.append(after)
        return tuple(cycle)

    @cached_property
    def interior(self) -> tuple[int, ...]:
        """The interior vertices in increasing order."""
        outside = set(self.boundary)
        return tuple(v for v in range(len(self.vertices)) if v not in outside)

    @cached_property
    def edges(self) -> tuple[Edge, ...]:
        """All edges (i, j) with i < j, sorted."""
        count = len(self.vertices)
        if len(self.triangles) >= large_disk.MANY:
            return large_disk.sorted_edges(self.triangles, count)
        numbers: set[int] = set()  # edge (i, j) as i * count + j: integers are quickly sorted
        for a, b, c in self.triangles:
            numbers.add(a * count + b if a < b else b * count + a)
            numbers.add(b * count + c if b < c else c * count + b)
            numbers.add(c * count + a if c < a else a * count + c)
        return tuple(divmod(number, count) for number in sorted(numbers))

    @cached_property
    def boundary_edges(self) -> tuple[Edge, ...]:
        """The boundary edges (i, j) with i < j, sorted."""
        cycle = self.boundary
        pairs = zip(cycle, cycle[1:] + cycle[:1], strict=True)
        return tuple(sorted((min(e), max(e)) for e in pairs))

    @cached_property
    def folds(self) -> tuple[Edge, ...]:
        """The folds, that is, the interior edges (i, j) with i < j, sorted."""
        outside = set(self.boundary_edges)
        return tuple(e for e in self.edges if e not in outside)

    @cached_property
    def chords(self) -> tuple[Edge, ...]:
        """The folds that join two boundary vertices; each of them splits the sheet in two."""
        outside = set(self.boundary)
        return tuple((i, j) for i, j in self.folds if i in outside and j in outside)

    def star(self, vertex: int) -> tuple[int, ...]:
        """The neighbours of `vertex` in counter-clockwise order.

        At an interior vertex they start with the smallest index. At a boundary vertex they run from
        the next boundary vertex to the previous one.
        """
        rotation = self._next[vertex]
        start = min(rotation) if vertex in self.interior_set else self._first_spoke(vertex)
        cycle = [start]
        while cycle[-1] in rotation and (after := rotation[cycle[-1]]) != start:
            cycle.append(after)
        return tuple(cycle)

    def _first_spoke(self, vertex: int) -> int:
        rotation = self._next[vertex]
        return next(iter(set(rotation) - set(rotation.values())))

    @cached_property
    def interior_set(self) -> frozenset[int]:
        """The interior vertices, for tests of membership."""
        return frozenset(self.interior)

    def degree(self, vertex: int) -> int:
        """The number of edges at `vertex`."""
        return len(self.star(vertex))

    @property
    def degrees(self) -> dict[int, int]:
        """The degree of every vertex.

        >>> wheel = CreasePattern(
        ...     [(0, 0), (3, 0), (0, 3), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)])
        >>> wheel.degrees
        {0: 3, 1: 3, 2: 3, 3: 3}
        """
        return {v: self.degree(v) for v in range(len(self.vertices))}

    def left(self, i: int, j: int) -> int:
        """The third vertex of the triangle to the left of the directed edge from i to j."""
        return self._next[i][j]

    def opposite(self, fold: Edge) -> Edge:
        """The third vertices (left, right) of the triangles ijk and jil at the fold (i, j)."""
        i, j = fold
        return self._next[i][j], self._next[j][i]

    # --- counts ----------------------------------------------------------------------------------

    @property
    def Ve(self) -> int:
        """The number of boundary (external) vertices."""
        return len(self.boundary)

    @property
    def Vi(self) -> int:
        """The number of interior vertices."""
        return len(self.interior)

    @property
    def degrees_of_freedom(self) -> int:
        """The number D = Ve - 3 (the paper's Eq. Dcount)."""
        return self.Ve - 3

    D = degrees_of_freedom

    @property
    def Vt(self) -> int:
        """The number of vertices inside triangulated triangles."""
        return len(self.rigid_vertices)

    @cached_property
    def triangulated_triangles(self) -> tuple[tuple[Triangle, tuple[int, ...]], ...]:
        """The maximal 3-cycles with vertices inside, each with the vertices inside it.

        A 3-cycle runs counter-clockwise from its smallest index. On every branch the pattern inside
        it stays flat. If the sheet has three boundary vertices, these form the only maximal
        3-cycle.
        """
        points, _ = self.integer_vertices
        return find_triangulated_triangles(points, self.edges, self.triangles, self._next)

    @cached_property
    def rigid_vertices(self) -> frozenset[int]:
        """The vertices inside triangulated triangles."""
        return frozenset(v for _, inside in self.triangulated_triangles for v in inside)

    @property
    def foldable_vertices(self) -> tuple[int, ...]:
        """The interior vertices outside all triangulated triangles."""
        return tuple(v for v in self.interior if v not in self.rigid_vertices)

    def without_rigid_parts(
        self, curved: Collection[int] = ()
    ) -> tuple[CreasePattern, tuple[int, ...]]:
        """The pattern in which each triangulated triangle is one face, and the labels of vertices.

        Vertex k of the returned pattern is vertex `labels[k]` of this pattern; the order is kept.
        Triangulated triangles that contain one of the vertices `curved` are not changed.

        >>> wheel = CreasePattern(
        ...     [(0, 0), (3, 0), (0, 3), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)])
        >>> reduced, labels = wheel.without_rigid_parts()
        >>> reduced.triangles, labels
        (((0, 1, 2),), (0, 1, 2))
        """
        stiff = [item for item in self.triangulated_triangles if not set(curved) & set(item[1])]
        gone = {v for _, inside in stiff for v in inside}
        labels = tuple(v for v in range(len(self.vertices)) if v not in gone)
        if not gone:
            return self, labels
        position = {v: k for k, v in enumerate(labels)}
        kept = [t for t in self.triangles if gone.isdisjoint(t)]
        kept += [t for t, _ in stiff]
        triangles = [(position[a], position[b], position[c]) for a, b, c in kept]
        return CreasePattern([self.vertices[v] for v in labels], triangles), labels

    # --- geometry --------------------------------------------------------------------------------

    @cached_property
    def integer_vertices(self) -> tuple[tuple[tuple[int, int], ...], int]:
        """Integer points P_v and the least d > 0 with vertices_v = P_v / d."""
        flat, denominator = over_common_denominator(x for point in self.vertices for x in point)
        return tuple(zip(flat[::2], flat[1::2], strict=True)), denominator

    @cached_property
    def area(self) -> Fraction:
        """The area of the sheet, in squared length units."""
        points, denominator = self.integer_vertices
        twice = sum(validate.orientation(*(points[v] for v in t)) for t in self.triangles)
        return Fraction(twice, 2 * denominator**2)

    @cached_property
    def boundary_turns(self) -> tuple[int, ...]:
        """The turn at each boundary vertex: 1 convex, 0 straight (angle pi), -1 reflex."""
        points, _ = self.integer_vertices
        cycle = self.boundary
        turns = []
        for k, v in enumerate(cycle):
            before, after = cycle[k - 1], cycle[(k + 1) % len(cycle)]
            turn = validate.orientation(points[before], points[v], points[after])
            turns.append((turn > 0) - (turn < 0))
        return tuple(turns)

    @property
    def is_convex(self) -> bool:
        """Whether no boundary angle exceeds pi."""
        return -1 not in self.boundary_turns

    @property
    def reflex_corner(self) -> int | None:
        """The first boundary vertex with an angle above pi; None if the boundary is convex."""
        turns = zip(self.boundary, self.boundary_turns, strict=True)
        return next((v for v, turn in turns if turn < 0), None)

    def with_notch_closed(self) -> CreasePattern:
        """The pattern with a triangle attached at its reflex corner, which becomes interior.

        If the boundary is convex, the pattern itself is returned. Raises an `OverlapError` if the
        triangle does not fit, which cannot happen for four boundary vertices.

        >>> dart = CreasePattern([(0, 0), (4, -4), (1, 0), (4, 4)], [(0, 1, 2), (0, 2, 3)])
        >>> dart.with_notch_closed().boundary
        (0, 1, 3)
        """
        corner = self.reflex_corner
        if corner is None:
            return self
        k = self.boundary.index(corner)
        before, after = self.boundary[k - 1], self.boundary[(k + 1) % self.Ve]
        return CreasePattern(self.vertices, [*self.triangles, (before, after, corner)])

    def snapped(self, denominator: int) -> tuple[CreasePattern, Fraction]:
        """The pattern rounded to multiples of 1/denominator, and the largest coordinate change.

        Raises a `PatternError` that mentions the rounding if the rounded pattern is not valid.

        >>> pattern = CreasePattern([(0, 0), ("0.99999999", 0), (0, 1)], [(0, 1, 2)])
        >>> pattern.snapped(8)[1]
        Fraction(1, 100000000)
        """
        moved = tuple((snap(x, denominator), snap(y, denominator)) for x, y in self.vertices)
        pairs = zip(self.vertices, moved, strict=True)
        largest = max(abs(a - b) for p, q in pairs for a, b in zip(p, q, strict=True))
        with validate.rounded_to(denominator):
            return CreasePattern(moved, self.triangles), largest

    # --- identity --------------------------------------------------------------------------------

    @cached_property
    def sha256(self) -> str:
        """The digest of the exact pattern, with vertices in order and triangles as a set.

        It is the SHA-256 of the lines `exactfold pattern 1`, `v X Y` for each vertex and `t I J K`
        for each triangle (counter-clockwise from the smallest index, sorted). A newline ends each
        line.
        """
        lines = ["exactfold pattern 1"]
        lines += [f"v {format_rational(x)} {format_rational(y)}" for x, y in self.vertices]
        lines += [f"t {a} {b} {c}" for a, b, c in sorted(self.triangles)]
        return hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()

    def __hash__(self) -> int:
        return hash(self.sha256)

    def __reduce__(self) -> tuple[object, ...]:
        return _restored, (self.vertices, self.triangles)  # without the cached properties

    def __repr__(self) -> str:
        return f"<CreasePattern: {self.Vi} interior and {self.Ve} boundary vertices>"


def _restored(vertices: tuple[Point, ...], triangles: tuple[Triangle, ...]) -> CreasePattern:
    """A copy of a pattern, which was validated when it was first made.

    The copy is not validated again: that would take a second for 10,000 vertices, and it would
    protect nobody, as whoever can forge a pickle can make it run any program.
    """
    pattern = object.__new__(CreasePattern)
    object.__setattr__(pattern, "vertices", vertices)
    object.__setattr__(pattern, "triangles", triangles)
    return pattern
