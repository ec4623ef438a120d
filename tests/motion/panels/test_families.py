"""One motion of a family: its start, its path, its end, and the folds that are free."""

import numpy as np
import pytest

from exactfold.design import match_panels
from exactfold.errors import NotFollowedError
from exactfold.motion import follow_panels
from exactfold.motion.panels.closing import Closing
from exactfold.motion.panels.families import follow_family
from exactfold.motion.panels.motion import closing_residual
from exactfold.pattern.loading import open_sheet
from exactfold.pattern.opening import panels


@pytest.fixture(scope="module")
def bird():
    return match_panels("bird-base")


def test_the_derivative_of_the_closing_conditions_is_that_of_differences(bird):
    closing = Closing(bird.pattern)
    angles = np.random.default_rng(1).normal(size=len(bird.pattern.folds))
    step = 1e-6
    differences = [
        (closing.values(angles + step * e) - closing.values(angles - step * e)) / (2 * step)
        for e in np.eye(len(angles))
    ]
    found = closing.derivative(angles).toarray()
    assert np.allclose(found, np.array(differences).T, atol=1e-8)
    worst = float(np.abs(closing.values(angles)).max())
    assert worst == pytest.approx(closing_residual(bird.pattern, angles[None]), abs=1e-14)


def test_corrected_angles_close_and_rates_within_keep_closing(bird):
    closing = Closing(bird.pattern)
    motion = follow_family(bird.pattern, bird.densities, frames=9)
    middle = motion.angles[4]
    generator = np.random.default_rng(2)
    near = middle + 0.01 * generator.normal(size=len(middle))
    corrected = closing.corrected(near)
    assert closing_residual(bird.pattern, corrected[None]) < 1e-11
    rates = closing.within(middle, generator.normal(size=len(middle)))
    assert np.abs(closing.derivative(middle) @ rates).max() < 1e-9
    far = middle + 3 * generator.normal(size=len(middle))
    assert (
        closing.corrected(far) is None
        or np.abs(closing.values(closing.corrected(far))).max() < 1e-8
    )


def test_the_bird_base_folds_with_its_letters_until_panels_meet(bird):
    motion = follow_family(bird.pattern, bird.densities, frames=40)
    assert dict(motion.assignment) == dict(bird.letters)
    assert (motion.end, motion.dimension) == ("contact", 5)
    assert motion.length_error < 1e-10
    assert closing_residual(bird.pattern, motion.angles) < 1e-10
    small = motion.angles[1]
    signs = {"V": 1, "M": -1}
    for fold, angle in zip(bird.pattern.folds, small, strict=True):
        assert angle * signs[bird.letters[fold]] > 0
    assert np.degrees(np.abs(motion.angles[-1])).max() > 150
    assert np.allclose(motion.at(motion.times[7]), motion.coords[7], atol=1e-9)


def test_drivers_are_free_and_determine_the_rest(bird):
    closing = Closing(bird.pattern)
    motion = follow_family(bird.pattern, bird.densities, frames=9)
    rows = closing.derivative(motion.angles[4]).toarray()
    at = [bird.pattern.folds.index(fold) for fold in motion.drivers]
    others = [k for k in range(len(bird.pattern.folds)) if k not in at]
    assert np.linalg.matrix_rank(rows[:, others], tol=1e-7) == len(others)
    assert np.linalg.matrix_rank(rows, tol=1e-7) == len(others)


def test_a_single_mode_is_the_motion_that_is_known_exactly():
    sheet = panels(open_sheet("single-vertex-4").sheet)
    exact = follow_panels(sheet, until="120deg", frames=7)
    rates = exact.angles_at(np.array([1e-3]))[0]
    points = np.array([(float(x), float(y)) for x, y in sheet.vertices])
    densities = {
        (i, j): rate / float(np.linalg.norm(points[i] - points[j]))
        for (i, j), rate in zip(sheet.folds, rates, strict=True)
    }
    motion = follow_family(sheet, densities, frames=200)
    driver = int(np.abs(exact.angles[-1]).argmax())
    for row in exact.angles[1:]:
        near = [
            np.interp(abs(row[driver]), np.abs(motion.angles[:, driver]), c)
            for c in motion.angles.T
        ]
        assert np.allclose(near, row, atol=2e-3)


def test_directions_without_a_motion_are_refused(bird):
    with pytest.raises(NotFollowedError, match="all folds stay flat"):
        follow_family(bird.pattern, {})
    wrong = dict.fromkeys(bird.pattern.folds, 1.0)
    with pytest.raises(NotFollowedError, match="was not found in floats"):
        follow_family(bird.pattern, wrong)
