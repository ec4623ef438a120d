"""The batched homotopy: completeness on generic systems, honest reports on the others."""

from __future__ import annotations

import numpy as np
import pytest
from sampling import slow_after

from exactfold.errors import UsageError
from exactfold.pattern.families import flat_vertex_square
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.numeric import homotopy as module
from exactfold.solve.numeric.homotopy import homotopy


def random_system(n: int, seed: int, size: int = 99) -> QuadraticSystem:
    rng = np.random.default_rng(seed)
    matrices = []
    for _ in range(n):
        matrix = rng.integers(-size, size + 1, (n + 1, n + 1))
        matrices.append((matrix + matrix.T).tolist())
    return QuadraticSystem.from_rational(matrices)


def relative_residual(system: QuadraticSystem, points: np.ndarray) -> float:
    z = np.hstack([points, np.ones((len(points), 1))])
    value = np.abs(np.einsum("pij,bi,bj->bp", system.float_tensor, z, z))
    size = np.einsum("pij,bi,bj->bp", np.abs(system.float_tensor), np.abs(z), np.abs(z))
    return float((value / size).max())


def smallest_gap(points: np.ndarray) -> float:
    gap = np.abs(points[:, None] - points[None]).max(axis=2)
    gap[np.diag_indices(len(points))] = np.inf
    return float(gap.min())


@pytest.mark.parametrize("n", [1, 2, 3, 5, 7])
@pytest.mark.parametrize("seed", slow_after(1, range(3)))
def test_generic_systems_have_two_to_the_n_distinct_zeros(n: int, seed: int) -> None:
    system = random_system(n, seed)
    found = homotopy(system)
    assert found.lost == ()
    assert found.points.shape == (2**n, n)
    assert relative_residual(system, found.points) < 1e-12
    assert smallest_gap(found.points) > 1e-7
    # a real system: the zeros come in conjugate pairs
    conjugate = np.abs(found.points[:, None] - found.points.conj()[None]).max(axis=2)
    assert (conjugate.min(axis=1) < 1e-8 * (1 + np.abs(found.points).max(axis=1))).all()


@pytest.mark.slow
def test_eight_interior_vertices() -> None:
    system = BranchSystem(random_square(8, seed=3)).chart.system
    found = homotopy(system)
    assert found.points.shape == (256, 8)
    assert np.abs(found.points.imag).max() < 1e-9
    assert smallest_gap(found.points) > 1e-9


def test_function_of_the_seed() -> None:
    system = random_system(4, 0)
    a, b, c = homotopy(system, seed=5), homotopy(system, seed=5), homotopy(system, seed=6)
    assert np.array_equal(a.points, b.points)
    assert a.settings == b.settings
    assert a.settings["seed"] == 5
    assert a.settings["paths"] == 16
    assert not np.array_equal(a.points, c.points)
    gap = np.abs(a.points[:, None] - c.points[None]).max(axis=2)
    assert (gap.min(axis=1) < 1e-8).all()


def test_global_random_state_is_left_alone() -> None:
    np.random.seed(1)
    before = np.random.get_state()[1].copy()
    homotopy(random_system(3, 0))
    assert np.array_equal(before, np.random.get_state()[1])


def test_blocks_do_not_change_what_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    system = random_system(5, 1)
    whole = homotopy(system)
    monkeypatch.setattr(module, "_BLOCK", 5)
    blocks = homotopy(system)
    gap = np.abs(whole.points - blocks.points).max()
    assert gap < 1e-8 * (1 + np.abs(whole.points).max())


def test_progress_counts_paths() -> None:
    calls: list[tuple[int, int]] = []
    homotopy(random_system(3, 0), progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (8, 8)
    assert calls == sorted(calls)


def test_zeros_at_infinity_are_named() -> None:
    found = homotopy(QuadraticSystem.from_rational([[[0, 1], [1, -6]]]))
    assert found.points.real.ravel() == pytest.approx([3.0])
    assert len(found.lost) == 1
    assert "infinity" in found.lost[0]


@pytest.mark.parametrize("seed", range(3))
def test_double_zero_is_not_hidden(seed: int) -> None:
    # Multiplicities 2, 1, 1. What arrives at the double zero is not certified.
    system = BranchSystem(flat_vertex_square()).chart.system
    found = homotopy(system, seed=seed)
    assert found.points.shape == (4, 2)
    boxes = [b for b in krawczyk(system, found.points) if isinstance(b, IsolatingBox)]
    assert len(boxes) == 2


@pytest.mark.parametrize(
    "matrices",
    [
        [[[0, 0], [0, 0]]],
        [[[0, 0], [0, 1]]],
        [[[1, 0, 0], [0, 1, 0], [0, 0, -1]]] * 2,
        [[[1, 0, 0], [0, 0, 0], [0, 0, 0]], [[0, 1, 0], [1, 0, 0], [0, 0, 0]]],
    ],
    ids=["zero", "constant", "one curve twice", "plane at x = 0"],
)
def test_degenerate_systems_end_with_every_path_named(matrices: list[list[list[int]]]) -> None:
    found = homotopy(QuadraticSystem.from_rational(matrices))
    assert len(found.points) <= 1 << len(matrices)
    assert len(found.lost) == 1 << len(matrices)
    assert np.isfinite(found.points).all()


def test_a_system_without_unknowns() -> None:
    with pytest.raises(UsageError, match="no paths"):
        homotopy(QuadraticSystem(()))


def test_badly_scaled_unknowns_and_equations() -> None:
    # x_p^2 = 10^(12 p) in units that differ by 10^6 each, one equation scaled by 2^70
    n = 4
    matrices = []
    for p in range(n):
        matrix = [[0] * (n + 1) for _ in range(n + 1)]
        matrix[p][p] = 1 << (70 if p == 1 else 0)
        matrix[n][n] = -(10 ** (12 * p)) << (70 if p == 1 else 0)
        matrix[p][n] = matrix[n][p] = (-1) ** p
        matrices.append(matrix)
    found = homotopy(QuadraticSystem.from_rational(matrices))
    assert found.lost == ()
    size = np.abs(found.points) / 10.0 ** (6 * np.arange(n))
    assert (size > 0.4).all()
    assert (size < 2.5).all()


def test_balanced_forms_are_orthonormal_and_equivalent() -> None:
    tensor = random_system(4, 2).float_tensor * np.array([1.0, 1e-9, 1e5, 1.0])[:, None, None]
    powers, plain = module._equilibrate(tensor)
    forms, change = module._operator_scaling(plain)
    assert np.einsum("pij,qij->pq", forms, forms) == pytest.approx(np.eye(4), abs=1e-10)
    assert (np.log2(powers) == np.round(np.log2(powers))).all()
    w = np.random.default_rng(0).standard_normal(5)
    old = np.einsum("pij,i,j->p", plain, change @ w, change @ w)
    new = np.einsum("pij,i,j->p", forms, w, w)
    # both vanish together: the new values are a nonsingular combination of the old ones
    flat_old = np.einsum("pij,ia,jb->pab", plain, change, change).reshape(4, -1)
    combination = forms.reshape(4, -1) @ np.linalg.pinv(flat_old)
    assert combination @ old == pytest.approx(new, rel=1e-8, abs=1e-8)


def test_paths_that_meet_are_found() -> None:
    rng = np.random.default_rng(0)
    w = rng.standard_normal((6, 3)) + 1j * rng.standard_normal((6, 3))
    w[4] = w[1] * (0.3 - 2j)
    w[5] = w[1] * 1j
    reached = np.ones(6)
    probe = rng.standard_normal((2, 3)) + 1j * rng.standard_normal((2, 3))
    assert module._meetings(w, reached, probe).tolist() == [-1, -1, -1, -1, 1, 1]
    reached[1] = 0.5
    assert module._meetings(w, reached, probe).tolist() == [-1, -1, -1, -1, -1, 4]


def test_careless_first_pass_is_repaired(monkeypatch: pytest.MonkeyPatch) -> None:
    careless = module._Tolerances(predict=0.3, correct=10.0, shortest=1e-3, rounds=40)
    monkeypatch.setattr(module, "_Tolerances", lambda: careless)
    system = random_system(5, 4)
    found = homotopy(system)
    assert int(found.settings["retried"]) > 0
    assert found.lost == ()
    assert found.points.shape == (32, 5)
    assert smallest_gap(found.points) > 1e-7


def test_every_lost_path_gets_its_own_line() -> None:
    powers, plain = module._equilibrate(random_system(2, 0).float_tensor)
    scaled = module._Balanced(*module._operator_scaling(plain), powers, plain)
    w = np.ones((4, 3), dtype=np.complex128)
    w[2] = np.linalg.solve(scaled.to_y, [1.0, 2.0, 0.0])
    reached = np.array([1.0, 1.0, 1.0, 0.25])
    met = np.array([-1, 0, -1, -1])
    points, lost = module._collect(scaled, module._Run(w, reached, np.ones(4), met, 2, 9))
    assert points.shape == (1, 2)
    assert lost == (
        "path 1 ended at the same point as path 0",
        "path 2 ended at infinity",
        "path 3 stalled at 1 - T = 7.5e-01",
    )


def test_two_zeros_at_distance_2e_7_are_told_apart() -> None:
    # Rounding noise near the end of these paths exceeds a fixed tolerance on the corrector.
    found = homotopy(BranchSystem(random_square(7, seed=27)).chart.system)
    assert found.lost == ()
    assert found.points.shape == (128, 7)
    assert 1e-8 < smallest_gap(found.points) < 1e-6
