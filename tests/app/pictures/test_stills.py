"""Stills of motions: one polygon for each face, the right side in front, text made safe."""

import xml.etree.ElementTree as ElementTree
from fractions import Fraction

import numpy as np
import pytest
from panel_sheets import miura

from exactfold import random_square
from exactfold.app.pictures.painting import back_to_front
from exactfold.app.pictures.stills import motion_stills, seen_from_above, stills
from exactfold.branches import find_branch
from exactfold.motion import follow, follow_panels
from exactfold.pattern.panel_pattern import PanelPattern

NAME = "{http://www.w3.org/2000/svg}"
BLUE, YELLOW = (86, 180, 233), (240, 228, 66)


def faces_of(text):
    return [p.attrib for p in ElementTree.fromstring(text).iter(f"{NAME}path")]


def is_blue(colour):
    red, blue = (int(colour[k : k + 2], 16) for k in (1, 5))
    return blue > red


def test_every_still_has_every_face_and_a_caption():
    sheet = random_square(3, seed=1)
    motion = follow(find_branch(sheet, "+-+"), frames=12)
    text = motion_stills(motion, 4, "a & b")
    tree = ElementTree.fromstring(text)
    assert len(faces_of(text)) == 4 * len(sheet.triangles)
    captions = [t.text for t in tree.iter(f"{NAME}text")]
    assert len(captions) == 4
    assert captions[0] == "flat"
    assert captions[-1].startswith("180°, t = ")
    assert tree.find(f"{NAME}title").text == "a & b: the sheet as it folds"


def test_the_upper_side_is_blue_and_the_lower_side_yellow():
    flat = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float)
    (up,) = faces_of(stills([flat], [(0, 1, 2)], [""], "t"))
    (down,) = faces_of(stills([flat], [(0, 2, 1)], [""], "t"))
    assert is_blue(up["fill"])
    assert not is_blue(down["fill"])


def test_nearer_faces_are_drawn_later():
    low = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float)
    both = np.vstack([low, low + np.array([0, 0, 1])])
    for faces in ([(0, 1, 2), (3, 5, 4)], [(3, 5, 4), (0, 1, 2)]):
        drawn = faces_of(stills([both], faces, [""], "t"))
        assert [is_blue(face["fill"]) for face in drawn] == [True, False]
    assert seen_from_above(both)[3:, 2].min() > seen_from_above(both)[:3, 2].min()


@pytest.mark.parametrize("turn", [0.4, 2.0])
def test_a_sheet_that_only_moves_looks_the_same(turn):
    """The stills are turned to lie as near the flat sheet as they can."""
    sheet = random_square(2, seed=0)
    motion = follow(find_branch(sheet, "+-"), frames=5)
    moved = motion.coords.copy()
    c, s = np.cos(turn), np.sin(turn)
    moved[1:] = moved[1:] @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + [3, 1, -2]
    other = motion.__class__(
        **{**{f: getattr(motion, f) for f in motion.__dataclass_fields__}, "coords": moved}
    )
    one, two = (
        [
            list(map(float, f["d"].replace("M", "").replace("Z", "").replace("L", " ").split()))
            for f in faces_of(motion_stills(m))
        ]
        for m in (motion, other)
    )
    assert np.abs(np.array(one) - np.array(two)).max() <= 0.011


def test_panels_are_polygons_that_keep_their_corners():
    motion = follow_panels(miura(2, 3), frames=6)
    text = motion_stills(motion, 3)
    paths = faces_of(text)
    assert len(paths) == 3 * len(motion.pattern.faces)
    assert {path["d"].count("L") for path in paths} == {3}
    assert "way 1" in ElementTree.fromstring(text).find(f"{NAME}title").text


def turned_to_the_eye(corners):
    """Points given by right, up and depth."""
    return np.array(corners, dtype=float) @ np.linalg.inv(seen_from_above(np.eye(3)))


@pytest.mark.parametrize("turn", [1, -1])
def test_a_long_face_lies_under_a_near_one_whatever_its_mean_depth(turn):
    """The long one comes nearer than the other, but not where they overlap."""
    long = [[0, 0, 0], [20, 0, 20], [20, 1, 20], [0, 1, 0]]
    short = [[0, 0.2, 3], [1, 0.2, 3], [1, 0.8, 3], [0, 0.8, 3]]
    pieces = [[(0, 1, 2), (0, 2, 3)], [(4, 5, 6), (4, 6, 7)]][::turn]
    view = np.array(long + short, dtype=float)
    order = back_to_front(view, pieces)
    assert order == ([0, 1] if turn > 0 else [1, 0])
    assert view[:4, 2].mean() > view[4:, 2].mean()
    shape = turned_to_the_eye(view)
    assert seen_from_above(shape) == pytest.approx(view)
    polygons = [(0, 1, 2, 3), (4, 5, 6, 7)][::turn]
    drawn = faces_of(stills([shape], polygons, [""], "t", pieces=pieces))
    places = [list(map(float, f["d"][1:-1].replace("L", " ").split()))[::2] for f in drawn]
    widths = [max(xs) - min(xs) for xs in places]
    assert widths[0] > 10 * widths[1]


def test_three_faces_in_a_circle_are_all_drawn():
    """Each lies over the next, as the flaps of a box do."""
    turns = [np.exp(2j * np.pi * k / 3) for k in range(3)]
    corners, pieces = [], []
    for t in turns:
        bar = [(-2 - 1j, 1), (2 - 1j, -1), (2 - 0.4j, -1), (-2 - 0.4j, 1)]
        corners += [[(t * z).real, (t * z).imag, depth] for z, depth in bar]
        k = len(corners) - 4
        pieces.append([(k, k + 1, k + 2), (k, k + 2, k + 3)])
    assert sorted(back_to_front(np.array(corners), pieces)) == [0, 1, 2]


@pytest.mark.parametrize("rate", [1, -1])
def test_layers_that_lie_on_each_other_are_drawn_as_they_came_there(rate):
    """Of two panels the second is folded over the first, or under it."""
    points = [(Fraction(x), Fraction(y)) for x in (0, 2, 4) for y in (0, 2)]
    sides = [(0, 1), (2, 3), (4, 5), (0, 2), (2, 4), (1, 3), (3, 5)]
    motion = follow_panels(PanelPattern(points, sides), amounts={(2, 3): rate}, frames=30)
    last = faces_of(motion_stills(motion, 2))[2:]
    assert [is_blue(face["fill"]) for face in last] == [rate > 0, rate < 0]
