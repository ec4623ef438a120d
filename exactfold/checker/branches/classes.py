"""Classes of zeros: each zero is a rational function of one root of a squarefree polynomial."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from ..core.polynomials import (
    Poly,
    are_coprime,
    bounds,
    derivative,
    plus,
    remainder,
    scaled,
    times,
    value,
)
from ..core.reading import items, parse_integer, parse_rational, require, text_of
from ..sheets.equations import BranchSystem


class RootClass:
    """Zeros x_i = w_i(t) / p'(t) of the branch system, one for each root t of p.

    `check_algebraic` has already verified the keys of the entry.
    """

    def __init__(self, system: BranchSystem, separating: list[int], entry: Any) -> None:
        n = system.size
        self.p = [parse_integer(text_of(c)) for c in items(entry["polynomial"], "polynomial")]
        require(len(self.p) > 1 and self.p[-1], "a class polynomial is constant")
        self.slope = derivative(self.p)
        require(are_coprime(self.p, self.slope), "a class polynomial has a double root")
        self.w = [
            [parse_rational(c) for c in items(w, "numerator")]
            for w in items(entry["numerators"], "numerators", n)
        ]
        require(all(len(w) < len(self.p) for w in self.w), "a numerator has too high a degree")
        flat = set(items(entry["flat"], "flat vertices"))
        require(
            len(flat) == len(entry["flat"])
            and all(type(v) is int for v in flat)
            and flat <= set(system.sheet.interior),
            "a flat vertex is not an interior vertex, or appears twice",
        )
        z = [*self.w, self.slope]
        for v, quadric in zip(system.sheet.interior, system.quadrics, strict=True):
            gradient: list[Poly] = [[] for _ in z]
            for (i, j), c in quadric.items():
                gradient[i] = plus(gradient[i], scaled(z[j], c))
            total: Poly = []
            for a, b in zip(gradient, z, strict=True):
                total = plus(total, times(a, b))
            require(not remainder(total, self.p), "the parametrisation misses a quadric")
            require(
                v not in flat or not any(remainder(g, self.p) for g in gradient[:n]),
                f"vertex {v} is listed as flat, but its quadric has order 1",
            )
        self.multiplicity = 1 << len(flat)  # a lower bound: the product of the quadrics' orders
        form: Poly = []
        for s, w in zip(separating, self.w, strict=True):
            form = plus(form, scaled(w, s))
        require(
            not remainder(plus(form, scaled([0, *self.slope], -1)), self.p),
            "the separating form is not the root of its polynomial",
        )


class AlgebraicRoot:
    """One real zero of a class, given by an interval in which the polynomial p has one root.

    At the two ends p has opposite signs, or both ends are the root.
    """

    kind = "class"

    def __init__(self, root_class: RootClass, low: Fraction, high: Fraction) -> None:
        self.root_class, self.low, self.high = root_class, low, high
        left, right = value(root_class.p, low), value(root_class.p, high)
        require(
            (low < high and left * right < 0) or (low == high and right == 0),
            "an interval shows no root",
        )
        self.rising = value(root_class.slope, low) > 0 if low == high else right > 0

    def sign(self, row: Sequence[int]) -> int | None:
        """The sign of a functional at the zero; 0 if it vanishes there, None if it stays open.

        The interval is halved until it shows the sign.
        """
        p = self.root_class.p
        f: Poly = []
        for c, w in zip(row, [*self.root_class.w, self.root_class.slope], strict=True):
            f = plus(f, scaled(w, c))
        f = remainder(f, p)
        if not f:
            return 0
        for _ in range(4000):
            low, high = bounds(f, self.low, self.high)
            if low > 0 or high < 0:
                return 1 if (low > 0) == self.rising else -1
            if self.low == self.high:
                return 0
            middle = (self.low + self.high) / 2
            at = value(p, middle)
            if at == 0:
                self.low = self.high = middle
            elif (at > 0) == self.rising:
                self.high = middle
            else:
                self.low = middle
        return None
