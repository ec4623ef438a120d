"""SVG files that ask for much: nesting, repetition, and text that is slow to search."""

from fractions import Fraction
from math import pi, sqrt

import pytest
from drawings import svg

from exactfold.checker.core.limits import MOST_DEPTH, MOST_TEXT, MOST_USED
from exactfold.errors import MalformedDrawingError, TooLargeError
from exactfold.pattern.drawing.formats import svg_tree
from exactfold.pattern.drawing.formats.svg import read_svg

LINE = '<line x2="1" y2="1" stroke="red"/>'
XLINK = 'xmlns:xlink="http://www.w3.org/1999/xlink"'


def nested(depth):
    return svg("<g>" * depth + LINE + "</g>" * depth)


def chain(length, each):
    """Groups of which each uses the one before it `each` times."""
    groups = [f'<g id="g0">{LINE}</g>']
    for k in range(1, length):
        groups.append(f'<g id="g{k}">' + f'<use href="#g{k - 1}"/>' * each + "</g>")
    return svg("".join(groups))


def test_groups_inside_each_other():
    assert len(read_svg(nested(MOST_DEPTH - 2)).lines) == 1
    for depth in (MOST_DEPTH - 1, 990, 10**4):
        with pytest.raises(TooLargeError, match=r"nested more than 200 deep, .*: ungroup them"):
            read_svg(nested(depth))


@pytest.mark.parametrize(
    "content",
    [
        f'<g id="a">{LINE}<use href="#a"/></g>',
        f'<g {XLINK} id="a">{LINE}<use xlink:href="#a"/></g>',
        f'<defs><g id="a"><use href="#b"/></g><g id="b"><use href="#a"/></g></defs>{LINE}',
        f'<clipPath id="a"><use href="#a"/></clipPath>{LINE}',
    ],
)
def test_a_use_inside_what_it_refers_to(content):
    with pytest.raises(MalformedDrawingError, match=r"`use` of '#[ab]' lies inside its own target"):
        read_svg(svg(content))


def test_elements_that_are_used_often():
    assert len(read_svg(chain(6, 2)).lines) == 63
    for length, each in ((40, 2), (12, 10)):
        with pytest.raises(TooLargeError, match=f"`use` repeats [0-9]+ .* at most {MOST_USED} are"):
            read_svg(chain(length, each))
    with pytest.raises(TooLargeError, match="nested more than 200 deep"):
        read_svg(chain(150, 1))


def test_one_element_more_than_may_be_repeated(monkeypatch):
    monkeypatch.setattr(svg_tree, "MOST_USED", 2)
    assert len(read_svg(svg(f'<g id="a">{LINE}</g><use href="#a"/>')).lines) == 2
    monkeypatch.setattr(svg_tree, "MOST_USED", 1)
    with pytest.raises(TooLargeError, match="repeats 2 elements of the SVG file, but"):
        read_svg(svg(f'<g id="a">{LINE}</g><use href="#a"/>'))


def test_of_elements_with_one_name_the_last_is_used():
    twice = f'<defs><g id="a">{LINE}{LINE}</g><g id="a">{LINE}</g></defs><use href="#a"/>'
    assert len(read_svg(svg(twice)).lines) == 1


@pytest.mark.parametrize(
    "style",
    ["a{" * 30000, "/*" * 30000, " a" * 30000, "a," * 30000 + "b{stroke:blue}", "*{:" * 30000],
)
def test_styles_that_regular_expressions_do_not_get_out_of(style):
    assert [x.letter for x in read_svg(svg(f"<style>{style}</style>{LINE}")).lines] == ["M"]


@pytest.mark.parametrize(
    ("attribute", "text"),
    [
        ("transform", "translate(" * 1000),
        ("transform", "rotate(1)" * 1000),
        ("stroke", "rgb(" + " " * 5000),
        ("style", "stroke:rgb(" + " " * 5000 + "1"),
        ("id", "a" * 5000),
    ],
)
def test_long_attributes(attribute, text):
    name = "stroke" if attribute == "style" else attribute
    message = rf"an attribute \({name}\) of an SVG element 'line' has .* at most {MOST_TEXT} are"
    with pytest.raises(TooLargeError, match=message):
        read_svg(svg(f'<line x2="1" {attribute}="{text}"/>'))


def test_attributes_that_are_not_read_may_be_long():
    text = "0 0 " * 30000
    drawing = read_svg(svg(f'<line x2="1" stroke="red" desc="{text}" fill="{text}"/>'))
    assert len(drawing.lines) == 1
    picture = f'<image href="data:{text}"/><text font="{text}">A</text>'
    assert read_svg(svg(picture + LINE)).points == ((0, 0), (1, -1))


def test_transforms_that_add_up():
    """The transforms of all groups around an element apply to it."""
    move = f'<g transform="translate({"0" * 100}1)">'
    two = svg(move * 2 + LINE + "</g>" * 2)
    assert read_svg(two).points == ((2, 0), (3, -1))
    many = MOST_TEXT // 100
    with pytest.raises(TooLargeError, match=r"transforms .* too long: [0-9]+ characters for one"):
        read_svg(svg(move * many + LINE + "</g>" * many))
    use = f'<use href="#{{}}" x="{"0" * 3000}1"/>'
    moved = f'<g id="a">{LINE}</g><g id="b">{use.format("a")}</g>'
    assert len(read_svg(svg(moved)).lines) == 2
    with pytest.raises(TooLargeError, match=r"too long: 60[0-9]+ characters for one"):
        read_svg(svg(moved + use.format("b")))


def test_transforms_of_all_elements(monkeypatch):
    drawn = svg(f'<g transform="scale(2)">{LINE * 10}</g>')
    monkeypatch.setattr(svg_tree, "MOST_TRANSFORMS", 88)
    assert len(read_svg(drawn).lines) == 10
    monkeypatch.setattr(svg_tree, "MOST_TRANSFORMS", 87)
    with pytest.raises(TooLargeError, match="8 characters for one element and 88 for all"):
        read_svg(drawn)


def test_transforms_beyond_all_floats():
    with pytest.raises(MalformedDrawingError, match="a transform has numbers that are too large"):
        read_svg(svg(f'<g transform="scale(1e300) scale(1e300)">{LINE}</g>'))


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (f'<polyline points="{" " * 50000}x"/>', "polyline 1: `points` does not consist of pairs"),
        (f'<polyline points="{"1" * 50000}x"/>', "polyline 1: `points` does not consist of pairs"),
        (f'<line x2="{" " * 50000}x"/>', "line 1: x2 is '    .*, not a length"),
        (f'<line x2="1{" " * 50000}!"/>', "line 1: x2 is '1   .*, not a length"),
        (f'<path d="M0 0{" " * 50000}x"/>', "path 1: path data has the unknown command 'x'"),
    ],
)
def test_long_geometry(shape, message):
    with pytest.raises(MalformedDrawingError, match=message):
        read_svg(svg(shape.replace("/>", ' stroke="red"/>')))


def test_styles_apply_in_their_order():
    """`*`, then the element, its name, its classes, and what it says itself."""
    rules = "*{stroke:yellow} line{stroke:blue} #a{stroke:red} .b{stroke:black} line.c{stroke:lime}"
    lines = [
        ("<rect width='1' height='1'/>", "F"),
        ('<line x2="2"/>', "V"),
        ('<line x2="3" id="a"/>', "M"),
        ('<line x2="4" id="a" class="b"/>', "B"),
        ('<line x2="5" id="a" class="x c b"/>', "B"),
        ('<line x2="6" class="b c"/>', "C"),
        ('<line x2="7" class="b" style="stroke : #f0f; x: y: z"/>', "U"),
    ]
    for element, letter in lines:
        crease = '<line x1="8" x2="9" stroke="red"/>'  # so that black is the boundary
        text = f"<style>/* // */ {rules} // end</style>{element}{crease}"
        *lines, _ = read_svg(svg(text)).lines
        assert {line.letter for line in lines} == {letter}, element


@pytest.mark.parametrize(
    ("rule", "fits"),
    [
        (".b.c", True),
        ("line.b.c", True),
        ("*.c.b", True),
        ("#a.b", True),
        ("g line", True),
        ("svg .b", True),
        ("#folds > .b", True),
        ("#folds g.near .c", True),
        ("g #folds .c", False),
        (".b.d", False),
        ("path.b.c", False),
        (".near.far line", False),
        ("line g", False),
        (".b:hover", False),
        ("[id=a].b", False),
    ],
)
def test_selectors_with_several_parts(rule, fits):
    text = (
        f"<style>line{{stroke:red}} {rule}{{stroke:blue}}</style>"
        '<g id="folds"><g class="near"><line x2="5" id="a" class="b c"/></g></g>'
    )
    assert [line.letter for line in read_svg(svg(text)).lines] == ["V" if fits else "M"]


def test_too_many_selectors_with_several_parts(monkeypatch):
    text = '<style>.a.b, g .a {stroke:red}</style><g><line x2="5" class="a"/></g>'
    monkeypatch.setattr(svg_tree, "MOST_SELECTORS", 2)
    assert len(read_svg(svg(text)).lines) == 1
    monkeypatch.setattr(svg_tree, "MOST_SELECTORS", 1)
    with pytest.raises(TooLargeError, match="more than 1 selectors with several parts"):
        read_svg(svg(text))


# --- transforms and pictures inside pictures -----------------------------------------------------


def moved_point(transform, x=2, y=1):
    """Where the end of a line goes from (x, y), y downwards."""
    drawing = read_svg(
        svg(f'<g transform="{transform}"><line x2="{x}" y2="{y}" stroke="red"/></g>')
    )
    line = drawing.lines[0]
    right, up = drawing.points[line[1]]
    return pytest.approx((float(right), -float(up)), abs=1e-12)


ROOT = sqrt(0.5)


@pytest.mark.parametrize(
    ("transform", "place"),
    [
        ("none", (2, 1)),
        ("matrix(1 2, 3-4 .5,6)", (5.5, 6)),
        ("translate(3px)", (5, 1)),
        ("translate(1in, -3)", (98, -2)),
        ("translateX(3)translateY(4)", (5, 5)),
        ("scale(2)", (4, 2)),
        ("scale(2, 3)", (4, 3)),
        ("scaleX(2) scaleY(-1)", (4, -1)),
        ("rotate(90)", (-1, 2)),
        ("rotate(.25turn)", (-1, 2)),
        ("rotate(100grad) rotate(45deg)", (-3 * ROOT, ROOT)),
        (f"rotate({pi / 2}rad)", (-1, 2)),
        ("rotate(90, 1 1)", (1, 2)),
        ("skewX(45)", (3, 1)),
        ("skewY(45)", (2, 3)),
        ("skew(45deg, -45deg)", (3, -1)),
        ("translate(1 2), scale(3)", (7, 5)),
        ("scale(3) translate(1 2)", (9, 9)),
    ],
)
def test_transforms(transform, place):
    assert place == moved_point(transform)


@pytest.mark.parametrize(
    ("transform", "message"),
    [
        ("rotate", "the transform 'rotate' cannot be read"),
        ("rotate3d(1, 2, 3)", "the transform 'rotate3d.*' cannot be read"),
        ("spin(3)", r"the transform 'spin\(3\)' cannot be read"),
        ("scale(2) and more", "the transform 'scale.*' cannot be read"),
        ("matrix(1 2 3 4 5)", r"a transform has 'matrix\(1 2 3 4 5\)'"),
        ("rotate(1 2)", r"a transform has 'rotate\(1 2\)'"),
        ("scale(a)", r"a transform has 'scale\(a\)'"),
        ("scale()", r"a transform has 'scale\(\)'"),
        ("scale(2px)", "a transform has '2px', a unit that is not read"),
        ("translate(10%)", "a transform has '10%', a unit that is not read"),
        ("rotate(3px)", "a transform has '3px', a unit that is not read"),
        ("scale(1e999)", "a transform has numbers that are too large"),
    ],
)
def test_transforms_that_are_not_read(transform, message):
    """They matter only if the line has a letter."""
    drawn = f'<g transform="{transform}"><line x2="3" stroke="{{}}"/></g>{LINE}'
    with pytest.raises(MalformedDrawingError, match=f"line 1: {message}"):
        read_svg(svg(drawn.format("red")))
    assert len(read_svg(svg(drawn.format("none"))).lines) == 1


def inner(attributes, content='<line x1="1" y1="1" x2="4" y2="3" stroke="red"/>'):
    """The two ends of a line in a picture inside a picture of 30 times 20, y downwards."""
    picture = f'<svg viewBox="0 0 30 20"><svg {attributes}>{content}</svg></svg>'
    drawing = read_svg(picture)
    (line,) = drawing.lines
    return [(x, -y) for x, y in (drawing.points[k] for k in line[:2])]


@pytest.mark.parametrize(
    ("attributes", "ends"),
    [
        ('x="5" y="7"', [(6, 8), (9, 10)]),
        ('x="5" width="12" height="4" viewBox="0 0 6 2"', [(7, 2), (13, 6)]),
        ('width="12" height="4" viewBox="1 1 6 2"', [(0, 0), (6, 4)]),
        ('viewBox="0 0 15 10"', [(2, 2), (8, 6)]),
        ('width="50%" height="10" viewBox="0 0 15 20"', [(Fraction(17, 4), 0.5), (5.75, 1.5)]),
        ('width="9" height="4" viewBox="0 0 3 2" preserveAspectRatio="none"', [(3, 2), (12, 6)]),
        ('width="9" height="4" viewBox="0 0 3 2"', [(3.5, 2), (9.5, 6)]),
        ('width="9" height="4" viewBox="0 0 3 2" preserveAspectRatio="xMinYMax"', [(2, 2), (8, 6)]),
        (
            'width="9" height="4" viewBox="0 0 3 2" preserveAspectRatio="xMaxYMid"',
            [(5, 2), (11, 6)],
        ),
        (
            'width="9" height="4" viewBox="0 0 3 2" preserveAspectRatio="xMidYMax slice"',
            [(3, 1), (12, 7)],
        ),
    ],
)
def test_a_picture_inside_a_picture(attributes, ends):
    assert inner(attributes) == ends


def test_a_picture_without_a_size():
    for attributes in ('width="0" viewBox="0 0 1 1"', 'viewBox="0 0 0 1"'):
        with pytest.raises(MalformedDrawingError, match=r"line 1: a picture inside .* has no size"):
            inner(attributes)


def test_parts_that_are_not_drawn_where_they_stand():
    """A symbol is drawn by `use` only, and a clip path not even so."""
    for tag in ("defs", "clipPath", "pattern", "mask", "marker", "symbol"):
        part = f'<{tag} id="a"><line x2="5" stroke="blue"/></{tag}>'
        assert [x.letter for x in read_svg(svg(part + LINE)).lines] == ["M"]
        both = read_svg(svg(part + LINE + '<use href="#a" y="3"/>'))
        assert [x.letter for x in both.lines] == (["M", "V"] if tag == "symbol" else ["M"])


def test_colours_that_are_inherited_and_current():
    group = '<g color="blue" stroke="{}"><line x2="1"/><line x2="2" color="red" {}/></g>'
    current = group.format("currentColor", "")
    assert [x.letter for x in read_svg(svg(current)).lines] == ["V", "V"]
    own = group.format("currentColor", 'stroke="currentColor"')
    assert [x.letter for x in read_svg(svg(own)).lines] == ["V", "M"]


@pytest.mark.parametrize(
    ("colour", "letter"),
    [
        *(("red", "M"), ("#F00", "M"), ("#ff0000", "M"), ("#f00f", "M"), ("#FF000080", "M")),
        *(("rgb(255, 0, 0)", "M"), ("RGBA(255,0,0,.5)", "M"), ("rgb(100%, 0%, 0%)", "M")),
        *(("rgb(255 0 0 / 50%)", "M"), ("hsl(0, 100%, 50%)", "M"), ("hsla(240deg 100% 50%)", "V")),
        *(("rgb(999, 0, 0)", "M"), ("navy", "V"), ("lime", "C"), ("green", "C"), ("yellow", "F")),
    ],
)
def test_colours(colour, letter):
    drawing = read_svg(svg(f'<line x2="1" stroke="{colour}"/><line x2="2" stroke="red"/>'))
    assert [x.letter for x in drawing.lines] == [letter, "M"]


@pytest.mark.parametrize("colour", ["rgb(1)", "reddish", "f00", "rgb(a,b,c)", "url(#a)", "#ff"])
def test_what_is_no_colour(colour):
    drawing = read_svg(svg(f'<line x2="1" stroke="{colour}"/><line x2="2" stroke="red"/>'))
    assert [x.letter for x in drawing.lines] == ["M"]
