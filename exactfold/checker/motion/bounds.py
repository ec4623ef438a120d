"""Newton's method along a curve: bounds that prove one zero near every point of the curve.

Let H(x, s) be quadratic in x, p(s) a polynomial, P any matrix, and |s| <= h. Let b, q and kappa
bound |P H(p(s), s)|, |1 - P DH(p(s), s)| and |P D2H(s)| in a maximum norm with weights. If
b + q r + kappa r^2 / 2 < r and q + kappa r < 1, then for each s exactly one zero of H lies within r
of p(s). For the map y -> y - P H(p(s) + y, s) takes the ball into itself and contracts it
(docs/motion.md, Theorem 1).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from operator import itemgetter, mul
from typing import NamedTuple

from ..core.reading import require

INVERSE_BITS = 40
WEIGHT_BITS = 16
LEAST_WEIGHT = (1 << WEIGHT_BITS) // 100
ROUND = 128  # binary places after the point of bounds
ONE = 1 << ROUND
Vector = list[int]
Columns = list[list[tuple[int, int]]]
"""A sparse matrix: for each column the pairs (row, entry) of the entries that are not 0."""

_RECIPROCAL_BITS = 96
ENOUGH = 1 / 64  # weights that change by less than this share are near enough as a rule
_MOST_ROUNDS = 30


class Rounded(NamedTuple):
    """A matrix with the entries x 2^`drop`, x in `rows`; each is off by less than 2^`drop`."""

    rows: Sequence[Sequence[int]]
    drop: int


class Bounds:
    """The bounds b, q and kappa as polynomials in h, given by their coefficients over 2^ROUND."""

    def __init__(self, b: Vector, q: Vector, kappa: Vector) -> None:
        self.b, self.q, self.kappa = b, q, kappa
        self._radii: dict[Fraction, Fraction] = {}

    def radius(self, h: Fraction) -> Fraction:
        """A radius r such that for every |s| <= h exactly one zero lies within r of p(s)."""
        if h not in self._radii:
            self._radii[h] = self._radius(h)
        return self._radii[h]

    def _radius(self, h: Fraction) -> Fraction:
        b, q, kappa = value(self.b, h), value(self.q, h), value(self.kappa, h)
        require(q < ONE, "a matrix is not near the inverse of the Jacobian along a tube")
        room = ONE - q
        r = (b << ROUND) // room
        r += (r * (2 * b * kappa // room) // room) + (r >> 60) + 2
        # b + q r + kappa r^2 / 2 < r and q + kappa r < 1, all multiplied by 2^(2 ROUND + 1).
        small = ((b - r) << ROUND + 1) + 2 * q * r + (kappa * r * r >> ROUND) + 1 < 0
        one = small and (q << ROUND) + kappa * r < ONE << ROUND
        require(one, "a tube does not hold one zero for each parameter")
        return Fraction(r, ONE)

    def uniqueness(self, h: Fraction) -> Fraction:
        """An R such that for every |s| <= h at most one zero lies within R of p(s)."""
        room = (ONE - value(self.q, h)) * 63 // 64
        return Fraction((room << ROUND) // value(self.kappa, h), ONE)

    def velocity(self, h: Fraction, r: Fraction) -> Fraction:
        """A bound of |x'(s) - p'(s)| for |s| <= h; it follows by differentiating H(x(s), s) = 0."""
        b, q, kappa = (value(derivative(c), h) for c in (self.b, self.q, self.kappa))
        radius = -(-r.numerator * ONE // r.denominator)
        slope = value(self.q, h) + up(value(self.kappa, h) * radius, ROUND)
        rate = b + up(q * radius, ROUND) + up(kappa * radius * radius, 2 * ROUND + 1)
        return Fraction(-(-(rate << ROUND) // (ONE - slope)), ONE)


def up(x: int, places: int) -> int:
    """x / 2^places, rounded up."""
    return -(-x >> places)


def value(coefficients: Sequence[int], h: Fraction) -> int:
    """The value of a polynomial with coefficients >= 0 at h >= 0, rounded up."""
    total, numerator, denominator = 0, h.numerator, h.denominator
    for c in reversed(coefficients):
        total = c - (-total * numerator // denominator)
    return total


def derivative(coefficients: Sequence[int]) -> Vector:
    """The coefficients of the derivative of a polynomial."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def bounds(
    p: list[Vector],
    images: Sequence[Vector],
    residual_bits: int,
    slopes: Sequence[Rounded],
    matrix_bits: int,
    squares: list[Vector],
    weights: Vector,
) -> Bounds:
    """The bounds for P = p / 2^INVERSE_BITS.

    The lists have one entry for each power s^k. `images[k]` is the coefficient of P H(p(s), s),
    over 2^(INVERSE_BITS + residual_bits). `slopes[k]` is that of P DH(p(s), s) - 1, over
    2^(INVERSE_BITS + matrix_bits). `squares[k]` bounds that of |D2H(y, z)| for |y|, |z| <= 1, over
    2^(2 WEIGHT_BITS); the equations after those in `squares` are linear.
    """
    reciprocals = [-((-1 << _RECIPROCAL_BITS + WEIGHT_BITS) // w) for w in weights]

    def norm_of(rows: Iterable[int], bits: int) -> int:
        """The maximum norm of a vector with entries >= 0 over 2^bits."""
        most = max(map(mul, rows, reciprocals))
        return up(most << ROUND, bits + _RECIPROCAL_BITS)

    b = [norm_of(map(abs, image), INVERSE_BITS + residual_bits) for image in images]
    q, spread = [], sum(weights)
    for rows, drop in slopes:
        sizes = [dot(map(abs, row), weights) + spread for row in rows]
        q.append(norm_of(sizes, INVERSE_BITS + matrix_bits + WEIGHT_BITS - drop))
    sizes_of_p = [[abs(x) for x in row] for row in p]
    kappa = [
        norm_of([dot(row, square) for row in sizes_of_p], INVERSE_BITS + 2 * WEIGHT_BITS)
        for square in squares
    ]
    return Bounds(b, q, kappa)


def norm(rows: Sequence[int], weights: Vector, bits: int) -> int:
    """The maximum norm with weights of a vector with entries >= 0 over 2^bits, rounded up.

    It is an integer over 2^ROUND.
    """
    most = max(-(-(x << 64) // w) for x, w in zip(rows, weights, strict=True))
    return up(most << WEIGHT_BITS + ROUND, bits + 64)


def dot(a: Iterable[int], b: Iterable[int]) -> int:
    """The scalar product of two vectors."""
    return sum(map(mul, a, b))


def product(p: list[Vector], columns: Columns) -> list[Vector]:
    """The product of P and a sparse matrix."""
    places = []
    for column in columns:
        # With further terms that are 0, `itemgetter` gives a tuple even for a single entry.
        entries = column if len(column) > 1 else [(0, 0), (0, 0), *column]
        at, values = zip(*entries, strict=True)
        places.append((itemgetter(*at), values))
    return [[sum(map(mul, at(row), values)) for at, values in places] for row in p]


def less_one(matrix: list[Vector], one: int) -> list[Vector]:
    """The matrix, from which `one` is subtracted on the diagonal."""
    for i, row in enumerate(matrix):
        row[i] -= one
    return matrix


def weights_of(matrix: list[list[float]], enough: float = 0.0) -> Vector:
    """Positive weights over 2^WEIGHT_BITS, near the Perron vector of a matrix with entries >= 0.

    The vector is improved until it changes by less than the share `enough`, but not for ever.
    """
    vector = [1.0] * len(matrix)
    for _ in range(_MOST_ROUNDS):
        image = [sum(map(mul, row, vector)) for row in matrix]
        top = max(max(image), 1e-300)
        after = [x + y / top for x, y in zip(vector, image, strict=True)]
        top = max(after)
        after = [x / top for x in after]
        change = max(abs(x - y) - enough * y for x, y in zip(vector, after, strict=True))
        vector = after
        if change < 0:
            break
    return [max(LEAST_WEIGHT, int(x * 2**WEIGHT_BITS)) for x in vector]
