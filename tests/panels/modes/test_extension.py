"""Which loop is named where a mode does not fold."""

from fractions import Fraction
from itertools import pairwise

import pytest
from panel_sheets import grid

from exactfold._support.verdict import REFUTED
from exactfold.panels.decomposition import decompose
from exactfold.panels.modes.elementary import ModeSearch
from exactfold.panels.modes.extension import Loops, extension
from exactfold.panels.vertex.stars import stars
from exactfold.panels.vertex.transmission import Transmission
from exactfold.pattern.panel_pattern import PanelPattern


def bent() -> PanelPattern:
    """Two zigzags with equal second differences and different slopes across two straight rows."""
    offsets, columns = (0, 1, 0, 3), [(0, 0), (1, 0), (1, 1), (0, 0)]

    def place(i: int, j: int) -> tuple[Fraction, Fraction]:
        moves, slope = columns[i]
        return Fraction(8 * i + moves * offsets[j] + slope * j), Fraction(4 * j)

    return grid(3, 3, place)


def renumbered(pattern: PanelPattern, first: int) -> PanelPattern:
    """The same sheet with new vertices on one boundary edge before all others."""
    (a, b), *_ = pattern.boundary_edges
    (ax, ay), (bx, by) = pattern.vertices[a], pattern.vertices[b]
    steps = [Fraction(k + 1, first + 1) for k in range(first)]
    added = [(ax + (bx - ax) * t, ay + (by - ay) * t) for t in steps]
    chain = [a + first, *range(first), b + first]
    edges = [(i + first, j + first) for i, j in pattern.edges if (i, j) != (a, b)]
    edges += list(pairwise(chain))
    return PanelPattern([*added, *pattern.vertices], edges)


def test_the_loop_named_is_one_of_the_mode_also_if_its_shape_was_seen_before() -> None:
    known: Loops = {}
    for first in (0, 3):
        pattern = renumbered(bent(), first)
        moving = stars(pattern)
        search = ModeSearch(moving, pattern.field)
        modes = [mode for support in search.supports(100) for mode in search.listed(support)]
        found = [extension(pattern, moving, mode.choice, known) for mode in modes]
        [refuted] = [result for result in found if result.verdict is REFUTED]
        assert set(refuted.cycle) == {v + first for v in (5, 6, 9, 10)}
        assert "-".join(map(str, refuted.cycle)) in refuted.by
        assert refuted.order == 3
    assert len(known) == 1  # the shape is shared, or the second sheet would show nothing


def test_the_listed_modes_name_their_own_loops() -> None:
    for mode in decompose(bent()).modes:
        assert set(mode.extends.cycle) <= set(mode.active)


TWO = (
    "0,0 6,0 5,1/2 2,1/2 -1,-1/2 6,-1 7,3/2 5,1 19/4,1 17/8,1 2,1 1,3/4",
    [(0, 4), (0, 11), (1, 5), (1, 6), (2, 7), (2, 8), (3, 9), (3, 10)],
)
THREE = (
    "0,0 6,0 9/2,1 3,3/2 -1/4,1/10 1/10,-1/20 121/20,-1/20 117/20,1/4 89/20,23/20 17/4,11/8 "
    "27/10,37/20 11/4,7/4",
    [(0, 4), (0, 5), (1, 6), (1, 7), (2, 8), (2, 9), (3, 10), (3, 11)],
)


@pytest.mark.parametrize(
    ("sheet", "nonlinear", "orders"), [(TWO, 2, [3, 3, 5]), (THREE, 3, [9])], ids=["two", "three"]
)
def test_the_order_bound_is_sharp(
    sheet: tuple[str, list[tuple[int, int]]], nonlinear: int, orders: list[int]
) -> None:
    """Loops that close up to the order 2^k and fail at 2^k + 1 (docs/panels.md, Order bound)."""
    points, outer = sheet
    border = [(4 + k, 4 + (k + 1) % 8) for k in range(8)]
    vertices = [tuple(map(Fraction, point.split(","))) for point in points.split()]
    pattern = PanelPattern(vertices, [(0, 1), (1, 2), (2, 3), (3, 0), *border, *outer])
    modes = decompose(pattern).modes
    assert all(mode.extends.verdict is REFUTED for mode in modes)
    assert sorted(mode.extends.order for mode in modes) == orders
    assert orders[-1] == 2**nonlinear + 1
    [last] = [mode for mode in modes if mode.extends.order == orders[-1]]
    moving, linear = stars(pattern), []
    for local in last.choice:
        before, after = (fold for fold in local.folds if max(fold) < 4)
        linear.append(Transmission(moving[local.vertex], local, before, after).is_linear)
    assert sorted(linear) == [False] * nonlinear + [True] * (4 - nonlinear)
