"""The order of elimination of large sheets."""

import numpy as np
import pytest
from scipy.sparse import csc_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu
from scipy.spatial import Delaunay

from exactfold.branches.counting.find import BranchFinder
from exactfold.pattern.triangulating.random_squares import sample_random_square
from exactfold.solve.numeric import nested_dissection as module
from exactfold.solve.numeric import sparse_sheet
from exactfold.solve.numeric.nested_dissection import nested_dissection


def _grid(side: int) -> tuple[np.ndarray, np.ndarray]:
    """The places and the edges of a triangulated grid of side x side vertices."""
    name = np.arange(side * side).reshape(side, side)
    pairs = [(name[1:], name[:-1]), (name[:, 1:], name[:, :-1]), (name[1:, 1:], name[:-1, :-1])]
    ends = np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in pairs])
    return np.stack(np.divmod(name.ravel(), side), axis=1).astype(float), ends


def _border(side: int) -> np.ndarray:
    x, y = np.divmod(np.arange(side * side), side)
    return np.asarray((np.minimum(x, y) == 0) | (np.maximum(x, y) == side - 1))


def _ordered(side: int) -> np.ndarray:
    return nested_dissection(*_grid(side), _border(side))


def _entries(order: np.ndarray, ends: np.ndarray) -> int:
    """The entries of the factors of a matrix on these edges, eliminated in this order."""
    n = len(order)
    place = np.argsort(order)[ends]
    rows = np.concatenate([place[:, 0], place[:, 1], np.arange(n)])
    columns = np.concatenate([place[:, 1], place[:, 0], np.arange(n)])
    values = np.where(rows == columns, 10.0, 1.0)
    matrix = csc_matrix((values, (rows, columns)), shape=(n, n))
    options = {"SymmetricMode": True}
    return splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options).nnz


def test_factors_on_a_grid_grow_by_little_more_than_the_grid() -> None:
    """O(n log n) entries; row by row there are n^(3/2)."""
    entries = {side: _entries(_ordered(side), _grid(side)[1]) for side in (30, 90)}
    by_rows = {side: _entries(np.arange(side * side), _grid(side)[1]) for side in (30, 90)}
    assert entries[90] < 15 * entries[30]
    assert by_rows[90] > 20 * by_rows[30]
    assert entries[90] < by_rows[90] / 3


@pytest.mark.parametrize("count", [0, 1, 7, 8, 9, 100, 1001])
def test_every_vertex_has_one_place_in_the_order(count: int) -> None:
    places = np.random.default_rng(count).random((count, 2)).round(1)  # many share a line
    ends = np.random.default_rng(1).integers(0, max(count, 1), (3 * count, 2))
    border = np.random.default_rng(2).random(count) < 0.2
    assert sorted(nested_dissection(places, ends, border)) == list(range(count))


def test_ends_of_an_edge_are_in_one_half_or_one_of_them_is_a_separator() -> None:
    """The first separator comes last; without it no edge joins the two halves before it."""
    places, ends = _grid(20)
    order = _ordered(20)
    last = order[-20:]
    assert len(set(places[last, 0])) == 1  # a straight line of 20 vertices
    left = places[:, 0] < places[last[0], 0]
    right = places[:, 0] > places[last[0], 0]
    assert not (left[ends[:, 0]] & right[ends[:, 1]]).any()
    assert not (right[ends[:, 0]] & left[ends[:, 1]]).any()


def _scattered(side: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The places, the edges and the border of a mesh of scattered vertices in a square."""
    places = np.random.default_rng(5).random((side * side, 2)) * side
    border = np.arange(side * side) < 4 * side
    for k in range(4):
        places[k * side : (k + 1) * side, k % 2] = side * (k // 2)
    mesh = Delaunay(places).simplices
    pairs = np.sort(np.concatenate([mesh[:, :2], mesh[:, 1:], mesh[:, ::2]]), axis=1)
    return places, np.unique(pairs, axis=0), border


def test_shortest_paths_leave_fewer_entries_than_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    places, ends, border = _scattered(60)
    entries = [_entries(nested_dissection(places, ends, border), ends)]
    entries.append(_entries(nested_dissection(places, ends, np.zeros_like(border)), ends))
    monkeypatch.setattr(module, "_LEAST_WITH_PATH", 60 * 60)
    entries.append(_entries(nested_dissection(places, ends, border), ends))
    assert entries[0] < 0.9 * entries[2]
    assert entries[0] < entries[1]  # then paths begin and end beside separators only


def test_a_path_separates_the_halves() -> None:
    """The vertices after both halves in the order are a path from border to border."""
    places, ends, border = _scattered(30)
    part = np.zeros(len(places), dtype=np.int64)
    parts = module._Parts.of(places, ends, part, 1)
    path, half = parts.paths(border)
    line, _ = parts.lines()
    assert 0 < path.sum() < line.sum()
    kept = ~path[ends].any(axis=1)
    assert (half[ends[kept, 0]] == half[ends[kept, 1]]).all()
    assert parts.better(path, half, line).all()
    assert (border & path).sum() >= 2
    # Of several shortest paths the order may end with another one.
    last = np.isin(np.arange(len(places)), nested_dissection(places, ends, border)[-path.sum() :])
    a, b = ends[~last[ends].any(axis=1)].T
    graph = csc_matrix((np.ones(len(a)), (a, b)), shape=2 * (len(places),))
    piece = connected_components(graph, directed=False)[1]
    assert max(np.bincount(piece)) < 0.75 * len(places)


def test_both_orders_solve_the_same_system(monkeypatch: pytest.MonkeyPatch) -> None:
    pattern = sample_random_square(400, 7, redraw=True).pattern
    right = np.random.default_rng(2).random(400)
    solutions, orders = [], []
    for limit in (400, 399):
        monkeypatch.setattr(sparse_sheet, "_DISSECTED", limit)
        sheet = BranchFinder(pattern)._floats
        bends = sheet.bends(sheet.heights(np.random.default_rng(3).random(400)))
        solutions.append(sheet.solve(bends, np.ones(400), np.full(400, 0.1), right))
        orders.append(sheet._elimination[0].tolist())
    assert orders[0] != orders[1]
    assert np.allclose(solutions[0], solutions[1], rtol=1e-6, atol=1e-9)
