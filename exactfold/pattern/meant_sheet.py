"""The sheet that was meant: the exact sheet near a drawing whose edges have exact angles."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import hypot
from typing import Any, Literal, TypeAlias

from exactfold._support.plurals import counted
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
from exactfold.exact.surds import Number, Surd, simple
from exactfold.pattern.drawing.meant.directions import exact_directions
from exactfold.pattern.drawing.meant.positions import bound_edges, exact_positions, missed
from exactfold.pattern.drawing.meant.values import Angles, Relation
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

Written: TypeAlias = tuple[tuple[Fraction, Fraction], ...]
Existence: TypeAlias = Literal["exact", "none"]


@dataclass(frozen=True)
class Realized:
    """The sheet with exact angles near a drawing, or why none was found.

    `drawn` is the drawing as written, and `sheet` is the exact sheet; no vertex is further from its
    written point than `distance` times the larger side of the drawing. If `existence` is "none", no
    sheet was found, and `reason` says why.
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
    angles with rational tangents, and free coordinates short decimals; both stay far nearer to
    their values than the noise. All other coordinates follow from the directions of edges, and all
    edges are checked exactly. Raises `UsageError` if the coordinates of the drawing are irrational.

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
    directions = exact_directions(angles, noise / 100)
    if directions is None:
        parts = max(c.denominator for c in angles.constants.values())
        return _none(
            drawn,
            f"some angles are multiples of pi/{parts} that have directions in no small tower of "
            "square roots",
        )
    bound = bound_edges(angles)
    points = exact_positions(written, directions, bound, noise)
    if failed := missed(points, directions, bound):
        i, j = failed[0]
        return _none(
            drawn,
            f"the positions of the vertices constrain the free angles: {len(failed)} of "
            f"{counted(len(bound), 'edge')}, the first {i}-{j}, cannot have the given directions "
            "for these values of the free angles",
        )
    return _compared(drawn, written, points)


def certificate(made: Realized, relations: Iterable[Relation]) -> dict[str, Any]:
    """The certificate of an exact sheet with its relations, for `exactfold.checker`.

    Raises `NotApplicableError` if there is no exact sheet.
    """
    if made.sheet is None:
        raise NotApplicableError(f"no certificate, as no exact sheet was found: {made.reason}")
    sheet = made.sheet
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


def _written(point: Sequence[Number]) -> tuple[Fraction, Fraction]:
    x, y = (simple(c) for c in point)
    if isinstance(x, Surd) or isinstance(y, Surd):
        raise UsageError("the coordinates of this drawing are irrational and already exact")
    return Fraction(x), Fraction(y)


def _none(drawn: PanelPattern, reason: str) -> Realized:
    return Realized(drawn, None, Fraction(0), "none", reason)


def _compared(
    drawn: PanelPattern, written: Written, points: Sequence[tuple[Surd, Surd]]
) -> Realized:
    """The sheet with these points, if it has the panels of the drawing."""
    try:
        sheet = PanelPattern([(simple(x), simple(y)) for x, y in points], drawn.edges)
    except (FoldError, PatternError, NotADiskError) as error:
        return _none(drawn, f"the exact positions do not make the sheet that was drawn: {error}")
    if sheet.faces != drawn.faces:
        face = next(face for face in drawn.faces if face not in sheet.faces)
        name = "-".join(map(str, face))
        return _none(drawn, f"the exact positions turn over or break panel {name}")
    return Realized(drawn, sheet, _distance(written, points), "exact", "")


def _distance(written: Written, points: Sequence[tuple[Surd, Surd]]) -> Fraction:
    """An upper bound, in three digits, of how far points moved, relative to the larger side."""
    size = max(max(axis) - min(axis) for axis in zip(*written, strict=True))
    moved = max(
        hypot(float(x - a), float(y - b)) for (x, y), (a, b) in zip(points, written, strict=True)
    )
    above = Fraction(moved) * Fraction(1 + 2.0**-40)  # floats of differences are correctly rounded
    return Fraction(decimal_above(above / size, 3)) if moved else Fraction(0)


def _parts(value: Number) -> Iterator[Fraction]:
    yield from value.coefficients if isinstance(value, Surd) else (Fraction(value),)
