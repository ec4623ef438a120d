"""`exactfold tolerance`: what it prints and draws, its exit codes, and what it refuses."""

import json

import pytest
from jsonschema import Draft202012Validator
from running import BAD_INPUT, PROVED, UNDECIDED, USAGE, run

import exactfold
from exactfold.pattern import write_fold


def valid(text):
    data = json.loads(text)
    Draft202012Validator(exactfold.schema("tolerance")).validate(data)
    return data


@pytest.mark.parametrize("sheet", ["two-vertex", "zigzags"])
def test_command_and_function_give_the_same(sheet):
    result = run("tolerance", sheet, "--way", 1, "--json")
    data, expected = valid(result.stdout), exactfold.tolerance(sheet, way=1).to_dict(sheet)
    assert result.exit_code == PROVED
    for key in ("seconds", "pattern"):
        assert data.pop(key) is not None
        expected.pop(key)
    assert data == json.loads(json.dumps(expected))


def test_what_is_shown():
    lines = run("tolerance", "two-vertex", "--signs", "+-").stdout.splitlines()
    assert "way       branch +-" in lines
    assert lines[0].startswith("status    PROVED (all sheets whose vertices move by less than the")
    assert any(line.startswith("radius    0.0177") for line in lines)
    assert any("on branch +- fold 1-4 has the letter M, not V" in line for line in lines)
    assert any(line.split() == ["3", "0.0273536"] for line in lines)


def test_relations_are_shown():
    text = run("tolerance", "square-twist", "--way", 1).stdout
    assert "  1  the folds round the loop 4-5-6-7 " in text
    assert "vertex 4: 0.0271" in text
    assert "may move alone" not in text


@pytest.mark.slow
def test_a_picture_has_a_circle_round_each_vertex(tmp_path):
    path = tmp_path / "circles.svg"
    result = run("tolerance", "two-vertex", "-o", path)
    assert result.exit_code == PROVED
    text = path.read_text()
    assert text.count('class="alone"') == text.count('class="together"') == 6
    assert "all move (green)" in text
    write_fold(exactfold.random_square(6, seed=1), tmp_path / "p.fold")
    assert run("tolerance", tmp_path / "p.fold", "-o", path).exit_code == PROVED
    assert "times as large" in path.read_text()
    assert run("tolerance", "zigzags", "-o", path).exit_code == PROVED
    assert "no radius is positive" in path.read_text()


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["two-vertex", "--way", "9"], USAGE, "there is no way 9"),
        (["two-vertex", "--way", "1", "--signs", "++"], USAGE, "one of --way"),
        (["two-vertex", "--seed", "-1"], USAGE, "less than 0"),
        (["two-vertex", "-o", "picture.txt"], USAGE, "picture.txt"),
        (["waterbomb"], UNDECIDED, "form families"),
        (["none.fold"], BAD_INPUT, "none.fold"),
    ],
)
def test_what_is_refused(options, code, words):
    result = run("tolerance", *options)
    assert result.exit_code == code
    assert words in result.stderr
    assert result.stdout == ""


def test_the_radius_has_a_certificate(tmp_path):
    proof = tmp_path / "radius.json"
    result = run("tolerance", "two-vertex", "--signs", "+-", "--certificate", str(proof))
    assert result.exit_code == PROVED
    assert f"wrote {proof}: the evidence for `exactfold check`" in result.stderr + result.stdout
    assert "have 1 way with the letters of the file; sha256" in run("check", str(proof)).stdout


def test_where_there_is_no_certificate_this_is_said(tmp_path):
    proof = tmp_path / "radius.json"
    result = run("tolerance", "zigzags", "--way", 2, "--certificate", str(proof))
    assert result.exit_code == PROVED
    assert "no certificate was written: only a radius that is proved has" in result.stderr
    assert not proof.exists()
