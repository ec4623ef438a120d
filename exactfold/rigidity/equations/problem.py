"""The problem that all solvers and certifiers share: a sheet, its gauge, its exact equations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from exactfold.errors import NotCountedError
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.boundary_heights import given_boundary_heights, given_deficits
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart, chamber_chart
from exactfold.rigidity.equations.gauge import Gauge

if TYPE_CHECKING:
    from exactfold.rigidity.rigid_triangles import RigidTriangle
from exactfold.rigidity.equations.sign_rows import Functionals


@dataclass(frozen=True, repr=False)
class Problem:
    """The equations K_v(h) = 0 of the part of a pattern that can fold, in one gauge.

    In `sheet` each triangulated triangle of the pattern is a single face, as its inside stays flat.
    Vertex k of `sheet` is vertex `labels[k]` of `pattern`. Solvers and certifiers work on `sheet`;
    `labels`, `all_heights` and `height_rows` lead back to the pattern.

    >>> from exactfold.pattern.families import two_vertex
    >>> problem = Problem.of(two_vertex())
    >>> problem.size, problem.gauge.kind, problem.foldable
    (2, 'saddle', (4, 5))
    """

    pattern: CreasePattern
    sheet: CreasePattern
    labels: tuple[int, ...]
    gauge: Gauge

    @classmethod
    def of(
        cls,
        pattern: CreasePattern,
        *,
        boundary_heights: Mapping[int, RationalLike] | None = None,
        curvature: Mapping[int, RationalLike] | None = None,
    ) -> Problem:
        """The problem of a pattern with four boundary vertices, or with given boundary heights.

        `curvature` maps interior vertices to angle deficits; other vertices have the deficit 0. A
        triangulated triangle with a deficit inside does not stay flat. Raises the errors of
        `Gauge.of`.
        """
        deficits = None if curvature is None else given_deficits(pattern, curvature)
        if (
            boundary_heights is not None
        ):  # checked here, so that messages name vertices of the pattern
            boundary_heights = given_boundary_heights(
                pattern, boundary_heights, may_be_flat=bool(deficits)
            )
        sheet, labels = pattern.without_rigid_parts(deficits or ())
        place = {v: k for k, v in enumerate(labels)}
        heights = (
            None
            if boundary_heights is None
            else {place[v]: height for v, height in boundary_heights.items()}
        )
        curved = None if deficits is None else {place[v]: k for v, k in deficits.items()}
        return cls(pattern, sheet, labels, Gauge.of(sheet, heights, curved))

    @cached_property
    def rigid(self) -> frozenset[int]:
        """The vertices of the pattern that are not in the sheet, because they stay flat."""
        return frozenset(range(len(self.pattern.vertices))) - set(self.labels)

    @property
    def size(self) -> int:
        """The number n of foldable vertices; a sign vector names these."""
        return self.sheet.Vi

    def require_foldable(self) -> None:
        """Raises `NotCountedError` if there is no interior vertex, or all stay flat."""
        if not self.pattern.interior:
            raise NotCountedError("no vertex can pop: the pattern has no interior vertex")
        if not self.sheet.interior:
            raise NotCountedError(
                "no vertex can pop: all interior vertices lie in triangulated triangles and stay "
                "flat, so no branch has vertex signs; `exactfold count` lists the branches"
            )

    @cached_property
    def foldable(self) -> tuple[int, ...]:
        """The foldable vertices of the pattern in the order of a sign vector."""
        return tuple(self.labels[v] for v in self.sheet.interior)

    @cached_property
    def triangles(self) -> tuple[RigidTriangle, ...] | None:
        """The triangulated triangles with proofs that they stay flat; None if one is missing."""
        from exactfold.rigidity.rigid_triangles import certify_rigid_triangles  # loads FLINT

        return certify_rigid_triangles(self.pattern)

    @cached_property
    def chart(self) -> Chart:
        """The chart in which vertex signs alone name each of the 2^n branches."""
        return chamber_chart(self.sheet)

    @cached_property
    def functionals(self) -> Functionals:
        """The functionals on `chart` whose signs are the vertex signs and the letters."""
        return Functionals(self.chart)

    def all_heights(self, known: Mapping[int, Fraction]) -> dict[int, Fraction]:
        """The heights of all vertices of the pattern, from those of the vertices of the sheet."""
        heights = {self.labels[v]: height for v, height in known.items()}
        for vertex, cycle, weights in self.flat_inside:
            heights[vertex] = sum(
                (w * heights[c] for w, c in zip(weights, cycle, strict=True)), Fraction(0)
            )
        return dict(sorted(heights.items()))

    def height_rows(self, chart: Chart) -> dict[int, tuple[Fraction, ...]]:
        """The heights of all vertices of the pattern, as rows on (x, 1), x in a chart of `sheet`.

        The sheet is tilted so that the vertices pinned in the chart `saddle = 1` have height 0.
        """
        pinned = BranchSystem(self.sheet).pinned
        rows = {self.labels[v]: row for v, row in Functionals(chart).heights.items()}
        if chart.branch_system.pinned != pinned:
            corners = tuple(self.labels[v] for v in pinned)
            rows = {v: self._above(corners, v, rows) for v in rows}
        for vertex, cycle, weights in self.flat_inside:
            rows[vertex] = tuple(
                sum((w * x for w, x in zip(weights, column, strict=True)), Fraction(0))
                for column in zip(*(rows[c] for c in cycle), strict=True)
            )
        return dict(sorted(rows.items()))

    def __repr__(self) -> str:
        return f"<Problem: {self.size} foldable vertices, {self.gauge!r}>"

    def _above(
        self, corners: tuple[int, ...], vertex: int, rows: Mapping[int, tuple[Fraction, ...]]
    ) -> tuple[Fraction, ...]:
        """The height of a vertex above the plane through three others, as a row."""
        weights = barycentric(self.pattern, corners, vertex)
        return tuple(
            own - sum((w * x for w, x in zip(weights, column, strict=True)), Fraction(0))
            for own, *column in zip(rows[vertex], *(rows[c] for c in corners), strict=True)
        )

    @cached_property
    def flat_inside(self) -> list[tuple[int, tuple[int, ...], tuple[Fraction, ...]]]:
        """The rigid vertices, with their 3-cycles and their barycentric coordinates in these."""
        return [
            (v, cycle, barycentric(self.pattern, cycle, v))
            for cycle, inside in self.pattern.triangulated_triangles
            for v in inside
            if v in self.rigid
        ]


def barycentric(
    pattern: CreasePattern, cycle: Sequence[int], vertex: int
) -> tuple[Fraction, Fraction, Fraction]:
    """The barycentric coordinates of a vertex with respect to three others, exactly."""
    (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in cycle)
    x, y = pattern.vertices[vertex]
    whole = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    beta = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / whole
    gamma = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / whole
    return 1 - beta - gamma, beta, gamma
