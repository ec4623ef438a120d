"""Folded maps, stamps and vertices: against published numbers, and against brute force."""

from __future__ import annotations

from collections import Counter

import pytest
from flat_sheets import fan, folded_map, strip
from independent_layers import map_orders, stamps
from sampling import slow_after

from exactfold import PROVED, REFUTED, flat
from exactfold.exact.surds import RATIONALS

STAMPS = [1, 2, 6, 16, 50, 144, 462, 1392, 4536]  # A000136
STRIPS = {2: 8, 3: 60, 4: 320, 5: 1980}  # A001415: 2 x n
SQUARES = {1: 1, 2: 8, 3: 1368}  # A001418: n x n


@pytest.mark.parametrize(("number", "states"), list(enumerate(STAMPS, 1)))
def test_stamps_have_the_published_number_of_states(number, states):
    assert flat(folded_map(1, number)).count == states


@pytest.mark.parametrize(("columns", "states"), list(STRIPS.items()))
def test_two_rows_have_the_published_number_of_states(columns, states):
    assert flat(folded_map(2, columns)).count == states


@pytest.mark.parametrize(("side", "states"), list(SQUARES.items()))
def test_square_maps_have_the_published_number_of_states(side, states):
    assert flat(folded_map(side, side)).count == states


def _orders(found):
    return [frozenset((i, j) if x > 0 else (j, i) for (i, j), x in s.orders.items()) for s in found]


def _panel_numbers(sheet, rows, columns):
    """The panel of the sheet for each panel of the map, row by row."""
    corners = [r * (columns + 1) + c for r in range(rows) for c in range(columns)]
    return [next(k for k, face in enumerate(sheet.faces) if face[0] == v) for v in corners]


@pytest.mark.parametrize(
    ("rows", "columns"),
    [
        *slow_after(5, [(1, 3), (1, 5), (2, 2), (2, 3), (3, 2), (1, 7), (4, 2), (2, 4), (3, 3)]),
    ],
)
def test_the_states_of_a_map_are_those_of_all_orders_of_panels(rows, columns):
    sheet = folded_map(rows, columns)
    number = _panel_numbers(sheet, rows, columns)
    expected, with_letters = set(), Counter()
    for order, letters in map_orders(rows, columns):
        named = [number[panel] for panel in order]
        expected.add(frozenset((a, b) for k, a in enumerate(named) for b in named[k + 1 :]))
        by_panels = frozenset(
            (frozenset((number[a], number[b])), x) for (a, b), x in letters.items()
        )
        with_letters[by_panels] += 1
    found = flat(sheet, most=10**6)
    assert found.letters_used == "any"
    got = _orders(found)
    assert len(got) == len(set(got)) == found.count
    assert set(got) == expected
    for by_panels, states in sorted(with_letters.items(), key=str)[:24]:
        known = dict(by_panels)
        letters = {
            fold: known[frozenset((sheet.sides[fold], sheet.sides[fold[::-1]]))]
            for fold in sheet.folds
        }
        assert flat(sheet, letters).count == states
        turned = {fold: {"M": "V", "V": "M"}[x] for fold, x in letters.items()}
        assert flat(sheet, turned).count == states


def test_letters_that_no_order_has_are_refuted():
    sheet = folded_map(1, 4)
    known = {letters for _, letters in stamps([1, 1, 1, 1])}
    assert flat(sheet, "VVV").status is (PROVED if "VVV" in known else REFUTED)
    found = flat(strip(2, 1, 2), "VV")
    assert found.status is REFUTED
    assert {one.constraint.kind for one in found.conflict} == {"letter", "taco-tortilla"}


@pytest.mark.parametrize(
    "widths",
    [(1, 2, 3), (2, 1, 2), (3, 2, 1, 2), (2, 3, 2, 3), (1, 3, 1, 2, 2), (2, 1, 1, 2, 3, 1)],
)
def test_stamps_of_different_widths_are_those_of_all_orders(widths):
    sheet = strip(*widths)
    expected = {frozenset(relations): letters for relations, letters in stamps(widths)}
    found = flat(sheet, most=10**6)
    number = [
        next(k for k, face in enumerate(sheet.faces) if face[0] == c) for c in range(len(widths))
    ]
    named = {
        frozenset((number[a], number[b]) for a, b in relations): letters
        for relations, letters in expected.items()
    }
    assert set(_orders(found)) == set(named)
    for letters, states in Counter(named.values()).items():
        by_fold = {
            fold: letters[k] for k, fold in enumerate(sorted(sheet.folds, key=lambda e: e[0]))
        }
        assert flat(sheet, by_fold).count == states


EIGHTHS = [(2, 0), (2, 2), (0, 2), (-2, 2), (-2, 0), (-2, -2), (0, -2), (2, -2)]


@pytest.mark.parametrize(
    "sectors",
    [
        *((2, 2, 2, 2), (1, 3, 3, 1), (1, 2, 3, 2), (1, 1, 1, 1, 2, 2), (2, 1, 1, 2, 1, 1)),
        (1, 2, 1, 1, 2, 1),
        pytest.param((1,) * 8, marks=pytest.mark.slow),
    ],
)
def test_the_states_of_a_vertex_are_those_of_all_orders_of_its_sectors(sectors):
    """Sectors in units of 45 degrees; on a circle round the vertex they are a closed strip."""
    places = [sum(sectors[:k]) for k in range(len(sectors))]
    sheet = fan(*(EIGHTHS[p] for p in places))
    count = len(sectors)
    number = [
        next(k for k, face in enumerate(sheet.faces) if {j, (j + 1) % count} <= set(face))
        for j in range(count)
    ]
    states = {
        frozenset((number[a], number[b]) for a, b in relations): letters
        for relations, letters in stamps(sectors, closed=True)
    }
    assert number[0] == 0  # it keeps its place, face up
    found = flat(sheet, most=10**6)
    assert set(_orders(found)) == set(states)
    for letters, number_of_states in sorted(Counter(states.values()).items())[:40]:
        by_fold = {((k + 1) % count, count): letters[k] for k in range(count)}
        assert flat(sheet, by_fold).count == number_of_states


def test_a_vertex_with_sectors_of_22_5_degrees_in_a_field_with_a_root():
    tangent = RATIONALS.adjoined(2).root - 1
    found = flat(fan((1, 0), (1, tangent), (1, 1), (-1, -tangent)))
    assert found.count == len(list(stamps((1, 1, 7, 7), closed=True))) > 0
    assert flat(fan((1, 0), (1, tangent), (-1, tangent), (-1, -tangent))).status is REFUTED
