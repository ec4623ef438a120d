"""Mutants of the checker: whether its tests notice a line that is weakened.

    python tests/benchmarks/mutate_checker.py refusals [MODULE ...]
    python tests/benchmarks/mutate_checker.py mutmut [MODULE ...]
    python tests/benchmarks/mutate_checker.py survivors

`refusals` takes out, one at a time, each line of `exactfold/checker` that refuses something, and
runs the tests of its module, then all quick tests of the checker. `mutmut` makes the mutants of
mutmut (3.8, to be installed by hand) and runs those that `worth_running` leaves; `survivors` prints
what both have left. Everything happens in a copy of the project (`--folder`). What was found is
explained in docs/mutation.md.
"""

from __future__ import annotations

import argparse
import ast
import difflib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path("exactfold", "checker")
TESTS = {
    "arithmetic": "linear polynomials reading flat_folds",
    "checker_krawczyk": "krawczyk boxes",
    "sheets_refused": "sheet",
    "forged_listings": "listing reading",
    "forged_boxes": "boxes equations",
    "forged_triangles": "stress",
    "forged_classes": "algebraic classes flat_sheets",
    "forged_compact": "compact compact_lines command",
    "forged_blocks": "compact_blocks",
    "forged_branches": "branch branch_proof command",
    "recognised": "command",
    "fixtures": "",
}
"""Quick tests, which need no other process, and the modules for which each is the first to run."""

CONFIG = """[mutmut]
source_paths=exactfold
only_mutate=exactfold/checker/*.py
do_not_mutate=exactfold/checker/__main__.py
pytest_add_cli_args=
    -q
    -x
    -p
    no:cacheprovider
pytest_add_cli_args_test_selection=
{tests}
timeout_multiplier=6
timeout_constant=10
track_dependencies=false
use_git_change_detection=false
"""


def files_of(module: str) -> list[str]:
    """The files of the quick tests, those of a module first."""
    first = sorted(TESTS, key=lambda name: module not in TESTS[name].split())
    return [f"tests/checker/test_{name}.py" for name in first]


def modules(chosen: list[str]) -> list[str]:
    """The modules asked for, or all."""
    found = sorted(path.stem for path in (ROOT / PACKAGE).glob("*.py"))
    return chosen or [name for name in found if not name.startswith(("_", "exactfold"))]


def copy(folder: Path) -> None:
    """The project in a folder of its own."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in ("exactfold", "tests"):
        shutil.rmtree(folder / name, ignore_errors=True)
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(ROOT / name, folder / name, ignore=ignored)


# --- refusals taken out --------------------------------------------------------------------------


_REFUSING = ("require", "keys", "check_", "_check", "_raise", "self._check", "self._disk")
_METHODS = (".check", ".check_root")


class Refusal(ast.NodeTransformer):
    """Takes out refusal number `chosen` of a module: a `require` or a `raise` that says why."""

    def __init__(self, chosen: int) -> None:
        self.chosen, self.seen, self.text = chosen, -1, ""

    def _taken(self, node: ast.stmt) -> ast.stmt:
        self.seen += 1
        if self.seen != self.chosen:
            return node
        self.text = f"line {node.lineno}: {ast.unparse(node)}"
        return ast.copy_location(ast.Pass(), node)

    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        if isinstance(node.value, ast.Call):
            name = ast.unparse(node.value.func)
            if name.startswith(_REFUSING) or name.endswith(_METHODS):
                return self._taken(node)
        return node

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        return self._taken(node)


def refusals(module: str) -> Iterator[tuple[str, str]]:
    """What is taken out, and the module without it."""
    source = (ROOT / PACKAGE / f"{module}.py").read_text()
    for number in range(1000):
        change = Refusal(number)
        changed = ast.fix_missing_locations(change.visit(ast.parse(source)))
        if not change.text:
            return
        yield change.text, ast.unparse(changed)


def run_refusals(folder: Path, chosen: list[str], jobs: int) -> None:
    """Take out every refusal; the survivors go to refusals.json."""
    todo = [(m, *pair) for m in modules(chosen) for pair in refusals(m)]
    left: list[str] = []
    places = [folder / f"refusals-{k}" for k in range(jobs)]
    for place in places:
        copy(place)

    def one(item: tuple[int, tuple[str, str, str]]) -> None:
        number, (module, text, changed) = item
        place = free.pop()
        path = place / PACKAGE / f"{module}.py"
        before = path.read_text()
        path.write_text(changed)
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider"]
        env = {**os.environ, "PYTHONPATH": str(place), "PYTHONDONTWRITEBYTECODE": "1"}
        start = time.monotonic()
        try:
            done = subprocess.run(
                [*command, *files_of(module)],
                cwd=place,
                env=env,
                capture_output=True,
                check=False,
                timeout=900,
            )
            killed = done.returncode == 1
        except subprocess.TimeoutExpired:
            killed = True
        path.write_text(before)
        free.append(place)
        if not killed:
            left.append(f"{module} {text}")
        state = "killed" if killed else "SURVIVED"
        seconds = time.monotonic() - start
        print(f"{number + 1}/{len(todo)} {seconds:.0f} s {state}: {module} {text}", flush=True)

    free = list(places)
    with ThreadPoolExecutor(jobs) as pool:
        list(pool.map(one, enumerate(todo)))
    result = {"taken out": len(todo), "modules": modules(chosen), "left": sorted(left)}
    (folder / "refusals.json").write_text(json.dumps(result, indent=1))
    print(f"{len(todo)} refusals taken out, {len(left)} not noticed")


# --- mutmut --------------------------------------------------------------------------------------


def mutants(folder: Path, module: str) -> Iterator[tuple[str, str, str]]:
    """Name, line before and line after of the mutants that mutmut has written."""
    path = folder / "mutants" / PACKAGE / f"{module}.py"
    bodies: dict[str, str] = {}
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef) and "__mutmut_" in node.name:
            name, node.name = node.name, "f"
            bodies[name] = ast.unparse(node)
    for name, body in bodies.items():
        stem, _, number = name.rpartition("__mutmut_")
        if number == "orig":
            continue
        before, after = (text.splitlines() for text in (bodies[f"{stem}__mutmut_orig"], body))
        changed = [d for d in difflib.ndiff(before, after) if d[0] in "+-"]
        old = " ".join(d[2:].strip() for d in changed if d[0] == "-")
        new = " ".join(d[2:].strip() for d in changed if d[0] == "+")
        yield f"exactfold.checker.{module}.{name}", old, new


_STRICT = re.compile(r",? ?strict=(?:True|False|None)\b")


def worth_running(before: str, after: str) -> bool:
    """False for mutants that change nothing but what cannot matter.

    The `strict=` of a zip whose parts have been made equally long, and the text of a message.
    """
    if _STRICT.sub("", before) == _STRICT.sub("", after).replace(", )", ")"):
        return False
    message = re.compile(r"""f?(['"]).*\1""")
    return not (
        before.startswith(("require(", "raise "))
        and message.sub("", before) == message.sub("", after)
    )


def run_mutmut(folder: Path, chosen: list[str], jobs: int) -> None:
    """Make all mutants, and run those of the modules that are worth it."""
    copy(folder)
    tests = "\n".join(f"    {name}" for name in files_of(""))
    (folder / "setup.cfg").write_text(CONFIG.format(tests=tests))
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    command = [sys.executable, "-m", "mutmut", "run", "--max-children", str(jobs)]
    none = [*command, "exactfold.checker.formats*"]  # writes all mutants, runs none
    subprocess.run(none, cwd=folder, env=env, check=False, stdout=subprocess.DEVNULL)
    names = [
        name
        for module in modules(chosen)
        for name, before, after in mutants(folder, module)
        if worth_running(before, after)
    ]
    print(f"{len(names)} mutants", flush=True)
    subprocess.run([*command, *names], cwd=folder, env=env, check=False)


def survivors(folder: Path) -> None:
    """Print what was run, what was not, and what is left."""
    if (folder / "refusals.json").exists():
        print((folder / "refusals.json").read_text())
    for module in modules([]):
        meta = folder / "mutants" / PACKAGE / f"{module}.py.meta"
        if not meta.exists():
            continue
        codes = json.loads(meta.read_text())["exit_code_by_key"]
        shown = {name: (old, new) for name, old, new in mutants(folder, module)}
        run = {name: code for name, code in codes.items() if code is not None}
        left = sorted(name for name, code in run.items() if code in (0, 5, 33))
        skipped = sum(
            code is None and not worth_running(*shown[name]) for name, code in codes.items()
        )
        not_run = len(codes) - len(run) - skipped
        print(f"{module}: {len(codes)} mutants, {skipped} left out, {not_run} not run, ", end="")
        print(f"{len(run)} run, {len(left)} left")
        for name in left:
            print(f"  {name.rpartition('.')[2]}\n    - {shown[name][0]}\n    + {shown[name][1]}")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("refusals", "mutmut", "survivors"))
    parser.add_argument("modules", nargs="*")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutants")
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    if given.what == "refusals":
        run_refusals(given.folder, given.modules, given.jobs)
    elif given.what == "mutmut":
        run_mutmut(given.folder, given.modules, given.jobs)
    else:
        survivors(given.folder)


if __name__ == "__main__":
    main()
