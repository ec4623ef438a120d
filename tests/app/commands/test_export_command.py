"""`exactfold export`: what it writes, prints and refuses."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from jsonschema import Draft202012Validator
from sampling import slow_after
from typer.testing import CliRunner

import exactfold
from exactfold._support.verdict import UNDECIDED as UNPROVED
from exactfold.app.cli import app
from exactfold.branches import branch_certificate, count_branches, export_branch, find_branch
from exactfold.errors import UndecidedBranchError
from exactfold.interop import branch_to_coq, branches_to_coq, to_coq
from exactfold.interop.fold_frames import BRANCH_KEY, MOTION_KEY
from exactfold.motion.panels.listing import panel_ways
from exactfold.pattern import load_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.degenerate import ringed_square
from exactfold.pattern.families import two_vertex
from exactfold.pattern.opening import open_pattern
from exactfold.pattern.writing.fold_writing import fold_text

OK, USAGE, BAD_INPUT, UNDECIDED = 0, 2, 3, 4
TWO = example_path("two-vertex")


def run(*arguments, **options):
    return CliRunner().invoke(app, ["export", *map(str, arguments)], **options)


@pytest.fixture
def out(tmp_path):
    return tmp_path / "branch.fold"


def signs_in(path):
    return json.loads(path.read_text())[BRANCH_KEY]["vertex_signs"]


# --- what is written -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("how", "signs"),
    [
        (["--signs", "-+"], "-+"),
        (["--signs=--"], "--"),
        (["--up", "4"], "+-"),
        (["--up", "4,5"], "++"),
        (["--up", ""], "--"),
        (["--way", "1"], "--"),
        (["--way", "3"], "+-"),
    ],
)
def test_the_branch_is_named_in_three_ways(out, how, signs):
    result = run(TWO, *how, "-o", out)
    assert (result.exit_code, result.stderr) == (OK, "")
    assert signs_in(out) == signs
    file = load_fold(out)
    assert file.pattern == two_vertex()
    branch = find_branch(two_vertex(), signs)
    assert {fold: file.assignment[fold] for fold in branch.assignment} == branch.assignment
    assert "PROVED" in result.stdout
    assert branch.assignment_text in result.stdout


def test_signs_are_read_from_a_file(tmp_path, out):
    (tmp_path / "signs.txt").write_text("+\n-\n")
    assert run(TWO, "--signs", f"@{tmp_path / 'signs.txt'}", "-o", out).exit_code == OK
    assert signs_in(out) == "+-"


def test_the_branches_of_the_listing_in_its_order(out):
    listed = [branch.sign_text for branch in count_branches(two_vertex()).branches]
    for k, signs in enumerate(listed, 1):
        assert run(TWO, "--way", k, "-o", out).exit_code == OK
        assert signs_in(out) == signs


def test_command_and_function_write_the_same(tmp_path, out):
    assert run(TWO, "--signs", "+-", "--amount", "12.5", "-o", out).exit_code == OK
    other = tmp_path / "other.fold"
    branch = find_branch(two_vertex(), "+-")
    export_branch(branch, other, amount=12.5, title="two-vertex")
    assert out.read_bytes() == other.read_bytes()


@pytest.mark.parametrize(("options", "largest"), [([], 30), (["--amount", "5"], 5)])
def test_the_amount_is_the_largest_angle(out, options, largest):
    assert run(TWO, "--signs", "++", "-o", out, *options).exit_code == OK
    document = json.loads(out.read_text())
    assert max(map(abs, document["edges_foldAngle"])) == largest
    assert document[BRANCH_KEY]["largest_angle"] == largest


@pytest.mark.parametrize("name", [[], ["-o", "-"]])
def test_without_a_name_the_file_goes_to_stdout(out, name):
    assert run(TWO, "--signs", "+-", "-o", out).exit_code == OK
    result = run(TWO, "--signs", "+-", *name)
    assert (result.exit_code, result.stderr) == (OK, "")
    assert result.stdout == out.read_text()


def test_a_pattern_from_standard_input_has_no_title():
    done = subprocess.run(
        [sys.executable, "-m", "exactfold", "export", "-", "--signs", "+-"],
        input=TWO.read_text(),
        capture_output=True,
        text=True,
        check=True,
    )
    document = json.loads(done.stdout)
    assert document["file_title"] == "branch +-"
    assert document["frame_exactfold:branch"]["vertex_signs"] == "+-"


def test_json_says_what_was_written(out):
    result = run(TWO, "--signs", "+-", "-o", out, "--json")
    assert result.exit_code == OK
    assert result.stdout.count("\n") == 1
    said, document = json.loads(result.stdout), json.loads(out.read_text())
    assert said["output"] == str(out)
    assert said["status"] == "proved"
    assert said["vertex_signs"] == {"4": 1, "5": -1}
    assert said["pattern"]["sha256"] == two_vertex().sha256
    assert said["gauge"] == "saddle"
    assert 0 < said["length_error"] == document[BRANCH_KEY]["length_error"] < 0.01
    edges = [f"{i}-{j}" for i, j in document["edges_vertices"]]
    angles = dict(zip(edges, document["edges_foldAngle"], strict=True))
    letters = dict(zip(edges, document["edges_assignment"], strict=True))
    assert said["angles"] == {fold: angles[fold] for fold in said["assignment"]}
    assert said["assignment"] == {e: a for e, a in letters.items() if a != "B"}


# --- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ([], "one of --way, --signs, --up and --letters"),
        (["--signs", "++", "--up", "4"], "one of --way, --signs, --up and --letters"),
        (["--up", "4", "--way", "1"], "one of --way, --signs, --up and --letters"),
        (["--signs", "+-+"], "3 signs for 2 vertices"),
        (["--signs", "+x"], "'x' is not a vertex sign"),
        (["--up", "0"], "vertex 0 is not an interior vertex"),
        (["--up", "a"], "--up takes vertex indices"),
        (["--way", "5"], "there is no way 5: `count` lists 1 to 4"),
        (["--signs", "++", "--amount", "0"], "largest fold angle cannot be 0.0 degrees"),
        (["--signs", "++", "--amount", "200"], "largest fold angle cannot be 200.0 degrees"),
        (["--signs", "++", "--amount", "nan"], "--amount: 'nan' is not a number"),
        (["--signs", "++", "--amount", "1_0"], "--amount: '1_0' is not a number"),
        (["--signs", "++", "--amount", "1e400"], "largest fold angle cannot be inf degrees"),
    ],
)
def test_wrong_usage_is_one_line_and_writes_nothing(out, options, words):
    result = run(TWO, *options, "-o", out)
    assert result.exit_code == USAGE
    assert words in result.stderr
    assert result.stderr.count("\n") == 1
    assert result.stdout == ""
    assert not out.exists()


def test_json_needs_a_file_to_speak_of():
    for name in ([], ["-o", "-"]):
        result = run(TWO, "--signs", "++", "--json", *name)
        assert result.exit_code == USAGE
        assert "name it with -o" in result.stderr


def test_the_pattern_is_not_replaced(tmp_path):
    path = tmp_path / "two.fold"
    path.write_text(TWO.read_text())
    assert run(path, "--signs", "++", "-o", path).exit_code == USAGE
    assert path.read_text() == TWO.read_text()


def test_an_output_that_cannot_be_written(tmp_path):
    result = run(TWO, "--signs", "++", "-o", tmp_path / "none" / "a.fold")
    assert result.exit_code == BAD_INPUT
    assert "cannot write" in result.stderr


@pytest.fixture
def undecided(tmp_path):
    """A sheet with a star that is flat by a symmetry that is not recognised."""
    path = tmp_path / "ringed.fold"
    path.write_text(fold_text(ringed_square(4)))
    return path


def test_an_undecided_branch_is_refused_unless_forced(undecided, out):
    pattern = load_fold(undecided).pattern
    signs = "+" * pattern.Vi
    branch = find_branch(pattern, signs)
    assert str(branch.status) == "undecided"
    assert branch.heights
    result = run(undecided, "--signs", signs, "-o", out)
    assert result.exit_code == UNDECIDED
    assert "not written" in result.stderr
    assert branch.reason in result.stderr
    assert not out.exists()
    result = run(undecided, "--signs", signs, "--coq")
    assert (result.exit_code, result.stdout) == (UNDECIDED, "")
    assert f"not written: the branch is not proved; {branch.reason}" in result.stderr
    with pytest.raises(UndecidedBranchError, match="not proved"):
        export_branch(branch, out)
    assert not out.exists()

    result = run(undecided, "--signs", signs, "-o", out, "--force")
    assert result.exit_code == UNDECIDED
    assert "UNDECIDED" in result.stdout
    document = json.loads(out.read_text())
    assert document[BRANCH_KEY]["status"] == "undecided"
    letters, angles = document["edges_assignment"], document["edges_foldAngle"]
    unknown = [angle for letter, angle in zip(letters, angles, strict=True) if letter == "U"]
    assert unknown
    assert set(unknown) == {0.0}


def test_a_branch_without_heights_is_refused_always(out):
    found = find_branch(two_vertex(), "++")
    letters = dict.fromkeys(found.assignment, "U")
    nothing = replace(found, root=None, assignment=letters, status=UNPROVED)
    with pytest.raises(UndecidedBranchError, match="nothing is proved"):
        export_branch(nothing, out, force=True)
    assert not out.exists()


# --- rigid panels --------------------------------------------------------------------------------


def in_space(path):
    """The fold angles of the last frame, in degrees, computed from its coordinates and faces."""
    document = json.loads(path.read_text())
    points = np.array(document["file_frames"][-1]["vertices_coords"])
    sides = {}
    for face in document["faces_vertices"]:
        a, b, c = points[face[:3]]
        normal = np.cross(b - a, c - b)
        for i, j in zip(face, [*face[1:], face[0]], strict=True):
            sides[i, j] = normal / np.linalg.norm(normal)
    found = {}
    for i, j in document["edges_vertices"]:
        if (i, j) in sides and (j, i) in sides:
            axis = (points[j] - points[i]) / np.linalg.norm(points[j] - points[i])
            left, right = sides[i, j], sides[j, i]
            sine, cosine = np.dot(np.cross(right, left), axis), np.dot(left, right)
            found[i, j] = np.degrees(np.arctan2(sine, cosine))
    return document, found


def letters_in(path):
    letters = json.loads(path.read_text())["edges_assignment"]
    return "".join(letter for letter in letters if letter != "B")


@pytest.mark.parametrize(
    ("name", "way"), slow_after(1, [("zigzags", 2), ("miura", 1), ("miura", 8)])
)
def test_a_way_of_rigid_panels_has_its_letters_and_true_angles(out, name, way):
    result = run(name, "--way", way, "--amount", "40", "-o", out)
    assert result.exit_code == OK
    assert "status           PROVED" in result.stdout
    assert letters_in(out) == "".join(
        panel_ways(exactfold.count(name))[way - 1].letters.get(fold, "F")
        for fold in open_pattern(example_path(name)).sheet.folds
    )
    document, angles = in_space(out)
    edges = [tuple(edge) for edge in document["edges_vertices"]]
    written = dict(zip(edges, document["edges_foldAngle"], strict=True))
    assert {fold: written[fold] for fold in angles} == pytest.approx(angles, abs=1e-6)
    assert max(map(abs, angles.values())) == pytest.approx(40)
    assert document[MOTION_KEY]["way"] == way


def test_letters_name_a_way_of_rigid_panels(tmp_path, out):
    assert run("miura", "--way", 2, "-o", out).exit_code == OK
    letters = letters_in(out)
    other = tmp_path / "other.fold"
    assert run("miura", "--letters", letters, "-o", other).exit_code == OK
    assert out.read_bytes() == other.read_bytes()


@pytest.mark.slow
def test_of_a_family_one_motion_is_written_and_said_so(out):
    result = run("bird-base", "--way", 3, "-o", out, "--json")
    assert result.exit_code == OK
    assert "way 3 is a family of dimension 5: this is one of infinitely many" in result.stderr
    said = json.loads(result.stdout)
    Draft202012Validator(exactfold.schema("export")).validate(said)
    assert (said["way"], said["status"], said["gauge"]) == (3, "proved", None)
    _, angles = in_space(out)
    by_fold = {f"{i}-{j}": angle for (i, j), angle in angles.items()}
    assert by_fold == pytest.approx(said["angles"], abs=1e-5)
    signs = {fold: "VMF"[(x < 0) + 2 * (abs(x) < 1e-6)] for fold, x in said["angles"].items()}
    assert signs == said["assignment"]
    followed = exactfold.follow("bird-base", 3, until="30deg", frames=2)
    assert {f: x for f, x in followed.assignment.items() if x != "F"}.items() <= {
        tuple(map(int, fold.split("-"))): x for fold, x in said["assignment"].items()
    }.items()


def test_a_family_of_branches_is_said_to_be_one(out):
    result = run("waterbomb", "--way", 1, "-o", out)
    assert (result.exit_code, signs_in(out)) == (OK, "+")
    assert "way 1 is a family of dimension 3: this is one of infinitely many" in result.stderr


def test_the_other_formats_of_a_way_of_rigid_panels(tmp_path):
    for ending in ("obj", "csv", "json"):
        assert run("zigzags", "--way", 1, "-o", tmp_path / f"a.{ending}").exit_code == OK
    rows = (tmp_path / "a.csv").read_text().splitlines()
    assert rows[0] == "fold,letter,degrees"
    assert len(rows) == 13
    [(letter, degrees)] = [row.split(",")[1:] for row in rows if row.startswith("14-15,")]
    assert (letter, float(degrees)) == ("M", pytest.approx(-30))


def test_contact_and_the_end_of_a_motion_are_said(out):
    result = run("miura", "--way", 1, "--amount", 180, "-o", out)
    assert result.exit_code == OK
    assert "on the way to 180 degrees: folds" in result.stderr
    assert "close: faces meet" in result.stderr


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        ([], USAGE, "give one of --way, --signs, --up and --letters"),
        (["--way", "9"], USAGE, "there is no way 9: `count` lists 1 to 8"),
        (["--way", "1", "--amount", "181"], USAGE, "largest fold angle cannot be 181.0 degrees"),
        (["--letters", "M" * 24], UNDECIDED, "no known way has these letters"),
        (
            ["--signs", "+"],
            UNDECIDED,
            "`exactfold export` writes one, with `--way N` or `--letters`",
        ),
    ],
)
def test_what_rigid_panels_do_not_have(out, options, code, words):
    result = run("miura", *options, "-o", out)
    assert (result.exit_code, result.stdout) == (code, "")
    assert words in result.stderr
    assert not out.exists()


# --- for Coq -------------------------------------------------------------------------------------


def test_a_sheet_is_written_for_coq(tmp_path):
    text = to_coq("two-vertex")
    assert run("two-vertex", "--coq").stdout == text
    assert run("two-vertex", "--coq", "-o", "-").stdout == text
    out = tmp_path / "two_vertex.v"
    result = run("two-vertex", "--coq", "-o", out)
    assert (result.exit_code, result.stderr) == (OK, "")
    assert out.read_text() == text
    assert f"coqc -Q proofs/formal Exactfold {out}" in result.stdout


def test_all_branches_are_written_for_coq():
    branches = [find_branch("two-vertex", signs) for signs in ("++", "+-", "-+", "--")]
    every = branches_to_coq([branch_certificate(branch) for branch in branches])
    assert run("two-vertex", "--coq", "--all").stdout == every


def test_a_branch_is_written_for_coq():
    branch = find_branch("two-vertex", "+-")
    text = branch_to_coq(branch_certificate(branch))
    for named in (["--up", "4"], ["--way", "3"], ["--letters", "MVVVMVM"]):
        assert run("two-vertex", "--coq", *named).stdout == text


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (
            ["two-vertex", "--signs", "-+", "--up", "4"],
            USAGE,
            "give one of --way, --signs, --up and --letters",
        ),
        (["two-vertex", "--all", "--up", "4"], USAGE, "leave out --way, --signs"),
        (["waterbomb", "--all"], USAGE, "with four corners, not 6"),
        (["two-vertex", "--amount", "20"], USAGE, "--amount does not go with --coq"),
        (["two-vertex", "--force"], USAGE, "--force does not go with --coq"),
        (
            ["two-vertex", "--boundary-heights", "rim.json"],
            USAGE,
            "--boundary-heights goes with --signs or --up",
        ),
        (["two-vertex", "--json"], USAGE, "--json does not go with --coq"),
        (["random-8", "--all"], USAGE, "have 256 sign vectors, and Coq takes a second or more"),
        (["flat-vertex", "--all"], USAGE, "vertex 5 is flat on the branch with the signs +0"),
        (
            ["flat-octahedron", "--all"],
            USAGE,
            "vertex 7 lies in a triangulated triangle and is flat",
        ),
        (["flat-vertex", "--signs", "++"], USAGE, "vertex 5 may be flat"),
        (["two-vertex", "-o", "two-vertex.v"], USAGE, "with the name two-vertex.v: use"),
        (["two-vertex", "-o", "two_vertex.coq"], USAGE, "with the name two_vertex.coq: use"),
        (["miura"], UNDECIDED, "16 panels with more than three sides"),
        (["bird-base"], UNDECIDED, "the coordinates of this one lie in Q(sqrt 2)"),
    ],
)
def test_what_coq_does_not_take_is_refused(arguments, code, said):
    result = run(*arguments, "--coq")
    assert (result.exit_code, result.stdout.count("Theorem")) == (code, 0)
    assert said in result.stderr


def test_many_branches_are_written_for_coq_by_force(monkeypatch):
    monkeypatch.setattr("exactfold.app.commands.export.FEW", 2)
    result = run("two-vertex", "--coq", "--all")
    assert (result.exit_code, result.stdout) == (USAGE, "")
    assert "to write more than 2, add --force" in result.stderr
    result = run("two-vertex", "--coq", "--all", "--force")
    assert (result.exit_code, result.stdout.count("branch_3 :")) == (OK, 1)


def test_all_branches_are_for_coq_alone():
    result = run("two-vertex", "--signs", "++", "--all")
    assert result.exit_code == USAGE
    assert "--all goes with --coq" in result.stderr


def test_a_reflex_corner_is_named_to_who_asks_for_coq(tmp_path):
    dart = tmp_path / "dart.fold"
    pattern = CreasePattern([(0, 0), (4, -4), (1, 0), (4, 4)], [(0, 1, 2), (0, 2, 3)])
    dart.write_text(fold_text(pattern))
    result = run(dart, "--coq")
    assert (result.exit_code, result.stdout) == (USAGE, "")
    assert "vertex 2 is reflex" in result.stderr
