"""The linear functionals whose signs are vertex signs and letters of folds, as rows on (x, 1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.exact.numbers import integer_row
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.functionals import (
    fold_functional,
    saddle_functional,
    vertex_sign_functional,
)

Row = tuple[int, ...]


@dataclass(frozen=True)
class Functionals:
    """The sign functionals of a chart, for interior vertices and folds (docs/mathematics.md, 9).

    A row (c_1, ..., c_n, c_0) has the value c . x + c_0 at the point x of the chart.
    """

    chart: Chart

    @cached_property
    def vertices(self) -> Mapping[int, Row]:
        """Rows that are positive if the vertex pops up, negative if down, zero if it is flat."""
        pattern = self.chart.branch_system.pattern
        return {
            v: self.chart.integer_row(vertex_sign_functional(pattern, v)) for v in pattern.interior
        }

    @cached_property
    def folds(self) -> Mapping[Edge, Row]:
        """Rows that are positive for a valley, negative for a mountain, zero for a flat fold."""
        pattern = self.chart.branch_system.pattern
        return {
            fold: self.chart.integer_row(fold_functional(pattern, fold)) for fold in pattern.folds
        }

    @cached_property
    def saddle(self) -> Row:
        """The row of the boundary saddle of a sheet with four boundary vertices."""
        pattern = self.chart.branch_system.pattern
        return integer_row(self.chart.restrict(saddle_functional(pattern)))

    @cached_property
    def heights(self) -> Mapping[int, tuple[Fraction, ...]]:
        """The row of the height of every vertex."""
        pattern = self.chart.branch_system.pattern
        return {v: tuple(self.chart.restrict({v: 1})) for v in range(len(pattern.vertices))}
