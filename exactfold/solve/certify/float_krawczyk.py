r"""Krawczyk's test on many candidates at once, in floats with bounded rounding errors.

Notation: u = 2^-53, gamma_k = k u / (1 - k u), and |.| is entrywise. A holds the doubles nearest to
the exact coefficients S, where a power of two scales each quadric to at most 1. The candidate m
consists of doubles and counts as exact; z = (m, 1). Y is any matrix of doubles, and
F_p = (1/2) z^T S_p z. A dot product of k terms, summed in any order, with or without fused
operations, has an error of at most gamma_k |a| . |b| (Higham, Accuracy and Stability of Numerical
Algorithms, section 3.1); matrix products consist of dot products. Let G = |A| |z|, with the row G_p
for quadric p, and H_p = G_p . |z|. Then

    gradients   J = fl(A z):    |J - F'(m)|   <= gamma_{n+2} G    (n + 1 terms; |A - S| <= u |S|)
    product     P = fl(Y J):    |P - Y J|     <= gamma_n |Y| |J| <= gamma_{2n+1} |Y| G
    so, with    R = fl(P - I):  |I - Y F'(m)| <= (1 + u) |R| + gamma_{3n+3} |Y| G
    values      f = fl(J z/2):  |f - F(m)|    <= (1/2) gamma_{3n+4} H
    product     w = fl(Y f):    |w - Y F(m)|  <= gamma_{3n+4} |Y| H

All gammas on the right are at most c = 3 (n + 3) u. The bounds themselves (|Y| G, |Y| H, sums of
|R|, |Y| times Hessian norms) are sums of non-negative terms. They are computed with a relative
error below 2^-30 for n <= 1024, which the factor 1 + 2^-20 covers. Underflow adds less than 2^-500,
which is added to the bounds. This holds because |z| <= 2^100, |Y| <= 2^300 and nonzero coefficients
are at least 2^-900; the code checks all three. Then nothing overflows, and a NaN fails every
comparison.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exactfold._support.arrays import BoolArray, FloatArray, IntArray
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox

UNPROVED = -1
"""The radius exponent of a candidate for which nothing was proved."""

_U = 2.0**-53
_UP = 1.0 + 2.0**-20
_TINY = 2.0**-500
_MOST_Z, _MOST_Y, _MOST_BITS, _MOST_UNKNOWNS = 2.0**100, 2.0**300, 900, 1024
_INTEGERS = 2.0**52
_CONTRACTION, _SHARE = 0.75, 8.0
_CHUNK = 256


@dataclass(frozen=True)
class FloatBoxes:
    """Boxes |x - center / 2^bits| <= 2^exponent / 2^bits, one row for each candidate.

    If the exponent is not `UNPROVED`, the box contains exactly one zero, a regular one.
    """

    bits: int
    centers: IntArray
    exponents: IntArray

    @property
    def proved(self) -> BoolArray:
        """Which rows are proved; a row whose centre is not exactly a double never is."""
        most = int(_INTEGERS)
        exact = ((self.centers < most) & (self.centers > -most)).all(axis=1)
        return np.asarray((self.exponents != UNPROVED) & exact)

    @property
    def points(self) -> FloatArray:
        """The centres as doubles, exactly (they have at most 52 bits)."""
        return np.asarray(np.ldexp(self.centers.astype(np.float64), -self.bits))

    @property
    def radii(self) -> FloatArray:
        """The radii as doubles, exactly."""
        return np.asarray(np.ldexp(1.0, (self.exponents - self.bits).astype(np.intc)))

    def box(self, row: int) -> IsolatingBox:
        """The box of a proved row."""
        radius = 1 << int(self.exponents[row])
        return IsolatingBox(tuple(self.centers[row].tolist()), (), radius, self.bits)


@dataclass(frozen=True)
class FloatKrawczyk:
    """The test of `krawczyk` for one system, in floats; the module states the error bounds.

    A failure says nothing about zeros: the exact test may still pass.

    >>> test = FloatKrawczyk(QuadraticSystem.from_rational([[[1, 0], [0, -2]]]))
    >>> boxes = test.isolate(np.array([[1.4142135623731], [1.5]]), bits=40)
    >>> boxes.proved.tolist(), boxes.exponents.tolist()
    ([True, True], [2, 40])
    """

    system: QuadraticSystem

    @cached_property
    def _stack(self) -> FloatArray | None:
        """A with the shape (n (n + 1), n + 1); None if the test does not apply."""
        if not 0 < self.system.size <= _MOST_UNKNOWNS:
            return None
        blocks = [scaled_rows(matrix) for matrix in self.system.matrices]
        usable = [block for block in blocks if block is not None]
        return np.vstack(usable) if len(usable) == len(blocks) else None

    @cached_property
    def _absolute(self) -> tuple[FloatArray, FloatArray]:
        """|A|, and the sums over j, k of |(H_p)_jk|, for each p."""
        n = self.system.size
        absolute = np.abs(self._stack if self._stack is not None else np.zeros((n * n + n, n + 1)))
        return absolute, absolute.reshape(n, n + 1, n + 1)[:, :n, :n].sum(axis=(1, 2))

    def isolate(self, points: FloatArray, bits: int) -> FloatBoxes:
        """A box around each candidate; `points` has shape (m, n), centres have `bits` bits.

        Radii are powers of two and larger than necessary, so that another Y proves the boxes too.
        """
        with np.errstate(all="ignore"):
            scaled = np.rint(np.ldexp(points, bits))
            fits = np.asarray((np.abs(scaled) < _INTEGERS).all(axis=1))  # false for NaN
            centers = np.where(fits[:, None], scaled, 0.0).astype(np.int64)
            eta, k0, bound = self._bounds(np.asarray(np.ldexp(centers.astype(np.float64), -bits)))
            usable = fits & (eta < 2.0**60)
            least = np.ldexp(_SHARE * np.where(usable, eta, 1.0), bits)
            exponents = np.maximum(np.frexp(least)[1], 0).astype(np.int64)
            radii = np.ldexp(1.0, (exponents - bits).astype(np.intc))
            passed = usable & ((k0 + radii * bound) * _UP <= _CONTRACTION)
        return FloatBoxes(bits, centers, np.where(passed, exponents, UNPROVED))

    def verify(self, boxes: FloatBoxes) -> BoolArray:
        """Which of the given boxes are proved to contain exactly one zero, a regular one."""
        with np.errstate(all="ignore"):
            eta, k0, bound = self._bounds(boxes.points)
            contraction = (k0 + boxes.radii * bound) * _UP
            holds = eta * _UP < boxes.radii * (1.0 - contraction)
        return np.asarray(boxes.proved & (contraction < 1.0) & holds)

    def _bounds(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Upper bounds of eta, k0 and M for every point; NaN or infinite if there is no bound."""
        parts = [
            self._chunk(points[start : start + _CHUNK]) for start in range(0, len(points), _CHUNK)
        ]
        if self._stack is None or not parts:
            return (np.full(len(points), np.inf),) * 3
        eta, k0, bound = (np.concatenate(part) for part in zip(*parts, strict=True))
        return eta, k0, bound

    def _chunk(self, points: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        n, m = self.system.size, len(points)
        if self._stack is None:
            return (np.full(m, np.inf),) * 3
        absolute, norms = self._absolute
        z = np.hstack([points, np.ones((m, 1))])
        gradients = (z @ self._stack.T).reshape(m, n, n + 1)
        jacobian = gradients[:, :, :n]
        y = inverse_each(jacobian)
        values = np.matmul(gradients, z[:, :, None]) * 0.5
        size = np.abs(z)
        majorant = (size @ absolute.T).reshape(m, n, n + 1)
        errors = np.empty((m, n, 3))
        c = 3.0 * (n + 3) * _U
        errors[:, :, 0] = c * majorant[:, :, :n].sum(axis=2)
        errors[:, :, 1] = c * np.matmul(majorant, size[:, :, None])[:, :, 0]
        errors[:, :, 2] = norms
        product = np.matmul(y, jacobian)
        product[:, range(n), range(n)] -= 1.0
        weights = np.abs(y)
        bounds = np.matmul(weights, errors)
        k0 = (np.abs(product).sum(axis=2) + bounds[:, :, 0]).max(axis=1) * _UP + _TINY
        eta = np.abs(np.matmul(y, values)[:, :, 0]) + bounds[:, :, 1]
        usable = (size.max(axis=1) <= _MOST_Z) & (weights.max(axis=(1, 2)) <= _MOST_Y)
        return (
            np.where(usable, eta.max(axis=1) * _UP + _TINY, np.inf),
            np.where(usable, k0, np.inf),
            bounds[:, :, 2].max(axis=1) * _UP + _TINY,
        )


@dataclass(frozen=True)
class FloatSigns:
    """The signs of functionals c . x + c_0 on whole boxes, from integer rows (c_1, ..., c_n, c_0).

    For the nearest doubles C, |fl(C z) - c . z| <= gamma_{n+2} |C| |z|. Over a box of radius r the
    value changes by at most r sum_k |c_k|. Errors are bounded as in `FloatKrawczyk`.

    >>> boxes = FloatBoxes(4, np.array([[16], [2]]), np.array([2, 2]))
    >>> FloatSigns(((1, 0), (-3, 1))).on(boxes).tolist()
    [[1, -1], [0, 0]]
    """

    rows: tuple[tuple[int, ...], ...]

    @cached_property
    def _matrix(self) -> FloatArray | None:
        scaled = [scaled_rows([row]) for row in self.rows]
        usable = [row for row in scaled if row is not None]
        return np.vstack(usable) if usable and len(usable) == len(scaled) else None

    def on(self, boxes: FloatBoxes) -> npt.NDArray[np.int8]:
        """1 or -1 if a row has this sign on the whole box, 0 if that is not proved."""
        if self._matrix is None:
            return np.zeros((len(boxes.centers), len(self.rows)), dtype=np.int8)
        z = np.hstack([boxes.points, np.ones((len(boxes.centers), 1))])
        absolute = np.abs(self._matrix)
        with np.errstate(all="ignore"):
            values = z @ self._matrix.T
            reach = boxes.radii[:, None] * absolute[:, :-1].sum(axis=1)
            reach += 3.0 * (z.shape[1] + 2) * _U * (np.abs(z) @ absolute.T)
            clear = (np.abs(values) > reach * _UP + _TINY) & boxes.proved[:, None]
        small = np.asarray((np.abs(z) <= _MOST_Z).all(axis=1))
        return np.where(clear & small[:, None], np.sign(values), 0).astype(np.int8)


def scaled_rows(rows: Sequence[Sequence[int]]) -> FloatArray | None:
    """The doubles nearest to integers over a power of two, at most 1; None if out of range."""
    bits = max((abs(x) for row in rows for x in row), default=0).bit_length()
    if bits > _MOST_BITS:
        return None
    # Division of integers is correctly rounded, and every nonzero quotient is at least 2^-900.
    return np.array([[x / (1 << bits) for x in row] for row in rows], dtype=np.float64)


def inverse_each(matrices: FloatArray) -> FloatArray:
    """Approximate inverses of m matrices; NaN for a singular matrix."""
    try:
        return np.asarray(np.linalg.inv(matrices), dtype=np.float64)
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(matrices, np.nan)
        half = len(matrices) // 2
        return np.concatenate([inverse_each(matrices[:half]), inverse_each(matrices[half:])])
