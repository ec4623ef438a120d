"""Single branches of sheets with given boundary heights, and shapes with angle deficits."""

from __future__ import annotations

import random
from collections.abc import Mapping
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from independent import curvature
from scipy.optimize import root
from sheets import HEXAGON, dart, nested_triangles, scrambled, wheel

from exactfold import PROVED, checker, random_square
from exactfold.branches import find_branch
from exactfold.branches.certificates.single import branch_certificate
from exactfold.branches.values.branch import Branch
from exactfold.errors import (
    BadCurvatureError,
    BoundaryHeightsError,
    NotApplicableError,
    NotFollowedError,
)
from exactfold.motion import follow
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.boundary_heights import (
    above_plane,
    default_boundary_heights,
)

PENTAGON = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
WHEEL = wheel(PENTAGON, (6, 4))
TWO = scrambled(5, HEXAGON, 2)


def with_straight_corner(square: CreasePattern) -> tuple[CreasePattern, int]:
    """The sheet with a new boundary vertex, the last, on the side of the first boundary edge."""
    a, b = square.boundary[:2]
    c = square.left(a, b)
    (ax, ay), (bx, by) = square.vertices[a], square.vertices[b]
    new = len(square.vertices)
    point = ((2 * ax + bx) / 3, (2 * ay + by) / 3)
    faces = [t for t in square.triangles if set(t) != {a, b, c}]
    return CreasePattern([*square.vertices, point], [*faces, (a, new, c), (new, b, c)]), new


# --- boundary heights -----------------------------------------------------------------------


def test_without_heights_the_border_is_that_of_a_saddle() -> None:
    found = find_branch(TWO, "+-")
    rim = default_boundary_heights(TWO)
    assert found.status is PROVED
    assert found.boundary_heights == dict(sorted(rim.items()))
    assert list(rim.values()).count(Fraction(0)) >= 3
    assert max(map(abs, rim.values())) == 1
    assert all(height.denominator in (1, 2, 4, 5, 10, 20, 25, 50, 100) for height in rim.values())
    assert found == find_branch(TWO, "+-", boundary_heights=rim)
    assert checker.check(branch_certificate(found))["gauge"] == "rim"
    with pytest.raises(NotApplicableError, match="vertex 1 is reflex"):
        default_boundary_heights(dart())
    with pytest.raises(NotApplicableError, match="three boundary vertices"):
        default_boundary_heights(wheel([(0, 0), (3, 0), (0, 3)], (1, 1)))


def test_the_second_saddle_is_taken_where_the_first_is_flat_on_the_border() -> None:
    # x^2 + x y - y^2 = 1 at (1, 0), (1, 1), (-1, 0), (-1, -1): these four heights lie in one plane.
    pattern = wheel([(-1, -1), (1, 0), (1, 1), (-1, 0)])
    corners = {v: pattern.vertices[v] for v in pattern.boundary}
    first = {v: x * x + x * y - y * y for v, (x, y) in corners.items()}
    assert set(above_plane(pattern, first).values()) == {0}
    second = above_plane(pattern, {v: x * x - y * y for v, (x, y) in corners.items()})
    assert default_boundary_heights(pattern) == {
        v: h / max(map(abs, second.values())) for v, h in second.items()
    }


@pytest.mark.parametrize("sign", [1, -1])
def test_one_vertex_is_the_root_of_a_quadratic(sign: int) -> None:
    hub = 5
    rim = {v: Fraction(h, 7) for v, h in enumerate((3, -1, 0, 2, 5))}
    for deficit in (Fraction(0), Fraction(2, 3)):
        found = find_branch(WHEEL, {hub: sign}, boundary_heights=rim, curvature={hub: deficit})
        heights = {v: {**rim, hub: Fraction(v)} for v in (-1, 0, 1)}
        low, middle, high = (curvature(WHEEL, heights[v], hub) - deficit for v in (-1, 0, 1))
        a, b = float(high + low - 2 * middle) / 2, float(high - low) / 2
        z = (-b + sign * (b * b - 4 * a * float(middle)) ** 0.5) / (2 * a)  # a > 0: up is above
        assert abs(float(found.centres[hub]) - z) < 1e-9
        assert found.status is PROVED


def by_newton(
    pattern: CreasePattern, rim: Mapping[int, Fraction], deficits: Mapping[int, Fraction]
) -> list[dict[int, float]]:
    """All real solutions that SciPy finds from 20 random starts, each once."""
    inner = pattern.interior
    source = random.Random(1)

    def values(x: np.ndarray) -> list[float]:
        exact = {v: Fraction(height) for v, height in zip(inner, x.tolist(), strict=True)}
        heights = {**rim, **exact}
        return [float(curvature(pattern, heights, v) - deficits.get(v, 0)) for v in inner]

    found: list[np.ndarray] = []
    for _ in range(20):
        result = root(values, [source.uniform(-3, 3) for _ in inner], tol=1e-12)
        if max(map(abs, values(result.x))) > 1e-9:
            continue
        if all(abs(result.x - other).max() > 1e-5 for other in found):
            found.append(result.x)
    return [dict(zip(inner, x.tolist(), strict=True)) for x in found]


@pytest.mark.parametrize(
    "deficits",
    [pytest.param({}, marks=pytest.mark.slow), {6: Fraction(1, 3), 7: Fraction(1, 50)}],
)
def test_all_solutions_that_newton_finds_are_the_proved_ones(
    deficits: dict[int, Fraction],
) -> None:
    rim = {v: Fraction((v * v) % 5, 2) for v in TWO.boundary}
    proved = [
        find_branch(TWO, signs, boundary_heights=rim, curvature=deficits or None)
        for signs in product((1, -1), repeat=2)
    ]
    floats = by_newton(TWO, rim, deficits)
    assert len(floats) == 4
    places = [
        [max(abs(float(p.centres[v]) - f[v]) for v in TWO.interior) < 1e-7 for f in floats]
        for p in proved
    ]
    assert [row.count(True) for row in places] == [1] * 4
    assert len({row.index(True) for row in places}) == 4


def test_a_corner_on_a_straight_side_changes_nothing_if_it_stays_on_it() -> None:
    square = random_square(4, seed=3)
    pattern, new = with_straight_corner(square)
    turns = dict(zip(pattern.boundary, pattern.boundary_turns, strict=True))
    assert [v for v, turn in turns.items() if not turn] == [new]
    a, b = square.boundary[:2]
    for signs in ("+-+-", "++--"):
        plain = find_branch(square, signs)
        rim = {v: plain.centres[v] for v in square.boundary}
        on_line = rim | {new: (2 * rim[a] + rim[b]) / 3}
        found = find_branch(pattern, signs, boundary_heights=on_line)
        assert found.straight_boundary == (new,)
        for v in square.interior:
            assert abs(found.centres[v] - plain.centres[v]) <= plain.radius + found.radius
        for fold, letter in plain.assignment.items():
            assert found.assignment[fold] == letter
        bent = find_branch(pattern, signs, boundary_heights=on_line | {new: on_line[new] + 1})
        [fold] = [fold for fold in pattern.folds if new in fold]
        assert bent.assignment[fold] == "M"  # the side bends like a mountain there


def test_errors_of_heights_name_the_vertex() -> None:
    rim = dict.fromkeys(TWO.boundary, 0) | {0: 1}
    with pytest.raises(BoundaryHeightsError, match="boundary vertex 3 has no height") as missing:
        find_branch(TWO, "++", boundary_heights={v: h for v, h in rim.items() if v != 3})
    assert missing.value.vertices == (3,)
    with pytest.raises(BoundaryHeightsError, match=r"^6 is not a boundary vertex") as inner:
        find_branch(TWO, "++", boundary_heights=rim | {6: 0})
    assert inner.value.vertices == (6,)
    with pytest.raises(BoundaryHeightsError, match=r"height of vertex 2: the float 0\.5") as number:
        find_branch(TWO, "++", boundary_heights=rim | {2: 0.5})
    assert number.value.vertices == (2,)
    level = {v: 3 * TWO.vertices[v][0] - TWO.vertices[v][1] for v in TWO.boundary}
    with pytest.raises(BoundaryHeightsError, match="the boundary is flat") as flat:
        find_branch(TWO, "++", boundary_heights=level)
    assert flat.value.vertices == TWO.boundary


def test_rims_are_followed_and_deficits_are_not() -> None:
    assert follow(find_branch(TWO, "+-"), frames=2).boundary_heights == default_boundary_heights(
        TWO
    )
    curved = find_branch("two-vertex", "+-", curvature={4: 1})
    with pytest.raises(NotFollowedError, match="angle deficits"):
        follow(curved)
    square = random_square(2, seed=1)
    rim = {v: Fraction(k in (0, 2)) for k, v in enumerate(square.boundary)}
    assert follow(find_branch(square, "+-", boundary_heights=rim), frames=2).end == "flat-fold"


def test_pictures_show_it() -> None:
    assert find_branch(TWO, "+-")._repr_svg_().count("<svg") == 1
    assert find_branch(TWO, "+-", curvature={6: 1})._repr_svg_().count("<svg") == 1


# --- angle deficits ------------------------------------------------------------------------------


def fan(hub: int, *ring: int) -> list[tuple[int, int, int]]:
    """The triangles between a hub and a closed ring of vertices."""
    return [(a, b, hub) for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]


def shapes(pattern: CreasePattern, deficits: Mapping[int, object]) -> list[Branch]:
    return [
        find_branch(pattern, signs, curvature=deficits)  # type: ignore[arg-type]
        for signs in product((1, -1), repeat=len(pattern.interior))
    ]


def test_the_curvature_is_the_angle_deficit_to_second_order() -> None:
    hub, height, step = 5, (3, -1, 0, 2, 5, 1), 1e-3
    points = [
        np.array([float(x), float(y), step * height[v]]) for v, (x, y) in enumerate(WHEEL.vertices)
    ]
    total = 0.0
    for triangle in WHEEL.triangles:
        a, b = (points[v] - points[hub] for v in triangle if v != hub)
        total += float(np.arccos(a @ b / np.sqrt((a @ a) * (b @ b))))
    exact = {v: Fraction(h) for v, h in enumerate(height)}
    assert abs((2 * np.pi - total) / step**2 - float(curvature(WHEEL, exact, hub))) < 1e-4


def test_a_triangle_has_one_shape_for_each_sign_vector() -> None:
    pattern = nested_triangles()
    inside = max(pattern.triangulated_triangles, key=lambda item: len(item[1]))[1]
    deficits = dict.fromkeys(pattern.interior, Fraction(1, 2))
    found = find_branch(pattern, {v: (-1) ** v for v in pattern.interior}, curvature=deficits)
    assert found.status is PROVED
    assert found.vertex_signs == {v: (-1) ** v for v in pattern.interior}
    for v in pattern.interior:
        assert abs(curvature(pattern, found.centres, v) - Fraction(1, 2)) < Fraction(1, 10**20)
    one = find_branch(pattern, dict.fromkeys(pattern.interior, 1), curvature={inside[0]: 1})
    assert one.status is PROVED
    claims = checker.check(branch_certificate(one))
    assert claims["curvature"] == ["1" if v == inside[0] else "0" for v in pattern.interior]


def test_shapes_differ_and_come_in_mirror_pairs() -> None:
    found = shapes(TWO, {6: "1/3", 7: 2})
    assert all(shape.status is PROVED for shape in found)
    assert len({shape.sign_text for shape in found}) == 4
    for shape, other in zip(found, found[::-1], strict=True):
        for v in TWO.interior:
            gap = abs(shape.centres[v] + other.centres[v])
            assert gap <= shape.radius + other.radius


def test_a_deficit_far_below_the_others_keeps_its_sign() -> None:
    found = find_branch(TWO, "+-", curvature={6: 1, 7: Fraction(1, 10**60)})
    assert found.status is PROVED
    assert found.sign_text == "+-"
    checker.check(branch_certificate(found))


def test_a_scale_changes_nothing() -> None:
    big = find_branch(TWO, "+-", curvature={6: 10**40, 7: 3 * 10**40})
    small = find_branch(TWO, "+-", curvature={6: 1, 7: 3})
    assert big.assignment == small.assignment
    for v in TWO.interior:
        assert abs(big.centres[v] / 10**20 - small.centres[v]) < Fraction(1, 10**9)


def test_flat_where_a_vertex_has_no_deficit() -> None:
    # A fold from boundary to boundary: nothing bends the vertices on its other side. With this
    # deficit the height of vertex 6 is 1, so that all heights are rational and flat folds are
    # known.
    pattern = CreasePattern(
        [(0, 0), (4, 0), (4, 4), (0, 4), (-3, 2), (2, 1), (-1, 2), (2, 3)],
        [*fan(5, 0, 1, 2, 7), *fan(7, 2, 3, 0)[:2], *fan(6, 0, 3, 4)],
    )
    deficit = curvature(pattern, {v: Fraction(v == 6) for v in range(8)}, 6)
    found = find_branch(pattern, {5: 1, 7: 1, 6: 1}, curvature={6: deficit})
    assert (found.status, found.sign_text) == (PROVED, "0+0")
    assert found.multiplicity == 4
    checker.check(branch_certificate(found))


def test_errors_of_deficits_name_the_vertex() -> None:
    with pytest.raises(BadCurvatureError, match="vertex 6 is negative") as negative:
        find_branch(TWO, "++", curvature={6: -1, 7: 1})
    assert negative.value.vertices == (6,)
    with pytest.raises(BadCurvatureError, match=r"^0 is not an interior vertex"):
        find_branch(TWO, "++", curvature={0: 1})
    with pytest.raises(BadCurvatureError, match="deficit of vertex 7: 'x'"):
        find_branch(TWO, "++", curvature={7: "x"})
    with pytest.raises(BoundaryHeightsError, match="the boundary is flat"):
        find_branch(TWO, "++", curvature={})
    with pytest.raises(NotApplicableError, match="reflex"):
        find_branch(dart(), "+", curvature={4: 1})


def test_a_negative_deficit_may_have_no_shape() -> None:
    # Border in a plane: K = a z^2 with a > 0 at the hub, which is no negative number.
    heights = dict.fromkeys(WHEEL.boundary, Fraction(0)) | {5: Fraction(1)}
    assert curvature(WHEEL, heights, 5) > 0
