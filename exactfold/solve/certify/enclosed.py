"""Proves an enclosure of the branch with given signs, from proposed heights of a sheet."""

from __future__ import annotations

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosed_flat import deduced, rational
from exactfold.solve.certify.enclosure import Enclosure, enclose
from exactfold.solve.certify.refinement import exact, refine
from exactfold.solve.numeric.sparse_sheet import FloatSheet

_LEVELS = (80, 160, 320)
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
    wanted = dict(zip(sheet.unknowns, signs.astype(int).tolist(), strict=True))
    heights = exact(sheet, floats, x)
    best, failed = None, tuple[int, ...]()
    for k, level in enumerate(_LEVELS):
        if progress is not None:
            progress("proof", k, len(_LEVELS))
        refined = refine(sheet, floats, signs, heights, level)
        if refined is None:
            break
        heights = refined
        outcome = enclose(sheet, heights.values, heights.denominator, heights.bits)
        if isinstance(outcome, tuple) or outcome.signs != wanted:
            failed = outcome if isinstance(outcome, tuple) else ()
            break
        best = deduced(sheet, outcome)
        if best.complete:
            break
    if best is not None and not best.complete:
        best = rational(sheet, best, wanted) or best
    if best is None and not failed:
        rough = enclose(sheet, heights.values, heights.denominator, heights.bits)
        failed = rough if isinstance(rough, tuple) else ()
    return best, failed
