"""`exactfold actuate`: what it prints, its exit codes, and what it refuses."""

import json
from fractions import Fraction

import pytest
from jsonschema import Draft202012Validator
from running import BAD_INPUT, INVALID, PROVED, UNDECIDED, USAGE, error_class, run

import exactfold
from exactfold import random_square, schema
from exactfold.design import actuate
from exactfold.pattern import write_fold
from exactfold.pattern.families import two_vertex

TORQUES = {"0-4": -1, "2-5": 0.5, "4-5": "-1/3"}


def valid(text):
    data = json.loads(text)
    Draft202012Validator(schema("actuate")).validate(data)
    return data


@pytest.fixture
def torques(tmp_path):
    path = tmp_path / "torques.json"
    path.write_text(json.dumps(TORQUES))
    return path


def test_command_and_function_give_the_same():
    result = run("actuate", "two-vertex", "--signs", "+-", "--json")
    assert (result.exit_code, result.stderr) == (PROVED, "")
    data, expected = valid(result.stdout), actuate(two_vertex(), "+-").to_dict("two-vertex")
    for key in ("seconds", "warnings"):
        data.pop(key)
        expected.pop(key)
    assert data == json.loads(json.dumps(expected))


@pytest.mark.parametrize("how", [["--signs", "+-"], ["--up", "4"]])
def test_what_is_shown(how):
    result = run("actuate", "two-vertex", *how)
    assert result.exit_code == PROVED
    lines = result.stdout.splitlines()
    assert lines[0] == "status           PROVED (the branch has more power than every other ray)"
    assert "margin           from 0.982036 to 0.982037; at most 0.982037 is possible" in lines
    assert "no torques do work on this branch only" in result.stdout
    assert "    1  +-       1.80186" in lines
    assert "    3  -+      0.819822  turned over" in lines
    assert result.stdout.count("-5     ") == 4


def test_torques_that_do_work_on_one_branch_only():
    text = run("actuate", "single-vertex-4", "--signs", "+").stdout
    assert "dimension 1; such" in text
    assert "on this branch only" in text
    data = valid(run("actuate", "single-vertex-4", "--signs", "+", "--json").stdout)
    assert data["orthogonal_dimension"] == [1, 1]
    assert Fraction(data["orthogonal"]["share"]) < Fraction(1, 10**9)


def test_few_creases():
    data = valid(run("actuate", "two-vertex", "--signs", "+-", "--creases", 2, "--json").stdout)
    driven = [name for name, torque in data["torques"].items() if torque != "0"]
    assert (data["creases"], len(driven), data["status"]) == (2, 2, "proved")
    text = run("actuate", "two-vertex", "--signs", "+-", "--creases", 2).stdout
    assert "on 2 creases at most" in text
    assert all(f"\n{name} " in text for name in driven)


def test_torques_from_a_file_are_read_exactly(torques):
    result = run("actuate", "two-vertex", "--signs", "+-", "--torques", torques, "--json")
    data = valid(result.stdout)
    assert (data["given"], data["creases"]) == (True, None)
    given = {name: torque for name, torque in data["torques"].items() if torque != "0"}
    assert given == {"0-4": "-1", "2-5": "1/2", "4-5": "-1/3"}
    best = max(data["ranking"], key=lambda row: Fraction(row["power"][0]))
    assert data["ranking"][0] == best
    assert result.exit_code == (PROVED if Fraction(data["margin"][0]) > 0 else INVALID)
    text = run("actuate", "two-vertex", "--signs", "+-", "--torques", torques).stdout
    assert "with torques of this size at most" in text


def test_torques_of_another_branch_are_refuted(tmp_path):
    other = actuate(two_vertex(), "--").torques
    path = tmp_path / "t.json"
    path.write_text(json.dumps({f"{i}-{j}": str(t) for (i, j), t in other.items()}))
    result = run("actuate", "two-vertex", "--signs", "+-", "--torques", path)
    assert result.exit_code == INVALID
    assert "REFUTED (another ray has as much power, or more)" in result.stdout


def test_all_branches_are_listed_if_asked(tmp_path):
    write_fold(random_square(4, seed=1), tmp_path / "p.fold")
    command = ("actuate", tmp_path / "p.fold", "--signs", "+-+-")
    short, long = run(*command).stdout, run(*command, "--all").stdout
    assert "... and 8 more (--all shows them)" in short
    assert "\n   16  " in long
    assert "more (" not in long


def test_nothing_found_is_undecided(tmp_path):
    write_fold(random_square(4, seed=1), tmp_path / "p.fold")
    result = run("actuate", tmp_path / "p.fold", "--signs", "+-+-", "--creases", 1)
    assert result.exit_code == UNDECIDED
    assert "UNDECIDED (no torques on so few creases were found that prefer" in result.stdout
    assert "crease  letter" not in result.stdout


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "give one of --way, --signs, --up and --letters"),
        (["--signs", "+-", "--up", "4"], "give one of --way, --signs, --up and --letters"),
        (["--signs", "+-", "--creases", "2", "--torques", "x"], "do not go together"),
        (["--signs", "+-", "--creases", "8"], "from 1 to 7"),
        (["--signs", "+"], "1 sign for 2 vertices"),
    ],
)
def test_wrong_usage(options, message):
    result = run("actuate", "two-vertex", *options)
    assert result.exit_code == USAGE
    assert message in result.stderr


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{", "is not JSON"),
        ("[1]", "does not hold numbers by crease"),
        ('{"0-4": 1, "0-4": 2}', "crease 0-4 is given twice"),
        ('{"0-5": 1}', "0-5 is not a fold"),
        ('{"0-4": true}', "0-4: True is a truth value"),
        ('{"0-4": NaN}', "0-4: 'NaN' is not a number"),
        ('{"0-4": [1]}', "0-4: [1] is not a rational number"),
    ],
)
def test_bad_files_of_torques(tmp_path, text, message):
    path = tmp_path / "t.json"
    path.write_text(text)
    result = run("actuate", "two-vertex", "--signs", "+-", "--torques", path, "--json")
    assert result.exit_code == BAD_INPUT
    assert message in result.stderr
    assert error_class(result) == "InputError"


def test_a_file_of_torques_that_is_missing(tmp_path):
    result = run("actuate", "two-vertex", "--signs", "+-", "--torques", tmp_path / "none.json")
    assert result.exit_code == BAD_INPUT
    assert "cannot read" in result.stderr


def test_too_many_rivals(tmp_path):
    write_fold(random_square(13, seed=1), tmp_path / "p.fold")
    result = run("actuate", tmp_path / "p.fold", "--signs", "+" * 13, "--json")
    assert result.exit_code == UNDECIDED
    assert "at most 12 can" in result.stderr
    assert error_class(result) == "NotCountedError"


# --- rigid panels --------------------------------------------------------------------------------


def test_panels_are_driven_along_a_way(tmp_path):
    table = tmp_path / "torques.csv"
    hinges = ("--stiffness", "0.5", "--width", 100)
    command = ("actuate", "zigzags", "--way", 1, "--creases", 3, *hinges)
    result = run(*command, "-o", table, "--json")
    assert result.exit_code == PROVED
    data = valid(result.stdout)
    assert (data["self_foldable"], data["rivals"]["number"], data["way"]) == ("proved", 2, 1)
    assert Fraction(data["margin"][0]) <= Fraction(data["bound"])
    driven = [name for name, torque in data["torques"].items() if torque != "0"]
    rows = [line.split(",") for line in table.read_text().splitlines()[1:]]
    assert sorted(row[0] for row in rows) == sorted(driven)
    for name, _, _, _, torque in rows:
        assert float(torque) == pytest.approx(data["hinges"]["torques"][name], rel=1e-5)
    text = run(*command).stdout
    assert "Model of the torques in N mm: linear springs at the folds, rigid panels" in text
    assert "on 3 creases at most" in text


def test_all_ways_and_folds_of_panels_are_listed_if_asked():
    short = run("actuate", "miura", "--way", 1)
    assert "REFUTED (torques that do no work on the other ways do none on" in short.stdout
    assert "family" not in short.stdout
    assert run("actuate", "miura", "--letters", "drawn").stdout


@pytest.mark.parametrize(
    ("options", "code", "message"),
    [
        (["--way", 8, "--creases", 2], USAGE, "way 8 has 3 degrees of freedom: drive at least 3"),
        (["--way", 9], USAGE, "there is no way 9: `count` lists 1 to 8"),
        (["--signs", "+"], USAGE, "signs is for branches of triangulated sheets"),
        (["--way", 1, "--stiffness", 0, "--width", 1], USAGE, "a stiffness of 0 N mm / rad"),
        (["--way", 1, "--stiffness", -1, "--width", 1], USAGE, "a stiffness of -1 N mm / rad"),
        (["--way", 1, "--stiffness", 1], USAGE, "--stiffness and --width go together"),
        (["--way", 1, "--stiffness", "x", "--width", 1], USAGE, "'x' is not a number"),
        (["--way", 1, "-o", "OUT.csv"], USAGE, "-o writes torques in N mm"),
    ],
)
def test_what_is_refused_of_panels_writes_nothing(options, code, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run("actuate", "miura", *options)
    assert result.exit_code == code
    assert message in " ".join(result.stderr.split())
    assert not list(tmp_path.iterdir())


def test_branches_have_torques_in_newton_millimetres_too():
    command = ("actuate", "two-vertex", "--signs", "+-", "--stiffness", "0.5", "--width", 100)
    data = valid(run(*command, "--json").stdout)
    assert data["springs"] == "by length"
    torque, length = data["torques"]["2-5"], data["hinges"]["lengths"]["2-5"]
    assert data["hinges"]["torques"]["2-5"] == pytest.approx(float(Fraction(torque)) * length / 2)
    assert "Model of the torques in N mm: linear springs" in run(*command).stdout


def test_a_certificate_of_torques_for_panels_is_checked(tmp_path):
    path = tmp_path / "torques.json"
    result = run("actuate", "zigzags", "--way", 1, "--certificate", path, "--json")
    assert result.exit_code == PROVED
    assert valid(result.stdout)["certificate"] == str(path)
    checked = run("check", path)
    assert checked.exit_code == PROVED
    assert "the way is self-foldable" in " ".join(checked.stdout.split())
    branch = tmp_path / "b.json"
    assert run("actuate", "two-vertex", "--up", 4, "--certificate", branch).exit_code == PROVED
    assert "the branch is not self-foldable" in " ".join(run("check", branch).stdout.split())


def test_letters_of_the_other_side_name_the_listed_branch() -> None:
    """Its opposite vertex signs are those of another branch."""
    one = run("actuate", "two-vertex", "--letters", "MVVVMVM")
    other = run("actuate", "two-vertex", "--letters", "VMMMVMV")
    assert "vertex signs     +-\n" in one.stdout
    assert one.stdout == other.stdout
    assert "other side of branch +-: the opposite torques drive it" in other.stderr
    assert "other side" not in one.stderr
    named = exactfold.actuate("two-vertex", letters="VMMMVMV")
    assert named == exactfold.actuate("two-vertex", "+-")
