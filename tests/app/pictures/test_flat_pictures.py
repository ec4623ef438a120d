"""Pictures of flat-folded states, and of why there is none."""

from __future__ import annotations

import re
from fractions import Fraction
from xml.etree import ElementTree

import numpy as np
import pytest

import exactfold
from exactfold.app.pictures.flat_conflicts import conflict_picture
from exactfold.app.pictures.flat_layers import bottom_to_top, corners_of
from exactfold.app.pictures.flat_states import BACK, FRONT, clipped, state_picture
from exactfold.app.pictures.painting import area
from exactfold.app.report.flat import reasons
from exactfold.pattern.panel_pattern import PanelPattern

SVG = "{http://www.w3.org/2000/svg}"


def lid() -> PanelPattern:
    """A square with four flaps, of which neighbours overlap: closed like a box, in cycles, too."""
    corners = [(0, 0), (10, 0), (10, 10), (0, 10)]
    outer = [(0, -4), (10, -4), (14, 0), (14, 10), (10, 14), (0, 14), (-4, 10), (-4, 0)]
    edges = [(0, 1), (1, 2), (2, 3), (0, 3)]
    for k in range(4):
        first, second = 4 + 2 * k, 5 + 2 * k
        edges += [(k, first), (first, second), (second, (k + 1) % 4)]
    return PanelPattern([*corners, *outer], edges)


def inside(point, corners):
    after = np.roll(corners, -1, axis=0)
    turns = (after[:, 0] - corners[:, 0]) * (point[1] - corners[:, 1])
    turns -= (after[:, 1] - corners[:, 1]) * (point[0] - corners[:, 0])
    return turns.min() > 1e-9


@pytest.mark.parametrize(
    ("sheet", "letters"),
    [("miura", None), ("square-twist", "any"), ("map-fold", None), (lid(), "VVVV")],
    ids=["miura", "square-twist", "map-fold", "lid"],
)
def test_layers_are_drawn_in_the_order_of_the_state(sheet, letters):
    found = exactfold.flat(sheet, letters)
    random = np.random.default_rng(0)
    for state in found:
        layers = bottom_to_top(state)
        whole = np.array(state.images.places)
        for point in random.uniform(whole.min(axis=0), whole.max(axis=0), (40, 2)):
            drawn = [one.piece for one in layers if inside(point, one.corners)]
            assert tuple(drawn[::-1]) == state.stack([Fraction(x) for x in point.tolist()])
        areas = [0.0] * len(state.images.maps)
        for one in layers:
            areas[one.piece] += area(one.corners)
        assert areas == pytest.approx([area(corners) for corners in corners_of(state)])


def test_only_cycles_are_cut():
    found = exactfold.flat(lid(), "VVVV")
    assert found.count == 16
    numbers = sorted(len(bottom_to_top(state)) for state in found)
    assert numbers[:14] == [5] * 14
    assert numbers[14:] == [7, 7]  # one flap of the cycle is cut: two corners, and the rest


def test_both_sides_and_the_two_sides_of_the_paper():
    state = exactfold.flat(lid(), "VVVV").state()
    root = ElementTree.fromstring(state_picture(state, "lid"))
    layers = [one for one in root.iter(f"{SVG}g") if "data-panels" in one.attrib]
    fills = [one.find(f"{SVG}path").get("fill") for one in layers]
    half = len(layers) // 2
    base = [one.get("data-panels") for one in layers[:half]]
    assert [one.get("data-panels") for one in layers[half:]] == base[::-1]
    # from above the flaps show the back over the front of the base, which is seen alone from below
    assert sorted(fills[:half]) == sorted([FRONT, *[BACK] * (half - 1)])
    assert fills[half:] == [BACK if x == FRONT else FRONT for x in fills[:half][::-1]]
    assert root.find(f"{SVG}title").text == "lid"
    drawn = {one.get("class") for one in root.iter(f"{SVG}path")}
    assert {"V", "B"} <= drawn
    assert "M" not in drawn


def test_lines_are_clipped_to_convex_polygons():
    square = np.array([[0.0, 0.0], [1, 0], [1, 1], [0, 1]])

    def part(*ends):
        found = clipped(np.array(ends, dtype=float), square)
        return None if found is None else np.round(found, 5).tolist()

    assert part((-1, 0.5), (2, 0.5)) == [[0, 0.5], [1, 0.5]]
    assert part((0, 0), (1, 0)) == [[0, 0], [1, 0]]
    assert part((0.5, 0.2), (0.5, 3)) == [[0.5, 0.2], [0.5, 1]]
    assert part((0, 1.1), (1, 1.1)) is None
    assert part((1, 1), (2, 2)) is None
    assert part((1.5, 0), (2.5, 1)) is None


def test_a_conflict_is_marked_with_the_numbers_of_the_text():
    found = exactfold.flat("square-twist")
    text = conflict_picture(found, reasons(found), "twist")
    root = ElementTree.fromstring(text)
    marked = [one for one in root.iter() if one.get("class") == "marked"]
    assert [one.get("fill") == "none" for one in marked] == [False] * 3 + [True] * 2
    words = [one.text for one in root.iter(f"{SVG}text")]
    assert {"panel 5", "panel 6", "panel 7", "1, 3", "2, 4"} <= set(words)
    assert "1. crease 4-7 between panels 5 and 6 is a mountain" in words


def test_vertices_that_fail_are_marked():
    found = exactfold.flat("flat-octahedron")
    assert len(reasons(found)) == len(found.failures) == 6
    text = conflict_picture(found, reasons(found)[:2])
    assert len(re.findall('<circle class="marked"', text)) == 6
    assert "2. at vertex" in text
    assert "and 4 more" in text
