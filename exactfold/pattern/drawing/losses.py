"""Says in short how a sheet was made of a drawing, and which creases are missing in it."""

from __future__ import annotations

from collections import Counter
from math import hypot

from exactfold._support.plurals import agreeing, counted
from exactfold.pattern.drawing.drawing import Drawing, Loud
from exactfold.pattern.drawing.mending import Lost, floats, used
from exactfold.pattern.drawing.repair import Sheets
from exactfold.pattern.drawing.segments import KINDS

_WHY = {
    "dangling": "creases that end inside a panel or meet no other line cannot fold; draw them "
    "from line to line, or leave them out",
    "border": "creases with no panel on one side are taken for the boundary; draw a closed "
    "boundary round them",
}


def missing(drawing: Drawing, sheets: Sheets, k: int, *, folds: bool) -> str | None:
    """What is lost of a drawing in sheet `k`, counted from 0; None if every crease is in it.

    The creases are the lines M and V. In a drawing without these letters, they are the lines U.
    Lines round a sheet count as lost only if the drawing has boundary lines elsewhere. A lost line
    belongs to the sheets whose bounding boxes contain its middle; if there are none, it belongs to
    the nearest sheet. A sheet without `folds` is a loss, too.
    """
    letters = {line.letter for line in drawing.lines}
    creases = letters & {"M", "V"} or {"U"}
    boxes = [_box(sheet) for sheet in sheets.sheets]
    said = [] if folds else ["the sheet has no folds"]
    for step, why in _WHY.items():
        if step == "border" and "B" not in letters and folds:
            continue
        gone = [
            line
            for repair in sheets.repairs
            if repair.step == step
            for line in repair.lost
            if _belongs(line, k, boxes)
        ]
        if any(line.letter in creases for line in gone):
            said.append(_sentence(gone, creases, why))
    return "; ".join(said) or None


def brief(drawing: Drawing, sheets: Sheets) -> tuple[str, ...]:
    """What was read, in a few words each: lines, coordinates, and how much was mended."""
    number = Counter[str]()
    for repair in sheets.repairs:
        if not repair.loud:
            number[repair.step if repair.step in ("join", "split") else "mended"] += repair.count
    words = [counted(len(drawing.lines), "line"), sheets.coordinates.brief]
    words += [f"cut at {counted(number['split'], 'point')}"] if number["split"] else []
    words += [f"{counted(number['join'], 'flat line')} left out"] if number["join"] else []
    words += [f"{number['mended']} mended"] if number["mended"] else []
    return tuple(words)


def loud(drawing: Drawing, sheets: Sheets) -> tuple[str, ...]:
    """What nobody should miss of how a drawing was read, one sentence each."""
    remarks = [remark for remark in drawing.remarks if isinstance(remark, Loud)]
    return (*remarks, *(repair.sentence for repair in sheets.repairs if repair.loud))


def _sentence(gone: list[Lost], creases: set[str], why: str) -> str:
    first = next(line for line in gone if line.letter in creases)
    number = Counter(line.letter for line in gone)
    kinds = ", ".join(f"{number[letter]} {KINDS[letter]}" for letter in KINDS if number[letter])
    return (
        f"{counted(len(gone), 'line')} of the drawing ({kinds}) {agreeing(len(gone), 'is')} not in "
        f"the sheet, the first near ({first.x:.6g}, {first.y:.6g}): {why}"
    )


def _belongs(line: Lost, k: int, boxes: list[tuple[float, float, float, float]]) -> bool:
    away = [
        hypot(
            max(left - line.x, 0, line.x - right),
            max(low - line.y, 0, line.y - high),
        )
        for left, low, right, high in boxes
    ]
    return away[k] == min(away)


def _box(sheet: Drawing) -> tuple[float, float, float, float]:
    places = floats(sheet.points)[used(sheet.lines)]
    (left, low), (right, high) = places.min(axis=0).tolist(), places.max(axis=0).tolist()
    return left, low, right, high
