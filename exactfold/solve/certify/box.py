"""Isolating boxes: the results of certifiers for roots."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class IsolatingBox:
    """A box that is proved to contain exactly one zero of a system, a regular one.

    Several tests prove this, for example docs/mathematics.md, Krawczyk's test. The centre is
    (real + i imag) / 2^bits. The radius is radius / 2^bits, in the sup norm over the unknowns; in a
    complex box the real and the imaginary parts each stay within the radius (a box of R^2n).
    `imag` is empty if the zero is proved real.

    >>> IsolatingBox((3,), (), 1, 2).interval(0)
    (Fraction(1, 2), Fraction(1, 1))
    """

    real: tuple[int, ...]
    imag: tuple[int, ...]
    radius: int
    bits: int

    def __repr__(self) -> str:
        kind = "real" if self.is_real else "complex"
        size = self.radius.bit_length() - self.bits
        return f"<IsolatingBox: {kind}, {len(self.real)} unknowns, radius below 2^{size}>"

    @property
    def is_real(self) -> bool:
        """Whether the zero is proved real."""
        return not self.imag

    @property
    def is_nonreal(self) -> bool:
        """Whether the zero is proved non-real: some imaginary part is bounded away from zero."""
        return any(abs(y) > self.radius for y in self.imag)

    def interval(self, k: int) -> tuple[Fraction, Fraction]:
        """Bounds of the real part of the unknown number k."""
        scale = 1 << self.bits
        return (
            Fraction(self.real[k] - self.radius, scale),
            Fraction(self.real[k] + self.radius, scale),
        )

    def is_inside(self, other: IsolatingBox) -> bool:
        """Whether this box lies within `other`, decided exactly."""
        bits = max(self.bits, other.bits)
        mine, theirs = bits - self.bits, bits - other.bits
        slack = (other.radius << theirs) - (self.radius << mine)
        flat = (0,) * len(self.real)
        pairs = [
            *zip(self.real, other.real, strict=True),
            *zip(self.imag or flat, other.imag or flat, strict=True),
        ]
        return all(abs((x << mine) - (y << theirs)) <= slack for x, y in pairs)

    def is_disjoint_from(self, other: IsolatingBox) -> bool:
        """Whether the two boxes have no common point, decided exactly."""
        bits = max(self.bits, other.bits)
        reach = (self.radius << (bits - self.bits)) + (other.radius << (bits - other.bits))

        def apart(a: tuple[int, ...], b: tuple[int, ...]) -> bool:
            size = len(self.real)
            a, b = a or (0,) * size, b or (0,) * size
            return any(
                abs((x << (bits - self.bits)) - (y << (bits - other.bits))) > reach
                for x, y in zip(a, b, strict=True)
            )

        return apart(self.real, other.real) or apart(self.imag, other.imag)


@dataclass(frozen=True)
class Uncertified:
    """A candidate for which no zero could be isolated; there may or may not be a zero near it."""

    point: tuple[complex, ...]
    reason: str
