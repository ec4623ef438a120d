"""Reading the exact numbers, lists and objects of a file, and refusing what is malformed."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from decimal import MAX_EMAX, MIN_EMIN, ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from typing import Any, NoReturn

from .limits import LONG_COORDINATE, MOST_COORDINATE, MOST_NUMBER, MOST_PRODUCTS

MALFORMED = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
"""The errors that the arithmetic raises on malformed values that no earlier test refused."""


class CertificateError(Exception):
    """A claim of the certificate is not supported by its evidence."""


class UnfinishedError(CertificateError):
    """The file ends before its claims, as after an interrupted run.

    What was checked holds, and the message says what was checked.
    """


class FormatError(Exception):
    """The file is not a certificate of a known format and version."""


class LimitError(FormatError):
    """The file asks for more than `limits` allows, so that nothing is known of its claims."""


def at_most(number: int, most: int, what: str, limit: str) -> None:
    """Raise `LimitError` if a number exceeds a limit; `what` says what the number counts.

    `limit` is the name of this limit in `limits`. Whoever wants to check such a file may raise the
    limit there.
    """
    if number > most:
        said = f"{what}, {number}, are more than the limit, {most}"
        raise LimitError(f"not checked: {said} ({limit} in checker/core/limits.py)")


def require(condition: object, message: str) -> None:
    """Raise `CertificateError` unless the condition holds."""
    if not condition:
        raise CertificateError(message)


@contextmanager
def refusing(where: str = "while checking") -> Iterator[None]:
    """Refuse a file as malformed if the arithmetic raises one of the errors of `MALFORMED`.

    Used as `with refusing():` or `@refusing()`. Raises `CertificateError` with the name of the
    error.
    """
    try:
        yield
    except MALFORMED as error:
        raise CertificateError(f"malformed: {type(error).__name__} {where}") from error


def plain(error: object) -> str:
    """A message as one line of printable ASCII, cut after 1000 characters.

    What the message quotes from a file may hold any characters; they are escaped.
    """
    return "".join(c if " " <= c <= "~" else ascii(c)[1:-1] for c in str(error)[:1000])[:1000]


def counted(number: int, one: str, many: str) -> str:
    """A number with its noun, in the singular or the plural."""
    return f"{number} {one if number == 1 else many}"


def parse_integer(text: str) -> int:
    """The integer with these decimal digits; raises `LimitError` beyond `MOST_NUMBER` digits."""
    sign, digits = (-1, text[1:]) if text[:1] == "-" else (1, text)
    if not (digits.isascii() and digits.isdigit()):
        raise CertificateError(f"{text[:40]!a} is not an integer")
    at_most(len(digits), MOST_NUMBER, f"the digits of {text[:40]!a}", "MOST_NUMBER")
    value = 0
    for start in range(0, len(digits), 4000):
        part = digits[start : start + 4000]
        value = value * 10 ** len(part) + int(part)
    return sign * value


def parse_rational(text: Any) -> Fraction:
    """The rational number that is written "p" or "p/q"."""
    require(isinstance(text, str), f"{text!a} is not a rational number in quotes")
    numerator, slash, denominator = text.partition("/")
    q = parse_integer(denominator) if slash else 1
    require(q > 0, f"{text[:40]!a} has no positive denominator")
    return Fraction(parse_integer(numerator), q)


class Coordinates:
    """Reads the coordinates of one sheet; limits how many of them may be long."""

    def __init__(self) -> None:
        self.products = 0

    def __call__(self, text: Any) -> Fraction:
        """The coordinate that is written "p" or "p/q"; raises `LimitError`."""
        above, below = (len(part) for part in text_of(text).partition("/")[::2])
        longer = max(above, below)
        at_most(longer, MOST_COORDINATE, "the digits of a coordinate", "MOST_COORDINATE")
        if max(above, below) > LONG_COORDINATE:
            self.products += above * max(below, 1)
            what = "the products of digits in long coordinates"
            at_most(self.products, MOST_PRODUCTS, what, "MOST_PRODUCTS")
        return parse_rational(text)


def read_json(text: str) -> Any:
    """Read a JSON value; raises `FormatError` for floats, repeated keys and too long integers."""

    def refuse(number: str) -> NoReturn:
        raise FormatError(f"a certificate holds no floats, but here is {number[:40]}")

    def integer(number: str) -> int:
        if len(number) > 4000:  # certificates write longer integers as text; Python prints none
            raise FormatError(f"an integer is too long: {number[:40]}...")
        return int(number)

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        keys = [key for key, _ in pairs]
        if len(set(keys)) != len(keys):
            raise FormatError("a key appears twice in one object")
        return dict(pairs)

    try:
        return json.loads(
            text,
            parse_float=refuse,
            parse_constant=refuse,
            parse_int=integer,
            object_pairs_hook=unique,
        )
    except (ValueError, RecursionError) as error:
        raise FormatError(f"not JSON, or cut off: {error}") from None


def keys(value: Any, names: str, what: str, error: type[Exception] = CertificateError) -> None:
    """Raise unless `value` is an object with exactly these keys."""
    if not isinstance(value, dict) or sorted(value) != sorted(names.split()):
        raise error(f"{what}: expected an object with the keys {names}")


def keys_of(form: type) -> str:
    """The keys of a typed dictionary, in the form in which `keys` takes them."""
    return " ".join(form.__annotations__)


def items(value: Any, what: str, length: int | None = None) -> list[Any]:
    """Return `value` if it is a list, and has `length` entries if a length is given."""
    require(isinstance(value, list), f"{what} is not a list")
    require(length is None or len(value) == length, f"{what} does not have {length} entries")
    return list(value)


def natural(value: Any, what: str) -> int:
    """Return `value` if it is an integer >= 0."""
    if type(value) is not int or value < 0:
        raise CertificateError(f"{what} is not a natural number")
    return value


def integer(value: Any) -> int:
    """Return `value` if it is an integer."""
    if type(value) is not int:
        raise CertificateError(f"{value!a} is not an integer")
    return value


def same(claim: Any, fact: Any) -> bool:
    """Whether a claim equals a fact, with the same types: `true` does not stand for 1."""
    if isinstance(fact, dict):
        return (
            isinstance(claim, dict)
            and claim.keys() == fact.keys()
            and all(same(claim[key], fact[key]) for key in fact)
        )
    if isinstance(fact, list):
        return isinstance(claim, list) and len(claim) == len(fact) and all(map(same, claim, fact))
    return type(claim) is type(fact) and bool(claim == fact)


def text_of(value: Any) -> str:
    """Return `value` if it is a string."""
    if not isinstance(value, str):
        raise CertificateError(f"{value!a} is not a number in quotes")
    return value


def digits(n: int) -> str:
    """The decimal digits of an integer of any length."""
    if n < 0:
        return "-" + digits(-n)
    if n.bit_length() < 13000:  # fewer than 4000 digits, which Python prints
        return str(n)
    half = n.bit_length() * 3 // 20
    high, low = divmod(n, 10**half)
    return digits(high) + digits(low).rjust(half, "0")


def shown(text: str, *, up: bool = False) -> str:
    """A rational number in six digits, rounded down as a lower bound, or up as an upper bound."""
    return rounded(parse_rational(text), 6, up=up)


def rounded(value: Fraction, places: int, *, up: bool) -> str:
    """A number in `places` digits, rounded down or up; it may be too large for a float."""
    context = Context(places, ROUND_CEILING if up else ROUND_FLOOR, MIN_EMIN, MAX_EMAX)
    quotient = context.divide(Decimal(value.numerator), Decimal(value.denominator))
    short = context.normalize(quotient)
    return f"{short:f}" if -5 < short.adjusted() < places else f"{short:e}"
