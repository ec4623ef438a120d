"""`BranchBlocks` solves, proves and classifies branches, a block of sign vectors at a time.

    problem = Problem.of(pattern)         # reduced sheet, labels, gauge, chart
    ends    = branch_blocks.ends(block)   # candidates, in floats
    roots   = branch_blocks.prove(block)  # proved roots with letters, and reasons for open ones

Zeros with different vertex signs are different zeros in the chart of `Problem`. So if each of the
2^n sign vectors has a proved zero with these signs, then these are all zeros (docs/mathematics.md,
Completeness and Nappes).
"""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold.branches.counting.exact_roots import ExactProver
from exactfold.branches.values.blocks import ExactRoot, OpenEnd, ProvedBlock
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import BranchMaker
from exactfold.branches.values.roots import BoxRoot
from exactfold.checker.core.limits import MOST_UNKNOWNS
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.rounding import half_step
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.float_krawczyk import UNPROVED, FloatBoxes, FloatKrawczyk, FloatSigns
from exactfold.solve.numeric.dense_newton import NappeSystem, SweptPoints
from exactfold.solve.numeric.nappe_newton import sign_vectors

if TYPE_CHECKING:
    from exactfold.branches.values.nearly_flat import Bends

BLOCK = 1024
"""Sign vectors in a block. An interruption loses at most one block."""

BITS = 44
"""Bits of the centres: enough for every test and for nine digits of a height, yet few bytes."""

_WIDEST = 52
_UNCLEAR = 1e-12
"""Floats cannot tell that a fold with a smaller share of the largest angle is not flat."""


@dataclass(frozen=True)
class BranchBlocks:
    """All 2^n branches of a problem with four boundary vertices, in blocks of `block_size`."""

    problem: Problem
    block_size: int
    _solved: dict[int, tuple[SweptPoints, float]] = field(
        default_factory=dict, repr=False, compare=False
    )

    @classmethod
    def of(cls, pattern: CreasePattern | Problem, block_size: int | None = None) -> BranchBlocks:
        """The branches of a pattern in blocks; `block_size` is a power of two, 1024 by default.

        Raises `NotApplicableError` unless D = 1 and some vertex is foldable, 40 at most.

        >>> from exactfold.pattern.triangulating.random_squares import random_square
        >>> branch_blocks = BranchBlocks.of(random_square(3, seed=0))
        >>> block = branch_blocks.prove(0)
        >>> bool(block.boxes.proved.all()), len(block.open)
        (True, 0)
        >>> [branch.sign_text for branch in branch_blocks.branches(block)][:3]
        ['+++', '-++', '+-+']
        """
        problem = pattern if isinstance(pattern, Problem) else Problem.of(pattern)
        problem.require_foldable()
        if problem.triangles is None:
            raise NotApplicableError("no definite stress was found for a triangulated triangle")
        if problem.size > MOST_UNKNOWNS:
            raise NotApplicableError(f"2^{problem.size} branches are too many to list")
        return cls(problem, min(block_size or BLOCK, 1 << problem.size))

    @property
    def size(self) -> int:
        """n, the number of foldable vertices."""
        return self.problem.size

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return (1 << self.size) // self.block_size

    @cached_property
    def _nappes(self) -> NappeSystem:
        return NappeSystem(self.problem.chart)

    @cached_property
    def _prover(self) -> ExactProver:
        return ExactProver(self._nappes, self.problem)

    @cached_property
    def _test(self) -> FloatKrawczyk:
        return FloatKrawczyk(self.problem.chart.system)

    @cached_property
    def _vertices(self) -> FloatSigns:
        return FloatSigns(tuple(self.problem.functionals.vertices.values()))

    @cached_property
    def _folds(self) -> FloatSigns:
        return FloatSigns(tuple(self.problem.functionals.folds.values()))

    @cached_property
    def _maker(self) -> BranchMaker:
        return BranchMaker(self.problem, self.problem.chart)

    def ends(self, index: int) -> SweptPoints:
        """Candidates for the sign vectors of block `index`; kept until `prove` uses them."""
        if index not in self._solved:
            start = time.process_time()
            ends = self._nappes.ends_of_block(index * self.block_size, self.block_size)
            self._solved[index] = ends, time.process_time() - start
        return self._solved[index][0]

    def prove(self, index: int) -> ProvedBlock:
        """Solve, prove and classify the sign vectors of block `index`.

        Floats with bounded rounding errors prove most roots; integers decide those left open.
        """
        self.ends(index)
        ends, solving = self._solved.pop(index)
        signs = sign_vectors(index * self.block_size, self.block_size, self.size)
        return self._proved(index, signs, ends, solving)

    def _proved(
        self, index: int, signs: FloatArray, ends: SweptPoints, solving: float
    ) -> ProvedBlock:
        start = time.process_time()
        boxes = self._test.isolate(ends.points, BITS)
        vertices, folds = self._vertices.on(boxes), self._folds.on(boxes)
        good = boxes.proved & (vertices == signs).all(axis=1) & (folds != 0).all(axis=1)
        good &= boxes.exponents <= _WIDEST
        certified = time.process_time()
        exact: dict[int, ExactRoot] = {}
        unproved: dict[int, OpenEnd] = {}
        for j in np.flatnonzero(~good).tolist():
            root = self._prover.prove([int(sign) for sign in signs[j]], ends.points[j])
            if isinstance(root, ExactRoot):
                exact[j] = root
            else:
                unproved[j] = root
        return ProvedBlock(
            index,
            FloatBoxes(
                boxes.bits,
                np.where(good[:, None], boxes.centers, 0),
                np.where(good, boxes.exponents, UNPROVED),
            ),
            (folds > 0) & good[:, None],
            exact,
            unproved,
            ends.steps,
            {
                "solve": solving,
                "certify": certified - start,
                "exactly": time.process_time() - certified,
            },
            self._bends(ends.points, exact, unproved) if self._rounded else None,
        )

    def bends(self, index: int) -> Bends | None:
        """The angles of folds in a block that is proved already; None if coordinates are exact.

        They are those at `ends`, which are close to the branches. Branches on which floats cannot
        tell a fold from a flat one are proved again.
        """
        if not self._rounded:
            return None
        points = self.ends(index).points
        self._solved.pop(index)
        angles = self._angles(points)
        unclear = (angles < _UNCLEAR * angles.max(axis=1, keepdims=True)).any(axis=1)
        signs = sign_vectors(index * self.block_size, self.block_size, self.size).astype(int)
        again = {
            j: self._prover.prove(signs[j].tolist(), points[j])
            for j in np.flatnonzero(unclear).tolist()
        }
        exact = {j: root for j, root in again.items() if isinstance(root, ExactRoot)}
        return self._bends(points, exact, again.keys() - exact.keys())

    @cached_property
    def _rounded(self) -> bool:
        """Whether coordinates are decimals that may be rounded."""
        return half_step(self.problem.pattern.vertices) > 0

    @cached_property
    def _bending(self) -> FloatArray:
        """The angles of the folds of the sheet as rows on (x, 1)."""
        heights = Functionals(self.problem.chart).heights
        rows = np.array([[float(c) for c in row] for _, row in sorted(heights.items())])
        from exactfold.branches.values.nearly_flat import angles_on  # exact sheets do without it

        return angles_on(self.problem.sheet, rows)

    def _angles(self, points: FloatArray) -> FloatArray:
        """The sizes of the first-order angles of all folds, up to a factor for each point."""
        rows = self._bending
        return np.asarray(np.abs(points @ rows[:, :-1].T + rows[:, -1]))

    def _bends(
        self, points: FloatArray, exact: Mapping[int, ExactRoot], left_out: Iterable[int]
    ) -> Bends:
        from exactfold.branches.values.nearly_flat import Bends

        angles = self._angles(points)
        for j, root in exact.items():
            angles[j, [k for k, letter in enumerate(root.assignment) if letter in "FU"]] = 0.0
        angles[list(left_out)] = 0.0
        return Bends.of(self.problem.sheet, angles)

    def _root(self, box: IsolatingBox) -> BoxRoot:
        return BoxRoot(box, system=self.problem.chart.system)

    def branches(self, block: ProvedBlock) -> Iterator[Branch]:
        """The proved branches of a block, in the order of the sign vectors."""
        signs = sign_vectors(block.index * self.block_size, self.block_size, self.size)
        return (branch for branch in self._named(block, signs) if branch is not None)

    def with_signs(self, signs: FloatArray) -> Iterator[Branch | None]:
        """The branch for each row of `signs`, 1 or -1 in the order of the foldable vertices.

        It is None for a row that stays open.

        >>> from exactfold.pattern.triangulating.random_squares import random_square
        >>> branch_blocks = BranchBlocks.of(random_square(3, seed=0))
        >>> list(branch_blocks.with_signs(np.array([[1.0, -1.0, 1.0]])))
        [<Branch +-+: proved, MMMMVVVVMM>]
        """
        for first in range(0, len(signs), BLOCK):
            rows = signs[first : first + BLOCK]
            yield from self._named(self._proved(0, rows, self._nappes.ends(rows), 0.0), rows)

    def _named(self, block: ProvedBlock, rows: FloatArray) -> Iterator[Branch | None]:
        signs, boxes = rows.astype(int).tolist(), block.boxes
        centers, exponents = boxes.centers.tolist(), boxes.exponents.tolist()
        letters = letter_rows(block.valleys)
        for j in range(len(signs)):
            if j in block.exact:
                root = block.exact[j]
                yield self._maker.branch(self._root(root.box), signs[j], root.assignment)
            elif exponents[j] != UNPROVED:
                box = IsolatingBox(tuple(centers[j]), (), 1 << exponents[j], boxes.bits)
                yield self._maker.branch(self._root(box), signs[j], letters[j])
            else:
                yield None


def letter_rows(valleys: BoolArray) -> list[str]:
    """Each row as a text with the letter V for a valley and M for a mountain.

    >>> letter_rows(np.array([[True, False]]))
    ['VM']
    """
    letters = np.where(valleys, ord("V"), ord("M")).astype(np.uint8)
    return [bytes(row).decode("ascii") for row in letters]
