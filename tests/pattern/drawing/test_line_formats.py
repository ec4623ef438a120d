"""`.cp`, `.opx`, `.ori` and `.orh`: what is left out, what is refused, and where."""

import json

import pytest
from drawings import SQUARE, as_opx, as_orh, as_ori

from exactfold.errors import MalformedDrawingError, NotFoldError
from exactfold.pattern.drawing.formats.cp import read_cp
from exactfold.pattern.drawing.formats.opx import read_opx
from exactfold.pattern.drawing.formats.ori import read_orh, read_ori


def test_auxiliary_lines_of_cp_are_left_out():
    drawing = read_cp("1 0 0 1 0\r\n\r\n0 0 0 1 1\r\n4 0 0 2 2\r\n2\t0 0 1e-1 -.5\r\n")
    assert [line.letter for line in drawing.lines] == ["B", "M"]
    assert drawing.remarks == ("left out 2 auxiliary lines",)
    assert drawing.points[2] == (pytest.approx(0.1), pytest.approx(-0.5))


def test_only_auxiliary_lines_are_no_pattern():
    with pytest.raises(MalformedDrawingError, match=r"CP file.*left out 1 auxiliary line"):
        read_cp("4 0 0 1 1")


def test_lines_of_length_zero_are_left_out():
    assert read_cp("1 0 0 1 0\n2 1 1 1 1").remarks == ("left out 1 empty line",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 0 0 1 0\n2 0 0 1", r"line 2: '2 0 0 1' is not"),
        ("7 0 0 1 0", "line 1: '7' is not a line type"),
        ("1 0 0 1 0 0", "line 1"),
        ("1 0 0 one 0", "line 1: 'one' is not a number"),
        ("1 0 0 NaN 0", "line 1: 'NaN' is not a number"),
    ],
)
def test_cp_refusals_name_the_line(text, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_cp(text)


def test_opx_without_a_type_is_auxiliary():
    text = as_opx(SQUARE).replace('<void property="type"><int>2</int></void>', "")
    drawing = read_opx(text)
    assert [line.letter for line in drawing.lines] == ["B", "B", "B", "B", "V"]
    assert drawing.remarks == ("left out 1 auxiliary line",)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("<int>2</int>", "<int>9</int>", "line 4: '9' is not a line type"),
        ("<double>0.1</double>", "<double>x</double>", "line 4: 'x' is not a number"),
        ("</java>", "", "not XML"),
    ],
)
def test_opx_refusals_name_the_line(old, new, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_opx(as_opx(SQUARE).replace(old, new))


def ori(change):
    document = json.loads(as_ori(SQUARE))
    change(document)
    return json.dumps(document)


def test_other_colours_and_auxiliary_lines_of_ori_are_left_out():
    def change(document):
        document["lineSegments"][5]["color"] = "CYAN_3"
        document["auxLineSegments"] = [{}, {}]

    drawing = read_ori(ori(change))
    assert len(drawing.lines) == 5
    assert drawing.remarks == ("left out 1 cyan line", "left out 2 auxiliary lines")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(lineSegments=3), "`lineSegments` is 3"),
        (lambda d: d["lineSegments"].append(4), "line 6 in `lineSegments` is 4"),
        (lambda d: d["lineSegments"][1].update(a="1"), "line 1 .* ends at '1'"),
        (lambda d: d["lineSegments"][1].update(b=None), "line 1 .* ends at None"),
        (lambda d: d["lineSegments"][2].update(b="1,y"), "line 2 .*: 'y' is not a number"),
    ],
)
def test_ori_refusals_name_the_line(change, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_ori(ori(change))


def test_an_ori_file_that_is_cut_off():
    with pytest.raises(NotFoldError, match="not JSON at"):
        read_ori(as_ori(SQUARE)[:-5])


def test_auxiliary_lines_of_orh_are_left_out():
    text = as_orh(SQUARE).replace("色,2", "色,3")
    text += "\n<補助線分集合>\n番号,1\n色,1\n座標,0,0,7,7"
    drawing = read_orh(text)
    assert [line.letter for line in drawing.lines] == ["B", "B", "B", "B", "M"]
    assert drawing.remarks == ("left out 1 auxiliary line",)


@pytest.mark.parametrize(
    ("row", "message"),
    [("座標,0,0,1", "row 5: .* does not have four numbers"), ("座標,0,0,1,z", "row 5: 'z' is not")],
)
def test_orh_refusals_name_the_row(row, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_orh(f"<タイトル>\n<線分集合>\n番号,1\n色,1\n{row}")
