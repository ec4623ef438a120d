"""All branches of a pattern as arrays: proved signs and letters, directions with error bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from operator import mul

import numpy as np
import numpy.typing as npt

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, Verdict
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.by_theorem import IN_MEMORY, is_too_many
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.result import BranchCount
from exactfold.errors import NotCountedError
from exactfold.exact.numbers import over_common_denominator
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.functionals import fold_functional
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import FloatBoxes
from exactfold.solve.numeric.nappe_newton import sign_vectors

SignArray = npt.NDArray[np.int8]

UNKNOWN = 2
"""Stands in place of the sign of a fold that is not decided."""

_U = 2.0**-53
_UP = 1.0 + 2.0**-20
_VALUES = {letter: UNKNOWN if sign is None else sign for sign, letter in LETTERS.items()}
_BITS = 80
"""Bounds have so many bits if branches come one by one, or are sharpened."""


@dataclass(frozen=True)
class Lines:
    """All branches of a pattern with four corners, one row each, seen from either side.

    `signs` (branches, interior vertices): 1 up, -1 down, 0 proved flat. `letters` (branches,
    folds): 1 valley, -1 mountain, 0 proved flat, `UNKNOWN`. `directions` (branches, folds): the
    unit vector of the first-order fold angles of each branch (`fold_angles`), as doubles that are
    within `errors` of the true ones in the Euclidean norm. Interior vertices and folds have the
    order of the pattern. If `status` is PROVED, these are all branches, each once, and
    `with_multiplicity` is the number of solutions with multiplicity; otherwise there are no rows.
    `sharp(rows)` computes directions and errors of rows anew, from boxes of `_BITS` bits; it is
    None if `directions` come from such boxes already.
    """

    pattern: CreasePattern
    status: Verdict
    signs: SignArray
    letters: SignArray
    directions: FloatArray
    errors: FloatArray
    with_multiplicity: int | None
    sharp: Callable[[Sequence[int]], tuple[FloatArray, FloatArray]] | None = field(compare=False)

    @classmethod
    def of(cls, pattern: CreasePattern) -> Lines:
        """All branches, proved as by `count_branches`, and read from arrays if possible.

        UNDECIDED for more than 2^20 branches, which are not kept in memory. Raises the errors of
        `count_branches`.

        >>> from exactfold.pattern.families import two_vertex
        >>> lines = Lines.of(two_vertex())
        >>> lines.signs.tolist()
        [[1, 1], [-1, 1], [1, -1], [-1, -1]]
        >>> bool(lines.errors.max() < 1e-9)
        True
        """
        if is_too_many(pattern, IN_MEMORY):
            return _one_by_one(count_branches(pattern))
        try:
            branch_blocks = BranchBlocks.of(pattern)
        except NotCountedError:
            return _one_by_one(count_branches(pattern))
        return _by_blocks(branch_blocks) or _one_by_one(count_branches(pattern))

    def sharper(self, rows: Sequence[int]) -> tuple[FloatArray, FloatArray]:
        """Directions of some branches, up to sign, with errors in the last bits only; the errors.

        If there are no better ones, these are rows of `directions`.
        """
        if self.sharp is None:
            return self.directions[rows], self.errors[rows]
        return self.sharp(rows)

    @property
    def distinct(self) -> int | None:
        """The number of branches; None if it is not proved."""
        return len(self.signs) if self.status is PROVED else None

    @property
    def flat_vertices(self) -> int:
        """How many foldable vertices are flat on some branch."""
        rigid = {v for _, inside in self.pattern.triangulated_triangles for v in inside}
        flat = (self.signs == 0).any(axis=0).tolist()
        interior = self.pattern.interior
        return sum(f for v, f in zip(interior, flat, strict=True) if v not in rigid)


def _by_blocks(branch_blocks: BranchBlocks) -> Lines | None:
    """The branches of all blocks; None unless each sign vector has a proved root with letters."""
    problem, count = branch_blocks.problem, branch_blocks.block_size
    pattern = problem.pattern
    total = 1 << branch_blocks.size
    signs = np.zeros((total, pattern.Vi), dtype=np.int8)
    letters = np.zeros((total, len(pattern.folds)), dtype=np.int8)
    points = np.empty((total, branch_blocks.size + 1))
    radii = np.empty(total)
    points[:, -1] = 1.0
    boxes: list[FloatBoxes] = []
    exact: dict[int, IsolatingBox] = {}
    vertices = [pattern.interior.index(v) for v in problem.foldable]
    places = {fold: k for k, fold in enumerate(pattern.folds)}
    labels = problem.labels
    folds = [places[labels[i], labels[j]] for i, j in sorted(problem.sheet.folds)]
    for index in range(branch_blocks.blocks):
        block = branch_blocks.prove(index)
        if not block.is_decided:
            return None
        rows = slice(index * count, (index + 1) * count)
        block_letters = np.where(block.valleys, 1, -1).astype(np.int8)
        boxes.append(block.boxes)
        points[rows, :-1] = block.boxes.points
        radii[rows] = block.boxes.radii
        for j, root in block.exact.items():
            block_letters[j] = [_VALUES[letter] for letter in root.assignment]
            exact[index * count + j] = box = root.box
            points[index * count + j, :-1] = [x / (1 << box.bits) for x in box.real]
            radii[index * count + j] = (box.radius / (1 << box.bits)) * _UP
            radii[index * count + j] += _U * float(np.abs(points[index * count + j]).max())
        letters[rows, folds] = block_letters
        signs[rows, vertices] = sign_vectors(index * count, count, branch_blocks.size)
    directions, errors = _directions(problem, points, radii)

    def sharp(rows: Sequence[int]) -> tuple[FloatArray, FloatArray]:
        wide = [exact.get(row) or boxes[row // count].box(row % count) for row in rows]
        return _sharp_directions(problem, _sharpened(problem, wide), letters[rows])

    return Lines(pattern, PROVED, signs, letters, directions, errors, 1 << pattern.Vi, sharp)


def _sharpened(problem: Problem, boxes: Sequence[IsolatingBox]) -> list[IsolatingBox]:
    """Boxes of `_BITS` bits for the same zeros, inside the given ones; else the given ones."""
    from exactfold.solve.certify.exact_krawczyk import krawczyk  # here: only this needs FLINT

    centres = [[Fraction(x, 1 << box.bits) for x in box.real] for box in boxes]
    sharpened = krawczyk(problem.chart.system, centres, precisions=(_BITS,), reach=None)
    return [
        sharp if isinstance(sharp, IsolatingBox) and sharp.is_inside(box) else box
        for sharp, box in zip(sharpened, boxes, strict=True)
    ]


@dataclass(frozen=True)
class _Bend:
    """The bend of a fold at (x, 1): the integer row times (x, 1), times `length` / `below`."""

    row: tuple[int, ...]
    below: int
    length: float


def _bends(problem: Problem) -> list[_Bend]:
    """The bends of all folds of the pattern at points of the chart."""
    pattern, rows = problem.pattern, problem.height_rows(problem.chart)
    flat, unit = over_common_denominator(x for row in rows.values() for x in row)
    size = len(flat) // len(rows)
    heights = {v: flat[k * size : (k + 1) * size] for k, v in enumerate(rows)}
    bends = []
    for fold in pattern.folds:
        weights = fold_functional(pattern, fold)
        left, right = pattern.opposite(fold)
        row = (sum(w * heights[v][k] for v, w in weights.items()) for k in range(size))
        below = weights[left] * weights[right] * unit
        bends.append(_Bend(tuple(row), below, _length(pattern, fold)))
    return bends


def _sharp_directions(
    problem: Problem, boxes: Sequence[IsolatingBox], letters: SignArray
) -> tuple[FloatArray, FloatArray]:
    """Unit vectors of the fold angles in boxes, and error bounds.

    Values at the centres are integers, rounded once; a fold that is proved flat has the value 0.
    The length has an error of 2 u. After the product, a bend has an error of at most 4 u of its
    size, plus the part of the box.
    """
    folds = _bends(problem)
    slopes = [sum(map(abs, fold.row[:-1])) for fold in folds]
    bends, errors = np.zeros(letters.shape), np.zeros(len(boxes))
    for j, (box, row) in enumerate(zip(boxes, letters.tolist(), strict=True)):
        point = (*box.real, 1 << box.bits)
        for k, (fold, slope, letter) in enumerate(zip(folds, slopes, row, strict=True)):
            if letter:
                below = fold.below << box.bits
                bends[j, k] = sum(map(mul, fold.row, point)) / below * fold.length
                errors[j] += abs(box.radius * slope / below) * fold.length * _UP
                errors[j] += 4 * _U * abs(bends[j, k])
    return _units(bends, errors * _UP)


def _directions(
    problem: Problem, points: FloatArray, radii: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Unit vectors of the fold angles at points (x, 1) with boxes of these radii, and error bounds.

    A bend is a row of rationals times the length of the fold. Let B hold the nearest doubles, all
    with errors of at most 4 u, let z = (x, 1) have n + 1 terms, and let gamma be as in
    `float_krawczyk`. Then the error of fl(B z) is at most r sum_k |B_k| + c |B| |z| for
    c = 3 (n + 5) u. A vector within e of a vector of length l has a direction within 2 e / (l - e)
    of its direction, to which rounding adds less than (F + 4) u.
    """
    rows = [[x / fold.below * fold.length for x in fold.row] for fold in _bends(problem)]
    matrix, size = np.array(rows), points.shape[1]
    absolute = np.abs(matrix)
    bends = points @ matrix.T
    off = radii[:, None] * absolute[:, :-1].sum(axis=1)
    off += 3.0 * (size + 4) * _U * (np.abs(points) @ absolute.T)
    return _units(bends, np.sqrt((off**2).sum(axis=1)) * _UP)


def _units(bends: FloatArray, errors: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The vectors scaled to length 1, and their error bounds after scaling."""
    lengths = np.sqrt((bends**2).sum(axis=1))
    with np.errstate(all="ignore"):
        spread = np.where(
            lengths > 2.0 * errors, 2.0 * errors / (lengths * (1.0 - 2.0**-30) - errors), 2.0
        )
    return bends / lengths[:, None], spread * _UP + (bends.shape[1] + 4) * _U


def _length(pattern: CreasePattern, fold: tuple[int, int]) -> float:
    """The length of a fold in integer coordinates, correctly rounded up to two units."""
    points, _ = pattern.integer_vertices
    (ax, ay), (bx, by) = points[fold[0]], points[fold[1]]
    return float(np.sqrt(float((bx - ax) ** 2 + (by - ay) ** 2)))


def _one_by_one(result: BranchCount) -> Lines:
    """The branches of a count; its roots may be multiple."""
    pattern = result.pattern
    proved = result.status is PROVED and bool(result.branches)
    branches = list(result.branches) if proved else []
    directions, errors = _measured(pattern, branches)
    return Lines(
        pattern,
        result.status,
        np.array(
            [[b.vertex_signs[v] for v in pattern.interior] for b in branches], dtype=np.int8
        ).reshape(len(branches), pattern.Vi),
        np.array(
            [[_VALUES[b.assignment[f]] for f in pattern.folds] for b in branches], dtype=np.int8
        ).reshape(len(branches), len(pattern.folds)),
        directions,
        errors,
        result.with_multiplicity if result.status is PROVED else None,
        None,
    )


def _measured(pattern: CreasePattern, branches: Sequence[Branch]) -> tuple[FloatArray, FloatArray]:
    """Unit vectors of the fold angles of branches, from sharp bounds, and error bounds."""
    bends = np.empty((len(branches), len(pattern.folds)))
    errors = np.zeros(len(branches))
    for k, branch in enumerate(branches):
        angles = branch.sharpened(_BITS).fold_angles
        bends[k] = [float(angles.bends[fold]) for fold in pattern.folds]
        for fold, bend in zip(pattern.folds, bends[k].tolist(), strict=True):
            low, high = angles.densities[fold]
            middle = (low + high) / 2
            if middle:
                errors[k] += float((high - low) / 2) * abs(bend / float(middle)) * _UP
            elif high > low:  # the middle gives no bound of the bend
                errors[k] = np.inf
            errors[k] += 4 * _U * abs(bend)
    return _units(bends, errors)
