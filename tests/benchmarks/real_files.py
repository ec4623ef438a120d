"""Count every crease pattern below a folder, with this program and with an older one.

python tests/benchmarks/real_files.py FOLDER [--against COMMIT] [--only TEXT] [--keep FOLDER]
    [--csv FILE] [--limit SECONDS]
python tests/benchmarks/real_files.py FOLDER --noise FILE [--limit SECONDS] [--only TEXT]
    [--keep FOLDER]

Every file is a process of its own, one after the other, which has 60 seconds. As the machine may
have other work, this is its time or that of its processors, whichever is less; `--limit` gives
each count more of the former, so that it gets its share of the latter. A file with several
sheets has the kind of its worst sheet. The answers are kept below `--keep`, one file of JSON lines
a program, so that an interrupted run goes on where it stopped. The summary at the end is that of
docs/real_files.md; `--csv` writes a row for each file, as docs/real_files.csv.

`--noise` finds the inexact drawings instead, and writes a row for each, as docs/real_noise.csv: the
sheet that was meant, its answer, and that for the digits as written. Each count has the `--limit`
of `exactfold count`.
"""

from __future__ import annotations

import argparse
import csv
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from exactfold._support.plurals import counted
from exactfold.pattern.drawing.formats.read import READERS

LIMIT = 60
HERE = Path(__file__).resolve().parents[2]
KINDS = (
    "complete",
    "in part",
    "refused",
    "UNDECIDED, nothing more",
    f"not ended in {LIMIT} s",
    "defect",
)
REASONS = {
    "SeveralSheetsError": "several sheets",  # by programs that count only a chosen one
    "NotADiskError": "a sheet that hangs together by a point",
    "FoldedStateError": "a folded state",
    "FoldError": "border lines between panels",
    "DisconnectedError": "lines that do not meet",
    "MalformedPatternError": "creases that end inside panels",
    "MalformedDrawingError": "creases that vanish, or no folds",
}
REMEDIES = {
    "`--chords ": ["--chords", "4"],
    "`--box`": ["--box"],
}
"""What the message to a refused file names and nobody has to choose, with options of `count`."""

NOISE = (
    "file",
    "eps",
    "gap",
    "relations",
    "independent",
    "moved",
    "answer of the sheet that was meant",
    "answer as written",
)
"""The columns of docs/real_noise.csv; lengths are shares of the size of the drawing."""

SLOWEST = 10 * LIMIT
"""No command takes longer, on a machine that has other work to do, too."""

Line = dict[str, Any]


def answered(
    path: Path, source: Path, *options: str, command: str = "count", limit: float = SLOWEST
) -> Line:
    """What a command of the program below `source` answers, ended after `limit` seconds.

    "seconds" is the time that has passed, or that of processors if this is less. "sheets" has the
    answers to the sheets of a file with several.
    """
    words = [sys.executable, "-m", "exactfold", command, str(path.resolve()), "--json", *options]
    began, used = time.perf_counter(), processors()
    try:
        done = subprocess.run(
            words,
            capture_output=True,
            text=True,
            timeout=limit,
            check=False,
            cwd=source,
            env={**os.environ, "PYTHONPATH": str(source)},
        )
    except subprocess.TimeoutExpired:
        return {"code": None, "seconds": limit, "result": None, "error": ""}
    seconds = min(time.perf_counter() - began, processors() - used)
    results = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    line = {
        "code": done.returncode,
        "seconds": round(seconds, 1),
        "result": results[0] if results else None,
        "error": done.stderr.strip(),
    }
    if len(results) > 1:
        line["sheets"] = [
            {
                "code": one["exit_code"],
                "seconds": 0.0,  # of the whole file
                "result": one["result"] or {"error": one["error"]},
            }
            for one in results
        ]
    return line


def processors() -> float:
    """The seconds of processors that the processes which have ended used."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def known_in_part(result: Line) -> list[str]:
    """What is proved of a sheet whose ways are not all known."""
    known = []
    freedom, drawn = result.get("freedom") or {}, result.get("drawn") or {}
    if drawn.get("starts") in ("proved", "refuted"):
        known.append(f"drawn letters {drawn['starts']}")
    if freedom and (freedom["least"] or not freedom["most"] or freedom.get("within")):
        near = " on every sheet near" if freedom.get("within") else ""
        known.append(f"{freedom['least']} to {freedom['most']} degrees of freedom{near}")
    found = result["components"] or {}
    ways = found.get("found_true") or found.get("found") or {}
    if ways:
        known.append(f"at least {counted(sum(ways.values()), 'way')}")
    return known


def refused_for(line: Line) -> str:
    """Why a file was refused, in a few words; programs before errors had classes say nothing."""
    if line["result"] is None:
        return ""
    error = line["result"]["error"]
    if "creases must be straight" in error["message"]:
        return "curves"
    return REASONS.get(error["class"], str(error["class"]))


def remedy_of(line: Line) -> list[str]:
    """The options of `count` that the message to a refused file names; empty if there are none.

    They are not looked for in files with several sheets.
    """
    if line["code"] != 3 or line["result"] is None or "sheets" in line:
        return []
    message = line["result"]["error"]["message"]
    return next((options for named, options in REMEDIES.items() if named in message), [])


def kind_of(line: Line) -> tuple[str, str]:
    """The kind of an answer, and what it says; of several sheets, the kind of the worst."""
    code, result = line["code"], line["result"]
    if code is None or line["seconds"] > LIMIT:
        return KINDS[4], ""
    if "sheets" in line:
        return of_sheets([kind_of(one) for one in line["sheets"]])
    if code == 3:
        return KINDS[2], refused_for(line)
    if result is None:
        return KINDS[5], f"exit code {code}"
    components = result["components"] or {}
    if code in (0, 1):
        if result["rigid"]:
            return KINDS[0], "rigid"
        if result["distinct"] is not None:
            return KINDS[0], counted(result["distinct"], "branch")
        if result["pieces"]:
            number = int(result["pieces"]["graphs"])
            power = number.bit_length() - 1
            short = f"2^{power}" if number == 1 << power and power > 20 else number
            graphs = counted(short, "graph")
            return KINDS[0], f"{graphs} of dimension {result['dimension']}"
        if components.get("graphs"):
            known = components["graphs"]
            return KINDS[0], f"2^{known['vertices']} graphs of dimension {known['dimension']}"
        spaces = components["true"] or components["second_order"]
        said = ", ".join(f"{number} of dimension {k}" for k, number in spaces.items())
        return KINDS[0], said + ("" if components["true"] else ", to second order")
    known = known_in_part(result)
    return (KINDS[1], "; ".join(known)) if known else (KINDS[3], "")


def of_sheets(answers: list[tuple[str, str]]) -> tuple[str, str]:
    """The worst kind of the sheets of a file; what is said of each if all are complete or refused,
    and the kinds if not.
    """
    worst = max((kind for kind, _ in answers), key=KINDS.index)
    short = len({kind for kind, _ in answers}) > 1
    alike = Counter(kind if short or not said else said for kind, said in answers)
    sheets = counted(len(answers), "sheet")
    if len(alike) == 1:
        return worst, f"{sheets}, each {next(iter(alike))}"
    return worst, f"{sheets}: {'; '.join(f'{number} {said}' for said, number in alike.items())}"


def helped(line: Line) -> str:
    """The kind of the answer to a refused file with the remedy that its message names."""
    remedy = line.get("remedy")
    return kind_of(remedy)[0] if remedy else ""


def withdrawn(before: Line, now: Line) -> bool:
    """Whether a complete answer of before has changed: it was about noise or lost creases."""
    return kind_of(before)[0] == KINDS[0] and kind_of(before) != kind_of(now)


@contextmanager
def program(commit: str | None) -> Iterator[Path]:
    """The folder of the program of a commit; None stands for this one."""
    if commit is None:
        yield HERE
        return
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "old"
        git = ["git", "-C", str(HERE), "worktree"]
        subprocess.run([*git, "add", "-q", "--detach", str(tree), commit], check=True)
        try:
            yield tree
        finally:
            subprocess.run([*git, "remove", "--force", str(tree)], check=True)


def answers(
    paths: list[Path], folder: Path, commit: str | None, keep: Path, seconds: str
) -> dict[str, Line]:
    """The answer to every file by name, from the file of answers where it is there.

    Programs of before `--limit` are not told of the usual one.
    """
    limit = [] if seconds == str(LIMIT) else ["--limit", seconds]
    kept: dict[str, Line] = {}
    if keep.exists():
        kept = {line["file"]: line for line in map(json.loads, keep.open())}
    with program(commit) as source, keep.open("a") as out:
        for path in paths:
            name = str(path.relative_to(folder))
            if name in kept:
                continue
            line = {"file": name, **answered(path, source, *limit)}
            if options := remedy_of(line):
                line["remedy"] = answered(path, source, *limit, *options)
            out.write(json.dumps(line) + "\n")
            out.flush()
            kept[name] = line
            print(f"{line['seconds']:5.1f} s  {kind_of(line)[0]}  {name}", flush=True)
    return {str(path.relative_to(folder)): kept[str(path.relative_to(folder))] for path in paths}


def print_summary(programs: dict[str, dict[str, Line]]) -> None:
    """Print how many files have each kind of answer."""
    print(f"\n| answer | {' | '.join(programs)} |\n|---|{'---:|' * len(programs)}")
    kinds = [Counter(kind_of(line)[0] for line in lines.values()) for lines in programs.values()]
    for kind in KINDS:
        print(f"| {kind} | {' | '.join(str(count[kind]) for count in kinds)} |")
    slowest = [max(line["seconds"] for line in lines.values()) for lines in programs.values()]
    print(f"| slowest file, in seconds | {' | '.join(map(str, slowest))} |")
    *_, now = programs.values()
    kinds_helped = Counter(helped(line) for line in now.values())
    tried = sum(number for kind, number in kinds_helped.items() if kind)
    complete, partly = kinds_helped[KINDS[0]], kinds_helped[KINDS[1]]
    print(f"\n{tried} refused files were counted again with the options that the message names:")
    print(f"{complete} are then complete, {partly} in part.")
    if len(programs) == 2:
        before, now = programs.values()
        noise = sum(withdrawn(before[name], now[name]) for name in now)
        print(f"\nOf the complete answers before, {noise} are withdrawn or changed (*):")
        print("they were about noise or lost creases.")


def short(names: Iterable[str]) -> dict[str, str]:
    """Each path without its first folder, the repository, where no two paths then agree."""
    rest = {name: name.partition("/")[2] or name for name in names}
    times = Counter(rest.values())
    return {name: path if times[path] == 1 else name for name, path in rest.items()}


def write_files(programs: dict[str, dict[str, Line]], path: Path) -> None:
    """Write a row for each file."""
    first, now = next(iter(programs.values())), [*programs.values()][-1]
    with path.open("w", encoding="utf-8", newline="") as out:
        table = csv.writer(out, lineterminator="\n")
        table.writerow(["file", *programs])
        for name, path_shown in short(now).items():
            cells = []
            for lines in programs.values():
                kind, said = kind_of(lines[name])
                star = "*" if lines is not now and withdrawn(first[name], now[name]) else ""
                remedy = lines[name].get("remedy") and " ".join(remedy_of(lines[name]))
                then = f"; with `{remedy}` {helped(lines[name])}" if remedy else ""
                cells.append((f"{kind}: {said}" if said else kind) + then + star)
            table.writerow([path_shown, *cells])


def inexact(path: Path, seconds: str) -> Line:
    """What is inferred from a drawing, and both answers; `meant` is None if it is exact."""
    read = answered(path, HERE, command="vertices")["result"] or {}
    line: Line = {"meant": read.get("meant")}
    if line["meant"]:
        line["of_meant"] = answered(path, HERE, "--limit", seconds)
        digits = ("--snap", "exact", "--limit", seconds)
        line["of_digits"] = answered(path, HERE, *digits)
    return line


def print_noise(paths: list[Path], folder: Path, keep: Path, out: Path, seconds: str) -> None:
    """Write a row for each inexact drawing, in the columns of `NOISE`."""
    kept: dict[str, Line] = {}
    if keep.exists():
        kept = {line["file"]: line for line in map(json.loads, keep.open())}
    with keep.open("a") as lines:
        for path in paths:
            name = str(path.relative_to(folder))
            if name not in kept:
                kept[name] = {"file": name, **inexact(path, seconds)}
                lines.write(json.dumps(kept[name]) + "\n")
                lines.flush()
                print(f"{'inexact' if kept[name]['meant'] else '-'}  {name}", flush=True)
    with out.open("w", encoding="utf-8", newline="") as rows:
        table = csv.writer(rows, lineterminator="\n")
        table.writerow(NOISE)
        for name, path_shown in short(kept).items():
            if kept[name]["meant"]:
                table.writerow([path_shown, *noise_row(kept[name])])


def noise_row(line: Line) -> list[str]:
    """The columns of `NOISE` after the first."""
    meant = line["meant"]
    numbers = [_number(meant[key]) for key in ("eps", "gap")]
    inferred = meant["existence"] != "none"
    relations = [str(len(meant["relations"])), str(meant["independent"])] if inferred else ["", ""]
    moved = _number(meant["distance"]) if inferred else ""
    answer = _said(line["of_meant"]) if inferred else f"none inferred: {meant['reason']}"
    return [*numbers, *relations, moved, answer, _said(line["of_digits"])]


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.1e}"


def _said(line: Line) -> str:
    kind, said = kind_of(line)
    return said if kind == KINDS[0] else f"{kind}: {said}" if said else kind


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--against", metavar="COMMIT", help="an older program, run beside this one")
    parser.add_argument("--only", default="", help="only paths with this text")
    parser.add_argument("--keep", type=Path, default=Path("real-files"), help="where answers go")
    parser.add_argument("--csv", type=Path, metavar="FILE", help="write a row for each file")
    parser.add_argument("--noise", type=Path, metavar="FILE", help="write the inexact drawings")
    parser.add_argument("--limit", default=str(LIMIT), metavar="SECONDS", help="of each count")
    arguments = parser.parse_args()
    paths = [
        path
        for path in sorted(arguments.folder.rglob("*"))
        if path.suffix.lower().removeprefix(".") in READERS
        and path.is_file()
        and arguments.only in str(path)
    ]
    arguments.keep.mkdir(exist_ok=True)
    if arguments.noise:
        keep = arguments.keep / "noise.jsonl"
        print_noise(paths, arguments.folder, keep, arguments.noise, arguments.limit)
        return
    programs: dict[str, dict[str, Line]] = {}
    for heading, commit in (("before", arguments.against), ("now", None)):
        if heading == "now" or commit:
            kept = arguments.keep / f"{commit or 'now'}.jsonl"
            programs[heading] = answers(paths, arguments.folder, commit, kept, arguments.limit)
    print_summary(programs)
    if arguments.csv:
        write_files(programs, arguments.csv)


if __name__ == "__main__":
    main()
