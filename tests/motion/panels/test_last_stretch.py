"""The last stretch before all folds close: positions by another formula, and panels that meet."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import atan, inf, pi, sqrt

import numpy as np
import pytest
from folding_panels import strip
from panel_sheets import miura

import exactfold
from exactfold._support.verdict import PROVED
from exactfold.motion import follow_panels, prove_contacts
from exactfold.motion.panels.clearance import PanelPairs
from exactfold.motion.panels.contacts import PanelContacts
from exactfold.motion.panels.last_stretch import LastStretch


@pytest.fixture(scope="module")
def folding():
    return follow_panels(miura(2, 3), until="180deg", frames=3)


def pairs_of(motion):
    return PanelPairs(PanelContacts(motion.pattern), 1.0)


def test_positions_are_those_of_the_motion_with_heights_in_proportion(folding):
    """Up to one factor for x and y and one for heights, at angles between 90 and 180 degrees."""
    stretch = LastStretch(folding)
    held = stretch._placing.held
    length = 2.0**-7
    coefficients, radius = stretch.positions(length)
    factors = []
    for square in (2.0**-20, 0.001, 0.003, length):
        time = 2 * atan(1 / sqrt(square))
        moved = replace(folding, held=held)
        real = moved._positions(time) - moved._positions(0)[folding.pattern.faces[held][0]]
        real[:, 2] /= sqrt(square)
        powers = (square - length / 2) ** np.arange(len(coefficients))
        found = np.einsum("k,kvc->vc", powers, coefficients)
        sizes = np.abs(real).max(axis=0)
        factors.append(np.abs(found).max(axis=0) / sizes)
        assert found == pytest.approx(real * factors[-1], abs=1e-9)
    assert np.ptp(factors, axis=0) == pytest.approx(0, abs=1e-9)
    assert radius.max() < 1e-12


def test_mirrored_motions_are_clear_for_the_same_time(folding):
    other = follow_panels(
        miura(2, 3),
        until="180deg",
        frames=3,
        modes=[folding.modes[0]],
        amounts={folding.modes[0]: -1.0},
    )
    times = [LastStretch(one).clear_from(pairs_of(one))[0] for one in (folding, other)]
    assert times[0] == times[1] < 3


def test_a_shorter_stretch_is_clear_where_floats_see_no_contact(folding):
    """The distance of the closest corners without a common panel is positive until the end."""
    found = prove_contacts(folding)
    assert (found.status, found.clear) == (PROVED, pi)
    assert found.event.time == (pi, np.nextafter(pi, inf))


@pytest.mark.parametrize("way", [1, 2])
def test_flaps_that_meet_at_the_last_moment(way):
    """The edges of the fish base fold to its diagonal, from both sides."""
    motion = exactfold.follow("fish-base", way, until="180deg", frames=3)
    stretch = LastStretch(motion)
    pairs = pairs_of(motion)
    time, left = stretch.clear_from(pairs)
    assert time < pi
    assert not left
    # Two of the flaps lie on the same line in the end.
    ends = stretch._images
    met = [v for v in range(len(ends)) if ends[v][0] + ends[v][1] == ends[0][0] + ends[0][1]]
    assert {0, 1, 2, 3} <= set(met)
    assert prove_contacts(motion).clear == pi


def test_panels_that_pass_through_each_other_are_never_clear():
    """Of the square twist, four ways run into contact at 172 degrees."""
    motion = exactfold.follow("square-twist", 2, until="180deg", frames=3)
    time, left = LastStretch(motion).clear_from(pairs_of(motion))
    assert time == inf
    assert left
    found = prove_contacts(motion)
    assert found.event.kind == "contact"
    assert found.event.time[1] < time


def test_flaps_of_one_length_touch_before_they_are_closed():
    """Their tips are in one vertical plane at the end, but they get there over the middle panel."""
    motion = follow_panels(strip([1, 2, 1]), until="180deg", frames=3)
    stretch = LastStretch(motion)
    time, _ = stretch.clear_from(pairs_of(motion))
    assert time < pi
    short = follow_panels(strip([3, 5, 3]), until="180deg", frames=3)
    assert LastStretch(short).clear_from(pairs_of(short))[0] == inf


def test_it_applies_only_where_all_folds_close_together():
    assert not LastStretch(exactfold.follow("zigzags", 2, frames=3)).applies
    assert not LastStretch(exactfold.follow("square-twist", 1, until="90deg", frames=3)).applies
    miura_motion = exactfold.follow("miura", 8, until="180deg", frames=3)
    assert LastStretch(miura_motion).applies
    slow = {miura_motion.modes[0]: 1.0, miura_motion.modes[1]: Fraction(1, 2)}
    other = exactfold.motion.follow_panels(
        exactfold.decompose("miura"), modes=list(slow), amounts=slow, until="180deg", frames=3
    )
    assert not LastStretch(other).applies
