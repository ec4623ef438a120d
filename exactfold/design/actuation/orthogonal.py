"""The torques that do no work on any branch but one: proved bounds of their dimension, an
example.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from scipy.linalg import qr

from exactfold._support.arrays import BigArray, BoolArray, FloatArray
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.branches.values.angles import fold_angles
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.directions import BITS, Directions
from exactfold.design.actuation.powers import Powers
from exactfold.design.actuation.programs import strongest_within
from exactfold.pattern.crease_pattern import Edge
from exactfold.rigidity.functionals import fold_functional

_INDEPENDENT = 1e-6
"""Pivots below this count as 0. This only guides proposals, which have to pass an exact test."""

_SCALE = 60
"""Bits after the point of an approximate inverse."""


@dataclass(frozen=True, repr=False)
class OrthogonalTorques:
    """Torques of size at most 1 whose power on every other branch is nearly 0.

    `share` is a proved bound of the largest power on another branch, divided by the power on this
    one. It is not 0, because fold angles of branches are irrational in general and torques are
    rational.
    """

    torques: Mapping[Edge, Fraction]
    share: Fraction

    def __repr__(self) -> str:
        return f"<OrthogonalTorques: rivals have at most {float(self.share):.2g} of the power>"


def independent_rows(
    directions: Directions, places: Sequence[int]
) -> tuple[list[int], list[int]] | None:
    """Some of the branches at `places`, and as many folds, whose minor is proved to be nonzero.

    So the vectors of these branches are linearly independent. There are as many as seem independent
    in floating point. The proof is an approximate inverse C with |C A - 1| < 1, in the norm of row
    sums, for every matrix A within the bounds. None if the proof fails, which does not mean that
    the vectors are dependent.
    """
    matrix = directions.middles[list(places)]
    if not len(matrix):
        return [], []
    _, triangle, order = qr(matrix.T, mode="economic", pivoting=True)
    rank = int((np.abs(np.diag(triangle)) > _INDEPENDENT).sum())
    rows = sorted(places[k] for k in order[:rank])
    columns = sorted(qr(directions.middles[rows], mode="r", pivoting=True)[1][:rank].tolist())
    low = directions.lows[np.ix_(rows, columns)]
    high = directions.highs[np.ix_(rows, columns)]
    return (rows, columns) if _is_regular(low, high) else None


def _is_regular(low: BigArray, high: BigArray) -> bool:
    """Whether every matrix within the bounds, in units of 2^-BITS, is proved to be invertible."""
    try:
        inverse = np.linalg.inv(((low + high) / (2 << BITS)).astype(float))
    except np.linalg.LinAlgError:
        return False
    if not np.isfinite(inverse).all():
        return False
    size = len(low)
    scaled = [int(Fraction(x) * (1 << _SCALE)) for x in inverse.ravel().tolist()]
    c = np.array(scaled, dtype=object).reshape(size, size)
    one = 1 << _SCALE + BITS + 1
    unit = np.array([one * (i == j) for i in range(size) for j in range(size)], dtype=object)
    errors = abs(c @ (low + high) - unit.reshape(size, size)) + abs(c) @ (high - low)
    return bool(max(errors.sum(axis=1)) < one)


@dataclass(frozen=True)
class Alone:
    """The torques that do no work on any branch but one: proved bounds of their dimension.

    `independent` are the places of other branches that are proved to be linearly independent.
    `orthogonal` is an example of such torques, or None. `self_foldable` says whether some such
    torques do work on the branch itself.
    """

    self_foldable: Verdict
    dimension: tuple[int, int]
    independent: list[int]
    orthogonal: OrthogonalTorques | None


def alone(
    directions: Directions,
    branches: Sequence[Branch],
    place: int,
    size: int,
    independent: list[int] | None = None,
) -> Alone:
    """What is proved of the torques that do no work on any branch but the one at `place`.

    `size` is the dimension of the space of first-order motions. `independent` are other branches
    that have already been proved to be independent, if some are known.
    """
    others = [b for b in range(len(branches)) if b != place]
    if independent is None:
        independent, _ = independent_rows(directions, others) or ([], [])
    dimension = dimension_bounds(branches, others, len(independent), size)
    orthogonal = None
    if dimension[0] > 0:
        orthogonal = orthogonal_torques(directions, place, independent, directions.moving)
    verdict = REFUTED if dimension[1] == 0 else UNDECIDED
    if dimension[0] > 0:
        verdict = _is_outside(directions, branches, place, size - dimension[0])
    return Alone(verdict, dimension, independent, orthogonal)


def _is_outside(
    directions: Directions, branches: Sequence[Branch], place: int, rank_of_others: int
) -> Verdict:
    """Whether a branch is no sum of multiples of the others, which have at most this rank."""
    everything = independent_rows(directions, range(len(branches)))
    if everything is not None and len(everything[0]) > rank_of_others:
        return PROVED
    others = _exact_rank([branch for b, branch in enumerate(branches) if b != place])
    if others is not None and others == _exact_rank(branches):
        return REFUTED
    return UNDECIDED


def alone_each(directions: Directions, branches: Sequence[Branch], size: int) -> Iterator[Alone]:
    """The result of `alone` for each branch.

    If there are enough branches, there are in general two disjoint sets of `size` independent
    branches. They suffice for all branches, because at least one of the two sets does not contain
    the branch in question.
    """
    places = range(len(branches))
    full: list[list[int]] = []
    for _ in range(2):
        rest = [b for b in places if not any(b in rows for rows in full)]
        rows, _ = independent_rows(directions, rest) or ([], [])
        if len(rows) < size:
            break
        full.append(rows)
    for place in places:
        known = next((rows for rows in full if place not in rows), None)
        yield alone(directions, branches, place, size, known)


def dimension_bounds(
    branches: Sequence[Branch], others: Sequence[int], proved_rank: int, size: int
) -> tuple[int, int]:
    """Bounds of the dimension of the torques orthogonal to the branches at `others`.

    Torques are taken modulo those that do no work on any first-order motion; the quotient has
    dimension `size`. The dimension sought is `size` minus the rank of the other branches. This rank
    is at least `proved_rank` and at most the number of the other branches. It is also at most the
    dimension of the motions on which all folds are flat that are proved flat on all these branches.
    If all heights are exact rationals, the rank is computed.
    """
    chosen = [branches[b] for b in others]
    most = min(len(chosen), size)
    if proved_rank < most:
        most = min(most, _motions_with_flat_folds(chosen))
    if proved_rank < most:
        exact = _exact_rank(chosen)
        if exact is not None:
            return size - exact, size - exact
    return size - most, size - proved_rank


def _motions_with_flat_folds(branches: Sequence[Branch]) -> int:
    """The dimension of the first-order motions on which the folds that are flat on all branches are
    flat.
    """
    from exactfold.exact.linalg import rank  # imported here because it loads FLINT

    pattern = branches[0].pattern
    vertices = range(len(pattern.vertices))
    rows = []
    for fold in pattern.folds:
        if all(branch.assignment[fold] == "F" for branch in branches):
            weights = fold_functional(pattern, fold)
            rows.append([weights.get(v, 0) for v in vertices])
    return len(vertices) - 3 - rank(rows)


def _exact_rank(branches: Sequence[Branch]) -> int | None:
    """The rank of the branches if all their heights are known to be rational; otherwise None.

    Heights are taken modulo planes: three corners of the boundary have height 0 in every branch of
    a count.
    """
    from exactfold.exact.linalg import rank  # imported here because it loads FLINT

    rows = []
    for branch in branches:
        heights = branch.exact_heights
        if heights is None or not all(isinstance(h, Fraction) for h in heights.values()):
            return None
        rows.append(_densities(branch, heights))
    return rank(rows)


def _densities(branch: Branch, heights: Mapping[int, Fraction]) -> list[Fraction]:
    """Exact fold densities, that is, fold angles divided by lengths; they have the same rank."""
    angles = fold_angles(branch.pattern, {v: (h, h) for v, h in heights.items()})
    return [low for low, _ in angles.densities.values()]


def orthogonal_torques(
    directions: Directions, chosen: int, silent: Sequence[int], moving: BoolArray
) -> OrthogonalTorques | None:
    """The strongest torques on branch `chosen` that do no work on the branches at `silent`.

    The branches at `silent` span all other branches. None if no such torques are found that work on
    the chosen branch.
    """
    units: FloatArray = directions.middles
    strongest = strongest_within(units[chosen], units[list(silent)], moving)
    if strongest is None:
        return None
    # The solver allows errors of 1e-7. Projecting makes the torques orthogonal up to rounding.
    basis = qr(units[list(silent)].T, mode="economic")[0] if len(silent) else units[:0].T
    for _ in range(2):
        strongest = strongest - basis @ (basis.T @ strongest)
    strongest = np.where(moving, strongest, 0.0) / max(1.0, np.abs(strongest).max())
    torques = [Fraction(round(x * 10**15), 10**15) for x in strongest.tolist()]
    powers = Powers.of(directions, torques)
    least = powers.bounds(chosen)[0]
    others = np.arange(len(directions)) != chosen
    largest = max(np.maximum(powers.high, -powers.low)[others].tolist(), default=0)
    if least <= 0:
        return None
    share = Fraction(largest, powers.unit) / least
    return OrthogonalTorques(dict(zip(directions.folds, torques, strict=True)), share)
