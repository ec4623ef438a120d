"""Solvers of one's own: what is accepted, what a faulty one costs, and that it never lies."""

import copy
import pickle
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

import exactfold
from exactfold import random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import METHODS, count_branches, find_candidates
from exactfold.branches.counting.registry import choose, register_solver, solvers, unregister_solver
from exactfold.errors import NotApplicableError, SolverError, UsageError
from exactfold.pattern.families import two_vertex
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart
from exactfold.solve import Candidates
from exactfold.solve.numeric.popping import popping

CHART = BranchSystem(two_vertex()).chart
BUILT_IN = ("newton", "popping", "homotopy", "groebner")
Registrar = Callable[[Any], str]


@pytest.fixture
def register() -> Iterator[Registrar]:
    """Registers a solver as "mine" and forgets it after the test."""

    def add(solver: Any) -> str:
        register_solver("mine", solver, description="of this test")
        return "mine"

    yield add
    if "mine" in solvers():
        unregister_solver("mine")


def path_ends(chart: Chart, seed: int, progress: Any) -> Candidates:
    return popping(chart)


# --- names ---------------------------------------------------------------------------------------


def test_methods_are_auto_and_the_registry(register: Registrar) -> None:
    assert tuple(METHODS) == ("auto", *BUILT_IN) == ("auto", *solvers())
    register(path_ends)
    assert tuple(METHODS) == ("auto", *BUILT_IN, "mine")
    assert (len(METHODS), METHODS[-1], METHODS[1:3]) == (6, "mine", ("newton", "popping"))
    assert "mine" in METHODS
    assert exactfold.branches.METHODS is METHODS
    assert repr(METHODS) == repr(("auto", *BUILT_IN, "mine"))
    assert solvers()["mine"].solver is path_ends
    assert solvers()["mine"].description == "of this test"
    unregister_solver("mine")
    assert tuple(METHODS) == ("auto", *BUILT_IN)


def test_methods_compare_copy_and_pickle() -> None:
    for again in (copy.deepcopy(METHODS), pickle.loads(pickle.dumps(METHODS))):
        assert again == METHODS
        assert tuple(again) == tuple(METHODS)
    assert tuple(METHODS) == METHODS
    assert METHODS != ("auto",)


def test_what_solvers_returns_does_not_change_the_registry() -> None:
    solvers().clear()
    assert tuple(solvers()) == BUILT_IN


@pytest.mark.parametrize("name", ["auto", "nappes", *BUILT_IN])
def test_names_that_are_taken_are_refused(name: str) -> None:
    with pytest.raises(UsageError, match=f"there is a method '{name}' already"):
        register_solver(name, path_ends, description="")
    assert tuple(solvers()) == BUILT_IN


def test_a_name_is_registered_once(register: Registrar) -> None:
    register(path_ends)
    with pytest.raises(UsageError, match="there is a method 'mine' already"):
        register(popping)
    assert solvers()["mine"].solver is path_ends


@pytest.mark.parametrize("name", ["", "Mine", "my solver", "-x", "1st", "mine\n", None, 3])
def test_other_names_are_refused(name: Any) -> None:
    with pytest.raises(UsageError, match="cannot name a solver"):
        register_solver(name, path_ends, description="")


@pytest.mark.parametrize("solver", [None, "popping", 3, Candidates("x", np.zeros((0, 2)))])
def test_what_cannot_be_called_is_refused(solver: Any, register: Registrar) -> None:
    with pytest.raises(UsageError, match="'mine' cannot be called"):
        register(solver)
    assert "mine" not in solvers()


@pytest.mark.parametrize("name", ["mine", "auto", "nappes", *BUILT_IN])
def test_only_solvers_of_ones_own_are_forgotten(name: str) -> None:
    with pytest.raises(UsageError, match=f"no solver '{name}' was registered"):
        unregister_solver(name)


def test_the_earlier_name_of_newton_is_accepted_and_not_recorded() -> None:
    assert choose("nappes") == choose("newton")
    result = count_branches(two_vertex(), method="nappes")
    assert (result.status, result.method, result.why) == (PROVED, "newton", "as asked for")
    assert find_candidates(CHART, "nappes").method == "newton"
    assert "nappes" not in METHODS


# --- what a faulty solver costs ------------------------------------------------------------------


@pytest.mark.parametrize(
    "change", [lambda p: p, lambda p: p.astype(np.complex64), np.ndarray.tolist]
)
def test_a_solver_that_works_proves_the_count(change: Any, register: Registrar) -> None:
    """Points are taken as any array of numbers that NumPy reads."""

    def solver(chart: Chart, seed: int, progress: Any) -> Candidates:
        return Candidates("of no account", change(popping(chart).points))

    result = count_branches(random_square(3, seed=1), method=register(solver))
    assert (result.status, result.method, result.distinct) == (PROVED, "mine", 8)


@pytest.mark.parametrize(
    "error",
    [
        RuntimeError("out of patience"),
        KeyError("x"),
        AssertionError("no"),
        NotApplicableError("only on Sundays"),
        StopIteration(),
        np.linalg.LinAlgError("Singular matrix"),
        OverflowError("too large"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_exception_costs_the_proof_and_no_more(error: Exception, register: Registrar) -> None:
    def solver(chart: Chart, seed: int, progress: Any) -> Candidates:
        raise error

    found = find_candidates(CHART, register(solver))
    assert found.points.shape == (0, 2)
    (why,) = found.lost
    assert why.startswith("mine ")
    assert str(error) in why
    result = count_branches(two_vertex(), method="mine")
    assert result.status is UNDECIDED
    assert result.distinct is None
    assert "0 of 4 solutions isolated" in result.reason
    assert why in result.open_questions


@pytest.mark.parametrize("error", [MemoryError, KeyboardInterrupt, SystemExit])
def test_no_shortage_and_no_interruption_looks_like_an_answer(
    error: type[BaseException], register: Registrar
) -> None:
    def solver(chart: Chart, seed: int, progress: Any) -> Candidates:
        raise error

    with pytest.raises(error):
        count_branches(two_vertex(), method=register(solver))


def test_an_exception_of_the_progress_function_is_passed_on(register: Registrar) -> None:
    def solver(chart: Chart, seed: int, progress: Any) -> Candidates:
        progress(1, 2)
        return popping(chart)

    def stop(*event: object) -> None:
        raise RuntimeError("stop")

    with pytest.raises(RuntimeError, match="stop"):
        count_branches(two_vertex(), method=register(solver), progress=stop)


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        (None, "the solver 'mine' returned a NoneType, not Candidates"),
        (np.zeros((4, 2)), "returned a ndarray, not Candidates"),
        (Candidates("x", np.zeros((4, 3))), r"'mine' have shape \(4, 3\), not \(m, 2\)"),
        (Candidates("x", np.zeros(2)), r"have shape \(2,\), not \(m, 2\)"),
        (Candidates("x", np.zeros((2, 2, 2))), r"have shape \(2, 2, 2\), not \(m, 2\)"),
        (Candidates("x", np.array([["a", "b"]])), "'mine' are not an array of complex numbers"),
        (Candidates("x", [[1.0], [1.0, 2.0]]), "'mine' are not an array of complex numbers"),
        (Candidates("x", np.array([[1.0, np.nan], [1, 2]])), "1 points of the solver 'mine'"),
        (Candidates("x", np.array([[np.inf, 1.0]])), "of the solver 'mine' are not finite"),
        (Candidates("x", np.array([[complex(0, np.inf), 1.0]])), "are not finite"),
        (Candidates("x", np.zeros((1, 2)), "a path"), "`lost` of the solver 'mine'"),
        (Candidates("x", np.zeros((1, 2)), (3,)), "`lost` of the solver 'mine'"),
    ],
)
def test_wrong_candidates_are_refused_by_name(
    returned: Any, message: str, register: Registrar
) -> None:
    name = register(lambda chart, seed, progress: returned)
    with pytest.raises(SolverError, match=message):
        find_candidates(CHART, name)
    with pytest.raises(SolverError, match="'mine'"):
        count_branches(two_vertex(), method=name)


# --- that it never lies --------------------------------------------------------------------------


def test_a_missing_candidate_is_undecided(register: Registrar) -> None:
    """A solver that loses a path must cost the proof, never the count."""

    def forgetful(chart: Chart, seed: int, progress: Any) -> Candidates:
        return Candidates("popping", popping(chart).points[:-1], ("path lost on purpose",))

    result = count_branches(random_square(2, seed=0), method=register(forgetful))
    assert result.status is UNDECIDED
    assert "3 of 4 solutions isolated" in result.reason
    assert "path lost on purpose" in result.open_questions
    assert len(result.branches) == 3
    assert result.distinct is None


def test_what_a_solver_lost_is_no_open_question_once_all_is_proved(register: Registrar) -> None:
    def modest(chart: Chart, seed: int, progress: Any) -> Candidates:
        return Candidates("popping", popping(chart).points, ("a path may be lost",))

    result = count_branches(random_square(2, seed=0), method=register(modest))
    assert (result.status, result.open_questions) == (PROVED, ())


def test_a_false_candidate_is_never_counted(register: Registrar) -> None:
    def inventive(chart: Chart, seed: int, progress: Any) -> Candidates:
        points = popping(chart).points.copy()
        points[0] = 10 + points[1]
        points[2] = points[3]
        return Candidates("popping", points)

    result = count_branches(random_square(2, seed=0), method=register(inventive))
    assert result.status is UNDECIDED
    assert result.distinct is None
    assert 1 <= len(result.branches) < 4
    boxes = [branch.root.box for branch in result.branches]  # type: ignore[attr-defined]
    assert all(a.is_disjoint_from(b) for k, a in enumerate(boxes) for b in boxes[:k])


def test_no_candidates_at_all_are_undecided(register: Registrar) -> None:
    empty = Candidates("popping", np.zeros((0, 2), dtype=complex))
    result = count_branches(two_vertex(), method=register(lambda chart, seed, progress: empty))
    assert result.status is UNDECIDED
    assert "0 of 4 solutions isolated" in result.reason
    assert result.branches == ()
