"""Stills of motions: one polygon for each face, the right side in front, text made safe."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

from exactfold import find_branch, follow, random_square
from exactfold.report.stills import _seen, motion_stills, stills

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
    assert captions[-1].startswith("180° at ")
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
    assert _seen(both)[3:, 2].min() > _seen(both)[:3, 2].min()


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
