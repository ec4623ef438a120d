"""What notebooks show: pictures of patterns, branches and motions, and tables of counts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final

from exactfold._support.notebook import shows
from exactfold._support.plurals import agreeing, counted
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.drawn_ways import DrawnWay, branch_way, ways_of
from exactfold.app.pictures.stills import motion_stills
from exactfold.app.pictures.svg import escape
from exactfold.app.report.connected_components import families_answer
from exactfold.app.report.panels import panels_answer
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.design.assignments.result import Match
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.fold import FoldFile
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import PanelPattern

if TYPE_CHECKING:
    from collections.abc import Sequence

ROWS: Final = 30
"""At most this many ways have a row each; the others are only counted."""
_THUMBNAIL: Final = 120.0


@shows("svg", CreasePattern, PanelPattern, Drawing)
def _pattern(pattern: CreasePattern | PanelPattern | Drawing) -> str:
    return pattern_picture(pattern)


@shows("svg", Opened)
def _opened(opened: Opened) -> str:
    return pattern_picture(opened.sheet, opened.assignment)


@shows("svg", FoldFile)
def _file(file: FoldFile) -> str:
    return pattern_picture(file.pattern, file.assignment)


@shows("svg", Branch)
def _branch(branch: Branch) -> str:
    return branch_way(branch).picture()


@shows("svg", SheetInMotion)
def _motion(motion: SheetInMotion) -> str:
    return motion_stills(motion)


@shows("html", BranchCount)
def _count(result: BranchCount) -> str:
    heads = ("way", "", "vertex signs", "folds", "counts")
    shown = [branch_way(branch, k) for k, branch in enumerate(result.branches[:ROWS], 1)]
    rows = [
        (way, branch.sign_text, way.text, str(branch.multiplicity or "?"))
        for way, branch in zip(shown, result.branches, strict=False)
    ]
    count = "" if result.distinct is None else f"{counted(result.distinct, 'branch')}, "
    if result.connected_components is not None and result.distinct is None:
        count = f"{escape('; '.join(families_answer(result.connected_components)))}, "
    head = f"{count}<b>{result.status}</b> ({escape(result.reason)})"
    return _page(head, heads, rows, len(result.branches), result.warning)


@shows("html", Match)
def _match(match: Match) -> str:
    heads = ("", "", "vertex signs", "side", "folds")
    shown = [branch_way(ray.branch, k) for k, ray in enumerate(match.matches[:ROWS], 1)]
    shown = [
        replace(way, letters=ray.assignment, signs=ray.vertex_signs, name=ray.sign_text)
        for way, ray in zip(shown, match.matches, strict=False)
    ]
    rows = [
        (way, ray.sign_text, "+" if ray.side > 0 else "-", way.text)
        for way, ray in zip(shown, match.matches, strict=False)
    ]
    number = len(match.matches)
    have = agreeing(number, "has")
    head = f"{number or 'no'} {agreeing(number, 'half')} of branches {have} these letters, "
    head += f"<b>{match.status}</b>"
    return _page(head, heads, rows, number, None)


@shows("html", Decomposition)
def _panels(result: Decomposition) -> str:
    heads = ("way", "", "folds", "truly folds")
    ways = panel_ways(result)
    rows = [
        (way, way.text, str(one.verdict))
        for way, one in zip(ways_of(result, ROWS), ways, strict=False)
    ]
    return _page(escape(str(panels_answer(result))), heads, rows, len(ways), result.warning)


def _page(
    head: str,
    heads: Sequence[str],
    rows: Sequence[tuple[DrawnWay, *tuple[str, ...]]],
    number: int,
    warning: str | None,
) -> str:
    """The answer, a table with a picture in each row, how many rows are left out, and the
    warning.
    """
    parts = [f"<p>{head}</p>"]
    if rows:
        titles = "".join(f"<th>{escape(title)}</th>" for title in heads)
        parts.append(f"<table><thead><tr>{titles}</tr></thead><tbody>")
        parts += [_row(way, cells) for way, *cells in rows]
        parts.append("</tbody></table>")
    if number > len(rows):
        parts.append(f"<p>and {number - len(rows)} more</p>")
    if warning is not None:
        parts.append(f"<p>warning: {escape(warning)}</p>")
    return "\n".join(parts)


def _row(way: DrawnWay, cells: Sequence[str]) -> str:
    drawn = way.drawing(_THUMBNAIL, small=True).picture(way.name, keyed=False)
    others = "".join(f"<td><code>{escape(cell)}</code></td>" for cell in cells)
    return f"<tr><td>{way.number}</td><td>{drawn.strip()}</td>{others}</tr>"
