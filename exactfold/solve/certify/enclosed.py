"""Proves an enclosure of the branch with given signs, from proposed heights of a sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosed_flat import deduced, rational
from exactfold.solve.certify.enclosure import Enclosure, enclose
from exactfold.solve.certify.merged import Merged, merged
from exactfold.solve.certify.refinement import Heights, exact, refine
from exactfold.solve.numeric.sparse_sheet import FloatSheet

_LEVELS = (160, 320, 640)
"""Heights have excess curvatures 2^-level; levels are tried in turn until all folds are decided."""


def enclosed(
    sheet: VertexEquations,
    floats: FloatSheet,
    signs: FloatArray,
    x: FloatArray,
    progress: Progress | None = None,
) -> tuple[Enclosure | None, tuple[int, ...]]:
    """The enclosure of the branch with exactly these signs near the heights `x` (`enclose`).

    `signs` are the signs of the unknowns of the sheet, 1.0 or -1.0. Exact arithmetic refines the
    heights until all folds are decided, or as far as it gets. If the test fails, the result is None
    and, as far as they are known, the vertices where it fails. That says nothing against the
    branch.
    """
    return _enclosed(sheet, floats, signs, exact(sheet, floats, x), progress)


def _enclosed(
    sheet: VertexEquations,
    floats: FloatSheet,
    signs: FloatArray,
    heights: Heights,
    progress: Progress | None,
    fewer: bool = True,
) -> tuple[Enclosure | None, tuple[int, ...]]:
    """`enclosed` from integer heights; `fewer` says whether faces may be merged."""
    wanted = dict(zip(sheet.unknowns, signs.astype(int).tolist(), strict=True))
    best, failed, tried = None, tuple[int, ...](), None
    for k, level in enumerate(_LEVELS):
        if progress is not None:
            progress("proof", k, len(_LEVELS))
        refined = refine(sheet, floats, signs, heights, level)
        if refined is None:
            break
        heights = refined
        outcome = _tested(sheet, heights)
        if isinstance(outcome, tuple) or outcome.signs != wanted:
            failed = outcome if isinstance(outcome, tuple) else ()
            break
        best = deduced(sheet, outcome)
        if best.complete:
            break
        part = merged(sheet, best) if fewer else None
        if part is not None and part.faces != tried:
            tried = part.faces
            lifted = _lifted(part, wanted, heights)
            if lifted is not None:
                return lifted, ()
    if best is not None and not best.complete:
        best = rational(sheet, best, wanted) or best
    if best is None and not failed:
        rough = _tested(sheet, heights)
        failed = rough if isinstance(rough, tuple) else ()
    return best, failed


def _tested(sheet: VertexEquations, heights: Heights) -> Enclosure | tuple[int, ...]:
    return enclose(
        sheet, heights.values, heights.denominator, heights.bits, known=heights.curvature
    )


def _lifted(part: Merged, wanted: Mapping[int, int], heights: Heights) -> Enclosure | None:
    """The enclosure of the branch with all folds decided, from the sheet with merged faces.

    The heights are tried as they are first, as they nearly are heights of that sheet.
    """
    sheet = part.sheet
    start = replace(heights, values=heights.values[list(part.labels)], curvature=None)
    as_they_are = _tested(sheet, start)
    if isinstance(as_they_are, Enclosure):
        lifted = part.lifted(deduced(sheet, as_they_are), wanted)
        if lifted is not None and lifted.complete:
            return lifted
    signs = np.array([float(wanted[part.labels[v]]) for v in sheet.unknowns])
    proof, _ = _enclosed(sheet, FloatSheet.of(sheet), signs, start, None, fewer=False)
    lifted = None if proof is None else part.lifted(proof, wanted)
    return lifted if lifted is not None and lifted.complete else None
