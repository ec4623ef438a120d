"""Forged motions of panels that are claimed to be clear until all folds close together."""

from __future__ import annotations

import json
from fractions import Fraction
from functools import cache
from math import pi

import pytest
from forge import Document, refused, stopped, verified
from forge_panel_motions import given, strip

import exactfold
from exactfold import checker
from exactfold.checker.core.intervals import Interval
from exactfold.checker.motion.panels.closing import LastStretch
from exactfold.checker.motion.panels.folding import Folding
from exactfold.checker.motion.panels.series import BITS
from exactfold.checker.motion.panels.turning import turn_for
from exactfold.checker.sheets.panels import read_panels
from exactfold.motion import follow_panels, prove_panels

_EARLY = 1 << 39
"""The parameter at 90 degrees."""


def flaps(middle: int) -> object:
    """Two flaps of length 2 that fold over a panel between them."""
    return follow_panels(strip([2, middle, 2]), until="180deg", frames=2)


@cache
def _text(name: str) -> str:
    motion = flaps(4) if name == "meeting" else exactfold.follow(name, 1, until="180deg", frames=2)
    return json.dumps(prove_panels(motion).certificate())


def whole(name: str) -> Document:
    document: Document = json.loads(_text(name))
    return document


def closing(document: Document, clear: int) -> Document:
    """A certificate with the claim that all its folds close together, from a parameter on."""
    document["version"] = 3
    sheet, _ = read_panels(document["pattern"])
    letters = zip(sheet.folds, document["claims"]["assignment"], strict=True)
    document["claims"]["closed"] = [list(fold) for fold, letter in letters if letter != "F"]
    document["claims"].pop("contact", None)
    document["evidence"].pop("contact", None)
    document["claims"]["clear"] = "0"
    document["evidence"]["clear"] = clear
    return document


@pytest.mark.parametrize("name", ["meeting", "fish-base", "single-vertex-4"])
def test_what_is_claimed_is_proved(name: str) -> None:
    if name == "single-vertex-4":
        document = closing(given("vertex"), 1 << 37)
        document["evidence"]["clear"] = 1 << 39
    else:
        document = whole(name)
        assert float(Fraction(document["claims"]["clear"])) < pi - 1e-3
    claims = verified(document)
    assert "contact" not in claims
    assert len(claims["closed"]) == len(claims["assignment"].replace("F", ""))
    assert "nor later, until all folds that move are closed" in checker.summary(claims)


def test_some_folds_do_not_close() -> None:
    for change in (list.pop, list.reverse, lambda folds: folds.append([0, 1])):
        document = whole("meeting")
        change(document["claims"]["closed"])
        stopped(document, "the folds that close are not those that move")


@pytest.mark.slow
def test_modes_that_are_not_linear_close_one_by_one() -> None:
    stopped(closing(given("bent"), _EARLY >> 2), "the folds are not proved to close together")


@pytest.mark.slow
def test_flaps_that_pass_through_each_other() -> None:
    """Flaps of length 2 over a panel of length 3 overlap at the end; they cross on the way."""
    document = closing(json.loads(json.dumps(prove_panels(flaps(3)).certificate())), _EARLY)
    faces = "the faces (0, 2, 3, 1) and (4, 6, 7, 5)"
    stopped(document, f"{faces} may touch before the folds close")


def test_panels_that_meet_in_the_flat_sheet_are_not_parted() -> None:
    """At the flat sheet the last stretch has no beginning."""
    document = whole("meeting")
    document["claims"]["clear"], document["evidence"]["clear"] = "0", 0
    refused(document, "malformed: ZeroDivisionError while checking")


def test_other_versions_do_not_know_the_claim() -> None:
    for version in (1, 2, 4):
        document = whole("meeting")
        document["version"] = version
        with pytest.raises(checker.CertificateError, match="expected an object with the keys"):
            verified(document)


def stretch(name: str) -> LastStretch:
    document = whole(name)
    sheet, _ = read_panels(document["pattern"])
    return LastStretch(Folding(sheet, document["claims"], document["evidence"]))


def test_levelled_positions_begin_at_the_image() -> None:
    """Two ways: the exact reflections, and the series at S = 0; x and y of all vertices."""
    found = stretch("fish-base")
    for point, place in zip(found.images(), found.series(Interval(0, 0, BITS)), strict=True):
        for exact, series in zip(point, place[:2], strict=True):
            series_here = series.coefficients[0]
            enclosed = exact.enclosed(BITS)
            assert max(enclosed.low, series_here.low) <= min(enclosed.high, series_here.high)
            assert series_here.high - series_here.low < 1 << BITS - 60


def test_planes_that_turn() -> None:
    assert turn_for([[1.0, 0.0, 0.0]], [1.0]) == [0.0, 0.0, 0.0]
    m = turn_for([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [-1.0, 0.5])
    assert m is not None
    assert m[0] > 1
    assert m[1] > -0.5
    assert turn_for([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]], [-1.0, 0.0]) is None
