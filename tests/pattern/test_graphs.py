"""Graphs of patterns against what the package finds with code of its own."""

from collections import Counter
from itertools import combinations

import networkx as nx
import pytest
from hypothesis import given
from pattern_strategies import patterns, quick

from exactfold.interop.graphs import to_networkx
from exactfold.pattern.data import SHEETS
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.loading import load

PATTERNS = {name: load(name) for name in SHEETS} | {n: make() for n, make in DEGENERATE.items()}
shipped = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


def face_graph(pattern):
    """Faces, one edge for each fold between two.

    Nodes are positions in `triangles`, with `triangle`; edges have `fold`, (i, j) with i < j. A
    spanning tree lays the faces out one after the other, the cycles close around interior
    vertices, and the bridges are the chords.

    """
    beside = {
        side: face
        for face, (a, b, c) in enumerate(pattern.triangles)
        for side in ((a, b), (b, c), (c, a))
    }
    graph = nx.Graph()
    graph.add_nodes_from((face, {"triangle": t}) for face, t in enumerate(pattern.triangles))
    graph.add_edges_from((beside[i, j], beside[j, i], {"fold": (i, j)}) for i, j in pattern.folds)
    return graph


def embedding(pattern):
    """The rotation around every vertex, clockwise as NetworkX has it.

    `traverse_face(i, j)` goes around the face to the right of the edge from i to j.

    """
    result = nx.PlanarEmbedding()
    result.set_data({v: pattern.star(v)[::-1] for v in range(len(pattern.vertices))})
    return result


@shipped
def test_nodes_and_edges_know_what_they_are(pattern):
    graph = to_networkx(pattern)
    assert {v for v, inside in graph.nodes(data="interior") if inside} == pattern.interior_set
    assert [point for _, point in sorted(graph.nodes(data="pos"))] == list(pattern.vertices)
    kinds = {(min(i, j), max(i, j)): fold for i, j, fold in graph.edges(data="fold")}
    assert tuple(sorted(kinds)) == pattern.edges
    assert tuple(sorted(e for e, fold in kinds.items() if fold)) == pattern.folds


@shipped
def test_separating_triangles_are_the_triangulated_ones(pattern):
    """A second way: what the removal of a 3-cycle of edges cuts off from the boundary."""
    graph = to_networkx(pattern)
    boundary = set(pattern.boundary)
    rigid = set()
    for cycle in combinations(graph, 3):
        if all(graph.has_edge(*side) for side in combinations(cycle, 2)):
            rest = graph.subgraph(set(graph) - set(cycle))
            for part in nx.connected_components(rest):
                if part.isdisjoint(boundary):
                    rigid |= part
    assert rigid == pattern.rigid_vertices


@shipped
def test_faces_close_around_interior_vertices_and_part_at_chords(pattern):
    graph = face_graph(pattern)
    assert nx.is_connected(graph)
    assert sorted(fold for *_, fold in graph.edges(data="fold")) == list(pattern.folds)
    assert graph.size() - graph.order() + 1 == pattern.Vi  # independent cycles
    bridges = {graph.edges[edge]["fold"] for edge in nx.bridges(graph)}
    assert bridges == set(pattern.chords)
    for f, g, fold in graph.edges(data="fold"):
        assert set(graph.nodes[f]["triangle"]) & set(graph.nodes[g]["triangle"]) == set(fold)


@quick
@given(patterns())
def test_the_rotation_embeds_the_graph_with_the_triangles_as_faces(pattern):
    plane = embedding(pattern)
    plane.check_structure()  # Euler's formula
    assert nx.check_planarity(to_networkx(pattern))[0]
    assert nx.utils.graphs_equal(nx.Graph(list(plane.edges)), nx.Graph(list(pattern.edges)))
    faces, seen = [], set()
    for i, j in plane.edges:
        if (i, j) not in seen:
            faces.append(tuple(plane.traverse_face(i, j, mark_half_edges=seen)[::-1]))
    expected = [*pattern.triangles, pattern.boundary]
    assert Counter(map(frozenset, faces)) == Counter(map(frozenset, expected))
