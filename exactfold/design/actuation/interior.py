"""The linear programs of all branches of a sheet, solved together in floating point.

The results prove nothing by themselves. The method is a primal-dual interior point method with
predictor and corrector (Mehrotra, SIAM Journal on Optimization 2, 1992) for the programs of
`programs.largest_margin`. Each branch has all other rays as rivals, so the programs differ only in
one ray, and matrix products make the normal equations of all programs at once. Close to the
solution, the constraints that seem tight form a square system; its solution is a vertex of the
program, up to rounding errors.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from copy import copy
from dataclasses import dataclass, replace

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray, IndexArray
from exactfold.design.actuation.powers import Ray

_STEPS = 40
"""The largest number of steps; 8 to 20 are usual."""

_GAP = 1e-9
"""A program ends when its margin and its bound differ by less than this."""

_STEP = 0.999
"""A step goes this share of the way to the nearest constraint."""

_ENTRIES = 1 << 18
"""The largest number of programs times rays that are in memory at once."""

_DAMPING = 2e-15
"""Regularises the directions in which torques are equally good."""

_SMALL = 1e-12
"""Weights below this are dropped."""


@dataclass(frozen=True)
class RayProposal:
    """Proposed `torques` by fold, and `weights` of the rivals `rays` that bound all margins."""

    torques: FloatArray
    rays: list[Ray]
    weights: FloatArray


def largest_margins(units: FloatArray, places: IndexArray) -> Iterator[RayProposal | None]:
    """For each row u of `units` at `places`, torques that maximise the least (u - u') . tau.

    The torques satisfy |tau_e| <= 1. The least is taken over all rays u' other than u; the rays are
    the rows and their opposites. If a program fails, the result is None, or the torques and weights
    are poor; the proof that follows reveals this.

    >>> for answer in largest_margins(np.array([[1.0, 0.0], [0.6, 0.8]]), np.arange(2)):
    ...     print(answer.torques.round(6).tolist(), answer.rays, answer.weights.round(6).tolist())
    [1.0, -0.75] [(1, 1), (1, -1)] [0.5, 0.5]
    [0.0, 1.0] [(0, 1), (0, -1)] [0.8, 0.2]
    """
    moving = (units != 0).any(axis=0)
    inner = units[:, moving]
    # `basis` spans the space of all motions, which has a small dimension.
    _, sizes, basis = np.linalg.svd(inner, full_matrices=False)
    basis = basis[sizes > 1e-12 * sizes[0]]
    number = max(1, _ENTRIES // len(units))
    for start in range(0, len(places), number):
        programs = _Programs(inner, basis, places[start : start + number])
        programs.solve()
        for k in range(len(programs.places)):
            proposal = programs.proposal(k)
            if proposal is None:
                yield None
                continue
            torques = np.zeros(len(moving))
            torques[moving] = proposal.torques
            yield replace(proposal, torques=torques)


class _Programs:
    """Maximise m with A (tau, m) + c >= 0 for the branches at `places`, one program per row.

    The constraints lie along the last axis of `slack` and of the multipliers `force`, in this
    order: (u - u_r) . tau >= m for each ray u_r; (u + u_r) . tau >= m for each ray; tau <= 1 for
    each fold; tau >= -1 for each fold. The ray u is not its own rival: where `counts` is False, the
    slack stays 1 and the multiplier stays 0. The multipliers are a solution of the dual program,
    A^T force = (0, -1).
    """

    def __init__(self, units: FloatArray, basis: FloatArray, places: IndexArray) -> None:
        self.units, self.basis, self.places = units, basis, places
        self.own = units[places]
        self.rays, self.folds = units.shape
        inner = units @ basis.T
        self.squares = (inner[:, :, None] * inner[:, None, :]).reshape(self.rays, -1)
        number = len(places)
        self.counts: BoolArray = np.ones((number, 2 * (self.rays + self.folds)), dtype=np.bool_)
        self.counts[np.arange(number), places] = False
        self.constraints = self.counts.shape[1] - 1
        # tau = 0, m = -1, and equal weights.
        self.tau = np.zeros((number, self.folds))
        self.slack = np.ones(self.counts.shape)
        self.force = np.where(self.counts, 1.0 / (2 * self.rays - 1), 0.0)
        self.force[:, 2 * self.rays :] = 0.0
        pull, _ = self.gathered(self.force)
        pushes = np.hstack([np.maximum(pull, 0.0), np.maximum(-pull, 0.0)])
        self.force[:, 2 * self.rays :] = pushes + 1.0 / self.folds

    def moved(self, tau: FloatArray, m: FloatArray) -> FloatArray:
        """A (tau, m): the change of the slacks caused by a step."""
        others = tau @ self.units.T
        own = (tau * self.own).sum(axis=1) - m
        moved = np.hstack([own[:, None] - others, own[:, None] + others, -tau, tau])
        return np.where(self.counts, moved, 0.0)

    def gathered(self, force: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The two parts of A^T force."""
        with_u, against, below, above = self.parts(force)
        total = (with_u + against).sum(axis=1)
        pull = total[:, None] * self.own - (with_u - against) @ self.units
        return pull - below + above, -total

    def parts(self, values: FloatArray) -> list[FloatArray]:
        """The values split into the four kinds of constraints."""
        rays, folds = self.rays, self.folds
        return np.split(values, [rays, 2 * rays, 2 * rays + folds], axis=1)

    def solve(self, steps: int = _STEPS) -> None:
        """Step until all programs have ended. When few are left, only these go on."""
        for done in range(steps):
            gaps = (self.slack * self.force).sum(axis=1)
            going = gaps >= _GAP
            if 2 * going.sum() < len(going):
                self._solve_some(np.flatnonzero(going), steps - done)
                break
            try:
                self._step(gaps / self.constraints, going)
            except np.linalg.LinAlgError:
                break

    def _solve_some(self, which: IndexArray, steps: int) -> None:
        """`solve` for some of the programs."""
        if not len(which):
            return
        part = copy(self)
        names = ("places", "own", "counts", "tau", "slack", "force")
        for name in names:
            setattr(part, name, getattr(self, name)[which])
        part.solve(steps)
        for name in names:
            getattr(self, name)[which] = getattr(part, name)

    def _step(self, mu: FloatArray, going: BoolArray) -> None:
        """One predictor-corrector step of all programs that are `going`."""
        stiff = self.force / self.slack
        solver = _Normal(self, stiff)

        def change(target: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
            """The change of torques, slacks and multipliers that makes slack * force the target."""
            wanted = np.where(self.counts, target / self.slack, 0.0)
            pull, total = self.gathered(wanted)
            tau, slack = solver.solve(pull, total + 1.0)
            return tau, slack, wanted - self.force - stiff * slack

        _, slack, force = change(np.zeros((len(mu), 1)))
        far = [_reach(values, step) for values, step in ((self.slack, slack), (self.force, force))]
        ahead = (self.slack + far[0][:, None] * slack) * (self.force + far[1][:, None] * force)
        centre = (ahead.sum(axis=1) / self.constraints / mu) ** 3 * mu
        tau, slack, force = change(centre[:, None] - slack * force)
        forth = np.where(going, _STEP * _reach(self.slack, slack), 0.0)[:, None]
        back = np.where(going, _STEP * _reach(self.force, force), 0.0)[:, None]
        self.tau += forth * tau
        self.slack += forth * slack
        self.force += back * force

    def proposal(self, k: int) -> RayProposal | None:
        """The better torques and the better weights of two points: the end of program k, and a
        vertex.
        """
        ends = [self._inside(k)]
        if not all(np.isfinite(values).all() for values in ends[0]):
            return None
        with suppress(np.linalg.LinAlgError):
            ends.append(self._vertex(k))
        torques = max((torques for torques, _ in ends), key=lambda tau: self._margin(k, tau))
        weights = min((weights for _, weights in ends), key=lambda w: self._bound(k, w))
        rays = np.flatnonzero(weights).tolist()
        named = [(r % self.rays, 1 if r < self.rays else -1) for r in rays]
        return RayProposal(torques, named, weights[rays])

    def _margin(self, k: int, torques: FloatArray) -> float:
        powers = self.units @ torques
        own = float(powers[self.places[k]])
        rivals = np.abs(powers)
        rivals[self.places[k]] = -own
        return own - float(rivals.max())

    def _bound(self, k: int, weights: FloatArray) -> float:
        rays = weights.reshape(2, -1)
        return float(np.abs(self.own[k] - (rays[0] - rays[1]) @ self.units).sum())

    def _inside(self, k: int) -> tuple[FloatArray, FloatArray]:
        """The point where program k has ended, inside all constraints."""
        weights = self.force[k, : 2 * self.rays]
        weights = np.where(weights > _SMALL, weights, 0.0)
        return self.tau[k], weights / weights.sum()

    def _vertex(self, k: int) -> tuple[FloatArray, FloatArray]:
        """The vertex near the end of program k at which the constraints that seem tight
        are tight.
        """
        tight = self.force[k] > self.slack[k]
        rays = np.flatnonzero(tight[: 2 * self.rays])
        fixed = tight[2 * self.rays :].reshape(2, -1)
        free = ~fixed.any(axis=0)
        signs = np.where(rays < self.rays, 1.0, -1.0)
        gaps = self.own[k] - signs[:, None] * self.units[rays % self.rays]
        torques = np.where(free, self.tau[k], fixed[0].astype(float) - fixed[1])
        matrix = np.column_stack([gaps[:, free], -np.ones(len(rays))])
        torques[free] -= np.linalg.lstsq(matrix, gaps @ torques)[0][:-1]
        force = self.force[k, rays]
        off = np.append(force @ gaps[:, free], 1.0 - force.sum())
        force = np.maximum(force - np.linalg.lstsq(matrix.T, off)[0], 0.0)
        weights = np.zeros(2 * self.rays)
        weights[rays] = force / force.sum()
        return np.clip(torques, -1.0, 1.0), weights


class _Normal:
    """The normal equations A^T D A (tau, m) = (pull, total) of the programs, with D diagonal.

    Let d_r and d'_r belong to the ray u_r and its opposite, s = sum_r (d_r + d'_r) and q = sum_r
    (d_r - d'_r) u_r. Once m is eliminated, the matrix of tau is sum_r (d_r + d'_r) u_r u_r^T - q
    q^T / s, plus a diagonal that comes from the bounds of the torques.
    """

    def __init__(self, programs: _Programs, stiff: FloatArray) -> None:
        with_u, against, below, above = programs.parts(stiff)
        both, size = with_u + against, len(programs.basis)
        self.programs, self.stiff = programs, stiff
        self.total = both.sum(axis=1)
        q = (with_u - against) @ programs.units
        self.v = self.total[:, None] * programs.own - q
        inner = (both @ programs.squares).reshape(-1, size, size)
        matrix = programs.basis.T @ inner @ programs.basis
        places = np.arange(programs.folds)
        diagonal = matrix[:, places, places]
        floor = _DAMPING * diagonal.max(axis=1, keepdims=True)
        matrix -= q[:, :, None] * q[:, None, :] / self.total[:, None, None]
        matrix[:, places, places] += below + above
        self.scale = 1.0 / np.sqrt(np.maximum(matrix[:, places, places], floor))
        matrix *= self.scale[:, :, None] * self.scale[:, None, :]
        matrix[:, places, places] += _DAMPING
        self.inverse = np.linalg.inv(matrix)

    def solve(self, pull: FloatArray, total: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return tau and the change of the slacks caused by (tau, m), after one iterative
        refinement.
        """
        tau, m = self._solved(pull, total)
        left, rest = self.programs.gathered(self.stiff * self.programs.moved(tau, m))
        more, further = self._solved(pull - left, total - rest)
        tau, m = tau + more, m + further
        return tau, self.programs.moved(tau, m)

    def _solved(self, pull: FloatArray, total: FloatArray) -> tuple[FloatArray, FloatArray]:
        right = self.scale * (pull + self.v * (total / self.total)[:, None])
        tau = self.scale * (self.inverse @ right[:, :, None])[:, :, 0]
        return tau, (total + (self.v * tau).sum(axis=1)) / self.total


def _reach(values: FloatArray, step: FloatArray) -> FloatArray:
    """For each row, the largest factor, at most 1, with values + factor * step >= 0."""
    falls = np.where(values > 0, -step / np.where(values > 0, values, 1.0), 0.0)
    factors: FloatArray = 1.0 / np.maximum(1.0, falls.max(axis=1))
    return factors
