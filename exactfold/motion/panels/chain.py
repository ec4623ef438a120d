"""Panels placed one after the other by rotations that are polynomials, with proved errors.

With |R - P| <= e and |S - Q| <= f in the spectral norm R S is within e + f + e f of P Q for
rotations R, S, so that the errors of a product of many add up (docs/panel_motion.md, 6).

Polynomials are in y, |y| <= 1, and each has coefficients in floats along its last axis. With
u = 2^-53 a sum of n products is off by at most 2 n u times the sum of their sizes; all errors are
made larger by `_MORE`, which covers the rounding of the errors themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from exactfold._support.arrays import FloatArray

_MORE = 1 + 1e-9
_U = 2.0**-53
_TINY = 1e-300


class Turned(NamedTuple):
    """A rotation, shape (3, 3, order + 1), or a place, (3, order + 1), within `error` of this.

    In the spectral norm of matrices, or the length of vectors, for all |y| <= 1.
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
    """The rotation about an axis (x, y) within `off` of a unit vector: 1 + sine K + versine K^2.

    `sine` and `versine`, 1 - cosine, have one row.
    """
    x, y = axis
    once = np.array([[0.0, 0.0, y], [0.0, 0.0, -x], [-y, x, 0.0]])
    twice = np.array([[-y * y, x * y, 0.0], [x * y, -x * x, 0.0], [0.0, 0.0, -x * x - y * y]])
    (s, s_off), (v, v_off) = sine, versine
    polynomial = once[..., None] * s[0] + twice[..., None] * v[0]
    polynomial[..., 0] += np.eye(3)
    # Each entry is rounded at most six times; |K| and |K^2| are at most 1 + 3 off.
    rounded = 12 * _U * 3 * (1 + size(s) + size(v))
    error = (1 + 3 * off) * (s_off + v_off) + 6 * off * (size(s) + size(v)) + rounded
    return Turned(polynomial, error * _MORE)


def product(first: Turned, second: Turned) -> Turned:
    """The product of two rotations up to the same order."""
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
    """Where a point (x, y) of the flat sheet, within `off`, is: turned, then shifted."""
    r = rotation.polynomial
    place = r[:, 0] * point[0] + r[:, 1] * point[1] + shift.polynomial
    reach = float(abs(point).sum())
    rounded = 6 * _U * (reach * size(r) + size(shift.polynomial))
    error = rotation.error * reach + (1 + rotation.error) * off + shift.error + rounded
    return Turned(place, error * _MORE)


def hinged(old: Turned, new: Turned, point: FloatArray, off: float, shift: Turned) -> Turned:
    """The shift of the next panel: a point (x, y) of the fold, within `off`, is where it was."""
    turn = old.polynomial - new.polynomial
    reach = float(abs(point).sum())
    sizes = size(old.polynomial) + size(new.polynomial)
    rounded = _U * sizes
    error = old.error + new.error + rounded
    place = moved(Turned(turn, error), point, 0.0, shift)
    return Turned(place.polynomial, (place.error + off * (2 + error)) * _MORE + 4 * _U * reach)
