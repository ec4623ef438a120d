import random
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pattern_strategies import patterns, quick
from sampling import slow_after

from exactfold.errors import (
    DisconnectedError,
    FoldError,
    MalformedPatternError,
)
from exactfold.exact.surds import RATIONALS
from exactfold.pattern.planar import check_no_crossing, trace_faces
from exactfold.pattern.validate import segments_meet

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0)]


def test_one_face():
    assert trace_faces(SQUARE, SIDES) == [(0, 1, 2, 3)]


def test_faces_are_counter_clockwise_whatever_the_order_of_the_edges():
    edges = [(3, 0), (2, 0), (2, 1), (2, 3), (1, 0)]
    assert trace_faces(SQUARE, edges) == [(0, 1, 2), (0, 2, 3)]


def test_duplicate_edges_count_once():
    assert trace_faces(SQUARE, [*SIDES, (1, 0), (0, 1)]) == [(0, 1, 2, 3)]


def test_directions_of_every_kind_are_sorted():
    ring = [(2, 0), (2, 1), (1, 2), (0, 2), (-1, 2), (-2, 0), (-2, -1), (0, -2), (1, -2)]
    count = len(ring)
    rim = [(k, (k + 1) % count) for k in range(count)]
    faces = trace_faces([*ring, (0, 0)], [*rim, *((k, count) for k in range(count))])
    assert faces == sorted([(k, k + 1, count) for k in range(count - 1)] + [(0, count, count - 1)])


def test_face_with_a_notch_is_one_cycle():
    points = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)]
    assert trace_faces(points, [(k, (k + 1) % 5) for k in range(5)]) == [(0, 1, 2, 3, 4)]


def test_crossing_edges_error():
    with pytest.raises(FoldError, match="edges 0-2 and 1-3 cross"):
        trace_faces(SQUARE, [*SIDES, (1, 3), (0, 2)])


def test_vertex_inside_an_edge_error():
    points = [*SQUARE, (2, 0), (2, 2)]
    with pytest.raises(FoldError, match=r"vertex 4, .* 4-5, lies inside edge 0-1"):
        trace_faces(points, [*SIDES, (4, 5), (5, 2), (5, 3)])


def test_overlapping_collinear_edges_error():
    points = [(0, 0), (1, 0), (3, 0), (0, 3)]
    with pytest.raises(FoldError, match=r"vertex 1, .* 0-1, lies inside edge 0-2"):
        trace_faces(points, [(0, 1), (0, 2), (2, 3), (3, 0), (1, 3)])
    with pytest.raises(FoldError, match="lies inside"):
        trace_faces([(0, 0), (2, 0), (1, 0), (3, 0)], [(0, 1), (2, 3)])


def test_near_crossings_are_decided_exactly():
    far = 10**30
    points = [(0, 0), (far, far), (far, far + 1), (0, 1), (-far, far), (far // 2, far // 2 + 1)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (3, 4), (4, 0)]
    assert trace_faces(points[:5], edges) == [(0, 1, 2, 3), (0, 3, 4)]
    with pytest.raises(FoldError, match="vertex 5"):
        trace_faces(points, [*edges, (5, 0), (5, 1)])


def test_duplicate_vertex_error():
    with pytest.raises(MalformedPatternError, match="vertices 1 and 4"):
        trace_faces([*SQUARE, (4, 0)], [*SIDES, (4, 2), (4, 0)])


def test_isolated_vertex_error():
    with pytest.raises(MalformedPatternError, match=r"vertex 4 is on no edge .and 1 more"):
        trace_faces([*SQUARE, (2, 2), (3, 2)], SIDES)


def test_dangling_edge_error():
    with pytest.raises(FoldError, match="edge 0-4 ends at vertex 4"):
        trace_faces([*SQUARE, (2, 2)], [*SIDES, (0, 4)])


def test_loop_error():
    with pytest.raises(FoldError, match="edge 2-2 joins a vertex to itself"):
        trace_faces(SQUARE, [*SIDES, (2, 2)])


def test_bridge_error():
    points = [(0, 0), (1, 0), (0, 1), (5, 5), (6, 5), (5, 6)]
    edges = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (1, 3)]
    with pytest.raises(FoldError, match="edge 1-3 has the same face on both sides"):
        trace_faces(points, edges)


def test_disconnected_error():
    points = [*SQUARE, (1, 1), (2, 1), (1, 2)]
    with pytest.raises(DisconnectedError, match="vertex 0 to vertex 4"):
        trace_faces(points, [*SIDES, (4, 5), (5, 6), (6, 4)])


@quick
@given(patterns(), st.randoms(use_true_random=False))
def test_faces_of_a_triangulation_are_its_triangles(pattern, random):
    edges = [random.choice([(i, j), (j, i)]) for i, j in pattern.edges]
    random.shuffle(edges)
    assert trace_faces(pattern.integer_vertices[0], edges) == sorted(pattern.triangles)


@quick
@given(patterns(), st.data())
def test_removing_a_fold_merges_its_two_triangles(pattern, data):
    if not pattern.folds:
        return
    fold = data.draw(st.sampled_from(pattern.folds))
    edges = [e for e in pattern.edges if e != fold]
    faces = trace_faces(pattern.integer_vertices[0], edges)
    assert len(faces) == len(pattern.triangles) - 1
    (merged,) = (face for face in faces if len(face) == 4)
    assert set(merged) == {*fold, *pattern.opposite(fold)}


@pytest.mark.parametrize("seed", slow_after(2, range(6)))
def test_floats_sort_out_no_pair_that_meets(seed):
    """Points within a few units of a long line, in whole numbers and in Q(sqrt 2)."""
    random_ = random.Random(seed)
    root = RATIONALS.adjoined(2).root
    for _ in range(300):
        scale = 10 ** random_.choice([1, 8, 17, 160])
        unit = random_.choice([scale, scale * (root - 1)])
        points = [(0, 0), (unit * 3, unit * 2)]
        for _ in range(2):
            t = random_.choice([-1, 0, 1, 2, 3])
            points.append(
                (unit * 3 * t / Fraction(2), unit * t + Fraction(random_.randint(-1, 1), 2))
            )
        if len(set(points)) < 4:
            continue
        meets = segments_meet(*points)
        if meets:
            with pytest.raises(FoldError, match=r"cross$|lies inside edge"):
                check_no_crossing(points, [(0, 1), (2, 3)])
        else:
            check_no_crossing(points, [(0, 1), (2, 3)])
