"""Bounds of the degrees of freedom: known values, never too small, and refused without a proof."""

from collections.abc import Sequence
from fractions import Fraction
from itertools import combinations

import pytest
from flint import fmpq_mat
from panel_sheets import mesh, miura, shifted_columns, tiling
from test_folding_modes import boxes

from exactfold._support.clock import Clock
from exactfold._support.verdict import UNDECIDED
from exactfold.exact.surds import RATIONALS
from exactfold.panels import by_spaces
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces import freedom
from exactfold.panels.spaces.freedom import most_first_order, most_freedom
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.subspaces import reduced
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.families import single_vertex
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern, Point

SHEETS = {
    "single": panels(single_vertex(7)),
    "miura": miura(2, 3),
    "mesh": mesh(2, 2, seed=1),
    "tiling": tiling(3, 3),
    "columns": shifted_columns(3),
}


def bound(pattern: PanelPattern) -> int:
    moving = stars(pattern)
    return most_freedom(moving, *first_order(moving))


@pytest.mark.parametrize("name", SHEETS)
def test_no_component_has_more_dimensions(name: str) -> None:
    known = decompose(SHEETS[name])
    assert known.second_order is not None
    assert bound(SHEETS[name]) >= max(known.second_order)


@pytest.mark.parametrize("count", range(4, 9))
def test_a_single_vertex_has_exactly_its_folds_less_three(count: int) -> None:
    assert bound(panels(single_vertex(count))) == count - 3


@pytest.mark.parametrize("name", SHEETS)
def test_a_restriction_is_onto_only_if_its_rank_says_so(name: str) -> None:
    """Every pair of vertices, against the rank that FLINT computes over Q."""
    moving = stars(SHEETS[name])
    rows, size = first_order(moving)
    for some in combinations(moving, min(2, len(moving))):
        folds = sorted({edge for v in some for edge in moving[v].folds if edge in rows})
        rank = fmpq_mat([list(rows[edge]) for edge in folds]).rank()
        wanted = sum(len(moving[v].folds) - 2 for v in some)
        assert freedom._restricts_onto(moving, rows, size, some) is (rank == wanted)


def test_a_choice_that_is_not_onto_gives_a_weaker_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two neighbours share a fold: floats that propose both are not believed."""
    pattern = mesh(2, 1, seed=1)
    moving = stars(pattern)
    rows, size = first_order(moving)
    assert most_freedom(moving, rows, size) == size - 1
    monkeypatch.setattr(freedom, "_chosen", lambda *_: sorted(moving))
    assert most_freedom(moving, rows, size) == size - 1


@pytest.mark.parametrize("name", SHEETS)
def test_the_rank_modulo_a_prime_bounds_the_first_order_motions(name: str) -> None:
    moving = stars(SHEETS[name])
    assert most_first_order(moving) == first_order(moving)[1]


def test_irrational_coordinates_have_no_rank_modulo_a_prime() -> None:
    sheet = open_sheet("square-twist").sheet
    assert isinstance(sheet, PanelPattern)
    points = [tuple(RATIONALS.adjoined(2).root * x for x in point) for point in sheet.vertices]
    assert most_first_order(stars(PanelPattern(points, sheet.edges))) is None


def test_without_first_order_motions_modes_and_a_bound_are_known(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stopped(*_: object) -> None:
        Clock(0).check()

    pattern = boxes(7, "/")
    known = decompose(pattern, clock=Clock(0)).freedom
    monkeypatch.setattr(by_spaces, "first_order", stopped)
    found = decompose(pattern, clock=Clock(0))
    assert "are not known: the time limit of 0 seconds" in found.reason
    assert known is not None
    assert found.freedom is not None
    assert (found.freedom.least, found.freedom.first_order) == (known.least, None)
    assert found.freedom.most == known.first_order


def test_bounds_of_a_complete_answer_are_its_dimension() -> None:
    known = decompose(miura(2, 3)).freedom
    assert known is not None
    assert (known.least, known.most, known.text) == (2, 2, "degrees of freedom: 2")


def test_a_search_without_time_still_bounds_the_degrees_of_freedom() -> None:
    for pattern in (miura(2, 3), tiling(3, 3)):
        stopped = decompose(pattern, clock=Clock(0))
        assert stopped.status is UNDECIDED
        assert "the time limit of 0 seconds (--limit) was reached" in stopped.reason
        known, bounds = decompose(pattern).freedom, stopped.freedom
        assert known is not None
        assert bounds is not None
        assert bounds.least <= known.least
        assert bounds.most >= known.most
        assert bounds.first_order == first_order(stars(pattern))[1]


def sheet_on_grid(
    columns: Sequence[int], rows: Sequence[int], more: Point, edges: str
) -> PanelPattern:
    """Vertices where lines cross, numbered along columns, and one more vertex."""
    points = [(Fraction(x), Fraction(y)) for x in columns for y in rows]
    pairs = (pair.split("-") for pair in edges.split())
    return PanelPattern([*points, more], [(int(i), int(j)) for i, j in pairs])


def test_dimensions_to_second_order_bound_only_motions_that_have_no_more_complex_ones() -> None:
    """Where x^2 + y^2 vanishes to second order, x and y may be larger at a higher order."""
    bounded = sheet_on_grid(
        (0, 1, 2),
        (0, 1, 2),
        (Fraction(1, 2), Fraction(3, 2)),
        "0-1 0-3 0-4 1-2 1-4 1-9 2-5 2-9 3-4 3-6 4-5 4-7 4-9 5-8 5-9 6-7 7-8",
    )
    with_squares = sheet_on_grid(
        (0, 3, 6, 9),
        (0, 2, 4),
        (Fraction(8), Fraction(3)),
        "0-1 0-3 1-2 1-4 1-5 2-5 3-4 3-6 4-5 4-7 4-8 5-8 6-7 6-9 7-8 7-10 7-12 8-11 8-12 9-10 "
        "10-11 10-12 11-12",
    )
    for pattern, first, second, most in ((bounded, 5, {3: 2}, 3), (with_squares, 6, {3: 2}, 4)):
        [part] = decompose(pattern).parts
        assert (part.second_order, part.true) == (second, None)
        assert (part.dimension, part.freest) == (first, most)
        assert bound(pattern) == 4


def test_forms_of_several_squares_are_noted() -> None:
    """Three folds have a definite form: one square. Four with a sector above pi have two."""
    square = Star(0, ((0, 1), (0, 2), (0, 3)), ((1, 0), (0, 1), (-1, -1)))
    squares = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (3, 1), (1, 1), (1, 3)))
    for star, size, sums in ((square, 1, False), (squares, 2, True)):
        rows, first = first_order({0: star})
        assert first == size
        assert reduced({0: star}, rows, size, 10**6) == ({}, 0, sums)
