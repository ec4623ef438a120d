"""Certificates of sheets with holes, and a forgery for each line that refuses one."""

from __future__ import annotations

import json
from functools import cache

import pytest
from forge import refused, verified
from forge_panels import Document, drawn, stopped
from holed_sheets import ACROSS, BESIDE, FLAP, RING, spokes

from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern


def popup(end: int) -> PanelPattern:
    """A strip with parallel folds at 2, 3 and `end` between two holes, across a fold at 3."""
    return PanelPattern(
        [
            (0, 0),
            (3, 0),
            (6, 0),
            (6, 6),
            (3, 6),
            (0, 6),
            (2, 2),
            (3, 1),
            (end, 2),
            (3, 2),
            (2, 4),
            (3, 5),
            (end, 4),
            (3, 4),
        ],
        [
            (0, 1),
            (1, 2),
            (2, 3),
            (3, 4),
            (4, 5),
            (0, 5),
            (6, 7),
            (7, 8),
            (8, 9),
            (6, 9),
            (10, 11),
            (11, 12),
            (12, 13),
            (10, 13),
            (1, 7),
            (4, 11),
            (6, 10),
            (9, 13),
            (8, 12),
        ],
        holes=[(6, 7, 8, 9), (10, 11, 12, 13)],
    )


SHEETS = {
    "ring": RING,
    "beside": BESIDE,
    "flap": FLAP,
    "across": ACROSS,
    "concurrent": spokes([(2, 2), (4, 2), (4, 4), (2, 4)]),
    "rigid": spokes([(2, 2), (4, 2), (5, 4), (2, 3)]),
    "parallel": popup(4),
    "uneven": popup(5),
}
SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


@cache
def _text(name: str) -> str:
    return json.dumps(certificate_of_panels(decompose(SHEETS[name])))


def certified(name: str) -> Document:
    document: Document = json.loads(_text(name))
    return document


@pytest.mark.parametrize(
    ("name", "components"),
    [
        ("ring", {"0": 1}),
        ("beside", {"1": 32}),
        ("flap", {"2": 2}),
        ("across", {"1": 1}),
        ("concurrent", {"1": 2}),
        ("rigid", {"0": 1}),
        ("parallel", {"1": 2}),
    ],
)
def test_the_checker_finds_the_conditions_round_holes_itself(
    name: str, components: dict[str, int]
) -> None:
    assert verified(certified(name))["second_order"] == components


def test_a_flap_is_free() -> None:
    assert verified(certified("flap"))["free"] == [[4, 5]]


def test_the_sheet_of_a_certificate_has_its_holes() -> None:
    """Without the hole the same drawing is another sheet, on which four creases meet a panel."""
    made = certified("concurrent")
    del made["pattern"]["holes"]
    refused(made, "the parts listed are not those with a vertex of more than four folds")


def test_more_keys() -> None:
    made = certified("ring")
    made["pattern"]["more"] = 1
    refused(made, "pattern: expected an object with the keys radicands vertices edges holes")


@pytest.mark.parametrize("claim", [{"1": 1}, {"0": 2}])
def test_other_components(claim: dict[str, int]) -> None:
    made = certified("rigid")
    made["claims"]["second_order"] = claim
    refused(made, f"claim second_order = {claim!r}, but it is {{'0': 1}}")


def test_other_ways() -> None:
    made = certified("ring")
    [part] = made["claims"]["spaces"]
    part["isolated"]["nonreal"][0] = part["isolated"]["nonreal"][1]
    refused(made, "two boxes meet")


def test_a_line_that_is_not_proved_to_close() -> None:
    """The angles of its folds differ, so that tau = T w does not close the sheet."""
    made = certified("uneven")
    [part] = made["claims"]["spaces"]
    assert [leaf["extending"] for leaf in part["leaves"]] == [0, 1]
    made = certified("uneven")
    made["claims"]["spaces"][0]["leaves"][0]["extending"] = 1
    name = f"the part of vertex {part['vertices'][0]}"
    refused(made, f"{name}: 0 leaves of a kind are proved to fold, not 1")


# --- the sheet -----------------------------------------------------------------------------------


def holed(
    points: list[tuple[int, int]], edges: list[tuple[int, int]], *holes: list[int]
) -> Document:
    made = drawn(points, edges)
    made["pattern"]["holes"] = [*holes]
    made["claims"]["supports"] = []
    return made


BORDER = [(0, 1), (1, 2), (2, 3), (0, 3)]


@pytest.mark.parametrize("hole", [[0, 1, 3], [0, 2, 1], [0, 1, 7]])
def test_a_hole_that_is_no_face(hole: list[int]) -> None:
    """The last face is named from its smallest vertex, counter-clockwise."""
    stopped(holed(SQUARE, [*BORDER, (0, 2)], hole), f"the hole {hole} is no face")


def test_a_hole_that_is_listed_twice() -> None:
    made = certified("ring")
    made["pattern"]["holes"] *= 2
    refused(made, "the hole [3, 4, 5, 6] is no face")


def test_a_sheet_without_panels() -> None:
    stopped(holed(SQUARE, BORDER, [0, 1, 2, 3]), "all faces are holes")


def test_a_hole_that_touches_the_edge_of_the_paper() -> None:
    edges = [*BORDER, (0, 4), (4, 5), (0, 5), (1, 4), (3, 5), (2, 4), (2, 5)]
    made = holed([*SQUARE, (2, 1), (1, 2)], edges, [0, 4, 5])
    stopped(made, "the boundary passes vertex 0 twice")
