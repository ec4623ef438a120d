"""What commands load."""

import subprocess
import sys

import pytest
from running import PROVED, run

import exactfold
from exactfold.branches.counting.registry import ALIASES

HEAVY = ("mpmath", "sympy", "networkx", "scipy", "distributed", "asyncio", "pydantic")
NEARLY = ("numpy.ma", "logging", "importlib.metadata", "multiprocessing")
"""Modules that take some time to load, too, and that a count does not need."""


@pytest.mark.parametrize(
    ("arguments", "idle"),
    [
        (["--help"], ("numpy", "flint", "multiprocessing", "rich", *HEAVY)),
        (["random", "--interior", "3", "--seed", "1"], ("numpy", "flint", "rich", *HEAVY)),
        (["info"], ("multiprocessing", *HEAVY)),
        (
            ["branch", "--up", "4"],
            ("flint", "mpmath", "sympy", "networkx", "exactfold.solve.algebraic"),
        ),
        (["count"], HEAVY),
        (["motions"], ("scipy.optimize",)),
    ],
    ids=lambda value: value[0],
)
def test_commands_load_what_they_need(two_vertex, arguments, idle):
    script = (
        "import sys\n"
        "from exactfold.app.cli import main\n"
        "try: main()\n"
        "except SystemExit as end: code = end.code\n"
        f"print(code, *(m for m in {idle!r} if m in sys.modules), file=sys.stderr)"
    )
    pattern = [] if arguments[0] in ("--help", "random") else [str(two_vertex)]
    command = [sys.executable, "-c", script, *arguments, *pattern]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.stderr == "0\n"
    assert result.stdout != ""


def test_what_a_small_count_loads(two_vertex):
    script = (
        "import sys\n"
        "from exactfold.app.cli import main\n"
        "try: main()\n"
        "except SystemExit as end: assert end.code == 0\n"
        "print(*sorted(sys.modules), sep='\\n', file=sys.stderr)"
    )
    command = [sys.executable, "-c", script, "count", str(two_vertex)]
    loaded = subprocess.run(command, capture_output=True, text=True, check=True).stderr.split()
    heavy = (*HEAVY, *NEARLY, "numpy", "flint", "rich.markdown", "pygments")
    assert [name for name in loaded if name in heavy] == []
    rooms = (
        *("panels", "motion", "design", "studies", "interop", "branches.connected_components"),
        *("solve.algebraic.", "branches.counting.find", "branches.counting.in_chart"),
        *("branches.counting.batch", "app.options.branches", "app.options.pictures"),
    )
    idle = tuple(f"exactfold.{room}" for room in rooms)
    assert [name for name in loaded if name.startswith(idle)] == []


@pytest.mark.parametrize("name", [*exactfold.branches.METHODS, *ALIASES])
def test_methods_of_the_command_line(two_vertex, name):
    assert run("count", two_vertex, "--method", name).exit_code == PROVED
