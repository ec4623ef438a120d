"""`exactfold design`: what it prints and writes, its exit codes, and what it refuses."""

import json
from fractions import Fraction

import pytest
from jsonschema import Draft202012Validator
from running import INVALID, PROVED, UNDECIDED, USAGE, run
from shown import near_miss

import exactfold
from exactfold.design import designed
from exactfold.pattern import PanelPattern, write_fold
from exactfold.pattern.families import two_vertex
from exactfold.pattern.opened import Opened
from exactfold.pattern.writing.fold_writing import document_text, write_text
from exactfold.pattern.writing.panel_writing import converted


def test_command_and_function_give_the_same(tmp_path):
    path = tmp_path / "new.fold"
    result = run("design", "two-vertex", "--maximise", "tolerance", "-o", path, "--json")
    data = json.loads(result.stdout)
    Draft202012Validator(exactfold.schema("design")).validate(data)
    expected = designed(two_vertex(), maximise="tolerance")
    assert result.exit_code == PROVED
    assert (data["before"], data["after"]) == (expected.before, expected.after)
    assert exactfold.read(path).sheet == expected.pattern
    assert data["output"] == str(path)


def test_what_is_shown(tmp_path):
    path = tmp_path / "new.fold"
    result = run("design", "two-vertex", "--way", 1, "--maximise", "margin", "-o", path)
    lines = result.stdout.splitlines()
    assert lines[0] == "status  PROVED (the margin of torques is proved to be larger than before)"
    assert "branch  --" in lines
    assert any(line.startswith("margin  from 0.800706 to ") for line in lines)
    assert lines[-1].endswith("new.fold: 6 vertices, 7 folds, 6 panels")
    assert exactfold.read(path).letters


def test_letters_that_are_there_need_no_move():
    result = run("design", "two-vertex", "--letters", "MVVVMVM")
    assert result.exit_code == PROVED
    assert "moved   by at most 0" in result.stdout


def test_letters_that_are_refuted_or_not_reached(tmp_path):
    result = run("design", "two-vertex", "--letters", "MMMMMMM")
    assert result.exit_code == INVALID
    assert "on no sheet with these" in result.stdout
    pattern, letters = near_miss(4, 3)
    other = "".join(letters[fold] for fold in sorted(letters))
    write_fold(pattern, tmp_path / "p.fold")
    result = run("design", tmp_path / "p.fold", "--letters", other, "--within", "1e-4", "--json")
    data = json.loads(result.stdout)
    assert result.exit_code == UNDECIDED
    assert "keeps another letter" in data["reason"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "--maximise"),
        (["--maximise", "margin"], "about one way"),
        (["--maximise", "stroke"], "about one way"),
        (["--maximise", "beauty"], "none of tolerance, margin, stroke"),
        (["--maximise", "tolerance", "--within", "0"], "is not positive"),
        (["--maximise", "tolerance", "--fixed", "a"], "--fixed takes vertex indices"),
        (["--maximise", "tolerance", "-o", "new.svg"], "new.svg"),
    ],
)
def test_what_is_refused(options, words):
    result = run("design", "two-vertex", *options)
    assert result.exit_code == USAGE
    assert words in result.stderr


def test_panels_are_written_with_their_letters_and_read_again(tmp_path):
    path = tmp_path / "new.fold"
    result = run("design", "map-fold", "--letters", "drawn", "-o", path, "--json")
    data = json.loads(result.stdout)
    Draft202012Validator(exactfold.schema("design")).validate(data)
    assert result.exit_code == PROVED
    assert (data["goal"], data["before"], data["after"]) == ("letters", None, None)
    assert data["largest_move"] > 0
    again = exactfold.read(path)
    assert {str(x) for x, _ in again.sheet.vertices} == {x for x, _ in data["pattern"]["vertices"]}
    assert run("match", path).exit_code == PROVED
    same = run("design", path, "--letters", "drawn", "--symmetric", "--border", "free")
    assert "PROVED" in same.stdout
    assert "moved" not in same.stdout


@pytest.mark.parametrize(("off", "nearly"), [("1/500000", True), ("0", False)])
def test_where_the_new_sheet_may_be_taken_for_an_inexact_drawing_a_line_says_so(
    off, nearly, tmp_path
):
    """The border is bent a little at vertex 1, or not."""
    rim = [(2 + Fraction(off), 0), (2, 2), (0, 2), (-2, 2), (-2, 1), (-2, -2), (1, -2), (2, -2)]
    edges = [(k, k % 8 + 1) for k in range(1, 9)] + [(0, 1), (0, 3), (0, 5), (0, 7)]
    sheet = PanelPattern([(0, 0), *rim], edges)
    write_text(tmp_path / "a.fold", document_text(converted(Opened(sheet, {})).document()))
    options = ["--way", 1, "--snap", "exact", "-o", tmp_path / "b.fold"]
    found = run("design", tmp_path / "a.fold", *options)
    assert found.exit_code == PROVED
    said = "other commands need --snap exact" in " ".join(found.stdout.split())
    assert said == nearly
    as_written = exactfold.read(tmp_path / "b.fold", snap="exact")
    assert as_written.sheet.vertices == sheet.vertices
    taken = exactfold.read(tmp_path / "b.fold")
    assert (taken.sheet.vertices != sheet.vertices) == nearly
    assert run("match", tmp_path / "b.fold", "--snap", "exact").exit_code == PROVED


def test_a_way_of_panels_gives_its_letters():
    result = run("design", "miura", "--way", 1)
    assert result.exit_code == PROVED
    assert result.stdout.startswith("status  PROVED (true motions of the panels begin")


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ([], USAGE, "give --letters"),
        (["--way", 99], USAGE, "there is no way 99"),
        (["--letters", "drawn", "--border", "none"], USAGE, "none of along, free"),
        (["--letters", "drawn", "--maximise", "stroke"], UNDECIDED, "letters, alone or with"),
    ],
)
def test_what_is_refused_of_panels(options, code, words):
    result = run("design", "miura", *options)
    assert result.exit_code == code
    assert words in result.stderr
