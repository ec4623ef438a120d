"""Counts that are known, on sheets with rational coordinates and in Q(sqrt 3)."""

from fractions import Fraction
from itertools import pairwise

import pytest
from panel_sheets import chicken_wire, grid, outlined, regular_twist, shifted_columns, twist

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point


def turned(point: Point) -> Point:
    """Clockwise by the angle with cosine 3/5, and twice as long."""
    x, y = point
    return Fraction(2, 5) * (3 * x + 4 * y), Fraction(2, 5) * (3 * y - 4 * x)


def polygon_twist(*corners: tuple[int, int]) -> PanelPattern:
    """The twist of a polygon with each pleat at one angle to its side: all vertices flat-fold."""
    points = [(Fraction(x), Fraction(y)) for x, y in corners]
    sides = [(b[0] - a[0], b[1] - a[1]) for a, b in pairwise([*points, points[0]])]
    return twist(points, [turned(side) for side in sides])


TWISTS = {
    "square, 45 degrees": (regular_twist(4, (Fraction(6), Fraction(-6))), {1: 6}),
    "square": (regular_twist(4, (Fraction(3), Fraction(-7))), {1: 6}),
    "square, inward": (regular_twist(4, (Fraction(-2), Fraction(-7))), {1: 6}),
    "triangle": (regular_twist(3, (Fraction(3), Fraction(-7))), {0: 1}),
    "triangle, upright pleat": (regular_twist(3, (Fraction(0), Fraction(-7))), {0: 1}),
    "hexagon": (regular_twist(6, (Fraction(3), Fraction(-7))), {0: 1}),
    "parallelogram": (polygon_twist((0, 0), (4, 0), (5, 3), (1, 3)), {1: 6}),
    "isosceles trapezoid": (polygon_twist((0, 0), (4, 0), (3, 3), (1, 3)), {1: 6}),
    "general quadrilateral": (polygon_twist((0, 0), (4, 0), (5, 4), (-1, 2)), {0: 1}),
}


@pytest.mark.parametrize("name", TWISTS)
def test_twists(name: str) -> None:
    """Square twists fold in six ways of one parameter, triangle and hexagon twists not at all."""
    pattern, known = TWISTS[name]
    result = decompose(pattern)
    assert result.status is PROVED
    assert result.second_order == result.true == known
    assert result.rigid is (PROVED if known == {0: 1} else REFUTED)
    if name.startswith(("triangle", "hexagon")):
        assert pattern.field.dimension == 2
    for mode in result.modes:
        assert mode.extends.by == "linear transmissions"  # all vertices can be folded flat


def test_the_classic_square_twist_does_not_fold_rigidly() -> None:
    """12 of the 16 assignments fold; among the others are those of equal letters on the square."""
    result = decompose(regular_twist(4, (Fraction(3), Fraction(-7))))
    square = [(0, 1), (1, 2), (2, 3), (0, 3)]
    letters = {"".join(mode.assignment[edge] for edge in square) for mode in result.modes}
    letters |= {text.translate(str.maketrans("MV", "VM")) for text in letters}
    assert len(letters) == 12
    assert not letters & {"MMMM", "VVVV", "MVMV", "VMVM"}


def test_hexagonal_chicken_wire_is_rigid() -> None:
    pattern = chicken_wire(4, 4)
    result = decompose(pattern)
    assert len(pattern.interior) > 10
    assert result.second_order == {0: 1}
    assert result.rigid is PROVED
    assert not result.parts  # the flat closure takes all folds away


@pytest.mark.parametrize(("shift", "true"), [(0, {1: 3, 2: 1}), (1, {1: 2, 2: 1})])
def test_second_order_is_not_enough(shift: int, true: dict[int, int]) -> None:
    """Two zigzags with equal bends fold together truly only if they are parallel."""
    result = decompose(shifted_columns(shift))
    assert result.second_order == {1: 3, 2: 1}
    assert result.true == true
    failing = [mode.extends for mode in result.modes if mode.extends.verdict is REFUTED]
    assert [extends.order for extends in failing] == ([3] if shift else [])


def test_zigzags_that_alternate_fold_together_at_any_slope() -> None:
    def alternating(i: int, j: int) -> Point:
        return Fraction(10 * i + (0, 2, 3, 5)[j] + i * j), Fraction(4 * j)

    result = decompose(grid(3, 3, alternating))
    assert result.second_order == result.true == {1: 3, 2: 1}


def test_a_mesh_of_parallelograms_folds_in_four_ways() -> None:
    """Sums of two polygons: opposite sides of a panel see equal vertices (Kokotsakis)."""
    across = ((0, 0), (5, 1), (9, -1), (15, 1))
    up = ((0, 0), (1, 5), (-1, 9), (0, 14))

    def place(i: int, j: int) -> Point:
        return Fraction(across[i][0] + up[j][0]), Fraction(across[i][1] + up[j][1])

    result = decompose(grid(3, 3, place))
    assert result.second_order == result.true == {1: 4}
    assert {mode.extends.by for mode in result.modes} == {"loops to order 17"}


def test_lines_on_a_cone_are_no_components() -> None:
    """A vertex with five folds at the end of a straight row: the row may fold or stay flat."""
    points = [(0, 0), (4, 0), (-1, 3), (5, 4), (12, 0), (5, -4), (11, -4), (16, -1), (16, 3)]
    points += [(11, 4), (9, 6), (6, 9), (1, 8), (-4, 4), (-4, 0), (-1, -4)]
    folds: list[Edge] = [(0, 1), (0, 2), (1, 3), (2, 3), (1, 4), (0, 14), (0, 15), (1, 5)]
    folds += [(2, 12), (2, 13), (3, 10), (3, 11), (4, 6), (4, 7), (4, 8), (4, 9)]
    sheet = outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, 5)
    assert decompose(sheet).second_order == {2: 1}
    assert decompose(sheet, flat=[(1, 4)]).second_order == {1: 2}
