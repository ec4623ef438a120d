"""Ask every crease pattern below a folder for its flat-folded states, and Flat-Folder beside.

python tests/benchmarks/flat_states.py FOLDER --csv FILE [--against CHECKOUT] [--only TEXT]

CHECKOUT is a clone of github.com/origamimagiro/flat-folder, which Node runs on the sheet that
exactfold has read. Reading, folding and Flat-Folder have 60 seconds of processor time each. The
smallest files come first, and FILE gets a row as soon as a file is done: started anew with the same
FILE, the run goes on where it stopped. The tables at the end are those of docs/flat.md.
"""

from __future__ import annotations

import argparse
import csv
import json
import multiprocessing
import resource
import signal
import subprocess
import tempfile
import time
from collections import Counter
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from real_files import REASONS, short

from exactfold.errors import ExactfoldError
from exactfold.layers.folding import fold_flat
from exactfold.layers.states import FlatStates
from exactfold.pattern.drawing.formats.read import READERS
from exactfold.pattern.opening import open_pattern

LIMIT = 60
LISTED = 100_000  # states of each component, at most, in Flat-Folder
KINDS = ("states", "none", "not locally flat", "noise", "not read", "undecided")
TIMES = ("reading", "folding", "flat_folder_seconds")
COLUMNS = ("file", "answer", "states", "why", "pieces", "pairs", *TIMES, "flat_folder", "agree")
"""Pieces, overlapping pairs, seconds of processor time; for noise, the states of the digits."""
ENDED: dict[int | None, str] = {-signal.SIGXCPU: f"not ended in {LIMIT} s"}
Row = dict[str, Any]


def allow(seconds: float) -> None:
    """Let this process have so many more seconds of processor time."""
    soft = int(time.process_time() + seconds) + 1
    resource.setrlimit(resource.RLIMIT_CPU, (soft, resource.getrlimit(resource.RLIMIT_CPU)[1]))


def kind_of(found: FlatStates) -> tuple[str, str]:
    """The kind of an answer, and the reason in a few words."""
    if found.doubt:
        if found.near is not None and found.doubt.startswith(found.near.text):
            return "noise", f"corners miss lines by {found.near.distance:.0e}"
        moved = found.doubt.startswith("coordinates moved")
        return "noise", "coordinates moved" if moved else "the sheet that was meant is not known"
    if found.failures:
        angles = [abs(one.off) for one in found.failures if one.off is not None]
        number = f"{len(found.failures) - len(angles)} letters or degrees"
        return "not locally flat", f"{number}, {len(angles)} angles by {max(angles, default=0):.1g}"
    if found.conflict:
        return "none", f"{len(found.conflict)} conditions"
    return ("undecided", found.stopped) if found.count is None else ("states", "")


def fold_document(found: FlatStates) -> dict[str, Any]:
    """The sheet with its letters as FOLD, in floats."""
    border = set(found.pattern.boundary_edges)
    edges = found.pattern.edges
    return {
        "vertices_coords": [[float(x), float(y)] for x, y in found.pattern.vertices],
        "edges_vertices": edges,
        "edges_assignment": ["B" if edge in border else found.letters[edge] for edge in edges],
        "faces_vertices": found.pattern.faces,
    }


def answer(path: Path, sheet: Path, out: Connection) -> None:
    """Send what is done, a text before each step, and at last the row; write the sheet."""
    out.send("reading")
    allow(LIMIT)
    start = time.process_time()
    try:
        opened = open_pattern(path)
    except ExactfoldError as error:
        why = REASONS.get(type(error).__name__, type(error).__name__)
        return out.send({"answer": "not read", "why": why})
    read = time.process_time()
    out.send("folding")
    allow(LIMIT)
    found = fold_flat(opened, limit=None, progress=lambda step, done, total: out.send(step))
    row: Row = {"reading": read - start, "folding": time.process_time() - read}
    row |= zip(("answer", "why"), kind_of(found), strict=True)
    pieces = found.pattern.faces if found.images is None else found.images.maps
    row |= {"states": found.count, "pieces": len(pieces), "pairs": len(found.pairs)}
    sheet.write_text(json.dumps(fold_document(found)))
    out.send(row)


def answered(path: Path, sheet: Path) -> Row:
    """The row of a file, from a process of its own."""
    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)
    process = fork.Process(target=answer, args=(path, sheet, sender))
    process.start()
    sender.close()
    step: Any = ""
    with suppress(EOFError):
        while isinstance(step, str):
            step = receiver.recv()
    process.join()
    if not isinstance(step, str):
        return dict(step)
    why = f"{ENDED.get(process.exitcode, 'died')}: {step}"
    return {"answer": "not read" if step == "reading" else "undecided", "why": why}


def flat_folder(checkout: Path, sheet: Path) -> Row:
    """What Flat-Folder answers on a sheet."""
    driver = Path(__file__).with_name("flat_folder.mjs")
    command = ["node", str(driver), str(checkout), str(sheet), str(LISTED)]
    done = subprocess.run(
        command, stdout=subprocess.PIPE, text=True, check=False, preexec_fn=lambda: allow(LIMIT)
    )
    if not done.stdout:
        return {"flat_folder": ENDED.get(done.returncode, "died")}
    said = json.loads(done.stdout)
    number = said.get("error") or said["states"] + ("+" if said["limited"] else "")
    return {"flat_folder": number, "flat_folder_seconds": said["seconds"]}


def agreement(row: Row) -> str:
    """Whether the numbers of states agree; "+" means that there may be more."""
    ours, other = row.get("states"), str(row.get("flat_folder", ""))
    if ours in (None, "") or not other.removesuffix("+").isdigit():
        return ""
    least = int(other.removesuffix("+"))
    return "yes" if int(ours) == least or (other.endswith("+") and int(ours) > least) else "no"


def run(folder: Path, only: str, table: Path, checkout: Path | None) -> list[Row]:
    """Append the rows of all files that the table does not have; all rows."""
    every = [p for p in folder.rglob("*") if p.suffix.lower().removeprefix(".") in READERS]
    names = short(str(path.relative_to(folder)) for path in every if path.is_file())
    paths = sorted(names, key=lambda name: (folder / name).stat().st_size)
    known = [*csv.DictReader(table.open())] if table.exists() else []
    rows = {row["file"]: row for row in known}
    with table.open("a", newline="") as out, tempfile.TemporaryDirectory() as scratch:
        writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
        if not known:
            writer.writeheader()
        sheet = Path(scratch) / "sheet.fold"
        for path, name in ((folder / path, names[path]) for path in paths):
            if name in rows or only not in name:
                continue
            sheet.unlink(missing_ok=True)
            row = {"file": name, **answered(path, sheet)}
            if checkout is not None and sheet.exists():
                row |= flat_folder(checkout, sheet)
            row = {key: f"{x:.2f}" if isinstance(x, float) else x for key, x in row.items()}
            row["agree"] = agreement(row)
            rows[name] = row
            writer.writerow(row)
            out.flush()
            print(*(row.get(key, "") for key in COLUMNS), sep="  ", flush=True)
    return [rows[name] for name in names.values() if name in rows]


def summary(rows: list[Row]) -> str:
    """The tables of docs/flat.md."""
    lines = ["| answer | files | Flat-Folder agrees | differs | no answer |", f"|---|{'---:|' * 4}"]
    for kind in KINDS:
        these = [row for row in rows if row["answer"] == kind]
        agree = Counter(row["agree"] for row in these if row.get("flat_folder"))
        counts = (len(these), agree["yes"], agree["no"], agree[""])
        lines.append(f"| {kind} | {' | '.join(map(str, counts))} |")
    both = [row for row in rows if row["agree"] and int(row["pairs"])]
    both.sort(key=lambda row: -int(row["pairs"]))
    lines.append("\n| file | pairs | reading | folding | Flat-Folder | folding by it |")
    lines.append(f"|---|{'---:|' * 5}")
    for name, some in (("all", both), *((row["file"], [row]) for row in both[:8])):
        read, ours, other = (sum(float(row[key]) for row in some) for key in TIMES)
        times = f"{read:.2f} s | {ours:.2f} s | {other:.2f} s | {ours / max(other, 0.01):.2f}"
        lines.append(f"| {name} | {sum(int(row['pairs']) for row in some)} | {times} |")
    return "\n".join(lines)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--csv", type=Path, required=True, help="a row for each file is added")
    parser.add_argument("--against", type=Path, metavar="CHECKOUT", help="of Flat-Folder")
    parser.add_argument("--only", default="", help="only paths with this text")
    given = parser.parse_args()
    fold_flat("square-twist")  # modules are loaded once, before the clocks
    print(summary(run(given.folder, given.only, given.csv, given.against)))


if __name__ == "__main__":
    main()
