"""The refinement of heights: its Jacobians with and without pivots off the diagonal."""

import random
from dataclasses import replace

import numpy as np
import pytest

from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import BranchFinder, find_branch
from exactfold.pattern.triangulating.random_squares import random_square, sample_random_square
from exactfold.solve.certify import refinement
from exactfold.solve.certify.enclosure import curvatures
from exactfold.solve.certify.refinement import exact, refine
from exactfold.solve.numeric.sparse_newton import solve
from exactfold.solve.numeric.sparse_sheet import FloatSheet


@pytest.fixture
def finder():
    return BranchFinder(random_square(12, seed=3))


def test_pivots_change_no_solution(finder) -> None:
    floats = finder._floats
    rng = np.random.default_rng(1)
    x = rng.random(floats.n)
    omega = floats.bends(floats.heights(x))
    rows, right = rng.random((2, floats.n)), rng.random(floats.n)
    dense = floats.solve(omega, *rows, right)
    sparse = replace(floats, dense=0)
    for pivots in (False, True):
        found = sparse.solve(omega, *rows, right, pivots=pivots)
        assert found == pytest.approx(dense, rel=1e-9)


def test_steps_that_run_away_are_given_up_and_taken_with_pivots(finder, monkeypatch) -> None:
    sheet, floats = finder.sheet, finder._floats
    signs = np.array([1.0, -1.0] * 6)
    start = exact(sheet, floats, solve(floats, signs).x)
    expected = refine(sheet, floats, signs, start, 160)
    asked, plain = [], FloatSheet.solver

    def inexact(self, *arguments, pivots=False):
        asked.append(pivots)
        factored = plain(self, *arguments)
        return lambda right: factored(right) + (0.0 if pivots else 1.0)

    monkeypatch.setattr(FloatSheet, "solver", inexact)
    found = refine(sheet, floats, signs, start, 160)
    assert found.values.tolist() == expected.values.tolist()
    assert asked[0] is False
    assert asked.count(False) < 5


def test_patches_lead_to_the_same_heights(monkeypatch) -> None:
    finder = BranchFinder(sample_random_square(150, 4, redraw=True).pattern)
    sheet, floats = finder.sheet, replace(finder._floats, dense=0)
    signs = np.array([random.Random(2).choice((1.0, -1.0)) for _ in range(floats.n)])
    start = exact(sheet, floats, solve(floats, signs).x)
    expected = refine(sheet, floats, signs, start, 160)
    mended = []
    take = refinement._mended

    def counted(*given) -> bool:
        mended.append(take(*given))
        return mended[-1]

    monkeypatch.setattr(refinement, "MANY", 10)
    monkeypatch.setattr(refinement, "FEW", 0.0)
    monkeypatch.setattr(
        refinement,
        "patches",
        lambda floats, sizes: np.flatnonzero(floats.near(sizes == sizes.max(), 2)),
    )
    monkeypatch.setattr(refinement, "_mended", counted)
    found = refine(sheet, floats, signs, start, 160)
    assert True in mended
    curvature = curvatures(sheet.folds, found.values, found.bits)
    for name in ("bends", "low", "high"):
        assert (getattr(curvature, name) == getattr(found.curvature, name)).all()
    differences = found.values * expected.denominator - expected.values * found.denominator
    assert abs(differences).max() < found.denominator * expected.denominator >> 60


@pytest.mark.slow
def test_a_flat_star_that_needs_pivots_is_proved() -> None:
    pattern = sample_random_square(10_000, 1, redraw=True).pattern
    source = random.Random(9)
    branch = find_branch(pattern, "".join(source.choice("+-") for _ in range(10_000)))
    assert branch.status is PROVED
    assert branch.multiplicity == 4
