"""Splitting spaces: both orders of vertices give the same leaves, and sparse rows are exact."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from flint import fmpq
from panel_sheets import crossed_stars, grid, miura, ring_of_fives, tiling

from exactfold._support.clock import Clock
from exactfold.errors import TooManyModesError
from exactfold.panels.spaces import splitting
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.parameters import Space, on_folds
from exactfold.panels.spaces.quadratics import squares_of
from exactfold.panels.spaces.sparse import (
    Form,
    Row,
    are_independent,
    combined,
    diagonalised,
    other_factor,
    row_space,
)
from exactfold.panels.spaces.splitting import Splitting, leaves
from exactfold.panels.vertex.stars import stars

SHEETS = {
    "grid": lambda: grid(4, 3, lambda i, j: (Fraction(i), Fraction(j))),
    "miura": lambda: miura(2, 3),
    "tiling": lambda: tiling(3, 2),
    "crossed stars": crossed_stars,
    "ring of fives": ring_of_fives,
}


@pytest.mark.parametrize("name", sorted(SHEETS))
def test_both_orders_give_the_same_leaves(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pattern = SHEETS[name]()
    moving = stars(pattern)
    rows, size = first_order(moving)
    kinds = []
    for avoids in (False, True):

        def in_one_order(search: Splitting, space: object, avoids: bool = avoids) -> object:
            search._avoids_roots = avoids
            return search._split(space, frozenset())  # type: ignore[arg-type]

        monkeypatch.setattr(Splitting, "_in_turns", in_one_order)
        found = leaves(moving, rows, size, 10**7)
        kinds.append(sorted((leaf.folds, leaf.size, leaf.vertices) for leaf in found))
    assert kinds[0] == kinds[1]
    assert kinds[0]


def test_the_second_order_is_tried_where_the_first_takes_too_much_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    moving = stars(ring_of_fives())
    rows, size = first_order(moving)
    plain = Splitting(moving, 10**7)
    expected = plain.leaves(rows, size)
    monkeypatch.setattr(splitting, "_FIRST_TURN", 1)
    tried: list[bool] = []
    split = Splitting._split

    def counted(search: Splitting, space: object, settled: frozenset[int]) -> object:
        if not settled:
            tried.append(search._avoids_roots)
        return split(search, space, settled)  # type: ignore[arg-type]

    monkeypatch.setattr(Splitting, "_split", counted)
    search = Splitting(moving, 10**7)
    assert [leaf.rows for leaf in search.leaves(rows, size)] == [leaf.rows for leaf in expected]
    assert tried[:3] == [False, True, False]
    with pytest.raises(TooManyModesError, match="more work than is allowed"):
        Splitting(moving, 5).leaves(rows, size)
    with pytest.raises(TooManyModesError, match="time limit"):
        Splitting(moving, 10**7, Clock(0)).leaves(rows, size)


def test_of_equally_near_vertices_one_without_a_new_root_is_split_first() -> None:
    moving = stars(tiling(2, 2))
    search = Splitting(moving, 10**7)
    rows = on_folds(*first_order(moving))
    forms = {v: search._form(v, rows) for v in moving}

    def chosen(plain: set[int], settled: frozenset[int]) -> int:
        """The choice if the forms of these vertices need no root, and all others sqrt 2."""
        given = {
            v: [(fmpq(1), one), (fmpq(-1 if v in plain else -2), other)]
            for v, ((_, one), (_, other)) in forms.items()
        }
        waiting = [v for v in forms if v not in settled]
        return search._chosen(Space(rows, given), settled, waiting)[0]

    for v, star in moving.items():
        around = {u for edge in star.folds for u in edge}
        far = forms.keys() - around
        assert far
        search._avoids_roots = False
        assert chosen({v}, frozenset()) == v
        assert chosen(far, frozenset({v})) in around
        search._avoids_roots = True
        assert chosen(far, frozenset({v})) in far


@pytest.mark.parametrize("name", sorted(SHEETS))
def test_the_forms_on_random_subspaces_are_those_of_dense_rows(name: str) -> None:
    """Both sums of squares have the same values at random points of random subspaces."""
    rng = random.Random(5)
    moving = stars(SHEETS[name]())
    rows, size = first_order(moving)
    search = Splitting(moving, 10**7)
    for smaller in {size, max(1, size - 1), max(1, size // 2), 1}:
        change = [[fmpq(rng.randint(-1, 1)) for _ in range(smaller)] for _ in range(size)]
        dense = {
            edge: [
                sum((x * line[k] for x, line in zip(row, change, strict=True)), fmpq(0))
                for k in range(smaller)
            ]
            for edge, row in rows.items()
        }
        dense = {edge: row for edge, row in dense.items() if any(row)}
        sparse = {edge: {k: x for k, x in enumerate(row) if x} for edge, row in dense.items()}
        at = [fmpq(rng.randint(-9, 9)) for _ in range(smaller)]
        for v, star in moving.items():
            wanted = squares_of(star, dense, smaller)
            form = search._form(v, sparse)
            assert len(form) == len(wanted)
            values = [sum((x * at[k] for k, x in row.items()), fmpq(0)) for _, row in form]
            total = sum((d * x * x for (d, _), x in zip(form, values, strict=True)), fmpq(0))
            for d, row in wanted:
                x = sum((c * y for c, y in zip(row, at, strict=True)), fmpq(0))
                total = total - d * x * x
            assert not total


def test_rows_of_a_basis_are_found_among_the_rows() -> None:
    one = fmpq(1)
    rows: list[Row] = [{0: one, 1: one}, {0: 2 * one, 1: 2 * one}, {1: one}, {0: one, 1: 4 * one}]
    basis, coordinates = row_space(rows)
    assert basis == [rows[0], rows[2]]
    assert [combined(line, basis) for line in coordinates] == rows
    assert are_independent(basis)
    assert not are_independent(rows[:2])
    assert not are_independent([{}, {0: one}])


def test_the_other_factor_is_found_only_for_factors() -> None:
    one = fmpq(1)
    form: Form = [(one, {0: one, 2: one}), (-4 * one, {1: one, 2: one})]
    factor: Row = combined({0: one, 1: 2 * one}, [row for _, row in form])
    other = combined({0: one, 1: -2 * one}, [row for _, row in form])
    assert other_factor(form, factor) == other
    assert other_factor(form, other) == factor
    tripled = {k: 3 * x for k, x in factor.items()}
    assert other_factor(form, tripled) == {k: 3 * x for k, x in other.items()}
    for row in ({0: one, 1: 2 * one}, {0: one}, {3: one}, {0: one, 1: 2 * one, 2: 2 * one}):
        assert other_factor(form, row) is None


def test_completed_squares_leave_the_matrix_as_it_was() -> None:
    one, none = fmpq(1), fmpq(0)
    matrix = [[none, one], [one, none]]
    squares = diagonalised(matrix)
    assert matrix == [[none, one], [one, none]]
    assert sorted(d > 0 for d, _ in squares) == [False, True]


def test_the_clock_is_asked_while_the_form_of_a_vertex_with_many_folds_is_made(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The form takes one step for each fold, and the clock ends it after any of them."""
    star = stars(ring_of_fives())[0]
    steps = 0

    def counted(_: Clock) -> None:
        nonlocal steps
        steps += 1
        if steps == 3:
            raise TooManyModesError("the time limit was reached")

    monkeypatch.setattr(Clock, "check", counted)
    with pytest.raises(TooManyModesError, match="time limit"):
        Splitting({star.vertex: star}, 10**7, Clock(60))
    assert steps == 3
