"""Mutants of the checker: whether its tests notice a line that is weakened.

    python tests/benchmarks/mutate_checker.py refusals [--left] [MODULE ...]
    python tests/benchmarks/mutate_checker.py mutmut [--every] [--left] [MODULE ...]
    python tests/benchmarks/mutate_checker.py survivors

`refusals` takes out, one at a time, each line of `exactfold/checker` that refuses something;
`mutmut` makes the mutants of mutmut (3.8, to be installed by hand) that `worth_running` leaves;
`survivors` prints what both have left. What was found is explained in docs/mutation.md.

Everything is loaded once: the quick tests of the checker are collected and run as they are, and it
is noted how long each takes and which functions of the modules it calls. Then a process is forked
for each mutant, in which the function has the code of the mutant, and the tests that call it are
run until one fails: those that have noticed mutants of that function before, then the quickest.
"""

from __future__ import annotations
import __future__

import argparse
import ast
import contextlib
import difflib
import functools
import hashlib
import inspect
import json
import os
import re
import resource
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from types import FrameType, FunctionType
from typing import Any, NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = ROOT / "exactfold" / "checker"
SLOW = (
    "against_the_package branch_checker check_command compact_checker evidence_refused standalone"
)
SLOW_TESTS = {f"test_{name}" for name in (SLOW + " tampering").split()}
"""Files that start processes, or count: all other tests in `tests/checker` are run."""

MEMORY = 4 << 30  # bytes that a mutant may ask for
Functions = dict[str, Any]


class Mutant(NamedTuple):
    """A function of a module with another definition."""

    module: str
    function: str
    definition: str
    before: str
    after: str
    lines: range

    @property
    def digest(self) -> str:
        """What tells it from others."""
        return hashlib.sha256(f"{self.module} {self.definition}".encode()).hexdigest()

    @property
    def text(self) -> str:
        """In words."""
        return f"{self.module} {self.function}: {self.before} -> {self.after or 'taken out'}"


def modules(chosen: list[str]) -> list[str]:
    """The modules asked for, or all."""
    left_out = ("_", "exactfold")
    paths = (path for path in PACKAGE.rglob("*.py") if not path.name.startswith(left_out))
    return chosen or sorted(map(module_of, paths))


def module_of(path: Path) -> str:
    """The name of a module of the checker, by its file."""
    return ".".join(path.relative_to(PACKAGE).with_suffix("").parts)


def definitions(tree: ast.Module) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Functions and methods, by name."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, node
        elif isinstance(node, ast.ClassDef):
            for inner in node.body:
                if isinstance(inner, ast.FunctionDef):
                    yield f"{node.name}.{inner.name}", inner


def source_of(module: str) -> str:
    """The text of a module."""
    return PACKAGE.joinpath(*module.split(".")).with_suffix(".py").read_text()


# --- refusals taken out --------------------------------------------------------------------------


_REFUSING = (
    "require",
    "at_most",
    "keys",
    "check_",
    "_check",
    "_raise",
    "self._check",
    "self._disk",
)
_METHODS = (".check", ".check_root")


class Refusal(ast.NodeTransformer):
    """Takes out refusal number `chosen` of a function: a `require` or a `raise` that says why."""

    def __init__(self, chosen: int) -> None:
        self.chosen, self.seen, self.text, self.lines = chosen, -1, "", range(0)

    def _taken(self, node: ast.stmt) -> ast.stmt:
        self.seen += 1
        if self.seen != self.chosen:
            return node
        self.text = ast.unparse(node)
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


def refusals(module: str) -> Iterator[Mutant]:
    """The functions of a module without one of their refusals."""
    for name, _ in definitions(ast.parse(source_of(module))):
        for number in range(1000):
            change = Refusal(number)
            node = dict(definitions(ast.parse(source_of(module))))[name]
            changed = ast.unparse(change.visit(node))
            if not change.text:
                break
            yield Mutant(module, name, changed, change.text, "", change.lines)


# --- mutmut --------------------------------------------------------------------------------------


@functools.cache
def mutmut() -> Any:
    """What makes the mutants of a file; mutmut wants a configuration where it is."""
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder):
        Path("setup.cfg").write_text("[mutmut]\nsource_paths=exactfold\n")
        import_module("mutmut.configuration").config()
    return import_module("mutmut.mutation.file_mutation").mutate_file_contents


def mutants(module: str) -> Iterator[Mutant]:
    """The mutants that mutmut makes of a module."""
    made = mutmut()(f"exactfold/checker/{module}.py", source_of(module)).code
    bodies: dict[str, str] = {}
    for _, node in definitions(ast.parse(made)):
        if "__mutmut_" in node.name:
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
        function = ".".join(stem.split("\u01c1")[1:]) if "\u01c1" in stem else stem[2:]
        yield Mutant(module, function, body, old, new, range(0))


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


# --- running -------------------------------------------------------------------------------------


def functions_of(names: list[str]) -> Functions:
    """The functions and methods of modules, by `module:name`."""
    found = {}
    for module in names:
        loaded = import_module(f"exactfold.checker.{module}")
        for name, _ in definitions(ast.parse(source_of(module))):
            owner, _, last = name.rpartition(".")
            value = inspect.getattr_static(getattr(loaded, owner) if owner else loaded, last)
            for inner in ("__func__", "fget", "func", "__wrapped__"):
                value = getattr(value, inner, value)
            found[f"{module}:{name}"] = value
    return found


def give(function: Any, definition: str) -> None:
    """Let a function, wherever it has been imported to, do what another definition says."""
    node = ast.parse(definition).body[0]
    names = function.__code__.co_freevars  # `__class__` if it calls `super`
    if isinstance(node, ast.FunctionDef):
        node.decorator_list = []
        node.body[:0] = [ast.parse(name).body[0] for name in names]
        outer = ast.parse(f"def outer({', '.join(names)}):\n    return {node.name}").body[0]
        if isinstance(outer, ast.FunctionDef):
            outer.body.insert(0, node)
            node = outer
    flags = __future__.annotations.compiler_flag
    made: dict[str, Any] = {}
    exec(compile(ast.Module([node], []), "mutant", "exec", flags), function.__globals__, made)
    [outermost] = made.values()
    other = outermost(*names)
    function.__code__, function.__defaults__ = other.__code__, other.__defaults__
    function.__kwdefaults__ = other.__kwdefaults__


class Bench:
    """A plugin of pytest that runs the collected tests on every mutant."""

    def __init__(self, todo: list[Mutant], what: str, folder: Path, jobs: int) -> None:
        self.todo, self.what, self.folder, self.jobs = todo, what, folder, jobs
        self.failed = False
        self.test = ""
        self.calls: dict[str, set[str]] = defaultdict(set)  # tests, by function
        self.refusing: dict[str, set[str]] = defaultdict(set)  # tests, by line that refuses
        self.seconds: dict[str, float] = {}
        self.noticed: dict[str, Counter[str]] = defaultdict(Counter)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.failed |= report.failed
        self.seconds[report.nodeid] = self.seconds.get(report.nodeid, 0.0) + report.duration

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        said = os.fdopen(os.dup(1), "w", buffering=1)
        with open(os.devnull, "w") as nothing:
            os.dup2(nothing.fileno(), 1)
        functions = functions_of(sorted({mutant.module for mutant in self.todo}))
        self._measure(session.items, functions)
        if self.failed:
            print("the tests fail as they are:", self.test, file=said)
            return True
        total = sum(self.seconds.values())
        print(f"{len(session.items)} tests in {total:.0f} s, {len(self.todo)} mutants", file=said)
        jobs = [
            functools.partial(self._share, job, session.items, functions, said)
            for job in range(self.jobs)
        ]
        for child in [forked(job) for job in jobs]:
            os.waitpid(child, 0)
        return True

    def _measure(self, items: list[pytest.Item], functions: Functions) -> None:
        """Run all tests as they are, and note what each calls and refuses."""
        before = {}
        for key, function in functions.items():
            name = key.replace(":", "_").replace(".", "_")
            copy = FunctionType(
                function.__code__, function.__globals__, closure=function.__closure__
            )
            copy.__defaults__, copy.__kwdefaults__ = function.__defaults__, function.__kwdefaults__
            before[key] = copy
            function.__globals__.update({f"_bench_{name}": copy, "_bench_called": self._called})
            give(
                function,
                f"def f(*args, **kwargs):\n    _bench_called({key!r})\n"
                f"    return _bench_{name}(*args, **kwargs)",
            )
        reading: Any = import_module("exactfold.checker.core.reading")
        errors = (reading.CertificateError, reading.FormatError)
        for error in errors:
            error.__init__ = self._told
        for item, following in zip(items, [*items[1:], None], strict=True):
            self.test = item.nodeid
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if self.failed:
                return
        for error in errors:
            del error.__init__
        for key, function in functions.items():
            copy = before[key]
            function.__code__, function.__defaults__ = copy.__code__, copy.__defaults__
            function.__kwdefaults__ = copy.__kwdefaults__

    def _called(self, key: str) -> None:
        self.calls[key].add(self.test)

    def _told(self, *_: object) -> None:
        frame: FrameType | None = sys._getframe()
        while frame is not None:
            path = Path(frame.f_code.co_filename)
            if path.is_relative_to(PACKAGE):
                self.refusing[f"{module_of(path)}:{frame.f_lineno}"].add(self.test)
            frame = frame.f_back

    def _share(self, job: int, items: list[pytest.Item], functions: Functions, said: Any) -> None:
        todo = self.todo[job :: self.jobs]
        for number, mutant in enumerate(todo, 1):
            start = time.monotonic()
            key = f"{mutant.module}:{mutant.function}"
            seen = self.noticed[key]
            first = set().union(*(self.refusing[f"{mutant.module}:{k}"] for k in mutant.lines))
            chosen = sorted(
                (item for item in items if item.nodeid in self.calls[key]),
                key=lambda item: (
                    item.nodeid not in first,
                    -seen[item.nodeid],
                    self.seconds[item.nodeid],
                ),
            )
            test = self._first_to_fail(functions[key], mutant.definition, chosen, job)
            if test:
                seen[test] += 1
            entry = {k: getattr(mutant, k) for k in ("function", "before", "after", "digest")}
            entry["noticed by"] = test
            with open(self._result(mutant.module), "a") as stream:
                stream.write(json.dumps(entry) + "\n")
            state = "killed" if test else "SURVIVED"
            took = time.monotonic() - start
            print(f"{number}/{len(todo)} {took:.1f} s {state} {mutant.text}", file=said)

    def _result(self, module: str) -> Path:
        return self.folder / f"{self.what}-{module}.jsonl"

    def _first_to_fail(
        self, function: Any, definition: str, chosen: list[pytest.Item], job: int
    ) -> str:
        """The test that notices a definition, or that it stops, and "" if none does."""
        note = self.folder / f"test-{job}"
        note.write_text("")

        def run() -> None:
            give(function, definition)
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            for item, following in zip(chosen, [*chosen[1:], None], strict=True):
                note.write_text(item.nodeid)
                # Time of this process, so that a busy machine stops no mutant.
                signal.setitimer(signal.ITIMER_PROF, 10 + 5 * self.seconds[item.nodeid])
                item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
                if self.failed:
                    os._exit(1)

        code = os.waitstatus_to_exitcode(os.waitpid(forked(run), 0)[1])
        return note.read_text() if code else ""


def forked(run: Callable[[], None]) -> int:
    """The number of a new process that runs something and ends."""
    child = os.fork()
    if child:
        return child
    code = 1
    try:
        run()
        code = 0
    finally:
        os._exit(code)


def run(
    what: str, folder: Path, chosen: list[str], jobs: int, every: bool, left: bool, tests: list[str]
) -> None:
    """Run the tests on all mutants of a kind, or those left before; the results go to `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    todo = [
        mutant
        for module in modules(chosen)
        for mutant in (refusals(module) if what == "refusals" else mutants(module))
        if what == "refusals" or worth_running(mutant.before, mutant.after, every)
    ]
    known = {mutant.digest for mutant in todo}
    noticed: set[str] = set()
    for module in modules(chosen):
        path = folder / f"{what}-{module}.jsonl"
        rows = path.read_text().splitlines(keepends=True) if left and path.exists() else []
        kept = {row: json.loads(row) for row in rows}
        kept = {r: e for r, e in kept.items() if e["noticed by"] and e["digest"] in known}
        noticed |= {entry["digest"] for entry in kept.values()}
        path.write_text("".join(kept))
    todo = [mutant for mutant in todo if mutant.digest not in noticed]
    sys.path[:0] = [str(ROOT)]
    sys.dont_write_bytecode = True
    os.chdir(ROOT)
    found = {path.stem: str(path) for path in Path("tests", "checker").rglob("test_*.py")}
    quick = sorted(tests or set(found) - SLOW_TESTS)
    options = ["-x", "-s", "-p", "no:cacheprovider", "-p", "no:terminal"]
    pytest.main(
        [*options, *(found[name] for name in quick)],
        [Bench(todo, what, folder, jobs)],
    )


def survivors(folder: Path) -> None:
    """Print what was run and what is left."""
    for path in sorted(folder.glob("*-*.jsonl")):
        rows = [json.loads(line) for line in path.read_text().splitlines()]
        left = [row for row in rows if not row["noticed by"]]
        print(f"{path.stem}: {len(rows)} run, {len(left)} left")
        for row in left:
            print(f"  {row['function']}\n    - {row['before']}\n    + {row['after']}")


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("refusals", "mutmut", "survivors"))
    parser.add_argument("modules", nargs="*")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutants")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--every", action="store_true", help="mutants that end in an error, too")
    parser.add_argument("--left", action="store_true", help="only what the last run has left")
    parser.add_argument("--tests", nargs="*", default=[], help="only these files, as test_boxes")
    given = parser.parse_args()
    folder = given.folder.resolve()
    if given.what == "survivors":
        survivors(folder)
    else:
        run(given.what, folder, given.modules, given.jobs, given.every, given.left, given.tests)


if __name__ == "__main__":
    main()
