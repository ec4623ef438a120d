"""The complete decompositions of known sheets, by two ways that share little."""

import random
from collections import Counter
from fractions import Fraction

import networkx as nx
import numpy as np
import pytest
from panel_sheets import grid, mesh, miura, outlined, tiling

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.panels.decomposition import decompose
from exactfold.panels.modes.elementary import ModeSearch
from exactfold.panels.modes.extension import cycle_basis
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels
from exactfold.pattern.panel_pattern import PanelPattern


def by_spaces(pattern: PanelPattern) -> dict[int | None, int]:
    moving = stars(pattern)
    rows, size = first_order(moving)
    return dict(Counter(leaf.dimension for leaf in leaves(moving, rows, size, 10**6)))


@pytest.mark.parametrize("zigzags", [1, 2, 3, 4])
@pytest.mark.parametrize("rows", [1, 2, 3])
def test_miura(rows: int, zigzags: int) -> None:
    known = {1: 2**zigzags} if rows == 1 else {1: 2**zigzags - 1, rows: 1}
    pattern = miura(rows, zigzags)
    result = decompose(pattern)
    assert result.status is PROVED
    assert result.second_order == result.true == known
    assert result.rigid is REFUTED
    assert by_spaces(pattern) == known


@pytest.mark.parametrize("count", [1, 2, 20])
def test_a_strip_in_general_position_has_two_modes_a_vertex(count: int) -> None:
    result = decompose(mesh(1, count, seed=count))
    assert result.second_order == result.true == {1: 2**count}
    assert result.modes_count == 2**count
    assert len(result.modes) == (2**count if count < 10 else 0)


@pytest.mark.parametrize(("columns", "rows"), [(2, 2), (3, 2), (20, 20)])
def test_a_mesh_in_general_position_is_rigid(columns: int, rows: int) -> None:
    result = decompose(mesh(columns, rows, seed=5))
    assert result.second_order == result.true == {0: 1}
    assert result.rigid is PROVED
    assert result.modes == ()


@pytest.mark.parametrize("size", [2, 4])
def test_a_tiling_by_any_quadrilateral_folds_in_two_ways(size: int) -> None:
    pattern = tiling(size, size)
    result = decompose(pattern)
    assert result.second_order == result.true == {1: 2}
    assert {mode.extends.by for mode in result.modes} == {"loops to order 17"}
    if size == 2:
        assert by_spaces(pattern) == {1: 2}


def test_every_mode_solves_the_conditions_exactly() -> None:
    pattern = mesh(1, 3, seed=9)
    moving = stars(pattern)
    search = ModeSearch(moving, pattern.field)
    [support] = search.supports(10)
    modes = search.listed(support)
    assert len(modes) == support.count == 8
    assert len({tuple(mode.signs.values()) for mode in modes}) > 1
    for mode in modes:
        for local in mode.choice:
            star = moving[local.vertex]
            values = dict(zip(local.folds, local.values, strict=True))
            w = [values.get(edge, 0) for edge in star.folds]
            assert star.form(w) == 0
            for axis in (0, 1):
                assert sum(x * d[axis] for x, d in zip(w, star.directions, strict=True)) == 0


def test_folds_from_border_to_border_add_a_dimension() -> None:
    square = PanelPattern(
        [(0, 0), (3, 0), (3, 3), (0, 3), (1, 0), (1, 3)],
        [(0, 4), (4, 1), (1, 2), (2, 5), (5, 3), (3, 0), (4, 5)],
    )
    result = decompose(square)
    assert result.free == ((4, 5),)
    assert result.second_order == result.true == {1: 1}
    held = decompose(square, flat=[(4, 5)])
    assert held.second_order == {0: 1}
    assert held.rigid is PROVED


def test_independent_lines_cross() -> None:
    """Two lines each way: either both of one direction fold, or both of the other."""
    result = decompose(grid(3, 3, lambda i, j: (i, j)))
    assert result.second_order == result.true == {2: 2}


@pytest.mark.parametrize("seed", range(5))
def test_the_faces_of_the_active_graph_are_a_basis_of_its_loops(seed: int) -> None:
    pattern = mesh(5, 4, seed)
    inside = set(pattern.interior)
    shared = [edge for edge in pattern.folds if inside.issuperset(edge)]
    graph = nx.Graph()
    graph.add_nodes_from(inside)
    graph.add_edges_from(random.Random(seed).sample(shared, 25))
    loops = cycle_basis(pattern, graph)
    parts = nx.number_connected_components(graph)
    assert len(loops) == graph.number_of_edges() - graph.number_of_nodes() + parts > 3
    bit = {frozenset(edge): 1 << k for k, edge in enumerate(graph.edges)}
    basis: list[int] = []
    for loop in loops:
        assert len(set(loop)) == len(loop)
        mask = 0
        for side in zip(loop, (*loop[1:], loop[0]), strict=True):
            mask ^= bit[frozenset(side)]
        for other in basis:
            mask = min(mask, mask ^ other)
        assert mask != 0, "a loop is a sum of the others"
        basis.append(mask)


@pytest.mark.parametrize("folds", [5, 6, 8])
def test_one_vertex_has_one_cone_that_truly_folds(folds: int) -> None:
    result = decompose(panels(single_vertex(folds)))
    assert result.theory == "subspaces"
    assert result.second_order == result.true == {folds - 3: 1}
    assert result.rigid is REFUTED


def test_lines_where_all_conditions_are_independent_truly_fold() -> None:
    """Eight lines of a triangle with corners of five, four and four folds, and true motions.

    Newton's method finds a configuration near each line in which all vertices close.
    """
    points = [(0, 0), (8, 0), (3, 7), (-5, 2), (-6, -3), (-1, -6), (8, -7), (15, 3), (5, 8)]
    points.append((-2, 14))
    folds = [(0, 1), (1, 2), (0, 2), (0, 3), (0, 4), (0, 5), (1, 6), (1, 7), (2, 8), (2, 9)]
    sheet = outlined([(Fraction(x), Fraction(y)) for x, y in points], folds, 3)
    result = decompose(sheet)
    assert result.second_order == result.true == {1: 8}
    around = stars(sheet).values()
    order = sorted(sheet.folds)

    def gaps(tau: np.ndarray) -> np.ndarray:
        found = []
        for star in around:
            turn = np.eye(2, dtype=complex)
            for edge, (dx, dy) in zip(star.folds, star.directions, strict=True):
                x, y = (float(c) * tau[order.index(edge)] for c in (dx, dy))
                turn = turn @ np.array([[1, y + 1j * x], [-y + 1j * x, 1]])
            found += [turn[0, 0].imag, turn[0, 1].real, turn[0, 1].imag]
        return np.array(found)

    for leaf in result.parts[0].spaces:
        row = np.array([float(leaf.rows.get(edge, [0])[0]) for edge in order])
        start = 0.01 * row / abs(row).max() / 5
        tau = start.copy()
        for _ in range(20):
            steps = 1e-7 * np.eye(len(order))
            slopes = np.array([(gaps(tau + s) - gaps(tau - s)) / 2e-7 for s in steps]).T
            slopes = np.vstack([slopes, row])  # the amplitude stays
            tau = tau - np.linalg.lstsq(slopes, np.append(gaps(tau), 0), rcond=None)[0]
        assert abs(gaps(tau)).max() < 1e-13
        assert abs(tau - start).max() < abs(start).max() / 20
