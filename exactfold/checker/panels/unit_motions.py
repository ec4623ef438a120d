"""The motions of modes and free folds as unit vectors of fold angles, in intervals.

Springs hold the folds, all of the same stiffness or each in proportion to the length of its fold.
With stiffness k_e, the torques k_e t_e of springs that rest at the angles t_e have on a motion of
fold angles phi_e the power sum_e k_e t_e phi_e, where sum_e k_e phi_e^2 = 1 (docs/actuation.md, 9).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeVar

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most, items, natural, parse_rational, require
from ..core.towers import Number
from ..sheets.panels import Edge, PanelSheet, dot, pair, read_edges
from .certificate import kind_of, listed, paired, supports_of
from .components import maximal_sets
from .loops import Loops
from .modes import Modes, Support
from .reduction import BITS

Value = TypeVar("Value", Interval, Number)
Vector = dict[Edge, Interval]
EQUAL, BY_LENGTH = "equal", "by length"
MOST_WAYS = limits.TORQUE_WAYS


@dataclass
class UnitMotion:
    """One mode, or a fold from boundary to boundary.

    `row` has the numbers by which torques are multiplied, positive at the first fold. A mode has a
    `support`, and its lines at the vertices as a `choice`.
    """

    row: Vector
    support: Support | None
    choice: Mapping[int, int]

    @property
    def vertices(self) -> tuple[int, ...]:
        """The vertices that move."""
        return () if self.support is None else self.support.vertices


class UnitMotions:
    """All modes that truly fold, by support and choice, and all free folds.

    `claims` are those of a panels certificate that was verified. `named` finds a motion by the name
    that a file gives it: [k, choice] for a mode of support k of the claims, with its lines as
    there, or [i, j] for the free fold i-j.
    """

    def __init__(self, sheet: PanelSheet, claims: Any, springs: str) -> None:
        self.sheet, self.springs = sheet, springs
        held = read_edges(claims["held"], "held")
        self.near = sheet.live(held)
        self.modes = Modes(sheet, self.near)
        self.named: dict[tuple[int, Any], int] = {}
        self.motions: list[UnitMotion] = []
        self.lengths = {fold: self._length(fold) for fold in sheet.folds}
        places = {
            tuple(read_edges(entry["folds"], "folds of a support")): k
            for k, entry in enumerate(claims["supports"])
        }
        loops = Loops(self.modes)
        for support, entry in paired(supports_of(self.modes), claims["supports"]):
            for choice in self._folding(loops, support, entry):
                name = "".join(self._line(support, v, choice[v]) for v in support.vertices)
                densities = densities_of(
                    self.modes, support, choice, lambda gain: gain.enclosed(BITS)
                )
                self.named[places[support.folds], name] = len(self.motions)
                self.motions.append(UnitMotion(self._unit(densities), support, choice))
        for edge in read_edges(claims["free"], "free"):
            self.named[edge] = len(self.motions)
            one = {edge: Interval.of(Fraction(1), BITS)}
            self.motions.append(UnitMotion(self._unit(one), None, {}))

    def find(self, name: Any) -> int:
        """The place of the motion with a name; raises `CertificateError` for other names."""
        first, second = items(name, "a motion", 2)
        key = first, second
        require(
            type(first) is int and type(second) in (int, str) and key in self.named,
            f"{name!a} is no motion that truly folds",
        )
        return self.named[key]

    def ways(self) -> list[frozenset[int]]:
        """The ways: largest sets of modes without a common vertex, each with all free folds."""
        modes = [k for k, motion in enumerate(self.motions) if motion.support is not None]
        free = {k for k, motion in enumerate(self.motions) if motion.support is None}
        found: list[frozenset[int]] = []
        if modes:
            for chosen in maximal_sets([self.motions[k].vertices for k in modes]):
                found.append(frozenset([modes[k] for k in chosen]) | free)
                at_most(len(found), MOST_WAYS, "the ways", "TORQUE_WAYS")
        return found or ([frozenset(free)] if free else [])

    def _folding(
        self, loops: Loops, support: Support, entry: Mapping[str, Any]
    ) -> list[dict[int, int]]:
        """The modes of a support that truly fold; the claims about them were verified."""
        rows = self.modes.listed(support)
        if kind_of(loops, support) != "loops":
            return rows
        if entry["modes"] is not None:
            pairs = listed(self.modes, support, rows, entry["modes"])
            return [row for row, mode in pairs if mode and mode["extends"] == "proved"]
        return [row for row in rows if all(loops.closes(row, loop) for loop in support.loops)]

    def _line(self, support: Support, v: int, line: int) -> str:
        lines = support.choices[v]
        return "0" if len(lines) == 1 else "-+"[lines.index(line)]

    def _length(self, fold: Edge) -> Interval:
        along = self.sheet.vector(*fold)
        return dot(along, along).enclosed(BITS).root()

    def _unit(self, densities: Mapping[Edge, Interval]) -> Vector:
        angles = {fold: w * self.lengths[fold] for fold, w in densities.items()}
        forces = dict(angles)
        if self.springs == BY_LENGTH:
            forces = {fold: angle * self.lengths[fold] for fold, angle in angles.items()}
        squares = (forces[fold] * angle for fold, angle in angles.items())
        norm = sum(squares, start=Interval.of(Fraction(0), BITS)).root()
        return {fold: force / norm for fold, force in forces.items()}


def densities_of(
    modes: Modes, support: Support, row: Mapping[int, int], of: Callable[[Number], Value]
) -> dict[Edge, Value]:
    """The fold densities of a mode, 1 at its first fold; `of` makes values of the gains."""
    known = {support.folds[0]: of(modes.sheet.tower.number(1))}
    waiting = set(support.vertices)
    while waiting:
        v = next(u for u in sorted(waiting) if any(pair(u, w) in known for w in support.active[u]))
        waiting.remove(v)
        start = next(w for w in sorted(support.active[v]) if pair(v, w) in known)
        for w in support.active[v]:
            if pair(v, w) not in known:
                known[pair(v, w)] = known[pair(v, start)] * of(modes.gain(v, row[v], start, w))
    return known


def power(row: Mapping[Edge, Interval], torques: Mapping[Edge, Fraction]) -> Interval:
    """The power of torques on a motion."""
    total = Interval.of(Fraction(0), BITS)
    for fold, value in row.items():
        if torques[fold]:
            total = total + value * Interval.of(torques[fold], BITS)
    return total


def plus(one: Vector, weight: Interval, other: Mapping[Edge, Interval]) -> Vector:
    """The sum of a vector and a multiple of another."""
    total = dict(one)
    for fold, value in other.items():
        term = weight * value
        total[fold] = total[fold] + term if fold in total else term
    return total


def largest(interval: Interval) -> Fraction:
    """The largest size of a number of an interval."""
    return Fraction(max(-interval.low, interval.high, 0), 1 << interval.bits)


def root_of_sum(values: Sequence[Interval]) -> Interval:
    """The square root of the sum of squares."""
    squares = (value * value for value in values)
    return sum(squares, start=Interval.of(Fraction(0), BITS)).root()


class Torques:
    """The torques that a file claims, of size at most `limit`, on at most `most` folds."""

    def __init__(self, folds: Sequence[Edge], claims: Mapping[str, Any]) -> None:
        self.claims = claims
        values = items(claims["torques"], "torques", len(folds))
        self.by_fold = dict(zip(folds, map(parse_rational, values), strict=True))
        self.limit = parse_rational(claims["limit"])
        small = all(abs(torque) <= self.limit for torque in self.by_fold.values())
        require(small, "a torque is larger than the limit")
        self.most: int | None = None
        if claims["creases"] is not None:
            self.most = natural(claims["creases"], "creases")
            number = sum(torque != 0 for torque in self.by_fold.values())
            require(number <= self.most, f"{number} folds are driven, more than {self.most}")

    def check_margin(self, target: Interval, rivals: int) -> None:
        """Refuse a margin unless the power on the ray exceeds that of all rivals by it.

        `rivals` is at least the largest power on a rival, with `BITS` bits after the point.
        """
        margin = parse_rational(self.claims["margin"])
        require(margin > 0, "the margin is not positive")
        require(
            margin <= Fraction(target.low - rivals, 1 << BITS),
            "the power on the ray does not exceed that on every rival by the margin",
        )

    def check_bound(self, gap: Vector, weights: Fraction) -> None:
        """Refuse a bound that the target less the weighted rays, `gap`, does not prove.

        `weights` is the sum of the weights.
        """
        require(weights == 1, "the weights of the rays do not add up to 1")
        sizes = sorted(map(largest, gap.values()), reverse=True)[: self.most]
        require(
            sum(sizes, Fraction(0)) * self.limit <= parse_rational(self.claims["bound"]),
            "the rays and their weights do not prove the bound",
        )


def weight_of(text: Any) -> Fraction:
    """The weight of a ray, which is not negative."""
    weight = parse_rational(text)
    require(weight >= 0, "a weight is negative")
    return weight
