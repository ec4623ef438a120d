"""Exact heights in every chamber: branches, and solutions of K_v = k_v > 0 for all signs."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product

from exactfold import (
    BranchCount,
    CreasePattern,
    QuadraticSystem,
    count_branches,
    curvature_form,
    isolate,
)
from exactfold.branches.branch import Branch
from exactfold.branches.functionals import integer_row
from exactfold.branches.roots import BoxRoot
from exactfold.errors import NotApplicableError
from exactfold.rigidity.timelike import vertex_sign_functional
from exactfold.solve.homotopy import homotopy
from exactfold.verdict import PROVED, Verdict

Heights = dict[int, Fraction]


@lru_cache(maxsize=256)
def counted(pattern: CreasePattern) -> BranchCount:
    """The branches of a pattern, counted once: proofs are run again for each deliberate mistake."""
    return count_branches(pattern)


@dataclass(frozen=True)
class Solutions:
    """What was found for the right-hand sides k_v > 0 and the boundary heights of one pattern.

    `points` are the rational centres of the boxes of the real solutions, and `signs` the vertex
    signs that hold on all of each box, None where undecided. `complete` is PROVED if there are no
    other solutions, real or complex.
    """

    pattern: CreasePattern
    points: tuple[Heights, ...]
    signs: tuple[tuple[int | None, ...], ...]
    complete: Verdict

    @property
    def is_one_each(self) -> bool:
        """Whether exactly one solution is proved for each sign vector, and no other."""
        n = self.pattern.Vi
        right = set(self.signs) == set(product((1, -1), repeat=n))
        return self.complete is PROVED and right and len(self.points) == 1 << n


@lru_cache(maxsize=128)
def solve(pattern: CreasePattern, seed: int) -> Solutions:
    """All solutions of K_v(h) = k_v, with random k_v > 0 and random boundary heights.

    >>> from exactfold.pattern.families import single_vertex
    >>> solve(single_vertex(5), 0).is_one_each
    True
    """
    source = random.Random(seed)
    fixed = {v: Fraction(source.randint(-5, 5)) for v in pattern.boundary}
    position = {v: k for k, v in enumerate(pattern.interior)}
    n = len(position)
    matrices, rows = [], []
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        matrix = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
        for a, line in zip(form.labels, form.matrix, strict=True):
            for b, weight in zip(form.labels, line, strict=True):
                i, j = position.get(a, n), position.get(b, n)
                matrix[i][j] += weight * fixed.get(a, Fraction(1)) * fixed.get(b, Fraction(1))
        matrix[n][n] -= Fraction(source.randint(1, 9), source.randint(1, 9))
        matrices.append(matrix)
        row = [Fraction(0)] * (n + 1)
        for u, c in vertex_sign_functional(pattern, v).items():
            row[position.get(u, n)] += c * fixed.get(u, Fraction(1))
        rows.append(integer_row(row))
    system = QuadraticSystem.from_rational(matrices)
    found = isolate(system, homotopy(system))
    boxes = [box for box in found.boxes if box.is_real]
    points = tuple(
        fixed
        | {v: Fraction(m, 1 << box.bits) for v, m in zip(pattern.interior, box.real, strict=True)}
        for box in boxes
    )
    signs = tuple(tuple(BoxRoot(box).sign(row) for row in rows) for box in boxes)
    return Solutions(pattern, points, signs, found.complete)


def vertex_signs(pattern: CreasePattern, heights: Mapping[int, Fraction]) -> tuple[int, ...]:
    """1 up, -1 down, 0 undefined, in the order of the interior vertices; needs all K_v >= 0."""
    values = (
        sum((c * heights[u] for u, c in vertex_sign_functional(pattern, v).items()), Fraction(0))
        for v in pattern.interior
    )
    return tuple((value > 0) - (value < 0) for value in values)


def corner_sign(pattern: CreasePattern, branch: Branch) -> int | None:
    """Whether the reflex corner pops up (1) or down (-1) in the closed sheet, on a shown branch.

    None if the enclosure of the branch does not decide it.
    """
    closed, corner = pattern.with_notch_closed(), pattern.reflex_corner
    if corner is None:
        raise NotApplicableError("a convex sheet has no reflex corner")
    weighted = [
        [c * x for x in branch.height_rows[v]]
        for v, c in vertex_sign_functional(closed, corner).items()
    ]
    return branch.root.sign(integer_row([sum(column) for column in zip(*weighted, strict=True)]))


def jacobian(pattern: CreasePattern, heights: Mapping[int, Fraction]) -> list[list[Fraction]]:
    """J(h) = (K_v(h, e_u)), v and u interior: half the Jacobian of the curvature forms at h."""
    rows = [curvature_form(pattern, v).functional(heights) for v in pattern.interior]
    return [[row.get(u, Fraction(0)) for u in pattern.interior] for row in rows]
