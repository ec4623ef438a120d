"""Rational solutions, and lines over quadratic fields, of exact rays: for certificates."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from flint import fmpz

from exactfold.branches.periodic.exactly import ExactRay

Pair = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class QuadraticLine:
    """A line with the entries a + c sqrt(`radicand`) on z, the first that is not 0 being 1."""

    radicand: int
    point: tuple[Pair, ...]
    ray: ExactRay

    @classmethod
    def of(cls, ray: ExactRay) -> QuadraticLine | None:
        """The line of a ray, if it lies in a quadratic field; else None."""
        known = ray.root.root_class
        if known.degree != 2:
            return None
        low, middle, lead = known.polynomial
        radicand, square = split_square(middle * middle - 4 * lead * low)
        # the roots in increasing order; 2 lead t = -middle -+ square sqrt(radicand)
        side = 1 if (ray.root.index == 1) == (lead > 0) else -1
        root = Fraction(-middle, 2 * lead), Fraction(side * square, 2 * lead)
        point = [_at(entry, root, radicand) for entry in ray.entries]
        first = next(pair for pair in point if any(pair))
        return cls(radicand, tuple(_over(pair, first, radicand) for pair in point), ray)


def rational_point(ray: ExactRay) -> tuple[Fraction, ...] | None:
    """The point z of a ray that is rational; else None."""
    known = ray.root.root_class
    if known.degree != 1:
        return None
    root = Fraction(-known.polynomial[0], known.polynomial[1]), Fraction(0)
    return tuple(_at(entry, root, 0)[0] for entry in ray.entries)


def covering(
    rays: Iterable[ExactRay], missing: Iterable[Sequence[float]]
) -> tuple[QuadraticLine, ...] | None:
    """Lines over quadratic fields that cover all missing sign vectors; None if some is left."""
    lines = [line for line in map(QuadraticLine.of, rays) if line is not None]
    used: dict[int, None] = {}
    for signs in missing:
        place = next((k for k, line in enumerate(lines) if agree(line.ray.signs, signs)), None)
        if place is None:
            return None
        used[place] = None
    return tuple(lines[k] for k in used)


def agree(signs: Sequence[int], given: Sequence[float]) -> bool:
    """Whether a sign vector, or its opposite, agrees with signs where these are not 0."""
    pairs = [(s, e) for s, e in zip(signs, given, strict=True) if s]
    return all(s == e for s, e in pairs) or all(s == -e for s, e in pairs)


def split_square(number: int) -> tuple[int, int]:
    """A positive number as d s^2 with the largest s.

    >>> split_square(180)
    (5, 6)
    """
    free, square = 1, 1
    for prime, power in fmpz(number).factor():
        free *= int(prime) ** (power % 2)
        square *= int(prime) ** (power // 2)
    return free, square


def _at(entry: Sequence[Fraction], root: Pair, radicand: int) -> Pair:
    value = Fraction(0), Fraction(0)
    for c in reversed(entry):
        value = _times(value, root, radicand)
        value = value[0] + c, value[1]
    return value


def _times(one: Pair, other: Pair, radicand: int) -> Pair:
    (a, b), (c, d) = one, other
    return a * c + radicand * b * d, a * d + b * c


def _over(one: Pair, other: Pair, radicand: int) -> Pair:
    c, d = other
    norm = c * c - radicand * d * d
    return _times(one, (c / norm, -d / norm), radicand)
