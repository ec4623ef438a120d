"""One suite for every solver: each finds all zeros of small systems, counted, and repeatably."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
from known_systems import (
    CIRCLE_AND_AXES,
    Root,
    approx,
    circle_and_axes,
    contains,
    random_pairs,
    roots_of,
    system_of,
)

from exactfold.algebra.groebner import groebner
from exactfold.certify.box import IsolatingBox
from exactfold.certify.krawczyk import krawczyk
from exactfold.pattern.families import h1_sequence, hypar, single_vertex, two_vertex
from exactfold.pattern.random_squares import random_square
from exactfold.problem.branch_system import BranchSystem, Chart
from exactfold.problem.quadratic import QuadraticSystem
from exactfold.solve.candidates import Candidates
from exactfold.solve.homotopy import homotopy
from exactfold.solve.newton_ends import nappe_ends
from exactfold.solve.popping import popping

SystemSolver = Callable[[QuadraticSystem], Candidates]


def by_groebner(system: QuadraticSystem) -> Candidates:
    return groebner(system).candidates


solvers = pytest.mark.parametrize("solve", [homotopy, by_groebner])


def check_found(found: Candidates, roots: list[Root]) -> None:
    """One candidate per known zero, and nothing else."""
    assert found.points.shape == (len(roots), len(roots[0]))
    known = np.array([approx(root) for root in roots])
    distance = np.abs(found.points[:, None, :] - known[None, :, :]).max(axis=2)
    scale = 1 + np.abs(known).max(axis=1)
    assert (distance.min(axis=0) <= 1e-8 * scale).all()
    assert sorted(distance.argmin(axis=1).tolist()) == list(range(len(roots)))


@solvers
def test_circle_and_line_pair(solve: SystemSolver) -> None:
    found = solve(CIRCLE_AND_AXES)
    check_found(found, circle_and_axes())
    assert found.lost == ()


@solvers
@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("conjugate", [0, 1])
def test_products_of_forms(solve: SystemSolver, n: int, conjugate: int) -> None:
    pairs = random_pairs(20 + n, n, conjugate=conjugate)
    found = solve(system_of(pairs))
    check_found(found, roots_of(pairs))
    assert found.lost == ()


@solvers
def test_only_nonreal_zeros(solve: SystemSolver) -> None:
    pairs = random_pairs(3, 3, conjugate=3)
    found = solve(system_of(pairs))
    check_found(found, roots_of(pairs))
    assert (np.abs(found.points.imag).max(axis=1) > 1e-6).all()


@solvers
def test_candidates_are_good_enough_to_certify(solve: SystemSolver) -> None:
    pairs = random_pairs(31, 3, conjugate=1)
    system, roots = system_of(pairs), roots_of(pairs)
    boxes = krawczyk(system, solve(system).points)
    assert all(isinstance(box, IsolatingBox) for box in boxes)
    for root in roots:
        assert sum(contains(box, root) for box in boxes if isinstance(box, IsolatingBox)) == 1


@solvers
def test_coefficients_of_seventy_bits(solve: SystemSolver) -> None:
    pairs = random_pairs(9, 2, size=2**35)
    check_found(solve(system_of(pairs)), roots_of(pairs))


@solvers
def test_zero_at_infinity_of_the_chart(solve: SystemSolver) -> None:
    # (x - 2)(y) = 0 and x (y - 1) = 0: zeros (2, 1) and (0, 0), and two at infinity
    system = QuadraticSystem.from_rational(
        [[[0, 1, 0], [1, 0, -2], [0, -2, 0]], [[0, 1, -1], [1, 0, 0], [-1, 0, 0]]]
    )
    zero = Fraction(0)
    roots = [((Fraction(2), zero), (Fraction(1), zero)), ((zero, zero), (zero, zero))]
    check_found(solve(system), roots)


@solvers
def test_equal_calls_give_equal_results(solve: SystemSolver) -> None:
    system = system_of(random_pairs(4, 3, conjugate=1))
    first, second = solve(system), solve(system)
    assert np.array_equal(first.points, second.points)
    assert first.settings == second.settings


# --- the branch systems: two solvers take a chart, the others its quadrics -----------------------

PATTERNS = [
    ("single vertex", single_vertex(4), 1),
    ("two vertices", two_vertex(), 2),
    ("random square of three", random_square(3, seed=1), 3),
    ("random square of four", random_square(4, seed=2), 4),
    ("hypar", hypar(1), 4),
    ("H1", h1_sequence(4), 4),
]


def on_chart(solve: SystemSolver) -> Callable[[Chart], Candidates]:
    return lambda chart: solve(chart.system)


@pytest.mark.parametrize(
    "solve",
    [nappe_ends, popping, on_chart(homotopy), on_chart(by_groebner)],
    ids=["nappes", "popping", "homotopy", "groebner"],
)
@pytest.mark.parametrize(("name", "pattern", "n"), PATTERNS, ids=[p[0] for p in PATTERNS])
def test_branch_systems_have_two_to_the_n_branches(
    solve: Callable[[Chart], Candidates], name: str, pattern: object, n: int
) -> None:
    chart = BranchSystem(pattern).chart  # type: ignore[arg-type]
    found = solve(chart)
    assert found.points.shape == (2**n, n), name
    boxes = [box for box in krawczyk(chart.system, found.points) if isinstance(box, IsolatingBox)]
    assert len(boxes) == 2**n
    assert all(box.is_real for box in boxes)
    assert all(a.is_disjoint_from(b) for i, a in enumerate(boxes) for b in boxes[:i])
