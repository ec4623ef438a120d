"""The command `flat`: what it prints, its JSON and its exit codes."""

from __future__ import annotations

import json
from math import pi

import pytest
from jsonschema import Draft202012Validator
from running import BAD_INPUT, INVALID, PROVED, UNDECIDED, USAGE, run

import exactfold

VALIDATOR = Draft202012Validator(exactfold.schema("flat"))


def printed(*arguments):
    done = run("flat", *arguments, "--json")
    data = json.loads(done.stdout)
    VALIDATOR.validate(data)
    return done.exit_code, data


def test_a_sheet_that_folds_flat():
    code, data = printed("map-fold")
    assert (code, data["status"], data["locally_flat"]) == (PROVED, "proved", "proved")
    assert (data["states"], data["components"], data["letters_used"]) == (1, [], "drawn")
    assert (data["pieces"], data["overlaps"], data["reason"]) == (8, 28, "")


def test_any_letters_and_the_parts_whose_product_is_the_number():
    code, data = printed("square-twist", "--any")
    assert (code, data["states"], data["components"]) == (PROVED, 4, [2, 2])
    assert (data["letters_used"], set(data["letters"].values())) == ("any", {"U"})


def test_given_letters():
    code, data = printed("single-vertex-4", "--letters", "MMMV")
    assert (code, data["states"], data["letters_used"]) == (PROVED, 1, "given")
    code, data = printed("single-vertex-4", "--letters", "MMVV")
    assert (code, data["states"], data["locally_flat"]) == (INVALID, 0, "refuted")
    assert data["vertices"] == [{"vertex": 4, "condition": "maekawa", "off": None, "excess": 0}]
    assert data["reason"] == (
        "at vertex 4 there are as many mountains as valleys, and it has to be 2 (Maekawa)"
    )


def test_a_vertex_that_does_not_fold_flat():
    code, data = printed("zigzags")
    assert (code, data["states"], data["pieces"]) == (INVALID, 0, 0)
    assert [one["vertex"] for one in data["vertices"]] == [9, 10, 13, 14]
    assert {one["condition"] for one in data["vertices"]} == {"kawasaki"}
    text = run("flat", "zigzags").stdout
    assert text.startswith("not flat-foldable with the drawn mountains and valleys: 4 vertices")
    odd = run("flat", "flat-octahedron", "--all").stdout
    assert "1. at vertex 4 the number of folded creases is odd (Kawasaki)" in odd
    assert odd.count("(Kawasaki)") == 6


def test_panels_that_cross_whatever_the_order():
    code, data = printed("square-twist")
    assert (code, data["status"], data["locally_flat"]) == (INVALID, "refuted", "proved")
    kinds = [one["kind"] for one in data["conflict"]]
    assert kinds == ["letter", "letter", "taco-tortilla", "taco-tortilla"]
    assert data["reason"] == (
        "panels 5, 6 and 7 cross whatever the order of layers: 4 conditions contradict each other"
    )


def test_the_limit_ends_the_search():
    code, data = printed("map-fold", "--any", "--limit", "1e-9")
    assert (code, data["status"], data["states"]) == (UNDECIDED, "undecided", None)
    text = run("flat", "map-fold", "--limit", "1e-9").stdout
    assert "whether the sheet folds flat with the drawn mountains and valleys is open" in text


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        (("map-fold", "--any", "--letters", "drawn"), USAGE),
        (("waterbomb", "--letters", "drawn"), USAGE),
        (("map-fold", "--letters", "MMM"), USAGE),
        (("no-such-sheet",), BAD_INPUT),
    ],
)
def test_wrong_usage_and_bad_input(arguments, code):
    assert run("flat", *arguments).exit_code == code


@pytest.mark.slow
def test_where_ways_end():
    code, data = printed("fish-base", "--ways", "--letters", "FVVMVVMVV", "--limit", "600")
    assert code == PROVED
    ends = data["ways"]
    assert [end["status"] for end in ends] == ["proved"] * 4
    assert [end["clear"] for end in ends] == [pi] * 4
    assert [(end["state"], end["mirrored"]) for end in ends].count((0, None)) == 1
    assert ends[0]["letters"]["0-2"] == "F"
    assert printed("fish-base")[1]["ways"] is None


def test_ways_in_words():
    text = run("flat", "zigzags", "--ways", "--limit", "600").stdout
    assert "Where the ways of the sheet end\nway 1: not all folds that move are known" in text
    assert "run into each other by 120.01 degrees of\nthe driving folds - REFUTED" in text
    other = run("flat", "single-vertex-4", "--ways")
    assert other.exit_code == USAGE
    assert "its ways are branches" in other.stderr
    assert "no way is known along which" in run("flat", "bird-base", "--ways").stdout


def test_certificates(tmp_path):
    """What is proved is written, and verified; what is not is said."""
    for number, (name, *options, said) in enumerate(
        (
            (
                "square-twist",
                "--any",
                "the sheet has exactly 4 flat-folded states with any letters",
            ),
            ("square-twist", "every order of layers has a crossing"),
            ("zigzags", "the folds do not close at vertex 9"),
        )
    ):
        path = tmp_path / f"{number}.json"
        run("flat", name, *options, "--certificate", str(path))
        assert said in run("check", str(path)).stdout
    path = tmp_path / "none.json"
    done = run("flat", "bird-base", "--any", "--limit", "0.001", "--certificate", str(path))
    assert "no certificate was written: nothing is decided" in done.stderr
    assert not path.exists()


def test_a_state_is_drawn_and_written(tmp_path):
    for ending, start in [("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF"), ("fold", b"{")]:
        file = tmp_path / f"state.{ending}"
        done = run("flat", "waterbomb", "--state", "17", "-o", file)
        assert done.exit_code == PROVED
        assert done.stdout.endswith(f"state.{ending}: state 17, from 0, of 18 listed\n")
        assert file.read_bytes().startswith(start)
    document = json.loads((tmp_path / "state.fold").read_text("utf-8"))
    assert document["file_frames"][0]["frame_title"] == "flat-folded state 17"
    code, data = printed("waterbomb", "-o", tmp_path / "state.svg")
    assert (code, data["states"]) == (PROVED, 18)


def test_why_there_is_no_state_is_drawn(tmp_path):
    file = tmp_path / "why.svg"
    assert run("flat", "zigzags", "-o", file).exit_code == INVALID
    assert "1. at vertex 9 every second sector" in file.read_text("utf-8")
    fold = tmp_path / "state.fold"
    done = run("flat", "zigzags", "-o", fold)
    assert done.exit_code == INVALID
    assert "was not written: no flat-folded state is known" in done.stderr
    assert not fold.exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("-o", "state.txt"), "a folded sheet is written as .svg, .png, .pdf, .fold"),
        (("--state", "0"), "give -o FILE, too"),
        (("-o", "state.svg", "--state", "1"), "there is no state 1: 1 are listed, from 0"),
        (("-o", "state.svg", "--certificate", "state.svg"), "already reads or writes"),
    ],
)
def test_wrong_outputs(arguments, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run("flat", "miura", *arguments)
    assert done.exit_code == USAGE
    assert words in done.stderr
    assert not list(tmp_path.iterdir())
