"""Images, pieces, states and conflicts of sheets that are folded flat."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from flat_sheets import folded_map, grid, strip
from hypothesis import given, settings
from hypothesis import strategies as st

import exactfold
from exactfold import PROVED, REFUTED, UNDECIDED, flat
from exactfold.errors import TooManyModesError, UsageError
from exactfold.exact.surds import RATIONALS
from exactfold.layers.common import Common
from exactfold.layers.conflicts import ConflictSearch
from exactfold.layers.constraints import Constraints
from exactfold.layers.folding import _components
from exactfold.layers.images import Images, Isometry, images_of
from exactfold.layers.orders import Search, models, solver
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import Pieces, pieces_of
from exactfold.layers.witnesses import _clipped
from exactfold.pattern.panel_pattern import PanelPattern

OPPOSITE = {"M": "V", "V": "M"}


def test_the_panels_at_a_point_lie_in_the_order_of_the_state():
    found = flat(folded_map(1, 3), "VV")
    assert found.count == 2
    stacks = {state.stack((Fraction(1, 2), Fraction(1, 2))) for state in found}
    assert stacks == {(1, 0, 2), (1, 2, 0)}
    for state in found:
        top, middle, bottom = state.stack((Fraction(1, 3), Fraction(1, 2)))
        assert state.above(top, middle)
        assert state.above(top, bottom)
        assert not state.above(bottom, middle)


def test_states_have_numbers_and_others_are_refused():
    found = flat("map-fold", "any")
    assert found.status is PROVED
    assert found.listed == found.count == len(list(found)) == 320
    assert len({tuple(state.orders.items()) for state in found}) == 320
    with pytest.raises(UsageError, match="there is no state 320: 320 are listed, from 0"):
        found.state(320)
    with pytest.raises(UsageError, match="there is no state 0: 0 are listed"):
        flat("zigzags").state()


def test_more_states_are_counted_than_listed():
    found = flat(folded_map(1, 6), most=10)
    assert (found.count, found.at_least, found.listed) == (144, 144, 10)


class AfterChecks:
    """A clock that passes when it has been asked so many times."""

    def __init__(self, checks):
        self.checks = checks

    def check(self):
        self.checks -= 1
        if self.checks < 0:
            raise TooManyModesError("the time is over")


def test_a_search_that_is_stopped_has_a_lower_bound():
    pattern = folded_map(1, 7)
    overlaps = Overlaps(images_of(pieces_of(pattern, dict.fromkeys(pattern.folds, "U"))))
    orders = Search(Constraints(overlaps), AfterChecks(300), None, 10).run()
    [component] = orders.components
    assert component.count is None
    assert len(component.states) == 10 < component.least < 462
    assert orders.stopped == "the time is over"
    found = replace(flat(pattern, "any"), components=_components(orders))
    assert (found.count, found.at_least, found.status) == (None, component.least, PROVED)
    assert found.to_dict()["at_least"] == component.least


def test_an_image_is_an_isometry_that_agrees_on_creases():
    found = flat("bird-base")
    images, sheet = found.images, found.pattern
    for polygon, place in zip(images.pieces.polygons, images.maps, strict=True):
        for i, j in combinations(polygon, 2):
            (ax, ay), (bx, by) = images.points[i], images.points[j]
            (cx, cy), (dx, dy) = (sheet.scaled_vertices[v] for v in (i, j))
            assert (
                (ax - bx) ** 2
                if False
                else (ax - bx) * (ax - bx) + (ay - by) * (ay - by)
                == (cx - dx) * (cx - dx) + (cy - dy) * (cy - dy)
            )
            assert place(sheet.scaled_vertices[i]) == images.points[i]
        (a, b), (c, d) = place.matrix
        assert a * d - b * c == (-1 if place.flipped else 1)


def test_a_panel_that_is_not_convex_is_cut_and_may_lie_between_and_above():
    """A strip passes above one prong of a U and below the other one."""
    points = [(0, 0), (6, 0), (6, 2), (2, 2), (2, 4), (6, 4), (6, 6), (0, 6)]
    sheet = PanelPattern(points, [(k, (k + 1) % 8) for k in range(8)])
    pieces = pieces_of(sheet, {})
    assert len(pieces.polygons) == 3
    assert len(pieces.joints) == 2
    assert flat(sheet).count == 1
    # A long flap folded back over both prongs of a comb: above or below each one by itself.
    comb = [(0, 0), (2, 0), (2, 1), (4, 1), (4, 0), (6, 0), (6, 3), (0, 3), (0, 9), (6, 9)]
    border = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (0, 7), (7, 8), (8, 9), (6, 9)]
    sheet = PanelPattern(comb, [*border, (6, 7)])
    assert flat(sheet, "V").count == 1
    assert {len(p) for p in pieces_of(sheet, {}).polygons} <= {3, 4, 5}


def test_creases_that_are_not_folded_join_panels():
    sheet = folded_map(1, 4)
    folds = sorted(sheet.folds)
    found = flat(sheet, {folds[0]: "V", folds[1]: "F", folds[2]: "V"})
    assert found.count == len(list(flat(strip(1, 2, 1), "VV")))
    assert len(found.images.pieces.polygons) == 3


@pytest.mark.parametrize("letters", [None, "any"])
def test_a_file_whose_folds_all_have_f_is_not_folded(letters):
    corners = [[0, 0], [2, 0], [2, 2], [0, 2]]
    edges = [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2]]
    sheet = {"vertices_coords": corners, "edges_vertices": edges}
    kept = flat({**sheet, "edges_assignment": [*"BBBBF"]}, letters)
    assert (kept.status, kept.count, kept.letters) == (PROVED, 1, {(0, 2): "F"})
    assert len(kept.images.maps) == 1
    for said in ({}, {"edges_assignment": [*"BBBBU"]}):
        free = flat({**sheet, **said}, letters)
        assert (free.status, free.count, free.letters) == (PROVED, 2, {(0, 2): "U"})


def test_the_order_of_panels_across_a_flat_edge_is_one():
    """A square on a flat crease of another layer cannot pass through it."""
    sheet = grid((0, 1, 2), (0, 1, 2))
    letters = dict.fromkeys(sheet.folds, "F")
    found = flat(sheet, letters)
    assert (found.status, found.count, len(found.pairs)) == (PROVED, 1, 0)


def test_without_a_state_every_condition_of_the_conflict_is_needed():
    pieces = pieces_of(*_twist())
    constraints = Constraints(Overlaps(images_of(pieces)))
    search = Search(constraints)
    orders = search.run()
    assert orders.refuted
    found = ConflictSearch(constraints, orders.used).find()
    rows = {}
    for k in range(len(constraints.equal)):
        x, y = constraints.equal[k].tolist()
        rows[constraints.equality(k)] = [[x, -y], [-x, y]]
    for edge, literal in constraints.given.items():
        rows[constraints.letter(edge)] = [[literal]]
    for leave in (None, *found):
        clauses = [clause for one in found if one != leave for clause in rows[one]]
        with solver(clauses) as asked:
            assert asked.solve() is (leave is not None)


def _twist():
    opened = exactfold.read("square-twist")
    return opened.sheet, opened.letters


def test_a_conflict_has_a_point_in_all_its_panels():
    found = flat("square-twist")
    assert found.status is REFUTED
    for one in found.conflict:
        for piece in one.constraint.pieces:
            corners = [found.images.points[v] for v in found.images.pieces.polygons[piece]]
            side = -1 if found.images.maps[piece].flipped else 1
            x, y = (c * found.images.scale for c in one.point)
            for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
                assert ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) * side >= 0


TURNS = [(1, 0), (0, 1), (Fraction(3, 5), Fraction(4, 5)), (Fraction(-3, 5), Fraction(4, 5))]


@settings(max_examples=150, deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from(TURNS), st.integers(-4, 4), st.integers(-4, 4), st.booleans()),
        min_size=3,
        max_size=3,
    )
)
def test_three_pieces_have_a_common_part_if_exact_clipping_leaves_one(places):
    """Three long rectangles anywhere in the plane, also where they only touch."""
    overlaps = Overlaps(_rectangles(places))
    if len(overlaps.pairs) < 3:
        return
    common, triples = Common(overlaps), np.array([[0, 1, 2]])
    polygon = [overlaps.points[p] for p in overlaps.corners[0]]
    for piece in (1, 2):
        polygon = _clipped(overlaps, polygon, piece) if polygon else []
    area = sum(
        p[0] * q[1] - p[1] * q[0]
        for p, q in zip(polygon, [*polygon[1:], *polygon[:1]], strict=True)
    )
    assert common.have(triples).tolist() == [bool(area != 0)]
    assert common._some(triples).tolist() == [bool(area != 0)]


def test_three_rectangles_round_a_triangle_overlap_in_pairs_only():
    level, right, left = TURNS[0], TURNS[2], TURNS[3]
    apart = _rectangles([(level, -6, -1, False), (right, -5, -5, False), (left, 5, -5, False)])
    overlaps = Overlaps(apart)
    assert len(overlaps.pairs) == 3
    assert Common(overlaps).have(np.array([[0, 1, 2]])).tolist() == [False]


def _rectangles(places):
    """Rectangles of 12 by 1 at places of their own: a turn, a shift, and whether it is flipped."""
    sheet = grid((0, 12), range(6))
    number = RATIONALS.number
    polygons = tuple((2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in (0, 2, 4))
    maps = tuple(
        Isometry((number(c), number(s)), (number(x + 2 * k * s), number(y - 2 * k * c)), flipped)
        for k, ((c, s), x, y, flipped) in enumerate(places)
    )
    return Images(Pieces(sheet, {}, polygons, ((0,), (2,), (4,)), {}, {}), maps)


def test_the_time_limit_leaves_what_is_known():
    found = flat(folded_map(1, 5), limit=0)
    assert (found.status, found.count, found.listed) == (UNDECIDED, None, 0)
    assert found.reason == "the time limit of 0 seconds (--limit) was reached"
    assert found.locally_flat is PROVED


def test_states_that_are_not_all_counted_are_proved_to_exist(monkeypatch):
    monkeypatch.setattr("exactfold.layers.orders.models", _two_models)
    found = flat(folded_map(1, 4))
    assert (found.status, found.count, found.listed) == (PROVED, None, 2)
    assert found.reason == "enough"


def _two_models(variables, clauses, clock):
    for number, model in enumerate(models(variables, clauses, clock)):
        if number == 2:
            raise TooManyModesError("enough")
        yield model


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.integers(1, 3), min_size=2, max_size=5),
    st.lists(st.sampled_from("MV"), min_size=4, max_size=4),
    st.tuples(st.integers(-3, 3), st.integers(1, 3)),
)
def test_turning_mirroring_and_reversing_keep_the_number_of_states(widths, letters, turn):
    sheet = strip(*widths)
    chosen = dict(zip(sorted(sheet.folds), letters, strict=False))
    count = flat(sheet, chosen).count
    opposite = {fold: OPPOSITE[x] for fold, x in chosen.items()}
    assert flat(sheet, opposite).count == count
    mirrored = PanelPattern([(-x, y) for x, y in sheet.vertices], sheet.edges)
    assert flat(mirrored, opposite).count == flat(mirrored, chosen).count == count
    a, b = turn
    turned = PanelPattern([(a * x - b * y, b * x + a * y) for x, y in sheet.vertices], sheet.edges)
    assert flat(turned, chosen).count == count


@pytest.mark.parametrize("name", ["fish-base", "windmill", "map-fold", "bird-base"])
def test_the_drawn_letters_are_among_all(name):
    drawn = flat(name)
    opposite = {fold: OPPOSITE.get(x, x) for fold, x in drawn.letters.items()}
    assert flat(name, opposite).count == drawn.count == 1
