"""Fans: sheets on which the same sign flips on all loops (docs/matching.md, Theorem 2)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.validate import orientation


@dataclass(frozen=True)
class Fan:
    """A `chain` x_0, ..., x_(n+1) between boundary vertices, and poles p, q joined to all of it."""

    sheet: CreasePattern
    poles: tuple[int, int]
    chain: tuple[int, ...]

    def _area(self, a: int, b: int, c: int) -> Fraction:
        """Twice the signed area of a triangle."""
        points = self.sheet.vertices
        area: Fraction = orientation(points[a], points[b], points[c])
        return area

    def closing(self, j: int) -> Fraction:
        """c_j: a quarter of the difference of |p q|^2 in the flat sheet and with fold j closed."""
        (p, q), (x, y) = self.poles, self.chain[j - 1 : j + 1]
        dx, dy = (a - b for a, b in zip(*(self.sheet.vertices[v] for v in (x, y)), strict=True))
        product = self._area(x, y, p) * self._area(y, x, q)
        return product / Fraction(dx * dx + dy * dy)

    def signs(self) -> tuple[int, ...] | None:
        """For folds 1 to n + 1 the place of the sign they carry; None at a straight angle."""
        p, q = self.poles
        n = len(self.chain) - 2
        carried: dict[int, int] = {}
        for i in range(1, n + 1):
            x, after = self.chain[i : i + 2]
            star = self.sheet.star(x)
            at = star.index(after)
            a, b = star[at - 1], star[(at + 1) % 4]  # the poles, in their order around x
            side = self._area(x, a, b)
            if {a, b} != {p, q} or not side:
                return None
            carried[i if side > 0 else i + 1] = self.sheet.interior.index(x)
        return tuple(carried.get(j, n) for j in range(1, n + 2)) if len(carried) == n else None

    def flipped(self) -> int | None:
        """The place of the sign that flips on every loop (n for the last one); None for a tie."""
        signs = self.signs()
        values = [self.closing(j) for j in range(1, len(self.chain))]
        least = min(values)
        if signs is None or values.count(least) > 1:
            return None
        return signs[values.index(least)]


def fan(sheet: CreasePattern) -> Fan | None:
    """The sheet as a fan, if it is one; a sheet with one vertex is a fan in two ways.

    >>> from exactfold.pattern.families import two_vertex
    >>> sheet_as_fan = fan(two_vertex())
    >>> sheet_as_fan.poles, sheet_as_fan.chain, sheet_as_fan.flipped()
    ((1, 3), (0, 4, 5, 2), 2)
    """
    inside = sheet.interior_set
    if not inside or any(sheet.degree(v) != 4 for v in inside):
        return None
    common = set.intersection(*(set(sheet.star(v)) for v in inside)) - inside
    for p in sorted(common):
        for q in sorted(common - {p}):
            ends = [v for v in sheet.boundary if v not in (p, q)]
            chain, seen = [ends[0]], {ends[0], p, q}
            while True:
                after = [v for v in sheet.star(chain[-1]) if v not in seen]
                if len(after) != 1:
                    break
                chain.append(after[0])
                seen.add(after[0])
            if len(chain) == len(inside) + 2 and chain[-1] == ends[1]:
                return Fan(sheet, (p, q), tuple(chain))
    return None
