"""The gauge: it fixes some heights, so that every branch is a point and not a ray."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property

from exactfold.errors import NotCountedError
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.boundary_heights import given_boundary_heights, given_deficits
from exactfold.rigidity.functionals import saddle_functional

SADDLE, CORNER, RIM = "saddle", "corner", "rim"


@dataclass(frozen=True, repr=False)
class Gauge:
    """The given boundary heights of `sheet`, and the given curvatures of its vertices.

    `kind` is one of three (docs/mathematics.md, Heights):

    - "saddle": a convex quadrilateral. One boundary vertex has height 1, the others have height 0,
      so that the boundary saddle (`saddle_functional`) is +1.
    - "corner": a quadrilateral with a reflex corner. In `sheet` a triangle closes its notch. The
      other three corners have height 0. The reflex corner, which is now an interior vertex, pops up
      with K = `corner_curvature`.
    - "rim": a convex boundary of any length with given heights. `curvature` holds the angle
      deficits K_v of interior vertices that are not 0; with deficits, the boundary heights are 0 if
      none are given.

    In all three cases there is exactly one solution in the closed nappes of each sign vector
    (docs/theorem.md, Four boundary vertices; docs/branch.md, Angle deficits). `sheet` has the
    vertices of the given sheet and no others.
    """

    kind: str
    sheet: CreasePattern
    boundary_heights: Mapping[int, Fraction]
    corner: int | None = None
    curvature: Mapping[int, Fraction] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        sheet: CreasePattern,
        boundary_heights: Mapping[int, RationalLike] | None = None,
        curvature: Mapping[int, RationalLike] | None = None,
    ) -> Gauge:
        """The gauge of a sheet with four boundary vertices, or with given heights or deficits.

        Raises `NotCountedError` for another number of boundary vertices without `boundary_heights`,
        and the errors of `given_boundary_heights` and `given_deficits`.

        >>> from exactfold.pattern.families import single_vertex
        >>> gauge = Gauge.of(single_vertex(4))
        >>> gauge.kind, {v: str(height) for v, height in gauge.boundary_heights.items()}
        ('saddle', {0: '1', 1: '0', 2: '0', 3: '0'})
        """
        if curvature is not None:
            deficits = given_deficits(sheet, curvature)
            level = (
                dict.fromkeys(sheet.boundary, 0) if boundary_heights is None else boundary_heights
            )
            heights = given_boundary_heights(sheet, level, may_be_flat=bool(deficits))
            return cls(RIM, sheet, heights, None, deficits)
        if boundary_heights is not None:
            return cls(RIM, sheet, given_boundary_heights(sheet, boundary_heights))
        if sheet.Ve != 4:
            raise NotCountedError(
                "the sheet has three boundary vertices: it is rigid and has no branches"
                if sheet.Ve == 3
                else f"vertex signs name a branch of a sheet with four boundary vertices, but this "
                f"sheet has {sheet.Ve}. Its ways to fold form continuous families, with one way "
                "for each choice of the boundary heights: give them (`exactfold branch` with "
                "--boundary-heights; in Python find_branch with boundary_heights=)"
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
        """The vertices with unknown heights: first those that a sign vector names, then the corner.

        Each has one equation: K_v = 0, or K = `corner_curvature` at the corner.
        """
        named = tuple(v for v in self.sheet.interior if v != self.corner)
        return named if self.corner is None else (*named, self.corner)

    def __repr__(self) -> str:
        where = "" if self.corner is None else f" {self.corner}"
        return f"<Gauge: {self.kind}{where}, {len(self.boundary_heights)} boundary vertices>"

    @cached_property
    def corner_curvature(self) -> Fraction:
        """The curvature 1 / size^2, where size is the larger side of the bounding box."""
        return 1 / pattern_size(self.sheet) ** 2

    @cached_property
    def targets(self) -> Mapping[int, Fraction]:
        """The curvatures K_v that are not 0, by vertex of `sheet`."""
        if self.corner is not None:
            return {self.corner: self.corner_curvature}
        return self.curvature


def pattern_size(pattern: CreasePattern) -> Fraction:
    """The larger side of the bounding box: the unit of length that keeps floats in range."""
    points, denominator = pattern.integer_vertices
    sides = (max(p[axis] for p in points) - min(p[axis] for p in points) for axis in (0, 1))
    return Fraction(max(sides), denominator)
