"""Motions of rigid panels against formulas that know nothing of this code."""

import copy
import pickle
import random
from fractions import Fraction
from itertools import combinations, product
from math import acos, cos, inf, pi, radians, sin, sqrt, tan

import numpy as np
import pytest
from panel_sheets import (
    chicken_wire,
    grid,
    mesh,
    miura,
    outlined,
    regular_twist,
    shifted_columns,
    tiling,
)
from scipy.optimize import linprog

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.surds import RATIONALS
from exactfold.motion.panels.followable import panel_components, panel_modes
from exactfold.motion.panels.following import follow_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.panel_pattern import PanelPattern

ROOT3 = RATIONALS.adjoined(3).root


def one_vertex(*tips):
    """A vertex at the origin with a fold to each of these points, on the hull of the points."""
    return outlined([(0, 0), *tips], [(0, k + 1) for k in range(len(tips))], 1)


def strip(widths, height=2):
    """Panels side by side, with a fold from border to border between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (xs[i], height * j))


def sectors(pattern, v):
    """The sector angles at a vertex, the k-th from fold k to the next."""
    at = np.array([float(c) for c in pattern.vertices[v]])
    around = [np.array([float(c) for c in pattern.vertices[u]]) - at for u in pattern.stars[v]]
    units = [d / np.linalg.norm(d) for d in around]
    return [acos(float(units[k] @ units[(k + 1) % len(units)])) for k in range(len(units))]


def turned(axis, angle):
    """A rotation, from the exponential series of its generator."""
    x, y = axis
    generator = angle * np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    total, term = np.eye(3), np.eye(3)
    for k in range(1, 40):
        term = term @ generator / k
        total = total + term
    return total


def open_by(pattern, angles):
    """How far the rotations round each interior vertex are from composing to the identity."""
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    worst = 0.0
    for v, around in pattern.stars.items():
        total = np.eye(3)
        for u in around:
            d = np.array([float(c) for c in pattern.direction(v, u)])
            fold = angles[columns[min(u, v), max(u, v)]]
            total = total @ turned(d / np.linalg.norm(d), fold)
        worst = max(worst, float(np.abs(total - np.eye(3)).max()))
    return worst


def checked(motion):
    """Closed vertices, rigid panels, and fold angles as they are in space, in every frame."""
    pattern = motion.pattern
    size = float(np.ptp(motion.coords[0], axis=0).max())
    assert motion.residual < 1e-12
    assert motion.gap < 1e-12 * size
    assert max(open_by(pattern, row) for row in motion.angles[::5]) < 1e-12
    assert not motion.angles[0].any()
    assert np.abs(motion.coords[0][:, 2]).max() == 0
    flat = motion.coords[0]
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    normals = []
    for face in pattern.faces:
        corners = list(face)
        before = np.linalg.norm(flat[corners][:, None] - flat[corners][None], axis=2)
        for coords in motion.coords:
            after = np.linalg.norm(coords[corners][:, None] - coords[corners][None], axis=2)
            assert np.abs(after - before).max() < 1e-12 * size
        normals.append(np.array([newell(coords[corners]) for coords in motion.coords]))
    for (i, j), k in columns.items():
        left, right = (normals[pattern.sides[half]] for half in ((i, j), (j, i)))
        axis = motion.coords[:, j] - motion.coords[:, i]
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        # A valley turns the normal of the left face about the fold, from that of the right one.
        sine = (np.cross(right, left) * axis).sum(axis=1)
        found = np.arctan2(sine, (left * right).sum(axis=1))
        off = (found - motion.angles[:, k] + pi) % (2 * pi) - pi
        assert np.abs(off).max() < 1e-11
    return motion


def newell(corners):
    """The unit normal of a polygon in space."""
    total = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return total / np.linalg.norm(total)


def angle(motion, fold, frame=-1):
    return motion.angles[frame, motion.pattern.folds.index(tuple(sorted(fold)))]


# --- known formulas ------------------------------------------------------------------------------


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
    if motion.component == 1 and rows > 1:
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
    """A straight crease that folds alone does so whatever Q is (docs/panel_motion.md, 1)."""
    components = panel_components(decompose(one_vertex(*tips)))
    found = {}
    for k, component in enumerate(components, 1):
        motion = follow_panels(decompose(one_vertex(*tips)), component=k, frames=2)
        found.setdefault(component.folds, []).append(motion.closes is PROVED)
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
        motion = checked(follow_panels(result, component=number, until="180deg", frames=31))
        assert motion.closes is UNDECIDED
        assert motion.curves[0].mode.extends.by == "loops to order 17"


# --- exactly -------------------------------------------------------------------------------------


def lengths_kept(pattern, spots):
    """Whether all distances inside panels are kept exactly."""
    for face in pattern.faces:
        for i, j in product(face, face):
            ends = pattern.vertices[i], pattern.vertices[j]
            if squared(*ends) != squared(spots[i], spots[j]):
                return False
    return True


def squared(one, other):
    return sum((a - b) * (a - b) for a, b in zip(one, other, strict=True))


def miura_60(rows, zigzags):
    """A Miura-ori with sectors of 60 degrees, in Q(sqrt 3)."""
    return grid(zigzags + 1, rows + 1, lambda i, j: (Fraction(2 * i + j % 2), ROOT3 * j))


@pytest.mark.parametrize(
    "pattern",
    [
        miura(2, 2),
        miura_60(2, 2),
        regular_twist(4, (Fraction(3), Fraction(-5))),
        regular_twist(4, (Fraction(0), Fraction(-5))),
    ],
)
def test_positions_at_a_rational_parameter_are_exact(pattern):
    motion = follow_panels(pattern, until="180deg", frames=5)
    assert motion.closes is PROVED
    for parameter in (Fraction(1, 7), 3, inf):
        spots = motion.exactly(parameter)
        assert lengths_kept(pattern, spots)
        driver = motion.drivers[0]
        ends = (np.array([float(c) for c in pattern.vertices[v]]) for v in driver)
        length = float(np.linalg.norm(next(ends) - next(ends)))
        half = pi / 2 if parameter == inf else np.arctan(float(parameter) * length)
        if len(motion.curves) == 1:
            floats = motion.at(min(2 * half, pi))
            assert np.allclose([[float(c) for c in s] for s in spots], floats, rtol=0, atol=1e-13)
    assert all(z == 0 for _, _, z in motion.exactly(inf))
    assert any(z != 0 for _, _, z in motion.exactly(1))


def test_the_ratios_of_the_miura_ori_are_exact():
    motion = follow_panels(miura_60(2, 2))
    [driver] = motion.drivers
    assert abs(motion.ratios[driver]) == 1
    # All folds have length 2: tan(straight / 2) is half of tan(zigzag / 2).
    assert {abs(c) for c in motion.ratios.values()} == {Fraction(1), Fraction(1, 2)}


def test_a_forged_ratio_does_not_close():
    """`exactly` checks at every corner that the panels meet."""
    motion = follow_panels(miura(2, 2))
    fold = next(f for f, c in motion.ratios.items() if f not in motion.drivers)
    turns = {f: (1, c) for f, c in motion.ratios.items()}
    motion._placing.exactly(turns)
    turns[fold] = (1, 2 * motion.ratios[fold])
    with pytest.raises(UsageError, match="do not close"):
        motion._placing.exactly(turns)


def test_a_followed_motion_has_no_exact_positions():
    motion = follow_panels(mesh(1, 2, seed=2))
    assert motion.ratios is None
    with pytest.raises(NotApplicableError, match="floats only"):
        motion.exactly(1)
    with pytest.raises(UsageError, match="is a float"):
        follow_panels(miura(1, 1)).exactly(0.5)
    with pytest.raises(UsageError, match="mode 9 does not fold here"):
        follow_panels(miura(1, 1)).exactly({9: 1})


# --- what is followed ----------------------------------------------------------------------------


def test_components_begin_with_the_one_with_most_folds():
    result = decompose(miura(2, 2))
    components = panel_components(result)
    assert [one.folds for one in components] == sorted((c.folds for c in components), reverse=True)
    assert sorted(one.dimension for one in components) == [1, 1, 1, 2]
    assert follow_panels(result).modes == components[0].modes
    both = next(k for k, one in enumerate(components, 1) if one.dimension == 2)
    motion = checked(follow_panels(result, component=both, until="180deg"))
    assert motion.modes == components[both - 1].modes
    assert motion.closes is PROVED


def test_modes_without_a_common_vertex_fold_at_their_own_rates():
    result = decompose(miura(2, 2))
    both = next(one for one in panel_components(result) if one.dimension == 2)
    first, second = both.modes
    motion = checked(
        follow_panels(result, modes=both.modes, amounts={first: -2, second: 1}, until="180deg")
    )
    assert motion.rates == (-1.0, 0.5)
    one, other = (angle(motion, driver) for driver in motion.drivers)
    assert (abs(one), abs(other)) == (pi, pytest.approx(pi / 2))
    alone = follow_panels(result, modes=both.modes, amounts={second: 1}, until="90deg")
    assert alone.modes == (second,)
    spots = motion.exactly({first: -3, second: Fraction(1, 2)})
    assert lengths_kept(motion.pattern, spots)


def test_a_mirror_image_moves_in_the_mirror():
    pattern = tiling(2, 2)
    mirror = PanelPattern([(-x, y) for x, y in pattern.vertices], pattern.edges)
    motion = follow_panels(pattern, until="100deg", frames=7)
    found = []
    for number in (1, 2):
        for side in (1, -1):
            other = follow_panels(
                mirror, modes=[number], amounts={number: side}, until="100deg", frames=7
            )
            found.append(np.allclose(other.angles, motion.angles, rtol=0, atol=1e-12))
    assert sum(found) == 1
    down = follow_panels(pattern, amounts={motion.modes[0]: -1}, until="100deg", frames=7)
    assert np.allclose(down.coords, motion.coords * [1, 1, -1], rtol=0, atol=1e-12)
    assert np.array_equal(down.angles, -motion.angles)


@pytest.mark.parametrize("pattern", [tiling(2, 2), miura(2, 2), mesh(1, 2, seed=4)])
def test_other_numbers_of_the_vertices_change_nothing(pattern):
    rng = random.Random(3)
    new = list(range(len(pattern.vertices)))
    rng.shuffle(new)
    points = [pattern.vertices[new.index(k)] for k in range(len(new))]
    other = PanelPattern(points, [(new[i], new[j]) for i, j in pattern.edges])

    def motions(sheet, names):
        result = decompose(sheet)
        found = set()
        for mode in panel_modes(result):
            motion = follow_panels(result, modes=[mode.number], until="100deg", frames=4)
            sizes = {
                frozenset(names[v] for v in fold): round(abs(float(x)), 9)
                for fold, x in zip(sheet.folds, motion.angles[2], strict=True)
            }
            found.add(frozenset(sizes.items()))
        return found

    assert motions(pattern, new) == motions(other, list(range(len(new))))


def test_free_folds_fold_by_their_angle():
    pattern = strip([2, 3, 1])
    motion = checked(follow_panels(pattern, until="90deg", frames=3))
    assert motion.modes == ()
    assert motion.closes is PROVED
    assert [angle(motion, fold) for fold in pattern.folds] == pytest.approx([pi / 2, pi / 2])
    first, second = pattern.folds
    motion = follow_panels(pattern, amounts={first: 1, second: -0.5}, until="60deg", frames=3)
    assert angle(motion, second) == pytest.approx(-radians(30))
    assert motion.assignment == {first: "V", second: "M"}


def test_the_panel_that_is_held_does_not_move():
    pattern = miura(2, 2)
    for held in (0, 4, 8):
        motion = checked(follow_panels(pattern, held=held, until="120deg", frames=5))
        corners = list(motion.pinned)
        assert corners == list(pattern.faces[held])
        assert np.allclose(motion.coords[:, corners], motion.coords[0][corners], rtol=0, atol=1e-12)


def test_vertices_with_five_folds_on_a_line_that_closes():
    """A Miura-ori with a diagonal in its middle panel: modes that leave the diagonal flat."""
    pattern = miura(2, 2)
    result = decompose(PanelPattern(pattern.vertices, [*pattern.edges, (5, 10)]))
    assert result.theory == "subspaces"
    assert result.modes == ()
    found = panel_modes(result)
    assert len(found) == 2
    without = decompose(pattern)
    for mode in found:
        assert mode.extends.verdict is PROVED
        motion = checked(follow_panels(result, modes=[mode.number], until="150deg", frames=7))
        assert motion.closes is PROVED
        assert lengths_kept(result.pattern, motion.exactly(Fraction(2, 3)))
        same = [
            other
            for other in panel_modes(without)
            if other.letters == dict(mode.letters)
            or all(mode.letters.get(f) != a for f, a in other.letters.items())
        ]
        assert same
    cone = outlined(
        [(0, 0), (2, 0), (1, 2), (-1, 2), (-2, 0), (-1, -2), (1, -2)],
        [(0, k) for k in range(1, 7)],
        1,
    )
    with pytest.raises(NotApplicableError, match="more than four folds"):
        follow_panels(cone)


# --- where it ends -------------------------------------------------------------------------------


def test_first_contact_of_two_flaps():
    """Two flaps of length 3 at distance 1 meet with their tips: -3 cos t = 1/2."""
    motion = follow_panels(strip([3, 1, 3]))
    assert motion.end == "contact"
    [contact] = motion.events
    low, high = contact.time
    assert low <= high < low + 1e-11
    assert high == pytest.approx(acos(-1 / 6), abs=1e-9)
    assert set(contact.faces) == {motion.pattern.faces[0], motion.pattern.faces[2]}
    short = follow_panels(strip([3, 7, 3]))
    assert short.end == "flat-fold"
    on = follow_panels(strip([3, 1, 3]), until="180deg")
    assert [event.kind for event in on.events] == ["contact", "flat-fold"]
    assert on.events[0].time == contact.time


def meet(one, other):
    """Whether two convex hulls have a common point, by linear programming."""
    n, m = len(one), len(other)
    equal = np.block([[one.T, -other.T], [np.ones(n), np.zeros(m)], [np.zeros(n), np.ones(m)]])
    found = linprog(np.zeros(n + m), A_eq=equal, b_eq=[0, 0, 0, 1, 1])
    return found.status == 0


@pytest.mark.slow
def test_contacts_agree_with_linear_programming():
    """Convex panels without a common corner: separated before the contact, not after it."""
    pattern = tiling(2, 2)
    [contact] = follow_panels(pattern).events
    motion = follow_panels(pattern, until="180deg")
    apart = [
        (one, other) for one, other in combinations(pattern.faces, 2) if set(one).isdisjoint(other)
    ]

    def meeting(time):
        coords = motion.at(time)
        return {(a, b) for a, b in apart if meet(coords[list(a)], coords[list(b)])}

    assert not any(meeting(x * contact.time[0]) for x in np.linspace(0.05, 1 - 1e-6, 25))
    assert meeting(contact.time[1] + 1e-4) == {tuple(sorted(contact.faces))}


def test_motions_are_values():
    for pattern in (miura(2, 2), mesh(1, 2, seed=3), strip([3, 7, 3])):
        motion = follow_panels(pattern, until="100deg", frames=4)
        assert motion.ratios is None or motion.exactly(0)
        for other in (pickle.loads(pickle.dumps(motion)), copy.deepcopy(motion)):
            assert other == motion
            assert np.array_equal(other.at(1.0), motion.at(1.0))
        assert motion != follow_panels(pattern, until="100deg", frames=5)


def test_motions_end_at_an_angle():
    motion = follow_panels(tiling(2, 2), until="70deg")
    assert motion.end == "angle"
    assert np.abs(motion.angles[-1]).max() == pytest.approx(radians(70), abs=1e-12)
    [event] = motion.events
    assert abs(angle(motion, event.folds[0])) == pytest.approx(radians(70), abs=1e-12)


def test_frames_at_equal_angles_of_a_fold():
    pattern = tiling(2, 2)
    fold = pattern.folds[0]
    motion = checked(follow_panels(pattern, by=fold, frames=11, until="120deg"))
    column = motion.angles[:, pattern.folds.index(fold)]
    assert np.allclose(np.diff(column), column[-1] / 10, rtol=0, atol=1e-12)
    names, rows = motion.table()
    assert names[1] == f"{fold[0]}-{fold[1]}"
    assert np.allclose(np.radians(rows[:, 1]), column)


def test_samples_are_close_together():
    motion = follow_panels(mesh(1, 3, seed=1), until="180deg")
    times, angles = motion.sampled(300)
    assert len(times) >= 300
    assert np.abs(np.diff(angles, axis=0)).max() < radians(2.01)
    middle = motion.at(float(times[len(times) // 2]))
    assert middle.shape == motion.coords[0].shape


# --- what cannot be followed ---------------------------------------------------------------------


def test_a_rigid_sheet_is_not_followed():
    with pytest.raises(NotApplicableError, match="rigid - PROVED"):
        follow_panels(chicken_wire(3, 3))


def test_a_mode_that_does_not_fold_is_not_followed():
    result = decompose(shifted_columns(1))
    refuted = [k for k, mode in enumerate(result.modes, 1) if mode.extends.verdict is REFUTED]
    assert refuted
    for number in refuted:
        with pytest.raises(NotApplicableError, match=r"the loop [\d-]+ does not close at order 3"):
            follow_panels(result, modes=[number])
    followed = {k for one in panel_components(result) for k in one.modes}
    assert followed.isdisjoint(refuted)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"until": "far"}, "give contact, or an angle"),
        ({"until": "200deg"}, "up to 180deg"),
        ({"frames": 1}, "at least 2"),
        ({"component": 9}, "no component 9: give a number from 1 to 4"),
        ({"component": 1, "modes": [1]}, "not both"),
        ({"modes": [7]}, "no mode 7: give numbers from 1 to"),
        ({"modes": [1, 4]}, "cannot fold together: both use vertex"),
        ({"amounts": {17: 1}}, "an amount is given for mode 17"),
        ({"amounts": {(0, 1): 1}}, "not a fold from border to border"),
        ({"amounts": {}}, "so nothing folds"),
        ({"amounts": {4: float("nan")}}, "give a finite number"),
        ({"held": 9}, "no panel 9 to hold: give a number from 0 to 8"),
        ({"by": (0, 15)}, "no fold 0-15"),
        ({"by": (0, 1)}, "0-1 is an edge of the border, not a fold to make equal steps of"),
    ],
)
def test_what_does_not_fit_is_said(options, message):
    with pytest.raises(UsageError, match=message):
        follow_panels(miura(2, 2), **options)


def test_a_fold_that_stays_flat_names_no_frames():
    pattern = strip([3, 7, 3])
    first, second = pattern.folds
    with pytest.raises(UsageError, match="stays flat"):
        follow_panels(pattern, amounts={first: 1}, by=second)
