"""Searches the torques that drive one ray of rigid panels with the largest margin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold._support.progress import Progress
from exactfold.design.actuation.choices import CreaseChoice
from exactfold.design.actuation.panels.rays import Rays, Recipe
from exactfold.design.actuation.powers import Weights, exact_weights, margin_bound, shares
from exactfold.design.actuation.programs import Proposal, largest_margin

_JOINING: Final = 24
"""At most so many rivals join the linear program at once."""

_ROUNDS: Final = 80
"""After so many linear programs no more rivals join; the bound holds all the same."""

_CHOICES: Final = 6
"""The choice of creases is repeated at most so often, with more points of families."""

_CLOSE: Final = 1e-6
"""A rival joins if it exceeds the largest power that is allowed by this share of the margin."""

_DIGITS: Final = (6, 9, 12)


@dataclass(frozen=True)
class Best:
    """The torques found, the proved bound of all margins, and the shares of the folds in the bound
    of torques on all folds. Without one of these folds, no margin exceeds that bound less its
    share. The rivals and weights of `proof` show the bound, or for few folds a bound that may be
    larger, `shown`.
    """

    torques: list[Fraction]
    bound: Fraction
    shares: list[Fraction]
    proof: tuple[tuple[Recipe, Fraction], ...]
    shown: Fraction


class TorquesForWay:
    """Linear programs over a growing list of rivals: isolated rays, and points of families.

    The power on a family is the length of a projection, so that its largest rival is a point of a
    sphere. A program with some points bounds that with all of them, and the point with the most
    power joins until none has more than the program allows.
    """

    def __init__(self, rays: Rays, progress: Progress | None = None) -> None:
        self.rays, self.progress = rays, progress
        self.families = [w for w in rays.ways if len(w.motions) > 1 and not w.is_cone]
        self.units = rays.units
        self.allowed: BoolArray = np.any(self.units != 0, axis=0)
        turned = len(rays.way.motions)
        self.known = list(range(turned))

    def best(self, creases: int | None, nodes: int) -> Best:
        """The best torques on all folds, or on so many of them."""
        proposal = self._on_all_folds()
        rays, directions = [self.rays.rivals[k] for k in self.known], self.rays.directions
        weights: Weights = exact_weights(rays, proposal.weights)
        bound = margin_bound(directions, self.rays.target, weights)
        by_fold = shares(directions, self.rays.target, weights)
        torques, shown = proposal.torques, bound
        if creases is not None and creases < int(self.allowed.sum()):
            torques, bound = self._on_few_folds(creases, nodes)
            weights, shown = self._shown_on_few(creases)
        proof = tuple((self.rays.recipe(ray), weight) for ray, weight in weights)
        return Best(self.rounded(torques), bound, by_fold, proof, max(bound, shown))

    def _shown_on_few(self, creases: int) -> tuple[Weights, Fraction]:
        """Weights, and the bound that they show of torques on so many folds."""
        rays = self.rays.rivals
        gaps = self._gaps(range(len(rays)))
        proposal = largest_margin(gaps, self.allowed, self.allowed, creases)
        weights = exact_weights(rays, proposal.weights)
        every = [True] * len(self.allowed)
        return weights, margin_bound(
            self.rays.directions, self.rays.target, weights, every, creases
        )

    def _on_all_folds(self) -> Proposal:
        for done in range(_ROUNDS):
            if self.progress is not None:
                self.progress("torques", done, _ROUNDS)
            gaps = self._gaps(self.known)
            proposal = largest_margin(gaps, self.allowed)
            if not self._join(proposal):
                break
        return proposal

    def _join(self, proposal: Proposal) -> bool:
        """Let the rivals join that have more power than the program allows; say if there are any"""
        tau = proposal.torques
        most = float(self.units[self.rays.target] @ tau) - proposal.margin
        most += _CLOSE * max(proposal.margin, _CLOSE)
        powers = self.units @ tau
        values = [(sign * powers[row], k) for k, (row, sign) in enumerate(self.rays.rivals)]
        fresh = sorted((v, k) for v, k in values if v > most and k not in set(self.known))
        self.known += [k for _, k in fresh[-_JOINING:]]
        points = 0
        for way in self.families:
            own = [float(powers[k]) for k in way.motions]
            if float(np.linalg.norm(own)) > most and points < _JOINING:
                self.rays.add_point(way, own)
                self.known.append(len(self.rays.rivals) - 1)
                points += 1
        if points:
            self.units = self.rays.units
        return bool(fresh) or points > 0

    def _gaps(self, which: Sequence[int]) -> FloatArray:
        rays = [self.rays.rivals[k] for k in which]
        gaps: FloatArray = self.units[self.rays.target] - np.array(
            [sign * self.units[row] for row, sign in rays]
        )
        return gaps

    def _on_few_folds(self, creases: int, nodes: int) -> tuple[FloatArray, Fraction]:
        """Branch and bound over the choices of folds, with more points of families each time."""
        best: tuple[float, FloatArray] = 0.0, np.zeros(len(self.allowed))
        bound: Fraction | None = None
        for _ in range(_CHOICES):
            everything = range(len(self.rays.rivals))
            rivals = [self.rays.rivals[k] for k in everything]
            search = CreaseChoice(
                self.rays.directions,
                self.rays.target,
                rivals,
                self._gaps(everything),
                self.allowed,
                creases,
            )
            choice = search.best(nodes, self.progress)
            bound = choice.bound if bound is None else min(bound, choice.bound)
            value = self._margin(choice.torques)
            if value > best[0]:
                best = value, choice.torques
            proposal = Proposal(choice.torques, search.margin, np.zeros(0))
            if not self.families or not self._join(proposal):
                break
        return best[1], bound if bound is not None else Fraction(0)

    def _margin(self, torques: FloatArray) -> float:
        """The margin in floating point."""
        powers = self.units @ torques
        rivals = [float(sign * powers[row]) for row, sign in self.rays.rivals]
        rivals += [float(np.linalg.norm(powers[list(w.motions)])) for w in self.families]
        return float(powers[self.rays.target]) - max(rivals)

    def rounded(self, torques: FloatArray) -> list[Fraction]:
        """Decimal torques with few digits whose margin is nearly that of the given ones."""
        exact = [max(Fraction(-1), min(Fraction(1), Fraction(x))) for x in torques.tolist()]
        wanted = self.rays.margin(self.rays.powers(exact))[0]
        for digits in _DIGITS:
            rounded = [Fraction(round(x * 10**digits), 10**digits) for x in exact]
            if self.rays.margin(self.rays.powers(rounded))[0] >= wanted * Fraction(9999, 10000):
                return rounded
        return rounded
