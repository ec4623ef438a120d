"""One way in: the same drawing in every format, formats known by content, refusals that say why."""

import pytest
from drawings import (
    SQUARE,
    as_cp,
    as_dxf,
    as_fold,
    as_obj,
    as_opx,
    as_orh,
    as_ori,
    as_svg,
    as_tmd5,
    drawn,
    places,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import (
    InputError,
    MalformedDrawingError,
    NotFoldError,
    UnknownFormatError,
    UnreadableFileError,
    UsageError,
)
from exactfold.pattern.data import example_path
from exactfold.pattern.drawing.drawing import Drawing, SvgReading
from exactfold.pattern.drawing.formats.read import READERS, parse_drawing, read_drawing
from exactfold.pattern.opening import open_pattern
from exactfold.pattern.reading import Reading

WRITERS = {
    "fold": as_fold,
    "svg": as_svg,
    "cp": as_cp,
    "opx": as_opx,
    "ori": as_ori,
    "orh": as_orh,
    "dxf": as_dxf,
    "tmd5": as_tmd5,
    "obj": as_obj,
}


def test_there_is_a_file_of_every_format():
    assert WRITERS.keys() == READERS.keys()


@pytest.mark.parametrize("ending", WRITERS)
def test_a_square_is_the_same_in_every_format_whatever_the_name(ending, tmp_path):
    path = tmp_path / "square.txt"
    path.write_text(WRITERS[ending](SQUARE), encoding="utf-8")
    drawing = read_drawing(path)
    assert drawn(drawing) == places(SQUARE)
    assert len(drawing.points) == 5
    assert drawing.remarks == (("kinds of creases: 6 axial",) if ending == "tmd5" else ())
    assert drawing.source == (
        f"read square.txt: {ending.upper()}, 6 lines (1 mountain, 1 valley, 4 boundary)"
    )


@pytest.mark.parametrize("ending", WRITERS)
def test_content_goes_before_the_ending(ending):
    wrong = "cp" if ending != "cp" else "svg"
    assert drawn(parse_drawing(WRITERS[ending](SQUARE), f"a.{wrong}")) == places(SQUARE)


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16"])
@pytest.mark.parametrize("ending", ["fold", "cp", "orh"])
def test_marks_of_encodings(ending, encoding):
    content = WRITERS[ending](SQUARE).encode(encoding)
    assert drawn(parse_drawing(content, "a")) == places(SQUARE)


def test_the_encoding_that_xml_declares():
    text = '<?xml version="1.0" encoding="ISO-8859-1"?>' + as_svg(SQUARE).replace(
        "<line ", '<line class="\xe9" ', 1
    )
    assert drawn(parse_drawing(text.encode("latin-1"), "a.svg")) == places(SQUARE)


@pytest.mark.parametrize(
    ("content", "name"),
    [
        (b"%PDF-1.4 \xff", "crane.pdf"),
        (b"\x89PNG\r\n", "crane.png"),
        ("", "nothing"),
        ("{}", "a.json"),
        ("<html></html>", "a.html"),
        ("0 SECTION", "a.txt"),
        (b'<?xml version="1.0" encoding="klingon"?><svg/>', "a.svg"),
    ],
)
def test_unknown_formats_are_refused_with_the_list(content, name):
    with pytest.raises(
        UnknownFormatError, match="FOLD, SVG, CP, OPX, ORI, ORH, DXF, TMD5 and OBJ"
    ) as caught:
        parse_drawing(content, name)
    assert str(caught.value).startswith(name)


@pytest.mark.parametrize(
    ("content", "name", "error"),
    [
        ("{}", "a.fold", NotFoldError),
        ('{"vertices_coords": [', "a", NotFoldError),
        ("", "a.cp", MalformedDrawingError),
        ("1 0 0", "a.cp", MalformedDrawingError),
        ("<svg>", "a", MalformedDrawingError),
        ("<html/>", "a.svg", MalformedDrawingError),
        ("<java/>", "a.opx", MalformedDrawingError),
        ("<タイトル>", "a.orh", MalformedDrawingError),
        ("{}", "a.ori", MalformedDrawingError),
        ("0 SECTION", "a.dxf", MalformedDrawingError),
        ("tree\n5.0\n", "a", MalformedDrawingError),
        ("", "a.tmd5", MalformedDrawingError),
        ("", "a.obj", MalformedDrawingError),
    ],
)
def test_a_damaged_file_is_judged_by_the_reader_of_its_format(content, name, error):
    with pytest.raises(error):
        parse_drawing(content, name)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(UnreadableFileError, match=r"none\.cp"):
        read_drawing(tmp_path / "none.cp")


@settings(max_examples=300, deadline=None)
@given(st.sampled_from([*WRITERS]), st.data())
@pytest.mark.slow
def test_a_damaged_file_is_read_or_refused_but_never_a_traceback(ending, data):
    text = WRITERS[ending](SQUARE)
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, min(len(text), start + 12)))
    damage = data.draw(st.text("0-.eaM<>\"'{}[],:/ \n", max_size=3))
    try:
        drawing = parse_drawing(text[:start] + damage + text[end:], f"a.{ending}")
    except InputError:
        return
    assert isinstance(drawing, Drawing)
    assert all(i != j for i, j, _ in drawing.lines)
    assert max(v for line in drawing.lines for v in line[:2]) < len(drawing.points)


@pytest.mark.parametrize(
    "reading", [{"colours": {"red": "M"}}, {"dashes": {"solid": "M"}}, {"chords": 2}]
)
def test_choices_for_svg_files(reading):
    message = r"colours, dashes and chords are for SVG and DXF files, and a\.cp is CP"
    with pytest.raises(UsageError, match=message):
        parse_drawing(as_cp(SQUARE), "a.cp", SvgReading(**reading))
    with pytest.raises(UsageError, match=r"two-vertex\.fold is FOLD"):
        open_pattern(example_path("two-vertex"), Reading(**reading))
