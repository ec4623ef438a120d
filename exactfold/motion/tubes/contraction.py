"""The numbers that prove a curve of zeros near a polynomial curve, exact or rounded upwards.

The equations H(x, s) = 0 are quadratic in x. Let p(s) be a predictor and P any matrix. The map y ->
y - P H(p(s) + y, s) is studied in a weighted maximum norm (docs/motion.md, Theorem 1).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import isqrt
from typing import Any

import numpy as np

from exactfold._support.arrays import BigArray, FloatArray, IndexArray, IntArray
from exactfold.motion.curves.coupling import Coupling

SCALE = 128
"""The numbers of a `Contraction`, and all arguments of it, are integers over 2^SCALE."""

ONE = 1 << SCALE
INVERSE_BITS = 40
"""The matrix P is rounded to multiples of 2^-INVERSE_BITS."""

_COARSE = 16  # products with small matrices drop this many bits of P

WEIGHT_BITS = 16
_WORD = 62
_SHORTEST = 14


@dataclass(frozen=True, repr=False)
class Contraction:
    """Bounds for |s| <= h: residual b(h), slope q(h), quadratic part kappa(h), polynomials in h.

    In the norm |y| = max |y_i| / w_i they satisfy b(h) >= |P H(p(s), s)|, q(h) >= |1 - P DH(p(s),
    s)| and kappa(h) >= |P D2H(s)|. Theorem 1: if b + q r + kappa r^2 / 2 < r and q + kappa r < 1,
    then for every |s| <= h there is exactly one zero x(s) with |x(s) - p(s)| <= r. It is regular
    and depends analytically on s. If q + kappa R < 1, two zeros within R of p(s) are equal.
    """

    residual: tuple[int, ...]
    slope: tuple[int, ...]
    quadratic: tuple[int, ...]

    def radius(self, reach: int) -> int | None:
        """A radius r that satisfies Theorem 1 and is nearly the smallest; None if none is found.

        >>> half = ONE >> 1
        >>> Contraction((1,), (half,), (0,)).radius(ONE)
        4
        >>> Contraction((1,), (ONE,), (0,)).radius(ONE) is None
        True
        """
        b, q, kappa = (polynomial(c, reach) for c in (self.residual, self.slope, self.quadratic))
        if q >= ONE:
            return None
        # r is the smaller root of b - (1 - q) r + kappa r^2 / 2, slightly enlarged.
        room = ONE - q
        square = room * room - 2 * kappa * b
        if square <= 0:
            return None
        r = (2 * b << SCALE) // (room + isqrt(square))
        r += (r >> 16) + 2
        # Check b + q r + kappa r^2 / 2 < r and q + kappa r < 1 in exact integers.
        quadratic = kappa * r
        if ((b - r) << (SCALE + 1)) + 2 * q * r + (quadratic * r >> SCALE) + 1 >= 0:
            return None
        return r if (q << SCALE) + quadratic < 1 << 2 * SCALE else None

    def uniqueness(self, reach: int) -> int:
        """A radius R within which zeros are unique for |s| <= reach; 0 if none is known."""
        q, kappa = polynomial(self.slope, reach), polynomial(self.quadratic, reach)
        room = ONE - q - (ONE >> 6)
        return (room << SCALE) // kappa if room > 0 and kappa else 0

    def velocity(self, reach: int, radius: int) -> int:
        """A bound of |x'(s) - p'(s)| for |s| <= reach, where x(s) is within `radius` of p(s).

        The bound is (b' + q' r + kappa' r^2 / 2) / (1 - q - kappa r).
        """
        b, q, kappa = (
            polynomial(derivative(c), reach) for c in (self.residual, self.slope, self.quadratic)
        )
        return self._over(b, q, kappa, reach, radius)

    def drift(self, reach: int, radius: int) -> int:
        """A bound of the integral of |x'(s) - p'(s)| over 0 <= s <= reach.

        `radius` is that of `velocity`. The integral of the numerator of `velocity` is the
        difference of its polynomials at the reach and at 0. The denominator is least at the reach.
        """
        b, q, kappa = (
            polynomial((0, *c[1:]), reach) for c in (self.residual, self.slope, self.quadratic)
        )
        return self._over(b, q, kappa, reach, radius)

    def _over(self, b: int, q: int, kappa: int, reach: int, radius: int) -> int:
        """(b + q r + kappa r^2 / 2) / (1 - q(h) - kappa(h) r), rounded up."""
        top = b + up(q * radius, SCALE) + up(kappa * radius * radius, 2 * SCALE + 1)
        bottom = ONE - polynomial(self.slope, reach)
        bottom -= up(polynomial(self.quadratic, reach) * radius, SCALE)
        return -((-top << SCALE) // bottom)

    def __repr__(self) -> str:
        b, q, kappa = (c[0] / ONE for c in (self.residual, self.slope, self.quadratic))
        return f"<Contraction: residual {b:.1e}, slope {q:.1e}, quadratic {kappa:.1e}>"


def up(value: int, shift: int) -> int:
    """value / 2^shift, rounded up."""
    return -(-value >> shift)


def polynomial(coefficients: Sequence[int], at: int) -> int:
    """The value of a polynomial with nonnegative coefficients at a nonnegative number,
    rounded up.
    """
    total = 0
    for c in reversed(coefficients):
        total = c - (-total * at >> SCALE)  # `up`, in the innermost loop
    return total


def derivative(coefficients: Sequence[int]) -> list[int]:
    """The coefficients of the derivative of a polynomial."""
    return [k * c for k, c in enumerate(coefficients)][1:]


Whole = IntArray | BigArray


@dataclass(frozen=True, repr=False)
class Places:
    """The ends of the edges at free vertices, sorted by vertex, with their signs +-1.

    Given a row v_e for every edge, they describe the matrix that takes y to v_e . (y_i - y_j).
    """

    size: int
    vertex: IndexArray
    edge: IndexArray
    sign: IndexArray

    def dense(self, rows: Any) -> Any:
        """The matrix that the rows describe, shape (edges, size)."""
        matrix = np.zeros((len(rows), self.size), dtype=rows.dtype)
        columns = 3 * self.vertex[:, None] + np.arange(3)
        matrix[self.edge[:, None], columns] = self.sign[:, None] * rows[self.edge]
        return matrix

    def product(self, left: Any, rows: Any) -> Any:
        """left @ dense(rows), computed without the zeros; `rows` may have shape (..., edges, 3)."""
        weighted = self.sign[:, None] * rows[..., self.edge, :]
        taken = left[:, self.edge]
        product = np.empty(
            (*rows.shape[:-2], len(left), self.size), dtype=np.result_type(left, rows)
        )
        for a in range(3):
            products = taken * weighted[..., None, :, a]
            product[..., a::3] = np.add.reduceat(products, self._starts, axis=-1)
        return product

    @cached_property
    def _starts(self) -> IndexArray:
        return np.flatnonzero(np.diff(self.vertex, prepend=-1))

    @cached_property
    def most(self) -> int:
        """The largest number of edges at a vertex."""
        return int(np.bincount(self.vertex).max())

    def __repr__(self) -> str:
        return f"<Places: {len(self.edge)} ends of edges, {self.size} unknowns>"


def contraction(
    inverse: FloatArray,
    residuals: Sequence[Sequence[int]],
    residual_bits: int,
    places: Places,
    coupling: Coupling,
    rows: Sequence[BigArray],
    linear: Sequence[Sequence[int]],
    row_bits: int,
    squares: Sequence[Sequence[int]],
    sums: BigArray,
    weights: Sequence[int],
) -> Contraction:
    """The bounds for P, which is `inverse` rounded. Everything is exact or rounded upwards.

    `residuals[k]` is the coefficient of s^k of H(p(s), s), in integers over 2^`residual_bits`.
    `rows[k]` are the vectors of the bars in the coefficient of s^k of DH(p(s), s); the `coupling`
    turns them into equations. `linear` are the rows of DH after these, for k = 0 only. Both are
    integers over 2^`row_bits`. The positive `weights` are over 2^WEIGHT_BITS. `sums` contains w_i +
    w_j for the three coordinates of every bar (i, j), shape (bars, 3). `squares[k]` bounds the
    coefficient of s^k of D2H(y, z) for |y|, |z| <= 1, over 2^(2 WEIGHT_BITS).
    """
    n = len(weights)
    p = _whole(inverse)
    on_bars = _on_bars(p, coupling, len(sums))
    size = np.asarray(abs(on_bars))
    size[:, len(sums) - len(coupling.diagonals) :] += 1

    def norm(rows: Sequence[int], bits: int) -> int:
        """The maximum of rows_i / w_i over 2^SCALE, for rows over 2^bits."""
        shift = SCALE + WEIGHT_BITS - bits
        left, right = max(shift, 0), max(-shift, 0)
        return max(-(-(row << left) // (w << right)) for row, w in zip(rows, weights, strict=True))

    # The first product nearly cancels and is exact. In the other products P and the rows are
    # rounded so that they fit machine words; `off` and `spread` bound the effect of half a unit in
    # the rows and in P.
    coarse = _coarse(on_bars)
    off = _above(size, [int(x) for x in sums.sum(axis=1)])
    room = _WORD - _largest(coarse).bit_length() - places.most.bit_length()
    lines = np.array(linear, dtype=object)
    product = _product(on_bars, places, rows[0]) + _dot(p[:, n - len(lines) :], lines)
    product[np.diag_indices(n)] -= 1 << INVERSE_BITS + row_bits
    mixed = _of_diagonals(coupling, rows, sums)
    slope = [
        norm(
            [x + mixed[0] for x in _above(np.asarray(abs(product)), weights)],
            INVERSE_BITS + row_bits + WEIGHT_BITS,
        )
    ]
    if len(rows) > 1:
        drops = [max(0, _largest(v).bit_length() - room) if room > _SHORTEST else 0 for v in rows]
        nearest = np.array(
            [(v + (1 << drop >> 1)) >> drop for v, drop in zip(rows, drops, strict=True)][1:]
        )
        images = np.asarray(abs(_product(coarse, places, nearest)))
        # No array here: numpy turns integers on both sides of 2^63 into floats.
        whole = _above(images.reshape(-1, n), weights)
        above = [whole[k : k + n] for k in range(0, len(whole), n)]
        spreads = (abs(nearest) * sums).sum(axis=(1, 2)).tolist()
        for image, spread, drop, more in zip(above, spreads, drops[1:], mixed[1:], strict=True):
            sizes = [
                ((2 * x + int(spread)) << drop + _COARSE) + (y << drop if drop else 0) + 2 * more
                for x, y in zip(image, off, strict=True)
            ]
            slope.append(norm(sizes, INVERSE_BITS + row_bits + WEIGHT_BITS + 1))
    quadratic = [norm(_above(size, square), INVERSE_BITS + 2 * WEIGHT_BITS) for square in squares]
    residual = [
        norm(bounds, INVERSE_BITS + residual_bits + 1) for bounds in _twice_images(p, residuals)
    ]
    return Contraction(tuple(residual), tuple(slope), tuple(quadratic))


def _twice_images(p: Whole, residuals: Sequence[Sequence[int]]) -> Iterator[list[int]]:
    """Twice the upper bounds of |P g| for each residual g.

    A single residual, that of a point, is treated exactly, because the point may be next to a
    branch point, where P is large. For several residuals, P is rounded by _COARSE bits, and floors
    replace nearest integers.
    """
    if len(residuals) == 1:
        exact = abs(p.astype(object) @ np.array([int(x) for x in residuals[0]], dtype=object))
        yield [2 * int(x) for x in exact]
        return
    coarse, size, n = _coarse(p), np.asarray(abs(p)), len(p)
    spare = max(_WORD - _largest(coarse).bit_length() - n.bit_length(), _SHORTEST)
    shifts = [max(0, max(map(int.bit_length, g)) - spare) for g in residuals]
    short = [[x >> shift for x in g] for g, shift in zip(residuals, shifts, strict=True)]
    images = np.asarray(abs(_dot(coarse, np.array(short, dtype=object).T))).T.tolist()
    rest = _above(size, [1] * n)
    for image, g, shift in zip(images, short, shifts, strict=True):
        spread = sum(map(abs, g))
        yield [
            (((2 * x + spread) << _COARSE) + (2 * y if shift else 0)) << shift
            for x, y in zip(image, rest, strict=True)
        ]


def _on_bars(p: Whole, coupling: Coupling, bars: int) -> Whole:
    """The columns of P for the bars: those of edges, and through the coupling those of diagonals.

    The columns of diagonals are rounded, with errors of less than one unit.
    """
    if not coupling.diagonals:
        return p[:, :bars]
    edges = bars - len(coupling.diagonals)
    own = p[:, edges : edges + len(coupling.rows)].astype(object)
    mixed = (own @ np.array(coupling.rows, dtype=object)) >> coupling.bits
    if _largest(mixed) < 1 << _WORD:
        mixed = mixed.astype(p.dtype)
    return np.concatenate([p[:, :edges], mixed], axis=1)


def _of_diagonals(coupling: Coupling, rows: Sequence[BigArray], sums: BigArray) -> list[int]:
    """The effect on the product of one unit in the columns of P for diagonals, for each
    of `rows`.
    """
    at = len(sums) - len(coupling.diagonals)
    return [int((abs(row[at:]) * sums[at:]).sum()) for row in rows]


def _coarse(p: Whole) -> Whole:
    return (p + (1 << (_COARSE - 1))) >> _COARSE


def _whole(inverse: FloatArray) -> Whole:
    """The nearest integers over 2^INVERSE_BITS."""
    rounded = np.rint(inverse * 2.0**INVERSE_BITS)
    if np.abs(rounded).max(initial=0.0) < 2.0**_WORD:
        return rounded.astype(np.int64)
    return np.array([[int(x) for x in row] for row in rounded], dtype=object)


def _largest(array: Whole) -> int:
    return int(abs(array).max(initial=0))


def _dot(a: Whole, b: Whole) -> Whole:
    """The exact product, in machine words if these can hold all sums."""
    if _largest(a) * _largest(b) * a.shape[1] < 1 << _WORD:
        return np.asarray(a.astype(np.int64) @ b.astype(np.int64))
    return np.asarray(a.astype(object) @ b.astype(object))


def _product(p: Whole, places: Places, rows: Whole) -> Whole:
    """The exact product of P and the matrix of the rows, computed as in `_dot`."""
    p = p[:, : rows.shape[-2]]
    if _largest(p) * _largest(rows) * places.most < 1 << _WORD:
        return np.asarray(places.product(p.astype(np.int64), rows.astype(np.int64)))
    return np.asarray(places.product(p.astype(object), rows.astype(object)))


def _above(a: Whole, v: Sequence[int]) -> list[int]:
    """Upper bounds of a @ v for nonnegative entries."""
    largest = _largest(a)
    excess = (largest * sum(v)).bit_length() - _WORD
    if excess <= 0:
        bounds = a.astype(np.int64) @ np.array(v, dtype=np.int64)
        return [int(x) for x in bounds]
    if largest >> (excess + 2):  # the shifted entries fit
        return [x << (excess + 2) for x in _above((a >> (excess + 2)) + 1, v)]
    return [int(x) for x in a.astype(object) @ np.array(v, dtype=object)]
