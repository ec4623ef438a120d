"""mpmath's basic interval arithmetic against exact rationals, and the pieces of the test."""

from __future__ import annotations

import operator
import re
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import mpmath
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import exactfold
from exactfold.errors import UsageError
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify import ball_newton as module
from exactfold.solve.certify.ball_newton import interval_newton
from exactfold.solve.certify.box import IsolatingBox, Uncertified

SQRT2 = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
OPERATIONS = [operator.add, operator.sub, operator.mul, operator.truediv]
Ends = tuple[int, int, int]

# low, width and exponent: all signs, zeros, huge and tiny numbers, and end points with more bits
# than the working precision
entries = st.one_of(st.integers(-3, 3), st.integers(-(2**80), 2**80), st.integers(-9, 9))
widths = st.one_of(st.integers(0, 2), st.integers(0, 2**82), st.integers(0, 9))
intervals = st.tuples(entries, widths, st.integers(-130, 130))


def worker(precision: int) -> Any:
    result = module._Worker(SQRT2)
    result.iv.prec = precision
    return result


def ends(interval: Any) -> tuple[Fraction, Fraction]:
    low, high = (exactly(end) for end in (interval.a, interval.b))
    return low, high


def exactly(end: Any) -> Fraction:
    """The value of an interval of width 0, with room for 2000 bits on either side of the point."""
    value = mpmath.mpf(end, prec=4000)
    number = Fraction(int(mpmath.ldexp(value, 2000)), 2**2000)
    assert mpmath.ldexp(int(number * 2**2000), -2000) == value  # nothing was cut off
    return number


def exact(value: Ends) -> tuple[Fraction, Fraction]:
    low, width, exponent = value
    return Fraction(low) * Fraction(2) ** exponent, Fraction(low + width) * Fraction(2) ** exponent


def ulp_bound(x: Fraction, precision: int) -> Fraction:
    """Outward rounding moves an end point by at most |x| 2^(1 - precision)."""
    return abs(x) * Fraction(2) ** (1 - precision)


@pytest.mark.parametrize("operation", OPERATIONS)
@pytest.mark.parametrize("precision", [2, 5, 53, 106])
@settings(max_examples=20)  # for each of four operations with four precisions
@given(a=intervals, b=intervals)
@example(a=(-1, 2, 0), b=(-1, 2, 0))
@example(a=(0, 0, 0), b=(-1, 2, 0))
@example(a=(-1, 1, 0), b=(0, 1, 0))
@example(a=(1, 0, 0), b=(3, 0, 0))
@example(a=(2**80 - 1, 1, -80), b=(-(2**80) + 1, 2**81, 17))
def test_basic_arithmetic_encloses_and_is_narrow(
    operation: Any, precision: int, a: Ends, b: Ends
) -> None:
    box = worker(precision)
    (a0, a1), (b0, b1) = exact(a), exact(b)
    if operation is operator.truediv and b0 <= 0 <= b1:
        return  # never computed: pivots exclude zero
    x, y = box._dyadic(a[0], a[0] + a[1], -a[2]), box._dyadic(b[0], b[0] + b[1], -b[2])
    assert ends(x) == (a0, a1)
    assert ends(y) == (b0, b1)
    corners = [operation(p, q) for p, q in product((a0, a1), (b0, b1))]
    low, high = ends(operation(x, y))
    assert low <= min(corners)
    assert max(corners) <= high
    assert min(corners) - low <= ulp_bound(min(corners), precision)
    assert high - max(corners) <= ulp_bound(max(corners), precision)


@pytest.mark.parametrize("precision", [5, 53, 106])
@given(value=intervals, other=intervals)
def test_halving_and_comparison(precision: int, value: Ends, other: Ends) -> None:
    box = worker(precision)
    x = box._dyadic(value[0], value[0] + value[1], -value[2])
    y = box._dyadic(other[0], other[0] + other[1], -other[2])
    (low, high), (a, b), (c, d) = ends(x / 2), exact(value), exact(other)
    assert low <= a / 2
    assert b / 2 <= high
    assert a / 2 - low <= ulp_bound(a / 2, precision)
    assert high - b / 2 <= ulp_bound(b / 2, precision)
    assert module._inside(x, y) == (c < a and b < d)
    assert ((x > 0) is True) == (a > 0)
    assert ((x < 0) is True) == (b < 0)


@given(value=intervals, bits=st.integers(0, 200))
def test_outward_integers(value: Ends, bits: int) -> None:
    x = worker(106)._dyadic(value[0], value[0] + value[1], -value[2])
    low, high = module._outward(x, bits)
    a, b = exact(value)
    assert low <= a * 2**bits < low + 1
    assert high - 1 < b * 2**bits <= high


matrices = st.lists(st.lists(st.integers(-4, 4), min_size=4, max_size=4), min_size=3, max_size=3)


@given(matrix=matrices, noise=matrices)
def test_elimination_encloses_solutions_of_all_members(
    matrix: list[list[int]], noise: list[list[int]]
) -> None:
    box = worker(53)
    # near 16 I, as after preconditioning; each entry has width 1
    rows = [
        [box._dyadic(e + 16 * (i == j), e + 16 * (i == j) + 1, 0) for j, e in enumerate(row)]
        for i, row in enumerate(matrix)
    ]
    solution = module._eliminate([row[:3] for row in rows], [row[3] for row in rows])
    if solution is None:
        return
    member = [
        [Fraction(e + 16 * (i == j)) + Fraction(k + 4, 8) for j, (e, k) in enumerate(pairs)]
        for i, pairs in enumerate(
            [list(zip(r, s, strict=True)) for r, s in zip(matrix, noise, strict=True)]
        )
    ]
    exact_solution = solve([row[:3] for row in member], [row[3] for row in member])
    for value, enclosure in zip(exact_solution, solution, strict=True):
        low, high = ends(enclosure)
        assert low <= value <= high
        assert high - low < 2


def solve(matrix: list[list[Fraction]], right: list[Fraction]) -> list[Fraction]:
    """Cramer's rule for three unknowns."""

    def determinant(m: list[list[Fraction]]) -> Fraction:
        (a, b, c), (d, e, f), (g, h, i) = m
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    whole = determinant(matrix)
    return [
        determinant([[r if j == k else x for j, x in enumerate(row)] for row, r in rows]) / whole
        for k in range(3)
        for rows in [list(zip(matrix, right, strict=True))]
    ]


def test_elimination_refuses_a_pivot_with_zero() -> None:
    box = worker(53)
    one, wide = box._dyadic(1, 1, 0), box._dyadic(-1, 1, 0)
    assert module._eliminate([[wide]], [one]) is None
    assert module._eliminate([[one, one], [one, one]], [one, one]) is None
    assert module._eliminate([[box._dyadic(0, 1, 0)]], [one]) is None


def test_global_precision_is_neither_read_nor_changed() -> None:
    before = mpmath.iv.prec, mpmath.mp.prec
    expected = interval_newton(SQRT2, [[1.4]])
    assert (mpmath.iv.prec, mpmath.mp.prec) == before
    try:
        mpmath.iv.prec, mpmath.mp.prec = 7, 9
        assert interval_newton(SQRT2, [[1.4]]) == expected
        assert (mpmath.iv.prec, mpmath.mp.prec) == (7, 9)
    finally:
        mpmath.iv.prec, mpmath.mp.prec = before


def test_no_private_name_of_mpmath_is_used() -> None:
    """Its modules inside, `make_mpf`, and attributes that start with an underscore."""
    inside = r"mpmath\.(libmp|ctx_|matrices|calculus|functions|rational)|make_mp[fc]|\._mp[fci]+_"
    files = list(Path(exactfold.__file__).parent.rglob("*.py"))
    assert any("import mpmath" in path.read_text("utf-8") for path in files)
    for path in files:
        assert re.search(inside, path.read_text("utf-8")) is None, path


@pytest.mark.parametrize("precision", [53, 106, 212, 1696])
def test_boxes_are_as_narrow_as_the_precision_allows(precision: int) -> None:
    (box,) = interval_newton(SQRT2, [[1.414]], precisions=(precision,))
    assert isinstance(box, IsolatingBox)
    low, high = box.interval(0)
    assert low**2 < 2 < high**2
    assert high - low <= Fraction(64, 2**precision)


def test_zero_at_the_origin_and_exact_zeros() -> None:
    system = QuadraticSystem.from_rational([[[1, 0], [0, -4]]])
    (box,) = interval_newton(system, [[2]])
    assert isinstance(box, IsolatingBox)
    assert box.radius > 0
    origin = QuadraticSystem.from_rational([[[1, 2], [2, 0]]])
    for candidate in (0, 0.0, 1e-17, -1e-300):
        (box,) = interval_newton(origin, [[candidate]])
        assert isinstance(box, IsolatingBox)
        low, high = box.interval(0)
        assert low <= 0 <= high
        assert high - low < Fraction(1, 10**25)


def test_kinds_of_numbers() -> None:
    exact_root = Fraction(14142135623730951, 10**16)
    boxes = interval_newton(SQRT2, [[exact_root], [1.4142135623730951], [1.4142135623730951 + 0j]])
    assert all(isinstance(box, IsolatingBox) and box.is_real for box in boxes)
    assert not boxes[0].is_disjoint_from(boxes[1])  # type: ignore[union-attr, arg-type]
    (huge,) = interval_newton(SQRT2, [[Fraction(10) ** 400]])
    assert isinstance(huge, Uncertified)
    assert huge.point == (complex("inf"),)
    (huge,) = interval_newton(SQRT2, [[-(Fraction(10) ** 400)]])
    assert huge.point == (complex("-inf"),)  # type: ignore[union-attr]


def test_nearly_real_candidate_of_a_nonreal_zero() -> None:
    # zeros +- i 10^-10: the imaginary part is negligible to the heuristic, and the proof decides
    system = QuadraticSystem.from_rational([[[1, 0], [0, Fraction(1, 10**20)]]])
    (box,) = interval_newton(system, [[1e-10j]])
    assert isinstance(box, IsolatingBox)
    assert box.is_nonreal
    assert abs(Fraction(box.imag[0], 2**box.bits) - Fraction(1, 10**10)) < Fraction(1, 10**20)


def test_large_numbers_need_more_bits() -> None:
    big = 2**300 + 1
    system = QuadraticSystem.from_rational([[[1, 0], [0, -(big**2)]]])
    low, high = interval_newton(system, [[Fraction(big + 5)]], precisions=(53, 106, 424))[
        0
    ].interval(0)  # type: ignore[union-attr]
    assert low <= big <= high
    assert high - low < 1


@pytest.mark.parametrize(
    ("matrix", "point", "words"),
    [
        ([[1, 0], [0, 0]], 0.0, "singular"),
        ([[1, 0], [0, 0]], 1e-9, "singular"),
        ([[1, 0], [0, 1]], 0.3, "left the candidate"),
        ([[1, 0], [0, -2]], 3.0, "left the candidate"),
        ([[0, 0], [0, 1]], 1.0, "singular"),
        ([[1, 0], [0, 0]], 1e-3j, "at 1696 bits"),
    ],
)
def test_reasons_name_the_failing_test(matrix: list[list[int]], point: complex, words: str) -> None:
    (result,) = interval_newton(QuadraticSystem.from_rational([matrix]), [[point]])
    assert isinstance(result, Uncertified)
    assert words in result.reason


def test_precision_too_low_says_how_far_off() -> None:
    close = QuadraticSystem.from_rational([[[1, -1], [-1, 1 - Fraction(1, 10**30)]]])
    (result,) = interval_newton(close, [[1 + Fraction(1, 10**15)]], precisions=(53,))
    assert isinstance(result, Uncertified)
    assert "53 bits" in result.reason
    (box,) = interval_newton(close, [[1 + Fraction(1, 10**15)]], precisions=(53, 212))
    assert isinstance(box, IsolatingBox)
    (result,) = interval_newton(SQRT2, [[1.4]], precisions=())
    assert isinstance(result, Uncertified)
    assert "no precision" in result.reason


def test_wrong_number_of_coordinates() -> None:
    with pytest.raises(UsageError, match="2 coordinates, not 1"):
        interval_newton(SQRT2, [[1.0, 2.0]])
