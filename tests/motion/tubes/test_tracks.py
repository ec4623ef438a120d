"""Tubes and tracks: what they prove is true by ways of their own."""

from __future__ import annotations

import copy
import json
import math
import pickle
import random
from dataclasses import replace
from fractions import Fraction

import flint
import numpy as np
import pytest
from sheets import mapped, mirrored, nested_triangles, reflex_corners, relabelled, star_in, wheel
from sixty_digits import holds, newton

from exactfold import checker
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.find import find_branch
from exactfold.errors import FlatVertexError, UsageError
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball
from exactfold.motion.tubes.tracks import Track, follow_proved, ray
from exactfold.motion.tubes.tube import prove_tube, sharpened
from exactfold.motion.tubes.tube_start import ROOT_BITS
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, single_vertex
from exactfold.pattern.triangulating.random_squares import random_square


def signs(n: int, seed: int) -> str:
    return "".join(random.Random(seed).choice("+-") for _ in range(n))


def goal(pattern: CreasePattern, text: str, times: float = 1.6) -> float:
    """A length some times that of the start tube."""
    half = ray(find_branch(pattern, text))
    return float(half.length[0]) * times


def track_of(pattern: CreasePattern, text: str, until: float | None = None) -> Track:
    until = goal(pattern, text) if until is None else until
    track = follow_proved(find_branch(pattern, text), until=until)
    assert track.status is PROVED
    return track


SHEETS = {
    **{f"square {n}": (random_square(n, seed=n), signs(n, n)) for n in range(1, 9)},
    "reflex": (star_in(reflex_corners(1)), "-"),
    "reflex, along a line": (star_in(reflex_corners(4)), "+"),
    "triangles": (nested_triangles(), "+-+"),
    "large coordinates": (
        mapped(random_square(2, seed=1), lambda p: (p[0] * 10**20 + 7, p[1] * 10**20)),
        "+-",
    ),
    "thirds": (wheel([(0, 0), (1, 0), (1, "2/3"), ("1/7", 1)], ("1/3", "2/5")), "+"),
}


@pytest.fixture(scope="module", params=SHEETS)
def track(request: pytest.FixtureRequest) -> Track:
    return track_of(*SHEETS[request.param])


# --- every box holds what it says ----------------------------------------------------------------


def test_boxes_hold_a_recomputation_with_60_digits(track: Track) -> None:
    links = [track.links[0], track.links[len(track.links) // 2], track.links[-1]]
    with flint.ctx.workprec(240):
        for link in links:
            tube = link.tube
            for parameter in (link.exit, -tube.longest, tube.longest // 3 + 1):
                x = newton(track.framework, tube, parameter)
                wide, fine = tube.enclosure(parameter), sharpened(tube, parameter)
                assert holds(wide, x)
                assert holds(fine, x)
                assert max(fine.radii) < 1e-12 * (1 << fine.bits)
                # And nothing is vaguely true: a point of the curve nearby is outside.
                other = newton(track.framework, tube, parameter // 2 + 12345)
                assert not holds(wide, other)


def test_velocities_hold_difference_quotients(track: Track) -> None:
    tube, step = track.links[-1].tube, 1 << 12
    with flint.ctx.workprec(240):
        a, b = (newton(track.framework, tube, step * k) for k in (-1, 1))
        scale = Fraction(1 << PARAMETER_BITS, 2 * step)
        ball = tube.velocity(0)
        wider = replace(ball, radii=tuple(r + (1 << ball.bits - 50) for r in ball.radii))
        assert holds(wider, [(y - x) * scale for x, y in zip(a, b, strict=True)])


def test_lengths_of_edges_are_kept(track: Track) -> None:
    last = float(track.length[0])
    for frame in track.frames([0.0, last / 7, last / 2, last]):
        assert track.framework.length_error(frame.ball.floats[0]) < 1e-12
        low, high = frame.time
        assert 0 <= high - low <= track.length[1] / 50_000


def test_frames_come_at_their_times(track: Track) -> None:
    """The length of the polygon through many frames is that of the motion, nearly."""
    unit = float(track.framework.unit)
    last = float(track.length[0])
    times = np.linspace(0, last, 30)
    frames = track.frames(list(times))
    points = np.array([frame.ball.floats[0] for frame in frames]) * unit
    found = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    assert (found < times + 1e-5 * last).all()
    assert (found > times - 1e-2 * last).all()
    for frame, time in zip(frames, times, strict=True):
        assert abs(float(frame.time[0]) - time) < 1e-5 * last


def test_the_relative_width_of_the_length_is_small(track: Track) -> None:
    low, high = track.length
    assert 0 < high - low < low / 50_000
    assert low > track.started[1] * track.framework.unit * Fraction(3, 2)


# --- links ---------------------------------------------------------------------------------------


def test_pieces_are_linked(track: Track) -> None:
    last = track.start.last
    ball, velocity = track.start.ball(last), track.start.ball_velocity(last)
    for link in track.links:
        low, high = link.tube.located(ball)
        assert (low, high) == link.entry
        assert high <= link.exit <= link.tube.longest
        assert link.tube.goes_along(velocity) == 1
        backwards = replace(velocity, centre=tuple(-x for x in velocity.centre))
        assert link.tube.goes_along(backwards) == -1
        assert link.tube.lies_in(link.tube.enclosure(link.exit))
        ball, velocity = link.tube.enclosure(link.exit), link.tube.velocity(link.exit)


def test_what_is_far_or_wide_does_not_lie_in_a_tube(track: Track) -> None:
    tube = track.links[0].tube
    ball = tube.enclosure(0)
    room = [tube.uniqueness * w >> 128 + 16 - tube.bits for w in tube.weights]
    for i in range(0, len(room) - 1, 2):
        # Across the curve: T does not change.
        t, u = tube.row[i], tube.row[i + 1] or int(not tube.row[i])
        size = 2 * max(room[i], room[i + 1]) // max(abs(t), abs(u)) + 2
        moved = list(ball.centre)
        moved[i] += u * size
        moved[i + 1] -= t * size
        assert not tube.lies_in(replace(ball, centre=tuple(moved)))
        wide = list(ball.radii)
        wide[i] += room[i] + 2
        assert not tube.lies_in(replace(ball, radii=tuple(wide)))
    flat = Ball(tube.bits, (0,) * len(room), (0,) * len(room))
    assert not tube.lies_in(flat)
    beyond = track.links[-1].tube.enclosure(track.links[-1].exit)
    assert len(track.links) == 1 or not tube.lies_in(beyond)


def test_parameters_are_located(track: Track) -> None:
    tube = track.links[-1].tube
    for parameter in (0, tube.longest // 2, -tube.longest // 3):
        low, high = tube.located(sharpened(tube, parameter))
        assert low <= parameter <= high
        assert high - low < 10**4


def test_candidates_are_those_that_are_located(track: Track) -> None:
    balls = [sharpened(link.tube, at) for link in track.links for at in (0, link.exit)]
    balls += [reflected(ball) for ball in balls]
    points = np.array([ball.floats[0] for ball in balls])
    for link in track.links[:4]:
        found = [k for k, ball in enumerate(balls) if link.tube.lies_in(ball)]
        assert link.tube.candidates(points).tolist() == found
        assert len(found) >= 2
    assert track.links[0].tube.candidates(points[:0]).tolist() == []


def test_nothing_is_proved_beyond_the_reach(track: Track) -> None:
    tube = track.links[0].tube
    with pytest.raises(ArithmeticError, match="beyond the reach"):
        tube.enclosure(tube.longest + 1)


def test_where_there_is_no_curve_there_is_no_tube(track: Track) -> None:
    """Far from all configurations, and where the Jacobian is singular: the flat state."""
    from exactfold.motion.tubes.length_equations import LengthEquations

    equations = LengthEquations.of(track.framework)
    size = track.framework.size
    away = np.random.default_rng(0).normal(size=size) * 1e-3
    assert prove_tube(equations, np.zeros(size), away, 0.01) is None


# --- names ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", SHEETS)
def test_a_track_is_that_of_its_branch(name: str) -> None:
    pattern, text = SHEETS[name]
    branch = find_branch(pattern, text)
    track = ray(branch)
    assert track.vertex_signs == {
        v: s for v, s in branch.vertex_signs.items() if v not in pattern.rigid_vertices
    }
    assert track.side == 1
    other = ray(branch, -1)
    assert other.vertex_signs == {v: -s for v, s in track.vertex_signs.items()}
    assert other.side == -1
    assert (track.corner is None) == pattern.is_convex
    assert track.links == ()


def reflected(ball: Ball) -> Ball:
    """The box of the mirror image in the plane of the sheet."""
    return replace(ball, centre=tuple(-x if k % 3 == 2 else x for k, x in enumerate(ball.centre)))


def test_the_opposite_half_branch_is_the_mirror_image(track: Track) -> None:
    branch = find_branch(
        track.pattern, [track.vertex_signs.get(v, 0) for v in track.pattern.interior]
    )
    other = follow_proved(
        branch, -1, until=1.6 / 1.00001 * float(track.started[0] * track.framework.unit)
    )
    assert other.length[0] == pytest.approx(track.length[0])
    assert other.vertex_signs == {v: -s for v, s in track.vertex_signs.items()}
    last = track.start.last
    assert reflected(track.start.ball(last)).contains(other.start.ball(-last)) or other.links[
        0
    ].tube.lies_in(reflected(track.start.ball(last)))
    for link in track.links:
        ball = reflected(sharpened(link.tube, link.exit))
        assert any(piece.tube.lies_in(ball) for piece in other.links)
        assert not any(piece.tube.lies_in(ball) for piece in track.links)


def test_relabelled_and_reflected_sheets_move_alike() -> None:
    pattern, text = random_square(3, seed=5), "+-+"
    track = track_of(pattern, text)
    order = [3, 5, 0, 6, 2, 4, 1]
    other_pattern = relabelled(pattern, order)
    values = dict(zip(pattern.interior, text, strict=True))
    moved = {order.index(v): 1 if s == "+" else -1 for v, s in values.items()}
    pinned = tuple(order.index(v) for v in track.framework.pinned)
    # Two rays have these vertex signs; their saddles differ.
    others = [
        follow_proved(
            find_branch(other_pattern, {v: side * x for v, x in moved.items()}),
            side,
            until=0.6,
            pinned=pinned,
        )
        for side in (1, -1)
    ]
    assert all(other.vertex_signs == moved for other in others)

    def moves(which: Track, time: float) -> np.ndarray:
        d = which.framework.displacement(which.frame(time).ball.floats[0])
        return d * float(which.framework.unit)

    last = float(track.length[0])
    for time in (0.1 * last, 0.5 * last, 0.99 * last):
        same = [np.allclose(moves(track, time)[order], moves(o, time), atol=1e-5) for o in others]
        assert sum(same) == 1
    image = track_of(mapped(pattern, mirrored), text)
    for time in (0.2 * last, 0.9 * last):
        angles = [
            fold_angles_of(t.framework.positions(t.frame(time).ball.floats[0]), t.framework.hinges)
            for t in (track, image)
        ]
        assert np.allclose(*angles, atol=1e-5)


# --- one vertex of degree four, exactly ----------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("text", ["+", "-"])
def test_one_vertex_of_degree_four_obeys_the_half_angle_equations(seed: int, text: str) -> None:
    """c12 c41 x^2 (1 + |d3|^2 z^2) = c23 c34 z^2 (1 + |d1|^2 x^2), tau = tan(phi/2) / length."""
    pattern = random_square(1, seed=seed)
    track = track_of(pattern, text, 1.5)
    ring = pattern.star(4)
    d = [np.array([float(x) for x in pattern.vertices[v]]) for v in (*ring, 4)]
    d = [p - d[4] for p in d[:4]]
    cross = [d[k][0] * d[(k + 1) % 4][1] - d[k][1] * d[(k + 1) % 4][0] for k in range(4)]
    folds = [pattern.folds.index((v, 4)) for v in ring]
    for frame in track.frames([0.05, 0.4, 0.9, 1.5]):
        framework = track.framework
        angles = fold_angles_of(framework.positions(frame.ball.floats[0]), framework.hinges)
        tau = [math.tan(angles[f] / 2) / np.linalg.norm(v) for f, v in zip(folds, d, strict=True)]
        for k in range(2):
            x, z = tau[k], tau[k + 2]
            left = cross[k] * cross[k - 1] * x**2 * (1 + d[k + 2] @ d[k + 2] * z**2)
            right = cross[k + 1] * cross[k + 2] * z**2 * (1 + d[k] @ d[k] * x**2)
            assert left == pytest.approx(right, rel=1e-9)


# --- ends ----------------------------------------------------------------------------------------


def test_a_track_ends_where_it_is_told() -> None:
    branch = find_branch(random_square(2, seed=0), "+-")
    seen = []

    def stop(link: object) -> str | None:
        seen.append(link)
        return "three are enough" if len(seen) == 3 else None

    track = follow_proved(branch, stop=stop)
    assert (track.status, track.reason, len(track.links)) == (PROVED, "three are enough", 3)
    assert list(track.links) == seen
    few = follow_proved(branch, until=9, most=2)
    assert (few.status, few.reason) == (UNDECIDED, "the limit of 2 tubes was reached")
    assert len(few.links) == 2


def test_at_the_flat_state_a_track_is_undecided() -> None:
    """The rays of two vertices return to the flat state, where tubes become short."""
    track = follow_proved(find_branch(random_square(2, seed=1), "++"))
    assert track.status is UNDECIDED
    assert track.reason.startswith("all faces come to lie in one plane, flat")
    assert 20 < len(track.links) < 100
    end = track.links[-1].tube.enclosure(track.links[-1].exit).floats[0]
    assert np.abs(end).max() < 0.05
    # It is no branch point, although all stars are flat there.
    on = follow_proved(find_branch(random_square(2, seed=1), "++"), through_branch_points=True)
    assert (on.status, on.reason, on.through) == (UNDECIDED, track.reason, ())


def test_most_tubes_hold_the_curve_on_both_sides_of_their_centres() -> None:
    track = track_of(random_square(5, seed=2), "+-++-", until=1.5)
    begins = [link.entry[0] / link.tube.longest for link in track.links[1:]]
    assert len(begins) > 5
    assert sum(begin < -0.4 for begin in begins) > 0.8 * len(begins)


def test_the_return_to_the_flat_state_is_proved() -> None:
    """A point of exactly one other ray lies in a tube of the track, which comes back."""
    pattern = random_square(2, seed=1)
    branches = [find_branch(pattern, text) for text in ("++", "+-", "-+", "--")]
    halves = [ray(branch, side) for branch in branches for side in (1, -1)]
    ends = []
    for half in halves:
        # Nearer to the flat state than the tubes of the track reach at first.
        tau = half.start.last // 2
        ends.append((half.start.ball(tau), half.start.ball_velocity(tau)))
    found = []
    track = follow_proved(branches[0])
    for link in track.links[2:]:
        for k, (ball, velocity) in enumerate(ends):
            if link.tube.lies_in(ball):
                found.append((k, link.tube.goes_along(velocity)))
    assert len(set(found)) == 1
    (other, direction), *_ = found
    assert direction == -1
    assert other != 0


def test_flat_vertices_and_unproved_branches_are_refused() -> None:
    pattern = flat_vertex_square()
    branches = [find_branch(pattern, text) for text in ("++", "+-", "-+", "--")]
    flat = next(b for b in branches if 0 in b.vertex_signs.values())
    with pytest.raises(FlatVertexError, match="stays flat on this branch"):
        ray(flat)
    branch = find_branch(single_vertex(4), "+")
    with pytest.raises(UsageError, match="the side is 0"):
        ray(branch, 0)
    with pytest.raises(UsageError, match="proved from a proved branch"):
        ray(replace(branch, status=UNDECIDED))


def test_times_that_are_not_reached_are_refused() -> None:
    track = track_of(random_square(1, seed=0), "+")
    for time in (-0.1, 5.0):
        with pytest.raises(UsageError, match="does not reach the time"):
            track.frame(time)


# --- certificates --------------------------------------------------------------------------------


def test_certificates_are_verified(track: Track) -> None:
    document = json.loads(json.dumps(track.certificate()))
    claims = checker.check(document)
    expected = [track.vertex_signs.get(v, 0) for v in track.pattern.interior]
    assert claims["vertex_signs"] == expected
    assert claims["side"] == track.side
    assert claims["tubes"] == len(track.links)
    length = Fraction(claims["length"])
    assert track.length[0] * Fraction(98, 100) < length <= track.length[1]


def test_tracks_pickle_and_copy(track: Track) -> None:
    other = pickle.loads(pickle.dumps(track))
    assert other == track
    assert copy.copy(track) == track
    assert other.links[-1].tube.enclosure(0) == track.links[-1].tube.enclosure(0)
    assert repr(other) == repr(track)


def test_the_start_tube_is_left_within_its_reach() -> None:
    start = ray(find_branch(random_square(1, seed=0), "+")).start
    assert start.last**2 <= start.longest
    assert start.last % (1 << ROOT_BITS - 8) == 0
