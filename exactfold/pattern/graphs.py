"""Patterns as NetworkX graphs, to use that library's cycles, components, planarity tests and more.

Validation does not use it: it has short code of its own, which is faster and names the vertex or
edge to blame.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import networkx as nx

    from exactfold.pattern.crease_pattern import CreasePattern

# Each function imports NetworkX itself, as loading it takes longer than reading a pattern.


def vertex_graph(pattern: CreasePattern) -> nx.Graph:
    """The frozen graph of the vertices and edges of a pattern.

    Its nodes have the attributes `pos` (the exact point), `interior` and `rigid` (inside a
    triangulated triangle). Its edges have `fold` (not on the boundary) and `chord`.

    >>> from exactfold.pattern.families import single_vertex
    >>> graph = vertex_graph(single_vertex(3))
    >>> graph.nodes[3], graph.edges[0, 3]["fold"], graph.edges[0, 1]["fold"]
    ({'pos': (Fraction(0, 1), Fraction(0, 1)), 'interior': True, 'rigid': True}, True, False)
    """
    import networkx as nx

    graph = nx.Graph()
    for v, point in enumerate(pattern.vertices):
        inside, rigid = v in pattern.interior_set, v in pattern.rigid_vertices
        graph.add_node(v, pos=point, interior=inside, rigid=rigid)
    graph.add_edges_from(pattern.folds, fold=True, chord=False)
    graph.add_edges_from(pattern.chords, fold=True, chord=True)
    graph.add_edges_from(pattern.boundary_edges, fold=False, chord=False)
    return nx.freeze(graph)


def face_graph(pattern: CreasePattern) -> nx.Graph:
    """The frozen graph of the faces, with one edge for each fold between two faces.

    Nodes are positions in `triangles` and have the attribute `triangle`; edges have `fold`, (i, j)
    with i < j. Along a spanning tree the faces can be laid out one after the other. Cycles close
    around interior vertices, and the bridges are the chords.

    >>> from exactfold.pattern.families import single_vertex
    >>> sorted(face_graph(single_vertex(3)).edges(data="fold"))
    [(0, 1, (1, 3)), (0, 2, (0, 3)), (1, 2, (2, 3))]
    """
    import networkx as nx

    beside = {
        side: face
        for face, (a, b, c) in enumerate(pattern.triangles)
        for side in ((a, b), (b, c), (c, a))
    }
    graph = nx.Graph()
    graph.add_nodes_from((face, {"triangle": t}) for face, t in enumerate(pattern.triangles))
    graph.add_edges_from((beside[i, j], beside[j, i], {"fold": (i, j)}) for i, j in pattern.folds)
    return nx.freeze(graph)


def embedding(pattern: CreasePattern) -> nx.PlanarEmbedding:
    """The frozen planar embedding: the rotation around every vertex, clockwise as in NetworkX.

    `traverse_face(i, j)` goes around the face on the right of the edge from i to j.

    >>> from exactfold.pattern.families import single_vertex
    >>> embedding(single_vertex(3)).traverse_face(1, 0)
    [1, 0, 3]
    """
    import networkx as nx

    result = nx.PlanarEmbedding()
    result.set_data({v: pattern.star(v)[::-1] for v in range(len(pattern.vertices))})
    return nx.freeze(result)
