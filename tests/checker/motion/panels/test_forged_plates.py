"""Forged motions of plates and forged stops: each is stopped by one line of the checker alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from forge import Document, given, refused, stopped, verified
from forge_panel_motions import at_rest, strip
from panel_sheets import miura

from exactfold import checker
from exactfold.checker.motion.panels.folding import Folding
from exactfold.checker.motion.panels.outlines import Outlines, Solid
from exactfold.checker.motion.panels.plates import Plates
from exactfold.checker.sheets.panels import read_panels
from exactfold.motion import follow_panels, prove_panels
from exactfold.motion.solid.plates import Plates as Ours
from exactfold.motion.solid.plates import Solid as OurSolid
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

FIFTH = Fraction(1, 5)
APART = "the faces (0, 2, 3, 1) and (2, 4, 5, 3) may touch where the motion is claimed to be clear"


@cache
def _text(name: str) -> str:
    solid = OurSolid(FIFTH, "middle", FIFTH)
    motion = follow_panels(
        miura(2, 2) if name == "miura" else strip([3, 1, 3]), solid=solid, until="40deg", frames=2
    )
    return json.dumps(prove_panels(motion).certificate())


def whole(name: str) -> Document:
    document: Document = json.loads(_text(name))
    return document


def plates(change: Callable[[Document], object] = lambda _: None) -> Document:
    """Two plates that meet at their hinge, after a change of what they are."""
    document = given("panelmotion-plates")
    change(document["claims"]["plates"])
    return document


def short(document: Document) -> Document:
    """The certificate with a contact that is claimed not to happen early."""
    document["claims"] |= {"clear": "1/8"}
    document["claims"]["contact"]["time"][0] = "1/8"
    document["evidence"]["clear"] = 1 << 36
    return document


def without_contact(document: Document) -> Document:
    document["evidence"].pop("point", None)
    return at_rest(document)


def test_what_is_claimed_is_proved() -> None:
    line = checker.summary(verified(plates()))
    assert "; as plates 1/5 thick, with hinges in the middle, cut back by 1/5 from the" in line
    assert "; no two panels touch before the time 2.21429 (126.869 degrees)" in line
    line = checker.summary(
        verified(plates(lambda p: p.update(hinge="valley", trim="2/5")))
        if 0
        else verified(short(plates()))
    )
    assert line.count("0-2-3-1 and 2-4-5-3 do by 2.2143") == 1
    assert "nor later" not in line


@pytest.mark.parametrize("name", ["flaps", pytest.param("miura", marks=pytest.mark.slow)])
def test_plates_that_stay_apart(name: str) -> None:
    claims = verified(whole(name))
    assert float(Fraction(claims["clear"])) == pytest.approx(np.radians(40))
    assert "contact" not in claims


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"thickness": "0"}, "the thickness is not positive"),
        ({"thickness": "-1/5"}, "the thickness is not positive"),
        ({"trim": "0"}, "the trim is not positive"),
        ({"trim": "-1/5"}, "the trim is not positive"),
        ({"hinge": "top"}, "the hinges are neither in the middle nor on one side"),
    ],
)
def test_numbers_that_make_no_plates(change: Document, message: str) -> None:
    stopped(without_contact(plates(lambda p: p.update(change))), message)


def test_keys() -> None:
    refused(
        without_contact(plates(lambda p: p.update(more=1))),
        "plates: expected an object with the keys thickness hinge trim",
    )
    document = plates()
    document["claims"]["more"] = 1
    message = "claims: expected an object with the keys assignment drivers rates plates clear"
    refused(document, f"{message} contact")
    document = plates()
    del document["evidence"]["point"]
    message = "evidence: expected an object with the keys vertices clear contact point"
    refused(document, message)
    document = plates()
    document["version"] = 2
    message = "claims: expected an object with the keys assignment drivers rates clear contact"
    refused(document, message)


def small_triangle() -> PanelPattern:
    """A triangle of inner radius 1 amid three large panels, and a fold across a corner."""
    points = [(-300, -200), (300, -200), (0, 300), (-2, -1), (2, -1), (0, 2)]
    points += [(-270, -150), (-200, -200)]
    edges = [(0, 7), (1, 7), (1, 2), (2, 6), (0, 6), (3, 4), (4, 5), (3, 5), (1, 4), (2, 5), (6, 7)]
    return PanelPattern(points, [*edges, (3, 7)])


def hourglass() -> PanelPattern:
    """A panel with a waist of width 1 between two others, and a fold across a corner."""
    points = [(-9, -9), (9, -9), (9, 9), (-9, 9), (0, 1), (0, -1), (5, -9), (9, -5)]
    edges = [(0, 6), (1, 6), (1, 7), (2, 7), (2, 3), (0, 3), (3, 4), (2, 4), (0, 5), (5, 6), (6, 7)]
    return PanelPattern(points, edges)


def bare(pattern: PanelPattern, fold: tuple[int, int], trim: str) -> Document:
    """A certificate that one fold moves, of plates, of which nothing else is claimed."""
    folds = pattern.folds
    return {
        "format": "exactfold panel motion",
        "version": 5,
        "pattern": panels_document(pattern),
        "claims": {
            "assignment": "".join("V" if e == fold else "F" for e in folds),
            "drivers": [list(fold)],
            "rates": ["1"],
            "plates": {"thickness": "1/100", "hinge": "middle", "trim": trim},
            "clear": "0",
        },
        "evidence": {"vertices": [], "clear": 0},
    }


def test_nothing_may_be_left_of_a_panel() -> None:
    """A triangle that is turned inside out is a triangle again."""
    pattern = small_triangle()
    verified(bare(pattern, (6, 7), "1"))
    stopped(bare(pattern, (6, 7), "2"), "the panel (3, 4, 5) cannot be cut back so far")


def test_sides_of_plates_may_not_cross() -> None:
    pattern = hourglass()
    verified(bare(pattern, (6, 7), "1/2"))
    waist = next(face for face in pattern.faces if {4, 5} <= set(face))
    stopped(bare(pattern, (6, 7), "1"), f"the panel {waist} cannot be cut back so far")


def test_a_plate_may_not_be_claimed_to_be_clear_beyond_its_limit() -> None:
    document = without_contact(plates())
    document["claims"]["clear"] = "9/4"
    document["evidence"]["clear"] = int(Fraction(9, 16) * (1 << 40)) + 1
    refused(document, APART)


@pytest.mark.slow
def test_thicker_plates_meet_earlier() -> None:
    document = without_contact(plates(lambda p: p.update(thickness="1/4")))
    document["claims"]["clear"] = "2"
    document["evidence"]["clear"] = 1 << 39
    verified(document)
    document["claims"]["plates"]["thickness"] = "1/3"
    refused(document, APART)
    document["claims"]["plates"] |= {"hinge": "valley"}
    verified(document)
    document["claims"]["assignment"] = "M"
    refused(document, APART)


def test_the_point_of_a_contact_is_in_both_plates() -> None:
    message = "no point is proved to be in the plates of both panels"
    document = short(plates())
    point = document["evidence"]["point"]
    for other in ([point[0], point[1], "1/5"], ["1", "1", "0"], ["2", "1", "0"], [*point[:2], "0"]):
        document["evidence"]["point"] = other
        stopped(document, message)
    document = short(plates())
    document["evidence"]["contact"] -= 1 << 30
    stopped(document, message)


def test_the_point_of_a_contact_belongs_to_its_first_face() -> None:
    document = short(plates())
    document["claims"]["contact"]["faces"].reverse()
    stopped(document, "no point is proved to be in the plates of both panels")
    document["claims"]["contact"]["faces"][0] = [0, 1, 2]
    refused(document, "malformed: KeyError while checking")


def test_outlines_are_those_of_the_prover() -> None:
    pattern = miura(2, 2)
    sheet, _ = read_panels(panels_document(pattern))
    solid = Solid({"thickness": "1/5", "hinge": "middle", "trim": "1/5"}, Fraction(1))
    outlines = Outlines(sheet, solid)
    ours = Ours(pattern, OurSolid(FIFTH, "middle", FIFTH))
    there = {tuple(np.round(point, 12)) for point in ours.flat.tolist()}
    scale = 1 << 96
    for _, point in outlines.carried:
        assert tuple(round((c.low + c.high) / 2 / scale, 12) + 0.0 for c in point) in there
    assert len(outlines.carried) == len(ours.flat)


def test_pairs_at_folds_are_left_out_until_their_limit() -> None:
    document = whole("miura")
    sheet, _ = read_panels(document["pattern"])
    folding = Folding(sheet, document["claims"], document["evidence"])
    panels = folding.panels
    assert isinstance(panels, Plates)
    every = len(panels.apart)
    panels.until(Fraction(1, 8))
    few = len(panels.apart)
    panels.until(Fraction(5, 8))
    assert few < len(panels.apart) < every


# --- stops ---------------------------------------------------------------------------------------


def stop(change: Callable[[Document, Document], object] = lambda *_: None) -> Document:
    """Two folds of rates 1 and 1/2 with stops at 80 and 50 degrees, after a change."""
    document = at_rest(given("panelmotion-stop"))
    change(document["claims"]["stop"], document["evidence"])
    return document


def test_a_stop_that_is_claimed_is_proved() -> None:
    line = checker.summary(verified(stop()))
    assert "the fold 2-3 is the first at its stop, between the times 1.396263401" in line
    verified(given("panelmotion-stop"))


def test_stops_with_other_times() -> None:
    stopped(
        stop(lambda s, _: s["time"].__setitem__(0, "1397/1000")),
        "a fold may reach its stop earlier than claimed",
    )
    stopped(
        stop(lambda s, _: s["time"].__setitem__(1, "1396/1000")),
        "the fold may reach its stop later than claimed",
    )
    verified(stop(lambda s, _: s.update(time=["1", "2"])))


def test_another_fold_may_not_have_reached_its_stop_before() -> None:
    message = "the fold (4, 5) may have reached its stop before"
    document = stop(lambda s, _: s["angles"].__setitem__(1, [4, 5, "39"]))
    stopped(document, message)
    document = stop(lambda s, _: s["angles"].__setitem__(1, [4, 5, "41"]))
    verified(document)
    late = stop(lambda s, e: e["stop"].__setitem__(0, e["stop"][1]))
    stopped(late, "the fold (2, 3) may have reached its stop before")


def test_the_fold_has_reached_its_stop() -> None:
    message = "the fold is not proved to have reached its stop"
    stopped(stop(lambda s, e: e["stop"].__setitem__(1, e["stop"][0])), message)
    stopped(stop(lambda s, _: s.update(fold=[4, 5])), message)


@pytest.mark.parametrize(
    "angles",
    [
        [[2, 3, "80"], [4, 5, "50"], [4, 6, "50"]],
        [[2, 3, "80"], [4, 5, "30"], [4, 5, "50"]],
        [[2, 3, "80"], [4, 5, "200"]],
    ],
)
def test_stops_are_at_folds_one_each_below_180_degrees(angles: list[list[object]]) -> None:
    message = "a stop is at no fold, is the second at one, or is not below 180 degrees"
    stopped(stop(lambda s, _: s.update(angles=angles)), message)


def test_a_stop_is_read_strictly() -> None:
    refused(
        stop(lambda s, _: s.update(more=1)),
        "stop: expected an object with the keys angles fold time",
    )
    refused(stop(lambda s, _: s.update(fold=[0, 2])), "malformed: KeyError while checking")
    refused(stop(lambda s, _: s["angles"].pop(0)), "malformed: KeyError while checking")
    refused(stop(lambda s, e: e.update(stop=[1])), "parameters of a stop does not have 2 entries")
