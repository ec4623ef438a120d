"""The survey of flat-folded states on a few small sheets, and that no file is passed over."""

import csv
import json
from pathlib import Path

import flat_states
import pytest

MAP = {
    "vertices_coords": [[x, y] for y in (0, 1) for x in range(4)],
    "edges_vertices": [
        [0, 1],
        [1, 2],
        [2, 3],
        [3, 7],
        [7, 6],
        [6, 5],
        [5, 4],
        [4, 0],
        [1, 5],
        [2, 6],
    ],
    "edges_assignment": [*"BBBBBBBBVV"],
    "faces_vertices": [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6]],
}
CORNER = {  # a vertex with three mountains and a valley folds flat; two of each do not
    "vertices_coords": [[1, 1], [0, 0], [1, 0], [2, 0], [2, 1], [2, 2], [1, 2], [0, 2], [0, 1]],
    "edges_vertices": [*([i, i % 8 + 1] for i in range(1, 9)), *([0, i] for i in (2, 4, 6, 8))],
    "edges_assignment": [*"BBBBBBBBMMVV"],
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "files"
    folder.mkdir()
    (folder / "letter.fold").write_text(json.dumps(MAP))
    (folder / "corner.fold").write_text(json.dumps(CORNER))
    (folder / "broken.cp").write_text("no lines")
    return folder


def rows(table: Path) -> dict[str, dict[str, str]]:
    return {Path(row["file"]).stem: row for row in csv.DictReader(table.open())}


def test_every_file_has_a_row_and_the_run_goes_on_where_it_stopped(folder: Path, tmp_path: Path):
    table = tmp_path / "t.csv"
    flat_states.run(folder, "letter", table, None)
    assert [*rows(table)] == ["letter"]
    found = flat_states.run(folder, "", table, None)
    assert [*rows(table)] == ["letter", "broken", "corner"]  # then the smallest file first
    assert {Path(row["file"]).stem: row["answer"] for row in found} == {
        "broken": "not read",
        "corner": "not locally flat",
        "letter": "states",
    }
    assert rows(table)["letter"]["states"] == "2"
    assert rows(table)["letter"]["pairs"] == "3"
    assert rows(table)["corner"]["why"] == "1 letters or degrees, 0 angles by 0"
    assert "| states | 1 | 0 | 0 | 0 |" in flat_states.summary(found)


def busy(*_: object, progress, **__: object) -> None:
    progress("overlaps", 0, 0)
    while True:
        pass


def test_a_file_that_takes_too_long_says_at_which_step(folder: Path, tmp_path: Path, monkeypatch):
    monkeypatch.setattr(flat_states, "fold_flat", busy)
    monkeypatch.setattr(flat_states, "LIMIT", 0)
    (row,) = flat_states.run(folder, "letter", tmp_path / "t.csv", None)
    assert (row["answer"], row["why"]) == ("undecided", "not ended in 60 s: overlaps")


def test_a_program_that_claims_another_number_is_reported(
    folder: Path, tmp_path: Path, monkeypatch
):
    """A stand-in for Node, which has seen the sheet with its letters and claims 3 states."""
    node = tmp_path / "bin" / "node"
    node.parent.mkdir()
    claims = '{"states": "3", "limited": false, "seconds": 0.5}'
    node.write_text(f"#!/bin/sh\ngrep -q '\"B\", \"V\"' $3 && echo '{claims}'\n")
    node.chmod(0o755)
    monkeypatch.setenv("PATH", str(node.parent), prepend=":")
    (row,) = flat_states.run(folder, "letter", tmp_path / "t.csv", tmp_path)
    assert (row["flat_folder"], row["agree"]) == ("3", "no")
    assert "| states | 1 | 0 | 1 | 0 |" in flat_states.summary([row])


@pytest.mark.parametrize(
    ("ours", "other", "agree"),
    [
        ("2", "2", "yes"),
        ("2", "3", "no"),
        ("5", "3+", "yes"),
        ("2", "3+", "no"),
        ("", "3", ""),
        ("2", "no epsilon found", ""),
    ],
)
def test_agreement(ours: str, other: str, agree: str):
    assert flat_states.agreement({"states": ours, "flat_folder": other}) == agree
