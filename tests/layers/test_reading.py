"""No answer about the digits of a drawing is called one about the sheet."""

from __future__ import annotations

import json
import re
from itertools import accumulate
from math import cos, radians, sin

import pytest
from running import UNDECIDED as EXIT_UNDECIDED
from running import run
from sampling import slow_after

import exactfold
from exactfold import PROVED, REFUTED, UNDECIDED, flat, read
from exactfold.layers.states import Near


def letter_fold(more, *, cut=False):
    """Panels 100, 100 and 100 + more with two valleys; `cut` into triangles, read as they stand."""
    xs = [0, 100, 200, 300 + more]
    edges = [[k, k + 1] for k in (0, 1, 2, 4, 5, 6)] + [[k, k + 4] for k in range(4)]
    letters = [*"BBBBBB", "B", "V", "V", "B"]
    document = {
        "vertices_coords": [[x, y] for y in (0, 50) for x in xs],
        "edges_vertices": edges,
        "edges_assignment": letters,
    }
    if cut:
        document["edges_vertices"] = edges + [[k, k + 5] for k in range(3)]
        document["edges_assignment"] = [*letters, "F", "F", "F"]
        document["faces_vertices"] = [
            face for k in range(3) for face in ([k, k + 1, k + 5], [k, k + 5, k + 4])
        ]
    return document


LONGER = [0.1, 1e-3, 1e-5, 1e-7, 1e-8, 1e-9]


@pytest.mark.parametrize("more", LONGER)
def test_a_longer_last_panel_leaves_one_state_for_the_digits_as_written(more):
    found = flat(read(letter_fold(more), snap="exact"))
    assert (found.status, found.count) == (PROVED, 1)
    shorter = flat(read(letter_fold(-more), snap="exact"))
    assert (shorter.status, shorter.count) == (PROVED, 2)


@pytest.mark.parametrize("snap", [None, "auto", "exact", 1, 1000])
def test_equal_panels_have_two_states_however_they_are_read(snap):
    found = flat(read(letter_fold(0), snap=snap))
    assert (found.status, found.count) == (PROVED, 2)


@pytest.mark.parametrize("more", LONGER)
def test_where_reading_moves_coordinates_to_another_answer_nothing_is_proved(more):
    found = flat(read(letter_fold(more)))
    assert (found.status, found.as_written) == (UNDECIDED, PROVED)
    assert "the digits as written have 1 state" in found.reason
    assert "--snap exact" in found.reason
    assert found.to_dict()["states"] is None
    assert found.to_dict()["as_written"]["states"] == found.count == 2


@pytest.mark.parametrize("more", LONGER)
def test_a_grid_that_was_asked_for_is_no_doubt(more):
    found = flat(read(letter_fold(more), snap=1))
    assert (found.status, found.count) == (PROVED, 2)


@pytest.mark.parametrize("more", [1e-12, 1e-13])
def test_rounding_errors_of_floats_are_no_doubt(more):
    found = flat(read(letter_fold(more)))
    assert (found.status, found.count) == (PROVED, 2)


@pytest.mark.parametrize("more", LONGER[1:])
def test_corners_that_nearly_meet_a_crease_leave_the_answer_open(more):
    found = flat(read(letter_fold(more, cut=True)))
    assert (found.status, found.as_written, found.count) == (UNDECIDED, PROVED, 1)
    assert found.near.states == 2
    assert "if all that nearly meets is taken to meet, there are 2 states" in found.reason
    assert found.near.distance == pytest.approx(more / 300, rel=0.01)
    exactly = flat(read(letter_fold(more, cut=True), snap="exact"))
    assert (exactly.status, exactly.near) == (PROVED, None)


@pytest.mark.parametrize("more", [-1e-5, 1e-5])
def test_a_near_miss_on_which_nothing_depends_is_no_doubt(more):
    """A zigzag of panels has one state, however long the last panel is."""
    sheet = letter_fold(more, cut=True)
    sheet["edges_assignment"][7:9] = "VM"
    found = flat(read(sheet))
    assert found.near is not None
    assert (found.status, found.count) == (PROVED, 1)


def panels_in_a_row(widths, height, letters, *, turned=0.0, digits):
    """Panels side by side, turned by an angle, with coordinates of so many decimals."""
    xs = [0.0, *accumulate(widths)]
    corners = [(x, 0.0) for x in xs] + [(x, height) for x in xs[::-1]]
    c, s = cos(turned), sin(turned)
    last = len(corners) - 1
    folds = [(k, last - k) for k in range(1, len(widths))]
    return {
        "vertices_coords": [
            [round(c * x - s * y, digits), round(s * x + c * y, digits)] for x, y in corners
        ],
        "edges_vertices": [(k, (k + 1) % (last + 1)) for k in range(last + 1)] + folds,
        "edges_assignment": ["B"] * (last + 1) + list(letters),
    }


@pytest.mark.parametrize(("side", "digits"), [(100, 1), (1, 3), (1000, 0)])
def test_three_equal_panels_in_rounded_digits_are_not_refuted(side, digits):
    sheet = panels_in_a_row([side] * 3, side, "VV", turned=0.3, digits=digits)
    found = flat(read(sheet))
    assert found.meant.inferred
    assert (found.status, found.as_written) == (UNDECIDED, REFUTED)
    assert found.near.states == 2


@pytest.mark.parametrize("turned", slow_after(2, [0.28 + 0.17 * k for k in range(6)]))
@pytest.mark.parametrize("digits", [1, 2, 3, 4])
def test_nothing_false_is_proved_about_turned_panels(turned, digits):
    sheet = panels_in_a_row([100] * 3, 100, "VV", turned=turned, digits=digits)
    found = flat(read(sheet))
    assert found.status is UNDECIDED or (found.status, found.count) == (PROVED, 2)


def test_an_inferred_sheet_with_another_answer_than_its_digits_is_in_doubt():
    sheet = panels_in_a_row([100] * 3, 100, "VV", turned=0.3, digits=7)
    found = flat(read(sheet))
    assert found.meant.inferred
    assert (found.status, found.count) == (UNDECIDED, 2)
    assert "the digits as written have 0 states" in found.reason
    assert flat(read(sheet, snap="exact")).status is REFUTED


def test_seven_stamps_in_few_digits_are_open():
    found = flat(read(panels_in_a_row([1 / 7] * 7, 1, "UUUUUU", digits=3)))
    assert (found.status, found.as_written, found.count) == (UNDECIDED, PROVED, 88)
    assert found.near.states == 462


@pytest.mark.parametrize("widths", [(100, 100, 101), (8, 8, 9), (0.5, 0.5, 0.75)])
def test_coordinates_on_a_small_grid_are_no_rounded_ones(widths):
    found = flat(read(panels_in_a_row(widths, widths[0], "VV", digits=3)))
    assert (found.status, found.count) == (PROVED, 1)


def test_a_near_miss_below_all_floats_is_no_miss_by_0():
    misses = Near(0.0, 3, (1, 6)), Near(2e-9, 3, (1, 6))
    by = [one.text.split(" by ")[1] for one in misses]
    assert by == ["less than 1e-300 of the size", "2e-09 of the size"]


def test_a_near_miss_that_floats_cancel_is_measured_exactly():
    sheet = letter_fold(0, cut=True)
    sheet["vertices_coords"][3][0] = "300" + "." + "0" * 29 + "3"
    found = flat(read(_numbers_as_they_are(sheet)))
    assert found.near.distance == pytest.approx(1e-32, rel=0.01)


def test_a_clear_difference_is_no_near_miss():
    found = flat(read(letter_fold(1, cut=True)))
    assert (found.status, found.near, found.count) == (PROVED, None, 1)


def _numbers_as_they_are(document):
    """The FOLD text, where coordinates that are given as text are numbers of so many digits."""
    text = json.dumps(document)
    return re.sub(r'"(\d+\.\d+)"', r"\1", text)


def diagonals():
    """Two diagonals and a ring round their crossing, whose corners are off by 2e-6 to 6e-4."""
    corners = [[0, 0], [4, 0], [4, 4], [0, 4], [2.00001, 1.99997], [1.0003, 0.99992]]
    corners += [[3.000007, 0.999998], [2.99988, 3.00005], [1.002, 2.9991]]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (4, 6), (4, 7), (4, 8)]
    edges += [(5, 6), (6, 7), (7, 8), (5, 8), (0, 5), (1, 6), (2, 7), (3, 8)]
    edges += [(0, 6), (1, 7), (2, 8), (3, 5)]
    return {
        "vertices_coords": corners,
        "edges_vertices": edges,
        "edges_assignment": ["B"] * 4 + ["U"] * 16,
    }


def test_a_doubted_drawing_is_undecided_and_says_what_its_digits_are():
    found = flat(read(diagonals()))
    assert (found.status, found.as_written) == (UNDECIDED, REFUTED)
    assert found.locally_flat is UNDECIDED
    assert "relations nearly hold" in found.reason
    assert "the coordinates as they were read: refuted" in found.reason
    assert flat(read(diagonals(), snap="exact")).status is REFUTED


def test_the_command_says_that_it_is_undecided(tmp_path):
    path = tmp_path / "letter.fold"
    path.write_text(json.dumps(letter_fold(1e-5)))
    done = run("flat", path)
    assert done.exit_code == EXIT_UNDECIDED
    assert done.stdout.startswith("whether the sheet folds flat with the drawn")
    assert "The coordinates as they were read: 2 flat-folded states" in done.stdout
    data = json.loads(run("flat", path, "--json").stdout)
    assert (data["status"], data["states"], data["components"]) == ("undecided", None, [])
    assert run("flat", path, "--snap", "exact").exit_code == 0
    assert run("flat", path, "--snap", "10").exit_code == 0


def test_the_sheet_that_was_meant_is_named():
    sides = {"vertices_coords": [[0, 0], [1, 1e-9], [1, 1], [0, 1], [0.5, 0.5]]}
    edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [1, 4], [2, 4], [3, 4]]
    sheet = {**sides, "edges_vertices": edges, "edges_assignment": [*"BBBB", *"VVVM"]}
    found = exactfold.flat(sheet)
    assert found.status is PROVED
    assert found.locally_flat is PROVED


@pytest.mark.parametrize(
    ("digits", "status"),
    [(2, UNDECIDED), (3, UNDECIDED), (5, PROVED), (7, PROVED), (9, PROVED)],
)
def test_a_vertex_that_hardly_fails_is_not_refuted(digits, status):
    """Its sectors 50.3, 60.1, 59.2, 65.4, 70.5, 54.5 fold flat; those of rounded points do not.

    With enough digits the sheet that was meant is found, and the answer is about that sheet.
    """
    document = star([50.3, 60.1, 59.2, 65.4, 70.5, 54.5], digits)
    found = flat(read(document))
    assert found.status is status
    assert ("Kawasaki" in found.doubt) is (status is UNDECIDED)
    assert (found.meant is not None and found.meant.inferred) is (status is PROVED)
    assert flat(read(document, snap="exact")).status is REFUTED


def test_a_vertex_that_fails_by_more_than_its_digits_is_refuted():
    found = flat(read(star([50.3, 60.1, 59.2, 65.4, 71.5, 53.5], 3)))
    assert found.status is REFUTED


def star(sectors, digits):
    """A vertex with sectors in degrees, the ends of its folds at distance 1, rounded."""
    turns = [radians(7 + turn) for turn in accumulate(sectors[:-1], initial=0)]
    points = [[0, 0]] + [[round(cos(t), digits), round(sin(t), digits)] for t in turns]
    n = len(sectors)
    return {
        "vertices_coords": points,
        "edges_vertices": [[0, k] for k in range(1, n + 1)]
        + [[k, k % n + 1] for k in range(1, n + 1)],
        "edges_assignment": ["U"] * n + ["B"] * n,
    }
