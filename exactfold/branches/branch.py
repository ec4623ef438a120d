"""A branch: one line of second-order foldings through the unfolded state, and what names it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.branches.named import NamedBranch
from exactfold.branches.roots import Root
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import Edge


@dataclass(frozen=True)
class Branch(NamedBranch):
    """One branch of a pattern with D = 1, shown by its ray of positive boundary saddle.

    `vertex_signs`: interior vertex -> +1 popped up, -1 popped down, 0 proved flat. `assignment`:
    fold (i, j) -> "M" mountain, "V" valley, "F" proved flat, "U" undecided, seen from +z.
    `multiplicity` is that of the solution of the branch system. `representative` is "saddle", or
    "either" if the saddle is not proved to differ from 0 (reflex boundaries only): then either side
    may be shown. `heights` encloses the height of every vertex.
    """

    vertex_signs: Mapping[int, int]
    assignment: Mapping[Edge, str]
    multiplicity: int
    root: Root
    representative: str
    height_rows: Mapping[int, tuple[Fraction, ...]]

    @cached_property
    def heights(self) -> dict[int, tuple[Fraction, Fraction]]:
        """Rational bounds of the height of every vertex, in the gauge of the chart."""
        return {v: self.root.enclose(row) for v, row in self.height_rows.items()}

    @property
    def approx_heights(self) -> dict[int, float]:
        """Heights as floats, for pictures."""
        return {v: float((low + high) / 2) for v, (low, high) in self.heights.items()}

    def sort_key(self) -> tuple[list[int], str]:
        """Vertex signs in the order of the vertices, -1 before 0 before +1, then the folds."""
        return [s for _, s in sorted(self.vertex_signs.items())], self.assignment_text

    def to_dict(self) -> dict[str, object]:
        """The branch as in `exactfold count --json`."""
        return {
            "vertex_signs": {str(v): s for v, s in sorted(self.vertex_signs.items())},
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.assignment.items())},
            "multiplicity": self.multiplicity,
            "representative": self.representative,
            "heights": {
                str(v): [format_rational(low), format_rational(high)]
                for v, (low, high) in sorted(self.heights.items())
            },
        }
