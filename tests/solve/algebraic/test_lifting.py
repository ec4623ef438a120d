"""Lifting from a prime field against the Groebner basis."""

from dataclasses import replace
from itertools import permutations
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sheets import with_point

from exactfold._support.clock import Clock
from exactfold.errors import NotApplicableError
from exactfold.pattern import families, random_cell
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.all_directions import AllDirections
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem, primitive_matrices
from exactfold.solve.algebraic import lifting
from exactfold.solve.algebraic.groebner_bases import groebner

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
TWO_VERTICES = CreasePattern(
    [*CORNERS, ("1/3", "1/2"), ("2/3", "2/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
FLAT_STAR = CreasePattern(
    [*CORNERS, ("1/2", "1/2"), ("7/10", "1/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
INNER_TRIANGLE = CreasePattern(
    [*CORNERS, ("1/3", "1/4"), ("3/4", "1/3"), ("1/2", "3/4")],
    [(4, 5, 6), (0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 6, 5), (2, 3, 6), (3, 4, 6), (3, 0, 4)],
)
FIVE_VERTICES = CreasePattern(
    [
        (-3, -3),
        (3, -3),
        (4, 3),
        (-3, 3),
        (-1, -1),
        (1, "-4/5"),
        (1, 1),
        ("-6/5", 1),
        ("1/7", "1/9"),
    ],
    [(4, 5, 8), (5, 6, 8), (6, 7, 8), (7, 4, 8)]
    + [
        t
        for k in range(4)
        for t in ((k, (k + 1) % 4, 4 + (k + 1) % 4), (k, 4 + (k + 1) % 4, 4 + k))
    ],
)


def chart_system(pattern):
    return BranchSystem(pattern).chart.system


NONREAL = QuadraticSystem((((1, 0, 0), (0, 0, 0), (0, 0, 2)), ((0, 1, 0), (1, 2, 0), (0, 0, 3))))


@pytest.mark.parametrize("system", [*map(chart_system, (TWO_VERTICES, INNER_TRIANGLE)), NONREAL])
def test_lifting_agrees_with_the_groebner_basis(system):
    assert groebner(system, engine="lifting").classes == groebner(system, engine="flint").classes


@pytest.mark.slow
def test_roots_and_lifting_agree_for_five_unknowns():
    solution = groebner(chart_system(FIVE_VERTICES))
    assert solution.engine == "roots"
    assert solution.classes == groebner(chart_system(FIVE_VERTICES), engine="lifting").classes
    assert solution.dimension == 32
    assert all(c.multiplicity == 1 for c in solution.classes)
    boxes = solution.real_points(30)
    assert len(boxes) == 32


def test_reducible_systems_split_into_classes():
    system = QuadraticSystem(
        (((1, 0, 0), (0, 0, 0), (0, 0, -1)), ((0, 0, 0), (0, 1, 0), (0, 0, -4)))
    )
    solution = groebner(system, engine="lifting")
    assert [c.degree for c in solution.classes] == [1, 1, 1, 1]


@pytest.mark.parametrize(
    "system",
    [
        QuadraticSystem((((1, 0, 0), (0, 1, 0), (0, 0, -1)), ((1, 0, 0), (0, 1, 0), (0, 0, -2)))),
        QuadraticSystem((((1, 0, 0), (0, 0, 0), (0, 0, 0)), ((0, 1, 0), (1, 0, 0), (0, 0, 0)))),
        # one zero at infinity: x y = 1 and x (x + y) = 1 have three leading directions too few
        QuadraticSystem((((0, 1, 0), (1, 0, 0), (0, 0, -2)), ((2, 1, 0), (1, 0, 0), (0, 0, -2)))),
        # y = x^2 and y^2 = 0: multiplicity 4 where the Jacobian has corank 1
        QuadraticSystem((((2, 0, 0), (0, 0, -1), (0, -1, 0)), ((0, 0, 0), (0, 1, 0), (0, 0, 0)))),
    ],
)
def test_lifting_that_does_not_apply_error(system):
    assert lifting.lifted_classes(system) is None
    with pytest.raises(NotApplicableError, match="another engine"):
        groebner(system, engine="lifting")
    assert groebner(system).engine == "flint"


def test_lifting_gives_up_at_the_precision_limit(monkeypatch):
    monkeypatch.setattr(lifting, "_precision_limit", lambda system: 1)
    assert lifting.lifted_classes(chart_system(TWO_VERTICES)) is None


def test_too_little_precision_is_noticed(monkeypatch):
    """Wrong reconstructions are caught by substitution, and the precision rises."""
    attempts = []
    original = lifting._reconstructed

    def recorded(*arguments):
        attempts.append(original(*arguments))
        return attempts[-1]

    monkeypatch.setattr(lifting, "_reconstructed", recorded)
    [found] = lifting.lifted_classes(chart_system(INNER_TRIANGLE))
    assert len(attempts) > 1
    assert found == attempts[-1]


def test_an_unlucky_prime_is_replaced(monkeypatch):
    monkeypatch.setattr(lifting, "PRIMES", (3, lifting.PRIMES[0]))
    system = QuadraticSystem((((1, 0), (0, -3)),))  # x^2 = 3: a double zero modulo 3
    assert [c.polynomial for c in lifting.lifted_classes(system)] == [(-3, 0, 1)]


def test_an_unlucky_prime_proves_nothing(monkeypatch):
    """Modulo 3 the two zeros of x^2 = 3 look like a double one; the exact corank refutes it."""
    monkeypatch.setattr(lifting, "PRIMES", (3,))
    assert lifting.lifted_classes(QuadraticSystem((((1, 0), (0, -3)),))) is None


MULTIPLE = {
    "flat star": FLAT_STAR,
    "hypar": families.hypar(1, 0),
    "vertex of degree three": with_point(TWO_VERTICES, 0, (1, 2, 3)),
    "hypar and degree three": with_point(families.hypar(1, 0), 0, (1, 2, 3)),
    "nested triangles": with_point(with_point(TWO_VERTICES, 0, (1, 2, 3)), 5, (1, 1, 1)),
}


@pytest.mark.parametrize("pattern", MULTIPLE.values(), ids=MULTIPLE)
def test_multiple_zeros_agree_with_the_groebner_basis(pattern):
    system = chart_system(pattern)
    lifted, exact = groebner(system, engine="lifting"), groebner(system, engine="flint")
    assert lifted.classes == exact.classes
    assert max(c.multiplicity for c in lifted.classes) > 1


@pytest.mark.slow
def test_multiple_zeros_in_six_unknowns():
    solution = groebner(chart_system(families.flat_octahedron_in_square()))
    assert solution.engine == "lifting"
    assert solution.dimension == 64
    assert [(c.degree, c.multiplicity) for c in solution.classes] == [(8, 8)]


def test_multiple_zeros_that_are_not_flat_vertices():
    """Generic combinations of the quadrics: no row of the Jacobian is zero at the double zero."""
    system = chart_system(families.hypar(1, 0))
    mixture = [[1, 2, 0, 1], [0, 1, 3, 1], [1, 0, 1, 1], [2, 1, 1, -1]]
    mixed = QuadraticSystem(
        tuple(
            tuple(
                tuple(
                    sum(w * m[i][j] for w, m in zip(row, system.matrices, strict=True))
                    for j in range(5)
                )
                for i in range(5)
            )
            for row in mixture
        )
    )
    assert groebner(mixed, engine="lifting").classes == groebner(system, engine="flint").classes


entries = st.integers(-2, 2)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.lists(entries, min_size=6, max_size=6), min_size=2, max_size=2))
def test_random_conics_with_multiple_zeros(rows):
    """Where lifting claims multiplicities, the characteristic polynomials over Q agree."""
    matrices = [[[2 * a, b, d], [b, 2 * c, e], [d, e, 2 * f]] for a, b, c, d, e, f in rows]
    system = QuadraticSystem.from_rational(matrices)
    lifted, exact = lifting.lifted_classes(system), groebner(system, engine="flint")
    if lifted is not None:
        assert lifted == exact.classes
    elif exact.dimension == 4:  # no zero at infinity: then only a multiplicity is in the way
        assert any(c.multiplicity > 1 for c in exact.classes)


def reordered(system, order, weights):
    places = [*order, system.size]
    scales = [*weights, 1]
    return QuadraticSystem(
        tuple(
            tuple(tuple(m[i][j] * scales[i] * scales[j] for j in places) for i in places)
            for m in system.matrices
        )
    )


@pytest.mark.slow
@pytest.mark.parametrize("weights", [(1, 1, 1, 1), (7, 1, 3, 2)])
def test_every_order_of_the_unknowns_has_the_same_profile(weights):
    """Fixed coefficients of the deflation were too special for four of the 24 orders."""
    system = chart_system(families.hypar(1, 0))
    for order in permutations(range(4)):
        classes = lifting.lifted_classes(reordered(system, order, weights))
        profile = sorted((c.degree, c.multiplicity) for c in classes)
        assert profile == [(1, 1), (1, 1), (1, 4), (2, 1), (2, 1), (3, 1), (3, 1)]


def test_special_coefficients_of_the_deflation_are_replaced(monkeypatch):
    seeds = []
    original = lifting.Deflation.of

    def special(system, corank, seed):
        seeds.append((corank, seed))
        found = original(system, corank, seed)
        zeros = tuple(tuple((0,) * corank for _ in range(corank)) for _ in range(corank))
        return replace(found, weights=zeros) if corank and seed < 2 else found

    monkeypatch.setattr(lifting.Deflation, "of", special)
    assert lifting.lifted_classes(chart_system(FLAT_STAR)) is not None
    assert [seed for corank, seed in seeds if corank] == [0, 1, 2]


def test_a_zero_that_is_more_than_a_power_of_its_corank_stops_early(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Stars that go flat together: a zero of multiplicity 16, and four of 4.

    Without the test of the residues, Newton's method goes on to a million bits.
    """
    cell = random_cell(6, 1629, 64, flips=6)
    star = AllDirections.of(cell).flat_star(1)
    assert star is not None
    system = QuadraticSystem(primitive_matrices(star.forms))
    steps: list[int] = []

    def seen(ring: Any, values: Any, form: Any, power: int) -> None:
        steps.append(power)

    monkeypatch.setattr(lifting, "_reconstructed", seen)
    monkeypatch.setattr(lifting, "_precision_limit", lambda system: 4000)
    assert lifting.lifted_classes(system) is None
    assert not steps


def test_a_limit_of_time() -> None:
    """All squares are equal: the fast engines do not apply, and no other begins under a limit."""
    size = 6
    matrices = []
    for k in range(size):
        matrix = [[0] * (size + 1) for _ in range(size + 1)]
        matrix[k][k], matrix[(k + 1) % size][(k + 1) % size] = 1, -1
        matrices.append(matrix)
    system = QuadraticSystem.from_rational(matrices)
    with pytest.raises(NotApplicableError, match=r"time limit of 0 seconds"):
        groebner(system, clock=Clock(0))
    with pytest.raises(NotApplicableError, match="is not begun under a limit of time"):
        groebner(system, clock=Clock(60))
