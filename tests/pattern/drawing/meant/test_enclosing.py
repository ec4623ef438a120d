"""Enclosed positions of sheets whose edges have exact directions."""

from __future__ import annotations

import pickle
from fractions import Fraction

import numpy as np
import pytest
from noisy_sheets import angles_of, with_noise
from panel_sheets import chicken_wire, mesh, miura, regular_twist

from exactfold.errors import MalformedPatternError, NotApplicableError
from exactfold.motion.panels.places import Placing
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.drawing.meant.directions import Directions
from exactfold.pattern.drawing.meant.enclosing import DEPENDENT, Enclosed, enclosed, keeps_faces
from exactfold.pattern.drawing.meant.left import left_relations
from exactfold.pattern.drawing.meant.positions import placed_together
from exactfold.pattern.drawing.meant.values import Angles, Edge
from exactfold.pattern.meant_sheet import certificate, enclose, realize
from exactfold.pattern.panel_pattern import EnclosedPattern, PanelPattern

SQUARE: list[Edge] = [(0, 1), (1, 2), (2, 3), (0, 3)]
CORNERS = [(Fraction(x), Fraction(y)) for x, y in ((0, 0), (8, 1), (9, 5), (1, 6))]


def with_free_sides(turn: float) -> Angles:
    """The angles of the four sides of a quadrangle; one is turned away from the drawing."""
    values = [np.arctan2(1, 8), np.arctan2(4, 1), np.arctan2(1, -8) + turn, np.arctan2(6, 1)]
    terms = {edge: ((k, Fraction(1)),) for k, edge in enumerate(SQUARE)}
    return Angles(dict.fromkeys(SQUARE, Fraction(0)), terms, tuple(map(float, values)))


def enclosed_copy(sheet: PanelPattern, digits: int = 12) -> EnclosedPattern:
    """A sheet with its exact directions, at twice their length, and rounded positions."""
    size = max(max(axis) - min(axis) for axis in zip(*sheet.vertices, strict=True))
    radius = Fraction(float(size) / 10**9)
    points = [
        (round(Fraction(float(x)), digits), round(Fraction(float(y)), digits))
        for x, y in sheet.vertices
    ]
    vectors = {(i, j): sheet.direction(i, j) for i, j in sheet.edges}
    return EnclosedPattern(
        points, sheet.edges, {e: (2 * x, 2 * y) for e, (x, y) in vectors.items()}, radius
    )


def test_a_box_contains_the_exact_positions() -> None:
    angles = with_free_sides(1e-5)
    places = np.array(CORNERS, dtype=float)
    directions = Directions(angles, angles.free, 1e-6)
    box = enclosed(places, directions, SQUARE, 1e-4)
    exact = placed_together(CORNERS, places, directions, {e: e for e in SQUARE}, 1e-4)
    assert isinstance(box, Enclosed)
    assert not isinstance(exact, str)
    assert 0 < box.radius < Fraction(1, 10**20)
    moved = 0
    for (x, y), (a, b), corner in zip(exact, box.points, CORNERS, strict=True):
        off = (x - a) * (x - a) + (y - b) * (y - b)
        assert off <= box.radius**2
        moved += (x, y) != corner
    assert moved


def test_dependent_directions_are_not_enclosed() -> None:
    """The directions of all edges round an inner vertex fit only if the product of sines does."""
    points = [*CORNERS, (Fraction(4), Fraction(3))]
    edges = [*SQUARE, (0, 4), (1, 4), (2, 4), (3, 4)]
    places = np.array(points, dtype=float)
    values = [float(np.arctan2(*(places[j] - places[i])[::-1])) for i, j in edges]
    terms = {edge: ((k, Fraction(1)),) for k, edge in enumerate(edges)}
    angles = Angles(dict.fromkeys(edges, Fraction(0)), terms, tuple(values))
    directions = Directions(angles, angles.free, 1e-6)
    assert enclosed(places, directions, edges, 1e-6) == DEPENDENT


@pytest.mark.parametrize(("radius", "kept"), [(Fraction(1, 10), True), (Fraction(1, 2), False)])
def test_a_vertex_must_not_come_to_an_edge_of_its_face(radius: Fraction, kept: bool) -> None:
    """Vertex 3 is at the distance 1 from the edges at vertex 1, which is at most twice 1/2."""
    arrow = [(Fraction(x), Fraction(y)) for x, y in ((0, 0), (10, 0), (10, 10), (9, 1))]
    assert keeps_faces(arrow, [SQUARE], radius) is kept
    assert keeps_faces(arrow, [], radius)  # vertices of different faces do not meet first


@pytest.mark.parametrize("sheet", [mesh(3, 3, 1), chicken_wire(2, 2), miura(3, 4)])
def test_ways_depend_on_directions_alone(sheet: PanelPattern) -> None:
    exact, boxed = decompose(sheet), decompose(enclosed_copy(sheet))
    assert boxed.status is exact.status
    assert boxed.second_order == exact.second_order
    assert [m.assignment for m in boxed.modes] == [m.assignment for m in exact.modes]


def test_a_sheet_whose_positions_are_enclosed() -> None:
    sheet = enclosed_copy(mesh(2, 2, 1))
    exact = mesh(2, 2, 1)
    assert sheet.direction(0, 1) == tuple(2 * c for c in exact.direction(0, 1))
    assert sheet.direction(1, 0) == tuple(2 * c for c in exact.direction(1, 0))
    again = pickle.loads(pickle.dumps(sheet))
    assert again == sheet
    assert again.sha256 == sheet.sha256
    i, j = sheet.folds[0]
    (x, y) = sheet.directions[i, j]
    other = EnclosedPattern(
        sheet.vertices, sheet.edges, {**sheet.directions, (i, j): (x, y + 1)}, sheet.radius
    )
    assert other.sha256 != sheet.sha256
    assert other != sheet
    with pytest.raises(MalformedPatternError, match=f"fold {i}-{j} has no direction"):
        EnclosedPattern(sheet.vertices, sheet.edges, {}, sheet.radius)


def test_rounded_positions_make_no_relation_of_exact_directions_near() -> None:
    sheet = regular_twist(6, (Fraction(3), Fraction(-7)))
    rounded = enclosed_copy(sheet, 6)
    assert left_relations(sheet) == left_relations(rounded) == ()
    assert left_relations(PanelPattern(rounded.vertices, rounded.edges))


def test_nothing_exact_is_said_of_enclosed_positions() -> None:
    sheet = enclosed_copy(mesh(2, 2, 1))
    with pytest.raises(NotApplicableError, match="they are known only within"):
        certificate_of_panels(decompose(sheet))
    with pytest.raises(NotApplicableError, match="they are known only within"):
        Placing(sheet, 0).exactly({})


@pytest.mark.parametrize("noise", [1e-9, 1e-6])
def test_the_enclosed_sheet_is_like_the_exact_one(noise: float) -> None:
    drawn = with_noise(chicken_wire(2, 2), noise)
    angles = angles_of(chicken_wire(2, 2), 1)
    exact, boxed = realize(drawn, angles, noise), enclose(drawn, angles, noise)
    assert exact.existence == "exact"
    assert boxed.existence == "box", boxed.reason
    assert isinstance(boxed.sheet, EnclosedPattern)
    assert exact.sheet is not None
    assert boxed.distance < 10 * noise
    assert boxed.sheet.faces == exact.sheet.faces
    assert decompose(boxed.sheet).second_order == decompose(exact.sheet).second_order
    flat = [e for e, c in angles.constants.items() if not c and e not in angles.coefficients]
    assert flat
    assert all(boxed.sheet.direction(*edge)[1] == 0 for edge in flat)
    with pytest.raises(NotApplicableError, match="positions"):
        certificate(boxed, [])
