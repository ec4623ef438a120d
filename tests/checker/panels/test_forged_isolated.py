"""Parts whose ways are all isolated: a forgery for each line of the checker that refuses one."""

from __future__ import annotations

import json
from functools import cache

import pytest
from forge import beyond, refused, verified
from forge_panels import Document, stopped
from panel_sheets import ring

from exactfold.checker.core import limits
from exactfold.exact.surds import RATIONALS
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

NONE = 8
SHAPE = "isolated ways: expected an object with the keys chart real nonreal"


@cache
def _text(seed: int) -> str:
    return json.dumps(certificate_of_panels(decompose(ring(seed))))


def certified(seed: int = 1) -> tuple[Document, Document, Document]:
    """A certificate of a ring, its only part, and the evidence for the isolated ways."""
    made = json.loads(_text(seed))
    [part] = made["claims"]["spaces"]
    return made, part, part["isolated"]


def test_the_checker_finds_all_ways() -> None:
    made, part, ways = certified()
    assert verified(made)["true"] == {"1": len(ways["real"])}
    assert len(ways["real"]) + 2 * len(ways["nonreal"]) == 16
    assert part["leaves"][0]["number"] == len(ways["real"])


def test_the_checker_finds_that_no_way_is_real() -> None:
    made, part, ways = certified(NONE)
    assert verified(made)["rigid"] == "proved"
    assert part["leaves"] == ways["real"] == []


def test_a_key_more() -> None:
    made, _, ways = certified()
    ways["more"] = 1
    refused(made, SHAPE)


def test_too_many_vertices(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(limits, "ISOLATED_FORMS", 3)
    stopped(certified()[0], beyond("the vertices of one part", 4, 3, "ISOLATED_FORMS"))


def test_a_box_is_left_out() -> None:
    made, part, ways = certified()
    del ways["real"][0]
    [leaf] = part["leaves"]
    leaf["number"] = leaf["extending"] = leaf["number"] - 1
    made["claims"]["second_order"]["1"] -= 1
    made["claims"]["true"]["1"] -= 1
    stopped(made, "15 isolated ways, not 2^4")


def test_two_boxes_hold_the_same_way() -> None:
    made, _, ways = certified()
    ways["real"][0] = ways["real"][1]
    stopped(made, "two boxes meet")


def test_a_box_for_each_of_two_conjugate_ways() -> None:
    made, _, ways = certified()
    first, second = ways["nonreal"][:2]
    second |= first
    second["center"] = [
        *first["center"][:4],
        *(str(-int(y)) for y in first["center"][4:]),
    ]
    stopped(made, "two boxes meet")


def test_a_real_way_that_is_said_not_to_be_real() -> None:
    """Two real boxes are left out, and one of them comes back with imaginary parts of 0."""
    made, part, ways = certified()
    _, box = ways["real"].pop(), ways["real"].pop()
    ways["nonreal"].append({**box, "center": [*box["center"], *["0"] * 4]})
    [leaf] = part["leaves"]
    leaf["number"] = leaf["extending"] = len(ways["real"])
    made["claims"]["second_order"]["1"] = made["claims"]["true"]["1"] = len(ways["real"])
    stopped(made, "two boxes meet")


@pytest.mark.parametrize("kind", ["real", "nonreal"])
def test_a_box_that_holds_no_way(kind: str) -> None:
    made, _, ways = certified()
    center = ways[kind][0]["center"]
    center[0] = str(int(center[0]) + (1 << ways[kind][0]["bits"]))
    about = [int(x) for x in center[:2]]
    bits = ways[kind][0]["bits"]
    refused(made, f"Krawczyk's test fails for the box about {about}.../2^{bits}")


def test_a_box_so_large_that_a_fold_may_be_flat() -> None:
    made, _, ways = certified(3)
    ways["real"][5]["radius"] = str(1 << 53)
    stopped(made, "a fold may be flat on an isolated way")


def test_a_sheet_whose_vertices_are_not_rational() -> None:
    """The same ring, wider by a factor of 1 + sqrt(2): its motions satisfy the same equations."""
    made, _, _ = certified()
    root = RATIONALS.adjoined(2).root
    wide = PanelPattern([(x, y * (1 + root)) for x, y in ring(1).vertices], ring(1).edges)
    made["pattern"] = panels_document(wide)
    made["claims"]["sha256"] = wide.sha256
    stopped(made, "isolated ways are listed of sheets with rational vertices")


def test_other_numbers_of_motions_and_conditions() -> None:
    _, _, ways = certified()
    other = certificate_of_panels(decompose(ring(1, (4, 4, 4, 6))))
    other["claims"]["spaces"][0]["isolated"] = ways
    refused(other, "a part with isolated ways has other numbers of motions and conditions")


def test_charts_that_are_none() -> None:
    made, _, ways = certified()
    chart = ways["chart"]
    for wrong, message in (
        (chart[:-1], "chart does not have 5 entries"),
        ([*chart[:-1], chart[-1][:2]], "an entry of the chart does not have 3 entries"),
        ([*chart[:-1], [*chart[-1][:2], 0]], "the last weight of the chart is 0"),
        ([*chart[:-1], [*chart[0][:2], 1]], "malformed: ZeroDivisionError while checking"),
        ([*chart[:-1], [*chart[-1][:2], "1"]], "'1' is not an integer"),
    ):
        ways["chart"] = wrong
        refused(made, message)


def test_another_number_of_ways() -> None:
    made, part, _ = certified()
    [leaf] = part["leaves"]
    leaf["extending"] -= 1
    stopped(made, "the part of vertex 0 has other ways than those listed")


def test_isolated_ways_are_complete() -> None:
    made, part, _ = certified()
    part["complete"] = False
    stopped(made, "the part of vertex 0 has isolated ways, so that these are complete")
