"""Exact roots recognised from their boxes."""

import pytest

from exactfold.pattern.families import two_vertex
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.certify.recognition import recognise
from exactfold.solve.numeric.popping import popping


@pytest.mark.parametrize("pattern", [two_vertex(), random_square(3, 1)], ids=["two", "random"])
def test_all_roots_give_the_exact_solution(pattern):
    chart = BranchSystem(pattern).chart
    boxes = isolate(chart.system, popping(chart)).boxes
    found = recognise(chart.system, boxes)
    assert found is not None
    exact = [c.with_parameter(found[0].separating) for c in groebner(chart.system).classes]
    assert sorted(c.polynomial for c in found) == sorted(c.polynomial for c in exact if c)


def test_a_part_that_is_not_rational_is_not_recognised():
    """One of two conjugate roots is no zero set of a rational system."""
    system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    assert recognise(system, krawczyk(system, [[1.4142]])) is None


def test_a_rational_part_is_recognised_alone():
    x = [[1, 0, 0], [0, 0, 0], [0, 0, -2]]
    y = [[0, 0, 0], [0, 1, 0], [0, 0, -4]]
    system = QuadraticSystem.from_rational([x, y])
    boxes = krawczyk(system, [[1.4142, 2.0], [-1.4142, 2.0]])
    found = recognise(system, boxes)
    assert found is not None
    assert [c.degree for c in found] == [2]
