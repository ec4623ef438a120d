"""Mutants of the checker: whether its tests notice a line that is weakened.

    python tests/benchmarks/mutate_checker.py refusals [MODULE ...]
    python tests/benchmarks/mutate_checker.py mutmut [--every] [MODULE ...]
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
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

import pytest

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
    "forged_intervals": "algebraic classes",
    "forged_compact": "compact compact_lines command",
    "forged_blocks": "compact_blocks",
    "forged_branches": "branch branch_proof command",
    "panels_checker": "panels panel_components panel_lines panel_loops panel_modes panel_sheet "
    "towers intervals",
    "forged_spaces": "panel_leaves panel_reduction panel_spaces panels towers",
    "recognised": "command",
    "fixtures": "",
}
"""Quick tests, which need no other process, and the modules for which each is the first to run."""

CONFIG = """[mutmut]
source_paths=exactfold
only_mutate=exactfold/checker/*.py
do_not_mutate=exactfold/checker/__main__.py
pytest_add_cli_args_test_selection=tests/checker/test_recognised.py
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
        self.chosen, self.seen, self.text, self.lines = chosen, -1, "", range(0)

    def _taken(self, node: ast.stmt) -> ast.stmt:
        self.seen += 1
        if self.seen != self.chosen:
            return node
        self.text = f"line {node.lineno}: {ast.unparse(node)}"
        self.lines = range(node.lineno, (node.end_lineno or node.lineno) + 1)
        return ast.copy_location(ast.Pass(), node)

    def visit_Expr(self, node: ast.Expr) -> ast.AST:
        if isinstance(node.value, ast.Call):
            name = ast.unparse(node.value.func)
            if name.startswith(_REFUSING) or name.endswith(_METHODS):
                return self._taken(node)
        return node

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        return self._taken(node)


def refusals(module: str) -> Iterator[tuple[str, range, str]]:
    """What is taken out, its lines, and the module without it."""
    source = (ROOT / PACKAGE / f"{module}.py").read_text()
    for number in range(1000):
        change = Refusal(number)
        changed = ast.fix_missing_locations(change.visit(ast.parse(source)))
        if not change.text:
            return
        yield change.text, change.lines, ast.unparse(changed)


class Witness:
    """A plugin of pytest: which tests make which lines of the checker refuse something."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.test = folder, ""
        self.seen: dict[str, list[str]] = {}
        self.seconds: dict[str, float] = {}

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        self.test = item.nodeid
        from exactfold.checker import reading

        for error in (reading.CertificateError, reading.FormatError):
            if "__init__" not in vars(error):
                error.__init__ = self._told  # type: ignore[assignment]

    def _told(self, *arguments: object) -> None:
        frame: FrameType | None = sys._getframe()
        while frame is not None:
            path = Path(frame.f_code.co_filename)
            if path.parts[-3:-1] == PACKAGE.parts:
                tests = self.seen.setdefault(f"{path.stem}:{frame.f_lineno}", [])
                if self.test not in tests:
                    tests.append(self.test)
            frame = frame.f_back

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call":
            self.seconds[report.nodeid] = report.duration

    def of(self, module: str, lines: range) -> list[str]:
        """The quickest tests that see one of these lines refuse."""
        found = {test for line in lines for test in self.seen.get(f"{module}:{line}", ())}
        return sorted(found, key=lambda test: self.seconds.get(test, 0.0))[:8]


def forked(place: Path, arguments: list[str], plugins: list[object], seconds: int = 900) -> int:
    """The exit code of pytest in a process of its own that has everything loaded but exactfold."""
    child = os.fork()
    if child:
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    signal.alarm(seconds)
    os.chdir(place)
    sys.path[:0] = [str(place)]
    sys.dont_write_bytecode = True
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
        os.dup2(nothing.fileno(), 2)
        code = int(pytest.main(["-q", "-x", "-p", "no:cacheprovider", *arguments], plugins))
        for plugin in plugins:
            if isinstance(plugin, Witness):
                found = [plugin.seen, plugin.seconds]
                (plugin.folder / "witnesses.json").write_text(json.dumps(found))
    os._exit(code)


def run_refusals(folder: Path, chosen: list[str]) -> None:
    """Take out every refusal; the survivors go to refusals.json."""
    copy(folder / "refusals")
    place, witness = folder / "refusals", Witness(folder)
    if forked(place, files_of(""), [witness]):
        raise SystemExit("the tests fail as they are")
    witness.seen, witness.seconds = json.loads((folder / "witnesses.json").read_text())
    todo = [(m, *entry) for m in modules(chosen) for entry in refusals(m)]
    left = []
    for number, (module, text, lines, changed) in enumerate(todo, 1):
        path = place / PACKAGE / f"{module}.py"
        before = path.read_text()
        path.write_text(changed)
        start = time.monotonic()
        quick = witness.of(module, lines)
        killed = bool(quick and forked(place, quick, [])) or forked(place, files_of(module), [])
        path.write_text(before)
        if not killed:
            left.append(f"{module} {text}")
        state = "killed" if killed else "SURVIVED"
        seconds = time.monotonic() - start
        print(f"{number}/{len(todo)} {seconds:.0f} s {state}: {module} {text}", flush=True)
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
_TEXT = re.compile(r"""f?(['"]).*\1""")


def worth_running(before: str, after: str, every: bool = False) -> bool:
    """False for mutants that cannot matter, and unless `every` for those that end in an error.

    The `strict=` of a zip whose parts have been made equally long, and the text of a message, do
    not matter. Values and arguments replaced by None or left out, and texts in other letters, raise
    an error sooner or later in nearly all cases; what is left are mutants of operators, numbers,
    comparisons, branches and loops.
    """
    if _STRICT.sub("", before) == _STRICT.sub("", after).replace(", )", ")"):
        return False
    if before.startswith(("require(", "raise ")) and _TEXT.sub("", before) == _TEXT.sub("", after):
        return False
    if every:
        return True
    return not (
        after.count("None") > before.count("None")
        or after.count("XX") > before.count("XX")
        or after.count(",") < before.count(",")
        or after.count('""') > before.count('""')
        or before.lower() == after.lower()
    )


def run_mutmut(folder: Path, chosen: list[str], jobs: int, every: bool) -> None:
    """Make all mutants, and run those of the modules that are worth it; survivors are noted."""
    copy(folder)
    (folder / "setup.cfg").write_text(CONFIG)
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
    none = [sys.executable, "-m", "mutmut", "run", "exactfold.checker.formats*"]  # makes all
    subprocess.run(none, cwd=folder, env=env, check=False, capture_output=True)
    todo = [
        (module, *mutant)
        for module in modules(chosen)
        for mutant in mutants(folder, module)
        if worth_running(*mutant[1:], every)
    ]
    shutil.copytree(folder / "tests", folder / "mutants" / "tests", dirs_exist_ok=True)
    print(f"{len(todo)} mutants", flush=True)
    children = []
    for job in range(jobs):
        child = os.fork()
        if not child:
            _run_share(folder, todo[job::jobs], folder / f"mutants-{job}.jsonl")
            os._exit(0)
        children.append(child)
    for child in children:
        os.waitpid(child, 0)


def _run_share(folder: Path, todo: list[tuple[str, str, str, str]], result: Path) -> None:
    place = folder / "mutants"
    with open(result, "w") as stream:
        for number, (module, name, before, after) in enumerate(todo, 1):
            os.environ["MUTANT_UNDER_TEST"] = name
            own = [path for path in files_of(module) if module in TESTS[path[19:-3]].split()]
            code = forked(place, own, [], 300) if own else 0
            if code in (0, 5):
                code = forked(place, [path for path in files_of(module) if path not in own], [])
            entry = {"module": module, "name": name, "before": before, "after": after}
            print(json.dumps({**entry, "killed": code != 0}), file=stream, flush=True)
            state = "killed" if code else "SURVIVED"
            print(f"{number}/{len(todo)} {state} {name}: {before} -> {after}", flush=True)


def survivors(folder: Path) -> None:
    """Print what was run and what is left."""
    if (folder / "refusals.json").exists():
        print((folder / "refusals.json").read_text())
    rows = [
        json.loads(line)
        for path in sorted(folder.glob("mutants-*.jsonl"))
        for line in path.read_text().splitlines()
    ]
    for module in modules([]):
        here = [row for row in rows if row["module"] == module]
        left = [row for row in here if not row["killed"]]
        print(f"{module}: {len(here)} mutants run, {len(left)} left")
        for row in left:
            print(f"  - {row['before']}\n  + {row['after']}")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("refusals", "mutmut", "survivors"))
    parser.add_argument("modules", nargs="*")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutants")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--every", action="store_true", help="mutants that end in an error, too")
    given = parser.parse_args()
    if given.what == "refusals":
        run_refusals(given.folder, given.modules)
    elif given.what == "mutmut":
        run_mutmut(given.folder, given.modules, given.jobs, given.every)
    else:
        survivors(given.folder)


if __name__ == "__main__":
    main()
