"""Both checkers on the same files: the one in Python, and the one from the formal proof.

    python tests/benchmarks/compare_checkers.py PROGRAM [--mutations N] [--seed S] [--keep FOLDER]

The files are all certificates that forgeries in `tests/checker/branches` give to the checker in
Python, and N random changes of the stored certificates. What is printed is how often
each pair of verdicts occurs, and, where the verdicts differ, for what reasons. Exit code 1 if
one refuses a file that the other accepts for a reason that is not in `EXPLAINED`.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from exactfold import checker
from exactfold.checker.branches import compact
from exactfold.checker.core.lines import digest

ROOT = Path(__file__).resolve().parents[2]
FORGERIES = [
    str(ROOT / "tests" / "checker" / "branches" / f"test_{name}.py")
    for name in (
        *("branch_checker", "compact_checker", "forged_blocks"),
        *("forged_branches", "forged_compact", "forged_heights", "evidence_refused"),
        *("forged_classes", "forged_kinds", "forged_listings", "forged_roots"),
    )
]
STORED = ROOT / "tests" / "fixtures" / "certificates"
READ = {
    *(("exactfold branch", 1), ("exactfold certificate", 2)),
    *(("exactfold compact certificate", 1), ("exactfold compact certificate", 2)),
}
BRANCH = ("vertex_signs", "assignment", "multiplicity", "representative")
Documents = list[dict[str, Any]]

EXPLAINED = {
    "heights and radii are proposals to the program": (
        r"Krawczyk's test fails for the box|K is not positive at vertex|the radius is not positive"
    ),
    "the program says that it does not verify the distance": "the distance is larger than claimed",
    "the program says that it does not verify letters F": (
        r"root \d+: folds are|is not known to be 'F'"
    ),
    "the program says that it does not verify signs without letters": "does not have the claimed",
    "the program does not use multipliers": "multipliers|not definite|pivot",
    "the program reads the chart of the closed notch only": "the chart does not name the side",
    "a vertex is named twice inside a triangle": "triangulated triangles are not those of the",
    "a sheet without vertices inside has one fold": "four boundary vertices and an interior vertex",
}
"""Why one may accept what the other refuses: the program proves claims by evidence of its own."""


# --- files ---------------------------------------------------------------------------------------


def written(folder: Path, content: bytes, ending: str) -> None:
    (folder / (hashlib.sha256(content).hexdigest()[:16] + ending)).write_bytes(content)


def chained(parts: Documents) -> bytes:
    last, data = "", ""
    for part in parts:
        text = json.dumps(part, separators=(",", ":"))
        last = digest(last, text)
        data += f"{text}\t{last}\n"
    return data.encode()


class Recorder:
    """A plugin of pytest that writes down what the tests give to the checker."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def pytest_sessionstart(self) -> None:
        import forge

        folder, of_object, of_lines, of_file = (
            self.folder,
            forge.verified,
            forge.verified_lines,
            compact.check,
        )

        def verified(document: Any) -> Any:
            written(folder, json.dumps(document).encode(), ".json")
            return of_object(document)

        def verified_lines(data: Any) -> Any:
            written(folder, data if isinstance(data, bytes) else chained(data), ".txt")
            return of_lines(data)

        def check(path: str, *others: Any) -> Any:
            written(folder, Path(path).read_bytes(), ".txt")
            return of_file(path, *others)

        forge.verified, forge.verified_lines, compact.check = verified, verified_lines, check


def record(folder: Path) -> int:
    """The tests that forge certificates of branches, with every file that they make."""
    code = pytest.main(
        ["-q", "-m", "not survey", "-p", "no:cacheprovider", *FORGERIES], [Recorder(folder)]
    )
    return int(code)


def nodes(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    yield path
    keys = value if isinstance(value, dict) else range(len(value)) if type(value) is list else ()
    for key in keys:
        yield from nodes(value[key], (*path, key))


def other(value: Any, rng: random.Random) -> Any:
    """Something like it, but not it."""
    if isinstance(value, str) and value:
        place = rng.randrange(len(value))
        pool = "0123456789-/" if re.fullmatch(r"[-0-9/]+", value) else "MVFUabAB01+/="
        return value[:place] + rng.choice(pool) + value[place + 1 :]
    if type(value) is int:
        return value + rng.choice((-1, 1, -value, 7))
    if isinstance(value, list) and value:
        changed = value.copy()
        kind = rng.randrange(3)
        if kind == 0:
            changed.pop(rng.randrange(len(changed)))
        elif kind == 1:
            changed.append(rng.choice(changed))
        else:
            rng.shuffle(changed)
        return changed
    return rng.choice((None, 0, "0", [], {}))


def mutated(parts: Documents, rng: random.Random) -> Documents:
    """One node changed, taken out or exchanged with another of its kind."""
    made: Documents = json.loads(json.dumps(parts))
    places = [p for p in nodes(made) if len(p) > 1 and "provenance" not in p]
    path = rng.choice(places)
    parent: Any = made
    for key in path[:-1]:
        parent = parent[key]
    if isinstance(parent, dict) and rng.random() < 0.05:
        del parent[path[-1]]
    else:
        parent[path[-1]] = other(parent[path[-1]], rng)
    return made


def mutate(folder: Path, count: int, seed: int) -> None:
    rng = random.Random(seed)
    stored: list[tuple[str, Documents]] = []
    for path in sorted(STORED.iterdir()):
        if path.name.startswith(("branch-", "compact-", "listing-", "algebraic-")):
            texts = path.read_text(encoding="utf-8").splitlines()
            parts = [json.loads(t.partition("\t")[0]) for t in texts]
            if (parts[0]["format"], parts[0]["version"]) in READ:
                stored.append((path.suffix, parts))
    for _ in range(count):
        ending, parts = rng.choice(stored)
        made = mutated(parts, rng)
        content = chained(made) if ending == ".txt" else json.dumps(made[0]).encode()
        written(folder, content, ending)


# --- verdicts ------------------------------------------------------------------------------------


def in_python(path: Path) -> tuple[str, str]:
    try:
        checker.verify(str(path))
    except (checker.CertificateError, checker.FormatError) as error:
        return "refused", str(error)
    return "accepted", ""


def natively(program: Path, path: Path) -> tuple[str, str]:
    done = subprocess.run([program, path], capture_output=True, text=True, check=False)
    said = (done.stdout + done.stderr).strip().splitlines()
    reason = next((t for t in said if t.startswith(("INVALID", "NOT VERIFIED"))), said[-1])
    verdict = {0: "accepted", 1: "refused", 3: "not read"}.get(done.returncode, "defect")
    return verdict, reason.removeprefix(f"exactfold-verify: {path}: ")


def masked(text: str) -> str:
    return re.sub(r"-?\d+(/\d+)?", "#", text)[:90]


def listed(path: Path) -> str | None:
    """The sheet of a listing with all claims about it, without the evidence."""
    try:
        texts = path.read_text(encoding="utf-8").splitlines()
        first, *more = [json.loads(text.partition("\t")[0]) for text in texts]
        if first["version"] != 2 or first["format"] not in {kind for kind, _ in READ}:
            return None
        *blocks, last = more or [first]
        branches = last["claims"].pop("branches", [])
        branches += [entry for block in blocks for entry in block["roots"]]
        kept = [[branch[key] for key in BRANCH] for branch in branches]
        return json.dumps([first["pattern"], last["claims"], kept], sort_keys=True)
    except (ValueError, KeyError, TypeError, AttributeError):
        return None


def explanation(said: str) -> str | None:
    return next((why for why, form in EXPLAINED.items() if re.search(form, said)), None)


def compare(program: Path, paths: list[Path]) -> int:
    """Print the table; the number of differences that nothing explains."""
    table: Counter[tuple[str, str]] = Counter()
    reasons: Counter[tuple[str, str, str]] = Counter()
    unexplained: list[tuple[Path, str]] = []
    verdicts = {path: in_python(path) for path in paths}
    true = {listed(path) for path in STORED.iterdir()}
    true |= {listed(path) for path, (python, _) in verdicts.items() if python == "accepted"}
    for path, (python, said) in verdicts.items():
        native, reason = natively(program, path)
        if "are verified here" in reason:
            native = "another kind"
        table[python, native] += 1
        if native == "defect":
            unexplained.append((path, reason))
        elif (python, native) == ("accepted", "not read"):
            reasons[python, native, masked(reason)] += 1
        elif "accepted" in (python, native) and python != native != "another kind":
            why = explanation(said or reason)
            if why is None and native == "accepted" and (listed(path) or "") in true:
                why = "the evidence is damaged, the claims are those of a certificate that verifies"
            reasons[python, native, why or masked(said or reason)] += 1
            if why is None:
                unexplained.append((path, said or reason))
    for (python, native), count in sorted(table.items()):
        print(f"{count:6}  Python: {python:8}  exactfold-verify: {native}")
    for (python, native, why), count in reasons.most_common():
        print(f"{count:6}  {python} / {native}: {why}")
    for path, why in unexplained[:20]:
        print(f"NOT EXPLAINED {path.name}: {why}")
    return len(unexplained)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--mutations", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, help="a folder for the files, read if it has some")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        base = given.keep or Path(made)
        forged, changed = base / "forged", base / "changed"
        if not forged.exists():
            forged.mkdir(parents=True)
            if record(forged):
                print("a test failed: the files may not be all")
        if not changed.exists():
            changed.mkdir(parents=True)
            mutate(changed, given.mutations, given.seed)
        left = 0
        for name, folder in (("forgeries of the tests", forged), ("random changes", changed)):
            paths = sorted(folder.iterdir())
            print(f"{name}: {len(paths)} files")
            left += compare(given.program.resolve(), paths)
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
