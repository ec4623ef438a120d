"""Arrays of balls: doubles with a bound of their error, for sums and products in NumPy.

u = 2^-53. A sum of k products of doubles, in any order, with or without fused operations, is off by
at most k u / (1 - k u) times the sum of the sizes of the products (Higham, Accuracy and Stability
of Numerical Algorithms, section 3.1); for complex doubles by at most 2 sqrt(2) times as much. Here
it is 4 (k + 1) u. Bounds of errors are themselves sums of numbers that are not negative; they are
computed with a relative error below 2^-30 for k < 2^20, which the factor 1 + 2^-20 covers. What
underflow loses is below 2^-1000 for so many terms, and is added. Overflow makes a bound infinite or
not a number, which no comparison passes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from exactfold._support.arrays import FloatArray

Mids: TypeAlias = npt.NDArray[Any]
"""Doubles, real or complex."""

_U = 4 * 2.0**-53
_TINY = 2.0**-1000
UP = 1.0 + 2.0**-20
"""A sum of few numbers that are not negative, as computed, times this is no less than the sum."""


@dataclass(frozen=True)
class Balls:
    """All numbers within `rad` of `mid`, entry by entry.

    >>> third = Balls.exact(np.array([1.0])) * Balls(np.array([1 / 3]), np.array([2.0**-54]))
    >>> bool(third.mid[0] == 1 / 3), bool(2.0**-54 <= third.rad[0] < 2.0**-52)
    (True, True)
    """

    mid: Mids
    rad: FloatArray

    @classmethod
    def exact(cls, values: Mids) -> Balls:
        """Doubles that are exact."""
        return cls(values, np.zeros(values.shape))

    def __getitem__(self, place: Any) -> Balls:
        return Balls(self.mid[place], self.rad[place])

    def reshape(self, *shape: int) -> Balls:
        """The same balls in another shape."""
        return Balls(self.mid.reshape(shape), self.rad.reshape(shape))

    def __add__(self, other: Balls) -> Balls:
        mid = self.mid + other.mid
        return Balls(mid, (self.rad + other.rad + _U * np.abs(mid)) * UP)

    def __sub__(self, other: Balls) -> Balls:
        return self + Balls(-other.mid, other.rad)

    def __mul__(self, other: Balls) -> Balls:
        mid = self.mid * other.mid
        rad = np.abs(self.mid) * other.rad + self.rad * (np.abs(other.mid) + other.rad)
        return Balls(mid, (rad + _U * np.abs(mid)) * UP + _TINY)

    def __matmul__(self, other: Balls) -> Balls:
        terms = self.mid.shape[-1]
        size, other_size = np.abs(self.mid), np.abs(other.mid)
        rad = size @ (other.rad + (terms + 1) * _U * other_size)
        if self.rad.any():
            rad = rad + self.rad @ (other_size + other.rad)
        return Balls(self.mid @ other.mid, rad * UP + _TINY)

    def moved(self, axes: tuple[int, ...]) -> Balls:
        """The same balls with other axes first, as in `transpose`."""
        return Balls(self.mid.transpose(axes), self.rad.transpose(axes))

    @property
    def above(self) -> FloatArray:
        """Upper bounds of the sizes."""
        return np.asarray((np.abs(self.mid) + self.rad) * UP)

    @property
    def below(self) -> FloatArray:
        """Lower bounds of the sizes; negative where the ball contains 0."""
        return np.asarray(np.abs(self.mid) * (2.0 - UP) - self.rad * UP)
