"""Reads the candidates for a certifier exactly: floats, complex numbers and rationals."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from flint import arb

from exactfold.errors import UsageError
from exactfold.solve.certify.box import IsolatingBox, Uncertified

Coordinate: TypeAlias = "complex | float | int | Fraction | tuple[Fraction | int, Fraction | int]"
Points: TypeAlias = "Iterable[Sequence[Coordinate]] | Iterable[npt.NDArray[Any]]"
Point: TypeAlias = tuple[Fraction, ...]

REACH = Fraction(1, 64)
"""A box is accepted if it is at most max(1, |candidate|) times this away from its candidate."""
_ZERO = Fraction(0)
_NEGLIGIBLE = Fraction(1, 10**8)


@dataclass(frozen=True)
class Candidate:
    """A point of C^n: its exact real and imaginary parts, and floats for messages."""

    real: Point
    imag: Point
    shown: tuple[complex, ...]

    @property
    def is_nearly_real(self) -> bool:
        """Whether the imaginary parts are negligible, so that a real zero is tried first."""
        if not any(self.imag):
            return True
        size = max([Fraction(1), *map(abs, self.real)])
        return max(map(abs, self.imag), default=Fraction(0)) <= _NEGLIGIBLE * size


def exact_candidates(points: Points, size: int) -> list[Candidate | Uncertified]:
    """Each row of `points` as exact numbers, or `Uncertified` if it is not finite.

    A coordinate is a float, a complex number, an int, a Fraction, or a pair (real part, imaginary
    part) of rationals. Raises `UsageError` if a row does not have `size` coordinates.

    >>> row, = exact_candidates([[0.5, (Fraction(1, 3), 2)]], 2)
    >>> row.real, row.imag
    ((Fraction(1, 2), Fraction(1, 3)), (Fraction(0, 1), Fraction(2, 1)))
    """
    candidates: list[Candidate | Uncertified] = []
    for given in points:
        row = given.tolist() if isinstance(given, np.ndarray) else given
        shown = tuple(_approx_complex(x) for x in row)
        if len(shown) != size:
            raise UsageError(f"a candidate has {len(shown)} coordinates, not {size}")
        parts = [_exact_parts(x) for x in row]
        finite = [part for part in parts if part is not None]
        if len(finite) < len(parts):
            candidates.append(Uncertified(shown, "the candidate is not finite"))
            continue
        real, imag = tuple(a for a, _ in finite), tuple(b for _, b in finite)
        candidates.append(Candidate(real, imag, shown))
    return candidates


def is_within_reach(box: IsolatingBox, start: Point, reach: Fraction | None) -> bool:
    """Whether the centre of a box is near the point (real, then imaginary parts) of its start.

    `reach` is in units of max(1, |start|); None allows any distance.
    """
    if reach is None:
        return True
    allowed = reach * max([Fraction(1), *map(abs, start)])
    scale = Fraction(1, 1 << box.bits)
    centre = (*box.real, *box.imag)
    return all(abs(c * scale - s) <= allowed for c, s in zip(centre, start, strict=True))


def to_arb(value: Fraction) -> arb:
    """A ball around the number, at the precision of FLINT's context."""
    return arb(value.numerator) / arb(value.denominator)


def largest(column: Any) -> arb:
    """Roughly the largest absolute value in a matrix of balls; not a bound, only for choices."""
    return max(abs(entry).mid() for entry in column.entries())


def _exact_parts(value: Any) -> tuple[Fraction, Fraction] | None:
    if isinstance(value, tuple):
        return Fraction(value[0]), Fraction(value[1])
    if isinstance(value, Fraction | int):
        return Fraction(value), _ZERO
    number = complex(value)
    if not (isfinite(number.real) and isfinite(number.imag)):
        return None
    return Fraction(number.real), Fraction(number.imag) if number.imag else _ZERO


def _approx_complex(value: Any) -> complex:
    if isinstance(value, tuple):
        return complex(_approx(value[0]), _approx(value[1]))
    return complex(_approx(value)) if isinstance(value, Fraction | int) else complex(value)


def _approx(value: Fraction | int) -> float:
    try:
        return float(value)
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")
