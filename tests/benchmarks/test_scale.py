"""Cost of the streaming pipeline by stage. See also scale_table.py, which runs whole commands."""

from pathlib import Path
from typing import Any

import pytest

from exactfold import random_square
from exactfold.branches.certificates.check import check_compact
from exactfold.branches.counting.stream import stream_branches
from exactfold.rigidity.equations.branch_system import chamber_chart
from exactfold.solve.certify.float_krawczyk import FloatKrawczyk
from exactfold.solve.numeric.dense_newton import NappeSystem
from exactfold.solve.numeric.nappe_newton import sign_vectors

SIZES = [4, 8]


@pytest.mark.parametrize("interior", SIZES)
def test_nappes(benchmark: Any, interior: int) -> None:
    system = NappeSystem(chamber_chart(random_square(interior, seed=1)))
    assert benchmark(system.ends, sign_vectors(0, 1 << interior, interior)).converged.all()


@pytest.mark.parametrize("interior", SIZES)
def test_float_krawczyk(benchmark: Any, interior: int) -> None:
    chart = chamber_chart(random_square(interior, seed=1))
    points = NappeSystem(chart).ends(sign_vectors(0, 1 << interior, interior)).points
    assert benchmark(FloatKrawczyk(chart.system).isolate, points, 40).proved.all()


@pytest.mark.parametrize("interior", SIZES)
def test_streaming(benchmark: Any, interior: int, tmp_path: Path) -> None:
    pattern, path = random_square(interior, seed=1), tmp_path / "c.txt"
    assert benchmark(stream_branches, pattern, path).distinct == 1 << interior


@pytest.mark.parametrize("fast", [True, False])
def test_checking(benchmark: Any, fast: bool, tmp_path: Path) -> None:
    stream_branches(random_square(6, seed=1), tmp_path / "c.txt")
    claims = benchmark(check_compact, tmp_path / "c.txt", fast=fast)
    assert claims["distinct"] == 64
