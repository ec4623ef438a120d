"""What is known of the branches of a periodic sheet over all directions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from itertools import zip_longest
from math import atan2, degrees, gcd, lcm
from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import (
    Keywords,
    Natural,
    NotNegative,
    Pair,
    Positive,
    Rational,
    Side,
    SignsText,
)
from exactfold._support.plurals import counted
from exactfold._support.verdict import Verdict
from exactfold.branches.periodic.result import Whole
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern

Interval = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class RollingBranch:
    """One branch for every direction: its vertex signs, and the sign of b on the same side.

    The side is that on which the first vertex, outside triangulated triangles, pops up.
    """

    vertex_signs: str
    b: int


@dataclass(frozen=True)
class ExactDirection:
    """A direction n = (x(t), y(t)), up to a factor, where t is a root of an integer polynomial.

    All polynomials have their constant term first. `interval` holds exactly one root of
    `polynomial`, which is irreducible. A rational direction has constants x and y.
    """

    polynomial: tuple[int, ...]
    interval: Interval
    x: tuple[int, ...]
    y: tuple[int, ...]

    @classmethod
    def of(
        cls, polynomial: Sequence[int], interval: Interval, x: Sequence[int], y: Sequence[int]
    ) -> ExactDirection:
        """The direction; a rational one is the shortest integer vector that points up.

        The degrees of x and y are less than that of a polynomial of degree two or more.

        >>> str(ExactDirection.of((-1, 2), (Fraction(1, 2), Fraction(1, 2)), (0, 4), (-6,)))
        '-1,3'
        """
        pair: list[Fraction] | None = None
        if len(polynomial) == 2:
            t = Fraction(-polynomial[0], polynomial[1])
            pair = [sum((c * t**k for k, c in enumerate(form)), Fraction(0)) for form in (x, y)]
        else:  # x / y is rational where all coefficients have this quotient
            places = list(zip_longest(x, y, fillvalue=0))
            p, q = next(place for place in places if any(place))
            if all(p * d == q * c for c, d in places):
                pair = [Fraction(p), Fraction(q)]
        if pair is not None:
            common = lcm(*(z.denominator for z in pair))
            whole = [int(z * common) for z in pair]
            scale = gcd(*whole) * (-1 if whole[1] < 0 or (whole[1] == 0 > whole[0]) else 1)
            return cls(
                (0, 1), (Fraction(0), Fraction(0)), (whole[0] // scale,), (whole[1] // scale,)
            )
        common = gcd(*x, *y)
        return cls(
            tuple(polynomial),
            interval,
            tuple(c // common for c in x),
            tuple(c // common for c in y),
        )

    @property
    def is_rational(self) -> bool:
        """Whether the direction is rational."""
        return len(self.x) == 1 == len(self.y)

    @property
    def angle(self) -> float:
        """The angle in degrees, in (0, 180], in floats."""
        t = sum(self.interval) / 2
        x, y = (sum(c * t**k for k, c in enumerate(form)) for form in (self.x, self.y))
        if not y:
            return 180.0
        return degrees(atan2(1.0, x / y))

    def __str__(self) -> str:
        if self.is_rational:
            return f"{self.x[0]},{self.y[0]}"
        return f"algebraic, of degree {len(self.polynomial) - 1}"

    def to_dict(self) -> ExactDirectionDocument:
        """The object in the JSON."""
        low, high = self.interval
        return {
            "polynomial": [format_integer(c) for c in self.polynomial],
            "interval": [format_rational(low), format_rational(high)],
            "x": [format_integer(c) for c in self.x],
            "y": [format_integer(c) for c in self.y],
        }


@dataclass(frozen=True)
class BranchCrossing:
    """A direction and a solution at which stars are flat: the 2^(number of them) branches there.

    `vertices` are those that are flat at this direction only, and have other signs after it than
    before on each of these branches. `vertex_signs` has 0 for them, and `b` is the sign of b on the
    same side. `angle` is that of the direction, in degrees from 0 (excluded) to 180, in floats.
    """

    direction: ExactDirection
    angle: float
    vertex_signs: str
    b: int
    vertices: tuple[int, ...]

    def to_dict(self) -> BranchCrossingDocument:
        """The object in the JSON."""
        return {
            "direction": self.direction.to_dict(),
            "degrees": round(self.angle, 9),
            "vertex_signs": self.vertex_signs,
            "b": self.b,
            "vertices": list(self.vertices),
        }


class ExactDirectionDocument(TypedDict):
    """A direction n = (x(t), y(t)) up to a factor; polynomials have their constant term first."""

    polynomial: list[Whole]
    """An irreducible polynomial with the root t."""
    interval: Pair[Rational]
    """Bounds of the one root t that is meant."""
    x: list[Whole]
    """The polynomial x(t)."""
    y: list[Whole]
    """The polynomial y(t)."""


class BranchCrossingDocument(TypedDict):
    """A direction and a solution at which stars are flat."""

    direction: ExactDirectionDocument
    """The direction, exactly."""
    degrees: float
    """Its angle, more than 0 and at most 180, in floating point."""
    vertex_signs: SignsText
    """The signs of the solution: 0 where a star is flat."""
    b: Side
    """The sign of b on this side."""
    vertices: list[Natural]
    """The vertices that change their signs on each branch through the solution."""


class RollingBranchDocument(TypedDict):
    """A branch for every direction."""

    vertex_signs: SignsText
    """Its signs, except at crossings."""
    b: Side
    """The sign of b on this side, for all directions."""


class DirectionsDocument(TypedDict):
    """The branches of a periodic sheet over all directions."""

    format: Literal["exactfold directions result"]
    version: Literal[1]
    name: str | None
    """The file or the name of the cell."""
    status: Annotated[str, Keywords(enum=["proved", "undecided"])]
    """Proved: the branches, their crossings and the permutation are these."""
    reason: str
    """How it was proved, or what is open."""
    vertices: Positive
    """The number V of vertices in the cell."""
    branches: list[RollingBranchDocument]
    """A branch for each pair of opposite sign vectors, sorted; empty if they are not known."""
    crossings: list[BranchCrossingDocument]
    """All crossings for directions counter-clockwise; some of them if undecided."""
    permutation: list[Positive] | None
    """After a half turn, from just after 1,0: as which branch, from 1, each of them continues."""
    cycles: list[list[Positive]] | None
    """The cycles of the permutation; null if undecided."""
    families: list[ExactDirectionDocument] | None
    """All directions with families, proved; null if they are not known."""
    seconds: NotNegative
    """The time that it took."""


@dataclass(frozen=True, repr=False)
class DirectionsCount:
    """The branches of a periodic sheet over all directions (docs/tessellations.md, Theorem 19).

    `branches` has one entry for each pair of opposite sign vectors, in the order in which
    `count_periodic` lists them at a direction without flat stars. `crossings` are sorted
    counter-clockwise, from just after the direction (1, 0) through a half turn, and (1, 0) itself
    comes last. `permutation` says as which branch, from 0, each branch comes back after this half
    turn if it is followed analytically; it is None if that is undecided. Clockwise it is inverted.
    `families` are all directions in which linear spaces of two or more dimensions have b other than
    0, proved also where `status` is UNDECIDED; None if they are not known.
    """

    pattern: PeriodicPattern
    status: Verdict
    reason: str
    branches: tuple[RollingBranch, ...]
    crossings: tuple[BranchCrossing, ...]
    permutation: tuple[int, ...] | None
    families: tuple[ExactDirection, ...] | None = None
    seconds: float = field(default=0.0, compare=False)

    @cached_property
    def cycles(self) -> tuple[tuple[int, ...], ...] | None:
        """The cycles of the permutation, with branches numbered from 1; None if undecided.

        A cycle of k branches is one analytic sheet, which closes after k half turns.
        """
        if self.permutation is None:
            return None
        left = set(range(len(self.permutation)))
        found = []
        while left:
            cycle = [min(left)]
            while (after := self.permutation[cycle[-1]]) != cycle[0]:
                cycle.append(after)
            left -= set(cycle)
            found.append(tuple(k + 1 for k in cycle))
        return tuple(found)

    @property
    def turns(self) -> int | None:
        """The number of half turns after which all branches are back; None if undecided."""
        return None if self.cycles is None else lcm(*map(len, self.cycles))

    def __repr__(self) -> str:
        found = (
            f"{counted(len(self.branches), 'branch')}, {counted(len(self.crossings), 'crossing')}"
        )
        return f"<DirectionsCount: {self.status}, {found}, {self.pattern!r}>"

    def to_dict(self, name: str | None = None) -> DirectionsDocument:
        """The object printed by `exactfold count CELL --direction all --json`."""
        order, cycles = self.permutation, self.cycles
        return {
            "format": "exactfold directions result",
            "version": 1,
            "name": name,
            "status": str(self.status),
            "reason": self.reason,
            "vertices": self.pattern.V,
            "branches": [{"vertex_signs": k.vertex_signs, "b": k.b} for k in self.branches],
            "crossings": [crossing.to_dict() for crossing in self.crossings],
            "permutation": None if order is None else [k + 1 for k in order],
            "cycles": None if cycles is None else [list(cycle) for cycle in cycles],
            "families": None if self.families is None else [n.to_dict() for n in self.families],
            "seconds": round(self.seconds, 3),
        }
