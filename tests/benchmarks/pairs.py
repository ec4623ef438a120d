"""Two commits on the same commands, in turns, in one run: processor time and ratios.

    python tests/benchmarks/pairs.py COMMIT [--rounds 3] [--only TEXT] [--long] [--limit S]
                                     [--keep FILE.jsonl | --from FILE.jsonl] [--markdown]

Each command runs in this program and in that of COMMIT, one after the other, in each round, so that
a busy machine slows both. What counts is the processor time of the process and its children, start
included. A round that ends with another exit code than in the other program is marked, and one
that was stopped after `--limit` seconds has a `>`. `--long` takes commands that people wait for.
Each measurement is appended to `--keep` as a line of JSON with its commit; `--from` prints the last
run there against COMMIT again, and measures nothing, as only times of one run can be compared.
`peers.py --against COMMIT` runs the same beside the other programs.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from peer_process import run
from peer_report import as_markdown, as_text, pair_table
from real_files import HERE, program

from exactfold.branches.counting.find import BranchFinder
from exactfold.motion import find_loops
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.pattern.writing.fold_writing import write_fold
from exactfold.pattern.writing.panel_writing import converted

sys.path.append(str(HERE / "tests" / "panels"))
from panel_sheets import ring

LIMIT = 300.0
SEED = 7000
"""Seeds from here on are in no test."""

Line = dict[str, Any]


def commands(folder: Path) -> dict[str, Callable[[], list[str]]]:
    """By name, what makes the arguments of `exactfold`, with the files that they name."""

    def square(n: int, k: int = 0) -> tuple[str, CreasePattern]:
        sheet = sample_random_square(n, SEED + k, redraw=n > 20).pattern
        path = folder / f"square-{n}-{k}.fold"
        write_fold(sheet, path)
        return str(path), sheet

    def matched(k: int) -> list[str]:
        path, sheet = square(20, k)
        return ["match", path, "--letters", half_letters(sheet, SEED + k), "--json"]

    def loops(n: int) -> str:
        path = folder / f"loops-{n}.txt"
        find_loops(sample_random_square(n, SEED).pattern, certificate=path)
        return str(path)

    stream = ["--stream", "{out}/stream.txt", "--workers", "1"]
    drawn = ["--interior", "20000", "--seed", str(SEED), "--redraw", "-o", "{out}/sheet.fold"]
    return {
        "--help": lambda: ["--help"],
        "count two-vertex": lambda: ["count", "two-vertex"],
        "count zigzags": lambda: ["count", "zigzags"],
        "count bird-base": lambda: ["count", "bird-base"],
        "count, 10 vertices": lambda: ["count", square(10)[0], "--json"],
        "count --stream, 16 vertices": lambda: ["count", square(16)[0], *stream],
        "branch, 1000 vertices": lambda: ["branch", square(1000)[0], "--up", "4", "--json"],
        "branch, 20000 vertices": lambda: ["branch", square(20000)[0], "--up", "4", "--json"],
        "random, 20000 vertices redrawn": lambda: ["random", *drawn],
        "motions, 3 vertices": lambda: ["motions", square(3)[0], "--workers", "1"],
        "check, loops of 4 vertices": lambda: ["check", loops(4)],
        "fold miura": lambda: ["fold", "miura"],
        "view waterbomb": lambda: ["view", "waterbomb", "-o", "{out}/view.html"],
        **{
            f"match, half of the letters of 20 vertices, sheet {k}": partial(matched, k)
            for k in range(4)
        },
    }


def long_commands(folder: Path) -> dict[str, Callable[[], list[str]]]:
    """The same for commands that take from seconds to many minutes."""

    def square(n: int) -> str:
        path = folder / f"square-{n}.fold"
        if not path.exists():
            write_fold(sample_random_square(n, SEED, redraw=n > 20).pattern, path)
        return str(path)

    def ringed(k: int) -> list[str]:
        path = folder / f"ring-{k}.fold"
        path.write_text(json.dumps(converted(Opened(ring(SEED + k))).document()))
        return ["count", str(path), "--json"]

    def loops(n: int) -> list[str]:
        return ["motions", square(n), "--workers", "1", "--json", "--certificate", "{out}/loops"]

    def checked(n: int) -> list[str]:
        path = folder / f"loops-{n}.txt"
        find_loops(sample_random_square(n, SEED).pattern, certificate=path)
        return ["check", str(path)]

    def drawn(n: int) -> list[str]:
        return ["random", "--interior", str(n), "--seed", str(SEED), "-o", "{out}/sheet.fold"]

    return {
        **{f"count, ring of ten panels {k}": partial(ringed, k) for k in range(4)},
        "random, 1000 vertices, not redrawn": lambda: drawn(1000),
        "random, 100000 vertices redrawn": lambda: [*drawn(100_000), "--redraw"],
        "branch, 100000 vertices": lambda: ["branch", square(100_000), "--up", "4", "--json"],
        **{f"motions, {n} vertices": partial(loops, n) for n in (6, 8, 10)},
        "check, loops of 6 vertices": lambda: checked(6),
    }


def half_letters(sheet: CreasePattern, seed: int) -> str:
    """The letters of a branch at half of the folds, chosen at random; the others are free."""
    rng = random.Random(seed)
    finder = BranchFinder(sheet)
    branch = finder.find({v: rng.choice((1, -1)) for v in finder.poppable})
    kept = set(rng.sample(range(len(sheet.folds)), len(sheet.folds) // 2))
    return "".join(x if k in kept else "U" for k, x in enumerate(branch.assignment_text))


def name_of(commit: str) -> str:
    """The short name of a commit, and whether files of the working tree differ from it."""
    git = ["git", "-C", str(HERE)]
    short = subprocess.check_output([*git, "rev-parse", "--short=8", commit], text=True).strip()
    changed = commit == "HEAD" and subprocess.run([*git, "diff", "--quiet", "HEAD"], check=False)
    return f"{short}+" if changed and changed.returncode else short


def paired(
    commit: str,
    rounds: int,
    only: str = "",
    keep: Path | None = None,
    long: bool = False,
    limit: float = LIMIT,
) -> list[Line]:
    """For every command of both programs: the processor seconds of each round, and exit codes.

    Long commands are not run once before they are measured.
    """
    lines: list[Line] = []
    with program(commit) as old, tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        sources = {name_of(commit): old, name_of("HEAD"): HERE}
        for name, made in (long_commands if long else commands)(folder).items():
            if only not in name:
                continue
            arguments = made()
            both = [
                {"command": name, "commit": at, "cpu": [], "memory": 0.0, "code": set()}
                for at in sources
            ]
            for turn in range(long, rounds + 1):  # the turn 0 compiles and is not counted
                for line, source in zip(both, sources.values(), strict=True):
                    out = Path(tempfile.mkdtemp(dir=folder))
                    words = [word.format(out=out) for word in arguments]
                    command = [sys.executable, "-m", "exactfold", *words]
                    used = run(command, out, "it", limit, source)
                    line["code"].add(used.code)
                    if turn:
                        line["cpu"].append(round(used.cpu, 3))
                        line["memory"] = max(line["memory"], round(used.memory))
            for line in both:
                line["code"] = sorted(line["code"], key=str)
                line["date"] = time.strftime("%Y-%m-%d")
                lines.append(line)
                if keep is not None:
                    with keep.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(line) + "\n")
            print(*pair_table(both)[-1], sep="  ", file=sys.stderr, flush=True)
    return lines


def remembered(commit: str, kept: Path) -> list[Line]:
    """The last measurement of each command against a commit, by the newest of all programs."""
    lines = [json.loads(line) for line in kept.read_text(encoding="utf-8").splitlines()]
    pairs = [
        (old, new)
        for old, new in zip(lines[::2], lines[1::2], strict=True)
        if commit.startswith(old["commit"]) or old["commit"].startswith(commit)
    ]
    if not pairs:
        raise SystemExit(f"{kept} has no measurement against {commit}")
    newest = pairs[-1][1]["commit"]
    last = {old["command"]: (old, new) for old, new in pairs if new["commit"] == newest}
    return [line for pair in last.values() for line in pair]


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("commit")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", default="", help="only commands with this text")
    parser.add_argument("--long", action="store_true", help="commands that people wait for")
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds by the clock")
    parser.add_argument("--keep", type=Path, help="a file of JSON lines that grows")
    parser.add_argument("--from", type=Path, dest="kept", help="print what such a file holds")
    parser.add_argument("--markdown", action="store_true")
    given = parser.parse_args()
    if given.kept is not None:
        lines = [x for x in remembered(given.commit, given.kept) if given.only in x["command"]]
    else:
        lines = paired(given.commit, given.rounds, given.only, given.keep, given.long, given.limit)
    rows = pair_table(lines)
    print(as_markdown(rows) if given.markdown else as_text(rows))


if __name__ == "__main__":
    main()
