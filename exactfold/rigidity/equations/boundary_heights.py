"""Checks given boundary heights and angle deficits, and chooses boundary heights by default."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from exactfold.errors import (
    BadCurvatureError,
    BoundaryHeightsError,
    NotApplicableError,
    NumberError,
)
from exactfold.exact.numbers import RationalLike, as_rational
from exactfold.pattern.crease_pattern import CreasePattern

_FORMS = ((1, 1, -1), (1, 0, -1), (0, 1, 0))
"""Coefficients of x^2, x y and y^2 that `default_boundary_heights` tries in this order."""


def default_boundary_heights(pattern: CreasePattern) -> dict[int, Fraction]:
    """Boundary heights of a saddle, which depend on the pattern alone.

    The heights are h = x^2 + x y - y^2 minus the plane through three boundary vertices, where x and
    y run from -1 to 1 over the bounding box. They are scaled so that the largest is 1 or -1, and
    rounded to hundredths. Such a saddle rises along one diameter and falls along another, so that
    both vertices that pop up and vertices that pop down have room. It is oblique, so that symmetry
    makes no fold flat if the boundary is a regular polygon. If these heights lie in one plane,
    x^2 - y^2 and then x y are tried.

    Raises `NotApplicableError` for fewer than four boundary vertices and for a boundary that is not
    convex.

    >>> from exactfold.pattern.families import single_vertex
    >>> sorted(map(str, default_boundary_heights(single_vertex(5)).values()))
    ['-1', '0', '0', '0', '11/20']
    """
    _require_convex(pattern)
    if len(pattern.boundary) < 4:
        raise NotApplicableError(
            "three boundary vertices always lie in one plane: their heights cannot be chosen"
        )
    for form in _FORMS:
        heights = _saddle(pattern, form)
        if any(heights.values()):
            return heights
    raise NotApplicableError(
        "no saddle gives boundary heights that do not lie in one plane: give heights (`rim=`)"
    )


def saddle_boundary_heights(pattern: CreasePattern) -> list[dict[int, Fraction]]:
    """Boundary heights of several saddles; the first are the `default_boundary_heights`.

    The saddles are x^2 + x y - y^2, its mirror image, x^2 - y^2 and x y, each of them and its
    negative, with heights made as in `default_boundary_heights`. Raises the errors of
    `default_boundary_heights`.

    >>> from exactfold.pattern.families import single_vertex
    >>> boundaries = saddle_boundary_heights(single_vertex(5))
    >>> len(boundaries), boundaries[0] == default_boundary_heights(single_vertex(5))
    (8, True)
    """
    saddles = [default_boundary_heights(pattern)]
    for form in (_FORMS[0], (1, -1, -1), *_FORMS[1:]):
        for sign in (1, -1):
            a, b, c = form
            heights = _saddle(pattern, (sign * a, sign * b, sign * c))
            if any(heights.values()) and heights not in saddles:
                saddles.append(heights)
    return saddles


def _saddle(pattern: CreasePattern, form: tuple[int, int, int]) -> dict[int, Fraction]:
    """The rounded heights of a form above a plane; all are 0 if the heights lie in one plane."""
    boundary, (a, b, c) = pattern.boundary, form
    middle, half = [], []
    for axis in (0, 1):
        values = [pattern.vertices[v][axis] for v in boundary]
        middle.append((max(values) + min(values)) / 2)
        half.append((max(values) - min(values)) / 2)
    heights = {}
    for v in boundary:
        x, y = ((pattern.vertices[v][k] - middle[k]) / half[k] for k in (0, 1))
        heights[v] = a * x * x + b * x * y + c * y * y
    level = above_plane(pattern, heights)
    largest = max(map(abs, level.values())) or Fraction(1)
    return {v: Fraction(round(100 * h / largest), 100) for v, h in level.items()}


def above_plane(pattern: CreasePattern, heights: Mapping[int, Fraction]) -> dict[int, Fraction]:
    """Heights of the boundary vertices above the plane through three of them.

    All are 0 if all boundary vertices lie in one plane. The three vertices are two neighbours and
    the vertex farthest from the side between them.
    """
    a, b = pattern.boundary[:2]
    (ax, ay), (bx, by) = pattern.vertices[a], pattern.vertices[b]

    def row(v: int) -> tuple[Fraction, Fraction]:
        # Distance from the line ab, and height above it.
        x, y = pattern.vertices[v][0] - ax, pattern.vertices[v][1] - ay
        dx, dy = bx - ax, by - ay
        along = (x * dx + y * dy) / (dx * dx + dy * dy)
        return x * dy - y * dx, heights[v] - heights[a] - along * (heights[b] - heights[a])

    rows = {v: row(v) for v in pattern.boundary}
    farthest = max(rows.values(), key=lambda pair: abs(pair[0]))
    slope = farthest[1] / farthest[0]
    return {v: height - slope * distance for v, (distance, height) in rows.items()}


def given_boundary_heights(
    pattern: CreasePattern,
    boundary_heights: Mapping[int, RationalLike],
    *,
    may_be_flat: bool = False,
) -> dict[int, Fraction]:
    """The given heights of the boundary vertices, checked, in the order of the boundary.

    Raises `BoundaryHeightsError` if a height is missing, belongs to another vertex or is not a
    number, or if all heights lie in one plane; its `vertices` are to blame. Raises
    `NotApplicableError` for a boundary that is not convex.
    """
    boundary = pattern.boundary
    wanted = f"give a height for each boundary vertex: {', '.join(map(str, boundary))}"
    for v in boundary_heights:
        if v not in boundary:
            raise BoundaryHeightsError(f"{v} is not a boundary vertex; {wanted}", (v,))
    missing = [v for v in boundary if v not in boundary_heights]
    if missing:
        raise BoundaryHeightsError(f"boundary vertex {missing[0]} has no height; {wanted}", missing)
    _require_convex(pattern)
    heights = {}
    for v in boundary:
        try:
            heights[v] = as_rational(boundary_heights[v])
        except NumberError as error:
            raise BoundaryHeightsError(f"the height of vertex {v}: {error}", (v,)) from None
    if not may_be_flat and not any(above_plane(pattern, heights).values()):
        raise BoundaryHeightsError(
            f"the boundary is flat: the heights of vertices {', '.join(map(str, boundary))} lie in "
            "one plane, and then the flat sheet is the only solution; change a height",
            boundary,
        )
    return heights


def given_deficits(
    pattern: CreasePattern, curvature: Mapping[int, RationalLike]
) -> dict[int, Fraction]:
    """The angle deficits of interior vertices that are not 0, checked.

    A vertex without a given deficit has the deficit 0. Raises `BadCurvatureError` for a vertex that
    is not interior, and for a deficit that is not a number or is negative.
    """
    interior = set(pattern.interior)
    deficits = {}
    for v, value in curvature.items():
        if v not in interior:
            raise BadCurvatureError(
                f"{v} is not an interior vertex, so it has no angle deficit", (v,)
            )
        try:
            deficit = as_rational(value)
        except NumberError as error:
            raise BadCurvatureError(f"the angle deficit of vertex {v}: {error}", (v,)) from None
        if deficit < 0:
            raise BadCurvatureError(
                f"the angle deficit of vertex {v} is negative: a vertex with an angle excess is a "
                "saddle, which pops neither up nor down, and a shape need not exist",
                (v,),
            )
        if deficit:
            deficits[v] = deficit
    return dict(sorted(deficits.items()))


def _require_convex(pattern: CreasePattern) -> None:
    if not pattern.is_convex:
        corner = pattern.reflex_corner
        raise NotApplicableError(
            f"boundary heights can be given for a convex boundary only; vertex {corner} is reflex"
        )
