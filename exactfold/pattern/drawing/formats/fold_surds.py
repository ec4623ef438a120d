"""Points with square roots in FOLD files: their field, and their coefficients in it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction
from typing import Any

from exactfold.checker.core.limits import MOST_ROOTS
from exactfold.errors import (
    NumberError,
    StaleExactCoordinatesError,
    TooLargeError,
    UsageError,
)
from exactfold.exact.numbers import format_rational, parse_rational, shown
from exactfold.exact.surds import RATIONALS, Surd, SurdField, common_field
from exactfold.pattern.drawing.drawing import Point
from exactfold.pattern.drawing.formats.fold_json import AGREEMENT, FIELD_KEY, SURDS_KEY, list_at


def surd_keys(points: Iterable[Point]) -> dict[str, Any]:
    """The two FOLD keys of points in a field of square roots.

    A number is written as the list of its coefficients of 1, r1, r2, r1 r2, r3, ..., as in `Surd`.

    >>> root = RATIONALS.adjoined(2).root
    >>> surd_keys([(root / 2, 1 + root)])["frame_exactfold:field"]
    [['2']]
    >>> surd_keys([(root / 2, Fraction(1))])["vertices_exactfold:surds"]
    [[['0', '1/2'], ['1', '0']]]
    """
    rows = list(points)
    field = common_field(c for point in rows for c in point)
    return {
        FIELD_KEY: [[format_rational(c) for c in radicand] for radicand in field.radicands],
        SURDS_KEY: [
            [[format_rational(c) for c in field.number(value).coefficients] for value in point]
            for point in rows
        ],
    }


def surd_points(document: Mapping[str, Any], stated: Sequence[tuple[Fraction, ...]]) -> list[Point]:
    """The points of `vertices_exactfold:surds`; empty if the key is absent.

    They must agree with the first two components of `stated` up to 1e-9 of the largest of these.
    Raises `StaleExactCoordinatesError` if they do not, and `NumberError` for an invalid field
    or invalid coefficients.

    >>> root = RATIONALS.adjoined(2).root
    >>> document = surd_keys([(root / 2, 1 + root)])
    >>> surd_points(document, [(Fraction("0.70710678119"), Fraction("2.41421356237"))])
    [(1/2*r1, 1 + r1)]
    """
    rows = list_at(document, SURDS_KEY)
    if not rows:
        return []
    if len(rows) != len(stated):
        raise StaleExactCoordinatesError(
            f"`{SURDS_KEY}` has {len(rows)} vertices and `vertices_coords` has {len(stated)}: "
            f"delete `{SURDS_KEY}` if another program changed the pattern"
        )
    field = _field(list_at(document, FIELD_KEY))
    tolerance = AGREEMENT * max(abs(c) for point in stated for c in point[:2])
    points: list[Point] = []
    for v, (row, place) in enumerate(zip(rows, stated, strict=True)):
        if not isinstance(row, list) or len(row) != 2:
            raise NumberError(f"vertex {v}: {shown(row)} in `{SURDS_KEY}` is not two numbers")
        x, y = (Surd(field, _coefficients(part, field.dimension, f"vertex {v}")) for part in row)
        for value, drawn in ((x, place[0]), (y, place[1])):
            if value - drawn > tolerance or drawn - value > tolerance:
                raise StaleExactCoordinatesError(
                    f"vertex {v}: `{SURDS_KEY}` and `vertices_coords` disagree; delete "
                    f"`{SURDS_KEY}` if another program moved the vertex"
                )
        points.append((x, y))
    return points


def _field(rows: Sequence[object]) -> SurdField:
    if len(rows) > MOST_ROOTS:
        raise TooLargeError(
            f"the field in `{FIELD_KEY}` has {len(rows)} square roots, but at most {MOST_ROOTS} "
            "are read: give decimals instead"
        )
    field = RATIONALS
    for k, row in enumerate(rows, 1):
        name = f"the number under r{k} in `{FIELD_KEY}`"
        radicand = Surd(field, _coefficients(row, field.dimension, name))
        try:
            larger = field.adjoined(radicand)
        except UsageError:
            raise NumberError(f"{name} is not positive: {shown(row)}") from None
        if larger is field:
            raise NumberError(f"{name} is a square of the field already: {shown(row)}")
        field = larger
    return field


def _coefficients(row: object, count: int, name: str) -> tuple[Fraction, ...]:
    texts = isinstance(row, list) and len(row) == count and all(isinstance(c, str) for c in row)
    if not texts or not isinstance(row, list):
        raise NumberError(f'{name}: {shown(row)} is not a list of {count} texts "p/q"')
    try:
        return tuple(parse_rational(c) for c in row)
    except NumberError as error:
        raise NumberError(f"{name}: {error}") from None
