"""Systems whose zeros are known exactly, as pairs (re, im) of Fractions."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import product

from flint import fmpq_mat

from exactfold.exact.linalg import from_fmpq, to_flint
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox

Form = tuple[Fraction, ...]  # coefficients of x_1, ..., x_n, 1
ComplexForm = tuple[Form, Form]  # a + i b
Root = tuple[tuple[Fraction, Fraction], ...]
Pair = tuple[ComplexForm, ComplexForm]


def zero_form(size: int) -> Form:
    return (Fraction(0),) * (size + 1)


def real_pair(first: Form, second: Form) -> Pair:
    """The quadric L M."""
    return (first, zero_form(len(first) - 1)), (second, zero_form(len(first) - 1))


def conjugate_pair(a: Form, b: Form) -> Pair:
    """The quadric a^2 + b^2 = (a + i b)(a - i b)."""
    return (a, b), (a, tuple(-x for x in b))


def system_of(pairs: list[Pair]) -> QuadraticSystem:
    matrices = []
    for (a, b), (c, d) in pairs:
        # (a + ib)(c + id) has the real part ac - bd; the imaginary part vanishes by construction.
        size = len(a)
        matrices.append(
            [
                [a[i] * c[j] + c[i] * a[j] - b[i] * d[j] - d[i] * b[j] for j in range(size)]
                for i in range(size)
            ]
        )
    return QuadraticSystem.from_rational(matrices)


def roots_of(pairs: list[Pair]) -> list[Root]:
    """One zero for each choice of a factor in every equation; raises if one is at infinity."""
    n = len(pairs)
    roots = []
    for choice in product((0, 1), repeat=n):
        rows, right = [], []
        for pair, k in zip(pairs, choice, strict=True):
            a, b = pair[k]
            rows += [[*a[:n], *(-x for x in b[:n])], [*b[:n], *a[:n]]]
            right += [[-a[n]], [-b[n]]]
        solution: fmpq_mat = to_flint(rows).solve(to_flint(right))
        values = [from_fmpq(solution[k, 0]) for k in range(2 * n)]
        roots.append(tuple(zip(values[:n], values[n:], strict=True)))
    return roots


def random_form(source: random.Random, n: int, size: int = 9) -> Form:
    return tuple(Fraction(source.randint(-size, size), source.randint(1, 4)) for _ in range(n + 1))


def random_pairs(seed: int, n: int, conjugate: int = 0, size: int = 9) -> list[Pair]:
    """n pairs of random forms, the first `conjugate` of them conjugate over Q(i), 2^n zeros."""
    source = random.Random(seed)
    while True:
        pairs = []
        for p in range(n):
            first, second = random_form(source, n, size), random_form(source, n, size)
            pairs.append((conjugate_pair if p < conjugate else real_pair)(first, second))
        try:
            if len(set(roots_of(pairs))) == 1 << n:
                return pairs
        except ZeroDivisionError:
            continue


def circle_and_axes() -> list[Root]:
    zero, one = Fraction(0), Fraction(1)
    return [
        ((x, zero), (y, zero)) for x, y in ((one, zero), (-one, zero), (zero, one), (zero, -one))
    ]


CIRCLE_AND_AXES = QuadraticSystem.from_rational(
    [[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 1, 0], [1, 0, 0], [0, 0, 0]]]
)


def approx(root: Root) -> list[complex]:
    return [complex(float(re), float(im)) for re, im in root]


def is_real(root: Root) -> bool:
    return all(im == 0 for _, im in root)


def contains(box: IsolatingBox, root: Root) -> bool:
    """Whether the closed box holds the root, decided over Q."""
    scale = Fraction(2) ** box.bits
    imag = box.imag or (0,) * len(box.real)
    return (bool(box.imag) or is_real(root)) and all(
        abs(re * scale - c) <= box.radius and abs(im * scale - d) <= box.radius
        for (re, im), c, d in zip(root, box.real, imag, strict=True)
    )


def radius(box: IsolatingBox) -> Fraction:
    return Fraction(box.radius) / Fraction(2) ** box.bits


def magnitude(root: Root) -> Fraction:
    return max(max(abs(re), abs(im)) for re, im in root)
