"""The motions of one vertex with at most four folds in a sheet of panels.

The fold densities w (angle / length) solve `sum_j w_j d_j = 0` and, to second order,
`sum_{k<j} w_k w_j [d_k, d_j] = 0`. The solutions are one line for a straight pair, and two lines
for four folds with all sectors less than pi (docs/panels.md, 2).
"""

from __future__ import annotations

from dataclasses import dataclass

from ..core.towers import Number
from ..sheets.panels import PanelSheet, cross


@dataclass
class Line:
    """One line of motions at a vertex.

    `densities` has the density of the fold to each neighbour; densities that are 0 are left out.
    The densities lie in the field of the sheet with the square root of `radicand`, or in the field
    of the sheet itself if `radicand` is None.
    """

    densities: dict[int, Number]
    radicand: Number | None

    def gain(self, start: int, end: int) -> Number:
        """The density of the fold to `end`, divided by that of the fold to `start`."""
        return self.densities[end] / self.densities[start]


def lines_at(sheet: PanelSheet, v: int, near: list[int]) -> list[Line]:
    """The lines of motions of a vertex with a straight pair or four folds.

    Suppose that both lines of four folds have all four folds active. They are then sorted by the
    quotient of two densities: that of the fold to the neighbour with the second smallest number,
    divided by that of the fold to the neighbour with the smallest number.
    """
    d = [sheet.vector(v, u) for u in near]
    one = sheet.tower.number(1)
    if len(near) == 2:
        k = 0 if d[0][0].sign() else 1
        return [Line(dict(zip(near, (one, -d[0][k] / d[1][k]), strict=True)), None)]
    zero = sheet.tower.number(0)

    def motion(x: Number, y: Number) -> list[Number]:
        """The densities (x, y, z, w) with x d_1 + y d_2 + z d_3 + w d_4 = 0."""
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
    lines = []
    for x, y in ratios:
        w = dict(zip(near, motion(x, y), strict=True))
        lines.append(Line({u: w[u] for u in sorted(near) if w[u].sign()}, radicand))
    if len(lines[0].densities) == len(lines[1].densities) == 4:
        i, j = sorted(near)[:2]
        if (lines[0].gain(i, j) - lines[1].gain(i, j)).sign() > 0:
            lines.reverse()
    return lines
