"""What is followed of a sheet of panels: its modes and lines, each once."""

from dataclasses import replace
from itertools import combinations
from types import SimpleNamespace

import numpy as np
import pytest
from holed_sheets import ACROSS, FLAP, POP_UP

from exactfold._support.verdict import PROVED
from exactfold.errors import NotApplicableError, NotFollowedError
from exactfold.exact.surds import RATIONALS
from exactfold.motion.panels import followable
from exactfold.motion.panels.curves import curve_of
from exactfold.motion.panels.families import follow_family
from exactfold.motion.panels.following import follow_panels
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces.subspaces import Leaf


def test_lines_over_different_fields_are_told_apart():
    """A line in Q(sqrt 2) and others in Q(sqrt 3), one of them rational in truth."""
    two, three = (RATIONALS.adjoined(d).root for d in (2, 3))
    first, second, third = (
        Leaf({(0, 1): (1,), (1, 2): (last,)}, 1, ()) for last in (two, three, two * 0 + 1)
    )
    again = Leaf({(0, 1): (1,), (1, 2): (three * 0 + 1,)}, 1, ())
    part = SimpleNamespace(spaces=(first, second, third, again), found=())
    assert [*map(id, followable._lines(part))] == [*map(id, (first, second, third))]


@pytest.mark.parametrize("sheet", [ACROSS, FLAP, POP_UP], ids=["across", "flap", "pop-up"])
def test_lines_that_close_round_holes_are_followed(sheet):
    """Places found along a tree of panels keep the shapes of all panels, so that holes close."""
    motion = follow_panels(sheet, until="80deg", frames=3)
    assert motion.closes is PROVED
    for face in sheet.faces:
        for i, j in combinations(face, 2):
            sizes = np.linalg.norm(motion.coords[:, i] - motion.coords[:, j], axis=1)
            assert np.abs(sizes / sizes[0] - 1).max() < 1e-12
    assert np.ptp(motion.coords[-1, :, 2]) > 1


def test_a_pop_up_is_a_parallelogram_or_an_antiparallelogram():
    """The page and the step are links of the lengths 2, 1, 2 and 1."""
    parallel = follow_panels(POP_UP, way=2, until="80deg", frames=2)
    assert "".join(parallel.assignment[fold] for fold in POP_UP.folds) == "VVVMV"
    assert np.degrees(np.abs(parallel.angles[-1])) == pytest.approx([80] * 5)
    crossed = follow_panels(POP_UP, way=1, until="80deg", frames=2)
    assert "".join(crossed.assignment[fold] for fold in POP_UP.folds) == "VVVVM"


def test_motions_that_are_not_linear_are_not_followed_round_holes():
    """Densities that close one star only: all others are lines that do not close for all T."""
    mode = followable.panel_modes(decompose(POP_UP))[0]
    other = replace(mode, choice=tuple(replace(c, values=(1, 2, 3, 4)) for c in mode.choice))
    assert not other.is_linear
    with pytest.raises(NotApplicableError, match="round a hole are not proportional"):
        curve_of(other).angles(np.array([1.0]))
    with pytest.raises(NotFollowedError, match="not followed round holes"):
        follow_family(POP_UP, dict.fromkeys(POP_UP.folds, 1.0))
