"""Fold angles of rigid panels against formulas that know nothing of this code."""

import random
from fractions import Fraction
from math import cos, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from folding_panels import angle, checked, one_vertex, sectors
from panel_sheets import (
    mesh,
    miura,
    tiling,
)

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.motion.panels.following import follow_panels
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels.decomposition import decompose


@pytest.mark.parametrize(("rows", "zigzags"), [(1, 1), (2, 2), (3, 4)])
def test_miura_ori(rows, zigzags):
    """tan(straight / 2) = cos(sector) tan(zigzag / 2), at all fold angles."""
    pattern = miura(rows, zigzags)
    motion = checked(follow_panels(pattern, until="180deg", frames=23))
    assert motion.closes is PROVED
    assert motion.status is PROVED
    cosine = 1 / sqrt(10)
    straight, zigzag = [], []
    for k, (i, j) in enumerate(pattern.folds):
        (_, y), (_, z) = pattern.vertices[i], pattern.vertices[j]
        (straight if y == z else zigzag).append(k)
    if motion.way == 1 and rows > 1:
        assert len(straight) + len(zigzag) == np.count_nonzero(motion.angles[5])
    inner = motion.angles[1:-1]
    active = [k for k in straight if inner[0, k]]
    assert active
    tangents = np.tan(np.abs(inner) / 2)
    assert np.allclose(tangents[:, active], cosine * tangents[:, zigzag[:1]], rtol=1e-12, atol=0)
    assert np.allclose(tangents[:, zigzag], tangents[:, zigzag[:1]], rtol=1e-12, atol=0)
    assert np.allclose(np.abs(motion.angles[-1][[*active, *zigzag]]), pi, rtol=0, atol=1e-12)


@pytest.mark.parametrize("sizes", [(50, 70), (40, 115), (90, 65)])
def test_a_flat_foldable_vertex_folds_in_a_known_ratio(sizes):
    """Sectors a, b, pi - a, pi - b: p = sin((a - b) / 2) / sin((a + b) / 2), or with cosines."""
    # Exact points on the unit circle close to the angles; then Kawasaki's condition holds exactly.
    points, total = [(Fraction(1), Fraction(0))], (Fraction(1), Fraction(0))
    angles = [radians(s) for s in sizes]
    turns = [rational_turn(x) for x in angles]
    turns += [(-c, s) for c, s in turns]
    for c, s in turns[:3]:
        total = (total[0] * c - total[1] * s, total[0] * s + total[1] * c)
        points.append(total)
    pattern = one_vertex(*points)
    a, b, *others = sectors(pattern, 0)
    assert others == pytest.approx([pi - a, pi - b])
    expected = {
        round(abs(sin((a - b) / 2) / sin((a + b) / 2)), 9),
        round(abs(cos((a + b) / 2) / cos((a - b) / 2)), 9),
    }
    result = decompose(pattern)
    assert len(result.modes) == 2
    found = set()
    for number in (1, 2):
        motion = checked(follow_panels(result, modes=[number], until="120deg", frames=9))
        assert motion.closes is PROVED
        tangents = np.tan(np.abs(motion.angles[1:]) / 2)
        assert np.allclose(tangents[:, 0], tangents[:, 2], rtol=1e-12, atol=0)
        assert np.allclose(tangents[:, 1], tangents[:, 3], rtol=1e-12, atol=0)
        ratio = tangents[:, :2].min(axis=1) / tangents[:, :2].max(axis=1)
        assert np.allclose(ratio, ratio[0], rtol=1e-12, atol=0)
        found.add(round(float(ratio[0]), 9))
    assert found == expected


def rational_turn(x):
    """(cos, sin) of an angle near x, exactly on the circle."""
    t = Fraction(round(1000 * tan(x / 2)), 1000)
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


@pytest.mark.parametrize(
    ("tips", "linear"),
    [
        ([(1, 0), (1, 1), (-2, 0), (-1, -1)], {2: [True, True]}),  # two lines, Q = 4
        ([(1, 0), (0, 1), (-2, 0), (0, -3)], {2: [True, True]}),  # perpendicular ones, Q = 0
        ([(1, 0), (-1, 2), (-3, 0), (-1, -2)], {2: [True], 4: [True]}),  # one line, Q = 0
        ([(1, 0), (-1, 2), (-3, 0), (1, -1)], {2: [True], 4: [False]}),  # one line, Q = -18
        ([(1, 0), (3, 4), (-63, 16), (5, -12)], {4: [True, True]}),  # no line, Q = 0
        ([(2, 1), (-1, 3), (-2, -3), (1, -4)], {4: [False, False]}),  # no line, Q = 567
    ],
)
def test_four_active_folds_stay_in_proportion_where_the_vertex_folds_flat(tips, linear):
    """A straight crease that folds alone does so whatever Q is (docs/motion.md, 18)."""
    ways = panel_ways(decompose(one_vertex(*tips)))
    found = {}
    for k, way in enumerate(ways, 1):
        motion = follow_panels(decompose(one_vertex(*tips)), way=k, frames=2)
        found.setdefault(way.folds, []).append(motion.closes is PROVED)
    assert found == linear


@pytest.mark.parametrize("seed", range(8))
def test_a_vertex_with_four_folds_is_a_spherical_four_bar_linkage(seed):
    """Both sides of each diagonal of the linkage, by the spherical law of cosines."""
    rng = random.Random(seed)
    tips = [(9, rng.randint(-3, 3)), (rng.randint(-3, 3), 7), (-8, 2), (rng.randint(-3, 3), -9)]
    pattern = one_vertex(*((Fraction(x), Fraction(y)) for x, y in tips))
    angles = sectors(pattern, 0)
    at = [pattern.folds.index((0, u)) for u in pattern.stars[0]]
    result = decompose(pattern)
    for number in (1, 2):
        motion = checked(follow_panels(result, modes=[number], until="180deg", frames=37))
        assert motion.closes is UNDECIDED
        assert motion.status is UNDECIDED
        for k in (0, 1):
            before, after, far, last = (angles[(k + n) % 4] for n in (3, 0, 1, 2))
            one = cos(before) * cos(after) - sin(before) * sin(after) * np.cos(
                motion.angles[:, at[k]]
            )
            other = cos(far) * cos(last) - sin(far) * sin(last) * np.cos(
                motion.angles[:, at[(k + 2) % 4]]
            )
            assert np.allclose(one, other, rtol=0, atol=1e-13)
        assert abs(angle(motion, motion.drivers[0])) == pi
        assert np.abs(motion.angles).max() == pi
        # Opposite a fold that closes alone lies one that turns back: the extreme of its range.
        [closing, turning] = motion.events[-2:]
        assert (closing.kind, turning.kind) == ("flat-fold", "turning")
        for fold in turning.folds:
            opposite = at[(at.index(pattern.folds.index(fold)) + 2) % 4]
            assert pattern.folds[opposite] in closing.folds


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(k, marks=pytest.mark.survey) for k in range(1, 6))]
)
def test_all_folds_of_a_strip_grow_until_the_first_closes(seed):
    result = decompose(mesh(1, 3, seed=seed))
    assert len(result.modes) == 8
    for number in range(1, 9):
        motion = checked(follow_panels(result, modes=[number], until="180deg", frames=40))
        steps = np.diff(np.abs(motion.angles), axis=0)
        active = np.abs(motion.angles[-1]) > 0
        assert active.sum() == 10
        assert (steps[:, active] > 0).all()
        assert np.abs(motion.angles).max() == pi
        letters = result.modes[number - 1].assignment
        assert all(motion.assignment[fold] == letter for fold, letter in letters.items())


@pytest.mark.parametrize("size", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_a_tiling_closes_round_its_loops(size):
    result = decompose(tiling(size, size))
    for number in (1, 2):
        motion = checked(follow_panels(result, way=number, until="180deg", frames=31))
        assert motion.closes is UNDECIDED
        assert motion.curves[0].mode.extends.by == "loops to order 17"
