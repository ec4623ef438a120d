"""All branches by size, whole commands in processes of their own: one table.

    python tests/benchmarks/scale_table.py --sizes 8 10 12 --seeds 1 2 3 --workers 2

Medians over the seeds. `solve` and `certify` are processor seconds of all workers, `count` and
`check` seconds by the clock, from the start of the interpreter to its end, `cpu` the processor
seconds of both commands with their workers, `exact` the roots that needed integers. `memory` is
the largest process of any run; there is one more process than workers. `growth` is the factor a
vertex, from one line to the next, in the processor time of solving and certifying.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import Any

COUNT = """
import json, sys
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.branches.counting.stream import stream_branches
if __name__ == "__main__":
    n, seed, workers = map(int, sys.argv[2:])
    result = stream_branches(random_square(n, seed=seed), sys.argv[1], workers=workers)
    spent = result.cpu_seconds
    print(json.dumps({"status": str(result.status), "exact": result.exact,
                      "solve": spent["solve"],
                      "certify": spent["certify"] + spent["exactly"]}))
"""
CHECK = """
import sys
from exactfold.branches.certificates.check import check_compact
if __name__ == "__main__":
    print(check_compact(sys.argv[1], workers=int(sys.argv[2]), fast=sys.argv[3] == "fast")["real"])
"""
COLUMNS = ("Vi", "solve", "certify", "exact", "count s", "check s", "cpu s", "file MB", "memory MB")


def run(script: Path, *arguments: object) -> tuple[str, float, float, float]:
    """Output, seconds by the clock, processor seconds and the largest process in MB."""
    start = time.perf_counter()
    command = [sys.executable, str(script), *map(str, arguments)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        output = process.stdout.read() if process.stdout else ""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{command} failed")
    elapsed = time.perf_counter() - start
    return output, elapsed, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def measured(folder: Path, n: int, seed: int, workers: int, check: str) -> dict[str, Any]:
    """One pattern: counted, written and checked."""
    path = folder / f"{n}-{seed}.txt"
    text, count, cpu, memory = run(folder / "count_it.py", path, n, seed, workers)
    found = json.loads(text)
    if found["status"] != "proved":
        raise SystemExit(f"random square {n}, seed {seed}: {found}")
    line = {**found, "count": count, "check": float("nan"), "cpu": cpu, "memory": memory}
    line["size"] = path.stat().st_size / 1e6
    if check != "none":
        text, line["check"], more, memory = run(folder / "check_it.py", path, workers, check)
        if int(text) != 1 << n:
            raise SystemExit(f"random square {n}, seed {seed}: the check found {text}")
        line["cpu"] += more
        line["memory"] = max(line["memory"], memory)
    path.unlink()
    return line


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[8, 10, 12])
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--check", choices=("fast", "exact", "none"), default="fast")
    arguments = parser.parse_args()
    print(" ".join(f"{name:>9}" for name in (*COLUMNS, "growth")))
    before: tuple[int, float] | None = None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "count_it.py").write_text(COUNT, encoding="utf-8")
        (folder / "check_it.py").write_text(CHECK, encoding="utf-8")
        for n in arguments.sizes:
            lines = [
                measured(folder, n, seed, arguments.workers, arguments.check)
                for seed in arguments.seeds
            ]
            keys = ("solve", "certify", "exact", "count", "check", "cpu", "size")
            values = [median(line[key] for line in lines) for key in keys]
            values.append(max(line["memory"] for line in lines))
            work = values[0] + values[1]
            growth = "" if before is None else f"{(work / before[1]) ** (1 / (n - before[0])):.2f}"
            before = (n, work)
            cells = [f"{value:9.2f}" for value in values]
            print(f"{n:>9}", *cells, f"{growth:>9}", flush=True)


if __name__ == "__main__":
    main()
