"""Positions that are recognised from many digits."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import atan2, pi, sqrt

import numpy as np
import pytest

from exactfold.exact.surds import RATIONALS
from exactfold.pattern.drawing.meant.refining import refined
from exactfold.pattern.drawing.meant.solving import holds, recognised_positions
from exactfold.pattern.drawing.meant.values import Angles, Edge, Relation
from exactfold.pattern.meant_sheet import recognise
from exactfold.pattern.panel_pattern import PanelPattern

EDGES: list[Edge] = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
"""A triangle with an inner vertex."""


def triangle(height: float) -> tuple[PanelPattern, Angles]:
    """An isosceles triangle; its inner vertex is as steep from one corner as half the side is.

    The positions determine all free angles but one, up to a similarity.
    """
    points = [(0.0, 0.0), (4.0, 0.0), (2.0, height), (2.0, height / 3)]
    written = [(Fraction(str(round(x, 6))), Fraction(str(round(y, 6)))) for x, y in points]
    side, inner = atan2(height, 2), atan2(height / 3, 2)
    one = Fraction(1)
    constants = dict.fromkeys(EDGES, Fraction(0))
    constants[2, 3] = Fraction(-1, 2)
    constants[1, 2] = constants[1, 3] = one
    coefficients = {
        (0, 2): ((0, one),),
        (1, 2): ((0, -one),),
        (0, 3): ((1, one),),
        (1, 3): ((1, -one),),
    }
    return PanelPattern(written, EDGES), Angles(constants, coefficients, (side, inner))


def shape(sheet: PanelPattern, angles: Angles) -> list[object] | None:
    written = tuple((Fraction(x), Fraction(y)) for x, y in sheet.vertices)
    places = np.array(written, dtype=float)
    near = refined(places, angles, EDGES, 1e-6)
    assert near.exists
    points = recognised_positions(written, near, angles, EDGES, 1e-6)
    return None if points is None else [c for point in points for c in point]


def on_a_grid(angles: Angles, side: Fraction, inner: Fraction) -> Angles:
    """The angles, where those that were free are multiples of pi."""
    values = {0: side, 1: inner}
    constants = dict(angles.constants)
    for edge, ((k, factor),) in angles.coefficients.items():
        constants[edge] += factor * values[k]
    return Angles(constants, {}, ())


def test_positions_in_a_field_that_the_angles_do_not_name() -> None:
    """The sides are at 60 and 30 degrees, but no constant of the angles says so."""
    sheet, angles = triangle(2 * sqrt(3))
    found = shape(sheet, on_a_grid(angles, Fraction(1, 3), Fraction(1, 6)))
    assert found is not None
    assert {c.field.numbers for c in found if c} == {(3,)}
    x, y = found[4] - found[0], found[5] - found[1]
    assert x * x * 3 == y * y
    assert x


def test_rational_positions() -> None:
    sheet, angles = triangle(3.0)
    found = shape(sheet, angles)
    assert found is not None
    assert not any(c.field.radicands for c in found)
    assert found[4] == found[6] == (found[0] + found[2]) / 2


def test_positions_that_are_no_short_numbers() -> None:
    """The tangent of pi/7 has degree 6."""
    sheet, angles = triangle(2 * np.tan(pi / 7))
    assert shape(sheet, on_a_grid(angles, Fraction(1, 7), Fraction(1, 6))) is None


@pytest.mark.parametrize(
    ("terms", "parts", "true"),
    [
        ((((0, 1), 1),), 1, True),
        ((((0, 2), 1),), 3, True),
        ((((0, 2), 1),), 2, False),
        ((((0, 2), 1), ((1, 2), 1)), 1, True),
        ((((0, 2), 1), ((1, 2), -1)), 1, False),
        ((((0, 2), 1), ((1, 2), -1)), 3, True),
        ((((0, 2), 3),), 1, True),
        ((((0, 2), -2),), 1, False),
    ],
)
def test_a_relation_is_checked_exactly(
    terms: tuple[tuple[Edge, int], ...], parts: int, true: bool
) -> None:
    field = RATIONALS.adjoined(3)
    points = [(field.number(x), field.number(y)) for x, y in ((0, 0), (2, 0), (1, field.root))]
    assert holds(Relation("grid", "grid:0-2", terms, parts, 0.0), points) is true
    moved = [*points[:2], (points[2][0] + Fraction(1, 10**30), points[2][1])]
    assert holds(Relation("grid", "grid:0-2", terms, parts, 0.0), moved) is (terms[0][0] == (0, 1))


def test_relations_that_are_missed_are_not_claimed() -> None:
    sheet, angles = triangle(3.0)
    one = Relation("mirrored", "mirrored:0-2,1-2", (((0, 2), 1), ((1, 2), 1)), 1, 1e-6)
    made = recognise(sheet, angles, 1e-6, [one])
    assert made.existence == "exact", made.reason
    other = replace(one, name="parallel:0-2,1-2", terms=(((0, 2), 1), ((1, 2), -1)))
    made = recognise(sheet, angles, 1e-6, [one, other])
    assert (made.existence, made.sheet) == ("none", None)
    assert made.reason == "the positions that were recognised miss parallel:0-2,1-2"


def test_equations_that_are_singular_in_floats_give_no_positions() -> None:
    """An edge that is there twice; the drawing stays as it is, and its edges miss their angles."""
    sheet, angles = triangle(3.0)
    places = np.array(sheet.vertices, dtype=float)
    places[1, 1] += 0.1
    near = refined(places, angles, [(0, 1), (0, 1)], 1e-12)
    assert not near.exists
    assert np.allclose(near.places, places)
