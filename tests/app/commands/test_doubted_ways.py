"""Commands about one way of a drawing whose digits are in doubt: nothing is PROVED of the sheet."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from rounded_sheets import SHEETS, rounded
from running import PROVED, UNDECIDED, run

import exactfold

SAID = "UNDECIDED for the sheet that was meant; for the digits as written (--snap exact):"


@pytest.fixture
def drawing(tmp_path: Path) -> Path:
    """Two diagonals and a ring round their crossing, whose corners are off by 2e-6 to 6e-4."""
    corners = [[0, 0], [4, 0], [4, 4], [0, 4]]
    inner = [[2.00001, 1.99997], [1.0003, 0.99992], [3.000007, 0.999998]]
    inner += [[2.99988, 3.00005], [1.002, 2.9991]]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3)]
    edges += [(4, 5), (4, 6), (4, 7), (4, 8), (5, 6), (6, 7), (7, 8), (5, 8)]
    edges += [(0, 5), (1, 6), (2, 7), (3, 8), (0, 6), (1, 7), (2, 8), (3, 5)]
    letters = ["B"] * 4 + ["U"] * 16
    path = tmp_path / "diagonals.fold"
    document: dict[str, Any] = {"vertices_coords": corners + inner, "edges_vertices": edges}
    path.write_text(json.dumps({**document, "edges_assignment": letters}))
    return path


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("branch", ["--up", "4"]),
        ("actuate", ["--up", "4"]),
        ("tolerance", ["--up", "4"]),
        ("fold", ["--up", "4", "--until", "5deg"]),
        ("export", ["--up", "4", "-o", "way.fold"]),
    ],
)
def test_an_answer_about_digits_says_so_first(
    command: str, options: list[str], drawing: Path, tmp_path: Path
) -> None:
    options = [str(tmp_path / x) if x == "way.fold" else x for x in options]
    doubted = run(command, drawing, *options)
    assert doubted.exit_code == UNDECIDED
    assert doubted.stdout.startswith(SAID)
    sure = run(command, drawing, *options, "--snap", "exact")
    assert sure.exit_code == PROVED
    assert SAID not in sure.stdout
    data = json.loads(run(command, drawing, *options, "--json").stdout)
    assert data["status"] == "undecided"
    if command in ("branch", "actuate", "tolerance"):
        Draft202012Validator(exactfold.schema(command)).validate(data)
        assert "relations nearly hold" in data["reason"]
        assert "; the digits as written: proved, " in data["reason"]
        assert data.get("self_foldable", "undecided") == "undecided"


def test_equations_of_digits_in_doubt_are_not_written(drawing: Path) -> None:
    result = run("export", str(drawing), "--system", "m2")
    assert (result.exit_code, result.stdout) == (UNDECIDED, "")
    assert result.stderr.count("relations nearly hold") == 1
    assert "--snap exact takes the digits as written" in result.stderr
    result = run("export", str(drawing), "--system", "m2", "--snap", "exact")
    assert (result.exit_code, result.stdout[:5]) == (PROVED, "-- he")


def test_so_do_the_values_of_python(drawing: Path) -> None:
    exact = exactfold.read(drawing, snap="exact")
    for find in (exactfold.branch, exactfold.actuate, exactfold.tolerance):
        found, sure = find(drawing, up=[4]), find(exact, up=[4])
        assert (found.status, sure.status) == (exactfold.UNDECIDED, exactfold.PROVED)
        assert found.reason.endswith(f"; the digits as written: proved, {sure.reason}")
        assert "relations nearly hold" in found.reason


def test_a_streamed_count_and_a_converted_sheet_say_the_doubt_once(
    drawing: Path, tmp_path: Path
) -> None:
    streamed = run("count", drawing, "--stream", tmp_path / "s.txt")
    assert streamed.exit_code == UNDECIDED
    assert streamed.stderr == ""
    assert " ".join(streamed.stdout.split()).count("relations nearly hold") == 1
    as_json = run("count", drawing, "--stream", tmp_path / "t.txt", "--json")
    assert as_json.stderr.count("relations nearly hold") == 1
    converted = run("convert", drawing, tmp_path / "written.fold")
    assert converted.stdout.count("warning: 7 relations nearly hold") == 1


@pytest.fixture
def ring(tmp_path: Path) -> Path:
    """A turned ring: six of its branches are double, and rounding to 10 decimals splits them."""
    path = tmp_path / "ring.fold"
    path.write_text(json.dumps(rounded(SHEETS["ring"](), 10)))
    return path


NEAR = "vertex 8 is nearly flat"


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("count", []),
        ("branch", ["--up", "4,5,6,7,8"]),
        ("branch", ["--way", "1"]),
        ("fold", ["--way", "1", "--until", "5deg"]),
        ("actuate", ["--way", "1"]),
        ("export", ["--way", "1", "-o", "way.fold"]),
        ("match", ["--letters", "MMMMMMMMVMFMMVFM"]),
        ("assignments", []),
    ],
)
def test_a_way_that_rounding_splits_is_proved_for_the_digits_only(
    command: str, options: list[str], ring: Path, tmp_path: Path
) -> None:
    options = [str(tmp_path / x) if x == "way.fold" else x for x in options]
    result = run(command, ring, *options)
    assert result.exit_code == UNDECIDED
    said = " ".join((result.stderr + result.stdout).split())
    assert NEAR in said
    data = json.loads(run(command, ring, *options, "--json").stdout)
    assert data["status"] == "undecided"
    exact = run(command, ring, *options, "--snap", "exact")
    assert NEAR not in exact.stdout
    assert (f"warning: {NEAR}" in exact.stderr) == (command == "count")
    if command not in ("actuate", "match"):
        assert exact.exit_code == PROVED


@pytest.mark.parametrize("command", ["branch", "fold"])
def test_a_way_that_rounding_leaves_alone_is_proved(command: str, ring: Path) -> None:
    more = ["--until", "5deg"] if command == "fold" else []
    result = run(command, ring, "--signs", "+-+++", *more)
    assert result.exit_code == PROVED
    assert NEAR not in result.stdout


def test_a_count_proposes_the_exact_sheet(ring: Path) -> None:
    said = " ".join(run("count", ring).stdout.split())
    assert f"UNDECIDED (0.00 s): {NEAR} on 12 of 32 ways" in re.sub(r"\d\.\d\d s", "0.00 s", said)
    assert "the digits as written: 32 ways to start folding - PROVED" in said
    assert "a proposal (--noise " in said
    assert "of that sheet: 26 ways to start folding - PROVED" in said
    proposal = json.loads(run("count", ring, "--json").stdout)["proposal"]
    assert proposal["answer"]["distinct"] == 26
    taken = json.loads(run("count", ring, "--noise", proposal["noise"], "--json").stdout)
    assert (taken["status"], taken["distinct"]) == ("proved", 26)


def test_views_and_streams_of_digits_say_so(ring: Path, tmp_path: Path) -> None:
    streamed = run("count", ring, "--stream", tmp_path / "s.txt")
    assert streamed.exit_code == UNDECIDED
    assert f"{NEAR} on 12 of 32 ways" in " ".join(streamed.stdout.split())
    viewed = run("view", ring, "--way", "1", "-o", tmp_path / "way.html")
    assert f"UNDECIDED for the sheet that was meant: {NEAR}" in " ".join(viewed.stdout.split())
