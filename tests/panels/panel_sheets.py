"""Sheets of rigid panels whose motions are known."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from contextlib import suppress
from fractions import Fraction
from itertools import pairwise
from math import atan2, cos, pi, sin

from exactfold.errors import InputError
from exactfold.exact.surds import RATIONALS, Number
from exactfold.panels.vertex.stars import Star, star_at, stars
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
    """A sheet whose boundary joins the points from number `inner` on, in the order given."""
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


def whole(points: Sequence[tuple[int, int]], folds: Sequence[Edge], inner: int) -> PanelPattern:
    """`outlined` with whole numbers."""
    return outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, inner)


def two_stars() -> PanelPattern:
    """Two vertices with six folds that share one."""
    points = [(0, 0), (9, 0), (3, -5), (6, -5), (12, -4), (14, 0), (12, 4), (6, 5), (3, 5)]
    points += [(-3, 4), (-5, 0), (-3, -4)]
    folds = [(0, 1), (0, 2), (0, 8), (0, 9), (0, 10), (0, 11)]
    folds += [(1, 3), (1, 4), (1, 5), (1, 6), (1, 7)]
    return whole(points, folds, 2)


def row_of_stars() -> PanelPattern:
    """Three vertices in a row, of five, six and five folds."""
    points = [(0, 0), (9, 1), (18, 0), (2, -5), (7, -5), (11, -5), (16, -5), (22, -3), (22, 3)]
    points += [(17, 5), (12, 5), (6, 5), (2, 5), (-5, 3), (-4, -3)]
    folds = [(0, 1), (1, 2), (0, 3), (0, 12), (0, 13), (0, 14), (1, 4), (1, 5), (1, 10), (1, 11)]
    folds += [(2, 6), (2, 7), (2, 8), (2, 9)]
    return whole(points, folds, 3)


def crossed_stars() -> PanelPattern:
    """Two vertices with six folds, and between them one where two straight creases cross."""
    points = [(0, 0), (6, 0), (12, 0), (2, -5), (6, -5), (10, -5), (15, -4), (17, 0), (15, 4)]
    points += [(10, 5), (6, 5), (2, 5), (-3, 4), (-5, 0), (-3, -4)]
    folds = [(0, 1), (1, 2), (1, 4), (1, 10), (0, 3), (0, 11), (0, 12), (0, 13), (0, 14)]
    return whole(points, [*folds, (2, 5), (2, 6), (2, 7), (2, 8), (2, 9)], 3)


def ring_of_fives() -> PanelPattern:
    """A triangle at each of whose corners three more folds end."""
    points = [(0, 0), (8, 0), (3, 7), (-2, 6), (-6, 2), (-4, -4), (2, -6), (6, -6), (12, -4)]
    points += [(13, 3), (8, 10), (3, 13)]
    folds = [(0, 1), (1, 2), (0, 2), (0, 4), (0, 5), (0, 6), (1, 7), (1, 8), (1, 9)]
    return whole(points, [*folds, (2, 10), (2, 11), (2, 3)], 3)


def joined_twists() -> PanelPattern:
    """A square twist and its mirror image, a pleat of each meeting at a vertex that both move.

    The vertex between them cannot be folded flat, and lies on no loop.
    """
    square = [(0, 0), (4, 0), (4, 4), (0, 4)]
    ends = [(0, (6, -14)), (1, (14, -14)), (1, (15, 3)), (7, (29, 3)), (7, (30, -14))]
    ends += [(6, (38, -14)), (6, (58, -6)), (5, (58, 2)), (5, (50, 22)), (4, (42, 22))]
    ends += [(8, (26, 24)), (8, (20, 24)), (2, (2, 22)), (3, (-6, 22)), (3, (-14, 2))]
    ends += [(0, (-14, -6))]
    points = [*square, *((18 + x, 4 - y) for x, y in square), (11, 7)]
    rim = [(Fraction(x, 2), Fraction(y, 2)) for _, (x, y) in ends]
    folds = [(0, 1), (1, 2), (2, 3), (0, 3), (4, 5), (5, 6), (6, 7), (4, 7), (2, 8), (4, 8)]
    folds += [(corner, 9 + k) for k, (corner, _) in enumerate(ends)]
    return outlined([*((Fraction(x), Fraction(y)) for x, y in points), *rim], folds, 9)


def one_vertex(around: Sequence[Point]) -> PanelPattern:
    """Folds in rational directions from one vertex, the last one, to the sides of a square."""
    ends: list[tuple[Fraction, Fraction]] = []
    for x, y in around:
        scale = 10 / Fraction(max(abs(x), abs(y)))
        ends.append((x * scale, y * scale))
    ten = Fraction(10)
    corners = [(ten, ten), (-ten, ten), (-ten, -ten), (ten, -ten)]
    rim = sorted({*ends, *corners}, key=lambda p: atan2(p[1], p[0]))
    count = len(rim)
    sides = [(k, (k + 1) % count) for k in range(count)]
    return PanelPattern(
        [*rim, (Fraction(0), Fraction(0))], sides + [(rim.index(end), count) for end in ends]
    )


def star_of(sheet: PanelPattern | Sequence[Point]) -> Star:
    """All folds of the only vertex of a sheet, or folds in these directions."""
    if isinstance(sheet, PanelPattern):
        return star_at(sheet, sheet.interior[0])
    return Star(0, tuple((0, k + 1) for k in range(len(sheet))), tuple(sheet))


def ring(seed: int, degrees: Sequence[int] = (4, 4, 4, 5)) -> PanelPattern:
    """A panel whose corners have these numbers of folds, in a ring of panels on the boundary.

    The other folds end at a vertex of the boundary each. Every sector is less than a half turn.
    """
    count = len(degrees)
    for number in range(1000 * seed, 1000 * seed + 1000):
        rng = random.Random(number)
        corners = [
            (rng.uniform(60, 140), 2 * pi * (k + rng.uniform(-0.25, 0.25)) / count)
            for k in range(count)
        ]
        folds = [(k, (k + 1) % count) for k in range(count)]
        ends: list[tuple[float, float]] = []
        for k, (_, angle) in enumerate(corners):
            spread = 0.9 * pi / count
            for turn in sorted(rng.uniform(-spread, spread) for _ in range(degrees[k] - 2)):
                folds.append((k, count + len(ends)))
                ends.append((rng.uniform(380, 420), angle + turn))
        points = [(round(r * cos(t)), round(r * sin(t))) for r, t in (*corners, *ends)]
        exact = [(Fraction(x), Fraction(y)) for x, y in points]
        with suppress(InputError):
            sheet = outlined(exact, folds, count)
            if [len(star.folds) for star in stars(sheet).values()] == list(degrees):
                return sheet
    raise ValueError(f"no ring was found with seed {seed}")


def corner_diagonals() -> PanelPattern:
    """Two rows and two columns of creases on a square, and a crease to each corner.

    Where one of the two folds to the neighbours is flat, the form of a vertex is a square.
    """
    points = [(1, 1), (2, 1), (2, 2), (1, 2), (0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (3, 2)]
    points += [(3, 3), (2, 3), (1, 3), (0, 3), (0, 2), (0, 1)]
    folds = [(0, 1), (1, 2), (2, 3), (0, 3), (0, 4), (0, 5), (0, 15), (1, 6), (1, 7), (1, 8)]
    folds += [(2, 9), (2, 10), (2, 11), (3, 12), (3, 13), (3, 14)]
    return outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, 4)
