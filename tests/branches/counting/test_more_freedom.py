"""Sheets with more degrees of freedom than one, and sheets and methods that are refused."""

from fractions import Fraction

import pytest
from counting import counts
from sheets import DENTED, HEXAGON, SQUARE, random_wheel, scrambled, wheel

from exactfold import PROVED, UNDECIDED, CreasePattern
from exactfold.branches import count_branches
from exactfold.errors import NotCountedError, UsageError
from exactfold.pattern.families import two_vertex
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.groebner_bases import groebner


@pytest.mark.parametrize("degree", range(5, 13))
def test_single_vertex_with_more_folds(degree):
    result = count_branches(random_wheel(degree, degree))
    assert result.status is PROVED
    assert counts(result) == (1, 1, 1, 0)
    assert result.method == "single vertex"


@pytest.mark.parametrize("corners", [5, 6])
def test_two_vertices_with_more_degrees_of_freedom_are_graphs(corners):
    pattern = scrambled(1, HEXAGON[:corners], 2, loose=True)
    assert pattern.degrees_of_freedom == corners - 3
    result = count_branches(pattern)
    assert (result.status, result.by) == (PROVED, "theorem")
    assert f"2^2 graphs over the boundary heights, of dimension {corners - 3}" in result.reason
    assert result.connected_components.number == {5: 2, 6: 1}[corners]
    assert counts(result) == (None,) * 4
    assert result.proof is None


def test_a_reflex_corner_of_a_sheet_with_more_degrees_of_freedom_is_undecided():
    result = count_branches(scrambled(1, DENTED, 2, loose=True))
    assert (result.status, result.connected_components) == (UNDECIDED, None)
    assert "6 boundary vertices, so it has 3 degrees of freedom, and a reflex" in result.reason
    assert "shapes with given boundary heights need not be real" in result.reason


def test_chord_of_a_sheet_with_more_degrees_of_freedom_joins_everything():
    # One interior vertex of degree 4, and a chord that cuts off a flap: not one double cone.
    inner = wheel([(0, 0), (4, 0), (4, 4), (0, 4)], (1, 2))
    flap = CreasePattern([*inner.vertices, (7, 2)], [*inner.triangles, (1, 5, 2)])
    assert (flap.Ve, flap.chords) == (5, ((1, 2),))
    result = count_branches(flap)
    assert (
        result.status,
        result.connected_components.graphs,
        result.connected_components.number,
    ) == (PROVED, 2, 1)
    assert result.connected_components.chord == (1, 2)


def test_dimension_and_degree_of_sheets_with_more_freedom():
    """The cone of solutions against a Groebner basis of its section by fixed boundary heights."""
    for seed in range(3):
        pattern = scrambled(seed, HEXAGON, 3)
        result = count_branches(pattern)
        assert result.status is PROVED
        assert (result.dimension, result.degree) == (3, 1 << pattern.Vi)
        system = BranchSystem(pattern)
        inner = [v for v in system.variables if v in pattern.interior]
        rim = {v: Fraction(3 + 2 * v) for v in system.variables if v not in pattern.interior}
        matrices = []
        for form in system.quadrics.values():
            rows = {v: {inner.index(v): Fraction(1)} for v in inner}
            rows |= {v: {len(inner): height} for v, height in rim.items()}
            matrix = [[Fraction(0)] * (len(inner) + 1) for _ in range(len(inner) + 1)]
            for a, left in zip(form.labels, form.matrix, strict=True):
                for b, weight in zip(form.labels, left, strict=True):
                    for i, x in rows[a].items():
                        for j, y in rows[b].items():
                            matrix[i][j] += weight * x * y
            matrices.append(matrix)
        section = groebner(QuadraticSystem.from_rational(matrices), engine="flint")
        assert section.dimension == 1 << pattern.Vi


def test_no_interior_vertex_error():
    with pytest.raises(NotCountedError, match="no interior vertex"):
        count_branches(CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)]))


def test_unknown_method_error():
    with pytest.raises(UsageError, match="unknown method 'guess': choose one of auto"):
        count_branches(two_vertex(), method="guess")
