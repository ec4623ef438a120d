"""Forged certificates of motions to a branch point: another one, or contacts before it."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from forge import Document, beyond, refused, verified, with_one_key_more, without
from forge_motions import pieces_once

from exactfold import checker
from exactfold.branches.counting.find import find_branch
from exactfold.checker.core.reading import CertificateError, shown
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion import contacts as motion_contacts
from exactfold.checker.motion.contacts import check_contacts
from exactfold.checker.motion.lengths import Arc, stretches_of
from exactfold.checker.motion.tubes import Ball
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import first_contact
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern.triangulating.random_squares import random_square

SIGNS, FLAT = "-+--+", 6
MAY_TOUCH = r"^the (faces|faces at) .* may touch where the motion is claimed to be clear$"


@cache
def _text() -> str:
    branch = find_branch(random_square(5, seed=4), SIGNS)
    return json.dumps(certificate_with_contact(*first_contact(branch)))


def given() -> Document:
    """A fresh copy of the certificate of a motion that is clear up to its branch point."""
    document: Document = json.loads(_text())
    return document


@pytest.fixture(autouse=True, scope="module")
def _pieces_once() -> Iterator[None]:
    with pieces_once():
        yield


def stopped(message: str, change: Callable[[Document], None]) -> None:
    """Refused with this message, and accepted with the line that says so taken out."""
    forged = given()
    change(forged)
    refused(forged, message)
    with without(message):
        verified(forged)


def longer(text: str, factor: str) -> str:
    return str(Fraction(text) * Fraction(factor))


def test_what_is_claimed_is_proved() -> None:
    claims = verified(given())
    assert claims["node"] == {"flat": [FLAT], "clear": True}
    line = checker.summary(claims)
    assert f" or more, to a branch point where vertex {FLAT} is flat; " in line
    when = f"which is at {shown(claims['clear'])} or later"
    assert f"; no two faces touch before the branch point, {when}, nor at it; " in line
    assert "to a branch point where vertices 5 and 7 are flat;" in motion.summary(
        {**claims, "node": {"flat": [5, 7], "clear": False}}
    )


@pytest.mark.slow
def test_less_may_be_claimed() -> None:
    document = given()
    document["claims"]["node"]["clear"] = False
    document["evidence"]["contacts"]["clear"] = document["evidence"]["node"]["entry"]
    document["claims"]["clear"] = longer(document["claims"]["clear"], "1/2")
    assert "nor at it" not in checker.summary(verified(document))
    document["evidence"]["contacts"] = {"tube": len(document["evidence"]["tubes"]), "clear": 0}
    verified(document)
    del document["claims"]["clear"], document["evidence"]["contacts"]
    assert "touch" not in checker.summary(verified(document))


# --- keys ----------------------------------------------------------------------------------------


def test_keys() -> None:
    for place, message in (
        (
            ("claims",),
            "claims: expected an object with the keys vertex_signs side length node clear",
        ),
        (
            ("evidence",),
            "evidence: expected an object with the keys emptied pinned bits start tubes "
            "node contacts",
        ),
        (("claims", "node"), "node: expected an object with the keys flat clear"),
        (
            ("evidence", "node"),
            "node: expected an object with the keys node centre row reach entry",
        ),
        (("evidence", "tubes", -1), "tube: expected an object with the keys centre row reach"),
        (("evidence", "tubes", 0), "tube: expected an object with the keys centre row reach exit"),
    ):
        refused(with_one_key_more(given(), place), message)


def test_a_node_is_claimed_with_its_evidence() -> None:
    forged = given()
    del forged["claims"]["node"]
    names = "evidence: expected an object with the keys emptied pinned bits start tubes"
    refused(forged, f"{names} contacts")
    forged = given()
    del forged["evidence"]["node"]
    refused(forged, f"{names} node contacts")


@pytest.mark.slow
def test_numbers() -> None:
    size = len(given()["evidence"]["node"]["node"])
    for key, value, message in (
        ("node", [], f"node does not have {size} entries"),
        ("centre", None, "centre is not a list"),
        ("row", [1 << 124] * size, "a number of the row is out of range"),
        ("reach", 0, "the reach is out of range"),
        ("entry", None, "None is not an integer"),
        ("entry", True, "True is not an integer"),
        ("entry", -(1 << 60), "a motion leaves a tube beyond its reach"),
    ):
        forged = given()
        forged["evidence"]["node"][key] = value
        refused(forged, message)
    forged = given()
    forged["evidence"]["tubes"] = [None] * 4090
    refused(forged, beyond("the tubes", 4106, 4096, "MOST_TUBES"))


# --- the branch point
# ------------------------------------------------------------------------------------


def test_other_vertices_are_not_flat() -> None:
    inner = "the flat vertices of a branch point are none, or not sorted interior vertices"
    flat: Any
    for flat, message in (
        ([], inner),
        ([FLAT, FLAT], inner),
        ([0], inner),
        ([99], inner),
        ([str(FLAT)], "flat vertex is not a natural number"),
        (None, "flat is not a list"),
    ):
        forged = given()
        forged["claims"]["node"]["flat"] = flat
        refused(forged, message)
    others = [v for v in random_square(5, seed=4).interior if v != FLAT]
    for v in others:
        forged = given()
        forged["claims"]["node"]["flat"] = [v]
        with pytest.raises(CertificateError):
            verified(forged)


@pytest.mark.slow
def test_another_node_is_refused() -> None:
    forged = given()
    forged["evidence"]["node"]["node"][0] += 1 << 60
    with pytest.raises(CertificateError):
        verified(forged)
    forged = given()
    at = forged["evidence"]["node"]
    for key in ("node", "centre", "row"):  # the mirror image
        at[key] = [-x if k % 3 == 2 else x for k, x in enumerate(at[key])]
    with pytest.raises(CertificateError, match=r"^a motion (enters|does not enter)"):
        verified(forged)


@pytest.mark.slow
def test_an_arc_that_leaves_its_node() -> None:
    """The arc reversed: its point on the tube comes after the branch point."""
    forged = given()
    at = forged["evidence"]["node"]
    at["centre"], at["row"] = ([-x for x in at[key]] for key in ("centre", "row"))
    at["entry"] *= -1
    refused(forged, "a motion may enter a tube backwards")
    for entry in (0, 1, 1 << 20):  # at the branch point and beyond it
        forged = given()
        forged["evidence"]["node"]["entry"] = entry
        refused(forged, "a motion enters a tube beyond its reach")


@pytest.mark.slow
def test_the_arc_begins_on_the_last_tube() -> None:
    forged = given()
    del forged["evidence"]["tubes"][-1]
    del forged["evidence"]["tubes"][-1]["exit"]
    with pytest.raises(CertificateError, match=r"^a motion (enters|does not enter)"):
        verified(forged)
    forged["evidence"]["tubes"] = []
    refused(forged, "a motion meets a branch point, or lands, where it is on no tube")
    forged = given()
    forged["evidence"]["node"]["entry"] += 1 << 36  # nearer to the branch point, beyond the tube
    with pytest.raises(CertificateError, match=r"^a motion (enters|does not enter)"):
        verified(forged)


@pytest.mark.slow
def test_the_length_is_that_up_to_the_node() -> None:
    forged = given()
    length = Fraction(forged["claims"]["length"])
    forged["claims"]["length"] = str(length * Fraction(10001, 10000))
    refused(forged, "the motion is shorter than claimed")
    # Up to the arc it is much shorter than claimed.
    start, tau, steps, _, _ = pieces()
    most = sum((s.length()[1] for s in stretches_of(start, tau, steps)[:-1]), Fraction(0))
    assert most * start.equations.unit < length


# --- contacts ------------------------------------------------------------------------------------


def test_clear_is_true_or_false() -> None:
    message = "clear is not true or false"
    stopped(message, lambda forged: forged["claims"]["node"].update(clear=1))
    stopped(message, lambda forged: forged["claims"]["node"].update(clear=None))


def test_clear_up_to_the_node_is_shown() -> None:
    message = "the motion is not shown to be clear up to its branch point"

    def before(forged: Document) -> None:
        forged["evidence"]["contacts"]["clear"] = -1
        forged["claims"]["clear"] = longer(forged["claims"]["clear"], "99/100")

    def on_the_tube(forged: Document) -> None:
        forged["evidence"]["contacts"] = {"tube": len(forged["evidence"]["tubes"]), "clear": 0}
        forged["claims"]["clear"] = "0"

    def nothing(forged: Document) -> None:
        del forged["claims"]["clear"], forged["evidence"]["contacts"]

    for change in (before, on_the_tube, nothing):
        stopped(message, change)


def test_the_time_that_is_clear_is_at_most_that_of_the_node() -> None:
    def later(forged: Document) -> None:
        forged["claims"]["clear"] = longer(forged["claims"]["clear"], "1.00001")

    stopped("the clear part of the motion is shorter than claimed", later)


@pytest.mark.slow
def test_there_is_nothing_beyond_the_node() -> None:
    for parameter in (1, 1 << 30, given()["evidence"]["node"]["entry"] - 1):
        forged = given()
        forged["evidence"]["contacts"]["clear"] = parameter
        refused(forged, "the motion is not shown to be clear up to its branch point")
        forged["claims"]["node"]["clear"] = False
        refused(forged, 'the parameter "clear" is out of range')
    forged = given()
    forged["evidence"]["contacts"]["tube"] += 1
    refused(forged, "the motion is not shown to be clear up to its branch point")
    forged["claims"]["node"]["clear"] = False
    refused(forged, "the contacts name a tube that does not exist")


def pieces() -> tuple[Any, ...]:
    """What `check_contacts` is given: start, tau, steps, claims, evidence."""
    found: list[tuple[Any, ...]] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_contacts, "check_contacts", lambda *all_: found.append(all_))
        verified(given())
    return found[0]


def test_faces_that_may_touch_on_the_arc() -> None:
    """A branch point that may be anywhere: only the arc is not clear then."""
    start, tau, steps, claims, contacts = pieces()
    check_contacts(start, tau, steps, claims, contacts)
    arc, begin, end = steps[-1]
    known = {"branch_point": arc.branch_point, "curve": arc.curve, "bits": arc.bits}
    vague = type("Vague", (), known)()
    box, rate = arc.configuration(begin)
    wide = Ball(box.centre, [r + (1 << arc.bits - 2) for r in box.radii])
    vague.configuration = lambda s: (wide, rate)

    def stretches(_: Any, __: Any, some: list[Any]) -> list[Any]:
        """The tube is left where the true arc begins."""
        found = stretches_of(start, tau, steps)
        found[-1] = stretches_of(start, tau, [Arc(vague, begin, end)])[-1]
        return found[: len(some) + 1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(motion_contacts, "stretches_of", stretches)
        with pytest.raises(CertificateError, match=MAY_TOUCH):
            check_contacts(start, tau, steps, claims, contacts)
        before = {"tube": len(steps) - 1, "clear": 0}
        check_contacts(start, tau, steps, claims | {"clear": "0"}, before)


def test_the_last_tube_is_clear_up_to_the_arc() -> None:
    """The stretch of the last tube ends where the arc may begin, not before."""
    start, tau, steps, _, _ = pieces()
    arc, begin, _ = steps[-1]
    *_, tube, last = stretches_of(start, tau, steps)
    low, high = steps[-2].tube.met(*arc.configuration(begin))
    assert (tube.first, tube.last) == (low, high)
    assert tube.high < low < high < tube.most == steps[-2].tube.reach
    assert last.low == last.high == last.least == begin
    assert [last.first, last.last, last.most] == [0, 0, 0]


def test_positions_on_the_arc_are_those_of_its_configurations() -> None:
    start, tau, steps, _, _ = pieces()
    arc, begin, _ = steps[-1]
    path = stretches_of(start, tau, steps)[-1].path
    unit = Fraction(1, 1 << arc.bits)
    for k in range(9):
        s = begin * Fraction(k, 8)
        x = Fraction(path.below(s), 1 << 60)
        assert -1 <= x <= 0
        box, _ = arc.configuration(s)
        for i, column in enumerate(path.columns):
            q = sum(c * x**m for m, c in enumerate(column))
            assert abs(q / (1 << 60) - box.centre[i] * unit) < Fraction(1, 10**15)
            assert path.errors[i] * Fraction(1, 1 << 60) >= box.radii[i] * unit
    shortest, longest = stretches_of(start, tau, steps)[-1].length()
    ends = [arc.configuration(s)[0].centre for s in (begin, Fraction(0))]
    chord = sum((a - b) ** 2 for a, b in zip(*ends, strict=True)) ** 0.5 / (1 << arc.bits)
    assert chord * 0.99999 < shortest <= longest < chord * 1.1


@pytest.mark.slow
def test_a_motion_through_the_paper_is_not_clear_up_to_its_node() -> None:
    document = follow_proved(find_branch(random_square(5, seed=0), "++++-")).certificate()
    assert document["claims"]["node"] == {"flat": [5, 7], "clear": False}
    verified(document)
    document["claims"]["node"]["clear"] = True
    document["claims"]["clear"] = "1/2"
    document["evidence"]["contacts"] = {"tube": len(document["evidence"]["tubes"]) + 1, "clear": 0}
    with pytest.raises(CertificateError, match=MAY_TOUCH):
        verified(document)
    document["claims"]["node"]["flat"] = [7, 5]
    refused(
        document, "the flat vertices of a branch point are none, or not sorted interior vertices"
    )
