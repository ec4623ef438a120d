"""The linear functionals for vertex signs, folds and the boundary saddle."""

import random
from fractions import Fraction
from math import hypot, sqrt

import pytest
from sheets import (
    SQUARE,
    dart,
    mapped,
    mirrored,
    random_wheel,
    reflex_corners,
    rotated,
    scrambled,
    straight_side,
    wheel,
)

from exactfold.exact.linalg import nullspace
from exactfold.pattern.families import single_vertex
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import (
    fold_functional,
    saddle_functional,
    vertex_sign_functional,
)
from exactfold.rigidity.timelike import round_cone

CROSS = wheel([(1, 0), (0, 1), (-1, 0), (0, -1)])


def value(functional, heights):
    return sum((c * heights.get(v, 0) for v, c in functional.items()), Fraction(0))


def mean_slope(pattern, vertex, h):
    """The integral of the slope of the sheet over all directions at a vertex.

    On the null cone of K_v = (1/2) int (rho^2 - rho'^2) it is never 0 off the flat sheet, and
    negative where the sheet is locally a tent: the definition of "popped up" without any form.
    """
    x, y = pattern.vertices[vertex]
    ring = pattern.star(vertex)
    spokes = [(float(pattern.vertices[j][0] - x), float(pattern.vertices[j][1] - y)) for j in ring]
    rises = [h[j] - h[vertex] for j in ring]
    total = 0.0
    for k in range(len(ring)):
        (ax, ay), (bx, by) = spokes[k - 1], spokes[k]
        p, q = rises[k - 1], rises[k]
        c = ax * by - ay * bx
        gx, gy = (p * by - q * ay) / c, (q * ax - p * bx) / c
        a, b = hypot(ax, ay), hypot(bx, by)
        # The integral of (cos, sin) between the two directions.
        total += gx * (by / b - ay / a) + gy * (ax / a - bx / b)
    return total


def null_vectors(pattern, vertex, seed, count=12):
    """Heights (floats) with K_v = 0, on random lines that meet the null cone."""
    form = curvature_form(pattern, vertex)
    source = random.Random(seed)
    found = []
    while len(found) < count:
        a, b = ({v: Fraction(source.randint(-50, 50)) for v in form.labels} for _ in range(2))
        p, q, r = form(a), form.polar(a, b), form(b)
        if q * q > p * r and r:
            t = (-float(q) + sqrt(float(q * q - p * r))) / float(r)
            found.append({v: float(a[v]) + t * float(b[v]) for v in form.labels})
    return found


@pytest.mark.parametrize("degree", range(4, 10))
def test_sign_is_that_of_the_mean_slope(degree):
    pattern = random_wheel(degree, degree)
    functional = vertex_sign_functional(pattern, degree)
    seen = set()
    for h in null_vectors(pattern, degree, seed=degree):
        slope = mean_slope(pattern, degree, h)
        sign = sum(c * h[v] for v, c in functional.items())
        assert (sign > 0) == (slope < 0)
        seen.add(sign > 0)
    assert seen == {True, False}


@pytest.mark.parametrize("degree", range(4, 10))
def test_sign_is_that_of_any_other_timelike_vector(degree):
    """Perturb the round cone at random: as long as it is timelike the nappe is the same."""
    pattern = random_wheel(degree + 20, degree)
    form, cone = curvature_form(pattern, degree), round_cone(pattern, degree)
    functional = vertex_sign_functional(pattern, degree)
    source = random.Random(degree)
    others = []
    while len(others) < 3:
        other = {v: x + Fraction(source.randint(-9, 9), 2) for v, x in cone.items()}
        if form(other) > 0 and form.polar(cone, other) > 0:
            others.append(form.functional(other))
    for h in null_vectors(pattern, degree, seed=degree):
        signs = {sum(float(c) * h[v] for v, c in f.items()) > 0 for f in (functional, *others)}
        assert len(signs) == 1


def test_ridge_is_popped_up_and_its_crease_is_a_mountain():
    # Both sides of the crease 1-4-3 hang down: a tent, and the only bend is the ridge.
    ridge = {0: -1, 1: 0, 2: -1, 3: 0, 4: 0}
    assert curvature_form(CROSS, 4)({v: Fraction(x) for v, x in ridge.items()}) == 0
    assert value(vertex_sign_functional(CROSS, 4), ridge) > 0
    assert [value(fold_functional(CROSS, (k, 4)), ridge) for k in (0, 2)] == [0, 0]
    assert all(value(fold_functional(CROSS, (k, 4)), ridge) < 0 for k in (1, 3))


def test_trough_is_popped_down():
    trough = {0: 1, 1: 0, 2: 1, 3: 0, 4: 0}
    assert value(vertex_sign_functional(CROSS, 4), trough) < 0


def test_sign_vanishes_where_the_star_is_flat():
    pattern = random_square(4, seed=3)
    plane = {v: 3 * x - y + 2 for v, (x, y) in enumerate(pattern.vertices)}
    assert all(value(vertex_sign_functional(pattern, v), plane) == 0 for v in pattern.interior)


def test_degree_four_pops_to_the_side_of_its_three_like_folds():
    """On the null cone (second order; no finite folding is built) Maekawa's count holds."""
    pattern = wheel([(5, 1), (-1, 4), (-6, -1), (2, -5)])
    functional = vertex_sign_functional(pattern, 4)
    bends = [fold_functional(pattern, (k, 4)) for k in range(4)]
    for h in null_vectors(pattern, 4, seed=1, count=40):
        folds = [sum(c * h[v] for v, c in bend.items()) > 0 for bend in bends]
        assert sum(folds) in (1, 3)  # Maekawa: valleys and mountains differ by two
        popped_up = sum(c * h[v] for v, c in functional.items()) > 0
        assert popped_up == (sum(folds) == 1)  # three mountains around a peak


@pytest.mark.parametrize("seed", range(4))
def test_bowl_has_no_mountains(seed):
    """x^2 + y^2 on a Delaunay triangulation is convex; a fold is flat where four are cocircular."""
    pattern = random_square(6, seed=seed)
    bowl = {v: x * x + y * y for v, (x, y) in enumerate(pattern.vertices)}
    bends = [value(fold_functional(pattern, fold), bowl) for fold in pattern.folds]
    assert all(bend >= 0 for bend in bends)
    assert any(bend > 0 for bend in bends)


def test_fold_functional_vanishes_on_planes_and_sees_one_side():
    for pattern in (random_square(5, seed=2), scrambled(2, SQUARE, 5), dart()):
        plane = {v: 5 * x - 2 * y + 1 for v, (x, y) in enumerate(pattern.vertices)}
        for fold in pattern.folds:
            functional = fold_functional(pattern, fold)
            assert value(functional, plane) == 0
            assert all(functional[v] > 0 for v in pattern.opposite(fold))


@pytest.mark.parametrize("move", [rotated, mirrored])
def test_functionals_move_with_the_sheet(move):
    pattern = random_square(4, seed=5)
    image = mapped(pattern, move)
    h = {v: Fraction(v * v - 7 * v + 3) for v in range(len(pattern.vertices))}
    for fold in pattern.folds:
        before, after = (value(fold_functional(p, fold), h) for p in (pattern, image))
        assert (before > 0, before < 0) == (after > 0, after < 0)
    for v in pattern.interior:
        before, after = (value(vertex_sign_functional(p, v), h) for p in (pattern, image))
        assert (before > 0, before < 0) == (after > 0, after < 0)


@pytest.mark.parametrize(
    "pattern",
    [
        random_square(2, seed=0),
        single_vertex(4),
        dart(),
        scrambled(1, reflex_corners(5), 3),
        straight_side(smallest=True),
        straight_side(smallest=False),
    ],
    ids=["square", "circle", "dart", "reflex", "straight at smallest", "straight elsewhere"],
)
def test_saddle_is_the_affine_dependency_of_the_corners(pattern):
    corners = pattern.boundary
    functional = saddle_functional(pattern)
    plane = [[1, *pattern.vertices[v]] for v in corners]
    (dependency,) = nullspace([list(column) for column in zip(*plane, strict=True)])
    first = next(x for x in dependency if x)
    assert [functional[v] for v in corners] == [x / first for x in dependency]


def test_saddle_passes_over_a_smallest_corner_without_weight():
    # Vertices 3, 0, 1 are collinear, so the height of corner 2 does not matter there ...
    pattern = straight_side(smallest=True)
    assert pattern.boundary_turns[0] == 0
    opposite = pattern.boundary[2]
    assert saddle_functional(pattern)[opposite] == 0
    # ... and with that corner numbered first the next one is normalised to 1 instead.
    moved = wheel([(3, 8), (0, 0), (4, 0), (9, 0)], (4, 3))
    assert saddle_functional(moved)[0] == 0
    assert saddle_functional(moved)[1] == 1
