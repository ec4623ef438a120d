"""What is said to be apart is so in exact rationals, and what is apart in general is said to be."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from sheets import nested_triangles, reflex_corners, star_in

from exactfold.motion.contacts.face_pairs import FacePairs, Open
from exactfold.motion.contacts.separation import (
    Swept,
    bends,
    clear_until,
    not_separated,
    through,
)
from exactfold.motion.curves.framework import Framework
from exactfold.pattern.triangulating.random_squares import random_square

NONE = np.zeros((0, 2), dtype=np.intp)


def exact(points):
    return [tuple(map(Fraction, map(float, p))) for p in points]


def minus(a, b):
    return [x - y for x, y in zip(a, b, strict=True)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def det(p, q, r, s):
    return dot(minus(q, p), cross(minus(r, p), minus(s, p)))


def runs_through(p, q, a, b, c):
    """Whether the segment pq crosses the inside of the triangle abc, in rationals."""
    sides = {det(p, q, s, t) > 0 for s, t in ((a, b), (b, c), (c, a))}
    ends = det(a, b, c, p), det(a, b, c, q)
    return len(sides) == 1 and ends[0] * ends[1] < 0


def meet(points, one, two):
    """Whether two triangles in general position meet beyond a common vertex."""
    for first, second in ((one, two), (two, one)):
        for i, j in combinations(first, 2):
            if not {i, j} & set(second) and runs_through(
                points[i], points[j], *(points[v] for v in second)
            ):
                return True
    return False


def still(points, error=0.0):
    """Positions that do not move."""
    points = np.asarray(points, dtype=float)
    return Swept.of(points[None], np.full_like(points, error), 0.0, 0.0)


class Pairs:
    """As `FacePairs`, for triangles that are no sheet."""

    def __init__(self, apart, corners, triangles):
        self.apart = np.array(apart, dtype=np.intp).reshape(-1, 2)
        self.corners = np.array(corners, dtype=np.intp).reshape(-1, 5)
        self.corner = self.corners[:, :2]
        self.closed = np.zeros(0)
        self.triangles = np.array(triangles, dtype=np.intp)
        self.hinges = np.zeros((0, 4), dtype=np.intp)


def apart(points, error=0.0):
    pairs = Pairs([(0, 1)], [], [(0, 1, 2), (3, 4, 5)])
    return not len(not_separated(pairs, still(points, error), Open.all_of(pairs)).apart)


def apart_at_corner(points, error=0.0):
    pairs = Pairs([], [(0, 1, 2, 3, 4)], [(0, 1, 2), (0, 3, 4)])
    return not len(not_separated(pairs, still(points, error), Open.all_of(pairs)).corner)


@pytest.mark.parametrize("seed", range(1))
def test_random_triangles_are_separated_iff_they_do_not_meet(seed):
    rng = np.random.default_rng(seed)
    seen = [0, 0]
    for _ in range(200):
        points = rng.uniform(-1, 1, (6, 3)) * rng.choice([1, 1e-3], (6, 1))
        truth = meet(exact(points), (0, 1, 2), (3, 4, 5))
        assert apart(points) == (not truth)
        seen[truth] += 1
        corner = points[:5]
        touching = meet(exact(corner), (0, 1, 2), (0, 3, 4))
        assert apart_at_corner(corner) == (not touching)
    assert min(seen) > 20


def test_touching_is_not_apart():
    """A corner on a face, an edge on an edge, coplanar triangles, a corner on a corner."""
    face = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    touching = {
        "corner on face": [(0.25, 0.25, 0), (0, 0, 1), (1, 1, 1)],
        "edge on edge": [(0.5, -0.5, 0), (0.5, 0.5, 0), (0.5, 0, 1)],
        "in one plane": [(0.25, 0.25, 0), (2, 2, 0), (2, 1, 0)],
        "corner on corner": [(1, 0, 0), (2, 0, 0), (2, 0, 1)],
        "corner on edge": [(0.5, 0.5, 0), (2, 2, 1), (2, 2, -1)],
    }
    for other in touching.values():
        assert not apart([*face, *other])
        # Along z where that separates them, else away.
        for gap in (1e-9, 1e-3):
            up = np.array(other) + gap * np.array([1, 1, 1])
            assert apart([*face, *up]) == (not meet(exact([*face, *up]), (0, 1, 2), (3, 4, 5)))
    assert apart([*face, (0.25, 0.25, 1e-10), (0, 0, 1), (1, 1, 1)])
    assert not apart([*face, (0.25, 0.25, 1e-12), (0, 0, 1), (1, 1, 1)])


def test_faces_at_a_vertex_whose_other_corners_touch_are_not_apart():
    v, a, b = (0, 0, 0), (1, 0, 0), (0, 1, 0)
    assert not apart_at_corner([v, a, b, a, (0, 0, 1)])
    assert not apart_at_corner([v, a, b, (0.5, 0.5, 0), (0, 0, 1)])
    assert not apart_at_corner([v, a, b, (0.3, 0.3, 0), (0.3, 0.3, 1)])
    assert not apart_at_corner([v, a, b, (2, 0, 0), (2, -1, 0)])
    # A face beyond the other's reach in the same directions is apart, but no plane parts the cones.
    assert not apart_at_corner([v, a, b, (0, 0, 0), (0, 0, 1)])
    assert apart_at_corner([v, a, b, (-1, 0, 0), (0, 0, 1)])
    assert apart_at_corner([v, a, b, (1, 0, 1e-6), (1, -1, 1)])


@pytest.mark.survey
def test_positions_within_the_error_are_all_apart():
    rng = np.random.default_rng(5)
    shown = 0
    for _ in range(300):
        points, error = rng.uniform(-1, 1, (6, 3)), 10.0 ** -rng.integers(1, 6)
        if not apart(points, error):
            continue
        shown += 1
        for _ in range(10):
            moved = points + error * rng.choice([-1, 0, 1], (6, 3))
            assert not meet(exact(moved), (0, 1, 2), (3, 4, 5))
    assert shown > 50


def random_motion(rng, order=4):
    """Polynomials of six points, shape (order + 1, 6, 3)."""
    return rng.uniform(-1, 1, (order + 1, 6, 3)) / 4.0 ** np.arange(order + 1)[:, None, None]


def value(coefficients, s):
    """The points at a rational parameter, exactly."""
    rows = [[list(map(Fraction, map(float, p))) for p in row] for row in coefficients]
    return [
        [sum(row[v][a] * s**k for k, row in enumerate(rows)) for a in range(3)]
        for v in range(len(rows[0]))
    ]


def test_moving_positions_are_within_their_bounds():
    rng = np.random.default_rng(7)
    for order in (1, 3, 8, 18):
        for _ in range(10):
            coefficients = random_motion(rng, order)
            radius = rng.uniform(0, 1e-8, (6, 3))
            low, high = np.sort(rng.uniform(-1, 1, 2))
            swept = Swept.of(coefficients, radius, low, high)
            a, b, e = (
                [list(map(Fraction, map(float, p))) for p in x]
                for x in (swept.start, swept.slope, swept.error)
            )
            middle, half = Fraction(0.5 * (low + high)), Fraction(swept.half)
            for s in (low, high, 0.5 * (low + high), low + 0.3 * (high - low)):
                s = min(max(Fraction(s), Fraction(low)), Fraction(high))
                # As in the tests of planes: the parameter may leave [m - half, m + half] by an ulp.
                t = min(max(s - middle, -half), half)
                for v, point in enumerate(value(coefficients, s)):
                    for k in range(3):
                        off = abs(a[v][k] + b[v][k] * t - point[k])
                        assert off + Fraction(float(radius[v, k])) <= e[v][k]


def test_what_is_too_large_for_the_roundings_is_never_apart():
    face = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    far = [(3, 3, 3), (3.5, 3, 3), (3, 3.5, 3)]
    assert apart([*face, *far])
    assert not apart([*face, *np.array(far) * 2])
    points = np.array([*face, *far], dtype=float)
    many = np.concatenate([points[None], np.zeros((21, 6, 3))])
    pairs = Pairs([(0, 1)], [], [(0, 1, 2), (3, 4, 5)])
    for rows, left in ((many, 1), (many[:-1], 0)):
        swept = Swept.of(rows, np.zeros((6, 3)), -1.0, 1.0)
        assert len(not_separated(pairs, swept, Open.all_of(pairs)).apart) == left


@pytest.mark.survey
def test_moving_triangles_are_clear_until_they_meet():
    rng = np.random.default_rng(8)
    pairs = Pairs([(0, 1)], [], [(0, 1, 2), (3, 4, 5)])
    stopped = 0
    for _ in range(60):
        coefficients = random_motion(rng)
        at, left = clear_until(pairs, coefficients, np.zeros((6, 3)), -1.0, 1.0)
        assert bool(left) == (at < 1)
        times = [Fraction(k, 10) for k in range(-10, 11)]
        for s in times:
            if s < at:
                assert not meet(value(coefficients, s), (0, 1, 2), (3, 4, 5))
        if left and at > -1:
            stopped += 1
            near = [Fraction(at) + Fraction(k * k, 10**6) for k in range(1, 12)]
            assert any(meet(value(coefficients, s), (0, 1, 2), (3, 4, 5)) for s in near)
    assert stopped > 4


# --- folds, and sheets ---------------------------------------------------------------------------


def turned(framework, fold, angle):
    """The flat sheet with everything to the right of one fold turned about it."""
    i, j, _, right = framework.hinges[fold]
    x = np.column_stack([framework.flat, np.zeros(len(framework.flat))])
    axis = (x[j] - x[i]) / np.linalg.norm(x[j] - x[i])
    arm = x[right] - x[i]
    moved = (
        arm * np.cos(angle)
        + np.cross(axis, arm) * np.sin(angle)
        + axis * (axis @ arm) * (1 - np.cos(angle))
    )
    x[right] = x[i] + moved
    return x


@pytest.mark.parametrize("seed", range(5))
def test_folds_are_open_until_they_are_closed(seed):
    framework = Framework.of(random_square(3, seed=seed))
    pairs = FacePairs(framework)
    for fold in range(len(framework.hinges)):
        only = Open(NONE[:, 0], NONE[:, 0], np.array([fold]))
        for angle in (0.0, 1.0, -1.0, 2.5, 3.0, np.pi - 1e-3, np.pi - 1e-7, 1e-3 - np.pi):
            assert not not_separated(pairs, still(turned(framework, fold, angle)), only)
            # At right angles: nothing below is planar.
            bend = bends(still(turned(framework, fold, angle)), framework.hinges[fold : fold + 1])
            assert bend[0] == (-1 if angle > 0 else 1) * (abs(angle) > 1e-6)
        closed = turned(framework, fold, np.pi)
        assert not_separated(pairs, still(closed), only)
        _, _, left, right = framework.hinges[fold]
        assert pairs.closed[fold] == pytest.approx(((closed[left] - closed[right]) ** 2).sum())


@pytest.mark.parametrize(
    "pattern",
    [random_square(4, seed=1), nested_triangles(), star_in(reflex_corners(1))],
    ids=["square", "triangles", "reflex"],
)
def test_the_flat_sheet_is_clear(pattern):
    framework = Framework.of(pattern)
    pairs = FacePairs(framework)
    flat = np.column_stack([framework.flat, np.zeros(len(framework.flat))])
    plane = Swept.of(flat[None], np.zeros_like(flat), 0.0, 0.0, planar=True)
    assert not not_separated(pairs, plane, Open.all_of(pairs))
    assert not not_separated(pairs, still(flat), Open.all_of(pairs))


def test_in_the_plane_nothing_is_made_of_heights():
    """Two triangles over each other are apart in space, and not by their projections."""
    points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
    pairs = Pairs([(0, 1)], [(0, 1, 2, 3, 4)], [(0, 1, 2), (3, 4, 5)])
    assert apart(points)
    rows = np.array(points, dtype=float)[None]
    planar = Swept.of(rows, np.zeros((6, 3)), 0.0, 0.0, planar=True)
    left = not_separated(pairs, planar, Open.all_of(pairs))
    assert len(left.apart) == len(left.corner) == 1


@pytest.mark.slow
def test_edges_through_faces_are_those_of_exact_rationals():
    rng = np.random.default_rng(3)
    seen = [0, 0]
    for _ in range(500):
        points = rng.uniform(-1, 1, (5, 3))
        truth = runs_through(*exact(points))
        assert through(still(points), (0, 1), (2, 3, 4)) == truth
        if through(still(points, 1e-2), (0, 1), (2, 3, 4)):
            for _ in range(10):
                moved = points + 1e-2 * rng.choice([-1, 0, 1], (5, 3))
                assert runs_through(*exact(moved))
        seen[truth] += 1
    assert min(seen) > 20
