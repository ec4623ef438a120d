"""Drawings whose lines miss each other: merged where it is clear what was meant, and it is said."""

from fractions import Fraction

import pytest

from exactfold.errors import DisconnectedError, FoldError
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.inexactness import clear_distances
from exactfold.pattern.drawing.repair import exact_sheets
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.triangulating.panels import triangulating_edges

CORNERS = ((0, 0), (10, 0), (10, 10), (0, 10))
RIM = ((0, 1, "B"), (1, 2, "B"), (2, 3, "B"), (3, 0, "B"))


def drawing(points, lines):
    return Drawing(
        tuple((Fraction(str(x)), Fraction(str(y))) for x, y in (*CORNERS, *points)),
        tuple(Line(*line) for line in (*RIM, *lines)),
        "a test",
    )


def panels(made):
    (sheet,) = made.sheets
    return PanelPattern(sheet.points, [line[:2] for line in sheet.lines])


def sentences(made):
    return " ".join(repair.sentence for repair in made.repairs)


def missing_the_border_by(*gaps):
    """Vertical creases that end below the upper boundary."""
    points, lines = [], []
    for k, gap in enumerate(gaps):
        x = 1 + Fraction(8 * k, len(gaps)).limit_denominator(10**6)
        points += [(x, 0), (x, 10 - Fraction(gap))]
        lines.append((4 + 2 * k, 5 + 2 * k, "M"))
    return drawing(points, lines)


def test_creases_that_miss_the_border_by_far_less_than_all_else_end_on_it():
    drawn = missing_the_border_by("0.001", "0.002", "0.004")
    made = exact_sheets(drawn)
    assert len(panels(made).faces) == 4
    assert "dangling" not in {repair.step for repair in made.repairs}
    assert "miss each other by up to 4.0e-04 of the size are taken to meet" in sentences(made)


def test_a_distance_that_is_given_goes_before_what_seems_clear():
    made = exact_sheets(missing_the_border_by("0.001001", "0.002"), merge=Fraction(1, 10**6))
    assert len(panels(made).faces) == 1
    assert "2 lines dropped" in sentences(made)
    assert "inexact" not in sentences(made)


def test_a_drawing_without_misses_is_merged_as_finely_as_before():
    made = exact_sheets(missing_the_border_by("0", "1"))
    assert len(panels(made).faces) == 2  # the second crease is loose by a tenth of the sheet
    assert "inexact" not in sentences(made)


def test_the_next_clear_distance_is_tried_where_the_first_leaves_loose_ends():
    drawn = missing_the_border_by("0.00005", "0.02")
    found = clear_distances(drawn, 2e-5, 10 / 300)
    assert found == pytest.approx([5e-5, 0.02])
    assert len(panels(exact_sheets(drawn)).faces) == 3


def test_a_border_drawn_twice_is_no_hole():
    points = [("0.002", "0.001"), ("9.999", "-0.002"), ("10.001", "10"), ("0", "9.998")]
    again = [(4, 5, "B"), (5, 6, "B"), (6, 7, "B"), (7, 4, "B"), (0, 2, "M")]
    made = exact_sheets(drawing(points, again))
    assert len(panels(made).faces) == 2
    assert "4 points are merged" in sentences(made)


def test_misses_of_all_sizes_are_refused_with_the_distance_that_would_do():
    """Misses grow by less than four times up to 1 % of the size: nothing is clear by itself."""
    gaps = ("0.00003", "0.0001", "0.0003", "0.001", "0.003", "0.01", "0.03", "0.06")
    points = [(Fraction(k, 2) + 1, 10 + Fraction(gap)) for k, gap in enumerate(gaps)]
    again = [("0", "10.09"), ("10", "10.05"), *points]
    lines = [(3, 4, "B"), (4, 5, "B"), (5, 2, "B"), *((4 + k, 2, "M") for k in range(2, 10))]
    drawn = drawing(again, lines)
    with pytest.raises(FoldError, match=r"--merge 0\.\d+` would read it") as refused:
        exact_sheets(drawn)
    advised = str(refused.value).split("--merge ")[1].split("`")[0]
    assert panels(exact_sheets(drawn, merge=Fraction(advised))).faces


def test_crossings_with_long_denominators_are_settled_by_floats():
    """Lines across a square, each crossing with a denominator of its own."""
    points, lines = [], []
    for k in range(24):
        x, y = Fraction(3 + 37 * k * k % 97, 10), Fraction(5 + 41 * k * k % 89, 10)
        points += [(0, y), (10, Fraction(1000 + k, 1009) * x)]
        lines.append((4 + 2 * k, 5 + 2 * k, "M"))
    pattern = panels(exact_sheets(drawing(points, lines), snap="exact"))
    assert pattern.scaled_vertices == pattern.vertices  # a common denominator is too long
    assert len(pattern.vertices) - len(pattern.edges) + len(pattern.faces) == 1
    assert len(triangulating_edges(pattern)) > 0


def test_where_most_lines_were_dropped_a_refusal_says_so():
    loose = [(f"{k}.5", f"{y}.5") for k in range(9) for y in (2, 8)]
    inner = [("4.1", "4.1"), ("4.2", "4.1"), ("4.1", "4.2")]
    lines = [(4 + k, 5 + k, "M") for k in range(0, 18, 2)]
    lines += [(22, 23, "M"), (23, 24, "M"), (24, 22, "M")]
    with pytest.raises(DisconnectedError, match=r"; 9 lines dropped .*; draw each line from"):
        exact_sheets(drawing([*loose, *inner], lines))
