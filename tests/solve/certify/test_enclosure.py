"""The exact check: its formulas against the definitions, its bounds, and what it must refuse."""

from __future__ import annotations

import random
from fractions import Fraction

import networkx as nx
import numpy as np
import pytest
from independent import big_square, curvature, dirichlet, signs_of
from sheets import SQUARE, dart, reflex_corners, scrambled

from exactfold.branches.counting.find import BranchFinder
from exactfold.pattern.triangulating.random_squares import random_square
from exactfold.rigidity.equations.gauge import Gauge
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.rigidity.functionals import fold_functional, vertex_sign_functional
from exactfold.solve.certify import enclosure
from exactfold.solve.certify.enclosure import (
    Enclosure,
    curvatures,
    enclose,
    height_radius,
    nappes,
    root_above,
    round_up,
)
from exactfold.solve.certify.refinement import Heights, exact, refine
from exactfold.solve.numeric.sparse_newton import solve
from exactfold.solve.numeric.sparse_sheet import FloatSheet

SHEETS = {
    "random": random_square(6, seed=3),
    "thin": scrambled(1, SQUARE, 6),
    "dart": dart(),
    "reflex": scrambled(3, reflex_corners(3), 4),
}


def proposal(sheet: VertexEquations, signs: str, level: int) -> Heights:
    floats = FloatSheet.of(sheet)
    e = np.array([1.0 if s == "+" else -1.0 for s in signs])
    end = solve(floats, e)
    assert not end.failure
    found = refine(sheet, floats, e, exact(sheet, floats, end.x), level)
    assert found is not None
    return found


def fractions(found: Heights) -> dict[int, Fraction]:
    return {v: Fraction(int(h), found.denominator) for v, h in enumerate(found.values)}


@pytest.mark.parametrize("height", [1, 10**12, 10**400])
def test_nappes_in_floats_are_the_exact_ones(height: int, monkeypatch: pytest.MonkeyPatch) -> None:
    sheet = VertexEquations(Problem.of(random_square(30, seed=3)))
    source = random.Random(7)
    heights = np.array([source.randint(-height, height) for _ in sheet.pattern.vertices])
    flat = sheet.unknowns[4]
    for v in (flat, *sheet.pattern.star(flat)):
        heights[v] = 0
    bends = sheet.folds.bends(heights.astype(object))
    found = nappes(sheet, bends)
    assert found[flat] == 0
    monkeypatch.setattr(enclosure, "_CLEAR", np.inf)
    assert nappes(sheet, bends) == found


@pytest.mark.parametrize("name", SHEETS)
def test_folds_give_the_curvature_forms(name: str) -> None:
    sheet = VertexEquations(Problem.of(SHEETS[name]))
    pattern, folds = sheet.pattern, sheet.folds
    source = random.Random(5)
    values = [source.randint(-99, 99) for _ in pattern.vertices]
    heights = np.array(values, dtype=object)
    bends = folds.bends(heights)
    for e, fold in enumerate(pattern.folds):
        weights = fold_functional(pattern, fold)
        assert bends[e] == sum(w * values[v] for v, w in weights.items())
    found = curvatures(sheet.folds, heights, 40)
    degrees = pattern.degrees
    for v in pattern.interior:
        unit = 2 << 40  # of integer lengths
        value = curvature(pattern, dict(enumerate(map(Fraction, values))), v)
        value *= unit * Fraction(1, pattern.integer_vertices[1] ** 2)
        assert found.low[v] <= value <= found.high[v]
        assert found.high[v] - found.low[v] <= degrees[v]


@pytest.mark.parametrize("name", SHEETS)
def test_a_proof_holds_by_the_definitions(name: str) -> None:
    sheet = VertexEquations(Problem.of(SHEETS[name]))
    signs = "".join("+-"[k % 2] for k in range(len(sheet.poppable)))
    if sheet.corner is not None:
        signs = "".join(
            "+" if v == sheet.corner else "+-"[k % 2] for k, v in enumerate(sheet.unknowns)
        )
    found = proposal(sheet, signs, 80)
    proof = enclose(sheet, found.values, found.denominator, found.bits)
    assert isinstance(proof, Enclosure)
    heights = fractions(found)
    for v, sign in zip(sheet.unknowns, signs, strict=True):
        assert curvature(sheet.pattern, heights, v) > 0
        side = sum(c * heights[u] for u, c in vertex_sign_functional(sheet.pattern, v).items())
        assert (side > 0) == (sign == "+") == (proof.signs[v] == 1)
    for fold, letter in zip(sheet.pattern.folds, proof.letters, strict=True):
        bend = sum(c * heights[u] for u, c in fold_functional(sheet.pattern, fold).items())
        assert letter == (bend > 0) - (bend < 0)


@pytest.mark.parametrize("name", SHEETS)
@pytest.mark.parametrize("level", [6, 12, 24])
def test_the_distance_is_bounded_and_not_much_too_large(name: str, level: int) -> None:
    sheet = VertexEquations(Problem.of(SHEETS[name]))
    signs = "+" * len(sheet.unknowns)
    rough, fine = proposal(sheet, signs, level), proposal(sheet, signs, 200)
    proof = enclose(sheet, rough.values, rough.denominator, rough.bits)
    assert isinstance(proof, Enclosure)
    near, far = fractions(fine), fractions(rough)
    gap = {v: far[v] - near[v] for v in near}
    true = dirichlet(sheet.pattern, gap)
    assert 0 < true <= proof.squared_distance
    assert proof.squared_distance <= len(sheet.unknowns) * Fraction(2, 1 << level)
    assert max(map(abs, gap.values())) <= height_radius(sheet, proof.squared_distance)
    # Letters decided with a rough bound are those of the fine one.
    best = enclose(sheet, fine.values, fine.denominator, fine.bits)
    assert isinstance(best, Enclosure)
    assert all(best.letters) == (name != "dart")  # which has a straight crease
    assert all(a in (0, b) for a, b in zip(proof.letters, best.letters, strict=True))


def test_a_rough_bound_leaves_letters_open() -> None:
    sheet = VertexEquations(Problem.of(SHEETS["random"]))
    found = proposal(sheet, "+-+-+-", 3)
    proof = enclose(sheet, found.values, found.denominator, found.bits)
    assert isinstance(proof, Enclosure)
    assert 0 in proof.letters


def test_the_inequality_for_any_two_sheets_in_the_same_nappes() -> None:
    # Theorem 5 (a) with targets other than zero, in exact arithmetic.
    sheet = VertexEquations(Problem.of(SHEETS["thin"]))
    pattern = sheet.pattern
    points, denominator = pattern.integer_vertices
    radius = 2 * max(x * x + y * y for x, y in points)
    for seed in range(3):
        signs = "".join(random.Random(seed).choice("+-") for _ in sheet.unknowns)
        first, second = proposal(sheet, signs, 5), proposal(sheet, signs, 9)
        assert isinstance(enclose(sheet, first.values, first.denominator, first.bits), Enclosure)
        assert isinstance(enclose(sheet, second.values, second.denominator, second.bits), Enclosure)
        a, b = fractions(first), fractions(second)
        bound = 0.0
        for v in pattern.interior:
            m = Fraction(radius - sum(x * x for x in points[v]), denominator**2)
            roots = [float(curvature(pattern, h, v)) ** 0.5 for h in (a, b)]
            bound += float(m) * (roots[0] - roots[1]) ** 2
        assert 0 < float(dirichlet(pattern, {v: a[v] - b[v] for v in a})) <= bound * (1 + 1e-9)


def test_a_vertex_of_negative_curvature_is_named() -> None:
    sheet = VertexEquations(Problem.of(SHEETS["random"]))
    found = proposal(sheet, "+-+-+-", 80)
    v = sheet.unknowns[2]
    values = found.values.copy()
    values[v] += found.denominator // 1000
    heights = {u: Fraction(int(h), found.denominator) for u, h in enumerate(values)}
    failed = enclose(sheet, values, found.denominator, found.bits)
    negative = {u for u in sheet.unknowns if curvature(sheet.pattern, heights, u) <= 0}
    assert isinstance(failed, tuple)
    assert negative <= set(failed)
    assert negative


def test_curvature_zero_does_not_pass() -> None:
    # A sheet that is flat but for one corner has K = 0 at almost every vertex.
    sheet = VertexEquations(Problem.of(SHEETS["random"]))
    flat = np.array([0] * len(sheet.pattern.vertices), dtype=object)
    for v, height in sheet.boundary_heights.items():
        flat[v] = height
    assert isinstance(enclose(sheet, flat, sheet.boundary_denominator, 8), tuple)


def test_another_rim_is_refused() -> None:
    sheet = VertexEquations(Problem.of(SHEETS["random"]))
    found = proposal(sheet, "+-+-+-", 80)
    for v in sheet.pattern.boundary:
        values = found.values.copy()
        values[v] += 1
        with pytest.raises(ValueError, match="are not those of the sheet"):
            enclose(sheet, values, found.denominator, found.bits)


def test_a_boundary_that_is_not_convex_is_refused() -> None:
    pattern = dart()
    flat = Gauge("rim", pattern, dict.fromkeys(pattern.boundary, Fraction(0)))
    sheet = VertexEquations(Problem(pattern, pattern, tuple(range(5)), flat))
    with pytest.raises(ValueError, match="convex"):
        enclose(sheet, np.array([0] * 5, dtype=object), 1, 8)


@pytest.mark.parametrize(
    "value", [Fraction(2), Fraction(1, 3**200), Fraction(10**80 + 1, 7), Fraction(1 << 90)]
)
def test_roundings_go_up_and_not_far(value: Fraction) -> None:
    assert value <= root_above(value) ** 2 <= value * (1 + Fraction(1, 1 << 28))
    assert value <= round_up(value) <= value * (1 + Fraction(1, 1 << 22))


def test_a_large_sheet_by_the_definitions() -> None:
    pattern = big_square(260, seed=4)
    assert pattern.Vi > 200  # the sparse solver
    signs = signs_of(pattern, 1)
    branch = BranchFinder(pattern).find(BranchFinder(pattern).signs(signs, None))
    assert str(branch.status) == "proved"
    assert branch.undecided_folds == ()
    for v, sign in zip(pattern.interior, signs, strict=True):
        assert 0 < curvature(pattern, branch.centres, v) < Fraction(1, 10**20)
        side = sum(c * branch.centres[u] for u, c in vertex_sign_functional(pattern, v).items())
        assert (side > 0) == (sign == "+")


@pytest.mark.parametrize("name", SHEETS)
def test_the_radius_is_the_longest_shortest_path_from_the_rim(name: str) -> None:
    """Against NetworkX, on costs from exact squared lengths and areas."""
    sheet = VertexEquations(Problem.of(SHEETS[name]))
    points = sheet.pattern.integer_vertices[0]
    graph = nx.Graph()
    for (i, j), left, right in zip(
        sheet.pattern.folds, sheet.folds.left, sheet.folds.right, strict=True
    ):
        squared = sum((a - b) ** 2 for a, b in zip(points[i], points[j], strict=True))
        graph.add_edge(i, j, cost=(2 * squared / max(left, right)) ** 0.5)
    rim = [v for v in sheet.pattern.boundary if v in graph]
    far = nx.multi_source_dijkstra_path_length(graph, rim, weight="cost")
    radius = height_radius(sheet, Fraction(1, 10**6))
    assert 1 <= radius * 1000 / Fraction(max(far.values())) <= 1 + Fraction(1, 10**5)
