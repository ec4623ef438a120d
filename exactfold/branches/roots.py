"""Values and signs of linear functionals at a proved root."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Protocol

from exactfold.branches.functionals import Row
from exactfold.certify.box import IsolatingBox


class Root(Protocol):
    """A real point of the chart that is proved to exist and enclosed."""

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value of a row (c_1, ..., c_n, c_0)."""

    def sign(self, row: Row) -> int | None:
        """Sign of the value: 1, -1, 0 only if it is proved to vanish, None if undecided."""


@dataclass(frozen=True)
class BoxRoot:
    """The one zero of the system in an isolating box."""

    box: IsolatingBox

    def enclose(self, row: Sequence[Fraction | int]) -> tuple[Fraction, Fraction]:
        """Bounds of the value over the whole box."""
        box = self.box
        *slopes, constant = row
        terms = (c * m for c, m in zip(slopes, box.real, strict=True) if c)
        value = sum(terms, Fraction(0)) + (constant << box.bits if isinstance(constant, int)
                                           else constant * (1 << box.bits))
        reach = box.radius * sum((abs(c) for c in slopes), Fraction(0))
        scale = 1 << box.bits
        return (value - reach) / scale, (value + reach) / scale

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
            return 1
        if value < -reach:
            return -1
        return 0 if value == 0 and reach == 0 else None
