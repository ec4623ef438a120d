"""Events of motions along branches: contacts, creases that turn back, branch points."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np
import pytest

from exactfold import CreasePattern, random_square
from exactfold.app.report.motion import event_text
from exactfold.branches import find_branch
from exactfold.motion import follow
from exactfold.motion.curves.crossings import Crossings
from exactfold.motion.curves.events import KINDS, Event
from exactfold.motion.curves.framework import Framework


def drawn_signs(n, seed):
    source = random.Random(seed)
    return "".join(source.choice("+-") for _ in range(n))


def det(a, b, c):
    return (
        a[0] * (b[1] * c[2] - b[2] * c[1])
        - a[1] * (b[0] * c[2] - b[2] * c[0])
        + a[2] * (b[0] * c[1] - b[1] * c[0])
    )


def volume(p, q, r, s):
    return det(*([x - y for x, y in zip(v, p, strict=True)] for v in (q, r, s)))


def crossing_exactly(pattern, coords):
    """All (edge, face) without a common corner that cross, in exact rationals."""
    points = [[Fraction(float(x)) for x in point] for point in coords]
    found = []
    for i, j in pattern.edges:
        for face in pattern.triangles:
            if {i, j} & set(face):
                continue
            p, q, (a, b, c) = points[i], points[j], (points[v] for v in face)
            if volume(a, b, c, p) * volume(a, b, c, q) >= 0:
                continue
            sides = [volume(p, q, a, b) > 0, volume(p, q, b, c) > 0, volume(p, q, c, a) > 0]
            if all(sides) or not any(sides):
                found.append(((i, j), face))
    return found


@pytest.mark.parametrize(
    ("n", "seed", "kind"),
    [
        (4, 0, "vertex on face"),
        (4, 5, "edge on edge"),
        pytest.param(5, 5, "edge on edge", marks=pytest.mark.slow),
        pytest.param(5, 11, "edge on edge", marks=pytest.mark.slow),
    ],
)
def test_contacts_are_those_of_exact_rationals(n, seed, kind):
    motion = follow(find_branch(random_square(n, seed=seed), drawn_signs(n, seed)), frames=9)
    assert motion.end == "contact"
    pattern, event = motion.branch.pattern, motion.events[-1]
    assert event.time[0] <= event.time[1] == motion.duration
    later = follow(motion.branch, until=motion.duration * (1 + 1e-5), frames=9)
    assert [e.kind for e in later.events].count("contact") == 1
    for time in np.linspace(0, event.time[0] * (1 - 1e-6), 12):
        assert crossing_exactly(pattern, later.at(time)) == []
    found = crossing_exactly(pattern, later.at(event.time[1] * (1 + 1e-6)))
    one, two = (set(face) for face in event.faces)
    assert any(
        (set(edge) <= one and set(face) == two) or (set(edge) <= two and set(face) == one)
        for edge, face in found
    )
    assert not len(one & two) > 1
    assert event.detail == kind


def test_a_fold_that_closes_has_180_degrees():
    motion = follow(find_branch("two-vertex", "+-"), frames=5)
    event = motion.events[-1]
    assert motion.end == event.kind == "flat-fold"
    at = motion.branch.pattern.folds.index(event.folds[0])
    assert abs(motion.angles[-1, at]) == pytest.approx(np.pi, abs=1e-9)
    assert np.max(np.abs(motion.angles)) <= np.pi + 1e-9
    assert all(set(event.folds[0]) <= set(face) for face in event.faces)


@pytest.mark.parametrize("seed", range(2))
def test_where_a_crease_turns_back_its_angle_is_extreme(seed):
    branch = find_branch(random_square(5, seed=seed), drawn_signs(5, seed))
    motion = follow(branch, until="return", through_branch_points=True, frames=5)
    turning = [event for event in motion.events if event.kind == "turning"]
    assert turning
    times, angles = motion.sampled(2000)
    folds = branch.pattern.folds
    for event in turning:
        at, time = folds.index(event.folds[0]), event.time[1]
        step = 1e-4 * motion.duration
        if not step < time < motion.duration - step:
            continue
        before, there, after = (motion.at(t) for t in (time - step, time, time + step))
        values = [angle_of(branch.pattern, at, x) for x in (before, there, after)]
        bent = np.unwrap(values)
        assert (bent[1] - bent[0]) * (bent[2] - bent[1]) <= 1e-12
    # And there are no others: each change of direction in fine samples has its event.
    named = [(folds.index(event.folds[0]), event.time[1]) for event in turning]
    changes = np.diff(np.sign(np.diff(angles, axis=0)), axis=0)
    for row, at in np.argwhere(np.abs(changes) == 2):
        low, high = times[row], times[min(row + 2, len(times) - 1)]
        size = np.abs(np.diff(angles[row : row + 3, at]))
        if size.min() < 1e-9:
            continue
        assert any(k == at and low - 1e-6 <= time <= high + 1e-6 for k, time in named)


def angle_of(pattern, place, coords):
    """A fold angle from the normals of its faces, by the angle between two vectors."""
    i, j = pattern.folds[place]
    left, right = pattern.opposite((i, j))
    axis = coords[j] - coords[i]
    one = np.cross(axis, coords[left] - coords[i])
    two = np.cross(coords[right] - coords[i], axis)
    sine = np.cross(one, two) @ axis / np.linalg.norm(axis)
    return -np.arctan2(sine, one @ two)


@pytest.mark.slow
def test_the_sheet_comes_back_flat():
    for n in (1, 2, 3):
        branch = find_branch(random_square(n, seed=n), "+" * n)
        motion = follow(branch, until="return", frames=30)
        assert motion.end == "return"
        assert motion.coords[-1] == pytest.approx(motion.coords[0], abs=1e-9)
        turns = motion.angles[-1] / (2 * np.pi)
        assert turns == pytest.approx(np.round(turns), abs=1e-6)
        assert np.max(np.abs(motion.coords[15] - motion.coords[0])) > 0.1


def test_nodes_stop_a_motion_unless_they_are_passed():
    branch = find_branch(random_square(8, seed=1), "+-++--+-")
    motion = follow(branch, until="return", frames=3)
    assert motion.end == motion.events[-1].kind == "node"
    assert motion.duration == pytest.approx(motion.events[-1].time[0])
    [vertex] = motion.events[-1].vertices
    star = [k for k, fold in enumerate(branch.pattern.folds) if vertex in fold]
    assert np.max(np.abs(motion.angles[-1, star])) < 1e-3
    assert np.max(np.abs(motion.angles[1, star])) > 1e-2
    through = follow(branch, frames=3, through_branch_points=True)
    assert through.duration > motion.duration
    assert "node" in [event.kind for event in through.events]


@pytest.mark.slow
def test_the_tree_of_boxes_finds_what_all_pairs_find():
    branch = find_branch(random_square(100, seed=3), drawn_signs(100, 3))
    motion = follow(branch, until="90deg", frames=3)
    framework = motion.curve.framework
    source = np.random.default_rng(1)
    seen = []
    for frame in motion.coords:
        for noise in (0.0, 0.05, 0.3):
            x = frame + noise * source.normal(size=frame.shape)
            with_tree = Crossings(framework)
            assert with_tree._pairs is None
            expected = {
                (e, f)
                for e, edge in enumerate(with_tree.edges)
                for f, face in enumerate(framework.triangles)
                if not set(edge) & set(face)
            }
            pairs = np.array(sorted(expected))
            crossing = pairs[with_tree.cross(x[None], pairs)[0]]
            assert {tuple(p) for p in with_tree.pairs(x)} == {tuple(p) for p in crossing}
            assert with_tree.any_of(x[None]).tolist() == [len(crossing) > 0]
            if with_tree.graphs(x[None])[0]:
                assert len(crossing) == 0
            seen.append((bool(with_tree.graphs(x[None])[0]), len(crossing) > 0))
    assert (True, False) in seen
    assert (False, True) in seen


def test_a_sheet_over_the_plane_whose_rim_does_not_cross_itself_meets_nothing():
    """A strip: with many corners on a line; rolled up until its ends overlap; face down."""
    cells = 14
    flat = [(k, y) for k in range(cells + 1) for y in (0, 1)]
    faces = [
        face for k in range(0, 2 * cells, 2) for face in ((k, k + 2, k + 1), (k + 1, k + 2, k + 3))
    ]
    crossings = Crossings(Framework.of(CreasePattern(flat, faces)))
    turn = np.repeat(np.arange(cells + 1), 2)[:, None] * np.pi / 6
    radius = 2 + turn / 50 - np.array(flat)[:, 1:]
    rolled = radius * np.hstack([np.cos(turn), np.sin(turn)])
    places = np.array([flat, rolled, rolled[:, ::-1]])
    positions = np.concatenate([places, np.zeros((*places.shape[:2], 1))], axis=2)
    short = Crossings(Framework.of(CreasePattern(flat[:18], faces[:16])))
    assert crossings.graphs(positions).tolist() == [True, False, False]
    assert short.graphs(positions[:, :18]).tolist() == [True, True, False]


def test_every_kind_has_words():
    """They say what happens, and name the folds; a kind that is unknown has none."""
    for kind in KINDS:
        event = Event(kind, (1.0, 1.0), faces=((1, 2, 3), (4, 5, 6)), folds=((7, 8),))
        assert len(event_text(event)) > 10
    with pytest.raises(KeyError):
        event_text(Event("eclipse", (1.0, 1.0)))
