"""Counts of periodic sheets against theorems, and against Groebner bases of other forms."""

from __future__ import annotations

from fractions import Fraction
from itertools import product

import pytest

from exactfold import PROVED, checker
from exactfold.branches import AlgebraicLine, HeightSpace, count_periodic, periodic_certificate
from exactfold.branches.periodic import counting
from exactfold.branches.periodic.exactly import rays_on
from exactfold.branches.periodic.lines import QuadraticLine
from exactfold.branches.periodic.spaces import Spaces
from exactfold.checker.sheets.cell import CellForms
from exactfold.checker.sheets.cell import read_cell as read_checked
from exactfold.errors import NotApplicableError, NotCountedError, SolverError, UsageError
from exactfold.pattern import CELLS, PeriodicPattern, cell_document, random_cell, read_cell
from exactfold.rigidity.equations.periodic import PeriodicProblem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic import groebner_bases
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import groebner

EXPECTED = {
    "waterbomb-cell": (4, 4, 0),
    "yoshimura-cell": (1, 1, 1),
    "kisrhombille-cell": (29, 32, 0),
    "miura-cell": (5, 5, 3),
    "herringbone-cell": (6, 6, 2),
    "resch-cell": (8, 8, 0),
    "square-twist-cell": (6, 6, 2),
}
"""Isolated solutions for the direction (1, 2), the same with multiplicity, and lines of pleats."""


@pytest.mark.parametrize(
    "name",
    [pytest.param(x, marks=pytest.mark.slow) if x == "kisrhombille-cell" else x for x in CELLS],
)
def test_shipped_cells(name: str) -> None:
    result = count_periodic(name, (1, 2))
    assert result.status is PROVED
    found = (result.distinct, result.with_multiplicity, len(result.pleats))
    assert found == EXPECTED[name]
    cell = read_cell(name)
    assert EXPECTED[name][1] + EXPECTED[name][2] == 2 ** (cell.V - 1)  # no pleat has a flat vertex
    assert result.families == ()


def independent(cell: PeriodicPattern, direction: tuple[int, int]) -> tuple[int, int, int]:
    """Solutions with b = 1 by a Groebner basis of the checker's forms.

    Their number, the number of real ones, and their number with multiplicity.
    """
    document = cell_document(cell)
    known = {"lattice": document["lattice"], "vertices": document["points"]}
    forms = CellForms(read_checked({**known, "faces": document["faces"]}), direction, Fraction(1))
    matrices = list(forms.forms.values())
    assert not any(sum(m[i][j] for m in matrices) for i in range(cell.V) for j in range(cell.V))
    solution = groebner(QuadraticSystem.from_rational(matrices[:-1]))
    real = sum(len(c.real_roots(20)) for c in solution.classes)
    total = sum(c.degree * c.multiplicity for c in solution.classes)
    return solution.distinct, real, total


@pytest.mark.parametrize(
    "seed", [0, 1, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(2, 8))]
)
@pytest.mark.parametrize("vertices", [2, 3, 4])
def test_random_cells_against_groebner_bases(vertices: int, seed: int) -> None:
    cell = random_cell(vertices, seed, 16, flips=seed)
    result = count_periodic(cell, (2, 1))
    expected = independent(cell, (2, 1))
    assert (result.distinct, result.real, result.with_multiplicity) == (expected[0], *expected[1:])
    pleats = 2 ** (vertices - 1) - expected[2]
    assert (pleats > 0) == bool(result.pleats)


def test_one_vertex_rolls_up_in_one_way() -> None:
    result = count_periodic(random_cell(1, 0), (1, 1))
    (branch,) = result
    assert (branch.vertex_signs, branch.b, branch.multiplicity) == ("+", -1, 1)
    assert result.pleats == ()


def test_a_fold_along_the_axis_is_flat() -> None:
    """Of a square grid with diagonals, h = x^2 / 2 folds only the vertical lines."""
    halves = [[(0, 0, 0), (0, 1, 0), (0, 1, 1)], [(0, 0, 0), (0, 1, 1), (0, 0, 1)]]
    result = count_periodic(PeriodicPattern([(1, 0), (0, 1)], [(0, 0)], halves), (1, 0))
    assert [branch.letters for branch in result] == ["MFF"]
    assert checker.check(periodic_certificate(result))["branches"][0]["letters"] == "MFF"


def test_folds_in_line_at_a_vertex_with_four_folds_are_flat_on_half_of_the_branches() -> None:
    result = count_periodic(random_cell(5, 7, 8), (2, 7))
    assert sorted(branch.letters.count("F") for branch in result) == [0] * 8 + [2] * 8
    assert not any("U" in branch.letters for branch in result)
    claims = checker.check(periodic_certificate(result))
    assert [b["letters"] for b in claims["branches"]] == [b.letters for b in result]


def test_letters_that_a_factor_shows_are_those_of_the_certificate() -> None:
    """Across 0,1 the forms of the waterbomb's vertices with six folds are products."""
    result = count_periodic("waterbomb-cell", (0, 1))
    claims = checker.check(periodic_certificate(result))
    letters = ["UMUFMFVVV", "UVUMMMFVF", "MFMFFFFFF"]  # those of the boxes
    assert [b["letters"] for b in claims["branches"]] == letters
    assert [b.letters for b in result] == ["FMFFMFVVV", "FVFMMMFVF", "MFMFFFFFF"]


def test_a_vertex_of_degree_three_is_flat_on_every_branch() -> None:
    cell = random_cell(4, 14, 16)
    assert [cell.degree(v) for v in range(4)] == [6, 9, 3, 6]
    result = count_periodic(cell, (2, 1))
    assert (result.distinct, result.with_multiplicity) == (4, 8)
    assert {(branch.vertex_signs[2], branch.multiplicity) for branch in result} == {("0", 2)}


def test_each_sign_vector_occurs_once_and_all_up_rolls_down() -> None:
    result = count_periodic(random_cell(6, 3), (3, -2))
    signs = [branch.vertex_signs for branch in result]
    assert signs == ["+" + "".join(rest) for rest in product("-+", repeat=5)]
    assert result[-1].b == -1


def test_parallel_loops_at_two_vertices_make_a_pleat() -> None:
    """Theorem: two classes of parallel straight crease lines make (H) fail."""
    result = count_periodic("yoshimura-cell", (2, 7))
    assert result.pleats == (HeightSpace(((Fraction(0), Fraction(1), Fraction(0)),)),)
    across = count_periodic("yoshimura-cell", (0, 1))
    assert (len(across), len(across.families)) == (0, 1)
    assert across.families[0].dimension == 2


@pytest.mark.parametrize(
    ("vertices", "seed", "flips", "expected"),
    [
        # All heights that are flat at the vertex with four folds are solutions.
        (3, 461, 3, (0, [1], [2])),
        # A plane of pleats, and two isolated solutions.
        (5, 891, 5, (2, [2], [])),
        # A line of a family is flat at three vertices; beside the family a form is a square.
        (5, 649, 5, (0, [1], [2])),
        (5, 844, 0, (0, [1], [2])),
    ],
)
def test_spaces_of_random_cells(
    vertices: int, seed: int, flips: int, expected: tuple[int, list[int], list[int]]
) -> None:
    result = count_periodic(random_cell(vertices, seed, 64, flips=flips), (1, 0))
    assert result.status is PROVED
    pleats, families = ([s.dimension for s in x] for x in (result.pleats, result.families))
    assert (result.distinct, pleats, families) == expected
    claims = checker.check(periodic_certificate(result))
    assert [s["dimension"] for s in claims["families"]] == families


def test_lines_over_a_quadratic_field_beside_a_plane_of_pleats() -> None:
    """Singular: at b = 1 degree 12, of the radical 10, with primes of degree 2 and 8."""
    result = count_periodic(random_cell(6, 1242, 64), (3, 4))
    assert result.status is PROVED
    assert (result.distinct, result.with_multiplicity) == (10, 12)
    assert [space.dimension for space in result.pleats] == [2]
    document = periodic_certificate(result)
    assert [line["radicand"] for line in document["evidence"]["lines"]] == [1520673] * 2
    claims = checker.check(document)
    doubled = [b["multiplicity"] for b in claims["branches"] if b["vertex_signs"][0] == "0"]
    assert doubled == [2, 2]


def test_zeros_of_a_groebner_basis_are_verified(monkeypatch: pytest.MonkeyPatch) -> None:
    false = RootClass.from_coordinates((-2, 0, 1), [(Fraction(0), Fraction(1))], 1, (1,))
    monkeypatch.setattr(groebner_bases, "classes_of_ideal", lambda *_: (false,))
    problem = PeriodicProblem.of(read_cell("yoshimura-cell"), (3, 2))
    one, zero = Fraction(1), Fraction(0)
    with pytest.raises(SolverError, match="does not vanish"):
        rays_on(problem, [(one, zero), (zero, one)], (zero, one))


def test_a_line_in_a_larger_space_is_no_component() -> None:
    problem = PeriodicProblem.of(read_cell("yoshimura-cell"), (0, 1))
    (ray,) = rays_on(problem, [(Fraction(1), Fraction(1))], (Fraction(1), Fraction(0)))
    pair = Fraction(1), Fraction(0)
    inside = QuadraticLine(2, (pair, (Fraction(0), Fraction(1))), ray)
    assert not inside.is_component(problem)


def test_pleats_do_not_depend_on_the_direction() -> None:
    known = {frozenset(count_periodic("miura-cell", n).pleats) for n in ((3, 4), (1, 0), (0, 1))}
    assert len(known) == 1


def test_the_pleats_of_a_square_twist_are_over_the_field_of_root_five() -> None:
    result = count_periodic("square-twist-cell", (1, 2))
    for line in result.pleats:
        assert isinstance(line, AlgebraicLine)
        c, b, a = line.polynomial
        assert (b * b - 4 * a * c) % 5 == 0
        square = Fraction(b * b - 4 * a * c, 5)
        assert int(square**0.5) ** 2 == square
    claims = checker.check(periodic_certificate(result))
    assert [line["radicand"] for line in claims["lines"]] == [5, 5]
    assert claims["pleats"] == []


def test_rational_solutions_that_are_not_guessed_from_floats_are_in_the_certificate(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Solved exactly where vertices are flat, and all together."""
    cell = random_cell(4, 21, 8, flips=21)
    near = count_periodic(cell, (1, 0))
    monkeypatch.setattr(counting, "solved_near", lambda *_: iter(()))
    result = count_periodic(cell, (1, 0))
    assert "Groebner" in result.reason
    assert "Groebner" not in near.reason
    assert near.branches == result.branches
    assert periodic_certificate(near)["claims"] == periodic_certificate(result)["claims"]
    claims = checker.check(periodic_certificate(result))
    assert (claims["distinct"], claims["with_multiplicity"]) == (5, 6)
    assert [line.to_dict() for line in result.pleats] == claims["pleats"]
    assert claims["pleats"] == [{"dimension": 1, "basis": [["0", "0", "1", "1/2", "0"]]}]


def test_no_certificate_states_a_pleat_in_a_larger_field(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(QuadraticLine, "of", lambda ray: None)
    result = count_periodic("square-twist-cell", (1, 2))
    assert result.status is PROVED
    with pytest.raises(NotApplicableError, match="in no quadratic field"):
        periodic_certificate(result)


def test_the_waterbomb_has_the_square_root_of_its_direction() -> None:
    """w = (0, 0, (|n|^2 +- n_1 sqrt(n_1^2 + 4 n_2^2)) / 2) at b = 1, and signs by the theorem."""
    cell = read_cell("waterbomb-cell")
    result = count_periodic(cell, (3, 2))  # the square root is that of 25
    problem = PeriodicProblem.of(cell, (3, 2))
    signs = set()
    for side in (1, -1):
        w = [Fraction(0), Fraction(13 + side * 15, 2), 1 / problem.unit]
        assert Spaces(problem).solves([tuple(w)])
        found = Spaces(problem).values(w)
        signs.add("".join("+-"[s != found[0]] for s in found))
    assert signs < {branch.vertex_signs for branch in result}
    assert len(signs) == 2


def test_simple_branches_that_a_box_proves_have_a_certificate() -> None:
    result = count_periodic(random_cell(4, 14, 16), (2, 1))
    claims = checker.check(periodic_certificate(result))
    assert claims["with_multiplicity"] == 8
    assert claims["sha256"] == result.pattern.sha256


def test_what_is_not_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UsageError, match="is no direction"):
        count_periodic("miura-cell", (0, 0))
    with pytest.raises(UsageError, match="two coordinates, not 3"):
        count_periodic("miura-cell", (0, 0, 1))
    monkeypatch.setattr(counting, "MOST", 3)
    with pytest.raises(NotCountedError, match=r"2\^3 branches are too many"):
        count_periodic("miura-cell", (1, 2))


def test_what_is_open_is_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(counting, "exact_rays", lambda problem, clock: None)
    result = count_periodic("square-twist-cell", (1, 2))
    assert str(result.status) == "undecided"
    assert (len(result.branches), result.distinct, len(result.open)) == (6, None, 2)
    assert result.to_dict()["real"] is None
    with pytest.raises(NotApplicableError, match="not proved"):
        periodic_certificate(result)
