"""Cuts: pieces, slits that open, holes that matter and holes that do not."""

import json
import random
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from drawings import svg

from exactfold import count
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.errors import (
    DisconnectedError,
    FoldError,
    MalformedPatternError,
    NotADiskError,
    SeveralSheetsError,
)
from exactfold.panels import decompose
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.cutting import pieces
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.formats.svg import read_svg
from exactfold.pattern.drawing.meant.left import left_relations
from exactfold.pattern.opening import from_drawing, open_pattern, panels
from exactfold.pattern.reading import Reading

COLOURS = {"B": "black", "M": "red", "V": "blue", "C": "lime", "U": "magenta"}


def square(x, y, size, letter="B"):
    ends = [(x, y), (x + size, y), (x + size, y + size), (x, y + size)]
    return [(*a, *b, letter) for a, b in zip(ends, ends[1:] + ends[:1], strict=True)]


def picture(*lines):
    return read_svg(
        svg(
            "".join(
                f'<line x1="{float(a)}" y1="{float(b)}" x2="{float(c)}" y2="{float(d)}" '
                f'stroke="{COLOURS[letter]}"/>'
                for a, b, c, d, letter in lines
            )
        )
    )


def opened(*lines, number=None):
    return from_drawing(picture(*lines), Reading(number=number))


def shape(sheet):
    """The numbers of interior vertices, folds and panels."""
    if isinstance(sheet, CreasePattern):
        sheet = panels(sheet)
    return len(sheet.interior), len(sheet.folds), len(sheet.faces)


STAR = [(0, 0, 2, 2, "M"), (4, 0, 2, 2, "V"), (4, 4, 2, 2, "M"), (0, 4, 2, 2, "M")]
"""Four creases from the corners of a square to its middle."""


def test_a_slit_to_a_vertex_takes_it_to_the_boundary():
    assert shape(opened(*square(0, 0, 4), *STAR).sheet) == (1, 4, 4)
    slit = opened(*square(0, 0, 4), *STAR, (2, 0, 2, 2, "C"))
    assert shape(slit.sheet) == (0, 4, 5)
    assert sorted(slit.letters.values()) == [*"MMMV"]
    assert slit.lines[-1] == (
        "cuts (1 line) are opened: creases end 0.004 before them; no angle and no way "
        "to fold changes, and contacts are those of the open sheet: at 5 (2, 0)"
    )


def test_the_two_sides_of_a_slit_fold_differently():
    """A crease that meets the slit from above and one from below are two creases."""
    lines = [*square(0, 0, 4), (0, 2, 2, 2, "C"), (2, 2, 4, 2, "M")]
    lines += [(1, 0, 1, 4, "M"), (2, 0, 2, 4, "V")]
    assert shape(opened(*lines[:4], *lines[5:]).sheet) == (1, 4, 4)
    sheet = opened(*lines).sheet
    assert shape(sheet) == (0, 5, 6)
    assert len(sheet.vertices) == 4 + 4 + 1 + 4 + 1  # the slit has two more ends and middles


def popup(off="0"):
    """A book with cuts across its middle, whose strips fold out; its first hinge is `off`."""
    left, middle, right = (k + Fraction("0.03125") for k in (1, 2, 3))
    places = [Fraction("0.53125") + k * Fraction("0.46875") for k in range(6)]
    lines = square(0, 0, 4)
    for low, high in pairwise(places):
        lines += [(x, low, x, high, "M" if x == middle else "V") for x in (left, middle, right)]
    lines += [(left, y, right, y, "C") for y in places]
    first = middle + Fraction(off)
    return [*lines, (first, 0, first, places[0], "V"), (middle, places[-1], middle, 4, "V")]


def test_edges_that_opening_made_nearly_straight_are_no_noise():
    """Creases end at the same distance from a slit, and corners of panels do not."""
    found = opened(*popup())
    assert {near.kind for near in left_relations(found.sheet)} == {"border"}
    assert found.left == ()
    assert count(found).status is PROVED


def test_a_book_whose_two_hinges_are_nearly_on_one_line_is_not_called_rigid():
    """No hole shows it: the lines round each are parallel all the same."""
    near = count(opened(*popup("0.0005")))
    assert near.status is UNDECIDED
    assert "two folds between the same panels are nearly on one line" in near.reason
    assert near.as_written.rigid is PROVED
    assert count(opened(*popup("0.25"))).rigid is PROVED


def test_a_cut_across_makes_two_sheets():
    lines = [*square(0, 0, 4), (0, 2, 4, 2, "C"), (2, 0, 2, 4, "M"), (1, 0, 1, 2, "V")]
    with pytest.raises(SeveralSheetsError, match="holds 2 sheets"):
        opened(*lines)
    assert {shape(opened(*lines, number=k).sheet) for k in (1, 2)} == {(0, 1, 2), (0, 2, 3)}


def test_pieces_without_creases_fall_out():
    half = opened(*square(0, 0, 4), (0, 2, 4, 2, "C"), (2, 0, 2, 2, "M"))
    assert shape(half.sheet) == (0, 1, 2)
    assert "1 piece without creases is left out (holes, frames, or paper" in half.lines[-1]
    with pytest.raises(MalformedPatternError, match="no piece of the drawing has a crease"):
        opened(*square(0, 0, 4), (0, 2, 4, 2, "C"))


def test_frames_and_holes_inside_a_panel_do_not_matter():
    sheet = [*square(0, 0, 4), *STAR]
    plain = opened(*sheet)
    more = [*square(-1, -1, 9), *square(1.5, 0.25, 0.5), *square(2, 0.25, 0.5, "C")]
    framed = opened(*sheet, *more)
    assert framed.sheet == plain.sheet
    assert "2 pieces without creases are left out" in framed.lines[-1]


def test_a_frame_of_lines_without_letters():
    unlettered = [(*line[:4], "U") for line in [*square(0, 0, 4), *STAR]]
    framed = opened(*square(-1, -1, 9, "U"), *unlettered)
    assert shape(framed.sheet) == (1, 4, 4)
    assert "1 piece without creases is left out" in framed.lines[-1]
    inside = [*square(-1, -1, 9, "U"), (-1, 6, 8, 6, "U"), *unlettered]
    with pytest.raises(DisconnectedError, match="lie inside a panel, and no line joins them"):
        opened(*inside)
    with pytest.raises(DisconnectedError, match="lie inside a panel, and no line joins them"):
        opened(*square(-1, -1, 9, "U"), *unlettered, *square(5, 5, 1, "U"))
    lettered = [(*line[:4], "M") for line in [*square(0, 0, 4), *STAR]]
    with pytest.raises(DisconnectedError, match="lie inside a panel, and no line joins them"):
        opened(*square(-1, -1, 9), *lettered)


def test_a_file_of_triangles_with_a_cut_is_a_drawing(tmp_path):
    triangles = {
        "vertices_coords": [[0, 0], [4, 0], [4, 4], [0, 4], [2, 2]],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]],
        "edges_assignment": [*"BBBBMVMV"],
        "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
    }
    path = tmp_path / "cut.fold"
    path.write_text(json.dumps(triangles))
    assert shape(open_pattern(path).sheet) == (1, 4, 4)
    path.write_text(json.dumps({**triangles, "edges_assignment": [*"BBBBMVMC"]}))
    found = open_pattern(path)
    assert shape(found.sheet) == (0, 3, 4)
    assert "cuts (1 line) are opened" in found.lines[-1]


# --- holes ---------------------------------------------------------------------------------------

SPOKES = [(0, 0, 1, 1, "M"), (4, 0, 3, 1, "V"), (4, 4, 3, 3, "M"), (0, 4, 1, 3, "V")]


@pytest.mark.parametrize("letter", ["B", "C"])
def test_a_hole_between_panels_is_read(letter):
    found = opened(*square(0, 0, 4), *square(1, 1, 2, letter), *SPOKES)
    assert shape(found.sheet) == (0, 4, 4)
    [hole] = found.sheet.holes
    corners = {tuple(map(int, found.sheet.vertices[v])) for v in hole}
    assert corners == {(1, -1), (3, -1), (3, -3), (1, -3)}
    assert "the sheet has 1 hole" in found.lines
    assert dict(decompose(found.sheet).true) == {1: 2}


def test_several_holes_are_read():
    lines = [*square(0, 0, 4), *square(1, 1, 2), *SPOKES]
    beside = [(a + 4, b, c + 4, d, letter) for a, b, c, d, letter in lines]
    two = opened(*lines[:1], *lines[2:], (4, 0, 4, 4, "M"), *beside[:3], *beside[4:])
    assert len(two.sheet.holes) == 2
    assert shape(two.sheet) == (0, 9, 8)


def test_a_slit_that_begins_inside_is_a_hole():
    """It gets a point on each side of its middle, and the creases at its ends go on as before."""
    lines = [*square(0, 0, 4), (1, 2, 3, 2, "C"), (1, 0, 1, 4, "M"), (3, 0, 3, 4, "M")]
    found = opened(*lines)
    assert shape(found.sheet) == (0, 4, 4)
    [hole] = found.sheet.holes
    assert len(hole) == 4
    places = {found.sheet.vertices[v] for v in hole}
    assert {(1, -2), (3, -2)} < places
    assert all(abs(y + 2) < 0.01 for _, y in places)
    flat = opened(*square(0, 0, 4), (1.5, 2, 2.5, 2, "C"), (1, 0, 1, 4, "M"))
    assert shape(flat.sheet) == (0, 1, 2)  # within one panel it changes nothing
    assert flat.sheet.holes == ()


def test_a_popup_of_two_slits_has_two_ways():
    """All folds are parallel: the middle crease alone, and the strip that pops up."""
    lines = [*square(0, 0, 6), (3, 0, 3, 2, "V"), (3, 4, 3, 6, "V"), (2, 2, 4, 2, "C")]
    lines += [(2, 4, 4, 4, "C"), (2, 2, 2, 4, "M"), (3, 2, 3, 4, "V"), (4, 2, 4, 4, "M")]
    result = decompose(opened(*lines).sheet)
    assert (dict(result.second_order), dict(result.true)) == ({1: 2}, {1: 2})


STRIP = [(3, 3, 7, 3, "C"), (3, 7, 7, 7, "C"), (3, 3, 3, 7, "M"), (7, 3, 7, 7, "M")]
"""A strip between two slits in the middle of a panel."""


@pytest.mark.parametrize(
    ("across", "folds"),
    [([(5, 3, 5, 7, "V")], 3), ([(4, 3, 4, 7, "V"), (6, 3, 6, 7, "V")], 4)],
    ids=["three", "four"],
)
def test_a_panel_all_round_creases_is_cut_open(across, folds):
    """The strip is clamped at both ends: to second order its parallel folds are locked."""
    found = opened(*square(0, 0, 10), *STRIP, *across, (1, 0, 1, 10, "V"))
    assert any(line.startswith("1 slit through panels that go all round") for line in found.lines)
    assert shape(found.sheet) == (0, folds + 1, folds + 1)
    assert len(found.sheet.holes) == 1
    assert dict(decompose(found.sheet).true) == {1: 1}


def test_creases_without_cuts_inside_a_panel_are_refused():
    box = [(*line[:4], "M") for line in square(3, 3, 2)]
    with pytest.raises(DisconnectedError, match="lie inside a panel, and no line joins them"):
        opened(*square(0, 0, 10), *box, (1, 0, 1, 10, "V"))


def test_a_hole_that_a_slit_joins_to_the_edge_is_none():
    slit = opened(*square(0, 0, 4), *square(1, 1, 2), *SPOKES, (0, 2, 1, 2, "C"))
    assert shape(slit.sheet) == (0, 4, 5)
    at_a_corner = opened(*square(0, 0, 4), *square(1, 1, 2), *SPOKES, (0, 2, 1, 1, "C"))
    assert shape(at_a_corner.sheet) == (0, 4, 5)


def test_paper_that_hangs_by_a_point_is_refused():
    hole = [(2, 0, 1, 2, "C"), (1, 2, 3, 2, "C"), (3, 2, 2, 0, "C")]
    with pytest.raises(NotADiskError, match=r"hangs together only by vertex .* near \(2, 0\)"):
        opened(*square(0, 0, 4), *hole, (1, 2, 0, 2, "M"), (3, 2, 4, 2, "M"))


def test_borders_between_panels_are_listed_with_what_to_do():
    lines = [*square(0, 0, 4), (2, 0, 2, 4, "B"), (0, 1, 4, 1, "M")]
    with pytest.raises(FoldError) as refusal:
        opened(*lines)
    assert str(refusal.value) == (
        "2 boundary lines are between two panels (from (2, 0) to (2, -1), from (2, -1) to (2, "
        "-4)): give them the letter U for a crease, C for a cut, or F for nothing (`--colours "
        "black=U`, or black=C; all lines of this colour get the letter)"
    )
    with pytest.raises(FoldError) as without_colours:
        from_drawing(replace(picture(*lines), coloured=False))
    assert str(without_colours.value).endswith(" C for a cut, or F for nothing")


def test_boundary_lines_round_a_panel_at_the_edge_are_no_hole():
    for corner in ((2, 0), (0, 1)):
        lines = [(*corner, 1, 2, "B"), (1, 2, 3, 2, "B"), (3, 2, *corner, "B")]
        with pytest.raises(FoldError, match="3 boundary lines are between two panels"):
            opened(*square(0, 0, 4), *lines, (1, 2, 0, 2, "M"), (3, 2, 4, 2, "M"))
    with pytest.raises(FoldError, match="1 boundary line is between two panels"):
        opened(*square(0, 0, 4), (1, 0, 1, 4, "B"), (2, 0, 2, 4, "M"))


# --- how slits are opened ------------------------------------------------------------------------


@pytest.mark.parametrize("crease", [(2, 2, 1, 4, "M"), (2, 2, 0.5, 4, "M"), None])
def test_corners_of_180_degrees_and_more_keep_clear_of_the_slit(crease):
    """The slit turns at (2, 2). Its outer side has 270 degrees: a crease leaves 243 for one panel,
    and a second crease 180 or 190 between both."""
    lines = [*square(0, 0, 4), (2, 0, 2, 2, "C"), (2, 2, 0.8, 2, "C"), (2, 2, 3, 0, "V")]
    lines += [(0.8, 2, 0, 1, "M"), (0.8, 2, 0, 4, "M"), *([crease] if crease else [])]
    assert shape(opened(*lines).sheet) == ((0, 4, 5) if crease else (0, 3, 4))


def test_a_side_of_a_slit_without_creases_keeps_clear_of_the_other():
    lines = [*square(0, 0, 4), (0, 2, 2, 2, "C"), (1, 2, 1, 4, "M"), (2, 2, 4, 2, "V")]
    sheet = opened(*lines).sheet
    assert shape(sheet) == (0, 2, 3)
    on_left = sorted(float(y) for x, y in sheet.vertices if x < 1.5 and abs(y + 2) < 0.1)
    assert [y < -2 for y in on_left] == [True, True, False, False]


@pytest.mark.parametrize("seed", range(6))
def test_random_slits_keep_every_crease_and_every_direction_round_a_vertex(seed):
    """A grid with diagonals, and slits along its lines that begin at the edge and grow as trees."""
    rng, n = random.Random(seed), 5
    spots = [(x, y) for x in range(n + 1) for y in range(n + 1)]

    def on_rim(spot):
        return not (0 < spot[0] < n and 0 < spot[1] < n)

    place = {
        spot: tuple(Fraction(33 * c + 7 * rng.randrange(2) * (not on_rim(spot)), 10) for c in spot)
        for spot in spots
    }
    edges = {((x, y), (x + 1, y)) for x in range(n) for y in range(n + 1)}
    edges |= {((x, y), (x, y + 1)) for x in range(n + 1) for y in range(n)}
    edges |= {((x, y), (x + 1, y + 1)) for x in range(n) for y in range(n)}

    rim = {
        (a, b)
        for a, b in edges
        if on_rim(a)
        and on_rim(b)
        and abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1
        and (a[0] == b[0] in (0, n) or a[1] == b[1] in (0, n))
    }
    reached, cuts = {spot for spot in spots if on_rim(spot)}, set()
    for a, b in rng.sample(sorted(edges - rim), len(edges - rim)):
        if (a in reached) != (b in reached) and len(cuts) < 8:
            cuts.add((a, b))
            reached |= {a, b}
    lines = [
        (*place[a], *place[b], "B" if (a, b) in rim else "C" if (a, b) in cuts else "M")
        for a, b in sorted(edges)
    ]
    sheet = opened(*lines).sheet
    on_slits = {spot for edge in cuts for spot in edge}
    inner = [spot for spot in spots if not on_rim(spot) and spot not in on_slits]
    assert shape(sheet) == (len(inner), len(edges) - len(rim) - len(cuts), 2 * n * n)
    found = {sheet.vertices[v]: star for v, star in _stars(sheet).items()}
    assert set(found) == {(place[s][0], -place[s][1]) for s in inner}
    for spot in inner:
        x, y = place[spot]
        near = {b if a == spot else a for a, b in edges if spot in (a, b)}
        meant = {_direction(place[t][0] - x, y - place[t][1]) for t in near}
        assert found[x, -y] == meant


def _stars(sheet):
    stars = {v: set() for v in sheet.interior}
    for i, j in sheet.folds:
        for a, b in ((i, j), (j, i)):
            if a in stars:
                (ax, ay), (bx, by) = sheet.vertices[a], sheet.vertices[b]
                stars[a].add(_direction(bx - ax, by - ay))
    return stars


def _direction(x, y):
    size = max(abs(x), abs(y))
    return Fraction(x) / size, Fraction(y) / size


def test_slits_that_are_too_close_to_other_lines_are_refused():
    tiny = Fraction(1, 10**9)
    points = ((0, 0), (2, 0), (4, 0), (4, 2), (0, 2), (4, -2), (0, -2), (1, tiny), (2, 2))
    lines = [(1, 2, "M"), (0, 1, "C"), (1, 7, "V"), (7, 8, "V")]
    lines += [(a, b, "B") for a, b in ((0, 6), (6, 5), (5, 2), (2, 3), (3, 8), (8, 4), (4, 0))]
    faces = [(0, 6, 5, 2, 1), (1, 2, 3, 8, 7), (0, 1, 7, 8, 4)]
    drawing = Drawing(points, tuple(Line(*line) for line in lines), "a test")
    with pytest.raises(FoldError, match=r"the slits near \(0, 0\) are too close to other lines"):
        pieces(drawing, faces, drawing.lines)


def test_an_open_slit_has_the_ways_of_a_wedge():
    """The same creases, once with a slit and once with a wedge that was cut out by hand."""
    creases = [(4, 2, 6, 2, "M"), (4, 0, 4, 4, "V"), (0, 1, 6, 1, "M"), (0, 0, 4, 2, "M")]
    rim = [(0, 0, 6, 0, "B"), (6, 0, 6, 4, "B"), (6, 4, 0, 4, "B")]
    slit = [*rim, (0, 4, 0, 0, "B"), (0, 2, 4, 2, "C"), (2, 0, 2, 4, "M"), *creases]
    wedge = [*rim, (0, 0, 0, 1.5, "B"), (0, 1.5, 2, 1.5, "B"), (2, 1.5, 4, 2, "B")]
    wedge += [(4, 2, 2, 2.5, "B"), (2, 2.5, 0, 2.5, "B"), (0, 2.5, 0, 4, "B"), *creases]
    wedge += [(2, 0, 2, 1.5, "M"), (2, 2.5, 2, 4, "M")]
    ways = [decompose(opened(*lines).sheet) for lines in (slit, wedge)]
    assert ways[0].second_order == ways[1].second_order == {6: 2}
