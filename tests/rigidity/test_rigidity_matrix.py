"""The rigidity matrix and its self stresses, by elimination and by wheels."""

from fractions import Fraction

import pytest
from sheets import (
    HEXAGON,
    SQUARE,
    TRIANGLE,
    dart,
    nested_triangles,
    random_wheel,
    reflex_corners,
    scrambled,
    straight_side,
    wheel,
)

from exactfold.exact.linalg import rank
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, hypar, waterbomb
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import wheel_stress
from exactfold.rigidity.self_stress import rigidity_matrix, self_stresses


def spike(height):
    """Thin triangles: three points within `height` of the middle of a long sheet."""
    points = [(0, 0), (1000, 0), (1000, 1), (0, 1)]
    near = [(300, Fraction(1, 3)), (500, Fraction(1, 2) + height), (700, Fraction(1, 2) - height)]
    return delaunay([*points, *near])


PATTERNS = {
    "one triangle": CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)]),
    **{f"random square {k}": random_square(k, seed=k) for k in (2, 4, 7)},
    "spike": spike(Fraction(1, 10**6)),
    "scrambled square": scrambled(1, SQUARE, 6),
    "scrambled hexagon": scrambled(2, HEXAGON, 5),
    "scrambled triangle": scrambled(3, TRIANGLE, 5),
    "reflex": scrambled(4, reflex_corners(1), 4),
    "dart": dart(),
    "straight side": straight_side(smallest=True),
    "nested": nested_triangles(),
    "hypar": hypar(2, twist=0),
    "waterbomb": waterbomb(),
    "symmetric octagon": wheel(
        [(2, 0), (2, 2), (0, 2), (-2, 2), (-2, 0), (-2, -2), (0, -2), (2, -2)]
    ),
    "straight path": flat_vertex_square(),
    "wheel": random_wheel(7, 9),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


def residual(pattern, stress):
    """R^T w, the force at every vertex."""
    matrix = rigidity_matrix(pattern)
    rows = dict(zip(pattern.edges, matrix, strict=True))
    return [
        sum((w * rows[edge][column] for edge, w in stress.items()), Fraction(0))
        for column in range(2 * len(pattern.vertices))
    ]


def vectors(pattern, stresses):
    return [[stress.get(edge, Fraction(0)) for edge in pattern.edges] for stress in stresses]


@patterns
def test_rank_is_2v_minus_3(pattern):
    assert rank(rigidity_matrix(pattern)) == 2 * len(pattern.vertices) - 3


@patterns
def test_self_stresses_are_as_many_as_interior_vertices(pattern):
    found = self_stresses(pattern)
    assert len(found) == pattern.Vi == len(pattern.edges) - 2 * len(pattern.vertices) + 3
    assert not found or rank(vectors(pattern, found)) == pattern.Vi
    assert all(not any(residual(pattern, stress)) for stress in found)


@patterns
def test_wheel_stress_is_a_self_stress(pattern):
    for v in pattern.interior:
        stress = wheel_stress(pattern, v)
        assert any(stress.values())
        assert not any(residual(pattern, stress))


@patterns
def test_wheel_stresses_are_a_basis(pattern):
    wheels = vectors(pattern, [wheel_stress(pattern, v) for v in pattern.interior])
    found = vectors(pattern, self_stresses(pattern))
    if not wheels:
        assert found == []
        return
    assert rank(wheels) == pattern.Vi
    assert rank([*wheels, *found]) == pattern.Vi


@patterns
def test_wheel_stress_lives_on_the_wheel(pattern):
    for v in pattern.interior:
        ring = pattern.star(v)
        assert set().union(*wheel_stress(pattern, v)) == {v, *ring}
        assert len(wheel_stress(pattern, v)) == 2 * len(ring)


def test_rigid_motions_are_in_the_kernel():
    pattern = PATTERNS["random square 4"]
    for motion in (
        [c for _ in pattern.vertices for c in (1, 0)],
        [c for _ in pattern.vertices for c in (0, 1)],
        [c for x, y in pattern.vertices for c in (-y, x)],
    ):
        for row in rigidity_matrix(pattern):
            assert sum(a * b for a, b in zip(row, motion, strict=True)) == 0


def test_a_changed_wheel_is_not_a_self_stress():
    pattern = PATTERNS["random square 4"]
    stress = wheel_stress(pattern, 4)
    edge = next(iter(stress))
    assert any(residual(pattern, stress | {edge: stress[edge] + Fraction(1, 10**9)}))
