"""Sheets with more branches than can be listed: what the theorem says, at once."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from running import UNDECIDED, run
from sheets import dart, nested_triangles, reflex_corners, scrambled

from exactfold import random_square, schema
from exactfold._support.verdict import PROVED
from exactfold._support.verdict import UNDECIDED as OPEN
from exactfold.app.shell.shell import Bar
from exactfold.branches import METHODS, count_branches
from exactfold.branches.counting import by_theorem
from exactfold.branches.counting.by_theorem import too_many
from exactfold.pattern import families, write_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.random_squares import sample_random_square


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("large") / "p.fold"
    write_fold(random_square(41, seed=1), path)
    return path


@pytest.mark.parametrize("method", METHODS)
def test_no_method_starts(large: Path, method: str) -> None:
    result = run("count", large, "--json", "--method", method)
    assert result.exit_code == UNDECIDED
    assert result.stderr == ""
    data = json.loads(result.stdout)
    Draft202012Validator(schema("count")).validate(data)
    assert (data["status"], data["by"], data["distinct"], data["real"]) == (
        "undecided",
        "theorem",
        None,
        None,
    )
    assert (data["with_multiplicity"], data["nonreal"], data["degree"]) == (2**41, 0, 2**41)
    assert "--stream" in data["reason"]
    assert "up to 40" in data["reason"]
    assert "exactfold branch" in data["reason"]


def test_what_is_said(large: Path, tmp_path: Path) -> None:
    result = run("count", large, "--certificate", tmp_path / "c.json")
    assert result.exit_code == UNDECIDED
    assert " ".join(result.stdout.split()).startswith(
        "2^41 ways to start folding with multiplicity, all real, by Theorem 2; how many of "
        "them are different is UNDECIDED"
    )
    assert not (tmp_path / "c.json").exists()
    refused = run("count", large, "--stream", tmp_path / "s.txt")
    assert refused.exit_code == UNDECIDED
    assert "2^41 are too many to list" in refused.stderr


def test_numbers_beyond_those_of_other_programs_are_text() -> None:
    data = count_branches(sample_random_square(60, 1, redraw=True).pattern).to_dict()
    assert (data["with_multiplicity"], data["degree"]) == ("2^60", "2^60")
    Draft202012Validator(schema("count")).validate(data)


@pytest.mark.parametrize(
    "pattern",
    [
        random_square(3, seed=1),
        nested_triangles(),
        families.FAMILIES["flat-vertex"](),
        dart(),
        scrambled(1, reflex_corners(5), 3),
    ],
)
def test_the_theorem_agrees_with_enumeration(
    pattern: CreasePattern, monkeypatch: pytest.MonkeyPatch
) -> None:
    listed = count_branches(pattern)
    assert listed.status is PROVED
    monkeypatch.setattr(by_theorem, "LIMIT", 0)
    monkeypatch.setattr("exactfold.branches.counting.collect.IN_MEMORY", 0)
    said = count_branches(pattern)
    assert (said.status, said.by) == (OPEN, "theorem")
    assert said.reason == too_many(pattern).reason
    for name in ("with_multiplicity", "nonreal", "dimension", "degree"):
        assert getattr(said, name) == getattr(listed, name)


def test_other_sheets_are_counted_whatever_their_size() -> None:
    assert count_branches(families.single_vertex(50)).status is PROVED


def test_progress_of_totals_beyond_machine_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    with Bar("reading", delay=3600) as bar:
        bar.show()
        assert bar.display is not None
        for done in (0, 1 << 79):
            bar("solving", done, 1 << 80)
            bar.display.progress.refresh()
        (task,) = bar.display.progress.tasks
        assert (task.completed, task.total) == (0.5, 1)
        assert task.fields["count"] == f"{1 << 79}/{1 << 80}"
