"""Exact heights in every chamber: branches, and solutions of K_v = k_v > 0 for all signs."""

from __future__ import annotations

import random
from collections.abc import Mapping, Set
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product

from exactfold import BranchCount, CreasePattern
from exactfold._support.verdict import PROVED, Verdict
from exactfold.branches import count_branches
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.roots import BoxRoot, EnclosedRoot
from exactfold.errors import NotApplicableError
from exactfold.exact import QuadraticForm
from exactfold.exact.linalg import Inertia, from_fmpq, inertia, to_flint
from exactfold.exact.numbers import integer_row
from exactfold.rigidity import QuadraticSystem, curvature_form
from exactfold.rigidity.functionals import vertex_sign_functional
from exactfold.solve import isolate
from exactfold.solve.numeric.homotopy import homotopy

Heights = dict[int, Fraction]


@lru_cache(maxsize=512)
def forms(pattern: CreasePattern) -> dict[int, QuadraticForm]:
    """The curvature form of every interior vertex."""
    return {v: curvature_form(pattern, v) for v in pattern.interior}


@lru_cache(maxsize=512)
def sign_functionals(pattern: CreasePattern) -> dict[int, dict[int, int]]:
    """The vertex sign functional of every interior vertex."""
    return {v: vertex_sign_functional(pattern, v) for v in pattern.interior}


@lru_cache(maxsize=256)
def counted(pattern: CreasePattern) -> BranchCount:
    """The branches of a pattern, remembered, because tests run a proof once for each mistake."""
    return count_branches(pattern)


@dataclass(frozen=True)
class Solutions:
    """The solutions for right-hand sides k_v > 0 and boundary heights of one pattern.

    `points` are the rational centres of boxes that hold the real solutions; no height of a solution
    differs from that of its centre by more than `radius`. `signs` are the vertex signs that hold on
    the whole of each box, None where they are undecided. `complete` is PROVED if there are no other
    solutions, real or complex.
    """

    pattern: CreasePattern
    points: tuple[Heights, ...]
    signs: tuple[tuple[int | None, ...], ...]
    radius: Fraction
    complete: Verdict

    @property
    def is_one_each(self) -> bool:
        """Whether exactly one solution is proved for each sign vector, and no other."""
        n = self.pattern.Vi
        right = set(self.signs) == set(product((1, -1), repeat=n))
        return self.complete is PROVED and right and len(self.points) == 1 << n


@lru_cache(maxsize=128)
def solve(pattern: CreasePattern, seed: int, sign: int = 1) -> Solutions:
    """All solutions of K_v(h) = sign k_v, with random k_v > 0 and random boundary heights.

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
        form = forms(pattern)[v]
        matrix = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
        for a, line in zip(form.labels, form.matrix, strict=True):
            for b, weight in zip(form.labels, line, strict=True):
                i, j = position.get(a, n), position.get(b, n)
                matrix[i][j] += weight * fixed.get(a, Fraction(1)) * fixed.get(b, Fraction(1))
        matrix[n][n] -= sign * Fraction(source.randint(1, 9), source.randint(1, 9))
        matrices.append(matrix)
        row = [Fraction(0)] * (n + 1)
        for u, c in sign_functionals(pattern)[v].items():
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
    radius = max((Fraction(box.radius, 1 << box.bits) for box in boxes), default=Fraction(0))
    return Solutions(pattern, points, signs, radius, found.complete)


def vertex_signs(pattern: CreasePattern, heights: Mapping[int, Fraction]) -> tuple[int, ...]:
    """1 up, -1 down, 0 undefined, in the order of the interior vertices; needs all K_v >= 0."""
    values = (
        sum((c * heights[u] for u, c in sign_functionals(pattern)[v].items()), Fraction(0))
        for v in pattern.interior
    )
    return tuple((value > 0) - (value < 0) for value in values)


def corner_sign(pattern: CreasePattern, branch: Branch) -> int | None:
    """Whether on a branch the reflex corner pops up (1) or down (-1) in the closed sheet.

    None if the enclosure of the branch does not decide it.
    """
    closed, corner = pattern.with_notch_closed(), pattern.reflex_corner
    if corner is None:
        raise NotApplicableError("a convex sheet has no reflex corner")
    weighted = [
        [c * x for x in branch.height_rows[v]] for v, c in sign_functionals(closed)[corner].items()
    ]
    if branch.root is None or isinstance(branch.root, EnclosedRoot):
        raise NotApplicableError("the branch has no root in a chart")
    return branch.root.sign(integer_row([sum(column) for column in zip(*weighted, strict=True)]))


def jacobian(pattern: CreasePattern, heights: Mapping[int, Fraction]) -> list[list[Fraction]]:
    """J(h) = (K_v(h, e_u)), v and u interior: half the Jacobian of the curvature forms at h."""
    rows = [form.functional(heights) for form in forms(pattern).values()]
    return [[row.get(u, Fraction(0)) for u in pattern.interior] for row in rows]


def inertia_at(
    pattern: CreasePattern, box: Mapping[int, tuple[Fraction, Fraction]], flat: Set[int]
) -> Inertia | None:
    """The inertia of J(h), the same for all heights h between two bounds; None if undecided.

    `flat` names vertices that are known to be flat; their rows of J are zero and are left out. Let
    Y be the inverse of J(m) at the centre m. If the entries of each row of |Y| R add up to less
    than 1, no matrix is singular whose entries differ from those of J(m) by less than those of R.
    """
    centre = {v: (low + high) / 2 for v, (low, high) in box.items()}
    reach = {v: abs(high - low) / 2 for v, (low, high) in box.items()}
    keep = [k for k, v in enumerate(pattern.interior) if v not in flat]
    if not keep:
        return 0, 0, len(pattern.interior)
    whole = jacobian(pattern, centre)
    matrix = [[whole[i][j] for j in keep] for i in keep]
    radii = []
    for i in keep:
        form = forms(pattern)[pattern.interior[i]]
        row = {
            u: sum((abs(m) * reach[x] for m, x in zip(line, form.labels, strict=True)), Fraction(0))
            for u, line in zip(form.labels, form.matrix, strict=True)
        }
        radii.append(sum((row.get(pattern.interior[j], Fraction(0)) for j in keep), Fraction(0)))
    positive, negative, zero = inertia(matrix)
    if zero:
        return None
    inverse = to_flint(matrix).inv().tolist()
    rows = (
        sum((abs(from_fmpq(y)) * r for y, r in zip(line, radii, strict=True)), Fraction(0))
        for line in inverse
    )
    return (positive, negative, len(flat)) if all(row < 1 for row in rows) else None
