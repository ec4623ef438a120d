"""Sheets of rigid panels whose motions are known."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import pairwise

from exactfold.exact.surds import RATIONALS, Number
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

Place = Callable[[int, int], tuple[Number, Number]]


def grid(columns: int, rows: int, place: Place) -> PanelPattern:
    """A mesh of columns x rows quadrilaterals, vertex (i, j) at `place(i, j)`."""
    number = {(i, j): i * (rows + 1) + j for i in range(columns + 1) for j in range(rows + 1)}
    along = [((i, j), (i + 1, j)) for i, j in number if i < columns]
    up = [((i, j), (i, j + 1)) for i, j in number if j < rows]
    return PanelPattern(
        [place(i, j) for i, j in number], [(number[a], number[b]) for a, b in along + up]
    )


def miura(rows: int, zigzags: int) -> PanelPattern:
    """Straight creases along x crossed by zigzags."""
    return grid(zigzags + 1, rows + 1, lambda i, j: (Fraction(4 * i + j % 2), Fraction(3 * j)))


def mesh(columns: int, rows: int, seed: int) -> PanelPattern:
    """A mesh with columns x rows interior vertices in general position."""
    rng = random.Random(seed)

    def place(i: int, j: int) -> tuple[Number, Number]:
        return (
            10 * i + Fraction(rng.randint(-300, 300), 100),
            10 * j + Fraction(rng.randint(-300, 300), 100),
        )

    return grid(columns + 1, rows + 1, place)


def tiling(columns: int, rows: int) -> PanelPattern:
    """Copies of one quadrilateral, each turned by half a turn about the middle of its sides."""
    corners = {(0, 0): (0, 0), (1, 0): (5, 1), (1, 1): (6, 5), (0, 1): (-1, 4)}
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = (corners[k] for k in ((0, 0), (1, 0), (1, 1), (0, 1)))
    right = (bx - ax + cx - dx, by - ay + cy - dy)
    up = (dx - ax + cx - bx, dy - ay + cy - by)

    def place(i: int, j: int) -> tuple[Number, Number]:
        x, y = corners[i % 2, j % 2]
        return (
            Fraction(x + i // 2 * right[0] + j // 2 * up[0]),
            Fraction(y + i // 2 * right[1] + j // 2 * up[1]),
        )

    return grid(columns + 1, rows + 1, place)


def shifted_columns(shift: int) -> PanelPattern:
    """Straight rows crossed by two columns of one shape, the second sheared by `shift` a row."""
    shape = (0, 2, 3, 8)
    return grid(3, 3, lambda i, j: (Fraction(10 * i + shape[j] + i * shift * j), Fraction(4 * j)))


def outlined(points: Sequence[Point], folds: Sequence[Edge], inner: int) -> PanelPattern:
    """A sheet whose border joins the points from number `inner` on, in the order given."""
    rim = list(range(inner, len(points)))
    return PanelPattern(points, [*folds, *pairwise([*rim, rim[0]])])


def twist(corners: Sequence[Point], pleats: Sequence[Point]) -> PanelPattern:
    """A polygon, counter-clockwise, from whose side k two creases run along `pleats[k]`."""
    count = len(corners)
    points, folds = list(corners), [(k, (k + 1) % count) for k in range(count)]
    for k, (dx, dy) in enumerate(pleats):
        for corner in (k, (k + 1) % count):
            x, y = corners[corner]
            folds.append((corner, len(points)))
            points.append((x + dx, y + dy))
    return outlined(points, folds, count)


def regular_twist(sides: int, pleat: Point) -> PanelPattern:
    """The twist of a regular polygon with 3, 4 or 6 sides of length 4; `pleat` is the first."""
    root: Number = RATIONALS.adjoined(3).root if sides != 4 else Fraction(0)
    cosine: Number = {3: Fraction(-1, 2), 4: Fraction(0), 6: Fraction(1, 2)}[sides]
    sine: Number = Fraction(1) if sides == 4 else root / 2

    def turned(point: Point) -> Point:
        x, y = point
        return cosine * x - sine * y, sine * x + cosine * y

    sides_, pleats = [(Fraction(4), Fraction(0))], [pleat]
    for _ in range(sides - 1):
        sides_.append(turned(sides_[-1]))
        pleats.append(turned(pleats[-1]))
    corners: list[Point] = [(Fraction(0), Fraction(0))]
    for dx, dy in sides_[:-1]:
        corners.append((corners[-1][0] + dx, corners[-1][1] + dy))
    return twist(corners, pleats)


def chicken_wire(columns: int, rows: int) -> PanelPattern:
    """Regular hexagons side by side, drawn on a lattice of 60 degrees."""
    root = RATIONALS.adjoined(3).root
    number: dict[tuple[int, int], int] = {}
    edges = set()
    for column in range(columns):
        for row in range(rows):
            x, y = 3 * column, 2 * row + column % 2
            ring = [(x + 2, y), (x + 1, y + 1), (x - 1, y + 1)]
            ring += [(x - 2, y), (x - 1, y - 1), (x + 1, y - 1)]
            ends = [number.setdefault(point, len(number)) for point in ring]
            edges |= {(min(e), max(e)) for e in pairwise([*ends, ends[0]])}
    return PanelPattern([(Fraction(x), root * y) for x, y in number], sorted(edges))
