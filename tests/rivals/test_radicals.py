"""Nested square roots against popping, lifting and Groebner bases."""

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
import sympy
from rivals.radicals import branch_tower, h1_moves
from sheets import wheel, with_point

from exactfold.errors import NotApplicableError, SolverError, UsageError
from exactfold.pattern import families
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.solve.algebraic.groebner_bases import groebner, root_classes
from exactfold.solve.numeric.popping import popping

PATTERNS = {
    "one": families.h1_sequence(1),
    "two": families.h1_sequence(2, seed=1),
    "three": families.h1_sequence(3, seed=2),
    "four": families.h1_sequence(4, seed=3),
    "two-vertex": families.two_vertex(),
}


def in_chart(pattern, heights):
    """The point of the chart on the same branch: subtract an affine function, and scale."""
    chart = BranchSystem(pattern).chart
    points = np.array([[float(x), float(y), 1.0] for x, y in pattern.vertices])
    h = np.array([float(heights[v]) for v in range(len(points))])
    pinned = list(chart.branch_system.pinned)
    h = h - points @ np.linalg.solve(points[pinned], h[pinned])
    saddle = sum(float(c) * h[v] for v, c in chart.functional.items())
    return h[list(chart.variables)] / saddle


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS)
def test_branches_agree_with_popping(pattern):
    tower = branch_tower(pattern)
    found = []
    for signs in product((1, -1), repeat=pattern.Vi):
        heights = {v: x.evalf(40) for v, x in tower.heights(signs).items()}
        assert all(x.is_real for x in heights.values())
        found.append(in_chart(pattern, heights))
    expected = popping(BranchSystem(pattern).chart).points.real
    assert len(found) == len(expected) == 1 << pattern.Vi
    for point in found:
        distance = np.abs(expected - point).max(axis=1) / (1 + np.abs(point).max())
        assert distance.min() < 1e-9
        expected = np.delete(expected, distance.argmin(), axis=0)


@pytest.mark.parametrize("name", ["one", "two", "three", "two-vertex"])
def test_factor_degrees_agree_with_the_exact_engine(name):
    """The field of a branch from the tower, and from the factors of the branch polynomial."""
    pattern = PATTERNS[name]
    classes = root_classes(branch_tower(pattern).tower.algebra)
    solution = groebner(BranchSystem(pattern).chart.system)
    assert tuple(sorted(c.degree for c in classes)) == solution.factor_degrees
    assert all(c.multiplicity == 1 for c in classes)
    assert all(d & (d - 1) == 0 for d in solution.factor_degrees)
    assert solution.is_irreducible == (solution.factor_degrees == (1 << pattern.Vi,))


def test_heights_are_exact():
    """SymPy, which knows nothing of the tower, finds all forms zero at the nested radicals."""
    pattern = families.h1_sequence(2, seed=1)
    tower = branch_tower(pattern)
    quadrics = BranchSystem(pattern).quadrics
    pinned = BranchSystem(pattern).pinned
    x = sympy.Symbol("x")
    for signs in product((1, -1), repeat=2):
        heights = tower.heights(signs)
        corners = [
            sympy.Matrix(
                [[sympy.Rational(c.numerator, c.denominator) for c in pattern.vertices[v]]]
            )
            for v in pinned
        ]
        plane = sympy.Matrix([[*c, 1] for c in corners]).LUsolve(
            sympy.Matrix([heights[v] for v in pinned])
        )
        for form in quadrics.values():
            flat = [
                heights[v]
                - sum(
                    sympy.Rational(c.numerator, c.denominator) * p
                    for c, p in zip((*pattern.vertices[v], Fraction(1)), plane, strict=True)
                )
                for v in form.labels
            ]
            value = sum(
                sympy.Rational(m.numerator, m.denominator) * a * b
                for row, a in zip(form.matrix, flat, strict=True)
                for m, b in zip(row, flat, strict=True)
            )
            assert sympy.minimal_polynomial(value, x) == x


def test_a_square_radicand_gives_rational_heights():
    # collinear folds at the new interior vertex: its form splits over Q
    pattern = families.single_vertex(4)
    straight = CreasePattern(
        [(0, 0), (4, 0), (4, 4), (0, 4), (1, 2)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]
    )
    assert h1_moves(pattern) is not None
    for p in (pattern, straight):
        rational = [
            all(x.is_rational for x in branch_tower(p).heights((s,)).values()) for s in (1, -1)
        ]
        degrees = groebner(BranchSystem(p).chart.system).factor_degrees
        assert (degrees == (1, 1)) == all(rational) == any(rational)


def test_the_moves_rebuild_the_pattern():
    pattern = families.sample_h1_sequence(5, seed=4).pattern
    moves = h1_moves(pattern)
    added = [w for *_, w in moves]
    assert len(set(added)) == 5
    rebuilt = [{*t} for t in pattern.triangles if not set(t) & set(added)]
    assert len(rebuilt) == 2
    for v1, v2, v3, w in moves:
        before = set().union(*rebuilt)
        assert {v1, v2, v3} <= before
        assert w not in before
        rebuilt += [{v1, v2, w}, {v2, v3, w}]
    assert sorted(map(sorted, rebuilt)) == sorted(map(sorted, pattern.triangles))


MULTIPLE = {
    "flat vertex": families.flat_vertex_square(),
    "degree three": with_point(families.two_vertex(), 0, (1, 1, 1)),
}


@pytest.mark.parametrize("pattern", MULTIPLE.values(), ids=MULTIPLE)
def test_multiple_branches(pattern):
    """Roots of zero radicands: multiplicities from the tower and from the exact engine."""
    classes = root_classes(branch_tower(pattern).tower.algebra)
    solution = groebner(BranchSystem(pattern).chart.system)
    profile = sorted((c.degree, c.multiplicity) for c in classes)
    assert profile == sorted((c.degree, c.multiplicity) for c in solution.classes)
    assert max(m for _, m in profile) == 2


@pytest.mark.parametrize("pattern", [families.hypar(1), wheel([(1, 0), (0, 1), (-1, 0), (0, -1)])])
def test_patterns_not_built_by_moves_error(pattern):
    assert h1_moves(pattern) is None
    with pytest.raises(NotApplicableError, match="not built by H1 moves"):
        branch_tower(pattern)


def test_other_boundaries_have_no_moves():
    assert h1_moves(families.waterbomb()) is None
    assert h1_moves(random_square(6, seed=1)) is None


@pytest.mark.parametrize("signs", [(1,), (1, 0), (1, 1, 1)])
def test_wrong_signs_error(signs):
    with pytest.raises(UsageError, match="2 signs"):
        branch_tower(PATTERNS["two"]).heights(signs)


def test_changed_heights_are_refused_error():
    tower = branch_tower(PATTERNS["two"])
    last = tower.moves[-1][3]
    changed = list(tower.elements)
    changed[last] = (changed[last][0] + 1, *changed[last][1:])
    with pytest.raises(SolverError, match="does not vanish"):
        replace(tower, elements=tuple(changed)).verify()
