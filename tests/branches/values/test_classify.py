"""Signs of branches: independent of the timelike vector, of the box, and checked in floats."""

import random
from fractions import Fraction
from math import hypot

import pytest
from sheets import dart, nested_triangles, reflex_corners, scrambled, wheel

from exactfold import random_square
from exactfold.branches import count_branches
from exactfold.branches.values import classify as module
from exactfold.branches.values.classify import classify
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot
from exactfold.exact.numbers import integer_row
from exactfold.pattern.families import (
    collinear_folds,
    flat_vertex_square,
    h1_sequence,
    hypar,
    two_vertex,
)
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.problem import Problem, barycentric
from exactfold.rigidity.equations.sign_rows import Functionals
from exactfold.rigidity.timelike import round_cone
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk_at

PATTERNS = {
    "two vertices": two_vertex(),
    "random": random_square(4, seed=2),
    "h1": h1_sequence(4, seed=1),
    "reflex": scrambled(2, reflex_corners(2), 3, loose=True),
    "dart": dart(),
    "flat vertex": flat_vertex_square(),
    "hypar": hypar(1, twist=0),
    "nested": nested_triangles(),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


@patterns
def test_vertex_signs_do_not_depend_on_the_timelike_vector(pattern):
    reduced, labels = pattern.without_rigid_parts()
    source = random.Random(0)
    result = count_branches(pattern)
    chart = result.proof.chart
    for k in reduced.interior:
        form, cone = curvature_form(reduced, k), round_cone(reduced, k)
        size = max(map(abs, cone.values()))
        found = 0
        while found < 3:
            noise = {v: size * Fraction(source.randint(-60, 60), 100) for v in cone}
            other = {v: cone[v] + noise[v] for v in cone}
            if form(other) <= 0 or form.polar(cone, other) <= 0:
                continue
            found += 1
            row = integer_row(chart.restrict(form.functional(other)))
            for branch in result.branches:
                assert branch.root.sign(row) == branch.vertex_signs[labels[k]]


@patterns
def test_vertex_signs_are_those_of_the_mean_slope(pattern):
    """In floats from the heights: a tent slopes down on average in all directions."""
    for branch in count_branches(pattern).branches:
        h = branch.approx_heights
        for v in pattern.interior:
            mean = 0.0
            x, y = pattern.vertices[v]
            ring = pattern.star(v)
            for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
                (ax, ay), (bx, by) = (
                    (float(pattern.vertices[u][0] - x), float(pattern.vertices[u][1] - y))
                    for u in (i, j)
                )
                p, q, c = h[i] - h[v], h[j] - h[v], ax * by - ay * bx
                gx, gy = (p * by - q * ay) / c, (q * ax - p * bx) / c
                a, b = hypot(ax, ay), hypot(bx, by)
                mean += gx * (by / b - ay / a) + gy * (ax / a - bx / b)
            sign = branch.vertex_signs[v]
            assert (mean < -1e-9, mean > 1e-9) == (sign > 0, sign < 0)


@patterns
def test_folds_are_those_of_the_heights(pattern):
    """Across a fold: is the far corner of one face above the plane of the other? In floats."""
    for branch in count_branches(pattern).branches:
        h = branch.approx_heights
        for (i, j), letter in branch.assignment.items():
            k, m = pattern.opposite((i, j))
            corners = [
                (float(pattern.vertices[v][0]), float(pattern.vertices[v][1]), h[v])
                for v in (i, j, k, m)
            ]
            (ax, ay, az), *others = corners
            (bx, by, bz), (cx, cy, cz), (dx, dy, dz) = (
                (px - ax, py - ay, pz - az) for px, py, pz in others
            )
            normal = (by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx)
            above = (normal[0] * dx + normal[1] * dy + normal[2] * dz) / normal[2]
            assert {"V": above > 1e-9, "M": above < -1e-9, "F": abs(above) < 1e-9}[letter]


@patterns
def test_every_vertex_has_mountains_and_valleys(pattern):
    """A flat-foldable star with curvature 0 is never all valleys or all mountains."""
    for branch in count_branches(pattern).branches:
        for v in pattern.interior:
            around = {branch.assignment[min(v, j), max(v, j)] for j in pattern.star(v)}
            bent = around - {"F"}
            if len(bent) == 1:  # along a straight line, with the folds across it flat
                letters = {j: branch.assignment[min(v, j), max(v, j)] for j in pattern.star(v)}
                i, j = sorted(j for j, letter in letters.items() if letter != "F")
                assert (i, v, j) in collinear_folds(pattern)
            assert (bent == set()) == (branch.vertex_signs[v] == 0)


def test_vertex_of_degree_four_pops_to_the_side_of_its_odd_fold():
    for branch in count_branches(two_vertex()).branches:
        for v in (4, 5):
            letters = [branch.assignment[min(v, j), max(v, j)] for j in two_vertex().star(v)]
            assert sorted(letters) in (["M", "M", "M", "V"], ["M", "V", "V", "V"])
            assert branch.vertex_signs[v] == (1 if letters.count("M") == 3 else -1)


def test_branches_are_sorted_by_vertex_signs():
    for pattern in PATTERNS.values():
        keys = [list(b.vertex_signs.values()) for b in count_branches(pattern).branches]
        assert keys == sorted(keys)


# --- undecided signs -----------------------------------------------------------------------------


def chart_and_boxes(pattern):
    boxes = [branch.root.box for branch in count_branches(pattern).branches]
    return BranchSystem(pattern).chart, boxes


def coarse(box, bits):
    """A much wider box around the same centre: the same zero, fewer signs."""
    return IsolatingBox(box.real, (), box.radius << bits, box.bits)


def test_sharper_boxes_decide_what_a_wide_one_leaves_open():
    pattern = random_square(2, seed=0)
    chart, boxes = chart_and_boxes(pattern)
    wide = [coarse(box, 60) for box in boxes]
    first = Functionals(chart)
    rows = [*first.vertices.values(), *first.folds.values()]
    assert any(BoxRoot(box).sign(row) is None for box in wide for row in rows)
    branches, undecided = classify(
        Problem.of(pattern), chart, [(BoxRoot(b, system=chart.system), 1) for b in wide]
    )
    assert undecided == []
    expected = count_branches(pattern).branches
    assert [b.sign_text + b.assignment_text for b in branches] == [
        b.sign_text + b.assignment_text for b in expected
    ]


def test_signs_that_stay_open_are_named(monkeypatch):
    monkeypatch.setattr(module, "_RISING", ())
    pattern = random_square(2, seed=0)
    chart, boxes = chart_and_boxes(pattern)
    hopeless = IsolatingBox(boxes[0].real, (), boxes[0].radius << 200, boxes[0].bits)
    branches, undecided = classify(
        Problem.of(pattern), chart, [(BoxRoot(hopeless, system=chart.system), 1)]
    )
    assert branches == []
    (item,) = undecided
    assert "vertex 4" in item.what
    assert any(what.startswith("fold ") for what in item.what)


def test_sharper_box_lies_inside_and_keeps_its_signs():
    pattern = random_square(3, seed=1)
    chart, boxes = chart_and_boxes(pattern)
    rows = Functionals(chart).vertices.values()
    for box in boxes:
        sharp = krawczyk_at(chart.system, box, 256)
        assert sharp.is_inside(box)
        assert sharp.bits == 256
        assert [BoxRoot(sharp).sign(r) for r in rows] == [BoxRoot(box).sign(r) for r in rows]


def test_box_root_encloses_a_functional():
    root = BoxRoot(IsolatingBox((4, -8), (), 1, 2))  # (1, -2), each plus or minus 1/4
    assert root.enclose((2, -1, 3)) == (Fraction(7) - Fraction(3, 4), Fraction(7) + Fraction(3, 4))
    assert root.sign((1, 0, 0)) == 1
    assert root.sign((0, 1, 0)) == -1
    assert root.sign((1, 0, -1)) is None
    assert root.sign((0, 0, 0)) == 0
    assert root.sign((2, 1, 0)) is None
    assert root.sign((4, 0, -3)) is None  # the end of the box lies on the zero set
    assert root.sign((8, 0, -5)) == 1


def test_algebraic_root_vanishes_only_where_it_is_proved():
    result = count_branches(flat_vertex_square(), method="groebner")
    chart = BranchSystem(flat_vertex_square()).chart
    rows = Functionals(chart)
    for branch in result.branches:
        assert isinstance(branch.root, AlgebraicRoot)
        for v, row in rows.vertices.items():
            low, high = branch.root.enclose(row)
            sign = branch.root.sign(row)
            assert sign == branch.vertex_signs[v]
            assert low <= 0 <= high if sign == 0 else (low > 0) == (sign > 0)
            assert high - low <= Fraction(max(map(abs, row)), 2**64)
        nudged = [Fraction(0)] * (len(rows.vertices)) + [Fraction(1, 10**40)]
        assert branch.root.sign(tuple(integer_row(nudged))) == 1


# --- heights of rigid vertices -------------------------------------------------------------------


def test_barycentric_coordinates():
    pattern = wheel([(0, 0), (6, 0), (0, 6)], (1, 2))
    assert barycentric(pattern, (0, 1, 2), 3) == (Fraction(1, 2), Fraction(1, 6), Fraction(1, 3))
    assert barycentric(pattern, (0, 1, 2), 1) == (0, 1, 0)


def test_rigid_vertices_lie_in_the_plane_of_their_corners():
    pattern = nested_triangles()
    ((cycle, inside),) = pattern.triangulated_triangles
    for branch in count_branches(pattern).branches:
        for v in inside:
            weights = barycentric(pattern, cycle, v)
            assert sum(weights) == 1
            ends = [branch.heights[c] for c in cycle]
            low = sum(w * a for w, (a, _) in zip(weights, ends, strict=True))
            high = sum(w * b for w, (_, b) in zip(weights, ends, strict=True))
            below, above = branch.heights[v]
            assert low <= below <= above <= high
