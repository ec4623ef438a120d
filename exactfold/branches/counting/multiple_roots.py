"""Multiple roots: the zeros of a chart with flat vertices, by the way in which each is proved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.classify import Undecided
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, FlatBoxRoot, Root
from exactfold.exact.univariate import Interval
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import flat_sheets
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.flat_zeros import lift, zeros_flat_at
from exactfold.solve.certify.algebraic import FlatBox
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.certify.recognition import recognise
from exactfold.solve.numeric.candidates import Candidates

_MOST_TOGETHER = 64  # conjugate zeros in one class, for the sake of the checker

_FINE = 80
"""Bits to which zeros of classes are told apart by the boxes that hold them."""

GROEBNER_LIMIT = 5
"""Largest number of unknowns left on flat sheets for which a Groebner basis is computed."""


@dataclass
class Zeros:
    """Zeros by the way in which they are proved."""

    classes: list[RootClass] = field(default_factory=list)
    boxes: list[IsolatingBox] = field(default_factory=list)
    flat_boxes: list[FlatBox] = field(default_factory=list)

    @property
    def total(self) -> int:
        """Their number with multiplicity."""
        flat = sum(1 << len(sheets.vertices) for sheets, _ in self.flat_boxes)
        return sum(c.degree * c.multiplicity for c in self.classes) + len(self.boxes) + flat


def solve_flat(chart: Chart, vertices: frozenset[int], points: FloatArray, found: Zeros) -> None:
    """Add the zeros with these flat vertices; `points` are near them, shape (m, n).

    Exactly if few unknowns are left on the flat sheets, else in boxes if the system is square.
    """
    sheets = flat_sheets(chart, vertices)
    if sheets is None:
        return
    if len(sheets.free) <= GROEBNER_LIMIT:
        found.classes += zeros_flat_at(sheets)
    elif sheets.system is not None:
        inner = points[:, list(sheets.free)].astype(np.complex128)
        isolation = isolate(sheets.system, Candidates("flat sheets", inner))
        found.flat_boxes += [(sheets, box) for box in isolation.boxes if box.is_real]


def recognised(chart: Chart, found: Zeros, undecided: Sequence[Undecided]) -> Zeros | None:
    """The same zeros, those in boxes on which some folds seem flat as exact classes.

    All zeros on which the same folds are flat are the zeros of a rational system, so they are
    recognised together. None if none was.
    """
    groups: dict[tuple[object, ...], list[BoxRoot | FlatBoxRoot]] = {}
    for item in undecided:
        if isinstance(item.root, BoxRoot | FlatBoxRoot):
            flat = item.root.sheets.vertices if isinstance(item.root, FlatBoxRoot) else None
            groups.setdefault((flat, *item.what), []).append(item.root)
    result = Zeros(list(found.classes), list(found.boxes), list(found.flat_boxes))
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
    return result if len(result.classes) > len(found.classes) else None


def with_exact_roots(
    branches: Sequence[Branch], classes: Sequence[RootClass]
) -> tuple[Branch, ...]:
    """The same branches, whose boxes hold all zeros, told which zero of the classes each holds.

    A zero of a class whose bounds meet one box only is the zero in that box.
    """
    found = list(branches)
    for root_class in classes:
        for index, point in enumerate(root_class.real_points(_FINE)):
            near = [k for k, branch in enumerate(branches) if _meets(branch.root, point)]
            if len(near) == 1:
                root = branches[near[0]].root
                if isinstance(root, BoxRoot):
                    known = AlgebraicRoot(root_class, index)
                    found[near[0]] = replace(branches[near[0]], root=replace(root, known=known))
    return tuple(found)


def _meets(root: Root | None, point: Sequence[Interval]) -> bool:
    """Whether a box of bounds meets the box of a root."""
    return isinstance(root, BoxRoot) and all(
        low <= bounds[1] and bounds[0] <= high
        for (low, high), bounds in zip(
            point, (root.box.interval(k) for k in range(len(point))), strict=True
        )
    )


def are_told_apart(branches: Sequence[Branch]) -> bool:
    """Whether no two branches proved in different ways have the same, or mirrored, signs.

    Only the folds that are decided on all branches are looked at.
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
