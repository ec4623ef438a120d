"""Exact directions of edges, from angles that are multiples of pi plus multiples of free angles.

The direction of an edge is a vector along it, of any length. As a complex number it is a product:
one factor for the multiple of pi, with its tangent in a tower of square roots, and a power of
1 + i tan(t/q) for each free angle t, with a rational tangent.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, cos, gcd, hypot, lcm, sin
from typing import Final, TypeAlias

from exactfold.exact.surds import RATIONALS, Number, Surd, SurdField, rational
from exactfold.pattern.drawing.candidates import reduced_match
from exactfold.pattern.drawing.meant.values import Angles, Edge

Vector: TypeAlias = tuple[Surd, Surd]
_MOST_ROOTS: Final = 4
"""Towers with more square roots are not used for directions."""
_SURE: Final = 10.0
"""By so many bits a short number must beat chance."""
_ROUGH: Final = 2.0**-46
"""Where positions determine free angles, floats find them no better than so, in radians."""
_FINEST: Final = 2.0**-50
"""Floats hold free angles no better than so, in radians."""


def in_a_tower(parts: int) -> bool:
    """Whether all multiples of pi / `parts` have directions in a small tower of square roots.

    The tangent of pi / n is made of square roots if the odd part of n is a product of different
    Fermat primes; 3 and 5 are used here.

    >>> [n for n in range(1, 33) if in_a_tower(n)]
    [1, 2, 3, 4, 5, 6, 8, 10, 12, 15, 16, 20, 24, 30, 32]
    """
    return _roots(parts) is not None


class Directions:
    """Exact directions of edges, with coordinates in one field.

    `free` holds the values of the free angles, in radians. Each free angle becomes one with a
    tangent in the field, unless `fix` gave it a direction before it was used. The tangent is a
    short number that chance does not explain, within four times the `noise` of the value, or else a
    fraction far nearer to the value. If only a multiple of the angle has such a tangent, the field
    is extended by the square roots that halve it. Unless `recognise`, all are fractions.

    >>> edge = {(0, 1): Fraction(1, 8)}, {(0, 1): ((0, Fraction(1, 2)),)}
    >>> found = Directions(Angles(*edge, (0.2,)), (0.2,), 1e-6)
    >>> x, y = found.vector((0, 1))
    >>> round(float(y / x), 4), found.field.name
    (0.5369, 'Q(sqrt 2)')
    """

    def __init__(
        self, angles: Angles, free: Sequence[float], noise: float, *, recognise: bool = True
    ) -> None:
        self.angles, self.free, self.noise = angles, free, noise
        self._grid = _Grid(parts_of(angles))
        self.field = self._grid.field
        used: dict[int, list[Fraction]] = {}
        for terms in angles.coefficients.values():
            for k, coefficient in terms:
                used.setdefault(k, []).append(coefficient)
        self.scales = {k: lcm(*(c.denominator for c in each)) for k, each in used.items()}
        self._most = {k: max(map(abs, each)) for k, each in used.items()}
        self._fixed: dict[int, Vector] = {}
        self._short: dict[int, Vector] = {}
        self._whole: dict[int, tuple[int, int]] = {}
        self._vectors: dict[tuple[Fraction, tuple[tuple[int, Fraction], ...]], Vector] = {}
        for k in self.scales if recognise else ():
            self._recognise(k)

    def key(self, edge: Edge) -> tuple[Fraction, tuple[tuple[int, Fraction], ...]]:
        """What the direction of an edge depends on: edges with equal keys are parallel."""
        return self.angles.constants[edge] % 1, self.angles.coefficients.get(edge, ())

    def power(self, edge: Edge, k: int) -> int:
        """The power in which the direction of t / q stands in that of an edge; t has the number k.

        q clears the denominators of all coefficients of the free angle t.
        """
        coefficients = dict(self.angles.coefficients.get(edge, ()))
        return int(coefficients.get(k, Fraction(0)) * self.scales[k])

    def vector(self, edge: Edge) -> Vector:
        """A vector along an edge, in either sense."""
        key = self.key(edge)
        if key not in self._vectors:
            self._vectors[key] = self._without(edge, None)
        return self._vectors[key]

    def fix(self, k: int, edge: Edge, vector: Vector) -> None:
        """Give a free angle the value with which an edge has the direction of a vector.

        The angle must stand in the direction of the edge in the power 1 or -1.
        """
        x, y = self._without(edge, k)
        quotient = product(vector, (x, -y))
        if self.power(edge, k) < 0:
            quotient = quotient[0], -quotient[1]
        self._fixed[k] = with_a_one(quotient)

    def _without(self, edge: Edge, left_out: int | None) -> Vector:
        constant, terms = self.key(edge)
        whole = (1, 0)
        total = self._grid.direction(constant)
        for k, _ in terms:
            power = self.power(edge, k)
            if k == left_out:
                continue
            known = self._fixed.get(k) or self._short.get(k)
            if known is None:
                whole = _times(whole, _power(self._fraction(k), power))
                continue
            x, y = known
            for _ in range(abs(power)):
                total = product(total, (x, y if power > 0 else -y))
        return _turned(total, whole)

    def _noise(self, k: int) -> float:
        """The noise of a free angle over its q."""
        return self.noise / (max(ceil(self._most[k]), 1) * self.scales[k])

    def _recognise(self, k: int) -> None:
        """Find a short number for the tangent or cotangent of t / q, or of a multiple of it."""
        halvings = 0
        while self.scales[k] % (1 << halvings) == 0:
            angle = self.free[k] / self.scales[k] * (1 << halvings)
            slope, steep = _slope(angle)
            within = max(4 * self._noise(k) * (1 << halvings), _ROUGH)
            match = reduced_match(Fraction(slope), Fraction(within), self.field, _SURE)
            if match is not None:
                short, one = self.field.number(match.value), self.field.number(1)
                vector = (short, one) if steep else (one, short)
                self._halve(k, vector, angle, halvings)
                return
            halvings += 1

    def _halve(self, k: int, vector: Vector, angle: float, halvings: int) -> None:
        """Halve the angle of a vector several times, and take it for a free angle."""
        for _ in range(halvings):
            scale = lcm(*(int(c.q) for part in vector for c in part.parts))
            x, y = vector[0] * scale, vector[1] * scale
            square = x * x + y * y
            field = self.field.adjoined(square)
            length = field.square_root(square)
            if length is None or len(field.radicands) > _MOST_ROOTS:
                return
            self.field, angle = field, angle / 2
            # (x + length, y) has half the angle of (x, y), and (x - length, y) is at right angles
            half = [(x + length, field.number(y)), (x - length, field.number(y))]
            vector = with_a_one(min(half, key=lambda other: _off(other, angle)))
        self._short[k] = vector

    def _fraction(self, k: int) -> tuple[int, int]:
        """A Gaussian integer whose angle is that of t / q, nearly."""
        if k not in self._whole:
            slope, steep = _slope(self.free[k] / self.scales[k])
            near = _fraction(Fraction(slope), max(self._noise(k) / 100, _FINEST))
            p, q = near.numerator, near.denominator
            self._whole[k] = (p, q) if steep else (q, p)
        return self._whole[k]


def parts_of(angles: Angles) -> int:
    """The least n such that all constants are multiples of pi / n."""
    return lcm(*(c.denominator for c in angles.constants.values()))


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
                total = product(total, factor)
        return with_a_one(total)


def _with_root(field: SurdField, square: Number) -> tuple[SurdField, Surd]:
    """The field with the square root of a number that has none there, and this root."""
    field = field.adjoined(square)
    return field, field.root


def product(a: Vector, b: Vector) -> Vector:
    """The product of two vectors as complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def with_a_one(vector: Vector) -> Vector:
    """A multiple of a vector with a coordinate 1."""
    x, y = vector
    one = x.field.number(1)
    return (one, y / x) if abs(float(x)) >= abs(float(y)) else (x / y, one)


def _slope(angle: float) -> tuple[float, bool]:
    """The tangent of an angle, or its cotangent if that is smaller; whether it is the cotangent."""
    x, y = cos(angle), sin(angle)
    steep = abs(y) > abs(x)
    return (x / y if steep else y / x), steep


def _off(vector: Vector, angle: float) -> float:
    """The sine of the angle between a vector and an angle, without its sign."""
    x, y = float(vector[0]), float(vector[1])
    return abs(y * cos(angle) - x * sin(angle)) / max(hypot(x, y), _FINEST)


def _fraction(value: Fraction, within: float) -> Fraction:
    """A short fraction near a value.

    >>> _fraction(Fraction(1, 3), 0.1), _fraction(Fraction("0.46365"), 1e-4)
    (Fraction(1, 3), Fraction(51, 110))
    """
    limit = 1
    while abs((near := value.limit_denominator(limit)) - value) > within:
        limit *= 2
    return near


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
