"""exactfold against msolve, PHCpack and Macaulay2 on the same patterns, and against itself by size.

    python tests/benchmarks/peers.py [--sizes 4,6,8] [--own-sizes 10,12] [--branch-sizes 100,1000]
                                     [--seeds 1,2,3] [--timeout S] [--json | --markdown]
                                     [--profile] [--plain] [--from RESULTS.json]
                                     [--against COMMIT]

Patterns are random Delaunay squares. Every program is a process of its own, start included, with
one thread; what counts is the processor time of the process and its children, so that a busy
machine does little harm. Times are medians over the seeds, memory is the largest. Programs that are
not installed are skipped with a message. No answer is taken on trust: `peer_tasks.py` counts the
different solutions of each by the exact coefficients. A program that reaches the limit, or that
does not apply, is not asked for larger sizes.

With `--against`, commands of exactfold are compared with those of an older commit (`pairs.py`).
`--json` prints everything measured, with the commit; `--from` reads it again to print it otherwise.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pairs import name_of, paired
from peer_process import Usage, run
from peer_programs import PEERS
from peer_report import COMPLETE, INCOMPLETE, LIMIT, NOTHING, markdown, report

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
SETUP = 3600.0  # seconds for what is not measured

Line = dict[str, Any]

OWN = {
    "exactfold, certificate": "count",
    "exactfold, streaming": "stream",
    "exactfold, exact from roots": "parametrise",
    "exactfold, exact by lifting": "lifting",
}


class Bench:
    """Measures; `lines` holds one entry for every program, size and seed."""

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self.lines: list[Line] = []
        self.stopped: set[str] = set()

    def task(self, name: str, folder: Path, size: int, seed: int, limit: float = SETUP) -> Line:
        """A task of `peer_tasks.py`, which must not fail but may reach the limit."""
        script = str(HERE / "peer_tasks.py")
        used = run([sys.executable, script, name, str(size), str(seed)], folder, name, limit)
        if used.code:
            error = (folder / f"{name}.stderr").read_text(errors="replace")
            raise SystemExit(f"{name} {size} {seed} failed:\n{error}")
        text = (folder / f"{name}.stdout").read_text().strip()
        found = json.loads(text.splitlines()[-1]) if used.code == 0 else {}
        return {**found, **vars(used), "size": size, "seed": seed}

    def add(self, program: str, line: Line, expected: int) -> None:
        """Note what was measured, and whether it is all that was to be found."""
        right = line.get("found") == expected and line.get("same", True)
        if line["code"] is None:
            outcome = LIMIT
        elif line.get("found", 0) is None:
            outcome = NOTHING
        else:
            outcome = COMPLETE if right else INCOMPLETE
        if outcome in (LIMIT, NOTHING):
            self.stopped.add(program)
        self.lines.append({"program": program, **line, "expected": expected, "outcome": outcome})
        found = f", {line['found']} of {expected}" if outcome == INCOMPLETE else ""
        print(
            f"{program}, {line['size']} vertices, seed {line['seed']}: {line['cpu']:.2f} s, "
            f"{outcome}{found}",
            file=sys.stderr,
        )

    def own(
        self, program: str, task: str, folder: Path, size: int, seed: int, expected: int
    ) -> None:
        """One of exactfold's ways, unless it was too slow before."""
        if program not in self.stopped:
            self.add(program, self.task(task, folder, size, seed, self.limit), expected)

    def pattern(self, size: int, seed: int, binaries: dict[str, str | None]) -> None:
        """All programs on one pattern."""
        with tempfile.TemporaryDirectory() as name:
            folder, expected = Path(name), 1 << size
            self.task("export", folder, size, seed)
            for program, task in OWN.items():
                self.own(program, task, folder, size, seed, expected)
            for program, task, file in (
                ("check, standard library", "checker", "certificate.txt"),
                ("check, compact, floats", "", "compact.txt"),
            ):
                if not (folder / file).exists():
                    continue
                if not task:
                    self.own(program, "check", folder, size, seed, expected)
                elif program not in self.stopped:
                    command = [sys.executable, str(ROOT / "exactfold" / task), file]
                    used = run(command, folder, "checker", self.limit)
                    found = {"found": expected if used.code == 0 else 0}
                    self.add(program, {**found, **vars(used), "size": size, "seed": seed}, expected)
            self._peers(folder, size, seed, binaries, expected)

    def _peers(
        self, folder: Path, size: int, seed: int, binaries: dict[str, str | None], expected: int
    ) -> None:
        used: dict[str, Usage] = {}
        for peer in PEERS:
            binary = binaries.get(peer.name)
            if binary is None or peer.name in self.stopped:
                continue
            used[peer.name] = run(peer.command(binary), folder, peer.name, self.limit)
            if used[peer.name].code is None:
                (folder / peer.answer).unlink(missing_ok=True)
        if not used:
            return
        answers = self.task("judge", folder, size, seed)["answers"]
        for program, usage in used.items():
            answer = answers.get(program, {"found": 0})
            line = {**answer, **vars(usage), "size": size, "seed": seed}
            self.add(program, line, expected)

    def single(self, size: int, seed: int, plain: bool) -> None:
        """One branch on demand."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            self.task("export", folder, size, seed)
            self.own("one branch, exactfold", "branch", folder, size, seed, 1)
            if plain and (folder / "branch.npy").exists():
                self.own("one branch, plain splu", "plain", folder, size, seed, 1)

    def profiles(self, sizes: Sequence[int], branch_sizes: Sequence[int]) -> dict[str, Line]:
        """Where the time goes, at the largest sizes."""
        wanted = [
            ("count", max(sizes)),
            ("stream", max(sizes)),
            ("parametrise", min(8, max(sizes))),
        ]
        wanted += [("branch", max(branch_sizes))] if branch_sizes else []
        found = {}
        for task, size in wanted:
            with tempfile.TemporaryDirectory() as name:
                self.task("export", Path(name), size, 1)
                found[task] = self.task(f"profile_{task}", Path(name), size, 1)
        return found


def described(binaries: dict[str, str | None]) -> dict[str, str]:
    """Processor, memory and the versions of the peers."""
    found = {"processor": "unknown", "cores": str(os.cpu_count())}
    for file, key, name in (
        ("/proc/cpuinfo", "model name", "processor"),
        ("/proc/meminfo", "MemTotal", "memory"),
    ):
        if os.path.exists(file):
            lines = Path(file).read_text(encoding="utf-8").splitlines()
            values = [line.partition(":")[2].strip() for line in lines if line.startswith(key)]
            found[name] = values[0] if values else "unknown"
    if found.get("memory", "").endswith(" kB"):
        found["memory"] = f"{int(found['memory'][:-3]) / (1 << 20):.0f} GB"
    for peer in PEERS:
        binary = binaries[peer.name]
        if binary is not None:
            done = subprocess.run(peer.version(binary), capture_output=True, text=True, check=False)
            words = (done.stdout + done.stderr).split()
            found[peer.name] = next((w for w in words if any(c.isdigit() for c in w)), "unknown")
    return found


def measured(arguments: argparse.Namespace) -> dict[str, Any]:
    """Everything that was asked for."""
    bench = Bench(arguments.timeout)
    with tempfile.TemporaryDirectory() as name:
        known = bench.task("machine", Path(name), 0, 0)
    binaries = known["binaries"]
    for peer in PEERS:
        if binaries[peer.name] is None:
            print(f"{peer.name} is not installed and skipped: {peer.package}", file=sys.stderr)
    nobody = dict.fromkeys(binaries)
    for size in sorted({*arguments.sizes, *arguments.own_sizes}):
        for seed in arguments.seeds:
            bench.pattern(size, seed, binaries if size in arguments.sizes else nobody)
    for size in sorted(arguments.branch_sizes):
        for seed in arguments.seeds:
            bench.single(size, seed, arguments.plain)
    every = [*arguments.sizes, *arguments.own_sizes]
    return {
        "command": " ".join(["python tests/benchmarks/peers.py", *arguments.given]),
        "machine": described(binaries) | known["versions"],
        "missing": {p.name: p.package for p in PEERS if binaries[p.name] is None},
        "commit": name_of("HEAD"),
        "pairs": paired(arguments.against, 3) if arguments.against else [],
        "limit": arguments.timeout,
        "seeds": arguments.seeds,
        "start": known["cpu"],
        "lines": bench.lines,
        "profiles": bench.profiles(every, arguments.branch_sizes) if arguments.profile else {},
    }


def _numbers(text: str) -> list[int]:
    return [int(part) for part in text.split(",") if part]


def parsed(given: list[str]) -> argparse.Namespace:
    """The command line; what only shapes the output is left out of `given`."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--sizes", type=_numbers, default=[4, 6, 8], help="for all programs")
    parser.add_argument("--own-sizes", type=_numbers, default=[], help="for exactfold alone")
    parser.add_argument("--branch-sizes", type=_numbers, default=[], help="one branch on demand")
    parser.add_argument("--seeds", type=_numbers, default=[1, 2, 3])
    parser.add_argument("--timeout", type=float, default=300.0, help="seconds for each program")
    parser.add_argument("--plain", action="store_true", help="one branch by plain SciPy as well")
    parser.add_argument("--profile", action="store_true", help="where the time goes")
    parser.add_argument("--against", metavar="COMMIT", help="an older program, run in turns")
    parser.add_argument("--json", action="store_true", help="print everything measured")
    parser.add_argument("--markdown", action="store_true", help="print docs/benchmarks.md")
    parser.add_argument("--from", dest="source", type=Path, help="print results of --json again")
    arguments = parser.parse_args(given)
    arguments.given = [word for word in given if word not in ("--json", "--markdown")]
    return arguments


def main(given: list[str]) -> None:
    """Measure, or read what was measured, and print it."""
    arguments = parsed(given)
    if arguments.source:
        results = json.loads(arguments.source.read_text(encoding="utf-8"))
    else:
        results = measured(arguments)
    if arguments.json:
        print(json.dumps(results, indent=1))
    else:
        print(markdown(results) if arguments.markdown else report(results))


if __name__ == "__main__":
    main(sys.argv[1:])
