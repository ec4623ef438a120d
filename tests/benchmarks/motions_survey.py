"""Whole graphs of true motions of random squares, with certificates: a line for each size.

    python tests/benchmarks/motions_survey.py --sizes 4 5 --seeds 0 50

Of `random_square(n, seed)` for the seeds of a range: all loops and the arcs on no loop, proved by
`find_loops`, and the certificate, verified by the stand-alone checker. Columns: `sheets`; `proved`
matchings and `graphs`; `loops`, those `open`, and those `through` nodes; `nodes` and `arcs` of the
graphs, and `closed` curves that do not come to the flat state; `valid` certificates and those that
are `complete`; processor seconds of the proofs and of the `checks`. Every sheet has a line above
the table, and what is not proved one with its reason.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections import Counter
from pathlib import Path

from exactfold import checker, random_square
from exactfold._support.verdict import PROVED
from exactfold.motion import find_loops

COLUMNS = (
    "sheets", "proved", "graphs", "loops", "open", "through", "nodes", "arcs", "closed", "valid",
    "complete", "seconds", "checks",
)  # fmt: skip


def surveyed(n: int, seed: int, folder: Path) -> Counter[str]:
    """What one sheet adds to the columns; prints what is not proved of it."""
    file = folder / f"{n}-{seed}.txt"
    began = time.process_time()
    found = find_loops(random_square(n, seed=seed), certificate=file)
    proved = time.process_time()
    total = Counter({"sheets": 1, "loops": len(found.loops)})
    try:
        claims = checker.verify(file)
    except checker.CertificateError as error:
        print(f"random_square({n}, seed={seed}): REFUSED: {error}", flush=True)
    else:
        total |= Counter({"valid": 1, "complete": int(claims["complete"])})
        if claims["matched"] != len(found.matching):
            raise ArithmeticError("the certificate matches other rays")
    total["proved"] += found.status is PROVED
    total["graphs"] += found.graph.status is PROVED
    total["open"] += sum(loop.target is None for loop in found.loops)
    total["through"] += sum(bool(loop.through) for loop in found.loops)
    total["nodes"] += len(found.graph.nodes)
    total["arcs"] += len(found.graph.arcs)
    total["closed"] += len(found.graph.closed_curves)
    total["ms"] += round((proved - began) * 1000)
    total["check ms"] += round((time.process_time() - proved) * 1000)
    reasons = [found.reason, *(loop.reason for loop in found.loops), *found.skipped.values()]
    reasons += [found.graph.reason, *(arc.reason for arc in found.graph.arcs)]
    for reason, times in Counter(filter(None, reasons)).items():
        print(f"random_square({n}, seed={seed}): {reason} ({times})", flush=True)
    file.unlink()
    facts = ", ".join(f"{name} {total[name]}" for name in (*COLUMNS[1:-2], "ms", "check ms"))
    print(f"random_square({n}, seed={seed}): {facts}", flush=True)
    return total


def main() -> None:
    """Print what is open, and the table."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=[4, 5])
    parser.add_argument("--seeds", type=int, nargs=2, default=[0, 50], metavar=("FROM", "TO"))
    given = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for n in given.sizes:
            total: Counter[str] = Counter()
            for seed in range(*given.seeds):
                total += surveyed(n, seed, Path(folder))
            total["seconds"] = round(total["ms"] / 1000)
            total["checks"] = round(total["check ms"] / 1000)
            rows.append([n, *(total[name] for name in COLUMNS)])
    print("| n |", " | ".join(COLUMNS), "|")
    print("|--:|" + "--:|" * len(COLUMNS))
    for row in rows:
        print("|", " | ".join(map(str, row)), "|")


if __name__ == "__main__":
    main()
