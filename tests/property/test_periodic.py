"""Counts of periodic sheets do not depend on how the cell is written, and follow affine maps."""

from __future__ import annotations

from fractions import Fraction
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from exactfold.branches import PeriodicCount, count_periodic
from exactfold.pattern import PeriodicPattern, random_cell

Facts = set[tuple[str, int, int]]
N = (2, 1)


def facts(result: PeriodicCount, names: list[int] | None = None) -> Facts:
    """Signs, multiplicities and b, with the vertices put back in their order."""
    found = set()
    for branch in result:
        signs, b = branch.vertex_signs, branch.b
        if names is not None:
            signs = "".join(signs[k] for k in names)
        if signs.strip("0")[0] == "-":
            signs, b = signs.translate(str.maketrans("+-", "-+")), -b
        found.add((signs, branch.multiplicity, b))
    return found


cells = st.builds(
    random_cell, st.integers(2, 4), st.integers(0, 200), st.just(16), flips=st.integers(0, 4)
)
few = settings(max_examples=6, deadline=None)


@pytest.mark.slow
@few
@given(cells, st.sampled_from([((1, 2), (0, 1)), ((2, 1), (1, 1)), ((0, 1), (1, 0))]))
def test_another_basis_of_the_lattice(
    cell: PeriodicPattern, change: tuple[tuple[int, int], tuple[int, int]]
) -> None:
    """a' = p a + q b, b' = r a + s b with p s - q r = 1 or -1; corners get the inverse."""
    (p, q), (r, s) = change
    det = p * s - q * r
    (ax, ay), (bx, by) = cell.lattice
    lattice = [(p * ax + q * bx, p * ay + q * by), (r * ax + s * bx, r * ay + s * by)]
    faces = [
        [(v, (s * i - r * j) * det, (p * j - q * i) * det) for v, i, j in face]
        for face in cell.faces
    ]
    other = PeriodicPattern(lattice, cell.points, faces)
    assert facts(count_periodic(other, N)) == facts(count_periodic(cell, N))


@pytest.mark.slow
@few
@given(cells, st.randoms(use_true_random=False))
def test_other_names_and_other_translates(cell: PeriodicPattern, source: Random) -> None:
    """Vertex v becomes vertex names[v], and its point another one of its class."""
    names = list(range(cell.V))
    source.shuffle(names)
    moves = [(source.randint(-2, 2), source.randint(-2, 2)) for _ in names]
    points = [cell.place((v, *moves[v])) for v in sorted(names, key=names.__getitem__)]
    faces = [
        [(names[v], i - moves[v][0], j - moves[v][1]) for v, i, j in face] for face in cell.faces
    ]
    other = count_periodic(PeriodicPattern(cell.lattice, points, faces), N)
    assert facts(other, names) == facts(count_periodic(cell, N))


@pytest.mark.slow
@few
@given(cells, st.sampled_from([((1, "1/2"), (0, 3)), ((2, 1), (-1, 1)), ((0, -1), (1, 0))]))
def test_affine_maps_take_the_direction_along(
    cell: PeriodicPattern, given_map: tuple[tuple[str, str], tuple[str, str]]
) -> None:
    """Heights stay, and n . x too, if x is mapped by A and n by the inverse transpose of A."""
    (a, b), (c, d) = ((Fraction(x), Fraction(y)) for x, y in given_map)
    det = a * d - b * c

    def mapped(point: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
        x, y = point
        return a * x + b * y, c * x + d * y

    other = PeriodicPattern(
        [mapped(v) for v in cell.lattice], [mapped(p) for p in cell.points], cell.faces
    )
    turned = ((d * N[0] - c * N[1]) / det, (a * N[1] - b * N[0]) / det)
    assert facts(count_periodic(other, turned)) == facts(count_periodic(cell, N))


@pytest.mark.parametrize("seed", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_a_mirror_reverses_the_faces_and_keeps_the_signs(seed: int) -> None:
    cell = random_cell(4, seed, 16)
    lattice = [(-x, y) for x, y in cell.lattice]
    points = [(-x, y) for x, y in cell.points]
    other = PeriodicPattern(lattice, points, cell.faces)
    mirrored = count_periodic(other, (-N[0], N[1]))
    assert facts(mirrored) == facts(count_periodic(cell, N))


def test_twice_the_cell_has_the_same_branches_and_more() -> None:
    """Each solution of a cell is one of two cells side by side, and all pleats stay pleats."""
    cell = random_cell(2, 5, 16)
    (ax, ay), b = cell.lattice
    points = [cell.place((v, i, 0)) for i in (0, 1) for v in range(cell.V)]
    faces = [
        [(v + cell.V * ((i + k) % 2), (i + k) // 2, j) for v, i, j in face]
        for k in (0, 1)
        for face in cell.faces
    ]
    double = count_periodic(PeriodicPattern([(2 * ax, 2 * ay), b], points, faces), N)
    once = {(signs * 2, b) for signs, _, b in facts(count_periodic(cell, N))}
    assert once <= {(signs, b) for signs, _, b in facts(double)}
