"""Signs of points and lines that nearly meet, against fractions, and half planes against sums.

Here coordinates differ from small multiples of 1/6 by small multiples of 2^-62 to 2^-70, where
integers that are rounded to 64 bits begin to decide nothing, and some of what they say is wrong.
"""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import combinations, permutations, product
from math import isqrt
from types import SimpleNamespace

import pytest

from exactfold.checker.core.towers import Number, Tower
from exactfold.checker.layers.plane import Plane, rounded


def points_of(seed, size=11, unit=Fraction(1)):
    """Points whose lines nearly have common points, and some that do."""
    draw = random.Random(seed)

    def near():
        noise = Fraction(draw.choice((0, 0, -3, -1, 1, 2)), 1 << draw.randint(62, 70))
        return unit * (Fraction(draw.randint(-3, 3), 6) + noise)

    return [(near(), near()) for _ in range(size)]


def plane_of(points):
    """The plane with these points as images of vertices."""
    tower = Tower()
    numbers = [tuple(tower.number(c) for c in point) for point in points]
    sheet = SimpleNamespace(points=numbers)
    return Plane(SimpleNamespace(sheet=sheet, points=dict(enumerate(numbers)), tower=tower))


def lines_of(points):
    """The lines through two points each, as (a, b, c)."""
    found = {}
    for i, j in combinations(range(len(points)), 2):
        (x, y), (u, v) = points[i], points[j]
        if x != u:
            slope = (v - y) / (u - x)
            found[i, j] = (-slope, Fraction(1), y - slope * x)
        elif y != v:
            found[i, j] = (Fraction(1), Fraction(0), x)
    return found


def sign(number):
    return (number > 0) - (number < 0)


@pytest.mark.parametrize("unit", [Fraction(1), Fraction(1, 2**75), Fraction(2**40, 3)])
def test_points_lie_on_the_sides_of_lines_that_fractions_say(unit):
    points = points_of(1, unit=unit)
    plane, near = plane_of(points), 0
    assert plane.bits == (128 if unit < Fraction(1, 2**40) else 64)
    for edge, (a, b, c) in lines_of(points).items():
        line = plane.line(edge)
        values = [a * x + b * y - c for x, y in points]
        near += sum(0 < abs(value) < unit / 2**60 for value in values)
        sides = plane.sides(line)
        for v, value in enumerate(values):
            spot = plane.spot_of[v]
            assert plane.side(line, plane.spots[spot]) == sides[spot] == sign(value)
    assert near > 20


def determinant(rows):
    """Leibniz' formula."""
    total = Fraction(0)
    for order in permutations(range(3)):
        odd = sum(order[m] > order[n] for m, n in combinations(range(3), 2)) % 2
        product = rows[0][order[0]] * rows[1][order[1]] * rows[2][order[2]]
        total += -product if odd else product
    return total


def meet(half_planes):
    """Whether open half planes a x + b y > c have a common point, by Fourier and Motzkin."""
    low, high, rest = [], [], []
    for a, b, c in half_planes:
        if b:
            (low if b > 0 else high).append((-a / b, c / b))
        else:
            rest.append((a, c))
    rest += [(t - s, d - e) for s, d in low for t, e in high]  # s x + d < y < t x + e
    lows = [c / a for a, c in rest if a > 0]
    highs = [c / a for a, c in rest if a < 0]
    if any(c >= 0 for a, c in rest if not a):
        return False
    return not lows or not highs or max(lows) < min(highs)


def test_lines_turn_and_half_planes_meet_as_fractions_say():
    points = points_of(2, size=9)
    plane, lines, draw = plane_of(points), lines_of(points), random.Random(2)
    numbers = {plane.line(edge): line for edge, line in lines.items()}
    for (m, one), (n, other) in permutations(numbers.items(), 2):
        assert plane._turn(m, n) == sign(one[0] * other[1] - one[1] * other[0])
    small = common = apart = 0
    for _ in range(900):
        k, m, n = draw.sample(sorted(numbers), 3)
        rows = [numbers[number] for number in (k, m, n)]
        value = determinant(rows)
        small += 0 < abs(value) < Fraction(1, 2**50)
        assert plane._determinant(k, m, n) == sign(value)
        inner = tuple(draw.choice((1, -1)) for _ in range(3))
        planes = [(s * a, s * b, s * c) for s, (a, b, c) in zip(inner, rows, strict=True)]
        if all(meet(two) for two in combinations(planes, 2)):
            assert plane.misses((k, m, n), inner) is not meet(planes)
            common, apart = common + meet(planes), apart + (not meet(planes))
    assert min(small, common, apart) > 10


def test_half_planes_whose_lines_have_one_point_miss_each_other():
    points = [(0, 0), (1, 0), (0, 1), (-1, -1)]
    plane = plane_of([tuple(map(Fraction, point)) for point in points])
    lines = tuple(plane.line((0, k)) for k in (1, 2, 3))
    rows = [lines_of(points)[0, k] for k in (1, 2, 3)]
    missing = []
    for inner in product((1, -1), repeat=3):
        planes = [(s * a, s * b, s * c) for s, (a, b, c) in zip(inner, rows, strict=True)]
        missing.append(plane.misses(lines, inner))
        assert missing[-1] is not meet(planes)
    assert missing.count(True) == 2


@pytest.mark.parametrize("large", [1, 10**12, 10**40])
def test_roots_are_rounded_to_within_two(large):
    """Large multiples of a root that nearly cancel are enclosed only with more bits."""
    tower = Tower(((Fraction(2),),))
    near = isqrt(2 * large**2)
    number = Number(tower, (Fraction(-near), Fraction(large)))  # large sqrt 2 - near
    for bits in (8, 64):
        m = rounded(number, bits)
        below = isqrt(2 * (large << bits) ** 2) - (near << bits)  # |2^bits z - below| < 1
        assert abs(m - below) <= 3
