"""Proves that forms have no common zero but 0, by the rank of one matrix modulo a prime."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations_with_replacement, islice
from typing import Final, TypeAlias

from flint import fmpz, nmod_mat, nmod_poly

from exactfold._support.clock import Clock

IntRow: TypeAlias = Sequence[int]

NO_LIMIT: Final = Clock()
_STEPS: Final = 2e9
"""Products in a second, of a slow machine, by which the time of a rank is foreseen."""

_PRIMES: Final = 200
"""How many primes are tried."""
MOST_MONOMIALS: Final = 4000
"""The most columns of a matrix whose rank is computed."""


def only_zero(
    linear: Sequence[IntRow],
    quadrics: Sequence[Sequence[IntRow]],
    prime: int,
    clock: Clock = NO_LIMIT,
) -> bool:
    """Whether linear forms and quadrics have no common zero but 0, modulo a prime and so over Q.

    `linear` are rows, and `quadrics` symmetric matrices, of integers modulo `prime`. They are
    images of forms over a ring R whose residue field at some maximal ideal has `prime` elements,
    such as Z, or Z[t] / p localised at a root of p. If the forms have a common zero in an extension
    of the field of fractions, scale it so that its entries lie in a valuation ring over R and one
    of them is a unit: it reduces to a zero modulo the prime. So True is a proof for that field,
    too; False says nothing. Zeros modulo the prime are excluded if all monomials of one degree are
    combinations of the quadrics times monomials (F. S. Macaulay, "The Algebraic Theory of Modular
    Systems", 1916); degree n + 1 suffices for n unknowns. A matrix that would take longer than the
    clock has left is not begun.

    >>> square, product = [[1, 0], [0, 0]], [[0, 1], [1, 0]]
    >>> only_zero([], [square, [[0, 0], [0, 1]]], 101), only_zero([], [square, product], 101)
    (True, False)
    """
    basis = _kernel(linear, len(quadrics[0]) if quadrics else len(linear[0]), prime)
    size = basis.ncols()
    if not size:
        return True
    forms = [
        (basis.transpose() * nmod_mat([list(map(int, row)) for row in form], prime) * basis)
        for form in quadrics
    ]
    terms = [terms for form in forms if (terms := _terms(form, size))]
    return len(terms) >= size and _has_all(terms, size, prime, clock)


def roots_modulo(polynomial: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Some primes with a simple root each of a polynomial modulo that prime.

    >>> [(root * root) % prime == 2 for prime, root in roots_modulo((-2, 0, 1))][:2]
    [True, True]
    """
    for prime in islice(_primes(), _PRIMES):
        reduced = nmod_poly([c % prime for c in polynomial], prime)
        if reduced.degree() < len(polynomial) - 1:
            continue
        simple = [int(root) for root, exponent in reduced.roots() if exponent == 1]
        if simple:
            yield prime, min(simple)


def _primes() -> Iterator[int]:
    """Primes below 2^31, descending."""
    return (n for n in range((1 << 31) - 1, 1 << 30, -2) if fmpz(n).is_prime())


def _kernel(linear: Sequence[IntRow], width: int, prime: int) -> nmod_mat:
    """A basis of the common zeros of linear forms, as columns."""
    if not linear:
        return nmod_mat([[int(i == j) for j in range(width)] for i in range(width)], prime)
    reduced, rank = nmod_mat([list(map(int, row)) for row in linear], prime).rref()
    pivots: list[int] = []
    for i in range(rank):
        pivots.append(next(j for j in range(width) if int(reduced[i, j])))
    free = [j for j in range(width) if j not in set(pivots)]
    columns = []
    for j in free:
        column = [0] * width
        column[j] = 1
        for i, pivot in enumerate(pivots):
            column[pivot] = -int(reduced[i, j]) % prime
        columns.append(column)
    return nmod_mat(width, len(free), [c[i] for i in range(width) for c in columns], prime)


def _terms(form: nmod_mat, size: int) -> dict[tuple[int, int], int]:
    """The coefficients of a quadric by pairs of unknowns."""
    found = {}
    for i in range(size):
        for j in range(i, size):
            value = int(form[i, j]) * (1 + (i != j))
            if value % form.modulus():
                found[i, j] = value % form.modulus()
    return found


def _has_all(
    terms: Sequence[dict[tuple[int, int], int]], size: int, prime: int, clock: Clock
) -> bool:
    """Whether the quadrics times monomials span all monomials of some degree up to n + 1."""
    for degree in range(2, size + 2):
        columns = {m: k for k, m in enumerate(combinations_with_replacement(range(size), degree))}
        if len(columns) > MOST_MONOMIALS:
            return False
        factors = list(combinations_with_replacement(range(size), degree - 2))
        if len(factors) * len(terms) < len(columns):
            continue
        steps = len(factors) * len(terms) * len(columns) ** 2
        if clock.left is not None and steps > _STEPS * clock.left:
            return False
        entries = []
        for quadric in terms:
            for factor in factors:
                row = [0] * len(columns)
                for pair, value in quadric.items():
                    row[columns[tuple(sorted((*pair, *factor)))]] = value
                entries.append(row)
        if nmod_mat(entries, prime).rank() == len(columns):
            return True
    return False
