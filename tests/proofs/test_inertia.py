"""The parts of the proof of Theorem 4, against independent constructions."""

import random
from fractions import Fraction

import pytest

from exactfold import random_square
from exactfold.exact.linalg import inertia_by_elimination
from exactfold.pattern.families import flat_vertex_square
from exactfold.rigidity import curvature_form
from proofs.chambers import counted, inertia_at, jacobian, vertex_signs
from proofs.inertia import right_roots, round_matrix
from proofs.patterns import hostile_patterns


@pytest.mark.parametrize("seed", range(20))
def test_right_roots_of_a_product(seed: int) -> None:
    """Real roots and pairs of complex roots, drawn at random."""
    source = random.Random(seed)
    product, right = [Fraction(1)], 0
    for _ in range(source.randint(1, 4)):
        a, b = source.choice((-1, 1)) * Fraction(source.randint(1, 9999), 7), source.randint(1, 9)
        factor = source.choice(([Fraction(1), -a], [Fraction(1), -2 * a, a**2 + b**2]))
        right += (len(factor) - 1) * (a > 0)
        longer = [Fraction(0)] * (len(product) + len(factor) - 1)
        for i, x in enumerate(product):
            for j, y in enumerate(factor):
                longer[i + j] += x * y
        product = longer
    assert right_roots(product) == right


def test_imaginary_roots_are_not_counted() -> None:
    with pytest.raises(ArithmeticError, match="first column"):
        right_roots([Fraction(1), Fraction(0), Fraction(1)])


def test_the_scales_make_a_matrix_definite_that_is_not() -> None:
    """So the proof needs them: L + L^T has a negative eigenvalue on some sheet."""
    inertias = set()
    for pattern in hostile_patterns(14):
        for scaled in (True, False):
            matrix = round_matrix(pattern, scaled)
            both = [
                [x + y for x, y in zip(row, column, strict=True)]
                for row, column in zip(matrix, zip(*matrix, strict=True), strict=True)
            ]
            inertias.add((scaled, inertia_by_elimination(both) == (pattern.Vi, 0, 0)))
    assert inertias == {(True, True), (False, True), (False, False)}


def test_a_single_peak_need_not_have_positive_curvature() -> None:
    """Why J is not positive on e_v: raising the hub alone can have K < 0 in a spiky star."""
    pattern = next(
        p
        for p in hostile_patterns(60)
        if any(curvature_form(p, v).matrix[0][0] < 0 for v in p.interior)
    )
    assert pattern.is_convex


def test_inertia_at_is_not_decided_on_a_wide_box() -> None:
    pattern = random_square(2, 0)
    branch = counted(pattern).branches[0]
    narrow = branch.heights
    wide = {v: (low - 1, high + 1) for v, (low, high) in narrow.items()}
    assert inertia_at(pattern, narrow, set()) is not None
    assert inertia_at(pattern, wide, set()) is None


def test_inertia_at_counts_flat_vertices_as_zero() -> None:
    pattern = flat_vertex_square()
    found = set()
    for branch in counted(pattern).branches:
        flat = {v for v, s in branch.vertex_signs.items() if s == 0}
        found.add((branch.sign_text, inertia_at(pattern, branch.heights, flat)))
    assert found == {("+0", (1, 0, 1)), ("-+", (1, 1, 0)), ("--", (0, 2, 0))}


def test_inertia_of_a_pyramid_and_its_reflection() -> None:
    pattern = random_square(1, 0)
    up = {v: Fraction(int(v in pattern.interior)) for v in range(5)}
    down = {v: -h for v, h in up.items()}
    assert vertex_signs(pattern, up) == (1,)
    assert inertia_by_elimination(jacobian(pattern, up)) == (1, 0, 0)
    assert inertia_by_elimination(jacobian(pattern, down)) == (0, 1, 0)
