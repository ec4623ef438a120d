"""Stills of a sheet folded by a given amount."""

import numpy as np
import pytest
from svg_reading import NAME, tree, words

from exactfold.app.pictures.folded import Amount, folded
from exactfold.branches import find_branch
from exactfold.errors import UsageError
from exactfold.motion import follow


@pytest.fixture(scope="module")
def motion():
    return follow(find_branch("two-vertex", "+-"), until="90deg", frames=10)


@pytest.mark.parametrize("degrees", [20.0, 90.0])
def test_the_largest_fold_angle_is_the_one_asked_for(motion, degrees):
    time = Amount(degrees=degrees).time(motion)
    again = follow(motion.branch, until=f"{degrees}deg", frames=2)
    assert time == pytest.approx(again.duration, abs=1e-3)
    still = folded(motion, Amount(degrees=degrees), "two")
    assert (still.degrees, still.reached) == (pytest.approx(degrees, abs=1e-5), True)
    assert words(still.text) == [f"two, branch +-: largest fold angle {degrees:.0f}°"]


def test_a_part_of_the_motion(motion):
    assert Amount(part=0.5).time(motion) == motion.duration / 2
    assert folded(motion, Amount(part=1.0)).degrees == pytest.approx(90, abs=1e-5)
    largest = np.degrees(np.abs(motion.angles)).max(axis=1)
    half = folded(motion, Amount(part=0.5)).degrees
    assert half == pytest.approx(np.interp(motion.duration / 2, motion.times, largest), abs=1)


def test_a_motion_that_ends_before(motion):
    still = folded(motion, Amount(degrees=120.0))
    assert (round(still.degrees, 4), still.reached, still.end) == (90, False, "angle")


def test_every_face_is_drawn_once(motion):
    text = folded(motion, Amount(degrees=45.0)).text
    assert len(list(tree(text).iter(f"{NAME}path"))) == len(motion.pattern.triangles)


@pytest.mark.parametrize(
    "text", ["60", "0", "-1deg", "181deg", "nan", "infdeg", "1_0deg", "half", ""]
)
def test_amounts_that_make_no_sense(text):
    with pytest.raises(UsageError, match="60deg"):
        Amount.of(text)
