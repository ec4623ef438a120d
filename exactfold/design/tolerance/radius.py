"""Proved radii: for vertices that move less, a zero stays regular and no letter changes.

Let F(x, U) = 0 be the conditions of `gradients`, with one more that fixes a factor, and x_0 a zero,
nearly, for the vertices U_0. F is a polynomial of degree 2 in x and U together. Put
x = x_0 + N dU + xi with N = -Y F_U and Y near the inverse of F_x, and G = Y F. Then G is exactly

    Y F(x_0) + Y (F_x N + F_U) dU + Y q(dU) + Y F_x xi + Y L(dU) xi + (1/2) Y F_xx (xi, xi)

with a quadratic q and a linear L. Let |dU_v| <= r for every vertex, and |xi_i| <= rho_i. Bounds of
the terms are sums of lengths over vertices, and Krawczyk's test with dU as a parameter reads

    a_i + r b_i + r^2 t_i + sum_j (k0 + r k1)_ij rho_j + sum_jk |w_ijk| rho_j rho_k < rho_i.

If it holds, every such sheet has exactly one zero in the box, a regular one. A density keeps its
sign if its value at x_0 exceeds r times the lengths of its row of N, and its share of rho.
Coordinates are the nearest doubles: how far these are off is taken from the radius. Zeros that are
not real are treated alike, with complex discs for intervals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, inverses
from exactfold._support.progress import Progress
from exactfold.design.tolerance.gradients import Gradients
from exactfold.solve.certify.float_balls import UP, Balls, Mids

_BISECTIONS = 10
_HALVINGS = 60
_ROUNDS = 3
_MOST = 1 << 21
"""Chunks of zeros have tensors of at most so many entries."""
_LEAST = 2.0**-60
_WIDER = 1.0 + 1e-4
"""Room for rounding: rho is so much wider than necessary."""


@dataclass(frozen=True)
class Radii:
    """Radii for each of the given zeros: the zero stays regular, and its letters stay.

    `all_move` has one number for each zero, for moves of all vertices, and `one_moves` one for each
    zero and vertex, for moves of this vertex alone. A radius is 0 where nothing is proved. At the
    centre each zero lies within `errors` of the one given. `densities` are those of the folds, and
    `slopes` how they change with each vertex, in floats, with the shapes (B, E) and (B, E, V, 2).
    `is_sloping` says of which folds it is proved that the density changes with some vertex.
    """

    all_move: FloatArray
    one_moves: FloatArray
    errors: FloatArray
    densities: Mids
    slopes: Mids
    is_sloping: BoolArray


def proved_radii(
    part: Gradients,
    zeros: Mids,
    off: float = 0.0,
    lettered: BoolArray | None = None,
    progress: Progress | None = None,
) -> Radii:
    """Radii of zeros, given as gradients with shape (B, 2R), by the test of this module.

    The centre of the moves lies within `off` of `part.points`. Of zeros that are not `lettered`
    only that they stay regular is asked for; by default all are.
    """
    step = max(1, _MOST // part.size**3)
    wanted = np.ones(len(zeros), dtype=bool) if lettered is None else lettered
    # Powers of two scale exactly; without, squares of huge or tiny lengths would leave the doubles.
    unit = float(2.0 ** np.frexp(np.ptp(part.points, axis=0).max())[1])
    scaled = replace(part, points=part.points / unit)
    parts = []
    for start in range(0, len(zeros), step):
        if progress is not None:
            progress("bounding", start, len(zeros))
        some = slice(start, start + step)
        parts.append(_chunk(scaled, zeros[some], off / unit, wanted[some]))
    found = Radii(*(np.concatenate(rows) for rows in zip(*parts, strict=True)))
    return replace(
        found,
        all_move=found.all_move * unit,
        one_moves=found.one_moves * unit,
        densities=found.densities / unit,
        slopes=found.slopes / unit / unit,
    )


def _chunk(part: Gradients, zeros: Mids, off: float, lettered: BoolArray) -> tuple[Any, ...]:
    with np.errstate(all="ignore"):
        terms, values, slopes = _terms(part, zeros)
        least = np.where(lettered[:, None], terms.least, np.inf)
        terms = replace(terms, least=least)
        vertices = range(len(part.points))
        one_moves = [_radii(terms.moving([v], off))[0] for v in vertices]
        all_move, errors = _radii(terms.moving(vertices, off))
        sloping = (slopes.below.max(axis=3) > terms.missed(errors, off)).any(axis=2)
        return all_move, np.stack(one_moves, axis=1), errors, values, slopes.mid, sloping


# --- the terms of the test -----------------------------------------------------------------------


@dataclass(frozen=True)
class _Limits:
    """The test for moves of some vertices; the names are those of the module."""

    a: FloatArray  # (B, n)
    b: FloatArray  # (B, n)
    t: FloatArray  # (B, n)
    k0: FloatArray  # (B, n, n)
    k1: FloatArray  # (B, n, n)
    w: FloatArray  # (B, n, n, n)
    least: FloatArray  # (B, E): the sizes of the densities
    drift: FloatArray  # (B, E): their change for moves of length 1
    share: FloatArray  # (E, n): their change with rho
    cap: float  # no larger radius is asked for


@dataclass(frozen=True)
class _Terms:
    """Upper bounds of the terms of the test, vertex by vertex."""

    a: FloatArray
    b: FloatArray  # (B, n, V)
    t: FloatArray  # (B, n, V, V)
    k0: FloatArray
    k1: FloatArray  # (B, n, n, V)
    w: FloatArray
    least: FloatArray
    drift: FloatArray  # (B, E, V)
    share: FloatArray
    cap: float

    def missed(self, errors: FloatArray, off: float) -> FloatArray:
        """How far the slopes of the densities at the true zero may be from those at x_0: (B, E, V).

        The true slope of the zero is N + E with Y F_x E = -(Y F_x N + Y F_U), where F_x and F_U are
        taken at the true zero, within `errors` of x_0, and at the true centre, within `off`.
        """
        wide = errors[:, None, None]
        turned = self.k0 + wide * (self.w.sum(axis=3) + self.w.sum(axis=2))
        norm = (turned + off * self.k1.sum(axis=3)).sum(axis=2).max(axis=1) * UP
        rest = (self.b + wide * self.k1.sum(axis=2) + off * self.t.sum(axis=3)).max(axis=1)
        apart = np.where(norm < 1, 1 / (1 - norm), np.inf)[:, None] * rest * UP
        return np.asarray(self.share.sum(axis=1)[None, :, None] * apart[:, None, :] * UP)

    def moving(self, vertices: Sequence[int], off: float) -> _Limits:
        """The test if these vertices move, and all others by up to `off`."""
        these = list(vertices)
        t = self.t[:, :, these]
        return _Limits(
            (self.a + off * self.b.sum(axis=2) + off**2 * self.t.sum(axis=(2, 3))) * UP,
            (self.b[:, :, these].sum(axis=2) + 2 * off * t.sum(axis=(2, 3))) * UP,
            t[:, :, :, these].sum(axis=(2, 3)) * UP,
            (self.k0 + off * self.k1.sum(axis=3)) * UP,
            self.k1[:, :, :, these].sum(axis=3) * UP,
            self.w,
            self.least - off * self.drift.sum(axis=2) * UP,
            self.drift[:, :, these].sum(axis=2) * UP,
            self.share,
            self.cap,
        )


def _terms(part: Gradients, zeros: Mids) -> tuple[_Terms, Mids, Balls]:
    count, n = zeros.shape
    folds, vertices, forms, regions = (
        len(part.folds),
        len(part.points),
        len(part.vertices),
        part.regions,
    )
    places = 2 * vertices
    ends, jumps = Balls.exact(part.ends), Balls.exact(part.jumps)
    matrices, at = Balls.exact(part.forms), Balls.exact(zeros)
    along = ends @ Balls.exact(part.points)
    linear = Balls(
        np.concatenate([part.linear(along.mid), part.shift]),
        np.concatenate([np.abs(part.linear(along.rad)), 0 * part.shift]),
    )

    # F_x, Y, F and F_U at the zero. The last condition keeps the component along it.
    areas = (at[:, None, None, :] @ matrices[None])[:, :, 0]
    slope = _stacked(count, linear, areas, Balls.exact(zeros.conj()[:, None]))
    inverse = Balls.exact(inverses(slope.mid))
    halves = (areas @ at[:, :, None]) * Balls.exact(np.array(0.5))
    still = Balls.exact(np.zeros((count, 1, 1)))
    value = _stacked(count, linear @ at[:, :, None], halves, still)
    jump = jumps @ at.reshape(count, regions, 2)
    rows = ends[None, :, :, None] * jump[:, :, None, :]
    rest = Balls.exact(np.zeros((count, n - folds, places)))
    by_place = _stacked(count, rows.reshape(count, folds, places), rest)
    moved = Balls.exact(-(inverse.mid @ by_place.mid))
    first = inverse @ (slope @ moved + by_place)
    k0 = inverse @ slope - Balls.exact(np.eye(n))

    # L, q and F_xx, multiplied by Y.
    of_folds, of_forms = inverse[:, :, :folds], inverse[:, :, folds + 2 : -1]
    bent = matrices[None] @ moved[:, None]
    bending = of_forms @ bent.reshape(count, forms, n * places)
    turned = Balls.exact((part.jumps[:, :, None] * part.ends[:, None, :]).reshape(folds, -1))
    turning = (of_folds @ turned).reshape(count, n, regions, vertices)
    k1 = bending.reshape(count, n, regions, 2, vertices, 2)
    for axis in range(2):
        k1 = _added(k1, (..., axis, slice(None), axis), turning)
    jumped = jumps @ moved.reshape(count, regions, 2 * places)
    paired = jumped[..., None] * ends[None, :, None, :]
    mixed = of_folds @ paired.reshape(count, folds, 2 * places * vertices)
    closed = Balls.exact(moved.mid.transpose(0, 2, 1))[:, None] @ bent
    squares = of_forms @ closed.reshape(count, forms, places * places)
    half = Balls.exact(np.array(0.5))
    t = mixed.reshape(count, n, 2, vertices, 2, vertices).moved((0, 1, 3, 4, 5, 2))
    t = (t + t.moved((0, 1, 4, 5, 2, 3))) * half
    t = t + squares.reshape(count, n, vertices, 2, vertices, 2) * half
    w = of_forms @ matrices.reshape(forms, n * n)

    # Densities, measured with the directions of the folds at the centre.
    across = np.stack([-along.mid[:, 1], along.mid[:, 0]], axis=1)
    across /= (along.mid**2).sum(axis=1, keepdims=True)
    lever = Balls.exact(across[:, None, :])
    values = (lever @ jump[..., None])[..., 0, 0]
    slopes = (lever @ jumped.reshape(count, folds, 2, places))[..., 0, :]
    slopes = slopes.reshape(count, folds, vertices, 2)
    share = np.abs(part.jumps)[:, :, None] * np.abs(across)[:, None, :]
    terms = _Terms(
        (inverse @ value).above[..., 0],
        _lengths(first.reshape(count, n, vertices, 2)),
        _sizes(t),
        k0.above,
        _lengths(k1).reshape(count, n, n, vertices),
        w.above.reshape(count, n, n, n),
        values.below,
        _lengths(slopes),
        share.reshape(folds, n) * UP,
        2 * float(np.ptp(part.points, axis=0).max()),
    )
    return terms, values.mid, slopes


def _stacked(count: int, *blocks: Balls) -> Balls:
    """Blocks of rows below each other; a block without a first axis is the same for all zeros."""
    mids = [np.broadcast_to(x.mid, (count, *x.mid.shape[-2:])) for x in blocks]
    rads = [np.broadcast_to(x.rad, (count, *x.rad.shape[-2:])) for x in blocks]
    return Balls(np.concatenate(mids, axis=1), np.concatenate(rads, axis=1))


def _added(balls: Balls, place: Any, more: Balls) -> Balls:
    """The balls with others added at a place."""
    mid, rad, total = balls.mid.copy(), balls.rad.copy(), balls[place] + more
    mid[place], rad[place] = total.mid, total.rad
    return Balls(mid, rad)


def _lengths(balls: Balls) -> FloatArray:
    """Upper bounds of the lengths of vectors along the last axis, of length 2."""
    above = balls.above
    lengths: FloatArray = np.hypot(above[..., 0], above[..., 1]) * UP
    return lengths


def _sizes(balls: Balls) -> FloatArray:
    """Upper bounds of the spectral norms of matrices of 2 rows and columns: (.., V, 2, V, 2).

    A real matrix acts on complex numbers as x -> p x + q conj(x), with the norm |p| + |q|. For
    others the Frobenius norm is a bound.
    """
    mid, rad = balls.mid, balls.rad
    off = np.sqrt((rad**2).sum(axis=(-3, -1)))
    a, b, c, d = mid[..., 0, :, 0], mid[..., 0, :, 1], mid[..., 1, :, 0], mid[..., 1, :, 1]
    if np.iscomplexobj(mid):
        norms = np.sqrt((np.abs(mid) ** 2).sum(axis=(-3, -1)))
    else:
        norms = (np.hypot(a + d, c - b) + np.hypot(a - d, c + b)) / 2
    sizes: FloatArray = (norms + off) * UP
    return sizes


# --- the largest radius that passes --------------------------------------------------------------


def _radii(limits: _Limits) -> tuple[FloatArray, FloatArray]:
    """For each zero a radius that passes the test, nearly the largest for the best rho found, and
    how far the zero may be off at the centre.

    rho is s times weights, which are near the solution of the linear part of the test.
    """
    best, errors = np.zeros(len(limits.a)), np.full(len(limits.a), np.inf)
    weights = limits.t + _LEAST
    for _ in range(_ROUNDS):
        test = _Weighted(limits, weights / weights.max(axis=1, keepdims=True))
        best = np.fmax(best, test.largest())
        good, sizes = test.passes(np.zeros_like(best))
        errors = np.fmin(errors, np.where(good, sizes, np.inf))
        radius = best[:, None]
        ahead = limits.a + radius * limits.b + radius**2 * limits.t
        matrix = np.eye(limits.a.shape[1]) - limits.k0 - 0.9 * best[:, None, None] * limits.k1
        solved = (inverses(matrix) @ ahead[:, :, None])[:, :, 0]
        positive = (solved > 0).all(axis=1, keepdims=True)
        weights = np.where(positive, solved, limits.t + _LEAST)
    return best, errors


class _Weighted:
    """The test with rho in proportion to weights of at most 1."""

    def __init__(self, limits: _Limits, weights: FloatArray) -> None:
        self.limits, self.weights = limits, weights
        column = weights[:, :, None]
        self.k0, self.k1 = (limits.k0 @ column)[:, :, 0], (limits.k1 @ column)[:, :, 0]
        self.w = ((limits.w @ column[:, None])[..., 0] @ column)[:, :, 0]
        self.reach = (limits.share @ column)[:, :, 0]

    def passes(self, radius: FloatArray) -> tuple[BoolArray, FloatArray]:
        """Which zeros pass at these radii, and the largest rho with which they do."""
        limits, weights, r = self.limits, self.weights, radius[:, None]
        ahead = (limits.a + r * limits.b + r**2 * limits.t) * UP
        slack = weights - (self.k0 + r * self.k1) * UP
        root = np.sqrt(slack**2 - 4 * ahead * self.w)
        s = (2 * ahead / (slack + root)).max(axis=1, keepdims=True) * _WIDER + 2.0**-900
        rest = ahead + s * (self.k0 + r * self.k1) + s**2 * self.w
        inside = (slack > 0) & (rest * UP < s * weights * (2 - UP))
        kept = (r * limits.drift + s * self.reach) * UP < limits.least
        return np.asarray(inside.all(axis=1) & kept.all(axis=1)), s[:, 0] * UP

    def largest(self) -> FloatArray:
        """The largest radii that pass, to three digits."""
        limits = self.limits
        high = (limits.least / limits.drift).min(axis=1)  # no radius beyond passes
        high = np.fmin(high, (self.weights / self.k1).min(axis=1))
        high = np.fmin(high, limits.cap)
        low, guess = np.zeros_like(high), high * (1 - 1e-4)
        for _ in range(_HALVINGS):
            good = (low == 0) & self.passes(guess)[0]
            low = np.where(good, guess, low)
            if (low > 0).all():
                break
            high = np.where(low > 0, high, guess)
            guess = np.where(low > 0, guess, guess / 2)
        for _ in range(_BISECTIONS):
            guess = (low + high) / 2
            good = self.passes(guess)[0]
            low, high = np.where(good, guess, low), np.where(good, high, guess)
        return np.asarray(low)
