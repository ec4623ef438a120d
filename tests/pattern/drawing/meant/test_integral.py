"""Free angles of which all edges have integer multiples."""

from __future__ import annotations

import random
from fractions import Fraction
from math import lcm, pi

import pytest

from exactfold.pattern.drawing.meant.integral import with_integers
from exactfold.pattern.drawing.meant.values import Angles, Edge

Terms = dict[Edge, tuple[tuple[int, Fraction], ...]]


def value(angles: Angles, edge: Edge) -> float:
    terms = angles.coefficients.get(edge, ())
    return pi * float(angles.constants[edge]) + sum(float(a) * angles.free[k] for k, a in terms)


def parts(angles: Angles) -> int:
    return lcm(*(c.denominator for c in angles.constants.values()))


def sheet(seed: int, torsion: int) -> tuple[Angles, int]:
    """Integer multiples of three angles, hidden by a change of free angles with denominators."""
    rng = random.Random(seed)
    edges = [(0, k) for k in range(1, 9)]
    true = [[rng.randint(-2, 2) for _ in range(3)] for _ in edges]
    for k in range(3):
        true[k] = [int(j == k) for j in range(3)]  # the three angles are those of edges
    constants = [Fraction(0)] * 3 + [Fraction(rng.randint(0, torsion), torsion) for _ in edges[3:]]
    scales = [Fraction(rng.choice((7, 11, 191)), rng.choice((2, 3, 25))) for _ in range(3)]
    shift = [Fraction(rng.randint(1, 90), 191) for _ in range(3)]
    at = [rng.uniform(0, 3) for _ in range(3)]
    coefficients: Terms = {}
    moved: dict[Edge, Fraction] = {}
    for edge, row, constant in zip(edges, true, constants, strict=True):
        coefficients[edge] = tuple((k, n * scales[k]) for k, n in enumerate(row) if n)
        moved[edge] = constant + sum(n * s for n, s in zip(row, shift, strict=True))
    free = tuple((t - pi * float(s)) / float(q) for t, s, q in zip(at, shift, scales, strict=True))
    return Angles(moved, coefficients, free), lcm(*(c.denominator for c in constants))


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("torsion", [1, 2, 12])
def test_only_constants_that_are_implied_are_left(seed: int, torsion: int) -> None:
    angles, least = sheet(seed, torsion)
    found = with_integers(angles)
    assert parts(found) == least
    assert 191 % least or least == 1
    assert all(a.denominator == 1 for terms in found.coefficients.values() for _, a in terms)
    assert max(abs(a) for terms in found.coefficients.values() for _, a in terms) <= 4
    for edge in angles.constants:
        assert value(found, edge) == pytest.approx(value(angles, edge), abs=1e-9)


def test_torsion_of_a_multiple() -> None:
    """Three times an angle minus three times another is pi: they differ by pi/3."""
    edges = [(0, 1), (0, 2)]
    one = Fraction(1)
    angles = Angles(
        {edges[0]: Fraction(1, 7), edges[1]: Fraction(1, 7) + Fraction(1, 3)},
        {edges[0]: ((0, one),), edges[1]: ((0, one),)},
        (0.5,),
    )
    found = with_integers(angles)
    assert parts(found) == 3
    assert (found.constants[edges[1]] - found.constants[edges[0]]) % 1 == Fraction(1, 3)


def test_angles_without_free_ones_stay() -> None:
    angles = Angles({(0, 1): Fraction(1, 7)}, {}, ())
    assert with_integers(angles) is angles
