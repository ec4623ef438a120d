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
from operator import mul

from ..core.reading import require

INVERSE_BITS = 40
WEIGHT_BITS = 16
LEAST_WEIGHT = (1 << WEIGHT_BITS) // 100
ROUND = 128  # binary places after the point of bounds
Vector = list[int]
Columns = list[list[tuple[int, int]]]
"""A sparse matrix: for each column the pairs (row, entry) of the entries that are not 0."""


class Bounds:
    """The bounds b, q and kappa as polynomials in h, given by their coefficients."""

    def __init__(self, b: list[Fraction], q: list[Fraction], kappa: list[Fraction]) -> None:
        self.b, self.q, self.kappa = b, q, kappa

    def radius(self, h: Fraction) -> Fraction:
        """A radius r such that for every |s| <= h exactly one zero lies within r of p(s)."""
        b, q, kappa = value(self.b, h), value(self.q, h), value(self.kappa, h)
        require(q < 1, "a matrix is not near the inverse of the Jacobian along a tube")
        r = rounded(b / (1 - q) * (1 + 2 * b * kappa / (1 - q) ** 2), 60) + Fraction(1, 1 << ROUND)
        one = b + q * r + kappa * r * r / 2 < r and q + kappa * r < 1
        require(one, "a tube does not hold one zero for each parameter")
        return r

    def uniqueness(self, h: Fraction) -> Fraction:
        """An R such that for every |s| <= h at most one zero lies within R of p(s)."""
        room = (1 - value(self.q, h)) * Fraction(63, 64)
        return -rounded(-room / value(self.kappa, h), 60)

    def velocity(self, h: Fraction, r: Fraction) -> Fraction:
        """A bound of |x'(s) - p'(s)| for |s| <= h; it follows by differentiating H(x(s), s) = 0."""
        b, q, kappa = (value(derivative(c), h) for c in (self.b, self.q, self.kappa))
        slope = value(self.q, h) + value(self.kappa, h) * r
        return rounded((b + q * r + kappa * r * r / 2) / (1 - slope), 60)


def value(coefficients: Sequence[Fraction], h: Fraction) -> Fraction:
    """The value of a polynomial at h, rounded up."""
    total = Fraction(0)
    for c in reversed(coefficients):
        total = total * h + c
    return rounded(total, ROUND)


def derivative(coefficients: Sequence[Fraction]) -> list[Fraction]:
    """The coefficients of the derivative of a polynomial."""
    return [k * c for k, c in enumerate(coefficients)][1:]


def rounded(x: Fraction, places: int) -> Fraction:
    """x rounded up to `places` binary places; if x < 1, zeros after the point are not counted."""
    places += max(0, x.denominator.bit_length() - abs(x.numerator).bit_length())
    return Fraction(-(-(x.numerator << places) // x.denominator), 1 << places)


def bounds(
    p: list[Vector],
    residuals: list[Vector],
    residual_bits: int,
    matrices: list[list[Vector]],
    matrix_bits: int,
    squares: list[Vector],
    weights: Vector,
) -> Bounds:
    """The bounds for P = p / 2^INVERSE_BITS.

    The lists have one entry for each power s^k. `residuals[k]` is the coefficient of H(p(s), s),
    over 2^residual_bits. `matrices[k]` is that of P DH(p(s), s), over
    2^(INVERSE_BITS + matrix_bits). `squares[k]` bounds that of |D2H(y, z)| for |y|, |z| <= 1, over
    2^(2 WEIGHT_BITS).
    """
    n = len(p)
    linear = [0] * n  # the second derivatives of the equations after those in `squares`
    one = 1 << INVERSE_BITS + matrix_bits
    for i in range(n):
        matrices[0][i][i] -= one

    sizes = [[abs(x) for x in row] for row in p]
    b = [
        norm([abs(dot(row, g)) for row in p], weights, INVERSE_BITS + residual_bits)
        for g in residuals
    ]
    q = [
        norm(
            [dot(map(abs, row), weights) for row in matrix],
            weights,
            INVERSE_BITS + matrix_bits + WEIGHT_BITS,
        )
        for matrix in matrices
    ]
    kappa = [
        norm(
            [dot(row, [*square, *linear[len(square) :]]) for row in sizes],
            weights,
            INVERSE_BITS + 2 * WEIGHT_BITS,
        )
        for square in squares
    ]
    return Bounds(*([rounded(x, ROUND) for x in part] for part in (b, q, kappa)))


def norm(rows: Sequence[int], weights: Vector, bits: int) -> Fraction:
    """The maximum norm with weights of a vector with entries >= 0 over 2^bits, rounded up."""
    most = max(-(-(x << 64) // w) for x, w in zip(rows, weights, strict=True))
    return Fraction(most << WEIGHT_BITS, 1 << bits + 64)


def dot(a: Iterable[int], b: Iterable[int]) -> int:
    """The scalar product of two vectors."""
    return sum(map(mul, a, b))


def product(p: list[Vector], columns: Columns) -> list[Vector]:
    """The product of P and a sparse matrix."""
    places = [([e for e, _ in column], [x for _, x in column]) for column in columns]
    return [[sum(map(mul, [row[e] for e in at], values)) for at, values in places] for row in p]


def weights_of(matrix: list[list[float]]) -> Vector:
    """Positive weights over 2^WEIGHT_BITS, near the Perron vector of a matrix with entries >= 0."""
    vector = [1.0] * len(matrix)
    for _ in range(30):
        image = [sum(map(mul, row, vector)) for row in matrix]
        top = max(max(image), 1e-300)
        vector = [x + y / top for x, y in zip(vector, image, strict=True)]
        top = max(vector)
        vector = [x / top for x in vector]
    return [max(LEAST_WEIGHT, int(x * 2**WEIGHT_BITS)) for x in vector]
