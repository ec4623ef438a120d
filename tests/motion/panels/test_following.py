"""Which motions of rigid panels are followed, and where they end."""

import random
from fractions import Fraction
from itertools import combinations
from math import acos, pi, radians

import numpy as np
import pytest
from folding_panels import angle, checked, lengths_kept, strip
from panel_sheets import (
    chicken_wire,
    mesh,
    miura,
    outlined,
    shifted_columns,
    tiling,
)
from scipy.optimize import linprog

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.errors import NotApplicableError, UsageError
from exactfold.motion.panels.followable import panel_modes
from exactfold.motion.panels.following import follow_panels
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern

# --- what is followed ----------------------------------------------------------------------------


def test_ways_begin_with_the_one_with_most_folds():
    result = decompose(miura(2, 2))
    ways = panel_ways(result)
    assert [one.folds for one in ways] == sorted((c.folds for c in ways), reverse=True)
    assert sorted(one.dimension for one in ways) == [1, 1, 1, 2]
    assert follow_panels(result).modes == ways[0].numbers
    both = next(k for k, one in enumerate(ways, 1) if one.dimension == 2)
    motion = checked(follow_panels(result, way=both, until="180deg"))
    assert motion.modes == ways[both - 1].numbers
    assert motion.closes is PROVED


def test_modes_without_a_common_vertex_fold_at_their_own_rates():
    result = decompose(miura(2, 2))
    both = next(one for one in panel_ways(result) if one.dimension == 2)
    first, second = both.numbers
    motion = checked(
        follow_panels(result, modes=both.numbers, amounts={first: -2, second: 1}, until="180deg")
    )
    assert motion.rates == (-1.0, 0.5)
    one, other = (angle(motion, driver) for driver in motion.drivers)
    assert (abs(one), abs(other)) == (pi, pytest.approx(pi / 2))
    alone = follow_panels(result, modes=both.numbers, amounts={second: 1}, until="90deg")
    assert alone.modes == (second,)
    spots = motion.exactly({first: -3, second: Fraction(1, 2)})
    assert lengths_kept(motion.pattern, spots)


def test_a_mirror_image_moves_in_the_mirror():
    pattern = tiling(2, 2)
    mirror = PanelPattern([(-x, y) for x, y in pattern.vertices], pattern.edges)
    motion = follow_panels(pattern, until="100deg", frames=7)
    found = []
    for number in (1, 2):
        for side in (1, -1):
            other = follow_panels(
                mirror, modes=[number], amounts={number: side}, until="100deg", frames=7
            )
            found.append(np.allclose(other.angles, motion.angles, rtol=0, atol=1e-12))
    assert sum(found) == 1
    down = follow_panels(pattern, amounts={motion.modes[0]: -1}, until="100deg", frames=7)
    assert np.allclose(down.coords, motion.coords * [1, 1, -1], rtol=0, atol=1e-12)
    assert np.array_equal(down.angles, -motion.angles)


@pytest.mark.parametrize("pattern", [tiling(2, 2), miura(2, 2), mesh(1, 2, seed=4)])
def test_other_numbers_of_the_vertices_change_nothing(pattern):
    rng = random.Random(3)
    new = list(range(len(pattern.vertices)))
    rng.shuffle(new)
    points = [pattern.vertices[new.index(k)] for k in range(len(new))]
    other = PanelPattern(points, [(new[i], new[j]) for i, j in pattern.edges])

    def motions(sheet, names):
        result = decompose(sheet)
        found = set()
        for mode in panel_modes(result):
            motion = follow_panels(result, modes=[mode.number], until="100deg", frames=4)
            sizes = {
                frozenset(names[v] for v in fold): round(abs(float(x)), 9)
                for fold, x in zip(sheet.folds, motion.angles[2], strict=True)
            }
            found.add(frozenset(sizes.items()))
        return found

    assert motions(pattern, new) == motions(other, list(range(len(new))))


def test_free_folds_fold_by_their_angle():
    pattern = strip([2, 3, 1])
    motion = checked(follow_panels(pattern, until="90deg", frames=3))
    assert motion.modes == ()
    assert motion.closes is PROVED
    assert [angle(motion, fold) for fold in pattern.folds] == pytest.approx([pi / 2, pi / 2])
    first, second = pattern.folds
    motion = follow_panels(pattern, amounts={first: 1, second: -0.5}, until="60deg", frames=3)
    assert angle(motion, second) == pytest.approx(-radians(30))
    assert motion.assignment == {first: "V", second: "M"}


def test_the_panel_that_is_held_does_not_move():
    pattern = miura(2, 2)
    for held in (0, 4, 8):
        motion = checked(follow_panels(pattern, held=held, until="120deg", frames=5))
        corners = list(motion.pinned)
        assert corners == list(pattern.faces[held])
        assert np.allclose(motion.coords[:, corners], motion.coords[0][corners], rtol=0, atol=1e-12)


def test_vertices_with_five_folds_on_a_line_that_closes():
    """A Miura-ori with a diagonal in its middle panel: modes that leave the diagonal flat."""
    pattern = miura(2, 2)
    result = decompose(PanelPattern(pattern.vertices, [*pattern.edges, (5, 10)]))
    assert result.theory == "subspaces"
    assert result.modes == ()
    found = panel_modes(result)
    assert len(found) == 3
    without = decompose(pattern)
    for mode in found:
        assert mode.extends.verdict is PROVED
        motion = checked(follow_panels(result, modes=[mode.number], until="150deg", frames=7))
        assert motion.closes is PROVED
        assert lengths_kept(result.pattern, motion.exactly(Fraction(2, 3)))
        same = [
            other
            for other in panel_modes(without)
            if other.letters == dict(mode.letters)
            or all(mode.letters.get(f) != a for f, a in other.letters.items())
        ]
        assert same
    cone = outlined(
        [(0, 0), (2, 0), (1, 2), (-1, 2), (-2, 0), (-1, -2), (1, -2)],
        [(0, k) for k in range(1, 7)],
        1,
    )
    with pytest.raises(NotApplicableError, match="more than four folds"):
        follow_panels(cone)


# --- where it ends -------------------------------------------------------------------------------


def test_first_contact_of_two_flaps():
    """Two flaps of length 3 at distance 1 meet with their tips: -3 cos t = 1/2."""
    motion = follow_panels(strip([3, 1, 3]))
    assert motion.end == "contact"
    [contact] = motion.events
    low, high = contact.time
    assert low <= high < low + 1e-11
    assert high == pytest.approx(acos(-1 / 6), abs=1e-9)
    assert set(contact.faces) == {motion.pattern.faces[0], motion.pattern.faces[2]}
    short = follow_panels(strip([3, 7, 3]))
    assert short.end == "flat-fold"
    on = follow_panels(strip([3, 1, 3]), until="180deg")
    assert [event.kind for event in on.events] == ["contact", "flat-fold"]
    assert on.events[0].time == contact.time


def meet(one, other):
    """Whether two convex hulls have a common point, by linear programming."""
    n, m = len(one), len(other)
    equal = np.block([[one.T, -other.T], [np.ones(n), np.zeros(m)], [np.zeros(n), np.ones(m)]])
    found = linprog(np.zeros(n + m), A_eq=equal, b_eq=[0, 0, 0, 1, 1])
    return found.status == 0


@pytest.mark.slow
def test_contacts_agree_with_linear_programming():
    """Convex panels without a common corner: separated before the contact, not after it."""
    pattern = tiling(2, 2)
    [contact] = follow_panels(pattern).events
    motion = follow_panels(pattern, until="180deg")
    apart = [
        (one, other) for one, other in combinations(pattern.faces, 2) if set(one).isdisjoint(other)
    ]

    def meeting(time):
        coords = motion.at(time)
        return {(a, b) for a, b in apart if meet(coords[list(a)], coords[list(b)])}

    assert not any(meeting(x * contact.time[0]) for x in np.linspace(0.05, 1 - 1e-6, 25))
    assert meeting(contact.time[1] + 1e-4) == {tuple(sorted(contact.faces))}


def test_motions_end_at_an_angle():
    motion = follow_panels(tiling(2, 2), until="70deg")
    assert motion.end == "angle"
    assert np.abs(motion.angles[-1]).max() == pytest.approx(radians(70), abs=1e-12)
    [event] = motion.events
    assert abs(angle(motion, event.folds[0])) == pytest.approx(radians(70), abs=1e-12)


def test_frames_at_equal_angles_of_a_fold():
    pattern = tiling(2, 2)
    fold = pattern.folds[0]
    motion = checked(follow_panels(pattern, by=fold, frames=11, until="120deg"))
    column = motion.angles[:, pattern.folds.index(fold)]
    assert np.allclose(np.diff(column), column[-1] / 10, rtol=0, atol=1e-12)
    names, rows = motion.table()
    assert names[1] == f"{fold[0]}-{fold[1]}"
    assert np.allclose(np.radians(rows[:, 1]), column)


# --- what cannot be followed ---------------------------------------------------------------------


def test_a_rigid_sheet_is_not_followed():
    with pytest.raises(NotApplicableError, match="rigid - PROVED"):
        follow_panels(chicken_wire(3, 3))


def test_a_mode_that_does_not_fold_is_not_followed():
    result = decompose(shifted_columns(1))
    refuted = [k for k, mode in enumerate(result.modes, 1) if mode.extends.verdict is REFUTED]
    assert refuted
    for number in refuted:
        with pytest.raises(NotApplicableError, match=r"the loop [\d-]+ does not close at order 3"):
            follow_panels(result, modes=[number])
    followed = {k for one in panel_ways(result) for k in one.numbers if one.verdict is PROVED}
    assert followed.isdisjoint(refuted)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"until": "far"}, "give contact, or an angle"),
        ({"until": "200deg"}, "up to 180deg"),
        ({"frames": 1}, "at least 2"),
        ({"way": 9}, "there is no way 9: `count` lists 1 to 4"),
        ({"way": 1, "modes": [1]}, "not both"),
        ({"modes": [7]}, "no mode 7: give numbers from 1 to"),
        ({"modes": [1, 4]}, "cannot fold together: both use vertex"),
        ({"amounts": {17: 1}}, "an amount is given for mode 17"),
        ({"amounts": {(0, 1): 1}}, "not a fold from boundary to boundary"),
        ({"amounts": {}}, "so nothing folds"),
        ({"amounts": {4: float("nan")}}, "give a finite number"),
        ({"held": 9}, "no panel 9 to hold: give a number from 0 to 8"),
        ({"by": (0, 15)}, "no fold 0-15"),
        ({"by": (0, 1)}, "0-1 is an edge of the boundary, not a fold to make equal steps of"),
    ],
)
def test_what_does_not_fit_is_said(options, message):
    with pytest.raises(UsageError, match=message):
        follow_panels(miura(2, 2), **options)


def test_a_fold_that_stays_flat_names_no_frames():
    pattern = strip([3, 7, 3])
    first, second = pattern.folds
    with pytest.raises(UsageError, match="stays flat"):
        follow_panels(pattern, amounts={first: 1}, by=second)
