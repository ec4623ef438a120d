"""`exactfold fold`: what it writes, prints and refuses."""

from __future__ import annotations

import json
import re
from fractions import Fraction
from math import atan, pi

import pytest
from drawings import SQUARE, as_cp
from jsonschema import Draft202012Validator
from panel_sheets import miura
from running import BAD_INPUT, PROVED, UNDECIDED, USAGE, error_class, run
from sheets import TRIANGLE, scrambled

from exactfold import random_square, schema
from exactfold.branches import count_ways, find_branch
from exactfold.motion import follow, follow_panels
from exactfold.pattern import write_fold
from exactfold.pattern.degenerate import ringed_square
from exactfold.pattern.opening import Opened
from exactfold.pattern.writing.panel_writing import converted

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


@pytest.mark.slow
def test_long_lists_of_folds_that_turn_back_are_cut(tmp_path):
    result = run("fold", "random-8", "--up", "", "--until", "return", "--through-nodes")
    lines = result.stdout.splitlines()
    assert sum("  turning " in line for line in lines) == 8
    assert "more folds turn back (--json lists all)" in lines[-1]
    assert "return     the sheet is flat again" in result.stdout


def test_without_a_branch_all_vertices_pop_up():
    result = run("fold", "two-vertex", "--json")
    assert result.exit_code == OK
    assert "no way was named" in result.stderr
    assert json.loads(result.stdout)["vertex_signs"] == {"4": 1, "5": 1}


@pytest.mark.parametrize(
    "how",
    [["--signs", "+-"], ["--up", "4"], ["--letters", "MVVVMVM"], ["--way", "3"]],
    ids=["signs", "up", "letters", "way"],
)
def test_json_is_that_of_python(how, tmp_path):
    out, plot = tmp_path / "m.fold", tmp_path / "a.svg"
    result = run("fold", "two-vertex", *how, "--frames", 7, "-o", out, "--plot", plot, "--json")
    assert (result.exit_code, result.stderr) == (OK, "")
    data = json.loads(result.stdout)
    Draft202012Validator(schema("motion")).validate(data)
    expected = follow(find_branch("two-vertex", "+-"), frames=7).to_dict(
        "two-vertex", [str(out), str(plot)]
    )
    assert data["duration"] == pytest.approx(expected["duration"])
    if "--way" not in how:  # bounds from a count are others, so that digits differ
        assert data | {"seconds": 0} == expected | {"seconds": 0}
    assert data["vertex_signs"] == expected["vertex_signs"]
    assert data["status"] == "undecided"
    assert data["reason"] == "followed in floats along a proved branch"
    assert data["frames"]["number"] == len(data["frames"]["times"]) == 7
    assert plot.read_text().startswith("<svg ")
    assert len(json.loads(out.read_text())["file_frames"]) == 7


@pytest.mark.parametrize("ending", ["fold", "glb", "gltf", "obj", "stl", "csv"])
def test_files_of_every_kind(ending, tmp_path):
    result = run("fold", "two-vertex", "--up", "4", "--frames", 6, "-o", tmp_path / f"m.{ending}")
    assert result.exit_code == OK
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == (
        [f"m_000{k}.{ending}" for k in range(6)] if ending in ("obj", "stl") else [f"m.{ending}"]
    )
    assert str(tmp_path / names[0]) in result.stdout.replace("\n", "").replace(" " * 17, "")
    assert str(tmp_path / names[-1]) in result.stdout.replace("\n", "").replace(" " * 17, "")


def test_frames_by_a_fold_until_an_angle():
    options = ("--until", "45deg", "--by", "5-3", "--frames", 4, "--json")
    data = json.loads(run("fold", "two-vertex", "--signs", "+-", *options).stdout)
    assert data["end"] == data["events"][-1]["kind"] == "angle"
    assert [abs(x) for x in data["angles"]["3-5"]] == pytest.approx([0, 15, 30, 45])
    assert data["largest_angles"]["3-5"] == data["angles"]["3-5"][-1]


# --- panels --------------------------------------------------------------------------------------


def miura_file(folder):
    """Straight creases crossed by zigzags: vertices that can be folded flat."""
    path = folder / "miura.fold"
    path.write_text(json.dumps(converted(Opened(miura(2, 2))).document()))
    return path


def test_a_drawing_folds_along_the_way_with_most_folds():
    result = run("fold", "zigzags")
    assert result.exit_code == OK
    said = "it is proved that the sheet does not start to fold with the mountains and valleys of "
    said += "the drawing, `match` says why"
    assert f"{said}: this is way 1, the first of 3" in result.stderr
    lines = result.stdout.splitlines()
    assert lines[0] == "way              1"
    known = "PROVED: it exists until a fold reaches 180 degrees; its angles"
    assert lines[2] == f"motion           {known}"
    assert lines[3] == "                 and contacts are floats"
    assert lines[4] == "end              time 3.14159: fold 14-15 closes: its two faces meet"
    assert lines[-1].endswith("turning    fold 13-14 turns back")


def test_modes_that_are_linear_are_proved(tmp_path):
    result = run("fold", miura_file(tmp_path), "--way", 1)
    assert result.exit_code == OK
    assert "no way" not in result.stderr
    assert "motion           PROVED: all vertices close exactly" in result.stdout
    assert "folds 1-5, 2-6, 4-5, 5-6, 5-9, 6-7 and 6 more close: faces meet" in " ".join(
        result.stdout.split()
    )


@pytest.mark.parametrize("how", [["--way", "3"], ["--letters", "VVVVFFVFVFFF"]])
def test_json_of_panels_is_that_of_python(how, tmp_path):
    out, plot, picture = (tmp_path / name for name in ("m.fold", "a.svg", "p.svg"))
    files = ("-o", out, "--plot", plot, "--picture", picture)
    result = run("fold", "zigzags", *how, "--until", "90deg", "--frames", 5, *files, "--json")
    assert result.exit_code == OK
    data = json.loads(result.stdout)
    Draft202012Validator(schema("motion")).validate(data)
    motion = follow_panels(count_ways("zigzags"), until="90deg", frames=5, way=3)
    written = [str(out), str(plot), str(picture)]
    assert data | {"seconds": 0} == motion.to_dict("zigzags", written) | {"seconds": 0}
    assert (data["theory"], data["modes"]) == ("modes", [1, 5])
    assert data["way"] == 3
    assert (data["status"], data["side"], data["vertex_signs"]) == ("proved", None, None)
    assert data["pinned"] == [0, 4, 9, 8]
    assert max(map(abs, data["largest_angles"].values())) == pytest.approx(90)
    assert picture.read_text().count("<path") == 5 * 9
    assert plot.read_text().count("<path") == 12


def test_free_folds_fold_where_nothing_else_can(tmp_path):
    book = [((str(x), "0"), (str(x), "1"), "B" if x in (0, 2) else "V") for x in range(3)]
    book += [((str(x), y), (str(x + 1), y), "B") for x in range(2) for y in "01"]
    (tmp_path / "b.cp").write_text(as_cp(book))
    result = run("fold", tmp_path / "b.cp", "--json")
    assert result.exit_code == OK
    assert "way 1, which has the mountains and valleys of the drawing" in result.stderr
    data = json.loads(result.stdout)
    assert (data["status"], data["modes"], data["end"]) == ("proved", [], "flat-fold")
    assert list(data["largest_angles"].values()) == pytest.approx([180])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--signs", "+"], "--signs is for branches"),
        (["--up", "4"], "--up is for branches"),
        (["--through-nodes"], "--through-nodes is for branches"),
        (["--drive", "8-9=3"], "--drive is for branches"),
        (["--way", "5"], "there is no way 5: `count` lists 1 to 4"),
        (["--component", "1"], "--component is now --way N, the number in the list of `count`"),
        (["--modes", "1,5"], "--modes is now --way N"),
        (["--letters", "4-9=V"], "3 ways have these letters: name one by way, 1, 2, 3"),
        (["--until", "return"], "give contact, or an angle"),
        (["--by", "8-9"], "fold 8-9 stays flat"),
    ],
)
def test_what_panels_do_not_take(options, words):
    result = run("fold", "zigzags", *options)
    assert result.exit_code == USAGE
    assert words in result.stderr.splitlines()[-1]
    assert result.stdout == ""


def test_letters_that_no_known_way_has():
    result = run("fold", "zigzags", "--letters", "drawn")
    assert result.exit_code == UNDECIDED
    assert "no known way has these letters: `match` says whether" in result.stderr


def test_a_mode_that_does_not_truly_fold():
    result = run("fold", "zigzags", "--way", "4", "--json")
    assert result.exit_code == UNDECIDED
    assert error_class(result) == "NotFollowedError"
    assert "way 4 does not truly fold: the loop 14-10-9-13 does not close" in result.stderr


def test_a_rigid_sheet(tmp_path):
    (tmp_path / "s.cp").write_text(as_cp(SQUARE))
    result = run("fold", tmp_path / "s.cp", "--json")
    assert result.exit_code == UNDECIDED
    assert error_class(result) == "NotFollowedError"
    assert "the sheet is rigid - PROVED" in result.stderr


def test_the_picture_of_a_branch(tmp_path):
    picture = tmp_path / "p.svg"
    result = run("fold", "two-vertex", "--signs", "+-", "--picture", picture)
    assert result.exit_code == OK
    assert str(picture) in result.stdout.replace("\n", "").replace(" " * 17, "")
    text = picture.read_text()
    assert "<title>two-vertex, branch +-: the sheet as it folds</title>" in text
    assert text.count("<path") == 5 * 6


# --- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--signs", "++", "--up", "4"], "one of --way, --signs, --up and --letters"),
        (["--signs", "+"], "1 sign for 2 vertices"),
        (["--signs", "++", "--side", "x"], "'x' is neither + nor -"),
        (["--signs", "++", "--until", "never"], "until 'never'"),
        (["--signs", "++", "--until", "-3"], "until '-3'"),
        (["--signs", "++", "--until", "90"], "write 90deg for a fold angle, or time=90 for a time"),
        (["--signs", "++", "--until", "9_0deg"], "until '9_0deg'"),
        (["--signs", "++", "--frames", "1"], "1 is less than 2"),
        (["--signs", "++", "--by", "4"], "'4' is not a fold such as 4-7"),
        (["--signs", "++", "--by", "0-1"], "0-1 is an edge of the boundary, not a fold to make"),
        (["--branch", "1"], "--branch is now --way N, the number in the list of `count`"),
        (["--rim", "a.json"], "--rim is now --boundary-heights"),
        (["--way", "1", "--letters", "MMMMMMM"], "give one of --way"),
        (["--way", "x"], "'x' is not a whole number"),
        (["--way", "5"], "there is no way 5: `count` lists 1 to 4"),
        (["--letters", "MM"], "2 letters for 7 folds"),
        (["--signs", "++", "--plot", "a.svg", "--picture", "a.svg"], "name another file"),
        (["--signs", "++", "-o", "m.dxf"], "a motion is written as .fold"),
        (["--signs", "++", "--plot", "a.jpg"], "a.jpg: a picture is written as .svg, .png, .pdf"),
        (["--signs", "++", "--picture", "a"], "a: a picture is written as .svg, .png, .pdf"),
        (["--until", "400deg"], "until '400deg'"),
        (["--signs", "++", "-o", "-"], "give the output file a name"),
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
        (scrambled(1, TRIANGLE, 3), "boundary"),
    ],
    ids=["triangle"],
)
def test_sheets_that_have_no_single_motion(pattern, words, tmp_path):
    write_fold(pattern, tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold")
    assert result.exit_code == UNDECIDED
    assert words in result.stderr
    assert result.stderr.count("\n") == 1


def test_a_branch_with_a_flat_vertex_is_not_followed():
    result = run("fold", "flat-vertex", "--signs", "+0", "--json")
    assert result.exit_code == UNDECIDED
    what = "the sheet turns exactly about the straight line 0-4-2, up to 180 degrees"
    assert f"vertex 5 is flat on this branch: {what}, and exactfold does not" in result.stderr
    assert error_class(result) == "NotFollowedError"


def test_a_branch_that_is_not_proved_is_not_followed_where_it_is_not_simple(tmp_path):
    write_fold(ringed_square(4), tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold", "--signs", "+++++")
    assert result.exit_code == UNDECIDED
    assert "the branch is not simple, or floats cannot distinguish it" in result.stderr


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


@pytest.mark.parametrize("option", ["-o", "--plot", "--picture", "--certificate"])
def test_a_folder_that_is_missing_is_said_before_the_work(option, tmp_path, monkeypatch):
    monkeypatch.setattr("exactfold.app.commands.fold.choose", None)
    name = "m.fold" if option in ("-o", "--certificate") else "m.svg"
    result = run("fold", "two-vertex", "--up", "4", option, tmp_path / "none" / name)
    assert result.exit_code == BAD_INPUT
    assert result.stderr.count("\n") == 1
    assert f"cannot write {tmp_path / 'none' / name}: there is no folder" in result.stderr
    (tmp_path / name).mkdir()
    result = run("fold", "two-vertex", "--up", "4", option, tmp_path / name)
    assert (result.exit_code, result.stderr.count("\n")) == (BAD_INPUT, 1)
    assert f"cannot write {tmp_path / name}: it is a folder" in result.stderr


def test_plots_are_written_in_the_format_that_their_names_say(tmp_path):
    plot, picture = tmp_path / "a.png", tmp_path / "p.pdf"
    result = run("fold", "two-vertex", "--frames", 5, "--plot", plot, "--picture", picture)
    assert result.exit_code == OK
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert picture.read_bytes().startswith(b"%PDF")


def test_files_that_cannot_be_written(tmp_path):
    (tmp_path / "m_0001.obj").mkdir()
    result = run("fold", "two-vertex", "--up", "4", "-o", tmp_path / "m.obj")
    assert result.exit_code == BAD_INPUT
    assert "cannot write" in result.stderr


def test_large_sheets_are_followed(tmp_path):
    write_fold(random_square(40, seed=2), tmp_path / "p.fold")
    result = run("fold", tmp_path / "p.fold", "--up", "", "--until", "20deg", "--frames", 3)
    assert result.exit_code == OK
    assert "... (--json has all)" not in result.stdout
    assert "fold" in result.stdout


def test_a_certificate_proves_the_motion_and_its_contact(tmp_path):
    path = tmp_path / "proof.json"
    result = run("fold", "two-vertex", "--signs", "+-", "--certificate", str(path), "--json")
    assert result.exit_code == OK
    found = json.loads(result.stdout)
    Draft202012Validator(schema("motion")).validate(found)
    low, high = found["proof"]["contact"]["time"]
    assert low <= found["duration"] <= high < low * 1.0001
    assert found["written"] == [str(path)]
    assert found["status"] == "proved"
    assert run("check", str(path)).stdout.startswith("VALID: the motion along the ray +-")


@pytest.mark.slow
def test_a_certificate_of_panels_proves_their_first_contact(tmp_path):
    path = tmp_path / "proof.json"
    how = ("fold", "zigzags", "--way", 3, "--frames", 2, "--certificate", str(path))
    result = run(*how, "--json")
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    Draft202012Validator(schema("motion")).validate(found)
    [event] = found["events"]
    assert found["proof"]["contact"] == event
    assert event["time"][0] == found["proof"]["clear"] < 2 * pi / 3 < event["time"][1]
    assert found["written"] == [str(path)]
    checked = run("check", str(path), "--json")
    assert checked.exit_code == 0
    claims = json.loads(checked.stdout)["claims"]
    low, high = (Fraction(time) for time in claims["contact"]["time"])
    assert low < Fraction(2 * pi / 3) < high < low + Fraction(1, 10**5)
    said = " ".join(run(*how).stdout.split())
    assert "PROVED: all vertices close exactly at all fold angles; the first contact is" in said


@pytest.mark.slow
def test_the_certificate_of_a_return_is_a_loop(tmp_path):
    path, out = tmp_path / "proof.txt", tmp_path / "m.fold"
    back = ("fold", "two-vertex", "--signs", "+-", "--until", "return", "--frames", 4)
    returned = run(*back, "--certificate", str(path), "-o", str(out))
    assert (returned.exit_code, returned.stderr) == (OK, "")
    text = " ".join(returned.stdout.split())
    assert "it comes back along +-, saddle -" in text
    assert "of a proved configuration" in text
    assert run("check", str(path)).stdout.startswith("VALID: 1 loop of true motions")
    frames = json.loads(out.read_text())["file_frames"]
    assert all(0 <= frame["frame_exactfold:radius"] < 1e-15 for frame in frames)


@pytest.mark.parametrize("until", ["60deg", "time=0.8"])
def test_motions_to_an_angle_or_a_length_are_proved(until, tmp_path):
    path = tmp_path / "proof.json"
    how = ("--signs", "+-", "--until", until, "--frames", 3, "--certificate", str(path))
    data = json.loads(run("fold", "two-vertex", *how, "--json").stdout)
    Draft202012Validator(schema("motion")).validate(data)
    assert (data["status"], data["proof"]["status"]) == ("proved", "proved")
    assert len(data["frames"]["radii"]) == len(data["frames"]["time_bounds"]) == 3
    assert "no two faces touch before" in run("check", str(path)).stdout


def test_a_fold_that_changes_its_letter_is_said():
    result = run("fold", "flat-octahedron", "--way", 7)
    assert "change     fold 3-4 changes from mountain to valley" in result.stdout


@pytest.mark.parametrize("way", [[], ["--way", 13]])
def test_the_certificate_of_a_family_proves_how_true_motions_begin(tmp_path, way):
    path, frames = tmp_path / "begins.json", tmp_path / "frames.fold"
    how = ("fold", "bird-base", *way, "--frames", 3, "--certificate", path, "-o", frames, "--json")
    result = run(*how)
    assert result.exit_code == UNDECIDED
    assert "the certificate proves that true motions begin with these mountains" in result.stderr
    assert "nothing more is proved of this one" in result.stderr
    printed = json.loads(result.stdout)
    assert printed["proof"] is None
    assert frames.exists()
    checked = run("check", path, "--json")
    assert checked.exit_code == PROVED
    asked = json.loads(path.read_text())["claims"]["letters"]
    letters = (x if x in "MV" else "U" for x in printed["assignment"].values())
    assert asked == "".join(letters)


# --- thickness and stops -------------------------------------------------------------------------


@pytest.mark.slow
def test_plates_stop_a_miura_fold_where_they_meet(tmp_path):
    proof = tmp_path / "proof.json"
    options = ("--thickness", "8", "--stop", "130", "--certificate", str(proof))
    result = run("fold", "miura", *options)
    assert result.exit_code == OK
    text = " ".join(result.stdout.split())
    assert "8 thick, hinges in the middle, cut back by 8 from the folds; mountains at most" in text
    times = re.search(r"the first contact is between the times (\S+) and (\d\.\d+)", text)
    assert times is not None
    low, high = map(float, times.groups())
    assert low <= 2 * atan(2) <= high < low + 1e-8
    assert "(plates, at fold " in text
    assert "; as plates 8 thick, with hinges in the middle" in run("check", str(proof)).stdout


def test_the_first_stop_ends_a_motion():
    result = run("fold", "zigzags", "--way", "3", "--stop", "120,10-14=40deg", "--json")
    assert result.exit_code == OK
    motion = json.loads(result.stdout)
    assert motion["end"] == "stop"
    assert motion["stops"]["10-14"] == "40"
    assert motion["events"][-1]["folds"] == ["10-14"]
    assert motion["duration"] == pytest.approx(40 * pi / 180)
    assert motion["plates"] is None


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (("--thickness", "8", "--trim", "0"), BAD_INPUT, "the flat sheet is stuck: plates of"),
        (("--thickness", "99"), BAD_INPUT, "cannot be cut back by 99 from its folds"),
        (("--thickness", "0"), USAGE, "the thickness is 0: give a positive number"),
        (("--thickness", "1", "--hinge", "top"), USAGE, "'top' is none of middle, valley"),
        (("--trim", "2"), USAGE, "--hinge and --trim go with --thickness"),
        (("--stop", "190"), USAGE, "a stop at 190 degrees: give an angle between 0 and 180"),
        (("--stop", "90,80"), USAGE, "'90,80' gives two stops for the same folds"),
        (("--stop", "0-1=80"), USAGE, "there is no fold 0-1"),
    ],
)
def test_plates_and_stops_that_make_no_sense(tmp_path, options, code, message):
    proof = tmp_path / "proof.json"
    result = run("fold", "miura", *options, "--certificate", str(proof))
    assert result.exit_code == code
    assert message in " ".join(result.stderr.split())
    assert not proof.exists()
