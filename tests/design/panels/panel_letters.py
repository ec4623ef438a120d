"""Sheets and stars whose letters are asked for."""

from __future__ import annotations

import math
import random

import numpy as np

from exactfold.exact.surds import RATIONALS
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import PanelPattern


def crane_base() -> PanelPattern:
    """A bird base in half a turn of which four flaps meet: 17 lines of motions, with sqrt 2."""
    r = 2 * RATIONALS.adjoined(2).root - 4
    points = [(2, 2), (2, -2), (0, 0), (-2, 2), (-2, -2), (0, r), (r, 0), (-r, 0), (0, -r)]
    border, rest = "01 03 14 34", "07 08 12 15 17 23 25 26 27 28 36 38 45 46 56 78"
    edges = [(int(i), int(j)) for i, j in f"{border} {rest}".split()]
    return PanelPattern(points, edges)


def around(directions: list[tuple[int, int]]) -> PanelPattern:
    """A sheet with one interior vertex and these folds, counter-clockwise."""
    count = len(directions)
    spokes = [(0, k + 1) for k in range(count)]
    rim = [tuple(sorted((k + 1, (k + 1) % count + 1))) for k in range(count)]
    return PanelPattern([(0, 0), *directions], spokes + rim)


def star_of(directions: list[tuple[int, int]]) -> Star:
    """The star of `around`."""
    return Star(0, tuple((0, k + 1) for k in range(len(directions))), tuple(directions))


HEXAGON = ((1, 0), (1, 1), (0, 1), (-1, 0), (-1, -1), (0, -1))
"""Six folds at 60 degrees, sheared to whole numbers."""

HEXAGONAL = [(1, 0), (2, 1), (1, 1), (1, 2), (0, 1), (-1, 1)]
HEXAGONAL += [(-x, -y) for x, y in HEXAGONAL]


def random_directions(rng: random.Random, count: int) -> list[tuple[int, int]]:
    """Folds with all sectors less than 180 degrees: of a lattice with many relations, or random."""
    lattice = rng.random() < 0.5
    while True:
        if lattice:
            found = rng.sample(HEXAGONAL, count)
        else:
            found = [(rng.randint(-9, 9), rng.randint(-9, 9)) for _ in range(count)]
        found.sort(key=lambda d: math.atan2(d[1], d[0]))
        pairs = zip(found[-1:] + found[:-1], found, strict=True)
        if all(a[0] * b[1] - a[1] * b[0] > 0 for a, b in pairs):
            return found


def random_letters(rng: random.Random, directions: list[tuple[int, int]]) -> str:
    """The letters of a random motion to second order."""
    d = np.array(directions, dtype=float)
    brackets = np.triu(np.outer(d[:, 0], d[:, 1]) - np.outer(d[:, 1], d[:, 0]), 1)
    form = brackets + brackets.T
    plane = np.linalg.svd(d.T)[2][2:]
    numbers = np.random.default_rng(rng.randrange(10**9))
    while True:
        a, b = numbers.standard_normal((2, len(d) - 2)) @ plane
        square, middle, rest = b @ form @ b, a @ form @ b, a @ form @ a
        if middle**2 > square * rest:
            root = math.sqrt(middle**2 - square * rest) * rng.choice((1, -1))
            w = a + (root - middle) / square * b
            if np.abs(w).min() > 1e-4 * np.abs(w).max():
                return "".join("V" if x > 0 else "M" for x in w)
