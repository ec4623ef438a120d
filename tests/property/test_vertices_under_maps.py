"""Whether a vertex folds with its letters does not change under symmetries."""

from __future__ import annotations

from fractions import Fraction
from math import atan2, gcd

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from exactfold.panels.vertex.stars import Star, bracket, dot
from exactfold.panels.vertex.vertex_motions import vertex_motion
from exactfold.pattern.panel_pattern import Point

GRID = [(x, y) for x in range(-4, 5) for y in range(-4, 5) if gcd(x, y) == 1]
OTHER = {"M": "V", "V": "M"}
Folds = list[tuple[tuple[int, int], str]]


@st.composite
def vertices(draw: st.DrawFn) -> Folds:
    """Directions, counter-clockwise, each with a letter."""
    around = draw(st.lists(st.sampled_from(GRID), min_size=1, max_size=8, unique=True))
    around.sort(key=lambda d: atan2(d[1], d[0]))
    return [(d, draw(st.sampled_from("MMVVFU"))) for d in around]


def folds(vertex: list[tuple[Point, str]]) -> bool:
    star = Star(0, tuple((0, k + 1) for k in range(len(vertex))), tuple(d for d, _ in vertex))
    return (
        vertex_motion(star, {e: x for e, (_, x) in zip(star.folds, vertex, strict=True)})
        is not None
    )


@given(vertices(), st.tuples(*[st.integers(-5, 5)] * 4))
def test_linear_maps(vertex: Folds, entries: tuple[int, int, int, int]) -> None:
    a, b, c, d = entries
    assume(a * d != b * c)
    mapped: list[tuple[Point, str]] = [((a * x + b * y, c * x + d * y), f) for (x, y), f in vertex]
    assert folds(mapped if a * d > b * c else mapped[::-1]) is folds(list(vertex))


@given(vertices(), st.integers(0, 7))
def test_the_first_fold_may_be_any(vertex: Folds, first: int) -> None:
    first %= len(vertex)
    assert folds([*vertex[first:], *vertex[:first]]) is folds(list(vertex))


@given(vertices())
def test_mountains_and_valleys_may_be_exchanged(vertex: Folds) -> None:
    assert folds([(d, OTHER.get(x, x)) for d, x in vertex]) is folds(list(vertex))


@pytest.mark.slow
@given(vertices(), st.lists(st.fractions(Fraction(1, 9), 9), min_size=8, max_size=8))
def test_lengths_do_not_matter(vertex: Folds, lengths: list[Fraction]) -> None:
    scaled = [((x * r, y * r), f) for ((x, y), f), r in zip(vertex, lengths, strict=False)]
    assert folds(scaled) is folds(list(vertex))


@given(vertices(), st.sampled_from(GRID), st.integers(1, 4))
def test_a_further_free_fold_takes_no_motion_away(
    vertex: Folds, more: tuple[int, int], scale: int
) -> None:
    assume(all(bracket(more, d) or dot(more, d) < 0 for d, _ in vertex))
    wider = [*vertex, ((more[0] * scale, more[1] * scale), "U")]
    wider.sort(key=lambda fold: atan2(fold[0][1], fold[0][0]))
    assert folds(list(wider)) or not folds(list(vertex))
