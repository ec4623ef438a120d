"""`exactfold convert`: what is said, what is repaired, and that what is written is read again."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from drawings import SQUARE, as_cp, as_fold, as_ori, as_svg
from files import written
from running import BAD_INPUT, PROVED, UNDECIDED, USAGE, run

from exactfold import CreasePattern
from exactfold.pattern import read_fold
from exactfold.pattern.data import SHEETS, example_path
from exactfold.pattern.opening import open_pattern
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.reading import Reading

KITE = [
    *SQUARE[:4],
    (("0", "0"), ("1", "1"), "M"),
    (("1", "0"), ("0.414213562373095", "1"), "V"),
]
"""A diagonal and a crease with slope -1 - sqrt 2, which cross."""
TWO = [
    *SQUARE[:4],
    *(((f"{float(a) + 3}", b), (f"{float(c) + 3}", d), x) for (a, b), (c, d), x in SQUARE),
]
"""An empty square, and one with two creases."""


def test_one_line_of_what_was_read_the_coordinates_each_repair_and_what_was_written(
    tmp_path: Path,
) -> None:
    path, out = tmp_path / "kite.cp", tmp_path / "kite.fold"
    path.write_text(as_cp(KITE))
    result = run("convert", path, out)
    assert (result.exit_code, result.stderr) == (PROVED, "")
    assert result.stdout.splitlines() == [
        f"read {path}: CP, 6 lines (1 mountain, 1 valley, 4 boundary)",
        "coordinates in Q(sqrt 2), whole numbers; largest move 5e-17 of the size, tolerance 1e-09",
        "1 vertex inside of lines: 1 line cut there: at 4 (0.414214, 1)",
        "1 crossing of lines is a vertex: at 5 (0.630602, 0.630602)",
        f"wrote {out}: 6 vertices, 4 folds, 4 panels, coordinates in Q(sqrt 2)",
    ]


@pytest.mark.parametrize("triangulate", [False, True])
def test_the_sheet_that_is_read_again_is_the_identical_one(
    tmp_path: Path, triangulate: bool
) -> None:
    path, out = tmp_path / "kite.cp", tmp_path / "kite.fold"
    path.write_text(as_cp(KITE))
    flags = ["--triangulate"] if triangulate else []
    assert run("convert", path, out, *flags).exit_code == PROVED
    first, again = open_pattern(path), open_pattern(out)
    assert isinstance(again.sheet, PanelPattern)
    assert again.sheet == first.sheet
    assert again.sheet.sha256 == first.sheet.sha256
    assert again.assignment == first.assignment
    assert again.lines[1] == "coordinates kept as written: the file states exact coordinates"
    document = json.loads(out.read_text())
    assert ("J" in document["edges_assignment"]) is triangulate
    assert document["frame_exactfold:field"] == [["2"]]
    assert "vertices_exactfold:coords" not in document


def test_what_was_repaired_once_is_not_repaired_again(tmp_path: Path) -> None:
    """A vertex inside a side, which repair of a drawing dissolves, stays in a converted file."""
    path, out = tmp_path / "s.cp", tmp_path / "s.fold"
    half = [(("0", "0"), ("0.5", "0"), "B"), (("0.5", "0"), ("1", "0"), "B"), *SQUARE[1:]]
    path.write_text(as_cp(half))
    assert run("convert", path, out).exit_code == PROVED
    kept = open_pattern(out).sheet
    assert len(kept.vertices) == 6
    assert run("convert", path, out, "--repair").exit_code == PROVED
    assert len(open_pattern(out).sheet.vertices) == 5
    assert len(open_pattern(path).sheet.vertices) == 5


def test_creases_that_end_inside_of_sides_are_not_lost(tmp_path: Path) -> None:
    """Without a cut there they are joined to nothing: the bare rim would do as a sheet."""
    out = tmp_path / "out.fold"
    refused = run("convert", "zigzags", out, "--no-repair")
    assert refused.exit_code == BAD_INPUT
    assert "8 lines are joined to no panel, the first near (0, -80)" in refused.stderr
    assert run("convert", "zigzags", out).exit_code == PROVED
    assert open_pattern(out).sheet.sha256 == open_pattern(example_path("zigzags")).sheet.sha256


@pytest.mark.parametrize("writer", [as_cp, as_fold, as_ori, as_svg])
def test_all_formats_give_one_file(tmp_path: Path, writer) -> None:
    source, out = tmp_path / "drawing", tmp_path / "out.fold"
    source.write_text(writer(SQUARE))
    assert run("convert", source, out).exit_code == PROVED
    sheet = open_pattern(out).sheet
    assert {(float(x), float(y)) for x, y in sheet.vertices} == {
        *((0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.1)),
    }
    assert len(sheet.folds) == len(sheet.faces) == 2


@pytest.mark.parametrize("name", SHEETS)
def test_triangulated_sheets_stay_what_they_are(tmp_path: Path, name: str) -> None:
    out = tmp_path / "out.fold"
    assert run("convert", name, out).exit_code == PROVED
    assert read_fold(out) == read_fold(example_path(name))


def test_without_the_flag_only_what_is_needed_is_done(tmp_path: Path) -> None:
    path, out = tmp_path / "s.cp", tmp_path / "s.fold"
    loose = [*SQUARE, (("0.5", "0.1"), ("0.6", "0.8"), "M")]
    path.write_text(as_cp(loose))
    refused = run("convert", path, out, "--no-repair")
    assert refused.exit_code == BAD_INPUT
    assert refused.stderr.endswith("; --repair may mend it\n")
    assert not out.exists()
    for flags in ([], ["--repair"], ["--steps", "dangling"]):
        refused = run("convert", path, out, *flags)
        assert refused.exit_code == BAD_INPUT
        assert "1 line of the drawing (1 mountain) is not in the sheet" in refused.stderr
        assert not out.exists()
        result = run("convert", path, out, "--force", *flags)
        assert result.exit_code == PROVED
        assert result.stdout.startswith("warning: 1 line of the drawing (1 mountain) is not in")
        assert "1 line dropped that has the same panel on both sides" in result.stdout
        assert len(open_pattern(out).sheet.folds) == 2
        out.unlink()
    flat = [*SQUARE[:4], (("0", "0"), ("1", "1"), "F")]
    document = as_fold(flat)
    path = written(tmp_path, document)
    for flags, folds in (([], 1), (["--no-repair"], 1), (["--repair"], 0)):
        assert run("convert", path, out, "--force", *flags).exit_code == PROVED
        count = sum(a != "B" for a in json.loads(out.read_text())["edges_assignment"])
        assert count == folds


def test_points_are_merged_at_the_distance_given(tmp_path: Path) -> None:
    path, out = tmp_path / "s.cp", tmp_path / "s.fold"
    path.write_text(as_cp([*SQUARE[:5], (("0.5001", "0.1"), ("1", "1"), "V")]))
    assert run("convert", path, out, "--merge", "1e-3").exit_code == PROVED
    assert len(open_pattern(out).sheet.folds) == 2
    wrong = run("convert", path, out, "--merge", "-1")
    assert (wrong.exit_code, "-1 is not positive" in wrong.stderr) == (USAGE, True)


def test_triangles_of_a_rational_sheet_may_bend(tmp_path: Path) -> None:
    path, out = tmp_path / "s.cp", tmp_path / "s.fold"
    path.write_text(as_cp(SQUARE))
    refused = run("branch", path, "--signs", "+")
    assert refused.exit_code == UNDECIDED
    (message,) = refused.stderr.splitlines()[-1:]
    assert message.startswith(
        "exactfold: branch takes triangulated sheets, and this one has 2 panels with more than "
        "three sides: "
    )
    assert "`exactfold convert --triangulate`" in message
    assert run("convert", path, out, "--triangulate").exit_code == PROVED
    assert isinstance(open_pattern(out).sheet, CreasePattern)
    assert run("branch", out, "--signs", "+").exit_code == PROVED


def test_sheets_that_branches_do_not_take_are_refused_with_what_to_do(tmp_path: Path) -> None:
    kite, square = tmp_path / "kite.cp", tmp_path / "s.cp"
    kite.write_text(as_cp(KITE))
    square.write_text(as_cp(SQUARE))
    for command in (  # that no signs are given is said of sheets that have branches only
        ["branch", "--signs", "+"],
        ["branch"],
        ["branch", "--drive", "0-4=3"],
        ["export", "--signs", "+"],
        ["count", "--stream"],
    ):
        given = [tmp_path / "c.txt"] if command[-1] == "--stream" else []
        needs = "--stream" if given else command[0]
        for path, words in ((kite, "lie in Q(sqrt 2)"), (square, "2 panels with more than three")):
            result = run(*command, *given, path)
            assert result.exit_code == UNDECIDED
            (message,) = result.stderr.splitlines()[-1:]
            assert message.startswith(f"exactfold: {needs} takes triangulated sheets")
            assert words in message
            assert "`exactfold count`" in message
    assert not (tmp_path / "c.txt").exists()


def test_one_of_several_sheets(tmp_path: Path) -> None:
    path, out, lines = tmp_path / "two.cp", tmp_path / "two.fold", tmp_path / "o.jsonl"
    path.write_text(as_cp(TWO))
    for command in (["info"], ["convert"], ["branch", "--signs", "+"]):
        given = [out] if command == ["convert"] else []
        refused = run(*command, path, *given)
        assert refused.exit_code == BAD_INPUT
        assert refused.stderr.startswith(f"exactfold: {path}: the drawing holds 2 sheets (sheet 1 ")
        assert "choose one with --sheet N (`number=` in Python)" in refused.stderr
        missing = run(*command, path, *given, "--sheet", 3)
        assert missing.exit_code == BAD_INPUT
        assert "there is no sheet 3: the drawing holds 2" in missing.stderr
    folds = []
    for number in (1, 2):
        data = json.loads(run("count", path, "--json", "--force", "--sheet", number).stdout)
        folds.append(data["pattern"]["folds"])
        assert run("convert", path, out, "--force", "--sheet", number).exit_code == PROVED
        assert len(open_pattern(out, Reading(force=True)).sheet.folds) == folds[-1]
    assert sorted(folds) == [0, 2]
    assert "the sheet has no folds" in run("count", path, "--sheet", 1).stderr
    assert run("count", path, "--sheet", 2, "--jsonl", lines).exit_code == PROVED
    assert json.loads(lines.read_text())["asked"]["sheet"] == 2
    assert run("count", "two-vertex", "--sheet", 2).exit_code == BAD_INPUT
    assert run("count", "two-vertex", "--sheet", 1).exit_code == PROVED


def test_standard_output_takes_the_file(tmp_path: Path) -> None:
    path = tmp_path / "s.cp"
    path.write_text(as_cp(SQUARE))
    result = run("convert", path, "-")
    assert json.loads(result.stdout)["file_creator"] == "exactfold"
    assert result.stderr.startswith(f"exactfold: read {path}: CP, ")
    assert run("convert", path, "-", "--json").exit_code == USAGE
    assert run("convert", path, path).exit_code == USAGE
    assert run("convert", path, "-", "--steps", "merge", "--repair").exit_code == USAGE
    assert "there is no step 'mend'" in run("convert", path, "-", "--steps", "mend").stderr


ORANGE = (
    '<svg xmlns="http://www.w3.org/2000/svg"><rect width="4" height="4" stroke="black"/>'
    '<line x1="1" x2="3" y2="4" stroke="orange"/>'
    '<line y1="1" x2="4" y2="3" stroke="black" stroke-dasharray="3,2"/></svg>'
)


@pytest.mark.parametrize(
    ("options", "letters"),
    [
        ([], "UUUU"),
        (["--colours", "orange=M , rgb(0,0,0)=U"], "MMUU"),
        (["--dashes", "3,2=V"], "UUVV"),
        (["--dashes", "3 2=V", "--colours", "#ffa500=m"], "MMVV"),
    ],
)
def test_letters_by_colour_and_by_dashes(tmp_path: Path, options: list[str], letters: str) -> None:
    path, out = tmp_path / "orange.svg", tmp_path / "out.fold"
    path.write_text(ORANGE)
    result = run("convert", path, out, "--repair", *options)
    assert result.exit_code == PROVED, result.stderr
    made = json.loads(out.read_text())["edges_assignment"]
    assert "".join(sorted(letter for letter in made if letter != "B")) == letters


@pytest.mark.parametrize("text", ["", "red", "red=", "=M", "red=MV", "red=M;blue=V", "red=M,,"])
def test_what_is_no_map_of_letters(tmp_path: Path, text: str) -> None:
    path = tmp_path / "orange.svg"
    path.write_text(ORANGE)
    result = run("info", path, "--colours", text)
    assert result.exit_code == USAGE
    assert "is not a list such as red=M,blue=V" in " ".join(result.stderr.split())


def test_a_suffix_that_is_not_written_is_refused(tmp_path: Path) -> None:
    for command in (
        ["convert", "miura", tmp_path / "miura.svg"],
        ["convert", "miura", tmp_path / "miura"],
        ["export", "two-vertex", "--signs", "+-", "-o", tmp_path / "b.glb"],
        ["random", "--interior", "3", "--seed", "1", "-o", tmp_path / "r.dxf"],
    ):
        result = run(*command)
        assert result.exit_code == USAGE
        assert "is written as .fold, .json" in result.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("ending", ["dxf", "obj", "stl"])
def test_other_formats_are_written(ending: str, tmp_path: Path) -> None:
    out = tmp_path / f"miura.{ending}"
    result = run("convert", "miura", out)
    assert result.exit_code == PROVED
    assert "24 folds, 16 panels, coordinates as floats" in " ".join(result.stdout.split())
    assert not out.read_bytes().startswith(b"{")
    if ending == "dxf":
        assert run("count", out).stdout.startswith("8 families of ways to fold, 7 of dimension 1")
