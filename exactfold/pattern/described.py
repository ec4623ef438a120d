"""Describes the pattern inside every result, so that a result can be read without the file."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, NotRequired, TypedDict

from exactfold._support.documents import (
    Digest,
    Face,
    FoldText,
    Keywords,
    Natural,
    Pair,
    Rational,
    Several,
    Triangle,
)
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern

if TYPE_CHECKING:  # triangulated sheets do not need these modules
    from exactfold.exact.surds import Number
    from exactfold.pattern.panel_pattern import PanelPattern


class _SheetDocument(TypedDict):
    name: str | None
    interior: Natural
    boundary: Natural
    folds: Natural
    sha256: Digest


class PatternDocument(_SheetDocument):
    """The pattern to which a result belongs."""

    degrees_of_freedom: Natural
    snapped: NotRequired[Rational]
    """The largest distance by which --snap moved a coordinate."""
    vertices: Annotated[list[Pair[Rational]], Keywords(minItems=3)]
    """Exact coordinates."""
    faces: Several[Triangle]
    """Triangles, counter-clockwise."""


class PanelsDocument(_SheetDocument):
    """The sheet of rigid panels to which a result belongs.

    Its numbers are fractions, or sums of products of square roots r1, r2, ... with fractions.
    """

    degrees_of_freedom: int
    vertices: Annotated[list[Pair[str]], Keywords(minItems=3)]
    """Exact coordinates; if there is a `radius`, no vertex is further than this from its point."""
    faces: Several[Face]
    """Panels, counter-clockwise."""
    holes: NotRequired[Several[Face]]
    """Cycles of vertices round holes, counter-clockwise, if the sheet has holes."""
    field: list[str]
    """The numbers under the square roots r1, r2, ..."""
    radius: NotRequired[Rational]
    directions: NotRequired[dict[FoldText, Pair[str]]]
    """Exact vectors along the edges, where positions are known only within `radius`."""


def described(
    pattern: CreasePattern, name: str | None = None, snapped: Fraction | None = None
) -> PatternDocument:
    """The name, counts, digest, exact vertices and faces of a pattern, as JSON.

    >>> pattern = CreasePattern([(0, 0), (1, 0), ("1/2", 1)], [(0, 1, 2)])
    >>> data = described(pattern, "mine")
    >>> data["name"], data["boundary"], data["vertices"][2], data["faces"]
    ('mine', 3, ['1/2', '1'], [[0, 1, 2]])
    """
    data: PatternDocument = {
        "name": name,
        "interior": pattern.Vi,
        "boundary": pattern.Ve,
        "folds": len(pattern.folds),
        "degrees_of_freedom": pattern.degrees_of_freedom,
        "sha256": pattern.sha256,
        "vertices": [[format_rational(x), format_rational(y)] for x, y in pattern.vertices],
        "faces": [list(triangle) for triangle in pattern.triangles],
    }
    if snapped is not None:
        data["snapped"] = format_rational(snapped)
    return data


def described_panels(pattern: PanelPattern, name: str | None = None) -> PanelsDocument:
    """The name, counts, digest, exact vertices and panels of a sheet of rigid panels, as JSON.

    `field` lists the numbers under the square roots r1, r2, ... that the coordinates use.

    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> square = PanelPattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (0, 3)])
    >>> data = described_panels(square)
    >>> data["folds"], data["field"], data["faces"]
    (0, [], [[0, 1, 2, 3]])
    """
    from exactfold.pattern.panel_pattern import EnclosedPattern

    data: PanelsDocument = {
        "name": name,
        "interior": len(pattern.interior),
        "boundary": len(pattern.boundary_set),
        "folds": len(pattern.folds),
        "degrees_of_freedom": pattern.D,
        "sha256": pattern.sha256,
        "field": [number_text(radicand) for radicand in pattern.radicands],
        "vertices": [[number_text(x), number_text(y)] for x, y in pattern.vertices],
        "faces": [list(face) for face in pattern.faces],
    }
    if pattern.holes:
        data["holes"] = [list(hole) for hole in pattern.holes]
    if isinstance(pattern, EnclosedPattern):
        data["radius"] = format_rational(pattern.radius)
        data["directions"] = {
            f"{i}-{j}": [number_text(x), number_text(y)]
            for (i, j), (x, y) in pattern.directions.items()
        }
    return data


def number_text(value: Number) -> str:
    """An exact number as text: "p/q", or a sum such as "1/2 + 1/2*r1".

    >>> from exactfold.exact.surds import RATIONALS
    >>> number_text(Fraction(1, 2)), number_text(RATIONALS.adjoined(2).root - 1)
    ('1/2', '-1 + r1')
    """
    if isinstance(value, int | Fraction):
        return format_rational(Fraction(value))
    return repr(value)
