"""`find_branch` against the enumeration, against Krawczyk's test, and under symmetries."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from independent import big_square, curvature, signs_of
from sheets import (
    HEXAGON,
    SQUARE,
    dart,
    mapped,
    mirrored,
    nested_triangles,
    reflex_corners,
    relabelled,
    rotated,
    scrambled,
    two_triangles,
    wheel,
)

from exactfold import PROVED, UNDECIDED, random_square
from exactfold.branches import count_branches
from exactfold.branches.counting.find import BranchFinder, find_branch, find_branches, neighbours
from exactfold.errors import BoundaryHeightsError, NotApplicableError, UsageError
from exactfold.pattern import degenerate, families
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.numeric.sparse_sheet import FloatSheet

CONVEX = {
    "random": random_square(5, seed=2),
    "thin triangles": scrambled(1, SQUARE, 5),
    "nested triangles": nested_triangles(),
    "two triangles": two_triangles(),
    "straight corner": scrambled(2, [(4, 0), (9, 0), (3, 8), (0, 0)], 3),
}
REFLEX = {"dart": dart(), "reflex": scrambled(3, reflex_corners(3), 3)}


@pytest.mark.parametrize("name", CONVEX)
def test_every_branch_of_the_enumeration_is_found_by_its_signs(name: str) -> None:
    pattern = CONVEX[name]
    counted = count_branches(pattern)
    assert counted.status is PROVED
    assert len(counted.branches) == 2 ** (pattern.Vi - pattern.Vt)
    for branch in counted.branches:
        found = find_branch(pattern, branch.vertex_signs)
        assert found.status is PROVED
        assert found.saddle == 1
        assert found.assignment == branch.assignment
        assert found.vertex_signs == branch.vertex_signs
        for v, (low, high) in branch.heights.items():
            assert found.heights[v][0] <= high
            assert low <= found.heights[v][1]


@pytest.mark.parametrize("name", REFLEX)
def test_reflex_sheets_too_with_the_side_of_the_saddle(name: str) -> None:
    pattern = REFLEX[name]
    counted = count_branches(pattern)
    assert counted.status is PROVED
    wanted = {(b.sign_text, b.assignment_text) for b in counted.branches}
    seen = set()
    swap = str.maketrans("+-MV", "-+VM")
    for signs in product((1, -1), repeat=pattern.Vi - pattern.Vt):
        found = find_branch(pattern, signs)
        assert found.status is PROVED
        assert found.saddle != 0
        pair = found.sign_text, found.assignment_text
        if found.saddle < 0:
            pair = pair[0].translate(swap), pair[1].translate(swap)
        seen.add(pair)
    assert seen == wanted


def test_krawczyk_isolates_the_same_solution() -> None:
    pattern = big_square(40, seed=7)
    found = find_branch(pattern, signs_of(pattern, 3))
    assert found.radius is not None
    chart = BranchSystem(pattern).chart
    point = [found.centres[v] for v in chart.variables]
    (box,) = krawczyk(chart.system, [point])
    assert isinstance(box, IsolatingBox)
    assert box.is_real
    for k, v in enumerate(chart.variables):
        low, high = box.interval(k)
        assert found.heights[v][0] <= high
        assert low <= found.heights[v][1]


def test_inertia_of_the_jacobian_counts_the_vertices_up_and_down() -> None:
    pattern = big_square(60, seed=8)
    sheet = VertexEquations(Problem.of(pattern))
    floats = FloatSheet.of(sheet)
    for seed in range(4):
        signs = signs_of(pattern, seed)
        found = find_branch(pattern, signs)
        x = np.array([float(found.centres[v]) for v in sheet.unknowns])
        omega = floats.bends(floats.heights(x))
        n = floats.n
        matrix = np.zeros((n, n))
        place = {v: k for k, v in enumerate(sheet.unknowns)}
        for (i, j), w in zip(pattern.folds, omega, strict=True):
            for a, b in ((i, j), (j, i)):
                if a in place:
                    matrix[place[a], place[a]] -= w
                    if b in place:
                        matrix[place[a], place[b]] += w
        values = np.linalg.eigvalsh(matrix)
        assert np.abs(values).min() > 1e-9 * np.abs(values).max()
        assert (values > 0).sum() == signs.count("+")


DEGENERATE = {
    "flat vertex": families.flat_vertex_square(),
    "straight path": degenerate.straight_path(4),
    "off the path": degenerate.bent_off_path(),
    "grid": degenerate.gridded_square(2, 2),
    "larger grid": degenerate.gridded_square(2, 3),
    "lattice": random_square(5, seed=0, denominator=4),
    "straight hypar": families.hypar(1, 0),
    "notched": degenerate.notched(3),
    "dart": dart(),
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=pytest.mark.slow if name == "larger grid" else ())
        for name in DEGENERATE
    ],
)
def test_what_is_flat_is_what_the_enumeration_finds_flat(name: str) -> None:
    pattern = DEGENERATE[name]
    counted = count_branches(pattern)
    assert counted.status is PROVED
    turn_over = str.maketrans("MV", "VM")
    known = {}
    for branch in counted.branches:
        signs = tuple(branch.vertex_signs[v] for v in pattern.interior)
        known[signs, branch.assignment_text] = branch.multiplicity
        if not pattern.is_convex:  # shown by the side with positive saddle
            other = tuple(-s for s in signs)
            known[other, branch.assignment_text.translate(turn_over)] = branch.multiplicity
    reached = Counter[tuple[tuple[int, ...], str]]()
    finder = BranchFinder(pattern)
    for values in product((1, -1), repeat=len(finder.poppable)):
        found = finder.find(dict(zip(finder.poppable, values, strict=True)))
        assert found.status is PROVED
        assert found.undecided_folds == ()
        signs = tuple(found.vertex_signs[v] for v in pattern.interior)
        assert all(
            found.vertex_signs[v] in (0, s) for v, s in zip(finder.poppable, values, strict=True)
        )
        reached[signs, found.assignment_text] += 1
    # All signs of flat vertices lead to the same branch, whose multiplicity (Theorem 3) they are.
    inside = 2**pattern.Vt
    assert {key: times * inside for key, times in reached.items()} == {
        key: known[key] for key in reached
    }
    assert len(reached) == len(counted.branches)


def test_exact_heights_have_no_error() -> None:
    found = find_branch(families.hypar(2, 0), "++++++++")
    assert found.radius == found.squared_distance == 0
    assert all(curvature(found.pattern, found.centres, v) == 0 for v in found.pattern.interior)


def test_errors_below_the_range_of_floats_are_still_told() -> None:
    pattern = random_square(3, seed=0)
    rim = {v: Fraction(v * v + 1, 10**400) for v in pattern.boundary}
    found = find_branch(pattern, "+-+", boundary_heights=rim)
    assert found.status is PROVED
    assert found.squared_distance
    shown = found.reason.split("within ")[1].split()[0]
    assert found.squared_distance <= Fraction(shown) ** 2 < 100 * found.squared_distance


def test_what_is_flat_for_no_rational_reason_is_undecided() -> None:
    found = find_branch(degenerate.ringed_square(4), "+++++")
    assert found.status is UNDECIDED
    assert found.undecided_vertices == (8,)
    assert "flat to within" in found.reason


def test_a_very_symmetric_sheet_is_enclosed() -> None:
    pattern = families.hypar(1)
    for seed in range(4):
        found = find_branch(pattern, signs_of(pattern, seed))
        assert found.radius is not None
        assert float(found.radius) < 1e-6


def _moved(pattern: CreasePattern, kind: str) -> tuple[CreasePattern, list[int]]:
    count = len(pattern.vertices)
    if kind == "relabelled":
        order = [*range(4), *random.Random(1).sample(range(4, count), count - 4)]
        return relabelled(pattern, order), order
    moves = {
        "rotated": rotated,
        "mirrored": mirrored,
        "scaled": lambda p: (p[0] * 10**9 / 7, p[1] * 10**9 / 7),
        "tiny": lambda p: (p[0] / 10**30 + 5, p[1] / 10**30),
    }
    return mapped(pattern, moves[kind]), list(range(count))


@pytest.mark.parametrize("kind", ["relabelled", "rotated", "mirrored", "scaled", "tiny"])
def test_symmetries(kind: str) -> None:
    pattern = random_square(9, seed=4)
    moved, order = _moved(pattern, kind)
    for seed in range(3):
        up = {v for v, s in zip(pattern.interior, signs_of(pattern, seed), strict=True) if s == "+"}
        plain = find_branch(pattern, up=up)
        other = find_branch(moved, up=[k for k, v in enumerate(order) if v in up])
        assert plain.status is other.status is PROVED
        for k, v in enumerate(order):
            low, high = other.heights[k]
            assert plain.heights[v][0] <= high
            assert low <= plain.heights[v][1]
        back = {tuple(sorted((order[i], order[j]))): s for (i, j), s in other.assignment.items()}
        assert back == dict(plain.assignment)


@pytest.mark.parametrize("power", [8, 140])
def test_an_affine_map_changes_nothing(power: int) -> None:
    # The curvature forms are those of the gradients' polygons: all scale by the determinant.
    pattern = random_square(6, seed=3)
    moved = mapped(pattern, lambda p: (p[0] * 10**power + p[1], p[1]))
    for signs in ("+-+-+-", "++++++"):
        plain, other = find_branch(pattern, signs), find_branch(moved, signs)
        assert plain.status is other.status is PROVED
        assert plain.assignment == other.assignment
        for v, (low, high) in other.heights.items():
            assert plain.heights[v][0] <= high
            assert low <= plain.heights[v][1]


@pytest.mark.parametrize("power", [200, 400])
def test_what_is_beyond_floats_is_undecided(power: int) -> None:
    pattern = mapped(random_square(3, seed=0), lambda p: (p[0] * 10**power, p[1]))
    found = find_branch(pattern, "+-+")
    assert found.status is UNDECIDED
    assert found.reason
    assert found.heights == {}
    assert set(found.assignment_text) == {"U"}
    assert found.undecided_vertices == pattern.interior
    assert found.to_dict()["radius"] is None
    reached = neighbours(pattern, "+-+", [4])
    assert reached[4].status is UNDECIDED


# --- more boundary vertices ----------------------------------------------------------------------


def test_a_rim_of_four_is_the_same_branch_up_to_scale_and_a_plane() -> None:
    pattern = random_square(5, seed=2)
    plain = find_branch(pattern, "+-+-+")
    raised = next(v for v in pattern.boundary if plain.centres[v])
    rim = {
        v: 3 * Fraction(v == raised) + 2 * pattern.vertices[v][0] - pattern.vertices[v][1]
        for v in pattern.boundary
    }
    found = find_branch(pattern, "+-+-+", boundary_heights=rim)
    assert found.assignment == plain.assignment
    assert found.saddle == 1
    for v, (x, y) in enumerate(pattern.vertices):
        low, high = found.heights[v]
        middle = 3 * plain.centres[v] + 2 * x - y
        assert low - 3 * plain.radius <= middle <= high + 3 * plain.radius


@pytest.mark.parametrize("scale", [Fraction(1), Fraction(1, 10**40), Fraction(10**40)])
def test_six_boundary_vertices_with_a_given_rim(scale: Fraction) -> None:
    pattern = scrambled(5, HEXAGON, 3)
    source = random.Random(2)
    rim = {v: scale * source.randint(-9, 9) for v in pattern.boundary}
    letters = set()
    for signs in product((1, -1), repeat=3):
        found = find_branch(pattern, signs, boundary_heights=rim)
        assert found.status is PROVED
        assert all(found.centres[v] == height for v, height in rim.items())
        for v in pattern.interior:
            assert 0 < curvature(pattern, found.centres, v) < scale**2 / 10**15
        letters.add(found.assignment_text)
    assert len(letters) > 1


def test_a_rim_that_does_not_fit_is_refused() -> None:
    pattern = scrambled(5, HEXAGON, 3)
    with pytest.raises(NotApplicableError, match="four boundary vertices"):
        BranchFinder(pattern).problem.require_foldable()
    with pytest.raises(BoundaryHeightsError, match="each boundary vertex"):
        find_branch(pattern, "+++", boundary_heights={0: 1})
    flat = {v: 2 * pattern.vertices[v][0] + 7 for v in pattern.boundary}
    with pytest.raises(BoundaryHeightsError, match="boundary is flat"):
        find_branch(pattern, "+++", boundary_heights=flat)
    with pytest.raises(NotApplicableError, match="convex"):
        find_branch(dart(), "+", boundary_heights=dict.fromkeys(dart().boundary, 1))


# --- how signs are given -------------------------------------------------------------------------


def test_all_ways_to_give_signs_agree() -> None:
    pattern = two_triangles()
    finder = BranchFinder(pattern)
    names = finder.poppable
    assert len(names) == 3
    expected = dict(zip(names, (1, -1, 1), strict=True))
    full = {v: expected.get(v, 0) for v in pattern.interior}
    text = "".join("-0+"[s + 1] for s in full.values())
    for given in ("+-+", [1, -1, 1], (1, -1, 1), expected, full, text, list(full.values())):
        assert finder.signs(given, None) == expected
    assert finder.signs(None, [names[0], names[2]]) == expected
    found = finder.find(expected)
    assert found.sign_text == text
    assert "of the pattern without its triangulated triangles" in found.reason


@pytest.mark.parametrize(
    ("signs", "up", "message"),
    [
        (None, None, "either"),
        ("+-+", [4], "either"),
        ("+-", None, r"2 signs for 3 vertices: give \+ or - for each, in the order 4, 5, 6$"),
        ("+-+-", None, "4 signs for 3 vertices"),
        ("+x+", None, "'x' is not a vertex sign"),
        ([1, 2, 1], None, "2 is not a vertex sign"),
        ([1, [], 1], None, "not a vertex sign"),
        ({4: 1, 5: 1}, None, "vertex 6 has no sign"),
        ({4: 1, 5: 1, 6: 2}, None, "the sign of vertex 6 is 2"),
        ({4: 1, 5: 1, 6: 0}, None, "no branch has these signs: vertex 6 is not flat"),
        ({4: 1, 5: 1, 6: 1, 0: 1}, None, "vertex 0 is not an interior vertex"),
        (None, [0], "vertex 0 is not an interior vertex"),
    ],
)
def test_signs_that_do_not_fit_are_refused(signs: object, up: object, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        find_branch(random_square(3, seed=0), signs, up=up)  # type: ignore[arg-type]


def test_vertices_in_triangulated_triangles_cannot_pop() -> None:
    pattern = two_triangles()
    rigid = min(pattern.rigid_vertices)
    with pytest.raises(UsageError, match=f"vertex {rigid} lies in a triangulated triangle"):
        find_branch(pattern, up=[rigid])
    with pytest.raises(UsageError, match="triangulated triangle"):
        neighbours(pattern, "+++", [rigid])
    with pytest.raises(UsageError, match=r"2 signs for 3 vertices \(or 5"):
        find_branch(pattern, "++")


def test_sheets_without_anything_to_pop_are_refused() -> None:
    flat = CreasePattern(SQUARE, [(0, 1, 2), (0, 2, 3)])
    with pytest.raises(NotApplicableError, match="no interior vertex"):
        find_branch(flat, "")
    inside = CreasePattern(
        [*SQUARE, (Fraction(2, 3) * SQUARE[1][0], Fraction(1, 3) * SQUARE[2][1])],
        [(0, 1, 4), (1, 2, 4), (0, 4, 2), (0, 2, 3)],
    )
    with pytest.raises(NotApplicableError, match="triangulated triangles"):
        find_branch(inside, "")


# --- several at once -----------------------------------------------------------------------------


def test_a_batch_is_the_same_as_one_at_a_time() -> None:
    pattern = random_square(7, seed=6)
    many = [signs_of(pattern, seed) for seed in range(5)]
    for signs, found in zip(many, find_branches(pattern, many), strict=True):
        assert found.sign_text == signs
        assert found.assignment == find_branch(pattern, signs).assignment


def test_neighbours_are_the_branches_with_one_sign_changed() -> None:
    pattern = big_square(170, seed=2)
    signs = signs_of(pattern, 5)
    chosen = pattern.interior[3:40:9]
    reached = neighbours(pattern, signs, chosen)
    assert tuple(reached) == chosen
    for v, found in reached.items():
        k = pattern.interior.index(v)
        expected = signs[:k] + ("-" if signs[k] == "+" else "+") + signs[k + 1 :]
        assert found.sign_text == expected
        assert found.status is PROVED
        assert found.assignment == find_branch(pattern, expected).assignment


def test_progress_is_reported() -> None:
    pattern = random_square(4, seed=1)
    seen: list[str] = []
    find_branch(pattern, "++++", progress=lambda stage, done, total: seen.append(stage))
    neighbours(pattern, "++++", progress=lambda stage, done, total: seen.append(stage))
    assert set(seen) == {"Newton steps", "proof", "neighbours"}


@pytest.mark.parametrize("signs", [{4: True, 5: -1.0, 6: np.int64(1)}, np.array([1, -1, 1])])
def test_signs_are_plain_integers(signs: object) -> None:
    found = find_branch(random_square(3, seed=0), signs)  # type: ignore[arg-type]
    assert [type(s) for s in found.vertex_signs.values()] == [int] * 3
    assert found.sign_text == "+-+"


def test_where_it_fails_the_vertex_is_named() -> None:
    near = Fraction(1, 10**150)
    pattern = wheel(SQUARE, (2 * near, near))
    found = find_branch(pattern, "+")
    assert found.status is UNDECIDED
    assert "vertex 4" in found.reason


def test_the_signs_of_every_listed_branch_find_it() -> None:
    """Also with a 0, where a vertex is proved flat; no others with a 0 name a branch."""
    pattern = families.FAMILIES["flat-vertex"]()
    listed = {b.sign_text: b.assignment_text for b in count_branches(pattern).branches}
    assert set(listed) == {"+0", "--", "-+"}
    for signs in map("".join, product("+-0", repeat=2)):
        if "0" not in signs or signs in listed:
            found = find_branch(pattern, signs)
            assert found.status is PROVED
            assert found.assignment_text == listed[found.sign_text]
            assert signs in ("++", "+-", found.sign_text)
        else:
            with pytest.raises(UsageError, match="no branch has these signs: vertex"):
                find_branch(pattern, signs)
    with pytest.raises(UsageError, match="the sign of vertex 5 is 0: neighbours differ"):
        neighbours(pattern, "+0")


def test_a_zero_on_a_branch_that_stays_open_is_undecided() -> None:
    pattern = degenerate.ringed_square(4)
    signs = "+" * pattern.Vi
    assert find_branch(pattern, signs).status is UNDECIDED
    assert find_branch(pattern, "0" + signs[1:]).status is UNDECIDED
