"""SVG files that ask for much: nesting, repetition, and text that is slow to search."""

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
