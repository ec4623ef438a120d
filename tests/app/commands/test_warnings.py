"""Patterns whose numbers are almost those of a simpler one."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from running import PROVED, run

from exactfold import CreasePattern
from exactfold.branches import count_branches, count_many
from exactfold.exact.numbers import as_rational
from exactfold.pattern import near_degenerate, read_fold, write_fold
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.reading import Reading


@pytest.fixture
def moved(tmp_path: Path) -> Path:
    """A vertex of a straight crease path, moved by 1e-13 off the path."""
    pattern = read_fold(example_path("flat-vertex"))
    points = list(pattern.vertices)
    x, y = points[4]
    points[4] = (x + as_rational("1e-13"), y)
    write_fold(CreasePattern(points, pattern.triangles), tmp_path / "moved.fold")
    return tmp_path / "moved.fold"


def warning(text: str) -> str:
    """The one warning on stderr."""
    (line,) = text.splitlines()
    begin = "exactfold: warning: "
    assert line.startswith(begin)
    return line.removeprefix(begin)


@pytest.mark.parametrize("command", ["count", "info"])
@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_vertex_that_is_almost_flat_is_named(
    moved: Path, command: str, more: tuple[str, ...]
) -> None:
    exact = run(command, moved, *more, "--snap", "exact")
    assert exact.exit_code == PROVED
    (line,) = exact.stderr.splitlines()
    assert line.startswith("exactfold: warning: one relation nearly holds, straight@4:0-2, off by")
    again = run(command, moved, *more, "--snap", 10)
    assert (again.exit_code, again.stderr) == (PROVED, "")
    if command == "count" and more:
        assert json.loads(exact.stdout)["distinct"] == 4
        assert json.loads(again.stdout)["distinct"] == 3


@pytest.mark.parametrize(
    "command",
    [
        ("count", "--json"),
        ("count", "--stream", "{}/s.txt", "--json"),
        ("info", "--json"),
        ("branch", "--up", "4", "--json"),
        ("export", "--up", "4", "-o", "{}/b.fold", "--json"),
    ],
)
def test_json_has_the_warning_that_is_said(
    moved: Path, tmp_path: Path, command: tuple[str, ...]
) -> None:
    name, *more = (part.format(tmp_path) for part in command)
    result = run(name, moved, *more, "--snap", "exact")
    assert result.exit_code == PROVED
    (found,) = json.loads(result.stdout)["warnings"]
    assert found == {"vertices": [4], "text": warning(result.stderr)}
    assert json.loads(run("info", example_path("flat-vertex"), "--json").stdout)["warnings"] == []


@pytest.mark.parametrize("jobs", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_batch_names_the_patterns_with_a_warning(
    moved: Path, monkeypatch: pytest.MonkeyPatch, jobs: int
) -> None:
    monkeypatch.chdir(moved.parent)  # short names are shown on one line
    good, out = "two-vertex", Path("o.jsonl")
    text = warning(run("info", moved.name, "--snap", "exact").stderr)
    given = ("count", good, moved.name, "--jobs", jobs, "--snap", "exact")
    result = run(*given, "--jsonl", out)
    assert (result.exit_code, result.stderr) == (PROVED, "")
    shown = " ".join(result.stdout.split())
    assert f"4 PROVED moved.fold moved.fold: warning: {text[:60]}" in shown
    assert "2 patterns: 2 proved, 0 undecided, 0 failed; 1 with a warning; results in" in shown
    assert good not in result.stdout
    lines = {line["name"]: line for line in map(json.loads, out.read_text().splitlines())}
    assert lines[good]["result"]["warnings"] == []
    assert [w["text"] for w in lines[moved.name]["result"]["warnings"]] == [text]
    again = json.loads(run(*given, "--jsonl", out, "--json").stdout)
    assert (again["skipped"], again["warned"]) == (2, 1)
    assert "1 with a warning" in run(*given).stdout


def test_lines_from_before_there_were_warnings(moved: Path, tmp_path: Path) -> None:
    out = tmp_path / "o.jsonl"
    run("count", moved, "--jsonl", out)
    line = json.loads(out.read_text())
    del line["result"]["warnings"]
    out.write_text(json.dumps(line) + "\n")
    summary = json.loads(run("count", moved, "--jsonl", out, "--json").stdout)
    assert (summary["skipped"], summary["warned"]) == (1, 0)


def test_python_callers_find_the_warning(moved: Path) -> None:
    found = near_degenerate(read_fold(moved))
    assert found is not None
    assert count_branches(read_fold(moved)).warning == found.text
    assert found.text in count_branches(read_fold(moved))._repr_html_()
    ((_, result),) = count_many([moved], reading=Reading("exact"))
    assert result.warning == found.text
    assert count_branches("flat-vertex").warning is None
    assert "warning" not in count_branches("flat-vertex")._repr_html_()


@pytest.mark.parametrize("name", SHEETS)
def test_shipped_patterns_have_no_warning(name: str) -> None:
    assert run("info", name).stderr == ""
