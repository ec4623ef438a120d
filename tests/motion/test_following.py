"""Motions in floats, against what is known exactly of them."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest
from sampling import slow_after
from sheets import random_wheel, reflex_corners, scrambled

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches, find_branch
from exactfold.errors import NotApplicableError, UndecidedBranchError, UsageError
from exactfold.motion import follow
from exactfold.motion.curves.motion import Motion
from exactfold.pattern import read_fold
from exactfold.pattern.data import example_path


def drawn_signs(n, seed):
    source = random.Random(seed)
    return "".join(source.choice("+-") for _ in range(n))


def squares(n, number):
    for seed in range(number):
        yield find_branch(random_square(n, seed=seed), drawn_signs(n, seed))


def letters(angles):
    return "".join("V" if angle > 0 else "M" for angle in angles)


# --- rigid faces ---------------------------------------------------------------------------------


def assert_rigid(motion):
    pattern = motion.branch.pattern
    flat = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    i, j = np.array(pattern.edges).T
    exact = np.linalg.norm(flat[i] - flat[j], axis=1)
    lengths = np.linalg.norm(motion.coords[:, i] - motion.coords[:, j], axis=2)
    assert np.max(np.abs(lengths / exact - 1)) <= 1e-12
    assert motion.length_error <= 1e-12
    held = motion.coords[:, list(motion.pinned)]
    assert np.array_equal(held, np.broadcast_to(held[0], held.shape))
    assert not held[..., 2].any()


@pytest.mark.parametrize("n", [2])
def test_lengths_are_kept_on_random_squares(n):
    for branch in squares(n, 2):
        motion = follow(branch, until="return", through_branch_points=True, frames=9)
        assert motion.end in ("return", "singular")
        assert_rigid(motion)


@pytest.mark.survey
@pytest.mark.parametrize("n", range(1, 7))
def test_lengths_are_kept_on_fifty_random_squares(n):
    for branch in squares(n, 50):
        assert_rigid(follow(branch, frames=9))


@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_lengths_are_kept_on_reflex_sheets_and_in_triangulated_triangles(seed):
    sheet = scrambled(seed, reflex_corners(seed), 3, loose=True)
    for branch in count_branches(sheet).branches[::3]:
        assert_rigid(follow(branch, until="return", through_branch_points=True, frames=9))
    octahedron = read_fold(example_path("flat-octahedron"))
    assert_rigid(follow(count_branches(octahedron).branches[seed], frames=9))


@pytest.mark.parametrize("n", [1, 3, 6, 30])
def test_a_motion_starts_along_its_branch(n):
    for branch in squares(n, 3):
        for side in (1, -1):
            motion = follow(branch, until=1e-3, frames=2, side=side)
            turn = str.maketrans("MV", "MV" if side > 0 else "VM")
            assert letters(motion.angles[1]) == branch.assignment_text.translate(turn)
            degrees = branch.fold_angles.degrees(30)
            first = np.array([degrees[fold] for fold in branch.pattern.folds])
            found = side * motion.angles[1]
            assert found / np.max(np.abs(found)) == pytest.approx(first / 30, abs=1e-4)


# --- the same sheet, seen otherwise --------------------------------------------------------------


def same_motion(one: Motion, two: Motion, places, scale=1.0):
    """Whether fold k of one moves as fold places[k] of the other."""
    assert one.end == two.end
    assert two.times == pytest.approx(scale * one.times, rel=1e-9)
    assert two.angles[:, places] == pytest.approx(one.angles, abs=1e-8)
    kinds = [[event.kind for event in motion.events] for motion in (one, two)]
    assert sorted(kinds[0]) == sorted(kinds[1])


def the_branch(pattern, wanted):
    """The branch with these letters, and the side that has them."""
    for branch in count_branches(pattern).branches:
        for side in (1, -1):
            turn = str.maketrans("MV", "MV" if side > 0 else "VM")
            text = branch.assignment_text.translate(turn)
            if dict(zip(pattern.folds, text, strict=True)) == wanted:
                yield branch, side


@pytest.mark.parametrize("seed", slow_after(1, range(4)))
def test_the_mirror_image_of_a_sheet_has_the_mirror_motion(seed):
    pattern = random_square(3, seed=seed)
    branch = find_branch(pattern, drawn_signs(3, seed))
    motion = follow(branch, frames=15)
    mirrored = CreasePattern(
        [(-x, y) for x, y in pattern.vertices], [(a, c, b) for a, b, c in pattern.triangles]
    )
    [(other, side)] = the_branch(mirrored, dict(branch.assignment))
    image = follow(other, frames=15, side=side)
    same_motion(motion, image, range(len(pattern.folds)))
    assert image.coords == pytest.approx(motion.coords * [-1, 1, 1], abs=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_other_labels_make_the_same_motion(seed):
    pattern = random_square(3, seed=seed)
    branch = find_branch(pattern, drawn_signs(3, seed))
    order = list(range(len(pattern.vertices)))
    random.Random(seed).shuffle(order)  # vertex v is called order[v]
    points = {order[v]: point for v, point in enumerate(pattern.vertices)}
    named = CreasePattern(
        [points[v] for v in range(len(order))],
        [tuple(order[v] for v in face) for face in pattern.triangles],
    )
    renamed = {tuple(sorted((order[i], order[j]))): (i, j) for i, j in pattern.folds}
    wanted = {fold: branch.assignment[renamed[fold]] for fold in named.folds}
    [(other, side)] = the_branch(named, wanted)
    places = [named.folds.index(tuple(sorted((order[i], order[j])))) for i, j in pattern.folds]
    same_motion(follow(branch, frames=15), follow(other, frames=15, side=side), places)


@pytest.mark.parametrize("factor", [Fraction(3, 7), Fraction(10**9)])
def test_a_larger_sheet_takes_longer(factor):
    pattern = random_square(4, seed=1)
    large = CreasePattern(
        [(factor * x, factor * y) for x, y in pattern.vertices], pattern.triangles
    )
    one, two = (follow(find_branch(sheet, "+-++"), frames=15) for sheet in (pattern, large))
    same_motion(one, two, range(len(pattern.folds)), float(factor))
    assert two.coords == pytest.approx(float(factor) * one.coords, rel=1e-9, abs=1e-9 * factor)


def test_the_two_sides_are_mirror_images():
    branch = find_branch(random_square(4, seed=2), "++-+")
    up, down = (follow(branch, side=side, frames=7) for side in (1, -1))
    assert np.array_equal(up.coords * [1, 1, -1], down.coords)
    assert up.angles == pytest.approx(-down.angles, abs=1e-14)
    assert (up.end, up.duration) == (down.end, down.duration)
    assert up != down


# --- one vertex of degree four: a spherical four-bar linkage --------------------------------------


def four_bar(sectors, one, two):
    """What closes a vertex with these sector angles, from the half-angle tangents of two folds.

    Sector 0 lies in the plane, between the folds with the tangents `one` and `two`; sector 3 turns
    about the first and sector 1 about the second, and their outer sides must have the angle of
    sector 2. Multiplied by (1 + one^2) (1 + two^2) this is a polynomial; here divided by them.
    """
    a, b, c, d = sectors
    cosines = [(1 - t * t) / (1 + t * t) for t in (one, two)]
    sines = [2 * t / (1 + t * t) for t in (one, two)]
    first, across = np.array([1, 0, 0]), np.array([0, 1, 0])
    second = np.array([np.cos(a), np.sin(a), 0])
    along = np.array([-np.sin(a), np.cos(a), 0])
    up = np.array([0, 0, 1])
    outer = np.cos(d) * first + np.sin(d) * (-cosines[0] * across + sines[0] * up)
    other = np.cos(b) * second + np.sin(b) * (cosines[1] * along + sines[1] * up)
    return outer @ other - np.cos(c)


@pytest.mark.parametrize("seed", slow_after(1, range(3)))
@pytest.mark.parametrize("sign", "+-")
def test_one_vertex_of_degree_four_is_a_spherical_four_bar(seed, sign):
    pattern = random_wheel(seed, 4)
    motion = follow(find_branch(pattern, sign), until="return", frames=40)
    hub = np.array([float(x) for x in pattern.vertices[4]])
    arms = [np.array([float(x) for x in pattern.vertices[v]]) - hub for v in range(4)]
    around = [np.arctan2(arm[1], arm[0]) for arm in arms]
    sectors = [(around[(v + 1) % 4] - around[v]) % (2 * np.pi) for v in range(4)]
    assert sum(sectors) == pytest.approx(2 * np.pi)
    assert pattern.folds == ((0, 4), (1, 4), (2, 4), (3, 4))
    tangents = np.tan(motion.angles / 2)
    bent = np.abs(motion.angles) > 1e-3
    assert bent.any(axis=0).all()
    for k in range(4):
        turned = sectors[k:] + sectors[:k]
        for row in tangents:
            assert abs(four_bar(turned, row[k], row[(k + 1) % 4])) < 1e-11
    # The test sees a wrong angle.
    assert max(abs(four_bar(sectors, row[0], -row[1])) for row in tangents) > 1e-3


# --- frames --------------------------------------------------------------------------------------


def test_a_motion_ends_where_it_is_asked_to():
    branch = find_branch("two-vertex", "+-")
    assert follow(branch, until=0.25, frames=4).times == pytest.approx([0, 0.25 / 3, 0.5 / 3, 0.25])
    assert follow(branch, until="time=0.25").end == "length"
    degrees = follow(branch, until="30deg")
    assert np.degrees(np.max(np.abs(degrees.angles[-1]))) == pytest.approx(30)
    assert (degrees.end, degrees.events[-1].kind) == ("angle", "angle")


@pytest.mark.slow
def test_frames_at_equal_steps_of_an_angle():
    branch = find_branch("two-vertex", "+-")
    motion = follow(branch, until="60deg", frames=7, by=(3, 5))
    at = branch.pattern.folds.index((3, 5))
    steps = np.diff(motion.angles[:, at])
    assert steps == pytest.approx(np.full(6, steps[0]), abs=1e-9)
    assert np.std(np.diff(motion.times)) > 1e-5
    with pytest.raises(UsageError, match="turns back"):
        follow(find_branch(random_square(2, seed=1), "+-"), until="return", by=(1, 4))
    for pair, words in (
        ((0, 1), "0-1 is an edge of the boundary"),
        ((0, 2), "there is no fold 0-2"),
    ):
        with pytest.raises(UsageError, match=f"{words}.* to make equal steps of"):
            follow(branch, by=pair)


def test_any_time_between_frames():
    motion = follow(find_branch("two-vertex", "-+"), frames=11)
    for k in (0, 3, 10):
        assert motion.at(motion.times[k]) == pytest.approx(motion.coords[k], abs=1e-12)
    x, y = motion.at(0.5), motion.at(0.5 + 1e-6)
    free = [v for v in range(6) if v not in motion.pinned]
    assert np.linalg.norm((y - x)[free]) == pytest.approx(1e-6, rel=1e-4)  # time is arclength
    for time in (-0.1, motion.duration + 0.1, float("nan")):
        with pytest.raises(UsageError, match="this motion has the times"):
            motion.at(time)


def test_tables_and_angles_of_all_folds():
    motion = follow(find_branch("two-vertex", "-+"), frames=4)
    names, rows = motion.table()
    assert names[:2] == ("time", "0-4")
    assert rows.shape == (4, 8)
    assert rows[:, 1:] == pytest.approx(np.degrees(motion.angles))
    largest = motion.largest_angles
    assert np.abs(largest) == pytest.approx(np.abs(rows[:, 1:]).max(axis=0))
    times, angles = motion.sampled(500)
    assert len(times) == len(angles) >= 500
    assert angles[-1] == pytest.approx(motion.angles[-1], abs=1e-9)


@pytest.mark.parametrize(
    "options",
    [
        {"until": "never"},
        {"until": "200deg"},
        {"until": -1},
        {"until": float("nan")},
        {"frames": 1},
        {"side": 0},
        {"by": (0, 1)},
    ],
)
def test_options_that_make_no_sense(options):
    with pytest.raises(UsageError):
        follow(find_branch("two-vertex", "+-"), **options)


def test_branches_that_are_not_followed():
    flat = next(b for b in count_branches("flat-vertex").branches if "0" in b.sign_text)
    with pytest.raises(NotApplicableError, match="vertex 5 is flat"):
        follow(flat)
    from dataclasses import replace

    nothing = replace(find_branch("two-vertex", "+-"), root=None)
    with pytest.raises(UndecidedBranchError, match="nothing is proved"):
        follow(nothing)


def test_the_last_frame_of_a_return_is_the_flat_sheet():
    """Its heights are rounding errors, which have no direction to correct it in."""
    motion = follow(
        find_branch(random_square(3, seed=1), "+-+"),
        until="return",
        through_branch_points=True,
        frames=4,
    )
    assert motion.end == "return"
    assert np.abs(motion.coords[-1] - motion.coords[0]).max() < 1e-14
    assert motion.length_error < 1e-12


@pytest.mark.parametrize(
    ("name", "way", "changes"),
    [("flat-octahedron", 7, 1), ("random-8", 1, 2), ("two-vertex", 3, 0)],
)
def test_a_fold_that_passes_through_flat_is_an_event(name, way, changes):
    branch = count_branches(name).branches[way - 1]
    motion = follow(branch, frames=400)
    events = [event for event in motion.events if event.kind == "change"]
    assert len(events) == changes
    mirror = [event for event in follow(branch, side=-1).events if event.kind == "change"]
    for event, other in zip(events, mirror, strict=True):
        column = motion.angles[:, motion.pattern.folds.index(event.folds[0])]
        before, after = column[motion.times < event.time[0]], column[motion.times > event.time[1]]
        valley = event.detail == "from valley to mountain"
        assert (before[-1] > 0 > after[0]) if valley else (before[-1] < 0 < after[0])
        swapped = "from mountain to valley" if valley else "from valley to mountain"
        assert (other.folds, other.detail) == (event.folds, swapped)
    flips = (motion.angles[1:-1] * motion.angles[2:] < 0) & (np.abs(motion.angles[2:]) > 1e-6)
    assert flips.sum() == changes


def test_folds_that_are_flat_at_the_end_have_not_changed():
    back = follow(find_branch("two-vertex", "+-"), until="return", through_branch_points=True)
    assert back.end == "return"
    assert [event for event in back.events if event.kind == "change"] == []
