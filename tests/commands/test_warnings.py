"""Patterns whose numbers are almost those of a simpler one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from running import PROVED, run

from exactfold import CreasePattern, read_fold, write_fold
from exactfold.data import EXAMPLES, example_path
from exactfold.exact.numbers import as_rational


@pytest.fixture
def moved(tmp_path: Path) -> Path:
    """A vertex of a straight crease path, moved by 1e-13 off the path."""
    pattern = read_fold(example_path("flat-vertex"))
    points = list(pattern.vertices)
    x, y = points[4]
    points[4] = (x + as_rational("1e-13"), y)
    write_fold(CreasePattern(points, pattern.triangles), tmp_path / "moved.fold")
    return tmp_path / "moved.fold"


@pytest.mark.parametrize("command", ["count", "info"])
@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_vertex_that_is_almost_flat_is_named(
    moved: Path, command: str, more: tuple[str, ...]
) -> None:
    result = run(command, moved, *more)
    assert result.exit_code == PROVED
    (line,) = result.stderr.splitlines()
    assert line.startswith(
        "exactfold: warning: vertex 4 is within 1e-13 of (1/2, 1/2), but not there"
    )
    assert "the path 0-4-2 is nearly straight, but not quite" in line
    assert line.endswith("rounds to the simpler pattern")
    snap = line.split("--snap ")[1].split()[0]
    again = run(command, moved, *more, "--snap", snap)
    assert (again.exit_code, again.stderr) == (PROVED, "")
    if command == "count" and more:
        assert json.loads(result.stdout)["distinct"] == 4
        assert json.loads(again.stdout)["distinct"] == 3


@pytest.mark.parametrize("name", EXAMPLES)
def test_shipped_patterns_have_no_warning(name: str) -> None:
    assert run("info", name).stderr == ""
