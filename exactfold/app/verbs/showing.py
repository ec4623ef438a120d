"""`draw` and `view`: draw a sheet or its ways, and make the page that shows them in space."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.drawn_ways import DrawnWay, branch_way, mode_way
from exactfold.app.pictures.picture_files import write_picture
from exactfold.app.pictures.stills import motion_stills
from exactfold.app.pictures.way_sheets import sheet_of_ways
from exactfold.app.verbs.choosing import Letters, asked_letters, listed, modes_with, the_branch
from exactfold.app.viewer.document import FRAMES, view_document
from exactfold.app.viewer.page import checked_page, view_page
from exactfold.branches.counting.find import Signs
from exactfold.branches.counting.ways import decompose_opened
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import UsageError
from exactfold.motion.curves.motion import Motion
from exactfold.motion.panels.followable import panel_modes
from exactfold.motion.panels.motion import PanelMotion
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.fold_writing import write_text
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import has_branches

Shown: TypeAlias = "PatternLike | Branch | BranchCount | Decomposition | Motion | PanelMotion"
"""What can be drawn."""


def draw(
    sheet: Shown,
    way: int | None = None,
    *,
    signs: Signs | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    title: str = "",
    path: str | PathLike[str] | None = None,
    progress: Progress | None = None,
) -> str:
    """A picture as SVG text; with `path`, it is also written to a .svg, .png or .pdf file.

    For a sheet, which is anything that `read` takes, the picture shows its crease pattern with the
    mountains and valleys of the file. With `way`, `signs`, `up` or `letters`, as in `follow`, it
    shows that way; `way` also chooses a way of a `BranchCount` or a `Decomposition`. For a `Branch`
    it shows the branch. For a count without `way` it shows all ways that the count lists. For a
    motion it shows the sheet in space, in a row of stills.

    Raises `UsageError` for a way that does not exist or a file with another ending,
    `PackageMissingError` for .png and .pdf without the extra `exactfold[pictures]`, and the errors
    of `read` and `branch`.

    >>> import exactfold
    >>> text = exactfold.draw("two-vertex", signs="+-")
    >>> text.count('class="M"'), text.count('class="V"')
    (3, 4)
    """
    named = [x for x in (way, signs, up, letters) if x is not None]
    if isinstance(sheet, Branch | Motion | PanelMotion) and named:
        raise UsageError("way, signs, up and letters choose a way of a sheet: leave them out here")
    if isinstance(sheet, Branch):
        text = branch_way(sheet).picture(title)
    elif isinstance(sheet, Motion | PanelMotion):
        text = motion_stills(sheet, title=title)
    elif named:
        text = _way(sheet, way, signs, up, letters, progress).picture(title)
    elif isinstance(sheet, BranchCount | Decomposition):
        text = sheet_of_ways(sheet, title)
    elif isinstance(sheet, Drawing):
        text = pattern_picture(sheet, title=title)
    else:
        opened = open_sheet(sheet)
        text = pattern_picture(opened.sheet, opened.assignment, title=title)
    if path is not None:
        write_picture(text, path)
    return text


def view(
    sheet: PatternLike,
    *,
    signs: Sequence[str] | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    name: str | None = None,
    path: str | PathLike[str] | None = None,
    workers: int = 1,
    progress: Progress | None = None,
) -> str:
    """The page that shows how a sheet folds, as HTML text; with `path`, also written to a file.

    The page opens in a browser without a network. `sheet` is anything that `read` takes. For a
    large sheet, `signs` names the branches that the page shows. Each way is followed in `frames`
    frames to its first contact; with `proving`, its motion is also proved. `workers` processes
    share the work.

    Raises `UsageError` for signs that do not fit the sheet or a file that does not end in .html,
    and the errors of `read`.

    >>> import exactfold
    >>> page = exactfold.view("single-vertex-4", frames=3)
    >>> page.startswith("<!doctype html>")
    True
    """
    if path is not None:
        checked_page(Path(path))
    document = view_document(
        sheet,
        name=name,
        branches=signs,
        frames=frames,
        proving=proving,
        workers=workers,
        progress=progress,
    )
    page = view_page(document)
    if path is not None:
        write_text(Path(path), page)
    return page


def _way(
    sheet: PatternLike | BranchCount | Decomposition,
    way: int | None,
    signs: Signs | None,
    up: Iterable[int] | None,
    letters: Letters | None,
    progress: Progress | None,
) -> DrawnWay:
    """The picture of one way of a sheet, or of the way with a number in a count."""
    if isinstance(sheet, BranchCount):
        if way is None:
            raise UsageError("name a way of the count by its number, as in `draw(result, 3)`")
        return branch_way(listed(sheet.known, way), way)
    if not isinstance(sheet, Decomposition):
        opened = open_sheet(sheet)
        pattern = opened.sheet
        named = signs is not None or up is not None
        if isinstance(pattern, CreasePattern) and (named or has_branches(pattern)):
            branch, side = the_branch(opened, way, signs, up, letters, progress=progress)
            return branch_way(branch, way).turned(side)
        letters = None if letters is None else asked_letters(opened, letters)
        sheet = decompose_opened(opened, progress=progress).known
    if signs is not None or up is not None:
        raise UsageError("signs and up are for branches: choose a mode of this sheet by way")
    wanted = None if letters is None else by_fold(sheet.pattern.folds, letters)
    rates = modes_with(sheet, way, wanted) or {}
    modes = panel_modes(sheet)
    [(number, rate)] = rates.items()
    if not isinstance(number, int) or not 1 <= number <= len(modes):
        raise UsageError(f"there is no way {number}: the sheet has {counted(len(modes), 'mode')}")
    return mode_way(modes[number - 1]).turned(int(rate))
