"""The choice of at most a given number of creases to drive, by branch and bound.

Every bound is proved.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from heapq import heappop, heappush

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold._support.progress import Progress
from exactfold.design.actuation.directions import Directions
from exactfold.design.actuation.powers import Ray, exact_weights, margin_bound
from exactfold.design.actuation.programs import Proposal, largest_margin

_JOINING = 8
"""At most this many rivals join the linear program at once."""

_SHORT = 1e-7
"""A rival joins only if it falls short of the margin by more than this, the solver's tolerance."""

_CLOSE = 1e-4
"""The search does not go on for a gain smaller than this share of the margin."""

_ZERO = 1e-9
"""A torque or a margin below this counts as 0."""


@dataclass(frozen=True)
class Choice:
    """The proposed `torques`, and a proved upper bound of the margin of all torques on so few
    folds.
    """

    torques: FloatArray
    bound: Fraction


@dataclass(order=True)
class _Node:
    """All choices that drive the folds `inside` and do not drive the folds `barred`."""

    order: tuple[float, int]
    inside: BoolArray = field(compare=False)
    barred: BoolArray = field(compare=False)
    bound: Fraction | None = field(compare=False)


class CreaseChoice:
    """Branch and bound over the choices of at most `most` folds.

    A linear program bounds each node. It limits the sum of the sizes of the torques instead of
    their number, so its dual solution bounds all choices of the node (`margin_bound`). As few
    rivals are decisive, the program contains only some of them, and others join when they are
    needed. A bound from some of the rivals also holds with all of them.
    """

    def __init__(
        self,
        directions: Directions,
        chosen: int,
        rays: list[Ray],
        gaps: FloatArray,
        allowed: BoolArray,
        most: int,
    ) -> None:
        self.directions, self.chosen, self.rays, self.gaps = directions, chosen, rays, gaps
        self.allowed, self.most = allowed, most
        start = largest_margin(gaps, allowed, allowed, most)
        self.known = np.flatnonzero(start.weights > 0)
        self.torques, self.margin = np.zeros(len(allowed)), 0.0
        self.tried: set[bytes] = set()
        self._improve(start.torques)

    def best(self, nodes: int, progress: Progress | None = None) -> Choice:
        """The best torques found with at most this many nodes, and the bound of all choices."""
        nothing = np.zeros(len(self.allowed), dtype=np.bool_)
        queue = [_Node((-np.inf, 0), nothing, ~self.allowed, None)]
        settled: list[Fraction] = []
        made = 1
        for done in range(nodes):
            if not queue or (-queue[0].order[0] <= self._enough and queue[0].bound is not None):
                break
            if progress is not None:
                progress("choice of creases", done, nodes)
            node = heappop(queue)
            proposal, bound = self._bounded(node)
            fold = self._undecided(proposal, node)
            if proposal.margin <= self._enough or fold is None:
                settled.append(bound)
                continue
            for taken in (True, False):
                inside, barred = node.inside.copy(), node.barred.copy()
                (inside if taken else barred)[fold] = True
                if inside.sum() == self.most:
                    barred = ~inside
                heappush(queue, _Node((-proposal.margin, made), inside, barred, bound))
                made += 1
        open_bounds = [node.bound for node in queue if node.bound is not None]
        return Choice(self.torques, max([*settled, *open_bounds]))

    @property
    def _enough(self) -> float:
        return self.margin * (1 + _CLOSE) + _ZERO

    def _bounded(self, node: _Node) -> tuple[Proposal, Fraction]:
        """The solution of a node's linear program, and the proved bound of the node's choices."""
        limited = ~node.inside & ~node.barred
        left = self.most - int(node.inside.sum())
        while True:
            proposal = largest_margin(self.gaps[self.known], ~node.barred, limited, left)
            values = self.gaps @ proposal.torques
            worst = np.argsort(values, kind="stable")[:_JOINING]
            joining = np.setdiff1d(worst[values[worst] < proposal.margin - _SHORT], self.known)
            if not len(joining):
                break
            self.known = np.union1d(self.known, joining)
        self._improve(proposal.torques)
        rays = [self.rays[r] for r in self.known]
        bound = margin_bound(
            self.directions,
            self.chosen,
            exact_weights(rays, proposal.weights),
            limited.tolist(),
            left,
            node.barred.tolist(),
        )
        return proposal, bound

    def _improve(self, torques: FloatArray) -> None:
        """Try the folds with the largest torques; keep them if they are the best choice so far."""
        sizes = np.where(self.allowed, np.abs(torques), -1.0)
        support = np.zeros(len(torques), dtype=np.bool_)
        support[np.argsort(-sizes, kind="stable")[: self.most]] = True
        if support.tobytes() in self.tried:
            return
        self.tried.add(support.tobytes())
        known = largest_margin(self.gaps[self.known], support & self.allowed)
        if known.margin <= self._enough:  # with all rivals the margin is no larger
            return
        proposal = largest_margin(self.gaps, support & self.allowed)
        if proposal.margin > self.margin:
            self.torques, self.margin = proposal.torques, proposal.margin

    def _undecided(self, proposal: Proposal, node: _Node) -> int | None:
        """The fold with the largest torque that is neither inside nor barred.

        None if so few folds are driven that the program has found the best choice of the node.
        """
        driven = np.abs(proposal.torques) > _ZERO
        if int((driven | node.inside).sum()) <= self.most:
            return None
        sizes = np.where(node.inside | node.barred, -1.0, np.abs(proposal.torques))
        return int(np.argmax(sizes))
