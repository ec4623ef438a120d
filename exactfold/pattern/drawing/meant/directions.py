"""Exact directions of edges, from angles that are multiples of pi plus multiples of free angles.

The direction of an edge is a vector along it, of any length. As a complex number it is a product:
one factor for the multiple of pi, with its tangent in a tower of square roots, and a power of
1 + i tan(t/q) for each free angle t, with a rational tangent.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import cos, gcd, lcm, sin
from typing import Final, TypeAlias

from exactfold.exact.surds import RATIONALS, Number, Surd, SurdField, rational
from exactfold.pattern.drawing.meant.values import Angles, Edge

Vector: TypeAlias = tuple[Surd, Surd]
_MOST_ROOTS: Final = 4
"""Towers with more square roots are not used for directions."""
_FINEST: Final = 2.0**-50
"""Floats hold free angles no better than so, in radians."""


@dataclass(frozen=True)
class Directions:
    """A vector along each edge, with coordinates in one field."""

    field: SurdField
    vectors: Mapping[Edge, Vector]


def in_a_tower(parts: int) -> bool:
    """Whether all multiples of pi / `parts` have directions in a small tower of square roots.

    The tangent of pi / n is made of square roots if the odd part of n is a product of different
    Fermat primes; 3 and 5 are used here.

    >>> [n for n in range(1, 33) if in_a_tower(n)]
    [1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 30, 32]
    """
    return _roots(parts) is not None


def exact_directions(angles: Angles, tolerance: float) -> Directions | None:
    """The directions of all edges, with free angles within `tolerance` (radians) of their values.

    None if multiples of pi among the angles have directions in no small tower of square roots.

    >>> edge = {(0, 1): Fraction(1, 8)}, {(0, 1): ((0, Fraction(1, 2)),)}
    >>> found = exact_directions(Angles(*edge, (0.2,)), 1e-3)
    >>> [round(float(y / x), 4) for x, y in found.vectors.values()], found.field.name
    ([0.5364], 'Q(sqrt 2)')
    """
    parts = lcm(*(c.denominator for c in angles.constants.values()))
    if not in_a_tower(parts):
        return None
    grid = _Grid(parts)
    free = _free_factors(angles, tolerance)
    vectors = {}
    for edge, constant in angles.constants.items():
        whole = (1, 0)
        for k, coefficient in angles.coefficients.get(edge, ()):
            scale, factor = free[k]
            whole = _times(whole, _power(factor, int(coefficient * scale)))
        vectors[edge] = _turned(grid.direction(constant), whole)
    return Directions(grid.field, vectors)


def cross(a: Vector, b: Vector) -> Surd:
    """The cross product of two vectors."""
    return a[0] * b[1] - a[1] * b[0]


def _roots(parts: int) -> int | None:
    """The number of square roots that the tangents of pi / `parts` need; None if too many."""
    power = (parts & -parts).bit_length() - 1
    odd = parts >> power
    if 15 % odd:
        return None
    count = max(power - 2, 0) + (odd % 3 == 0) + 2 * (odd % 5 == 0)
    return count if count <= _MOST_ROOTS else None


class _Grid:
    """The directions of all multiples of pi / `parts`, in the tower of the tangents they need."""

    def __init__(self, parts: int) -> None:
        self.parts = parts
        self.known: dict[Fraction, Vector] = {}
        field = RATIONALS
        tangents: dict[int, Number] = {}
        power = parts & -parts
        tangent: Number = 1
        for _ in range(power.bit_length() - 3):  # from pi/4 to pi/8, pi/16, ...
            field, root = _with_root(field, 1 + tangent * tangent)
            tangent = (root - 1) / tangent
        if power > 2:
            tangents[power] = tangent
        if parts % 3 == 0:
            field, tangents[3] = _with_root(field, 3)
        if parts % 5 == 0:
            field, root = _with_root(field, 5)
            field, tangents[5] = _with_root(field, 5 - 2 * root)
        self.field = field
        one = field.number(1)
        self.factors = {q: (one, field.number(t)) for q, t in tangents.items()}
        if power == 2:
            self.factors[2] = (field.number(0), one)
        elif power == 4:
            self.factors[4] = (one, one)

    def direction(self, constant: Fraction) -> Vector:
        """A vector at the angle pi times the constant; its larger coordinate is 1 or -1."""
        constant %= 1
        if constant not in self.known:
            self.known[constant] = self._made(constant)
        return self.known[constant]

    def _made(self, constant: Fraction) -> Vector:
        total = (self.field.number(1), self.field.number(0))
        steps = int(constant * self.parts)
        for q, factor in self.factors.items():
            # modulo 1, the constant is the sum of share / q over all prime powers q of the grid
            share = steps * pow(self.parts // q, -1, q) % q
            for _ in range(share):
                total = _product(total, factor)
        x, y = total
        if abs(float(x)) >= abs(float(y)):
            return self.field.number(1), y / x
        return x / y, self.field.number(1)


def _with_root(field: SurdField, square: Number) -> tuple[SurdField, Surd]:
    """The field with the square root of a number that has none there, and this root."""
    field = field.adjoined(square)
    return field, field.root


def _product(a: Vector, b: Vector) -> Vector:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _free_factors(angles: Angles, tolerance: float) -> dict[int, tuple[int, tuple[int, int]]]:
    """For each free angle t: q, and a Gaussian integer whose angle is nearly t / q.

    q clears the denominators of all coefficients of t.
    """
    used: dict[int, list[Fraction]] = {}
    for terms in angles.coefficients.values():
        for k, coefficient in terms:
            used.setdefault(k, []).append(coefficient)
    factors = {}
    for k, coefficients in used.items():
        scale = lcm(*(c.denominator for c in coefficients))
        most = max(abs(c) * scale for c in coefficients)
        within = Fraction(max(tolerance, _FINEST)) / max(int(most), 1)
        factors[k] = scale, _gaussian(angles.free[k] / scale, within)
    return factors


def _gaussian(angle: float, within: Fraction) -> tuple[int, int]:
    """A short Gaussian integer whose angle, modulo pi, is nearly the given one.

    >>> _gaussian(0.5, Fraction(1, 1000)), _gaussian(2.0, Fraction(1, 1000))
    ((11, 6), (-11, 24))
    """
    x, y = cos(angle), sin(angle)
    steep = abs(y) > abs(x)
    slope = Fraction(x / y if steep else y / x)
    limit = 1
    while abs((near := slope.limit_denominator(limit)) - slope) > within:
        limit *= 2
    p, q = near.numerator, near.denominator
    return (p, q) if steep else (q, p)


def _power(factor: tuple[int, int], exponent: int) -> tuple[int, int]:
    if exponent < 0:
        factor, exponent = (factor[0], -factor[1]), -exponent
    total = (1, 0)
    for _ in range(exponent):
        total = _times(total, factor)
    return total


def _times(a: tuple[int, int], b: tuple[int, int]) -> tuple[int, int]:
    x, y = a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]
    common = gcd(x, y)
    return x // common, y // common


def _turned(direction: Vector, whole: tuple[int, int]) -> Vector:
    """The product of a direction of the grid and a Gaussian integer; coprime integers in Q."""
    x, y = direction
    p, q = whole
    u, v = x * p - y * q, x * q + y * p
    if x.field.radicands:
        return u, v
    a, b = rational(u), rational(v)
    scale = lcm(a.denominator, b.denominator)
    a, b = a * scale, b * scale
    common = gcd(int(a), int(b))
    return x.field.number(a / common), x.field.number(b / common)
