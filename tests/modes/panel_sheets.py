"""Sheets of rigid panels whose motions are known."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction

from exactfold.exact.surds import Number
from exactfold.pattern.panel_pattern import PanelPattern

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
