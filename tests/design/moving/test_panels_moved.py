"""Panels whose vertices are moved: what is claimed of the new sheet, by independent exact tests."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

import exactfold
from exactfold._support.clock import Clock
from exactfold.branches.counting.ways import count_ways
from exactfold.design import actuate_panels, designed, match_panels
from exactfold.design.moving import panel_order
from exactfold.design.moving.descent import descended
from exactfold.design.moving.panel_order import impossible_letters
from exactfold.design.moving.places import Places, symmetries_of
from exactfold.design.moving.rational_sheet import nearest_sheet, rational_sheets
from exactfold.design.moving.slopes import Equations, Slopes
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import NotCountedError, UsageError
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.decomposition import decompose
from exactfold.pattern.families import single_vertex
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.panel_pattern import PanelPattern


def way_of(name, folds=8):
    """A sheet, and the letters of its first way that truly folds with so many folds."""
    sheet = open_sheet(name).sheet
    ways = panel_ways(count_ways(name))
    way = next(w for w in ways if w.verdict is exactfold.PROVED and w.folds >= folds)
    return sheet, dict.fromkeys(sheet.folds, "F") | dict(way.letters)


def missed(sheet, seed, share, *, border=False):
    """The sheet with its vertices inside, or all of them, moved at random by a share of it."""
    source = random.Random(seed)
    width = max(float(x) for x, _ in sheet.vertices)
    points = list(sheet.vertices)
    for v in range(len(points)) if border else sheet.interior:
        points[v] = tuple(
            Fraction(round(float(c) * 10**3 + source.uniform(-share, share) * width * 10**3), 10**3)
            for c in points[v]
        )
    return PanelPattern(points, sheet.edges)


def folds_flat(sheet, v):
    """Kawasaki's condition in exact numbers: the product of every second quotient is real."""
    x, y = sheet.vertices[v]
    d1, d2, d3, d4 = ((sheet.vertices[u][0] - x, sheet.vertices[u][1] - y) for u in sheet.stars[v])
    cross = [a[0] * b[1] - a[1] * b[0] for a, b in ((d1, d2), (d3, d4))]
    dot = [a[0] * b[0] + a[1] * b[1] for a, b in ((d1, d2), (d3, d4))]
    return cross[0] * dot[1] + cross[1] * dot[0] == 0


@pytest.mark.parametrize("symmetric", [False, True])
def test_a_loop_that_misses_is_closed(symmetric):
    sheet, letters = way_of("square-twist")
    near = missed(sheet, 1, 0.004)
    assert match_panels(near, letters).truly is not exactfold.PROVED
    assert not folds_flat(near, 4)
    found = designed(near, letters, symmetric=symmetric)
    assert (found.status, found.goal) == (exactfold.PROVED, "letters")
    assert match_panels(found.pattern, letters).truly is exactfold.PROVED
    assert all(folds_flat(found.pattern, v) for v in sheet.interior)
    assert found.pattern.faces == sheet.faces
    assert 0 < found.largest_move < 0.04 * 400
    known = panel_ways(decompose(found.pattern))
    assert any(w.verdict is exactfold.PROVED and w.folds == 12 for w in known)
    for v, (x, y) in enumerate(found.pattern.vertices):
        before = sheet.vertices[v]
        on = [before[k] for k in (0, 1) if before[k] in (0, 400, -400)]
        assert v in sheet.interior or set(on) <= {x, y}
    if symmetric:
        for one in symmetries_of(found.pattern, letters):
            for v, (x, y) in enumerate(found.pattern.vertices):
                image = one.applied((x - 200, y + 200))
                other = found.pattern.vertices[one.vertices[v]]
                assert (image[0] + 200, image[1] - 200) == other


def turned(point):
    """The image of a point when the square twist is turned by 180 degrees."""
    return 400 - point[0], -400 - point[1]


def moves(found):
    """How far each vertex moves along an axis, exactly."""
    pairs = zip(found.pattern.vertices, found.original.vertices, strict=True)
    return [max(abs(p[0] - q[0]), abs(p[1] - q[1])) for p, q in pairs]


def test_with_symmetries_fixed_vertices_stay_and_take_their_images_along():
    sheet, letters = way_of("square-twist")
    near = missed(sheet, 1, 0.004)
    found = designed(near, letters, symmetric=True, fixed=[4])
    assert found.status is exactfold.PROVED
    assert found.pattern.vertices[4] == near.vertices[4]
    assert found.pattern.vertices[6] == turned(near.vertices[4]) != near.vertices[6]
    with pytest.raises(UsageError, match="vertices 4 and 6 are fixed, and not where a symmetry"):
        designed(near, letters, symmetric=True, fixed=[4, 6])


def test_the_box_is_about_the_given_places_also_with_symmetries():
    sheet, letters = way_of("square-twist")
    near = missed(sheet, 1, 0.004)
    wide = designed(near, letters, symmetric=True)
    box = Fraction(9, 10) * max(moves(wide))
    narrow = designed(near, letters, within=box, symmetric=True)
    assert narrow.status is exactfold.PROVED
    assert max(moves(narrow)) <= box


def test_a_sheet_that_folds_is_still_made_symmetric():
    sheet, letters = way_of("square-twist")
    folding = designed(missed(sheet, 1, 0.004), letters).pattern
    assert designed(folding, letters).pattern is folding
    found = designed(folding, letters, symmetric=True)
    assert found.status is exactfold.PROVED
    assert {turned(point) for point in found.pattern.vertices} == set(found.pattern.vertices)
    assert max(moves(found)) > 0


def test_symmetries_that_a_sheet_does_not_have_are_refused():
    sheet, letters = way_of("square-twist")
    one = sheet.folds[0]
    other = letters | {one: {"M": "V", "V": "M"}[letters[one]]}
    with pytest.raises(UsageError, match="no rotation or reflection keeps the sheet"):
        designed(sheet, other, symmetric=True)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["square-twist", "windmill", "pinwheel-base"])
@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("border", ["along", "free"])
def test_loops_of_twists_are_closed(name, seed, border):
    sheet, letters = way_of(name, 12)
    found = designed(missed(sheet, seed, 0.003), letters, border=border)
    assert found.status is exactfold.PROVED
    assert match_panels(found.pattern, letters).truly is exactfold.PROVED
    assert found.largest_move < 0.03 * 440


def test_a_mesh_whose_corners_move_is_repaired():
    sheet, letters = way_of("miura", 24)
    near = missed(sheet, 3, 0.002, border=True)
    assert match_panels(near, letters).starts is exactfold.REFUTED
    found = designed(near, letters, border="free")
    assert found.status is exactfold.PROVED
    assert all(folds_flat(found.pattern, v) for v in sheet.interior)
    assert match_panels(found.pattern, letters).truly is exactfold.PROVED


def test_drawn_letters_that_the_drawing_refutes():
    opened = open_sheet("map-fold")
    letters = by_fold(opened.sheet.folds, opened.letters)
    assert match_panels("map-fold", letters).starts is exactfold.REFUTED
    found = designed("map-fold", letters, fixed=[4])
    assert found.status is exactfold.PROVED
    assert match_panels(found.pattern, letters).truly is exactfold.PROVED
    assert found.pattern.vertices[4] == opened.sheet.vertices[4]
    same = designed(found.pattern, letters)
    assert (same.status, same.largest_move, same.steps) == (exactfold.PROVED, 0, 0)


def test_a_margin_of_panels_is_raised(monkeypatch):
    from exactfold.design.moving import panel_margin

    monkeypatch.setattr(panel_margin, "_TRIALS", 3)
    sheet, letters = way_of("square-twist")
    found = designed(sheet, letters, maximise="margin")
    assert (found.status, found.goal) == (exactfold.PROVED, "margin")
    values = []
    for one in (sheet, found.pattern):
        known = count_ways(one)
        [way] = [
            w
            for w in panel_ways(known)
            if w.verdict is exactfold.PROVED
            and {**letters, **w.letters}
            in (letters, {e: "MV"["VM".index(x)] for e, x in letters.items()})
        ]
        values.append(float(actuate_panels(known, way.number).margin[0]))
    assert values == pytest.approx([found.before, found.after], rel=1e-9)
    assert found.after > found.before


def test_letters_to_second_order_only_are_undecided():
    opened = open_sheet("square-twist")
    found = designed(opened.sheet, opened.letters)
    assert found.status is exactfold.UNDECIDED
    assert "to second order only" in found.reason
    matched = match_panels(found.pattern, opened.letters)
    assert (matched.starts, matched.truly) == (exactfold.PROVED, exactfold.REFUTED)


def test_what_is_stuck_is_named():
    sheet, letters = way_of("square-twist")
    near = missed(sheet, 1, 0.02)
    found = designed(near, letters, within=Fraction(1, 10))
    assert found.status is exactfold.UNDECIDED
    assert "nearest comes a sheet on which" in found.reason
    assert "at the limit of their box" in found.reason
    assert 0 < found.largest_move < 0.15
    over = designed(near, letters, clock=Clock(0))
    assert over.reason.endswith("(the time is over)")


def test_an_interruption_keeps_the_closest_sheet(monkeypatch):
    sheet, letters = way_of("square-twist")
    near = missed(sheet, 1, 0.02)

    def told(_stage, done, _total):
        if done == 4:
            raise KeyboardInterrupt

    found = designed(near, letters, progress=told)
    assert found.interrupted
    assert found.status is exactfold.UNDECIDED
    assert found.reason.endswith("(the search was interrupted)")
    assert found.largest_move > 0


def test_an_interruption_while_a_sheet_is_matched_keeps_it(monkeypatch):
    sheet, letters = way_of("square-twist")
    asked = []

    def interrupted(*arguments, **options):
        asked.append(arguments)
        if len(asked) > 1:
            raise KeyboardInterrupt
        return match_panels(*arguments, **options)

    monkeypatch.setattr(panel_order, "match_panels", interrupted)
    found = designed(missed(sheet, 1, 0.004), letters)
    assert found.interrupted
    assert found.reason.endswith("no exact sheet was found there (the search was interrupted)")
    assert found.largest_move > 0


def test_letters_that_a_vertex_has_on_no_sheet_are_refuted():
    sheet = open_sheet("square-twist").sheet
    found = designed(sheet, dict.fromkeys(sheet.folds, "M"))
    assert (found.status, found.largest_move) == (exactfold.REFUTED, 0)
    assert found.reason.startswith("vertex 4 has these letters on no sheet with these folds")
    star = exactfold.pattern.opened.panels(single_vertex(4))

    def why(text):
        return impossible_letters(star, by_fold(star.folds, text))

    assert not any(why(text) for text in ("MMMV", "UUMV", "MUMF", "MFMF", "UUUU", "MUUF"))
    assert all(why(text) for text in ("MMVV", "MMMM", "MFFV", "MFFF", "MMMF"))


def test_derivatives_are_those_of_the_values():
    opened = open_sheet("square-twist")
    letters = by_fold(opened.sheet.folds, opened.letters)
    equations = Equations(Slopes(Places(opened.sheet), letters), 40.0, (4, 5, 6, 7))
    count = equations.moves.shape[1] + equations.turns.shape[1]
    x = 0.3 * np.random.default_rng(1).normal(size=count)
    for function in (equations.closing, equations.margins):
        rows = [
            (function(x + 1e-6 * step)[0] - function(x - 1e-6 * step)[0]) / 2e-6
            for step in np.eye(count)
        ]
        assert function(x)[1] == pytest.approx(np.array(rows).T, abs=1e-7)


def test_exact_sheets_are_refused_where_floats_are_wrong():
    """Places and slopes that are no solution lead to no exact sheet, or to one far from them."""
    sheet, letters = way_of("square-twist")
    equations = Equations(Slopes(Places(sheet), letters), 40.0, ())
    slopes = equations.first(np.zeros(equations.moves.shape[1]), np.ones(len(sheet.folds)))
    start = np.concatenate([np.zeros(equations.moves.shape[1]), slopes])
    *_, last = descended(equations.closing, equations.margins, start, 16, 0.1, 100)
    made, exact = next(rational_sheets(equations, last.x, (4,)))
    assert (made.faces, exact) == (sheet.faces, True)
    turned = last.x.copy()
    turned[16:] *= -1
    assert not list(rational_sheets(equations, turned, (4, 6)))
    away = last.x.copy()
    away[:16] += 0.5
    assert nearest_sheet(equations, away, 4) is None
    assert not list(rational_sheets(equations, away, (4, 6)))


def test_symmetries_are_those_that_keep_the_letters():
    sheet, letters = way_of("square-twist")
    assert len(symmetries_of(sheet, dict.fromkeys(sheet.folds, "U"))) == 4
    found = symmetries_of(sheet, letters)
    assert {one.turns for one in found} <= {1, -1}
    one = sheet.folds[0]
    other = letters | {one: {"M": "V", "V": "M"}[letters[one]]}
    assert len(symmetries_of(sheet, other)) < len(found) or len(found) == 1


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"letters": None}, UsageError, "nothing is asked for"),
        ({"letters": {}}, UsageError, "no fold has the letter M or V"),
        ({"fixed": [99]}, UsageError, "there is no vertex 99"),
        ({"fixed": range(16)}, UsageError, "no vertex may move"),
        ({"maximise": "tolerance"}, NotCountedError, "the tolerance is raised on triangulated"),
        ({"maximise": "stroke"}, NotCountedError, "the stroke is raised on triangulated"),
    ],
)
def test_what_is_refused(options, error, words):
    opened = open_sheet("square-twist")
    with pytest.raises(error) as caught:
        designed(opened.sheet, **({"letters": opened.letters} | options))
    assert words in str(caught.value)


def test_sheets_that_are_refused(monkeypatch):
    sheet, letters = way_of("square-twist")
    monkeypatch.setattr(panel_order, "_MOST_FOLDS", 11)
    with pytest.raises(NotCountedError, match="has 12 folds"):
        designed(sheet, letters)
    fish = open_sheet("fish-base")
    inside = fish.sheet.interior[0]
    with pytest.raises(NotCountedError, match="irrational coordinate: round the drawing"):
        designed(fish.sheet, dict.fromkeys(fish.sheet.folds, "M"), fixed=[inside])
