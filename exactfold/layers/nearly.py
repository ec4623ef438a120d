"""The folded image with corners and lines that nearly meet taken to meet; it proves nothing."""

from __future__ import annotations

from copy import copy

import networkx as nx
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import Pieces
from exactfold.layers.sides import Indices


def reflections(pieces: Pieces) -> int:
    """The largest number of reflections from piece 0 to another one, on a shortest way."""
    graph = nx.Graph()
    graph.add_node(0)
    graph.add_edges_from(pieces.creases.values(), weight=1)
    graph.add_edges_from(pieces.joints.values(), weight=0)
    return int(max(nx.single_source_dijkstra_path_length(graph, 0).values()))


class Blurred(Overlaps):
    """Overlaps where points and lines closer than `blur` are taken to be one, in floats.

    The orders of layers of such an image say whether an answer depends on what nearly meets, and
    nothing else. Raises `ValueError` if a piece has no area any more.
    """

    def __init__(self, exact: Overlaps, blur: float) -> None:
        self.images, self.points, self.blur = exact.images, exact.points, blur
        self.sides = copy(exact.sides)
        s = exact.sides
        spots = np.stack([s.x, s.y], axis=1)
        close = cKDTree(spots).query_pairs(blur, output_type="ndarray").reshape(-1, 2)
        point = _joined(len(spots), close)
        length = np.hypot(s.a, s.b)[:, None]
        distance = abs(np.outer(s.a, s.x) + np.outer(s.b, s.y) - s.c[:, None]) / length
        self.sides.signs = np.where(distance < blur, 0, s.signs).astype(np.int8)
        ends = {line: pair for pair, (line, _) in exact.drawn.items()}
        pairs = np.array([ends[line] for line in range(len(s.lines))])
        on = (distance[:, pairs[:, 0]] < blur) & (distance[:, pairs[:, 1]] < blur)
        line = _joined(len(s.lines), np.argwhere(on))
        self.number = {v: int(point[p]) for v, p in exact.number.items()}
        self.drawn = {}
        for (p, q), (old, along) in exact.drawn.items():
            new = int(line[old])
            same = s.a[old] * s.a[new] + s.b[old] * s.b[new] > 0
            self.drawn[int(point[p]), int(point[q])] = (new, along if same else -along)
        self.corners = []
        for corners in exact.corners:
            some = list(dict.fromkeys(int(point[p]) for p in corners))
            if len(some) < 3:
                raise ValueError("a piece has no area")
            self.corners.append(some)
        self._find()


def _joined(count: int, pairs: Indices) -> Indices:
    """The first of all things that pairs join to each thing."""
    ones = np.ones(len(pairs), dtype=np.int8)
    graph = coo_matrix((ones, (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    _, labels = connected_components(graph, directed=False)
    _, first = np.unique(labels, return_index=True)
    found: Indices = first[labels]
    return found
