"""SVG: colours, styles, transforms, shapes, paths; what is left out; curves, which are refused."""

from fractions import Fraction
from itertools import pairwise

import pytest
from drawings import drawn, places, svg

from exactfold.errors import MalformedDrawingError, TooLargeError, UsageError
from exactfold.pattern.drawing.drawing import SvgReading
from exactfold.pattern.drawing.formats import svg_path
from exactfold.pattern.drawing.formats.svg import read_svg
from exactfold.pattern.drawing.formats.svg_path import path_lines
from exactfold.pattern.opening import from_drawing

ONE = '<line x1="1" y1="2" x2="3.1" y2="4" {}/>'
PLACED = (("1", "-2"), ("3.1", "-4"))


CREASE = '<line x1="5" y1="5" x2="6" y2="7" stroke="#f00"/>'
"""A crease by its colour, so that black is the boundary."""


def letters(content, **reading):
    return [line.letter for line in read_svg(svg(content), SvgReading(**reading)).lines]


@pytest.mark.parametrize(
    ("colour", "letter"),
    [
        ("black", "B"),
        ("#000", "B"),
        ("RGB(0, 0, 0)", "B"),
        ("red", "M"),
        ("#FF0000", "M"),
        ("blue", "V"),
        ("#00f", "V"),
        ("green", "C"),
        ("#0f0", "C"),
        ("yellow", "F"),
        ("rgb(255,255,0)", "F"),
        ("magenta", "U"),
        ("#F0F", "U"),
    ],
)
def test_the_colours_of_origami_simulator(colour, letter):
    drawing = read_svg(svg(ONE.format(f'stroke="{colour}"') + CREASE))
    assert drawn(drawing) == places([(*PLACED, letter), (("5", "-5"), ("6", "-7"), "M")])
    assert drawing.remarks == ()


@pytest.mark.parametrize("size", ['width="40" height="20"', 'width="9" viewBox="0 0,40 20"'])
def test_percent_are_shares_of_the_size_of_the_picture(size):
    line = '<line x1="12.5%" x2="5" y2="100%" stroke="red"/>'
    drawing = read_svg(f'<svg xmlns="http://www.w3.org/2000/svg" {size}><g>{line}</g></svg>')
    assert drawing.points == ((5, 0), (5, -20))


@pytest.mark.parametrize(
    "content",
    [
        '<svg><line x2="100%" y2="1" stroke="red"/></svg>',
        '<svg width="wide"><line x2="100%" y2="1" stroke="red"/></svg>',
        '<svg width="40"><svg><line x2="100%" y2="1" stroke="red"/></svg></svg>',
    ],
)
def test_percent_of_an_unknown_size_are_refused(content):
    with pytest.raises(MalformedDrawingError, match="line 1: x2 is '100%', not a length"):
        read_svg(content)


@pytest.mark.parametrize(
    ("colour", "letter"), [("#ed1c24", "M"), ("#2e3192", "V"), ("#231f20", "B"), ("#fff200", "F")]
)
def test_colours_near_these_are_taken_for_them_with_a_remark(colour, letter):
    drawing = read_svg(svg(ONE.format(f'stroke="{colour}"') + CREASE))
    assert drawing.lines[0].letter == letter
    assert drawing.remarks == (f"took 1 element of colour '{colour}' for {letter}",)


@pytest.mark.parametrize("colour", ["#808080", "cyan", "white", "orange", "url(#g)", "bluish"])
def test_other_colours_are_left_out_with_a_remark(colour):
    drawing = read_svg(svg(ONE.format('stroke="red"') + ONE.format(f'stroke="{colour}"')))
    assert len(drawing.lines) == 1
    assert drawing.remarks == (
        f"left out 1 element of colour '{colour}' (`--colours` gives it a letter)",
    )


@pytest.mark.parametrize(
    "content",
    [
        ONE.format('stroke="blue" style="stroke: #f00; fill:none"'),
        "<style>.st0{fill:none;stroke:#FF0000;}</style>" + ONE.format('class="st0"'),
        "<style><![CDATA[ /* m */ line { stroke:red } ]]></style>" + ONE.format(""),
        f'<g stroke="red"><g>{ONE.format("")}</g></g>',
        f'<g stroke="blue"><g style="stroke:red">{ONE.format("")}</g></g>',
        ONE.format('style="stroke:red !important"'),
        '<g color="red">' + ONE.format('stroke="currentColor"') + "</g>",
    ],
)
def test_styles(content):
    assert drawn(read_svg(svg(content))) == places([(*PLACED, "M")])


def test_what_is_not_drawn_is_left_out():
    drawing = read_svg(
        svg(
            f"<defs>{ONE.format('stroke=' + chr(34) + 'red' + chr(34))}</defs>"
            f'<g display="none"><line x2="5" stroke="red"/></g>'
            f'<g visibility="hidden"><line x2="6" stroke="red"/></g>'
            f'<line x2="7"/><rect width="9" height="9" fill="white"/>'
            f'<circle r="1" stroke="red"/><text stroke="red">A</text>'
            f'<line x2="8" stroke="red"/>'
        )
    )
    assert drawn(drawing) == places([(("0", "0"), ("8", "0"), "M")])
    assert drawing.remarks == (
        "left out 1 element of the kind circle",
        "left out 1 element of the kind text",
        "left out 1 element with hidden visibility",
        "left out 2 elements without stroke",
    )


def test_only_the_opacity_of_creases_is_a_fold_angle():
    content = ONE.format('stroke="red" opacity="0.5"') + ONE.format('stroke="#000" opacity="0.5"')
    drawing = read_svg(svg(content + '<line x2="1" stroke="blue" style="stroke-opacity:.2"/>'))
    assert drawing.remarks == ("did not read the opacity of 2 elements as fold angles",)


@pytest.mark.parametrize(
    ("transform", "end"),
    [
        ("translate(0.1, 0.2)", ("3.2", "-4.2")),
        ("scale(2)", ("6.2", "-8")),
        ("matrix(0 1 1 0 0.5 0)", ("4.5", "-3.1")),
        ("translate(1 1) scale(10)", ("32", "-41")),
    ],
)
def test_transforms(transform, end):
    direct = read_svg(svg(ONE.format(f'stroke="red" transform="{transform}"')))
    grouped = read_svg(svg(f'<g transform="{transform}">{ONE.format("")}</g>', 'stroke="red"'))
    assert direct.points[1] == tuple(map(Fraction, end))
    assert grouped.points == direct.points


def test_a_rotation_is_right_to_the_precision_of_floats():
    drawing = read_svg(svg('<line x2="1" stroke="red" transform="rotate(30)"/>'))
    x, y = drawing.points[1]
    assert float(x) == pytest.approx(3**0.5 / 2, abs=1e-15)
    assert float(y) == pytest.approx(-1 / 2, abs=1e-15)


def test_the_size_of_the_picture_does_not_change_the_numbers():
    size = 'width="10cm" height="20cm" viewBox="0 0 300 600"'
    assert drawn(read_svg(svg(ONE.format('stroke="red"'), size))) == places([(*PLACED, "M")])


@pytest.mark.parametrize("stroke", ['stroke="red"', 'style="stroke:red"'])
def test_shapes(stroke):
    corners = [("0", "0"), ("2", "0"), ("2", "-0.3"), ("0", "-0.3")]
    sides = [(a, b, "M") for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    rect = read_svg(svg(f'<rect width="2" height=".3" {stroke}/>'))
    polygon = read_svg(svg(f'<polygon points="0,0 2,0 2,.3 0,.3" {stroke}/>'))
    polyline = read_svg(svg(f'<polyline points="0 0,2 0 2 3e-1 0-0.3" {stroke}/>'))
    path = read_svg(svg(f'<path d="M0 0H2V.3h-2z" {stroke}/>'))
    assert drawn(rect) == drawn(polygon) == drawn(path) == places(sides)
    last = (("2", "-0.3"), ("0", "0.3"), "M")
    assert drawn(polyline) == places([*sides[:2], last])


def test_units_of_length():
    drawing = read_svg(svg('<line x2="25.4mm" y2="1in" stroke="red"/>'))
    assert drawing.points[1] == (96, -96)


@pytest.mark.parametrize(
    ("data", "ends"),
    [
        ("M1 2 3 4 5 6", [(3, 4), (5, 6)]),
        ("m1 2 3 4 5 6", [(4, 6), (9, 12)]),
        ("M1,2L3,4H5V6", [(3, 4), (5, 4), (5, 6)]),
        ("M1,2l3,4h5v6", [(4, 6), (9, 6), (9, 12)]),
        ("M1 2 3 4 5 5zl1 0", [(3, 4), (5, 5), (1, 2), (2, 2)]),
        ("M1 2L3 4L1 2z", [(3, 4), (1, 2)]),
        ("M1 2h1M5 5v1", [(2, 2), (5, 6)]),
        ("M1 2h1m5 5v1", [(2, 2), (7, 8)]),
        ("M0-1.5.5.5", [(Fraction(1, 2), Fraction(1, 2))]),
        ("M0 0l1e1-1E-1", [(10, Fraction(-1, 10))]),
    ],
)
def test_paths(data, ends):
    lines, unbent, bent = path_lines(data)
    assert [end for _, end in lines] == ends
    assert (unbent, bent) == (0, ())


def test_relative_places_are_added_exactly():
    lines, *_ = path_lines("m0.1 0" + "l0.1 0" * 9)
    assert lines[-1][1] == (1, 0)


@pytest.mark.parametrize(
    "data",
    [
        "M0 0C1 1 2 2 3 3",
        "M0 0c0 0 3 3 3 3",
        "M0 0S1 1 3 3",
        "M0 0Q1 1 3 3",
        "M0 0T3 3",
        "M0 0A2000 2000 0 0 1 3 3",
    ],
)
def test_curves_that_do_not_bend_are_lines(data):
    assert path_lines(data, 5) == ([((0, 0), (3, 3))], 1, ())


def test_an_arc_without_a_radius_is_a_line():
    assert path_lines("M0 0A0 5 0 0 1 3 3") == ([((0, 0), (3, 3))], 0, ())


def test_a_curve_that_hardly_bends_is_read_with_a_remark():
    drawing = read_svg(svg('<path stroke="red" d="M0 0C1 .0009 2 0 3 0"/>'))
    assert drawn(drawing) == places([(("0", "0"), ("3", "0"), "M")])
    assert drawing.remarks == ("read 1 curve as straight, within 1/1000 of the length",)


@pytest.mark.parametrize(
    "data",
    [
        "M0 0C0 1 2 2 3 3",
        "M0 0Q1 0 2 2",
        "M0 0Q-1-1 2 2",  # straight, but it turns back
        "M0 0Q.5 0 1 0T1 1",
        "M0 0C0 0 .5 0 1 0S2 1 2 0",
        "M0 0A1 1 0 0 1 2 2",
        "M0 0C1 1 1 0 0 0",
    ],
)
def test_curves_are_refused(data):
    with pytest.raises(MalformedDrawingError, match=r"straight, .* `--chords 8` reads each as 8"):
        read_svg(svg(f'<path stroke="red" d="{data}"/>'))


def test_the_refusal_of_curves_names_the_elements():
    bent = '<path id="arc" stroke="red" d="M0 0Q1 0 2 2M0 0Q1 0 2 2"/>'
    content = '<path stroke="red" d="M0 0h1"/>' + bent + '<path stroke="red" d="M0 0Q1 0 9 2"/>' * 7
    with pytest.raises(MalformedDrawingError) as refusal:
        read_svg(svg(content))
    assert str(refusal.value).startswith(
        "path 2 (id 'arc'): a curve (Q) from (0, 0) to (2, 2); creases must be straight, and the "
        "drawing has 9 curves (2 in path 2 (id 'arc'), 1 in path 3, 1 in path 4, 1 in path 5, 1 in "
        "path 6, ... 3 more): `--chords 8`"
    )
    with pytest.raises(MalformedDrawingError, match="rect 1: a rounded corner"):
        read_svg(svg('<rect width="3" height="3" rx="1" stroke="red"/>'))


def test_a_curve_is_as_many_chords_as_asked_for():
    content = '<path stroke="red" d="M0 0Q2 4 4 0"/><path stroke="blue" d="M0 0C1 0 2 0 3 0"/>'
    drawing = read_svg(svg(content), SvgReading(chords=4))
    places_passed = [("0", "0"), ("1", "-1.5"), ("2", "-2"), ("3", "-1.5"), ("4", "0")]
    chords = [(a, b, "M") for a, b in pairwise(places_passed)]
    assert drawn(drawing) == places([*chords, (("0", "0"), ("3", "0"), "V")])
    assert drawing.remarks == (
        "read 1 curve as straight, within 1/1000 of the length",
        "read 1 curve (1 in path 1) as 4 chords each: all answers are about the sheet with these "
        "straight lines and rigid panels, not about the curved one",
    )


@pytest.mark.parametrize(
    ("data", "passed"),
    [
        ("M0 0C0 3 3 3 3 0", [(1.5, 2.25), (3, 0)]),
        ("M0 0C0 3 3 3 3 0S6-3 6 0", [(1.5, 2.25), (3, 0), (4.5, -2.25), (6, 0)]),
        ("M0 0Q1 2 2 0T4 0", [(1, 1), (2, 0), (3, -1), (4, 0)]),
        ("M0 0A5 5 0 0 1 10 0", [(5, -5), (10, 0)]),  # clockwise on the screen: above
        ("M0 0A5 5 0 0 0 10 0", [(5, 5), (10, 0)]),
        ("M0 0A1 1 0 0 0 10 0", [(5, 5), (10, 0)]),  # too small a radius grows
        ("M0 0a5 5 0 016 0", [(3, -1), (6, 0)]),  # flags without spaces
        ("M0 0a5 5 0 116 0", [(3, -9), (6, 0)]),
        ("M0 0a5,5,0,1,0,6,0", [(3, 9), (6, 0)]),
        ("M0 0A5 10 90 0 1 0 10", [(10, 5), (0, 10)]),  # the first radius lies downwards
    ],
)
def test_places_on_curves(data, passed):
    ends = [end for _, end in path_lines(data, 2).lines]
    assert [(float(x), float(y)) for x, y in ends] == [pytest.approx(p) for p in passed]
    assert ends[-1] == passed[-1]


def test_rounded_corners():
    content = '<rect width="10" height="8" rx="5" ry="2" stroke="red"/>'
    ends = read_svg(svg(content), SvgReading(chords=1)).points
    assert set(ends) == {(5, 0), (10, -2), (10, -6), (5, -8), (0, -6), (0, -2)}
    square = read_svg(svg('<rect width="10" height="8" rx="0" ry="2" stroke="red"/>'))
    assert set(square.points) == {(0, 0), (10, 0), (10, -8), (0, -8)}


def test_too_many_chords(monkeypatch):
    content = '<path stroke="red" d="M0 0Q1 0 2 2Q1 0 3 3"/>'
    monkeypatch.setattr(svg_path, "MOST_LINES", 6)
    assert len(read_svg(svg(content), SvgReading(chords=3)).lines) == 6
    with pytest.raises(TooLargeError, match="more than 6 lines: read each as fewer chords than 4"):
        read_svg(svg(content), SvgReading(chords=4))
    with pytest.raises(TooLargeError, match="fewer chords than 3"):
        read_svg(svg(content + content), SvgReading(chords=3))
    with pytest.raises(UsageError, match="the number of chords of a curve is 0"):
        SvgReading(chords=0)


def test_arcs_beyond_floats_are_refused():
    for radius in ("1e999", "1e-999"):
        with pytest.raises(MalformedDrawingError, match="path 1: an arc has numbers that are too"):
            read_svg(svg(f'<path stroke="red" d="M0 0A{radius} 1 0 0 1 2 2"/>'))


def test_curves_in_other_colours_do_not_matter():
    assert letters('<path stroke="gray" d="M0 0Q1 0 2 2"/><line x2="1" stroke="blue"/>') == ["V"]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ('<path stroke="red" d="M0 0L1"/>', "path 1: .*too few numbers after 'L'"),
        ('<path stroke="red" d="M0 0X1 1"/>', "path 1: .*unknown command 'X'"),
        ('<path stroke="red" d="M0 0;1 1"/>', "path 1: .*cannot be read at ';1 1'"),
        ('<path stroke="red" d="1 1"/>', "path 1: .*without a command"),
        ('<path stroke="red" d="M0 0z1 1"/>', "path 1: .*without a command"),
        ('<polygon stroke="red" points="0,0 1,1 2"/>', "polygon 1: `points`"),
        ('<polyline stroke="red" points="0,0 a,1"/>', "polyline 1: `points`"),
        ('<line stroke="red" x2="50%"/>', "line 1: x2 is '50%'"),
        ('<line stroke="red" x2="NaN"/>', "line 1: x2 is 'NaN'"),
        ('<g transform="rotate(a)"><line stroke="red" x2="1"/></g>', r"line 1: .*'rotate\(a\)'"),
    ],
)
def test_what_is_not_understood_is_named(content, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_svg(svg(content))


@pytest.mark.parametrize("text", ["<svg>", "<svg/", "", "<a/><b/>", "<html/>", "<svg xmlns='a'/>"])
def test_what_is_no_svg(text):
    with pytest.raises(MalformedDrawingError):
        read_svg(text)


def test_an_empty_picture():
    with pytest.raises(MalformedDrawingError, match=r"SVG .*\(left out 1 element without stroke\)"):
        read_svg(svg('<line x2="1"/>'))


def test_entities_that_grow_without_bound_are_refused():
    rows = "".join(f'<!ENTITY e{k} "{f"&e{k - 1};" * 10}">' for k in range(1, 12))
    bomb = f'<!DOCTYPE svg [<!ENTITY e0 "lol">{rows}]><svg>&e11;</svg>'
    with pytest.raises(MalformedDrawingError):
        read_svg(bomb)


# --- drawings whose colours do not tell creases apart --------------------------------------------


def crossed(first="", second="", border=""):
    """A square with two creases from side to side that cross in its middle."""
    return (
        f'<rect width="4" height="4" stroke="black" {border}/>'
        f'<line x1="1" y1="0" x2="3" y2="4" stroke="black" {first}/>'
        f'<line x1="0" y1="1" x2="4" y2="3" stroke="black" {second}/>'
    )


def creases(content, **reading):
    """The letters of the folds in the sheet of a drawing, sorted."""
    opened = from_drawing(read_svg(svg(content), SvgReading(**reading)))
    return "".join(sorted(opened.assignment[fold] for fold in opened.sheet.folds))


def test_black_lines_inside_a_black_outline_are_creases_without_letters():
    drawing = read_svg(svg(crossed()))
    assert drawing.remarks == (
        "no colour says which lines are mountains or valleys (6 lines solid black): all are read "
        "as creases without a letter, except the outermost, which are the boundary (`--colours` "
        "and `--dashes` give letters)",
    )
    opened = from_drawing(drawing)
    assert creases(crossed()) == "UUUU"
    assert len(opened.sheet.faces) == 4
    assert {opened.assignment[edge] for edge in opened.sheet.boundary_edges} == {"B"}


def test_colours_without_a_meaning_are_creases_if_no_others_are():
    content = crossed('style="stroke:orange"') + '<line x2="4" y1="3" y2="3" stroke="#ddd"/>'
    drawing = read_svg(svg(content))
    assert drawing.remarks[0] == (
        "left out 1 element of colour '#ddd' (`--colours` gives it a letter)"
    )
    assert "(5 lines solid black, 1 line solid orange)" in drawing.remarks[1]
    assert creases(content) == "UUUU"


def test_dashed_valleys_and_dash_dotted_mountains():
    drawing = crossed('stroke-dasharray="5 3"', 'style="stroke-dasharray: 8,2,1,2"')
    assert creases(drawing) == "MMVV"
    remark = read_svg(svg(drawing)).remarks[0]
    assert "(4 lines solid black, 1 line dashed (5 3) black, 1 line dash-dotted (8 2 1 2)" in remark
    assert "valleys where dashed, mountains where dash-dotted" in remark
    third = drawing + '<line x1="1" x2="1" y2="4" stroke="black"/>'
    assert creases(third).count("U") == 2


@pytest.mark.parametrize("dashes", ["4", "4 3", "1 5", "9 2 1 2"])
def test_dashes_of_one_kind_claim_nothing(dashes):
    assert creases(crossed(f'stroke-dasharray="{dashes}"')) == "UUUU"


@pytest.mark.parametrize("dashes", ["none", "3 0", "0", "x"])
def test_strokes_that_are_solid(dashes):
    assert (
        "(6 lines solid black)" in read_svg(svg(crossed(f'stroke-dasharray="{dashes}"'))).remarks[0]
    )


def test_other_colours_than_those_of_origami_simulator_are_not_taken_for_its_cuts():
    pair = (
        '<line x2="1" stroke="{}"/><line x2="2" stroke="#40f90d"/><line x2="3" stroke="#ffb806"/>'
    )
    assert letters(pair.format("purple")) == [*"UUU"]
    assert letters(pair.format("red")) == [*"MCF"]


def test_a_cut_by_its_colour_stays_a_cut():
    assert letters('<line x2="1" stroke="black"/><line x2="2" stroke="lime"/>') == ["U", "C"]


# --- names -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "letter"),
    [
        ('id="mountain"', "M"),
        ('id="Mountains"', "M"),
        ('class="thin valley"', "V"),
        ('id="valley-folds"', "V"),
        ('id="valleys_1_"', "V"),
        ('xmlns:i="http://www.inkscape.org/namespaces/inkscape" i:label="Valley creases"', "V"),
        ('class="boundaries"', "B"),
        ('id="unassigned"', "U"),
        ('id="cuts"', "C"),
    ],
)
def test_names_of_groups_say_what_black_and_grey_lines_are(name, letter):
    for colour in ("black", "gray"):
        content = f'<g {name}><g id="g7"><line x2="1" stroke="{colour}"/></g></g>'
        assert letters(content + CREASE) == [letter, "M"]
    took = f"took 1 element for {letter} by the name of their class, id or layer"
    assert read_svg(svg(content + CREASE)).remarks == (took,)


def test_the_nearest_name_counts_and_colours_of_creases_come_before_names():
    inner = '<g id="mountains"><g id="valleys"><line x2="1" stroke="{}"/></g></g>'
    assert letters(inner.format("black")) == ["V"]
    assert letters(inner.format("red")) == ["M"]
    assert letters(inner.format("lime")) == ["C"]
    assert letters(inner.format("black"), colours={"black": "U"}) == ["U"]
    assert letters(inner.format("black"), dashes={"solid": "F"}) == ["F"]


@pytest.mark.parametrize("name", ["mount", "cutting", "flat", "edges", "marks", "crease"])
def test_names_that_say_nothing(name):
    assert letters(f'<g id="{name}"><line x2="1" stroke="black"/></g>' + CREASE) == ["B", "M"]


def test_lines_of_width_zero_are_not_drawn():
    lines = '<g stroke-width="0"><line x2="1" stroke="red"/></g><line x2="2" stroke="blue"/>'
    drawing = read_svg(svg(lines + '<line x2="3" stroke="blue" style="stroke-width:0.0px"/>'))
    assert drawn(drawing) == places([(("0", "0"), ("2", "0"), "V")])
    assert drawing.remarks == ("left out 2 elements without stroke",)
    assert letters('<line x2="1" stroke="red" stroke-width="1%"/>') == ["M"]


# --- maps ----------------------------------------------------------------------------------------


def test_a_map_of_colours():
    content = crossed('style="stroke:orange"', 'style="stroke:#0088A5"')
    assert creases(content, colours={"#ffa500": "M", "rgb(0, 136, 165)": "V"}) == "MMVV"
    assert letters(content, colours={"orange": "M"}) == [*"BBBBM"]
    red = '<line x2="1" stroke="red"/><line x2="2" stroke="#ff0001"/>'
    assert letters(red, colours={"red": "V"}) == ["V", "M"]
    assert read_svg(svg(red), SvgReading(colours={"red": "V", "#FF0001": "V"})).remarks == ()


def test_a_map_of_dashes():
    content = crossed('stroke-dasharray="8,8"', 'stroke-dasharray="3px"')
    assert creases(content, dashes={"8 8": "M", "3": "V"}) == "MMVV"
    assert creases(content, dashes={"8,8": "M"}) == "MMUU"
    assert creases(content, dashes={"dashed": "V"}) == "VVVV"
    assert letters(content, dashes={"solid": "B", "8 8": "M", "dashed": "V"}) == [*"BBBBMV"]


def test_dashes_come_before_colours():
    lines = '<line x2="1" stroke="red"/><line x2="2" stroke="red" stroke-dasharray="2 1"/>'
    assert letters(lines, dashes={"2 1": "V"}) == ["M", "V"]
    assert letters(lines, dashes={"2 1": "V"}, colours={"red": "F"}) == ["F", "V"]


def test_black_in_a_map_reads_borders_inside_as_creases():
    content = crossed('style="stroke:red"')
    assert creases(content, colours={"black": "U"}) == "MMUU"


@pytest.mark.parametrize(
    ("reading", "message"),
    [
        ({"colours": {"orange": "M"}}, "no line has 'orange'; the lines have black \\(6 lines\\)"),
        ({"colours": {"blackish": "M"}}, "no line has 'blackish'"),
        ({"colours": {"black": "X"}}, "the letter 'X' is not one of B, M, V, F, U, C, J"),
        ({"colours": {"black": ""}}, "the letter '' is not one of"),
        ({"dashes": {"3 2": "V"}}, r"no line has '3 2'; the lines have solid \(5 lines\), 8 4 \(1"),
        ({"dashes": {"dotted": "V"}}, "no line has 'dotted'"),
        ({"dashes": {"stripes": "V"}}, "no line has 'stripes'"),
    ],
)
def test_maps_that_do_not_fit_are_refused_with_what_is_there(reading, message):
    with pytest.raises(UsageError, match=message):
        read_svg(svg(crossed('stroke-dasharray="8 4"')), SvgReading(**reading))
