"""The operations of Arb that the proof uses against exact rationals, and the pieces of the test."""

from __future__ import annotations

import operator
from fractions import Fraction
from typing import Any

import pytest
from flint import acb, acb_mat, arb, arb_mat, ctx
from hypothesis import given, settings
from hypothesis import strategies as st
from rivals import ball_krawczyk as module
from rivals.ball_krawczyk import arb_krawczyk, decide_contains_one_zero

from exactfold._support.verdict import PROVED
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified

SQRT2 = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])

# middle, radius and exponent: all signs, zeros, huge and tiny numbers, more bits than the precision
middles = st.one_of(st.integers(-3, 3), st.integers(-(2**120), 2**120))
radii = st.one_of(st.integers(0, 2), st.integers(0, 2**90))
numbers = st.tuples(middles, radii, st.integers(-130, 130))
# where in the two balls to look, in 64ths of the radius
places = st.integers(-64, 64)
Number = tuple[int, int, int]


def ball(value: Number) -> Any:
    middle, radius, exponent = value
    return arb((middle, exponent), (radius, exponent))


def member(value: Number, place: int) -> Fraction:
    middle, radius, exponent = value
    return (middle + radius * Fraction(place, 64)) * Fraction(2) ** exponent


def holds(value: Any, number: Fraction) -> bool:
    ((low, high),) = module._ends(value)
    return low <= number <= high


def width(value: Any) -> Fraction:
    ((low, high),) = module._ends(value)
    return high - low


@given(value=numbers, place=places)
def test_balls_hold_what_they_are_made_of(value: Number, place: int) -> None:
    x = ball(value)
    middle, radius, exponent = value
    scale = Fraction(2) ** exponent
    assert holds(x, member(value, place))
    assert holds(x, member(value, 64))
    assert holds(x, member(value, -64))
    assert module._fraction(x.mid()) == middle * scale
    assert width(x) <= 2 * radius * scale * (1 + Fraction(1, 2**28))


@pytest.mark.slow
@pytest.mark.parametrize("operation", [operator.add, operator.sub, operator.mul])
@pytest.mark.parametrize("precision", [2, 53, 106])
@settings(max_examples=50)
@given(a=numbers, b=numbers, place=places, other=places)
def test_basic_arithmetic_encloses_and_is_narrow(
    operation: Any, precision: int, a: Number, b: Number, place: int, other: int
) -> None:
    x, y = ball(a), ball(b)
    with ctx.workprec(precision):
        result = operation(x, y)
    for p, q in ((place, other), (64, 64), (64, -64), (-64, 64), (-64, -64)):
        assert holds(result, operation(member(a, p), member(b, q)))
    reach = [abs(member(v, 0)) for v in (a, b)]
    spread = [abs(member((0, v[1], v[2]), 64)) for v in (a, b)]
    if operation is operator.mul:
        true = reach[0] * spread[1] + reach[1] * spread[0] + spread[0] * spread[1]
        size = reach[0] * reach[1]
    else:
        true, size = sum(spread), sum(reach)
    assert width(result) <= 2 * true * (1 + Fraction(1, 2**20)) + size * Fraction(5, 2**precision)


entries = st.lists(numbers, min_size=9, max_size=9)


@pytest.mark.parametrize("precision", [53, 200])
@settings(max_examples=30)
@given(left=entries, right=entries, spots=st.lists(places, min_size=18, max_size=18))
def test_matrix_products_and_differences_enclose(
    precision: int, left: list[Number], right: list[Number], spots: list[int]
) -> None:
    with ctx.workprec(precision):
        a, b = arb_mat(3, 3, list(map(ball, left))), arb_mat(3, 3, list(map(ball, right)))
        product, difference, total = a * b, a - b, a + b
    p = [member(v, k) for v, k in zip(left, spots[:9], strict=True)]
    q = [member(v, k) for v, k in zip(right, spots[9:], strict=True)]
    for i in range(3):
        for j in range(3):
            exact = sum(p[3 * i + k] * q[3 * k + j] for k in range(3))
            assert holds(product[i, j], Fraction(exact))
            assert holds(difference[i, j], p[3 * i + j] - q[3 * i + j])
            assert holds(total[i, j], p[3 * i + j] + q[3 * i + j])


@settings(max_examples=30)
@given(left=entries, right=entries, spots=st.lists(places, min_size=20, max_size=20))
def test_complex_products_hold_the_real_matrices_they_stand_for(
    left: list[Number], right: list[Number], spots: list[int]
) -> None:
    """Also where the four real parts vary independently, as uniqueness over C needs."""
    a = acb_mat(2, 2, [acb(ball(x), ball(y)) for x, y in zip(left[:4], left[4:8], strict=True)])
    b = acb_mat(2, 1, [acb(ball(x), ball(y)) for x, y in zip(right[:2], right[2:4], strict=True)])
    product = a * b
    for i in range(2):
        real = imag = Fraction(0)
        for k in range(2):
            re, im = left[2 * i + k], left[4 + 2 * i + k]
            x, y = member(right[k], spots[k]), member(right[2 + k], spots[2 + k])
            place = 4 + 4 * (2 * i + k)
            # the entries of ((re, -im), (im, re)) drawn separately
            real += member(re, spots[place]) * x - member(im, spots[place + 1]) * y
            imag += member(im, spots[place + 2]) * x + member(re, spots[place + 3]) * y
        assert holds(product[i, 0].real, real)
        assert holds(product[i, 0].imag, imag)


@given(
    centre=st.lists(st.integers(-(2**70), 2**70), min_size=2, max_size=2),
    radius=st.integers(0, 2**60),
    bits=st.integers(0, 90),
)
def test_cubes_hold_the_box_and_little_more(centre: list[int], radius: int, bits: int) -> None:
    balls = module._Balls(SQRT2, acb, acb_mat)
    (entry,) = balls._cube(centre, radius, bits).entries()
    for c, (low, high) in zip(centre, module._ends(entry), strict=True):
        scale = Fraction(1, 1 << bits)
        assert low <= (c - radius) * scale
        assert (c + radius) * scale <= high
        assert high - low <= 2 * radius * scale * (1 + Fraction(1, 2**28))


@pytest.mark.parametrize("kind", [(arb, arb_mat), (acb, acb_mat)])
@given(x=numbers, place=places)
def test_derivatives_enclose(kind: Any, x: Number, place: int) -> None:
    """F(x) = (3 x^2 + 2 b x + c)/2 and F'(x) = 3 x + b, with coefficients of 200 bits."""
    b, c = 2**200 + 1, -(3**120)
    system = QuadraticSystem((((3, b), (b, c)),))
    number, matrix = kind
    balls = module._Balls(system, number, matrix)
    jacobian, values = balls._derivatives(matrix(1, 1, [number(ball(x))]))
    t = member(x, place)
    slope, value = (m[0, 0] if number is arb else m[0, 0].real for m in (jacobian, values))
    assert holds(slope, 3 * t + b)
    assert holds(value, (3 * t * t + 2 * b * t + c) / 2)


def test_precision_of_the_context_is_neither_read_nor_changed() -> None:
    before = ctx.prec
    expected = arb_krawczyk(SQRT2, [[1.4], [0.0], [5.0]])
    box = expected[0]
    assert isinstance(box, IsolatingBox)
    assert all(isinstance(result, Uncertified) for result in expected[1:])
    try:
        ctx.prec = 7
        assert arb_krawczyk(SQRT2, [[1.4], [0.0], [5.0]]) == expected
        assert decide_contains_one_zero(SQRT2, box) is PROVED
        assert ctx.prec == 7
    finally:
        ctx.prec = before


@pytest.mark.parametrize("precision", [53, 106, 212, 1696])
def test_boxes_are_as_narrow_as_the_precision_allows(precision: int) -> None:
    (box,) = arb_krawczyk(SQRT2, [[1.414]], precisions=(precision,))
    assert isinstance(box, IsolatingBox)
    low, high = box.interval(0)
    assert low**2 < 2 < high**2
    assert high - low <= Fraction(64, 2**precision)


@pytest.mark.parametrize(
    ("matrix", "point", "words"),
    [
        ([[1, 0], [0, 0]], 0.0, "singular"),
        ([[0, 0], [0, 1]], 1.0, "singular"),
        ([[1, 0], [0, -2]], 3.0, "left the candidate"),
        ([[1, 0], [0, 0]], 1e-3j, "at 1696 bits"),
        ([[1, 0], [0, 1]], 1e-3, "bits"),
    ],
)
def test_reasons_name_the_failing_test(matrix: list[list[int]], point: complex, words: str) -> None:
    (result,) = arb_krawczyk(QuadraticSystem.from_rational([matrix]), [[point]])
    assert isinstance(result, Uncertified)
    assert words in result.reason
