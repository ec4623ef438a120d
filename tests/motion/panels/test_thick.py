"""First contacts of plates, and stops: against formulas, exact gains and linear programming."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from math import atan, cos, degrees, pi, radians, sin, tan

import numpy as np
import pytest
from folding_panels import strip
from panel_sheets import mesh, miura
from scipy.optimize import brentq, linprog

import exactfold
from exactfold import checker
from exactfold._support.verdict import PROVED
from exactfold.errors import StuckPlatesError, UsageError
from exactfold.motion import follow_panels, prove_contacts, prove_panels
from exactfold.motion.curves.stops import Stops
from exactfold.motion.panels.motion import sampled_times
from exactfold.motion.panels.places import Placing
from exactfold.motion.panels.reaching import half_tangents
from exactfold.motion.panels.thick import ThickContacts
from exactfold.motion.solid.plates import MIDDLE, VALLEY, Plates, Solid

TENTH, FIFTH = Fraction(1, 10), Fraction(1, 5)


def solid(thickness=FIFTH, hinge=MIDDLE, trim=FIFTH):
    return Solid(thickness, hinge, trim)


def proved(motion):
    """The proved bounds of the first contact, around the one in floats."""
    found = prove_contacts(motion)
    assert found.status is PROVED
    low, high = found.event.time
    assert low == found.clear
    assert low < motion.duration + 1e-12
    return low, high, found.event


@pytest.mark.parametrize("trim", [TENTH, FIFTH])
def test_one_hinge_meets_at_its_limit(trim):
    """A plate of half thickness 1/10: the angle between the panels is 2 arctan(1 / (10 trim))."""
    motion = follow_panels(strip([2, 2]), solid=solid(trim=trim), frames=2)
    low, high, event = proved(motion)
    wanted = pi - 2 * atan(float(TENTH / trim))
    assert low < wanted < high < low + 1e-8
    assert motion.end == event.kind == "contact"
    assert event.folds == motion.pattern.folds
    assert motion.solid.limit("V") == pytest.approx(wanted, abs=1e-15)


def test_hinges_on_the_side_of_valleys_let_a_valley_close_and_a_mountain_not():
    sheet = strip([2, 2])
    made = solid(hinge=VALLEY)
    motion = follow_panels(sheet, solid=made, frames=2)
    found = prove_contacts(motion)
    assert (motion.end, found.status, found.event.kind) == ("flat-fold", PROVED, "flat-fold")
    motion = follow_panels(sheet, solid=made, amounts={sheet.folds[0]: -1.0}, frames=2)
    low, high, _ = proved(motion)
    assert low < pi / 2 < high < low + 1e-8  # thickness and trim are equal


def test_thick_flaps_meet_before_thin_ones():
    """The upper edge of a flap of length 3 and half thickness 1/10, over the middle of the strip:
    1/2 + 3 cos t - sin t / 10 = 0.
    """
    motion = follow_panels(strip([3, 1, 3]), solid=solid(trim=Fraction(2, 5)), frames=2)
    low, high, event = proved(motion)
    wanted = brentq(lambda t: 0.5 + 3 * cos(t) - sin(t) / 10, 1.0, 2.5, xtol=1e-15)
    thin = follow_panels(strip([3, 1, 3]), frames=2).duration
    assert low < wanted < high < low + 1e-6
    assert high < thin - 0.03
    assert set(event.faces) == {motion.pattern.faces[0], motion.pattern.faces[2]}
    assert event.folds == ()


def apart_in_floats(motion, time):
    """Whether linear programming finds no point of two plates, over all pairs of panels."""
    plates = Plates(motion.pattern, motion.solid)
    coords, _ = Placing(motion.pattern, 0).positions(motion.angles_at(np.array([time])))
    there = plates.places(coords)[0]
    owners = np.repeat([panel for panel, _, _ in plates.corners], 2)
    bodies = [there[owners == panel] for panel in range(len(motion.pattern.faces))]
    for k, a in enumerate(bodies):
        for b in bodies[:k]:
            rows = np.zeros((5, len(a) + len(b)))
            rows[:3, : len(a)], rows[:3, len(a) :] = a.T, -b.T
            rows[3, : len(a)] = rows[4, len(a) :] = 1
            if linprog(np.zeros(rows.shape[1]), A_eq=rows, b_eq=[0, 0, 0, 1, 1]).status == 0:
                return False
    return True


@pytest.mark.parametrize("trim", [pytest.param(TENTH, marks=pytest.mark.slow), FIFTH])
def test_a_miura_fold_stops_at_the_limit_of_its_driver(trim):
    """Its driver has the largest angle; all pairs of panels are tried by linear programming."""
    motion = follow_panels(miura(2, 2), solid=solid(trim=trim), frames=2)
    low, high, event = proved(motion)
    wanted = 2 * atan(float(trim / TENTH))
    assert low < wanted < high < low + 1e-6
    assert len(event.folds) == 1
    assert abs(motion.angles_at(np.array([wanted]))).max() == pytest.approx(wanted)
    assert apart_in_floats(motion, wanted - 1e-4)
    assert not apart_in_floats(motion, wanted + 1e-4)


@pytest.mark.slow
def test_a_contact_does_not_depend_on_the_unit_or_on_the_place():
    sheet = miura(1, 2)
    far = type(sheet)([(1000 * x + 7000, 1000 * y - 9000) for x, y in sheet.vertices], sheet.edges)
    one = follow_panels(sheet, solid=solid(), frames=2)
    other = follow_panels(far, solid=solid(1000 * FIFTH, trim=1000 * FIFTH), frames=2)
    assert other.duration == pytest.approx(one.duration, abs=1e-9)
    assert prove_contacts(other).clear == pytest.approx(prove_contacts(one).clear, abs=1e-9)


def test_two_plates_that_only_meet_by_a_wrong_claim():
    motion = follow_panels(strip([2, 2]), solid=solid(), frames=2)
    thick = ThickContacts(motion, motion.solid)
    event, (panel, point) = thick.crossed(motion.duration + 1e-6)
    assert event.faces[0] == motion.pattern.faces[panel]
    prism = next(k for k, owner in enumerate(thick.contacts.plates.panel_of) if owner != panel)
    assert thick.proves(motion.duration + 1e-6, (panel, point), prism)
    assert not thick.proves(motion.duration - 1e-6, (panel, point), prism)
    outside = (point[0], point[1], point[2] + 1)
    assert not thick.proves(motion.duration + 1e-6, (panel, outside), prism)
    assert thick.crossed(motion.duration - 1e-6) is None


@pytest.mark.parametrize("side", [1, -1])
def test_plates_along_a_branch_fold_as_the_sheet_does(side):
    """Against the motion along the branch, when its fold has the angle at which plates meet."""
    plates = Solid(Fraction(1, 1000), "middle", Fraction(1, 1000))
    thick = exactfold.follow("two-vertex", signs="+-", side=side, solid=plates)
    assert (thick.name, thick.end, thick.status) == (
        "branch " + ("+-" if side > 0 else "-+"),
        "contact",
        exactfold.UNDECIDED,
    )
    assert thick.events[-1].folds == ((3, 5),)
    limit = plates.limit("V")
    assert abs(thick.angles[-1]).max() == pytest.approx(limit, abs=1e-6)
    thin = exactfold.follow(
        "two-vertex", signs="+-", side=side, until=f"{math.degrees(limit)}deg", held=(2, 3, 5)
    )
    assert thick.angles[-1] == pytest.approx(thin.angles[-1], abs=1e-6)
    assert thick.pinned == (2, 3, 5)
    assert thick.coords[-1] == pytest.approx(thin.coords[-1], abs=1e-5)
    assert thick.to_dict()["plates"]["thickness"] == "1/1000"


@pytest.mark.parametrize(
    ("sheet", "options", "words"),
    [
        ("waterbomb", {}, "thickness along a branch is followed on sheets with four corners"),
        ("two-vertex", {"by": (3, 5)}, "by does not go with thickness along a branch"),
        ("two-vertex", {"through_branch_points": True}, "going on through branch points does not"),
        ("two-vertex", {"until": "return"}, "until"),
    ],
)
def test_what_plates_along_a_branch_refuse(sheet, options, words):
    with pytest.raises(UsageError, match=words):
        exactfold.follow(sheet, solid=solid(), **options)


def test_plates_that_are_stuck_are_refused():
    with pytest.raises(StuckPlatesError, match="the flat sheet is stuck"):
        follow_panels(miura(2, 2), solid=solid(trim=Fraction(0)))


# --- stops ---------------------------------------------------------------------------------------


def test_the_first_stop_of_a_linear_mode_is_where_its_gain_says():
    """tan(angle / 2) of a fold is its gain times that of the driver, exactly."""
    sheet = miura(2, 2)
    free = follow_panels(sheet, frames=2)
    lengths = {
        (i, j): float(np.hypot(*(float(c) for c in sheet.direction(i, j)))) for i, j in sheet.folds
    }
    size = {e: abs(float(c)) * lengths[e] for e, c in free.ratios.items()}
    largest = max(size.values())
    slow = min(size, key=size.get)
    assert size[slow] < 0.9 * largest
    wanted = 2 * atan(tan(radians(40)) * largest / size[slow])
    motion = follow_panels(sheet, stops=Stops(None, {slow: Fraction(80)}), frames=3)
    assert motion.end == "stop"
    assert motion.duration == pytest.approx(wanted, abs=1e-12)
    proof = prove_panels(motion)
    low, high = proof.stop.time
    assert low < wanted < high < low + 1e-11
    assert proof.status is PROVED
    assert proof.stop.folds == (slow,)
    claims = checker.check(proof.certificate())
    assert claims["stop"]["fold"] == list(slow)
    first, last = (Fraction(t) for t in claims["stop"]["time"])
    assert first < wanted < last < first + Fraction(1, 10**9)


def test_a_stop_of_one_fold_replaces_that_of_all_others():
    sheet = strip([3, 1, 3])
    fold, other = sheet.folds
    stops = Stops(Fraction(30), {fold: Fraction(50)})
    motion = follow_panels(sheet, stops=stops, amounts={fold: 1.0, other: 0.5}, frames=2)
    assert degrees(motion.duration) == pytest.approx(50)
    assert stops.to_dict(sheet.folds) == {"2-3": "50", "4-5": "30"}
    assert stops.text == "all folds 30, 2-3 50 degrees"
    assert motion.to_dict()["stops"] == stops.to_dict(sheet.folds)


def test_the_earlier_of_a_contact_and_a_stop_ends_a_motion():
    sheet = strip([2, 2])
    for angle, end in ((100, "stop"), (140, "contact")):
        motion = follow_panels(sheet, solid=solid(), stops=Stops(Fraction(angle)), frames=2)
        assert motion.end == end
    assert [e.kind for e in motion.events] == ["contact"]
    through = follow_panels(
        sheet, solid=solid(), stops=Stops(Fraction(140)), until="170deg", frames=2
    )
    assert [e.kind for e in through.events] == ["contact", "stop"]


def test_stops_of_modes_that_are_not_linear_are_proved():
    sheet = mesh(1, 1, 1)
    motion = follow_panels(sheet, stops=Stops(Fraction(20)), frames=2)
    proof = prove_panels(motion)
    assert proof.status is PROVED
    assert proof.stop.time[0] < radians(20) < proof.stop.time[1]
    assert checker.check(proof.certificate())["stop"]["angles"][0][2] == "20"


@pytest.mark.slow
def test_a_stop_of_a_family():
    family = exactfold.follow("bird-base", stops=Stops(Fraction(45)), frames=3)
    assert family.end == "stop"
    assert np.abs(family.angles[-1]).max() == pytest.approx(pi / 4, abs=1e-6)


def test_a_stop_of_a_branch():
    branch = exactfold.follow("two-vertex", signs="+-", stops=Stops(Fraction(70)))
    assert branch.end == "stop"
    assert np.abs(branch.angles[-1]).max() == pytest.approx(radians(70), abs=1e-9)
    early = exactfold.follow("two-vertex", signs="+-", until="30deg", stops=Stops(Fraction(70)))
    assert early.end == "angle"


@pytest.mark.parametrize("angle", [0, -5, 180, 200])
def test_angles_of_stops(angle):
    with pytest.raises(UsageError, match="give an angle between 0 and 180"):
        Stops(Fraction(angle))


def test_a_stop_needs_a_fold():
    with pytest.raises(UsageError, match="there is no fold 0-9"):
        follow_panels(strip([2, 2]), stops=Stops(None, {(0, 9): Fraction(30)}))


def test_half_tangents():
    for angle, ball in half_tangents({(0, k): Fraction(k) for k in (1, 90, 179)}).items():
        assert float(ball.mid()) == pytest.approx(tan(radians(angle[1]) / 2), rel=1e-13)
        assert float(ball.rad()) < 1e-30


def test_samples_do_not_change_a_stop():
    sheet = miura(2, 2)
    motion = follow_panels(sheet, frames=2)
    stops = Stops(Fraction(77))
    found = {
        stops.first(sheet.folds, sampled_times(motion.angles_at, pi, n), motion.angles_at).time
        for n in (2, 50, 777)
    }
    assert max(high for _, high in found) - min(low for low, _ in found) < 1e-12
    assert replace(motion, stops=stops).stops == stops
