"""Forged motions of panels: times that are too late or too early, what does not touch."""

from __future__ import annotations

import json
from fractions import Fraction
from itertools import product
from math import atan, pi, sin
from typing import Any

import numpy as np
import pytest
from forge import Document, beyond, refused, stopped, unreadable, verified
from forge import given as fixture
from forge_panel_motions import MOTIONS, at_rest, forged, given, whole

from exactfold import checker
from exactfold.checker.core.intervals import Interval
from exactfold.checker.motion.lengths import GRID, ONE
from exactfold.checker.motion.panels import drive as panel_drive
from exactfold.checker.motion.panels import folding as panel_folding
from exactfold.checker.motion.panels import times as panel_times
from exactfold.checker.motion.panels.cut import cut
from exactfold.checker.motion.panels.drive import DrivenModes
from exactfold.checker.motion.panels.places import Places
from exactfold.checker.motion.panels.series import BITS
from exactfold.checker.motion.panels.times import OneRate, Rates
from exactfold.checker.sheets.panels import read_panels
from exactfold.checker.sheets.scaled import scaled

SLOW = "mixed", "closing", "tiling", "vertex", "miura", "bent"


# --- what is true --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] * (n in SLOW)) for n in MOTIONS]
)
def test_what_is_claimed_is_proved(name: str) -> None:
    claims = verified(whole(name))
    line = checker.summary(claims)
    assert line.startswith("VALID: the panels fold, ")
    low = float(Fraction(claims["clear"]))
    ends = {
        "flaps": "0-2-3-1 and 4-6-7-5 do by ",
        "closing": "the folds are closed by 3.1416 (180.001 degrees)",
    }
    ends["rated"] = ends["flaps"]
    assert "nor later" not in line
    assert ("contact" in claims) == (name in ends)
    if name in ends:
        high = Fraction(claims["contact"]["time"][1])
        assert claims["clear"] == claims["contact"]["time"][0]
        assert low < high < low + 1e-3
        assert ends[name] in line
    else:
        until = {"vertex": pi / 3, "bent": pi / 9, "mixed": pi * 2 / 9}.get(name, pi / 18)
        assert low == pytest.approx(until)


def test_less_may_be_claimed() -> None:
    for name in ("flaps", "closing"):
        document = given(name)
        document["claims"]["contact"]["time"][1] = "4"
        verified(document)
        verified(at_rest(document))


def test_a_fold_that_is_not_named_closes_in_modes_that_are_not_linear() -> None:
    document = at_rest(given("bent"))
    document["claims"]["contact"] = {
        "kind": "flat-fold",
        "time": ["0", "355/113"],
        "faces": [],
        "folds": [],
    }
    assert ", a fold is closed by 3.1416 (180.001 degrees)" in checker.summary(verified(document))
    document["claims"]["contact"]["folds"] = document["claims"]["drivers"]
    stopped(document, "a named fold is not proved to close")


@pytest.mark.parametrize("power", [-130, 130])
def test_the_scale_of_a_sheet_does_not_matter(power: int) -> None:
    """Positions have errors over a fixed denominator, so that the sheet is scaled before."""
    document = fixture("panelmotion-clear")
    time = document["claims"]["clear"]
    vertices = document["pattern"]["vertices"]
    document["pattern"]["vertices"] = [
        [[str(Fraction(text) * Fraction(2) ** power) for text in number] for number in point]
        for point in vertices
    ]
    assert verified(document)["clear"] == time


# --- rates of their own --------------------------------------------------------------------------


def test_flaps_at_two_rates_meet_where_the_end_of_one_is_on_the_other() -> None:
    """The end of the first, 3 (-cos t, sin t) from its fold at x = 3, on the second, from x = 4."""
    document = whole("rated")
    claims = verified(document)
    assert claims["rates"] == ["1", "1/2"]
    low, high = (float(Fraction(t)) for t in claims["contact"]["time"])
    across = [sin(t / 2) + 3 * sin(1.5 * t) for t in (low - 1e-12, high + 1e-12)]
    assert across[0] * across[1] < 0
    assert high - low < 1e-5
    assert ", driven by 2-3, 4-5 at rates of their own; no two" in checker.summary(claims)


def test_rates() -> None:
    message = "a rate is not positive, or the largest rate is not 1"
    for rates in (["1", "2"], ["1", "0"], ["1", "-1/2"], ["1/2", "1/2"]):
        document = at_rest(given("rated"))
        document["claims"]["rates"] = rates
        stopped(document, message)
    document["claims"]["rates"] = ["1"]
    refused(document, "rates does not have 2 entries")
    document = at_rest(given("rated"))
    del document["claims"]["rates"]
    message = "claims: expected an object with the keys assignment drivers"
    refused(document, f"{message} rates clear")
    document = at_rest(given("rated"))
    document["version"] = 1
    refused(document, f"{message} clear")


def test_slower_folds_are_not_closed() -> None:
    document = at_rest(given("rated"))
    closing = {"kind": "flat-fold", "time": ["0", "355/113"], "faces": [], "folds": [[2, 3]]}
    document["claims"]["contact"] = closing
    verified(document)
    closing["folds"] = [[4, 5]]
    stopped(document, "a named fold is not proved to close")
    closing |= {"folds": [], "time": ["0", "314/100"]}
    stopped(document, "the contact may be later than claimed")


def test_no_driver_is_followed_beyond_180_degrees() -> None:
    document = given("flaps")
    document["version"] = 2
    document["claims"]["rates"] = ["1", "1"]
    document["evidence"]["contact"] = 15 << 36
    document["claims"]["contact"]["time"][1] = "4"
    stopped(document, "a parameter is out of range")


def test_cosines_and_sines() -> None:
    """Against those of 1 and 2 to 30 digits, and of an interval that holds both."""
    known = {  # cosine and sine to 30 digits
        1: ("0.54030230586813971740093660744298", "0.8414709848078965066525023216303"),
        2: ("-0.41614683654714238699756822950076", "0.90929742682568169539601986591174"),
    }
    wide = panel_times.cosine_and_sine(Interval(1 << BITS, 2 << BITS, BITS))
    for angle, values in known.items():
        found = panel_times.cosine_and_sine(Interval.of(Fraction(angle), BITS))
        for text, narrow, around in zip(values, found, wide, strict=True):
            value = Fraction(text) * (1 << BITS)
            assert narrow.low < value < narrow.high < narrow.low + (1 << 10)
            assert around.low < value < around.high


# --- false times and contacts --------------------------------------------------------------------


def test_times_that_are_too_late_or_too_early() -> None:
    for name in ("flaps", "closing"):
        high = Fraction(given(name)["claims"]["contact"]["time"][1])

        def later(claims: Document, _: Document) -> None:
            claims["clear"] = claims["contact"]["time"][0] = "134/1000"

        def earlier(claims: Document, _: Document, high: Fraction = high) -> None:
            claims["contact"]["time"][1] = str(high - Fraction(1, 10**9))

        def not_from_there(claims: Document, _: Document) -> None:
            claims["contact"]["time"][0] = "126/1000"

        stopped(forged(name, later), "the clear part of the motion is shorter than claimed")
        stopped(forged(name, earlier), "the contact may be later than claimed")
        message = 'the first "time" of a contact differs from "clear"'
        stopped(forged(name, not_from_there), message)


def test_times_are_arc_tangents() -> None:
    for x in (0.0, 0.1, 0.25, 0.5, 0.625, 0.875, 1 - 2**-30):
        low, high = panel_times.time_of(Fraction(x))
        assert high - low < Fraction(1, 10**24)
        assert abs(float(low) - 2 * atan(x / (1 - x))) < 1e-14
    low, high = panel_times.time_of(Fraction(1))
    digits = Fraction(31415926535897932384626433832795, 10**31)  # of pi, known
    assert low < digits < digits + Fraction(1, 10**31) < high


@pytest.mark.slow
def test_what_is_not_clear_is_refused() -> None:
    document = whole("flaps")
    document["evidence"]["clear"] = document["evidence"]["contact"] + 1
    place = "may touch where the motion is claimed to be clear"
    stopped(document, f"the faces (0, 2, 3, 1) and (4, 6, 7, 5) {place}")


def test_a_mode_that_ends_before_is_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Driven by a fold that closes after another one; beyond that panels run through each other."""
    document = at_rest(given("bent"))
    assert document["claims"]["drivers"] == [[4, 5]]
    document["claims"]["drivers"] = [[4, 7]]
    verified(document)
    document["claims"]["contact"] = {
        "kind": "contact",
        "time": ["0", "4"],
        "faces": [[0, 3, 4, 1], [4, 7, 8, 5]],
        "folds": [],
    }
    document["evidence"]["contact"] = 15 << 36
    refused(document, "no side of one panel is proved to run through the other panel")
    monkeypatch.setattr(panel_drive, "may_be_closed", lambda _: False)
    verified(document)


@pytest.mark.slow
def test_the_motion_of_a_mode_that_ends_before_is_not_clear() -> None:
    document = at_rest(given("bent"))
    document["claims"]["drivers"] = [[3, 4]]
    document["evidence"]["clear"] = (1 << 40) - (1 << 30)
    refused(document, "the panels may touch where the motion is claimed to be clear")


def test_parameters_out_of_range() -> None:
    """The flaps cross beyond 180 degrees as before, on the other side."""

    def past(claims: Document, evidence: Document) -> None:
        evidence["contact"] = 6 << 38
        claims["contact"]["time"][1] = "7"

    stopped(forged("flaps", past), "a parameter is out of range")

    def negative(claims: Document, evidence: Document) -> None:
        evidence["clear"] = -1

    refused(forged("flaps", negative), "a parameter is not a natural number")


def test_what_does_not_touch() -> None:
    def not_yet(claims: Document, evidence: Document) -> None:
        evidence["contact"] -= 1 << 20

    message = "no side of one panel is proved to run through the other panel"
    stopped(forged("flaps", not_yet), message)

    def others(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"][0] = [2, 4, 5, 3]

    stopped(forged("flaps", others), message)

    def at_once(claims: Document, evidence: Document) -> None:
        evidence["contact"] = 0

    refused(forged("flaps", at_once), "malformed: ZeroDivisionError while checking")


def test_what_is_no_panel_or_fold() -> None:
    def no_kind(claims: Document, evidence: Document) -> None:
        claims["contact"]["kind"] = "touch"

    stopped(forged("closing", no_kind), "the contact is of no known kind")

    def with_folds(claims: Document, evidence: Document) -> None:
        claims["contact"]["folds"] = [[2, 3]]

    stopped(forged("flaps", with_folds), "a contact of two faces names folds")

    def no_panel(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"][0] = [0, 2, 3]

    message = "no side of one panel is proved to run through the other panel"
    refused(forged("flaps", no_panel), message)

    def with_faces(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"] = [[0, 2, 3, 1]]

    stopped(forged("closing", with_faces), "a contact at folds that close names faces")

    def other_fold(claims: Document, evidence: Document) -> None:
        claims["contact"]["folds"] = [[0, 2]]

    stopped(forged("closing", other_fold), "a named fold is not proved to close")

    def fold_twice(claims: Document, evidence: Document) -> None:
        claims["contact"]["folds"] = claims["contact"]["folds"][:1] * 2

    stopped(forged("closing", fold_twice), "a fold that closes is named twice")


@pytest.mark.parametrize("corners", [[0, 2, 3, 1, 1], [0, 0, 2, 3, 1], [0, 3, 2, 1], [1, 3, 2, 0]])
def test_a_panel_that_touches_has_each_corner_once_and_in_order(corners: list[int]) -> None:
    def changed(claims: Document, evidence: Document) -> None:
        claims["contact"]["faces"][0] = corners

    document = forged("flaps", changed)
    stopped(document, "no side of one panel is proved to run through the other panel")
    document["claims"]["contact"]["faces"][0] = [3, 1, 0, 2]
    assert "3-1-0-2 and 4-6-7-5 do by" in checker.summary(verified(document))


def test_keys() -> None:
    for name, place, message in (
        (
            "flaps",
            "claims",
            "claims: expected an object with the keys assignment drivers clear contact",
        ),
        ("vertex", "claims", "claims: expected an object with the keys assignment drivers clear"),
        ("vertex", "evidence", "evidence: expected an object with the keys vertices clear"),
        ("flaps", "evidence", "evidence: expected an object with the keys vertices clear contact"),
    ):
        document = given(name)
        document[place]["more"] = 1
        refused(document, message)
    document = given("vertex")
    document["evidence"]["vertices"][0]["more"] = 1
    refused(document, "a vertex: expected an object with the keys vertex radicand densities")
    document = given("flaps")
    document["claims"]["contact"]["more"] = 1
    refused(document, "contact: expected an object with the keys kind time faces folds")
    document = given("flaps")
    document["version"] = 6
    unreadable(json.dumps(document), "version 6 is not known to this checker")
    document = given("vertex")
    document["claims"]["drivers"] = [["a", "b"]]
    refused(document, "a vertex is not a natural number")


def test_the_work_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel_folding, "MOST_TESTS", 100)
    stopped(given("vertex"), beyond("the tests of contacts", 192, 100, "MOST_TESTS"))


# --- where the panels are ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["flaps", "bent", "rated", "mixed", pytest.param("tiling", marks=pytest.mark.slow)]
)
def test_positions_are_those_of_the_frames(name: str) -> None:
    """Against frames in floats, and the boxes against pieces that are a thousand times thinner."""
    motion = MOTIONS[name]()
    document = whole(name)
    sheet, _ = read_panels(document["pattern"])
    before = sheet.points
    _, sheet.points = scaled(sheet)
    i, j = sheet.edges[0]
    sizes = [
        np.hypot(*(c.enclosed(90).low for c in minus(p[j], p[i]))) for p in (sheet.points, before)
    ]
    factor = sizes[0] / sizes[1]
    claims = document["claims"]
    drive = DrivenModes(
        sheet, claims["assignment"], claims["drivers"], document["evidence"]["vertices"]
    )
    rates = claims.get("rates")
    clock = Rates(claims["drivers"], rates) if rates else OneRate()
    places = Places(drive, clock)
    x = Fraction(document["evidence"]["clear"], 1 << 40)
    pieces = [places.piece(x * (1 - Fraction(1, k)), x) for k in (12, 6000)]
    ends = []
    for piece in pieces:
        assert piece is not None
        y = piece.above(x)
        assert y == ONE
        ends.append([sum(column) / ONE for column in piece.columns])
        assert all(error < 1 << GRID - 20 for error in piece.errors)
    off = np.abs(np.array(ends[0]) - ends[1]).max() * ONE
    assert off <= pieces[0].errors[0] + pieces[1].errors[0] + 64
    there = np.array(ends[1]).reshape(-1, 3) / factor
    coords = motion.at(min(float(clock.time(x)[0]), motion.duration))
    held = sheet.panels[places.held]
    assert np.abs(distances(there) - distances(coords)).max() < 1e-8
    flat = np.array([[float(Fraction(c.parts[0])) for c in point] for point in before])
    moved = there[list(held), :2] - (flat - flat[sheet.panels[0][0]])[list(held)]
    assert np.abs(moved).max() < 1e-9


def minus(p: Any, q: Any) -> Any:
    return [a - b for a, b in zip(p, q, strict=True)]


def distances(points: Any) -> Any:
    return np.linalg.norm(points[:, None] - points[None], axis=2)


def test_a_panel_that_passes_a_corner_twice() -> None:
    """A triangle that hangs in a square at one of its corners."""
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (2, 1), (1, 2), (8, 0), (8, 4)]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (4, 5), (0, 5), (1, 6), (6, 7), (2, 7)]
    document = at_rest(given("closing"))
    document["pattern"] = {
        "radicands": [],
        "vertices": [[[str(x)], [str(y)]] for x, y in points],
        "edges": sorted([i, j] for i, j in edges),
    }
    document["claims"] |= {"drivers": [[1, 2]]}
    sheet, _ = read_panels(document["pattern"])
    document["claims"]["assignment"] = "".join("V" if f == (1, 2) else "F" for f in sheet.folds)
    [panel] = [p for p in sheet.panels if len(set(p)) < len(p)]
    stopped(document, f"the panel {panel} passes a corner twice")


def test_panels_are_cut_into_triangles_of_the_same_area() -> None:
    """Also where three corners lie on a line, and where a panel is not convex."""
    points = [(0, 0), (2, 0), (4, 0), (4, 4), (3, 1), (2, 4), (1, 1), (0, 4)]
    document = {
        "radicands": [],
        "vertices": [[[str(x)], [str(y)]] for x, y in points],
        "edges": sorted(sorted((k, (k + 1) % 8)) for k in range(8)),
    }
    sheet, _ = read_panels(document)
    [panel] = sheet.panels
    triangles = cut(sheet, panel)
    areas = [sheet.area(t) for t in triangles]
    assert all(area.sign() > 0 for area in areas)
    assert sum(area.parts[0] for area in areas) == sheet.area(panel).parts[0]
    assert len(triangles) == len(panel) - 2


def test_intervals_hold_products_of_all_signs() -> None:
    for ends in product((-3, -1, 0, 2, 5), repeat=4):
        if ends[0] <= ends[1] and ends[2] <= ends[3]:
            one = Interval(ends[0] << BITS, ends[1] << BITS, BITS)
            two = Interval(ends[2] << BITS, ends[3] << BITS, BITS)
            every = [a * b for a in ends[:2] for b in ends[2:]]
            found = one * two
            assert (found.low >> BITS, found.high >> BITS) == (min(every), max(every))
