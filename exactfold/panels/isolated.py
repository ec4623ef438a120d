"""Parts of a sheet whose ways are all isolated: Krawczyk's test finds them, Bezout counts them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import Final

import numpy as np
from flint import fmpq, fmpq_mat

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import PROVED
from exactfold.checker.core.limits import ISOLATED_FORMS
from exactfold.exact.linalg import from_fmpq
from exactfold.exact.root_tower import to_fmpq
from exactfold.exact.surds import RATIONALS, Number
from exactfold.panels.spaces.kernel import Rows
from exactfold.panels.spaces.regular import parameter_folds
from exactfold.panels.spaces.subspaces import Bounds, Leaf, bounds_of, made_leaf
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.pattern.panel_pattern import Edge
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.isolation import isolate
from exactfold.solve.numeric.homotopy import homotopy

_FEWEST_ROOTS: Final = 2
_TURNS: Final = (0.1, 0.7)
_CLOSED: Final = 1e-9
_STARTS: Final = 12
_STEPS: Final = 30
_SINGULAR: Final = 1e-6


@dataclass(frozen=True)
class IsolatedWays:
    """All complex motions to second order of a part, each of which is isolated and simple.

    The unknowns are the densities of `folds`, which determine those of all folds of the part. They
    are scaled so that the sum of `chart[k]` times the density of `folds[k]` is 1. Each box holds
    one motion, in all unknowns but the last. Of two conjugate motions `nonreal` has one.
    """

    folds: tuple[Edge, ...]
    chart: tuple[int, ...]
    real: tuple[IsolatingBox, ...]
    nonreal: tuple[IsolatingBox, ...]

    def motions(self) -> list[tuple[Bounds, ...]]:
        """Bounds of the densities of `folds`, for each real motion."""
        unknowns = range(len(self.folds) - 1)
        known = [[box.interval(k) for k in unknowns] for box in self.real]
        return [(*some, self._last(some)) for some in known]

    def _last(self, known: Sequence[Bounds]) -> Bounds:
        scale = Fraction(-1, self.chart[-1])
        low, high = bounds_of([scale * c for c in self.chart[:-1]], known)
        return low - scale, high - scale


def isolated_ways(
    stars: Mapping[int, Star], rows: Rows, size: int, clock: Clock = UNLIMITED
) -> tuple[IsolatedWays, list[Leaf]] | None:
    """All ways of a part whose first-order motions are `rows`; the real ones as leaves.

    Let there be one first-order motion more than vertices with four folds or more, so that the
    conditions of first order are independent, and let the forms of these m vertices have 2^m simple
    zeros in the projective space of the first-order motions. By Bezout's theorem these are all
    motions to second order, and each real one truly folds (docs/panels.md, Isolated ways).
    Floating point proposes the zeros, non-real ones included, and Krawczyk's test in integers
    proves them.

    None if the part is not of this kind, if the test does not find all zeros, or if exact lines in
    a field of square roots are better: where at most one square root is needed, where some fold may
    be flat on a way, and where a way may be linear in the half-angle tangents. Raises
    `TooManyModesError` if the clock has passed.
    """
    full = [v for v, star in stars.items() if star.has_form]
    folds = {edge for star in stars.values() for edge in star.folds}
    rational = all(isinstance(x, fmpq) for row in rows.values() for x in row)
    if not rational or size != len(full) + 1 or len(full) > ISOLATED_FORMS:
        return None
    if size != len(folds) - sum(star.conditions for star in stars.values()):
        return None
    if sum(_needs_root(stars[v]) for v in full) < _FEWEST_ROOTS:
        return None
    chart = tuple((-1) ** k * (1 + 3 * k % 5) for k in range(size))
    system = _system([stars[v] for v in full], rows, chart)
    if _seems_to_have_families(system):
        return None

    def on_time(done: int, total: int) -> None:
        clock.check()

    found = isolate(system, homotopy(system, progress=on_time), progress=on_time)
    if found.complete is not PROVED:
        return None
    real = tuple(box for box in found.boxes if box.is_real)
    nonreal = tuple(box for box in found.boxes if _is_first(box))
    if len(real) + 2 * len(nonreal) < len(found.boxes):
        return None
    ways = IsolatedWays(tuple(parameter_folds(rows, size)), chart, real, nonreal)
    whole = made_leaf(rows, size, full)
    leaves = [replace(whole, motion=motion) for motion in ways.motions()]
    if all(_may_be_taken(stars, leaf) for leaf in leaves):
        return ways, leaves
    return None


def _seems_to_have_families(system: QuadraticSystem) -> bool:
    """Whether Newton's method runs to a zero in projective space that is not simple.

    Then a homotopy would follow many paths in vain. Most starts lead to the largest families.
    """
    tensor = system.float_tensor
    tensor = tensor / np.abs(tensor).max(axis=(1, 2), keepdims=True)
    rng = np.random.default_rng(1)
    for _ in range(_STARTS):
        w = rng.normal(size=tensor.shape[1]) + 1j * rng.normal(size=tensor.shape[1])
        for _ in range(_STEPS):
            w /= np.linalg.norm(w)
            slopes = tensor @ w
            w = w - np.linalg.lstsq(2 * slopes, slopes @ w, rcond=_SINGULAR)[0]
        w /= np.linalg.norm(w)
        slopes = tensor @ w
        least = float(np.linalg.svd(slopes, compute_uv=False)[-1])
        if np.abs(slopes @ w).max() < _CLOSED and least < _SINGULAR:
            return True
    return False


def _is_first(box: IsolatingBox) -> bool:
    """Whether a box that is not real comes first of it and its conjugate."""
    return sum((2 * k * k + 3 * k + 5) * y for k, y in enumerate(box.imag)) > 0


def _needs_root(star: Star) -> bool:
    """Whether a vertex has a square root in its local modes, or more than four folds."""
    if len(star.folds) > 4 or star.hole is not None:
        return True
    discriminant: Number = 1
    for k, d in enumerate(star.directions):
        discriminant = discriminant * bracket(star.directions[k - 1], d)
    return RATIONALS.square_root(discriminant) is None


def _system(stars: Sequence[Star], rows: Rows, chart: Sequence[int]) -> QuadraticSystem:
    """The forms of these vertices in the chart, without the last parameter."""
    size = len(chart)
    change = fmpq_mat(size, size)
    for k, weight in enumerate(chart):
        change[k, k] = fmpq(1)
        change[size - 1, k] = fmpq(-weight, chart[-1])
    change[size - 1, size - 1] = fmpq(1, chart[-1])
    matrices = []
    for star in stars:
        form = fmpq_mat(size, size)
        local = [[(a, x) for a, x in enumerate(rows.get(e, ())) if x] for e in star.folds]
        for k, d in enumerate(star.directions):
            for j, c in enumerate(star.directions[:k]):
                weight = to_fmpq(bracket(c, d))
                for (a, x), (b, y) in product(local[j], local[k]):
                    form[a, b] += weight * x * y
                    form[b, a] += weight * x * y
        charted = (change.transpose() * form * change).tolist()
        matrices.append([[from_fmpq(x) for x in row] for row in charted])
    return QuadraticSystem.from_rational(matrices)


def _may_be_taken(stars: Mapping[int, Star], leaf: Leaf) -> bool:
    """Whether all folds bend on a way, and it does not seem to be linear.

    A way is linear if all vertices close with tau = tan(angle / 2) / length proportional to its
    densities. A vertex closes if the vector part of the product of the quaternions 1 + tau_j d_j
    vanishes. Floating point decides whether it seems to.
    """
    bounds = leaf.densities
    if any(low <= 0 <= high for low, high in bounds.values()):
        return False
    densities = {edge: float(low + high) for edge, (low, high) in bounds.items()}
    if any(star.hole is not None for star in stars.values()):
        return True
    return any(_gap(star, densities) > _CLOSED for star in stars.values())


def _gap(star: Star, densities: Mapping[Edge, float]) -> float:
    """How far a vertex is from closing with tau proportional to these densities, at two turns."""
    vectors = np.array([(float(x), float(y)) for x, y in star.directions])
    vectors *= [[densities.get(edge, 0.0)] for edge in star.folds]
    vectors /= np.abs(vectors).max() or 1.0
    gap = 0.0
    for turn in _TURNS:
        s, a, b, c = 1.0, 0.0, 0.0, 0.0
        for p, q in (turn * vectors).tolist():
            after = s - a * p - b * q, a + s * p - c * q, b + s * q + c * p, c + a * q - b * p
            s, a, b, c = after
        gap = max(gap, abs(a), abs(b), abs(c))
    return gap
