"""Intervals and towers of square roots in the checker, against values known otherwise."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import product
from math import isqrt

import pytest

from exactfold.checker.core.intervals import Interval
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.core.towers import Number, Tower

# --- intervals -----------------------------------------------------------------------------------


def ends(found: Interval) -> tuple[int, int]:
    return found.low, found.high


def test_intervals_of_rational_numbers_are_the_smallest() -> None:
    for value, low, high in ((1, 16, 16), (Fraction(1, 3), 5, 6), (Fraction(-1, 3), -6, -5)):
        found = Interval.of(Fraction(value), 4)
        assert (*ends(found), found.bits) == (low, high, 4)


def test_arithmetic_of_intervals() -> None:
    """All with ends over 4: the exact ends, rounded outwards."""
    some = [Interval(low, high, 2) for low, high in ((3, 5), (-7, 2), (-9, -6), (1, 1), (0, 3))]
    for a, b in product(some, repeat=2):
        assert ends(a + b) == (a.low + b.low, a.high + b.high)
        assert ends(a - b) == (a.low - b.high, a.high - b.low)
        corners = [Fraction(x * y, 4) for x in ends(a) for y in ends(b)]
        assert ends(a * b) == (min(corners).__floor__(), max(corners).__ceil__())
        if b.sign():
            over = [Fraction(16, y) for y in ends(b)]
            inverse = Interval(min(over).__floor__(), max(over).__ceil__(), 2)
            assert ends(a / b) == ends(a * inverse)
            assert (a / b).bits == 2


@pytest.mark.parametrize(("low", "high"), [(-1, 2), (0, 3), (-3, 0), (0, 0)])
def test_nothing_is_divided_by_what_may_be_0(low: int, high: int) -> None:
    assert Interval(low, high, 2).sign() == 0
    with pytest.raises(ZeroDivisionError, match="the divisor is an interval that may hold 0"):
        Interval(4, 4, 2) / Interval(low, high, 2)


def test_roots_and_signs_of_intervals() -> None:
    for low, high, bits, root in (
        (4, 9, 0, (2, 4)),
        (8, 8, 2, (5, 6)),
        (-5, 4, 0, (0, 3)),
        (-5, -1, 0, (0, 1)),
        (1, 1, 4, (4, 5)),
    ):
        found = Interval(low, high, bits).root()
        assert (*ends(found), found.bits) == (*root, bits)
    for low, high, sign in ((1, 3, 1), (0, 3, 0), (-3, -1, -1), (-3, 0, 0), (-3, 3, 0), (1, 1, 1)):
        assert Interval(low, high, 5).sign() == sign


# --- towers --------------------------------------------------------------------------------------

TWO = Tower().adjoined(Tower().number(2))[0]
ROOT = TWO.adjoined(TWO.number(2))[1]
THREE = TWO.adjoined(TWO.number(3))[0]
NESTED = TWO.adjoined(TWO.number(2) + ROOT)[0]
DEEP = NESTED.adjoined(NESTED.number(7) - NESTED.number(ROOT))[0]
TOWERS = {"2": TWO, "2, 3": THREE, "2, 2 + 2^(1/2)": NESTED, "three": DEEP}
BITS = 700


def value(number: Number) -> Fraction:
    """The number to some 600 binary places, by roots of rational numbers."""
    basis = [Fraction(1)]
    for radicand in number.tower.radicands:
        under = sum((c * b for c, b in zip(radicand, basis, strict=True)), Fraction(0))
        root = Fraction(isqrt(int(under * (1 << 2 * BITS))), 1 << BITS)
        basis += [root * b for b in basis]
    return sum((c * b for c, b in zip(number.parts, basis, strict=True)), Fraction(0))


def near(a: Fraction, b: Fraction) -> bool:
    return abs(a - b) * (1 << 600) < 1 + abs(a) + abs(b)


def drawn(tower: Tower, rng: random.Random) -> Number:
    """A number of the tower, some of whose coefficients are 0."""
    parts = [Fraction(rng.randint(-5, 5), rng.randint(1, 4)) for _ in range(tower.size)]
    return Number(tower, tuple(c * rng.randint(0, 1) for c in parts))


@pytest.mark.parametrize("name", TOWERS)
def test_arithmetic_of_numbers(name: str) -> None:
    tower, rng = TOWERS[name], random.Random(1)
    for _ in range(30):
        a, b = drawn(tower, rng), drawn(tower, rng)
        assert near(value(a + b), value(a) + value(b))
        assert near(value(a - b), value(a) - value(b))
        assert near(value(a * b), value(a) * value(b))
        assert near(value(-a), -value(a))
        assert a.sign() == (value(a) > 0) - (value(a) < 0)
        if b.sign():
            assert near(value(a / b), value(a) / value(b))
        found = a.enclosed(200)
        assert found.low <= value(a) * 2**200 <= found.high < found.low + (1 << 20)


def test_numbers_of_two_levels() -> None:
    low, high = ROOT, NESTED.adjoined(NESTED.number(ROOT) + NESTED.number(2))[1]
    for a, b in ((low, high), (high, low)):
        assert near(value(a * b), value(a) * value(b))
        assert near(value(a - b), value(a) - value(b))
        assert (a + b).tower is NESTED


@pytest.mark.parametrize("name", TOWERS)
def test_signs_of_numbers_next_to_0(name: str) -> None:
    """(2^(1/2) - 1)^n is less than any number that an enclosure of 128 places tells from 0."""
    tower = TOWERS[name]
    small = tower.number(1)
    for _ in range(160):
        small = small * (tower.number(ROOT) - tower.number(1))
    assert small.enclosed(128).sign() == 0
    last = Number(tower, (Fraction(0),) * (tower.size - 1) + (Fraction(1),))
    for number in (small, small * last, small * (tower.number(9) + last)):
        assert number.sign() == 1
        assert (-number).sign() == -1
        assert (number - number).sign() == 0
    assert (small * (tower.number(1) - tower.number(9) * last)).sign() == -1


@pytest.mark.parametrize("name", TOWERS)
def test_roots_in_a_tower_are_found(name: str) -> None:
    tower, rng = TOWERS[name], random.Random(2)
    for _ in range(30):
        a = drawn(tower, rng)
        if a.sign():
            same, root = tower.adjoined(a * a)
            assert same is tower
            assert root.sign() == 1
            assert not any((root - a).parts) or not any((root + a).parts)
            for k in (-1, 0):
                with pytest.raises(CertificateError, match="a number that is not positive"):
                    tower.adjoined(tower.number(k) * a * a)


@pytest.mark.parametrize(
    ("name", "radicand"),
    [("2", 3), ("2", 6), ("2", Fraction(1, 3)), ("2, 3", 5), ("2, 3", 10), ("three", 3)],
)
def test_roots_that_are_not_there_are_adjoined(name: str, radicand: int | Fraction) -> None:
    tower = TOWERS[name]
    for a in (tower.number(1), tower.number(1) + tower.number(ROOT)):
        under = tower.number(radicand) * a * a
        above, root = tower.adjoined(under)
        assert above.size == root.tower.size == 2 * tower.size
        assert root.sign() == 1
        assert near(value(root) ** 2, value(under))
        assert not any((root * root - above.number(under)).parts)


@pytest.mark.parametrize(
    ("radicand", "root"), [(Fraction(9, 4), Fraction(3, 2)), (Fraction(4, 25), Fraction(2, 5))]
)
def test_rational_roots(radicand: Fraction, root: Fraction) -> None:
    same, found = Tower().adjoined(Tower().number(radicand))
    assert found.parts == (root,)
    assert same.size == 1
    for other in (2 * radicand, radicand / 2, radicand / 3):
        assert Tower().adjoined(Tower().number(other))[0].size == 2
