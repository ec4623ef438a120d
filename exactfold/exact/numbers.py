"""Exact reading and writing of numbers: int, Fraction, Decimal, "p/q" and decimal text.

All numbers enter exactfold here. Floats are refused.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from fractions import Fraction
from math import inf, lcm
from numbers import Rational
from typing import TypeAlias

from exactfold.checker.core.limits import MOST_EXPONENT, MOST_NUMBER
from exactfold.errors import FloatRefusedError, NumberError, UsageError

RationalLike: TypeAlias = "int | Fraction | Decimal | str"

_INTEGER = re.compile(r"[+-]?[0-9]+\Z")
_QUOTIENT = re.compile(r"([+-]?[0-9]+)/([0-9]+)\Z")
_DECIMAL = re.compile(r"([+-]?)([0-9]*)(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]+))?\Z")
_MOST_DIGITS = 4000  # the most digits that are left to `int` and `str`


def long_integer(text: str) -> int:
    """The integer that decimal digits of any length denote; `int` alone refuses above 4300."""
    if len(text) <= _MOST_DIGITS:
        return int(text)
    from flint import fmpz  # here, as loading it takes longer than reading a pattern

    return int(fmpz(text.lstrip("+")))


def _int(text: str) -> int:
    """Reads like `long_integer`, but refuses more digits than a file may ask for.

    Raises `NumberError` for them.
    """
    if (digits := len(text.lstrip("+-"))) > MOST_NUMBER:
        raise NumberError(
            f"{shown(text)} has {digits} digits, but at most {MOST_NUMBER} digits are read: "
            "round the number"
        )
    return long_integer(text)


def parse_rational(text: str) -> Fraction:
    """The exact value of "p", "p/q" or decimal text such as "-1.25e-3".

    Raises `NumberError` for any other text, such as "NaN", "Infinity" and a zero denominator,
    and for numbers that are longer than the limits of `exactfold.checker.core.limits`.

    >>> parse_rational("0.1")
    Fraction(1, 10)
    >>> parse_rational("-3/6")
    Fraction(-1, 2)
    >>> parse_rational("inf")
    Traceback (most recent call last):
    exactfold.errors.NumberError: 'inf' is not a number: write an integer, "p/q" or a decimal
    """
    text = text.strip()
    if _INTEGER.match(text):
        return Fraction(_int(text))
    if quotient := _QUOTIENT.match(text):
        denominator = _int(quotient[2])
        if denominator == 0:
            raise NumberError(f"{shown(text)} has a zero denominator")
        return Fraction(_int(quotient[1]), denominator)
    decimal = _DECIMAL.match(text)
    if decimal and (decimal[2] or decimal[3]):
        sign, whole, part, power = decimal[1], decimal[2], decimal[3] or "", _int(decimal[4] or "0")
        if abs(power) > MOST_EXPONENT:
            raise NumberError(
                f"the exponent of {shown(text)} exceeds {MOST_EXPONENT} in size: "
                "rescale the coordinates"
            )
        digits = _int(f"{sign}{whole}{part}")
        power -= len(part)
        return Fraction(digits * 10**power) if power >= 0 else Fraction(digits, 10**-power)
    raise NumberError(f'{shown(text)} is not a number: write an integer, "p/q" or a decimal')


def parse_whole(text: str) -> int:
    """Reads a whole number of at most 4000 decimal digits, such as "-12".

    Raises `NumberError` for any other text, also for "1_0", which `int` would read as 10.

    >>> parse_whole(" -12 ")
    -12
    >>> parse_whole("1_0")
    Traceback (most recent call last):
    exactfold.errors.NumberError: '1_0' is not a whole number
    """
    digits = text.strip()
    if not _INTEGER.match(digits) or len(digits) > _MOST_DIGITS:
        raise NumberError(f"{shown(text)} is not a whole number")
    return int(digits)


def approx_number(text: str) -> float:
    """The float nearest to the number that `parse_rational` reads; infinite if no float is near.

    Raises `NumberError` for the same texts as `parse_rational`, such as "nan" and "1_0".

    >>> approx_number("0.1"), approx_number("-1e400")
    (0.1, -inf)
    """
    value = parse_rational(text)
    try:
        return float(value)
    except OverflowError:
        return inf if value > 0 else -inf


def shown(value: object) -> str:
    """`value` as it appears in an error message: its repr, cut to 40 characters.

    >>> shown("12"), shown(10**5000)
    ("'12'", 'an integer of 16610 bits')
    """
    if isinstance(value, str):
        return repr(value if len(value) <= 40 else value[:37] + "...")
    try:
        text = repr(value)
    except (ValueError, RecursionError):  # too many digits for repr, or too deeply nested
        if isinstance(value, int):
            return f"an integer of {value.bit_length()} bits"
        return f"a {type(value).__name__}"
    return text if len(text) <= 40 else text[:37] + "..."


def as_rational(value: object) -> Fraction:
    """The Fraction equal to `value`: an int, Fraction, `numbers.Rational`, Decimal, or text.

    Raises `FloatRefusedError` for floats, as their binary value is rarely what was meant, and
    `NumberError` for booleans, non-finite numbers and all other objects.

    >>> as_rational("0.25"), as_rational(3)
    (Fraction(1, 4), Fraction(3, 1))
    >>> as_rational(0.1)
    Traceback (most recent call last):
    exactfold.errors.FloatRefusedError: the float 0.1 is not exact: write "0.1" or Fraction(1, 10)
    """
    if isinstance(value, Fraction):
        return value
    if isinstance(value, bool):
        raise NumberError(f"{value!r} is a truth value, not a number")
    if isinstance(value, Rational):
        return Fraction(int(value.numerator), int(value.denominator))
    if isinstance(value, str):
        return parse_rational(value)
    if isinstance(value, Decimal):
        if not value.is_finite():
            raise NumberError(f"{value} is not a finite number")
        return parse_rational(str(value))
    if isinstance(value, float) or (type(value).__module__ == "numpy" and hasattr(value, "dtype")):
        raise _float_refused(value)
    raise NumberError(f"{shown(value)} is not a rational number")


def _float_refused(value: object) -> FloatRefusedError:
    try:
        near = Fraction(str(value))
    except ValueError:
        return FloatRefusedError(f"the float {value} is not a finite number")
    return FloatRefusedError(
        f'the float {value} is not exact: write "{value}" or '
        f"Fraction({near.numerator}, {near.denominator})"
    )


def snap(value: Fraction, denominator: int) -> Fraction:
    """The multiple of 1/denominator nearest to `value` (ties to even).

    Raises `UsageError` unless `denominator` is a positive integer.

    >>> snap(Fraction("0.24999999999999994"), 1024)
    Fraction(1, 4)
    """
    if isinstance(denominator, bool) or not isinstance(denominator, int) or denominator < 1:
        raise UsageError(
            f"numbers snap to multiples of 1/n for an integer n >= 1, not for n = {denominator!r}"
        )
    return Fraction(round(value * denominator), denominator)


def format_integer(value: int) -> str:
    """The decimal text of an integer of any length."""
    if value.bit_length() <= 13_000:
        return str(value)
    from flint import fmpz  # here, as in `long_integer`

    return str(fmpz(value))


def format_rational(value: Fraction) -> str:
    """The canonical text of a rational number: "p", or "p/q" in lowest terms with q > 1.

    >>> format_rational(Fraction(2, 4)), format_rational(Fraction(3))
    ('1/2', '3')
    """
    numerator = format_integer(value.numerator)
    if value.denominator == 1:
        return numerator
    return f"{numerator}/{format_integer(value.denominator)}"


def decimal_above(value: Fraction, digits: int) -> str:
    """The least decimal number with `digits` significant digits that is at least `value` >= 0.

    >>> decimal_above(Fraction(1, 3), 1), decimal_above(Fraction(1, 3 * 10**400), 2)
    ('0.4', '3.4e-401')
    """
    return _decimal(value, Context(digits, ROUND_CEILING))


def decimal_below(value: Fraction, digits: int) -> str:
    """The largest decimal number with `digits` significant digits that is at most `value`.

    >>> decimal_below(Fraction(2, 3), 1), decimal_below(Fraction(-2, 3), 1)
    ('0.6', '-0.7')
    """
    return _decimal(value, Context(digits, ROUND_FLOOR))


def outward(low: float, high: float) -> tuple[str, str]:
    """Two bounds in decimals, rounded outwards: eight digits, or so many that they differ.

    >>> outward(2.2142974355, 2.2142974365)
    ('2.214297435', '2.214297437')
    >>> outward(2 / 3, 0.75)
    ('0.66666666', '0.75')
    """
    digits = next((n for n in range(8, 17) if f"{low:.{n}g}" != f"{high:.{n}g}"), 16)
    return decimal_below(Fraction(low), digits), decimal_above(Fraction(high), digits)


def decimal_near(value: Fraction, digits: int) -> str:
    """The nearest decimal number with `digits` significant digits.

    >>> decimal_near(Fraction(1, 3), 4), decimal_near(Fraction(1919999, 3), 4)
    ('0.3333', '640000')
    >>> decimal_near(Fraction(10**40, 3), 4)
    '3.333e+39'
    """
    text = _decimal(value, Context(digits, ROUND_HALF_EVEN))
    return f"{Decimal(text):f}" if 10**-6 < abs(value) < 10**12 else text


def _decimal(value: Fraction, rounding: Context) -> str:
    quotient = rounding.divide(Decimal(value.numerator), Decimal(value.denominator))
    return f"{quotient.normalize(rounding):g}"


def over_common_denominator(values: Iterable[Fraction | int]) -> tuple[list[int], int]:
    """Integers n_i and the least d > 0 with values_i = n_i / d.

    >>> over_common_denominator([Fraction(1, 2), Fraction(1, 3)])
    ([3, 2], 6)
    """
    values = list(values)
    denominator = lcm(*(value.denominator for value in values))
    return [value.numerator * (denominator // value.denominator) for value in values], denominator


def integer_row(row: Sequence[Fraction]) -> tuple[int, ...]:
    """A positive multiple of a rational row, with integer entries; the signs stay the same.

    >>> integer_row([Fraction(1, 2), Fraction(-1, 3)])
    (3, -2)
    """
    return tuple(over_common_denominator(row)[0])
