"""`exactfold export --system` and `exactfold certify`: the text, JSON, exit codes and bad input."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from running import BAD_INPUT, PROVED, UNDECIDED, USAGE, run

import exactfold


def points(folder: Path, data: Any) -> Path:
    path = folder / "points.json"
    path.write_text(data if isinstance(data, str) else json.dumps(data))
    return path


def branch_points(name: str) -> list[dict[str, str]]:
    return [
        {f"h{v}": str(float(branch.heights[v][0])) for v in (4, 5)}
        for branch in exactfold.count(name).branches
    ]


def test_all_zeros_are_proved(tmp_path: Path) -> None:
    path = points(tmp_path, branch_points("two-vertex"))
    result = run("certify", "two-vertex", path)
    assert result.exit_code == PROVED
    assert result.stdout.startswith("4 of 4 points proved: 4 zeros in disjoint boxes, 4 real")
    assert "these are all zeros of the system - PROVED" in result.stdout
    data = json.loads(run("certify", "two-vertex", path, "--json").stdout)
    Draft202012Validator(exactfold.schema("certify")).validate(data)
    assert (data["status"], data["complete"], data["real"]) == ("proved", "proved", 4)
    for point, near in zip(data["points"], branch_points("two-vertex"), strict=True):
        centre = {name: float(Fraction(x)) for name, x in point["centre"].items()}
        assert centre == pytest.approx({name: float(x) for name, x in near.items()})


def test_points_that_are_not_proved_are_named(tmp_path: Path) -> None:
    near, *_ = branch_points("two-vertex")
    path = points(tmp_path, [near, near, [3, [4, 5]]])
    result = run("certify", "two-vertex", path)
    assert result.exit_code == UNDECIDED
    assert "proved, real, as point 0" in result.stdout
    assert "2      not proved: " in result.stdout
    assert "all zeros" not in result.stdout
    data = json.loads(run("certify", "two-vertex", path, "--json").stdout)
    Draft202012Validator(exactfold.schema("certify")).validate(data)
    assert (data["distinct"], data["complete"]) == (1, "undecided")
    assert [x["same_as"] for x in data["points"]] == [None, 0, None]


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("{", "is not JSON"),
        ({"h4": 1}, "does not hold a list of points"),
        ([3], "point 0 is neither a list nor an object"),
        ([[1, 2], [1]], "point 1 has 1 coordinate; the system has 2 unknowns: h4, h5"),
        ([{"h4": 1}], "point 0 has no coordinate h5"),
        ([{"h4": 1, "h5": 1, "h6": 1}], "point 0 has a coordinate 'h6'"),
        ([[1, True]], "point 0, h5: True is not a number"),
        ([["a", 1]], "point 0, h4: 'a' is not a number"),
        ("[[NaN, 1]]", "point 0, h4: 'NaN' is not a number"),
        ('[{"h4": 1, "h4": 2, "h5": 0}]', "h4 is given twice"),
    ],
)
def test_bad_points(tmp_path: Path, given: Any, message: str) -> None:
    result = run("certify", "two-vertex", points(tmp_path, given))
    assert (result.exit_code, result.stdout) == (BAD_INPUT, "")
    assert message in result.stderr


def test_panels_have_equations_but_no_certify(tmp_path: Path) -> None:
    out = tmp_path / "miura.m2"
    assert run("export", "miura", "--system", "m2", "-o", out).exit_code == PROVED
    assert out.read_text().count("w10x11") > 2
    result = run("certify", "miura", points(tmp_path, []))
    assert (result.exit_code, result.stdout) == (UNDECIDED, "")
    assert "certify takes triangulated sheets" in result.stderr
    assert "proves all solutions of its equations" in result.stderr


def test_a_program_that_is_not_known_and_options_that_do_not_go_together() -> None:
    for options in (["--system", "maple"], ["--system", "m2", "--signs", "+-"]):
        result = run("export", "two-vertex", *options)
        assert (result.exit_code, result.stdout) == (USAGE, "")
        assert "msolve" in result.stderr or "--system writes the equations" in result.stderr
