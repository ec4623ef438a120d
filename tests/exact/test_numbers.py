import re
from decimal import Decimal
from fractions import Fraction
from math import gcd, inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.errors import (
    FloatRefusedError,
    InputError,
    NumberError,
    UsageError,
)
from exactfold.exact.numbers import (
    approx_number,
    as_rational,
    format_integer,
    format_rational,
    over_common_denominator,
    parse_rational,
    parse_whole,
    shown,
    snap,
)

quick = settings(max_examples=100, deadline=None)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", 0),
        ("-17", -17),
        ("+17", 17),
        ("007", 7),
        (" 3/4 ", Fraction(3, 4)),
        ("-6/4", Fraction(-3, 2)),
        ("+1/3", Fraction(1, 3)),
        ("0.1", Fraction(1, 10)),
        ("-.5", Fraction(-1, 2)),
        ("5.", 5),
        ("1e3", 1000),
        ("-1.25E-2", Fraction(-1, 80)),
        ("+2.50e+1", 25),
        ("0.24999999999999994", Fraction(24999999999999994, 10**17)),
        ("-0.0", 0),
    ],
)
def test_parse_rational(text, value):
    assert parse_rational(text) == value


@pytest.mark.parametrize(
    "text",
    [
        "",
        " ",
        ".",
        "-",
        "e5",
        "1e",
        "1.2.3",
        "1/2/3",
        "1/-2",
        "1.5/2",
        "1 2",
        "1_000",
        "0x10",
        "nan",
        "NaN",
        "inf",
        "-Infinity",
        "one",
        "٣",
        "1/0",
        "0/0",
        "1e999999",
        "1e9999999",
        "--1",
        "1,5",
    ],
)
def test_parse_rational_error(text):
    with pytest.raises(NumberError, match=re.escape(repr(text.strip()))):
        parse_rational(text)


def test_whole_numbers_are_decimal_digits():
    assert [parse_whole(text) for text in ("12", " -3\n", "+007")] == [12, -3, 7]
    assert parse_whole("9" * 4000) == 10**4000 - 1
    for text in ("", "-", "1_0", "1.0", "1e1", "3/1", "0x10", "\u0663", "1 2", "9" * 4001):
        with pytest.raises(NumberError, match="is not a whole number"):
            parse_whole(text)


def test_floats_are_read_exactly_and_then_rounded():
    texts = ("0.1", "-1e-400", "7e22", "1/3", "2.5e-324", " 90 ")
    assert [approx_number(text) for text in texts] == [0.1, -0.0, 7e22, 1 / 3, 5e-324, 90.0]
    assert (approx_number("2e308"), approx_number("-1e400")) == (inf, -inf)
    for text in ("1_0", "nan", "inf", "0x10", "\u0663"):
        with pytest.raises(NumberError, match="is not a number"):
            approx_number(text)


def test_error_messages_are_short():
    with pytest.raises(NumberError, match="is not a number") as caught:
        parse_rational("x" * 10_000)
    assert len(str(caught.value)) < 200


@quick
@given(st.fractions())
def test_text_round_trip(value):
    assert parse_rational(format_rational(value)) == value


@quick
@given(st.decimals(allow_nan=False, allow_infinity=False))
def test_decimals_are_exact(value):
    exponent = value.as_tuple().exponent
    if abs(exponent) < 1000:
        assert as_rational(value) == Fraction(value) == parse_rational(str(value))


@quick
@given(st.floats(allow_nan=False, allow_infinity=False))
def test_decimal_text_of_a_float_is_read_as_written(value):
    assert parse_rational(repr(value)) == Fraction(Decimal(repr(value)))


@pytest.mark.parametrize("digits", [4000, 4001, 4300, 4301, 50_000])
@pytest.mark.parametrize("sign", ["", "-", "+"])
def test_integers_beyond_the_text_limit_of_python(digits, sign):
    value = (-1 if sign == "-" else 1) * (10**digits // 7)
    text = format_integer(abs(value))
    assert len(text) == digits
    assert parse_rational(sign + text) == value
    assert parse_rational(f"{sign}{text}/{text}") == (-1 if sign == "-" else 1)
    assert parse_rational(f"{sign}{text}.5") == value + Fraction(value, 2 * abs(value))
    quotient = Fraction(value, 10**digits)
    assert parse_rational(format_rational(quotient)) == quotient


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        (3, 3),
        (Fraction(1, 3), Fraction(1, 3)),
        (Decimal("1.10"), Fraction(11, 10)),
        ("2/6", Fraction(1, 3)),
        (np.int64(-5), -5),
        (np.uint8(200), 200),
    ],
)
def test_as_rational(value, expected):
    result = as_rational(value)
    assert result == expected
    assert type(result) is Fraction
    assert type(result.numerator) is int


@pytest.mark.parametrize(
    "value", [0.1, 1.0, float("nan"), float("inf"), np.float64(0.5), np.float32(0.5)]
)
def test_float_refused_error(value):
    with pytest.raises(FloatRefusedError, match="the float"):
        as_rational(value)


def test_float_refused_error_says_what_to_write():
    with pytest.raises(FloatRefusedError, match=r'write "0\.1" or Fraction\(1, 10\)'):
        as_rational(0.1)
    with pytest.raises(TypeError):  # it is a TypeError too, as Python would raise
        as_rational(0.1)


@pytest.mark.parametrize(
    "value",
    [
        True,
        False,
        None,
        1j,
        [1],
        (1, 2),
        object(),
        b"1",
        Decimal("NaN"),
        Decimal("-Infinity"),
        Decimal("1e999999"),
    ],
)
def test_not_a_number_error(value):
    with pytest.raises(NumberError) as caught:
        as_rational(value)
    assert type(caught.value) is NumberError
    assert isinstance(caught.value, InputError)


def test_a_truth_value_of_numpy_is_refused_as_a_float():
    with pytest.raises(FloatRefusedError, match="the float True is not a finite number"):
        as_rational(np.bool_(True))


@quick
@given(st.fractions(), st.integers(1, 10**6))
def test_snap(value, denominator):
    snapped = snap(value, denominator)
    assert denominator % snapped.denominator == 0
    assert abs(snapped - value) <= Fraction(1, 2 * denominator)
    assert snap(snapped, denominator) == snapped
    assert snap(-value, denominator) == -snapped


def test_snap_ties_go_to_even():
    assert [snap(Fraction(k, 2), 1) for k in (-3, -1, 1, 3, 5)] == [-2, 0, 0, 2, 2]


@pytest.mark.parametrize("denominator", [0, -1, 1.0, True, "8", None])
def test_snap_usage_error(denominator):
    with pytest.raises(UsageError):
        snap(Fraction(1, 3), denominator)


@quick
@given(st.lists(st.fractions(), min_size=1))
@pytest.mark.slow
def test_over_common_denominator(values):
    integers, denominator = over_common_denominator(values)
    assert [Fraction(n, denominator) for n in integers] == values
    assert gcd(denominator, *integers) == 1  # the least common denominator
    assert denominator > 0


def test_over_common_denominator_of_nothing():
    assert over_common_denominator([]) == ([], 1)


def test_shown():
    assert shown("x" * 50) == repr("x" * 37 + "...")
    assert len(shown(list(range(1000)))) == 40
    assert shown(10**5000).startswith("an integer of 16610 bits")
    assert shown([10**5000]) == "a list"
    assert shown(Fraction(1, 3)) == "Fraction(1, 3)"
