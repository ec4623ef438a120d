"""Degrees of irreducible factors over Q, proved by factoring modulo primes.

Let p be a prime that does not divide the leading coefficient of f, and let f be squarefree modulo
p. Then the degrees of the factors of f modulo p are the cycle lengths of an element of the Galois
group, which permutes the roots (Dedekind; Frobenius). A proof by a few primes can be checked again
from these primes alone.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

from flint import fmpz, fmpz_poly, nmod_poly

_FROM = 1000
_TRIED = 48


def modular_degrees(polynomial: Sequence[int], prime: int) -> tuple[int, ...] | None:
    """Degrees of the irreducible factors modulo a prime, ascending; None for an unsuitable prime.

    A prime is suitable if it does not divide the leading coefficient and the polynomial is
    squarefree modulo this prime.

    >>> [modular_degrees((-2, 0, 1), p) for p in (7, 5, 2)]
    [(1, 1), (2,), None]
    """
    reduced = nmod_poly(list(polynomial), prime)
    if reduced.degree() != len(polynomial) - 1:
        return None
    factors = reduced.factor()[1]
    if any(exponent > 1 for _, exponent in factors):
        return None
    return tuple(sorted(int(factor.degree()) for factor, _ in factors))


def irreducibility_primes(polynomial: Sequence[int], tried: int = _TRIED) -> tuple[int, ...] | None:
    """Primes whose `modular_degrees` together prove a polynomial irreducible over Q.

    For every suitable prime, the degree of a factor over Q is a sum of some of the degrees modulo
    that prime. If only 0 and d are such sums for all primes, there is no proper factor. The result
    is None if the first `tried` primes above 1000 prove nothing: the polynomial may be irreducible
    all the same.

    >>> irreducibility_primes((-2, 0, 1)), irreducibility_primes((1, 0, 0, 0, 1))  # T^4 + 1
    ((1013,), None)
    """
    degree = len(polynomial) - 1
    possible = (2 << degree) - 1  # bit k: a factor of degree k is not excluded
    used = []
    for prime, degrees in _patterns(polynomial, tried):
        sums = 1
        for k in degrees:
            sums |= sums << k
        if possible & ~sums:
            possible &= sums
            used.append(prime)
        if possible == 1 | 1 << degree:
            return tuple(used)
    return None


def factor_degrees(polynomial: Sequence[int]) -> tuple[int, ...]:
    """Degrees of the irreducible factors over Q of a squarefree polynomial, ascending and exact.

    `irreducibility_primes` is tried first. Only if it proves nothing, the polynomial is factored
    over Z, which may be slow.

    >>> factor_degrees((-2, 0, 1)), factor_degrees((1, 0, 0, 0, 1)), factor_degrees((-1, 0, 0, 1))
    ((2,), (4,), (1, 2))
    """
    if irreducibility_primes(polynomial) is not None:
        return (len(polynomial) - 1,)
    factors = fmpz_poly(list(polynomial)).factor()[1]
    return tuple(sorted(int(factor.degree()) for factor, _ in factors))


def _patterns(polynomial: Sequence[int], tried: int) -> Iterator[tuple[int, tuple[int, ...]]]:
    """Yields each suitable prime among the first `tried` above 1000, with the degrees modulo it."""
    for prime in islice((p for p in range(_FROM, _FROM * tried) if _is_prime(p)), tried):
        degrees = modular_degrees(polynomial, prime)
        if degrees is not None:
            yield prime, degrees


def _is_prime(value: int) -> bool:
    return bool(fmpz(value).is_prime())
