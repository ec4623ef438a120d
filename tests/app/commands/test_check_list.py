"""`exactfold check --list`: the branches of a certificate, as `count` lists them."""

from __future__ import annotations

import json
import re
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from compact_files import bodies, chained
from jsonschema import Draft202012Validator
from old_listing import old_listing
from running import BAD_INPUT, INVALID, PROVED, USAGE, error_class, run
from sampling import slow_after

from exactfold import random_square, schema
from exactfold.branches import certificate, count_branches
from exactfold.branches.counting import by_theorem
from exactfold.certificates import write_certificate
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.degenerate import DEGENERATE

FIXTURES = Path(__file__).parents[2] / "fixtures" / "certificates"


def checked(*arguments: object) -> dict[str, Any]:
    result = run("check", *arguments, "--json")
    assert result.exit_code == PROVED
    data: dict[str, Any] = json.loads(result.stdout)
    Draft202012Validator(schema("check")).validate(data)
    return data


@pytest.mark.parametrize("name", slow_after(3, SHEETS))
def test_the_list_is_that_of_count(tmp_path: Path, name: str) -> None:
    """Branch by branch, with all bounds of heights, of every shipped pattern."""
    file = tmp_path / "c.txt"
    counted = json.loads(run("count", example_path(name), "--json", "--certificate", file).stdout)
    assert checked(file, "--list")["branches"] == counted["branches"]
    assert "branches" not in checked(file)


@pytest.mark.parametrize("name", ["grid", "bent-off-path", "straight-path", "notched"])
def test_multiple_and_reflex_branches_are_listed(tmp_path: Path, name: str) -> None:
    result = count_branches(DEGENERATE[name]())
    listed = [branch.entry() for branch in result.branches]
    for made in (old_listing(result), certificate(result)):
        file = tmp_path / "c.txt"
        write_certificate(made, file)
        assert checked(file, "--list")["branches"] == listed


def test_a_streamed_file_is_listed_in_the_order_of_count(tmp_path: Path) -> None:
    counted = json.loads(run("count", "random-8", "--json").stdout)
    assert run("count", "random-8", "--stream", tmp_path / "c.txt").exit_code == PROVED
    assert checked(tmp_path / "c.txt", "--list")["branches"] == counted["branches"]


def test_the_table_is_that_of_count(tmp_path: Path) -> None:
    """Whatever comes between the answer and the table."""
    file = tmp_path / "c.txt"
    counted = run("count", "flat-vertex", "--all", "--certificate", file).stdout
    listed = run("check", file, "--list").stdout
    assert listed.startswith("VALID: 3 branches (4 with multiplicity")
    table = counted[counted.index("way  ") :]
    assert table.count("\n") > 6
    assert listed.endswith(table)


def test_heights_and_angles(tmp_path: Path) -> None:
    file = tmp_path / "c.txt"
    assert run("count", "two-vertex", "--certificate", file).exit_code == PROVED
    result = count_branches("two-vertex")
    text = " ".join(run("check", file, "--heights").stdout.split())
    for way, branch in enumerate(result.branches, 1):
        (said,) = re.findall(rf"way {way}, heights: (.*?) way", text)
        for part in said.split(", "):
            vertex, bounds = part.split(": ")
            low, high = branch.heights[int(vertex)]
            ends = [Fraction(Decimal(x)) for x in bounds.split(" to ")]
            assert ends[0] <= low <= high <= ends[-1]
            assert ends[-1] - ends[0] < Fraction(1, 10**9)
    data = checked(file, "--heights")["branches"]
    for branch, listed in zip(result.branches, data, strict=True):
        angles = {fold: float(angle) for fold, angle in listed.pop("angles").items()}
        assert listed == branch.entry()
        assert max(map(abs, angles.values())) == 1
        degrees = branch.fold_angles.degrees(1)
        assert angles == pytest.approx({f"{i}-{j}": a for (i, j), a in degrees.items()}, abs=1e-5)


def test_sheets_without_a_branch_to_list(tmp_path: Path) -> None:
    for name in ("compact-roots-rigid.txt", "compact-roots-single-vertex.txt", "rigid-nested.json"):
        result = run("check", FIXTURES / name, "--list")
        assert result.exit_code == PROVED
        assert "none is listed" in result.stdout
        assert checked(FIXTURES / name, "--list")["branches"] == []


def test_nothing_is_listed_of_a_file_that_does_not_hold(tmp_path: Path) -> None:
    lines = bodies((FIXTURES / "compact-roots-classes.txt").read_bytes())
    lines[1]["roots"][0]["multiplicity"] = 2
    file = tmp_path / "c.txt"
    file.write_bytes(chained(lines))
    result = run("check", file, "--list")
    assert (result.exit_code, result.stdout) == (INVALID, "INVALID: branch 0: multiplicity is 1\n")
    data = json.loads(run("check", file, "--list", "--json").stdout)
    assert data["valid"] is False
    assert "branches" not in data


@pytest.mark.parametrize("name", ["branch-dart.json", "loops-one-vertex.txt", "panels-bent.json"])
def test_other_certificates_list_no_branches(name: str) -> None:
    result = run("check", FIXTURES / name, "--list")
    assert result.exit_code == BAD_INPUT
    assert "does not list the branches of a triangulated sheet" in result.stderr
    assert error_class(run("check", FIXTURES / name, "--list", "--json")) == (
        "CertificateFormatError"
    )


def test_more_branches_than_memory_holds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "c.txt"
    write_certificate(certificate(count_branches(random_square(4, seed=1))), file)
    monkeypatch.setattr(by_theorem, "IN_MEMORY", 4)
    assert len(checked(file, "--list")["branches"]) == 16
    monkeypatch.setattr(by_theorem, "IN_MEMORY", 3)
    result = run("check", file, "--list")
    assert result.exit_code == USAGE
    assert "16 branches are too many to list here, though every claim holds" in result.stderr
