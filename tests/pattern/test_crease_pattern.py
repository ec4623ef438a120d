import hashlib
import random
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pattern_strategies import patterns, quick, relabelled, similarities, transformed

from exactfold.errors import (
    DegenerateFaceError,
    DisconnectedError,
    FloatRefusedError,
    InputError,
    MalformedPatternError,
    NotADiskError,
    NumberError,
    OverlapError,
    UsageError,
)
from exactfold.pattern import triangulated_triangles
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_octahedron_in_square, single_vertex
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.pattern.validate import segments_meet

CORNERS = [(0, 0), (1, 0), (1, 1), (0, 1)]
HALVES = [(0, 1, 2), (0, 2, 3)]


def fan(count, hub):
    return [(k, (k + 1) % count, hub) for k in range(count)]


# --- what is refused -----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("vertices", "triangles", "culprit"),
    [
        ([(0, 0), (1, 0, 5), (0, 1)], [(0, 1, 2)], "vertex 1"),
        ([(0, 0), 7, (0, 1)], [(0, 1, 2)], "vertex 1"),
        ([(0, 0), (1, 0), "01"], [(0, 1, 2)], "vertex 2"),
        (CORNERS, [(0, 1, 2, 3)], "face 0"),
        (CORNERS, [(0, 1, 2), "023"], "face 1"),
        (CORNERS, [(0, 1, 2), (0, 2, 4)], "face 1 uses vertex 4"),
        (CORNERS, [(0, 1, 2), (0, 2, -1)], "face 1 uses vertex -1"),
        (CORNERS, [(0, True, 2), (0, 2, 3)], "face 0: True"),
        (CORNERS, [(0, 1, 2), (0, 2, "3")], "face 1: '3'"),
        (CORNERS, [(0, 1, 2), (0, 2, 10**5000)], "face 1 uses vertex an integer of"),
        (CORNERS[:2], [(0, 1, 0)], "at least three vertices, not 2"),
        (CORNERS, [], "at least one triangle"),
    ],
)
def test_malformed_error(vertices, triangles, culprit):
    with pytest.raises(MalformedPatternError, match=culprit):
        CreasePattern(vertices, triangles)


def test_number_errors_name_the_vertex():
    with pytest.raises(FloatRefusedError, match=r'vertex 2: the float 0\.5 .* write "0\.5"'):
        CreasePattern([(0, 0), (1, 0), (0, 0.5)], [(0, 1, 2)])
    with pytest.raises(NumberError, match="vertex 1: 'one'"):
        CreasePattern([(0, 0), ("one", 0), (0, 1)], [(0, 1, 2)])


def test_duplicate_vertex_error():
    with pytest.raises(MalformedPatternError, match=r"vertices 1 and 4 .* \(1, 0\)") as caught:
        CreasePattern([*CORNERS, ("2/2", "0.0")], HALVES)
    assert caught.value.vertices == (1, 4)


def test_duplicate_vertex_error_at_a_huge_point():
    with pytest.raises(MalformedPatternError, match="vertices 1 and 2"):
        CreasePattern([(0, 0), (10**6000, 1), (10**6000, 1)], [(0, 1, 2)])


def test_isolated_vertex_error():
    with pytest.raises(MalformedPatternError, match=r"vertex 4 .*and 1 more") as caught:
        CreasePattern([*CORNERS, (7, 7), (8, 8)], HALVES)
    assert caught.value.vertices == (4, 5)


def test_degenerate_face_error():
    with pytest.raises(DegenerateFaceError, match=r"face 1 .* zero area") as caught:
        CreasePattern([(0, 0), (2, 0), (0, 2), (1, 1)], [(0, 1, 2), (1, 3, 2)])
    assert caught.value.faces == (1,)
    with pytest.raises(DegenerateFaceError, match="face 0 repeats a vertex"):
        CreasePattern(CORNERS, [(0, 1, 1), (0, 2, 3)])


def test_mixed_orientation_error():
    with pytest.raises(OverlapError, match=r"face 1 \(0, 3, 2\) is clockwise") as caught:
        CreasePattern(CORNERS, [(0, 1, 2), (0, 3, 2)])
    assert caught.value.faces == (1, 0)


def test_all_clockwise_is_reversed():
    clockwise = CreasePattern(CORNERS, [(2, 1, 0), (3, 2, 0)])
    assert clockwise == CreasePattern(CORNERS, HALVES)


def test_overlap_error_on_one_side_of_an_edge():
    with pytest.raises(OverlapError, match=r"faces 0 and 1 .* edge 0-1") as caught:
        CreasePattern([(0, 0), (1, 0), (0, 1), (1, 1)], [(0, 1, 2), (0, 1, 3)])
    assert caught.value.edges == ((0, 1),)
    assert caught.value.faces == (0, 1)


def test_overlap_error_for_a_boundary_fan_beyond_a_full_turn():
    ring = [(4, 0), (0, 4), (-4, 0), (0, -4), (6, 1)]
    with pytest.raises(OverlapError, match="meet") as caught:
        CreasePattern([(0, 0), *ring], [(0, k, k + 1) for k in range(1, 5)])
    assert len(caught.value.edges) == 2


def test_overlap_error_for_an_interior_vertex_that_winds_twice():
    around = [(1, 0), (1, 1), (-1, 1), (-1, -1), (1, -1)]
    ring = [(x * r, y * r) for r in (2, 3) for x, y in around]
    with pytest.raises(OverlapError):
        CreasePattern([*ring, (0, 0)], fan(10, 10))


def test_overlap_error_where_the_boundary_touches_itself():
    a, b, c, d, e, f, h = (0, 0), (6, 0), (6, 3), (5, 3), (5, 1), (1, 1), (0, 3)
    faces = [(0, 1, 4), (0, 4, 5), (1, 2, 4), (2, 3, 4), (0, 5, 7), (5, 6, 7)]
    assert CreasePattern([a, b, c, d, e, f, (4, 2), h], faces).Ve == 8
    with pytest.raises(OverlapError, match="touch") as caught:
        CreasePattern([a, b, c, d, e, f, (5, 2), h], faces)
    assert (3, 4) in caught.value.edges


@pytest.mark.parametrize(
    ("c", "d", "meet"),
    [
        ((1, -1), (1, 1), True),  # a crossing
        ((1, 0), (1, 5), True),  # an end inside
        ((1, 5), (1, 0), True),
        ((4, 0), (4, 3), True),  # a common end
        ((2, 0), (9, 0), True),  # an overlap
        ((5, 0), (9, 0), False),  # on one line, apart
        ((5, -1), (5, 1), False),
        ((1, 1), (3, 1), False),
        ((3, 1), (9, -4), False),
    ],
)
def test_segments_meet(c, d, meet):
    a, b = (0, 0), (4, 0)
    for p, q in ((a, b), (b, a)):
        assert segments_meet(p, q, c, d) is meet
        assert segments_meet(c, d, p, q) is meet


def test_non_manifold_edge_error():
    vertices = [(0, 0), (4, 0), (1, 3), (2, -3), (3, 4)]
    with pytest.raises(NotADiskError, match=r"edge 0-1 .* \[0, 1, 2\]") as caught:
        CreasePattern(vertices, [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    assert caught.value.edges == ((0, 1),)
    assert caught.value.faces == (0, 1, 2)


def test_disconnected_error():
    vertices = [(0, 0), (1, 0), (0, 1), (5, 0), (6, 0), (5, 1)]
    with pytest.raises(DisconnectedError, match="vertex 0 to 3") as caught:
        CreasePattern(vertices, [(0, 1, 2), (3, 4, 5)])
    assert caught.value.vertices == (0, 3)


def test_hole_error():
    outer = [(0, 0), (4, 0), (4, 4), (0, 4)]
    inner = [(1, 1), (3, 1), (3, 3), (1, 3)]
    ring = [
        t
        for j in range(4)
        for t in ((j, (j + 1) % 4, 4 + j), ((j + 1) % 4, 4 + (j + 1) % 4, 4 + j))
    ]
    with pytest.raises(NotADiskError, match="vertices 0 and 4"):
        CreasePattern(outer + inner, ring)
    assert CreasePattern(outer + inner, [*ring, (4, 5, 6), (4, 6, 7)]).Vi == 4


def test_pinch_error():
    vertices = [(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)]
    with pytest.raises(NotADiskError, match="vertex 0") as caught:
        CreasePattern(vertices, [(0, 1, 2), (0, 3, 4)])
    assert caught.value.vertices == (0,)


def test_pinch_error_between_two_boundaries():
    outer = [(0, 0), (6, 0), (0, 6)]  # a ring whose hole touches the outer boundary in vertex 0
    inner = [(3, 1), (1, 3)]
    faces = [(0, 1, 3), (1, 2, 3), (2, 4, 3), (2, 0, 4)]
    with pytest.raises(NotADiskError, match="vertex 0"):
        CreasePattern(outer + inner, faces)
    assert CreasePattern(outer + inner, [*faces, (0, 3, 4)]).Vi == 2


def test_every_pattern_error_is_bad_input():
    with pytest.raises(InputError):
        CreasePattern(CORNERS, [])


# --- what is accepted ----------------------------------------------------------------------------


def test_arrays_of_indices_are_accepted():
    pattern = CreasePattern(np.array(CORNERS), np.array(HALVES))
    assert pattern == CreasePattern(CORNERS, HALVES)
    assert all(type(v) is int for t in pattern.triangles for v in t)


def test_iterators_are_accepted():
    assert CreasePattern(map(iter, CORNERS), map(iter, HALVES)).Ve == 4


def test_boundary_angle_of_pi_and_reflex_boundary():
    pattern = CreasePattern([(0, 0), (1, 0), (2, 0), (1, 2)], [(0, 1, 3), (1, 2, 3)])
    assert pattern.boundary_turns == (1, 0, 1, 1)
    assert pattern.is_convex
    dart = CreasePattern([(0, 0), (4, 0), (1, 1), (0, 4)], [(0, 1, 2), (0, 2, 3)])
    assert dart.boundary_turns == (1, 1, -1, 1)
    assert not dart.is_convex


def test_chords():
    assert CreasePattern(CORNERS, HALVES).chords == ((0, 2),)
    assert single_vertex(5).chords == ()


def test_triangles_start_at_their_smallest_index():
    assert CreasePattern(CORNERS, [(2, 0, 1), (3, 0, 2)]).triangles == ((0, 1, 2), (0, 2, 3))


def test_star_order():
    pattern = single_vertex(5)
    assert pattern.star(5) == (0, 1, 2, 3, 4)
    assert pattern.star(0) == (1, 5, 4)
    assert pattern.opposite((2, 5)) == (1, 3)
    assert [pattern.degree(v) for v in range(6)] == [3, 3, 3, 3, 3, 5]


def test_frozen():
    with pytest.raises(AttributeError):
        single_vertex(4).vertices = ()


def test_sha256_of_a_known_pattern():
    text = "exactfold pattern 1\nv 0 0\nv 1 0\nv 1/2 3\nt 0 1 2\n"
    pattern = CreasePattern([(0, 0), (1, 0), ("2/4", 3)], [(1, 2, 0)])
    assert pattern.sha256 == hashlib.sha256(text.encode()).hexdigest()


@quick
@given(patterns(), st.randoms(use_true_random=False))
def test_sha256_ignores_the_order_of_triangles(pattern, random):
    shuffled = [random.choice([(a, b, c), (b, c, a)]) for a, b, c in pattern.triangles]
    random.shuffle(shuffled)
    same = CreasePattern(pattern.vertices, shuffled)
    assert same.sha256 == pattern.sha256
    assert hash(same) == hash(pattern)
    larger = CreasePattern([(2 * a, 2 * b) for a, b in pattern.vertices], pattern.triangles)
    assert larger.sha256 != pattern.sha256


# --- triangulated triangles ----------------------------------------------------------------------


def test_nested_triangulated_triangles():
    vertices = [(0, 0), (12, 0), (0, 12), (3, 3), (4, 2), (20, 20), (13, 12)]
    faces = [(0, 1, 4), (1, 3, 4), (3, 0, 4), (1, 2, 3), (2, 0, 3), (1, 5, 6), (5, 2, 6), (2, 1, 6)]
    pattern = CreasePattern(vertices, faces)
    assert pattern.triangulated_triangles == (((0, 1, 2), (3, 4)), ((1, 5, 2), (6,)))
    assert pattern.Vt == 3
    assert pattern.foldable_vertices == ()
    reduced, labels = pattern.without_rigid_parts()
    assert labels == (0, 1, 2, 5)
    assert reduced.triangles == ((0, 1, 2), (1, 3, 2))
    assert reduced.Vt == 0


def test_octahedron_without_its_inside():
    pattern = flat_octahedron_in_square()
    reduced, labels = pattern.without_rigid_parts()
    assert (pattern.Vi, pattern.Vt, reduced.Vi, reduced.Vt) == (6, 3, 3, 0)
    assert labels == tuple(range(7))
    assert reduced.area == pattern.area
    assert reduced.without_rigid_parts()[0] is reduced


def test_a_pattern_with_three_boundary_vertices_is_one_triangulated_triangle():
    pattern = single_vertex(3)
    assert pattern.triangulated_triangles == (((0, 1, 2), (3,)),)
    assert pattern.degrees_of_freedom == 0


# --- properties ----------------------------------------------------------------------------------


@quick
@given(patterns())
def test_counts_satisfy_euler(pattern):
    vertices = len(pattern.vertices)
    assert pattern.Vi + pattern.Ve == vertices
    assert len(pattern.edges) == 3 * vertices - 3 - pattern.Ve
    assert len(pattern.triangles) == 2 * vertices - 2 - pattern.Ve
    assert len(pattern.folds) + len(pattern.boundary_edges) == len(pattern.edges)
    assert sum(pattern.degree(v) for v in range(vertices)) == 2 * len(pattern.edges)


@quick
@given(patterns())
def test_stars_are_counter_clockwise(pattern):
    faces = {frozenset(t) for t in pattern.triangles}
    for v in range(len(pattern.vertices)):
        star = pattern.star(v)
        closed = v in pattern.interior
        assert set(star) == {i for edge in pattern.edges if v in edge for i in edge} - {v}
        pairs = list(zip(star, star[1:] + star[:1], strict=True))[: None if closed else -1]
        for a, b in pairs:
            assert {a, b, v} in faces
            (x, y), (ax, ay), (bx, by) = (pattern.vertices[w] for w in (v, a, b))
            assert (ax - x) * (by - y) > (ay - y) * (bx - x)
        if closed:
            assert star[0] == min(star)
        else:
            cycle = pattern.boundary
            k = cycle.index(v)
            assert (star[0], star[-1]) == (cycle[(k + 1) % len(cycle)], cycle[k - 1])


@quick
@given(patterns(), similarities)
def test_similarities_change_nothing_but_the_size(pattern, similarity):
    moved = transformed(pattern, similarity)
    assert moved.area == pattern.area * similarity.scale**2
    assert moved.interior == pattern.interior
    assert moved.edges == pattern.edges
    inside = {frozenset(corners): set(v) for corners, v in pattern.triangulated_triangles}
    assert {frozenset(corners): set(v) for corners, v in moved.triangulated_triangles} == inside
    if not similarity.mirror:  # which turns the order of the corners round
        assert moved.triangulated_triangles == pattern.triangulated_triangles
    assert moved.rigid_vertices == pattern.rigid_vertices
    assert sorted(moved.boundary_turns) == sorted(pattern.boundary_turns)


@quick
@given(patterns(), st.data())
def test_relabelling_permutes_everything(pattern, data):
    order = data.draw(st.permutations(range(len(pattern.vertices))))
    other = relabelled(pattern, order)
    assert {order[v] for v in other.interior} == set(pattern.interior)
    assert {order[v] for v in other.rigid_vertices} == set(pattern.rigid_vertices)
    assert {frozenset((order[i], order[j])) for i, j in other.folds} == set(
        map(frozenset, pattern.folds)
    )
    assert other.area == pattern.area


@quick
@given(patterns(), st.data())
def test_moving_a_vertex_out_of_its_star_is_refused(pattern, data):
    if not pattern.interior:
        return
    v = data.draw(st.sampled_from(pattern.interior))
    vertices = list(pattern.vertices)
    vertices[v] = (Fraction(100), Fraction(101, 7))
    with pytest.raises((OverlapError, DegenerateFaceError)):
        CreasePattern(vertices, pattern.triangles)


# --- snapping ------------------------------------------------------------------------------------


def test_snapped_reports_the_largest_move():
    noisy = CreasePattern([(0, 0), ("0.9999", "0.0003"), (0, "1.0002")], [(0, 1, 2)])
    snapped, largest = noisy.snapped(1000)
    assert snapped.vertices == ((0, 0), (1, 0), (0, 1))
    assert largest == Fraction(3, 10000)
    assert snapped.snapped(1000) == (snapped, 0)


@pytest.mark.parametrize("denominator", [0, -4, True, 2.0])
def test_snap_denominator_error(denominator):
    with pytest.raises(UsageError, match="multiples of 1/n"):
        single_vertex(4).snapped(denominator)


def test_snapping_onto_another_vertex_is_refused():
    close = CreasePattern([(0, 0), (1, 0), ("1.1", "0.1"), (0, 1)], [(0, 1, 3), (1, 2, 3)])
    with pytest.raises(MalformedPatternError, match="vertices 1 and 2"):
        close.snapped(1)


def test_arrays_find_the_same_triangulated_triangles(monkeypatch):
    source = random.Random(5)
    corners = [(0, 0), (50, 0), (50, 50), (0, 50)]
    for number in (0, 10, 60):
        inside = {(source.randrange(1, 50), source.randrange(1, 50)) for _ in range(number)}
        pattern = delaunay([*corners, *sorted(inside)])
        points, triangles = list(pattern.vertices), list(pattern.triangles)
        for _ in range(number // 2):  # a vertex in the middle of a face
            a, b, c = triangles.pop(source.randrange(len(triangles)))
            triangles += [(a, b, len(points)), (b, c, len(points)), (c, a, len(points))]
            points.append(tuple(sum(points[v][k] for v in (a, b, c)) / 3 for k in (0, 1)))
        monkeypatch.setattr(triangulated_triangles, "_MANY", 10**9)
        expected = CreasePattern(points, triangles).triangulated_triangles
        monkeypatch.setattr(triangulated_triangles, "_MANY", 0)
        assert CreasePattern(points, triangles).triangulated_triangles == expected
        assert bool(expected) == bool(number)
