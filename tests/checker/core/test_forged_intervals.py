"""Forged intervals: roots that are none, listed twice, or left out as not real."""

from __future__ import annotations

import pytest
from forge import (
    cross,
    drop_roots,
    given,
    in_box,
    refused,
    stopped_by,
    verified,
)

PATH, VERTEX = "algebraic-bent-off-path", "algebraic-flat-vertex-groebner"


@pytest.mark.parametrize(
    "interval",
    [
        ["0", "1/1000"],  # left of the root
        ["1/17", "1/10"],  # right of it
        ["1/10", "1/20"],  # the wrong way round
        ["0", "1"],  # two roots
        ["1/17", "1/17"],  # no root
    ],
)
def test_intervals_without_a_root(interval: list[str]) -> None:
    forged = given(VERTEX)
    assert forged["evidence"]["roots"][0]["class"] == 1
    forged["evidence"]["roots"][0]["interval"] = interval
    refused(forged, "an interval shows no root")


@pytest.mark.parametrize(
    "interval",
    [
        ["0", "1/4"],  # an end is a root
        ["-1/4", "0"],
        ["1/4", "1/2"],
        ["1/100", "1/50"],  # values are small and have one sign
        ["3/4", "1"],
        ["1/4", "1/4"],
        ["1/4", "-1/4"],
    ],
)
def test_one_rational_root_in_a_point_and_at_the_end_of_an_interval(interval: list[str]) -> None:
    for place in range(2):
        forged = cross()
        forged["evidence"]["roots"][place]["interval"] = interval
        refused(forged, "an interval shows no root")


def test_an_interval_without_a_root_hides_a_zero() -> None:
    """A copy of the second zero, seen at the wrong side, stands for the first."""
    forged = given(VERTEX)
    forged["evidence"]["roots"][0]["interval"] = ["0", "1/1000"]
    stopped_by(forged, "an interval shows no root")


def test_one_root_in_two_intervals() -> None:
    forged = given(VERTEX)
    first, second, _ = forged["evidence"]["roots"]
    second["interval"] = first["interval"]
    made = stopped_by(forged, "two intervals overlap")
    assert made["claims"]["branches"][0] == made["claims"]["branches"][1]
    second["interval"] = [first["interval"][0], "1/10"]
    stopped_by(forged, "two intervals overlap")


def test_one_rational_root_twice() -> None:
    for at in ("0", "1/2"):
        forged = cross()
        for root in forged["evidence"]["roots"]:
            root["interval"] = [at, at]
        made = stopped_by(forged, "two intervals overlap")
        assert made["claims"]["branches"][0] == made["claims"]["branches"][1]


def test_intervals_may_touch_and_be_wide() -> None:
    """At an end that is no root the polynomial has a sign, so no zero is in two intervals."""
    true = given(VERTEX)
    true["evidence"]["roots"][0]["interval"] = ["0", "1/10"]
    true["evidence"]["roots"][1]["interval"] = ["1/10", "1"]
    assert verified(true) == given(VERTEX)["claims"]
    true["evidence"]["roots"][1]["interval"] = ["1/10", "1" + "0" * 30]
    assert verified(true) == given(VERTEX)["claims"]


def test_a_real_root_left_out() -> None:
    forged = given(VERTEX)
    drop_roots(forged, lambda root: root["class"] == 1, 1)
    made = stopped_by(forged, "a real root is missing")
    assert made["claims"]["nonreal"] == 1


def test_all_real_roots_left_out() -> None:
    forged = given(VERTEX)
    drop_roots(forged, lambda root: root["class"] == 1, 2)
    assert stopped_by(forged, "a real root is missing")["claims"]["nonreal"] == 2


def test_roots_that_are_not_real_are_counted_in_every_class() -> None:
    """There are none by Theorem 2; without the quadrics, t^2 + 1 may come first, or last."""
    for first in (True, False):
        forged = given(PATH)
        drop_roots(forged, in_box, 2)
        circle = {"polynomial": ["1", "0", "1"], "numerators": [["1"], ["1"], ["-2"]], "flat": []}
        classes = forged["evidence"]["classes"]
        classes.insert(0 if first else 1, circle)
        next(r for r in forged["evidence"]["roots"] if "class" in r)["class"] = int(first)
        made = stopped_by(forged, "the parametrisation misses a quadric")
        assert (made["claims"]["nonreal"], made["claims"]["distinct"]) == (2, 5)
        assert made["claims"]["true_branches"] == "undecided"
