"""Definite combinations of curvature forms: found for every convex sheet, checked two ways."""

import pytest
from sheets import HEXAGON, SQUARE, TRIANGLE, dart, nested_triangles, scrambled, straight_side

from exactfold.exact.linalg import inertia, inertia_by_elimination
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_octahedron_in_square, hypar, waterbomb
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.curvature import curvature_form, stress_form, wheel_stress
from exactfold.rigidity.definite_stresses import (
    combined_form,
    definite_stress,
    inside,
    is_definite,
)
from exactfold.rigidity.rigid_triangles import certify_rigid_triangles

CONVEX = {
    **{f"random square {k}": random_square(k, seed=k) for k in (1, 3, 6, 9)},
    **{f"scrambled square {k}": scrambled(k, SQUARE, 7) for k in range(4)},
    **{f"scrambled hexagon {k}": scrambled(k, HEXAGON, 6) for k in range(3)},
    **{f"scrambled triangle {k}": scrambled(k, TRIANGLE, 8) for k in range(6)},
    "straight side": straight_side(smallest=True),
    "hypar": hypar(2, twist=0),
    "waterbomb": waterbomb(),
}


@pytest.mark.parametrize("pattern", CONVEX.values(), ids=CONVEX.keys())
def test_is_definite_for_a_convex_sheet(pattern):
    stress = definite_stress(pattern)
    assert stress is not None
    assert sorted(stress) == list(pattern.interior)
    assert all(weight > 0 for weight in stress.values())
    matrix = combined_form(pattern, stress)
    assert inertia(matrix) == inertia_by_elimination(matrix) == (pattern.Vi, 0, 0)


@pytest.mark.parametrize("pattern", CONVEX.values(), ids=CONVEX.keys())
def test_combined_form_is_the_form_of_the_combined_stress(pattern):
    stress = definite_stress(pattern)
    total = {}
    for v, weight in stress.items():
        for edge, w in wheel_stress(pattern, v).items():
            total[edge] = total.get(edge, 0) + weight * w
    whole = stress_form(pattern, total).matrix
    matrix = combined_form(pattern, stress)
    for a, i in enumerate(pattern.interior):
        for b, j in enumerate(pattern.interior):
            assert matrix[a][b] == whole[i][j]


def test_no_definite_stress_where_the_notch_is_open():
    pattern = dart()
    assert definite_stress(pattern) is None
    # There is none of any kind: the one form is negative definite in the one interior height.
    form = curvature_form(pattern, 4)
    assert form.matrix[0][0] < 0
    assert not is_definite(pattern, {4: 1})


def test_definite_stress_where_the_notch_is_closed():
    closed = dart().with_notch_closed()
    assert closed.interior == (1, 4)
    stress = definite_stress(closed)
    assert stress is not None
    assert inertia_by_elimination(combined_form(closed, stress)) == (2, 0, 0)


def test_is_not_definite_with_a_negative_multiplier():
    pattern = random_square(3, seed=1)
    stress = definite_stress(pattern)
    assert is_definite(pattern, stress)
    assert not is_definite(pattern, {v: -weight for v, weight in stress.items()})


def test_no_interior_vertex_needs_no_multiplier():
    assert definite_stress(CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])) == {}


@pytest.mark.parametrize("pattern", [nested_triangles(), flat_octahedron_in_square()])
def test_inside_of_a_triangulated_triangle(pattern):
    ((cycle, vertices),) = pattern.triangulated_triangles
    part = inside(pattern, cycle, vertices)
    assert part.boundary == (0, 1, 2)
    assert part.vertices == tuple(pattern.vertices[v] for v in (*cycle, *vertices))
    assert part.Vi == len(vertices) == 3
    (proof,) = certify_rigid_triangles(pattern)
    assert (proof.corners, proof.inside) == (cycle, vertices)
    assert is_definite(part, dict(zip((3, 4, 5), proof.multipliers, strict=True)))


def test_sheet_without_triangulated_triangles_needs_no_proof():
    assert certify_rigid_triangles(random_square(5, seed=0)) == ()
