from fractions import Fraction
from itertools import combinations
from math import cos, radians, sin
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pattern_strategies import point_sets, quick, same_up_to_labels, similarities

from exactfold.errors import FloatRefusedError, MalformedPatternError
from exactfold.pattern.triangulating import delaunay_sheets
from exactfold.pattern.triangulating.delaunay_mesh import DelaunayMesh, proposed_mesh
from exactfold.pattern.triangulating.delaunay_sheets import (
    _sweep,
    delaunay,
    delaunay_triangles,
)


def circle(p, q, r):
    """Centre and squared radius, from the perpendicular bisectors; independent of the package."""
    (ax, ay), (bx, by), (cx, cy) = p, q, r
    d = 2 * (ax * (by - cy) + bx * (cy - ay) + cx * (ay - by))
    a, b, c = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    x = Fraction(a * (by - cy) + b * (cy - ay) + c * (ay - by)) / d
    y = Fraction(a * (cx - bx) + b * (ax - cx) + c * (bx - ax)) / d
    return x, y, (ax - x) ** 2 + (ay - y) ** 2


def hull_area(points):
    """Area of the convex hull by gift wrapping over all sides with no point to their right."""
    twice = Fraction(0)
    for p in points:
        for q in points:
            if p == q:
                continue
            turns = [(q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) for r in points]
            on_line = [r for r, t in zip(points, turns, strict=True) if t == 0]
            if min(turns) >= 0 and {p, q} == {min(on_line), max(on_line)}:
                twice += p[0] * q[1] - p[1] * q[0]
    return twice / 2


@quick
@given(point_sets(most=14, width=9))
def test_circles_are_empty_and_the_hull_is_covered(points):
    pattern = delaunay(points)
    assert pattern.vertices == tuple(points)
    for t in pattern.triangles:
        x, y, radius2 = circle(*(pattern.vertices[v] for v in t))
        assert all((px - x) ** 2 + (py - y) ** 2 >= radius2 for px, py in points)
    assert pattern.area == hull_area(points)
    assert pattern.is_convex


@quick
@given(point_sets(most=12, width=4))
def test_every_empty_circle_is_a_fan_from_its_smallest_point(points):
    pattern = delaunay(points)
    faces = {frozenset(pattern.vertices[v] for v in t) for t in pattern.triangles}
    circles = {}
    for triple in combinations(points, 3):
        (ax, ay), (bx, by), (cx, cy) = triple
        if (bx - ax) * (cy - ay) != (by - ay) * (cx - ax):
            circles.setdefault(circle(*triple), set()).update(triple)
    for (x, y, radius2), around in circles.items():
        if any((px - x) ** 2 + (py - y) ** 2 < radius2 for px, py in points):
            continue
        apex = min(around)
        inside = [face for face in faces if face <= around]
        assert len(inside) == len(around) - 2
        assert all(apex in face for face in inside)


@quick
@given(point_sets(), st.randoms(use_true_random=False))
def test_order_of_the_points_does_not_matter(points, random):
    shuffled = list(points)
    random.shuffle(shuffled)
    assert same_up_to_labels(delaunay(points), delaunay(shuffled))


@quick
@given(point_sets(most=9, width=40), similarities)
def test_similarities_commute_with_delaunay(points, similarity):
    circles = [circle(*(points[v] for v in t)) for t in delaunay(points).triangles]
    if len(set(circles)) < len(circles):
        return  # cocircular points: the tie-break looks at the coordinates
    moved = delaunay([similarity(p) for p in points])
    assert sorted(map(sorted, moved.triangles)) == sorted(map(sorted, delaunay(points).triangles))


def test_regular_grid_is_cut_by_parallel_diagonals():
    points = [(x, y) for y in range(3) for x in range(3)]
    pattern = delaunay(points)
    diagonals = {(i, j) for i, j in pattern.edges if abs(i - j) in (2, 4)} - {(0, 2), (6, 8)}
    assert diagonals == {(0, 4), (1, 5), (3, 7), (4, 8)}
    assert pattern.boundary == (0, 1, 2, 5, 8, 7, 6, 3)


def test_points_on_the_hull_stay_on_the_boundary():
    pattern = delaunay([(0, 0), (1, 0), (2, 0), (3, 0), (1, 5)])
    assert pattern.boundary == (0, 1, 2, 3, 4)
    assert pattern.folds == ((1, 4), (2, 4))


def test_tip_below_a_vertical_line_of_points():
    pattern = delaunay([(0, 0), (0, 1), (0, 2), (-1, 5), (4, 1)])
    assert pattern.area == hull_area([(0, 0), (0, 1), (0, 2), (-1, 5), (4, 1)])


def test_a_circle_missed_by_one_part_in_ten_to_the_sixty():
    tiny = Fraction(1, 10**60)
    corners = [(0, 0), (1, 0), (0, 1)]
    assert delaunay([*corners, (1, 1)]).folds == ((0, 3),)
    assert delaunay([*corners, (1 + tiny, 1)]).folds == ((1, 2),)
    assert delaunay([*corners, (1 - tiny, 1)]).folds == ((0, 3),)


@quick
@given(point_sets(most=40, width=12))
def test_the_proposal_of_scipy_ends_as_the_sweep_does(points):
    integers = [(int(x), int(y)) for x, y in points]
    mesh = proposed_mesh(integers)
    mesh.make_delaunay()
    assert mesh.triangles() == delaunay_triangles(integers)


@pytest.mark.parametrize("far", [1, 2**12, 2**20, 2**40])
def test_flips_repair_any_triangulation(far):
    source = Random(far)
    points = list({(far * source.randrange(30), source.randrange(30)): 0 for _ in range(300)})
    mesh = DelaunayMesh(points, triangles_of(_sweep(points)))
    mesh.make_delaunay()
    assert mesh.is_triangulation_of_hull()
    assert mesh.triangles() == delaunay_triangles(points)


def triangles_of(apex):
    return [(a, b, c) for (a, b), c in apex.items() if a < min(b, c)]


SQUARE = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
TWICE_AROUND = [
    (round(1000 * cos(radians(80 * k))), round(1000 * sin(radians(80 * k)))) for k in range(9)
]


@pytest.mark.parametrize(
    ("points", "triangles"),
    [
        pytest.param(SQUARE[:4], [(0, 1, 2), (0, 3, 2)], id="a clockwise triangle"),
        pytest.param([*SQUARE[:2], (1, 0), (0, 2)], [(0, 1, 3), (0, 2, 1)], id="a flat triangle"),
        pytest.param(SQUARE[:4], [(0, 1, 2), (0, 1, 3)], id="an edge twice on one side"),
        pytest.param(SQUARE, [(0, 1, 2), (0, 2, 3)], id="a point in no triangle"),
        pytest.param(SQUARE, [(0, 1, 4), (1, 2, 4), (2, 3, 4)], id="a boundary with a notch"),
        pytest.param(SQUARE, [(0, 1, 4), (1, 2, 4), (3, 0, 4)], id="a notch that rises once"),
        pytest.param(
            [(0, 0), (9, 0), (0, 9), (2, 2), (4, 2), (2, 4)],
            [(0, 1, 4), (0, 4, 3), (1, 5, 4), (1, 2, 5), (2, 3, 5), (2, 0, 3), *[(3, 4, 5)] * 3],
            id="a triangle three times",
        ),
        pytest.param(SQUARE, [(0, 1, 4), (2, 3, 4)], id="two triangles with one common point"),
        pytest.param(
            [(0, 0), (1, 0), (0, 1), (5, 0), (6, 0), (5, 1)],
            [(0, 1, 2), (3, 4, 5)],
            id="two boundaries",
        ),
        pytest.param(
            [*TWICE_AROUND, (0, 0)],
            [(k, (k + 1) % 9, 9) for k in range(9)],
            id="a boundary that turns left and goes around twice",
        ),
    ],
)
def test_what_does_not_tile_the_hull_is_refused(points, triangles):
    assert not DelaunayMesh(points, triangles).is_triangulation_of_hull()


def test_a_proposal_that_fails_gives_way_to_the_sweep(monkeypatch):
    points = list({(x * x % 211, x * 7 % 97): 0 for x in range(400)})
    expected = delaunay_triangles(points)
    monkeypatch.setattr(delaunay_sheets, "_PROPOSED", 100)
    assert delaunay_triangles(points) == expected
    far = [(2**70 + x, y) for x, y in points]  # the same place for floats
    assert proposed_mesh(far) is None
    assert delaunay_triangles(far) == expected


def test_collinear_points_error():
    with pytest.raises(MalformedPatternError, match="all 4 points") as caught:
        delaunay([(0, 0), (3, 1), (6, 2), (-3, -1)])
    assert caught.value.vertices == (0, 1, 2, 3)


def test_duplicate_vertex_error():
    with pytest.raises(MalformedPatternError, match="vertices 0 and 3"):
        delaunay([(0, 0), (1, 0), (0, 1), ("0/5", 0)])


def test_float_error():
    with pytest.raises(FloatRefusedError, match="vertex 1"):
        delaunay([(0, 0), (0.5, 0), (0, 1)])
