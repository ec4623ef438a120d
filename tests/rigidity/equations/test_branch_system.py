"""The branch system and its charts, against the curvature forms of the pattern."""

from fractions import Fraction
from itertools import combinations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import MalformedPatternError, NotApplicableError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import single_vertex
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.functionals import saddle_functional
from exactfold.solve.algebraic.groebner_bases import groebner

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
TWO_VERTICES = CreasePattern(
    [*CORNERS, ("1/3", "1/2"), ("2/3", "2/5")],
    [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)],
)
REFLEX = CreasePattern(  # boundary vertex 2 is reflex
    [(0, 0), (4, 0), ("3/2", "3/2"), (0, 4), (1, "2/3"), ("1/2", "3/2")],
    [(0, 1, 4), (1, 2, 4), (2, 5, 4), (2, 3, 5), (3, 0, 5), (0, 4, 5)],
)
STRAIGHT = CreasePattern(  # boundary vertices 0, 1, 2 are collinear
    [(0, 0), (1, 0), (2, 0), (1, 3), ("9/10", 1)],
    [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
)
PATTERNS = [TWO_VERTICES, REFLEX, STRAIGHT, single_vertex(4)]
rationals = st.fractions(min_value=-9, max_value=9, max_denominator=12)


def affine_difference(pattern, first, second):
    """Whether two height functions differ by a + b x + c y."""
    rows = [(Fraction(1), x, y, first[v] - second[v]) for v, (x, y) in enumerate(pattern.vertices)]
    base = next(
        t for t in combinations(range(len(rows)), 3) if determinant([rows[k][:3] for k in t]) != 0
    )
    return all(
        determinant([rows[k] for k in (*base, v)]) == 0 for v in range(len(rows)) if v not in base
    )


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum(
        (-1) ** j * rows[0][j] * determinant([[*r[:j], *r[j + 1 :]] for r in rows[1:]])
        for j in range(len(rows))
    )


@pytest.mark.parametrize("pattern", PATTERNS)
def test_quadrics_are_the_curvature_forms_on_pinned_heights(pattern):
    for pinned in combinations(pattern.boundary, 3):
        try:
            system = BranchSystem(pattern, pinned)
        except MalformedPatternError:
            continue
        heights = {v: Fraction(v * v + 3, v + 2) for v in range(len(pattern.vertices))}
        heights.update(dict.fromkeys(pinned, Fraction(0)))
        for v, form in system.quadrics.items():
            assert form(heights) == curvature_form(pattern, v)(heights)
            assert set(form.labels).isdisjoint(pinned)


@pytest.mark.parametrize("pattern", PATTERNS)
@given(st.data())
@settings(max_examples=15)
def test_chart_values_are_positive_multiples_of_the_curvature_forms(pattern, data):
    chart = BranchSystem(pattern).chart
    x = data.draw(st.lists(rationals, min_size=pattern.Vi, max_size=pattern.Vi))
    heights = chart.heights(x)
    values = chart.system.values_at(x)
    saddle = saddle_functional(pattern)
    assert sum(c * heights[v] for v, c in saddle.items()) == 1
    for v in chart.branch_system.pinned:
        assert heights[v] == 0
    for k, v in enumerate(chart.variables):
        assert heights[v] == x[k]
    for value, v in zip(values, pattern.interior, strict=True):
        exact = curvature_form(pattern, v)(heights)
        assert (value > 0) - (value < 0) == (exact > 0) - (exact < 0)


@pytest.mark.parametrize("pattern", PATTERNS)
def test_chart_scale_is_one_constant_for_each_quadric(pattern):
    chart = BranchSystem(pattern).chart
    ratios = {}
    for seed in range(1, 5):
        x = [Fraction(seed * (k + 2) + 1, k + 3) for k in range(pattern.Vi)]
        heights = chart.heights(x)
        for value, v in zip(chart.system.values_at(x), pattern.interior, strict=True):
            exact = curvature_form(pattern, v)(heights)
            if exact:
                ratios.setdefault(v, set()).add(value / exact)
    assert all(len(values) == 1 and min(values) > 0 for values in ratios.values())


@pytest.mark.parametrize("pattern", PATTERNS)
def test_restrict_expresses_functionals_in_the_chart(pattern):
    chart = BranchSystem(pattern).chart
    functional = {v: Fraction(v + 1, 2) for v in range(len(pattern.vertices))}
    x = [Fraction(k - 3, 7) for k in range(pattern.Vi)]
    *row, constant = chart.restrict(functional)
    expected = sum(
        c * h for c, h in zip(functional.values(), chart.heights(x).values(), strict=True)
    )
    assert sum(a * b for a, b in zip(row, x, strict=True)) + constant == expected


@pytest.mark.parametrize("pattern", [TWO_VERTICES, REFLEX])
def test_roots_in_two_gauges_differ_by_an_affine_function(pattern):
    """Both charts fix the same saddle, so that each root of one is a root of the other."""
    first = BranchSystem(pattern).chart
    other = next(p for p in combinations(pattern.boundary, 3) if p != first.branch_system.pinned)
    second = BranchSystem(pattern, other).chart
    x = [Fraction(2 * k + 1, k + 5) for k in range(pattern.Vi)]
    heights = first.heights(x)
    moved = pinned_to_zero(pattern, heights, other)
    assert affine_difference(pattern, heights, moved)
    again = second.heights([moved[v] for v in second.variables])
    assert again == moved
    one, two = groebner(first.system), groebner(second.system)
    assert sorted((c.degree, c.multiplicity) for c in one.classes) == sorted(
        (c.degree, c.multiplicity) for c in two.classes
    )


def pinned_to_zero(pattern, heights, pinned):
    """Subtract the affine function that agrees with the heights at the pinned vertices."""
    rows = [(Fraction(1), *pattern.vertices[v]) for v in pinned]
    whole = determinant(rows)
    plane = []
    for column in range(3):
        swapped = [
            [heights[v] if j == column else a for j, a in enumerate(row)]
            for v, row in zip(pinned, rows, strict=True)
        ]
        plane.append(determinant(swapped) / whole)
    return {
        v: heights[v] - plane[0] - plane[1] * x - plane[2] * y
        for v, (x, y) in enumerate(pattern.vertices)
    }


def test_scaling_the_sheet_keeps_the_branches():
    doubled = CreasePattern(
        [(3 * x + 1, 3 * y - 2) for x, y in TWO_VERTICES.vertices], TWO_VERTICES.triangles
    )
    first, second = (groebner(BranchSystem(p).chart.system) for p in (TWO_VERTICES, doubled))
    assert [c.degree for c in first.classes] == [c.degree for c in second.classes]


def test_default_pins_are_boundary_vertices_in_general_position():
    for pattern in PATTERNS:
        system = BranchSystem(pattern)
        assert set(system.pinned) <= set(pattern.boundary)
        assert len(system.variables) == pattern.Vi + pattern.degrees_of_freedom


def test_straight_boundary_angle_pins_around_it():
    chart = BranchSystem(STRAIGHT).chart
    assert set(chart.branch_system.pinned) != {0, 1, 2}
    # The vertex in the middle of a straight side carries no saddle together with the apex.
    assert chart.heights([Fraction(0)])[chart.eliminated] != 0


def test_pinning_the_interior_is_allowed():
    system = BranchSystem(TWO_VERTICES, (0, 1, 4))
    assert system.variables == (2, 3, 5)


def test_collinear_pins_error():
    with pytest.raises(MalformedPatternError, match="collinear"):
        BranchSystem(STRAIGHT, (0, 1, 2))


@pytest.mark.parametrize("pinned", [(0, 1), (0, 0, 1), (0, 1, 99), (-1, 0, 1)])
def test_unusable_pins_error(pinned):
    with pytest.raises(UsageError, match="three different vertices"):
        BranchSystem(TWO_VERTICES, pinned)


def test_chart_needs_four_boundary_vertices_error():
    with pytest.raises(NotApplicableError, match="four boundary vertices, not 6"):
        _ = BranchSystem(single_vertex(6)).chart
