"""Polynomials with integer coefficients, each as one integer, so that few products are long.

Kronecker's substitution: the polynomial sum_k c_k s^k is the integer sum_k c_k 2^(width k). Sums
and products of such integers are those of the polynomials. They can be read as long as every
coefficient is less than 2^(width - 1) in size.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
from struct import unpack

from .bounds import Columns, Rounded, Vector

_WORD, _HALF = 64, 32
_FEW, _REST = 28, 34  # binary digits of the rounded P, and what they leave of 62 for other numbers


def packed(coefficients: Sequence[int], width: int) -> int:
    """The integer of a polynomial.

    >>> packed([1, -2, 3], 8), unpacked(packed([1, -2, 3], 8), 8, 3)
    (196097, [1, -2, 3])
    """
    total = 0
    for c in reversed(coefficients):
        total = (total << width) + c
    return total


def unpacked(value: int, width: int, count: int) -> Vector:
    """The coefficients of a polynomial of a degree below `count`; the width is whole bytes."""
    half, step = 1 << width - 1, width // 8
    data = (value + _halves(width, count)).to_bytes(step * count, "little")
    return [
        int.from_bytes(data[k : k + step], "little") - half for k in range(0, step * count, step)
    ]


def coefficient(value: int, width: int, k: int) -> int:
    """The coefficient of s^k of a polynomial."""
    half = 1 << width - 1
    return ((value + _halves(width, k + 1) >> width * k) & (1 << width) - 1) - half


def wide_enough(size: int) -> int:
    """A width for polynomials whose coefficients are at most `size` in size."""
    return (size.bit_length() + 2 + 7) // 8 * 8


def near_one(p: Sequence[Vector], matrix: Columns, size: int, one: int) -> Rounded:
    """The entries of P M - 1, where 1 is `one`, for a matrix M with entries of at most `size`.

    Each column of P is one integer with a place for each row, so that a column of P M is a sum of
    few products. The products are exact. Of each number the highest word of its place is kept.
    """
    digits = (max(sum(map(abs, row)) for row in p) * size + one).bit_length()
    width = -(-(digits + 2) // _WORD) * _WORD
    shift = width - 2 - digits  # so the highest words hold as many digits as possible
    places = [packed(column, width) for column in zip(*p, strict=True)]
    sums = [
        sum([places[e] * x for e, x in column]) - (one << width * i) << shift
        for i, column in enumerate(matrix)
    ]
    rows = _highest(sums, len(p), width // 32, "q", width // _WORD)
    return Rounded(rows, width - _WORD - shift, 1)


class Coarse:
    """P in few digits, for bounds of P M: its columns, each as one integer with 64-bit places.

    P is (Q + E) 2^c with integers |Q| <= 2^28 and 0 <= E < 1. Let v be (V + D) 2^d with integers
    |V| <= 2^b and 0 <= D < 1, and let at most m of its entries not be 0, where m 2^b <= 2^34. Then
    P v differs from Q V 2^(c + d) by less than (sum |P| / 2^c + 2^34) 2^(c + d), and Q V is at most
    2^62. Of Q V the highest 32 binary digits of its place are kept.
    """

    def __init__(self, p: list[Vector]) -> None:
        self.p = p
        self.drop = max(0, max(map(abs, chain.from_iterable(p))).bit_length() - _FEW)
        rows = [[x >> self.drop for x in row] for row in p]
        self.places = [packed(column, _WORD) for column in zip(*rows, strict=True)]
        most = (max(sum(map(abs, row)) for row in p) >> self.drop) + 1
        self.off = 2 + (most + (1 << _REST) >> _HALF) + 1

    def sizes(self, matrix: Columns) -> Rounded:
        """The sizes of the entries of P M."""
        entries, count = max(map(len, matrix)), len(self.p)
        top = max([abs(x) for column in matrix for _, x in column], default=0).bit_length()
        down, places = top - (_REST - entries.bit_length()), self.places
        if down < 0:
            sums = [sum([places[e] * x for e, x in column]) << -down for column in matrix]
        else:
            sums = [sum([places[e] * (x >> down) for e, x in column]) for column in matrix]
        rows = _highest(sums, count, 2, "i", 2)
        return Rounded(rows, self.drop + down + _HALF, self.off)


def _highest(
    columns: Sequence[int], count: int, step: int, form: str, words: int
) -> list[list[int]]:
    """The sizes of the highest words of all places, row by row.

    A column has `count` places of 32 `step` bits, which are `words` numbers of the given form.
    """
    halves, size = _halves(32 * step, count), 4 * step * count
    # x + halves has a positive number in each place; ^ turns it into two's complement.
    data = b"".join([((x + halves) ^ halves).to_bytes(size, "little") for x in columns])
    numbers = unpack(f"<{count * words * len(columns)}{form}", data)
    tops = range(words - 1, count * words, words)
    return [list(map(abs, numbers[top :: count * words])) for top in tops]


def _halves(width: int, count: int) -> int:
    """Half of the range of each place; the width is whole bytes."""
    return int.from_bytes((bytes(width // 8 - 1) + b"\x80") * count, "little")
