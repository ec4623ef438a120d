"""Near misses among real drawings: `python tests/design/moving/repaired.py FOLDER [--csv FILE]`.

Each crease pattern below the folder whose panels do not truly start to fold with the drawn letters
is given to `designed`, with a limit of time and of folds: first with vertices of the border that
move along it, then freely. A row for each says what `designed` answers, and by which share of the
width vertices were moved. A new sheet counts only if `match` proves that its panels truly fold.
"""

from __future__ import annotations

import argparse
import csv
import time
from collections import Counter
from pathlib import Path

from exactfold import PROVED, UNDECIDED
from exactfold._support.clock import Clock
from exactfold.design import designed, match_panels
from exactfold.errors import ExactfoldError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.formats.read import READERS
from exactfold.pattern.opening import open_pattern, panels
from exactfold.pattern.panel_pattern import EnclosedPattern
from exactfold.pattern.reading import Reading

NAMES = ("file", "folds", "border", "moved", "answer")


def row(path: Path, limit: float, most: int) -> tuple[str, ...] | None:
    """The row of a file; None if it is no near miss, or none that is looked at."""
    try:
        opened = open_pattern(path)
        if isinstance(opened.sheet, EnclosedPattern):
            opened = open_pattern(path, Reading(snap="exact"))
    except ExactfoldError:
        return None
    sheet = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    drawn = {fold: opened.letters.get(fold, "U") for fold in sheet.folds}
    if not {"M", "V"} & set(drawn.values()) or len(sheet.folds) > most or sheet.holes:
        return None
    try:
        before = match_panels(sheet, drawn, clock=Clock(limit))
        if before.truly is PROVED:
            return None
        for border in ("along", "free"):
            found = designed(sheet, drawn, border=border, clock=Clock(limit))
            if found.status is not UNDECIDED:
                break
    except ExactfoldError as error:
        return str(path), str(len(sheet.folds)), "", "", str(error)
    answer = f"{found.status}: {found.reason}"
    if found.status is PROVED:
        assert match_panels(found.pattern, drawn).truly is PROVED
        answer = "proved"
    share = found.largest_move / max(
        float(max(x)) - float(min(x)) for x in zip(*sheet.vertices, strict=True)
    )
    return str(path), str(len(sheet.folds)), border, f"{share:.2g}", answer


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--limit", type=float, default=60)
    parser.add_argument("--most", type=int, default=200, help="the most folds")
    parser.add_argument("--only", default="")
    asked = parser.parse_args()
    rows = []
    for path in sorted(asked.folder.rglob("*")):
        if path.suffix.lower()[1:] not in READERS or asked.only not in str(path):
            continue
        start = time.process_time()
        if (found := row(path, asked.limit, asked.most)) is not None:
            found = (str(path.relative_to(asked.folder)), *found[1:])
            rows.append(found)
            print(*found, f"{time.process_time() - start:.1f} s", sep="  ", flush=True)
    counts = Counter(answer.split(":")[0] for *_, answer in rows)
    print(f"{len(rows)} near misses: {dict(counts)}")
    if asked.csv is not None:
        with asked.csv.open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([NAMES, *rows])


if __name__ == "__main__":
    main()
