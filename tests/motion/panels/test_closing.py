"""Folds whose angles can be chosen independently, found in two ways."""

from __future__ import annotations

import numpy as np
import pytest

from exactfold.motion.panels import closing
from exactfold.motion.panels.closing import Closing
from exactfold.pattern.loading import open_sheet


@pytest.mark.parametrize("rank", [0, 7, 20])
def test_kernels_by_factors_with_pivots_are_those_by_singular_values(rank: int) -> None:
    rng = np.random.default_rng(1)
    matrix = rng.normal(size=(40, rank)) @ rng.normal(size=(rank, 20))
    one, other = closing._kernel(matrix), closing._kernel_of_many(matrix)
    assert one.shape == other.shape == (20 - rank, 20)
    assert one.T @ one == pytest.approx(other.T @ other, abs=1e-12)


def test_large_sheets_have_as_many_independent_folds(monkeypatch: pytest.MonkeyPatch) -> None:
    closed = Closing(open_sheet("miura").sheet)
    angles = np.zeros(len(closed.pattern.folds))
    expected = closed.drivers(angles)
    monkeypatch.setattr(closing, "_DENSE", 0)
    assert len(closed.drivers(angles)) == len(expected) > 1
