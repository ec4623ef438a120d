"""Plots of fold angles, and the pieces of SVG pictures."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from exactfold import random_square
from exactfold.app.pictures import svg
from exactfold.app.report import angles_plot
from exactfold.branches import find_branch
from exactfold.motion import follow

NAME = "{http://www.w3.org/2000/svg}"


def drawn(motion, title=""):
    root = ET.fromstring(angles_plot(motion, title))
    width, height = float(root.get("width")), float(root.get("height"))
    assert root.get("viewBox") == f"0 0 {svg.number(width)} {svg.number(height)}"
    return root, width, height


def texts(root):
    return {element.text: element for element in root.iter(f"{NAME}text")}


def test_every_fold_has_a_line_and_a_label_that_meets_no_other():
    motion = follow(find_branch(random_square(8, seed=1), "++++++++"), frames=5)
    root, width, height = drawn(motion, "a <b> & c")
    assert "a <b> & c" in next(iter(root.iter(f"{NAME}title"))).text
    paths = list(root.iter(f"{NAME}path"))
    folds = motion.branch.pattern.folds
    assert len(paths) == len(folds) == 25
    styles = {(path.get("stroke"), path.get("stroke-dasharray")) for path in paths}
    assert len(styles) == 25
    found = texts(root)
    labels = [found[f"{i}-{j}"] for i, j in folds]
    places = sorted(float(label.get("y")) for label in labels)
    assert np.diff(places).min() >= 13 - 0.02
    assert places[0] > 0
    assert places[-1] < height
    assert all(0 < float(label.get("x")) < width - 30 for label in labels)


def test_lines_are_the_angles_on_the_axes():
    motion = follow(find_branch("two-vertex", "+-"), until="90deg", frames=3)
    root, _, _ = drawn(motion)
    found = texts(root)
    high, zero = (float(found[name].get("y")) - 4 for name in ("60°", "0°"))
    degree = (zero - high) / 60
    first, second = (float(found[name].get("x")) for name in ("0", "1"))
    for path, angles in zip(root.iter(f"{NAME}path"), motion.angles.T, strict=True):
        points = [
            [float(x) for x in pair.split()] for pair in path.get("d").removeprefix("M").split("L")
        ]
        x, y = points[-1]
        assert (x - first) / (second - first) == pytest.approx(motion.duration, abs=1e-3)
        assert (zero - y) / degree == pytest.approx(np.degrees(angles[-1]), abs=0.1)
        assert points[0] == pytest.approx([first, zero], abs=0.02)


def test_events_are_named_lines():
    motion = follow(
        find_branch(random_square(8, seed=1), "+-++--+-"), frames=3, through_branch_points=True
    )
    root, _, _ = drawn(motion)
    names = " ".join(name for name in texts(root) if name)
    assert "4 folds turn back" in names
    assert "node" in names
    assert "contact" in names
    upright = {line.get("x1") for line in root.iter(f"{NAME}line") if line.get("y1") == "150"}
    times = {round(event.time[1], 6) for event in motion.events}
    assert len(upright) == len(times)


def test_of_many_folds_none_has_a_label():
    motion = follow(find_branch(random_square(30, seed=1), "+-" * 15), frames=3)
    root, _, _ = drawn(motion)
    folds = motion.branch.pattern.folds
    assert len(list(root.iter(f"{NAME}path"))) == len(folds) == 91
    assert not {f"{i}-{j}" for i, j in folds} & set(texts(root))
    colours = [path.get("stroke") for path in root.iter(f"{NAME}path")]
    for colour, letter in zip(colours, motion.branch.assignment_text, strict=True):
        assert colour == {"V": svg.VALLEY, "M": svg.MOUNTAIN}[letter]


places = st.lists(st.floats(0, 100), min_size=1, max_size=12)


@given(places)
def test_spread_places_keep_their_distance_and_their_order(given_places):
    found = svg.spread(given_places, 5, -20, 120)
    order = np.argsort(given_places, kind="stable")
    assert np.all(np.diff(np.array(found)[order]) >= 5 - 1e-9)
    assert min(found) >= -20 - 1e-9
    assert max(found) <= 120 + 1e-9
    if np.all(np.diff(np.sort(given_places)) >= 5):
        assert found == given_places


@given(st.floats(-1000, 1000), st.floats(1e-3, 1000), st.integers(3, 12))
def test_ticks_are_round_and_few(low, span, most):
    found = svg.ticks(low, low + span, most)
    assert len(found) <= most
    steps = np.diff(found)
    if len(found) > 2:
        assert steps == pytest.approx(np.full(len(steps), steps[0]), rel=1e-6)
    assert all(low - 1e-6 * span <= x <= low + span * (1 + 1e-6) for x in found[1:])


def test_text_is_escaped():
    assert ET.fromstring(svg.text('<&">', 0, 0)).text == '<&">'
    assert ET.fromstring(svg.element("a", b_='<"')).get("b") == '<"'
    whole = svg.picture(10, 5, [svg.path([(0, 0), (1, 1)], closed=True)], "<")
    assert ET.fromstring(whole)[2].get("d") == "M0 0L1 1Z"
