"""Multiple roots: zeros at which vertices are flat, sorted by the way in which each is proved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import Undecided
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, FlatBoxRoot, Root
from exactfold.errors import SolverError
from exactfold.exact.univariate import Interval
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets, flat_sheets
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.flat_zeros import flat_equations, lift, zeros_flat_at
from exactfold.solve.certify.algebraic import FlatBox
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.certify.recognition import recognise
from exactfold.solve.numeric.candidates import Candidates

_MOST_TOGETHER = 64  # most conjugate zeros in one class: more would cost the checker too much

_FINE = 80
"""Bits to which zeros of classes are enclosed when they are matched with boxes."""

GROEBNER_LIMIT = 5
"""A Groebner basis is computed if flat sheets leave at most this many unknowns."""


@dataclass
class Zeros:
    """Zeros, sorted by the way in which they are proved."""

    classes: list[RootClass] = field(default_factory=list)
    boxes: list[IsolatingBox] = field(default_factory=list)
    flat_boxes: list[FlatBox] = field(default_factory=list)

    @property
    def total(self) -> int:
        """The number of these zeros with multiplicity."""
        flat = sum(1 << len(sheets.vertices) for sheets, _ in self.flat_boxes)
        return sum(c.degree * c.multiplicity for c in self.classes) + len(self.boxes) + flat


def solve_flat(chart: Chart, vertices: frozenset[int], points: FloatArray, zeros: Zeros) -> None:
    """Add to `zeros` the zeros at which these vertices are flat.

    They are solved for exactly if the flat sheets leave few unknowns, else isolated in boxes if the
    system is square. `points`, of shape (m, n), are candidates near the zeros.
    """
    sheets = flat_sheets(chart, vertices)
    if sheets is None:
        return
    if len(sheets.free) <= GROEBNER_LIMIT:
        zeros.classes += zeros_flat_at(sheets)
    elif sheets.system is not None:
        inner = points[:, list(sheets.free)].astype(np.complex128)
        isolation = isolate(sheets.system, Candidates("flat sheets", inner))
        zeros.flat_boxes += [(sheets, box) for box in isolation.boxes if box.is_real]
    elif sheets.squared is not None:
        inner = points[:, list(sheets.free)].astype(np.complex128)
        isolation = isolate(sheets.squared, Candidates("flat sheets", inner))
        boxes = [box for box in isolation.boxes if box.is_real]
        if 0 < len(boxes) <= _MOST_TOGETHER:
            zeros.classes += _flat_classes(sheets, boxes)


def _flat_classes(sheets: FlatSheets, boxes: Sequence[IsolatingBox]) -> list[RootClass]:
    """The exact zeros in boxes on flat sheets with more conditions than unknowns.

    The boxes hold zeros of as many combinations of the conditions. The classes that satisfy all
    conditions are kept; they are verified by substitution.
    """
    system = sheets.squared
    classes = None if system is None else recognise(system, boxes)
    kept: list[RootClass] = []
    for inner in classes or ():
        lifted = lift(sheets, inner)
        try:
            lifted.verify(sheets.chart.system)
        except SolverError:
            continue
        if frozenset(flat_equations(sheets.chart, lifted)) == sheets.vertices:
            kept.append(lifted)
    return kept


def recognised(chart: Chart, zeros: Zeros, undecided: Sequence[Undecided]) -> Zeros | None:
    """The same zeros, but zeros in boxes at which folds seem flat are replaced by exact classes.

    The zeros at which the same folds are flat are all zeros of one rational system, so they are
    recognised together. None if no zero was recognised.
    """
    groups: dict[tuple[object, ...], list[BoxRoot | FlatBoxRoot]] = {}
    for item in undecided:
        if isinstance(item.root, BoxRoot | FlatBoxRoot):
            flat = item.root.sheets.vertices if isinstance(item.root, FlatBoxRoot) else None
            groups.setdefault((flat, *item.what), []).append(item.root)
    result = Zeros(list(zeros.classes), list(zeros.boxes), list(zeros.flat_boxes))
    for group in groups.values():
        if len(group) > _MOST_TOGETHER:
            continue
        boxes = [root.box for root in group]
        first = group[0]
        if isinstance(first, BoxRoot):
            classes = recognise(chart.system, boxes)
            if classes is not None:
                result.classes += classes
                result.boxes = [b for b in result.boxes if all(map(b.is_disjoint_from, boxes))]
        elif first.sheets.system is not None:
            classes = recognise(first.sheets.system, boxes)
            if classes is not None:
                result.classes += [lift(first.sheets, c) for c in classes]
                result.flat_boxes = [
                    (s, b)
                    for s, b in result.flat_boxes
                    if s is not first.sheets or all(map(b.is_disjoint_from, boxes))
                ]
    return result if len(result.classes) > len(zeros.classes) else None


def with_exact_roots(
    branches: Sequence[Branch], classes: Sequence[RootClass]
) -> tuple[Branch, ...]:
    """The same branches, each with the exact zero that its box holds, if that is known.

    The boxes of the branches hold all zeros. If the bounds of a zero of a class meet only one box,
    it is the zero in that box.
    """
    exact = list(branches)
    for root_class in classes:
        for index, point in enumerate(root_class.real_points(_FINE)):
            near = [k for k, branch in enumerate(branches) if _meets(branch.root, point)]
            if len(near) == 1:
                root = branches[near[0]].root
                if isinstance(root, BoxRoot):
                    known = AlgebraicRoot(root_class, index)
                    exact[near[0]] = replace(branches[near[0]], root=replace(root, known=known))
    return tuple(exact)


def _meets(root: Root | None, point: Sequence[Interval]) -> bool:
    """Whether the bounds of a point meet the box of a root."""
    return isinstance(root, BoxRoot) and all(
        low <= bounds[1] and bounds[0] <= high
        for (low, high), bounds in zip(
            point, (root.box.interval(k) for k in range(len(point))), strict=True
        )
    )


def are_told_apart(branches: Sequence[Branch]) -> bool:
    """Whether branches that were proved in different ways always differ in their signs.

    Opposite signs count as the same. Only folds that are decided on all branches are compared.
    """
    kinds: dict[tuple[str, str], object] = {}
    texts = [branch.assignment_text for branch in branches]
    decided = [k for k, letters in enumerate(zip(*texts, strict=True)) if "U" not in letters]
    for branch, text in zip(branches, texts, strict=True):
        root = branch.root
        kind = root.sheets.vertices if isinstance(root, FlatBoxRoot) else type(root)
        seen = (branch.sign_text, "".join(text[k] for k in decided))
        mirrored = (seen[0].translate(UPSIDE_DOWN), seen[1].translate(UPSIDE_DOWN))
        for letters in (seen, mirrored):
            if kinds.setdefault(letters, kind) != kind:
                return False
    return True
