"""Sheets of panels and their numbers, as certificates hold them."""

from __future__ import annotations

from typing import Any

from exactfold.exact.numbers import format_rational
from exactfold.exact.surds import Number, SurdField
from exactfold.pattern.panel_pattern import PanelPattern


def panels_document(pattern: PanelPattern) -> dict[str, Any]:
    """The vertices, as exact numbers in their field, the edges, and the holes if there are any.

    Raises `NotApplicableError` for a sheet whose positions are known only nearly.
    """
    pattern.check_positions()
    field = pattern.field
    holes = {"holes": [list(hole) for hole in pattern.holes]} if pattern.holes else {}
    return {
        **holes,
        "radicands": [[format_rational(c) for c in r] for r in field.radicands],
        "vertices": [[number_document(x, field) for x in point] for point in pattern.vertices],
        "edges": [[i, j] for i, j in pattern.edges],
    }


def number_document(value: Number, field: SurdField) -> list[str]:
    """The coefficients of a number in a field.

    >>> number_document(2, SurdField(()).adjoined(3))
    ['2', '0']
    """
    return [format_rational(c) for c in field.number(value).coefficients]
