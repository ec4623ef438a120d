"""Near misses among real drawings: `python tests/design/moving/repaired.py FOLDER [--csv FILE]`.

Each crease pattern below the folder whose panels do not truly start to fold with the drawn letters
is given to `designed`, with a limit of time and of folds: first with vertices of the border that
move along it, then freely. A row for each says what `designed` answers, and by which share of the
width vertices were moved. A new sheet counts only if `match` proves that its panels truly fold.

With `--rounded STEPS` drawings are taken whose panels do fold with their letters: their inner
vertices are rounded to so many steps over the width, so that they miss. With `--written` inexact
drawings are taken with the digits as written, and the letters are those of the first way along
modes of the sheet that was meant.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

from exactfold import PROVED, UNDECIDED
from exactfold._support.clock import Clock
from exactfold.design import designed, match_panels
from exactfold.errors import ExactfoldError, NotCountedError, SeveralSheetsError
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.decomposition import decompose
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.formats.read import READERS
from exactfold.pattern.opening import Opened, open_pattern, panels
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, PanelPattern
from exactfold.pattern.reading import Reading

NAMES = ("file", "folds", "border", "moved", "answer")


def missed(sheet: PanelPattern, steps: int) -> PanelPattern:
    """The sheet with its inner vertices rounded to so many steps over its width."""
    step = Fraction(max(float(x) for x, _ in sheet.vertices)) - Fraction(
        min(float(x) for x, _ in sheet.vertices)
    )
    points = list(sheet.vertices)
    for v in sheet.interior:
        points[v] = tuple(
            round(Fraction(float(c)) / step * steps) * step / steps for c in points[v]
        )
    return PanelPattern(points, sheet.edges)


def sheets_of(path: Path) -> Iterator[tuple[str, Opened]]:
    """The sheets of a file that can be read, with their names."""
    numbers: Iterable[int | None] = (None,)
    try:
        open_pattern(path)
    except SeveralSheetsError as error:
        numbers = range(1, error.sheets + 1)
    except ExactfoldError:
        return
    for number in numbers:
        try:
            opened = open_pattern(path, Reading(number=number))
            if isinstance(opened.sheet, EnclosedPattern):
                opened = open_pattern(path, Reading(snap="exact", number=number))
        except ExactfoldError:
            continue
        yield path.name if number is None else f"{path.name}, sheet {number}", opened


def way_as_written(opened: Opened) -> tuple[PanelPattern, dict[Edge, str]] | None:
    """The sheet with the digits as written, and the letters of the first way of the one meant."""
    if opened.meant is None or opened.again is None:
        return None
    written = opened.again(replace(opened.reading, snap="exact")).sheet
    if written.edges != opened.sheet.edges:
        return None
    ways = panel_ways(decompose(in_panels(opened.sheet), clock=Clock(60)))
    way = next((one for one in ways if one.verdict is PROVED and one.modes), None)
    if way is None:
        return None
    return in_panels(written), dict.fromkeys(opened.sheet.folds, "F") | dict(way.letters)


def in_panels(sheet: CreasePattern | PanelPattern) -> PanelPattern:
    """The sheet as one of panels."""
    return panels(sheet) if isinstance(sheet, CreasePattern) else sheet


def row(
    opened: Opened,
    limit: float,
    most: int,
    steps: int | None,
    share: Fraction,
    *,
    written: bool,
) -> tuple[str, ...] | None:
    """The row of a sheet; None if it is no near miss, or none that is looked at."""
    sheet = in_panels(opened.sheet)
    drawn = {fold: opened.letters.get(fold, "U") for fold in sheet.folds}
    if not {"M", "V"} & set(drawn.values()) or len(sheet.folds) > most or sheet.holes:
        return None
    if written:
        if (known := way_as_written(opened)) is None:
            return None
        sheet, drawn = known
    width = max(Fraction(float(max(x)) - float(min(x))) for x in zip(*sheet.vertices, strict=True))
    try:
        before = match_panels(sheet, drawn, clock=Clock(limit))
        if (before.truly is PROVED) != (steps is not None):
            return None
        if steps is not None:
            sheet = missed(sheet, steps)
            if match_panels(sheet, drawn, clock=Clock(limit)).truly is PROVED:
                return None
        for border in ("along", "free"):
            try:
                found = designed(
                    sheet, drawn, border=border, within=share * width, clock=Clock(limit)
                )
            except NotCountedError:  # a corner with an irrational coordinate
                if border == "free":
                    raise
                continue
            if found.status is not UNDECIDED:
                break
    except ExactfoldError as error:
        return str(len(sheet.folds)), "", "", str(error)
    answer = f"{found.status}: {found.reason}"
    if found.status is PROVED:
        assert match_panels(found.pattern, drawn).truly is PROVED
        answer = "proved"
    moved = found.largest_move / float(width)
    return str(len(sheet.folds)), border, f"{moved:.2g}", answer


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--most", type=int, default=200, help="the most folds")
    parser.add_argument("--written", action="store_true", help="digits as written, and a way")
    parser.add_argument("--within", type=Fraction, default=Fraction(1, 10), metavar="SHARE")
    parser.add_argument("--only", default="")
    parser.add_argument("--rounded", type=int, metavar="STEPS", help="drawings made to miss")
    asked = parser.parse_args()
    rows = []
    for path in sorted(asked.folder.rglob("*")):
        if path.suffix.lower()[1:] not in READERS or asked.only not in str(path):
            continue
        for name, opened in sheets_of(path):
            start = time.process_time()
            found = row(
                opened, asked.limit, asked.most, asked.rounded, asked.within, written=asked.written
            )
            if found is not None:
                rows.append((str(path.relative_to(asked.folder).with_name(name)), *found))
                print(*rows[-1], f"{time.process_time() - start:.1f} s", sep="  ", flush=True)
    counts = Counter(answer.split(":")[0] for *_, answer in rows)
    print(f"{len(rows)} near misses: {dict(counts)}")
    if asked.csv is not None:
        with asked.csv.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([NAMES, *rows])


if __name__ == "__main__":
    main()
