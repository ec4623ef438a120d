"""Cost of each stage by size. Run with: python -m pytest tests/benchmarks --benchmark-enable."""

from typing import Any

import pytest

from exactfold import checker, random_square
from exactfold.branches import certificate, count_branches
from exactfold.rigidity import BranchSystem
from exactfold.solve import isolate
from exactfold.solve.algebraic.from_roots import parametrisation_from_roots
from exactfold.solve.numeric.homotopy import homotopy
from exactfold.solve.numeric.popping import popping

SIZES = [4, 6, 8]


@pytest.mark.parametrize("interior", SIZES)
def test_popping(benchmark: Any, interior: int) -> None:
    chart = BranchSystem(random_square(interior, seed=1)).chart
    assert len(benchmark(popping, chart).points) == 1 << interior


@pytest.mark.parametrize("interior", SIZES)
def test_homotopy(benchmark: Any, interior: int) -> None:
    system = BranchSystem(random_square(interior, seed=1)).chart.system
    assert len(benchmark(homotopy, system).points) == 1 << interior


@pytest.mark.parametrize("interior", SIZES)
def test_isolation(benchmark: Any, interior: int) -> None:
    chart = BranchSystem(random_square(interior, seed=1)).chart
    assert benchmark(isolate, chart.system, popping(chart)).real == 1 << interior


@pytest.mark.parametrize("interior", SIZES)
def test_whole_count(benchmark: Any, interior: int) -> None:
    assert benchmark(count_branches, random_square(interior, seed=1)).distinct == 1 << interior


@pytest.mark.parametrize("interior", SIZES)
def test_checker(benchmark: Any, interior: int) -> None:
    made = certificate(count_branches(random_square(interior, seed=1)))
    claims = benchmark(checker.check, made)
    assert claims["distinct"] == 1 << interior


@pytest.mark.parametrize("interior", [4, 6, pytest.param(8, marks=pytest.mark.survey)])
def test_parametrisation_from_roots(benchmark: Any, interior: int) -> None:
    chart = BranchSystem(random_square(interior, seed=1)).chart
    rounds = {"rounds": 1 if interior == 8 else 3, "iterations": 1}
    found = benchmark.pedantic(parametrisation_from_roots, (chart.system, popping(chart)), **rounds)
    assert found.degree == 1 << interior
