"""Motions that end at a branch point, where other curves cross: proved up to it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from io import StringIO
from itertools import product
from typing import Any

import jsonschema
import numpy as np
import pytest
from rich.console import Console
from sixty_digits import assert_holds_the_node

from exactfold import checker, random_square, schema
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.report import motion_report
from exactfold.app.viewer import known
from exactfold.branches import find_branch
from exactfold.exact.surds import float_bounds
from exactfold.motion import certificate_with_contact, follow, follow_proved, prove, proving
from exactfold.motion.contacts import contacts
from exactfold.motion.contacts.contacts import first_contact
from exactfold.motion.contacts.separation import Open
from exactfold.motion.curves.crossing_curves import crossing_ahead
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes import chain, passages
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.tube import sharpened
from exactfold.motion.tubes.visits import LocatedBranchPoint
from exactfold.rigidity.equations.problem import Problem

SHEET = random_square(5, seed=4)
SIGNS, FLAT = "-+--+", 6


@pytest.fixture(scope="module")
def motion() -> Any:
    found = follow(find_branch(SHEET, SIGNS), frames=4)
    assert found.end == "node"
    return found


@pytest.fixture(scope="module")
def proof(motion: Any) -> Any:
    return prove(motion)


def test_a_motion_to_a_node_is_proved_and_clear_up_to_it(motion, proof):
    assert (proof.status, proof.reason) == (PROVED, "")
    low, high = proof.length
    assert low < high < low * (1 + 1e-6)
    assert float(low) == pytest.approx(motion.duration, rel=1e-6)
    assert proof.contact.clear == low
    assert proof.clear_to_the_end
    assert proof.to_dict()["node"] == {
        "flat": [FLAT],
        "time": [pytest.approx(motion.duration)] * 2,
        "clear": True,
    }
    assert proof.end_text == (
        "until a branch point at the time 0.500686, where vertex 6 is flat and another curve "
        "crosses"
    )
    assert proof.track.reason == "a branch point, where vertex 6 is flat and another curve crosses"
    claims = checker.check(proof.certificate())
    assert claims["node"] == {"flat": [FLAT], "clear": True}
    assert claims["tubes"] + 2 == proof.tubes == proof.track.tubes


def test_the_last_frame_is_the_node(motion, proof):
    bounds, node = proof.motion.bounds, proof.track.branch_point
    assert max(bounds.radii) < 1e-15
    assert bounds.times[-1][0] <= motion.duration <= bounds.times[-1][1]
    last = proof.track.frame(float_bounds(proof.length[1])[0])
    # The box of the last frame, recomputed with 60 digits; the star of the vertex is flat in it.
    assert_holds_the_node(node.tube.patch, last.ball)
    ends = np.array(SHEET.folds)
    at = (ends == FLAT).any(axis=1)
    assert np.abs(proof.motion.angles[-1, at]).max() < 1e-12
    assert np.abs(proof.motion.angles[-1, ~at]).max() > 0.1
    assert np.abs(proof.motion.angles[-2, at]).max() > 1e-4


def test_frames_on_the_arc(proof):
    track = proof.track
    node, unit = track.branch_point, track.framework.unit
    times = np.linspace(float(node.entered[1] * unit), float(node.left[0] * unit), 7)
    frames = track.frames(list(times))
    for frame, time in zip(frames, times, strict=True):
        assert float(frame.time[0]) - 1e-6 < time < float(frame.time[1]) + 1e-6
        assert track.framework.length_error(frame.ball.floats[0]) < 1e-12
        assert max(frame.ball.floats[1]) < 1e-13
    points = np.array([frame.ball.floats[0] for frame in frames]) * float(unit)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert chords.sum() == pytest.approx(times[-1] - times[0], rel=1e-3)


def test_the_mirror_image_ends_at_the_mirrored_node(proof):
    other = follow_proved(find_branch(SHEET, SIGNS), -1)
    node, image = proof.track.branch_point, other.branch_point
    assert image.vertices == node.vertices == (FLAT,)
    assert other.status is PROVED
    mirrored = node.tube.branch_point.mirrored
    assert not image.tube.branch_point.misses(mirrored)
    assert image.tube.branch_point.misses(node.tube.branch_point)
    point = node.tube.patch.point(mirrored.floats[0], mirrored.bits)
    assert point.is_in(mirrored)
    assert point.is_in(image.tube.branch_point)


@pytest.mark.slow
def test_a_track_to_a_time_ends_there_or_at_the_node(proof):
    branch = find_branch(SHEET, SIGNS)
    before = follow_proved(branch, until=0.4)
    assert (before.status, before.branch_point) == (PROVED, None)
    track = follow_proved(branch, until=0.51)
    assert (track.status, track.branch_point.vertices) == (UNDECIDED, (FLAT,))
    assert track.reason == "a branch point, where vertex 6 is flat and another curve crosses"
    assert track.length == proof.length


@pytest.mark.slow
def test_a_motion_that_passes_a_node_is_proved_beyond_it(proof):
    motion = follow(find_branch(SHEET, SIGNS), until=0.6, through_branch_points=True, frames=7)
    passing = prove(motion)
    assert (passing.status, passing.branch_point, passing.end_text) == (PROVED, None, "")
    [node] = passing.through
    assert node.vertices == (FLAT,)
    assert passing.clear_to_the_end
    assert passing.track.length[0] >= Fraction(motion.duration)
    time = pytest.approx(float(proof.length[0]))
    assert passing.to_dict()["through"] == [{"flat": [FLAT], "time": [time, time]}]
    told = f"one curve without a gap, 5 tubes, {passing.through_text}; no two faces touch on it"
    assert told in shown(passing)
    whole = {**passing.motion.to_dict(), "proof": passing.to_dict()}
    jsonschema.validate(whole, schema("motion"))
    claims = checker.check(passing.certificate())
    assert claims["through"] == [[FLAT]]
    assert "node" not in claims
    assert Fraction(claims["clear"]) > 0.6
    # At the branch point all angles of its star change their signs.
    assert max(passing.motion.bounds.radii) < 1e-14  # though one frame is close to the branch point
    at = (np.array(SHEET.folds) == FLAT).any(axis=1)
    before, after = (np.sign(passing.motion.angles[k, at]) for k in (3, -1))
    assert (before * after == -1).all()


@pytest.mark.slow
def test_a_node_that_floats_do_not_see_is_not_passed(motion):
    unseen = replace(motion, events=(), end="contact")
    proof = prove(unseen)
    assert proof.status is UNDECIDED
    assert proof.reason.endswith("the motion in floats goes on without a branch point there")
    assert not proof.may_succeed_otherwise
    assert checker.check(proof.certificate())["node"] == {"flat": [FLAT], "clear": True}


@pytest.mark.slow
def test_faces_that_are_not_parted_on_the_arc_are_named(motion, proof, monkeypatch):
    """The first pair of faces is taken to be near on the last half of the arc."""
    clear = contacts._clear

    def vague(pairs, coefficients, radius, low, high, planar=False):
        if high == 0.0:
            none = np.zeros(0, dtype=np.intp)
            return low / 2, Open(np.zeros(1, dtype=np.intp), none, none)
        return clear(pairs, coefficients, radius, low, high, planar)

    monkeypatch.setattr(contacts, "_clear", vague)
    undecided = prove(motion)
    assert undecided.status is UNDECIDED
    [(one, two)] = undecided.contact.open_faces
    names = " and ".join("-".join(map(str, face)) for face in (one, two))
    assert undecided.reason == (
        f"proved {proof.end_text}, but faces {names} are not proved to stay apart"
    )
    assert not undecided.clear_to_the_end
    assert (
        proof.track.branch_point.entered[0] < undecided.contact.clear / 2 < proof.contact.clear / 2
    )
    claims = checker.check(undecided.certificate())
    assert claims["node"] == {"flat": [FLAT], "clear": False}
    # Nor where the last tube is not clear up to the arc.
    monkeypatch.setattr(
        contacts, "on_branch_point_tube", lambda *given: pytest.fail("not looked at")
    )

    def sooner(pairs, coefficients, radius, low, high, planar=False):
        return vague(pairs, coefficients, radius, low, 0.0 if not planar else high, planar)

    monkeypatch.setattr(contacts, "_clear", sooner)
    track, contact = first_contact(find_branch(SHEET, SIGNS))
    assert contact.before_the_arc
    assert contact.clear == track.links[-1].left[0] * track.framework.unit
    claims = checker.check(certificate_with_contact(track, contact))
    assert claims["node"] == {"flat": [FLAT], "clear": False}


@pytest.mark.slow
def test_a_node_that_is_not_found_is_not_claimed(motion, monkeypatch):
    monkeypatch.setattr(chain, "passage_ahead", lambda labels, links, early=False: None)
    proof = prove(motion)
    assert proof.status is UNDECIDED
    assert proof.reason.startswith(
        "the lengths of edges between vertices 2, 3, 4, 5 and 6 come to "
    )
    assert proof.reason.endswith(
        "; floats see a branch point at the time 0.500686, which is not proved"
    )
    assert proof.branch_point is None
    assert proof.may_succeed_otherwise
    monkeypatch.setattr(proving, "_FARTHER", -1 / 2)
    assert prove(motion).reason == "the proof met no branch point where floats see one"


def shown(proof):
    text = StringIO()
    Console(file=text, width=400).print(motion_report(proof.motion, (), proof))
    return text.getvalue()


def test_what_is_said_of_a_node(proof, monkeypatch):
    told = f"{proof.end_text}; no two faces touch before it, nor at it"
    assert f"one curve without a gap, 4 tubes, {told}" in shown(proof)
    monkeypatch.setattr(known, "prove", lambda motion: proof)
    assert told in known.proof_of(proof.motion).said
    # Where faces may touch before it, it is not said that they do not.
    passed = replace(proof, passed=True)
    assert "no two faces touch before 0.50068592, then some may" in shown(passed)
    monkeypatch.setattr(known, "prove", lambda motion: passed)
    assert "touch" not in known.proof_of(proof.motion).said
    for one in (proof, passed):
        jsonschema.validate({**one.motion.to_dict(), "proof": one.to_dict()}, schema("motion"))


@pytest.mark.slow
def test_a_node_with_two_flat_vertices_after_a_contact():
    motion = follow(find_branch(random_square(5, seed=0), "++++-"), until="return", frames=3)
    assert motion.end == "node"
    proof = prove(motion)
    assert proof.status is PROVED
    assert proof.branch_point.vertices == (5, 7)
    assert proof.passed
    assert proof.end_text.endswith("where the vertices 5 and 7 are flat and other curves may cross")
    assert proof.contact.event.time[1] < float(proof.length[0])
    assert proof.to_dict()["node"]["clear"] is False
    assert_holds_the_node(
        proof.branch_point.tube.patch, proof.track.frame(float_bounds(proof.length[1])[0]).ball
    )


HARDLY = "+++++-++++-+", "++-+++-++++-"
"""Rays of `random_square(12, seed=7000)`: on the way to a branch point, no fold at its flat
vertices is steeper than 0.001 radians. On the second one it is far from where it seems to be."""


@pytest.mark.parametrize("signs", HARDLY)
def test_a_node_at_which_four_nearly_equal_curves_meet(signs, monkeypatch, tmp_path):
    """Floats do not follow any of them to the branch point."""
    branch = find_branch(random_square(12, seed=7000), signs)
    source = Ray(tuple(branch.vertex_signs.values()), 1)
    loop = LoopFinder(Problem.of(branch.pattern)).follow_from(branch, source)
    assert loop.loop.status is PROVED
    (passage,) = (step for step in loop.steps if isinstance(step, Passage))
    assert passage.vertices == (5, 7)
    before = loop.steps[: loop.steps.index(passage)]
    link = before[-1]
    point, along = sharpened(link.tube, link.exit).floats[0], link.tube.velocity(link.exit)
    assert crossing_ahead(link.tube.framework, point, along.floats[0]) is None
    with monkeypatch.context() as none:
        none.setattr(passages, "_passage_nearby", lambda *_: None)
        assert passages.passage_ahead(range(16), before) is None
    assert_holds_the_node(passage.tube.patch, passage.tube.branch_point)
    four = LocatedBranchPoint.of(passage.tube.framework, passage.visit(Fraction(1)))
    assert four.has_all_lines
    (tmp_path / "loop").write_text(loop.lines().text)
    assert checker.verify(tmp_path / "loop")["loops"] == 1


@pytest.mark.survey
def test_all_branches_of_a_square_that_end_at_a_node():
    sheet, found = random_square(8, seed=1), []
    for signs in product("+-", repeat=8):
        motion = follow(find_branch(sheet, "".join(signs)), frames=2)
        if motion.end == "node":
            proof = prove(motion)
            assert proof.status is PROVED, proof.reason
            assert checker.check(proof.certificate())["node"]["clear"] is True
            found.append(proof.branch_point.vertices)
    assert len(found) == 26
    assert set(found) == {(9,), (11,)}
