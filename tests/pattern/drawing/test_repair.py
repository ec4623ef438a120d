"""Repair: each step does its work, says it, and does nothing when it is left out."""

import random
from fractions import Fraction

import pytest

from exactfold.errors import (
    DisconnectedError,
    MalformedPatternError,
    UsageError,
)
from exactfold.exact.surds import RATIONALS, Surd
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.repair import STEPS, exact_sheets, repaired
from exactfold.pattern.drawing.sheets import sheets
from exactfold.pattern.panel_pattern import PanelPattern

CORNERS = ((0, 0), (4, 0), (4, 4), (0, 4))
RIM = ((0, 1, "B"), (1, 2, "B"), (2, 3, "B"), (3, 0, "B"))
TINY = Fraction(1, 10**7)


def exact(number):
    return number if isinstance(number, Surd) else Fraction(number)


def drawing(points, lines):
    return Drawing(
        tuple((exact(x), exact(y)) for x, y in points),
        tuple(Line(*line) for line in lines),
        "a test",
    )


def after(points, lines, *steps, **options):
    return repaired(drawing(points, lines), steps=steps or STEPS, **options)


def pattern(sheet):
    return PanelPattern(sheet.points, [line[:2] for line in sheet.lines])


def letters(drawn):
    return {tuple(sorted(line[:2])): line.letter for line in drawn.lines}


def area(sheet):
    made = pattern(sheet)
    total = 0
    for face in made.faces:
        corners = [made.vertices[v] for v in face]
        for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1], strict=True):
            total += ax * by - ay * bx
    return total / 2


# --- the steps -----------------------------------------------------------------------------------


def test_points_that_nearly_coincide_become_the_one_with_most_lines():
    points = [*CORNERS, (4 + TINY, TINY), (0, 1)]
    found, repairs = after(points, [*RIM, (4, 5, "M")], "merge")
    assert found.lines[4] == Line(1, 5, "M")
    (repair,) = repairs
    assert (repair.step, repair.count) == ("merge", 1)
    assert repair.places[0][0] == 4
    assert "at most 1.4e-07 away (tolerance 4e-06)" in repair.sentence


def test_points_further_apart_than_the_distance_stay():
    points = [*CORNERS, (Fraction("4.01"), 0), (0, 1)]
    lines = [*RIM, (4, 5, "M")]
    assert after(points, lines, "merge") == (drawing(points, lines), ())
    found, _ = after(points, lines, "merge", merge=Fraction(1, 100))
    assert found.lines[4] == Line(1, 5, "M")


@pytest.mark.parametrize(
    ("first", "second", "winner"),
    ["BMB", "VBB", "CMC", "BCB", "FVV", "UMM", "FUU", "JFF", "MVU", "MMM"],
)
def test_of_two_letters_one_wins(first, second, winner):
    found, repairs = after(CORNERS, [*RIM, (0, 2, first), (2, 0, second)], "duplicates")
    assert letters(found)[0, 2] == winner
    assert len(found.lines) == 5
    assert ("mountain and as valley" in " ".join(map(str, repairs))) == (winner == "U" != second)


def test_lines_without_length_are_dropped():
    found, (repair,) = after(CORNERS, [*RIM, (2, 2, "M")], "duplicates")
    assert len(found.lines) == 4
    assert repair.sentence == "1 line without length dropped"


def test_crossings_become_vertices_at_the_exact_place():
    points = [*CORNERS, (0, 1), (4, 2), (1, 0), (2, 4)]
    found, repairs = after(points, [*RIM, (4, 5, "M"), (6, 7, "V")], "split")
    x = Fraction(20, 15)
    assert found.points[8] == (x, 1 + x / 4)
    assert [repair.count for repair in repairs] == [4, 1]
    assert len(found.lines) == 4 + 4 + 4
    assert sorted(letters(found)[pair] for pair in [(4, 8), (5, 8), (6, 8), (7, 8)]) == list("MMVV")


def test_crossings_in_a_field_are_exact_and_three_creases_meet_in_one_vertex():
    """Creases of slopes 0, sqrt 2 - 1 and infinity through a point that is drawn nowhere."""
    root = RATIONALS.adjoined(2).root
    middle = (2 * root, 1)
    left = 1 - middle[0] * (root - 1) / 2
    right = left + 2 * (root - 1)
    points = [*CORNERS, (0, 1), (4, 1), (2 * root, 0), (2 * root, 4), (0, left), (4, right)]
    lines = [*RIM, (4, 5, "M"), (6, 7, "M"), (8, 9, "V")]
    found, _ = after(points, lines)
    assert len(found.points) == 11
    assert found.points[10] == middle
    assert len(pattern(sheets(found)[0][0]).faces) == 6


def test_a_vertex_near_a_line_moves_exactly_onto_it():
    points = [*CORNERS, (1, TINY), (3, 4 - TINY)]
    found, repairs = after(points, [*RIM, (4, 5, "M")], "split")
    slope = (4 - 2 * TINY) / 2
    assert found.points[4] == (1 - TINY / slope, 0)
    assert found.points[5] == (3 + TINY / slope, 4)
    assert [(repair.count, repair.sentence) for repair in repairs][1] == (
        2,
        "2 vertices moved exactly onto a line, by at most 1.1e-07",
    )


def test_a_vertex_on_two_lines_is_their_crossing():
    points = [*CORNERS, (2 + TINY, 2), (1, 4)]
    lines = [*RIM, (0, 2, "M"), (1, 3, "V"), (4, 5, "M")]
    found, _ = after(points, lines, "split")
    assert found.points[4] == (2, 2)
    assert len(found.points) == 6


def test_chains_of_vertices_that_lie_on_each_other_s_lines_are_all_exact():
    """Vertex 6 lies on the crease 4-5, whose end 5 lies on the boundary."""
    points = [*CORNERS, (0, 1), (4 - TINY, 2), (2, Fraction(3, 2) + TINY), (2, 4)]
    found, _ = after(points, [*RIM, (4, 5, "M"), (6, 7, "V")], "split")
    (x4, y4), (x5, y5), (x6, y6) = found.points[4:7]
    assert x5 == 4
    assert (x5 - x4) * (y6 - y4) == (y5 - y4) * (x6 - x4)


def test_three_lines_that_nearly_meet_bend_and_it_is_said():
    points = [*CORNERS, (2, 0), (2 + 2 * TINY, 4)]
    found, repairs = after(points, [*RIM, (0, 2, "M"), (1, 3, "V"), (4, 5, "M")], "split")
    assert len(found.points) == 7
    assert found.points[6] == (2, 2)
    assert any("bends by less than 4e-06" in repair.sentence for repair in repairs)


def test_overlapping_lines_are_cut_into_common_pieces():
    points = [*CORNERS, (1, 1), (2, 2), (3, 3)]
    found, _ = after(points, [*RIM, (0, 5, "M"), (4, 6, "M"), (5, 2, "M")], "split", "duplicates")
    inside = {(0, 4), (4, 5), (5, 6), (2, 6)}
    assert {pair for pair in letters(found) if letters(found)[pair] == "M"} == inside


def test_flat_lines_join_panels_and_can_be_kept():
    lines = [*RIM, (0, 2, "F"), (1, 3, "J")]
    found, repairs = after(CORNERS, lines)
    assert len(pattern(sheets(found)[0][0]).faces) == 1
    assert "4 flat lines (F or J) dropped" in " ".join(map(str, repairs))
    kept, _ = repaired(drawing(CORNERS, lines), steps=[step for step in STEPS if step != "join"])
    assert len(pattern(sheets(kept)[0][0]).faces) == 4


def test_lines_with_one_panel_on_both_sides_are_dropped():
    points = [*CORNERS, (1, 1), (2, 1), (3, 2)]
    lines = [*RIM, (0, 4, "M"), (4, 5, "V"), (5, 6, "M"), (0, 2, "M")]
    found, (repair,) = after(points, lines, "dangling")
    assert set(letters(found)) == {(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)}
    assert repair.count == 3
    assert repair.places[0][0] == 6
    assert "1 loose end" in repair.sentence


def test_straight_vertices_dissolve_where_no_other_line_meets_them():
    points = [*CORNERS, (1, 1), (2, 2), (2, 0)]
    lines = [(0, 6, "B"), (6, 1, "B"), *RIM[1:], (0, 4, "M"), (4, 5, "M"), (5, 2, "V")]
    found, (repair,) = after(points, lines, "dissolve")
    assert letters(found) == {
        **{(0, 1): "B", (1, 2): "B", (2, 3): "B", (0, 3): "B"},
        **{(0, 5): "M", (2, 5): "V"},
    }
    assert [place.point for place in repair.places] == [4, 6]


def test_corners_of_a_curve_do_not_dissolve():
    """Each corner is off the chord of its neighbours by a little less than the distance."""
    step = Fraction(1, 100)
    chain = [(k * step, (k * step) ** 2 / 100) for k in range(101)]
    lines = [(k, k + 1, "M") for k in range(100)]
    found, _ = after(chain, lines, "dissolve", merge=Fraction(1, 10**5))
    kept = sorted({v for line in found.lines for v in line[:2]})
    assert 5 < len(kept) < 40
    for a, b, _letter in found.lines:
        for k in range(min(a, b) + 1, max(a, b)):
            chord = chain[a][1] + (chain[b][1] - chain[a][1]) * Fraction(k - a, b - a)
            assert abs(chord - chain[k][1]) <= Fraction(11, 10**6)


def test_without_border_letters_the_outer_cycle_is_the_border():
    lines = [(a, b, "U") for a, b, _ in RIM] + [(0, 2, "U")]
    found, (repair,) = after(CORNERS, lines)
    assert letters(found) == {(0, 1): "B", (1, 2): "B", (2, 3): "B", (0, 3): "B", (0, 2): "U"}
    assert repair.sentence == "4 lines round the sheet are taken for the boundary"


@pytest.mark.parametrize("left_out", STEPS)
def test_a_step_that_is_left_out_does_nothing(left_out):
    points = [*CORNERS, (4 + TINY, TINY), (0, 1), (2, 0), (2, 3), (1, 0), (1, 4), (3, 0), (3, 4)]
    lines = [(a, b, "U") for a, b, _ in RIM]
    lines += [(4, 5, "M"), (5, 4, "M"), (6, 7, "M"), (8, 9, "F"), (10, 11, "V")]
    full = {repair.step for repair in after(points, lines)[1]}
    assert full == set(STEPS)
    rest = [step for step in STEPS if step != left_out]
    assert left_out not in {
        repair.step for repair in repaired(drawing(points, lines), steps=rest)[1]
    }


def test_unknown_steps_and_distances_are_refused():
    square = drawing(CORNERS, RIM)
    with pytest.raises(UsageError, match="no step 'polish'"):
        repaired(square, steps=["polish"])
    with pytest.raises(UsageError, match="must be positive"):
        repaired(square, merge=Fraction(0))


def test_a_drawing_in_order_is_left_alone():
    square = drawing(CORNERS, [*RIM, (0, 2, "M")])
    assert repaired(square) == (square, ())


# --- sheets --------------------------------------------------------------------------------------


def shifted(points, by):
    return [(x + by, y) for x, y in points]


def test_two_sheets_come_one_by_one():
    points = [*CORNERS, *shifted(CORNERS, 5), (9, 9)]
    lines = [*RIM, (0, 2, "M"), *((a + 4, b + 4, letter) for a, b, letter in RIM)]
    found, reports = sheets(drawing(points, lines))
    assert not reports
    assert [len(sheet.points) for sheet in found] == [4, 4]
    assert [len(sheet.lines) for sheet in found] == [5, 4]
    assert [area(sheet) for sheet in found] == [16, 16]


INNER = ((1, 1), (3, 1), (3, 3), (1, 3))


def ring(letter, *more):
    return [*RIM, *((a + 4, b + 4, letter) for a, b, _ in RIM), *more]


def test_an_island_of_creases_is_named():
    with pytest.raises(DisconnectedError, match="no line joins them to the rest"):
        sheets(drawing([*CORNERS, *INNER], ring("M")))


def test_lines_that_enclose_nothing_are_refused():
    with pytest.raises(MalformedPatternError, match="enclose no face"):
        sheets(drawing(CORNERS, RIM[:3]))
    with pytest.raises(MalformedPatternError, match="no lines"):
        exact_sheets(drawing(CORNERS, []))


# --- the whole way -------------------------------------------------------------------------------


def rounded(points, digits, scale):
    return [tuple(Fraction(f"{float(c) * scale:.{digits}f}") for c in point) for point in points]


def test_a_bird_base_of_whole_creases_is_exact():
    """22.5-degree creases of a square, drawn as segments of a .cp file that cross each other."""
    root = RATIONALS.adjoined(2).root
    t = root - 1
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    segments = [((0, 0), (1, 1)), ((1, 0), (0, 1))]
    segments += [((0, 0), (1, t)), ((0, 0), (t, 1)), ((1, 1), (0, 1 - t)), ((1, 1), (1 - t, 0))]
    points, lines = list(square), list(RIM)
    for start, end in segments:
        points += rounded([start, end], 12, 1)
        lines.append((len(points) - 2, len(points) - 1, "M"))
    made = exact_sheets(drawing(points, lines))
    (sheet,) = made.sheets
    found = pattern(sheet)
    assert made.coordinates.radicand == 2
    assert made.coordinates.kept == ()
    assert area(sheet) == 1
    assert set(found.boundary_edges) == {
        tuple(sorted(line[:2])) for line in sheet.lines if line.letter == "B"
    }
    # The creases from opposite corners meet on the diagonal x + y = 1, in x = 1/(1 + t).
    x = 1 / (1 + t)
    assert {(x, 1 - x), (1 - x, x), (Fraction(1, 2), Fraction(1, 2))} == {
        found.vertices[v] for v in found.interior
    }
    assert sorted(len(found.stars[v]) for v in found.interior) == [4, 6, 6]


@pytest.mark.parametrize("seed", range(8))
def test_random_grid_creases_in_pixels_make_a_pattern_without_loss(seed):
    """Whole creases between boundary points on sevenths, 5 decimals, 900 pixels wide."""
    random_ = random.Random(seed)
    points, lines = [(0, 0), (7, 0), (7, 7), (0, 7)], list(RIM)
    for _ in range(9):
        a, b = random_.randint(1, 6), random_.randint(1, 6)
        ends = [((a, 0), (b, 7)), ((0, a), (7, b)), ((a, 0), (0, b))][random_.randrange(3)]
        points += ends
        lines.append((len(points) - 2, len(points) - 1, random_.choice("MV")))
    drawn = drawing(rounded(points, 5, Fraction(900, 7)), lines)
    made = exact_sheets(drawn)
    (sheet,) = made.sheets
    found = pattern(sheet)
    unit = made.coordinates.unit
    assert area(sheet) * unit**2 == 900**2
    # The same lines on the exact grid, split by the same steps, are the same pattern.
    exact, _ = repaired(drawing(points, lines))
    twin = pattern(sheets(exact)[0][0])
    assert {(x * unit * 7 / 900, y * unit * 7 / 900) for x, y in found.vertices} == set(
        twin.vertices
    )
    assert len(found.faces) == len(twin.faces)
    assert len(found.folds) == len(twin.folds)


@pytest.mark.slow
def test_three_thousand_lines_are_one_exact_grid():
    """A grid of 40 x 40 rectangles of sides sqrt 2 to 1, with 16 decimals."""
    count = 40
    places = [[Fraction(f"{k * step:.16f}") for k in range(count + 1)] for step in (2**0.5, 1)]
    points = [(x / 64, y / 64) for x in places[0] for y in places[1]]
    lines = []
    for i in range(count + 1):
        for j in range(count + 1):
            here = i * (count + 1) + j
            if j < count:
                lines.append((here, here + 1, "U"))
            if i < count:
                lines.append((here, here + count + 1, "U"))
    assert len(lines) > 3000
    made = exact_sheets(drawing(points, lines))
    assert made.coordinates.radicand == 2
    assert made.coordinates.kept == ()
    assert len(made.sheets[0].points) == (count + 1) ** 2
