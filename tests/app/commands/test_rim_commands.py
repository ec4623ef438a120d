"""--boundary-heights, --curvature and `assignments` on the command line."""

from __future__ import annotations

import json
import math
from fractions import Fraction
from pathlib import Path

import jsonschema
import pytest
from running import error_class, run

from exactfold import checker, delaunay
from exactfold.app.schemas import schema
from exactfold.branches import fold_angles
from exactfold.pattern import families, write_fold
from exactfold.rigidity.equations.boundary_heights import default_boundary_heights

RIM = '{"0": 1, "1": "-1/2", "2": 0.25, "3": 0, "4": 1e-1}'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    corners = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
    write_fold(delaunay([*corners, (5, 4), (8, 7)]), "pentagon.fold")
    write_fold(families.single_vertex(6), "six.fold")
    Path("rim.json").write_text(RIM)
    Path("deficits.json").write_text('{"5": "1/10", "6": 0.25}')
    return tmp_path


def test_a_branch_with_a_rim(here: Path) -> None:
    options = ["branch", "pentagon.fold", "--signs", "+-", "--boundary-heights", "rim.json"]
    done = run(*options, "--certificate", "c.json")
    assert done.exit_code == 0
    assert "0: 1, 1: -1/2, 2: 1/4, 4: 1/10, others 0" in " ".join(done.stdout.split())
    assert checker.check(checker.load(Path("c.json").read_text()))["gauge"] == "rim"
    found = json.loads(run(*options, "--json").stdout)
    jsonschema.validate(found, schema("branch"))
    assert [found["centres"][str(v)] for v in range(5)] == ["1", "-1/2", "1/4", "0", "1/10"]
    assert run("branch", "pentagon.fold", "--signs", "+-").exit_code == 0


def test_a_shape_with_deficits(here: Path) -> None:
    options = ["branch", "pentagon.fold", "--signs", "+-", "--curvature", "deficits.json"]
    done = run(*options, "--certificate", "c.json")
    assert "angle deficits 5: 1/10, 6: 1/4" in " ".join(done.stdout.split())
    assert checker.check(checker.load(Path("c.json").read_text()))["curvature"] == ["1/10", "1/4"]
    counted = json.loads(
        run("count", "pentagon.fold", "--curvature", "deficits.json", "--json").stdout
    )
    jsonschema.validate(counted, schema("shapes"))
    assert counted["distinct"] == 4
    assert run("count", "pentagon.fold", "--boundary-heights", "rim.json").exit_code == 2
    more = run("count", "pentagon.fold", "--curvature", "deficits.json", "--stream", "x.txt")
    assert more.exit_code == 2


@pytest.mark.parametrize(
    ("option", "text", "name", "said"),
    [
        (
            "--boundary-heights",
            '{"0": 1}',
            "BoundaryHeightsError",
            "boundary vertex 1 has no height",
        ),
        (
            "--boundary-heights",
            RIM.replace("0.25", '"x"'),
            "BoundaryHeightsError",
            "the height of vertex 2: 'x'",
        ),
        (
            "--boundary-heights",
            RIM.replace("0.25", "NaN"),
            "BoundaryHeightsError",
            "the height of vertex 2: 'NaN'",
        ),
        (
            "--boundary-heights",
            RIM.replace('"3"', '"0"'),
            "BoundaryHeightsError",
            "vertex 0 is given twice",
        ),
        (
            "--boundary-heights",
            RIM.replace('"3"', '"0-5"'),
            "BoundaryHeightsError",
            "0-5 is not a boundary vertex",
        ),
        (
            "--boundary-heights",
            RIM.replace("}", ', "00": 2}'),
            "BoundaryHeightsError",
            "00 is not a boundary vertex",
        ),
        ("--boundary-heights", "[1, 2]", "BoundaryHeightsError", "does not hold numbers by vertex"),
        ("--boundary-heights", "{", "BoundaryHeightsError", "is not JSON"),
        (
            "--boundary-heights",
            '{"0": 0, "1": 10, "2": 16, "3": 9, "4": -2}',
            "BoundaryHeightsError",
            "lie in one plane",
        ),
        ("--curvature", '{"5": -1}', "BadCurvatureError", "deficit of vertex 5 is negative"),
        ("--curvature", '{"0": 1}', "BadCurvatureError", "0 is not an interior vertex"),
        ("--curvature", '{"5": 1, "05": 0}', "BadCurvatureError", "05 is not an interior vertex"),
        ("--curvature", '{"6": true}', "BadCurvatureError", "deficit of vertex 6"),
    ],
)
def test_errors_name_the_file_and_the_vertex(
    here: Path, option: str, text: str, name: str, said: str
) -> None:
    Path("bad.json").write_text(text)
    done = run("branch", "pentagon.fold", "--signs", "+-", option, "bad.json", "--json")
    assert done.exit_code == 3
    assert error_class(done) == name
    assert "bad.json" in done.stderr
    assert said in done.stderr


def test_numbers_of_any_length_are_printed(here: Path) -> None:
    """Python alone writes integers of up to 4300 digits."""
    Path("long.json").write_text(RIM.replace("0.25", "1e-4400"))
    Path("tall.json").write_text('{"5": 1e4400}')
    shape = ["--boundary-heights", "long.json", "--curvature", "tall.json"]
    for command in (["branch", "--signs", "+-"], ["count"]):
        done = run(command[0], "pentagon.fold", *command[1:], *shape)
        assert done.exit_code == 0
        assert "5: 1000000" in " ".join(done.stdout.split())


def test_such_a_branch_is_drawn_and_exported(here: Path) -> None:
    for options in (
        ["--signs", "+-", "--boundary-heights", "rim.json"],
        ["--signs", "+-"],
        ["--up", "5"],
    ):
        done = run("draw", "pentagon.fold", *options, "-o", "a.svg")
        assert done.exit_code == 0
        assert "branch +-" in Path("a.svg").read_text()
    exported = run(
        "export", "pentagon.fold", "--signs", "+-", "--boundary-heights", "rim.json", "-o", "e.fold"
    )
    assert exported.exit_code == 0


@pytest.mark.slow
def test_folds_drive_a_sheet(here: Path) -> None:
    options = ["--drive", "1-5=6deg,2-6=-5", "--frames", "2", "--certificate", "c.json"]
    done = run("fold", "pentagon.fold", *options)
    assert done.exit_code == 0
    said = " ".join(done.stdout.split())
    assert "driven 1-5 to 6, 2-6 to -5 degrees; sines of half the angles in ratio" in said
    assert "on which the driven angles reach the sizes asked for" in said
    assert "folds 1-5, 2-6 have the angles of the drive" in said
    assert "no way was named: this is the first branch found" in done.stderr
    claims = checker.check(checker.load(Path("c.json").read_text()))
    assert claims["drive"]["folds"] == [[1, 5], [2, 6]]
    # From a file; a fold without an angle goes along as on the branch.
    Path("drive.json").write_text('{"1-6": 5, "2-6": null}')
    done = run(
        "fold",
        "pentagon.fold",
        "--signs",
        "+-",
        "--boundary-heights",
        "rim.json",
        "--drive",
        "drive.json",
        "--json",
    )
    found = json.loads(done.stdout)
    jsonschema.validate(found, schema("motion"))
    assert found["end"] == "driven"
    assert found["rim"] is None
    assert found["drive"]["1-6"]["angle"] == pytest.approx(5)
    assert found["proof"] is None


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("1-5=x", 2, "fold 1-5: 'x' is not an angle such as 90deg"),
        ("1-5=3,5-1=4", 2, "fold 5-1 is given twice"),
        ("1:5=3", 2, "'1:5' is not a fold such as 4-7"),
        ("1-5=1_0", 2, "fold 1-5: '1_0' is not an angle such as 90deg"),
        ("1_0-5=3", 2, "'1_0-5' is not a fold such as 4-7"),
        ("0-6=3,2-6=4", 3, "there is no fold 0-6 to drive"),
        ("0-1=3,2-6=4", 3, "0-1 is an edge of the boundary, not a fold to drive"),
        ("1-5=3", 3, "1 fold to drive: this sheet has 2 degrees of freedom"),
        ('{"1-5": 3, "2-6": "y"}', 3, "drive.json: fold 2-6: 'y' is not an angle"),
        ('{"1-5": 3, "2-6": true}', 3, "drive.json: the angle of fold 2-6 is not a number"),
        ("[]", 3, "drive.json does not hold numbers by fold"),
    ],
)
def test_a_drive_that_is_none(here: Path, text: str, code: int, said: str) -> None:
    if text[0] in "{[":
        Path("drive.json").write_text(text)
        text = "drive.json"
    done = run("fold", "pentagon.fold", "--drive", text)
    assert said in " ".join(done.stderr.split())
    assert done.exit_code == code


def test_a_branch_on_which_folds_start_in_a_ratio(here: Path) -> None:
    options = ["pentagon.fold", "--signs=--", "--drive", "1-5=60,2-6=-45"]
    assert run("branch", *options, "--certificate", "c.json").exit_code == 0
    claims = checker.check(checker.load(Path("c.json").read_text()))
    found = json.loads(run("branch", *options, "--json").stdout)
    jsonschema.validate(found, schema("branch"))
    assert found["drive"]["status"] == "proved"
    assert found["drive"]["folds"]["1-5"] == {"angle": pytest.approx(60), "square": "1/4"}
    assert found["vertex_signs"] == {"5": -1, "6": -1}
    assert claims["sha256"] == found["pattern"]["sha256"]
    # The ratio of the bends over the lengths of the folds, from the heights that are printed.
    heights = {int(v): (Fraction(h), Fraction(h)) for v, h in found["centres"].items()}
    angles = fold_angles("pentagon.fold", heights).degrees(1.0)
    ratio = -math.sin(math.radians(30)) / math.sin(math.radians(22.5))
    assert angles[1, 5] / angles[2, 6] == pytest.approx(ratio, rel=1e-7)


def test_what_does_not_go_with_a_drive(here: Path) -> None:
    def refused(said: str, *options: str) -> None:
        done = run("fold", *options)
        assert done.exit_code == 2
        assert said in " ".join(done.stderr.split())

    drive = ["--drive", "1-5=6,2-6=-5"]
    refused("--drive goes with --signs or --up", "pentagon.fold", *drive, "--way", "1")
    refused("the angles say to which side", "pentagon.fold", *drive, "--side", "+")
    refused("--drive is for branches", "zigzags", "--drive", "1-2=3")
    done = run("branch", "pentagon.fold", "--signs=--", *drive, "--neighbours", "all")
    assert done.exit_code == 2
    assert "--drive goes with --signs or --up, and with --boundary-heights" in done.stderr


def test_such_a_branch_is_followed_and_proved(here: Path) -> None:
    options = [
        "--signs",
        "+-",
        "--boundary-heights",
        "rim.json",
        "--until",
        "5deg",
        "--frames",
        "2",
    ]
    done = run("fold", "pentagon.fold", *options, "--certificate", "c.json")
    assert done.exit_code == 0
    said = "boundary in the ratio 0: 1, 1: -1/2, 2: 1/4, 4: 1/10, others 0"
    assert said in " ".join(done.stdout.split())
    claims = checker.check(checker.load(Path("c.json").read_text()))
    assert claims["rim"] == ["1", "-1/2", "1/4", "0", "1/10"]
    # Without a file the rim is that of a saddle; with one vertex inside no signs are needed.
    found = json.loads(run("fold", "six.fold", "--until", "1deg", "--json").stdout)
    jsonschema.validate(found, schema("motion"))
    assert found["theory"] == "branches"
    rim = default_boundary_heights(families.single_vertex(6))
    assert found["rim"] == {str(v): str(h) for v, h in rim.items()}


def test_what_a_rim_does_not_go_with_is_refused(here: Path) -> None:
    for options, reason in (
        (
            ["six.fold", "--boundary-heights", "rim.json", "--way", "1"],
            "--boundary-heights goes with --signs or --up",
        ),
        (
            ["square-twist", "--boundary-heights", "rim.json"],
            "--boundary-heights is for branches of triangulated sheets",
        ),
        (["pentagon.fold", "--boundary-heights", "six.fold"], "six.fold"),
    ):
        done = run("fold", *options)
        assert done.exit_code in (2, 3)
        assert reason in done.stderr


def test_all_assignments(here: Path) -> None:
    found = json.loads(run("assignments", "pentagon.fold", "--json").stdout)
    jsonschema.validate(found, schema("assignments"))
    assert (found["status"], found["number"]) == ("proved", 32)
    shown = run("assignments", "pentagon.fold", "--all").stdout
    assert all(letters in shown for letters in found["assignments"])


def test_a_certificate_of_all_assignments(here: Path) -> None:
    done = run("assignments", "pentagon.fold", "--json", "--certificate", "all.json")
    claims = checker.verify("all.json")
    assert claims["assignments"] == json.loads(done.stdout)["assignments"]
    assert run("check", "all.json").stdout.startswith("VALID: exactly 32 mountain-valley")
