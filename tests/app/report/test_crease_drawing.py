"""Pictures of crease patterns, read back: lines by letter and angle, vertices by sign and room."""

from fractions import Fraction

import numpy as np
import pytest
from svg_reading import NAME, ends, group_of, letters, numbered, of_class, shipped, tree, words

from exactfold import CreasePattern, random_square
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.crease_labels import labels
from exactfold.app.pictures.drawn_ways import branch_way
from exactfold.branches import find_branch
from exactfold.exact.surds import SurdField
from exactfold.pattern import load, open_pattern
from exactfold.pattern.data import EXAMPLES, example_path
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.families import single_vertex
from exactfold.pattern.panel_pattern import PanelPattern

DART = CreasePattern([(0, 0), (4, -4), (1, 0), (4, 4)], [(0, 1, 2), (0, 2, 3)])


@pytest.fixture(scope="module")
def random_8():
    return find_branch(load("random-8"), "+-++--+-")


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_shipped_pattern_is_drawn_with_the_letters_of_its_file(name):
    opened = shipped(name)
    sheet = opened.sheet
    text = pattern_picture(sheet, opened.assignment, title=name)
    folds = [opened.assignment.get(fold, "U") for fold in sheet.folds]
    expected = {letter: folds.count(letter) for letter in "MVFU" if letter in folds}
    assert letters(text) == expected | {"B": len(sheet.edges) - len(sheet.folds)}
    assert tree(text).find(f"{NAME}title").text == name


def test_every_line_names_its_place_and_its_fold(random_8):
    pattern = random_8.pattern
    text = branch_way(random_8).picture()
    lines = [one for one in tree(text).iter(f"{NAME}path") if one.get("data-edge")]
    found = {int(one.get("data-edge")): one for one in lines}
    assert sorted(found) == list(range(len(pattern.edges)))
    for k, (i, j) in enumerate(pattern.edges):
        letter = random_8.assignment.get((i, j), "B")
        assert found[k].get("class") == letter
        assert found[k].get("data-fold") == (None if letter == "B" else f"{i}-{j}")


def test_lines_lie_where_the_folds_are():
    """The square is as wide as the picture without its margin, and y is turned upwards."""
    pattern = CreasePattern(
        [(0, 0), (2, 0), (2, 2), (0, 2), (1, "1/2")], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    )
    text = pattern_picture(pattern, size=400, labelled=False, keyed=False)
    width = float(tree(text).get("width"))
    margin = (width - 400) / 2
    (line,) = [p for p in tree(text).iter(f"{NAME}path") if p.get("data-fold") == "0-4"]
    (x1, y1), (x2, y2) = ends(line)
    assert (x1 - margin, y1 - margin) == pytest.approx((0, 400))
    assert (x2 - margin, y2 - margin) == pytest.approx((200, 300))


def test_valleys_are_dashed_and_mountains_solid(random_8):
    text = branch_way(random_8).picture()
    mountain, valley, border = (group_of(text, letter) for letter in "MVB")
    assert mountain.get("stroke-dasharray") is None
    assert len(valley.get("stroke-dasharray").split()) == 2
    red, blue = (int(mountain.get("stroke")[k : k + 2], 16) for k in (1, 5))
    assert red > 3 * blue
    red, blue = (int(valley.get("stroke")[k : k + 2], 16) for k in (1, 5))
    assert blue > 3 * red
    assert border.get("stroke") == "#000000"
    assert border.get("stroke-dasharray") is None


def test_folds_without_a_letter_are_of_a_fifth_kind():
    text = pattern_picture(single_vertex(4), {(0, 4): "M", (1, 4): "V", (2, 4): "F"})
    styles = {
        (group_of(text, k).get("stroke"), group_of(text, k).get("stroke-dasharray"))
        for k in "MVFUB"
    }
    assert len({colour for colour, _ in styles}) == len({dash for _, dash in styles}) + 1 == 5
    plain = pattern_picture(single_vertex(4))
    assert group_of(plain, "U").get("stroke-dasharray") is None
    assert set(words(plain)) == {"0", "1", "2", "3", "4"}
    assert "unassigned" in words(text)
    signed = pattern_picture(single_vertex(4), {(0, 4): "M"}, signs={4: 1})
    assert "undecided" in words(signed)


def test_the_width_grows_with_the_angle(random_8):
    way = branch_way(random_8)
    text = way.picture()
    usual = {k: float(group_of(text, k).get("stroke-width")) for k in "MV"}
    widths = {
        one.get("data-fold"): float(one.get("stroke-width") or usual[one.get("class")])
        for one in tree(text).iter(f"{NAME}path")
        if one.get("data-fold")
    }
    order = sorted(way.angles, key=lambda fold: abs(way.angles[fold]))
    drawn = [widths[f"{i}-{j}"] for i, j in order]
    assert drawn == sorted(drawn)
    assert drawn[-1] > 2.5 * drawn[0]


def test_vertices_have_triangles_that_point_as_they_pop(random_8):
    text = branch_way(random_8).picture()
    assert {int(g.get("data-vertex")) for g in of_class(text, "up")} == {4, 6, 7, 10}
    assert {int(g.get("data-vertex")) for g in of_class(text, "down")} == {5, 8, 9, 11}
    for kind, sign in (("up", 1), ("down", -1)):
        for group in of_class(text, kind):
            corners = group.find(f"{NAME}path").get("d")[1:-1].replace("L", " ").split()
            tip, *base = map(float, corners[1::2])
            assert all(sign * (y - tip) > 0 for y in base)  # y runs downwards
    assert numbered(text, "up", "down") == set(range(4, 12))
    assert numbered(text, "rim") == {0, 1, 2, 3}


def test_flat_vertices_have_rings_and_others_dots():
    branch = find_branch("flat-octahedron", "+-+")
    text = branch_way(branch).picture()
    flat = [v for v, sign in branch.vertex_signs.items() if sign == 0]
    assert {int(g.get("data-vertex")) for g in of_class(text, "flat")} == set(flat) != set()
    assert all(g.find(f"{NAME}circle").get("fill") == "#ffffff" for g in of_class(text, "flat"))
    assert len(of_class(pattern_picture(branch.pattern), "vertex")) == branch.pattern.Vi
    assert "flat vertex" in words(text)


def test_the_legend_names_what_is_there_and_no_more(random_8):
    said = set(words(branch_way(random_8).picture()))
    assert {"mountain", "valley", "wide: folds more", "up", "down"} <= said
    assert not said & {"flat", "undecided", "flat vertex"}
    assert set(words(pattern_picture(random_8.pattern))) == {str(v) for v in range(12)}


# --- many vertices -------------------------------------------------------------------------------


def test_numbers_and_markers_drop_out_where_they_have_no_room():
    shown = {}
    for size in (440, 110, 40):
        pattern = random_square(30, seed=0)
        text = pattern_picture(
            pattern, signs=dict.fromkeys(pattern.interior, 1), size=size, keyed=False
        )
        shown[size] = (len(numbered(text, "up")), len(of_class(text, "up")))
    assert shown[440][1] > 25
    assert shown[440][0] > shown[110][0]
    assert shown[440][0] > 20
    assert shown[40] == (0, 0)


def test_no_number_lies_on_a_line_a_marker_or_another_number(random_8):
    lines = branch_way(random_8).drawing()
    placed = labels(lines.places, lines.lines.edges, {}, random_8.pattern.interior, 12)
    boxes = [(*label.place, 3.5 * len(str(label.vertex)), 5) for label in placed]
    for k, (x, y, w, h) in enumerate(boxes):
        assert not any(abs(x - a) < w + c and abs(y - b) < h + d for a, b, c, d in boxes[:k])
    i, j = np.array(lines.lines.edges).T
    for t in np.linspace(0, 1, 200):
        along = (1 - t) * lines.places[i] + t * lines.places[j]
        for x, y, _, _ in boxes:
            assert np.linalg.norm(along - (x, y), axis=1).min() > 3.5


def grid(number):
    rows = range(number)
    points = [(x, y) for y in rows for x in rows]
    cells = [x + number * y for y in rows[:-1] for x in rows[:-1]]
    return CreasePattern(
        points,
        [t for c in cells for t in ((c, c + 1, c + number + 1), (c, c + number + 1, c + number))],
    )


@pytest.mark.parametrize("side", [45, pytest.param(100, marks=pytest.mark.slow)])
def test_thousands_of_vertices_are_a_small_file(side):
    pattern = grid(side)
    some = {fold: "MVFU"[k % 4] for k, fold in enumerate(pattern.folds)}
    angles = {fold: float(k % 11) for k, fold in enumerate(pattern.folds)}
    text = pattern_picture(pattern, some, angles=angles, signs=dict.fromkeys(pattern.interior, -1))
    assert len(text) < 75 * side**2
    assert set(letters(text)) == set("MVFUB")
    drawn = [p.get("d").count("M") for p in tree(text).iter(f"{NAME}path") if p.get("class")]
    assert sum(drawn) == len(pattern.edges)
    assert of_class(text, "down") == []
    assert text.count("data-") == 0


def test_lines_may_be_joined_or_not_as_is_asked():
    pattern = random_square(5, seed=0)
    joined = pattern_picture(pattern, joined=True)
    assert letters(joined) == {"U": 1, "B": 1}
    (path,) = [p for p in tree(joined).iter(f"{NAME}path") if p.get("class") == "U"]
    assert path.get("d").count("M") == len(pattern.folds)


# --- any sheet -----------------------------------------------------------------------------------


def mirrored(text):
    """The ends of all lines, from the other side."""
    width = float(tree(text).get("width"))
    return {
        p.get("data-edge"): [(round(width - x, 1), round(y, 1)) for x, y in ends(p)]
        for p in tree(text).iter(f"{NAME}path")
        if p.get("data-edge")
    }


def test_the_mirror_image_of_a_sheet_has_the_mirror_picture():
    pattern = random_square(6, seed=4)
    other = CreasePattern([(-x, y) for x, y in pattern.vertices], pattern.triangles)
    one = pattern_picture(pattern, keyed=False)
    two = pattern_picture(other, keyed=False)
    plain = {
        p.get("data-edge"): [(round(x, 1), round(y, 1)) for x, y in ends(p)]
        for p in tree(two).iter(f"{NAME}path")
        if p.get("data-edge")
    }
    for edge, places in mirrored(one).items():
        assert np.array(places) == pytest.approx(np.array(plain[edge]), abs=0.11)


@pytest.mark.parametrize("turn", [1, -1])
def test_numbers_of_the_boundary_stand_outside(turn):
    """Also at a reflex corner, where the sheet is on the other side."""
    pattern = CreasePattern([(turn * x, y) for x, y in DART.vertices], DART.triangles)
    text = pattern_picture(pattern, size=300)
    assert numbered(text, "rim") == {0, 1, 2, 3}
    (corner,) = [g for g in of_class(text, "rim") if g.get("data-vertex") == "2"]
    number = corner.find(f"{NAME}text")
    (fold,) = [p for p in tree(text).iter(f"{NAME}path") if p.get("data-fold") == "0-2"]
    (x0, _), (x2, _) = ends(fold)
    assert (float(number.get("x")) - x2) * (x2 - x0) > 0


def test_one_triangle_and_one_vertex():
    triangle = CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])
    assert letters(pattern_picture(triangle)) == {"B": 3}
    wheel = CreasePattern([(0, 0), (3, 0), (0, 3), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)])
    assert numbered(pattern_picture(wheel), "vertex") == {3}
    assert tree(pattern_picture(Drawing((), (), "nothing"))).get("width")
    assert letters(pattern_picture(Drawing(((1, 1),), (), "a point"))) == {}


def test_panels_and_square_roots():
    opened = open_pattern(example_path("zigzags"))
    text = pattern_picture(opened.sheet, opened.assignment)
    assert sum(letters(text).values()) == len(opened.sheet.edges)
    root = SurdField(()).adjoined(2).root
    square = PanelPattern(
        [(0, 0), (root, 0), (root, root), (0, root)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    )
    assert letters(pattern_picture(square)) == {"U": 1, "B": 4}


def test_a_drawing_that_is_no_sheet_is_drawn_as_it_is():
    ring = [(0, 0), (6, 0), (6, 6), (0, 6), (2, 2), (4, 2), (4, 4), (2, 4)]
    lines = [Line(k, (k + 1) % 4, "B") for k in range(4)]
    lines += [Line(4 + k, 4 + (k + 1) % 4, "C") for k in range(4)]
    drawing = Drawing(tuple(ring), (*lines, Line(0, 4, "M"), Line(1, 5, "J")), "a hole")
    text = pattern_picture(drawing)
    assert letters(text) == {"B": 8, "M": 1, "F": 1}
    assert of_class(text, "rim") == of_class(text, "vertex") == []


@pytest.mark.parametrize("far", [10**30, Fraction(1, 10**30)])
def test_places_do_not_depend_on_the_unit_or_the_origin(far):
    pattern = random_square(3, seed=2)
    moved = CreasePattern(
        [(far * x + 10**40, far * y - 10**40) for x, y in pattern.vertices], pattern.triangles
    )
    assert pattern_picture(moved) == pattern_picture(pattern)


def test_coordinates_longer_than_floats():
    pattern = CreasePattern(
        [(0, 0), (10**500, 0), (10**500, 10**500), (0, 10**500)], [(0, 1, 2), (0, 2, 3)]
    )
    small = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
    assert pattern_picture(pattern) == pattern_picture(small)


def test_titles_are_made_safe():
    nasty = "<svg onload='x'> & \"quotes\" ]]> é\u0007"
    text = pattern_picture(single_vertex(4), title=nasty)
    assert tree(text).find(f"{NAME}title").text.startswith("<svg onload='x'> & \"quotes\" ]]> é")
