"""`exactfold fold`: what it writes, prints and refuses."""

from __future__ import annotations

import json

import pytest
from drawings import SQUARE, as_cp
from jsonschema import Draft202012Validator
from running import BAD_INPUT, UNDECIDED, USAGE, error_class, run
from sheets import HEXAGON, TRIANGLE, scrambled

from exactfold import find_branch, follow, random_square, schema, write_fold
from exactfold.bridges import meshes
from exactfold.pattern.degenerate import ringed_square
from exactfold.pattern.families import single_vertex

OK = 0


def test_the_table_says_where_and_why_a_motion_ends():
    result = run("fold", "two-vertex", "--signs", "+-")
    assert (result.exit_code, result.stderr) == (OK, "")
    motion = follow(find_branch("two-vertex", "+-"))
    assert f"end              time {motion.duration:.6g}: fold 3-5 closes" in result.stdout
    assert "followed in floats: not proved" in result.stdout
    assert "MVVVMVM" in result.stdout
    assert "largest angles   3-5 180," in result.stdout
    assert "flat-fold  fold 3-5 closes: its two faces meet" in result.stdout


def test_the_other_side_is_the_mirror_image():
    result = run("fold", "two-vertex", "--signs", "+-", "--side", "-")
    assert result.exit_code == OK
    assert "VMMMVMV" in result.stdout
    assert "3-5 -180," in result.stdout


def test_long_lists_of_folds_that_turn_back_are_cut(tmp_path):
    result = run("fold", "random-8", "--up", "", "--until", "return", "--through-nodes")
    lines = result.stdout.splitlines()
    assert sum("  turning " in line for line in lines) == 8
    assert "more folds turn back (--json lists all)" in lines[-1]
    assert "return     the sheet is flat again" in result.stdout


def test_without_a_branch_all_vertices_pop_up():
    result = run("fold", "two-vertex", "--json")
    assert result.exit_code == OK
    assert "no branch was named" in result.stderr
    assert json.loads(result.stdout)["vertex_signs"] == {"4": 1, "5": 1}


@pytest.mark.parametrize(
    "how", [["--signs", "+-"], ["--up", "4"], ["--branch", "3"]], ids=["signs", "up", "place"]
)
def test_json_is_that_of_python(how, tmp_path):
    out, plot = tmp_path / "m.fold", tmp_path / "a.svg"
    result = run("fold", "two-vertex", *how, "--frames", 7, "-o", out, "--plot", plot, "--json")
    assert (result.exit_code, result.stderr) == (OK, "")
    data = json.loads(result.stdout)
    Draft202012Validator(schema("motion")).validate(data)
    expected = follow(find_branch("two-vertex", "+-"), frames=7).report(
        "two-vertex", [str(out), str(plot)]
    )
    assert data["duration"] == pytest.approx(expected["duration"])
    if "--branch" not in how:  # bounds from a count are others, so that digits differ
        assert data | {"seconds": 0} == expected | {"seconds": 0}
    assert data["vertex_signs"] == expected["vertex_signs"]
    assert data["status"] == "followed"
    assert data["frames"]["number"] == len(data["frames"]["times"]) == 7
    assert plot.read_text().startswith("<svg ")
    assert len(json.loads(out.read_text())["file_frames"]) == 7


@pytest.mark.parametrize("ending", ["fold", "glb", "gltf", "obj"])
def test_files_of_every_kind(ending, tmp_path):
    result = run("fold", "two-vertex", "--up", "4", "--frames", 6, "-o", tmp_path / f"m.{ending}")
    assert result.exit_code == OK
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ([f"m_000{k}.obj" for k in range(6)] if ending == "obj" else [f"m.{ending}"])
    assert str(tmp_path / names[0]) in result.stdout.replace("\n", "").replace(" " * 17, "")
    assert str(tmp_path / names[-1]) in result.stdout.replace("\n", "").replace(" " * 17, "")


def test_frames_by_a_fold_until_an_angle():
    options = ("--until", "45deg", "--by", "5-3", "--frames", 4, "--json")
    data = json.loads(run("fold", "two-vertex", "--signs", "+-", *options).stdout)
    assert data["end"] == data["events"][-1]["kind"] == "angle"
    assert [abs(x) for x in data["angles"]["3-5"]] == pytest.approx([0, 15, 30, 45])
    assert data["largest_angles"]["3-5"] == data["angles"]["3-5"][-1]


# --- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--signs", "++", "--up", "4"], "one of --signs, --up and --branch"),
        (["--signs", "+"], "1 sign for 2 vertices"),
        (["--signs", "++", "--side", "x"], "'x' is neither + nor -"),
        (["--signs", "++", "--until", "never"], "until 'never'"),
        (["--signs", "++", "--until", "-3"], "until '-3'"),
        (["--signs", "++", "--frames", "1"], "1 is less than 2"),
        (["--signs", "++", "--by", "4"], "'4' is not a fold such as 4-7"),
        (["--signs", "++", "--by", "0-1"], "no fold 0-1"),
        (["--signs", "++", "-o", "m.stl"], "a motion is written as .fold"),
        (["--signs", "++", "-o", "-"], "an output has a name of its own"),
        (["--signs", "++", "-o", "a.fold", "--plot", "a.fold"], "name another file"),
    ],
)
def test_wrong_usage_is_one_line(options, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("fold", "two-vertex", *options)
    assert result.exit_code == USAGE
    assert words in result.stderr
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        (scrambled(1, HEXAGON, 2, loose=True), "boundary"),
        (scrambled(1, TRIANGLE, 3), "boundary"),
        (single_vertex(5), "boundary"),
    ],
    ids=["hexagon", "triangle", "five"],
)
def test_sheets_that_have_no_single_motion(pattern, words, tmp_path):
    write_fold(pattern, tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold")
    assert result.exit_code == UNDECIDED
    assert words in result.stderr


def test_sheets_of_panels(tmp_path):
    (tmp_path / "s.cp").write_text(as_cp(SQUARE))
    result = run("fold", tmp_path / "s.cp", "--json")
    assert result.exit_code == UNDECIDED
    assert error_class(result) == "NotTriangulatedError"
    assert "fold takes triangulated sheets" in result.stderr


def test_a_branch_with_a_flat_vertex_is_not_followed():
    result = run("fold", "flat-vertex", "--signs", "+0", "--json")
    assert result.exit_code == UNDECIDED
    assert "vertex 5 is flat on this branch: several curves may be tangent to it" in result.stderr
    assert error_class(result) == "NotFollowedError"


def test_a_branch_that_is_not_proved_is_not_followed_where_it_is_not_simple(tmp_path):
    write_fold(ringed_square(4), tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold", "--signs", "+++++")
    assert result.exit_code == UNDECIDED
    assert "it is not simple, or too close to another one for floats" in result.stderr


def test_folds_that_stay_flat_do_not_turn_back(tmp_path):
    pattern = ringed_square(4)
    write_fold(pattern, tmp_path / "p.fold")
    data = json.loads(run("fold", tmp_path / "p.fold", "--signs=---+-", "--json").stdout)
    flat = {fold for fold, letter in data["assignment"].items() if letter == "F"}
    assert len(flat) == 2
    turning = {
        fold for event in data["events"] if event["kind"] == "turning" for fold in event["folds"]
    }
    assert turning
    assert not turning & flat
    assert max(abs(data["largest_angles"][fold]) for fold in flat) < 1e-9


def test_files_that_cannot_be_written(tmp_path, monkeypatch):
    result = run("fold", "two-vertex", "--up", "4", "-o", tmp_path / "none" / "m.fold")
    assert result.exit_code == BAD_INPUT
    assert "cannot write" in result.stderr
    monkeypatch.setattr(meshes, "find_spec", lambda name: None)
    result = run("fold", "two-vertex", "--up", "4", "-o", tmp_path / "m.glb", "--json")
    assert result.exit_code == USAGE
    assert error_class(result) == "GltfMissingError"


def test_large_sheets_are_followed(tmp_path):
    write_fold(random_square(40, seed=2), tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold", "--up", "", "--until", "20deg", "--frames", 3)
    assert result.exit_code == OK
    assert "... (--json has all)" not in result.stdout
    assert "fold" in result.stdout
