"""The parameter x of a motion of panels: it determines the time and the angles of the drivers.

If all drivers have the same angle, the tangent of half this angle is x / (1 - x). If the drivers
move at rates of their own, x is a quarter of the time, and half an angle is 2 x times the rate.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any, Protocol

from ...core.intervals import Interval
from ...core.reading import items, parse_rational, require
from ...sheets.panels import Edge
from .series import BITS, ONE, TERMS, Series

_HALVINGS = 4
_TERMS = 12
_POWERS = 40
_POINT = Interval(ONE, ONE, BITS)


class Clock(Protocol):
    """The time and the angles of the drivers at a parameter x; at `last` the time is below pi."""

    last: Fraction

    def time(self, x: Fraction) -> tuple[Fraction, Fraction]:
        """A lower and an upper bound of the time."""

    def closes(self, driver: Edge) -> bool:
        """Whether the driver is closed at the time pi."""

    def driven(self, x: Interval, driver: Edge) -> tuple[Series, Series]:
        """A pair (C, S) with S / C = tan(angle / 2) for a driver, as series about x."""


class OneRate:
    """All drivers have the angle t, with tan(t / 2) = x / (1 - x)."""

    last = Fraction(1)

    def time(self, x: Fraction) -> tuple[Fraction, Fraction]:
        """A lower and an upper bound of 2 arctan(x / (1 - x))."""
        return time_of(x)

    def closes(self, driver: Edge) -> bool:
        """All drivers are closed at the time pi."""
        return True

    def driven(self, x: Interval, driver: Edge) -> tuple[Series, Series]:
        """The pair (1 - x, x)."""
        return Series([_POINT - x, -_POINT]), Series([x, _POINT])


class Rates:
    """At the time t = 4 x each driver has the angle t times its rate; the largest rate is 1."""

    def __init__(self, drivers: list[Any], given: Any) -> None:
        values = [parse_rational(rate) for rate in items(given, "rates", len(drivers))]
        right = values and min(values) > 0 and max(values) == 1
        require(right, "a rate is not positive, or the largest rate is not 1")
        self.rates: Mapping[Edge, Fraction] = {
            (i, j): rate for (i, j), rate in zip(drivers, values, strict=True)
        }
        self.last = time_of(Fraction(1))[0] / 4

    def time(self, x: Fraction) -> tuple[Fraction, Fraction]:
        """The time 4 x, as both bounds."""
        return 4 * x, 4 * x

    def closes(self, driver: Edge) -> bool:
        """The drivers of rate 1 are closed at the time pi."""
        return self.rates[driver] == 1

    def driven(self, x: Interval, driver: Edge) -> tuple[Series, Series]:
        """The cosine and sine of half the angle; coefficient k is the k-th derivative over k!."""
        rate = Interval.of(2 * self.rates[driver], BITS)
        c, s = cosine_and_sine(rate * x)
        power = _POINT
        cosines, sines = [], []
        for k in range(TERMS):
            cosines.append((c, -s, -c, s)[k % 4] * power)
            sines.append((s, c, -s, -c)[k % 4] * power)
            power = power * rate * Interval.of(Fraction(1, k + 1), BITS)
        return Series(cosines), Series(sines)


def time_of(x: Fraction) -> tuple[Fraction, Fraction]:
    """Bounds of the angle 2 arctan(x / (1 - x)) = pi / 2 + 2 arctan(2 x - 1)."""
    half = arctan(_POINT) + arctan(Interval.of(2 * x - 1, BITS))
    total = half + half
    return Fraction(max(total.low, 0), 1 << BITS), Fraction(total.high, 1 << BITS)


def arctan(z: Interval) -> Interval:
    """The arc tangent of a number of size at most 1.

    The identity arctan z = 2 arctan(z / (1 + sqrt(1 + z^2))) is used four times, and then the
    series. The remainder of the series is at most the first term left out.
    """
    for _ in range(_HALVINGS):
        z = z / (_POINT + (_POINT + z * z).root())
    total, power = Interval.of(Fraction(0), BITS), z
    for k in range(_TERMS):
        term = power * Interval.of(Fraction((-1) ** k, 2 * k + 1), BITS)
        total = total + term
        power = power * z * z
    return Interval((total.low - 1) << _HALVINGS, (total.high + 1) << _HALVINGS, BITS)


def cosine_and_sine(angle: Interval) -> tuple[Interval, Interval]:
    """The cosine and the sine of an angle of size at most 2, by their series.

    The remainder of each series is less than 2^41 / 40!.
    """
    sums = [Interval(-1, 1, BITS), Interval(-1, 1, BITS)]
    term = _POINT
    for n in range(_POWERS):
        sums[n % 2] = sums[n % 2] + (term if n % 4 < 2 else -term)
        term = term * angle * Interval.of(Fraction(1, n + 1), BITS)
    return sums[0], sums[1]
