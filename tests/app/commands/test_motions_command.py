"""`exactfold motions`: the matching as people and programs read it, and what is refused."""

import json

from jsonschema import Draft202012Validator
from running import BAD_INPUT, UNDECIDED, USAGE, error_class, run
from sheets import HEXAGON, scrambled

from exactfold import random_square, schema
from exactfold.motion import find_loops
from exactfold.pattern import write_fold

OK = 0


def test_the_table_lists_each_loop_once():
    table = run("motions", "two-vertex", "--workers", "1")
    assert table.exit_code == OK
    assert "matched  8 of 8 rays, PROVED" in table.stdout
    loops = [line for line in table.stdout.splitlines() if "saddle +" in line]
    assert len(loops) == 2
    assert all(line.split()[6] == "saddle" for line in loops)


def test_the_json_is_what_python_says(tmp_path):
    path = tmp_path / "one.fold"
    write_fold(random_square(1, seed=0), path)
    result = run("motions", str(path), "--workers", "1", "--json")
    found = json.loads(result.stdout)
    Draft202012Validator(schema("motions")).validate(found)
    again = find_loops(path).to_dict(str(path))
    for value in (found, again):
        value.pop("seconds")
    assert found == again
    assert (found["half_branches"], found["matched"], found["vertices"]) == (4, 4, [4])


def test_what_is_not_matched_is_said():
    result = run("motions", "flat-vertex", "--workers", "1")
    assert result.exit_code == UNDECIDED
    assert "UNDECIDED" in result.stdout
    assert "not simple" in result.stdout


def test_sheets_of_another_kind_are_refused(tmp_path):
    path = tmp_path / "hexagon.fold"
    write_fold(scrambled(1, HEXAGON, 2), path)
    result = run("motions", str(path), "--json")
    assert result.exit_code == UNDECIDED
    assert error_class(result) == "NotCountedError"
    said = json.loads(result.stdout)["error"]["message"]
    assert said.startswith("motions takes sheets with four boundary vertices, and this one has 6")
    result = run("motions", str(tmp_path / "missing.fold"))
    assert result.exit_code == BAD_INPUT
    result = run("motions", "two-vertex", "--workers", "2", "--dask", "tcp://127.0.0.1:1")
    assert result.exit_code == USAGE
