"""One suite for every solver: each finds all zeros of small systems, counted, and repeatably.

Everything in the registry is tested on branch systems; the two that take any quadrics on others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
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
from plain_solver import random_newton
from sheets import dart

from exactfold import checker
from exactfold._support.verdict import PROVED
from exactfold.branches import certificate, count_branches
from exactfold.branches.counting.registry import (
    find_candidates,
    register_solver,
    solvers,
    unregister_solver,
)
from exactfold.pattern.families import (
    flat_vertex_square,
    h1_sequence,
    hypar,
    single_vertex,
    two_vertex,
)
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart, chamber_chart
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.homotopy import homotopy

SystemSolver = Callable[[QuadraticSystem], Candidates]


def by_groebner(system: QuadraticSystem) -> Candidates:
    return groebner(system).candidates


engines = pytest.mark.parametrize("solve", [homotopy, by_groebner])


def check_found(found: Candidates, roots: list[Root]) -> None:
    """One candidate per known zero, and nothing else."""
    assert found.points.shape == (len(roots), len(roots[0]))
    known = np.array([approx(root) for root in roots])
    distance = np.abs(found.points[:, None, :] - known[None, :, :]).max(axis=2)
    scale = 1 + np.abs(known).max(axis=1)
    assert (distance.min(axis=0) <= 1e-8 * scale).all()
    assert sorted(distance.argmin(axis=1).tolist()) == list(range(len(roots)))


@engines
def test_circle_and_line_pair(solve: SystemSolver) -> None:
    found = solve(CIRCLE_AND_AXES)
    check_found(found, circle_and_axes())
    assert found.lost == ()


@engines
@pytest.mark.parametrize("n", [1, 2, 3])
@pytest.mark.parametrize("conjugate", [0, 1])
def test_products_of_forms(solve: SystemSolver, n: int, conjugate: int) -> None:
    pairs = random_pairs(20 + n, n, conjugate=conjugate)
    found = solve(system_of(pairs))
    check_found(found, roots_of(pairs))
    assert found.lost == ()


@engines
def test_only_nonreal_zeros(solve: SystemSolver) -> None:
    pairs = random_pairs(3, 3, conjugate=3)
    found = solve(system_of(pairs))
    check_found(found, roots_of(pairs))
    assert (np.abs(found.points.imag).max(axis=1) > 1e-6).all()


@engines
def test_candidates_are_good_enough_to_certify(solve: SystemSolver) -> None:
    pairs = random_pairs(31, 3, conjugate=1)
    system, roots = system_of(pairs), roots_of(pairs)
    boxes = krawczyk(system, solve(system).points)
    assert all(isinstance(box, IsolatingBox) for box in boxes)
    for root in roots:
        assert sum(contains(box, root) for box in boxes if isinstance(box, IsolatingBox)) == 1


@engines
def test_coefficients_of_seventy_bits(solve: SystemSolver) -> None:
    pairs = random_pairs(9, 2, size=2**35)
    check_found(solve(system_of(pairs)), roots_of(pairs))


@engines
def test_zero_at_infinity_of_the_chart(solve: SystemSolver) -> None:
    # (x - 2)(y) = 0 and x (y - 1) = 0: zeros (2, 1) and (0, 0), and two at infinity
    system = QuadraticSystem.from_rational(
        [[[0, 1, 0], [1, 0, -2], [0, -2, 0]], [[0, 1, -1], [1, 0, 0], [-1, 0, 0]]]
    )
    zero = Fraction(0)
    roots = [((Fraction(2), zero), (Fraction(1), zero)), ((zero, zero), (zero, zero))]
    check_found(solve(system), roots)


@engines
def test_equal_calls_give_equal_results(solve: SystemSolver) -> None:
    system = system_of(random_pairs(4, 3, conjugate=1))
    first, second = solve(system), solve(system)
    assert np.array_equal(first.points, second.points)
    assert first.settings == second.settings


# --- the branch systems: whatever is in the registry, and a solver of one's own ------------------

PATTERNS = {
    "single vertex": single_vertex(4),
    "two vertices": two_vertex(),
    "random square of three": random_square(3, seed=1),
    "random square of four": random_square(4, seed=2),
    "hypar": hypar(1),
    "H1": h1_sequence(4),
    "reflex corner": dart(),
}
patterns = pytest.mark.parametrize("name", PATTERNS)


@pytest.fixture(params=[*solvers(), "plain"])
def method(request: pytest.FixtureRequest) -> Iterator[str]:
    """The name of each registered solver; one of them is registered here."""
    if request.param != "plain":
        yield request.param
        return
    register_solver("plain", random_newton, description="Newton's method from random starts")
    yield "plain"
    unregister_solver("plain")


@patterns
def test_branch_systems_have_two_to_the_n_branches(method: str, name: str) -> None:
    chart = chamber_chart(PATTERNS[name])
    n = chart.system.size
    found = find_candidates(chart, method)
    assert (found.method, found.lost) == (method, ())
    assert found.points.shape == (2**n, n)
    assert found.points.dtype == np.complex128
    boxes = [box for box in krawczyk(chart.system, found.points) if isinstance(box, IsolatingBox)]
    assert len(boxes) == 2**n
    assert all(box.is_real for box in boxes)
    assert all(a.is_disjoint_from(b) for i, a in enumerate(boxes) for b in boxes[:i])


@patterns
def test_counts_are_proved_and_agree(method: str, name: str) -> None:
    pattern = PATTERNS[name]
    result = count_branches(pattern, method=method, seed=3)
    assert (result.status, result.method) == (PROVED, method)
    assert result.distinct == result.real == 1 << pattern.Vi
    claims = checker.check(certificate(result))
    assert claims["distinct"] == result.distinct
    expected = count_branches(pattern)
    assert [(b.sign_text, b.assignment_text) for b in result.branches] == [
        (b.sign_text, b.assignment_text) for b in expected.branches
    ]


def test_equal_seeds_give_equal_candidates(method: str) -> None:
    chart = BranchSystem(random_square(3, seed=4)).chart
    first, second = (find_candidates(chart, method, seed=5) for _ in range(2))
    assert np.array_equal(first.points, second.points)
    assert (first.settings, first.lost) == (second.settings, second.lost)


def test_progress_does_not_go_back_and_an_interruption_stops_the_solver(method: str) -> None:
    chart = BranchSystem(random_square(3, seed=4)).chart
    seen: list[tuple[int, int]] = []
    find_candidates(chart, method, progress=lambda done, total: seen.append((done, total)))
    assert seen == sorted(seen)
    assert all(0 <= done <= total for done, total in seen)
    assert len({total for _, total in seen}) <= 1

    class StoppedError(Exception):
        pass

    def stop(done: int, total: int) -> None:
        raise StoppedError

    if seen:
        with pytest.raises(StoppedError):
            find_candidates(chart, method, progress=stop)


def test_a_double_zero_is_no_reason_to_fail(method: str) -> None:
    """Candidates near each zero; that one of them is double is for others to prove."""
    chart = BranchSystem(flat_vertex_square()).chart
    found = find_candidates(chart, method)
    exact = groebner(chart.system).approx_points()
    assert len(exact) == 3
    distance = np.abs(found.points[:, None, :] - exact[None, :, :]).max(axis=2)
    simple = [k for k, m in enumerate(multiplicities(chart)) if m == 1]
    assert (distance.min(axis=0)[simple] < 1e-8).all()
    assert found.points.shape[1] == chart.system.size


def multiplicities(chart: Chart) -> list[int]:
    """Of the zeros in the order of `approx_points`."""
    return [c.multiplicity for c in groebner(chart.system).classes for _ in range(c.degree)]
