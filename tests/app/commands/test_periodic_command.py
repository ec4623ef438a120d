"""`exactfold count --direction` and `exactfold random --torus`."""

from __future__ import annotations

import json
import os
import threading
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from running import PROVED, UNDECIDED, run

import exactfold
from exactfold import schema
from exactfold.app.pictures import directions_plot
from exactfold.app.viewer.rolling import rolling_document
from exactfold.branches import PeriodicCount, count_periodic
from exactfold.errors import UsageError
from exactfold.pattern import PeriodicPattern, read_cell
from exactfold.pattern.data import example_path


def test_a_cell_is_counted_certified_and_checked(tmp_path: Path) -> None:
    file = tmp_path / "c.json"
    result = run("count", "miura-cell", "--direction", "3,4", "--json", "--certificate", file)
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    Draft202012Validator(schema("periodic")).validate(data)
    assert (data["distinct"], data["real"], data["nonreal"]) == (5, 5, 0)
    assert (data["direction"], data["certificate"]) == ([3, 4], str(file))
    assert [space["dimension"] for space in data["pleats"]] == [1, 1, 1]
    checked = run("check", file)
    assert checked.exit_code == 0
    assert "5 branches of a periodic sheet" in checked.stdout


def test_irrational_pleats_stand_in_the_json() -> None:
    result = run("count", "square-twist-cell", "--direction", "1,2", "--json")
    data = json.loads(result.stdout)
    Draft202012Validator(schema("periodic")).validate(data)
    (row,) = data["pleats"][0]["basis"]
    assert len(row) == 5
    assert len(data["pleats"][0]["polynomial"]) == 3


def test_the_answer_in_words(tmp_path: Path) -> None:
    words = run("count", "miura-cell", "--direction", "0,1").stdout
    assert words.startswith("1 family of ways to start folding in the direction 0,1 - PROVED")
    assert "3 spaces of pleats" in words
    twist = run("count", "square-twist-cell", "--direction", "1,2", "--certificate", tmp_path / "c")
    assert "irrational heights" in twist.stdout
    checked = run("check", tmp_path / "c").stdout
    assert checked.startswith("VALID: 6 branches of a periodic sheet for the direction 1,2")
    assert "2 spaces of pleats" in checked


def test_a_cell_is_folded_and_written(tmp_path: Path) -> None:
    given = ("waterbomb-cell", "--direction", "1,2", "--way", "2", "--patch", "2,2")
    for ending in ("fold", "glb", "csv"):
        file = tmp_path / f"w.{ending}"
        result = run("fold", *given, "--until", "30deg", "--frames", "3", "-o", file, "--json")
        assert result.exit_code == PROVED, result.stderr
        data = json.loads(result.stdout)
        Draft202012Validator(schema("motion")).validate(data)
        assert (data["theory"], data["cells"], data["direction"]) == ("periodic", [2, 2], [1, 2])
        assert data["written"] == [str(file)]
        assert file.stat().st_size > 1000
    document = json.loads((tmp_path / "w.fold").read_text())
    assert len(document["file_frames"]) == 3
    proved = run("fold", *given, "--until", "30deg", "--frames", "3", "--prove", "--json")
    assert json.loads(proved.stdout)["status"] == "proved"
    words = run("fold", *given, "--until", "30deg", "--frames", "3").stdout
    assert "2 across 1,2" in words
    assert "the frames and the first contact were computed in floats" in " ".join(words.split())
    for arguments, message in (
        (("waterbomb-cell",), "give --direction X,Y"),
        ((*given, "--certificate", tmp_path / "c"), "have no --certificate"),
        ((*given[:3], "--letters", "MV"), "--letters does not go with --direction"),
        ((*given[:3], "--signs", "+-+"), "--signs is for branches"),
        (("waterbomb-cell", "--patch", "2,2"), "--patch goes with"),
    ):
        assert message in run("fold", *arguments).stderr


def test_a_cell_is_viewed(tmp_path: Path) -> None:
    file = tmp_path / "w.html"
    given = ("waterbomb-cell", "--direction", "1,2", "--patch", "2,1", "--frames", "3", "-o", file)
    assert run("view", *given).exit_code == PROVED
    assert "way 4: +++" in file.read_text()
    one = run("view", *given, "--way", "2")
    assert "1 way to fold" in one.stdout
    assert "1 of 4 ways are shown" in file.read_text()
    late = rolling_document("waterbomb-cell", (1, 2), cells=(1, 1), frames=2, limit=0)
    assert late["status"] == "undecided" or late["ways"][0]["why"]
    for arguments, message in (
        (("waterbomb-cell", "-o", file), "give --direction X,Y"),
        ((*given, "--signs", "+"), "only --way N"),
        ((*given, "--way", "9"), "lists 4 ways"),
        (("two-vertex", "--patch", "2,2", "-o", file), "--patch goes with --direction"),
    ):
        assert message in run("view", *arguments).stderr


def test_rigid_panels_have_a_certificate(tmp_path: Path) -> None:
    file = tmp_path / "panels.json"
    data = json.loads(run("count", "square-twist-cell", "--json", "--certificate", file).stdout)
    assert data["certificate"] == str(file)
    checked = run("check", file)
    assert checked.exit_code == PROVED
    assert "2 components of periodic motions of rigid panels to second order, 2 planar" in " ".join(
        checked.stdout.split()
    )
    words = run("count", "miura-cell", "--certificate", file).stdout
    assert f"certificate:{file}" in "".join(words.split())
    undecided = run("count", "waterbomb-cell", "--certificate", tmp_path / "none.json")
    assert "no certificate was written" in undecided.stderr
    assert not (tmp_path / "none.json").exists()


def test_rigid_panels_in_json_and_words() -> None:
    result = run("count", "miura-cell", "--json")
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    Draft202012Validator(schema("panel-cell")).validate(data)
    pair, planar = data["motions"]
    assert (pair["dimension"], pair["direction"], pair["planar"]) == (2, ["0", "1"], False)
    assert (planar["letters"], planar["planar"], planar["folds"]) == ("MVMMVVVM", True, "proved")
    words = run("count", "square-twist-cell").stdout
    assert words.startswith("2 components of periodic motions of rigid panels - PROVED")
    assert "Q(sqrt 5)" in words
    drawing = run("count", "miura", "--periodic", "--cell", "4,2")
    assert drawing.exit_code == PROVED
    assert "across 0,1" in drawing.stdout
    undecided = run("count", "waterbomb-cell")
    assert undecided.exit_code == UNDECIDED
    assert "--direction X,Y counts" in " ".join(undecided.stdout.split())


@pytest.mark.parametrize(
    ("arguments", "code", "ways"),
    [
        (("miura-cell", "--letters", "VMVVMMMV"), 0, [2]),
        (("miura-cell", "--letters", "MMFFFFUU"), 0, [1]),
        (("miura-cell", "--letters", "MMMFFFUU"), 1, []),
        (("miura-cell", "--letters", "FFFFFFFF"), 1, []),
        (("waterbomb-cell", "--letters", "UUUUUUUUU"), UNDECIDED, []),
        (("waterbomb-cell", "--direction", "1,2", "--letters", "VVMMVVMMM"), 0, [1]),
        (("waterbomb-cell", "--direction", "1,2", "--letters", "VVVVVVVVV"), 1, []),
    ],
)
def test_letters_on_a_cell(arguments: tuple[str, ...], code: int, ways: list[int]) -> None:
    result = run("match", *arguments, "--json")
    assert result.exit_code == code
    data = json.loads(result.stdout)
    Draft202012Validator(schema("periodic-match")).validate(data)
    assert data["ways"] == ways
    words = run("match", *arguments).stdout
    assert {0: "starts to fold", 1: "does not", UNDECIDED: "UNDECIDED"}[code] in words


def test_letters_that_do_not_fit_a_cell() -> None:
    for arguments, message in (
        (("miura-cell",), "give them with --letters"),
        (("miura-cell", "--letters", "MV"), "for each of the 8 folds"),
        (("miura-cell", "--letters", "MV", "--direction", "1,2"), "for each of the 12 edges"),
        (("two-vertex", "--direction", "1,2"), "two-vertex: the cell has no letters"),
    ):
        assert message in run("match", *arguments).stderr


def test_all_directions_in_json_and_words(tmp_path: Path) -> None:
    result = run("count", "waterbomb-cell", "--direction", "all", "--json")
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    Draft202012Validator(schema("directions")).validate(data)
    assert [branch["b"] for branch in data["branches"]] == [1, -1, -1, -1]
    assert (data["permutation"], data["cycles"]) == ([1, 2, 4, 3], [[1], [2], [3, 4]])
    (crossing,) = data["crossings"]
    assert (crossing["direction"]["x"], crossing["direction"]["y"]) == (["0"], ["1"])
    words = run("count", "waterbomb-cell", "--direction", "all").stdout
    assert words.startswith("4 branches over all directions - PROVED")
    assert "after 2 half" in words
    undecided = run("count", "miura-cell", "--direction", "all")
    assert undecided.exit_code == UNDECIDED
    assert "3 spaces of pleats" in " ".join(undecided.stdout.split())
    refused = run("count", "miura-cell", "--direction", "all", "--certificate", tmp_path / "c")
    assert "--direction all has no certificate" in refused.stderr


def test_a_picture_by_direction(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(directions_plot, "_SAMPLES", 12)
    file = tmp_path / "w.svg"
    result = run("draw", "waterbomb-cell", "--direction", "all", "--most", "1", "-o", file)
    assert result.exit_code == PROVED
    text = file.read_text()
    assert "1 crossing and 3 analytic sheets, proved" in text
    assert text.count("<path") == 4 + 9
    assert text.count('stroke-dasharray="3 3"') == 2
    for arguments, message in (
        ((), "give --direction all"),
        (("--direction", "3,4"), "draw takes --direction all"),
        (("--direction", "all", "--way", "1"), "--direction does not go with"),
        (("--cell", "2,2"), "--cell goes with --direction all"),
    ):
        assert message in run("draw", "waterbomb-cell", *arguments).stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("miura-cell", "--direction", "all", "--certificate", "c.json"), "has no certificate"),
        (("miura-cell", "--periodic", "--direction", "1,2"), "give --direction, or --periodic"),
        (("miura-cell", "--direction", "3"), "is not a direction such as 3,4"),
        (("miura-cell", "--direction", "0,0"), "0,0 is no direction"),
        (("miura-cell", "--direction", "1,2", "--method", "popping"), "--method does not go with"),
        (("miura-cell", "waterbomb-cell", "--direction", "1,2"), "go with one pattern"),
    ],
)
def test_what_does_not_go_together(arguments: tuple[str, ...], message: str) -> None:
    result = run("count", *arguments)
    assert result.exit_code == 2
    assert message in " ".join(result.stderr.split())


def test_a_sheet_that_is_not_periodic() -> None:
    result = run("count", "h1-4", "--direction", "1,2")
    assert result.exit_code == 3
    assert "no two translations carry the border of the sheet" in " ".join(result.stderr.split())


def test_a_pipe_is_not_read_to_see_whether_it_is_a_cell(tmp_path: Path) -> None:
    """What a pipe holds can be read once only."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    sheet = example_path("two-vertex").read_text()
    writer = threading.Thread(target=pipe.write_text, args=(sheet,), daemon=True)
    writer.start()
    result = run("count", pipe)
    writer.join(10)
    assert (result.exit_code, "4 ways to start" in result.stdout) == (PROVED, True)


def test_random_cells(tmp_path: Path) -> None:
    file = tmp_path / "cell.json"
    made = run("random", "--interior", "4", "--seed", "2", "--torus", "-o", file)
    assert made.exit_code == 0
    assert "a periodic sheet: 4 vertices in the cell" in made.stdout
    assert read_cell(file).V == 4
    printed = run("random", "--interior", "4", "--seed", "2", "--torus").stdout
    assert printed == file.read_text()
    assert run("random", "--interior", "4", "--seed", "2", "--torus", "--redraw").exit_code == 2


def test_the_verb() -> None:
    cell = read_cell("waterbomb-cell")
    result = exactfold.count(cell, direction=(1, "1/2"))
    assert isinstance(result, PeriodicCount)
    assert (len(result), result[0].vertex_signs, result.direction) == (4, "+--", (2, 1))
    assert isinstance(result.pattern, PeriodicPattern)
    with pytest.raises(UsageError, match="counted for one `direction`"):
        exactfold.count(cell)  # type: ignore[call-overload]
    with pytest.raises(UsageError, match="only `limit` and `progress` go with"):
        exactfold.count(cell, direction=(1, 2), seed=1)  # type: ignore[call-overload]


def test_a_drawing_is_taken_for_a_cell_aloud() -> None:
    result = run("count", "miura", "--direction", "1,3", "--cell", "4,2")
    assert result.exit_code == PROVED
    assert result.stdout.startswith("1 way to start folding in the direction 1,3 - PROVED")
    assert "2 vertices in a cell and the translations (90, 0) and (0, 160)" in result.stderr
    assert "the border of the drawing counts as creases" in result.stderr
    for code, arguments, message in (
        (2, ("miura", "--cell", "4,2"), "--cell goes with --direction"),
        (2, ("miura-cell", "--direction", "1,3", "--cell", "1,1"), "is a cell: leave out --cell"),
        (2, ("miura", "--direction", "1,3", "--cell", "4"), "is not two numbers of cells"),
        (3, ("miura", "--direction", "1,3", "--cell", "3,2"), "does not repeat 3-fold along"),
    ):
        refused = run("count", *arguments)
        assert refused.exit_code == code
        assert message in " ".join(refused.stderr.split())


def test_the_letters_of_a_drawing_are_those_of_its_cell() -> None:
    """Of Miura's sheet two by two creases repeat with their letters, and one by one without."""
    result = run("match", "miura", "--periodic", "--cell", "2,1", "--json")
    assert result.exit_code == PROVED
    data = json.loads(result.stdout)
    assert (data["starts"], data["direction"], data["ways"]) == ("proved", None, [2])
    assert set(data["letters"]) == set("MVU")
    rolled = run("match", "miura", "--direction", "1,3", "--cell", "4,2", "--letters", "MVMMVM")
    assert (rolled.exit_code, "way 1 - PROVED" in rolled.stdout) == (PROVED, True)
    for code, arguments, message in (
        (3, ("miura", "--periodic", "--cell", "4,2"), "letters do not repeat: fold 7-13 is V"),
        (2, ("miura", "--cell", "4,2"), "--cell goes with --direction or --periodic"),
        (2, ("miura", "--periodic", "--direction", "1,2"), "give --direction, or --periodic"),
        (2, ("miura-cell",), "miura-cell: the cell has no letters"),
    ):
        refused = run("match", *arguments)
        assert refused.exit_code == code
        assert message in " ".join(refused.stderr.split())


def test_a_drawing_rolls_up_as_its_cell(tmp_path: Path) -> None:
    given = ("miura", "--direction", "1,3", "--cell", "4,2", "--patch", "2,2", "--frames", "3")
    folded = run("fold", *given, "--until", "10deg", "--json")
    assert folded.exit_code == PROVED
    assert json.loads(folded.stdout)["cells"] == [2, 2]
    page = tmp_path / "miura.html"
    viewed = run("view", *given, "-o", page)
    assert viewed.stdout.startswith("1 way to start folding in the direction 1,3 - PROVED")
    for command in ("fold", "view"):
        refused = run(command, "miura", "--cell", "4,2", "-o", tmp_path / "out.html")
        assert (refused.exit_code, "--cell goes with --direction" in refused.stderr) == (2, True)


def test_a_drawing_with_several_cells_is_said_to_have_them(tmp_path: Path) -> None:
    """Two squares with diagonals that cross, side by side."""
    vertices = [[0, 0], [2, 0], [4, 0], [0, 2], [2, 2], [4, 2], [1, 1], [3, 1]]
    faces = [[a, b, m] for a, b, m in ((0, 1, 6), (1, 4, 6), (4, 3, 6), (3, 0, 6))]
    faces += [[a, b, m] for a, b, m in ((1, 2, 7), (2, 5, 7), (5, 4, 7), (4, 1, 7))]
    file = tmp_path / "two.fold"
    file.write_text(json.dumps({"vertices_coords": vertices, "faces_vertices": faces}))
    both = run("count", file, "--direction", "1,3")
    assert "it shows 2 x 1 equal cells: --cell 2,1 takes one of them" in both.stderr
    assert "4 vertices in a cell and the translations (4, 0) and (0, 2)" in both.stderr
    one = run("count", file, "--direction", "1,3", "--cell", "2,1")
    assert "2 vertices in a cell and the translations (2, 0) and (0, 2)" in one.stderr
    assert "it shows" not in one.stderr


def test_when_the_time_is_over_the_count_is_undecided() -> None:
    found = count_periodic("miura-cell", (3, 4), limit=0)
    assert found.status is exactfold.Verdict.UNDECIDED
    assert found.reason.endswith("undecided after 0 seconds")
