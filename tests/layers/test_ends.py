"""The states that motions reach: by the engine of states, by positions in floats, by symmetry."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from panel_sheets import grid, miura
from sampling import slow_after

import exactfold
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.errors import NotApplicableError
from exactfold.layers import fold_flat, reached, way_ends
from exactfold.motion import follow_panels, prove_contacts


def strip(widths):
    """Panels side by side, with a fold from boundary to boundary between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (xs[i], 2 * j))


def to_the_end(sheet, way, **more):
    return exactfold.follow(sheet, way, until="180deg", frames=2, **more)


def ends_of(name, letters="any"):
    return way_ends(exactfold.decompose(name), exactfold.flat(name, letters), limit=None)


def in_floats(motion, end):
    """The orders of `end` by the heights at 180 - 0.06 degrees, over points of the folded image."""
    images, pattern = end.images, motion.pattern
    held = replace(motion, held=images.pieces.panels[0][0])
    near = held._positions(pi - 1e-3)
    scale = float(images.scale)
    found = {}
    for i, j in end.state.orders:
        heights = []
        corners = [
            np.array([[float(c) / scale for c in images.points[v]] for v in polygon])
            for polygon in (images.pieces.polygons[k] for k in (i, j))
        ]
        inside = common_point(*corners)
        for k in (i, j):
            p, q, r = (near[v] for v in spread(pattern, images.pieces.polygons[k]))
            normal = np.cross(q - p, r - p)
            heights.append(p[2] - (normal[:2] @ (inside - p[:2])) / normal[2])
        found[i, j] = 1 if heights[1] > heights[0] else -1
    return found


def spread(pattern, polygon):
    """Three corners that are not on one line."""
    p, q = polygon[:2]
    a = [float(c) for c in pattern.vertices[p]]
    b = [float(c) for c in pattern.vertices[q]]

    def off(v):
        x, y = (float(c) for c in pattern.vertices[v])
        return abs((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]))

    return p, q, max(polygon, key=off)


def common_point(one, two):
    """The point deepest inside two convex polygons, among mixtures of the corners of one."""
    shares = np.random.default_rng(1).dirichlet(np.ones(len(one)), size=500)
    tried = shares @ one

    def depths(polygon):
        after = np.roll(polygon, -1, axis=0) - polygon
        out = tried[:, None] - polygon
        turn = after[:, 0] * out[..., 1] - after[:, 1] * out[..., 0]
        return (turn * np.sign(turn.sum()) / np.linalg.norm(after, axis=1)).min(axis=1)

    return tried[np.minimum(depths(one), depths(two)).argmax()]


@pytest.mark.slow
def test_the_square_twist_reaches_all_its_states():
    """Four states, by the engine: two ways reach them, each to both sides. The others touch."""
    ends = ends_of("square-twist")
    assert [end.status for end in ends] == [PROVED, *[REFUTED] * 4, PROVED]
    reached_states = [n for end in ends for n in (end.state, end.mirrored) if n is not None]
    assert sorted(reached_states) == [0, 1, 2, 3]
    for end in ends[1:5]:
        assert fold_flat("square-twist", end.letters).status is REFUTED
        assert end.reached.crossing is not None
        assert end.reached.state is None


@pytest.mark.parametrize("name", slow_after(1, ["fish-base", "pinwheel-base"]))
def test_each_way_reaches_a_state_with_its_letters(name):
    ends = [end for end in ends_of(name) if end.status is PROVED]
    assert len(ends) > 3
    for end in ends:
        states = fold_flat(name, end.letters)
        assert states.status is PROVED
        assert end.reached.number_in(states) in range(states.count)
        found = {
            pair: states.state(end.reached.number_in(states)).orders[pair] for pair in states.pairs
        }
        assert found == end.reached.state.orders


@pytest.mark.slow
@pytest.mark.parametrize(("name", "way"), [("square-twist", 1), ("fish-base", 2)])
def test_orders_are_those_of_floats_near_the_end(name, way):
    motion = to_the_end(name, way)
    end = reached(motion)
    assert in_floats(motion, end) == end.state.orders


def test_the_mirrored_motion_reaches_the_reversed_order():
    sheet = miura(2, 2)
    one = follow_panels(sheet, until="180deg", frames=2)
    [mode] = one.modes
    two = follow_panels(sheet, modes=[mode], amounts={mode: -1.0}, until="180deg", frames=2)
    first, second = reached(one), reached(two)
    assert first.status is second.status is PROVED
    assert second.state.orders == {pair: -above for pair, above in first.state.orders.items()}
    assert set(one.assignment.values()) == {"M", "V"}


def test_an_accordion_is_a_stack():
    sheet = strip([2, 2, 2, 2])
    rates = {fold: (-1.0) ** k for k, fold in enumerate(sheet.folds)}
    motion = follow_panels(sheet, amounts=rates, until="180deg", frames=2)
    end = reached(motion)
    assert end.status is PROVED
    assert sorted(end.state.stack((1, 1))) == [0, 1, 2, 3]
    assert end.state.stack((1, 1)) in [(0, 1, 2, 3), (3, 2, 1, 0)]


def test_two_flaps_on_one_panel():
    """At equal angles they pass through each other if they overlap, and else lie side by side."""
    crossed = reached(follow_panels(strip([3, 4, 3]), until="180deg", frames=2))
    assert crossed.status is REFUTED
    assert crossed.crossing == (0, 2)
    assert crossed.reason == (
        "panels 0-2-3-1 and 4-6-7-5 run into each other by 131.82 degrees of the driving folds"
    )
    apart = reached(follow_panels(strip([2, 4, 2]), until="180deg", frames=2))
    assert apart.status is PROVED
    assert set(apart.state.orders) == {(0, 1), (1, 2)}
    over = follow_panels(strip([3, 4, 3]), amounts={(2, 3): 1.0, (4, 5): -1.0}, until="180deg")
    assert reached(over).status is PROVED


@pytest.mark.slow
def test_a_contact_that_floats_miss_is_found_by_heights():
    """Without an event, the crossing at the end refutes by itself."""
    motion = to_the_end("square-twist", 2)
    contacts = prove_contacts(motion)
    blind = replace(contacts, event=None, status=UNDECIDED)
    end = reached(motion, blind)
    assert end.status is REFUTED
    assert end.reason.endswith("pass through each other before the folds close")
    open_end = reached(to_the_end("square-twist", 1), replace(blind, clear=3.0, reason="why"))
    assert (open_end.status, open_end.reason) == (UNDECIDED, "why")


def test_what_is_not_known_is_said():
    with pytest.raises(NotApplicableError, match="not all folds that move are known to close"):
        reached(to_the_end("zigzags", 2))
    ends = ends_of("zigzags")
    assert [end.status for end in ends] == [UNDECIDED, UNDECIDED, REFUTED]
    states = exactfold.flat("square-twist")
    answer = exactfold.decompose("square-twist")
    late = way_ends(answer, states, limit=0.0)
    assert {end.status for end in late} == {UNDECIDED}
    assert "time" in late[0].reason
    doubted = way_ends(answer, replace(states, doubt="rounded"), limit=None)
    assert {(end.status, end.reason) for end in doubted} == {(UNDECIDED, "rounded")}


@pytest.mark.slow
def test_states_of_other_letters_have_no_number():
    drawn = exactfold.flat("windmill", "any")
    ends = way_ends(exactfold.decompose("fish-base"), drawn, limit=None)
    assert {(end.status, end.state, end.mirrored) for end in ends} == {(PROVED, None, None)}


def test_the_drawn_state_may_be_one_to_the_other_side():
    """The letters of a way of the Miura fold are those of the drawing, reversed."""
    sheet, letters = miura(2, 2), {}
    motion = follow_panels(sheet, until="180deg", frames=2)
    for fold, letter in motion.assignment.items():
        letters[fold] = {"M": "V", "V": "M"}[letter]
    end, states = reached(motion), fold_flat(sheet, letters)
    assert end.number_in(states) is None
    assert end.number_in(states, mirrored=True) == 0
