"""Relations of drawings: found in noise, refused where there is no gap, and kept where exact."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction

import pytest

from exactfold.pattern.drawing.meant.inference import Inference, infer
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.triangulating.random_squares import sample_random_square

Points = list[tuple[Fraction, Fraction]]


def miura(columns: int = 4, rows: int = 3, rise: Fraction = Fraction(1, 3)) -> PanelPattern:
    """A sheet of parallelograms whose zigzags go up and down; its columns are numbered upwards."""
    points = {
        (i, j): (Fraction(7 * i, 5), Fraction(j) + i % 2 * rise)
        for i in range(columns + 1)
        for j in range(rows + 1)
    }
    number = {place: k for k, place in enumerate(points)}
    edges = [
        (number[i, j], number[i + a, j + b])
        for i, j in points
        for a, b in ((1, 0), (0, 1))
        if (i + a, j + b) in points
    ]
    return PanelPattern(points.values(), edges)


def rounded(points: Points, digits: int) -> Points:
    scale = 10**digits
    return [
        (Fraction(round(x * scale), scale), Fraction(round(y * scale), scale)) for x, y in points
    ]


def noisy(points: Points, eps: float, seed: int = 1) -> Points:
    source = random.Random(seed)
    return [
        (x + Fraction(source.uniform(-eps, eps)), y + Fraction(source.uniform(-eps, eps)))
        for x, y in points
    ]


def inferred(sheet: PanelPattern, points: Points) -> Inference:
    return infer(points, sheet.edges, sheet.boundary_edges)


def test_digits_without_noise_have_no_near_relation() -> None:
    sheet = miura()
    inference = inferred(sheet, list(sheet.vertices))
    assert inference.near == ()
    assert inference.reason == ""
    assert inference.angles is None


@pytest.mark.parametrize("eps", [1e-15, 1e-12, 1e-9, 1e-6])
def test_the_relations_of_an_exact_sheet_return_from_noise(eps: float) -> None:
    sheet = miura()
    inference = inferred(sheet, noisy(list(sheet.vertices), eps))
    kinds = Counter(relation.kind for relation in inference.relations)
    assert kinds["straight"] == 6, "one vertical path at each of the six interior vertices"
    assert kinds["kawasaki"] == 6
    assert kinds["border"] == 4, "the vertical sides are straight at two vertices each"
    assert inference.noise < 5 * eps
    assert inference.gap > 1000
    assert inference.angles is not None
    for relation in inference.relations:
        total = sum(c * inference.angles.constants[e] for e, c in relation.terms)
        assert (relation.parts * total).denominator == 1
        sums: Counter[int] = Counter()
        for edge, factor in relation.terms:
            for free, part in inference.angles.coefficients[edge]:
                sums[free] += factor * part
        assert not any(sums.values()), relation.name


def test_exact_relations_are_kept_beside_those_that_are_missed() -> None:
    sheet = miura()
    points = list(sheet.vertices)
    x, y = points[5]
    points[5] = (x + Fraction(1, 10**12), y)
    inference = inferred(sheet, points)
    assert {relation.name for relation in inference.near} == {
        "straight@5:4-6",
        "straight@6:5-7",
        "kawasaki@5",
        "kawasaki@6",
        "kawasaki@9",
    }
    kept = Counter(relation.kind for relation in inference.relations if not relation.defect)
    assert kept["straight"] == 4
    assert kept["kawasaki"] == 3


@pytest.mark.parametrize("digits", [9, 6, 5, 4])
def test_random_sheets_without_relations_infer_nothing(digits: int) -> None:
    for seed in range(8):
        square = sample_random_square(20 + seed, seed, 10**12, redraw=True).pattern
        points = rounded(list(square.vertices), digits)
        inference = infer(points, square.edges, square.boundary_edges)
        assert inference.relations == ()
        assert inference.angles is None


def test_a_drawing_by_hand_has_no_gap() -> None:
    sheet = miura(10, 10)
    source = random.Random(3)
    points = [
        (x + Fraction(10 ** source.uniform(-7, -2)), y + Fraction(10 ** source.uniform(-7, -2)))
        for x, y in sheet.vertices
    ]
    inference = inferred(sheet, points)
    assert inference.relations == ()
    assert inference.reason.startswith("noise and design show no gap")
    assert inference.near
