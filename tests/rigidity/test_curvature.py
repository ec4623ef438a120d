"""Curvature forms: their definition by angles, their inertia, their symmetries."""

import random
from fractions import Fraction
from itertools import combinations

import mpmath
import pytest
from sheets import (
    HEXAGON,
    SQUARE,
    dart,
    mapped,
    mirrored,
    nested_triangles,
    random_wheel,
    reflex_corners,
    rotated,
    scrambled,
    wheel,
)

from exactfold.errors import UsageError
from exactfold.exact.linalg import inertia_by_elimination
from exactfold.pattern.families import flat_vertex_square, hypar, waterbomb
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form, stress_form, wheel_stress

PATTERNS = {
    "random": random_square(5, seed=1),
    "scrambled": scrambled(1, SQUARE, 5),
    "hexagon": scrambled(2, HEXAGON, 4),
    "reflex": scrambled(3, reflex_corners(2), 4),
    "dart": dart(),
    "nested": nested_triangles(),
    "hypar": hypar(1, twist=0),
    "waterbomb": waterbomb(),
    "straight path": flat_vertex_square(),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


def heights(pattern, seed=0):
    source = random.Random(seed)
    return {
        v: Fraction(source.randint(-99, 99), source.randint(1, 9))
        for v in range(len(pattern.vertices))
    }


def deficit(pattern, vertex, z):
    """2 pi minus the angles at a vertex of the sheet lifted to heights z, in high precision."""

    def vector(j):
        x, y = (a - b for a, b in zip(pattern.vertices[j], pattern.vertices[vertex], strict=True))
        return [mpmath.mpf(t.numerator) / t.denominator for t in (x, y, z[j] - z[vertex])]

    ring = pattern.star(vertex)
    total = mpmath.mpf(0)
    for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
        a, b = vector(i), vector(j)
        cosine = mpmath.fdot(a, b) / mpmath.sqrt(mpmath.fdot(a, a) * mpmath.fdot(b, b))
        total += mpmath.acos(cosine)
    return 2 * mpmath.pi - total


@patterns
def test_is_the_second_order_angle_deficit(pattern):
    with mpmath.workdps(80):
        h, step = heights(pattern), Fraction(1, 10**20)
        for v in pattern.interior:
            lifted = {u: step * x for u, x in h.items()}
            exact = curvature_form(pattern, v)(h)
            near = deficit(pattern, v, lifted) / mpmath.mpf(10) ** -40
            expected = mpmath.mpf(exact.numerator) / exact.denominator
            assert abs(near - expected) < mpmath.mpf(10) ** -20 * (1 + abs(expected))


@patterns
def test_is_the_form_of_the_wheel_stress(pattern):
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        place = {label: k for k, label in enumerate(form.labels)}
        whole = stress_form(pattern, wheel_stress(pattern, v)).matrix
        for i in range(len(pattern.vertices)):
            for j in range(len(pattern.vertices)):
                inside = i in place and j in place
                assert whole[i][j] == (form.matrix[place[i]][place[j]] if inside else 0)


@pytest.mark.parametrize("degree", range(3, 13))
@pytest.mark.parametrize("seed", range(3))
def test_inertia_is_lorentzian(degree, seed):
    form = curvature_form(random_wheel(seed, degree), degree)
    assert form.inertia == (1, degree - 3, 3)
    assert inertia_by_elimination(form.matrix) == (1, degree - 3, 3)


def test_inertia_of_a_thin_star():
    thin = wheel([(10**9, 1), (-(10**9), 2), (-(10**9), -1), (10**9, -3)])
    form = curvature_form(thin, 4)
    assert form.inertia == inertia_by_elimination(form.matrix) == (1, 1, 3)


@patterns
def test_affine_functions_are_in_the_kernel(pattern):
    a, b, c = Fraction(2, 3), Fraction(-5, 7), Fraction(11)
    plane = {v: a * x + b * y + c for v, (x, y) in enumerate(pattern.vertices)}
    for v in pattern.interior:
        assert not any(curvature_form(pattern, v).functional(plane).values())


@patterns
def test_cubic_potential(pattern):
    """dK_v/dh_w = dK_w/dh_v for all interior v, w: a polarised, hence exact, identity."""
    h = heights(pattern, 1)
    for v, w in combinations(pattern.interior, 2):
        first, second = (curvature_form(pattern, u).functional(h) for u in (v, w))
        assert first.get(w, 0) == second.get(v, 0)


def test_cubic_potential_holds_as_an_identity_in_the_heights():
    pattern = PATTERNS["random"]
    for unit in range(len(pattern.vertices)):
        h = {v: Fraction(int(v == unit)) for v in range(len(pattern.vertices))}
        for v, w in combinations(pattern.interior, 2):
            first, second = (curvature_form(pattern, u).functional(h) for u in (v, w))
            assert first.get(w, 0) == second.get(v, 0)


@patterns
def test_rotation_and_translation_change_nothing(pattern):
    moved = mapped(pattern, lambda p: tuple(t + Fraction(7, 3) for t in rotated(p)))
    for v in pattern.interior:
        assert curvature_form(moved, v) == curvature_form(pattern, v)


@patterns
def test_scaling_divides_by_the_square(pattern):
    scale = Fraction(-3, 10**9)  # a negative factor is a turn by pi as well
    scaled = mapped(pattern, lambda p: (scale * p[0], scale * p[1]))
    for v in pattern.interior:
        before, after = curvature_form(pattern, v), curvature_form(scaled, v)
        assert after.matrix == tuple(tuple(x / scale**2 for x in row) for row in before.matrix)


@patterns
def test_reflection_changes_nothing(pattern):
    image = mapped(pattern, mirrored)
    h = heights(pattern, 2)
    for v in pattern.interior:
        assert curvature_form(image, v)(h) == curvature_form(pattern, v)(h)


def test_positive_on_a_cone_over_a_convex_polygon():
    pattern = wheel([(3, 0), (1, 2), (-2, 2), (-3, -1), (0, -4)])
    # The cone whose level sets are scaled copies of the boundary: every rim vertex at -1.
    cone = dict.fromkeys(range(5), Fraction(-1)) | {5: Fraction(0)}
    assert curvature_form(pattern, 5)(cone) > 0


def test_raising_the_hub_alone_is_spacelike_for_the_dart():
    pattern = dart()
    hub = dict.fromkeys(range(4), Fraction(0)) | {4: Fraction(1)}
    assert curvature_form(pattern, 4)(hub) < 0


def test_usage_error_on_a_boundary_vertex():
    with pytest.raises(UsageError, match="vertex 0 is not an interior vertex"):
        curvature_form(PATTERNS["random"], 0)
    with pytest.raises(UsageError, match="vertex 1 is not an interior vertex"):
        wheel_stress(PATTERNS["random"], 1)
