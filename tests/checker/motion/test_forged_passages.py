"""Forged certificates of motions through a branch point: another one, none, or contacts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from forge import Document, refused, verified, without
from forge_motions import pieces_once

from exactfold import checker
from exactfold.branches.counting.find import find_branch
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.motion import contacts as motion_contacts
from exactfold.checker.motion.contacts import check_contacts
from exactfold.checker.motion.lengths import Arc, stretches_of
from exactfold.checker.motion.tubes import Ball
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import ContactWatch
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern.triangulating.random_squares import random_square

SIGNS, FLAT = "-+--+", 6
MAY_TOUCH = r"^the (faces|faces at) .* may touch where the motion is claimed to be clear$"


@cache
def _text() -> str:
    branch, watch = find_branch(random_square(5, seed=4), SIGNS), ContactWatch()
    track = follow_proved(branch, until=0.65, stop=watch, through_branch_points=True)
    return json.dumps(certificate_with_contact(track, watch.result(track)))


@pytest.fixture(autouse=True, scope="module")
def _pieces_once() -> Iterator[None]:
    with pieces_once():
        yield


def given() -> Document:
    """A fresh copy of the certificate of a motion that is clear beyond its branch point."""
    document: Document = json.loads(_text())
    return document


def arc_of(document: Document) -> Document:
    """The arc among its steps."""
    [found] = [step for step in document["evidence"]["tubes"] if "flat" in step]
    return dict(found)


def pieces() -> tuple[Any, ...]:
    """What `check_contacts` is given: start, tau, steps, claims, evidence."""
    found: list[tuple[Any, ...]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_contacts, "check_contacts", lambda *all_: found.append(all_))
        verified(given())
    return found[0]


def test_what_is_claimed_is_proved() -> None:
    claims = verified(given())
    assert claims["through"] == [[FLAT]]
    assert Fraction(claims["clear"]) > Fraction("0.65")
    said = checker.summary(claims)
    assert (
        f" or more, through a branch point where vertex {FLAT} is flat; no two faces touch" in said
    )
    steps = given()["evidence"]["tubes"]
    assert f"; {len(steps) - 1} tubes; sha256" in said  # the arc through the branch point is none


@pytest.mark.slow
def test_the_nodes_that_are_passed_are_claimed() -> None:
    for through, message in (
        (None, "a motion passes branch points and claims none, or the other way round"),
        ([], "the motion passes other branch points than those claimed"),
        ([[5]], "the motion passes other branch points than those claimed"),
        ([[FLAT], [FLAT]], "the motion passes other branch points than those claimed"),
        ([[str(FLAT)]], "flat vertex is not a natural number"),
    ):
        forged = given()
        forged["claims"]["through"] = through
        if through is None:
            del forged["claims"]["through"]
        refused(forged, message)
        if message.startswith("the motion passes other"):
            with without(message):
                verified(forged)
    forged = given()
    passed = [step for step in forged["evidence"]["tubes"] if "flat" not in step]
    forged["evidence"]["tubes"] = passed[:1]
    del forged["claims"]["clear"], forged["evidence"]["contacts"]
    passed[0]["exit"] = 1 << 37
    forged["claims"]["length"] = "0"
    for through in ([], [[FLAT]]):
        forged["claims"]["through"] = through
        refused(forged, "a motion passes branch points and claims none, or the other way round")


@pytest.mark.slow
def test_an_arc_goes_through_its_node() -> None:
    """Else the motion might turn back before the branch point, or not reach it."""
    message = "an arc does not go through its branch point"
    forged = given()
    arc = next(step for step in forged["evidence"]["tubes"] if "flat" in step)
    k = forged["evidence"]["tubes"].index(arc)
    del forged["evidence"]["tubes"][k + 1 :]
    del forged["claims"]["clear"], forged["evidence"]["contacts"]
    forged["claims"]["length"] = "0"
    verified(forged)
    for end in (0, arc["entry"], arc["entry"] // 2):
        arc["exit"] = end
        refused(forged, message)
        with without(message):
            verified(forged)


@pytest.mark.slow
def test_a_motion_does_not_end_at_a_node_that_it_has_passed() -> None:
    """Its arc, met after the branch point, leads away from it (checker/motion/nodes.py)."""
    message = "an arc does not lead to its branch point"
    forged = given()
    steps = forged["evidence"]["tubes"]
    k = next(k for k, step in enumerate(steps) if "flat" in step)
    del steps[k + 2 :], steps[k + 1]["exit"]
    del forged["claims"]["clear"], forged["evidence"]["contacts"]
    forged["claims"] |= {"node": {"flat": [FLAT], "clear": False}, "length": "0"}
    node = {key: steps[k][key] for key in ("node", "centre", "row", "reach")}
    forged["evidence"]["node"] = {**node, "entry": steps[k]["exit"] * 17 // 16}
    refused(forged, message)
    with without(message):
        verified(forged)


@pytest.mark.slow
def test_contacts_are_looked_for_on_the_arc() -> None:
    start, tau, steps, claims, contacts = pieces()
    [k] = [k for k, step in enumerate(steps) if isinstance(step, Arc)]
    assert contacts["tube"] > k + 1
    check_contacts(start, tau, steps, claims, contacts)
    arc, begin, end = steps[k]
    assert begin < 0 < end
    vague: Any = type(
        "Vague", (), {"branch_point": arc.branch_point, "curve": arc.curve, "bits": arc.bits}
    )()
    box, rate = arc.configuration(begin)
    wide = Ball(box.centre, [r + (1 << arc.bits - 2) for r in box.radii])
    vague.configuration = lambda s: (wide, rate)

    def stretches(_: Any, __: Any, some: list[Any]) -> list[Any]:
        found = stretches_of(start, tau, steps[: len(some)])
        if len(some) > k:
            found[k + 1] = stretches_of(start, tau, [Arc(vague, begin, end)])[-1]
        return found

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_contacts, "stretches_of", stretches)
        with pytest.raises(CertificateError, match=MAY_TOUCH):
            check_contacts(start, tau, steps, {**claims, "clear": "0"}, contacts)
        before = {"tube": k, "clear": 0}
        check_contacts(start, tau, steps, {**claims, "clear": "0"}, before)


@pytest.mark.slow
def test_the_parts_of_a_motion_through_a_node_join() -> None:
    """The arc is passed from where it is met to where the next tube is entered."""
    start, tau, steps, _, _ = pieces()
    [k] = [k for k, step in enumerate(steps) if isinstance(step, Arc)]
    arc, begin, end = steps[k]
    found = stretches_of(start, tau, steps)
    before, part, after = found[k : k + 3]
    assert (before.first, before.last) == steps[k - 1].tube.met(*arc.configuration(begin))
    assert (part.low, part.high, part.first, part.last) == (begin, begin, end, end)
    low, high = steps[k + 1].tube.met(*arc.configuration(end))
    assert (after.low, after.high) == (low, high)
    unit = Fraction(1, 1 << arc.bits)
    for m in range(9):
        s = begin + (end - begin) * Fraction(m, 8)
        x = Fraction(part.path.below(s), 1 << 60)
        assert -1 <= x <= 1
        box, _ = arc.configuration(s)
        for i, column in enumerate(part.path.columns):
            q = sum(c * x**p for p, c in enumerate(column))
            assert abs(q / (1 << 60) - box.centre[i] * unit) < Fraction(1, 10**15)
            assert part.path.errors[i] * Fraction(1, 1 << 60) >= box.radii[i] * unit
    shortest, longest = part.length()
    ends = [arc.configuration(s)[0].centre for s in (begin, Fraction(0), end)]
    chord = sum(
        sum((a - b) ** 2 for a, b in zip(*two, strict=True)) ** 0.5 for two in (ends[:2], ends[1:])
    ) / (1 << arc.bits)
    assert chord * 0.99999 < shortest <= longest < chord * 1.1
