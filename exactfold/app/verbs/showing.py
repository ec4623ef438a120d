"""`draw` and `view`: draw a sheet or its ways, and make the page that shows them in space."""

from __future__ import annotations

from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

from exactfold._support.clock import LIMIT
from exactfold._support.progress import Progress
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.drawn_ways import DrawnWay, branch_way, panel_way
from exactfold.app.pictures.picture_files import write_picture
from exactfold.app.pictures.stills import motion_stills
from exactfold.app.pictures.way_sheets import sheet_of_ways
from exactfold.app.verbs.choosing import choose, listed
from exactfold.app.verbs.choosing_panels import panels_way
from exactfold.app.verbs.chosen import Choice, ChosenBranch, ChosenPanels, Letters
from exactfold.app.viewer.document import FRAMES, view_document
from exactfold.app.viewer.page import checked_page, view_page
from exactfold.branches.counting.find import Signs
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.errors import NotCountedError, UsageError
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.panels.result import Decomposition
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.writing.fold_writing import write_text

Shown: TypeAlias = "PatternLike | Branch | BranchCount | Decomposition | SheetInMotion"
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
    if isinstance(sheet, Branch | SheetInMotion) and named:
        raise UsageError("way, signs, up and letters choose a way of a sheet: leave them out here")
    if isinstance(sheet, Branch):
        text = branch_way(sheet).picture(title)
    elif isinstance(sheet, SheetInMotion):
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
    way: int | None = None,
    *,
    signs: Signs | None = None,
    up: Iterable[int] | None = None,
    letters: Letters | None = None,
    frames: int = FRAMES,
    proving: bool = False,
    name: str | None = None,
    path: str | PathLike[str] | None = None,
    workers: int = 1,
    limit: float = LIMIT,
    progress: Progress | None = None,
) -> str:
    """The page that shows how a sheet folds, as HTML text; with `path`, also written to a file.

    The page opens in a browser without a network. `sheet` is anything that `read` takes. The page
    shows all ways that are known, or the one that `way`, `signs`, `up` or `letters` names, as in
    `follow`. Each way is followed in `frames` frames to its first contact; with `proving`, its
    motion is also proved. `workers` processes share the work. All this takes `limit`
    seconds; a quarter of them at least is spent on following.

    Raises `UsageError` for signs that do not fit the sheet or a file that does not end in .html,
    and the errors of `read`.

    >>> import exactfold
    >>> page = exactfold.view("single-vertex-4", frames=3)
    >>> page.startswith("<!doctype html>")
    True
    """
    if path is not None:
        checked_page(Path(path))
    choice = Choice(way, signs, up, letters)
    only: dict[str, Any] = {}
    if choice.names:
        opened = open_sheet(sheet)
        only = shown(choose(opened, choice, progress))
        if name is None and isinstance(sheet, str | PathLike):
            name = Path(sheet).stem
        sheet = opened
    document = view_document(
        sheet,
        name=name,
        **only,
        frames=frames,
        proving=proving,
        workers=workers,
        limit=limit,
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
    if isinstance(sheet, Decomposition):
        if signs is not None or up is not None:
            raise UsageError("signs and up are for branches: choose a way of this sheet by way")
        chosen: ChosenBranch | ChosenPanels = panels_way(sheet, way, letters)
    else:
        chosen = choose(open_sheet(sheet), Choice(way, signs, up, letters), progress)
    if isinstance(chosen, ChosenBranch):
        return branch_way(chosen.branch, chosen.number).turned(chosen.side)
    return drawn_panels(chosen)


def shown(chosen: ChosenBranch | ChosenPanels) -> dict[str, Any]:
    """The way that a page shows, as arguments of `view_document`."""
    if isinstance(chosen, ChosenBranch):
        return {"branches": [chosen.branch]}
    return {"ways": [] if chosen.way is None else [chosen.way.number]}


def drawn_panels(chosen: ChosenPanels) -> DrawnWay:
    """The picture of a way of rigid panels with the letters that were asked for."""
    if chosen.way is None:
        raise NotCountedError("this sheet has no single way to draw")
    return panel_way(chosen.way, chosen.answer.known.pattern, chosen.rates)
