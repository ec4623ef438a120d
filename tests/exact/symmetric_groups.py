"""Galois groups that are the whole symmetric group, proved by factoring modulo primes.

The degrees of the factors modulo a prime are the cycle lengths of an element of the Galois group:
see `exactfold.exact.factors`.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import islice

from flint import fmpz

from exactfold.exact.factors import irreducibility_primes, modular_degrees

_TRIED = 48


def symmetric_group_primes(
    polynomial: Sequence[int], tried: int = _TRIED
) -> tuple[int, ...] | None:
    """Primes that prove the Galois group of a polynomial to be the symmetric group S_d.

    The primes prove three things. The polynomial is irreducible, so the group is transitive. Some
    prime has a factor of prime degree l with d/2 < l < d - 2; this gives an l-cycle, which makes
    the transitive group primitive, and by Jordan's theorem (Wielandt, Finite Permutation Groups,
    theorem 13.9) the group then contains the alternating group. Some prime gives an odd
    permutation. For d >= 5 the roots are then not expressible by radicals. The result is None if
    the primes tried prove nothing; for d < 8 there is no such l, and the result is always None.

    >>> symmetric_group_primes((-1, -1, 0, 0, 0, 0, 0, 0, 1))  # T^8 - T - 1
    (1009, 1013, 1021)
    >>> symmetric_group_primes((2, 0, 0, 0, 0, 0, 0, 0, 1)) is None
    True
    """
    first = irreducibility_primes(polynomial, tried)
    if first is None:
        return None
    degree = len(polynomial) - 1
    cycle = odd = None
    for prime in islice(filter(_is_prime, range(1000, 1000 * tried)), tried):
        degrees = modular_degrees(polynomial, prime)
        if degrees is None:
            continue
        if cycle is None and any(degree < 2 * k < 2 * degree - 4 and _is_prime(k) for k in degrees):
            cycle = prime
        if odd is None and sum(k - 1 for k in degrees) % 2:
            odd = prime
        if cycle is not None and odd is not None:
            return tuple(sorted({*first, cycle, odd}))
    return None


def _is_prime(value: int) -> bool:
    return bool(fmpz(value).is_prime())
