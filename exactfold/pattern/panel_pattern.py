"""A flat sheet of rigid panels: faces with any number of sides, creases that end anywhere."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import lcm
from types import MappingProxyType
from typing import Final, TypeAlias

from exactfold._support.notebook import Picture
from exactfold._support.plurals import counted
from exactfold.errors import (
    MalformedPatternError,
    NotADiskError,
    NotApplicableError,
    NotCountedError,
)
from exactfold.exact.numbers import decimal_above, format_rational
from exactfold.exact.surds import Number, Surd, SurdField, common_field
from exactfold.pattern.planar import counter_clockwise, trace_faces

Edge: TypeAlias = tuple[int, int]
Point: TypeAlias = tuple[Number, Number]
_LONGEST: Final = 256
"""The longest common denominator, in bits, with which integers are shorter than fractions."""


@dataclass(frozen=True)
class PanelPattern(Picture):
    """A planar drawing of creases on one sheet of paper; every bounded face is a rigid panel.

    `vertices` are points with coordinates in Q or in a field of square roots (`SurdField`).
    `edges` are sorted index pairs (i, j), i < j: the boundary of the sheet and all creases. Two
    edges meet in a common end only, every edge has a face on at least one side, and the boundary
    passes each of its vertices once. Faces need not be convex, and creases may end anywhere on the
    boundary.

    `holes` are bounded faces where there is no paper, as cycles of vertices with any start and
    direction. They are kept sorted, counter-clockwise from the smallest vertex. The boundary of the
    sheet includes that of its holes.

    Raises the errors of `trace_faces`, `MalformedPatternError` if there is no face or if a hole is
    none or takes all panels of an edge, and `NotADiskError` if a part of the sheet hangs by one
    vertex; so it does where a hole touches the edge of the paper or another hole.

    >>> cross = PanelPattern([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0), (0, -1), (1, 0),
    ...                       (0, 1), (-1, 0)],
    ...                      [(0, 5), (5, 1), (1, 6), (6, 2), (2, 7), (7, 3), (3, 8), (8, 0),
    ...                       (4, 5), (4, 6), (4, 7), (4, 8)])
    >>> cross.interior, cross.folds, len(cross.faces)
    ((4,), ((4, 5), (4, 6), (4, 7), (4, 8)), 4)
    >>> ring = PanelPattern([(0, 0), (9, 0), (0, 9), (3, 3), (4, 3), (3, 4)], [(0, 1), (1, 2),
    ...     (0, 2), (3, 4), (4, 5), (3, 5), (0, 3), (1, 4), (2, 5)], holes=[(3, 4, 5)])
    >>> ring.interior, ring.folds, len(ring.faces), ring.holes
    ((), ((0, 3), (1, 4), (2, 5)), 3, ((3, 4, 5),))
    """

    vertices: tuple[Point, ...]
    edges: tuple[Edge, ...]
    holes: tuple[tuple[int, ...], ...]

    def __init__(
        self,
        vertices: Iterable[Sequence[Number]],
        edges: Iterable[Edge],
        holes: Iterable[Sequence[int]] = (),
    ) -> None:
        points = tuple((_exact(x), _exact(y)) for x, y in vertices)
        field = common_field(c for point in points for c in point)
        if field.radicands:
            points = tuple((field.number(x), field.number(y)) for x, y in points)
        pairs = tuple(sorted({(min(i, j), max(i, j)) for i, j in edges}))
        for i, j in pairs:
            if i < 0 or j >= len(points):
                raise MalformedPatternError(f"edge {i}-{j} uses a vertex that does not exist")
        object.__setattr__(self, "vertices", points)
        object.__setattr__(self, "edges", pairs)
        object.__setattr__(self, "holes", ())
        if not pairs or not self.faces:
            raise MalformedPatternError(
                "the edges of the drawing enclose no face: draw the boundary of the sheet"
            )
        if taken := [tuple(hole) for hole in holes]:
            self._take_out(taken)
        self._check_boundary()

    def _take_out(self, holes: Sequence[tuple[int, ...]]) -> None:
        """Makes holes of faces; every edge must be left a side of a panel."""
        known = {frozenset(_sides(face)): face for face in self.faces}
        found = []
        for hole in holes:
            face = known.pop(frozenset(_sides(hole)), None) or known.pop(
                frozenset(_sides(hole[::-1])), None
            )
            if face is None:
                named = "-".join(map(str, hole))
                raise MalformedPatternError(f"the hole {named} is no face of the drawing")
            found.append(face)
        if not known:
            raise MalformedPatternError("all faces are holes: the sheet has no panel")
        for name in ("sides", "boundary_edges", "folds", "boundary_set", "interior", "stars"):
            self.__dict__.pop(name, None)
        self.__dict__["faces"] = tuple(sorted(known.values()))
        object.__setattr__(self, "holes", tuple(sorted(found)))
        bare = [(i, j) for i, j in self.edges if not {(i, j), (j, i)} & self.sides.keys()]
        if bare:
            i, j = bare[0]
            raise MalformedPatternError(f"edge {i}-{j} is the side of no panel", vertices=[i, j])

    # --- combinatorics ---------------------------------------------------------------------------

    @property
    def field(self) -> SurdField:
        """The field that contains all coordinates."""
        return common_field(c for point in self.vertices for c in point)

    @property
    def radicands(self) -> tuple[Number, ...]:
        """The numbers under the square roots r1, r2, ... of the field."""
        return self.field.numbers

    @property
    def field_name(self) -> str:
        """The field in words: `Q`, `Q(sqrt 2)`, or `Q(sqrt 2, sqrt (1 + r1))`."""
        return self.field.name

    @cached_property
    def faces(self) -> tuple[tuple[int, ...], ...]:
        """The panels, sorted; each runs counter-clockwise from its smallest vertex."""
        return tuple(trace_faces(self.scaled_vertices, self.edges))

    @cached_property
    def sides(self) -> Mapping[tuple[int, int], int]:
        """The face on the left of each directed edge, for the edges that have one."""
        sides: dict[tuple[int, int], int] = {}
        for k, face in enumerate(self.faces):
            for i, j in _sides(face):
                sides[i, j] = k
        return MappingProxyType(sides)

    @cached_property
    def boundary_edges(self) -> tuple[Edge, ...]:
        """The edges with a face on one side only."""
        return tuple(
            (i, j) for i, j in self.edges if ((i, j) in self.sides) != ((j, i) in self.sides)
        )

    @cached_property
    def folds(self) -> tuple[Edge, ...]:
        """The edges between two panels, sorted."""
        boundary_set = set(self.boundary_edges)
        return tuple(edge for edge in self.edges if edge not in boundary_set)

    @cached_property
    def boundary_set(self) -> frozenset[int]:
        """The vertices on the boundary of the sheet."""
        return frozenset(v for edge in self.boundary_edges for v in edge)

    @cached_property
    def interior(self) -> tuple[int, ...]:
        """The vertices inside the sheet, in increasing order."""
        return tuple(v for v in range(len(self.vertices)) if v not in self.boundary_set)

    @cached_property
    def stars(self) -> Mapping[int, tuple[int, ...]]:
        """The neighbours of each interior vertex, counter-clockwise."""
        around: dict[int, list[int]] = {v: [] for v in self.interior}
        for i, j in self.folds:
            if i in around:
                around[i].append(j)
            if j in around:
                around[j].append(i)
        ordered = {
            v: tuple(counter_clockwise(self.vertices, v, near)) for v, near in around.items()
        }
        return MappingProxyType(ordered)

    @property
    def D(self) -> int:
        """The number of folds, less 3 for each interior vertex and 6 for each hole.

        Every component of the configuration space has at least this dimension, if it is not
        negative: a vertex closes if three equations hold, and a hole if six do.
        """
        return len(self.folds) - 3 * len(self.interior) - 6 * len(self.holes)

    # --- geometry --------------------------------------------------------------------------------

    @cached_property
    def scaled_vertices(self) -> tuple[Point, ...]:
        """The vertices times an integer that clears all denominators, if there is a short one.

        If many lines cross, their crossings have long denominators without a common factor. Then
        the vertices are returned unchanged, since their integer multiples would be longer than all
        fractions together.
        """

        def parts(value: Number) -> Sequence[Fraction]:
            return value.coefficients if isinstance(value, Surd) else (Fraction(value),)

        scale = 1
        for denominator in {
            p.denominator for point in self.vertices for c in point for p in parts(c)
        }:
            scale = lcm(scale, denominator)
            if scale.bit_length() > _LONGEST:
                return self.vertices
        return tuple((_whole(x * scale), _whole(y * scale)) for x, y in self.vertices)

    def direction(self, start: int, end: int) -> Point:
        """The vector from one vertex to another, in units of `scaled_vertices`."""
        (ax, ay), (bx, by) = self.scaled_vertices[start], self.scaled_vertices[end]
        return bx - ax, by - ay

    def check_positions(self) -> None:
        """Raises `NotApplicableError` if the positions of vertices are known only nearly."""

    def check_disk(self, what: str = "this") -> None:
        """Raises `NotCountedError` for a sheet with holes; `what` names the work that needs one
        without holes.
        """
        if self.holes:
            raise NotCountedError(
                f"the sheet has {counted(len(self.holes), 'hole')}, and {what} is not done yet for "
                "sheets with holes: `count` says how they start to fold, and `fold`, `info`, "
                "`vertices`, `convert`, `draw` and `view` take them"
            )

    def _check_boundary(self) -> None:
        ends: dict[int, int] = {}
        for edge in self.boundary_edges:
            for v in edge:
                ends[v] = ends.get(v, 0) + 1
        pinched = sorted(v for v, count in ends.items() if count != 2)
        if pinched and self.holes:
            raise NotADiskError(
                f"a hole touches the edge of the paper or another hole in vertex {pinched[0]}",
                vertices=pinched,
            )
        if pinched:
            raise NotADiskError(
                f"the sheet hangs together only by vertex {pinched[0]}: its boundary passes this "
                "vertex twice",
                vertices=pinched,
            )

    # --- identity --------------------------------------------------------------------------------

    @cached_property
    def sha256(self) -> str:
        """The digest of the exact pattern: the field, the vertices in order, and the edges.

        It is the SHA-256 of the lines `exactfold panels 1`, `r C...` for each adjoined root,
        `v X... Y...` for each vertex (all coefficients), `e I J` for each edge and `h I J K...` for
        each hole. A newline ends each line.
        """
        lines = ["exactfold panels 1"]
        lines += ["r " + " ".join(map(format_rational, r)) for r in self.field.radicands]
        lines += [f"v {_text(x)} {_text(y)}" for x, y in self.vertices]
        lines += [f"e {i} {j}" for i, j in self.edges]
        lines += ["h " + " ".join(map(str, hole)) for hole in self.holes]
        return _digest(lines)

    def __hash__(self) -> int:
        return hash((len(self.vertices), self.edges, self.holes))

    def __reduce__(self) -> tuple[object, ...]:
        # without the cached properties
        return PanelPattern, (self.vertices, self.edges, self.holes)

    def __repr__(self) -> str:
        return (
            f"<PanelPattern: {counted(len(self.interior), 'interior vertex')}, "
            f"{counted(len(self.folds), 'fold')}, {counted(len(self.faces), 'panel')}"
            f"{', ' + counted(len(self.holes), 'hole') if self.holes else ''}>"
        )


@dataclass(frozen=True, init=False, repr=False)
class EnclosedPattern(PanelPattern):
    """A sheet whose folds have exact directions, and whose positions are known only nearly.

    There is a sheet with exactly these `directions`, with the faces of this drawing, and with no
    vertex further than `radius` from its point in `vertices`. Whoever makes an `EnclosedPattern`
    has proved that. `directions` maps edges (i, j), i < j, to vectors from i to j, of any length;
    it has all folds. Everything that depends on the directions of folds alone, such as the ways to
    fold rigid panels, is exact for this sheet. Positions are not, and no certificate has them.
    """

    directions: Mapping[Edge, Point]
    radius: Fraction

    def __init__(
        self,
        vertices: Iterable[Sequence[Number]],
        edges: Iterable[Edge],
        directions: Mapping[Edge, Point],
        radius: Fraction,
        holes: Iterable[Sequence[int]] = (),
    ) -> None:
        super().__init__(vertices, edges, holes)
        if missing := [fold for fold in self.folds if fold not in directions]:
            raise MalformedPatternError(f"fold {missing[0][0]}-{missing[0][1]} has no direction")
        object.__setattr__(self, "directions", MappingProxyType(dict(directions)))
        object.__setattr__(self, "radius", radius)

    @property
    def field(self) -> SurdField:
        """The field that contains all directions."""
        return common_field(c for vector in self.directions.values() for c in vector)

    def direction(self, start: int, end: int) -> Point:
        """A vector along a fold from one end to the other, of any length."""
        if start < end:
            return self.directions[start, end]
        x, y = self.directions[end, start]
        return -x, -y

    def check_positions(self) -> None:
        """Raises `NotApplicableError`."""
        raise NotApplicableError(
            "the folds of the inferred sheet have exact directions, but the exact positions of its "
            "vertices are too long to be written down; they are known only within "
            f"{decimal_above(self.radius, 1)}"
        )

    @cached_property
    def sha256(self) -> str:
        """The digest of the points, the radius, the edges and the exact directions."""
        lines = ["exactfold enclosed panels 1", f"within {format_rational(self.radius)}"]
        lines += ["r " + " ".join(map(format_rational, r)) for r in self.field.radicands]
        lines += [f"v {_text(x)} {_text(y)}" for x, y in self.vertices]
        lines += [f"e {i} {j}" for i, j in self.edges]
        lines += ["h " + " ".join(map(str, hole)) for hole in self.holes]
        lines += [f"d {i} {j} {_text(x)} {_text(y)}" for (i, j), (x, y) in self._sorted()]
        return _digest(lines)

    def _sorted(self) -> list[tuple[Edge, Point]]:
        return sorted(self.directions.items(), key=lambda item: item[0])

    def __hash__(self) -> int:
        return super().__hash__()

    def __reduce__(self) -> tuple[object, ...]:
        parts = (self.vertices, self.edges, dict(self.directions), self.radius, self.holes)
        return EnclosedPattern, parts


def _sides(cycle: Sequence[int]) -> list[tuple[int, int]]:
    return list(zip(cycle, (*cycle[1:], cycle[0]), strict=True))


def _text(value: Number) -> str:
    parts = value.coefficients if isinstance(value, Surd) else (Fraction(value),)
    return " ".join(format_rational(c) for c in parts)


def _digest(lines: Iterable[str]) -> str:
    return hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()


def _exact(value: Number) -> Number:
    return value if isinstance(value, Surd) else Fraction(value)


def _whole(value: Number) -> Number:
    return value if isinstance(value, Surd) else int(value)
