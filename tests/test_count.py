"""Proven counts: every family and example, every method, and brute force for few vertices."""

import dataclasses
import json
import random
from collections import Counter
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
import sympy
from sheets import (
    HEXAGON,
    SQUARE,
    TRIANGLE,
    dart,
    mapped,
    nested_triangles,
    random_wheel,
    reflex_corners,
    relabelled,
    scrambled,
    straight_side,
    two_triangles,
    wheel,
    with_point,
)

from exactfold import (
    EXAMPLES,
    PROVED,
    UNDECIDED,
    CreasePattern,
    checker,
    count_branches,
    example_path,
    random_square,
    read_fold,
)
from exactfold.algebra.groebner import groebner
from exactfold.branches import classify
from exactfold.certify import algebraic
from exactfold.count import attempt, multiple_roots
from exactfold.count import collect as module
from exactfold.count.methods import SOLVERS
from exactfold.errors import NoInteriorVertexError, UsageError
from exactfold.evidence.listing import certificate
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import FAMILIES, h1_sequence, hypar, single_vertex, two_vertex
from exactfold.problem.branch_system import BranchSystem
from exactfold.problem.quadratic import QuadraticSystem
from exactfold.rigidity import rigid_triangles
from exactfold.rigidity.curvature import curvature_form
from exactfold.solve.candidates import Candidates
from exactfold.solve.popping import popping

# (distinct, with multiplicity); None where D > 1 or flat vertices make it other than a power of 2.
EXPECTED = {
    "single-vertex": (2, 2),
    "single-vertex-4": (2, 2),
    "waterbomb": (1, 1),
    "two-vertex": (4, 4),
    "flat-vertex": (3, 4),
    "flat-octahedron": (8, 64),
    "hypar": (16, 16),
    "hypar-2": (256, 256),
    "h1": (16, 16),
    "h1-4": (16, 16),
    "random-8": (256, 256),
}


def counts(result):
    return result.distinct, result.with_multiplicity, result.real, result.nonreal


def all_pairs(size):
    """Every vertex-sign vector up to reversal, twice."""
    vectors = ["".join(signs) for signs in product("+-", repeat=size) if signs[0] == "+"]
    return Counter(dict.fromkeys(vectors, 2))


def check_generic(pattern, result):
    """2^(Vi - Vt) simple branches, two for each pair of opposite sign vectors."""
    free = pattern.Vi - pattern.Vt
    assert result.status is PROVED
    assert result.true_branches is PROVED
    assert counts(result) == (1 << free, 1 << pattern.Vi, 1 << free, 0)
    assert len(result.branches) == 1 << free
    loose = [pattern.interior.index(v) for v in pattern.foldable_vertices]
    seen = Counter()
    for branch in result.branches:
        assert branch.multiplicity == 1 << pattern.Vt
        assert all(branch.vertex_signs[v] == 0 for v in pattern.rigid_vertices)
        signs = "".join(branch.sign_text[k] for k in loose)
        assert "0" not in signs
        seen[signs if signs[:1] == "+" else signs.translate(str.maketrans("+-", "-+"))] += 1
    assert seen == all_pairs(free) if free else seen == Counter({"": 1})


# --- families and examples -----------------------------------------------------------------------


@pytest.mark.parametrize("name", FAMILIES)
def test_families(name):
    result = count_branches(FAMILIES[name]())
    assert result.status is PROVED
    assert (result.distinct, result.with_multiplicity) == EXPECTED[name]


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples(name):
    result = count_branches(read_fold(example_path(name)))
    assert result.status is PROVED
    assert (result.distinct, result.with_multiplicity) == EXPECTED[name]


def test_every_family_and_example_is_expected():
    assert set(FAMILIES) | set(EXAMPLES) == set(EXPECTED)


@pytest.mark.parametrize("size", range(1, 7))
@pytest.mark.parametrize("seed", range(4))
def test_random_squares(size, seed):
    pattern = random_square(size, seed=seed)
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("steps", [1, 2, 3, 5])
def test_h1_sequences(steps, seed):
    pattern = h1_sequence(steps, seed=seed)
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("seed", range(6))
def test_triangulations_far_from_delaunay(seed):
    pattern = scrambled(seed, SQUARE, 5)
    check_generic(pattern, count_branches(pattern))


# --- non-generic sheets --------------------------------------------------------------------------


@pytest.mark.parametrize("method", ["auto", "groebner"])
def test_flat_vertex_example(method):
    result = count_branches(FAMILIES["flat-vertex"](), method=method)
    assert counts(result) == (3, 4, 3, 0)
    assert result.true_branches is UNDECIDED
    assert sorted(branch.multiplicity for branch in result.branches) == [1, 1, 2]
    (double,) = (branch for branch in result.branches if branch.multiplicity == 2)
    assert list(double.vertex_signs.values()).count(0) == 1
    # The sheet folds along the diagonal 0-4-2 alone.
    bent = {fold for fold, letter in double.assignment.items() if letter != "F"}
    assert bent == {(0, 4), (2, 4)}


def test_paths_that_meet_are_settled_by_flat_vertices():
    result = count_branches(FAMILIES["flat-vertex"](), method="popping")
    assert result.status is PROVED
    assert result.method == "popping"
    assert counts(result) == (3, 4, 3, 0)
    assert sorted(branch.multiplicity for branch in result.branches) == [1, 1, 2]


@pytest.mark.parametrize("method", ["popping", "homotopy"])
def test_multiple_roots_are_undecided_without_the_exact_engine(monkeypatch, method):
    monkeypatch.setattr(attempt, "flat_vertices", lambda chart, points: iter(()))
    result = count_branches(FAMILIES["flat-vertex"](), method=method)
    assert result.status is UNDECIDED
    assert result.distinct is result.with_multiplicity is result.real is None
    assert "2 of 4 solutions isolated" in result.reason
    assert result.open_questions


def test_multiple_roots_of_a_large_pattern_are_undecided(monkeypatch):
    monkeypatch.setattr(module, "GROEBNER_LIMIT", 1)
    monkeypatch.setattr(attempt, "flat_vertices", lambda chart, points: iter(()))
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert "the exact engine is tried up to 1 unknown, not with 2" in result.reason


def test_flat_vertices_and_the_exact_engine_agree():
    """Two independent ways: strata found by paths, and the quotient algebra of the whole system."""
    for pattern in (FAMILIES["flat-vertex"](), hypar(1, twist=0)):
        paths = count_branches(pattern, method="popping")
        exact = count_branches(pattern, method="groebner")
        assert counts(paths) == counts(exact)
        assert [b.to_dict()["vertex_signs"] for b in paths.branches] == [
            b.to_dict()["vertex_signs"] for b in exact.branches
        ]
        assert [b.multiplicity for b in paths.branches] == [b.multiplicity for b in exact.branches]


def test_flat_vertices_by_boxes_and_by_exact_classes_agree(monkeypatch):
    pattern = hypar(2, twist=0)
    exact = count_branches(pattern)
    monkeypatch.setattr(multiple_roots, "GROEBNER_LIMIT", 0)
    boxes = count_branches(pattern)
    assert counts(exact) == counts(boxes) == (205, 256, 205, 0)
    assert Counter(b.multiplicity for b in exact.branches) == {1: 192, 4: 12, 16: 1}
    assert [(b.sign_text, b.assignment_text, b.multiplicity) for b in exact.branches] == [
        (b.sign_text, b.assignment_text, b.multiplicity) for b in boxes.branches
    ]
    for result in (exact, boxes):
        document = json.loads(json.dumps(certificate(result)))
        checker.check(document)
    roots = document["evidence"]["roots"]
    place = next(k for k, root in enumerate(roots) if "flat" in root)
    for flat in ([], [9], [11, 9], [9, 11, 11], [0, 9], [5, 7, 9, 11], ["9", 11], None):
        if flat != roots[place]["flat"]:
            roots[place]["flat"] = flat
            with pytest.raises(checker.CertificateError):
                checker.check(document)


def test_flat_vertices_among_nearly_flat_ones_are_found():
    """Five vertices are flat on one branch; paths that end near it make others seem flat too."""
    inner = [(3, 3), (2, 4), (4, 4), (4, 1), (3, 4), (3, 1), (3, 2), (2, 2)]
    faces = [(0, 1, 9), (0, 11, 3), (1, 2, 7), (1, 7, 9), (2, 3, 8), (2, 6, 7), (2, 8, 6)]
    faces += [(3, 5, 8), (3, 11, 5), (4, 5, 11), (4, 6, 8), (4, 8, 5), (4, 10, 6), (4, 11, 10)]
    faces += [(6, 10, 7), (7, 10, 9), (0, 9, 10), (0, 10, 11)]
    result = count_branches(CreasePattern([(0, 0), (5, 0), (5, 5), (0, 5), *inner], faces))
    assert counts(result) == (225, 256, 225, 0)
    assert Counter(b.multiplicity for b in result.branches) == {1: 224, 32: 1}
    checker.check(json.loads(json.dumps(certificate(result))))


def test_hypar_with_a_straight_diagonal():
    pattern = hypar(1, twist=0)
    result = count_branches(pattern)
    assert result.status is PROVED
    assert result.with_multiplicity == sum(b.multiplicity for b in result.branches) == 16
    assert result.distinct == len(result.branches) == 13
    multiple = [branch for branch in result.branches if branch.multiplicity > 1]
    assert [branch.vertex_signs[v] for branch in multiple for v in pattern.interior].count(0) > 0


def test_flat_vertices_in_a_non_convex_sheet():
    """A straight crease 3-4-6 in a non-convex quadrilateral: multiple branches again."""
    points = [(7, -1), (5, -6), (9, 2), (0, -8), ("23/5", "-16/5"), ("23/3", "-1/3")]
    points += [("92/15", "-8/5"), ("923/165", "-122/55")]
    faces = [(2, 3, 4), (0, 1, 5), (1, 2, 5), (2, 4, 6), (0, 6, 7), (4, 7, 6), (0, 5, 6)]
    pattern = CreasePattern(points, [*faces, (2, 6, 5), (0, 7, 3), (3, 7, 4)])
    assert not pattern.is_convex
    result = count_branches(pattern)
    assert counts(result) == (12, 16, 12, 0)
    assert result.true_branches is UNDECIDED
    for branch in result.branches:
        assert branch.multiplicity == (2 if "0" in branch.sign_text else 1)


def test_degree_four_cross_folds_along_its_lines():
    result = count_branches(wheel([(1, 0), (0, 2), (-3, 0), (0, -1)]))
    assert counts(result) == (2, 2, 2, 0)
    assert {branch.assignment_text for branch in result.branches} == {"FVFV", "MFMF"}


# --- triangulated triangles ----------------------------------------------------------------------


@pytest.mark.parametrize("method", ["nappes", "popping", "homotopy", "groebner"])
def test_one_vertex_of_degree_three(method):
    pattern = with_point(two_vertex(), 2, (1, 2, 2))
    assert pattern.Vt == 1
    check_generic(pattern, count_branches(pattern, method=method))


@pytest.mark.parametrize("pattern", [two_triangles(), nested_triangles()])
def test_several_triangulated_triangles(pattern):
    assert pattern.Vt in (2, 3)
    check_generic(pattern, count_branches(pattern))


def test_only_rigid_vertices_leave_one_fold():
    # A square cut by a diagonal with a vertex of degree 3 in one half: the diagonal alone folds.
    pattern = with_point(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]), 0, (1, 1, 1))
    result = count_branches(pattern)
    assert counts(result) == (1, 2, 1, 0)
    (branch,) = result.branches
    assert branch.assignment[0, 2] != "F"
    assert set(branch.assignment.values()) == {"F", branch.assignment[0, 2]}


def test_multiplicities_agree_with_the_full_system():
    """The emptied pattern's roots keep multiplicity 2^Vt: the quotient of the full ideal has
    dimension 2^Vi, and its radical 2^(Vi - Vt)."""
    pattern = with_point(single_vertex(4), 1, (1, 2, 3))
    forms, unknowns = brute_force_system(pattern)
    basis = sympy.groebner(forms, *unknowns, order="grevlex")
    assert basis.is_zero_dimensional
    leading = [sympy.Poly(g, *unknowns).monoms(order="grevlex")[0] for g in basis.exprs]
    standard = [
        m
        for m in product(range(8), repeat=2)
        if not any(all(a >= b for a, b in zip(m, lead, strict=True)) for lead in leading)
    ]
    result = count_branches(pattern)
    assert len(standard) == result.with_multiplicity == 4
    assert result.distinct == 2


# --- rigid sheets and more degrees of freedom ----------------------------------------------------


@pytest.mark.parametrize("inside", [1, 2, 5])
@pytest.mark.parametrize("seed", range(3))
def test_triangular_sheet_is_rigid(inside, seed):
    pattern = scrambled(seed, TRIANGLE, inside)
    assert pattern.Ve == 3
    result = count_branches(pattern)
    assert result.status is PROVED
    assert result.true_branches is PROVED
    assert counts(result) == (0, 0, 0, 0)
    assert result.branches == ()


@pytest.mark.parametrize("degree", range(5, 13))
def test_single_vertex_with_more_folds(degree):
    result = count_branches(random_wheel(degree, degree))
    assert result.status is PROVED
    assert counts(result) == (1, 1, 1, 0)
    assert result.method == "single vertex"


def test_single_vertex_with_a_rigid_triangle():
    result = count_branches(with_point(single_vertex(6), 2, (1, 1, 2)))
    assert (result.status, result.distinct, result.with_multiplicity) == (PROVED, 1, 2)


@pytest.mark.parametrize("corners", [5, 6])
def test_two_vertices_with_more_degrees_of_freedom_are_undecided(corners):
    pattern = scrambled(1, HEXAGON[:corners], 2, loose=True)
    assert pattern.degrees_of_freedom == corners - 3
    result = count_branches(pattern)
    assert result.status is UNDECIDED
    assert f"D = {corners - 3}" in result.reason
    assert counts(result) == (None,) * 4
    assert result.evidence is None


def test_chord_of_a_sheet_with_more_degrees_of_freedom_is_named():
    # One interior vertex of degree 4, and a chord that cuts off a flap: not one double cone.
    inner = wheel([(0, 0), (4, 0), (4, 4), (0, 4)], (1, 2))
    flap = CreasePattern([*inner.vertices, (7, 2)], [*inner.triangles, (1, 5, 2)])
    assert (flap.Ve, flap.chords) == (5, ((1, 2),))
    result = count_branches(flap)
    assert result.status is UNDECIDED
    assert "the fold 1-2 splits the sheet" in result.reason


def test_no_interior_vertex_error():
    with pytest.raises(NoInteriorVertexError, match="no interior vertex"):
        count_branches(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]))


def test_unknown_method_error():
    with pytest.raises(UsageError, match="unknown method 'guess': choose one of auto"):
        count_branches(two_vertex(), method="guess")


# --- chords, reflex corners, straight sides ------------------------------------------------------


@pytest.mark.parametrize("method", ["nappes", "popping", "homotopy", "groebner"])
def test_chord_between_two_halves_with_vertices(method):
    """Each half is a triangle, hence rigid: one branch, the fold along the chord."""
    pattern = CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)])
    pattern = with_point(with_point(pattern, 1, (1, 1, 1)), 0, (1, 1, 1))
    assert pattern.chords == ((0, 2),)
    assert pattern.Vt == 2
    result = count_branches(pattern, method=method)
    assert result.status is PROVED
    assert counts(result) == (1, 4, 1, 0)
    bent = [fold for fold, letter in result.branches[0].assignment.items() if letter != "F"]
    assert bent == [(0, 2)]


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("inside", [1, 2, 4])
def test_random_non_convex_quadrilaterals(seed, inside):
    corners = reflex_corners(seed)
    pattern = scrambled(seed, corners, inside) if inside > 1 else star_in(corners)
    assert not pattern.is_convex
    check_generic(pattern, count_branches(pattern))


def star_in(corners):
    """One vertex near the reflex corner, on the diagonal through it, joined to all corners."""
    (ax, ay), _, (cx, cy), _ = corners
    near = Fraction(1, 50)
    return wheel(corners, (ax + near * (cx - ax), ay + near * (cy - ay)))


@pytest.mark.parametrize("method", ["nappes", "popping", "homotopy", "groebner"])
def test_dart(method):
    check_generic(dart(), count_branches(dart(), method=method))


@pytest.mark.parametrize("method", ["auto", "nappes", "popping", "homotopy", "groebner"])
def test_branch_with_a_flat_boundary_is_not_lost_silently(method):
    """Here raising the hub alone bends the sheet without curvature: the saddle of that branch is 0.

    It has no representative of positive saddle. One branch alone must never be called all.
    """
    pattern = wheel([(2, -2), ("2/3", 0), (2, 2), (-2, 0)])
    hub = dict.fromkeys(range(4), Fraction(0)) | {4: Fraction(1)}
    assert curvature_form(pattern, 4)(hub) == 0
    result = count_branches(pattern, method=method)
    assert result.status is UNDECIDED or counts(result) == (2, 2, 2, 0)
    assert len(result.branches) < 2 or result.status is PROVED


@pytest.mark.parametrize("method", ["nappes", "popping", "homotopy", "groebner"])
@pytest.mark.parametrize("first", range(4))
def test_boundary_angle_of_pi_wherever_numbering_starts(method, first):
    pattern = straight_side(smallest=True)
    order = [(first + k) % 4 for k in range(4)]
    pattern = relabelled(pattern, [*order, *pattern.interior])
    assert sorted(pattern.boundary_turns) == [0, 1, 1, 1]
    check_generic(pattern, count_branches(pattern, method=method))


def test_some_smallest_corner_has_no_weight_in_the_saddle():
    # Corner 0 opposite the straight vertex: moving it out of the others' plane is a tilt.
    pattern = relabelled(straight_side(smallest=True), [2, 3, 0, 1, 4, 5])
    result = count_branches(pattern)
    check_generic(pattern, result)
    for branch in result.branches:
        assert branch.heights[0] == (0, 0)
        assert branch.heights[1] == (1, 1)


# --- methods agree -------------------------------------------------------------------------------


def summary(result):
    return [(b.sign_text, b.assignment_text, b.multiplicity) for b in result.branches]


AGREEMENT = {
    **{f"random square {n}-{s}": random_square(n, seed=s) for n in (1, 2, 3, 4) for s in (5, 6)},
    "h1": h1_sequence(3, seed=4),
    "scrambled": scrambled(9, SQUARE, 4),
    "reflex": scrambled(7, reflex_corners(7), 3, loose=True),
    "straight side": straight_side(smallest=False),
}


@pytest.mark.parametrize("pattern", AGREEMENT.values(), ids=AGREEMENT.keys())
def test_methods_agree(pattern):
    results = [
        count_branches(pattern, method=m) for m in ("nappes", "popping", "homotopy", "groebner")
    ]
    for result in results:
        check_generic(pattern, result)
        assert summary(result) == summary(results[0])
        for one, other in zip(result.branches, results[0].branches, strict=True):
            for v in range(len(pattern.vertices)):
                (a, b), (c, d) = one.heights[v], other.heights[v]
                assert max(a, c) <= min(b, d)


@pytest.mark.parametrize("seed", [0, 1, 12345])
def test_seed_of_the_homotopy_does_not_matter(seed):
    pattern = random_square(3, seed=2)
    result = count_branches(pattern, method="homotopy", seed=seed)
    assert summary(result) == summary(count_branches(pattern))


# --- brute force ---------------------------------------------------------------------------------


def brute_force_system(pattern):
    """Curvature polynomials in the interior heights, by angles between spokes alone (SymPy).

    Twice the second-order angle deficit: sum over faces of the expansion of the angle at v. The
    first corner with weight in the affine dependency of the boundary is at height 1, others at 0.
    """
    corners = pattern.boundary
    plane = sympy.Matrix([[1, *map(to_sympy, pattern.vertices[v])] for v in corners])
    (dependency,) = plane.T.nullspace()
    unit = next(v for v, weight in zip(corners, dependency, strict=True) if weight != 0)
    unknowns = sympy.symbols(f"h0:{pattern.Vi}")
    height = dict.fromkeys(corners, sympy.Integer(0)) | {unit: sympy.Integer(1)}
    height |= dict(zip(pattern.interior, unknowns, strict=True))
    forms = []
    for v in pattern.interior:
        total = sympy.Integer(0)
        for face in pattern.triangles:
            if v not in face:
                continue
            k = face.index(v)
            a, b = (
                [
                    to_sympy(p - q)
                    for p, q in zip(pattern.vertices[u], pattern.vertices[v], strict=True)
                ]
                for u in (face[(k + 1) % 3], face[(k + 2) % 3])
            )
            x, y = height[face[(k + 1) % 3]] - height[v], height[face[(k + 2) % 3]] - height[v]
            cross, dot = a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]
            squares = x**2 / (a[0] ** 2 + a[1] ** 2) + y**2 / (b[0] ** 2 + b[1] ** 2)
            total += (2 * x * y - dot * squares) / cross
        forms.append(sympy.expand(total))
    return forms, unknowns


def to_sympy(x):
    return sympy.Rational(x.numerator, x.denominator)


def brute_wheels():
    patterns = [random_wheel(seed, 4) for seed in range(6)]
    patterns += [star_in(reflex_corners(seed)) for seed in range(4)]
    return [*patterns, dart(), wheel([(1, 0), (0, 2), (-3, 0), (0, -1)])]


@pytest.mark.parametrize("pattern", brute_wheels())
def test_one_vertex_against_the_quadratic_formula(pattern):
    (form,), (h,) = brute_force_system(pattern)
    a, b, c = sympy.Poly(form, h).all_coeffs()
    assert a != 0
    assert b * b - 4 * a * c > 0
    roots = sorted((-b + s * sympy.sqrt(b * b - 4 * a * c)) / (2 * a) for s in (1, -1))
    result = count_branches(pattern)
    assert counts(result) == (2, 2, 2, 0)
    boxes = sorted(branch.heights[pattern.interior[0]] for branch in result.branches)
    for root, (low, high) in zip(roots, boxes, strict=True):
        assert to_sympy(low) <= root <= to_sympy(high)
        assert high - low < Fraction(1, 10**9) * (1 + abs(low))


def brute_pairs():
    patterns = [random_square(2, seed=s, denominator=16) for s in range(4)]
    patterns += [two_vertex(), scrambled(3, reflex_corners(3), 2, loose=True)]
    return [*patterns, FAMILIES["flat-vertex"]()]


@pytest.mark.parametrize("pattern", brute_pairs())
def test_two_vertices_against_a_resultant(pattern):
    (first, second), (x, y) = brute_force_system(pattern)
    resultant = sympy.Poly(sympy.resultant(first, second, y), x)
    result = count_branches(pattern)
    assert resultant.degree() == result.with_multiplicity == 4
    assert resultant.count_roots() == len({*resultant.real_roots()}) == result.real
    v = pattern.interior[0]
    for branch in result.branches:
        low, high = (to_sympy(bound) for bound in branch.heights[v])
        multiplicity = [
            m for r, m in sympy.Poly(resultant, x).sqf_list()[1] if r.count_roots(low, high)
        ]
        assert multiplicity == [branch.multiplicity]


# --- numbers of any size -------------------------------------------------------------------------


def test_huge_denominators():
    source = random.Random(0)
    noise = Fraction(1, 10**60)
    pattern = mapped(
        random_square(3, seed=1),
        lambda p: tuple(x + noise * source.randint(-(10**50), 10**50) for x in p),
    )
    assert max(x.denominator for p in pattern.vertices for x in p) > 10**57
    check_generic(pattern, count_branches(pattern))


@pytest.mark.parametrize("scale", [Fraction(10**40), Fraction(1, 10**40), Fraction(10**150)])
@pytest.mark.parametrize("method", ["nappes", "popping", "homotopy", "groebner"])
def test_scale_does_not_matter(scale, method):
    pattern = random_square(3, seed=8)
    scaled = mapped(pattern, lambda p: (scale * p[0], scale * p[1]))
    result = count_branches(scaled, method=method)
    check_generic(scaled, result)
    assert summary(result) == summary(count_branches(pattern))


def test_far_from_the_origin():
    pattern = mapped(random_square(3, seed=8), lambda p: (p[0] + 10**30, p[1] - 10**31))
    assert summary(count_branches(pattern)) == summary(count_branches(random_square(3, seed=8)))


def test_thin_sheet():
    pattern = mapped(random_square(3, seed=4), lambda p: (p[0], p[1] / 10**4))
    check_generic(pattern, count_branches(pattern))


def test_nearly_straight_path_is_counted_apart():
    # The flat-vertex example with its path bent by 1e-12: four simple branches, two of them close.
    vertices = list(FAMILIES["flat-vertex"]().vertices)
    vertices[4] = (vertices[4][0] + Fraction(1, 10**12), vertices[4][1])
    pattern = CreasePattern(vertices, FAMILIES["flat-vertex"]().triangles)
    check_generic(pattern, count_branches(pattern))


# --- what a count records ------------------------------------------------------------------------


def test_progress_is_reported():
    seen = []
    count_branches(random_square(3, seed=0), progress=lambda *event: seen.append(event))
    assert [stage for stage, done, total in seen if done == total == 8] == ["solving", "certifying"]


def test_progress_of_the_exact_engine_is_reported():
    seen = []
    count_branches(two_vertex(), method="groebner", progress=lambda *event: seen.append(event))
    assert seen[:2] == [("computing a Groebner basis", 0, 1), ("computing a Groebner basis", 1, 1)]


def test_settings_and_time_are_recorded():
    result = count_branches(two_vertex(), method="homotopy", seed=7)
    assert result.method == "homotopy"
    assert result.settings["seed"] == 7
    assert result.settings["lost"] == 0
    assert result.seconds > 0


def test_a_missing_candidate_is_undecided(monkeypatch):
    """A solver that loses a path must cost the proof, never the count."""

    def forgetful(chart, seed, progress):
        return Candidates("popping", popping(chart).points[:-1], ("path lost on purpose",))

    monkeypatch.setitem(SOLVERS, "popping", forgetful)
    result = count_branches(random_square(2, seed=0), method="popping")
    assert result.status is UNDECIDED
    assert "3 of 4 solutions isolated" in result.reason
    assert "path lost on purpose" in result.open_questions
    assert len(result.branches) == 3
    assert result.distinct is None
    monkeypatch.setitem(SOLVERS, "nappes", forgetful)
    exactly = count_branches(random_square(2, seed=0))
    assert (exactly.status, exactly.method) == (PROVED, "groebner")


def test_what_a_solver_lost_is_no_open_question_once_all_is_proved(monkeypatch):
    def modest(chart, seed, progress):
        return Candidates("popping", popping(chart).points, ("a path may be lost",))

    monkeypatch.setitem(SOLVERS, "popping", modest)
    result = count_branches(random_square(2, seed=0), method="popping")
    assert (result.status, result.open_questions) == (PROVED, ())


def test_a_false_candidate_is_never_counted(monkeypatch):
    def inventive(chart, seed, progress):
        points = popping(chart).points.copy()
        points[0] = 10 + points[1]
        points[2] = points[3]
        return Candidates("popping", points)

    monkeypatch.setitem(SOLVERS, "popping", inventive)
    result = count_branches(random_square(2, seed=0), method="popping")
    assert result.status is UNDECIDED
    assert result.distinct is None
    assert 1 <= len(result.branches) < 4
    boxes = [branch.root.box for branch in result.branches]
    assert all(a.is_disjoint_from(b) for k, a in enumerate(boxes) for b in boxes[:k])


def test_no_candidates_at_all_are_undecided(monkeypatch):
    empty = Candidates("popping", np.zeros((0, 2), dtype=complex))
    monkeypatch.setitem(SOLVERS, "popping", lambda chart, seed, progress: empty)
    result = count_branches(two_vertex(), method="popping")
    assert result.status is UNDECIDED
    assert "0 of 4 solutions isolated" in result.reason
    assert result.branches == ()


# --- a missing lemma is never papered over -------------------------------------------------------


def test_undecided_without_a_stress_for_a_triangulated_triangle(monkeypatch):
    monkeypatch.setattr(rigid_triangles, "definite_stress", lambda pattern: None)
    for pattern in (scrambled(1, TRIANGLE, 2), two_triangles()):
        result = count_branches(pattern)
        assert result.status is UNDECIDED
        assert "no definite stress" in result.reason
        assert counts(result) == (None,) * 4


def test_undecided_without_a_proof_of_finiteness(monkeypatch):
    monkeypatch.setattr(algebraic, "definite_stress", lambda pattern: None)
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert "finiteness is not proved" in result.reason
    assert counts(result) == (None,) * 4


def test_undecided_where_a_multiplicity_is_too_small(monkeypatch):
    monkeypatch.setattr(algebraic, "flat_equations", lambda chart, root_class: ())
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert counts(result) == (None,) * 4
    assert result.evidence is None


def test_undecided_where_the_engine_finds_a_curve_of_solutions(monkeypatch):
    real = attempt.groebner
    monkeypatch.setattr(
        attempt, "groebner", lambda system: dataclasses.replace(real(system), dimension=None)
    )
    result = count_branches(two_vertex(), method="groebner")
    assert result.status is UNDECIDED
    assert "infinitely many" in result.reason


def test_undecided_where_signs_stay_open(monkeypatch):
    monkeypatch.setattr(classify.BoxRoot, "sign", lambda self, row: None)
    monkeypatch.setattr(multiple_roots, "recognise", lambda system, boxes: None)
    result = count_branches(two_vertex(), method="popping")
    assert result.status is UNDECIDED
    assert "all 4 solutions isolated, but signs are undecided on 4" in result.reason
    assert "vertex 4" in result.open_questions[0]
    assert result.branches == ()


@pytest.mark.parametrize("name", ["cross", "straight-path", "ring", "waterbomb-pair"])
def test_open_folds_cost_their_letters_and_not_the_count(monkeypatch, name):
    pattern = DEGENERATE[name]()
    known = count_branches(pattern)
    assert not known.undecided_folds
    monkeypatch.setattr(attempt, "recognised", lambda chart, found, undecided: None)
    monkeypatch.setattr(classify, "flat_folds", lambda pattern, signs: frozenset())
    result = count_branches(pattern, method="popping")
    assert result.status is PROVED
    assert counts(result) == counts(known)
    assert result.true_branches is known.true_branches
    open_folds = result.undecided_folds
    assert open_folds
    assert result.repeated_assignments is None
    for fold in open_folds:
        assert any(f"{fold[0]}-{fold[1]}" in question for question in result.open_questions)
    shown = {(b.sign_text, b.assignment_text) for b in known.branches}
    for branch in result.branches:
        agreeing = [
            text
            for signs, text in shown
            if signs == branch.sign_text
            and all(a in (b, "U") for a, b in zip(branch.assignment_text, text, strict=True))
        ]
        assert agreeing
    document = json.loads(json.dumps(certificate(result)))
    assert checker.check(document) == document["claims"]
    monkeypatch.setattr(checker, "close_flat", lambda sheet, signs: None)
    assert checker.check(document) == document["claims"]
    place = next(b for b in document["claims"]["branches"] if "U" in b["assignment"])
    for letter in "MVF?":
        forged = dict(place, assignment=place["assignment"].replace("U", letter, 1))
        branches = [forged if b is place else b for b in document["claims"]["branches"]]
        claims = dict(document["claims"], branches=branches)
        with pytest.raises(checker.CertificateError, match="as shown by"):
            checker.check(dict(document, claims=claims))
    monkeypatch.setattr(classify, "flat_folds", lambda pattern, signs: frozenset())
    assert not count_branches(pattern).undecided_folds  # "auto" asks the exact engine
    monkeypatch.setattr(algebraic, "definite_stress", lambda pattern: None)
    for method in ("auto", "groebner"):  # which cannot prove its answer, but the boxes are there
        result = count_branches(pattern, method=method)
        assert result.status is known.status or known.true_branches is not PROVED
        assert bool(result.undecided_folds) == (result.status is PROVED)


def test_largest_straight_hypar_is_proved_but_for_one_letter():
    """Vi = 12: the folds across the middle square are flat on some simple roots."""
    result = count_branches(hypar(3, 0))
    assert result.status is PROVED
    assert (result.with_multiplicity, result.nonreal) == (4096, 0)
    assert set(result.undecided_folds) <= {(13, 15)}


def test_dimension_and_degree_of_sheets_with_more_freedom():
    """The cone of solutions against a Groebner basis of its section by fixed boundary heights."""
    for seed in range(3):
        pattern = scrambled(seed, HEXAGON, 3)
        result = count_branches(pattern)
        assert result.status is UNDECIDED
        assert (result.dimension, result.degree) == (3, 1 << pattern.Vi)
        system = BranchSystem(pattern)
        inner = [v for v in system.variables if v in pattern.interior]
        rim = {v: Fraction(3 + 2 * v) for v in system.variables if v not in pattern.interior}
        matrices = []
        for form in system.quadrics.values():
            rows = {v: {inner.index(v): Fraction(1)} for v in inner}
            rows |= {v: {len(inner): height} for v, height in rim.items()}
            matrix = [[Fraction(0)] * (len(inner) + 1) for _ in range(len(inner) + 1)]
            for a, left in zip(form.labels, form.matrix, strict=True):
                for b, weight in zip(form.labels, left, strict=True):
                    for i, x in rows[a].items():
                        for j, y in rows[b].items():
                            matrix[i][j] += weight * x * y
            matrices.append(matrix)
        section = groebner(QuadraticSystem.from_rational(matrices), engine="flint")
        assert section.dimension == 1 << pattern.Vi
