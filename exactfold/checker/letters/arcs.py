"""Solutions with given vertex signs over all directions of the boundary heights, and their letters.

Heights g with K_v(g) > 0 at every interior vertex lie in the nappes of one sign vector, and so does
every sum of two such heights with positive weights. These nappes hold exactly one solution h with
the boundary heights of g, and int |grad(h - g)|^2 <= D(g) = sum_v m_v K_v(g) (docs/branch.md,
Theorem 5). A fold that g bends by more than this bound allows bends to the same side in h. For
g = (1 - t) a + t b the bend is linear in t and D is a quadratic form in t, so that three products
decide a fold for all t at once.

Some letters may stay open. Letters of a solution must agree with the sign at each vertex: if a
vertex pops up, its mountains lie in no closed half-plane, and it has a valley (docs/assignment.md,
The search).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from itertools import product
from math import lcm
from typing import Any, TypeAlias

from ..core import limits
from ..core.reading import at_most, require
from ..sheets.sheet import Edge, Sheet, turn

MOST_OPEN = limits.MOST_OPEN
"""The largest number of ways to complete open letters that are tried."""

Heights: TypeAlias = Sequence[int]
Word: TypeAlias = tuple[int, ...]
"""For each fold 1 if it is a valley, -1 if it is a mountain, 0 if its letter is open."""
_Form: TypeAlias = list[tuple[int, int, int]]


class Arcs:
    """The letters of solutions of a convex sheet with integer coordinates.

    `places` are the vertices whose heights are given; all other vertices have height 0.
    """

    def __init__(self, sheet: Sheet, places: Sequence[int]) -> None:
        self.sheet = sheet
        self._at = {v: k for k, v in enumerate(places)}
        self._forms = {v: self._whole(sheet.curvature(v)) for v in sheet.interior}
        self._sides = {v: self._row(sheet.sign_of_vertex(v)) for v in sheet.interior}
        self._distance, self._unit = self._weighted()
        self._bends = [self._bend(fold) for fold in sheet.folds]
        self._stars = {v: self._star(v) for v in sheet.interior}
        self._words: dict[tuple[int, int], list[Word]] = {}
        self._known: dict[tuple[Word, Word], set[Word]] = {}

    # --- forms in integers -----------------------------------------------------------------------

    def _whole(self, form: Mapping[tuple[int, int], Fraction]) -> _Form:
        """A form restricted to the given heights, times a positive number that makes it integer."""
        own = {pair: w for pair, w in form.items() if w and set(pair) <= self._at.keys()}
        unit = lcm(*(w.denominator for w in own.values()))
        return [(self._at[i], self._at[j], int(w * unit)) for (i, j), w in own.items()]

    def _row(self, row: Mapping[int, Fraction]) -> list[tuple[int, int]]:
        own = {v: Fraction(w) for v, w in row.items() if v in self._at}
        unit = lcm(*(w.denominator for w in own.values()))
        return [(self._at[v], int(w * unit)) for v, w in own.items()]

    def _weighted(self) -> tuple[_Form, int]:
        """The form 4 D times a number that makes it integer, and this number.

        m_v = R^2 - |U_v - c|^2 for a disk round the sheet with centre c and radius R.
        """
        points = self.sheet.points
        xs, ys = zip(*points.values(), strict=True)
        x, y = min(xs) + max(xs), min(ys) + max(ys)

        def squared(v: int) -> Fraction:
            return Fraction((2 * points[v][0] - x) ** 2 + (2 * points[v][1] - y) ** 2)

        radius = max(squared(v) for v in self.sheet.boundary)
        total: dict[tuple[int, int], Fraction] = {}
        for v in self.sheet.interior:
            for pair, w in self.sheet.curvature(v).items():
                if set(pair) <= self._at.keys():
                    total[pair] = total.get(pair, Fraction(0)) + (radius - squared(v)) * w
        unit = lcm(*(w.denominator for w in total.values()))
        return [(self._at[i], self._at[j], int(w * unit)) for (i, j), w in total.items()], unit

    def _bend(self, fold: Edge) -> tuple[list[tuple[int, int]], int, int]:
        """The bend of a fold as a row, and numbers p and q: bend^2 p > 4 D unit q decides its side.

        This is the condition |omega| L > (D (2/c + 2/d))^(1/2) with omega = bend / (c d).
        """
        i, j = fold
        points = self.sheet.points
        left, right = self.sheet.next[i][j], self.sheet.next[j][i]
        c = turn(points[i], points[j], points[left])
        d = turn(points[j], points[i], points[right])
        length = sum((a - b) ** 2 for a, b in zip(points[i], points[j], strict=True))
        row = [(self._at[v], int(w)) for v, w in self.sheet.bend(fold).items() if v in self._at]
        return row, int(4 * self._unit * length), int(2 * (c + d) * c * d)

    # --- heights ---------------------------------------------------------------------------------

    def check_nappes(self, heights: Heights, signs: Iterable[int], what: str) -> None:
        """Raise unless the heights are inside the nappes of the signs of the interior vertices."""
        for v, sign in zip(self.sheet.interior, signs, strict=True):
            form = self._forms[v]
            require(_polar(form, heights, heights) > 0, f"{what}: K is not positive at vertex {v}")
            side = sum(w * heights[k] for k, w in self._sides[v])
            require(side * sign > 0, f"{what}: vertex {v} does not have the sign {sign}")

    def letters(self, a: Heights, b: Heights) -> Word:
        """The letters of all solutions with the boundary heights of (1 - t) a + t b, 0 <= t <= 1.

        A letter is 0 where it is open. Both a and b must be inside the nappes of the same signs.
        """
        first, last, both = (_polar(self._distance, *pair) for pair in ((a, a), (b, b), (a, b)))
        letters = []
        for row, p, q in self._bends:
            x, y = sum(w * a[k] for k, w in row), sum(w * b[k] for k, w in row)
            bent = x * x * p > first * q and y * y * p > last * q and x * y * p > both * q
            letters.append(0 if not bent else 1 if x > 0 else -1)
        return tuple(letters)

    # --- letters ---------------------------------------------------------------------------------

    def possible(self, letters: Word, signs: Word) -> set[Word]:
        """All ways to complete the letters of a solution with these signs that bends every fold.

        Only folds round interior vertices are completed.
        """
        if (letters, signs) not in self._known:
            completed = {letters}
            for v, sign in zip(self.sheet.interior, signs, strict=True):
                words = self._allowed(v, sign)
                completed = {made for word in completed for made in self._joined(word, v, words)}
                at_most(len(completed), MOST_OPEN, "the ways to complete open letters", "MOST_OPEN")
            self._known[letters, signs] = completed
        return self._known[letters, signs]

    def _joined(self, letters: Word, v: int, words: list[Word]) -> Iterable[Word]:
        places = self._stars[v]
        for word in words:
            if all(letters[k] in (0, x) for k, x in zip(places, word, strict=True)):
                made = list(letters)
                for k, x in zip(places, word, strict=True):
                    made[k] = x
                yield tuple(made)

    def _star(self, v: int) -> list[int]:
        """The indices of the folds round a vertex, counter-clockwise."""
        place = {fold: k for k, fold in enumerate(self.sheet.folds)}
        return [place[min(v, w), max(v, w)] for w in self.sheet.star(v)]

    def _allowed(self, v: int, sign: int) -> list[Word]:
        """The letters that the folds round a vertex with this sign may have."""
        if (v, sign) not in self._words:
            ring = self.sheet.star(v)
            self._words[v, sign] = [
                word
                for word in product((1, -1), repeat=len(ring))
                if sign in word
                and self._surround(v, [w for w, x in zip(ring, word, strict=True) if x == -sign])
            ]
        return self._words[v, sign]

    def _surround(self, v: int, ends: list[int]) -> bool:
        """Whether neighbours, in their order around v, lie in no closed half-plane."""
        points: Mapping[int, Any] = self.sheet.points
        return len(ends) > 2 and all(
            turn(points[v], points[a], points[b]) > 0
            for a, b in zip(ends, ends[1:] + ends[:1], strict=True)
        )


def _polar(form: _Form, a: Heights, b: Heights) -> int:
    return sum(w * a[i] * b[j] for i, j, w in form)
