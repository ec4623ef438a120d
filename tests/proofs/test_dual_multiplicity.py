"""Dual spaces prove multiplicities; tampered ones are rejected."""

from dataclasses import replace
from fractions import Fraction

import pytest

from exactfold.errors import SolverError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import groebner
from proofs.dual_multiplicity import check_complete, check_dual_space
from proofs.dual_space import DualSpace, dual_space

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
FLAT_STAR = CreasePattern(
    [*CORNERS, ("1/2", "1/2"), ("7/10", "1/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
RIGID_INSIDE = CreasePattern(
    [*CORNERS, ("1/2", "1/3"), ("1/2", "1/8")],
    [(0, 1, 5), (1, 4, 5), (4, 0, 5), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)
RIGID_TWICE = CreasePattern(
    [*CORNERS, ("1/2", "1/3"), ("1/2", "1/8"), ("2/3", "11/72")],
    [(0, 1, 5), (5, 1, 6), (1, 4, 6), (4, 5, 6), (4, 0, 5), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)
CONCENTRIC = CreasePattern(
    [(-3, -3), (3, -3), (3, 3), (-3, 3), (-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0)],
    [(4, 5, 8), (5, 6, 8), (6, 7, 8), (7, 4, 8)]
    + [
        t
        for k in range(4)
        for t in ((k, (k + 1) % 4, 4 + (k + 1) % 4), (k, 4 + (k + 1) % 4, 4 + k))
    ],
)
# x^2 = y meets y^2 = 0, and x y = 0 meets x^2 = y^2, in a fourfold point at the origin.
TANGENT = QuadraticSystem.from_rational(
    [[[2, 0, 0], [0, 0, -1], [0, -1, 0]], [[0, 0, 0], [0, 1, 0], [0, 0, 0]]]
)
FOUR_LINES = QuadraticSystem.from_rational(
    [[[0, 1, 0], [1, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, -1, 0], [0, 0, 0]]]
)


def chart_system(pattern):
    return BranchSystem(pattern).chart.system


def proofs(system):
    classes = groebner(system).classes
    return [(c, dual_space(system, c, c.multiplicity + 1)) for c in classes]


def origin(size, multiplicity=1):
    return RootClass((0, 1), ((),) * size, multiplicity, (1,) + (0,) * (size - 1))


@pytest.mark.parametrize(
    "system",
    [TANGENT, FOUR_LINES, *map(chart_system, (FLAT_STAR, RIGID_INSIDE, RIGID_TWICE, CONCENTRIC))],
)
def test_dual_spaces_agree_with_the_quotient_algebra(system):
    found = proofs(system)
    for root_class, dual in found:
        assert dual.is_complete
        assert dual.dimension == root_class.multiplicity
        check_dual_space(system, root_class, dual)
    check_complete(system, found)


def test_multiplicity_of_a_rigid_triangle_doubles_each_time():
    assert [d.dimension for _, d in proofs(chart_system(RIGID_INSIDE))] == [2]
    assert [d.dimension for _, d in proofs(chart_system(RIGID_TWICE))] == [4]


def test_curvilinear_point_has_depth_three():
    [(_, dual)] = proofs(TANGENT)
    assert (dual.dimension, dual.depth) == (4, 3)


def test_planar_point_has_depth_two():
    [(_, dual)] = proofs(FOUR_LINES)
    assert (dual.dimension, dual.depth) == (4, 2)
    assert {sum(a) for a in dual.pivots} == {0, 1, 2}


def test_regular_zero_has_the_value_alone():
    system = chart_system(FLAT_STAR)
    simple = next(c for c in groebner(system).classes if c.multiplicity == 1)
    dual = dual_space(system, simple, 5)
    assert dual.functionals == ({(0, 0): (Fraction(1),)},)
    assert dual.is_complete


def test_limit_stops_early_with_a_lower_bound():
    [root_class] = groebner(TANGENT).classes
    dual = dual_space(TANGENT, root_class, 2)
    assert dual.dimension == 2
    assert not dual.is_complete
    check_dual_space(TANGENT, root_class, dual)
    with pytest.raises(SolverError, match="isolated"):
        check_complete(TANGENT, [(root_class, dual)])


def test_incomplete_space_must_not_claim_completeness_error():
    [root_class] = groebner(TANGENT).classes
    dual = replace(dual_space(TANGENT, root_class, 2), is_complete=True)
    with pytest.raises(SolverError, match="not proved to be complete"):
        check_dual_space(TANGENT, root_class, dual)


def test_points_of_a_curve_do_not_prove_completeness_error():
    # x y = x (y + 1) = 0 is the line x = 0: four of its points are four zeros, but not isolated.
    system = QuadraticSystem.from_rational(
        [[[0, 1, 0], [1, 0, 0], [0, 0, 0]], [[0, 1, 1], [1, 0, 0], [1, 0, 0]]]
    )
    zero = RootClass.from_coordinates(
        (24, -50, 35, -10, 1), [(), (Fraction(0), Fraction(1))], 1, (0, 1)
    )
    value = DualSpace(({(0, 0): (Fraction(1),)},), ((0, 0),), is_complete=False)
    check_dual_space(system, zero, value)
    with pytest.raises(SolverError, match="isolated"):
        check_complete(system, [(zero, value)])
    with pytest.raises(SolverError, match="complete"):
        check_complete(system, [(zero, replace(value, is_complete=True))])
    long = dual_space(system, zero, 4)
    assert long.dimension >= 4
    assert not long.is_complete


def test_dual_space_away_from_the_zeros_error():
    with pytest.raises(SolverError, match="not a zero"):
        dual_space(
            FOUR_LINES, RootClass.from_coordinates((-1, 1), [(Fraction(1),)] * 2, 1, (1, 0)), 2
        )


def test_missing_class_error():
    found = proofs(chart_system(FLAT_STAR))
    with pytest.raises(SolverError, match="add up to 2"):
        check_complete(chart_system(FLAT_STAR), found[1:])


def test_repeated_class_error():
    found = proofs(chart_system(FLAT_STAR))
    with pytest.raises(SolverError, match="share a root"):
        check_complete(chart_system(FLAT_STAR), [found[0], found[0]])


def test_classes_of_different_forms_error():
    system = chart_system(FLAT_STAR)
    (first, dual), *rest = proofs(system)
    t = Fraction(-first.polynomial[0], first.polynomial[1])
    form = tuple(2 * x for x in first.separating)
    doubled = RootClass.from_coordinates(
        (int(-2 * t * t.denominator), t.denominator), first.coordinates, 2, form
    )
    with pytest.raises(SolverError, match="different linear forms"):
        check_complete(system, [(doubled, dual), *rest])


def tampered(dual):
    """Changed copies of a dual space of dimension four at the origin, with what is wrong."""
    one = (Fraction(1),)
    *head, last = dual.functionals
    yield replace(dual, functionals=(*head, {**last, (4, 0): one})), "leaves the space"
    yield replace(dual, functionals=(*head, {**last, (1, 0): (Fraction(3),)})), "reduced at pivot"
    yield replace(dual, functionals=(*head, head[0])), "reduced at pivot"
    yield replace(dual, functionals=tuple(head)), "needs a pivot"
    yield replace(dual, functionals=(), pivots=()), "needs a pivot"
    yield replace(dual, functionals=(*head, {**last, (0, 0, 0): one})), "wrong shape"
    scaled = {a: tuple(2 * x for x in c) for a, c in last.items()}
    yield replace(dual, functionals=(*head, scaled)), "reduced at pivot"


@pytest.mark.parametrize("index", range(7))
def test_tampered_dual_space_error(index):
    [(root_class, dual)] = proofs(TANGENT)
    changed, message = list(tampered(dual))[index]
    with pytest.raises(SolverError, match=message):
        check_dual_space(TANGENT, root_class, changed)


def test_functional_that_does_not_vanish_error():
    one = (Fraction(1),)
    line = DualSpace(({(0, 0): one}, {(1, 0): one}, {(2, 0): one}), ((0, 0), (1, 0), (2, 0)), False)
    with pytest.raises(SolverError, match="does not vanish on quadric 0"):
        check_dual_space(TANGENT, origin(2), line)


def test_class_that_is_not_a_zero_error():
    value = DualSpace(({(0, 0): (Fraction(1),)},), ((0, 0),), True)
    moved = RootClass.from_coordinates((-1, 1), [(Fraction(1),)] * 2, 1, (1, 0))
    with pytest.raises(SolverError, match="does not vanish on the root class"):
        check_dual_space(TANGENT, moved, value)
