"""Finds the number (a + b sqrt d)/q that a decimal was meant to be, and the odds against chance."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import isqrt, log, log2, prod, sqrt
from typing import Final

import numpy as np
from flint import arb, fmpz_mat

from exactfold._support.arrays import FloatArray, IntArray
from exactfold.exact.surds import RATIONALS, Number, Surd, SurdField, simple

RADICANDS: Final = (1, 2, 3, 5)
"""The fields that are tried: Q, Q(sqrt 2), Q(sqrt 3), Q(sqrt 5)."""
_LARGEST: Final = {1: 360_000, 2: 100_000, 3: 100_000, 5: 100_000}
"""Candidates have size q^2 (2|b| + 1) up to this bound, by d."""
_CHANCE: Final = 2.0**-6
"""A candidate is believed only if chance gives one as small with at most this probability."""
_BITS: Final = 10.0
"""By so many bits, numbers beyond the table must beat chance; there are many more of them."""


def field_of(radicand: int) -> SurdField:
    """Q for the radicand 1, else Q(sqrt radicand)."""
    return RATIONALS if radicand == 1 else RATIONALS.adjoined(radicand)


@dataclass(frozen=True)
class Candidates:
    """The numbers (a + b sqrt d)/q modulo 1, sorted by value.

    The size of a candidate is q^2 (2|b| + 1). `rank` counts the candidates of at most its size; up
    to a constant, this count is the size itself.
    """

    values: FloatArray
    numerators: IntArray
    roots: IntArray
    denominators: IntArray
    rank: IntArray


@dataclass(frozen=True)
class Match:
    """An exact number that matches a decimal, and the bits by which the match beats chance."""

    value: Number
    bits: float


@lru_cache(maxsize=8)
def candidates(radicand: int) -> Candidates:
    """All candidates of one field up to the bound on their size."""
    bound, root = _LARGEST[radicand], sqrt(radicand)
    rows: list[tuple[IntArray, IntArray, int]] = []
    for den in range(1, isqrt(bound) + 1):
        most = min((bound // (den * den) - 1) // 2, 256) if radicand > 1 else 0
        a, b = np.meshgrid(np.arange(den), np.arange(-most, most + 1), indexing="ij")
        lowest = np.gcd(np.gcd(a, b), den) == 1
        rows.append((a[lowest], b[lowest], den))
    a, b = (np.concatenate([row[k] for row in rows]) for k in (0, 1))
    q = np.repeat([row[2] for row in rows], [len(row[0]) for row in rows])
    size = q * q * (2 * np.abs(b) + 1)
    rank = np.searchsorted(np.sort(size), size, side="right")
    values = (a + b * root) / q
    whole = np.floor(values).astype(np.int64)
    order = np.argsort(values - whole, kind="stable")
    a = a - whole * q
    return Candidates(
        (values - whole)[order], a[order], b[order], q[order], rank[order].astype(np.int64)
    )


def matches(values: FloatArray, within: float, radicand: int) -> list[Match | None]:
    """For each value the smallest candidate within a distance, or None if chance explains it.

    A random number lies within `within` of one of the `rank` smallest candidates modulo 1 with
    probability at most 2 * within * rank; `bits` is minus the binary logarithm of this.
    """
    table, highest = candidates(radicand), _CHANCE / (2 * within)
    if highest < 1:  # no candidate has so low a rank
        return [None] * len(values)
    parts = values - np.floor(values)
    # Modulo 1, values just below 1 are near 0.
    turned = parts + np.array([[1.0], [0.0], [-1.0]])
    low = np.searchsorted(table.values, turned - within, side="left")
    high = np.searchsorted(table.values, turned + within, side="right")
    field = field_of(radicand)
    smallest: list[Match | None] = []
    for value, starts, ends in zip(values, low.T.tolist(), high.T.tolist(), strict=True):
        near = [
            start + int(np.argmin(table.rank[start:end]))
            for start, end in zip(starts, ends, strict=True)
            if start < end
        ]
        k = min(near, key=lambda k: int(table.rank[k]), default=None)
        if k is None or table.rank[k] > highest:
            smallest.append(None)
            continue
        q, whole = int(table.denominators[k]), round(float(value - table.values[k]))
        rational = Fraction(int(table.numerators[k]) + whole * q, q)
        root = Fraction(int(table.roots[k]), q)
        number = Surd(field, (rational, root)) if root else rational
        smallest.append(Match(number, -log2(2 * within * float(table.rank[k]))))
    return smallest


def reduced_match(
    value: Fraction, within: Fraction, field: SurdField, least: float = _BITS
) -> Match | None:
    """A number of a field, of any size, within a small distance; None if chance explains it.

    The number is (a + b_1 w_1 + ... + b_m w_m)/q, where w_i are the products of the roots. LLL
    finds a short vector of the lattice of (q, a, b_1, ..., b_m, (q value + a + b_1 w_1 + ...) /
    within). The size of a number is q^2 (2|b_1| + 1) ... (2|b_m| + 1). In a unit interval, fewer
    than S (1 + log S)^max(m, 1) numbers have a size of at most S. A match must beat chance by
    `least` bits.

    >>> reduced_match(Fraction("0.10236012565087"), Fraction(1, 10**13), field_of(2)).value
    17/97 + -5/97*r1
    """
    scale = 1 / within
    roots = field.products(int(scale).bit_length() + 64)
    basis = [round(value * scale), *(_floor(root, scale) for root in roots)]
    rows = [[*(int(i == k) for k in range(len(basis))), basis[i]] for i in range(len(basis))]
    shortest = fmpz_mat(rows).lll()
    q, *parts = (int(shortest[0, k]) for k in range(len(basis)))
    if not q:
        return None
    number = simple(Surd(field, tuple(Fraction(-part, q) for part in parts)))
    size = q * q * prod(2 * abs(b) + 1 for b in parts[1:])
    crowd = size * (1 + log(size)) ** max(len(parts) - 1, 1)
    bits = -log2(2 * float(within) * crowd)
    if bits < least or abs(float(number - value)) > within:
        return None
    return Match(number, bits)


def _floor(root: arb, scale: Fraction) -> int:
    return int((root * scale.numerator / scale.denominator).mid().floor().unique_fmpz())
