"""A flat sheet of rigid panels: faces of any number of sides, creases that end anywhere."""

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
from exactfold.errors import MalformedPatternError, NotADiskError
from exactfold.exact.numbers import format_rational
from exactfold.exact.surds import Number, Surd, SurdField, common_field
from exactfold.pattern.planar import counter_clockwise, trace_faces

Edge: TypeAlias = tuple[int, int]
Point: TypeAlias = tuple[Number, Number]
_LONGEST: Final = 256
"""Bits of a common denominator up to which whole numbers are shorter than fractions."""


@dataclass(frozen=True)
class PanelPattern(Picture):
    """A planar drawing of creases on one sheet of paper; every bounded face is a rigid panel.

    `vertices` are points with coordinates in Q or in a field of square roots (`SurdField`),
    `edges` index pairs (i, j), i < j, sorted: the border of the sheet and all creases. The edges
    meet in common ends only, every edge has a face on at least one side, and the border passes
    each of its vertices once. Faces need not be convex, and creases may end anywhere on the border.

    Raises the errors of `trace_faces`, `MalformedPatternError` if there is no face, and
    `NotADiskError` where the sheet hangs together by a vertex.

    >>> cross = PanelPattern([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0), (0, -1), (1, 0),
    ...                       (0, 1), (-1, 0)],
    ...                      [(0, 5), (5, 1), (1, 6), (6, 2), (2, 7), (7, 3), (3, 8), (8, 0),
    ...                       (4, 5), (4, 6), (4, 7), (4, 8)])
    >>> cross.interior, cross.folds, len(cross.faces)
    ((4,), ((4, 5), (4, 6), (4, 7), (4, 8)), 4)
    """

    vertices: tuple[Point, ...]
    edges: tuple[Edge, ...]

    def __init__(self, vertices: Iterable[Sequence[Number]], edges: Iterable[Edge]) -> None:
        points = tuple((_exact(x), _exact(y)) for x, y in vertices)
        field = common_field(c for point in points for c in point)
        if field.radicands:
            points = tuple((field.number(x), field.number(y)) for x, y in points)
        pairs = tuple(sorted({(min(i, j), max(i, j)) for i, j in edges}))
        if any(not 0 <= v < len(points) for pair in pairs for v in pair):
            raise MalformedPatternError("an edge uses a vertex that is not there")
        object.__setattr__(self, "vertices", points)
        object.__setattr__(self, "edges", pairs)
        if not pairs or not self.faces:
            raise MalformedPatternError("the drawing encloses no face")
        self._check_border()

    # --- combinatorics ---------------------------------------------------------------------------

    @property
    def field(self) -> SurdField:
        """The field of the coordinates."""
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
        """The panels, each counter-clockwise from its smallest vertex, sorted."""
        return tuple(trace_faces(self.scaled_vertices, self.edges))

    @cached_property
    def sides(self) -> Mapping[tuple[int, int], int]:
        """The face to the left of each directed edge that has one."""
        found: dict[tuple[int, int], int] = {}
        for k, face in enumerate(self.faces):
            for i, j in zip(face, (*face[1:], face[0]), strict=True):
                found[i, j] = k
        return MappingProxyType(found)

    @cached_property
    def border_edges(self) -> tuple[Edge, ...]:
        """The edges with a face on one side only."""
        return tuple(
            (i, j) for i, j in self.edges if ((i, j) in self.sides) != ((j, i) in self.sides)
        )

    @cached_property
    def folds(self) -> tuple[Edge, ...]:
        """The edges between two panels, sorted."""
        border = set(self.border_edges)
        return tuple(edge for edge in self.edges if edge not in border)

    @cached_property
    def border(self) -> frozenset[int]:
        """The vertices on the border of the sheet."""
        return frozenset(v for edge in self.border_edges for v in edge)

    @cached_property
    def interior(self) -> tuple[int, ...]:
        """The vertices inside the sheet, in increasing order."""
        return tuple(v for v in range(len(self.vertices)) if v not in self.border)

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
        """folds - 3 Vi: the dimension of every component is at least this, if not negative."""
        return len(self.folds) - 3 * len(self.interior)

    # --- geometry --------------------------------------------------------------------------------

    @cached_property
    def scaled_vertices(self) -> tuple[Point, ...]:
        """The vertices times a whole number that clears all denominators, if there is a short one.

        Many crossings of lines have long denominators without a common factor: then the vertices
        as they are, since their multiples would be longer than all of them together.
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
        """The vector between two vertices, in units of `scaled_vertices`."""
        (ax, ay), (bx, by) = self.scaled_vertices[start], self.scaled_vertices[end]
        return bx - ax, by - ay

    def _check_border(self) -> None:
        ends: dict[int, int] = {}
        for edge in self.border_edges:
            for v in edge:
                ends[v] = ends.get(v, 0) + 1
        pinched = sorted(v for v, count in ends.items() if count != 2)
        if pinched:
            raise NotADiskError(
                f"the sheet hangs together by vertex {pinched[0]} only: the border passes it twice",
                vertices=pinched,
            )

    # --- identity --------------------------------------------------------------------------------

    @cached_property
    def sha256(self) -> str:
        """Digest of the exact pattern: the field, the vertices in order, and the edges.

        The SHA-256 of the lines `exactfold panels 1`, `r C...` for each root that was adjoined,
        `v X... Y...` for each vertex (all coefficients) and `e I J` for each edge, each ended by a
        newline.
        """

        def text(value: Number) -> str:
            parts = value.coefficients if isinstance(value, Surd) else (Fraction(value),)
            return " ".join(format_rational(c) for c in parts)

        lines = ["exactfold panels 1"]
        lines += ["r " + " ".join(map(format_rational, r)) for r in self.field.radicands]
        lines += [f"v {text(x)} {text(y)}" for x, y in self.vertices]
        lines += [f"e {i} {j}" for i, j in self.edges]
        return hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()

    def __hash__(self) -> int:
        return hash((len(self.vertices), self.edges))

    def __reduce__(self) -> tuple[object, ...]:
        return PanelPattern, (self.vertices, self.edges)  # what is cached stays behind

    def __repr__(self) -> str:
        return (
            f"<PanelPattern: {counted(len(self.interior), 'interior vertex')}, "
            f"{counted(len(self.folds), 'fold')}, {counted(len(self.faces), 'panel')}>"
        )


def _exact(value: Number) -> Number:
    return value if isinstance(value, Surd) else Fraction(value)


def _whole(value: Number) -> Number:
    return value if isinstance(value, Surd) else int(value)
