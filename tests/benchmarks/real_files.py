"""Count every crease pattern below a folder, and print what was read, answered and proved.

python tests/benchmarks/real_files.py FOLDER [--only TEXT]

Every file is a process of its own, ended after 60 seconds. The last table is one of docs/panels.md.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

from exactfold.pattern.drawing.formats.read import READERS

LIMIT = 60
KINDS = (
    "rigid, proved",
    "all ways to fold, proved",
    "all motions to second order, proved",
    "facts and UNDECIDED",
    "refused",
    f"not ended in {LIMIT} s",
    "defect",
)


def counted(path: Path) -> tuple[str, str]:
    """The kind of answer, and what it says."""
    command = [sys.executable, "-m", "exactfold", "count", str(path), "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT, check=False)
    except subprocess.TimeoutExpired:
        return KINDS[5], ""
    if done.returncode == 3:
        return KINDS[4], done.stderr.strip().splitlines()[-1]
    if done.returncode not in (0, 4):
        return KINDS[6], f"exit code {done.returncode}: {done.stderr.strip()[-200:]}"
    return answer(json.loads(done.stdout))


def answer(result: dict[str, Any]) -> tuple[str, str]:
    """The kind of a result, and its components."""
    components = result["components"] or {}
    theory = result["theory"]
    if result["rigid"]:
        return KINDS[0], theory
    if result["status"] == "proved" and (theory == "branches" or components["true"]):
        return KINDS[1], f"{theory} {components.get('true') or result['distinct']}"
    if result["status"] == "proved":
        return KINDS[2], f"{theory} {components['second_order']}"
    return KINDS[3], result["reason"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", default="", help="only paths with this text")
    arguments = parser.parse_args()
    kinds: Counter[str] = Counter()
    formats: Counter[tuple[str, str]] = Counter()
    for path in sorted(arguments.folder.rglob("*")):
        ending = path.suffix.lower().removeprefix(".")
        if ending not in READERS or not path.is_file() or arguments.only not in str(path):
            continue
        began = time.perf_counter()
        kind, said = counted(path)
        kinds[kind] += 1
        formats[ending, "refused" if kind == KINDS[4] else "read"] += 1
        print(f"{time.perf_counter() - began:5.1f} s  {kind}  {path.name}: {said}", flush=True)
    print("\n| answer | files |\n|---|---:|")
    for kind in KINDS:
        print(f"| {kind} | {kinds[kind]} |")
    print("\n| format | outcome | files |\n|---|---|---:|")
    for (ending, outcome), number in sorted(formats.items()):
        print(f"| {ending} | {outcome} | {number} |")


if __name__ == "__main__":
    main()
