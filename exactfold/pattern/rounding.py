"""How far the coordinates of a drawing may have been rounded."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import gcd, inf, lcm
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from exactfold.exact.surds import Number

_WHOLE: Final = 512
"""Whole numbers of so many steps across the sheet count as exact, not as rounded."""
_TENTHS: Final = 64
"""So do other decimals of so many steps."""
_ZERO: Final = 1e-9
"""Coordinates below this share of the size are noise about zero."""


def size_of(points: Sequence[Sequence[Number]]) -> float:
    """The larger side of the rectangle round some points, however far from the origin.

    It is 0 or infinite if floats do not hold it.

    >>> size_of([(10**30, 0), (10**30 + 2, 1)])
    2.0
    """
    x, y = points[0]
    try:
        sides = [*zip(*((float(p[0] - x), float(p[1] - y)) for p in points), strict=True)]
    except OverflowError:
        return inf
    return float(max(max(side) - min(side) for side in sides))


def _ordinary(points: Sequence[Sequence[Number]]) -> Sequence[Sequence[Number]]:
    """The points, divided by a power of ten if their size is beyond that of floats."""
    if 0 < size_of(points) < inf:
        return points
    sizes = [abs(Fraction(c)) for p in points for c in p if isinstance(c, int | Fraction) and c]
    if not sizes:
        return points
    largest = max(sizes)
    digits = (largest.numerator.bit_length() - largest.denominator.bit_length()) * 3 // 10
    unit = Fraction(10) ** digits
    return [[c / unit for c in point] for point in points]


def half_step(points: Sequence[Sequence[Number]]) -> float:
    """By so much of the size decimals may have been rounded; 0 if they count as exact.

    This is half of the largest step of which all are multiples. Numbers without a finite decimal
    were recognised or given exactly, and are left out.

    >>> half_step([(0, 0), (100, 0), (200, 0), (301, 100)])
    0.0
    >>> half_step([(0, 0), (Fraction("0.143"), 0), (1, 0), (1, 1)])
    0.0005
    >>> half_step([(0, 0), (Fraction("143e-403"), 0), (Fraction("1e-400"), 0)])
    0.0005
    """
    points = _ordinary(points)
    size = size_of(points)
    known = [_decimal(c) for point in points for c in point]
    decimals = [x for x in known if x is not None and abs(x) > _ZERO * size]
    if not decimals:
        return 0.0
    below = lcm(*(x.denominator for x in decimals))
    step = Fraction(gcd(*(int(x * below) for x in decimals)), below)
    steps = size / float(step)
    return 0.0 if steps <= (_WHOLE if below == 1 else _TENTHS) else 0.5 / steps


def usual_half_step(points: Sequence[Sequence[Number]]) -> float:
    """`half_step` of the number of decimals that most coordinates have at most.

    Points at the strips of opened slits have many more decimals than those of the drawing.

    >>> usual_half_step([(0, 0), (Fraction("0.143"), 0), (1, Fraction(1, 2**20)), (1, 1)])
    0.0
    >>> round(usual_half_step([(Fraction("0.143"), 0), (Fraction("0.857"), Fraction("0.7"))]), 4)
    0.0007
    """
    points = _ordinary(points)
    size = size_of(points)
    known = [_decimal(c) for point in points for c in point]
    numbers = sorted(_places(x) for x in known if x is not None)
    if not numbers:
        return 0.0
    places = numbers[len(numbers) // 2]
    steps = size * 10**places
    return 0.0 if steps <= (_TENTHS if places else _WHOLE) else 0.5 / steps


def _places(number: Fraction) -> int:
    """The number of decimals of a fraction that has finitely many."""
    return next(
        k for k in range(number.denominator.bit_length()) if 10**k % number.denominator == 0
    )


def _decimal(number: Number) -> Fraction | None:
    """A number as a fraction, if it is a finite decimal."""
    if not isinstance(number, int | Fraction):
        from exactfold.exact.surds import Surd, simple  # here because it loads FLINT

        number = simple(number)
        if isinstance(number, Surd):
            return None
    found = Fraction(number)
    twos = (found.denominator & -found.denominator).bit_length() - 1
    rest = found.denominator >> twos
    return None if pow(5, rest.bit_length(), rest) else found
