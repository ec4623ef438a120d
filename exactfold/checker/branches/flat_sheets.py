"""Zeros of the branch system at which the stars of given vertices are flat, proved in boxes."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import Any

from ..core.linear import echelon
from ..core.reading import require
from ..sheets.boxes import read_box
from ..sheets.equations import BranchSystem


class FlatSheets:
    """The sheets that are flat at given vertices, as x = A (y, 1), and the quadrics on them.

    The equations "these folds are flat" are solved for their pivot unknowns; the y are the other
    unknowns x. `quadrics` is a basis of the span of all quadrics in y. It must have as many
    elements as there are unknowns y.
    """

    def __init__(self, system: BranchSystem, flat: list[Any]) -> None:
        sheet, n = system.sheet, system.size
        require(
            flat and all(type(v) is int for v in flat),
            "a flat vertex is not a vertex of the sheet, or none is given",
        )
        require(
            flat == sorted(set(flat)) and set(flat) <= set(sheet.interior),
            "the flat vertices are not sorted inner vertices",
        )
        folds = [fold for fold in sheet.folds if set(fold) & set(flat)]
        lines = echelon([[Fraction(c) for c in system.row(sheet.bend(f))] for f in folds])
        require(n not in lines, "no heights in the chart are flat at the flat vertices")
        free = [k for k in range(n) if k not in lines]
        self.system, self.size, self.multiplicity = system, len(free), 1 << len(flat)
        self.lifts = [
            [-lines[i][k] for k in (*free, n)]
            if i in lines
            else [Fraction(int(k == i)) for k in (*free, n)]
            for i in range(n)
        ]
        self.lifts.append([Fraction(int(k == n)) for k in (*free, n)])
        places = [(i, j) for i in range(self.size + 1) for j in range(i + 1)]
        span = echelon([self._restricted(quadric, places) for quadric in system.quadrics])
        require(len(span) == self.size > 0, "quadrics and unknowns on flat sheets differ in number")
        self.quadrics: list[dict[tuple[int, int], int]] = []
        for line in span.values():
            scale = lcm(*(c.denominator for c in line))
            quadric = {ij: int(c * scale) for ij, c in zip(places, line, strict=True) if c}
            # twice the form, so that c y_i y_j becomes the two integer entries c of (i, j), (j, i)
            both = {(i, j): c * (1 + (i == j)) for (i, j), c in quadric.items()}
            self.quadrics.append(both | {(j, i): c for (i, j), c in both.items()})

    def _restricted(
        self, quadric: dict[tuple[int, int], int], places: list[tuple[int, int]]
    ) -> list[Fraction]:
        """A quadric in terms of (y, 1): the coefficients of y_i y_j for i >= j."""
        total = dict.fromkeys(places, Fraction(0))
        for (p, q), c in quadric.items():
            for i, x in enumerate(self.lifts[p]):
                for j, y in enumerate(self.lifts[q]) if x else ():
                    if y:
                        total[max(i, j), min(i, j)] += c * x * y
        return list(total.values())

    def row(self, row: Sequence[int]) -> list[int]:
        """A functional of x as a functional of y, times a positive number."""
        total = [Fraction(0)] * (self.size + 1)
        for c, line in zip(row, self.lifts, strict=True):
            if c:
                total = [a + c * b for a, b in zip(total, line, strict=True)]
        scale = lcm(*(c.denominator for c in total))
        return [int(c * scale) for c in total]


class FlatBox:
    """A box that holds one real zero of the quadrics on flat sheets."""

    def __init__(self, entry: Any, sheets: FlatSheets) -> None:
        self.sheets = sheets
        self.kind = tuple(entry["flat"])
        self.box = read_box({k: v for k, v in entry.items() if k != "flat"}, sheets.size)

    def sign(self, row: Sequence[int]) -> int | None:
        """1 or -1 if the functional has this sign on the whole box, 0 if it is 0, else None."""
        return self.box.sign(self.sheets.row(row))
