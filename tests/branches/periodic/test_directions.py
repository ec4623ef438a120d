"""All directions together: crossings and permutation, beside branches followed in floats."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

import exactfold
from exactfold import UNDECIDED, Verdict
from exactfold._support.clock import Clock
from exactfold.branches import count_directions, count_periodic
from exactfold.branches.periodic import crossings, families
from exactfold.branches.periodic.crossings import Crossings, OpenVertexError
from exactfold.branches.periodic.directions_result import ExactDirection
from exactfold.branches.periodic.families import Families, OpenFamiliesError
from exactfold.errors import SolverError, UsageError
from exactfold.pattern import PeriodicPattern, random_cell, read_cell
from exactfold.rigidity.equations.all_directions import AllDirections
from exactfold.rigidity.equations.periodic import PeriodicProblem
from exactfold.rigidity.equations.quadratic import primitive_matrices
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.no_zeros import only_zero
from exactfold.solve.numeric.periodic_rays import PeriodicRays


def followed(pattern: PeriodicPattern, steps: int) -> dict[str, str]:
    """Where each sign vector (b > 0) comes back after a half turn, by extrapolation in floats."""

    def at(k: int) -> tuple[np.ndarray, list[str]]:
        angle = 0.0037 + math.pi * k / steps
        ends = (Fraction(f(angle)).limit_denominator(10**6) for f in (math.cos, math.sin))
        problem = PeriodicProblem.of(pattern, list(ends))
        rays = PeriodicRays(problem)
        z = rays.rays()
        p, q = problem.direction
        b = z[:, -1] * float(problem.unit) * (p * p + q * q)
        signs = (rays.signs * np.sign(b)[:, None]).astype(int).tolist()
        return z[:, :-1] / b[:, None], ["".join("-0+"[s + 1] for s in row) for row in signs]

    points, first = at(0)
    paths = [points]
    order = np.arange(len(points))
    for k in range(1, steps + 1):
        points, names = at(k)
        weights = {1: [1], 2: [-1, 2], 3: [1, -3, 3]}.get(len(paths), [-1, 4, -6, 4])
        guess = sum(w * path for w, path in zip(weights, paths[-4:], strict=True))
        gaps = np.linalg.norm(guess[:, None] - points[None], axis=2)
        order = linear_sum_assignment(gaps)[1]
        paths.append(points[order])
    return {first[i]: names[j] for i, j in enumerate(order)}


def permuted(pattern: PeriodicPattern) -> dict[str, str]:
    """The same from the exact answer."""
    result = count_directions(pattern)
    assert result.status is Verdict.PROVED, result.reason
    assert result.permutation is not None
    flip = str.maketrans("+-", "-+")
    names = [
        branch.vertex_signs if branch.b > 0 else branch.vertex_signs.translate(flip)
        for branch in result.branches
    ]
    return {names[k]: names[end] for k, end in enumerate(result.permutation)}


@pytest.mark.parametrize(
    ("cell", "steps"),
    [
        (read_cell("waterbomb-cell"), 31),
        pytest.param(read_cell("resch-cell"), 151, marks=pytest.mark.slow),
        pytest.param(random_cell(3, 4, 64), 151, marks=pytest.mark.slow),
        pytest.param(random_cell(3, 0, 64), 801, marks=pytest.mark.slow),
        pytest.param(random_cell(4, 1, 64, flips=4), 1601, marks=pytest.mark.survey),
        pytest.param(random_cell(4, 4, 64), 1601, marks=pytest.mark.survey),
    ],
)
def test_branches_followed_in_floats_come_back_as_proved(cell: PeriodicPattern, steps: int) -> None:
    assert followed(cell, steps) == permuted(cell)


def test_the_waterbomb_has_one_crossing_and_the_resch_pattern_a_cycle_of_four() -> None:
    waterbomb = count_directions("waterbomb-cell")
    (crossing,) = waterbomb.crossings
    assert (str(crossing.direction), crossing.angle) == ("0,1", 90.0)
    assert (crossing.vertex_signs, crossing.b, crossing.vertices) == ("++0", -1, (2,))
    assert waterbomb.cycles == ((1,), (2,), (3, 4))
    resch = exactfold.count("resch-cell", direction="all")
    assert [str(c.direction) for c in resch.crossings] == ["26,15", "0,1", "-26,15"]
    assert sorted(map(len, resch.cycles or ())) == [1, 1, 2, 4]
    assert resch.turns == 4


@pytest.mark.parametrize("seed", [0, 4])
def test_a_crossing_is_a_solution_with_flat_vertices_for_its_direction(seed: int) -> None:
    cell = random_cell(3, seed, 64)
    rational = [c for c in count_directions(cell).crossings if c.direction.is_rational]
    assert rational
    for crossing in rational:
        direction = crossing.direction.x[0], crossing.direction.y[0]
        found = {b.vertex_signs: b for b in count_periodic(cell, direction)}
        assert found[crossing.vertex_signs].b == crossing.b
        assert found[crossing.vertex_signs].multiplicity == 1 << len(crossing.vertices)


def test_an_algebraic_direction_is_near_a_branch_with_a_nearly_flat_vertex() -> None:
    cell = random_cell(3, 0, 64)
    crossing = next(c for c in count_directions(cell).crossings if not c.direction.is_rational)
    exact = crossing.direction
    low, high = exact.interval
    assert high - low <= Fraction(1, 2**64)
    t = (low + high) / 2
    x, y = (sum(c * t**k for k, c in enumerate(form)) for form in (exact.x, exact.y))
    assert math.degrees(math.atan2(y, x)) % 180 == pytest.approx(crossing.angle, abs=1e-9)
    near = [Fraction(value).limit_denominator(10**9) for value in (x / y, 1)]
    rays = PeriodicRays(PeriodicProblem.of(cell, near))
    (vertex,) = crossing.vertices
    assert np.abs(rays.rays() @ rays.lines[vertex]).min() < 1e-4


def test_mirror_images_turn_the_other_way_round() -> None:
    cell = random_cell(3, 4, 64)
    other = PeriodicPattern(
        [(-x, y) for x, y in cell.lattice], [(-x, y) for x, y in cell.points], cell.faces
    )
    there, back = permuted(cell), permuted(other)
    assert any(a != b for a, b in there.items())
    assert {b: a for a, b in there.items()} == back
    angles = sorted(180 - c.angle for c in count_directions(cell).crossings)
    assert angles == pytest.approx([c.angle for c in count_directions(other).crossings])


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("miura-cell", "3 spaces of pleats"),
        pytest.param("kisrhombille-cell", "has a flat vertex", marks=pytest.mark.slow),
    ],
)
def test_what_is_not_known_is_said(name: str, reason: str) -> None:
    result = count_directions(name)
    assert result.status is UNDECIDED
    assert reason in result.reason
    assert result.permutation is None
    assert result.cycles is None


def directions_of_families(cell: PeriodicPattern) -> list[str]:
    result = count_directions(cell)
    assert result.status is UNDECIDED
    assert result.families is not None
    for n in result.families:
        assert count_periodic(cell, (n.x[0], n.y[0])).families
    for direction in ((3, 4), (1, -2), (7, 1)):
        assert not count_periodic(cell, direction).families
    return [str(n) for n in result.families]


@pytest.mark.parametrize(
    ("name", "expected"),
    [("yoshimura-cell", ["0,1"]), ("miura-cell", ["0,1"]), ("square-twist-cell", [])],
)
def test_families_are_at_single_directions(name: str, expected: list[str]) -> None:
    """Miura's rigid panels roll up in the same direction."""
    cell = read_cell(name)
    assert directions_of_families(cell) == expected


@pytest.mark.parametrize(
    ("vertices", "seed", "flips", "expected"),
    [(3, 461, 3, ["1,0"]), (5, 891, 5, ["1,12"]), (5, 1150, 0, ["-3,26"])],
)
def test_families_of_random_cells(
    vertices: int, seed: int, flips: int, expected: list[str]
) -> None:
    """A plane of pleats; and a pleat with flat vertices, where forms are left to solve."""
    assert directions_of_families(random_cell(vertices, seed, 64, flips=flips)) == expected


def rows_of_loops(number: int) -> PeriodicPattern:
    """Parallel lines of loop edges: the pleats are all profiles across them."""
    points = [(Fraction(k % 2, 3), Fraction(k)) for k in range(number)]
    faces = []
    for k in range(number):
        v, j = (k + 1) % number, (k + 1) // number
        faces.append(((k, 0, 0), (k, 1, 0), (v, 0, j)))
        faces.append(((k, 1, 0), (v, 1, j), (v, 0, j)))
    return PeriodicPattern([(1, 0), (0, number)], points, faces)


def test_a_direction_is_rational_where_the_root_is_not() -> None:
    """(1 + 2 t, 3 + 6 t) is 1,3 up to a factor for every t; (1 + 2 t, 3 + 5 t) is not rational."""
    root = (-2, 0, 1), (Fraction(1), Fraction(2))
    for sign in (1, -1):
        n = ExactDirection.of(*root, (sign, 2 * sign), (3 * sign, 6 * sign))
        assert n == ExactDirection.of((0, 1), (Fraction(0), Fraction(0)), (1,), (3,))
    assert str(ExactDirection.of(*root, (0, 2), (0, 0))) == "1,0"
    assert not ExactDirection.of(*root, (1, 2), (3, 5)).is_rational


def test_directions_with_families_that_are_not_known() -> None:
    assert directions_of_families(rows_of_loops(2)) == ["0,1"]
    result = count_directions(rows_of_loops(4))
    assert result.families is None
    assert "pleats form a space of dimension 3" in result.reason
    cell = read_cell("miura-cell")
    base = count_periodic(cell, (3, 4))
    with pytest.raises(OpenFamiliesError, match="time limit of 0 seconds"):
        Families(AllDirections.of(cell), base, Clock(0)).directions()
    with pytest.raises(OpenFamiliesError, match="in no quadratic field"):
        Families(AllDirections.of(cell), replace(base, evidence=None), Clock()).directions()


def test_zeros_of_a_groebner_basis_are_verified(monkeypatch: pytest.MonkeyPatch) -> None:
    def false(_: object, size: int) -> tuple[RootClass, ...]:
        point = [(Fraction(0), Fraction(1))] * size
        return (RootClass.from_coordinates((-2, 0, 1), point, 1, (1, *[0] * (size - 1))),)

    monkeypatch.setattr(families, "classes_of_ideal", false)
    with pytest.raises(SolverError, match="does not vanish"):
        count_directions(random_cell(5, 1150, 64))


def test_a_time_limit_and_a_tangent_that_may_be_flat_leave_it_open(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    cell = random_cell(3, 0, 64)
    with pytest.raises(OpenVertexError, match="time limit of 0 seconds"):
        list(Crossings(AllDirections.of(cell), Clock(0)).places(1))
    assert "seconds" in count_directions(cell, limit=0).reason
    monkeypatch.setattr(Crossings, "_flips_modulo", lambda *_: False)
    result = count_directions(cell)
    assert result.status is UNDECIDED
    assert "a tangent may be flat" in result.reason
    assert len(result.crossings) == 3


def test_matrices_and_bases_that_would_take_too_long_are_not_begun(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """At vertex 2, there are seven quadrics in six unknowns; at vertex 0 they have no zeros."""
    whole = AllDirections.of(random_cell(8, 100, 16))
    star = whole.flat_star(0)
    assert star is not None
    matrices = primitive_matrices(star.forms)
    assert only_zero([], matrices, 2147483647, Clock(100))
    assert not only_zero([], matrices, 2147483647, Clock(0))
    monkeypatch.setattr(crossings, "only_zero", lambda *_: False)
    monkeypatch.setattr(crossings, "classes_of_ideal", None)
    with pytest.raises(OpenVertexError, match="6 unknowns are too many under a limit"):
        list(Crossings(whole, Clock(1000)).places(2))


def test_the_tangent_test_refuses_if_the_forms_of_other_flat_vertices_are_missing() -> None:
    """Without the second flat vertex in F, a z at which the first one is flat is a solution."""
    crossings = Crossings(AllDirections.of(random_cell(3, 0, 64)), Clock())
    place = next(place for place in crossings.places(1) if len(place.flat) == 2)
    assert place.flips
    assert not crossings._flips(place.star, place.zeros, place.flat[:1])


def test_a_direction_must_be_one_or_all() -> None:
    with pytest.raises(UsageError):
        exactfold.count("waterbomb-cell", direction="some")  # type: ignore[call-overload]


def test_a_vertex_with_four_folds_may_be_flat_for_all_directions() -> None:
    """Vertices 0 and 2 lie in a parallelogram of loop edges of vertex 1."""
    cell = random_cell(3, 421, 64, flips=3)
    assert [cell.degree(v) for v in range(3)] == [4, 10, 4]
    assert [edge for edge in cell.edges if edge[0] == edge[1]] == [(1, 1, 1, 0), (1, 1, 1, 1)]
    for direction in ((31, 17), (-13, 29), (5, 47), (1, 7), (2, -1), (0, 1)):
        result = count_periodic(cell, direction)
        assert result.status is Verdict.PROVED
        assert not result.pleats
        (flat,) = (branch for branch in result if "0" in branch.vertex_signs)
        assert (flat.vertex_signs[2], flat.multiplicity) == ("0", 2)
    with pytest.raises(OpenVertexError, match="flat on a whole curve"):
        list(Crossings(AllDirections.of(cell), Clock()).places(2))
    assert count_directions(cell).status is UNDECIDED
