"""What a count records and reports."""

from fractions import Fraction

import numpy as np
import pytest
from sheets import nested_triangles, straight_side

from exactfold import PROVED, random_square
from exactfold.app.verbs.checking import check
from exactfold.branches import count_branches
from exactfold.branches.counting import lines
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import two_vertex
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.numeric import nappes
from exactfold.solve.numeric.dense_newton import NappeSystem, SweptPoints
from exactfold.solve.numeric.nappes import few_ends


def test_progress_is_reported():
    seen = []
    count_branches(random_square(3, seed=0), progress=lambda *event: seen.append(event))
    assert [stage for stage, done, total in seen if done == total == 8] == ["solving", "certifying"]


def test_progress_of_the_exact_engine_is_reported():
    seen = []
    count_branches(two_vertex(), method="groebner", progress=lambda *event: seen.append(event))
    assert seen[:2] == [("computing a Groebner basis", 0, 1), ("computing a Groebner basis", 1, 1)]


def test_settings_and_time_are_recorded():
    result = count_branches(two_vertex(), method="homotopy", seed=7)
    assert result.method == "homotopy"
    assert result.settings["seed"] == 7
    assert result.settings["lost"] == 0
    assert result.seconds > 0


def test_auto_turns_to_the_exact_engine_where_newton_loses_a_zero(monkeypatch):
    real = NappeSystem.ends_of_block

    def spoiled(system, first, count):
        ends = real(system, first, count)
        points = np.vstack([ends.points[:-1], ends.points[:1]])  # the last path is lost
        return SweptPoints(points, np.arange(count) < count - 1, ends.steps)

    monkeypatch.setattr(lines, "FEW", 0)
    monkeypatch.setattr(NappeSystem, "ends_of_block", spoiled)
    exactly = count_branches(random_square(2, seed=0))
    assert (exactly.status, exactly.method) == (PROVED, "groebner")


def exact(pattern: CreasePattern) -> CreasePattern:
    """The pattern moved by a seventh, so that no coordinate is a decimal, which may be rounded."""
    points = [(x + Fraction(1, 7), y + Fraction(1, 7)) for x, y in pattern.vertices]
    return CreasePattern(points, pattern.triangles)


FEW = {
    "two vertices": two_vertex(),
    "three vertices": exact(random_square(3, seed=32)),
    "four vertices": exact(random_square(4, seed=31)),
    "straight side": exact(straight_side(smallest=True)),
    "triangulated triangles": exact(nested_triangles()),
}


def ways(result: BranchCount) -> list[tuple[str, str, int]]:
    return [(b.sign_text, b.assignment_text, b.multiplicity) for b in result.branches]


@pytest.mark.parametrize("name", FEW)
def test_few_vertices_have_the_branches_that_arrays_find(monkeypatch, name):
    plain = count_branches(FEW[name])
    assert check(plain.certificate()).status is PROVED
    monkeypatch.setattr(lines, "_few", lambda attempt: None)
    arrays = count_branches(FEW[name])
    assert (plain.status, plain.reason, plain.why) == (PROVED, arrays.reason, arrays.why)
    assert ways(plain) == ways(arrays)
    for one, other in zip(plain.branches, arrays.branches, strict=True):
        for v, (low, high) in one.heights.items():
            assert max(low, other.heights[v][0]) <= min(high, other.heights[v][1])


def test_few_vertices_need_no_arrays(monkeypatch):
    monkeypatch.setattr(NappeSystem, "ends_of_block", None)
    assert all(count_branches(pattern).status is PROVED for pattern in FEW.values())


def failing(gauge, vectors):
    raise ArithmeticError("lost")


def exchanged(gauge, vectors):
    ends, steps = few_ends(gauge, vectors)
    return ends[::-1], steps


def left(gauge, vectors):
    return [[1e300] * len(end) for end in few_ends(gauge, vectors)[0]], 1


@pytest.mark.parametrize("ends", [failing, exchanged, left])
def test_what_plain_floats_lose_arrays_find(monkeypatch, ends):
    pattern = FEW["three vertices"]
    known = ways(count_branches(pattern))
    monkeypatch.setattr(lines, "few_ends", ends)
    result = count_branches(pattern)
    assert (result.status, ways(result)) == (PROVED, known)


def test_steps_that_do_not_converge_are_an_error(monkeypatch):
    monkeypatch.setattr(nappes, "_STEPS", 1)
    with pytest.raises(ArithmeticError, match="did not converge"):
        few_ends(Problem.of(two_vertex()).gauge, [(1, 1)])
