"""The parts of a tolerance: balls, gradients, shapes, radii of zeros, and compliances."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import hypot, inf, log

import numpy as np
import pytest
from panel_sheets import ring

from exactfold import PanelPattern
from exactfold.branches import count_branches
from exactfold.branches.counting.ways import count_ways
from exactfold.design.tolerance.closing import closings
from exactfold.design.tolerance.distinct import all_distinct
from exactfold.design.tolerance.parts import branch_part, panel_parts
from exactfold.design.tolerance.radius import proved_radii
from exactfold.design.tolerance.sampling import pinching
from exactfold.design.tolerance.shape import shape_of, turning_radius
from exactfold.design.tolerance.tolerance import proved_radius
from exactfold.motion import panel_ways
from exactfold.motion.panels.followable import panel_modes
from exactfold.panels import decompose
from exactfold.panels.vertex.local import local_modes
from exactfold.panels.vertex.stars import edge_of, stars
from exactfold.pattern.families import two_vertex
from exactfold.solve.certify.float_balls import Balls


def exact(value):
    return Fraction(float(value))


def test_balls_hold_exact_sums_and_products():
    rng = np.random.default_rng(1)
    a, b = rng.normal(size=(3, 4)), rng.normal(size=(4, 2))
    off = np.full((3, 4), 1e-9)
    found = Balls(a, off) @ Balls.exact(b)
    added, times = Balls(a, off) + Balls.exact(a), Balls(a, off) * Balls.exact(a)
    for sign in (-1, 1):
        for i in range(3):
            row = [exact(x) + sign * exact(1e-9) for x in a[i]]
            for j in range(2):
                true = sum(x * exact(y) for x, y in zip(row, b[:, j], strict=True))
                assert abs(true - exact(found.mid[i, j])) <= exact(found.rad[i, j])
            for k, x in enumerate(row):
                for ball, true in ((added, x + exact(a[i, k])), (times, x * exact(a[i, k]))):
                    assert abs(true - exact(ball.mid[i, k])) <= exact(ball.rad[i, k])
    assert (found.rad < 1e-7).all()
    assert (found.below <= np.abs(found.mid)).all()
    assert (np.abs(found.mid) <= found.above).all()


def test_balls_of_complex_numbers_hold_exact_products():
    rng = np.random.default_rng(2)
    a = rng.normal(size=(2, 40)) + 1j * rng.normal(size=(2, 40))
    found = Balls.exact(a) @ Balls.exact(a.T)
    parts = [[(exact(z.real), exact(z.imag)) for z in row] for row in a]
    for i, row in enumerate(parts):
        for j, other in enumerate(parts):
            pairs = list(zip(row, other, strict=True))
            real = sum(x * u - y * v for (x, y), (u, v) in pairs)
            imag = sum(x * v + y * u for (x, y), (u, v) in pairs)
            mid = found.mid[i, j]
            off = (real - exact(mid.real)) ** 2 + (imag - exact(mid.imag)) ** 2
            assert off <= exact(found.rad[i, j]) ** 2


@pytest.fixture(scope="module")
def part():
    return branch_part(count_branches(two_vertex()).branches)


def test_zeros_are_those_of_the_count(part):
    branches = count_branches(two_vertex()).branches
    bends = part.conditions.bends(part.zeros, part.conditions.points)
    for row, branch in zip(bends, branches, strict=True):
        known = np.array([float(sum(b)) for b in branch.fold_angles.densities.values()])
        assert np.allclose(row / row[0], known / known[0])
    linear = part.conditions.linear(part.conditions.directions(part.conditions.points))
    for zero in part.zeros:
        assert np.abs(linear @ zero).max() < 1e-12
        assert np.abs(zero @ part.conditions.forms @ zero).max() < 1e-12


def test_slopes_are_differences(part):
    conditions, zero = part.conditions, part.zeros[1]
    densities, slopes = conditions.slopes(zero, conditions.points)
    assert np.allclose(densities, conditions.bends(zero, conditions.points))
    for v in range(6):
        for axis in range(2):
            points = conditions.points.copy()
            points[v, axis] += 1e-6
            after = conditions.newton(zero[None], points)[0]
            along = conditions.directions(conditions.points)
            across = np.stack([-along[:, 1], along[:, 0]], axis=1)
            jump = conditions.jumps @ after.reshape(-1, 2)
            moved = (jump * across).sum(axis=1) / (along**2).sum(axis=1)
            assert np.allclose((moved - densities) / 1e-6, slopes[:, v, axis], atol=1e-4)


def test_what_is_no_zero_has_the_radius_0(part):
    wrong = part.zeros.copy()
    wrong[0] += 0.05
    wrong[1] = np.nan
    found = proved_radii(part.conditions, wrong)
    assert found.all_move[:2].tolist() == [0.0, 0.0]
    assert (found.all_move[2:] > 0).all()
    assert (found.one_moves[:2] == 0).all()


def test_a_radius_is_less_if_the_centre_is_off_and_more_without_letters(part):
    plain = proved_radii(part.conditions, part.zeros)
    off = proved_radii(part.conditions, part.zeros, 1e-3)
    free = proved_radii(part.conditions, part.zeros, 0.0, np.zeros(4, dtype=bool))
    assert (off.all_move < plain.all_move).all()
    assert (plain.all_move - off.all_move < 5e-3).all()
    assert (free.all_move >= plain.all_move).all()
    assert (plain.one_moves >= plain.all_move[:, None]).all()


def test_zeros_that_are_not_real_stay_regular():
    result = decompose(ring(2))
    found = panel_parts(result, panel_ways(result), None)
    [tracked] = found.tracked
    lettered = np.array([bool(name) for name in tracked.names])
    assert (found.unknown, found.closings) == ("", ())
    assert lettered.sum() == result.ways
    assert lettered.sum() + 2 * (~lettered).sum() == 16
    assert (~lettered).any()
    assert tracked.is_complete
    radii = proved_radii(tracked.conditions, tracked.zeros, 0.0, lettered)
    assert (radii.all_move > 0).all()
    assert all_distinct(tracked, radii)
    twice = replace(
        tracked,
        zeros=np.concatenate([tracked.zeros, tracked.zeros[-1:].conj()]),
        names=(*tracked.names, ""),
    )
    again = proved_radii(twice.conditions, twice.zeros, 0.0, np.append(lettered, False))
    assert not all_distinct(twice, again)


def test_a_list_that_is_not_complete_proves_nothing_of_the_number():
    branches = count_branches(two_vertex()).branches
    assert proved_radius(branches, everything=True) > 0
    assert proved_radius(branches[1:], everything=True) == 0
    assert proved_radius(branches[1:], everything=False) > 0


def test_a_zero_that_is_given_twice_is_found(part):
    twice = replace(
        part,
        zeros=np.concatenate([part.zeros, -part.zeros[:1]]),
        names=(*part.names, "branch --"),
    )
    assert all_distinct(part, proved_radii(part.conditions, part.zeros))
    assert not all_distinct(twice, proved_radii(twice.conditions, twice.zeros))


def test_shapes():
    square = np.array([[0.0, 0], [2, 0], [2, 1], [0, 1]])
    shape = shape_of(square, [(0, 1, 2, 3)])
    assert shape.all_move == pytest.approx(0.5)
    assert shape.one_moves == pytest.approx((1, 1, 1, 1))
    assert turning_radius(square, 0, 1, 2) == pytest.approx(1 / hypot(2, 1))
    assert turning_radius(square, 0, 1, 2) < 1 / hypot(2, 1)


def test_moves_that_take_the_area_of_a_triangle():
    corners = np.array([[0.0, 0], [2, 0], [0, 1]])
    moves = np.zeros((3, 3, 2))
    moves[0, 2] = [0, -1]
    moves[1, 2] = [0, 1]
    moves[2, :] = [1, 1]
    assert pinching(corners, [(0, 1, 2)], moves).tolist() == [1.0, inf, inf]
    assert pinching(corners, [(0, 1, 2, 3)], moves).tolist() == [inf, inf, inf]


def test_the_compliance_of_a_loop_is_its_derivative():
    result = count_ways("square-twist")
    mode = panel_modes(result)[0]
    [loop] = closings(mode)
    at = {star.vertex: choice.index for star, choice in zip(mode.stars, mode.choice, strict=True)}

    def defect(pattern):
        total = 0.0
        for k, v in enumerate(loop.vertices):
            start = edge_of(loop.vertices[k - 1], v)
            end = edge_of(v, loop.vertices[(k + 1) % 4])
            local = local_modes(stars(pattern)[v])[at[v]]
            total += log(abs(float(local.gain(start, end))))
        return total

    step = Fraction(1, 10**5)
    assert defect(result.pattern) == pytest.approx(0, abs=1e-12)
    for v in (5, 8, 13):
        slopes = []
        for axis in range(2):
            points = [list(point) for point in result.pattern.vertices]
            points[v][axis] += step
            slopes.append(defect(PanelPattern(points, result.pattern.edges)) / float(step))
        assert hypot(*slopes) == pytest.approx(loop.compliance[v], rel=1e-4)


def test_a_straight_crease_bends_by_the_move_over_the_lengths():
    mode = panel_modes(count_ways("zigzags"))[0]
    found = [one for one in closings(mode) if one.kind == "straight"]
    for one in found:
        points = [[float(c) for c in mode.pattern.vertices[v]] for v in one.vertices]
        lengths = [hypot(*(a - b for a, b in zip(points[1], p, strict=True))) for p in points]
        assert one.compliance[one.vertices[0]] == pytest.approx(1 / lengths[0])
        assert one.compliance[one.vertices[1]] == pytest.approx(1 / lengths[0] + 1 / lengths[2])
