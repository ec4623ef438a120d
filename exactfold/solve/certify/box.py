"""Isolating boxes: what every certifier returns for a root."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True)
class IsolatingBox:
    """A box proved to hold exactly one zero of a system, a regular one.

    What proves it is, for one, docs/mathematics.md, Krawczyk's test.
    Centre (real + i imag) / 2^bits, radius / 2^bits in the sup norm over the unknowns; in a
    complex box real and imaginary parts each keep within the radius (a box of R^2n). `imag` is
    empty if the zero is proved real.

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
        """Whether the zero is proved not real: some imaginary part keeps off zero."""
        return any(abs(y) > self.radius for y in self.imag)

    def interval(self, k: int) -> tuple[Fraction, Fraction]:
        """Bounds of the real part of unknown k."""
        scale = 1 << self.bits
        return (
            Fraction(self.real[k] - self.radius, scale),
            Fraction(self.real[k] + self.radius, scale),
        )

    def is_inside(self, other: IsolatingBox) -> bool:
        """Whether this box lies within `other` (decided exactly)."""
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
        """Whether the two boxes have no common point (decided exactly)."""
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
    """A candidate around which no zero could be isolated; there may or may not be one."""

    point: tuple[complex, ...]
    reason: str
