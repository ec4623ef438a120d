"""DXF drawings: entities, layers and colours as letters, blocks, curves, and damaged files."""

from __future__ import annotations

import io
import sys
from fractions import Fraction

import ezdxf
import pytest
from drawings import SQUARE, as_dxf, drawn, places

from exactfold.checker.core import limits
from exactfold.errors import (
    FoldedStateError,
    MalformedDrawingError,
    PackageMissingError,
    TooLargeError,
    UnknownFormatError,
    UsageError,
)
from exactfold.pattern.drawing.drawing import SvgReading
from exactfold.pattern.drawing.formats.dxf import layer_letter, read_dxf
from exactfold.pattern.drawing.formats.read import parse_drawing


def made(draw) -> str:
    """The text of a document that `draw` fills."""
    document = ezdxf.new("R2010")
    draw(document, document.modelspace())
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue()


def letters(draw, reading: SvgReading | None = None) -> str:
    """The letters of the lines of a document, in the order of the file."""
    return "".join(line.letter for line in read_dxf(made(draw), reading).lines)


def test_the_layers_of_oriedita_are_letters_and_numbers_are_exact() -> None:
    drawing = parse_drawing(as_dxf(SQUARE), "square")
    assert drawn(drawing) == places(SQUARE)
    assert drawing.source == "read square: DXF, 6 lines (1 mountain, 1 valley, 4 boundary)"
    assert drawing.remarks == ()
    named = read_dxf(as_dxf(SQUARE, {"B": "border", "M": "0", "V": "0"}, M=[(62, 1)], V=[(62, 5)]))
    assert named.remarks == ("4 lines of the layer 'border' read as B",)


def test_colours_are_letters_where_layers_say_nothing() -> None:
    colours = {"B": [(62, 7)], "M": [(62, 1)], "V": [(62, 5)]}
    drawing = read_dxf(as_dxf(SQUARE, dict.fromkeys("BMV", "0"), **colours))
    assert drawn(drawing) == places(SQUARE)
    true = {"B": [(420, 0)], "M": [(420, 0xFF0000)], "V": [(420, 0x0000FF)]}
    assert drawn(read_dxf(as_dxf(SQUARE, dict.fromkeys("BMV", "0"), **true))) == places(SQUARE)


def test_a_colour_comes_from_the_layer_if_the_line_has_none() -> None:
    def draw(document, space) -> None:
        document.layers.add("one", color=1)
        document.layers.add("two", color=5)
        for name in ("one", "two"):
            space.add_line((0, 0), (1, 0), dxfattribs={"layer": name})
        space.add_line((0, 0), (0, 1), dxfattribs={"layer": "one", "color": 5})

    assert letters(draw) == "MVV"


@pytest.mark.parametrize(
    ("layer", "letter"),
    [
        *(("Mountain folds", "M"), ("MTN", "M"), ("Bergfalten", "M"), ("Montagne", "M")),
        *(("Montaña", "M"), ("Гора", "M"), ("山折り線", "M"), ("FoldMountain", "M"), ("m", "M")),
        *(("VALLEY_1", "V"), ("Talfalten", "V"), ("Pli vallée", "V"), ("долина", "V")),
        *(("谷折り", "V"), ("v", "V"), ("Outline", "B"), ("Rand", "B"), ("край", "B")),
        *(
            ("Cut line", "B"),
            ("cuts", "C"),
            ("Schnitt", "C"),
            ("creases", "U"),
            ("Faltlinien", "U"),
        ),
        *(("Hilfslinien", ""), ("aux 2", ""), ("Defpoints", ""), ("0", None), ("Layer 1", None)),
        *(("Metal", None), ("total", None), ("uncut", None), ("Bergen", None)),
    ],
)
def test_names_of_layers_in_several_languages(layer: str, letter: str | None) -> None:
    assert layer_letter(layer) == letter


def test_construction_lines_and_hidden_layers_are_left_out_and_said() -> None:
    def draw(document, space) -> None:
        document.layers.add("off").off()
        document.layers.add("frozen").freeze()
        for name in ("off", "frozen", "guides", "mountain"):
            space.add_line((0, 0), (1, 0), dxfattribs={"layer": name})
        space.add_text("a note")

    drawing = read_dxf(made(draw))
    assert [line.letter for line in drawing.lines] == ["M"]
    assert drawing.remarks[:2] == (
        "left out 1 element of the kind TEXT",
        "left out 2 elements on layers that are off or frozen",
    )
    assert "1 line of the layer 'guides' left out" in drawing.remarks


def test_maps_give_letters_to_layers_colours_and_line_types() -> None:
    def draw(document, space) -> None:
        document.linetypes.add("DASHED", [1.0, 0.5, -0.5])
        space.add_line((0, 0), (1, 0), dxfattribs={"layer": "Score", "color": 3})
        space.add_line((0, 0), (1, 1), dxfattribs={"layer": "border", "color": 3})
        space.add_line((0, 0), (1, 2), dxfattribs={"layer": "x", "color": 1})
        space.add_line((0, 0), (1, 3), dxfattribs={"layer": "x", "linetype": "DASHED"})

    assert letters(draw) == "CBMB"
    assert letters(draw, SvgReading({"score": "V", "border": "M"})) == "VMMB"
    assert letters(draw, SvgReading({"red": "V"}, {"dashed": "M"})) == "CBVM"
    with pytest.raises(UsageError, match="no line has 'blue'"):
        letters(draw, SvgReading({"blue": "V"}))


def test_a_drawing_of_one_colour_has_creases_without_letters() -> None:
    drawing = read_dxf(as_dxf(SQUARE, dict.fromkeys("BMV", "0")))
    assert {line.letter for line in drawing.lines} == {"U"}
    assert "creases without a letter" in drawing.remarks[-1]


def test_polylines_and_blocks_are_lines() -> None:
    def draw(document, space) -> None:
        block = document.blocks.new("b")
        block.add_line((0, 0), (1, 1), dxfattribs={"layer": "mountain"})
        inner = document.blocks.new("c")
        inner.add_blockref("b", (0, 0))
        space.add_blockref("b", (10, 20), dxfattribs={"xscale": 2, "yscale": 2})
        space.add_blockref("c", (5, 0))
        space.add_lwpolyline([(0, 0), (1, 0), (1, 1)], close=True, dxfattribs={"layer": "border"})
        space.add_polyline2d([(3, 0), (4, 0), (4, 1)], dxfattribs={"layer": "valley"})

    drawing = read_dxf(made(draw))
    segments = {(drawing.points[a], drawing.points[b], letter) for a, b, letter in drawing.lines}
    assert segments == {
        ((10, 20), (12, 22), "M"),
        ((5, 0), (6, 1), "M"),
        *(((0, 0), (1, 0), "B"), ((1, 0), (1, 1), "B"), ((1, 1), (0, 0), "B")),
        *(((3, 0), (4, 0), "V"), ((4, 0), (4, 1), "V")),
    }


def bent(document, space) -> None:
    space.add_arc((0, 0), 1, 0, 90, dxfattribs={"layer": "mountain"})
    space.add_lwpolyline([(0, 0, 1), (1, 0, 0)], format="xyb", dxfattribs={"layer": "valley"})
    space.add_circle((0, 0), 1, dxfattribs={"layer": "guides"})


def test_curves_are_refused_by_name_or_read_as_chords_and_that_is_said() -> None:
    with pytest.raises(MalformedDrawingError, match=r"^ARC 1 on layer 'mountain': .*--chords 8"):
        read_dxf(made(bent))
    drawing = read_dxf(made(bent), SvgReading(chords=3))
    assert [line.letter for line in drawing.lines].count("M") == 3
    assert "read 2 curves (ARC 1 on layer 'mountain', LWPOLYLINE 1" in drawing.remarks[-1]
    assert "not about the curved one" in drawing.remarks[-1]
    with pytest.raises(TooLargeError, match="chords"):
        read_dxf(made(bent), SvgReading(chords=limits.MOST_LINES + 1))


def test_lines_that_leave_their_plane_are_a_folded_state() -> None:
    def draw(document, space, top=2) -> None:
        space.add_line((0, 0, 2), (1, 0, top))

    assert read_dxf(made(draw)).points == ((0, 0), (1, 0))
    with pytest.raises(FoldedStateError, match="z goes from 2 to 3"):
        read_dxf(made(lambda document, space: draw(document, space, 3)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (as_dxf(SQUARE).replace("0.5", "nan"), "LINE 5 on layer 'MountainLine' .* not finite"),
        (as_dxf(SQUARE).replace("0.5", "1e999"), "not finite"),
        (as_dxf(SQUARE).replace("0.5", "left"), "damaged: .*save it again"),
        (as_dxf(SQUARE)[:90], "damaged"),
        ("0\nSECTION", "damaged"),
        ("", "damaged"),
        (as_dxf([]), "the DXF file has no lines of a crease pattern"),
    ],
)
def test_damaged_files_are_refused(text: str, message: str) -> None:
    with pytest.raises(MalformedDrawingError, match=message):
        read_dxf(text)


@pytest.mark.slow
def test_blocks_in_blocks_have_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    def doubling(document, space) -> None:
        document.blocks.new("b0").add_line((0, 0), (1, 1))
        for k in range(1, 12):
            block = document.blocks.new(f"b{k}")
            block.add_blockref(f"b{k - 1}", (0, 0))
            block.add_blockref(f"b{k - 1}", (1, 0))
        space.add_blockref("b11", (0, 0))

    text = made(doubling)
    assert len(read_dxf(text).lines) == 2**11
    monkeypatch.setattr("exactfold.pattern.drawing.formats.dxf.MOST_LINES", 500)
    with pytest.raises(TooLargeError, match="more than 500 elements after its blocks"):
        read_dxf(text)
    monkeypatch.setattr("exactfold.pattern.drawing.formats.dxf.MOST_DEPTH", 5)
    with pytest.raises(TooLargeError, match="more than 5 deep"):
        read_dxf(text)


def test_a_block_that_contains_itself_is_refused() -> None:
    def draw(document, space) -> None:
        document.blocks.new("b").add_blockref("b", (0, 0))
        space.add_blockref("b", (0, 0))

    with pytest.raises((TooLargeError, MalformedDrawingError)):
        read_dxf(made(draw))


def test_huge_numbers_are_refused_as_in_other_formats() -> None:
    with pytest.raises(TooLargeError, match="1e50"):
        parse_drawing(as_dxf(SQUARE).replace("0.5", "1e200"), "a.dxf")


def test_code_pages_and_binary_files() -> None:
    names = {"B": "輪郭", "M": "山折り", "V": "谷折り"}
    page = "0\nSECTION\n2\nHEADER\n9\n$DWGCODEPAGE\n3\nANSI_932\n0\nENDSEC\n"
    content = (page + as_dxf(SQUARE, names)).encode("cp932")
    assert drawn(parse_drawing(content, "a.dxf")) == places(SQUARE)
    with pytest.raises(UnknownFormatError, match="binary DXF file: save it as an ASCII DXF"):
        parse_drawing(b"AutoCAD Binary DXF\r\n\x1a\x00\xff", "a.dxf")
    with pytest.raises(UnknownFormatError, match="not text"):
        parse_drawing(content.replace(b"ANSI_932", b"ANSI_999"), "a.dxf")


def test_without_the_package_the_message_says_how_to_install_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    with pytest.raises(PackageMissingError, match=r"pip install 'exactfold\[dxf\]'"):
        read_dxf(as_dxf(SQUARE))


def test_decimals_are_read_as_written() -> None:
    drawing = read_dxf(as_dxf([(("0.1", "0"), ("0.30000000000000004", "1"), "M")]))
    assert drawing.points == (
        (Fraction(1, 10), Fraction(0)),
        (Fraction("0.30000000000000004"), Fraction(1)),
    )
