"""Read every drawing below a folder, and print what was read or refused, file by file and in sum.

python tests/benchmarks/real_files.py FOLDER
"""

from __future__ import annotations

import argparse
import time
from collections import Counter
from pathlib import Path

from exactfold.drawing.read import READERS, read_drawing
from exactfold.errors import InputError


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--remarks", action="store_true", help="print the remarks of each file")
    arguments = parser.parse_args()
    outcomes: Counter[tuple[str, str]] = Counter()
    slowest = (0.0, "")
    for path in sorted(arguments.folder.rglob("*")):
        ending = path.suffix.lower().removeprefix(".")
        if ending not in READERS or not path.is_file():
            continue
        began = time.perf_counter()
        try:
            drawing = read_drawing(path)
        except InputError as error:
            outcome, told, remarks = type(error).__name__, f"refused {path.name}: {error}", ()
        else:
            outcome, told, remarks = "read", drawing.source, drawing.remarks
        slowest = max(slowest, (time.perf_counter() - began, path.name))
        outcomes[ending, outcome] += 1
        print(told)
        for remark in remarks if arguments.remarks else ():
            print(f"    {remark}")
    print("\n| format | outcome | files |\n|---|---|---|")
    for (ending, outcome), number in sorted(outcomes.items()):
        print(f"| {ending} | {outcome} | {number} |")
    total = sum(outcomes.values())
    read = sum(number for (_, outcome), number in outcomes.items() if outcome == "read")
    print(f"| all | read | {read} of {total} |")
    print(f"\nslowest: {slowest[1]}, {slowest[0]:.2f} s")


if __name__ == "__main__":
    main()
