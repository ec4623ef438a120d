"""Sheets far from the origin, and in very large and small units: angles and claims keep digits."""

import math
from fractions import Fraction

import numpy as np
import pytest
from panel_sheets import regular_twist
from sheets import mapped

from exactfold import checker
from exactfold._support.verdict import PROVED
from exactfold.branches import find_branch
from exactfold.motion import (
    certificate_with_contact,
    first_contact,
    follow,
    follow_panels,
    prove_contacts,
)
from exactfold.motion.proving import prove
from exactfold.panels import decompose
from exactfold.pattern import PanelPattern, load

PLAIN = load("two-vertex")
MOVED = {
    "far": (mapped(PLAIN, lambda p: (p[0] + 10**30, p[1] - 10**30)), 1.0),
    "huge": (mapped(PLAIN, lambda p: (p[0] * 10**200, p[1] * 10**200)), 1e200),
    "tiny": (mapped(PLAIN, lambda p: (p[0] / 10**200, p[1] / 10**200)), 1e-200),
}


@pytest.mark.parametrize("name", MOVED)
@pytest.mark.filterwarnings("error")
def test_angles_are_those_of_the_sheet_in_its_place(name):
    sheet, unit = MOVED[name]
    plain, moved = (follow(find_branch(p, "-+"), frames=4) for p in (PLAIN, sheet))
    assert moved.angles == pytest.approx(plain.angles, abs=1e-9)
    assert moved.duration == pytest.approx(plain.duration * unit)
    assert moved.sampled()[1][-1] == pytest.approx(plain.sampled()[1][-1], abs=1e-9)
    # Of the coordinates of the far sheet no digits are left, which is said.
    assert moved.length_error == (1.0 if name == "far" else pytest.approx(0, abs=1e-12))


@pytest.mark.slow
@pytest.mark.parametrize("unit", [Fraction(10**200), Fraction(1, 10**200)])
@pytest.mark.filterwarnings("error")
def test_panels_in_large_and_small_units(unit):
    twist = regular_twist(4, (Fraction(0), Fraction(-3)))
    points = [(x * unit, y * unit) for x, y in twist.vertices]
    sheets = [decompose(sheet) for sheet in (twist, PanelPattern(points, twist.edges))]
    plain, moved = (follow_panels(sheet, frames=3) for sheet in sheets)
    assert moved.angles == pytest.approx(plain.angles, abs=1e-9)
    assert moved.length_error < 1e-12
    found = prove_contacts(follow_panels(sheets[1], until="30deg", frames=2))
    assert (found.status, found.event) == (PROVED, None)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["far", "tiny"])
@pytest.mark.filterwarnings("error")
def test_what_is_proved_of_them(name):
    sheet, unit = MOVED[name]
    branch = find_branch(sheet, "-+")
    claims = checker.check(certificate_with_contact(*first_contact(branch)))
    first, latest = (float(Fraction(time)) for time in claims["contact"]["time"])
    assert 0 < first < latest < first * (1 + 1e-5)
    assert first == pytest.approx(2.17434 * unit, rel=1e-5)
    proof = prove(follow(branch, until="90deg", frames=3))
    assert math.degrees(np.abs(proof.motion.angles).max()) == pytest.approx(90)
    assert max(proof.motion.bounds.radii) < (1e14 if name == "far" else 1e-214)
