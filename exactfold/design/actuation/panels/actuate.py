"""`actuate_panels`: torques that drive rigid panels along one way with the best margin."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design.actuation.actuate import NODES
from exactfold.design.actuation.hinges import Hinges
from exactfold.design.actuation.orthogonal import (
    OrthogonalTorques,
    independent_rows,
    orthogonal_torques,
)
from exactfold.design.actuation.panels.motions import WayMotions
from exactfold.design.actuation.panels.rays import Rays, WayPower
from exactfold.design.actuation.panels.result import PanelActuation
from exactfold.design.actuation.panels.search import Best, TorquesForWay
from exactfold.design.actuation.panels.self_folding import decide_self_folding, rival_motions
from exactfold.design.actuation.result import check_question, checked_torques, outward
from exactfold.errors import NotCountedError, UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.motion.panels.followable import PanelMode
from exactfold.motion.panels.listing import PanelWay, Rates, panel_ways, require_listed
from exactfold.panels.result import Decomposition
from exactfold.pattern.panel_pattern import Edge


def actuate_panels(
    result: Decomposition,
    way: int,
    *,
    rates: Rates | None = None,
    creases: int | None = None,
    torques: Mapping[Edge, RationalLike] | None = None,
    hinges: Hinges | None = None,
    nodes: int = NODES,
    progress: Progress | None = None,
) -> PanelActuation:
    """Torques on the folds that prefer one way of rigid panels by the largest margin.

    `result` has the ways, and `way` is the number of one in its list. The ray that is driven turns
    all motions of the way by the same share. `rates` are positive for a motion that turns as
    `count` lists it, and negative for the other side. The margin is the power on this ray minus the
    largest on a rival (docs/actuation.md, 7). `creases`, `torques` and `nodes` are those of
    `actuate`. With `hinges`, the stiffness of the spring at a fold is in proportion to its length,
    and the torques are rest angles in radians; otherwise all springs have the same stiffness.

    Raises `UsageError` for a way that is not proved to truly fold, for fewer creases than the way
    has degrees of freedom, and for other wrong arguments; `NotCountedError` for a way that is a
    family in a space of motions, and for more than 4,096 ways.

    >>> from exactfold.branches.counting.ways import count_ways
    >>> found = actuate_panels(count_ways("square-twist"), 1)
    >>> found
    <PanelActuation of way 1: proved, margin 0.9886 of at most 0.9886>
    >>> found.self_foldable
    <Verdict.REFUTED: 'refuted'>
    """
    start = time.perf_counter()
    known = result.known
    ways = panel_ways(known)
    require_listed(ways, way)
    chosen = ways[way - 1]
    _check(known, chosen, creases, torques, nodes)
    if progress is not None:
        progress("fold angles", 0, 0)
    motions = WayMotions.of(known, ways, "equal" if hinges is None else "by length")
    search = _Search(known, chosen, motions, rates or {}, creases, torques, nodes, progress)
    return replace(search.found(), hinges=hinges, seconds=time.perf_counter() - start)


def _check(
    result: Decomposition,
    way: PanelWay,
    creases: int | None,
    torques: Mapping[Edge, RationalLike] | None,
    nodes: int,
) -> None:
    pattern = result.pattern
    if way.why_not_followed:
        raise UsageError(f"{way.why_not_followed}: name a way that truly folds")
    if way.spaces and way.dimension > 1:
        raise NotCountedError(
            f"way {way.number} is a family in a space of motions of vertices with more than four "
            "folds: torques are found for isolated ways and for families that modes span"
        )
    check_question(pattern, creases, torques, nodes)
    if creases is not None and creases < way.dimension:
        raise UsageError(
            f"way {way.number} has {way.dimension} degrees of freedom: drive at least "
            f"{way.dimension} creases, not {creases}"
        )


class _Search:
    """The work of one call of `actuate_panels`."""

    def __init__(
        self,
        result: Decomposition,
        listed: PanelWay,
        motions: WayMotions,
        rates: Rates,
        creases: int | None,
        torques: Mapping[Edge, RationalLike] | None,
        nodes: int,
        progress: Progress | None,
    ) -> None:
        self.result, self.listed, self.motions = result, listed, motions
        self.creases, self.nodes, self.progress = creases, nodes, progress
        self.given = None if torques is None else checked_torques(result.pattern, torques)
        self.way = motions.way(listed.number)
        self.sides = {place: self._side(place, rates) for place in self.way.motions}
        self.rays = Rays(motions, self.way, self.sides)

    def found(self) -> PanelActuation:
        """The torques, what they do, and whether the way is self-foldable."""
        search = TorquesForWay(self.rays, self.progress)
        best = search.best(self.creases, self.nodes)
        torques, bound = best.torques, best.bound
        shown = best.shown
        if self.given is not None:
            torques = list(self.given.values())
            bound *= max(map(abs, torques))
            shown = bound
        powers = self.rays.powers(torques)
        margin, (_, bound) = outward(self.rays.margin(powers)), outward((bound, bound))
        status, reason = self._judged(margin, torques)
        verdict, why = decide_self_folding(self.motions, self.way)
        folds = self.motions.directions.folds
        ranking = [self.rays.way_power(way, powers) for way in self.motions.ways]
        return PanelActuation(
            self.result.pattern,
            self.result,
            self.listed,
            self._letters(),
            status,
            reason,
            verdict,
            why,
            dict(zip(folds, torques, strict=True)),
            margin,
            bound,
            self.creases,
            self.given is not None,
            self.motions.springs,
            outward(powers.bounds(self.rays.target)),
            outward(self.rays.largest_rival(powers)),
            tuple(sorted(map(_outward, ranking), key=lambda row: (-sum(row.power), row.number))),
            self._without(best),
            self._alone() if verdict is PROVED else None,
            self.motions,
            tuple(self.sides[place] for place in self.way.motions),
            best.proof,
            outward((shown, shown))[1],
        )

    def _side(self, place: int, rates: Rates) -> int:
        source = self.motions.motions[place].source
        key = source.number if isinstance(source, PanelMode) else source
        rate = rates.get(key, 1.0) if isinstance(key, int | tuple) else 1.0
        return -1 if rate < 0 else 1

    def _letters(self) -> dict[Edge, str]:
        """The letters on the ray that is driven."""
        letters: dict[Edge, str] = {}
        rows = self.motions.directions
        for place in self.way.motions:
            for k, fold in enumerate(rows.folds):
                low, high = rows.low[place][k], rows.high[place][k]
                if low > 0 or high < 0:
                    letter = "V" if low > 0 else "M"
                    turned = letter.translate(UPSIDE_DOWN)
                    letters[fold] = letter if self.sides[place] > 0 else turned
        return letters

    def _judged(self, margin: tuple[Fraction, Fraction], torques: Sequence[Fraction]) -> _Judged:
        """The verdict that the bounds of the margin allow, and the reason for it."""
        if not any(torques):
            return UNDECIDED, "no torques on so few creases were found that prefer the way"
        if margin[1] <= 0:
            return REFUTED, "a rival has as much power, or more"
        if margin[0] <= 0:
            return UNDECIDED, "the bounds do not tell whether the way has the most power"
        if self.motions.unknown:
            return UNDECIDED, self.motions.unknown
        return PROVED, "the way has more power than every other way"

    def _without(self, best: Best) -> dict[Edge, Fraction]:
        """For each fold that bends a bound of the margin without it, the smallest first."""
        total = sum(best.shares, Fraction(0))
        folds = zip(self.motions.directions.folds, best.shares, strict=True)
        order = sorted((-share, fold) for fold, share in folds if share)
        return {fold: outward((total + share, total + share))[1] for share, fold in order}

    def _alone(self) -> OrthogonalTorques | None:
        """Torques that do work on this way and nearly none on the others."""
        rows = self.motions.directions
        others = rival_motions(self.motions, self.way)
        target = self.rays.target
        alone = replace(
            rows,
            low=(tuple(self.rays.low[target]), *(rows.low[k] for k in others)),
            high=(tuple(self.rays.high[target]), *(rows.high[k] for k in others)),
        )
        basis = independent_rows(alone, range(1, len(others) + 1))
        moving = np.array([any(row[k] for row in rows.low) for k in range(len(rows.folds))])
        return None if basis is None else orthogonal_torques(alone, 0, basis[0], moving)


_Judged = tuple[Verdict, str]


def _outward(row: WayPower) -> WayPower:
    return replace(row, power=outward(row.power))


def named_wholly(way: PanelWay, rates: Rates) -> None:
    """Raise `UsageError` if a motion names only some of the modes of a family.

    Torques that drive some modes of a family drive its other modes, too, or leave them free.
    """
    if any(number not in rates for number in way.numbers):
        raise UsageError(
            f"these letters name a part of way {way.number}, a family of "
            f"{counted(way.dimension, 'dimension')}: give M or V for all its folds, or its number"
        )
