"""Converts sheets to bar frameworks of PyRigi, and back."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from exactfold.errors import (
    FoldError,
    InputError,
    MalformedPatternError,
    NumberError,
    PatternError,
)
from exactfold.exact.numbers import as_rational, over_common_denominator
from exactfold.interop.packages import optional
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.planar import trace_faces

if TYPE_CHECKING:
    import pyrigi

Point = tuple[Fraction, Fraction]


def to_pyrigi(pattern: PatternLike) -> pyrigi.Framework:
    """The flat sheet as a `pyrigi.Framework` in dimension 3, with a bar for each edge.

    Vertices keep their numbers. The points are (x, y, 0), exact rational numbers of SymPy in the
    unit of the pattern. For a sheet with V vertices, Vi of them interior, PyRigi finds the rank
    2V - 3, Vi independent equilibrium stresses (`exactfold.rigidity.self_stresses` gives the same
    space, as densities) and V - 3 nontrivial infinitesimal flexes: the heights.

    Raises `PackageMissingError` without PyRigi, and the errors of `load`.

    >>> framework = to_pyrigi("two-vertex")  # doctest: +SKIP
    >>> framework.rigidity_matrix_rank(), len(framework.stresses())  # doctest: +SKIP
    (9, 2)
    """
    package = optional("pyrigi", "'exactfold[bridges]'")
    import sympy  # here, as it takes long to load

    pattern = as_pattern(pattern)
    graph = package.Graph.from_vertices_and_edges(range(len(pattern.vertices)), pattern.edges)
    places = {
        v: (sympy.Rational(*x.as_integer_ratio()), sympy.Rational(*y.as_integer_ratio()), 0)
        for v, (x, y) in enumerate(pattern.vertices)
    }
    return package.Framework(graph, places)


def from_pyrigi(framework: pyrigi.Framework) -> CreasePattern:
    """The crease pattern whose edges are the bars of a `pyrigi.Framework`.

    The framework must have dimension 2, or dimension 3 with all points in a plane z = constant, and
    rational coordinates. Faces and boundary are found from the bars: every bounded region must be a
    triangle. Vertex k of the pattern is entry k of `framework.graph.vertex_list()`.

    Raises `PatternError` for any other framework. The cause of this error says which
    vertices, edges or faces are to blame. Floats are refused, as their binary value is rarely what
    was meant.

    >>> from_pyrigi(to_pyrigi("two-vertex")).sha256 == as_pattern("two-vertex").sha256
    ... # doctest: +SKIP
    True
    """
    try:
        return _sheet(framework)
    except InputError as error:
        raise PatternError(
            f"the framework is not a crease pattern: {error}",
            vertices=getattr(error, "vertices", ()),
            edges=getattr(error, "edges", ()),
            faces=getattr(error, "faces", ()),
        ) from error


def _sheet(framework: pyrigi.Framework) -> CreasePattern:
    names = framework.graph.vertex_list()
    number = {name: k for k, name in enumerate(names)}
    places = framework.realization(as_points=True)
    points = _flat([[_rational(k, c) for c in places[name]] for k, name in enumerate(names)])
    edges = [(number[a], number[b]) for a, b in framework.graph.edge_list()]
    whole, _ = over_common_denominator(c for point in points for c in point)
    faces = trace_faces(list(zip(whole[::2], whole[1::2], strict=True)), edges)
    for face in faces:
        if len(face) > 3:
            raise FoldError(
                f"the bars {'-'.join(map(str, face))} enclose a face of {len(face)} sides"
            )
    return CreasePattern(points, faces)


def _rational(vertex: int, value: Any) -> Fraction:
    """A coordinate; PyRigi keeps it as it was given, or as a number of SymPy."""
    if getattr(value, "is_Rational", False):
        return Fraction(int(value.p), int(value.q))
    if getattr(value, "is_Float", False):
        value = float(value)
    elif hasattr(value, "free_symbols"):
        raise FoldError(f"vertex {vertex}: {value} is not a rational number")
    try:
        return as_rational(value)
    except NumberError as error:
        raise type(error)(f"vertex {vertex}: {error}") from None


def _flat(points: Sequence[Sequence[Fraction]]) -> list[Point]:
    """The points as pairs of coordinates in their common plane z = constant."""
    dimension = len(points[0]) if points else 0
    if dimension not in (2, 3):
        raise MalformedPatternError(f"its dimension is {dimension}, not 2 or 3")
    if len({tuple(point[2:]) for point in points}) > 1:
        raise FoldError("its vertices do not lie in one plane z = constant")
    return [(point[0], point[1]) for point in points]
