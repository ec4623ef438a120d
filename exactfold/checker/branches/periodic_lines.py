"""Lines of solutions of a periodic sheet over a field Q(sqrt d); see `periodic`.

A vector p + q sqrt(d) is the rational vector (p, q) of twice the length, so that dimensions are
doubled. A row r + s sqrt(d) vanishes on it if r . p + d s . q = 0 and s . p + r . q = 0.
"""

from __future__ import annotations

from fractions import Fraction
from math import isqrt
from typing import Any, TypedDict

from ..core.linear import kernel
from ..core.reading import items, keys, natural, parse_rational, require
from ..sheets.cell import CellForms, Row


class LineClaim(TypedDict):
    """A line of pleats: heights w and b, each a + c sqrt(`radicand`) as a pair of a and c."""

    radicand: int
    line: list[list[str]]


class QuadraticLine:
    """A line that is a component of the solutions; the constructor refuses any other."""

    def __init__(self, forms: CellForms, entry: Any) -> None:
        keys(entry, "radicand point", "line")
        self.forms = forms
        self.radicand = natural(entry["radicand"], "radicand")
        require(isqrt(self.radicand) ** 2 != self.radicand, "a radicand is a square")
        point = items(entry["point"], "point", forms.size + 1)
        pairs = [list(map(parse_rational, items(pair, "number", 2))) for pair in point]
        first = next((pair for pair in pairs if any(pair)), [])
        require(first == [1, 0], "the first entry of a line that is not 0 is not 1")
        self.whole, self.roots = ([pair[k] for pair in pairs] for k in (0, 1))
        require(any(self.roots), "a line is rational")
        vector = [*self.whole, *self.roots]
        rows = {v: self._rows(forms.forms[v], vector) for v in forms.labels}
        zero = not any(_dot(row, vector) for some in rows.values() for row in some)
        require(zero, "a form does not vanish on a line")
        flat = [v for v in forms.labels if not any(map(self.sign, forms.bends_at[v]))]
        fixed = [row for v, some in rows.items() if v not in flat for row in some]
        normal = kernel(fixed, len(vector))
        total = [
            [sum(entries, Fraction(0)) for entries in zip(*lines, strict=True)]
            for lines in zip(*(forms.forms[v] for v in flat), strict=True)
        ]
        sums = [row for c in normal if flat for row in self._rows(total, c)]
        radical = kernel([[_dot(row, a) for a in normal] for row in sums], len(normal))
        require(len(radical) == 2, "a line lies in a larger space of solutions")

    def _rows(self, form: list[Row], vector: Row) -> list[Row]:
        """Rows on (p, q), both 0 where the polar form with a vector is 0."""
        r, s = (
            [_dot(row, part) for row in form]
            for part in (vector[: len(vector) // 2], vector[len(vector) // 2 :])
        )
        return [[*r, *(self.radicand * x for x in s)], [*s, *r]]

    def sign(self, row: Row) -> int:
        """The sign of a rational row on the line."""
        a, c = _dot(row, self.whole), _dot(row, self.roots)
        leading = a if a * a > self.radicand * c * c else c
        return (leading > 0) - (leading < 0)


def _dot(a: Row, b: Row) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))
