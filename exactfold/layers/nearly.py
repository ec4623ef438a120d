"""The folded image with corners and lines that nearly meet taken to meet; it proves nothing."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from fractions import Fraction
from math import gcd, lcm
from typing import Final

import networkx as nx
import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from exactfold.exact.surds import Number, Surd, simple
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import Pieces
from exactfold.layers.sides import Indices

_WHOLE: Final = 512
"""Whole numbers of so many steps across the sheet count as exact, not as rounded."""
_TENTHS: Final = 64
"""So do other decimals of so many steps."""
_ZERO: Final = 1e-9
"""Coordinates below this share of the size are noise about zero."""


def size_of(points: Sequence[Sequence[Number]]) -> float:
    """The larger side of the rectangle round some points, however far from the origin.

    >>> size_of([(10**30, 0), (10**30 + 2, 1)])
    2.0
    """
    x, y = points[0]
    return float(max(np.ptp([[float(p[0] - x), float(p[1] - y)] for p in points], axis=0)))


def half_step(points: Sequence[Sequence[Number]]) -> float:
    """By so much of the size decimals may have been rounded; 0 if they count as exact.

    This is half of the largest step of which all are multiples. Numbers without a finite decimal
    were recognised or given exactly, and are left out.

    >>> half_step([(0, 0), (100, 0), (200, 0), (301, 100)])
    0.0
    >>> half_step([(0, 0), (Fraction("0.143"), 0), (1, 0), (1, 1)])
    0.0005
    """
    size = size_of(points)
    known = [_decimal(c) for point in points for c in point]
    decimals = [x for x in known if x is not None and abs(x) > _ZERO * size]
    if not decimals:
        return 0.0
    below = lcm(*(x.denominator for x in decimals))
    step = Fraction(gcd(*(int(x * below) for x in decimals)), below)
    steps = size / float(step)
    return 0.0 if steps <= (_WHOLE if below == 1 else _TENTHS) else 0.5 / steps


def reflections(pieces: Pieces) -> int:
    """The largest number of reflections from piece 0 to another one, on a shortest way."""
    graph = nx.Graph()
    graph.add_node(0)
    graph.add_edges_from(pieces.creases.values(), weight=1)
    graph.add_edges_from(pieces.joints.values(), weight=0)
    return int(max(nx.single_source_dijkstra_path_length(graph, 0).values()))


def _decimal(number: Number) -> Fraction | None:
    """A number as a fraction, if it is a finite decimal."""
    number = simple(number)
    if isinstance(number, Surd):
        return None
    found = Fraction(number)
    twos = (found.denominator & -found.denominator).bit_length() - 1
    rest = found.denominator >> twos
    return None if pow(5, rest.bit_length(), rest) else found


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
