"""Heights with K_v > 0 at every interior vertex, and the one solution near them.

The formulas differ from those of the listing checker and of the program that writes certificates:
the curvature forms are summed wedge by wedge as in their definition, and rational timelike vectors
give the signs of vertices. Divisions of integers are rounded in the safe direction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from math import isqrt
from typing import Any

from ..core.reading import require
from ..sheets.flat_folds import close_flat
from ..sheets.sheet import Edge, Sheet, turn

SPARE = 400  # binary places of a curvature below (height / size)^2
Heights = Mapping[int, int]


class Proof:
    """What heights prove: signs of vertices, letters of folds, and the distance to the solution.

    The heights are integers over q, and the coordinates are integers. On the solution
    K_v = 1 / size^2 at `corner`, K_v = targets[v] at the vertices of `targets`, and K_v = 0 at all
    other interior vertices.
    """

    def __init__(
        self,
        sheet: Sheet,
        heights: Heights,
        q: int,
        corner: int | None,
        targets: Mapping[int, Fraction],
    ) -> None:
        self.sheet, self.heights, self.q, self.corner = sheet, heights, q, corner
        xs, ys = zip(*sheet.points.values(), strict=True)
        self.size = int(max(max(xs) - min(xs), max(ys) - min(ys)))
        self.targets = targets if corner is None else {corner: Fraction(1, self.size**2)}
        highest = max(map(abs, heights.values()))
        self.bits = max(0, SPARE + 2 * self.size.bit_length() - 2 * highest.bit_length())
        self.exact = all(self._on_target(v) for v in sheet.interior)
        self.signs = {v: self._sign(v) for v in sheet.interior}
        self.squared_distance = self._distance(int(min(xs) + max(xs)), int(min(ys) + max(ys)))
        self.letters = self._letters()

    def wedges(self, v: int, a: Heights, b: Heights) -> Iterator[tuple[int, int]]:
        """Yield numerator and denominator of each term of K_v(a, b), one term for each wedge.

        K_v(a, b) = sum_j [(x_j y_j+1 + y_j x_j+1) L^2 L'^2 - s (x_j y_j L'^2 + x_j+1 y_j+1 L^2)]
        / (2 c L^2 L'^2) with x = a_j - a_v, y = b_j - b_v, L = L_j and L' = L_j+1. Here c and s are
        the cross product and the scalar product of the two spokes of the wedge.
        """
        ring = self.sheet.star(v)
        points: Mapping[int, Any] = self.sheet.points
        for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
            px, py = points[i][0] - points[v][0], points[i][1] - points[v][1]
            qx, qy = points[j][0] - points[v][0], points[j][1] - points[v][1]
            c, s, k, m = px * qy - py * qx, px * qx + py * qy, px * px + py * py, qx * qx + qy * qy
            xi, xj, yi, yj = a[i] - a[v], a[j] - a[v], b[i] - b[v], b[j] - b[v]
            top = (xi * yj + yi * xj) * k * m - s * (xi * yi * m + xj * yj * k)
            yield int(top), int(2 * c * k * m)

    def form(self, v: int, a: Heights, b: Heights) -> tuple[int, int]:
        """Two integers with 2^bits K_v(a, b) between them."""
        terms = [(top << self.bits) // bottom for top, bottom in self.wedges(v, a, b)]
        return sum(terms), sum(terms) + len(terms)

    def exact_form(self, v: int, a: Heights, b: Heights) -> Fraction:
        """The exact value of K_v(a, b)."""
        return sum((Fraction(*term) for term in self.wedges(v, a, b)), Fraction(0))

    def _on_target(self, v: int) -> bool:
        """Whether K_v of the heights has exactly the value that it has on a solution."""
        low, high = self.form(v, self.heights, self.heights)
        target = self.q**2 * self.targets.get(v, Fraction(0))
        near = low <= target * (1 << self.bits) <= high
        return near and self.exact_form(v, self.heights, self.heights) == target

    def _sign(self, v: int) -> int:
        """The sign of the nappe of K_v in which the heights lie: 1 for up, -1 for down, 0 if flat.

        It is the sign of K_v(t, heights) for a timelike t that points up: K_v(t) > 0, and
        t_j - t_v < 0 for all j. Such a t points up because K_v(t, t') > 0 for the round cone t',
        which is a mountain on all spokes. On a solution K_v(t, .) is 0 only where the star is flat.
        """
        positive = self.exact or self.form(v, self.heights, self.heights)[0] > 0
        require(positive, f"K is not positive at vertex {v}")
        x, y = self.sheet.points[v]
        bits = 8
        while True:
            cone = {v: 0}
            for j in self.sheet.star(v):
                square = (self.sheet.points[j][0] - x) ** 2 + (self.sheet.points[j][1] - y) ** 2
                cone[j] = -isqrt(int(square) << 2 * bits)
            if self.form(v, cone, cone)[0] > 0:
                break
            bits *= 2
        low, high = self.form(v, cone, self.heights)
        if self.exact and low <= 0 <= high:
            side = self.exact_form(v, cone, self.heights)
            return (side > 0) - (side < 0)
        require(low > 0 or high < 0, f"the sign of vertex {v} is not certain")
        return 1 if low > 0 else -1

    def _distance(self, x: int, y: int) -> Fraction:
        """An upper bound of sum_v m_v (sqrt K_v - sqrt k_v)^2, with a disk about (x/2, y/2)."""
        points, unit = self.sheet.points, self.q**2 << self.bits
        if self.exact:
            return Fraction(0)

        def squared(v: int) -> int:
            return int((2 * points[v][0] - x) ** 2 + (2 * points[v][1] - y) ** 2)

        radius = max(squared(v) for v in self.sheet.boundary)
        total = Fraction(0)
        plain = 0
        for v in self.sheet.interior:
            low, high = self.form(v, self.heights, self.heights)
            if v in self.targets:
                target = self.targets[v]
                off = max(abs(Fraction(bound, unit) - target) for bound in (low, high))
                # (sqrt K - sqrt k)^2 is at most |K - k|, and at most (K - k)^2 / k
                total += Fraction(radius - squared(v), 4) * min(off, off**2 / target)
            else:
                plain += (radius - squared(v)) * high
        return total + Fraction(plain, 4 * unit)

    def _side(self, fold: tuple[int, int]) -> int | None:
        """The sign of a bend on the solution, None if the distance allows both signs."""
        bend = sum(w * self.heights[v] for v, w in self.sheet.bend(fold).items())
        i, j = fold
        left, right = self.sheet.next[i][j], self.sheet.next[j][i]
        p, q, r, s = (self.sheet.points[v] for v in (i, j, left, right))
        c, d = turn(p, q, r), turn(q, p, s)
        length = (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2
        # |omega| L > (squared_distance (2/c + 2/d))^(1/2) with omega = bend / (c d q)
        most = self.squared_distance * self.q**2 * 2 * (c + d) * c * d
        if bend**2 * length > most or self.exact:
            return (bend > 0) - (bend < 0)
        return None

    def _letters(self) -> dict[Edge, str]:
        """The letters of all folds: by `_side`, "F" also if `close_flat` proves it, else "U"."""
        sides = {fold: self._side(fold) for fold in self.sheet.folds}
        close_flat(self.sheet, sides, self.targets)
        return {fold: "U" if s is None else "MFV"[s + 1] for fold, s in sides.items()}
