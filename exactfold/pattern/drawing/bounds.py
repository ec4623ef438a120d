"""Refuses files and drawings that exceed the limits of `checker.core.limits`."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import isqrt, lcm, log2
from os import PathLike
from typing import TYPE_CHECKING, Any, Final

from exactfold.checker.core.limits import (
    LARGEST,
    LONG_COORDINATE,
    MOST_BYTES,
    MOST_COMMON,
    MOST_COMPARED,
    MOST_COORDINATE,
    MOST_LINES,
    MOST_PRODUCTS,
    SMALLEST,
)
from exactfold.errors import TooLargeError, UnreadableFileError

if TYPE_CHECKING:
    from exactfold.exact.surds import Number
    from exactfold.pattern.drawing.drawing import Drawing

_DIGITS_A_BIT: Final = 0.30103
_WORD: Final = 64
_FARTHEST: Final = int(LARGEST * log2(10))
_ROUND: Final = "round the coordinates"


def read_bytes(path: str | PathLike[str]) -> bytes:
    """The whole content of a file.

    Raises `UnreadableFileError`, and `TooLargeError` for more than 1 GiB.
    """
    try:
        with open(path, "rb") as stream:
            content = stream.read(MOST_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a null character in the path
        reason = getattr(error, "strerror", None) or str(error)
        raise UnreadableFileError(f"cannot read {path}: {reason}") from None
    if len(content) > MOST_BYTES:
        raise TooLargeError(f"{path} has more than {MOST_BYTES} bytes: larger files are not read")
    return content


def read_text(path: str | PathLike[str]) -> str:
    """The whole text of a UTF-8 file; raises the errors of `read_bytes`."""
    try:
        return read_bytes(path).decode("utf-8")
    except UnicodeDecodeError:
        raise UnreadableFileError(f"cannot read {path}: it is not UTF-8 text") from None


def check_coordinates(points: Iterable[Sequence[Number]]) -> None:
    """Raises `TooLargeError` for coordinates that take too long to compute with.

    A coordinate has at most 10,000 digits. A few coordinates may have that many, and many
    coordinates may have a few digits.

    >>> check_coordinates([(Fraction(1, 3), Fraction(10**12000))])
    Traceback (most recent call last):
    exactfold.errors.TooLargeError: vertex 0 has a coordinate of 12001 digits, but at most 10000 are
    read: round the coordinates
    """
    products = 0
    for vertex, point in enumerate(points):
        for part in (part for number in point for part in _parts(number)):
            if -_SHORT < part.numerator < _SHORT and part.denominator < _SHORT:
                continue
            above, below = _digits(part.numerator), _digits(part.denominator)
            longest = max(above, below)
            if longest > MOST_COORDINATE:
                raise TooLargeError(
                    f"vertex {vertex} has a coordinate of {longest} digits, but at most "
                    f"{MOST_COORDINATE} are read: {_ROUND}"
                )
            if longest > LONG_COORDINATE:
                products += above * below
    if products > MOST_PRODUCTS:
        raise TooLargeError(
            f"too many coordinates have more than {LONG_COORDINATE} digits: the products of the "
            f"digits of their numerators and denominators add up to {products}, but at most "
            f"{MOST_PRODUCTS} are read: {_ROUND}"
        )


def check_common_denominator(points: Iterable[Sequence[Fraction]]) -> None:
    """Raises `TooLargeError` for coordinates that are too long over one common denominator."""
    common, largest = 1, 0
    for number, part in enumerate((part for point in points for part in point), 1):
        largest = max(largest, part.numerator.bit_length() - part.denominator.bit_length() + 1)
        if common % part.denominator:
            common = lcm(common, part.denominator)
        bits = common.bit_length() + largest
        if number * (bits // _WORD + 1) ** 2 > MOST_COMMON:
            raise TooLargeError(
                f"over their common denominator, the first {number} coordinates have "
                f"{_digits(common)} digits each, but for so many coordinates at most "
                f"{isqrt(MOST_COMMON // number) * 19} digits are read: {_ROUND}"
            )


def check_drawing(drawing: Drawing) -> None:
    """Raises `TooLargeError` for a drawing with too many lines, or one that floats cannot hold.

    Floats are used to find which lines meet, so the size of a drawing must be from 1e-50 to 1e50.
    """
    if len(drawing.lines) > MOST_LINES:
        raise TooLargeError(
            f"the drawing has {len(drawing.lines)} lines, but at most {MOST_LINES} are read: leave "
            "out lines that are not creases, or give a part of the drawing"
        )
    check_coordinates(drawing.points)
    for vertex, point in enumerate(drawing.points):
        if any(
            part.numerator.bit_length() - part.denominator.bit_length() > _FARTHEST
            for number in point
            for part in _parts(number)
        ):
            raise TooLargeError(
                f"point {vertex} is farther than 1e{LARGEST} from the origin, and larger drawings "
                "are not read: scale the drawing down"
            )
    spots = {(float(x), float(y)) for x, y in drawing.points}
    size = max((max(column) - min(column) for column in zip(*spots, strict=True)), default=0.0)
    if size < 10.0**-SMALLEST and len(set(drawing.points)) > 1:
        raise TooLargeError(
            f"the drawing is smaller than 1e-{SMALLEST}, and smaller drawings are not read: scale "
            "the drawing up"
        )


def check_compared(boxes: Sequence[Sequence[Any]]) -> None:
    """Raises `TooLargeError` if too many of the sorted intervals (low, high, ...) overlap."""
    lows = [box[0] for box in boxes]
    pairs = sum(bisect_right(lows, box[1], k + 1) - k - 1 for k, box in enumerate(boxes))
    if pairs > MOST_COMPARED:
        raise TooLargeError(
            f"{pairs} pairs of edges have overlapping x-ranges, but at most {MOST_COMPARED} are "
            "compared: split the pattern into parts"
        )


_SHORT: Final = 1 << int((LONG_COORDINATE - 1) / _DIGITS_A_BIT)
"""Integers below this are no long coordinates."""


def _parts(number: Number) -> Sequence[Fraction]:
    return getattr(number, "coefficients", None) or (number,)  # type: ignore[return-value]


def _digits(number: int) -> int:
    """The number of decimal digits, correct up to one."""
    return int(number.bit_length() * _DIGITS_A_BIT) + 1
