"""Forged certificates of driven motions, and of motions that come back to the flat state."""

from __future__ import annotations

import json
import math
from contextlib import suppress
from fractions import Fraction
from functools import cache

import pytest
from forge import FIXTURES, Document, refused, verified, with_one_key_more, without

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion.certificate import MOTION
from exactfold.checker.motion.drive import PrescribedAngles, check_reached
from exactfold.checker.motion.equations import LengthEquations
from exactfold.checker.motion.pieces import arc_of
from exactfold.checker.motion.ray import shortened
from exactfold.checker.motion.tubes import Ball
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.motion import find_driven, follow, follow_proved, prove
from exactfold.motion.tubes.chain import Step
from exactfold.motion.tubes.tracks import ray
from exactfold.pattern.crease_pattern import CreasePattern

# A vertex with five folds.
STAR = CreasePattern(
    [(0, 0), (8, 1), (10, 7), (4, 11), (-2, 6), (4, 4)], [(k, (k + 1) % 5, 5) for k in range(5)]
)
START = ("centre", "halvings", "held", "reach")
ANGLES = {(0, 5): 12.0, (1, 5): 8.0}


@cache
def _text() -> str:
    driven = find_driven(STAR, ANGLES)
    proof = prove(follow(driven.branch, drive=driven.drive, until="return", frames=2))
    return json.dumps(proof.track.certificate())


def given() -> Document:
    """A fresh copy of a small certificate."""
    document: Document = json.loads(_text())
    return document


def _with(**changes: object) -> Document:
    document = given()
    document["claims"]["drive"] |= changes
    return document


def test_the_claims_say_what_is_driven() -> None:
    claims = verified(given())
    assert claims["drive"]["folds"] == [[0, 5], [1, 5]]
    assert claims["drive"]["reached"] is True
    ratio = " : ".join(claims["drive"]["squares"])
    text = f"driven by the folds 0-5, 1-5 (valley, valley), sin^2 of half the angle as {ratio}"
    assert f"{text}, at least that at the end;" in motion.summary(claims)
    early = {**claims, "drive": claims["drive"] | {"reached": False}}
    assert "at least that at the end" not in motion.summary(early)


def test_only_the_ratio_of_the_squares_is_kept() -> None:
    """Half of both is reached earlier; much more is not reached, but its ratio is kept."""
    squares = [Fraction(q) for q in given()["claims"]["drive"]["squares"]]
    assert verified(_with(squares=[str(q / 2) for q in squares]))
    more = [str(q * 60) for q in squares]
    assert verified(_with(squares=more, reached=False))
    message = "the driven folds are not proved to reach the sizes of their angles"
    with without(message):
        verified(_with(squares=more))
    refused(_with(squares=more), message)


def test_another_ratio() -> None:
    first, second = given()["claims"]["drive"]["squares"]
    other = str(Fraction(second) * Fraction(11, 10))
    refused(_with(squares=[first, other]), "a tube does not hold one zero for each parameter")


def test_folds_that_start_the_other_way() -> None:
    first, second = given()["claims"]["drive"]["squares"]
    message = "the driven fold (1, 5) may start to the other side"
    forged = _with(squares=[first, f"-{second}"], reached=False)
    with without(message):
        verified(forged)
    refused(forged, message)


def test_a_drive_of_another_shape() -> None:
    refused(
        with_one_key_more(given(), ("claims", "drive")),
        "drive: expected an object with the keys folds squares reached",
    )
    refused(_with(reached=1), "reached is not true or false")
    with without("reached is not true or false"):
        verified(_with(reached=1))
    refused(_with(folds=[[0, 5]]), "driven folds does not have 2 entries")
    refused(_with(folds=[[0, 5], [1, 5], [2, 5]]), "driven folds does not have 2 entries")
    refused(_with(folds=[[0, 5], [1, 5, 2]]), "fold does not have 2 entries")
    refused(_with(folds=[[0, 5], [1, -5]]), "vertex is not a natural number")
    refused(_with(squares=["1/2"]), "squares does not have 2 entries")


def test_what_is_driven_is_a_fold_and_no_two_are_the_same() -> None:
    message = "a driven fold is not a fold of the sheet, or is named twice"
    refused(_with(folds=[[0, 5], [0, 1]]), message)
    refused(_with(folds=[[0, 5], [5, 1]]), message)
    refused(_with(folds=[[0, 5], [0, 5]]), message)


def test_squares_are_those_of_angles() -> None:
    squares = [Fraction(q) for q in given()["claims"]["drive"]["squares"]]
    message = "each of the squares must be from -1 to 1, and not 0"
    large = [str(q / max(squares) * 2) for q in squares]
    with without(message):
        verified(_with(squares=large, reached=False))
    refused(_with(squares=large, reached=False), message)
    refused(_with(squares=["0", "1/2"], reached=False), message)


def test_without_a_drive_there_are_too_many_corners() -> None:
    document = given()
    del document["claims"]["drive"]
    refused(document, "there are not four boundary vertices")


def test_with_four_corners_nothing_is_driven() -> None:
    """The side is then that of the saddle, and no equation knows of the fold."""
    document = back()
    del document["claims"]["return"], document["evidence"]["landing"]
    document["evidence"]["tubes"] = []
    document["claims"] |= {"length": "0", "side": 1}
    [middle] = read_sheet(document["pattern"])[0].interior
    message = "a single driven fold has no ratio"
    for fold, reached in (([0, middle], False), ([98, 99], True)):
        drive = {"folds": [fold], "squares": ["1/2"], "reached": reached}
        refused(document | {"claims": document["claims"] | {"drive": drive}}, message)
    ways = []
    for square in ("1/2", "-1/2"):
        document["claims"]["drive"] = {
            "folds": [[0, middle]],
            "squares": [square],
            "reached": False,
        }
        with without(message), suppress(CertificateError):
            ways.append(verified(document)["side"])
    assert ways == [1]
    document["claims"]["drive"] = None
    refused(document, "drive: expected an object with the keys folds squares reached")


def test_with_a_rim_and_a_drive() -> None:
    document = given()
    document["claims"]["rim"] = ["0", "0", "1", "0", "1"]
    message = "a motion keeps the ratio of its boundary heights or of driven folds, not both"
    with without(message):
        verified(document)
    refused(document, message)


def test_the_side_of_a_driven_motion_is_that_of_its_folds() -> None:
    document = given()
    document["claims"]["side"] = -1
    refused(document, "the side is not the claimed one")


def test_folds_that_end_on_the_other_side() -> None:
    """Two wings, turned by 0.3 about the sides of the face that is held, up and down."""
    sheet = read_sheet(given()["pattern"])[0]
    square = str(Fraction(math.sin(0.1) ** 2))
    claim = {"folds": [[0, 5], [1, 5]], "squares": [square, f"-{square}"], "reached": True}
    equations = LengthEquations(sheet, [0, 1, 5], 64, PrescribedAngles(sheet, claim))
    scale = float((1 << 64) / equations.unit)
    centre = [0] * equations.size
    for v, fold, turn in ((4, (0, 5), 0.3), (2, (1, 5), -0.3)):
        (ax, ay), (bx, by), (x, y) = (tuple(map(float, sheet.points[w])) for w in (*fold, v))
        length = math.hypot(bx - ax, by - ay)
        nx, ny = (ay - by) / length, (bx - ax) / length
        off = (x - ax) * nx + (y - ay) * ny
        down = off * (math.cos(turn) - 1)
        moved = (down * nx, down * ny, abs(off) * math.sin(turn))
        k = equations.place[v]
        centre[k : k + 3] = [int(c * scale) for c in moved]
    here = Ball(centre, [0] * equations.size)
    check_reached(equations, PrescribedAngles(sheet, claim), here)
    claim["squares"] = [square, square]
    message = "the driven fold (1, 5) may end on the other side"
    with without(message):
        check_reached(equations, PrescribedAngles(sheet, claim), here)
    with pytest.raises(CertificateError) as caught:
        check_reached(equations, PrescribedAngles(sheet, claim), here)
    assert str(caught.value) == message


WINGS = {(1, 5): 96.0, (4, 5): -33.0}


@cache
def _there_and_back() -> str:
    """Driven folds that turn back when fold 3-5 is closed, along the other way to bend it."""
    up, down = (find_driven(STAR, WINGS, signs) for signs in "+-")
    end = ray(down.branch, down.side, drive=down.drive)
    tau = end.start.last // 2

    def comes_back(step: Step) -> str | None:
        return "back" if step.tube.lies_in(end.start.ball(tau)) else None

    document = follow_proved(
        up.branch,
        up.side,
        stop=comes_back,
        pinned=[end.labels[v] for v in end.framework.pinned],
        drive=up.drive,
    ).certificate()
    flat = end.certificate()
    start = {key: flat["evidence"]["start"][key] for key in START}
    del document["evidence"]["tubes"][-1]["exit"]
    document["evidence"]["landing"] = start | {"tau": tau}
    document["claims"]["return"] = {"vertex_signs": flat["claims"]["vertex_signs"], "side": 1}
    document["claims"]["drive"]["reached"] = False
    return json.dumps(document)


def test_driven_folds_that_come_back_are_flat_at_the_end() -> None:
    """They had small angles where the last tube is entered, and have none where it ends."""
    document = json.loads(_there_and_back())
    claims = verified(document)
    assert (claims["vertex_signs"], claims["return"]["vertex_signs"]) == ([1], [-1])
    drive = document["claims"]["drive"]
    drive["squares"] = [str(Fraction(q) / 1000) for q in drive["squares"]]
    drive["reached"] = True
    message = "a motion that returns to the flat state does not end at given angles"
    with without(message):
        verified(document)
    refused(document, message)


def test_a_driven_motion_has_no_node() -> None:
    """The patch of a branch point knows nothing of the equations of a drive."""
    document = given()
    sheet = read_sheet(document["pattern"])[0]
    drive = PrescribedAngles(sheet, document["claims"]["drive"])
    equations = LengthEquations(sheet, document["evidence"]["pinned"], 64, drive)
    with pytest.raises(CertificateError) as caught:
        arc_of(equations, [5], {})
    assert str(caught.value) == "a motion with driven folds cannot have a branch point"


# --- back to the flat state ----------------------------------------------------------------------


@cache
def _back() -> str:
    """The loop of the fixture, as a motion that comes back."""
    lines = (FIXTURES / "loops-one-vertex.txt").read_text().splitlines()
    header, loop = (json.loads(line.partition("\t")[0]) for line in lines[:2])
    evidence = loop["evidence"]
    document = {
        "format": MOTION.format,
        "version": MOTION.version,
        "pattern": header["pattern"],
        "claims": {**loop["from"], "length": loop["length"], "return": loop["to"]},
        "evidence": {
            **{key: header[key] for key in ("emptied", "pinned", "bits")},
            "start": evidence["start"],
            "tubes": evidence["steps"],
            "landing": evidence["landing"],
        },
    }
    return json.dumps(document)


def back() -> Document:
    """A fresh copy of a motion that comes back."""
    document: Document = json.loads(_back())
    return document


def test_a_motion_that_comes_back() -> None:
    claims = verified(back())
    assert ", and back to the flat state along" in motion.summary(claims)
    signs = shortened("+" * 80)
    assert signs == "+" * 60 + "..."


def test_it_comes_back_along_another_half_branch() -> None:
    for key, message in (
        ("vertex_signs", "vertex 4 does not have the claimed sign"),
        ("side", "the side is not the claimed one"),
    ):
        document = back()
        claim = document["claims"]["return"]
        value = claim[key]
        claim[key] = [-s for s in value] if isinstance(value, list) else -value
        refused(document, message)


def test_a_return_of_another_shape() -> None:
    refused(
        with_one_key_more(back(), ("claims", "return")),
        "return: expected an object with the keys vertex_signs side",
    )
    refused(
        with_one_key_more(back(), ("evidence", "landing")),
        "landing: expected an object with the keys centre halvings held reach tau",
    )
    document = back()
    del document["claims"]["return"]
    refused(document, "evidence: expected an object with the keys emptied pinned bits start tubes")


def test_a_motion_that_comes_back_claims_no_contact() -> None:
    """What is clear is checked to an exit of the last tube, which is not left there."""
    document = back()
    document["claims"]["clear"] = "1/1000"
    document["evidence"]["contacts"] = {"tube": 1, "clear": 0}
    refused(document, "a motion that returns may not claim a branch point at its end, or contacts")


def test_a_motion_that_comes_back_is_shorter_than_claimed() -> None:
    document = back()
    document["claims"]["length"] = str(Fraction(document["claims"]["length"]) * 2)
    refused(document, "the motion is shorter than claimed")
