"""Newton on the nappes finds the end of every popping path, each with the signs asked for."""

from fractions import Fraction

import numpy as np
import pytest
from sheets import SQUARE, dart, mapped, mirrored, reflex_corners, rotated, scrambled

from exactfold import random_square
from exactfold.errors import NotApplicableError
from exactfold.pattern import families, read_fold
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import example_path
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import chamber_chart
from exactfold.rigidity.timelike import round_cone
from exactfold.solve.numeric.dense_newton import NappeSystem, SweptPoints
from exactfold.solve.numeric.nappe_newton import sign_vectors, solve_each
from exactfold.solve.numeric.popping import popping
from exactfold.solve.numeric.refined_newton import refined_end

PATTERNS = {
    "random square": random_square(6, seed=3),
    "thin triangles": scrambled(1, SQUARE, 6),
    "reflex corner": scrambled(3, reflex_corners(3), 6),
    "dart": dart(),
    "flat vertex": read_fold(example_path("flat-vertex")),
    "hypar": families.hypar(1),
}


def every_end(pattern: CreasePattern) -> SweptPoints:
    return NappeSystem(chamber_chart(pattern)).ends(sign_vectors(0, 1 << pattern.Vi, pattern.Vi))


@pytest.mark.parametrize("name", PATTERNS)
def test_all_paths_end_where_popping_says(name: str) -> None:
    pattern, _ = PATTERNS[name].without_rigid_parts()
    ends = every_end(pattern)
    assert ends.converged.all()
    expected = popping(chamber_chart(pattern)).points.real
    gaps = np.abs(ends.points[:, None] - expected[None]).max(axis=2)
    assert gaps.min(axis=0).max() < 1e-6
    assert gaps.min(axis=1).max() < 1e-6


@pytest.mark.parametrize("name", PATTERNS)
def test_ends_have_zero_curvature_and_the_signs_asked_for(name: str) -> None:
    pattern, _ = PATTERNS[name].without_rigid_parts()
    system = NappeSystem(chamber_chart(pattern))
    signs = sign_vectors(0, 1 << pattern.Vi, pattern.Vi)
    z = np.hstack([system.ends(signs).points, np.ones((len(signs), 1))])
    tensor = system.chart.system.float_tensor
    assert np.abs(np.einsum("pij,bi,bj->bp", tensor, z, z)).max() < 1e-10
    if pattern.reflex_corner is None:
        lines = np.array([[float(c) for c in nappe.line] for nappe in system.nappes])
        assert ((z @ lines.T) * signs > -1e-12).all()


def test_nappes_are_curvature_forms_written_as_a_difference_of_squares() -> None:
    pattern = random_square(4, seed=2)
    system = NappeSystem(chamber_chart(pattern))
    z = [Fraction(3, 7), Fraction(-2, 5), Fraction(1, 3), Fraction(5, 2), Fraction(1)]
    heights = system.chart.heights(z[:-1])
    for v, nappe in zip(pattern.interior, system.nappes, strict=True):

        def at(row: tuple[Fraction, ...]) -> Fraction:
            return sum((a * b for a, b in zip(row, z, strict=True)), Fraction(0))

        form, cone = curvature_form(pattern, v), round_cone(pattern, v)
        hat = {u: Fraction(int(u == v)) for u in form.labels}
        value = at(nappe.line) ** 2 - sum(d * at(row) ** 2 for d, row in nappe.squares)
        assert value * form.polar(cone, hat) ** 2 == form(cone) * form(heights)
        floats = np.array([float(c) for c in z])
        assert floats @ nappe.form @ floats == pytest.approx(float(value), rel=1e-12)
        assert len(nappe.squares) == pattern.degree(v) - 3
        assert all(d > 0 for d, _ in nappe.squares)


@pytest.mark.parametrize("move", [rotated, mirrored])
def test_motions_of_the_plane_keep_the_heights(move: object) -> None:
    pattern = random_square(5, seed=7)
    moved = mapped(pattern, move)
    if move is mirrored:
        moved = CreasePattern(moved.vertices, [t[::-1] for t in pattern.triangles])
    # The boundary saddle may be normalised at another corner: the square's are all +-1.
    first, second = every_end(pattern).points, every_end(moved).points
    assert np.abs(first - second).max() < 1e-10


def test_nearly_flat_stars_converge() -> None:
    tiny = Fraction(1, 10**9)
    points = [(0, 0), (1, 0), (1, 1), (0, 1), ("1/2", Fraction(1, 2) + tiny), ("7/10", "1/5")]
    faces = [(0, 1, 5), (1, 2, 5), (2, 4, 5), (4, 0, 5), (2, 3, 4), (3, 0, 4)]
    ends = every_end(CreasePattern(points, faces))
    assert ends.converged.all()
    assert len(np.unique(np.round(ends.points, 12), axis=0)) == 4


@pytest.mark.parametrize(
    ("first", "count"), [(0, 1), (0, 32), (256, 256), (512, 512), (1023, 1), (0, 1024)]
)
def test_ends_of_blocks_are_those_of_single_sign_vectors(first: int, count: int) -> None:
    system = NappeSystem(chamber_chart(random_square(10, seed=5)))
    block = system.ends_of_block(first, count)
    single = system.ends(sign_vectors(first, count, 10))
    assert block.converged.all()
    assert np.abs(block.points - single.points).max() < 1e-12
    assert count < 128 or block.steps < 0.9 * single.steps


def test_singular_matrices_spoil_only_their_own_solution() -> None:
    matrices = np.array([np.eye(2), np.zeros((2, 2)), 2 * np.eye(2)])
    found = solve_each(matrices, np.ones((3, 2)))
    assert found[0].tolist() == [1, 1]
    assert found[2].tolist() == [0.5, 0.5]
    assert not np.isfinite(found[1]).any()


@pytest.mark.parametrize("name", PATTERNS)
def test_the_square_of_the_line_less_the_squares_is_the_curvature(name: str) -> None:
    system = NappeSystem(chamber_chart(PATTERNS[name]))
    sheet, gauge = system.gauge.sheet, system.gauge
    x = [Fraction(k * k + 1, k + 2) for k in range(len(gauge.unknowns))]
    heights = {**gauge.boundary_heights, **dict(zip(gauge.unknowns, x, strict=True))}
    for v, nappe in zip(gauge.unknowns, system.nappes, strict=True):
        cone, form = round_cone(sheet, v), curvature_form(sheet, v)
        star = {u: heights[u] for u in form.labels}
        line, *values = (
            sum(c * z for c, z in zip(row, [*x, 1], strict=True))
            for row in (nappe.line, *(row for _, row in nappe.squares))
        )
        hub = form.functional(cone)[v]
        assert line == form.polar(cone, star) / hub
        assert all(weight > 0 for weight, _ in nappe.squares)
        squares = sum(w * b**2 for (w, _), b in zip(nappe.squares, values, strict=True))
        assert line**2 - squares == form(cone) / hub**2 * (form(star) - gauge.targets.get(v, 0))


def test_other_boundaries_are_refused() -> None:
    with pytest.raises(NotApplicableError):
        chamber_chart(families.single_vertex(5))


@pytest.mark.parametrize("name", ["random square", "reflex corner", "flat vertex"])
def test_refined_ends_agree_with_doubles_and_between_precisions(name: str) -> None:
    system = NappeSystem(chamber_chart(PATTERNS[name].without_rigid_parts()[0]))
    size = system.chart.system.size
    for signs in sign_vectors(0, 3, size):
        (point,) = system.ends(signs[None]).points
        coarse = refined_end(system, [int(e) for e in signs], 100)
        fine = refined_end(system, [int(e) for e in signs], 300)
        assert coarse is not None
        assert fine is not None
        for x, a, b in zip(point, coarse.point, fine.point, strict=True):
            assert abs(x - a / 2**100) < 1e-9
            assert abs((a << 200) - b) < 1 << 220
        flat = (1,) if name == "flat vertex" and signs[0] > 0 else ()
        assert coarse.flat == fine.flat == flat


def test_refinement_satisfies_the_quadrics_to_its_precision() -> None:
    system = NappeSystem(chamber_chart(random_square(5, seed=4)))
    end = refined_end(system, [1, -1, 1, 1, -1], 400)
    assert end is not None
    values = system.chart.system.values_at([Fraction(m, 1 << 400) for m in end.point])
    scales = [max(abs(c) for row in s for c in row) for s in system.chart.system.matrices]
    assert all(abs(v) < c * Fraction(1, 1 << 380) for v, c in zip(values, scales, strict=True))


def test_a_short_step_can_grow_from_a_round_cone_on_the_wrong_side() -> None:
    """docs/mathematics.md, 12: A_v h = 0 and e_v l_v(h) < 0 at v = 4, and the rim as the cone."""
    rim = [(-4, -4), (4, -4), (4, 4), (-4, 4)]
    faces = [(0, 1, 4), (1, 5, 4), (1, 2, 5), (2, 3, 5), (3, 4, 5), (3, 0, 4)]
    pattern = CreasePattern([*rim, (-3, -3), (-2, -3)], faces)
    signs, lines, roots = {4: -1, 5: 1}, {}, {}
    for v in signs:
        form, cone = curvature_form(pattern, v), round_cone(pattern, v)
        polar, total = form.functional(cone), form(cone)
        lines[v] = np.array([float(polar.get(u, 0) / polar[v]) for u in range(6)])
        squared = np.outer(lines[v], lines[v])
        squared[np.ix_(form.labels, form.labels)] -= np.array(form.matrix, dtype=float) * float(
            total / polar[v] ** 2
        )
        values, vectors = np.linalg.eigh(squared)
        roots[v] = np.sqrt(np.maximum(values, 0))[:, None] * vectors.T
    h = np.array([float(round_cone(pattern, 4).get(u, 5)) for u in range(6)])

    def size(heights: np.ndarray) -> float:
        gaps = [
            lines[v] @ heights - e * np.linalg.norm(roots[v] @ heights) for v, e in signs.items()
        ]
        return float(np.hypot(*gaps))

    assert np.linalg.norm(roots[4] @ h) < 1e-6 < lines[4] @ h
    other = roots[5] @ h / np.linalg.norm(roots[5] @ h)
    growth = []
    for u in np.vstack([np.eye(6), -np.eye(6), np.zeros(6)]):
        rows = np.array([lines[4] + u @ roots[4], lines[5] - other @ roots[5]])
        step = np.zeros(6)
        step[4:] = np.linalg.solve(rows[:, 4:], -rows @ h)
        growth.append(size(h + 1e-4 * step) - size(h))
    assert growth[-1] < -1e-5  # u = 0
    assert max(growth) > 1e-5
