"""Numbers made of square roots, against values of many digits."""

import copy
import pickle
import random
from fractions import Fraction

import pytest
from flint import fmpq

from exactfold.errors import UsageError
from exactfold.exact.surds import RATIONALS, Surd, common_field, exact, rational, real_root, simple

TWO = RATIONALS.adjoined(2)
NESTED = TWO.adjoined(2 + TWO.root)
DIGITS = 400


def drawn(rng, field):
    size = field.dimension
    return Surd(field, [Fraction(rng.randint(-9, 9), rng.randint(1, 7)) for _ in range(size)])


def same(value, ball):
    return value.ball(DIGITS).overlaps(ball)


@pytest.mark.parametrize("seed", range(20))
def test_arithmetic(seed):
    rng = random.Random(seed)
    a, b = drawn(rng, NESTED), drawn(rng, rng.choice([TWO, NESTED]))
    x, y = a.ball(DIGITS), b.ball(DIGITS)
    r = Fraction(rng.randint(1, 9), 7)
    assert same(a + b, x + y)
    assert same(a - b, x - y)
    assert same(r - a, fmpq(r.numerator, r.denominator) - x)
    if b:
        assert a / b * b == a
        assert r / b * b == r
    assert (a + r) - r == a == a * r / r
    assert (a < b) == bool(x < y)
    assert (a > b) == bool(x > y)
    assert a.sign() == (bool(x > 0) - bool(x < 0))


def test_numbers_that_nearly_cancel():
    """(sqrt 2 - 1)^n is a small positive number, and p - q sqrt 2 with large p and q."""
    small = TWO.root - 1
    power = small
    for _ in range(6):
        power = power * power
    assert power.sign() == 1
    assert (-power).sign() == -1
    assert (power - power).sign() == 0
    assert abs(power.parts[0]) > 10**20


@pytest.mark.parametrize("seed", range(10))
def test_square_roots(seed):
    a = drawn(random.Random(seed), NESTED)
    root = NESTED.square_root(a * a)
    assert root is not None
    assert root * root == a * a
    assert TWO.square_root(TWO.number(3)) is None
    assert real_root(a * a, NESTED) in (a, -a)


def test_numbers_of_two_fields_do_not_mix():
    with pytest.raises(UsageError, match="does not extend"):
        TWO.root + RATIONALS.adjoined(3).root


@pytest.mark.parametrize("wrong", [0.5, "1", None])
def test_floats_are_no_exact_numbers(wrong):
    with pytest.raises(TypeError, match="is not an exact number"):
        TWO.root + wrong
    with pytest.raises(TypeError, match="is not an exact number"):
        TWO.root * wrong


def test_values():
    value = NESTED.number(Fraction(3, 4))
    assert value == Fraction(3, 4)
    assert hash(value) == hash(Fraction(3, 4))
    assert (rational(value), simple(value)) == (Fraction(3, 4), Fraction(3, 4))
    assert common_field([value, TWO.root, 1]) == NESTED
    assert exact(2) == Fraction(2)
    other = pickle.loads(pickle.dumps(NESTED.root))
    assert other == copy.deepcopy(NESTED.root) == NESTED.root
    assert hash(other) == hash(NESTED.root)
