"""A curve of configurations as a chain of Taylor polynomials, continued step by step in floats."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from math import comb

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.errors import NotApplicableError
from exactfold.motion.curves.bordered import Bordered, factors_of, sign_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.start import Start, blown_up, blown_up_rows

ORDER = 10
TOLERANCE = 1e-11
"""The tolerance of the predictor, in units of the sheet; Newton's method removes the rest."""

_CORRECTIONS = 8
_SMALLEST = 1e-7
_NO_HEIGHT = 1e-8
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


class LostCurveError(NotApplicableError):
    """Steps became too short: the configuration is singular or too close to a singular one."""


@dataclass(frozen=True, repr=False)
class Piece:
    """The unknowns of a framework as a polynomial of a parameter from 0 to `reach`.

    `coefficients` has shape (order + 1, unknowns). `time` is the arclength at 0, in units of the
    framework. `orientation` is the sign of the determinant of the Jacobian bordered by the tangent;
    it changes where another curve crosses. It is 0 for a series at the flat sheet.
    """

    coefficients: FloatArray
    reach: float
    time: float
    orientation: int = 0

    def at(self, parameter: FloatArray | float) -> FloatArray:
        """The unknowns at a parameter, shape (..., unknowns)."""
        s = np.asarray(parameter, dtype=np.float64)[..., None]
        value = np.zeros(s.shape[:-1] + self.coefficients.shape[1:])
        for row in self.coefficients[::-1]:
            value = value * s + row
        return np.asarray(value)

    def speed(self, parameter: FloatArray | float) -> FloatArray:
        """The derivative of the unknowns with respect to the parameter, shape (..., unknowns)."""
        s = np.asarray(parameter, dtype=np.float64)[..., None]
        value = np.zeros(s.shape[:-1] + self.coefficients.shape[1:])
        for k in range(len(self.coefficients) - 1, 0, -1):
            value = value * s + k * self.coefficients[k]
        return np.asarray(value)

    @cached_property
    def length(self) -> float:
        """The arclength of the whole piece."""
        return self.length_to(self.reach)

    def length_to(self, parameter: float) -> float:
        """The arclength from 0 to a parameter, by Gauss-Legendre quadrature."""
        s = 0.5 * parameter * (_NODES + 1)
        return float(0.5 * parameter * (_WEIGHTS @ self._pace(s)))

    @cached_property
    def _squares(self) -> FloatArray:
        """The squared speed as a polynomial, with the highest power first."""
        rows = self.coefficients[1:] * np.arange(1, len(self.coefficients))[:, None]
        products = rows @ rows.T
        return np.array([np.trace(products[:, ::-1], k) for k in range(1 - len(rows), len(rows))])

    def _pace(self, parameter: FloatArray | float) -> FloatArray:
        """The speed as a number: the derivative of the arclength."""
        return np.asarray(np.sqrt(np.maximum(np.polyval(self._squares, parameter), 0.0)))

    def parameter(self, length: float) -> float:
        """The parameter at which the arclength from 0 is `length`, by Newton's method."""
        s = self.reach * min(max(length / self.length, 0.0), 1.0) if self.length else 0.0
        for _ in range(20):
            slope = float(self._pace(s))
            step = (length - self.length_to(s)) / slope if slope else 0.0
            s = min(max(s + step, 0.0), self.reach)
            if abs(step) <= 1e-14 * self.reach:
                break
        return s

    def cut(self, reach: float) -> Piece:
        """The part of the piece up to a parameter."""
        return replace(self, reach=reach)

    def turned(self, end: float, time: float) -> Piece:
        """The same curve, run through backwards from the parameter `end` to 0.

        By Taylor's theorem this is exactly the polynomial p(end - s).
        """
        top = len(self.coefficients)
        rows = np.zeros_like(self.coefficients)
        for k in range(top):
            weights = [comb(m, k) * end ** (m - k) for m in range(k, top)]
            rows[k] = (-1) ** k * (np.array(weights) @ self.coefficients[k:])
        return Piece(rows, end, time)

    def __repr__(self) -> str:
        return f"<Piece: time {self.time:.4g}, length {self.length:.4g}>"


@dataclass(frozen=True, repr=False)
class Curve:
    """Configurations of a framework, beginning with the flat one, piece by piece."""

    framework: Framework
    pieces: tuple[Piece, ...]

    @property
    def duration(self) -> float:
        """The arclength of the whole curve, in units of the framework."""
        return self.pieces[-1].time + self.pieces[-1].length

    def at(self, time: float) -> FloatArray:
        """The unknowns at a time, moved onto the curve by Newton's method where it converges."""
        starts = [piece.time for piece in self.pieces]
        k = max(int(np.searchsorted(starts, time, side="right")) - 1, 0)
        piece = self.pieces[k]
        s = piece.parameter(time - piece.time)
        x = piece.at(s)
        if not piece.orientation:  # series at the flat sheet, where the Jacobian is singular
            return near_flat(self.framework, x)
        try:
            return on_curve(self.framework, x, piece.speed(s))[0]
        except LostCurveError:  # near a branch point the polynomial itself meets the tolerance
            return x

    def samples(self, each: int) -> tuple[FloatArray, FloatArray]:
        """Times and unknowns at `each` points of every piece, and at the end of the curve."""
        times, values = [], []
        for piece in self.pieces:
            s = np.linspace(0.0, piece.reach, each, endpoint=False)
            times += [piece.time + piece.length_to(t) for t in s]
            values.append(piece.at(s))
        times.append(self.duration)
        values.append(self.pieces[-1].at(np.array([self.pieces[-1].reach])))
        return np.array(times), np.concatenate(values)

    def __repr__(self) -> str:
        return f"<Curve: {len(self.pieces)} pieces, length {self.duration:.6g}>"


def leaving_piece(start: Start, tolerance: float = TOLERANCE) -> Piece:
    """The first piece, which leaves the flat state, with t as its parameter."""
    framework, coefficients = start.framework, start.in_t()
    # The error is relative to t, because the equations are divided by t^2 there.
    reach = _radius(coefficients, tolerance)
    for _ in range(60):
        piece = Piece(coefficients, reach, 0.0)
        error = float(np.max(np.abs(framework.residual(piece.at(reach))), initial=0.0))
        if error <= tolerance * reach:
            return piece
        reach *= 0.8
    raise LostCurveError("the radius of convergence of the series at the flat state is too small")


def continued(
    framework: Framework, first: Piece, tolerance: float = TOLERANCE, order: int = ORDER
) -> Iterator[Piece]:
    """Yield `first` and then, without end, the pieces that follow it.

    Each piece is the Taylor polynomial at its start, whose parameter is arclength to first order.
    One factorisation of the Jacobian gives all coefficients, and Newton's method uses it to
    correct the start. Raises `LostCurveError` if steps become too short.
    """
    piece = first
    while True:
        yield piece
        x = piece.at(piece.reach)
        direction = piece.speed(piece.reach)
        time = piece.time + piece.length
        piece = piece_of(*expansion(framework, x, direction, order), time, tolerance)


def piece_of(
    coefficients: FloatArray, orientation: int, time: float = 0.0, tolerance: float = TOLERANCE
) -> Piece:
    """The piece as far as an expansion is accurate; raises `LostCurveError` if that is
    too short.
    """
    reach = _radius(coefficients, tolerance)
    if not (np.isfinite(reach) and reach > _SMALLEST):
        raise LostCurveError("the steps of the continuation become too short")
    return Piece(coefficients, reach, time, orientation)


def expansion(
    framework: Framework, x: FloatArray, direction: FloatArray, order: int = ORDER
) -> tuple[FloatArray, int]:
    """Taylor coefficients of the curve at the configuration nearest to x, and the orientation.

    The parameter s has |dx/ds| = 1 at 0 and T . (x(s) - x(0)) = s, where T is the tangent there, in
    the given direction. The shape is (order + 1, unknowns). Raises `LostCurveError`.
    """
    x, factors, held = on_curve(framework, x, direction)
    right = np.zeros(framework.size)
    right[-1] = 1.0
    tangent = factors.solve(right)
    tangent /= np.linalg.norm(tangent)
    if tangent @ direction < 0:
        tangent = -tangent
    series = np.zeros((order + 1, framework.size))
    series[0], series[1] = x, tangent
    along = np.zeros((order + 1, len(framework.bars), 3))
    along[1] = framework.along(tangent)
    none = np.zeros(len(framework.ties) + 1)
    for k in range(2, order + 1):
        products = np.einsum("mec,mec->e", along[1:k], along[k - 1 : 0 : -1])
        right = framework.coupling.combined(-0.5 * products)
        row = factors.solve(np.append(right, none))
        series[k] = row - (tangent @ row) * tangent
        along[k] = framework.along(series[k])
    if not np.isfinite(series).all():
        raise LostCurveError("the curve leaves the range of floats")
    # T spans the kernel of J, so det [J; e_held] = T_held det [J; T].
    return series, factors.sign * int(np.sign(tangent[held]))


def orientation_at(framework: Framework, x: FloatArray, direction: FloatArray) -> int:
    """The sign of det [J; T] at a configuration, where T is the tangent in the given direction; or
    0.
    """
    held = int(np.argmax(np.abs(direction)))
    sign = sign_of(framework, framework.flat_edges + framework.along(x), held)
    return sign * int(np.sign(direction[held]))


def on_curve(
    framework: Framework, x: FloatArray, direction: FloatArray
) -> tuple[FloatArray, Bordered, int]:
    """The configuration near x with the same value of the unknown that changes most.

    Also returns the factorised bordered Jacobian at x, and the number of that unknown. Raises
    `LostCurveError`.
    """
    held = int(np.argmax(np.abs(direction)))
    try:
        factors = factors_of(framework, framework.flat_edges + framework.along(x), held)
    except np.linalg.LinAlgError:
        raise LostCurveError("the Jacobian is singular") from None
    last = np.inf
    for _ in range(_CORRECTIONS):
        step = factors.solve(np.append(-framework.residual(x), 0.0))
        size = float(np.max(np.abs(step)))
        if not np.isfinite(size) or size > 1e-2 or size > 2 * max(last, 1e-12):
            raise LostCurveError("Newton's method does not converge")
        x = x + step
        if size < 1e-15 or (size < 1e-12 and size > last / 4):
            break
        last = size
    return x, factors, held


def near_flat(framework: Framework, x: FloatArray) -> FloatArray:
    """The configuration near x, close to the flat one, that has the same largest height.

    Two steps of Newton's method are made in the blown-up equations, which are regular there.
    Heights of the size of rounding errors have no direction; then x is returned, which is as
    accurate as floats are.
    """
    t = float(np.max(np.abs(x[2::3]), initial=0.0))
    if t < _NO_HEIGHT:
        return x
    scale = np.full(framework.size, t * t)
    scale[2::3] = t
    y = x / scale
    held = 3 * int(np.argmax(np.abs(y[2::3]))) + 2
    try:
        factors = factors_of(framework, blown_up_rows(framework, y, t * t), held)
    except np.linalg.LinAlgError:
        return x
    for _ in range(2):
        y = y + factors.solve(np.append(-blown_up(framework, y, t * t), 0.0))
    return np.asarray(y * scale)


def _radius(coefficients: FloatArray, tolerance: float) -> float:
    """The parameter up to which the first neglected terms are about `tolerance`."""
    top = len(coefficients) - 1
    sizes = np.max(np.abs(coefficients), axis=1)
    bounds = [(tolerance / sizes[k]) ** (1.0 / k) for k in (top - 1, top) if sizes[k]]
    return float(min(bounds, default=1.0))
