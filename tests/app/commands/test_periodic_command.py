"""`exactfold count --direction` and `exactfold random --torus`."""

from __future__ import annotations

import json
import os
import threading
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from running import PROVED, run

import exactfold
from exactfold import schema
from exactfold.branches import PeriodicCount
from exactfold.errors import UsageError
from exactfold.pattern import PeriodicPattern, read_cell
from exactfold.pattern.data import example_path


def test_a_cell_is_counted_certified_and_checked(tmp_path: Path) -> None:
    file = tmp_path / "c.json"
    result = run("count", "miura-cell", "--direction", "3,4", "--json", "--certificate", file)
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    Draft202012Validator(schema("periodic")).validate(data)
    assert (data["distinct"], data["real"], data["nonreal"]) == (5, 5, 0)
    assert (data["direction"], data["certificate"]) == ([3, 4], str(file))
    assert [space["dimension"] for space in data["pleats"]] == [1, 1, 1]
    checked = run("check", file)
    assert checked.exit_code == 0
    assert "5 branches of a periodic sheet" in checked.stdout


def test_irrational_pleats_stand_in_the_json() -> None:
    result = run("count", "square-twist-cell", "--direction", "1,2", "--json")
    data = json.loads(result.stdout)
    Draft202012Validator(schema("periodic")).validate(data)
    (row,) = data["pleats"][0]["basis"]
    assert len(row) == 5
    assert len(data["pleats"][0]["polynomial"]) == 3


def test_the_answer_in_words(tmp_path: Path) -> None:
    words = run("count", "miura-cell", "--direction", "0,1").stdout
    assert words.startswith("1 family of ways to start folding in the direction 0,1 - PROVED")
    assert "3 spaces of pleats" in words
    twist = run("count", "square-twist-cell", "--direction", "1,2", "--certificate", tmp_path / "c")
    assert "irrational heights" in twist.stdout
    assert "no certificate was written" in twist.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("miura-cell",), "give the direction in which it rolls up"),
        (("miura-cell", "--direction", "3"), "is not a direction such as 3,4"),
        (("miura-cell", "--direction", "0,0"), "0,0 is no direction"),
        (("miura-cell", "--direction", "1,2", "--method", "popping"), "--method does not go with"),
        (("miura-cell", "waterbomb-cell", "--direction", "1,2"), "go with one pattern"),
    ],
)
def test_what_does_not_go_together(arguments: tuple[str, ...], message: str) -> None:
    result = run("count", *arguments)
    assert result.exit_code == 2
    assert message in " ".join(result.stderr.split())


def test_a_sheet_that_is_not_periodic() -> None:
    result = run("count", "two-vertex", "--direction", "1,2")
    assert result.exit_code == 3
    assert "not the cell of a periodic sheet" in " ".join(result.stderr.split())


def test_a_pipe_is_not_read_to_see_whether_it_is_a_cell(tmp_path: Path) -> None:
    """What a pipe holds can be read once only."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    sheet = example_path("two-vertex").read_text()
    writer = threading.Thread(target=pipe.write_text, args=(sheet,), daemon=True)
    writer.start()
    result = run("count", pipe)
    writer.join(10)
    assert (result.exit_code, "4 ways to start" in result.stdout) == (PROVED, True)


def test_random_cells(tmp_path: Path) -> None:
    file = tmp_path / "cell.json"
    made = run("random", "--interior", "4", "--seed", "2", "--torus", "-o", file)
    assert made.exit_code == 0
    assert "a periodic sheet: 4 vertices in the cell" in made.stdout
    assert read_cell(file).V == 4
    printed = run("random", "--interior", "4", "--seed", "2", "--torus").stdout
    assert printed == file.read_text()
    assert run("random", "--interior", "4", "--seed", "2", "--torus", "--redraw").exit_code == 2


def test_the_verb() -> None:
    cell = read_cell("waterbomb-cell")
    result = exactfold.count(cell, direction=(1, "1/2"))
    assert isinstance(result, PeriodicCount)
    assert (len(result), result[0].vertex_signs, result.direction) == (4, "+--", (2, 1))
    assert isinstance(result.pattern, PeriodicPattern)
    with pytest.raises(UsageError, match="counted for one `direction`"):
        exactfold.count(cell)  # type: ignore[call-overload]
    with pytest.raises(UsageError, match="only `progress` goes with"):
        exactfold.count(cell, direction=(1, 2), seed=1)  # type: ignore[call-overload]
