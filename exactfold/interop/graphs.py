"""Converts sheets to graphs of NetworkX, with the letters of a branch or of a file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.panel_pattern import PanelPattern

if TYPE_CHECKING:
    import networkx as nx


def to_networkx(
    pattern: PatternLike | PanelPattern, assignment: Mapping[Edge, str] | None = None
) -> nx.Graph:
    """The vertices and edges as a new `networkx.Graph`, which the caller may change.

    Nodes have `pos`, the exact point in the unit of the pattern, and `interior`. Edges have `fold`
    (not on the boundary) and `letter`. The letter is that of `assignment` (in the form of
    `Branch.assignment`), "U" for a fold without one, and "B" on the boundary.
    `graph.graph["faces"]` are the faces, counter-clockwise. Raises the errors of `load`.

    >>> graph = to_networkx("two-vertex", {(4, 5): "M"})
    >>> graph.nodes[4], graph.edges[4, 5]
    ({'pos': (Fraction(1, 3), Fraction(2, 5)), 'interior': True}, {'fold': True, 'letter': 'M'})
    >>> graph.edges[0, 1], len(graph.graph["faces"])
    ({'fold': False, 'letter': 'B'}, 6)
    """
    import networkx as nx  # here, as it takes long to load

    sheet = pattern if isinstance(pattern, PanelPattern) else as_pattern(pattern)
    faces = sheet.triangles if isinstance(sheet, CreasePattern) else sheet.faces
    inside, folds, letters = set(sheet.interior), set(sheet.folds), assignment or {}
    graph = nx.Graph(faces=faces)
    for v, point in enumerate(sheet.vertices):
        graph.add_node(v, pos=point, interior=v in inside)
    for edge in sheet.edges:
        fold = edge in folds
        graph.add_edge(*edge, fold=fold, letter=letters.get(edge, "U") if fold else "B")
    return graph
