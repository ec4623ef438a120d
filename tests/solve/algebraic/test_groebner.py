"""The exact solver on systems whose zeros are known."""

from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import SolverError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.algebraic.quotient import separating_forms

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
FLAT_STAR = CreasePattern(
    [*CORNERS, ("1/2", "1/2"), ("7/10", "1/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
TWO_VERTICES = CreasePattern(
    [*CORNERS, ("1/3", "1/2"), ("2/3", "2/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
INNER_TRIANGLE = CreasePattern(
    [*CORNERS, ("1/3", "1/4"), ("3/4", "1/3"), ("1/2", "3/4")],
    [(4, 5, 6), (0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)],
)
RIGID_INSIDE = CreasePattern(
    [*CORNERS, ("1/2", "1/3"), ("1/2", "1/8")],
    [(0, 1, 5), (1, 4, 5), (4, 0, 5), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)


def concentric_squares():
    outer, inner = [(-3, -3), (3, -3), (3, 3), (-3, 3)], [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    triangles = [(4, 5, 8), (5, 6, 8), (6, 7, 8), (7, 4, 8)]
    for k in range(4):
        after = (k + 1) % 4
        triangles += [(k, after, 4 + after), (k, 4 + after, 4 + k)]
    return CreasePattern([*outer, *inner, (0, 0)], triangles)


def chart_system(pattern):
    return BranchSystem(pattern).chart.system


def quadrics(*polynomials):
    """A system from {exponents: coefficient}, two variables unless the exponents say otherwise."""
    size = len(polynomials)
    matrices = []
    for polynomial in polynomials:
        matrix = [[Fraction(0)] * (size + 1) for _ in range(size + 1)]
        for exponents, coefficient in polynomial.items():
            places = [k for k, a in enumerate(exponents) for _ in range(a)]
            i, j = places + [size] * (2 - len(places))
            matrix[i][j] += Fraction(coefficient) / 2
            matrix[j][i] += Fraction(coefficient) / 2
        matrices.append(matrix)
    return QuadraticSystem.from_rational(matrices)


def profile(solution):
    """(degree, multiplicity, real roots) of the classes."""
    return sorted((c.degree, c.multiplicity, len(c.real_roots(4))) for c in solution.classes)


def rational_points(solution):
    points = {}
    for c in solution.classes:
        assert c.degree == 1
        root = Fraction(-c.polynomial[0], c.polynomial[1])
        value = tuple(
            sum((a * root**k for k, a in enumerate(g)), Fraction(0)) for g in c.coordinates
        )
        points[value] = c.multiplicity
    return points


@pytest.mark.parametrize("engine", ["flint", "sympy"])
class TestKnownSystems:
    def test_two_circles(self, engine):
        circles = quadrics(
            {(2, 0): 1, (0, 2): 1, (0, 0): -25}, {(2, 0): 1, (0, 2): 1, (1, 0): -6, (0, 0): 11}
        )
        solution = groebner(circles, engine=engine)
        # (6, +-sqrt(-11)); the two circular points are at infinity.
        assert solution.dimension == 2
        assert solution.at_infinity == 2
        assert profile(solution) == [(2, 1, 0)]

    def test_line_pairs_with_rational_points(self, engine):
        lines = quadrics({(2, 0): 1, (1, 0): -3, (0, 0): 2}, {(0, 2): 6, (0, 1): -5, (0, 0): 1})
        solution = groebner(lines, engine=engine)
        expected = {(Fraction(x), y): 1 for x in (1, 2) for y in (Fraction(1, 2), Fraction(1, 3))}
        assert rational_points(solution) == expected

    def test_multiple_points(self, engine):
        # y = x^2 meets y^2 = 0 four times at the origin.
        solution = groebner(quadrics({(2, 0): 1, (0, 1): -1}, {(0, 2): 1}), engine=engine)
        assert rational_points(solution) == {(0, 0): 4}
        # A double line meets a circle in two double points.
        solution = groebner(
            quadrics({(2, 0): 1, (0, 2): 1, (0, 0): -2}, {(2, 0): 1}), engine=engine
        )
        assert profile(solution) == [(2, 2, 2)]
        assert solution.distinct == 2

    def test_real_and_nonreal_points(self, engine):
        solution = groebner(
            quadrics({(2, 0): 1, (0, 0): -2}, {(0, 2): 1, (0, 0): 3}), engine=engine
        )
        assert solution.dimension == 4
        assert sum(len(c.real_roots(4)) for c in solution.classes) == 0
        points = solution.approx_points()
        assert np.allclose(sorted(abs(points[:, 0].real)), [2**0.5] * 4)
        assert np.allclose(points[:, 1].real, 0)

    def test_inconsistent(self, engine):
        solution = groebner(
            quadrics({(2, 0): 1, (0, 2): 1}, {(2, 0): 1, (0, 2): 1, (0, 0): -1}), engine=engine
        )
        assert (solution.dimension, solution.classes, solution.at_infinity) == (0, (), 4)
        assert solution.candidates.points.shape == (0, 2)

    @pytest.mark.parametrize("second", [{(1, 1): 1, (0, 1): 1}, {}])
    def test_infinitely_many_zeros(self, engine, second):
        solution = groebner(quadrics({(2, 0): 1, (1, 0): 1}, second), engine=engine)
        assert solution.dimension is None
        assert solution.at_infinity is None
        assert solution.classes == ()

    def test_no_equations_at_all(self, engine):
        assert groebner(quadrics({}, {}), engine=engine).dimension is None

    def test_one_unknown(self, engine):
        assert profile(groebner(quadrics({(2,): 1, (0,): -2}), engine=engine)) == [(2, 1, 2)]
        assert profile(groebner(quadrics({(2,): 1, (1,): -2, (0,): 1}), engine=engine)) == [
            (1, 2, 1)
        ]

    @pytest.mark.parametrize(
        ("pattern", "expected"),
        [
            (FLAT_STAR, [(1, 2, 1), (2, 1, 2)]),
            (RIGID_INSIDE, [(2, 2, 2)]),
            (TWO_VERTICES, [(4, 1, 4)]),
            (INNER_TRIANGLE, [(8, 1, 8)]),
        ],
    )
    def test_branches_of_patterns(self, engine, pattern, expected):
        solution = groebner(chart_system(pattern), engine=engine)
        assert solution.at_infinity == 0
        assert profile(solution) == expected

    def test_coordinates_that_do_not_separate(self, engine):
        # Four points on which each coordinate takes two values.
        solution = groebner(
            quadrics({(2, 0): 1, (0, 0): -1}, {(0, 2): 1, (0, 0): -1}), engine=engine
        )
        assert rational_points(solution) == {(a, b): 1 for a in (1, -1) for b in (1, -1)}
        assert solution.classes[0].separating not in [(1, 0), (0, 1), (1, 1)]


@pytest.mark.slow
def test_symmetric_pattern_with_multiplicities():
    solution = groebner(chart_system(concentric_squares()))
    assert solution.dimension == 32
    assert sum(d * m for d, m, _ in profile(solution)) == 32
    assert all(d == r for d, _, r in profile(solution))
    assert max(m for _, m, _ in profile(solution)) == 4


def test_engines_agree():
    system = chart_system(INNER_TRIANGLE)
    assert groebner(system, engine="flint").classes == groebner(system, engine="sympy").classes


def test_unknown_engine_error():
    with pytest.raises(UsageError, match="abacus"):
        groebner(chart_system(TWO_VERTICES), engine="abacus")


def test_real_points_enclose_the_zeros_narrowly():
    system = chart_system(INNER_TRIANGLE)
    solution = groebner(system)
    boxes = solution.real_points(40)
    assert len(boxes) == 8
    for box, multiplicity in boxes:
        assert multiplicity == 1
        assert all(high - low <= Fraction(1, 2**40) for low, high in box)
        middle = [(low + high) / 2 for low, high in box]
        scale = max(abs(x) for m in system.matrices for row in m for x in row)
        assert all(abs(v) < scale * Fraction(1, 2**30) for v in system.values_at(middle))


def test_enclose_refuses_a_wide_interval():
    [pair] = groebner(quadrics({(2,): 1, (0,): -2})).classes
    assert pair.enclose((Fraction(-2), Fraction(2))) is None


def test_linear_forms_on_a_class():
    solution = groebner(chart_system(TWO_VERTICES))
    [c] = solution.classes
    for interval in c.real_roots(200):
        box = c.enclose(interval)
        row = [Fraction(2), Fraction(-3), Fraction(1, 5)]
        low, high = c.value_on(row, interval)
        corners = [2 * x - 3 * y + Fraction(1, 5) for x in box[0] for y in box[1]]
        assert min(corners) <= high
        assert low <= max(corners)
        assert high - low < Fraction(1, 2**100)
    assert not c.vanishes(row)
    assert c.value_on([1, 0, 0], (Fraction(-(10**6)), Fraction(10**6))) is None


def test_linear_form_that_vanishes_on_one_class_only():
    # x y = 0 and x^2 + y^2 = 2: x vanishes on one pair of points, and not on the other.
    solution = groebner(quadrics({(1, 1): 1}, {(2, 0): 1, (0, 2): 1, (0, 0): -2}))
    assert sorted(c.vanishes([1, 0, 0]) for c in solution.classes) == [False, True]
    assert sorted(c.vanishes([0, 1, 0]) for c in solution.classes) == [False, True]


@pytest.mark.slow
def test_candidates_are_near_the_zeros():
    system = chart_system(concentric_squares())
    candidates = groebner(system).candidates
    assert candidates.method == "groebner"
    assert candidates.lost == ()
    z = np.hstack([candidates.points, np.ones((len(candidates.points), 1))])
    values = np.einsum("mi,pij,mj->mp", z, system.float_tensor, z)
    assert np.abs(values).max() < 1e-12
    assert np.all(candidates.points.imag == 0)


def test_numerators_and_coordinates_describe_the_same_class():
    for c in groebner(chart_system(TWO_VERTICES)).classes:
        again = RootClass.from_coordinates(
            c.polynomial, c.coordinates, c.multiplicity, c.separating
        )
        assert again == c


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("polynomial", "does not vanish on the root class"),
        ("numerators", "does not vanish on the root class"),
        ("separating", "not the stated linear form"),
        ("square", "not squarefree"),
    ],
)
def test_verify_rejects_a_changed_class_error(change, said):
    system = chart_system(TWO_VERTICES)
    [c] = groebner(system).classes
    polynomial, numerators, separating = c.polynomial, c.numerators, c.separating
    if change == "polynomial":
        polynomial = (polynomial[0] + 1, *polynomial[1:])
    elif change == "numerators":
        numerators = ((numerators[0][0] + 1, *numerators[0][1:]), *numerators[1:])
    elif change == "separating":
        separating = tuple(x + 1 for x in separating)
    else:
        polynomial = (1, 2, 1)
    with pytest.raises(SolverError, match=said):
        RootClass(polynomial, numerators, 1, separating).verify(system)


def test_separating_forms_are_eventually_in_general_position():
    forms = separating_forms(3)
    found = [next(forms) for _ in range(6)]
    assert found == [(0, 0, 1), (0, 1, 0), (1, 0, 0), (1, 1, 1), (1, 2, 4), (1, 3, 9)]


coefficients = st.integers(-3, 3)
small_systems = st.lists(
    st.lists(coefficients, min_size=6, max_size=6), min_size=2, max_size=2
).map(
    lambda rows: quadrics(
        *(dict(zip([(2, 0), (1, 1), (0, 2), (1, 0), (0, 1), (0, 0)], r, strict=True)) for r in rows)
    )
)


def reordered(system, order):
    places = [*order, system.size]
    return QuadraticSystem(
        tuple(tuple(tuple(m[i][j] for j in places) for i in places) for m in system.matrices)
    )


@settings(max_examples=60, deadline=None)
@given(small_systems)
def test_properties_of_random_conics(system):
    solution = groebner(system)
    if solution.dimension is None:
        return
    assert solution.dimension <= 4
    assert solution.at_infinity == 4 - solution.dimension
    assert sum(c.degree * c.multiplicity for c in solution.classes) == solution.dimension
    for order in permutations(range(2)):
        swapped = groebner(reordered(system, order))
        assert swapped.dimension == solution.dimension
        assert profile(swapped) == profile(solution)
    scaled = QuadraticSystem(
        tuple(tuple(tuple(-7 * x for x in row) for row in m) for m in reversed(system.matrices))
    )
    assert groebner(scaled).classes == solution.classes
    again = groebner(system, engine="sympy")
    assert again.classes == solution.classes


@settings(max_examples=10, deadline=None)
@given(st.permutations(range(3)))
def test_reordering_the_unknowns_of_a_pattern(order):
    system = chart_system(INNER_TRIANGLE)
    swapped = groebner(reordered(system, order))
    assert profile(swapped) == [(8, 1, 8)]
    boxes = {tuple(box[order.index(k)] for k in range(3)) for box, _ in swapped.real_points(20)}
    for box, _ in groebner(system).real_points(20):
        assert any(
            all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(box, other, strict=True))
            for other in boxes
        )
