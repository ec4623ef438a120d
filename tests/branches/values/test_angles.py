"""First-order fold angles and the second-order sheet, against the geometry of points in space."""

from fractions import Fraction

import numpy as np
import pytest
from sheets import random_wheel

from exactfold import random_square
from exactfold.branches import count_branches, find_branch, fold_angles
from exactfold.branches.values.second_order import second_order_sheet
from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern import families
from exactfold.pattern.crease_pattern import CreasePattern


def exact(heights):
    return {v: (Fraction(h), Fraction(h)) for v, h in enumerate(heights)}


def dihedral(points, i, j, left, right):
    """Degrees between the faces (i, j, left) and (j, i, right), a valley positive."""
    one = np.cross(points[j] - points[i], points[left] - points[i])
    two = np.cross(points[right] - points[i], points[j] - points[i])
    along = (points[j] - points[i]) / np.linalg.norm(points[j] - points[i])
    return np.degrees(np.arctan2(np.cross(one, along) @ two, one @ two))


def test_angles_are_the_slopes_of_dihedral_angles():
    pattern = random_wheel(3, 6)
    source = np.random.default_rng(2)
    heights = [Fraction(int(n), 7) for n in source.integers(-9, 9, len(pattern.vertices))]
    angles = fold_angles(pattern, exact(heights))
    t = Fraction(1, 10**6)
    lifted = [
        [*map(float, p), float(t * h)] for p, h in zip(pattern.vertices, heights, strict=True)
    ]
    for fold, bend in angles.bends.items():
        expected = dihedral(np.array(lifted), *fold, *pattern.opposite(fold))
        assert np.degrees(float(t * bend)) == pytest.approx(expected, rel=1e-6)
        low, high = angles.densities[fold]
        assert low == high


def test_bounds_enclose_the_density_of_every_sheet_within():
    pattern = random_square(2, seed=1)
    source = np.random.default_rng(5)
    middle = [Fraction(int(n), 8) for n in source.integers(-9, 9, len(pattern.vertices))]
    reach = Fraction(1, 64)
    outer = fold_angles(pattern, {v: (h - reach, h + reach) for v, h in enumerate(middle)})
    touched = set()
    for _ in range(200):
        signs = source.integers(-1, 2, len(middle))
        moved = [h + int(s) * reach for h, s in zip(middle, signs, strict=True)]
        inner = fold_angles(pattern, exact(moved))
        for fold, (value, same) in inner.densities.items():
            low, high = outer.densities[fold]
            assert low <= value == same <= high
            touched |= {(fold, value == low, value == high)}
    # The bounds are sharp: each is reached at some corner.
    for fold in pattern.folds:
        assert (fold, True, False) in touched
        assert (fold, False, True) in touched


def test_angles_do_not_depend_on_the_unit_or_the_plane():
    pattern = random_square(3, seed=0)
    branch = find_branch(pattern, "+-+")
    angles = fold_angles(pattern, branch.heights, branch.assignment)
    thrice = CreasePattern([(3 * x, 3 * y) for x, y in pattern.vertices], pattern.triangles)
    tilted = {
        v: tuple(h + 2 * x - 5 * y + 1 for h in branch.heights[v])
        for v, (x, y) in enumerate(pattern.vertices)
    }
    lifted = fold_angles(thrice, tilted)
    for fold, (low, high) in angles.densities.items():
        assert lifted.densities[fold] == (low / 9, high / 9)
    assert lifted.degrees(20) == pytest.approx(angles.degrees(20), rel=1e-12)


@pytest.mark.parametrize("pattern", [families.two_vertex(), random_square(3, seed=0)])
def test_signs_of_the_angles_are_the_letters(pattern):
    for branch in count_branches(pattern).branches:
        angles = fold_angles(pattern, branch.heights, branch.assignment)
        for fold, (low, high) in angles.densities.items():
            assert (low > 0, high < 0) == (
                branch.assignment[fold] == "V",
                branch.assignment[fold] == "M",
            )
        degrees = angles.degrees(25)
        assert max(map(abs, degrees.values())) == 25
        # At each vertex the angles add up to minus twice K_v(t, h), the size of the pop.
        for v, sign in branch.vertex_signs.items():
            assert np.sign(sum(a for fold, a in degrees.items() if v in fold)) == -sign


def test_proved_flat_folds_get_exactly_zero():
    pattern = families.flat_vertex_square()
    branch = next(b for b in count_branches(pattern).branches if "F" in b.assignment_text)
    angles = fold_angles(pattern, branch.heights, branch.assignment)
    for fold, letter in branch.assignment.items():
        assert (angles.densities[fold] == (0, 0)) == (letter == "F")
        assert (angles.degrees(30)[fold] == 0.0) == (letter == "F")


def test_usage_errors():
    pattern = families.two_vertex()
    heights = find_branch(pattern, "+-").heights
    angles = fold_angles(pattern, heights)
    for amount in (0, -1, 180.5, float("nan"), float("inf")):
        for method in (angles.degrees, angles.amplitude):
            with pytest.raises(UsageError, match="largest fold angle"):
                method(amount)
    for wrong in ({}, {**heights, 6: (0, 0)}):
        with pytest.raises(UsageError, match="every vertex"):
            fold_angles(pattern, wrong)
    flat = fold_angles(pattern, exact([x + 2 * y for x, y in pattern.vertices]))
    for method in (flat.degrees, flat.amplitude):
        with pytest.raises(NotApplicableError, match="flat"):
            method(10)


# --- the second-order sheet ----------------------------------------------------------------------


def raised(pattern, branch, amount):
    t = fold_angles(pattern, branch.heights, branch.assignment).amplitude(amount)
    return [t * sum(branch.heights[v]) / 2 for v in range(len(pattern.vertices))]


def test_lengths_agree_to_second_order_on_a_branch_and_not_beside_it():
    pattern = random_square(3, seed=0)
    for branch in count_branches(pattern).branches:
        errors = [
            second_order_sheet(pattern, raised(pattern, branch, amount)).length_error
            for amount in (8, 4, 2)
        ]
        # Half the amplitude, a sixteenth of the error.
        assert errors[0] / errors[1] == pytest.approx(16, rel=0.05)
        assert errors[1] / errors[2] == pytest.approx(16, rel=0.05)
    beside = raised(pattern, branch, 8)
    beside[pattern.interior[0]] += Fraction(1, 20)
    off = [second_order_sheet(pattern, [h / k for h in beside]).length_error for k in (1, 2, 4)]
    assert off[0] / off[1] == pytest.approx(4, rel=0.1)
    assert off[1] / off[2] == pytest.approx(4, rel=0.1)


def test_the_sheet_keeps_the_heights_up_to_a_plane_and_stays_in_place():
    pattern = random_square(3, seed=0)
    branch = find_branch(pattern, "++-")
    heights = raised(pattern, branch, 10)
    points = np.array(second_order_sheet(pattern, heights).coords)
    flat = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    plane = np.column_stack([np.ones(len(flat)), flat])
    rest = points[:, 2] - np.array([float(h) for h in heights])
    assert np.max(np.abs(rest - plane @ np.linalg.lstsq(plane, rest, rcond=None)[0])) < 1e-14
    assert np.max(np.abs(plane.T @ points[:, 2])) < 1e-13
    moves = points[:, :2] - flat
    assert np.max(np.abs(moves.mean(axis=0))) < 1e-15
    assert abs(np.sum(flat[:, 0] * moves[:, 1] - flat[:, 1] * moves[:, 0])) < 1e-13


def test_the_sheet_scales_and_moves_with_the_pattern():
    pattern = random_square(3, seed=0)
    heights = raised(pattern, find_branch(pattern, "++-"), 10)
    points = np.array(second_order_sheet(pattern, heights).coords)
    for scale in (Fraction(1, 10**200), Fraction(10**200)):
        moved = CreasePattern(
            [(scale * (x + 7), scale * (y - 2)) for x, y in pattern.vertices], pattern.triangles
        )
        found = second_order_sheet(moved, [scale * h for h in heights])
        back = np.array(found.coords) / float(scale) - [7, -2, 0]
        assert np.max(np.abs(back - points)) < 1e-12


def test_lengths_beyond_floats_are_refused():
    far = 10**400
    pattern = CreasePattern(
        [(0, 0), (far, 0), (far, far), (0, far), (Fraction(1, far), Fraction(1, far))],
        [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)],
    )
    with pytest.raises(NotApplicableError, match="floats"):
        second_order_sheet(pattern, [Fraction(0)] * 4 + [Fraction(1)])
