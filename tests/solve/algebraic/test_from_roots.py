"""The parametrisation built from approximate zeros, against lifting and the Groebner basis."""

import random
from dataclasses import replace
from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from flint import fmpz
from symmetric_groups import symmetric_group_primes

from exactfold.errors import SolverError
from exactfold.exact.factors import factor_degrees, modular_degrees
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic import from_roots
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.from_roots import parametrisation_from_roots
from exactfold.solve.algebraic.lifting import lifted_classes
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.homotopy import homotopy
from exactfold.solve.numeric.popping import popping

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
FLAT_STAR = CreasePattern(
    [*CORNERS, ("1/2", "1/2"), ("7/10", "1/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)


def random_chart(interior, seed):
    return BranchSystem(random_square(interior, seed=seed)).chart


def random_quadrics(n, seed, size=20):
    """Dense integer quadrics, which are no branch system: most zeros are not real."""
    source = random.Random(seed)
    matrices = []
    for _ in range(n):
        upper = [[source.randint(-size, size) for _ in range(n + 1)] for _ in range(n + 1)]
        matrices.append([[upper[min(i, j)][max(i, j)] for j in range(n + 1)] for i in range(n + 1)])
    return QuadraticSystem.from_rational(matrices)


def guesses(*rows):
    return Candidates("guess", np.array(rows, dtype=np.complex128))


def by_polynomial(classes):
    return sorted(classes, key=lambda c: c.polynomial)


@pytest.mark.parametrize(("interior", "seed"), [(1, 0), (2, 1), (3, 2), (4, 1), (5, 3)])
def test_branch_systems_agree_with_lifting(interior, seed):
    chart = random_chart(interior, seed)
    found = parametrisation_from_roots(chart.system, popping(chart))
    assert found is not None
    assert by_polynomial(found.factors()) == by_polynomial(lifted_classes(chart.system))


def test_isolating_boxes_will_do():
    chart = random_chart(4, 2)
    boxes = isolate(chart.system, popping(chart)).boxes
    found = parametrisation_from_roots(chart.system, boxes)
    assert found is not None
    assert by_polynomial(found.factors()) == by_polynomial(lifted_classes(chart.system))


@pytest.mark.parametrize(("n", "seed"), [(2, 0), (3, 0), (3, 1), (4, 0)])
def test_systems_with_zeros_that_are_not_real(n, seed):
    system = random_quadrics(n, seed)
    candidates = homotopy(system)
    assert np.abs(candidates.points.imag).max() > 0.01
    found = parametrisation_from_roots(system, candidates)
    assert found is not None
    assert by_polynomial(found.factors()) == by_polynomial(lifted_classes(system))
    assert len(found.real_roots(20)) == isolate(system, candidates).real


def test_two_conjugate_zeros():
    found = parametrisation_from_roots(QuadraticSystem((((2, 1), (1, 5)),)), guesses([1j], [-1j]))
    assert found == RootClass((5, 2, 2), ((Fraction(-10), Fraction(-2)),), 1, (1,))


def test_the_roots_of_the_parameter_are_those_of_the_boxes():
    chart = random_chart(6, 2)
    boxes = isolate(chart.system, popping(chart)).boxes
    found = parametrisation_from_roots(chart.system, boxes)
    assert found is not None
    assert found.degree == 64
    values = sorted(
        sum(c * box.interval(k)[0] for k, c in enumerate(found.separating)) for box in boxes
    )
    roots = found.real_roots(24)
    assert all(abs(a - b[0]) < Fraction(1, 1 << 20) for a, b in zip(values, roots, strict=True))


def test_another_form_where_coordinates_do_not_separate():
    """x^2 = 1, y^2 = 2: neither coordinate tells all four zeros apart, x + y does."""
    system = QuadraticSystem(
        (((1, 0, 0), (0, 0, 0), (0, 0, -1)), ((0, 0, 0), (0, 1, 0), (0, 0, -2)))
    )
    points = [(a, b * 2**0.5) for a in (1, -1) for b in (1, -1)]
    found = parametrisation_from_roots(system, guesses(*points))
    assert found is not None
    assert found.separating == (1, 1)
    assert factor_degrees(found.polynomial) == (2, 2)
    assert [c.degree for c in found.factors()] == [2, 2]


def test_rational_zeros_and_zero_coordinates():
    system = QuadraticSystem(
        (((1, 0, 0), (0, 0, 0), (0, 0, -9)), ((0, 0, 0), (0, 3, -1), (0, -1, 0)))
    )  # x = 3 or -3, y = 0 or 2/3
    points = [(a, b) for a in (3, -3) for b in (0, 2 / 3)]
    found = parametrisation_from_roots(system, guesses(*points))
    assert found is not None
    assert factor_degrees(found.polynomial) == (1, 1, 1, 1)
    boxes = {box for c in found.factors() for box in c.real_points(10)}
    assert {tuple(low for low, high in box) for box in boxes} == {
        (Fraction(a), b) for a in (3, -3) for b in (Fraction(0), Fraction(2, 3))
    }


def test_refusals():
    """Too few points, the same zero twice, points that are no zeros, a double zero, none at all."""
    chart = random_chart(3, 1)
    candidates = popping(chart)
    fewer = replace(candidates, points=candidates.points[1:])
    twice = replace(candidates, points=np.vstack([candidates.points[1:], candidates.points[1:2]]))
    assert parametrisation_from_roots(chart.system, fewer) is None
    assert parametrisation_from_roots(chart.system, twice) is None
    no_zeros = QuadraticSystem(
        (((0, 1, 0), (1, 0, 0), (0, 0, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, 1)))
    )
    points = [(a, b) for a in (1.0, 2.0) for b in (3.0, 5.0)]
    assert parametrisation_from_roots(no_zeros, guesses(*points)) is None
    flat = BranchSystem(FLAT_STAR).chart
    assert parametrisation_from_roots(flat.system, popping(flat)) is None
    candidates.points[0, 0] = np.nan
    assert parametrisation_from_roots(chart.system, candidates) is None
    nothing = Candidates("guess", np.zeros((1, 0), dtype=np.complex128))
    assert parametrisation_from_roots(QuadraticSystem(()), nothing) is None


def test_a_wrong_proposal_is_caught_by_substitution(monkeypatch):
    """Every rounding mistake is noticed, and the precision rises until there is none."""
    chart = random_chart(3, 1)
    original, attempts = from_roots._integers, []

    def wrong_at_first(polynomials, common):
        lines = original(polynomials, common)
        attempts.append(lines)
        if len(attempts) == 1:
            lines[2][1] += 1
        return lines

    monkeypatch.setattr(from_roots, "_integers", wrong_at_first)
    found = parametrisation_from_roots(chart.system, popping(chart))
    assert len(attempts) == 2
    assert by_polynomial(found.factors()) == by_polynomial(lifted_classes(chart.system))


def test_too_little_precision_gives_none(monkeypatch):
    monkeypatch.setattr(from_roots, "_bezout_bits", lambda system, form: 6)
    chart = random_chart(4, 1)
    assert parametrisation_from_roots(chart.system, popping(chart)) is None


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("polynomial", "does not vanish on the root class"),
        ("numerators", "does not vanish on the root class"),
        ("separating", "not the stated linear form"),
    ],
)
def test_verification_refuses_changes(place, said):
    chart = random_chart(3, 1)
    good = parametrisation_from_roots(chart.system, popping(chart))
    assert good is not None
    if place == "polynomial":
        bad = replace(good, polynomial=(good.polynomial[0] + 1, *good.polynomial[1:]))
    elif place == "numerators":
        first, *rest = good.numerators
        bad = replace(good, numerators=((first[0] + Fraction(1, 7), *first[1:]), *rest))
    else:
        bad = replace(good, separating=(1, *good.separating[1:]))
    good.verify(chart.system)
    with pytest.raises(SolverError, match=said):
        bad.verify(chart.system)


def test_verification_refuses_multiple_roots():
    system = QuadraticSystem((((1, 0), (0, -2)),))
    double = RootClass((4, 0, -4, 0, 1), ((Fraction(0), Fraction(0), Fraction(8)),), 1, (1,))
    with pytest.raises(SolverError, match="squarefree"):
        double.verify(system)


def test_random_quadrics_have_the_symmetric_group():
    system = random_quadrics(3, 0)
    found = parametrisation_from_roots(system, homotopy(system))
    assert found is not None
    assert factor_degrees(found.polynomial) == (8,)
    assert symmetric_group_primes(found.polynomial) is not None


@pytest.mark.parametrize(("interior", "seed"), [(3, 1), (4, 1), (5, 3), (6, 1)])
def test_a_vertex_of_degree_four_puts_a_square_root_into_the_field(interior, seed):
    """K_v = a^2 - D b^2: where D is no square modulo p, all degrees modulo p are even."""
    pattern = random_square(interior, seed=seed)
    chart = BranchSystem(pattern).chart
    found = parametrisation_from_roots(chart.system, popping(chart))
    assert found is not None
    assert symmetric_group_primes(found.polynomial) is None
    forms = [curvature_form(pattern, v).matrix for v in pattern.interior]
    discriminants = [discriminant_of_rank_two(m) for m in forms if len(m) == 5]
    primes = [p for p in range(1000, 1100) if fmpz(p).is_prime()]
    seen = 0
    for d in discriminants:
        for p in primes:
            degrees = modular_degrees(found.polynomial, p)
            if degrees is not None and pow(d, (p - 1) // 2, p) == p - 1:
                assert all(k % 2 == 0 for k in degrees)
                seen += 1
    assert seen > 0


def discriminant_of_rank_two(matrix):
    """D times a square for a form a^2 - D b^2: minus a principal minor that is not zero."""
    minors = [
        matrix[i][j] ** 2 - matrix[i][i] * matrix[j][j]
        for i, j in combinations(range(len(matrix)), 2)
    ]
    d = next(m for m in minors if m)
    return d.numerator * d.denominator


@pytest.mark.survey
def test_no_vertex_of_degree_four_symmetric_group():
    """The icosahedron without an edge: all degrees 5, all branches conjugate, none in radicals."""
    pattern = random_square(8, seed=147)
    assert {len(curvature_form(pattern, v).labels) for v in pattern.interior} == {6}
    chart = BranchSystem(pattern).chart
    found = parametrisation_from_roots(chart.system, popping(chart))
    assert found is not None
    assert factor_degrees(found.polynomial) == (256,)
    assert symmetric_group_primes(found.polynomial) is not None


@pytest.mark.parametrize("distance", [10**8, 10**15])
def test_close_zeros_cost_precision_only(distance):
    """x^2 = y^2 + 1/d^2 near x = y: pairs of zeros at a distance that doubles hardly see."""
    system = QuadraticSystem.from_rational(
        [
            [[1, 0, 0], [0, 0, 0], [0, 0, -Fraction(1, distance**2)]],
            [[0, 1, 0], [1, 3, 0], [0, 0, -1]],
        ]
    )  # x = 1/d or -1/d, 2 x y + 3 y^2 = 1
    y = 3**-0.5
    points = [(a / distance, b * y) for a in (1, -1) for b in (1, -1)]
    found = parametrisation_from_roots(system, guesses(*points))
    assert found is not None
    assert by_polynomial(found.factors()) == by_polynomial(lifted_classes(system))
