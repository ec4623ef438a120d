"""Rational quadratic forms on labelled variables."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from exactfold.exact.linalg import Inertia


@dataclass(frozen=True)
class QuadraticForm:
    """Q(h) = h^T M h on the variables named by `labels`, with M symmetric over Q.

    >>> form = QuadraticForm((4, 7), ((Fraction(1), Fraction(0)), (Fraction(0), Fraction(-1))))
    >>> form({4: Fraction(3), 7: Fraction(2)}), form.inertia
    (Fraction(5, 1), (1, 1, 0))
    """

    labels: tuple[int, ...]
    matrix: tuple[tuple[Fraction, ...], ...]

    def polar(self, a: Mapping[int, Fraction], b: Mapping[int, Fraction]) -> Fraction:
        """The symmetric bilinear form B(a, b) with B(h, h) = Q(h)."""
        left = [a[v] for v in self.labels]
        right = [b[v] for v in self.labels]
        return sum(
            (
                x * m * y
                for x, row in zip(left, self.matrix, strict=True)
                if x
                for m, y in zip(row, right, strict=True)
                if m
            ),
            Fraction(0),
        )

    def __call__(self, heights: Mapping[int, Fraction]) -> Fraction:
        """Q(h)."""
        return self.polar(heights, heights)

    def functional(self, a: Mapping[int, Fraction]) -> dict[int, Fraction]:
        """The linear functional h -> B(a, h), as coefficients by label."""
        left = [a[v] for v in self.labels]
        return {
            v: sum((m * x for m, x in zip(row, left, strict=True)), Fraction(0))
            for v, row in zip(self.labels, self.matrix, strict=True)
        }

    def __repr__(self) -> str:
        return f"<QuadraticForm: {len(self.labels)} variables>"

    @property
    def inertia(self) -> Inertia:
        """(positive, negative, zero), exactly."""
        from exactfold.exact.linalg import inertia  # FLINT, for this alone

        return inertia(self.matrix)
