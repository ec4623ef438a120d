"""Tracks, winding and inertia of a flat vertex that folds back on itself or winds repeatedly."""

import math
import random
from fractions import Fraction

import pytest
from sheets import random_wheel

from exactfold.errors import DegenerateFaceError, FloatRefusedError, MalformedPatternError
from exactfold.exact.linalg import inertia_by_elimination
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.kapovich_millson import kapovich_millson


def random_spokes(seed: int, count: int, reach: int) -> list[tuple[int, int]]:
    source = random.Random(seed)
    while True:
        d = [(source.randint(-reach, reach), source.randint(-reach, reach)) for _ in range(count)]
        if all(d[j - 1][0] * d[j][1] != d[j - 1][1] * d[j][0] for j in range(count)):
            return d


@pytest.mark.parametrize("seed", range(120))
def test_signature_is_that_of_the_theorem(seed: int) -> None:
    # a reach of 2 makes many partial angle sums multiples of pi, that is, many minors zero
    found = kapovich_millson(random_spokes(seed, 2 + seed % 8, 2 if seed % 2 else 30))
    assert found.inertia == found.predicted
    assert found.inertia == inertia_by_elimination(found.form.matrix)


@pytest.mark.parametrize("seed", range(40))
def test_tracks_and_winding_are_those_of_the_angles(seed: int) -> None:
    d = random_spokes(seed, 3 + seed % 6, 5)
    turns = [
        math.atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
        for a, b in zip(d, d[1:] + d[:1], strict=True)
    ]
    found = kapovich_millson(d)
    assert (found.forward, found.back) == (sum(t > 0 for t in turns), sum(t < 0 for t in turns))
    assert abs(sum(turns) - 2 * math.pi * found.winding) < 1e-9


@pytest.mark.parametrize("seed", range(10))
def test_form_is_minus_twice_the_curvature_form_of_a_sheet(seed: int) -> None:
    pattern = random_wheel(seed, 4 + seed % 5)
    hub = pattern.interior[0]
    form = curvature_form(pattern, hub)
    found = kapovich_millson([pattern.vertices[j] for j in form.labels[1:]])
    assert (found.back, found.winding) == (0, 1)
    assert [[-2 * x for x in row] for row in form.matrix] == [list(r) for r in found.form.matrix]


def test_reversal_turns_forward_tracks_into_back_tracks() -> None:
    d = random_spokes(3, 7, 9)
    one, other = kapovich_millson(d), kapovich_millson(d[::-1])
    assert (other.forward, other.back) == (one.back, one.forward)
    assert other.winding == -one.winding
    assert other.inertia[:2] == (one.inertia[1], one.inertia[0])


def test_winding_does_not_depend_on_where_the_axis_is() -> None:
    d = [(2, 0), (-2, 1), (1, -2), (1, 2), (-2, -1)]
    for _ in range(4):
        d = [(-y, x) for x, y in d]
        for first in range(5):
            found = kapovich_millson([*d[first:], *d[:first]])
            assert (found.forward, found.back, found.winding) == (5, 0, 2)


def test_two_spokes_there_and_back() -> None:
    found = kapovich_millson([("1/2", 0), (0, Fraction(1, 3))])
    assert (found.forward, found.back, found.winding) == (1, 1, 0)
    assert found.inertia == found.predicted == (0, 0, 3)


@pytest.mark.parametrize(
    ("spokes", "indices"),
    [
        ([(1, 0), (-1, 0), (0, 1)], (0, 1)),
        ([(1, 0), (0, 1), (2, 0), (3, 0)], (2, 3)),
        ([(1, 0), (0, 1), (-2, 0)], (2, 0)),
        ([(1, 0), (0, 0), (0, 1)], (0, 1)),
    ],
)
def test_parallel_consecutive_spokes_are_named(
    spokes: list[tuple[int, int]], indices: tuple[int, int]
) -> None:
    with pytest.raises(DegenerateFaceError, match="parallel") as error:
        kapovich_millson(spokes)
    assert error.value.vertices == indices


@pytest.mark.parametrize("spokes", [[], [(1, 0)], [(1, 0), (0, 1, 0)], ["10", "01"]])
def test_malformed_spokes_are_refused(spokes: list[tuple[int, ...]]) -> None:
    with pytest.raises(MalformedPatternError):
        kapovich_millson(spokes)


def test_floats_are_refused() -> None:
    with pytest.raises(FloatRefusedError):
        kapovich_millson([(1.0, 0), (0, 1)])  # type: ignore[list-item]
