"""Driven folds, whose angles keep a ratio: equations between distances (docs/motion.md, 10).

Half the change g_k of the square of the distance between the two vertices opposite to fold k is
-8 (A B / l^2) sin(a_k / 2)^2, with the areas A, B of its faces, its length l and its angle a_k.
"""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import Any

from ..core.reading import items, keys, natural, parse_rational, require
from ..sheets.sheet import Edge, Sheet, turn
from .bounds import Vector


class Drive:
    """The folds and the numbers q_k of a claim, and the equations w_m g_k = w_k g_m of their ratio.

    sin(a_k / 2)^2 is in the ratio of |q_k| iff they hold for w_k = |q_k| A B / l^2. `rows` are
    integers on the `diagonals` k, over 2^bits.
    """

    def __init__(self, sheet: Sheet, claim: Any) -> None:
        keys(claim, "folds squares reached", "drive")
        require(type(claim["reached"]) is bool, "reached is not true or false")
        self.reached: bool = claim["reached"]
        number = len(sheet.boundary) - 3
        require(number > 1, "one fold alone has no ratio that could be claimed")
        self.folds: list[Edge] = []
        for fold in items(claim["folds"], "driven folds", number):
            i, j = (natural(v, "vertex") for v in items(fold, "fold", 2))
            self.folds.append((i, j))
        there = set(self.folds) <= set(sheet.folds) and len(set(self.folds)) == number
        require(there, "what is driven is no fold, or one is driven twice")
        texts = items(claim["squares"], "squares", number)
        self.squares = [parse_rational(text) for text in texts]
        require(all(0 < abs(q) <= 1 for q in self.squares), "a driven fold has no angle to go to")
        self.diagonals: list[Edge] = []
        weights: list[Fraction] = []
        for (i, j), q in zip(self.folds, self.squares, strict=True):
            left, right = sheet.next[i][j], sheet.next[j][i]
            a, b, c, d = (sheet.points[v] for v in (i, j, left, right))
            square = (b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2
            self.diagonals.append((left, right))
            weights.append(abs(q) * turn(a, b, c) * turn(b, a, d) / square)
        most = self.most = weights.index(max(weights))
        self.weight = weights[most]
        rows = [self._row(weights, k, most) for k in range(number) if k != most]
        self.bits = max(map(_length, rows), default=0)
        self.rows = [[c << self.bits - _length(row) for c in row] for row in rows]

    def _row(self, weights: list[Fraction], k: int, most: int) -> Vector:
        common = lcm(weights[k].denominator, weights[most].denominator)
        row = [0] * len(weights)
        row[k], row[most] = int(weights[most] * common), -int(weights[k] * common)
        divisor = gcd(*row)
        return [c // divisor for c in row]


def _length(row: Vector) -> int:
    return max(abs(c).bit_length() for c in row)


def driven_of(claims: dict[str, Any]) -> str:
    """The driven folds of a claim, in words."""
    if "drive" not in claims:
        return ""
    drive = claims["drive"]
    names = ", ".join(f"{i}-{j}" for i, j in drive["folds"])
    ratio = " : ".join(q.removeprefix("-") for q in drive["squares"])
    ways = ", ".join("mountain" if q.startswith("-") else "valley" for q in drive["squares"])
    reached = ", at least that at the end" if drive["reached"] else ""
    return f", driven by the folds {names} ({ways}), sin^2 of half the angle as {ratio}{reached}"
