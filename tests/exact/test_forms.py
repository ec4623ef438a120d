"""Quadratic forms on labelled variables: values, squares, and their SymPy expressions."""

import pickle
from dataclasses import FrozenInstanceError
from fractions import Fraction
from operator import truediv

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold import random_square
from exactfold.errors import UsageError
from exactfold.exact.forms import QuadraticForm
from exactfold.pattern.families import single_vertex, two_vertex
from exactfold.rigidity.curvature import curvature_form, spokes, star_matrix, stress_form
from exactfold.rigidity.equations.branch_system import BranchSystem

quick = settings(max_examples=60, deadline=None)
rationals = st.builds(Fraction, st.integers(-9, 9), st.integers(1, 5))


@st.composite
def forms(draw):
    size = draw(st.integers(1, 5))
    labels = draw(st.permutations(range(2 * size)))[:size]
    upper = {(i, j): draw(rationals) for i in range(size) for j in range(i + 1)}
    matrix = tuple(tuple(upper[max(i, j), min(i, j)] for j in range(size)) for i in range(size))
    return QuadraticForm(tuple(labels), matrix)


def points(form, data):
    return {v: data.draw(rationals) for v in form.labels}


@quick
@given(forms(), st.data())
def test_the_diagonal_has_the_values_of_the_form(form, data):
    heights = points(form, data)
    found = form.diagonalised
    values = [
        sum(c * heights[v] for c, v in zip(row, form.labels, strict=True)) for row in found.rows
    ]
    assert sum(w * x * x for w, x in zip(found.weights, values, strict=True)) == form(heights)


@quick
@given(forms())
def test_two_ways_to_the_inertia(form):
    found = form.diagonalised
    positive, negative, zero = form.inertia
    assert found.inertia == (positive, negative, zero)
    assert found.signature == positive - negative
    assert "\n" not in repr(found)


@pytest.mark.parametrize("degree", range(3, 9))
def test_curvature_forms_have_one_positive_square(degree):
    found = curvature_form(single_vertex(degree), degree).diagonalised
    assert [w > 0 for w in found.weights].count(True) == 1
    assert (len(found.weights), found.zero, found.signature) == (degree - 2, 3, 4 - degree)


@settings(max_examples=20, deadline=None)
@given(forms(), st.data())
def test_the_expression_has_the_values_of_the_form(form, data):
    heights = points(form, data)
    exact = {sympy.Symbol(f"h{v}"): sympy.Rational(str(x)) for v, x in heights.items()}
    value = form.to_sympy().subs(exact)
    assert value == sympy.Rational(str(form(heights)))


def test_the_expression_is_expanded_in_any_symbols():
    form = QuadraticForm((4, 7), ((Fraction(1, 3), Fraction(-1)), (Fraction(-1), Fraction(0))))
    x, y = sympy.symbols("x y")
    assert form.to_sympy({4: x, 7: y, 9: x}) == x**2 / 3 - 2 * x * y
    assert form.to_sympy({4: x + y, 7: y}) == x**2 / 3 - sympy.Rational(4, 3) * x * y - (
        sympy.Rational(5, 3) * y**2
    )
    with pytest.raises(UsageError, match="vertex 7"):
        form.to_sympy({4: x})


def test_forms_of_a_system_are_those_it_exports():
    import exactfold

    system = BranchSystem(two_vertex())
    exported, symbols = exactfold.interop.to_sympy(system)
    for expression, form in zip(exported, system.quadrics.values(), strict=True):
        mine = form.to_sympy()
        assert mine.free_symbols <= set(symbols)
        assert sympy.cancel(expression / mine).is_positive  # the export scales to integers


def test_a_notebook_shows_small_forms_only():
    form = curvature_form(two_vertex(), 4)
    assert form._repr_latex_().startswith("$Q(h) = h_{0}^{2} + ")
    assert r" + \frac{64125 h_{4}^{2}}{5044} - " in form._repr_latex_()
    assert curvature_form(single_vertex(12), 12)._repr_latex_() is None
    zero = QuadraticForm((0,), ((Fraction(0),),))
    assert zero.to_sympy() == 0
    assert zero._repr_latex_() == "$Q(h) = 0$"


def test_forms_from_integers_are_those_from_fractions_and_do_not_change():
    over = QuadraticForm.over(12, [4, 7], [[4, -6], [-6, 0]])
    form = QuadraticForm(
        (4, 7), ((Fraction(1, 3), Fraction(-1, 2)), (Fraction(-1, 2), Fraction(0)))
    )
    assert (over.integers, over.denominator) == (((2, -3), (-3, 0)), 6)
    assert (form.integers, form.denominator) == (over.integers, over.denominator)
    assert form == over == pickle.loads(pickle.dumps(over))
    assert hash(form) == hash(over)
    assert form != QuadraticForm((7, 4), form.matrix)
    assert form != form.matrix
    with pytest.raises(FrozenInstanceError):
        form.labels = (1, 2)
    with pytest.raises(FrozenInstanceError):
        del form.labels


def test_forms_take_values_of_other_kinds():
    form = curvature_form(two_vertex(), 4)
    heights = {v: Fraction(v * v, 3) for v in form.labels}
    floats = {v: float(height) for v, height in heights.items()}
    assert form(floats) == pytest.approx(float(form(heights)))
    symbols = {v: sympy.Symbol(f"h{v}") for v in form.labels}
    assert sympy.expand(form(symbols) - form.to_sympy(symbols)) == 0


def test_curvature_forms_do_not_depend_on_the_way_they_are_computed():
    for v in (sheet := random_square(5, seed=2)).interior:
        ring, d = spokes(sheet, v)
        assert curvature_form(sheet, v) == QuadraticForm((v, *ring), star_matrix(d, truediv))


def test_stresses_that_are_whole_numbers_have_a_form():
    assert stress_form(single_vertex(3), {(0, 1): 1}).matrix[0][:2] == (
        Fraction(1, 2),
        Fraction(-1, 2),
    )
