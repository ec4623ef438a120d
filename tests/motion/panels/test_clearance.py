"""First contacts of panels, proved: against known times, exact positions and bounds made wider."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import acos, atan, nextafter, pi

import numpy as np
import pytest
from flint import arb, ctx, fmpq
from panel_sheets import grid, mesh, miura, tiling

from exactfold import checker
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import count_ways
from exactfold.errors import NotApplicableError
from exactfold.exact.surds import ball
from exactfold.motion import follow_panels, prove_contacts, prove_panels
from exactfold.motion.panels.clearance import PanelPairs, with_proved_contact
from exactfold.motion.panels.contacts import PanelContacts
from exactfold.motion.panels.curves import FollowedCurve
from exactfold.motion.panels.pieces import PanelPieces


def strip(widths):
    """Panels side by side, with a fold from boundary to boundary between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (Fraction(xs[i]), Fraction(2 * j)))


@pytest.fixture(scope="module")
def folding():
    """A sheet all of whose folds close together."""
    return follow_panels(miura(2, 2), frames=3)


def test_two_flaps_meet_where_they_must():
    """Two flaps of length 3 at distance 1 meet with their tips: -3 cos t = 1/2."""
    motion = follow_panels(strip([3, 1, 3]), frames=2)
    found = prove_contacts(motion)
    assert found.status is PROVED
    low, high = found.event.time
    assert found.event.kind == "contact"
    assert low == found.clear
    assert low < acos(-1 / 6) < high < low + 1e-5
    assert set(found.event.faces) == {motion.pattern.faces[0], motion.pattern.faces[2]}
    assert repr(found).startswith("<PanelClearance: proved, clear until 1.7382")


def test_short_flaps_come_down_on_the_panel_between_them():
    motion = follow_panels(strip([3, 7, 3]), frames=2)
    found = prove_contacts(motion)
    assert found.status is PROVED
    assert found.event.kind == "flat-fold"
    assert found.clear == pi  # the float, which is a little less than pi itself
    assert found.event.time == (pi, nextafter(pi, 4))
    assert found.event.folds == motion.pattern.folds


def test_a_motion_to_an_angle_is_clear():
    found = prove_contacts(follow_panels(strip([3, 1, 3]), until="90deg", frames=2))
    assert (found.status, found.event, found.open_panels) == (PROVED, None, ())
    assert found.clear == pytest.approx(pi / 2)
    passed = prove_contacts(follow_panels(strip([3, 1, 3]), until="120deg", frames=2))
    assert passed.status is PROVED
    assert passed.event.time[1] < 1.74


def test_pieces_hold_the_exact_positions(folding):
    """At a rational tangent all positions are numbers of a field."""
    pieces = list(PanelPieces(folding, folding.held).between(0.0, folding.duration))
    assert pieces[0].middle - pieces[0].half == 0
    for one, two in pairwise(pieces):
        assert one.middle + one.half == two.middle - two.half
    assert pieces[-1].middle + pieces[-1].half >= folding.duration
    [driver] = folding.drivers
    a, b = (np.array([float(c) for c in folding.pattern.vertices[v]]) for v in driver)
    corner = folding.pattern.vertices[folding.pinned[0]]
    for parameter in (Fraction(1, 50), Fraction(1, 3), Fraction(7, 5), Fraction(40)):
        near = 2 * atan(parameter * np.linalg.norm(a - b))
        piece = next(p for p in pieces if near < p.middle + p.half)
        spots = folding.exactly(parameter)
        with ctx.workprec(200):
            dx, dy = folding.pattern.direction(*driver)
            length = ball(dx * dx + dy * dy, 200).sqrt()
            s = 2 * (arb(fmpq(parameter.numerator, parameter.denominator)) * length).atan()
            s = s - arb(piece.middle)
            for v, spot in enumerate(spots):
                for axis in range(3):
                    there = ball(spot[axis], 200)
                    if axis < 2:
                        there = there - ball(corner[axis], 200)
                    value = arb(0)
                    for c in piece.coefficients[::-1, v, axis].tolist():
                        value = value * s + arb(c)
                    gap = abs(value - there / arb(piece.unit))
                    assert gap <= arb(float(piece.radius[v, axis]))
        assert piece.radius.max() <= 1e-9


def test_all_panels_of_a_sheet_that_folds_flat_are_apart_until_then(folding):
    found = prove_contacts(folding)
    assert (found.status, found.event.kind) == (PROVED, "flat-fold")
    assert found.clear == pi


def test_pairs_are_those_of_different_panels(folding):
    contacts = PanelContacts(folding.pattern)
    pairs = PanelPairs(contacts, 16.0)
    cut, panel = contacts.cut, contacts.panel_of
    assert len(cut.faces) == 2 * len(folding.pattern.faces)
    known = [tuple(row) for row in (*pairs.apart.tolist(), *pairs.corner.tolist())]
    across = {tuple(sorted((cut.sides[i, j], cut.sides[j, i]))) for i, j in folding.pattern.folds}
    number = len(cut.faces)
    everything = {(i, j) for i in range(number) for j in range(i)}
    assert {tuple(sorted(pair)) for pair in known} | across == {
        tuple(sorted(pair)) for pair in everything if panel[pair[0]] != panel[pair[1]]
    }
    # Folded over, the corners across a fold are where a reflection puts them.
    for (i, j, left, right), closed in zip(pairs.hinges.tolist(), pairs.closed, strict=True):
        p, q, a, b = (
            np.array([float(c) for c in folding.pattern.vertices[v]]) for v in (i, j, left, right)
        )
        u = (q - p) / np.linalg.norm(q - p)
        mirrored = p + 2 * ((b - p) @ u) * u - (b - p)
        assert closed == pytest.approx(((a - mirrored) @ (a - mirrored)) / 16.0**2)


def test_what_is_not_separated_is_named(monkeypatch):
    """With positions known to a quarter of the sheet nothing is proved."""
    motion = follow_panels(strip([3, 1, 3]), until="60deg", frames=2)
    whole = PanelPieces.between

    def wider(self, low, high):
        for piece in whole(self, low, high):
            yield replace(piece, radius=piece.radius + 0.1)

    monkeypatch.setattr(PanelPieces, "between", wider)
    found = prove_contacts(motion)
    assert found.status is UNDECIDED
    assert (found.clear, found.event) == (0.0, None)
    faces = motion.pattern.faces
    assert (faces[0], faces[2]) in found.open_panels
    assert found.reason == "some panels are proved neither to stay apart nor to touch"


def test_the_event_of_a_motion_is_replaced_by_the_proved_one():
    motion = follow_panels(strip([3, 1, 3]), until="180deg", frames=2)
    proved, found = with_proved_contact(motion)
    assert [event.kind for event in proved.events] == ["contact", "flat-fold"]
    assert proved.events[0] == found.event
    assert proved.events[1] == motion.events[1]
    clear = follow_panels(strip([3, 1, 3]), until="60deg", frames=2)
    assert with_proved_contact(clear)[0] is clear


def test_a_motion_that_is_not_proved_to_exist_is_refused():
    motion = follow_panels(mesh(1, 1, seed=1), until="10deg", frames=2)
    assert (motion.closes, motion.exists) == (UNDECIDED, PROVED)
    [curve] = motion.curves
    mode = replace(curve.mode, extends=replace(curve.mode.extends, verdict=UNDECIDED))
    unknown = replace(motion, curves=(FollowedCurve(mode),))
    with pytest.raises(NotApplicableError, match="not proved to exist"):
        prove_contacts(unknown)


@pytest.mark.parametrize("sheet", [mesh(1, 1, seed=1), tiling(2, 2)])
def test_pieces_of_modes_that_are_not_linear_hold_the_positions_in_floats(sheet):
    """These come from other formulas of the roots, and are placed as matrices of floats."""
    motion = follow_panels(sheet, until="60deg", frames=7)
    assert motion.closes is UNDECIDED
    pieces = PanelPieces(motion, motion.held)
    corner = np.array([float(c) for c in sheet.vertices[motion.pinned[0]]] + [0.0])
    for time, coords in zip(motion.times[1:].tolist(), motion.coords[1:], strict=True):
        piece = pieces.around(time)
        assert abs(piece.coefficients[0] * piece.unit + corner - coords).max() < 1e-12


def test_a_mode_that_is_not_linear_is_clear_until_its_first_fold_closes():
    motion = follow_panels(mesh(1, 1, seed=1), frames=2)
    proved, found = with_proved_contact(motion)
    assert (found.status, found.event.kind) == (PROVED, "flat-fold")
    assert pi - 1e-3 < found.clear < pi
    assert found.event.folds == ()  # some fold is closed by then; floats say which
    [event] = [event for event in proved.events if event.kind == "flat-fold"]
    assert (event.time, event.folds) == (found.event.time, motion.drivers)
    assert PanelPieces(motion).around(3.15) is None


def test_strips_that_fold_up_together_meet_at_120_degrees():
    """Two outer strips of equal width fold over the middle one until they meet edge to edge."""
    motion = follow_panels(count_ways("zigzags"), way=3, frames=2)
    found = prove_contacts(motion)
    assert found.status is PROVED
    low, high = found.event.time
    assert low < 2 * pi / 3 < high < low + 1e-6
    [contact] = [event for event in motion.events if event.kind == "contact"]
    assert low <= contact.time[1] <= high


def test_one_fold_is_clear_until_it_closes():
    proof = prove_panels(follow_panels(strip([2, 3]), frames=2))
    assert (proof.status, proof.contacts.event.kind) == (PROVED, "flat-fold")
    claims = checker.check(proof.certificate())
    assert claims["closed"] == [[2, 3]]
    assert "contact" not in claims


@pytest.mark.survey
def test_a_large_sheet_that_folds_flat_is_apart_until_then():
    motion = follow_panels(miura(4, 5), frames=2)
    found = prove_contacts(motion)
    assert found.status is PROVED
    assert found.clear > pi - 1e-6
    assert found.event.folds == motion.pattern.folds
