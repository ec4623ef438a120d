"""Motions of one vertex of a sheet of panels with at most four folds.

Fold densities w (angle / length) solve `sum_j w_j d_j = 0` and, to second order,
`sum_{k<j} w_k w_j [d_k, d_j] = 0`: one line for a straight pair, two for four folds with all
sectors less than pi (docs/panels.md, 2).
"""

from __future__ import annotations

from dataclasses import dataclass

from ..core.towers import Number
from ..sheets.panels import PanelSheet, cross


@dataclass
class Line:
    """One line of motions at a vertex: density by neighbour, only those that are not 0.

    `radicand` is what the root in the densities is of, None if they are in the field of the sheet.
    """

    densities: dict[int, Number]
    radicand: Number | None

    def gain(self, start: int, end: int) -> Number:
        """density of the fold to `end` / that of the fold to `start`."""
        return self.densities[end] / self.densities[start]


def lines_at(sheet: PanelSheet, v: int, near: list[int]) -> list[Line]:
    """The lines of motions of a vertex with a straight pair or four folds.

    Those of four folds with the same active folds are in the order of the quotient of the densities
    of the second and the first fold, by the numbers of the neighbours.
    """
    d = [sheet.vector(v, u) for u in near]
    one = sheet.tower.number(1)
    if len(near) == 2:
        k = 0 if d[0][0].sign() else 1
        return [Line(dict(zip(near, (one, -d[0][k] / d[1][k]), strict=True)), None)]
    zero = sheet.tower.number(0)

    def motion(x: Number, y: Number) -> list[Number]:
        """x d_1 + y d_2 + z d_3 + w d_4 = 0."""
        rest = [-(x * d[0][k] + y * d[1][k]) for k in (0, 1)]
        last = cross(d[2], d[3])
        return [
            x,
            y,
            cross((rest[0], rest[1]), d[3]) / last,
            cross(d[2], (rest[0], rest[1])) / last,
        ]

    def form(w: list[Number]) -> Number:
        total = zero
        for j in range(4):
            for k in range(j):
                total = total + w[k] * w[j] * cross(d[k], d[j])
        return total

    # a x^2 + b x y + c y^2 = 0
    a, c = form(motion(one, zero)), form(motion(zero, one))
    b = form(motion(one, one)) - a - c
    if c.sign() == 0:
        ratios = [(zero, one), (b, -a)]
        radicand = None
    else:
        square = b * b - sheet.tower.number(4) * a * c
        above, root = sheet.tower.adjoined(square)
        radicand = None if above is sheet.tower else square
        half = sheet.tower.number(2) * c
        ratios = [(half, -b - root), (half, root - b)]
    found = []
    for x, y in ratios:
        w = dict(zip(near, motion(x, y), strict=True))
        found.append(Line({u: w[u] for u in sorted(near) if w[u].sign()}, radicand))
    if len(found[0].densities) == len(found[1].densities) == 4:
        i, j = sorted(near)[:2]
        if (found[0].gain(i, j) - found[1].gain(i, j)).sign() > 0:
            found.reverse()
    return found
