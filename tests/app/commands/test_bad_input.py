"""Bad input: one line that names the culprit, exit code 3, nothing written."""

import json
from fractions import Fraction

import pytest
from files import CORNERS, FACES, written
from running import BAD_INPUT, PROVED, UNDECIDED, error_class, process, run
from sheets import SQUARE, with_point

from exactfold import random_square
from exactfold.pattern import write_fold
from exactfold.pattern.crease_pattern import CreasePattern

SQUARE_FOLD = {"vertices_coords": CORNERS, "faces_vertices": FACES}


def with_vertex(k, row):
    rows = json.loads(json.dumps(CORNERS))
    rows[k] = row
    return {**SQUARE_FOLD, "vertices_coords": rows}


def text_with(number):
    return json.dumps(with_vertex(4, ["@", 0.25])).replace('"@"', number)


BAD = {
    "empty": ("", "NotFoldError", "not JSON at"),
    "not JSON": ("crease pattern", "NotFoldError", "not JSON at"),
    "cut off": (json.dumps(SQUARE_FOLD)[:-9], "NotFoldError", "ends too early"),
    "a list": ("[1, 2]", "NotFoldError", "one JSON object, not"),
    "not FOLD": ('{"name": "x"}', "FoldError", "no FOLD keys"),
    "no coordinates": ({"faces_vertices": FACES}, "MissingCoordinatesError", "vertices_coords"),
    "empty vertex": (with_vertex(3, []), "MissingCoordinatesError", "vertex 3"),
    "NaN": (text_with("NaN"), "NumberError", "vertex 4"),
    "Infinity": (text_with("-Infinity"), "NumberError", "vertex 4"),
    "text": (text_with('"left"'), "NumberError", "vertex 4"),
    "null": (text_with("null"), "NumberError", "vertex 4"),
    "boolean": (text_with("true"), "NumberError", "vertex 4"),
    "off the plane": (
        {**SQUARE_FOLD, "vertices_coords": [[*p, int(k == 2)] for k, p in enumerate(CORNERS)]},
        "FoldedStateError",
        "vertex 2",
    ),
    "degenerate": (
        {"vertices_coords": [[0, 0], [1, 0], [2, 0]], "faces_vertices": [[0, 1, 2]]},
        "DegenerateFaceError",
        "face 0",
    ),
    "vertex pulled across": (with_vertex(4, [0.5, -1]), "FoldedStateError", "faces 0 and 1"),
    "overlap": (
        {
            "vertices_coords": [[0, 0], [4, 0], [4, 4], [1, 1], [5, 0.5], [2, 4]],
            "faces_vertices": [[0, 1, 3], [1, 2, 3], [3, 4, 5]],
        },
        "Error",
        "3",
    ),
    "edge on three faces": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [1, 1], [0.2, 2]],
            "faces_vertices": [[0, 1, 2], [1, 3, 2], [1, 4, 2]],
        },
        "NotADiskError",
        "edge 1-2",
    ),
    "two disks": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]],
            "faces_vertices": [[0, 1, 2], [3, 4, 5]],
        },
        "SeveralSheetsError",
        "choose one with --sheet N",
    ),
    "pinch": (
        {
            "vertices_coords": [[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]],
            "faces_vertices": [[0, 1, 2], [0, 3, 4]],
        },
        "NotADiskError",
        "by vertex 0",
    ),
    "no such vertex": (
        {**SQUARE_FOLD, "faces_vertices": [*FACES[:3], [3, 0, 9]]},
        "Error",
        "9",
    ),
}


MENDED = {
    "duplicate": (with_vertex(4, [1, 1]), "1 point is merged with another at the same place", 4),
    "isolated": ({**SQUARE_FOLD, "vertices_coords": [*CORNERS, [2, 2]]}, "8 lines", 0),
    "clockwise mixed": ({**SQUARE_FOLD, "faces_vertices": [*FACES[:3], [0, 3, 4]]}, "8 lines", 0),
    "four sides": (
        {"vertices_coords": CORNERS[:4], "faces_vertices": [[0, 1, 2, 3]]},
        "4 lines (4 boundary)",
        4,
    ),
    "hole": (
        {
            "vertices_coords": [[0, 0], [9, 0], [0, 9], [2, 2], [4, 2], [2, 4]],
            "faces_vertices": [
                *([0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]),
            ],
        },
        "the sheet has 1 hole",
        4,
    ),
}
"""What the strict reader refuses and drawings may be: what is said of it, exit code of branch."""


@pytest.mark.parametrize(("document", "said", "code"), MENDED.values(), ids=MENDED.keys())
def test_what_is_no_triangulated_sheet_is_read_as_a_drawing(tmp_path, document, said, code):
    path = written(tmp_path, document)
    for command, expected in ((["count"], 0), (["info"], 0), (["branch", "--signs", "+"], code)):
        result = run(*command, "--force", path, "-v")
        assert result.exit_code == expected
        assert f"exactfold: read {path}: FOLD, " in result.stderr
        assert said in result.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.fold"]


@pytest.mark.parametrize(("document", "error", "culprit"), BAD.values(), ids=BAD.keys())
def test_bad_input(tmp_path, document, error, culprit):
    path, out = written(tmp_path, document), tmp_path / "out.json"
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == BAD_INPUT
    assert error_class(result).endswith(error)
    assert result.stderr.startswith(f"exactfold: {path}: ")
    assert culprit in result.stderr
    assert result.stderr.count("\n") == 1
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.fold"]
    for command in (["info"], ["branch", "--signs", "+"], ["export", "--signs", "+"]):
        other = run(*command, path)
        assert other.exit_code == BAD_INPUT
        assert other.stderr == result.stderr


def test_missing_file(tmp_path):
    for command in ("count", "info"):
        missing = tmp_path / "none.fold"
        result = run(command, missing)
        assert result.exit_code == BAD_INPUT
        assert result.stderr == f"exactfold: cannot read {missing}: No such file or directory\n"
        assert result.stdout == ""


def test_chord_is_counted_right_and_named(tmp_path):
    path = tmp_path / "chord.fold"
    write_fold(with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1)), path)
    data = json.loads(run("count", path, "--json").stdout)
    assert (data["status"], data["distinct"], data["with_multiplicity"]) == ("proved", 1, 2)
    assert "0-2" in run("info", path).stdout


def test_huge_denominators(tmp_path):
    path = tmp_path / "huge.fold"
    pattern = random_square(2, seed=0)
    moved = [(x + Fraction(k, 10**60), y) for k, (x, y) in enumerate(pattern.vertices)]
    write_fold(CreasePattern(moved, pattern.triangles), path)
    out = tmp_path / "huge.json"
    result = run("count", path, "--json", "--certificate", out)
    assert result.exit_code == PROVED
    assert json.loads(result.stdout)["distinct"] == 4
    assert run("check", out).exit_code == PROVED


def test_standard_input_is_named():
    result = process("info", "-", input="{")
    assert result.returncode == BAD_INPUT
    assert result.stderr == (
        "exactfold: standard input: not JSON at line 1, column 2: the text ends too early\n"
    )


@pytest.mark.parametrize(
    ("name", "content", "wrong"),
    [
        ("a.cp", b"1 -200.0 -200.0 -200.0 0.0\n", "the lines of the drawing enclose no face"),
        ("a.svg", b"<svg></svg>", "the SVG file has no lines of a crease pattern"),
        ("a.OPX", b'<?xml version="1.0"?>', "not XML: no element found: line 1, column 21"),
        (
            "a.ori",
            b'{"@version": "v1", "lineSegments": []}',
            "the ORI file has no lines of a crease pattern",
        ),
        ("a.orh", b"\xff\xfe", "the ORH file has no lines of a crease pattern"),
    ],
)
def test_drawings_without_panels_are_refused_for_what_they_lack(tmp_path, name, content, wrong):
    path = tmp_path / name
    path.write_bytes(content)
    for command in (["count"], ["info"], ["branch", "--up", "4"], ["convert"]):
        out = [tmp_path / "out.fold"] if command == ["convert"] else []
        result = run(*command, path, *out)
        assert result.exit_code == BAD_INPUT
        hint = "; --repair may mend it" if out and "enclose" in wrong else ""
        assert result.stderr.startswith(f"exactfold: {path}: {wrong}")
        assert result.stderr.endswith(f"{hint}\n")
        assert result.stderr.count("\n") == 1
        assert sorted(p.name for p in tmp_path.iterdir()) == [name]
    path.write_text(json.dumps(SQUARE_FOLD))  # what is read decides, not the name
    assert run("count", path).exit_code == PROVED


def test_an_unknown_format_is_refused_with_a_list_of_those_that_are_read(tmp_path):
    path = tmp_path / "crane.pdf"
    path.write_bytes(b"%PDF-1.4")
    result = run("count", path)
    assert result.exit_code == BAD_INPUT
    assert result.stderr == (
        f"exactfold: {path} is not a drawing of a known format; exactfold reads "
        "FOLD, SVG, CP, OPX, ORI, ORH, DXF, TMD5 and OBJ\n"
    )


SHEETS_WITHOUT_BRANCHES = {
    "no interior vertex": (CORNERS[:4], [[0, 1, 2], [0, 2, 3]], 0),
    "three boundary vertices": ([*CORNERS[:3], [0.75, 0.5]], [[0, 1, 3], [1, 2, 3], [2, 0, 3]], 0),
    "all interior vertices lie in triangulated triangles": (
        [[0, 0], [3, 0], [0, 3], [3, 3], [1, 1]],
        [[0, 1, 4], [1, 2, 4], [2, 0, 4], [1, 3, 2]],
        0,
    ),
}


@pytest.mark.parametrize("words", SHEETS_WITHOUT_BRANCHES)
def test_sheets_in_order_whose_branches_have_no_names_exit_4(tmp_path, words):
    points, faces, counted = SHEETS_WITHOUT_BRANCHES[words]
    path = written(tmp_path, {"vertices_coords": points, "faces_vertices": faces})
    assert run("info", path).exit_code == 0
    assert run("count", path).exit_code == counted
    for command in ("branch", "export"):
        result = run(command, path, "--signs", "+")
        assert result.exit_code == UNDECIDED
        assert words in result.stderr
        assert result.stderr.count("\n") == 1
        assert "--boundary-heights" not in result.stderr
