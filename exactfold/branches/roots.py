"""Values and signs of linear functionals at a proved root."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import lcm
from typing import Protocol

from exactfold.algebra.exact_solution import RootClass
from exactfold.algebra.flat_zeros import FlatSheets
from exactfold.branches.functionals import Row, integer_row
from exactfold.certify.box import IsolatingBox
from exactfold.exact.univariate import Interval


class Root(Protocol):
    """A real point of the chart that is proved to exist and enclosed."""

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value of a row (c_1, ..., c_n, c_0)."""

    def sign(self, row: Row) -> int | None:
        """Sign of the value: 1, -1, 0 only if it is proved to vanish, None if undecided."""

    def mirrored(self) -> Root:
        """The same branch seen from below: all values change their sign."""


@dataclass(frozen=True)
class BoxRoot:
    """The one zero of the system in an isolating box; with side -1, its mirror image."""

    box: IsolatingBox
    side: int = 1

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value over the whole box."""
        box = self.box
        *slopes, constant = row
        if not any(slopes):  # a height that is given
            return Fraction(constant * self.side), Fraction(constant * self.side)
        common = lcm(*(c.denominator for c in row))  # integers, as fractions reduce at each step
        value = constant.numerator * (common // constant.denominator) << box.bits
        reach = 0
        for c, m in zip(slopes, box.real, strict=True):
            if c:
                whole = c.numerator * (common // c.denominator)
                value += whole * m
                reach += abs(whole)
        reach *= box.radius
        value *= self.side
        scale = common << box.bits
        return Fraction(value - reach, scale), Fraction(value + reach, scale)

    def sign(self, row: Row) -> int | None:
        """Sign of an integer row over the whole box, None if the box meets its zero set."""
        box = self.box
        *slopes, constant = row
        value = constant << box.bits
        reach = 0
        for c, m in zip(slopes, box.real, strict=True):
            if c:
                value += c * m
                reach += abs(c)
        reach *= box.radius
        if value > reach:
            return self.side
        if value < -reach:
            return -self.side
        return 0 if value == 0 and reach == 0 else None

    def mirrored(self) -> BoxRoot:
        """The mirror image."""
        return replace(self, side=-self.side)


@dataclass(frozen=True)
class FlatBoxRoot:
    """The one zero, in an isolating box, of the quadrics on the sheets that are flat somewhere.

    The box lies in the unknowns of `sheets`; with side -1, its mirror image.
    """

    sheets: FlatSheets
    box: IsolatingBox
    side: int = 1

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value over the whole box."""
        return BoxRoot(self.box, self.side).enclose(self.sheets.restrict(row))

    def sign(self, row: Row) -> int | None:
        """Sign over the whole box: 0 if the functional vanishes on these sheets."""
        return BoxRoot(self.box, self.side).sign(integer_row(self.sheets.restrict(row)))

    def mirrored(self) -> FlatBoxRoot:
        """The mirror image."""
        return replace(self, side=-self.side)


@dataclass(frozen=True)
class AlgebraicRoot:
    """The zero of a root class at the `index`-th real root of p; with side -1, its mirror image."""

    root_class: RootClass
    index: int
    side: int = 1

    def interval(self, bits: int) -> Interval:
        """Bounds of the parameter T, no wider than 2^-bits."""
        return self.root_class.real_roots(bits)[self.index]

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value, no wider than 2^-64 times the largest coefficient or 1."""
        scale = max((abs(Fraction(c)) for c in row), default=Fraction(0)) or Fraction(1)
        bits = 80
        while True:
            found = self.root_class.value_on(row, self.interval(bits))
            if found is not None and (found[1] - found[0]) * (1 << 64) <= scale:
                return found if self.side > 0 else (-found[1], -found[0])
            bits *= 2

    def sign(self, row: Row) -> int | None:
        """Sign of the value: 0 exactly if it vanishes modulo the irreducible polynomial."""
        if self.root_class.vanishes(row):
            return 0
        bits = 40
        while True:
            found = self.root_class.value_on(row, self.interval(bits))
            if found is not None and (found[0] > 0 or found[1] < 0):
                return self.side if found[0] > 0 else -self.side
            bits *= 2

    def mirrored(self) -> AlgebraicRoot:
        """The mirror image."""
        return replace(self, side=-self.side)
