"""Forms modulo a prime: what is shown of their common zeros, and what is not."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from itertools import islice, product

import pytest

from exactfold.checker.core.reading import LimitError
from exactfold.checker.panels import modular, reduction
from exactfold.checker.panels.modular import Matrix, one_component, only_zero, reduced_forms
from exactfold.checker.panels.proposed import near_zeros
from exactfold.checker.panels.reduction import Work

P = next(modular._primes())


def form(size: int, **terms: int) -> Matrix:
    """A form with terms such as `w01=2`: 2 w_0 w_1, all doubled."""
    matrix = [[0] * size for _ in range(size)]
    for name, weight in terms.items():
        j, k = int(name[1]), int(name[2])
        matrix[j][k] += weight
        matrix[k][j] += weight
    return [[x % P for x in row] for row in matrix]


CONE = form(4, w00=1, w11=-1, w22=-1)


@pytest.mark.parametrize(
    ("forms", "shown"),
    [
        ([form(2, w00=1), form(2, w11=1)], True),
        ([form(2, w00=1), form(2, w01=1)], False),  # (0, 1)
        ([form(2, w00=1, w11=1), form(2, w01=1)], True),
        ([form(2, w00=1, w11=1)], False),  # one form of two variables, zero at (1, i)
        ([form(3, w00=1, w12=1), form(3, w11=1, w02=1), form(3, w22=1, w01=1)], True),
        ([form(3, w00=1, w12=-1), form(3, w11=1, w02=-1), form(3, w22=1, w01=-1)], False),
    ],
)
def test_forms_that_vanish_only_at_zero(forms: list[Matrix], shown: bool) -> None:
    assert only_zero(forms, P, Work()) is shown


def test_many_variables_are_not_tried() -> None:
    squares = [form(6, **{f"w{k}{k}": 1}) for k in range(6)]
    assert not only_zero(squares, P, Work())
    assert only_zero([[row[:5] for row in square[:5]] for square in squares[:5]], P, Work())


COMPONENTS = {
    "a cone": ([form(4, w00=1, w11=-1, w22=-1)], True),
    "two planes": ([form(4, w00=1, w11=-1)], False),
    "an elliptic curve": ([CONE, form(4, w33=1, w11=-2, w02=-3)], True),
    "the same without real signs": ([CONE, form(4, w33=1, w00=-3, w11=-1)], True),
    "two conics": ([CONE, form(4, w33=1, w11=-1)], False),
    "two conics that are not real": ([CONE, form(4, w33=1, w11=1)], False),
    "two conics modulo the cone": ([CONE, form(4, w33=1, w00=1, w11=-2, w22=-1)], False),
    "a graph": ([CONE, form(4, w03=1, w22=1)], True),
    "a cubic and a line": ([form(4, w00=1, w12=1), form(4, w13=1, w02=1)], False),
    "two cones on a graph": (  # the last form is w4^2 - w1^2 where the others vanish
        [
            form(5, w00=1, w11=-1, w22=1),
            form(5, w03=1, w22=1),
            form(5, w44=1, w11=-1, w03=2, w22=2),
        ],
        False,
    ),
    "a form that depends on the earlier ones": ([CONE, CONE], False),
    "no direction is left": ([CONE, form(4, w00=1, w11=2, w22=5)], False),
    "too small a space for a graph": ([form(3, w00=1, w11=1, w22=1), form(3, w01=1)], False),
}


@pytest.mark.parametrize("name", COMPONENTS)
def test_forms_whose_zeros_are_one_component(name: str) -> None:
    forms, shown = COMPONENTS[name]
    assert one_component(forms, P, Work()) is shown


def test_random_forms_that_contain_a_product_are_never_one_component() -> None:
    """A sum of the forms is a product of linear forms, whatever the coordinates."""
    generator = random.Random(7)
    for _ in range(40):
        first = form(4, **{f"w{j}{k}": generator.randint(-3, 3) for j, k in PAIRS[:6]})
        one, other = ([generator.randint(-3, 3) for _ in range(4)] for _ in range(2))
        second = [
            [(x + one[j] * other[k] + one[k] * other[j]) % P for k, x in enumerate(row)]
            for j, row in enumerate(first)
        ]
        assert not one_component([first, second], P, Work())
        assert not one_component([second, first], P, Work())


PAIRS = [(j, k) for j, k in product(range(3), repeat=2) if j <= k]


@pytest.mark.parametrize("p", [3, 7, 11, 19])
@pytest.mark.parametrize("name", [name for name in COMPONENTS if name.startswith("two ")])
def test_a_discriminant_that_is_zero_is_no_square(name: str, p: int) -> None:
    """Modulo a small prime, many points lie where two components meet."""
    forms = [[[(2 * x % P - x) % p for x in row] for row in form] for form in COMPONENTS[name][0]]
    assert not one_component(forms, p, Work())


def test_the_primes_are_prime() -> None:
    some = list(islice(modular._primes(), 5))
    assert some == [2147483647, 2147483587, 2147483579, 2147483563, 2147483543]
    for p in some:
        assert p % 4 == 3
        assert all(p % q for q in range(2, 46341))


def test_primes_in_which_the_roots_have_values() -> None:
    half, zero, one = Fraction(1, 2), Fraction(0), Fraction(1)
    radicands = [(Fraction(2),), (Fraction(3), one)]  # 2, and 3 + sqrt 2
    weight, value = (zero, one, zero, zero), (half, zero, one, zero)  # r1, and 1/2 + r2
    found = reduced_forms([[(weight, [value])]], radicands, Work())
    assert found is not None
    [[[x]]], p = found
    r = next(r for r in _roots_of(2, p) if any(_is(x, r, s, p) for s in _roots_of(3 + r, p)))
    assert r * r % p == 2


def _roots_of(square: int, p: int) -> list[int]:
    root = pow(square, (p + 1) // 4, p)
    return [s for s in (root, p - root) if (s * s - square) % p == 0]


def _is(x: int, r: int, s: int, p: int) -> bool:
    """Whether x is r1 (1/2 + r2)^2 for these values of the roots."""
    return (4 * x - r * (1 + 2 * s) ** 2) % p == 0


def test_a_prime_that_divides_a_denominator_is_not_used() -> None:
    one = (Fraction(1),)
    found = reduced_forms([[(one, [(Fraction(1, P),)])]], [], Work())
    assert found is not None
    assert found[1] != P


def test_no_prime(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(modular, "PRIMES", 1)
    one = (Fraction(1),)
    square = next(x for x in range(2, 50) if pow(x, (P - 1) // 2, P) != 1)
    assert reduced_forms([[(one, [one])]], [(Fraction(square),)], Work()) is None
    assert reduced_forms([[(one, [one])]], [(Fraction(P),)], Work()) is None  # its root would be 0


def test_zeros_in_floating_point() -> None:
    cone = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]
    other = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -4.0]]
    found = list(near_zeros([cone, other], Work()))
    assert found
    for x, y, z in found:
        assert abs(x * x - y * y - z * z) < 1e-12
        assert abs(y * y - 4 * z * z) < 1e-12
    assert not list(near_zeros([[[1.0, 0.0], [0.0, 1.0]]], Work()))


MANY = [form(5, **{f"w{j}{k}": 1}) for j in range(5) for k in range(j + 1)]


@pytest.mark.parametrize(
    "tried",
    [
        lambda work: reduced_forms([], [(Fraction(-1),)], work),  # no prime will do
        lambda work: only_zero(400 * MANY[:4], P, work),
        lambda work: one_component(64 * [CONE], P, work),
        lambda work: list(near_zeros([[[float(x) for x in row] for row in CONE]], work)),
    ],
)
def test_all_work_is_counted(
    tried: Callable[[Work], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A file cannot make the checker go on for ever."""
    monkeypatch.setattr(reduction, "MOST_STEPS", 40)
    with pytest.raises(LimitError, match=r"the steps to the spaces of motions, \d+, are more than"):
        tried(Work())
