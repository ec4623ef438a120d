"""The builders of degenerate sheets: what they build, and what they refuse."""

import pytest

from exactfold.errors import UsageError
from exactfold.pattern.degenerate import (
    DEGENERATE,
    chorded_square,
    gridded_square,
    nested_triangles,
    notched,
    ringed_square,
    straight_path,
    with_vertex,
)
from exactfold.pattern.families import collinear_folds, two_vertex


@pytest.mark.parametrize("name", DEGENERATE)
def test_builders_have_four_boundary_vertices(name: str) -> None:
    assert DEGENERATE[name]().Ve == 4


@pytest.mark.parametrize("inside", range(1, 6))
def test_straight_paths_are_straight(inside: int) -> None:
    for pattern in (straight_path(inside), notched(inside)):
        along = {v for _, v, _ in collinear_folds(pattern)}
        assert along == set(pattern.interior)
        assert {pattern.degree(v) for v in along} == {4}


@pytest.mark.parametrize("sides", range(3, 9))
def test_rings_and_grids(sides: int) -> None:
    assert ringed_square(sides).Vi == sides + 1 == ringed_square(sides + 1, hub=False).Vi
    assert gridded_square(2, sides).Vi == 2 * sides


def test_builders_refuse_what_they_cannot_build() -> None:
    cases = [
        lambda: with_vertex(two_vertex(), 99),
        lambda: with_vertex(two_vertex(), 0, (1, 0, 1)),
        lambda: nested_triangles(0),
        lambda: chorded_square((1, -1)),
        lambda: straight_path(0),
        lambda: ringed_square(2),
        lambda: gridded_square(0, 2),
        lambda: notched(0),
    ]
    for build in cases:
        with pytest.raises(UsageError):
            build()
