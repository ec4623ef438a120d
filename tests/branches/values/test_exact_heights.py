"""Heights as exact numbers: inside the proved bounds, and zeros of the curvature forms."""

from fractions import Fraction

import pytest
import sympy
from sampling import slow_after
from sheets import random_wheel

from exactfold import Branch, random_square
from exactfold.branches import count_branches, find_branch
from exactfold.branches.values.known_roots import FEW
from exactfold.branches.values.roots import BoxRoot
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.degenerate import chorded_square
from exactfold.pattern.families import hypar, single_vertex, two_vertex
from exactfold.rigidity import curvature_form
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve import krawczyk

DART = CreasePattern(
    [(0, 0), (4, -4), (1, 0), (4, 4), ("1/2", 0)],
    [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)


def number(value: object) -> sympy.Expr:
    if isinstance(value, Fraction):
        return sympy.Rational(value.numerator, value.denominator)
    assert isinstance(value, sympy.Expr)
    return value


def check(branch: Branch) -> None:
    exact = branch.exact_heights
    assert exact is not None
    values = {v: number(height) for v, height in exact.items()}
    for v, (low, high) in branch.heights.items():
        assert number(low) <= values[v] <= number(high)
    for v in branch.pattern.interior:
        form = curvature_form(branch.pattern, v)
        total = sum(
            number(c) * values[a] * values[b]
            for a, row in zip(form.labels, form.matrix, strict=True)
            for b, c in zip(form.labels, row, strict=True)
        )
        assert abs(sympy.N(total, 60)) < 10**-50


@pytest.mark.parametrize("pattern", slow_after(2, [single_vertex(4), DART, two_vertex()]))
def test_heights_of_the_exact_engine(pattern):
    result = count_branches(pattern, method="groebner")
    assert len(result) == 1 << pattern.Vi
    for branch in result:
        check(branch)


def test_degree_two_is_in_radicals():
    pattern = random_wheel(1, 4)
    for branch in count_branches(pattern, method="groebner"):
        check(branch)
        height = branch.exact_heights[pattern.interior[0]]
        assert height.is_irrational
        assert height.has(sympy.sqrt) or any(
            power.exp == sympy.Rational(1, 2) for power in height.atoms(sympy.Pow)
        )


def test_degree_four_is_a_root_of_its_polynomial():
    heights = count_branches(two_vertex(), method="groebner")[0].exact_heights
    values = [heights[v] for v in two_vertex().interior]
    assert any(isinstance(value, sympy.CRootOf) for value in values)


def test_flat_vertices_have_rational_heights():
    result = count_branches("flat-vertex")
    (double,) = (branch for branch in result if branch.multiplicity == 2)
    check(double)
    assert all(isinstance(height, Fraction) for height in double.exact_heights.values())


def test_multiple_roots_of_a_hypar():
    for branch in count_branches(hypar(1, twist=0)):
        if branch.multiplicity > 1:
            check(branch)


@pytest.mark.parametrize(
    "pattern",
    [
        single_vertex(4),
        DART,
        two_vertex(),
        pytest.param(random_square(3, seed=1), marks=pytest.mark.slow),
    ],
)
def test_heights_of_few_vertices_are_found_when_they_are_asked_for(pattern):
    exact = {branch.names: branch for branch in count_branches(pattern, method="groebner")}
    result = count_branches(pattern)
    assert len(result) == len(exact) == 1 << pattern.Vi
    for branch in result:
        assert branch.root.known is None
        check(branch)
        assert branch.exact_heights == exact[branch.names].exact_heights


def test_bounds_alone_are_not_exact():
    assert count_branches(random_square(FEW + 1, seed=1))[0].exact_heights is None
    assert find_branch(two_vertex(), "+-").exact_heights is None


def squares(*values):
    """x_k^2 = values[k], a system that falls into single unknowns."""
    size = len(values)
    matrices = [[[0] * (size + 1) for _ in range(size + 1)] for _ in values]
    for k, value in enumerate(values):
        matrices[k][k][k], matrices[k][size][size] = 1, -value
    return QuadraticSystem.from_rational(matrices)


@pytest.mark.parametrize("side", [1, -1])
def test_rational_roots_of_any_number_of_unknowns_are_recognised(side):
    roots = [Fraction(k, 10**6 + k) * (-1) ** k for k in range(1, 8)]
    system = squares(*(root**2 for root in roots))
    root = BoxRoot(krawczyk(system, [[float(x) for x in roots]])[0], side, system)
    for k, value in enumerate(roots):
        assert root.exact([Fraction(int(j == k)) for j in range(8)]) == side * value


def test_roots_that_are_nearly_rational_are_not_called_so():
    """By a distance that no double sees: 1 + 2^-80 is no square of a rational number."""
    values = [*[Fraction(1)] * FEW, 1 + Fraction(1, 2**80)]
    system = squares(*values)
    (box,) = krawczyk(system, [[1] * len(values)])
    root = BoxRoot(box, 1, system)
    assert root.exact([*[0] * FEW, 1, 0]) is None
    few = squares(values[-1])
    (box,) = krawczyk(few, [[1]])
    assert BoxRoot(box, 1, few).exact([1, 0]) == sympy.sqrt(1 + sympy.Rational(1, 2**80))


def test_all_methods_share_one_gauge():
    """Heights of a sheet with a reflex corner agree, whichever chart they were found in."""
    assert Problem.of(DART).gauge.kind == "corner"
    for a, b in zip(count_branches(DART), count_branches(DART, method="groebner"), strict=True):
        assert a.gauge == b.gauge == "saddle"
        for v in range(len(DART.vertices)):
            (low, high), (other_low, other_high) = a.heights[v], b.heights[v]
            assert low <= other_high
            assert other_low <= high


def test_a_saddle_that_is_nearly_zero_is_decided_by_every_method():
    """A kite whose saddle is 1e-12 of its size: sides, signs and letters are the same."""
    tiny = Fraction(1, 10**12)
    kite = CreasePattern(
        [(1, 0), (4 + tiny, 5), (-2, 0), (4 + tiny, -5), (0, 0)],
        [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    )
    seen = {
        tuple(
            (b.sign_text, b.assignment_text, b.representative)
            for b in count_branches(kite, method=method)
        )
        for method in ("newton", "popping", "homotopy", "groebner")
    }
    assert len(seen) == 1


def test_a_branch_without_unknowns_is_as_sharp_as_can_be():
    branch = count_branches(chorded_square())[0]
    assert branch.sharpened(200).heights == branch.heights
