"""Forged motions and loops: numbers that are none, empty lists, tubes that come twice."""

from __future__ import annotations

import json
from typing import Any

import pytest
from forge import Document, beyond, given_lines, refused, unreadable, verified
from test_forged_loops import ONE
from test_forged_loops import refused as refused_loops
from test_forged_motions import given

from exactfold import checker
from exactfold.checker.core.lines import digest
from exactfold.checker.core.reading import CertificateError, FormatError, shown
from exactfold.checker.motion import boxes as motion_boxes
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion.loops import check_lines

LONG = "9" * 4001


def small() -> Document:
    """A motion through two tubes."""
    return given("reflex")


def changed(place: tuple[Any, ...], value: Any) -> Document:
    """The motion with another value in one place."""
    forged = small()
    inner: Any = forged
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    return forged


CENTRE = ("evidence", "tubes", 0, "centre")
FIRST = ("evidence", "start")


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("64.0", "a certificate holds no floats, but here is 64.0"),
        ("64e0", "a certificate holds no floats, but here is 64e0"),
        ("NaN", "a certificate holds no floats, but here is NaN"),
        ("-Infinity", "a certificate holds no floats, but here is -Infinity"),
        (LONG, f"an integer is too long: {LONG[:40]}..."),
        ('64, "bits": 64', "a key appears twice in one object"),
    ],
)
def test_what_is_written_as_no_integer_is_not_read(written: str, message: str) -> None:
    text = json.dumps(small())
    assert '"bits": 64' in text
    unreadable(text.replace('"bits": 64', f'"bits": {written}', 1), message)
    header, loop, claims = (json.dumps(part) for part in given_lines(ONE))
    parts = [header, loop.replace('"side": ', f'"side": {written}, "x": ', 1), claims]
    if written.startswith("64,"):
        parts[1] = loop.replace('"side": ', '"side": 1, "side": ', 1)
    last, data = "", ""
    for part in parts:
        last = digest(last, part)
        data += f"{part}\t{last}\n"
    refused_loops(data.encode(), f"a line: {message}", FormatError)


@pytest.mark.parametrize("other", ["NaN", True])
def test_what_is_no_integer_is_refused(other: Any) -> None:
    for place, what in (
        (("evidence", "bits"), "bits"),
        ((*FIRST, "halvings"), "halvings"),
        ((*FIRST, "held"), "held vertex"),
        ((*FIRST, "reach"), "reach"),
        ((*FIRST, "exit"), "exit"),
        (("evidence", "tubes", 0, "reach"), "reach"),
        (("evidence", "pinned", 1), "pinned vertex"),
    ):
        refused(changed(place, other), f"{what} is not a natural number")
    for place in (
        (*FIRST, "centre", 1),
        (*CENTRE, 0),
        ("evidence", "tubes", 0, "row", 3),
        ("evidence", "tubes", 1, "exit"),
    ):
        refused(changed(place, other), f"{other!a} is not an integer")
    for key in ("tau", "halvings"):
        forged = given_lines(ONE)
        forged[1]["evidence"]["landing"][key] = other
        said = f"{other!a} is not an integer"
        refused_loops(
            forged, f"loop 0: {said if key == 'tau' else f'{key} is not a natural number'}"
        )


def test_negative_numbers_are_refused() -> None:
    for place, what in (
        (("evidence", "bits"), "bits"),
        ((*FIRST, "halvings"), "halvings"),
        ((*FIRST, "reach"), "reach"),
        (("evidence", "tubes", 0, "reach"), "reach"),
    ):
        refused(changed(place, -1), f"{what} is not a natural number")
    backwards = changed(("evidence", "tubes", 0, "exit"), -1)
    refused(backwards, "a motion leaves a tube before it enters")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (1, "1 is not a rational number in quotes"),
        (None, "None is not a rational number in quotes"),
        ("NaN", "'NaN' is not an integer"),
        ("inf", "'inf' is not an integer"),
        ("1e-3", "'1e-3' is not an integer"),
        ("0.5", "'0.5' is not an integer"),
        ("1_0", "'1_0' is not an integer"),
        (" 1", "' 1' is not an integer"),
        ("--1", "'--1' is not an integer"),
        ("", "'' is not an integer"),
        ("1/", "'' is not an integer"),
        ("1/0", "'1/0' has no positive denominator"),
        ("-1/-2", "'-1/-2' has no positive denominator"),
        ("\u0661", r"'\u0661' is not an integer"),
    ],
)
def test_lengths_that_are_no_numbers_are_refused(text: Any, message: str) -> None:
    forged = changed(("claims", "length"), text)
    forged["evidence"]["tubes"] = []
    refused(forged, message)


def test_empty_lists_prove_nothing() -> None:
    forged = changed(("evidence", "tubes"), [])
    refused(forged, "the motion is shorter than claimed")
    assert verified(forged | {"claims": forged["claims"] | {"length": "0"}})["tubes"] == 0
    size = len(small()["evidence"]["tubes"][0]["centre"])
    for place, what, length in (
        ((*FIRST, "centre"), "centre", size),
        (CENTRE, "centre", size),
        (("evidence", "tubes", 0, "row"), "row", size),
        (("evidence", "pinned"), "pinned", 3),
        (("claims", "vertex_signs"), "vertex_signs", 1),
    ):
        refused(changed(place, []), f"{what} does not have {length} entries")
        refused(changed(place, [1] * (length + 1)), f"{what} does not have {length} entries")
    for value in ({}, "", None, 0):
        refused(changed(("evidence", "tubes"), value), "tubes is not a list")
    refused(
        changed(("evidence", "tubes", 0), []),
        "tube: expected an object with the keys centre row reach exit",
    )
    forged = given_lines(ONE)
    forged[1]["evidence"]["steps"] = []
    refused_loops(forged, "loop 0: a motion meets a branch point, or lands, where it is on no tube")


def test_a_direction_of_zero_is_refused() -> None:
    """A tube whose parameter does not move, and a plane that has no normal."""
    row = small()["evidence"]["tubes"][0]["row"]
    refused(
        changed(("evidence", "tubes", 0, "row"), [0] * len(row)),
        "malformed: ZeroDivisionError while checking",
    )
    boxes = {v: ([9 * v, v * v, 1], [9 * v, v * v, 2], 0) for v in range(6)}
    assert motion_boxes.parted(boxes, (3, 4, 5), (0, 1, 2), [1, 0, 0])
    for boxed in (boxes, {v: (a, b, 1) for v, (a, b, _) in boxes.items()}):
        assert not motion_boxes.parted(boxed, (3, 4, 5), (0, 1, 2), [0, 0, 0])
        assert not motion_boxes.parted_at(boxed, 2, (3, 4), (0, 1), [0, 0, 0])


def test_no_length_is_gained_by_a_tube_that_comes_twice() -> None:
    for number in (0, 1):
        forged = small()
        tubes = forged["evidence"]["tubes"]
        tubes.insert(number, tubes[number])
        forged["claims"]["length"] = "0"
        refused(forged, "a motion leaves a tube before it enters")
    forged = small()
    tubes = forged["evidence"]["tubes"]
    tubes.append(tubes[0])
    with pytest.raises(CertificateError, match=r"^a motion "):
        verified(forged)


def test_numbers_of_thousands_of_digits() -> None:
    huge = int("9" * 3999)
    left = "a motion leaves a tube beyond its reach"
    for place, message in (
        ((*FIRST, "exit"), left),
        (("evidence", "tubes", 0, "exit"), left),
        (("evidence", "bits"), beyond("the bits", huge, 2048, "MOTION_BITS")),
        ((*FIRST, "halvings"), "halvings are out of range"),
        ((*FIRST, "reach"), "the reach is out of range"),
        ((*FIRST, "held"), "the vertex held at its height is not one that can move"),
        (("evidence", "pinned", 0), "the pinned vertices are not those of a face"),
        ((*CENTRE, 0), "a number of the centre is out of range"),
    ):
        refused(changed(place, huge), message)
    refused(changed(("claims", "length"), "9" * 5000), "the motion is shorter than claimed")


def test_verified_numbers_of_any_size_are_shown() -> None:
    """They are true, if of no use: at least so negative a length, at the latest so late."""
    for text, low, high in (
        ("-" + "9" * 400, "-1e+400", "-9.99999e+399"),
        (f"{10**401}/3", "3.33333e+400", "3.33334e+400"),
        (f"1/{10**400}", "1e-400", "1e-400"),
        (f"2/{3 * 10**400}", "6.66666e-401", "6.66667e-401"),
        ("-1/3", "-0.333334", "-0.333333"),
        ("355/113", "3.14159", "3.1416"),
        (str(10**308), "1e+308", "1e+308"),
        ("1234567", "1.23456e+6", "1.23457e+6"),
        ("123456", "123456", "123456"),
        ("-1/8", "-0.125", "-0.125"),
        ("0", "0", "0"),
    ):
        assert (shown(text), shown(text, up=True)) == (low, high)
    forged = changed(("claims", "length"), "-" + "9" * 400)
    forged["evidence"]["tubes"] = []
    assert " of length -1e+400 or more; 0 tubes; " in checker.summary(verified(forged))
    contact = {"kind": "contact", "time": ["1", f"{10**400}"], "faces": [[0, 1, 2], [3, 4, 5]]}
    claims = {"vertex_signs": [1], "side": 1, "length": "1", "tubes": 1, "sha256": "x"}
    line = motion.summary({**claims, "clear": f"-{10**400}", "contact": contact})
    assert "; no two faces touch before -1e+400, (0, 1, 2) and (3, 4, 5) do by 1" in line


def test_faces_listed_as_cycles_are_refused() -> None:
    """A face counted twice, and a cycle that is none."""
    triangle = small()["pattern"]["triangles"][0]
    forged = changed(("evidence", "emptied"), [{"corners": triangle, "inside": []}])
    with pytest.raises(CertificateError, match=r"^(?!malformed)"):
        verified(forged)
    forged = changed(("evidence", "emptied"), [[]])
    refused(forged, "3-cycle: expected an object with the keys corners inside")
    forged = given("triangles")
    emptied = forged["evidence"]["emptied"]
    emptied.append(emptied[0])
    with pytest.raises(CertificateError, match=r"^(?!malformed)"):
        verified(forged)
    forged = given("triangles")
    forged["evidence"]["emptied"] = []
    with pytest.raises(CertificateError):
        verified(forged)


def test_loops_that_are_no_objects_or_land_nowhere() -> None:
    header, _, claims = (json.dumps(part) for part in given_lines(ONE))
    for part in ("[]", "1", "null", '"loop"'):
        with pytest.raises(FormatError, match=r"^a line is not an object$"):
            check_lines(iter([header, part, claims]))
    forged = given_lines(ONE)
    forged[1]["evidence"]["landing"]["tau"] = "NaN"
    refused_loops(forged, "loop 0: 'NaN' is not an integer")
