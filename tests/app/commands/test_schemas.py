"""Every JSON object printed is what its schema says, and stands alone."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from compact_files import bodies, chained
from drawings import SQUARE, as_cp
from files import written
from jsonschema import Draft202012Validator, ValidationError
from running import PROVED, UNDECIDED, run
from sheets import DENTED, HEXAGON, TRIANGLE, nested_triangles, scrambled

from exactfold import CreasePattern, schema
from exactfold.app.schemas import DOCUMENTS
from exactfold.branches import METHODS
from exactfold.pattern import read_fold, write_fold
from exactfold.pattern.data import SHEETS, example_path
from exactfold.rigidity import curvature_form

LARGE = ("hypar-2", "random-8")
"""Too large for the exact engine within a test."""
SOME = [pytest.param(x, marks=pytest.mark.slow) if x in LARGE else x for x in SHEETS]


def valid(data: dict[str, Any], kind: str) -> dict[str, Any]:
    Draft202012Validator(schema(kind)).validate(data)
    return data


def printed(kind: str, *arguments: object) -> dict[str, Any]:
    (line,) = run(*arguments, "--json").stdout.splitlines()
    return valid(json.loads(line), kind)


@pytest.mark.parametrize("kind", DOCUMENTS)
def test_schemas_are_schemas(kind: str) -> None:
    Draft202012Validator.check_schema(schema(kind))
    assert schema(kind)["$id"] == f"urn:exactfold:schema:{kind}"


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", SOME)
def test_counts(name: str, method: str) -> None:
    if name in LARGE and method == "groebner":
        method = "homotopy"
    path = example_path(name)
    data = printed("count", "count", path, "--method", method)
    assert (data["status"], data["by"]) == ("proved", "enumeration")
    assert data["pattern"]["name"] == str(path)


@pytest.mark.parametrize("name", SOME)
def test_every_other_command(name: str, tmp_path: Path) -> None:
    path, out, lines = example_path(name), tmp_path / "c.json", tmp_path / "o.jsonl"
    printed("info", "info", path)
    printed("count", "count", path, "--certificate", out)
    assert printed("check", "check", out)["name"] == str(out)
    pattern = read_fold(path)
    up = ",".join(map(str, pattern.foldable_vertices))
    if pattern.Ve == 4:
        printed("count-stream", "count", path, "--stream", tmp_path / "s.txt")
        printed("branch", "branch", path, "--up", up)
        assert printed("actuate", "actuate", path, "--up", up)["status"] == "proved"
        many = run(
            "branch", path, "--up", up, "--neighbours", pattern.foldable_vertices[0], "--json"
        )
        assert [valid(json.loads(line), "branch") for line in many.stdout.splitlines()] != []
    printed("batch", "count", path, tmp_path / "none", "--jobs", 1, "--jsonl", lines)
    counted, failed = (valid(json.loads(x), "batch-line") for x in lines.read_text().splitlines())
    assert (counted["error"], failed["result"]) == (None, None)


@pytest.mark.parametrize(
    "pattern",
    [
        scrambled(2, DENTED, 4, loose=True),
        scrambled(5, HEXAGON, 4, loose=True),
        scrambled(1, TRIANGLE, 3),
        nested_triangles(),
    ],
    ids=["undecided", "hexagon", "rigid", "nested"],
)
def test_other_counts(tmp_path: Path, pattern: CreasePattern) -> None:
    write_fold(pattern, tmp_path / "p.fold")
    data = printed("count", "count", tmp_path / "p.fold")
    by = "enumeration" if data["pieces"] is None else "theorem"
    assert data["by"] == (by if data["status"] == "proved" else None)
    assert printed("info", "info", tmp_path / "p.fold")["triangles"] == len(pattern.triangles)


def test_sheets_of_panels(tmp_path: Path) -> None:
    path, out, lines = tmp_path / "s.cp", tmp_path / "o.fold", tmp_path / "o.jsonl"
    path.write_text(as_cp(SQUARE))
    data = printed("count", "count", path)
    assert (data["theory"], data["status"], data["pattern"]["faces"]) == (
        *("modes", "proved"),
        [[0, 1, 2, 4], [0, 4, 2, 3]],
    )
    assert (
        data["read"]["lines"][0] == f"read {path}: CP, 6 lines (1 mountain, 1 valley, 4 boundary)"
    )
    known = printed("info", "info", path)
    assert (known["triangles"], known["panels"], known["field"]) == (None, 2, "Q")
    converted = printed("convert", "convert", path, out, "--triangulate")
    assert (converted["joins"], converted["output"]) == (["1-4", "3-4"], str(out))
    assert printed("convert", "convert", "two-vertex", out)["read"] is None
    printed("batch", "count", path, tmp_path / "none", "--jobs", 1, "--jsonl", lines)
    found = [valid(json.loads(x), "batch-line") for x in lines.read_text().splitlines()]
    assert sorted(line["status"] for line in found) == ["failed", "proved"]
    for wrong in ({"panels": None}, {"triangles": 2}, {"field": 2}, {"parts": None, "more": 1}):
        with pytest.raises(ValidationError):
            valid({**known, **wrong}, "info")
    for wrong in ({"joins": ["1"]}, {"read": {}}, {"more": 1}):
        with pytest.raises(ValidationError):
            valid({**converted, **wrong}, "convert")


def test_errors_and_invalid_certificates(tmp_path: Path) -> None:
    out = tmp_path / "c.json"
    printed("error", "count", tmp_path / "none.fold")
    printed("examples", "examples")
    printed("export", "export", "two-vertex", "--way", "1", "-o", tmp_path / "b.fold")
    printed("motion", "fold", "two-vertex", "--up", "4", "--frames", "3")
    printed("motion", "fold", "zigzags", "--frames", "3")
    printed("error", "info", written(tmp_path, "{"))
    assert run("count", example_path("two-vertex"), "--certificate", out).exit_code == PROVED
    lines = bodies(out.read_bytes())
    lines[-1]["claims"]["distinct"] = 5
    out.write_bytes(chained(lines))
    data = printed("check", "check", out)
    assert (data["valid"], data["claims"]) == (False, {})


@pytest.mark.parametrize("name", ["two-vertex", "h1-4"])
def test_a_count_stands_alone(name: str) -> None:
    """The pattern and the curvature of every branch, from what was printed and nothing else."""
    data = printed("count", "count", example_path(name))
    pattern = CreasePattern(data["pattern"]["vertices"], data["pattern"]["faces"])
    assert pattern == read_fold(example_path(name))
    for branch in data["branches"]:
        ends = {int(v): map(Fraction, pair) for v, pair in branch["heights"].items()}
        heights = {v: sum(pair) / 2 for v, pair in ends.items()}
        for v in pattern.interior:
            assert abs(curvature_form(pattern, v)(heights)) < Fraction(1, 10**12)


@pytest.mark.slow
def test_schemas_refuse_what_is_not_documented() -> None:
    data = printed("count", "count", example_path("two-vertex"))
    for key in data:
        with pytest.raises(ValidationError):
            valid({k: v for k, v in data.items() if k != key}, "count")
    for wrong in (
        {"more": 1},
        {"distinct": None},
        {"distinct": 4.5},
        {"version": 3},
        {"format": "exactfold branch result"},
        {"by": None},
        {"status": "undecided"},
        {"branches": [{**data["branches"][0], "heights": {"0": [0.5, 0.5]}}]},
        {"pattern": {**data["pattern"], "vertices": [[0, 0], [1, 0], [0, 1]]}},
    ):
        with pytest.raises(ValidationError):
            valid({**data, **wrong}, "count")
    with pytest.raises(ValidationError):
        valid(data, "count-stream")


def test_an_undecided_count_has_no_numbers(tmp_path: Path) -> None:
    write_fold(scrambled(2, DENTED, 4, loose=True), tmp_path / "p.fold")
    result = run("count", tmp_path / "p.fold", "--limit", "1e-9", "--json")
    assert result.exit_code == UNDECIDED
    with pytest.raises(ValidationError):
        valid(json.loads(result.stdout) | {"distinct": 4}, "count")
