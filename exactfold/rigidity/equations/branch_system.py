"""The branch system of a pattern: homogeneous quadrics in a gauge, and their affine charts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import gcd, lcm
from typing import Any

from exactfold.errors import MalformedPatternError, NotApplicableError, UsageError
from exactfold.exact.forms import QuadraticForm
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.quadratic import IntMatrix, QuadraticSystem, primitive_matrices
from exactfold.rigidity.functionals import saddle_functional, vertex_sign_functional


@dataclass(frozen=True)
class BranchSystem:
    """K_v(h) = 0 for every interior vertex v, with three non-collinear vertices pinned at h = 0.

    These are Vi homogeneous quadrics in the Vi + D heights of `variables` (docs/mathematics.md,
    Branch system). Pinning removes the affine functions, on which all curvature forms vanish. By
    default the pinned vertices lie on the boundary. For D = 1 they are all boundary vertices but
    one; the chart `saddle = 1` fixes the height of this one to 1.

    Raises `MalformedPatternError` if the pinned vertices are collinear, and `UsageError` if they
    are not three different vertices.

    >>> from exactfold.pattern.families import single_vertex
    >>> system = BranchSystem(single_vertex(4))
    >>> system.pinned, system.variables
    ((1, 2, 3), (0, 4))
    """

    pattern: CreasePattern
    pinned: tuple[int, int, int]

    def __init__(self, pattern: PatternLike, pinned: Sequence[int] | None = None) -> None:
        pattern = as_pattern(pattern)
        object.__setattr__(self, "pattern", pattern)
        chosen = _default_pins(pattern) if pinned is None else tuple(sorted(pinned))
        count = len(pattern.vertices)
        if len(set(chosen)) != 3 or not all(0 <= v < count for v in chosen):
            raise UsageError(f"pin three different vertices, not {tuple(chosen)}")
        if _collinear(pattern, chosen):
            raise MalformedPatternError(
                f"the pinned vertices {tuple(chosen)} are collinear", vertices=chosen
            )
        object.__setattr__(self, "pinned", tuple(chosen))

    @property
    def variables(self) -> tuple[int, ...]:
        """The vertices that are not pinned, in increasing order."""
        return tuple(v for v in range(len(self.pattern.vertices)) if v not in self.pinned)

    def __repr__(self) -> str:
        pinned = ", ".join(map(str, self.pinned))
        return f"<BranchSystem: {pinned} pinned, {self.pattern!r}>"

    @cached_property
    def quadrics(self) -> dict[int, QuadraticForm]:
        """The curvature form of each interior vertex, restricted to the variables in its star."""
        result = {}
        for v in self.pattern.interior:
            form = curvature_form(self.pattern, v)
            keep = [k for k, label in enumerate(form.labels) if label not in self.pinned]
            rows = [[form.integers[i][j] for j in keep] for i in keep]
            result[v] = QuadraticForm.over(form.denominator, (form.labels[k] for k in keep), rows)
        return result

    @cached_property
    def chart(self) -> Chart:
        """For D = 1: the affine chart in which the boundary saddle (`saddle_functional`) is 1.

        Raises `NotApplicableError` if D is not 1, as the solutions are then not isolated points.
        """
        if self.pattern.degrees_of_freedom != 1:
            raise NotApplicableError(
                "a chart with isolated solutions needs four boundary vertices, "
                f"not {self.pattern.Ve}"
            )
        functional = {v: c for v, c in saddle_functional(self.pattern).items() if c}
        eliminated = next(v for v in functional if v not in self.pinned)
        return Chart(self, functional, eliminated)


def notch_chart(pattern: CreasePattern) -> Chart:
    """For a quadrilateral with a reflex corner r: the chart `K_r(t, h) = 1` of the closed sheet.

    If a triangle closes the notch, K_r > 0 on every solution (docs/theorem.md, Four boundary
    vertices). So the sign functional of r vanishes on no solution: unlike the chart of the saddle,
    this chart has no branch at infinity. The other three corners are pinned. Raises
    `NotApplicableError` for other boundaries.
    """
    corner = pattern.reflex_corner
    if corner is None or pattern.Ve != 4:
        raise NotApplicableError(
            "only a boundary of four vertices with a reflex corner has a notch"
        )
    system = BranchSystem(pattern, [v for v in pattern.boundary if v != corner])
    signs = vertex_sign_functional(pattern.with_notch_closed(), corner)
    functional = {v: Fraction(c, abs(signs[corner])) for v, c in signs.items() if c}
    return Chart(system, functional, corner)


def chamber_chart(pattern: CreasePattern) -> Chart:
    """The chart in which vertex signs alone name each branch.

    (docs/theorem.md, Four boundary vertices.) For a convex boundary it is `saddle = 1`, for one
    with a reflex corner the chart of the closed notch. Neither has a branch at infinity. Raises
    `NotApplicableError` unless Ve = 4.

    >>> from exactfold.pattern.families import single_vertex
    >>> chamber_chart(single_vertex(4)).system.bezout_number
    2
    """
    if pattern.Ve != 4:
        raise NotApplicableError(
            f"signs name branches of sheets with four boundary vertices, not {pattern.Ve}"
        )
    return BranchSystem(pattern).chart if pattern.is_convex else notch_chart(pattern)


@dataclass(frozen=True)
class Chart:
    """The part of projective space in which a linear functional of the heights is 1.

    The equation functional = 1 expresses the height of the vertex `eliminated` by the others.
    `variables` are the remaining unknowns, and `system` holds the Vi affine quadrics in them
    (docs/mathematics.md, Heights). Zeros at infinity of the chart are the branches on which the
    functional vanishes.
    """

    branch_system: BranchSystem
    functional: Mapping[int, Fraction]
    eliminated: int

    @property
    def is_saddle(self) -> bool:
        """Whether the functional is the boundary saddle."""
        system = self.branch_system
        return self == system.chart and system.pinned == BranchSystem(system.pattern).pinned

    @cached_property
    def variables(self) -> tuple[int, ...]:
        """The unknowns of the chart, as vertex indices."""
        return tuple(v for v in self.branch_system.variables if v != self.eliminated)

    def __repr__(self) -> str:
        return f"<Chart: height of vertex {self.eliminated} eliminated, {self.branch_system!r}>"

    @cached_property
    def eliminated_row(self) -> tuple[Fraction, ...]:
        """The coefficients (a_1, ..., a_n, b) of the eliminated height sum a_k x_k + b."""
        lead = self.functional[self.eliminated]
        slope = tuple(-self.functional.get(v, Fraction(0)) / lead for v in self.variables)
        return (*slope, 1 / lead)

    @cached_property
    def system(self) -> QuadraticSystem:
        """The quadrics K_v in the chart; for D = 1 there are as many as unknowns."""
        return QuadraticSystem.from_rational(self.matrices)

    @cached_property
    def matrices(self) -> tuple[IntMatrix, ...]:
        """The quadrics K_v in the chart, as matrices over (x, 1), in the order of `interior`."""
        matrices = []
        for form in self.branch_system.quadrics.values():
            lifts = [self._integer_rows[v].items() for v in form.labels]
            size = len(self.variables) + 1
            matrix = [[0] * size for _ in range(size)]
            for left, weights in zip(lifts, form.integers, strict=True):
                for right, weight in zip(lifts, weights, strict=True):
                    if not weight:
                        continue
                    for i, x in left:
                        for j, y in right:
                            matrix[i][j] += weight * x * y
            matrices.append(matrix)
        return primitive_matrices(matrices)

    @cached_property
    def _unit(self) -> int:
        """The least d > 0 such that d times each row of `row` has integer coefficients."""
        return lcm(*(a.denominator for a in self.eliminated_row))

    @cached_property
    def _integer_rows(self) -> dict[int, dict[int, int]]:
        """`row` of every vertex times `_unit`."""
        unit = self._unit
        rows: dict[int, dict[int, int]] = {v: {} for v in self.branch_system.pinned}
        rows |= {v: {k: unit} for k, v in enumerate(self.variables)}
        row = enumerate(self.eliminated_row)
        return rows | {self.eliminated: {k: int(a * unit) for k, a in row if a}}

    def row(self, vertex: int) -> dict[int, Fraction]:
        """The height of a vertex as coefficients of x by position; position n is the constant."""
        return {k: Fraction(a, self._unit) for k, a in self._integer_rows[vertex].items()}

    def heights(self, x: Sequence[Fraction]) -> dict[int, Fraction]:
        """The heights of all vertices at a point of the chart."""
        z = [*x, Fraction(1)]
        return {
            v: sum((a * z[k] for k, a in self.row(v).items()), Fraction(0))
            for v in range(len(self.branch_system.pattern.vertices))
        }

    def restrict(self, functional: Mapping[int, int | Fraction]) -> list[Fraction]:
        """A linear functional of the heights, as coefficients (c_1, ..., c_n, c_0) of (x, 1)."""
        return [Fraction(value) / self._unit for value in self._in_units(functional)]

    def integer_row(self, functional: Mapping[int, int]) -> tuple[int, ...]:
        """The least positive multiple with integers of `restrict` of an integer functional."""
        row = self._in_units(functional)
        common = gcd(self._unit, *row)
        return tuple(value // common for value in row)

    def _in_units(self, functional: Mapping[int, Any]) -> list[Any]:
        """`restrict` times `_unit`; an integer functional gives integers."""
        row: list[Any] = [0] * (len(self.variables) + 1)
        for v, weight in functional.items():
            for k, a in self._integer_rows[v].items():
                row[k] += weight * a
        return row


def _collinear(pattern: CreasePattern, vertices: Sequence[int]) -> bool:
    (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in vertices)
    return (bx - ax) * (cy - ay) == (by - ay) * (cx - ax)


def _default_pins(pattern: CreasePattern) -> tuple[int, ...]:
    boundary = pattern.boundary
    if len(boundary) == 4:
        saddle = saddle_functional(pattern)
        unit = next(v for v in boundary if saddle[v])
        return tuple(sorted(v for v in boundary if v != unit))
    first, second = boundary[:2]
    third = next(v for v in boundary[2:] if not _collinear(pattern, (first, second, v)))
    return tuple(sorted((first, second, third)))
