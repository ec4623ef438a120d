"""Two commits on the same commands, in turns, in one run: processor time and ratios.

    python tests/benchmarks/pairs.py COMMIT [--rounds 3] [--only TEXT] [--keep FILE.jsonl]
                                     [--markdown]

Each command runs in this program and in that of COMMIT, one after the other, in each round, so that
a busy machine slows both. What counts is the processor time of the process and its children, start
included. A round that ends with another exit code than in the other program is marked. Each
measurement is appended to `--keep` as a line of JSON with its commit, so that runs of other days
can be looked up; compare only times of one run. `peers.py --against COMMIT` runs the same beside
the other programs.
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
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.pattern.writing.fold_writing import write_fold

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


def paired(commit: str, rounds: int, only: str = "", keep: Path | None = None) -> list[Line]:
    """For every command of both programs: the processor seconds of each round, and exit codes."""
    lines: list[Line] = []
    with program(commit) as old, tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        sources = {name_of(commit): old, name_of("HEAD"): HERE}
        for name, made in commands(folder).items():
            if only not in name:
                continue
            arguments = made()
            both = [
                {"command": name, "commit": at, "cpu": [], "memory": 0.0, "code": set()}
                for at in sources
            ]
            for turn in range(rounds + 1):  # the first compiles and is not counted
                for line, source in zip(both, sources.values(), strict=True):
                    out = Path(tempfile.mkdtemp(dir=folder))
                    words = [word.format(out=out) for word in arguments]
                    command = [sys.executable, "-m", "exactfold", *words]
                    used = run(command, out, "it", LIMIT, source)
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


def main() -> None:
    """Measure, and print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("commit")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", default="", help="only commands with this text")
    parser.add_argument("--keep", type=Path, help="a file of JSON lines that grows")
    parser.add_argument("--markdown", action="store_true")
    given = parser.parse_args()
    rows = pair_table(paired(given.commit, given.rounds, given.only, given.keep))
    print(as_markdown(rows) if given.markdown else as_text(rows))


if __name__ == "__main__":
    main()
