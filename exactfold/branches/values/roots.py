"""Values and signs of linear functionals at a proved root."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import TYPE_CHECKING, Any, Protocol

from exactfold.exact.numbers import integer_row
from exactfold.solve.certify.box import IsolatingBox

if TYPE_CHECKING:  # FLINT is loaded only when there is an algebraic root
    from exactfold.exact.univariate import Interval
    from exactfold.rigidity.equations.flat_sheets import FlatSheets
    from exactfold.rigidity.equations.quadratic import QuadraticSystem
    from exactfold.solve.algebraic.exact_solution import RootClass

Row = tuple[int, ...]


class ChartRoot(Protocol):
    """A real point of a chart that is proved to exist and enclosed."""

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value of a row (c_1, ..., c_n, c_0)."""

    def sign(self, row: Row) -> int | None:
        """The sign of the value: 1, -1, 0 only if it is proved to vanish, None if undecided."""

    def mirrored(self) -> ChartRoot:
        """The same branch seen from below; all values change their signs."""

    def exact(self, row: Sequence[Fraction | int], unit: Sequence[Fraction | int] = ()) -> Any:
        """The value, divided by that of `unit` if given (`Branch.exact_heights`); None if
        unknown.
        """


def sharper(system: QuadraticSystem, box: IsolatingBox, bits: int) -> IsolatingBox | None:
    """A box of the same zero with `bits` bits after the point, by the exact test; or None."""
    from exactfold.solve.certify.exact_krawczyk import krawczyk_at  # here because it loads FLINT

    if box.bits >= bits:
        return None
    sharpened = krawczyk_at(system, box, bits)
    return sharpened if isinstance(sharpened, IsolatingBox) else None


@dataclass(frozen=True)
class BoxRoot:
    """The only zero of `system` in an isolating box; with side -1, its mirror image.

    `known` is the same zero as an algebraic number, if an exact engine found it.
    """

    box: IsolatingBox
    side: int = 1
    system: QuadraticSystem | None = field(default=None, compare=False, repr=False)
    known: AlgebraicRoot | None = field(default=None, compare=False, repr=False)

    def sharpened(self, bits: int) -> BoxRoot | None:
        """The same zero in a box with `bits` bits after the point; None if that is not proved."""
        box = None if self.system is None else sharper(self.system, self.box, bits)
        return None if box is None else replace(self, box=box)

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value over the whole box."""
        box = self.box
        *slopes, constant = row
        if not any(slopes):  # the height is given
            return Fraction(constant * self.side), Fraction(constant * self.side)
        common = lcm(*(c.denominator for c in row))  # integers: fractions would reduce each step
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
        """The sign of an integer row over the whole box; None if the box meets its zero set."""
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

    def exact(self, row: Sequence[Fraction | int], unit: Sequence[Fraction | int] = ()) -> Any:
        """The value, if an exact engine knows the zero or `zero_in` finds it; otherwise None."""
        known = self._algebraic
        return None if known is None else replace(known, side=self.side).exact(row, unit)

    @cached_property
    def _algebraic(self) -> AlgebraicRoot | None:
        if self.known is not None or self.system is None:
            return self.known
        from exactfold.branches.values.known_roots import zero_in  # here because it loads FLINT

        zero = zero_in(self.system, self.box)
        return None if zero is None else AlgebraicRoot(*zero)


@dataclass(frozen=True)
class FlatBoxRoot:
    """The only zero, in an isolating box, of the quadrics on sheets that are flat at some vertices.

    The box lies in the unknowns of `sheets`. With side -1 the root is the mirror image.
    """

    sheets: FlatSheets
    box: IsolatingBox
    side: int = 1

    def sharpened(self, bits: int) -> FlatBoxRoot | None:
        """The same zero in a box with `bits` bits after the point; None if that is not proved."""
        system = self.sheets.system
        box = None if system is None else sharper(system, self.box, bits)
        return None if box is None else replace(self, box=box)

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value over the whole box."""
        return BoxRoot(self.box, self.side).enclose(self.sheets.restrict(row))

    def sign(self, row: Row) -> int | None:
        """The sign over the whole box; 0 if the functional vanishes on these sheets."""
        return BoxRoot(self.box, self.side).sign(integer_row(self.sheets.restrict(row)))

    def mirrored(self) -> FlatBoxRoot:
        """The mirror image."""
        return replace(self, side=-self.side)

    def exact(self, row: Sequence[Fraction | int], unit: Sequence[Fraction | int] = ()) -> None:
        """None, because a box only gives bounds."""


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
        """Bounds of the value, no wider than 2^-64 times the maximum of 1 and the largest
        coefficient.
        """
        scale = max((abs(Fraction(c)) for c in row), default=Fraction(0)) or Fraction(1)
        bits = 80
        while True:
            bounds = self.root_class.value_on(row, self.interval(bits))
            if bounds is not None and (bounds[1] - bounds[0]) * (1 << 64) <= scale:
                return bounds if self.side > 0 else (-bounds[1], -bounds[0])
            bits *= 2

    def quotient(
        self, row: Sequence[Fraction | int], unit: Sequence[Fraction | int]
    ) -> tuple[Fraction, Fraction]:
        """Bounds of the value divided by the positive value of `unit`.

        They are no wider than 2^-64 times the maximum of 1 and the size of the quotient.
        """
        bits = 80
        while True:
            interval = self.interval(bits)
            top, low = (self.root_class.value_on(r, interval) for r in (row, unit))
            if top is not None and low is not None and low[0] * low[1] > 0:
                ends = [a / b for a in top for b in low]
                bounds = min(ends), max(ends)
                if (bounds[1] - bounds[0]) * (1 << 64) <= max(Fraction(1), *map(abs, bounds)):
                    return bounds
            bits *= 2

    def sign(self, row: Row) -> int | None:
        """The sign of the value; it is 0 exactly if the value vanishes modulo the irreducible
        polynomial.
        """
        if self.root_class.vanishes(row):
            return 0
        bits = 40
        while True:
            bounds = self.root_class.value_on(row, self.interval(bits))
            if bounds is not None and (bounds[0] > 0 or bounds[1] < 0):
                return self.side if bounds[0] > 0 else -self.side
            bits *= 2

    def mirrored(self) -> AlgebraicRoot:
        """The mirror image."""
        return replace(self, side=-self.side)

    def exact(self, row: Sequence[Fraction | int], unit: Sequence[Fraction | int] = ()) -> Any:
        """The value: a `Fraction`, radicals, or a `CRootOf` of sympy."""
        from exactfold.branches.values.exact_values import value_at_root  # loads sympy

        side = 1 if unit else self.side  # a quotient is the same on both sides
        return value_at_root(self.root_class, self.index, [side * c for c in row], unit)


@dataclass(frozen=True)
class EnclosedRoot:
    """The only solution with given signs, near given heights (`exactfold.solve.certify.enclosure`).

    Its heights lie within `radius` of `centres`, and the integral of |grad(h - centres)|^2 over the
    sheet is at most `squared_distance`. If that is 0, `centres` are the heights themselves.
    `merged` are the larger triangles that stay flat because the branch is folded along their sides,
    each with its corners and its other vertices (docs/branch.md, Merged faces).
    """

    centres: Mapping[int, Fraction]
    radius: Fraction
    squared_distance: Fraction
    merged: tuple[tuple[tuple[int, int, int], tuple[int, ...]], ...] = ()

    @cached_property
    def heights(self) -> dict[int, tuple[Fraction, Fraction]]:
        """Rational bounds of the height of every vertex."""
        r = self.radius
        return {v: (c - r, c + r) for v, c in self.centres.items()}

    @property
    def exact_heights(self) -> dict[int, Fraction] | None:
        """The heights, if they are known exactly."""
        return None if self.squared_distance else dict(self.centres)


Root = ChartRoot | EnclosedRoot
"""The proved place of a branch."""
