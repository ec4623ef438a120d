"""The sheet that was meant: the exact sheet near a drawing whose edges have exact angles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import cos, hypot, log2, log10, pi, sin
from typing import Any, Final, TypeAlias

import numpy as np

from exactfold.checker.core.limits import LONG_COORDINATE, MOST_PRODUCTS
from exactfold.checker.sheets.meant import MEANT, MeantClaims
from exactfold.checker.sheets.relations import RelationClaim
from exactfold.errors import (
    FoldError,
    NotADiskError,
    NotApplicableError,
    PatternError,
    UsageError,
)
from exactfold.exact.numbers import decimal_above, format_rational
from exactfold.exact.surds import Number, Surd, sign, simple
from exactfold.pattern.drawing.meant.constructing import constructed
from exactfold.pattern.drawing.meant.directions import (
    Directions,
    Vector,
    in_a_tower,
    parts_of,
    with_a_one,
)
from exactfold.pattern.drawing.meant.enclosing import Enclosed, enclosed, keeps_faces
from exactfold.pattern.drawing.meant.integral import with_integers
from exactfold.pattern.drawing.meant.peeling import Lines
from exactfold.pattern.drawing.meant.positions import NO_PLACES, Point, bound_edges, placed_together
from exactfold.pattern.drawing.meant.refining import Refined, refined
from exactfold.pattern.drawing.meant.solving import holds, recognised_positions
from exactfold.pattern.drawing.meant.turning import turned_positions
from exactfold.pattern.drawing.meant.values import Angles, Edge, Existence, Relation
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import EnclosedPattern, PanelPattern

Written: TypeAlias = tuple[tuple[Fraction, Fraction], ...]
_SHARP: Final = 1e-12
"""Free angles of a sheet with enclosed positions are rounded this little, in radians."""
NO_FRAME: Final = "its coordinates are no small numbers in a frame along an edge"
_FAR: Final = 100
"""A sheet with enclosed positions is not near the drawing if it is off by so many times the noise.
"""
_LEAST: Final = 1e-300
"""A move that floats cannot tell from 0 is proposed to be this long."""


@dataclass(frozen=True)
class Realized:
    """The sheet with exact angles near a drawing, or why none was found.

    `drawn` is the drawing as written, and `sheet` is the exact sheet; no vertex is further from its
    written point than `distance` times the larger side of the drawing. If `existence` is "box",
    only the directions of `sheet` are exact, and its positions are enclosed (`EnclosedPattern`). If
    it is "none", no sheet was found, and `reason` says why.
    """

    drawn: PanelPattern
    sheet: PanelPattern | None
    distance: Fraction
    existence: Existence
    reason: str

    @property
    def bits(self) -> int:
        """The bits of the longest numerator or denominator among the coordinates."""
        points = () if self.sheet is None else self.sheet.vertices
        parts = [part for point in points for c in point for part in _parts(c)]
        return max((max(abs(p.numerator), p.denominator).bit_length() for p in parts), default=0)


def realize(drawn: PanelPattern, angles: Angles, noise: float) -> Realized:
    """The exact sheet near a drawing whose edges have the given angles.

    `noise` is the noise level of the drawing, relative to its larger side. Free angles become
    angles with tangents in the field, and free coordinates short decimals, without leaving the
    noise. All other coordinates follow from the directions of edges. If the positions determine
    some of the free angles, these follow, too, where each is found by linear equations. All edges
    are checked exactly. Raises `UsageError` if the coordinates of the drawing are irrational.

    >>> square = PanelPattern([(0, 0), (1, 0), (1, 1), (Fraction(1, 1000), 1)],
    ...                       [(0, 1), (1, 2), (2, 3), (0, 3), (0, 2)])
    >>> constants = {(0, 1): 0, (1, 2): Fraction(1, 2), (2, 3): 0, (0, 3): Fraction(1, 2),
    ...              (0, 2): Fraction(1, 4)}
    >>> made = realize(square, Angles({e: Fraction(c) for e, c in constants.items()}, {}, ()), 1e-3)
    >>> left = made.sheet.vertices
    >>> made.existence, made.distance < Fraction(1, 1000), left[3][0] == left[0][0]
    ('exact', True, True)
    """
    written = tuple(_written(point) for point in drawn.vertices)
    if not in_a_tower(parts_of(angles)):
        angles = with_integers(angles)
    if not in_a_tower(parts := parts_of(angles)):
        return _none(drawn, _no_tower(parts))
    points = _exact_points(written, angles, noise)
    return _none(drawn, points) if isinstance(points, str) else _compared(drawn, written, points)


def _exact_points(written: Written, angles: Angles, noise: float) -> list[Point] | str:
    """Exact positions near the written ones, or the reason why there are none."""
    bound = bound_edges(angles)
    places = np.array([(float(x), float(y)) for x, y in written])
    whole = {edge: edge for edge in bound}
    directions = Directions(angles, angles.free, noise)
    points = placed_together(written, places, directions, whole, noise)
    if not isinstance(points, str) or not any(angles.coefficients.get(edge) for edge in bound):
        return points
    near = refined(places, angles, bound, noise)
    if not near.exists:
        return _missed(near)
    for recognise in (True, False):
        directions = Directions(angles, near.free, noise, recognise=recognise)
        points = placed_together(written, places, directions, whole, noise)
        if not isinstance(points, str):
            return points
    directions = Directions(angles, near.free, noise)
    lines = _lines(directions, angles, near.free, bound)
    return constructed(written, near.places, directions, lines, bound, noise)


def recognise(
    drawn: PanelPattern, angles: Angles, noise: float, relations: Iterable[Relation]
) -> Realized:
    """The exact sheet near a drawing that has all relations, if its coordinates are short.

    The coordinates are recognised from many digits, which Newton's method finds. The relations are
    then checked exactly. Raises `UsageError` if the coordinates of the drawing are irrational.
    """
    written = tuple(_written(point) for point in drawn.vertices)
    if not in_a_tower(parts_of(angles)):
        angles = with_integers(angles)
    bound = bound_edges(angles)
    near = refined(np.array([(float(x), float(y)) for x, y in written]), angles, bound, noise)
    points = recognised_positions(written, near, angles, bound, noise) if near.exists else None
    if points is None:
        return _none(drawn, "its coordinates are no short numbers in a field of one square root")
    return _checked(drawn, written, points, noise, relations)


def in_a_frame(
    drawn: PanelPattern, angles: Angles, noise: float, relations: Iterable[Relation]
) -> Realized:
    """The exact sheet near a drawing that has all relations, if it is small in a frame.

    The frame is one along an edge (`turned_positions`). The relations are checked exactly, so that
    the `angles` are not needed. Raises `UsageError` if the coordinates of the drawing are
    irrational.
    """
    written = tuple(_written(point) for point in drawn.vertices)
    points = turned_positions(written, drawn.edges, noise)
    if points is None:
        return _none(drawn, NO_FRAME)
    return _checked(drawn, written, points, noise, relations)


def _checked(
    drawn: PanelPattern,
    written: Written,
    points: Sequence[Point],
    noise: float,
    relations: Iterable[Relation],
) -> Realized:
    """The sheet with recognised positions, if it is near the drawing and has all relations."""
    if missed := [relation.name for relation in relations if not holds(relation, points)]:
        return _none(drawn, f"the positions that were recognised miss {missed[0]}")
    made = _compared(drawn, written, points)
    return made if made.distance < _FAR * noise else _none(drawn, NO_PLACES)


def enclose(drawn: PanelPattern, angles: Angles, noise: float) -> Realized:
    """The sheet near a drawing whose edges have the given angles, with its positions enclosed.

    Directions are exact, as in `realize`, but positions are known only nearly. Free angles are
    chosen such that floats find a sheet with these angles. An enclosure proves that there is a
    sheet near it whose edges have the exact directions. Raises `UsageError` if the coordinates of
    the drawing are irrational.
    """
    if drawn.holes:
        return _none(drawn, "its positions are known only nearly, and holes need them")
    written = tuple(_written(point) for point in drawn.vertices)
    if not in_a_tower(parts_of(angles)):
        angles = with_integers(angles)
    if not in_a_tower(parts := parts_of(angles)):
        return _none(drawn, _no_tower(parts))
    edges = sorted({*bound_edges(angles), *drawn.folds})
    places = np.array([(float(x), float(y)) for x, y in written])
    near = refined(places, angles, edges, noise)
    reason = _missed(near)
    for precision, start in ((_SHARP, near.places), (noise, places)):
        directions = Directions(angles, near.free, precision, recognise=False)
        found = enclosed(start, directions, edges, precision)
        if isinstance(found, str):
            reason = reason or found
            continue
        made = _surrounded(drawn, written, directions, edges, found)
        if made.sheet is not None and made.distance < _FAR * noise:
            return made
        reason = reason or made.reason
    return _none(drawn, reason)


def _surrounded(
    drawn: PanelPattern,
    written: Written,
    directions: Directions,
    edges: Sequence[Edge],
    found: Enclosed,
) -> Realized:
    """The sheet with enclosed positions, if it has the panels of the drawing."""
    made = _compared(drawn, written, found.points)
    if made.sheet is None:
        return made
    polygons: list[Sequence[Edge]] = [
        [*zip(face, (*face[1:], face[0]), strict=True)] for face in drawn.faces
    ]
    vectors = {edge: _forwards(directions.vector(edge), edge, found) for edge in edges}
    if None in vectors.values() or not keeps_faces(
        found.points, [*polygons, drawn.boundary_edges], found.radius
    ):
        return _none(drawn, "its positions are not enclosed well enough to tell its panels")
    known = {edge: vector for edge, vector in vectors.items() if vector is not None}
    sheet = EnclosedPattern(found.points, drawn.edges, known, found.radius, drawn.holes)
    size = max(max(axis) - min(axis) for axis in zip(*written, strict=True))
    distance = Fraction(decimal_above(made.distance + found.radius / size, 3))
    return Realized(drawn, sheet, distance, "box", "")


def _forwards(vector: Vector, edge: Edge, found: Enclosed) -> tuple[Number, Number] | None:
    """The vector, or a multiple of it, as it points from one end of the edge to the other.

    It has nearly the length of the edge. None if the enclosure does not tell where it points.
    """
    (ax, ay), (bx, by) = (found.points[v] for v in edge)
    x, y = with_a_one(vector)
    along = x * (bx - ax) + y * (by - ay)
    square = x * x + y * y
    if sign(along * along - 4 * found.radius**2 * square) <= 0:
        return None
    scale = Fraction(2) ** round(log2(abs(float(along / square)))) * sign(along)
    return simple(x * scale), simple(y * scale)


def _no_tower(parts: int) -> str:
    return (
        f"some angles are multiples of pi/{parts}, and these have directions in no small tower of "
        "square roots"
    )


def _missed(near: Refined) -> str:
    if near.exists:
        return ""
    return (
        "no sheet near the drawing seems to have all relations: in floats, edges still miss their "
        f"directions by {near.off:.1g} of the size"
    )


def _lines(
    directions: Directions, angles: Angles, free: Sequence[float], bound: Sequence[Edge]
) -> Lines:
    """The directions of edges in floats, and what they depend on."""
    units, powers = {}, {}
    for edge in bound:
        terms = angles.coefficients.get(edge, ())
        constant = angles.constants[edge] % 1  # equal keys give equal vectors
        angle = float(constant) * pi + sum(float(a) * free[k] for k, a in terms)
        units[edge] = cos(angle), sin(angle)
        powers[edge] = {k: directions.power(edge, k) for k, _ in terms}
    return Lines({edge: directions.key(edge) for edge in bound}, units, powers)


def certificate(made: Realized, relations: Iterable[Relation]) -> dict[str, Any]:
    """The certificate of an exact sheet with its relations, for `exactfold.checker`.

    Raises `NotApplicableError` if there is no exact sheet, or if its numbers are too long for the
    checker.
    """
    if made.sheet is None:
        raise NotApplicableError(f"no certificate, as no exact sheet was found: {made.reason}")
    sheet = made.sheet
    if _products(sheet) > MOST_PRODUCTS:
        raise NotApplicableError(
            f"no certificate: the checker takes no sheet of this size with numbers of {made.bits} "
            "bits"
        )
    claims: MeantClaims = {
        "interior": len(sheet.interior),
        "border": len(sheet.boundary_set),
        "folds": len(sheet.folds),
        "panels": len(sheet.faces),
        "drawn": made.drawn.sha256,
        "within": format_rational(made.distance),
        "relations": [_claim(relation) for relation in relations],
        "sha256": sheet.sha256,
    }
    return {
        "format": MEANT.format,
        "version": MEANT.version,
        "drawn": panels_document(made.drawn),
        "pattern": panels_document(sheet),
        "claims": claims,
    }


def _claim(relation: Relation) -> RelationClaim:
    return {
        "kind": relation.kind,
        "name": relation.name,
        "terms": [[i, j, factor] for (i, j), factor in relation.terms],
        "parts": relation.parts,
    }


def _products(sheet: PanelPattern) -> float:
    """What the checker limits by `MOST_PRODUCTS`, or slightly more."""
    total = 0.0
    for part in (part for point in sheet.vertices for c in point for part in _parts(c)):
        above, below = (number.bit_length() * log10(2) + 2 for number in part.as_integer_ratio())
        if max(above, below) > LONG_COORDINATE:
            total += above * below
    return total


def _written(point: Sequence[Number]) -> tuple[Fraction, Fraction]:
    x, y = (simple(c) for c in point)
    if isinstance(x, Surd) or isinstance(y, Surd):
        raise UsageError("the coordinates of this drawing are irrational and already exact")
    return Fraction(x), Fraction(y)


def _none(drawn: PanelPattern, reason: str) -> Realized:
    return Realized(drawn, None, Fraction(0), "none", reason)


def _compared(
    drawn: PanelPattern, written: Written, points: Sequence[tuple[Number, Number]]
) -> Realized:
    """The sheet with these points, if it has the panels of the drawing."""
    try:
        sheet = PanelPattern([(simple(x), simple(y)) for x, y in points], drawn.edges, drawn.holes)
    except (FoldError, PatternError, NotADiskError) as error:
        return _none(drawn, f"the exact positions do not make the sheet that was drawn: {error}")
    if sheet.faces != drawn.faces:
        face = next(face for face in drawn.faces if face not in sheet.faces)
        name = "-".join(map(str, face))
        return _none(drawn, f"the exact positions turn over or break panel {name}")
    return Realized(drawn, sheet, _distance(written, points), "exact", "")


def _distance(written: Written, points: Sequence[tuple[Number, Number]]) -> Fraction:
    """An upper bound of how far points moved, relative to the larger side.

    Floats propose three digits, and the bound is doubled until exact squares confirm it.
    """
    size = max(max(axis) - min(axis) for axis in zip(*written, strict=True))
    moves = [(x - a, y - b) for (x, y), (a, b) in zip(points, written, strict=True)]
    moves = [move for move in moves if sign(move[0]) or sign(move[1])]
    if not moves:
        return Fraction(0)
    moved = max(hypot(float(dx), float(dy)) for dx, dy in moves) or _LEAST
    above = Fraction(moved) * Fraction(1 + 2.0**-40)
    bound = Fraction(decimal_above(above / size, 3))
    while any(sign(dx * dx + dy * dy - (bound * size) ** 2) > 0 for dx, dy in moves):
        bound *= 2
    return bound


def _parts(value: Number) -> Iterator[Fraction]:
    yield from value.coefficients if isinstance(value, Surd) else (Fraction(value),)
