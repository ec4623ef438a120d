"""Maps, strips and single vertices to fold flat."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from exactfold.pattern.panel_pattern import PanelPattern


def folded_map(rows: int, columns: int) -> PanelPattern:
    """A map of unit squares; its panels are numbered as `faces` says."""
    return grid(range(columns + 1), range(rows + 1))


def strip(*widths: Fraction | int) -> PanelPattern:
    """Stamps in a row, of the given widths."""
    places = [sum(widths[:k], Fraction(0)) for k in range(len(widths) + 1)]
    return grid(places, (0, 1))


def grid(xs: Sequence[Fraction | int], ys: Sequence[Fraction | int]) -> PanelPattern:
    """Rectangles between straight lines."""
    number = {(i, j): j * len(xs) + i for j in range(len(ys)) for i in range(len(xs))}
    edges = [(number[i, j], number[i + 1, j]) for i, j in number if (i + 1, j) in number]
    edges += [(number[i, j], number[i, j + 1]) for i, j in number if (i, j + 1) in number]
    return PanelPattern([(x, y) for y in ys for x in xs], edges)


def fan(*points: tuple[int, int]) -> PanelPattern:
    """One vertex at the origin, with creases to these points, counter-clockwise on the border."""
    count = len(points)
    edges = [(k, (k + 1) % count) for k in range(count)] + [(k, count) for k in range(count)]
    return PanelPattern([*points, (0, 0)], edges)
