"""Forged boxes and charts: zeros left out or listed twice, numbers out of range."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
from forge import Document, beyond, drop_roots, entry_of, given, refused, stopped_by, verified

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.boxes import Box, check_disjoint, read_box

TWO, ONE, EITHER = "listing-two-vertices", "listing-one-vertex", "listing-reflex-either-side"


# --- boxes ---------------------------------------------------------------------------------------


def test_a_root_left_out() -> None:
    for name in (ONE, TWO, "listing-reflex"):
        forged = given(name)
        n = forged["claims"]["interior"]
        drop_roots(forged, lambda root: True, 1)
        made = stopped_by(forged, f"{(1 << n) - 1} roots, not 2^{n}")
        assert made["claims"]["distinct"] == (1 << n) - 1
    forged = given("listing-chord")
    drop_roots(forged, lambda root: True, 1)
    stopped_by(forged, "0 roots, not 2^0")


def test_a_root_too_many() -> None:
    forged = given("listing-chord")
    forged["evidence"]["roots"] *= 2
    assert stopped_by(forged, "2 roots, not 2^0")["claims"]["distinct"] == 2


def test_one_root_in_two_boxes() -> None:
    for name in (ONE, TWO, "listing-isolated"):
        count = len(given(name)["evidence"]["roots"])
        for k in range(1, count):
            forged = given(name)
            roots = forged["evidence"]["roots"]
            roots[k] = dict(roots[0])
            made = stopped_by(forged, "two boxes meet")
            assert made["claims"]["distinct"] == count


def test_one_root_in_two_boxes_of_different_precision() -> None:
    forged = given(TWO)
    roots = forged["evidence"]["roots"]
    first = read_box(roots[0], 2)
    finer = Box([16 * m + 5 for m in first.center], 16 * first.radius + 1, first.bits + 4)
    for k in (1, 3):
        for order in ((0, k), (k, 0)):
            roots[order[0]], roots[order[1]] = entry_of(first), entry_of(finer)
            refused(forged, "two boxes meet")


def meet(a: Box, b: Box) -> bool:
    return all(
        abs(Fraction(x, 1 << a.bits) - Fraction(y, 1 << b.bits))
        <= Fraction(a.radius, 1 << a.bits) + Fraction(b.radius, 1 << b.bits)
        for x, y in zip(a.center, b.center, strict=True)
    )


def test_boxes_that_meet_are_found_as_by_comparing_all_pairs() -> None:
    import random

    source, seen = random.Random(5), {True: 0, False: 0}
    for _ in range(3000):
        size = source.randint(1, 3)
        boxes = []
        for _ in range(source.randint(2, 4)):
            bits = source.randint(0, 3)
            center = [source.randint(-9 << bits, 9 << bits) for _ in range(size)]
            boxes.append(Box(center, source.randint(1, 3 << bits), bits))
        expected = any(meet(a, b) for k, a in enumerate(boxes) for b in boxes[:k])
        seen[expected] += 1
        try:
            check_disjoint(boxes)
        except CertificateError:
            assert expected
        else:
            assert not expected
    assert min(seen.values()) > 300
    check_disjoint([])
    touching = [Box([0], 1, 0), Box([2], 1, 0)]
    with pytest.raises(CertificateError):
        check_disjoint(touching)


def test_numbers_of_a_box_are_bounded() -> None:
    """As large as they may be, they are checked; one more is refused before any arithmetic."""
    most = 1 << 14
    too_many = beyond("the bits of a box", most + 1, most, "MOST_BITS")
    for bits, message in ((most, None), (most + 1, too_many)):
        forged = given(ONE)
        root = forged["evidence"]["roots"][0]
        box = read_box(root, 1)
        by = bits - box.bits
        with_more = Box([m << by for m in box.center], box.radius << by, bits)
        import sys

        limit = sys.get_int_max_str_digits()
        sys.set_int_max_str_digits(0)
        try:
            root.update(entry_of(with_more))
        finally:
            sys.set_int_max_str_digits(limit)
        if message is None:
            verified(forged)
        else:
            stopped_by(forged, message)
    for key in ("radius", "center"):
        for length in (most, most + 1):
            forged = given(ONE)
            root = forged["evidence"]["roots"][0]
            text = root[key] if key == "radius" else root[key][0]
            sign, rest = ("-", text[1:]) if text.startswith("-") else ("", text)
            longer = sign + rest.rjust(length - len(sign), "0")
            root[key] = longer if key == "radius" else [longer]
            if length == most:
                verified(forged)
            else:
                what = "the digits of a number of a box"
                stopped_by(forged, beyond(what, most + 1, most, "MOST_BITS"))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": "0"}, "the radius is not positive"),
        ({"radius": "-1"}, "the radius is not positive"),
        ({"radius": 1}, "1 is not a number in quotes"),
        ({"radius": "1/2"}, "'1/2' is not an integer"),
        ({"center": [1]}, "1 is not a number in quotes"),
        ({"center": ["0", "0"]}, "center does not have 1 entries"),
        ({"center": []}, "center does not have 1 entries"),
        ({"center": "0"}, "center is not a list"),
        ({"bits": -1}, "bits is not a natural number"),
        ({"bits": True}, "bits is not a natural number"),
        ({"bits": "64"}, "bits is not a natural number"),
        ({"more": 1}, "root: expected an object with the keys bits radius center"),
    ],
)
def test_boxes_that_are_none(change: Document, message: str) -> None:
    forged = given(ONE)
    forged["evidence"]["roots"][1].update(change)
    refused(forged, message)
    forged = given(ONE)
    forged["evidence"]["roots"] = {}
    refused(forged, "roots is not a list")


# --- charts --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("chart", "message"),
    [
        ({"4": "-2/3"}, "the chart functional does not fix the height of its corner"),
        ({"1": "0"}, "the chart functional does not fix the height of its corner"),
        (
            {"1": "1", "0": "1"},
            "the chart functional uses a vertex that is neither its corner nor interior",
        ),
        (
            {"1": "1", "9": "1"},
            "the chart functional uses a vertex that is neither its corner nor interior",
        ),
        ({"1": "1", "01": "1"}, "a vertex appears twice in the chart"),
        ([["1", "1"]], "the chart is neither null nor a functional"),
        ("", "the chart is neither null nor a functional"),
        (False, "the chart is neither null nor a functional"),
        ({"x": "1"}, "'x' is not an integer"),
        ({"1": "1/0"}, "'1/0' has no positive denominator"),
        ({"1": 1}, "1 is not a rational number in quotes"),
    ],
)
def test_charts_that_are_none(chart: Any, message: str) -> None:
    forged = given(EITHER)
    forged["evidence"]["chart"] = chart
    refused(forged, message)


def test_a_chart_needs_a_reflex_corner() -> None:
    for name in (ONE, "listing-straight-side"):
        forged = given(name)
        forged["evidence"]["chart"] = {"0": "1"}
        refused(forged, "a chart other than the saddle's needs a reflex corner")


def test_a_chart_in_other_units() -> None:
    """Where the functional is twice as large, the zeros are half as high."""
    made = given("listing-reflex-either-side")
    evidence = made["evidence"]
    evidence["chart"] = {v: str(2 * Fraction(c)) for v, c in evidence["chart"].items()}
    with pytest.raises(CertificateError, match="Krawczyk's test fails"):
        verified(made)
    for root in evidence["roots"]:
        root["bits"] += 1
    verified(made)
