"""All assignments of sheets with five corners, against solutions in closed form for random rims."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest
from sheets import dart, relabelled, wheel

from exactfold import PROVED, UNDECIDED, delaunay
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.design.circles import circles
from exactfold.design.circles import covering as coverings
from exactfold.design.circles.assignment_list import AllAssignments, Circle
from exactfold.design.circles.certificate import assignments_certificate
from exactfold.design.circles.circles import all_assignments
from exactfold.design.circles.covering import NotCoveredError, covering
from exactfold.errors import NotApplicableError, NotCountedError
from exactfold.pattern import families
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import fold_functional

CORNERS = [(0, 0), (10, -3), (16, 5), (9, 14), (-2, 9)]
PENTAGON = delaunay([*CORNERS, (5, 4), (8, 7)])
FAMILIES = delaunay([(-4, 0), (1, 4), (0, 3), (0, 0), (1, -2), (-4, 3), (4, 0)])


def pentagon(seed: int) -> CreasePattern:
    """A random convex lattice pentagon with two interior vertices that both can pop, no chord."""
    source = random.Random(seed)
    while True:
        points = [(source.randint(-20, 20), source.randint(-20, 20)) for _ in range(7)]
        if len(set(points)) < 7:
            continue
        try:
            sheet = delaunay(points)
        except ValueError:
            continue
        convex = sheet.Ve == 5 and 0 not in sheet.boundary_turns
        if convex and not sheet.rigid_vertices and not sheet.chords:
            return sheet


def letters_by_resultant(pattern: CreasePattern, count: int, seed: int) -> set[str]:
    """The letters of all four solutions for random rims, by a resultant, two interior vertices.

    Two conics A y^2 + B y + C with B of degree 1 and C of degree 2 in x meet where
    (A1 C2 - A2 C1)^2 = (A1 B2 - A2 B1)(B1 C2 - B2 C1). Floats only, polished by Newton steps.
    """
    u, v = pattern.interior
    source = np.random.default_rng(seed)
    size = len(pattern.vertices)
    forms = []
    for w in (u, v):
        form, matrix = curvature_form(pattern, w), np.zeros((size, size))
        for i, a in enumerate(form.labels):
            for j, b in enumerate(form.labels):
                matrix[a, b] = float(form.matrix[i][j])
        forms.append(matrix)
    bends = np.zeros((len(pattern.folds), size))
    for k, fold in enumerate(pattern.folds):
        for w, c in fold_functional(pattern, fold).items():
            bends[k, w] = float(c)
    found = set()
    for _ in range(count):
        rim = np.zeros(size)
        rim[list(pattern.boundary)] = source.normal(size=len(pattern.boundary))
        pairs = []
        for m in forms:
            r = m @ rim
            b = np.poly1d([2 * m[u, v], 2 * r[v]])
            pairs.append((float(m[v, v]), b, np.poly1d([m[u, u], 2 * r[u], rim @ r])))
        (a1, b1, c1), (a2, b2, c2) = pairs
        first, second = a1 * c2 - a2 * c1, a1 * b2 - a2 * b1
        for x in (first * first - second * (b1 * c2 - b2 * c1)).roots.real:
            heights = rim.copy()
            heights[u], heights[v] = x, -first(x) / second(x)
            for _ in range(3):  # the roots of a resultant may be rough
                slopes = np.array([2 * (m @ heights)[[u, v]] for m in forms])
                errors = np.array([heights @ m @ heights for m in forms])
                heights[[u, v]] -= np.linalg.solve(slopes, errors)
            values = bends @ heights
            residual = max(abs(heights @ m @ heights) for m in forms)
            if residual < 1e-10 and abs(values).min() > 1e-6 * abs(values).max():
                found.add("".join("V" if value > 0 else "M" for value in values))
    return found


def check_crossings(pattern: CreasePattern, circle: Circle) -> None:
    """Neighbouring arcs differ in folds that are flat between them, and in no other."""
    folds = pattern.folds
    for k, crossing in enumerate(circle.crossings):
        before, after = circle.arcs[k - 1].letters, circle.arcs[k].letters
        changed = {f for f, a, b in zip(folds, before, after, strict=True) if a != b}
        assert changed <= set(crossing.folds)
        assert changed  # these sheets have no fold that only touches 0


def check_mirrors(found: AllAssignments) -> None:
    assert {a.translate(UPSIDE_DOWN) for a in found.assignments} == set(found.assignments)


def test_the_list_of_a_pentagon_is_that_of_random_rims() -> None:
    found = all_assignments(PENTAGON)
    assert found.status is PROVED
    assert [len(circle.arcs) for circle in found.circles] == [10, 6, 6, 10]
    assert len(found.assignments) == 32
    assert set(found.assignments) == letters_by_resultant(PENTAGON, 300, 1)
    check_mirrors(found)
    for circle in found.circles:
        check_crossings(PENTAGON, circle)
        for arc in circle.arcs:
            signs = circle.signs.translate(UPSIDE_DOWN) if arc.mirrored else circle.signs
            assert arc.branch.sign_text == signs


@pytest.mark.survey
@pytest.mark.parametrize("seed", range(7))
def test_the_lists_of_seven_pentagons_are_those_of_six_thousand_rims(seed: int) -> None:
    pattern = pentagon(seed)
    found = all_assignments(pattern)
    assert found.status is PROVED
    assert {len(circle.arcs) for circle in found.circles} <= {6, 8, 10}
    assert len(found.assignments) in (24, 32, 40)
    assert set(found.assignments) == letters_by_resultant(pattern, 6000, seed)
    for circle in found.circles:
        check_crossings(pattern, circle)


def test_one_vertex_folds_in_twenty_ways() -> None:
    # Of five folds at a vertex four fold with one letter, or three with one and two with the other.
    found = all_assignments(families.single_vertex(5))
    assert [len(circle.arcs) for circle in found.circles] == [10, 10]
    numbers = sorted(text.count("M") for text in found.assignments)
    assert numbers == [1] * 5 + [2] * 5 + [3] * 5 + [4] * 5


def test_a_straight_side_on_which_the_first_chart_has_a_fold_at_infinity() -> None:
    # The fold at vertex 4 is flat exactly where the side is straight, at height 0 of vertex 4.
    rim = [(0, 0), (16, 0), (20, 0), (20, 20), (0, 20)]
    found = all_assignments(wheel(rim, (14, 15)))
    assert found.status is PROVED
    assert all(((1, 5),) in [c.folds for c in circle.crossings] for circle in found.circles)
    check_mirrors(found)
    assert all(set(text) <= set("MV") for text in found.assignments)


def test_where_a_star_is_flat_the_circles_of_both_signs_meet() -> None:
    found = all_assignments(PENTAGON)
    meeting = [[c for c in circle.crossings if c.vertices] for circle in found.circles]
    assert [len(row) for row in meeting] == [2, 2, 2, 2]
    assert {c.vertices for row in meeting for c in row} == {(5,)}
    assert {c.folds for row in meeting for c in row} == {((0, 5), (1, 5), (4, 5), (5, 6))}


def test_a_fold_from_border_to_border_crosses_every_circle_with_all_else_flat() -> None:
    pattern = CreasePattern(
        [(0, 0), (4, 0), (5, 3), (2, 6), (-2, 3), (2, 2)],
        [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4)],
    )
    found = all_assignments(pattern)
    assert found.status is PROVED
    assert [len(circle.arcs) for circle in found.circles] == [4, 4]
    assert len(found.assignments) == 8
    for circle in found.circles:
        assert sum(c.vertices == (5,) for c in circle.crossings) == 2


@pytest.mark.slow
def test_numbers_of_vertices_do_not_matter() -> None:
    order = [6, 2, 0, 5, 3, 1, 4]
    moved = relabelled(PENTAGON, order)
    places = [tuple(sorted((order[i], order[j]))) for i, j in moved.folds]
    back = {
        "".join(dict(zip(places, text, strict=True))[fold] for fold in PENTAGON.folds)
        for text in all_assignments(moved).assignments
    }
    assert back == set(all_assignments(PENTAGON).assignments)


@pytest.mark.slow
def test_a_triangulated_triangle_stays_flat() -> None:
    a, b, c = (PENTAGON.vertices[v] for v in PENTAGON.triangles[0])
    middle = tuple(sum((p[k] for p in (a, b, c)), Fraction(0)) / 3 for k in (0, 1))
    i, j, k = PENTAGON.triangles[0]
    faces = [*PENTAGON.triangles[1:], (i, j, 7), (j, k, 7), (k, i, 7)]
    found = all_assignments(CreasePattern([*PENTAGON.vertices, middle], faces))
    assert len(found.assignments) == 32
    assert all(text.count("F") == 3 for text in found.assignments)


def test_what_is_not_listed() -> None:
    with pytest.raises(NotCountedError, match="this boundary has 4, and vertex 1 is reflex"):
        all_assignments(dart())
    with pytest.raises(NotCountedError, match="this boundary has 6"):
        all_assignments(families.single_vertex(6))
    with pytest.raises(NotCountedError, match="no vertex of this sheet can pop"):
        all_assignments(CreasePattern(CORNERS, [(0, 1, 2), (0, 2, 3), (0, 3, 4)]))


def test_where_folds_are_flat_along_arcs_the_circles_are_covered_by_points() -> None:
    # Two straight lines cross at the hub: each folds alone, with the other flat, on half a circle.
    pattern = wheel([(4, 0), (0, 4), (-4, 0), (0, -4)])
    corner = CreasePattern([*pattern.vertices, (5, 5)], [*pattern.triangles, (0, 5, 1)])
    found = all_assignments(corner)
    assert (found.status, found.assignments, found.circles) == (PROVED, (), ())
    assert repr(found.points) == "<Covering: 2 points on 1 circles>"


def test_points_round_the_circles_show_what_algebra_finds() -> None:
    for pattern in (PENTAGON, pentagon(3), families.single_vertex(5)):
        assert covering(pattern).assignments == all_assignments(pattern).assignments


@pytest.mark.slow
def test_assignments_with_folds_flat_along_arcs_are_those_of_random_rims() -> None:
    """A fold to a corner on a straight line through a vertex: algebra has families there."""
    found = all_assignments(FAMILIES)
    assert (found.status, found.circles) == (PROVED, ())
    assert set(found.assignments) == letters_by_resultant(FAMILIES, 1000, 1)


def test_where_points_do_not_tell_folds_apart_it_is_undecided(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(coverings, "_DEPTHS", (3,))
    with pytest.raises(NotCoveredError, match=r"with the vertex signs .. the letters"):
        covering(pentagon(3))
    monkeypatch.setattr(circles, "_MOST_SOLVED", 0)
    found = all_assignments(pentagon(3))
    assert found.status is UNDECIDED
    with pytest.raises(NotApplicableError, match="this list is undecided"):
        assignments_certificate(found)
