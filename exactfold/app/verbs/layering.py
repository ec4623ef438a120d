"""`flat`: the flat-folded states of a sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from exactfold._support.clock import LIMIT
from exactfold._support.progress import Progress
from exactfold.layers.folding import fold_flat
from exactfold.layers.orders import LISTED
from exactfold.pattern.loading import PatternLike

if TYPE_CHECKING:
    from exactfold.app.verbs.chosen import Letters
    from exactfold.layers.states import FlatStates


def flat(
    sheet: PatternLike,
    letters: Letters | None = None,
    *,
    most: int = LISTED,
    limit: float | None = LIMIT,
    progress: Progress | None = None,
) -> FlatStates:
    """Find all flat-folded states of a sheet, or prove that there is none.

    `sheet` is anything that `read` takes. `letters` has M, V, F (not folded) or U (folded, either
    way) for each fold, as text in the order of the folds or by fold (i, j), i < j. None takes the
    letters of the file if it has some, "drawn" insists on them, and "any" folds every crease either
    way that is not F in the file. The result counts all states and lists the first `most` of each
    component, or says why there is none (docs/flat.md). After `limit` seconds the search ends, and
    the result has what is known.

    Raises `UsageError` for letters that do not fit, and `InputError` for anything that is not a
    sheet.

    >>> import exactfold
    >>> exactfold.flat("map-fold").count, exactfold.flat("map-fold", "any").count
    (1, 320)
    >>> exactfold.flat("zigzags").status
    <Verdict.REFUTED: 'refuted'>
    """
    return fold_flat(sheet, letters, most=most, limit=limit, progress=progress)
