"""The page of a periodic sheet: a patch of cells that rolls up across one direction."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import Final

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.plurals import counted as in_words
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.viewer.document import FRAMES, ViewDocument, sheet_json
from exactfold.app.viewer.folded import NOT_ASKED
from exactfold.app.viewer.page import view_page
from exactfold.app.viewer.ways import Way, in_floats, not_followed
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.result import PeriodicCount
from exactfold.errors import ExactfoldError, UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.motion.periodic.patch import CELLS, Patch
from exactfold.motion.periodic.rolling import rolled
from exactfold.pattern.opening import Opened
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.pattern.writing.fold_writing import write_text

MOST: Final = 32
"""The most ways on one page."""


def rolling_document(
    cell: object,
    direction: Sequence[RationalLike],
    *,
    name: str = "cell",
    ways: Sequence[int] | None = None,
    cells: tuple[int, int] = CELLS,
    frames: int = FRAMES,
    proving: bool = False,
    limit: float | Clock = LIMIT,
    progress: Progress | None = None,
) -> ViewDocument:
    """What the page shows of a periodic sheet: n x m cells, and all ways to roll up across n.

    `ways` chooses ways by their numbers in `count_periodic`; without it, the first 32 are shown. A
    way that is not followed before the time limit says so. The motions are in floating point
    (`roll`), and proved with `proving`. Raises the errors of `count_periodic`, and `UsageError` for
    a way that is not listed.

    >>> document = rolling_document("waterbomb-cell", (1, 2), ways=[2], cells=(2, 2), frames=3)
    >>> [(way["name"], way["motion"]["end"]) for way in document["ways"]]
    [('way 2: +-+', 'flat-fold')]
    """
    clock = limit if isinstance(limit, Clock) else Clock(limit)
    pattern = as_cell(cell)
    counted = count_periodic(pattern, direction, limit=clock.left, progress=progress)
    patch = Patch.of(pattern, cells)
    wanted = range(1, min(len(counted), MOST) + 1) if ways is None else ways
    if wanted and not 1 <= min(wanted) <= max(wanted) <= len(counted):
        raise UsageError(f"`count` lists {in_words(len(counted), 'way')} in this direction")
    shown = []
    for done, way in enumerate(wanted):
        if progress is not None:
            progress("following", done, len(wanted))
        shown.append(_way(counted, way, patch, cells, frames, proving, clock))
    x, y = counted.direction
    all_ways = f"{in_words(len(counted), 'way')} to start folding in the direction {x},{y}"
    more = counted.pleats or counted.families
    return {
        "format": "exactfold view result",
        "version": 2,
        "name": name,
        "sheet": {**sheet_json(Opened(patch.pattern)), "foldable": [], "marks": []},
        "read": [
            f"{cells[0]} x {cells[1]} cells of a periodic sheet are shown",
            "all cells fold equally: two commuting screw motions leave the sheet invariant",
        ],
        "kind": "panels",
        "answer": f"{all_ways} - {str(counted.status).upper()}",
        "status": "proved" if counted.status is PROVED else "undecided",
        "complete": len(shown) == len(counted) and not more,
        "reason": counted.reason
        if len(shown) == len(counted)
        else f"{len(shown)} of {in_words(len(counted), 'way')} are shown",
        "freedom": "",
        "notes": ["Pleats, and families, are not shown."] if more else [],
        "ways": shown,
        "drawn": None,
        "folded": NOT_ASKED,
        "served": False,
    }


def write_rolling_view(
    cell: object,
    direction: Sequence[RationalLike],
    path: str | PathLike[str],
    *,
    name: str = "cell",
    ways: Sequence[int] | None = None,
    cells: tuple[int, int] = CELLS,
    frames: int = FRAMES,
    proving: bool = False,
    limit: float | Clock = LIMIT,
    progress: Progress | None = None,
) -> ViewDocument:
    """Write the page of a periodic sheet to a file, and return the document that it shows.

    See `rolling_document`. Raises its errors, and `UnwritableFileError`.
    """
    document = rolling_document(
        cell,
        direction,
        name=name,
        ways=ways,
        cells=cells,
        frames=frames,
        proving=proving,
        limit=limit,
        progress=progress,
    )
    write_text(Path(path), view_page(document))
    return document


def _way(
    counted: PeriodicCount,
    way: int,
    patch: Patch,
    cells: tuple[int, int],
    frames: int,
    proving: bool,
    clock: Clock,
) -> Way:
    """A way with its motion, or the reason why there is none."""
    branch = counted[way - 1]
    letters = patch.letters(counted.pattern, branch.letters)
    side = "towards you" if branch.b > 0 else "away from you"
    plain: Way = {
        "name": f"way {way}: {branch.vertex_signs}",
        "number": way,
        "signs": "",
        "letters": "".join(letters[fold] for fold in patch.pattern.folds),
        "saddle": 0,
        "multiplicity": None,
        "status": str(PROVED if counted.status is PROVED else UNDECIDED),
        "reason": f"it rolls up {side}, with the vertex signs {branch.vertex_signs} in each cell",
        "angles": [],
        "motion": None,
        "why": "",
        "family": None,
    }
    if clock.passed:
        said = f"{clock.said}; `exactfold view` with --way {way} follows it alone"
        return {**plain, **not_followed(said)}
    try:
        motion = rolled(counted, way, patch, cells=cells, frames=frames, proving=proving)
    except ExactfoldError as error:
        return {**plain, **not_followed(str(error))}
    drawn = in_floats(motion)
    if motion.tubes is not None:
        drawn = {**drawn, "proved": True, "exists": True, "said": motion.reason}
    return {**plain, "motion": drawn}
