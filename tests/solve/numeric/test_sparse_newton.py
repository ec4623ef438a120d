"""The sparse Newton solver of one branch."""

import numpy as np
import pytest

from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import BranchFinder, find_branch
from exactfold.pattern.triangulating.random_squares import random_square, sample_random_square
from exactfold.solve.numeric import sparse_newton
from exactfold.solve.numeric.sparse_newton import End, Point, equations, solve


def test_on_a_regular_cone_a_row_is_that_of_its_line() -> None:
    """N = 0 there, to rounding errors, and its root has no gradient."""
    lines = np.array([0.5, 0.5, -0.5])
    excess = lines**2 * [1, 1 - 1e-15, 1 + 1e-15]
    point = Point(np.zeros(3), np.zeros(0), lines, excess)
    value, of_lines, of_forms = equations(None, point, np.ones(3))  # type: ignore[arg-type]
    assert value == pytest.approx(lines, rel=1e-6)
    assert (of_lines.tolist(), of_forms.tolist()) == ([1] * 3, [0] * 3)


def test_smoothed_and_plain_steps_end_at_the_same_zero(monkeypatch) -> None:
    pattern = sample_random_square(1100, 5, redraw=True).pattern
    sheet = BranchFinder(pattern)._floats
    signs = np.where(np.arange(sheet.n) % 3 == 0, 1.0, -1.0)
    smoothed = solve(sheet, signs)
    monkeypatch.setattr(sparse_newton, "MANY", sheet.n)
    plain = solve(sheet, signs)
    assert (smoothed.failure, plain.failure) == ("", "")
    assert not np.array_equal(smoothed.x, plain.x)  # they came along different ways
    assert np.abs(smoothed.x - plain.x).max() < 1e-8


def test_plain_steps_follow_where_smoothed_ones_fail(monkeypatch) -> None:
    monkeypatch.setattr(sparse_newton, "MANY", 0)
    plain, tried = sparse_newton._solve, []

    def smoothed_fails(sheet, signs, start, smoothing, progress):
        tried.append(bool(smoothing))
        if smoothing:
            return End(np.zeros(sheet.n), 7, "too many steps")
        return plain(sheet, signs, start, smoothing, progress)

    monkeypatch.setattr(sparse_newton, "_solve", smoothed_fails)
    pattern = random_square(6, seed=3)
    assert find_branch(pattern, "+-+-+-").status is PROVED
    assert tried == [True, False]
