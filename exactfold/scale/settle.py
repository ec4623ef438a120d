"""Roots that the float test leaves open, one by one, in exact arithmetic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from exactfold.branches.flat_folds import flat_folds
from exactfold.branches.functionals import Functionals
from exactfold.branches.roots import BoxRoot
from exactfold.certify.box import IsolatingBox
from exactfold.certify.krawczyk import krawczyk, krawczyk_at
from exactfold.solve.nappe_refinement import refined_end
from exactfold.solve.nappes import NappeSystem

_FIRST = (64, 128)
_RISING = (128, 256, 512, 1024)
_SHARPER = (256, 1024)
_FAR = 1e100
_LETTERS = {1: "V", -1: "M", 0: "F"}


@dataclass(frozen=True)
class ExactRoot:
    """An isolating box of a zero with the signs asked for, and the letters of its folds."""

    box: IsolatingBox
    assignment: str


def settle(
    system: NappeSystem,
    functionals: Functionals,
    signs: Sequence[int],
    point: npt.NDArray[np.float64],
    labels: Sequence[int],
    flat_before: set[tuple[int, ...]],
) -> ExactRoot | str:
    """The zero with these vertex signs, proved, or why it was not (naming vertices by `labels`).

    The exact test of `krawczyk` at `point`; if it fails, or finds a zero with other signs, at the
    end of the nappe equations in rising precision, which is that with the signs asked for. Sets of
    vertices that look flat in the highest precision are remembered in `flat_before`; ends with the
    same flat vertices then stop at the lowest.
    """
    chart = functionals.chart
    if np.isfinite(point).all() and np.abs(point).max(initial=0.0) < _FAR:
        (found,) = krawczyk(chart.system, point[None], precisions=_FIRST)
        if isinstance(found, IsolatingBox):
            root = _classified(functionals, signs, found, labels)
            if isinstance(root, ExactRoot):
                return root
    reason = "no end was reached in higher precision"
    for bits in _RISING:
        end = refined_end(system, signs, bits)
        if end is None:
            continue
        wide = IsolatingBox(end.point, (), 1 << (bits // 2), bits)
        box = krawczyk_at(chart.system, wide, bits)
        if isinstance(box, IsolatingBox):
            root = _classified(functionals, signs, box, labels)
            if isinstance(root, ExactRoot):
                return root
            reason = root
        elif end.flat:
            names = ", ".join(str(labels[v]) for v in end.flat)
            many = 1 << len(end.flat)
            reason = (
                f"vertex {names} flat to {bits // 2} bits: {many} paths seem to meet in a "
                "multiple root"
            )
            if end.flat in flat_before:
                break
            if bits == _RISING[-1]:
                flat_before.add(end.flat)
        else:
            reason = box
    return reason


def _classified(
    functionals: Functionals, signs: Sequence[int], box: IsolatingBox, labels: Sequence[int]
) -> ExactRoot | str:
    """The box with its folds if they are decided and its vertex signs are those asked for."""
    chart = functionals.chart
    vertices = functionals.vertices
    root = BoxRoot(box)
    found = [root.sign(row) for row in vertices.values()]
    folds = {fold: root.sign(row) for fold, row in functionals.folds.items()}
    for bits in _SHARPER:
        if None not in found and None not in folds.values():
            break
        sharper = krawczyk_at(chart.system, root.box, bits)
        if not isinstance(sharper, IsolatingBox):
            break
        root = BoxRoot(sharper)
        found = [root.sign(row) for row in vertices.values()]
        folds = {fold: root.sign(row) for fold, row in functionals.folds.items()}
    for vertex, sign, wanted in zip(vertices, found, signs, strict=True):
        if sign != wanted:
            state = "undecided" if sign is None else "another"
            return f"the sign of vertex {labels[vertex]} is {state}"
    for fold in flat_folds(chart.branch_system.pattern, folds) if None in folds.values() else ():
        folds[fold] = 0
    still_open = [f"{labels[i]}-{labels[j]}" for (i, j), sign in folds.items() if sign is None]
    if still_open:
        return f"fold {', '.join(still_open)} undecided"
    letters = "".join(_LETTERS[sign] for _, sign in sorted(folds.items()) if sign is not None)
    return ExactRoot(root.box, letters)
