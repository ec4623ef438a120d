"""Motions of rigid panels as values: their exact positions, copies, and samples."""

import copy
import pickle
from fractions import Fraction
from math import inf, pi, radians

import numpy as np
import pytest
from folding_panels import lengths_kept, strip
from panel_sheets import (
    grid,
    mesh,
    miura,
    regular_twist,
)

from exactfold._support.verdict import PROVED
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.surds import RATIONALS
from exactfold.motion.panels.following import follow_panels

ROOT3 = RATIONALS.adjoined(3).root


def miura_60(rows, zigzags):
    """A Miura-ori with sectors of 60 degrees, in Q(sqrt 3)."""
    return grid(zigzags + 1, rows + 1, lambda i, j: (Fraction(2 * i + j % 2), ROOT3 * j))


@pytest.mark.parametrize(
    "pattern",
    [
        miura(2, 2),
        miura_60(2, 2),
        regular_twist(4, (Fraction(3), Fraction(-5))),
        regular_twist(4, (Fraction(0), Fraction(-5))),
    ],
)
def test_positions_at_a_rational_parameter_are_exact(pattern):
    motion = follow_panels(pattern, until="180deg", frames=5)
    assert motion.closes is PROVED
    for parameter in (Fraction(1, 7), 3, inf):
        spots = motion.exactly(parameter)
        assert lengths_kept(pattern, spots)
        driver = motion.drivers[0]
        ends = (np.array([float(c) for c in pattern.vertices[v]]) for v in driver)
        length = float(np.linalg.norm(next(ends) - next(ends)))
        half = pi / 2 if parameter == inf else np.arctan(float(parameter) * length)
        if len(motion.curves) == 1:
            floats = motion.at(min(2 * half, pi))
            assert np.allclose([[float(c) for c in s] for s in spots], floats, rtol=0, atol=1e-13)
    assert all(z == 0 for _, _, z in motion.exactly(inf))
    assert any(z != 0 for _, _, z in motion.exactly(1))


def test_the_ratios_of_the_miura_ori_are_exact():
    motion = follow_panels(miura_60(2, 2))
    [driver] = motion.drivers
    assert abs(motion.ratios[driver]) == 1
    # All folds have length 2: tan(straight / 2) is half of tan(zigzag / 2).
    assert {abs(c) for c in motion.ratios.values()} == {Fraction(1), Fraction(1, 2)}


def test_a_forged_ratio_does_not_close():
    """`exactly` checks at every corner that the panels meet."""
    motion = follow_panels(miura(2, 2))
    fold = next(f for f, c in motion.ratios.items() if f not in motion.drivers)
    turns = {f: (1, c) for f, c in motion.ratios.items()}
    motion._placing.exactly(turns)
    turns[fold] = (1, 2 * motion.ratios[fold])
    with pytest.raises(UsageError, match="do not close"):
        motion._placing.exactly(turns)


def test_a_followed_motion_has_no_exact_positions():
    motion = follow_panels(mesh(1, 2, seed=2))
    assert motion.ratios is None
    with pytest.raises(NotApplicableError, match="only in floats"):
        motion.exactly(1)
    with pytest.raises(UsageError, match="is a float"):
        follow_panels(miura(1, 1)).exactly(0.5)
    with pytest.raises(UsageError, match="mode 9 does not fold here"):
        follow_panels(miura(1, 1)).exactly({9: 1})


def test_motions_are_values():
    for pattern in (miura(2, 2), mesh(1, 2, seed=3), strip([3, 7, 3])):
        motion = follow_panels(pattern, until="100deg", frames=4)
        assert motion.ratios is None or motion.exactly(0)
        for other in (pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion)):
            assert other == motion
            assert np.array_equal(other.at(1.0), motion.at(1.0))
        assert motion != follow_panels(pattern, until="100deg", frames=5)


def test_samples_are_close_together():
    motion = follow_panels(mesh(1, 3, seed=1), until="180deg")
    times, angles = motion.sampled(300)
    assert len(times) >= 300
    assert np.abs(np.diff(angles, axis=0)).max() < radians(2.01)
    middle = motion.at(float(times[len(times) // 2]))
    assert middle.shape == motion.coords[0].shape
