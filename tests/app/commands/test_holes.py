"""What commands say of a sheet with a hole."""

import json

import pytest
from running import PROVED, UNDECIDED, run

HOLE = (
    '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 6 6"><path stroke="black" fill="none" '
    'd="M0 0H6V6H0Z M2 2H4V4H2Z"/><path stroke="red" d="M0 0L2 2M6 6L4 4"/>'
    '<path stroke="blue" d="M6 0L4 2M0 6L2 4"/></svg>'
)
"""A square with four creases to the corners of a square hole."""


@pytest.fixture
def sheet(tmp_path):
    path = tmp_path / "hole.svg"
    path.write_text(HOLE)
    return path


def test_count_and_info_take_it(sheet):
    found = run("count", sheet, "--json")
    assert found.exit_code == PROVED
    answer = json.loads(found.stdout)
    assert answer["components"]["true"] == {"1": 2}
    assert len(answer["pattern"]["holes"]) == 1
    assert [way["assignment"]["0-4"] for way in answer["way_list"]] == ["F", "V"]
    facts = run("info", sheet)
    assert facts.exit_code == PROVED
    assert "folds - 3 interior vertices - 6 holes  D = -2" in facts.stdout
    assert "1 part with vertices or holes" in facts.stdout


def test_vertices_say_that_holes_are_not_looked_at(sheet):
    said = run("vertices", sheet).stdout
    assert "the sheet has no interior vertex - PROVED" in said
    assert "whether the panels round a hole fit together is not looked at here" in said


@pytest.mark.parametrize(
    "command",
    [
        ("match",),
        ("flat",),
        ("branch", "--signs", "+"),
        ("actuate", "--way", "1"),
        ("assignments",),
    ],
    ids=" ".join,
)
def test_other_commands_refuse_it(sheet, command):
    name, *options = command
    result = run(name, sheet, *options)
    assert result.exit_code == UNDECIDED
    assert "is not done yet for sheets with holes" in result.stderr


def test_fold_follows_what_closes_round_the_hole(sheet, tmp_path):
    result = run("fold", sheet, "--way", "2", "--until", "60deg", "--frames", "3", "--json")
    assert result.exit_code == PROVED
    answer = json.loads(result.stdout)
    assert (answer["status"], answer["end"]) == ("proved", "angle")
    first = run("fold", sheet, "--until", "60deg", "--frames", "2")
    words = " ".join(first.stdout.split())
    assert "all vertices and holes close exactly at all fold angles" in words
    assert "no way is known with the mountains and valleys of the drawing: this is" in first.stderr
    certified = run("fold", sheet, "--until", "60deg", "--certificate", tmp_path / "c.json")
    assert certified.exit_code == UNDECIDED
    assert "no certificate states that panels close round a hole" in certified.stderr
    assert not (tmp_path / "c.json").exists()


def test_view_shows_the_motions_and_no_flat_states(sheet, tmp_path):
    page = tmp_path / "hole.html"
    assert run("view", sheet, "--frames", "2", "-o", page).exit_code == PROVED
    assert "folding flat is not done yet for sheets with holes" in page.read_text()


def test_convert_keeps_the_hole(sheet, tmp_path):
    assert run("convert", sheet, tmp_path / "hole.fold", "--triangulate").exit_code == PROVED
    again = run("count", tmp_path / "hole.fold", "--json")
    assert json.loads(again.stdout)["components"]["true"] == {"1": 2}
