"""How the checker draws a sheet of panels: edges that meet and folds that may fold, one by one."""

from __future__ import annotations

from itertools import combinations

import pytest

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.core.towers import Tower
from exactfold.checker.sheets.panels import PanelSheet, pair

RATIONAL = Tower()
Point = tuple[int, int]


def drawn(points: list[Point], edges: list[tuple[int, int]]) -> PanelSheet:
    """The points and edges, of which nothing is verified."""
    sheet = object.__new__(PanelSheet)
    sheet.tower = RATIONAL
    sheet.points = [(RATIONAL.number(x), RATIONAL.number(y)) for x, y in points]
    sheet.edges = edges
    return sheet


def common(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Whether a point of ab at k / 840 of its length lies on cd, ends that both have left out.

    840 is a multiple of all denominators that crossings of lines in these grids have.
    """
    ends = {a, b} & {c, d}
    for k in range(841):
        x, y = (840 * p + k * (q - p) for p, q in zip(a, b, strict=True))
        if any((x, y) == (840 * p, 840 * q) for p, q in ends):
            continue
        cross = (d[0] - c[0]) * (y - 840 * c[1]) - (d[1] - c[1]) * (x - 840 * c[0])
        within = [
            min(p, q) * 840 <= z <= max(p, q) * 840 for z, p, q in zip((x, y), c, d, strict=True)
        ]
        if cross == 0 and all(within):
            return True
    return False


def check_apart(sheet: PanelSheet, shared: set[int]) -> None:
    """Edges with a common end are compared where they are put in order round it."""
    sheet._check_apart()
    for v in shared:
        sheet._turned(v, [u for edge in sheet.edges for u in edge if u != v])


@pytest.mark.parametrize(("columns", "rows"), [pytest.param(3, 3, marks=pytest.mark.slow), (4, 2)])
def test_all_pairs_of_edges_of_a_small_grid(columns: int, rows: int) -> None:
    points = [(x, y) for x in range(columns) for y in range(rows)]
    edges = list(combinations(range(columns * rows), 2))
    sheet = drawn(points, edges)
    meeting = 0
    for first, second in combinations(edges, 2):
        sheet.edges = [first, second]
        shared = {*first} & {*second}
        if not shared:
            assert sheet._meet(first, second) == sheet._meet(second, first)
        if common(*(points[v] for v in (*first, *second))):
            meeting += 1
            with pytest.raises(CertificateError, match=r"^edges \d-\d and \d-\d meet$"):
                check_apart(sheet, shared)
        else:
            check_apart(sheet, shared)
    assert 50 < meeting < len(edges) ** 2 / 4


@pytest.mark.parametrize(
    ("around", "kept"),
    [
        ([(1, 0)], []),
        ([(1, 0), (-2, 0)], [1, 2]),
        ([(1, 0), (-2, 1)], []),
        ([(1, 0), (-1, 2), (-1, -2)], []),
        ([(1, 0), (1, 1), (-2, 0)], [1, 3]),
        ([(1, 0), (0, 1), (-1, 0), (0, -1)], [1, 2, 3, 4]),
        ([(1, 0), (1, 1), (0, 1), (-1, 0)], [1, 4]),
        ([(1, 0), (1, 1), (0, 1), (-1, 1)], []),
        ([(2, 0), (1, 2), (-2, 1), (-2, -2), (1, -2)], [1, 2, 3, 4, 5]),
    ],
)
def test_folds_that_may_fold(around: list[Point], kept: list[int]) -> None:
    sheet = drawn([(0, 0), *around], [(0, k + 1) for k in range(len(around))])
    assert sheet.foldable(0, list(range(1, len(around) + 1))) == kept


@pytest.mark.parametrize("edge", [(1, 1), (2, 1), (1, 4)])
def test_edges_have_two_points(edge: tuple[int, int]) -> None:
    points = [(RATIONAL.number(x), RATIONAL.number(y)) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
    with pytest.raises(CertificateError, match=f"^{edge[0]}-{edge[1]} is not an edge$"):
        PanelSheet(RATIONAL, points, [edge])


def test_a_small_sheet_is_one_all_the_same() -> None:
    small = RATIONAL.number(1) / RATIONAL.number(1000)
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    points = [(small * RATIONAL.number(x), small * RATIONAL.number(y)) for x, y in square]
    sheet = PanelSheet(RATIONAL, points, [(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)])
    assert sorted(map(sorted, sheet.panels)) == [[0, 1, 2], [0, 2, 3]]
    assert (sheet.folds, sheet.interior) == ([pair(2, 0)], [])


def test_two_vertices_in_one_place_meet() -> None:
    sheet = drawn([(0, 0), (1, 0), (1, 0), (2, 0)], [(0, 1), (2, 3)])
    assert sheet._meet((0, 1), (2, 3))
    assert sheet._meet((2, 3), (0, 1))
