"""Polynomials with integer coefficients, each as one integer, so that few products are long.

Kronecker's substitution: the polynomial sum_k c_k s^k is the integer sum_k c_k 2^(width k). Sums
and products of such integers are those of the polynomials. They can be read as long as every
coefficient is less than 2^(width - 1) in size.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import unpack

from .bounds import Rounded, Vector, less_one

_WORD = 64


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


def wide_enough(p: Sequence[Vector], size: int) -> int:
    """A width for scalar products of rows of a matrix with polynomials.

    The coefficients of these polynomials are at most `size` in size.
    """
    most = max(sum(map(abs, row)) for row in p) * size
    return (most.bit_length() + 2 + 7) // 8 * 8


class Lanes:
    """A place for each coefficient of the entries of P M(s), where M(s) is a matrix.

    `sizes[k]` bounds the entries of the coefficient of s^k of M(s). The coefficients of M(s) are
    shifted to the left so far that those of P M(s) may fill their places. Then the highest word of
    each place holds about 62 binary digits of the largest possible coefficient.
    """

    def __init__(self, p: Sequence[Vector], sizes: Sequence[int]) -> None:
        most = max(sum(map(abs, row)) for row in p)
        digits = [(most * size).bit_length() for size in sizes]
        self.width = -(-(max(digits) + 2) // _WORD) * _WORD
        self.shifts = [self.width - 2 - n for n in digits]

    def pack(self, coefficients: Sequence[int]) -> int:
        """The integer of an entry of M(s); missing coefficients at its end are 0."""
        total = 0
        for k, c in enumerate(coefficients):
            total += c << self.width * k + self.shifts[k]
        return total

    def table(self, tables: Sequence[Sequence[Sequence[int]]]) -> list[Vector]:
        """The integers of the entries of a table, given the table for each power of s."""
        return [
            [self.pack(entry) for entry in zip(*lines, strict=True)]
            for lines in zip(*tables, strict=True)
        ]

    def read(self, product: list[Vector], one: int) -> list[Rounded]:
        """The coefficients of P M(s) - 1 from the packed entries of P M(s); 1 is `one` there."""
        count, words = len(self.shifts), self.width // _WORD
        halves, size = _halves(self.width, count), self.width // 8 * count
        form = f"<{len(product) * count * words}q"
        read: list[list[Sequence[int]]] = [[] for _ in self.shifts]
        for row in less_one(product, one << self.shifts[0]):
            # x + halves has a positive number in each place; ^ turns it into two's complement.
            data = b"".join([((x + halves) ^ halves).to_bytes(size, "little") for x in row])
            numbers = unpack(form, data)
            for k, rows in enumerate(read):
                rows.append(numbers[(k + 1) * words - 1 :: count * words])
        low = self.width - _WORD
        return [Rounded(rows, low - shift) for rows, shift in zip(read, self.shifts, strict=True)]


def _halves(width: int, count: int) -> int:
    """Half of the range of each place; the width is whole bytes."""
    return int.from_bytes((bytes(width // 8 - 1) + b"\x80") * count, "little")
