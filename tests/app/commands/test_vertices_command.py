"""`exactfold vertices`: the answer, the table, what to change, JSON and exit codes."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator
from running import BAD_INPUT, INVALID, PROVED, UNDECIDED, USAGE, run

import exactfold
from exactfold.pattern import PanelPattern
from exactfold.pattern.opening import Opened
from exactfold.pattern.writing.fold_writing import document_text
from exactfold.pattern.writing.panel_writing import converted

NEAR = "0.000000001"


def valid(text: str) -> dict[str, Any]:
    data: dict[str, Any] = json.loads(text)
    Draft202012Validator(exactfold.schema("vertices")).validate(data)
    return data


def words(text: str) -> str:
    return " ".join(text.split())


def test_a_sheet_whose_vertices_all_start() -> None:
    result = run("vertices", "miura")
    assert result.exit_code == PROVED
    assert result.stdout.startswith("all 9 vertices start to fold with their letters - PROVED (")
    assert "Kawasaki's condition holds at all 9 vertices, Maekawa's at all 9" in result.stdout
    assert "vertex  degree" not in result.stdout
    listed = run("vertices", "miura", "--all")
    assert [listed.stdout.count(f"  {x}  ") for x in ("MMVM", "VMMM", "VVMV", "MVVV")] == [
        4,
        2,
        2,
        1,
    ]
    data = valid(run("vertices", "miura", "--json").stdout)
    assert (data["status"], data["starts"], data["kawasaki"]) == ("proved", "proved", 9)
    assert len(data["vertices"]) == data["maekawa"] == 9


def test_a_sheet_that_cannot_start() -> None:
    result = run("vertices", "zigzags")
    assert result.exit_code == INVALID
    text = words(result.stdout)
    assert text.startswith("none of the 4 vertices can start to fold with its letters - REFUTED")
    assert "so the sheet as a whole cannot start to fold with these letters if its" in text
    assert "exchange the letter of 9-13 (then vertex 13 cannot fold)" in text
    data = valid(run("vertices", "zigzags", "--json").stdout)
    assert (data["status"], data["starts"]) == ("proved", "refuted")
    assert data["vertices"][0]["flips"] == [["9-13"]]


def test_letters_on_the_command_line(tmp_path: Path) -> None:
    assert run("vertices", "two-vertex").exit_code == PROVED
    wrong = run("vertices", "two-vertex", "--letters", "MMMMMMM")
    assert wrong.exit_code == INVALID
    assert "vertex 5: all its folds are mountains, and it needs a valley: exchange the" in words(
        wrong.stdout
    )
    path = tmp_path / "letters.txt"
    path.write_text("MVVVMVM")
    assert run("vertices", "two-vertex", "--letters", f"@{path}").exit_code == PROVED
    assert run("vertices", "two-vertex", "--letters", "MM").exit_code == USAGE
    assert run("vertices", "no-such-pattern").exit_code == BAD_INPUT


def test_free_folds_that_have_no_choice_are_named() -> None:
    result = run("vertices", "miura", "--letters", "11-20=M,10-11=M,9-11=V", "--all")
    assert result.exit_code == PROVED
    assert "vertex 11: its letters leave its free folds no choice: 11-12=M" in words(result.stdout)


def crossed(off: str) -> PanelPattern:
    """Two lines that cross; the end of one is moved aside."""
    points = [("0", "0"), ("1", "0"), ("0", "1"), ("-1", "0"), (off, "-1")]
    rim = [(1, 2), (2, 3), (3, 4), (4, 1)]
    return PanelPattern(
        [(Fraction(x), Fraction(y)) for x, y in points], [*rim, *((0, k) for k in range(1, 5))]
    )


@pytest.mark.parametrize(
    ("off", "code"),
    [("0", INVALID), (NEAR, INVALID), ("0.0003", UNDECIDED), ("0.1", PROVED)],
    ids=["straight", "meant to be straight", "nearly straight", "bent"],
)
def test_nearly_straight_lines_leave_it_open(off: str, code: int, tmp_path: Path) -> None:
    path = tmp_path / "crossed.fold"
    path.write_text(document_text(converted(Opened(crossed(off))).document(None)))
    result = run("vertices", path, "--letters", "VMMM")
    assert result.exit_code == code
    if code == INVALID:
        assert "two straight lines, which cannot move at the same time: no letters help" in words(
            result.stdout
        )
    if code == UNDECIDED:
        assert result.stdout.startswith("whether vertex 0 can start to fold with its letters is o")
        assert run("vertices", path, "--letters", "VMMM", "--snap", "exact").exit_code == PROVED


@pytest.mark.parametrize("corners", [4, 5], ids=["four corners", "five corners"])
def test_match_leaves_open_what_a_nearly_straight_line_decides(
    corners: int, tmp_path: Path
) -> None:
    """A bend by 3e-4 lets the vertex fold; `vertices` calls it open, and `match` has to agree."""
    points = [("0", "0"), ("1", "0"), ("0", "1"), ("-1", "0"), ("0.0003", "-1"), ("0.8", "0.8")]
    rim = (
        [(1, 2), (2, 3), (3, 4), (4, 1)]
        if corners == 4
        else [(1, 5), (5, 2), (2, 3), (3, 4), (4, 1)]
    )
    sheet = PanelPattern(
        [(Fraction(x), Fraction(y)) for x, y in points[: corners + 1]],
        [*rim, *((0, k) for k in range(1, 5))],
    )
    path = tmp_path / "crossed.fold"
    path.write_text(document_text(converted(Opened(sheet)).document(None)))
    result = run("match", path, "--letters", "VMMM")
    assert result.exit_code == UNDECIDED
    assert "and with a straight line it does not" in words(result.stderr + result.stdout)
    assert exactfold.match(path, "VMMM").status is exactfold.UNDECIDED
    assert run("match", path, "--letters", "VMMM", "--snap", "exact").exit_code == PROVED
    assert run("match", path, "--letters", "MVMV").exit_code == INVALID  # with or without the line


def test_vertices_with_the_same_reason_share_a_line(tmp_path: Path) -> None:
    """Two vertical lines and a horizontal one, as in a map."""
    points = [(Fraction(x), Fraction(y)) for y in range(3) for x in range(4)]
    along = [(k, k + 1) for k in range(12) if k % 4 < 3]
    up = [(k, k + 4) for k in range(8)]
    sheet = PanelPattern(points, along + up)
    path = tmp_path / "map.fold"
    path.write_text(document_text(converted(Opened(sheet)).document(None)))
    result = run("vertices", path, "--letters", "1-5=M,5-9=V,4-5=M,5-6=M,6-7=M,2-6=V,6-10=M")
    assert result.exit_code == INVALID
    assert (
        "- vertices 5 and 6, each: its folds form two straight lines, which cannot move at the "
        "same time: no letters help"
    ) in words(result.stdout)


def test_a_count_that_is_undecided_says_what_is_known_of_each_vertex(tmp_path: Path) -> None:
    path = tmp_path / "crossed.fold"
    path.write_text(document_text(converted(Opened(crossed(NEAR))).document(None)))
    result = run("count", path, "--snap", 10**9)  # this leaves the near relation
    assert result.exit_code == UNDECIDED
    last = (
        "each vertex by itself: the only interior vertex starts to fold with some letters - PROVED"
    )
    assert last in words(result.stdout)
    known = run("count", path, "--snap", "exact")
    assert known.exit_code == PROVED
    assert "each vertex by itself" not in known.stdout
    json.loads(run("count", path, "--snap", 10**9, "--json").stdout)


def test_info_has_a_line_about_the_vertices() -> None:
    text = words(run("info", "zigzags").stdout)
    assert "each vertex by itself none of the 4 vertices can start to fold with its" in text
    assert "folding flat Kawasaki's condition holds at none of 4 vertices" in text
    data = json.loads(run("info", "zigzags", "--json").stdout)
    Draft202012Validator(exactfold.schema("info")).validate(data)
    assert data["vertices"] == {
        "starts": "refuted",
        "refuted": [9, 10, 13, 14],
        "never": [],
        "kawasaki": 0,
        "maekawa": 0,
    }
    plain = run("info", "two-vertex").stdout
    assert "each of the 2 vertices starts" in words(plain)
    assert "folding flat" not in plain


def row_of_three(letters: str) -> dict[str, object]:
    """Three vertices with three folds each on a crease that misses a straight line by 1e-4."""
    places = [("1.130014494456087", "1.589308330024756"), ("2.30999235456349", "1.683056078267849")]
    places.append(("3.770000313345168", "1.797945445634967"))
    coords: list[list[float]] = [[0, 0], [5.2, 0], [5.2, 4], [0, 4], [0, 1.500012881847532]]
    coords += [[float(x), float(y)] for x, y in places]
    coords += [[5.2, 1.910958965038882]]
    coords += [[0.830001993119765, 4], [2.010001333746047, 4], [3.470005464683004, 4]]
    rim = [(0, 1), (1, 8), (8, 2), (2, 11), (11, 10), (10, 9), (9, 3), (3, 4), (4, 0)]
    folds = [(4, 5), (5, 6), (6, 7), (7, 8), (5, 9), (6, 10), (7, 11)]
    return {
        "vertices_coords": coords,
        "edges_vertices": [*rim, *folds],
        "edges_assignment": ["B"] * len(rim) + list(letters),
    }


def test_what_neither_reading_allows_is_refuted_and_what_one_allows_is_open(tmp_path: Path) -> None:
    """As written three folds cannot move; if two of them are straight, they can, but not all."""
    path = tmp_path / "row.fold"
    path.write_text(json.dumps(row_of_three("MMMMMVM")))
    refuted = run("vertices", path)
    assert refuted.exit_code == INVALID
    assert "never" not in words(refuted.stdout)
    path.write_text(json.dumps(row_of_three("UUUUUUU")))
    free = run("vertices", path)
    assert free.exit_code == UNDECIDED
    assert (
        "the vertex does not start to fold as it is written, and with a straight line it does"
        in words(free.stdout)
    )


def test_fold_does_not_call_the_digits_of_a_doubted_drawing_rigid(tmp_path: Path) -> None:
    path = tmp_path / "row.fold"
    path.write_text(json.dumps(row_of_three("MMMMMVM")))
    result = run("fold", path)
    assert result.exit_code == UNDECIDED
    assert "PROVED" not in result.stderr + result.stdout
    info = words(run("info", path).stdout)
    assert "these facts hold for the digits as written: 3 relations nearly hold" in info
    assert "the digits as written are rigid, but they are inexact" in words(result.stderr)


def test_many_vertices_are_summed_up_and_the_first_ten_are_listed(tmp_path: Path) -> None:
    """A grid of 12 vertices with a wrong letter at each, and one that is right."""
    sheet = PanelPattern(
        [(i, j) for i in range(6) for j in range(5)],
        [(5 * i + j, 5 * i + j + 5) for i in range(5) for j in range(5)]
        + [(5 * i + j, 5 * i + j + 1) for i in range(6) for j in range(4)],
    )
    path = tmp_path / "grid.fold"
    letters = dict.fromkeys(sheet.folds, "M")
    path.write_text(document_text(converted(Opened(sheet, letters)).document(None)))
    shown = run("vertices", path)
    rows = [line.split() for line in shown.stdout.splitlines()]
    assert ["12", "4", "no", "holds", "no:", "M", "-", "V", "=", "4"] in rows
    assert sum(row[1:3] == ["4", "MMMM"] for row in rows) == 10
    assert "... and 2 more (--all shows them)" in shown.stdout
    rows = [line.split() for line in run("vertices", path, "--all").stdout.splitlines()]
    assert sum(row[1:3] == ["4", "MMMM"] for row in rows) == 12
