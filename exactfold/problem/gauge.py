"""The gauge: which heights are given, so that every branch is a point and not a ray."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.errors import NotApplicableError, NotCountedError, UsageError
from exactfold.exact.numbers import RationalLike, as_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.functionals import saddle_functional

SADDLE, CORNER, RIM = "saddle", "corner", "rim"


@dataclass(frozen=True, repr=False)
class Gauge:
    """Given heights of the rim of `sheet`, and the one vertex, if any, with a given curvature.

    `kind` is one of three (docs/conventions.md, Heights):

    - "saddle": a convex quadrilateral. One boundary vertex has height 1, the others 0, so that the
      boundary saddle (`saddle_functional`) is +1.
    - "corner": a quadrilateral with a reflex corner. In `sheet` its notch is closed by a triangle,
      the other three corners have height 0, and the corner, now an interior vertex, pops up with
      K = `corner_curvature`.
    - "rim": a convex boundary of any length, with heights that were given.

    In all three there is exactly one solution in the closed nappes of each sign vector
    (docs/theorem.md, Four boundary vertices). `sheet` has the vertices of the sheet that was given,
    and no others.
    """

    kind: str
    sheet: CreasePattern
    rim: Mapping[int, Fraction]
    corner: int | None = None

    @classmethod
    def of(cls, sheet: CreasePattern, rim: Mapping[int, RationalLike] | None = None) -> Gauge:
        """The gauge of a sheet with four boundary vertices, or with given rim heights.

        Raises `NotCountedError` for another number of boundary vertices without `rim`,
        `NotApplicableError` for `rim` on a boundary with a reflex corner and for a flat `rim`,
        `UsageError` unless `rim` names exactly the boundary vertices.

        >>> from exactfold.pattern.families import single_vertex
        >>> gauge = Gauge.of(single_vertex(4))
        >>> gauge.kind, {v: str(height) for v, height in gauge.rim.items()}
        ('saddle', {0: '1', 1: '0', 2: '0', 3: '0'})
        """
        if rim is not None:
            return cls(RIM, sheet, given_rim(sheet, rim))
        if sheet.Ve != 4:
            raise NotCountedError(
                "the sheet has three boundary vertices: it is rigid and has no branches"
                if sheet.Ve == 3
                else f"vertex signs name a branch of a sheet with four boundary vertices; this one "
                f"has {sheet.Ve}, so its ways to fold form continuous families (from Python, "
                "find_branch with rim=... finds the one way with given heights of the boundary)"
            )
        corner = sheet.reflex_corner
        if corner is not None:
            closed = sheet.with_notch_closed()
            return cls(CORNER, closed, dict.fromkeys(closed.boundary, Fraction(0)), corner)
        saddle = saddle_functional(sheet)
        raised = next(v for v in sheet.boundary if saddle[v])
        return cls(SADDLE, sheet, {v: Fraction(v == raised) for v in sheet.boundary})

    @cached_property
    def unknowns(self) -> tuple[int, ...]:
        """The vertices whose heights are unknown: those that a sign vector names, then the corner.

        One equation each: K_v = 0, and K = `corner_curvature` at the corner.
        """
        named = tuple(v for v in self.sheet.interior if v != self.corner)
        return named if self.corner is None else (*named, self.corner)

    def __repr__(self) -> str:
        where = "" if self.corner is None else f" {self.corner}"
        return f"<Gauge: {self.kind}{where}, {len(self.rim)} vertices on the rim>"

    @cached_property
    def corner_curvature(self) -> Fraction:
        """1 / size^2, with the larger side of the bounding box as the size of the sheet."""
        return 1 / pattern_size(self.sheet) ** 2


def pattern_size(pattern: CreasePattern) -> Fraction:
    """The larger side of the bounding box: the unit of length that keeps floats in range."""
    points, denominator = pattern.integer_vertices
    sides = (max(p[axis] for p in points) - min(p[axis] for p in points) for axis in (0, 1))
    return Fraction(max(sides), denominator)


def given_rim(pattern: CreasePattern, rim: Mapping[int, RationalLike]) -> dict[int, Fraction]:
    """Heights of the boundary vertices, checked; raises as `Gauge.of`."""
    if set(rim) != set(pattern.boundary):
        raise UsageError(f"give a height for each boundary vertex: {pattern.boundary}")
    if not pattern.is_convex:
        raise NotApplicableError(
            f"rim heights need a convex boundary; vertex {pattern.reflex_corner} is reflex"
        )
    heights = {v: as_rational(rim[v]) for v in pattern.boundary}
    a, b = pattern.boundary[:2]
    (ax, ay), (bx, by) = pattern.vertices[a], pattern.vertices[b]

    def row(v: int) -> tuple[Fraction, Fraction]:
        # Distance from the line ab, and height above it.
        x, y = pattern.vertices[v][0] - ax, pattern.vertices[v][1] - ay
        dx, dy = bx - ax, by - ay
        along = (x * dx + y * dy) / (dx * dx + dy * dy)
        return x * dy - y * dx, heights[v] - heights[a] - along * (heights[b] - heights[a])

    rows = [row(v) for v in pattern.boundary[2:]]
    third = next(r for r in rows if r[0])
    if all(r[1] * third[0] == third[1] * r[0] for r in rows):
        raise NotApplicableError("the rim is flat: the only sheet without curvature is flat")
    return heights
