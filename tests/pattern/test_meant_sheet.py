"""Exact sheets near drawings with noise, whose angles are given."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from math import atan2

import pytest
from flint import arb, ctx
from noisy_sheets import angles_of, with_noise
from panel_sheets import chicken_wire, mesh, miura, tiling
from sampling import slow_after

from exactfold import checker
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.surds import RATIONALS, ball
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.pattern.drawing.meant import positions
from exactfold.pattern.drawing.meant.inference import infer
from exactfold.pattern.drawing.meant.values import Angles, Edge
from exactfold.pattern.meant import Meant
from exactfold.pattern.meant_sheet import Realized, _distance, certificate, realize
from exactfold.pattern.opening import open_pattern, panels
from exactfold.pattern.panel_pattern import PanelPattern

SQUARE = [(0, 1), (1, 2), (2, 3), (0, 3)]


def example(name: str) -> PanelPattern:
    sheet = open_pattern(example_path(name)).sheet
    return panels(sheet) if isinstance(sheet, CreasePattern) else sheet


def off_grid(sheet: PanelPattern, edge: Edge, constant: Fraction) -> arb:
    """A ball of 200 bits round the sine of the angle between an edge and a multiple of pi."""
    before, ctx.prec = ctx.prec, 200
    try:
        (ax, ay), (bx, by) = (sheet.vertices[v] for v in edge)
        turn = arb(constant.numerator) / constant.denominator
        x, y = ball(bx - ax, 400), ball(by - ay, 400)
        return (x * turn.sin_pi() - y * turn.cos_pi()) / (x * x + y * y).sqrt()
    finally:
        ctx.prec = before


def check_exact(made: Realized, angles: Angles, noise: float) -> PanelPattern:
    """All edges have their angles exactly, and no point is far from where it was drawn."""
    assert made.existence == "exact", made.reason
    sheet = made.sheet
    assert sheet is not None
    along: dict[tuple[tuple[int, Fraction], ...], list[Edge]] = {}
    for edge, constant in angles.constants.items():
        terms = angles.coefficients.get(edge, ())
        along.setdefault(terms, []).append(edge)
        if not terms:
            sine = off_grid(sheet, edge, constant)
            assert sine.contains(0)
            assert sine.rad() < 1e-50
    for terms, edges in along.items():
        for one, other in pairwise(edges if terms else ()):
            (ax, ay), (bx, by) = (difference(sheet, edge) for edge in (one, other))
            assert ax * by - ay * bx == 0
    size = max(max(axis) - min(axis) for axis in zip(*made.drawn.vertices, strict=True))
    for (x, y), (a, b) in zip(sheet.vertices, made.drawn.vertices, strict=True):
        moved = ball((x - a) * (x - a) + (y - b) * (y - b), 200)
        assert moved <= ball((made.distance * size) ** 2, 200)
    assert made.distance < 3 * noise
    return sheet


def difference(sheet: PanelPattern, edge: Edge) -> tuple[object, object]:
    (ax, ay), (bx, by) = (sheet.vertices[v] for v in edge)
    return bx - ax, by - ay


@pytest.mark.parametrize("noise", [1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize(
    "sheet",
    [
        lambda: miura(4, 5),
        lambda: tiling(3, 3),
        lambda: mesh(3, 3, 1),
        lambda: chicken_wire(3, 3),
        lambda: example("bird-base"),
        lambda: example("hypar-2"),
        lambda: example("square-twist"),
        lambda: example("flapping-bird"),
    ],
)
def test_noise_on_exact_sheets(sheet: Callable[[], PanelPattern], noise: float) -> None:
    angles = angles_of(sheet(), 48)
    made = realize(with_noise(sheet(), noise), angles, noise)
    found = check_exact(made, angles, noise)
    assert found.faces == sheet().faces
    assert made.bits <= 120


def test_noise_below_the_last_digit_of_floats() -> None:
    angles = angles_of(miura(4, 5), 48)
    drawn = with_noise(miura(4, 5), 1e-16)
    made = realize(drawn, angles, 1e-16)
    check_exact(made, angles, 1e-15)


def test_halved_angles_and_sums() -> None:
    """A kite: its diagonal has the mean of the angles of two sides, which are free."""
    third = (Fraction("9.9"), Fraction("4.1000001"))
    points = [
        (Fraction(0), Fraction(0)),
        (Fraction(8), Fraction(1)),
        third,
        (Fraction(5), Fraction(7)),
    ]
    kite = PanelPattern(points, [*SQUARE, (0, 2)])
    half = Fraction(1, 2)
    low, high = 0.12435499454676144, 0.9505468408120751  # atan(1/8), atan(7/5)
    angles = Angles(
        {edge: Fraction(0) for edge in [(0, 1), (0, 2), (0, 3)]},
        {(0, 1): ((0, Fraction(1)),), (0, 3): ((1, Fraction(1)),), (0, 2): ((0, half), (1, half))},
        (low, high),
    )
    made = realize(kite, angles, 1e-3)
    assert made.existence == "exact"
    assert made.sheet is not None
    (ax, ay), (bx, by), (cx, cy) = (difference(made.sheet, e) for e in [(0, 1), (0, 2), (0, 3)])
    # (B^2 / (A C)) is real and positive
    re, im = bx * bx - by * by, 2 * bx * by
    u, v = ax * cx - ay * cy, ax * cy + ay * cx
    assert im * u - re * v == 0
    assert re * u + im * v > 0


# --- sheets that do not exist, or that are not the sheet that was drawn ---------------------------


def test_angles_that_no_tower_of_square_roots_holds() -> None:
    square = PanelPattern([(0, 0), (1, 0), (1, 1), (0, 1)], SQUARE)
    angles = Angles({(0, 1): Fraction(1, 9)}, {}, ())
    made = realize(square, angles, 1e-9)
    assert (made.existence, made.sheet, made.bits) == ("none", None, 0)
    assert made.reason == (
        "some angles are multiples of pi/9, and these have directions in no small tower of square "
        "roots"
    )


def test_directions_that_no_sheet_has() -> None:
    """A square with a diagonal at 45 degrees, and another diagonal that is meant at 60 degrees."""
    points = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
    drawn = PanelPattern(points, [*SQUARE, (0, 4), (1, 4), (2, 4), (3, 4)])
    angles = angles_of(drawn, 4)
    constants = {**angles.constants, (3, 4): Fraction(3, 4) + Fraction(1, 12)}
    made = realize(drawn, Angles(constants, {}, ()), 1e-3)
    assert made.existence == "none"
    assert made.reason == (
        "the exact positions do not make the sheet that was drawn: vertices 0 and 1 are at the "
        "same point"
    )


def test_positions_that_constrain_free_angles() -> None:
    """A square with a diagonal at a free angle: only one angle leads from corner to corner."""
    points = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)]
    drawn = PanelPattern(points, [*SQUARE, (0, 4), (1, 4), (2, 4), (3, 4)])
    constants = {**angles_of(drawn, 4).constants, (0, 4): Fraction(0), (2, 4): Fraction(0)}
    one = ((0, Fraction(1)),)
    angles = Angles(constants, {(0, 4): one, (2, 4): one}, (0.7853981,))
    made = realize(drawn, angles, 1e-6)
    check_exact(made, angles, 1e-6)


def test_a_sheet_that_collapses() -> None:
    """Three sides of a thin triangle, all meant to be horizontal."""
    drawn = PanelPattern([(0, 0), (2, 0), (1, Fraction(1, 1000))], [(0, 1), (1, 2), (0, 2)])
    angles = Angles({edge: Fraction(0) for edge in drawn.edges}, {}, ())
    made = realize(drawn, angles, 1e-3)
    assert made.existence == "none"
    assert made.reason == (
        "the exact positions do not make the sheet that was drawn: vertex 2, an end of edge 0-2, "
        "lies inside edge 0-1"
    )


def test_a_panel_that_turns_over() -> None:
    """A square with a narrow triangle on one side, whose tip is meant on the other side."""
    tip = (Fraction(1), Fraction(-1, 1000))
    points = [(0, 0), (2, 0), (2, 2), (0, 2), tip]
    drawn = PanelPattern(points, [*SQUARE, (0, 4), (1, 4)])
    turned = Fraction(1, 48)
    angles = Angles({**angles_of(drawn, 4).constants, (0, 4): turned, (1, 4): -turned}, {}, ())
    made = realize(drawn, angles, 1e-3)
    assert made.existence == "none"
    assert made.reason == "the exact positions turn over or break panel 0-1-2-3"


def test_irrational_coordinates_are_refused() -> None:
    sheet = example("bird-base")
    with pytest.raises(UsageError, match="irrational and already exact"):
        realize(sheet, angles_of(sheet, 8), 1e-9)


# --- free angles ---------------------------------------------------------------------------------


def fan(*slopes: tuple[int, int]) -> PanelPattern:
    """A square with folds from its centre to the boundary, one along each of the vectors."""
    tips = []
    for x, y in slopes:
        scale = Fraction(1, max(abs(x), abs(y)))
        tips.append((x * scale, y * scale))
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    ring = sorted({*corners, *tips}, key=lambda p: atan2(float(p[1]), float(p[0])))
    points = [(Fraction(0), Fraction(0)), *((Fraction(x), Fraction(y)) for x, y in ring)]
    count = len(ring)
    edges = [(k, k % count + 1) for k in range(1, count + 1)]
    spokes = [(0, k) for k, point in enumerate(points) if point in tips]
    return PanelPattern(points, [(min(e), max(e)) for e in edges] + spokes)


@pytest.mark.parametrize("noise", [1e-12, 1e-9, 1e-6])
def test_short_slopes_are_recognised(noise: float) -> None:
    """The slope 2/3 is found again, although its angle is known up to the noise only."""
    sheet = fan((3, 2), (-3, 2), (-3, -2), (3, -2))
    angles = angles_of(sheet, 4)
    off = Angles(angles.constants, angles.coefficients, tuple(t + noise / 2 for t in angles.free))
    made = realize(with_noise(sheet, noise), off, noise)
    found = check_exact(made, off, noise)
    slopes = set()
    for edge, terms in off.coefficients.items():
        assert terms
        x, y = difference(found, edge)
        slopes.add(y / x)
    assert slopes == {Fraction(2, 3), Fraction(-2, 3)}


def test_half_of_a_recognised_angle_extends_the_field() -> None:
    """A fold in the middle of the sector between the x-axis and the slope 1/2: tan = sqrt 5 - 2."""
    half = Fraction(1, 2)
    points = [(0, 0), (4, 0), (4, 4 * (5**half - 2)), (4, 2), (0, 2)]
    drawn = PanelPattern(
        [(Fraction(str(x)), Fraction(str(y))) for x, y in points],
        [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (0, 2), (0, 3)],
    )
    grid = {(0, 1): 0, (1, 2): half, (2, 3): half, (3, 4): 0, (0, 4): half, (0, 2): 0, (0, 3): 0}
    angles = Angles(
        {edge: Fraction(c) for edge, c in grid.items()},
        {(0, 3): ((0, Fraction(1)),), (0, 2): ((0, half),)},
        (atan2(1, 2),),
    )
    made = realize(drawn, angles, 1e-12)
    assert made.existence == "exact", made.reason
    assert made.sheet is not None
    x, y = difference(made.sheet, (0, 2))
    assert made.sheet.field_name == "Q(sqrt 5)"
    assert (y / x + 2) * (y / x + 2) == 5
    x, y = difference(made.sheet, (0, 3))
    assert y / x == half


# --- with the relations that a drawing shows -----------------------------------------------------

NAMES = ["bird-base", "flapping-bird", "map-fold", "miura", "square-twist", "waterbomb", "windmill"]


@pytest.mark.parametrize("noise", slow_after(1, [1e-9, 1e-12, 1e-6]))
@pytest.mark.parametrize("name", NAMES)
def test_inferred_relations_have_a_sheet_and_a_certificate(name: str, noise: float) -> None:
    """The certificate holds every relation under the name that the inference gives it."""
    sheet = example(name)
    drawn = with_noise(sheet, noise)
    found = infer(drawn.vertices, drawn.edges, drawn.boundary_edges)
    assert found.angles is not None, found.reason
    made = realize(drawn, found.angles, found.noise)
    assert made.existence == "exact", made.reason
    assert made.distance < 10 * noise
    assert made.bits < 150
    claims = checker.check(checker.load(json.dumps(certificate(made, found.relations))))
    assert [entry["name"] for entry in claims["relations"]] == [r.name for r in found.relations]
    assert len(claims["relations"]) >= len(sheet.interior)


def test_no_certificate_without_a_sheet() -> None:
    square = PanelPattern([(0, 0), (1, 0), (1, 1), (0, 1)], SQUARE)
    made = realize(square, Angles({(0, 1): Fraction(1, 9)}, {}, ()), 1e-9)
    with pytest.raises(NotApplicableError, match="no exact sheet was found: some angles are"):
        certificate(made, [])


@pytest.mark.parametrize(("digits", "fits"), [(3000, True), (6000, False)])
def test_a_certificate_that_the_checker_would_not_take(digits: int, fits: bool) -> None:
    """The checker takes coordinates with 6000 digits, but only a few of them."""
    long = Fraction(10**digits + 1, 10**digits + 3)
    square = PanelPattern([(0, 0), (long, 0), (long, long), (0, long)], SQUARE)
    made = Realized(square, square, Fraction(0), "exact", "")
    if fits:
        checker.check(checker.load(json.dumps(certificate(made, []))))
    else:
        with pytest.raises(NotApplicableError, match="numbers of 19932 bits"):
            certificate(made, [])


def test_numbers_that_become_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = with_noise(tiling(3, 3), 1e-9)
    angles = angles_of(tiling(3, 3), 4)
    assert realize(drawn, angles, 1e-9).bits > 50
    monkeypatch.setattr(positions, "_MOST_BITS", 40)
    made = realize(drawn, angles, 1e-9)
    assert (made.existence, made.sheet) == ("none", None)
    assert made.reason == positions.TOO_LONG


def test_the_distance_is_an_exact_bound() -> None:
    """Floats take a move of 1e-400 for none, and the digits of a longer one are rounded up."""
    written = ((Fraction(0), Fraction(0)), (Fraction(1), Fraction(0)))
    for move in (Fraction(1, 10**400), Fraction(1, 3), Fraction(2, 7 * 10**9)):
        points = [
            (RATIONALS.number(move), RATIONALS.number(0)),
            (RATIONALS.number(1), RATIONALS.number(0)),
        ]
        assert move <= _distance(written, points)
    still = [(RATIONALS.number(x), RATIONALS.number(y)) for x, y in written]
    assert _distance(written, still) == 0


def test_the_distance_is_shown_rounded_up() -> None:
    assert Meant(distance=6.84e-13, existence="exact").name.startswith(
        "the sheet that was meant, within 6.9e-13"
    )
