"""The conditions round holes: against rigid motions expanded in t, and against self stresses."""

import random
from fractions import Fraction
from itertools import pairwise

import pytest
from flint import fmpq, fmpq_mat
from holed_sheets import ACROSS, BESIDE, FLAP, RING, spokes

from exactfold import count
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.errors import MalformedPatternError, NotADiskError, NotCountedError
from exactfold.panels import decompose
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.holes import conditions, free_folds, restricted, rims
from exactfold.panels.vertex.nearly import nearly_dependent, nearly_moves
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import PanelPattern

# --- against rigid motions -----------------------------------------------------------------------


def times(a, b):
    """The product of two polynomials in t, up to t^2, whose coefficients are 4 x 4 matrices."""
    return [sum((a[i] * b[k - i] for i in range(k + 1)), fmpq_mat(4, 4)) for k in range(3)]


def turned(direction, point, weight):
    """exp(t w X), where X turns about the line through the point at the speed |direction|."""
    (x, y), (px, py) = direction, point
    rows = [[0, 0, y, 0], [0, 0, -x, 0], [-y, x, 0, px * y - py * x], [0, 0, 0, 0]]
    one = fmpq_mat([[fmpq(c) * weight for c in row] for row in rows])
    identity = fmpq_mat([[int(i == j) for j in range(4)] for i in range(4)])
    return [identity, one, one * one / fmpq(2)]


def once_round(pattern, rim, w):
    """The motion of the panels after one way round a hole, up to the second order in t."""
    total = turned((0, 0), (0, 0), fmpq(0))
    for v, u in rim.crossed:
        place = pattern.direction(rim.vertices[0], v)
        weight = w[min(v, u), max(v, u)]
        total = times(total, turned(pattern.direction(v, u), place, weight))
    return total


@pytest.mark.parametrize("pattern", [RING, BESIDE])
def test_first_order_is_that_of_the_motion_round_the_hole(pattern):
    rng = random.Random(1)
    w = {fold: fmpq(rng.randrange(-9, 10)) for fold in pattern.folds}
    [rim] = rims(pattern)
    _, first, _ = once_round(pattern, rim, w)
    plane, along, _ = [star for star in conditions(pattern).values() if star.hole is not None]

    def sums(star):
        pairs = list(zip(star.folds, star.directions, strict=True))
        return [sum((w[e] * fmpq(d[axis]) for e, d in pairs), fmpq(0)) for axis in (0, 1)]

    assert [first[2, 1], -first[2, 0], first[2, 3]] == [*sums(plane), sums(along)[1]]
    assert sums(along)[0] == sums(plane)[0]


@pytest.mark.parametrize("pattern", [RING, BESIDE])
@pytest.mark.parametrize("seed", range(3))
def test_the_forms_are_the_second_order_of_the_motion_round_the_hole(pattern, seed):
    rng = random.Random(seed)
    [rim] = rims(pattern)
    rows, size = first_order(conditions(pattern))
    p = [fmpq(rng.randrange(-9, 10)) for _ in range(size)]
    w = {e: sum((a * b for a, b in zip(row, p, strict=True)), fmpq(0)) for e, row in rows.items()}
    _, first, second = once_round(pattern, rim, {**dict.fromkeys(pattern.folds, fmpq(0)), **w})
    assert first == fmpq_mat(4, 4)
    around = [star for star in conditions(pattern).values() if star.hole is not None]
    turn, along, across = (
        sum(
            w[e] * w[f] * fmpq(c[0] * d[1] - c[1] * d[0])
            for k, (f, d) in enumerate(zip(star.folds, star.directions, strict=True))
            for e, c in list(zip(star.folds, star.directions, strict=True))[:k]
        )
        for star in around
    )
    assert all((turn, along, across))
    expected = fmpq_mat(4, 4)
    expected[1, 0], expected[0, 1] = turn, -turn
    expected[0, 3], expected[1, 3] = across, -along
    assert 2 * second == expected


# --- against self stresses -----------------------------------------------------------------------


def rational(value):
    return fmpq(Fraction(value).numerator, Fraction(value).denominator)


def self_stresses(pattern):
    """A basis of the self stresses of the framework of all edges."""
    points, edges = pattern.vertices, pattern.edges
    matrix = fmpq_mat(2 * len(points), len(edges))
    for k, (i, j) in enumerate(edges):
        for axis in (0, 1):
            matrix[2 * i + axis, k] = rational(points[i][axis] - points[j][axis])
            matrix[2 * j + axis, k] = rational(points[j][axis] - points[i][axis])
    reduced, rank = matrix.rref()
    pivots = [next(k for k in range(len(edges)) if reduced[r, k]) for r in range(rank)]
    for free in sorted(set(range(len(edges))) - set(pivots)):
        stress = [fmpq(0)] * len(edges)
        stress[free] = fmpq(1)
        for r, k in enumerate(pivots):
            stress[k] = -reduced[r, free]
        yield stress


def density(pattern, fold, heights):
    """The jump of the gradient across a fold between two triangles, over its length."""
    a, b = fold
    slopes = []
    for i, j in ((a, b), (b, a)):
        (k,) = set(pattern.faces[pattern.sides[i, j]]) - {a, b}
        (px, py), (qx, qy) = (
            [rational(pattern.vertices[v][n] - pattern.vertices[a][n]) for n in (0, 1)]
            for v in (b, k)
        )
        p, q = heights[b] - heights[a], heights[k] - heights[a]
        area = px * qy - py * qx
        slopes.append(((p * qy - q * py) / area, (q * px - p * qx) / area))
    (gx, gy), (hx, hy) = slopes
    return (gy - hy) / px if px else (hx - gx) / py


@pytest.mark.parametrize("pattern", [RING, BESIDE])
def test_the_forms_are_those_of_a_basis_of_self_stresses(pattern):
    """Both span the same forms; there are 3 for each hole and one for each interior vertex."""
    rng = random.Random(4)
    stresses = list(self_stresses(pattern))
    found = conditions(pattern)
    assert len(stresses) == len(pattern.interior) + 3
    assert first_order(found)[1] == len(pattern.vertices) - 3
    ours, theirs = [], []
    for _ in range(60):
        h = [fmpq(rng.randrange(-9, 10)) for _ in pattern.vertices]
        w = {fold: density(pattern, fold, h) for fold in pattern.folds}
        for star in found.values():
            for axis in (0, 1):
                pairs = zip(star.folds, star.directions, strict=True)
                assert sum(w[e] * fmpq(d[axis]) for e, d in pairs) == 0
        ours.append(
            [
                sum(
                    w[e] * w[f] * fmpq(c[0] * d[1] - c[1] * d[0])
                    for k, (f, d) in enumerate(zip(star.folds, star.directions, strict=True))
                    for e, c in list(zip(star.folds, star.directions, strict=True))[:k]
                )
                for star in found.values()
            ]
        )
        squares = [(h[i] - h[j]) ** 2 for i, j in pattern.edges]
        theirs.append([sum(x * y for x, y in zip(s, squares, strict=True)) for s in stresses])
    both = [[*a, *b] for a, b in zip(ours, theirs, strict=True)]
    assert {fmpq_mat(rows).rank() for rows in (ours, theirs, both)} == {len(stresses)}


# --- counts --------------------------------------------------------------------------------------


def test_an_outer_triangle_with_a_quadrilateral_hole_has_eight_branches_that_are_not_real():
    result = decompose(RING)
    [part] = result.parts
    assert (len(part.isolated.real), 2 * len(part.isolated.nonreal)) == (0, 8)
    assert (result.status, result.rigid, dict(result.true)) == (PROVED, PROVED, {0: 1})
    assert "1 hole" in repr(RING)


def test_folds_round_a_hole_with_independent_lines_are_flat():
    """Three lines that pass through no common point."""
    triangle = PanelPattern(
        [(0, 0), (9, 0), (0, 9), (3, 3), (4, 3), (3, 4)],
        [(0, 1), (1, 2), (0, 2), (3, 4), (4, 5), (3, 5), (0, 3), (1, 4), (2, 5)],
        holes=[(3, 4, 5)],
    )
    # the lines pass through one point: x = y, and those through (9, 0) and (0, 9)
    assert [star.hole.rank for star in conditions(triangle).values()] == [2]
    assert len(conditions(triangle)) == 1
    moved = PanelPattern(
        [(0, 0), (9, 0), (0, 9), (3, 3), (4, 3), (3, 5)], triangle.edges, holes=[(3, 4, 5)]
    )
    assert conditions(moved) == {}
    result = decompose(moved)
    assert (result.rigid, result.flat) == (PROVED, ((0, 3), (1, 4), (2, 5)))


def test_lines_through_one_point_are_conditions_of_a_vertex():
    """Four diagonals with a square hole in place of their vertex."""
    square = spokes([(2, 2), (4, 2), (4, 4), (2, 4)])
    [star] = conditions(square).values()
    assert (star.hole.rank, star.conditions, star.has_form) == (2, 2, True)
    result = decompose(square)
    assert dict(result.true) == {1: 2}
    vertex = PanelPattern(
        [*square.vertices[:4], (3, 3)],
        [*((k, (k + 1) % 4) for k in range(4)), *((k, 4) for k in range(4))],
    )
    assert dict(decompose(vertex).true) == {1: 2}


def test_a_straight_crease_across_a_hole_folds():
    [star] = conditions(ACROSS).values()
    assert (star.hole.rank, star.conditions, star.has_form) == (1, 1, False)
    result = decompose(ACROSS)
    assert (dict(result.true), result.free) == ({1: 1}, ())


def test_a_flap_at_a_hole_is_free_and_in_no_loop():
    """A fold from one corner of the hole to the next, with a triangle in the hole."""
    assert free_folds(FLAP) == ((4, 5),)
    [rim] = rims(FLAP)
    assert (rim.number, sorted(rim.vertices)) == (0, [4, 5, 6, 7])
    assert sorted(rim.crossed) == [(4, 0), (5, 1), (6, 2), (7, 3)]
    assert dict(decompose(FLAP).true) == {2: 2}


def test_restricted_stars_have_the_rank_of_their_folds():
    found = conditions(RING)
    assert [star.hole.rank for star in found.values()] == [3, 3, 3]
    some = restricted(found, {(0, 5), (0, 6)})
    assert [(v, star.hole.rank, star.folds) for v, star in some.items()] == [
        (7, 2, ((0, 5), (0, 6)))
    ]
    assert restricted(found, set()) == {}


def test_lines_that_nearly_pass_through_one_point_are_named():
    near = spokes([(2, 2), (4, 2), (4, 4), (2, Fraction("4.00003"))])
    assert [star.hole.rank for star in conditions(near).values()] == [3, 3, 3]
    said = nearly_dependent(near, 1e-4, 0.0)
    assert said.startswith("the lines of the folds round the hole at vertex 4 nearly pass through")
    assert nearly_dependent(near, 1e-7, 0.0) == ""
    assert nearly_dependent(near, 1e-7, 1e-4) == said
    assert nearly_dependent(RING, 1e-4, 1e-6) == ""


def test_rounded_lines_round_a_hole_prove_nothing():
    """Coordinates with five decimals, of which one is off by three units of the last."""
    near = spokes(
        [
            ("2.12345", "2.12345"),
            ("3.87655", "2.12345"),
            ("3.87655", "3.87655"),
            ("2.12345", "3.87658"),
        ]
    )
    result = count(near)
    assert result.status is UNDECIDED
    assert "nearly pass through one point" in result.reason
    assert dict(result.as_written.true) == {1: 1}  # with the digit that was meant, {1: 2}


@pytest.mark.parametrize(("below", "said"), [("0.0001", True), ("0.5", False)])
def test_folds_that_nearly_span_half_a_plane_nearly_move(below, said):
    """A vertex whose folds all point downwards is rigid; on a line with it, two of them fold."""
    low = -Fraction(below)
    points = [(0, 0), (4, low), (-4, low), (-1, -4), (2, -4), (0, 4)]
    edges = [*pairwise([1, 5, 2, 3, 4, 1]), (0, 1), (0, 2), (0, 3), (0, 4)]
    sheet = PanelPattern(points, edges)
    assert decompose(sheet).rigid is PROVED
    assert ("nearly start to fold" in nearly_moves(sheet, 1e-3, rigid=True)) is said
    assert nearly_moves(sheet, 1e-3, rigid=False) == ""


# --- refusals ------------------------------------------------------------------------------------


def test_holes_that_are_none_are_refused():
    points, edges = RING.vertices, RING.edges
    with pytest.raises(MalformedPatternError, match="the hole 3-4-5 is no face of the drawing"):
        PanelPattern(points, edges, holes=[(3, 4, 5)])
    with pytest.raises(MalformedPatternError, match="edge 3-6 is the side of no panel"):
        PanelPattern(points, edges, holes=[(3, 4, 5, 6), (1, 3, 6)])
    with pytest.raises(MalformedPatternError, match="all faces are holes"):
        PanelPattern(SQUARE, [(0, 1), (1, 2), (2, 3), (0, 3)], holes=[(0, 1, 2, 3)])
    assert PanelPattern(points, edges, holes=[(6, 5, 4, 3)]) == RING


SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]


def test_a_hole_that_touches_the_edge_of_the_paper_is_refused():
    edges = [*pairwise([0, 1, 2, 3, 0]), (0, 4), (4, 5), (0, 5), (1, 4), (3, 5), (2, 4), (2, 5)]
    with pytest.raises(NotADiskError, match=r"touches the edge of the paper .* in vertex 0"):
        PanelPattern([*SQUARE, (2, 1), (1, 2)], edges, holes=[(0, 4, 5)])


def test_holes_at_the_edge_of_the_paper_are_refused():
    edges = [*pairwise([0, 1, 2, 3, 0]), *pairwise([4, 5, 6, 7, 4]), (0, 4), (1, 5), (2, 6), (3, 7)]
    inner = [(1, 1), (3, 1), (3, 3), (1, 3)]
    with pytest.raises(MalformedPatternError, match="edge 0-1 is the side of no panel"):
        PanelPattern([*SQUARE, *inner], edges, holes=[(0, 1, 5, 4), (0, 3, 7, 4)])


def test_other_work_is_refused_by_name():
    with pytest.raises(NotCountedError, match="the sheet has 1 hole, and this is not done yet for"):
        stars(RING)
    assert free_folds(RING) == ()
