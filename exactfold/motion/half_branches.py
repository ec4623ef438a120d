"""The two halves of every branch: the directions in which a sheet leaves the flat state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.branches.letters import SIGNS
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.problem.problem import Problem
from exactfold.rigidity.functionals import saddle_functional, vertex_sign_functional


@dataclass(frozen=True, order=True)
class HalfBranch:
    """One of the two rays of a branch, named by what the moving sheet itself shows.

    `vertex_signs`: of the foldable vertices in order, 1 popped up and -1 popped down. `saddle`: the
    sign of the boundary saddle. On a sheet with four boundary vertices and n foldable ones there
    are 2^(n + 1) of them, if all branches are simple.
    """

    vertex_signs: tuple[int, ...]
    saddle: int

    @property
    def mirrored(self) -> HalfBranch:
        """The half-branch of the mirror image."""
        return HalfBranch(tuple(-s for s in self.vertex_signs), -self.saddle)

    @property
    def sign_text(self) -> str:
        """The vertex signs as in "+-"."""
        return "".join(SIGNS[s] for s in self.vertex_signs)

    def to_dict(self) -> dict[str, object]:
        """The half-branch as JSON shows it."""
        return {"vertex_signs": self.sign_text, "saddle": self.saddle}

    def __str__(self) -> str:
        return f"{self.sign_text}, saddle {SIGNS[self.saddle]}"


def half_branch_of(branch: Branch, side: int, problem: Problem) -> HalfBranch:
    """The half-branch that a branch shows, or that of its mirror image for `side` -1."""
    signs = tuple(side * branch.vertex_signs[v] for v in problem.foldable)
    return HalfBranch(signs, side * branch.saddle)


@dataclass(frozen=True)
class HeightSigns:
    """Reads vertex signs and the boundary saddle from heights in floats."""

    sheet: CreasePattern

    @cached_property
    def _rows(self) -> FloatArray:
        sheet = self.sheet
        functionals: list[Mapping[int, Fraction] | Mapping[int, int]] = [
            *(vertex_sign_functional(sheet, v) for v in sheet.interior),
            saddle_functional(sheet),
        ]
        rows = np.zeros((len(functionals), len(sheet.vertices)))
        for row, functional in zip(rows, functionals, strict=True):
            exact = {v: Fraction(c) for v, c in functional.items()}
            largest = max(map(abs, exact.values()))
            for v, c in exact.items():
                row[v] = float(c / largest)
        return rows

    def of(self, heights: FloatArray) -> HalfBranch:
        """The half-branch whose tangent has these heights of all vertices, shape (V,)."""
        *signs, saddle = (int(s) for s in np.sign(self._rows @ heights))
        return HalfBranch(tuple(signs), saddle)
