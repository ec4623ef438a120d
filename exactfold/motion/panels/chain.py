"""Panels placed one after the other by rotations that are polynomials, with proved errors.

Let R and S be rotations. If |R - P| <= e and |S - Q| <= f in the spectral norm, then R S is within
e + f + e f of P Q, because R S - P Q = (R - P) S + P (S - Q), |S| = 1 and |P| <= 1 + e. So the
errors of a product of many rotations add up. Polynomials are in y with |y| <= 1; their coefficients
are floats along the last axis. With u = 2^-53, a sum of n products has an error of at most 2 n u
times the sum of their sizes. All errors are enlarged by the factor `_MORE`, which covers the
rounding of the errors themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exactfold._support.arrays import FloatArray

_MORE = 1 + 1e-9
_U = 2.0**-53
_TINY = 1e-300


class Turned(NamedTuple):
    """A polynomial that approximates a rotation or a place.

    It has the shape (3, 3, order + 1) or (3, order + 1). `error` bounds the distance for all |y| <=
    1, in the spectral norm of matrices or in the length of vectors.
    """

    polynomial: FloatArray
    error: float


def still(order: int) -> tuple[Turned, Turned]:
    """The rotation and the shift of the panel that is held."""
    rotation = np.zeros((3, 3, order + 1))
    rotation[..., 0] = np.eye(3)
    return Turned(rotation, 0.0), Turned(np.zeros((3, order + 1)), 0.0)


def size(polynomial: FloatArray) -> float:
    """A bound of the norm for |y| <= 1: the sum of the norms of the coefficients."""
    flat = polynomial.reshape(-1, polynomial.shape[-1])
    return float(np.sqrt((flat * flat).sum(axis=0)).sum()) * _MORE + _TINY


def spun(sine: Turned, versine: Turned, axis: FloatArray, off: float) -> Turned:
    """The rotation 1 + sine K + versine K^2 about an axis (x, y) within `off` of a unit vector.

    `sine` and `versine` (1 - cosine) have one row.
    """
    x, y = axis
    once = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    twice = np.array([[-y * y, x * y, 0.0], [x * y, -x * x, 0.0], [0.0, 0.0, -x * x - y * y]])
    (s, s_off), (v, v_off) = sine, versine
    polynomial = once[..., None] * s[0] + twice[..., None] * v[0]
    polynomial[..., 0] += np.eye(3)
    # Each entry is rounded at most six times. |K| and |K^2| are at most 1 + 3 off.
    rounded = 12 * _U * 3 * (1 + size(s) + size(v))
    error = (1 + 3 * off) * (s_off + v_off) + 6 * off * (size(s) + size(v)) + rounded
    return Turned(polynomial, error * _MORE)


def product(first: Turned, second: Turned) -> Turned:
    """The product of two rotations, truncated at the same order."""
    a, b = first.polynomial, second.polynomial
    terms = a.shape[-1]
    whole = np.zeros((3, 3, 2 * terms - 1))
    for k in range(terms):
        whole[..., k : k + terms] += np.einsum("ij,jkm->ikm", a[..., k], b)
    dropped = size(whole[..., terms:])
    rounded = 2 * 3 * terms * _U * size(a) * size(b)
    error = first.error + second.error + first.error * second.error + dropped + rounded
    return Turned(whole[..., :terms], error * _MORE)


def moved(rotation: Turned, point: FloatArray, off: float, shift: Turned) -> Turned:
    """The place of a point after a rotation and a shift.

    In the flat sheet the point is at (x, y), or at (x, y, z) above or below it, known within `off`.
    """
    r = rotation.polynomial
    place = r[:, 0] * point[0] + r[:, 1] * point[1] + shift.polynomial
    if len(point) > 2:
        place = place + r[:, 2] * point[2]
    reach = float(abs(point).sum())
    rounded = 8 * _U * (reach * size(r) + size(shift.polynomial))
    error = rotation.error * reach + (1 + rotation.error) * off + shift.error + rounded
    return Turned(place, error * _MORE)


def hinged(old: Turned, new: Turned, point: FloatArray, off: float, shift: Turned) -> Turned:
    """The shift of the next panel: it leaves a point (x, y) of the fold, known within `off`, in
    place.
    """
    turn = old.polynomial - new.polynomial
    reach = float(abs(point).sum())
    sizes = size(old.polynomial) + size(new.polynomial)
    rounded = _U * sizes
    error = old.error + new.error + rounded
    place = moved(Turned(turn, error), point, 0.0, shift)
    return Turned(place.polynomial, (place.error + off * (2 + error)) * _MORE + 4 * _U * reach)
