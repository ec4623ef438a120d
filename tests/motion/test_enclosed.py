"""Frames of proved motions: what is stored is as near to a true configuration as it says."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction

import flint
import numpy as np
import pytest
from sheets import nested_triangles
from sixty_digits import newton

from exactfold import checker, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import find_branch
from exactfold.errors import UsageError
from exactfold.motion import follow, prove, write_motion
from exactfold.motion.loops.frames import frame_of
from exactfold.motion.loops.loops import Landing
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.piece import PARAMETER_BITS
from exactfold.motion.tubes.tube import ROW_BITS
from exactfold.pattern import load
from exactfold.pattern.data import example_path
from exactfold.rigidity.equations.problem import Problem

NODE_SHEET, NODE_SIGNS = random_square(8, seed=1), "------++"


@pytest.fixture(scope="module")
def returned():
    """The proof of a motion back to the flat sheet."""
    return prove(follow(find_branch("two-vertex", "+-"), until="return", frames=24))


def tube_through(track, point):
    """A tube and the parameter at which a point is on it; the parameters of frames are whole."""
    for link in track.links:
        tube = link.tube
        off = [
            Fraction(x) - Fraction(c, 1 << tube.bits)
            for x, c in zip(point, tube.coefficients[0], strict=True)
        ]
        s = sum(Fraction(t, 1 << ROW_BITS) * x for t, x in zip(tube.row, off, strict=True))
        whole = round(s * (1 << PARAMETER_BITS))
        if link.entry[0] <= whole <= link.exit and abs(s * (1 << PARAMETER_BITS) - whole) < 1e-3:
            return tube, whole
    return None


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize(
    ("pattern", "signs"),
    [(random_square(2, seed=2), "+-"), (nested_triangles(), "+-+")],
    ids=["square", "triangles"],
)
def test_stored_coordinates_are_near_a_recomputation_with_60_digits(pattern, signs, side):
    motion = follow(find_branch(pattern, signs), until="100deg", frames=9, side=side)
    proof = prove(motion)
    assert proof.status is PROVED
    framework, problem = proof.track.framework, Problem.of(pattern)
    place = {problem.labels[int(v)]: 3 * k for k, v in enumerate(framework.free)}
    seen = 0
    for k, time in enumerate(proof.motion.times):
        ball = proof.track.frame(float(time)).ball
        found = tube_through(proof.track, [Fraction(x, 1 << ball.bits) for x in ball.centre])
        if found is None:  # on the start tube
            continue
        with flint.ctx.workprec(240):
            x = newton(framework, *found)
        radius = Fraction(proof.motion.bounds.radii[k])
        worst = Fraction(0)
        for v, at in place.items():
            flat = [*(Fraction(c) for c in pattern.vertices[v]), Fraction(0)]
            stored = [Fraction(c) for c in proof.motion.coords[k, v].tolist()]
            true = [u + framework.unit * d for u, d in zip(flat, x[at : at + 3], strict=True)]
            worst = max(worst, *(abs(a - b) for a, b in zip(stored, true, strict=True)))
        seen += 1
        assert worst <= radius < 1e-14 * float(framework.unit)
        assert worst > radius / 20  # and the bound is not vague
    assert seen >= 3


def test_what_lies_in_a_triangle_is_bounded_as_its_corners():
    pattern = nested_triangles()
    proof = prove(follow(find_branch(pattern, "+-+"), until="40deg", frames=3))
    coords, radii = proof.motion.coords, proof.motion.bounds.radii
    problem = Problem.of(pattern)
    assert problem.flat_inside
    for vertex, cycle, weights in problem.flat_inside:
        for k in range(3):
            for axis in range(3):
                there = sum(
                    w * Fraction(coords[k, c, axis].item())
                    for c, w in zip(cycle, weights, strict=True)
                )
                assert abs(there - Fraction(coords[k, vertex, axis].item())) <= 2 * radii[k]


@pytest.mark.slow
def test_the_motion_keeps_its_times_and_events(returned):
    motion, floats = (
        returned.motion,
        follow(find_branch("two-vertex", "+-"), until="return", frames=24),
    )
    assert (motion.status, floats.status) == (PROVED, UNDECIDED)
    assert motion.times.tolist() == floats.times.tolist()
    assert motion.events == floats.events
    assert np.abs(motion.coords - floats.coords).max() < 1e-6
    assert np.abs(motion.angles - floats.angles).max() < 1e-5
    assert motion != floats
    assert motion.length_error < 1e-14
    assert repr(motion.bounds).startswith("<FrameBounds: 24 frames, radius ")
    for time, (low, high) in zip(motion.times, motion.bounds.times, strict=True):
        assert 0 <= low <= time <= high < low + 1e-5


def test_a_loop_is_as_long_as_the_way_through_its_frames(returned):
    """Distances of frames are at most the differences of their times, and nearly so."""
    looped, motion = returned.looped, returned.motion
    unit = float(looped.start.framework.unit)
    times = np.linspace(0.0, motion.duration, 60)
    frames = [frame_of(looped, time) for time in times]
    points = np.array([frame.ball.floats[0] for frame in frames]) * unit
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    for chord, one, two in zip(chords, frames, frames[1:], strict=False):
        assert chord <= float(two.time[1] - one.time[0]) + 1e-12
    assert chords.sum() > 0.99 * motion.duration
    for frame in frames:
        assert looped.start.framework.length_error(frame.ball.floats[0]) < 1e-13
    assert np.abs(points[0]).max() < 1e-15 > np.abs(points[-1]).max()
    with pytest.raises(UsageError, match="does not reach"):
        frame_of(looped, motion.duration * 1.01)


def test_the_way_back_may_be_described_by_the_mirror_image(returned):
    """A start tube stands for the ray and, at negative tau, for its mirror image."""
    looped, duration = returned.looped, returned.motion.duration
    landing, time = looped.landing, returned.motion.duration * 0.999
    start = landing.start
    heights = np.arange(len(start.weights)) % 3 == 2
    turned = replace(
        start,
        coefficients=tuple(
            tuple(-x if high else x for x, high in zip(row, heights, strict=True))
            for row in start.coefficients
        ),
    )
    other = replace(looped, landing=Landing(landing.to, turned, -landing.tau))
    one, two = frame_of(looped, time), frame_of(other, time)
    assert one.time == two.time
    assert abs(float(one.time[0]) - time) < 1e-5 * duration
    assert np.abs(one.ball.floats[0] - two.ball.floats[0]).max() < 1e-14


def test_a_motion_in_floats_that_left_the_branch_is_not_proved():
    motion = follow(find_branch("two-vertex", "+-"), until="50deg", frames=4)
    coords = motion.coords.copy()
    coords[2, :, 2] *= -1
    proof = prove(replace(motion, coords=coords))
    assert proof.status is UNDECIDED
    assert "floats have left the branch" in proof.reason
    assert proof.motion.bounds is None
    assert proof.motion.status is UNDECIDED


def test_files_and_json_hold_the_bounds(tmp_path):
    motion = follow(find_branch("two-vertex", "+-"), until="50deg", frames=4)
    assert motion.to_dict()["frames"]["radii"] is motion.to_dict()["frames"]["time_bounds"] is None
    proved = prove(motion).motion
    report = proved.to_dict()
    assert report["status"] == "proved"
    assert report["frames"]["radii"] == list(proved.bounds.radii)
    write_motion(motion, tmp_path / "floats.fold")
    write_motion(proved, tmp_path / "proved.fold")
    plain, frames = (
        json.loads((tmp_path / f"{name}.fold").read_text())["file_frames"]
        for name in ("floats", "proved")
    )
    assert not any("radius" in key for frame in plain for key in frame)
    assert [f["frame_exactfold:radius"] for f in frames] == report["frames"]["radii"]
    assert [f["frame_exactfold:timeBounds"] for f in frames] == report["frames"]["time_bounds"]
    assert [f["vertices_coords"] for f in frames] == proved.coords.tolist()


def test_a_return_writes_its_loop(returned, tmp_path):
    assert returned.write(tmp_path / "loop.txt")
    assert (tmp_path / "loop.txt").read_text() == returned.certificate().text
    claims = checker.verify(tmp_path / "loop.txt")
    assert (claims["loops"], claims["matched"], claims["half_branches"]) == (1, 4, 8)
    assert returned.write(tmp_path / "loop.txt")  # in place of the first


def test_a_return_that_is_not_proved_writes_nothing(returned, tmp_path):
    cut = replace(returned.looped, landing=None, reason="lost")
    assert not replace(returned, looped=cut).write(tmp_path / "loop.txt")
    assert not (tmp_path / "loop.txt").exists()


@pytest.mark.slow
def test_a_motion_until_a_fold_closes_after_a_contact_is_proved_to_its_end():
    """It does not end at the first contact, although it ends with faces on each other."""
    branch = find_branch("two-vertex", "+-")
    whole = follow(branch, until="return", frames=2)
    later = next(e for e in whole.events if e.kind == "flat-fold" and e.time[0] > 3.1)
    motion = follow(branch, until=later.time[1], frames=3)
    proof = prove(replace(motion, end="flat-fold"))
    assert proof.status is PROVED
    assert proof.passed
    assert proof.length[1] >= motion.duration > 3.5


@pytest.mark.slow
def test_frames_on_an_arc_through_a_node():
    motion = follow(
        find_branch(NODE_SHEET, NODE_SIGNS), until="return", through_branch_points=True, frames=2
    )
    proof = prove(motion)
    assert proof.status is PROVED
    looped, unit = proof.looped, proof.looped.start.framework.unit
    passages = [step for step in looped.steps if isinstance(step, Passage)]
    assert passages
    for passage in passages:
        low, high = (float(t * unit) for t in (passage.entered[1], passage.left[0]))
        times = np.linspace(low, high, 9)[1:-1]
        frames = [frame_of(looped, time) for time in times]
        points = np.array([frame.ball.floats[0] for frame in frames]) * float(unit)
        chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
        assert chords.sum() == pytest.approx(times[-1] - times[0], rel=1e-2)
        for frame, time in zip(frames, times, strict=True):
            assert float(frame.time[0]) - 1e-5 < time < float(frame.time[1]) + 1e-5
            assert looped.start.framework.length_error(frame.ball.floats[0]) < 1e-12
            assert max(frame.ball.floats[1]) < 1e-13  # not the width of the box of the branch point
        near = frame_of(
            looped, float((passage.entered[0] + passage.tube.length(passage.entry, 0)[0]) * unit)
        )
        assert looped.start.framework.length_error(near.ball.floats[0]) < 1e-8


def test_folded_flat_states_end_a_proof(tmp_path):
    """A vertex that can be folded flat: the motion is proved up to there, and not beyond."""
    sheet = load(example_path("single-vertex-4"))
    proof = prove(follow(find_branch(sheet, "+"), until=0.5, frames=3))
    assert proof.status is PROVED
    assert proof.write(tmp_path / "proof.json")
    assert "one curve without a gap" in checker.summary(checker.verify(tmp_path / "proof.json"))
