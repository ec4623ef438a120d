"""Ranges of fold angles on a chain, against angles at many times."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from exactfold.branches.counting.find import find_branch
from exactfold.motion.contacts import fold_ranges as module
from exactfold.motion.contacts.fold_ranges import Stretch, fold_ranges
from exactfold.motion.contacts.stretches import on_start_tube, on_tube
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.tracks import follow_proved
from exactfold.pattern.triangulating.random_squares import random_square


@pytest.fixture(scope="module")
def there_and_back() -> tuple[Framework, list[Stretch]]:
    """From the flat state along a motion, and back the same way."""
    track = follow_proved(find_branch(random_square(2, seed=3), "+-"), until=0.8)
    stretches = [on_start_tube(track.start, 0, track.start.last)]
    stretches += [on_tube(x.tube, x.entry[0], x.exit) for x in track.links]
    back = [replace(x, begin=x.end, end=x.begin) for x in reversed(stretches)]
    return track.framework, [*stretches, *back]


def _angles(framework: Framework, stretch: Stretch) -> np.ndarray:
    s = np.linspace(stretch.begin, stretch.end, 40)
    powers = s[:, None] ** np.arange(len(stretch.coefficients))
    positions = np.einsum("sk,kvc->svc", powers, stretch.coefficients)
    return np.degrees(fold_angles_of(positions, framework.hinges))


@pytest.mark.parametrize("radius", [0.0, 1e-4])
def test_bounds_hold_all_angles_and_are_as_close_as_the_chain_allows(
    there_and_back: tuple[Framework, list[Stretch]],
    radius: float,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    framework, chain = there_and_back
    chain = [replace(x, radius=x.radius + radius) for x in chain]
    numbers: list[int] = []
    extremes = module._Parts.extremes

    def counted(self: module._Parts) -> tuple[np.ndarray, np.ndarray]:
        found = extremes(self)
        numbers.append(len(self.stretch))
        return found

    monkeypatch.setattr(module._Parts, "extremes", counted)
    ranges = fold_ranges(framework, chain, framework.sheet.folds)
    monkeypatch.setattr(module, "_IN_VAIN", 2.0)
    finer = fold_ranges(framework, chain, framework.sheet.folds)
    assert ranges is not None
    assert finer is not None
    # Where the radius is larger than the closeness asked for, more parts are hardly any closer.
    assert (numbers[1] >= 8 * numbers[0]) == (radius > 0)
    angles = np.concatenate([_angles(framework, x) for x in chain])
    for k, (fold, other) in enumerate(zip(ranges, finer, strict=True)):
        assert fold.turns == other.turns == 0
        low, high = angles[:, k].min(), angles[:, k].max()
        assert fold.least[0] <= low + 1e-6
        assert fold.greatest[1] >= high - 1e-6
        for ours, theirs in ((fold.least, other.least), (fold.greatest, other.greatest)):
            assert ours[1] - ours[0] <= 1.25 * (theirs[1] - theirs[0]) + 0.06  # degrees
