"""Forms of rank 3 whose discriminants are squares: a leaf with two components."""

from __future__ import annotations

import pytest
from flint import fmpq
from panel_sheets import corner_diagonals

from exactfold._support.verdict import PROVED
from exactfold.exact.surds import RATIONALS
from exactfold.panels import by_spaces
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces.conics import Conics
from exactfold.panels.spaces.quadratics import Squares, Vector

X, Y, Z, T, S = range(5)


def vector(**entries: int) -> Vector:
    return [fmpq(entries.get(name, 0)) for name in "xyzts"]


def conic(one: str, other: str, middle: str, scale: int = 1) -> Squares:
    """The form scale l m - n^2 of three coordinates."""
    quarter = fmpq(scale, 4)
    both, apart = vector(**{one: 1, other: 1}), vector(**{one: 1, other: -1})
    return [(quarter, both), (-quarter, apart), (fmpq(-1), vector(**{middle: 1}))]


def test_a_ring_of_four_vertices_has_two_components() -> None:
    result = decompose(corner_diagonals())
    assert result.status is PROVED
    assert result.second_order == {4: 2}
    assert result.found_true == {4: 2}
    assert result.true is None


@pytest.mark.parametrize("p", [11, 13])
def test_points_over_a_finite_field_show_the_same_number(p: int) -> None:
    """A variety with c components of dimension d has about c p^d points (Lang and Weil).

    The folds of a vertex in counter-clockwise order have the densities x, y, x - z, z, y - z: two
    to neighbours, the opposite ones, and between these the diagonal. The directions are
    (1, 0), (0, 1), (-1, 0), (-1, -1), (0, -1).
    """
    around = [(1, 0), (0, 1), (-1, 0), (-1, -1), (0, -1)]

    def form(x: int, y: int, z: int) -> int:
        w = x, y, x - z, z, y - z
        return sum(
            w[k] * w[j] * (around[k][0] * around[j][1] - around[k][1] * around[j][0])
            for j in range(5)
            for k in range(j)
        )

    ways = [[sum(form(x, y, z) % p == 0 for z in range(p)) for y in range(p)] for x in range(p)]
    twice = [
        [sum(a * b for a, b in zip(row, ways[k], strict=True)) for k in range(p)] for row in ways
    ]
    points = sum(
        a * b
        for row, other in zip(twice, zip(*twice, strict=True), strict=True)
        for a, b in zip(row, other, strict=True)
    )
    assert round(points / p**4) == 2


@pytest.mark.parametrize(("scale", "sign"), [(1, 1), (2, 1), (-3, -1)])
def test_the_product_of_two_tangents_of_a_form_is_a_square(scale: int, sign: int) -> None:
    known = Conics(RATIONALS)
    assert known.add(conic("x", "y", "z"), vector(z=1)) is None
    root = known.add(conic("x", "y", "t", scale), vector(t=1))
    assert root is not None
    assert root.sign == sign
    [row] = root.rows  # where x y = z^2
    assert [bool(x) for x in row] == [False, False, True, False, False]


def test_a_chain_of_forms_joins_two_tangents() -> None:
    """Where x y = z^2 and y s = t^2, the product x s is the square of z t / y."""
    known = Conics(RATIONALS)
    known.add(conic("x", "y", "z"), vector(z=1))
    known.add(conic("y", "s", "t"), vector(t=1))
    assert known.add(conic("x", "s", "z"), vector(z=1)) is not None
    other = Conics(RATIONALS)
    other.add(conic("x", "y", "z"), vector(z=1))
    assert other.add(conic("x", "s", "t"), vector(t=1)) is None


def test_a_component_that_may_lie_in_another_space_is_not_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(by_spaces, "outside", lambda *_: False)
    assert decompose(corner_diagonals()).status is PROVED  # there is no other space
