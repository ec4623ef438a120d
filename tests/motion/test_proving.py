"""`prove`: what is proved of a motion that was followed in floats, and its certificate."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from exactfold import checker, random_square
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches import find_branch
from exactfold.motion import follow, persistence, prove
from exactfold.motion.proving import MotionProof

SHEET = random_square(3, seed=1)


@pytest.fixture(scope="module")
def branch():
    return find_branch(SHEET, "+-+")


@pytest.mark.slow
def test_a_motion_to_its_first_contact_is_proved_with_the_contact(branch):
    motion = follow(branch)
    proof = prove(motion)
    assert proof.status is PROVED
    low, high = proof.contact.event.time
    assert low <= motion.duration <= high
    assert high - low < 1e-4 * high
    claims = checker.check(proof.certificate())
    assert claims["contact"]["kind"] in ("contact", "flat-fold")
    assert claims["vertex_signs"] == [1, -1, 1]


def test_a_motion_to_an_angle_is_proved_and_clear_all_the_way(branch):
    motion = follow(branch, until="60deg", frames=3)
    proof = prove(motion)
    assert proof.status is PROVED
    assert proof.contact.event is None
    assert proof.contact.clear >= Fraction(motion.duration) * Fraction(999, 1000)
    assert proof.length[0] >= Fraction(motion.duration) * Fraction(999, 1000)
    claims = checker.check(proof.certificate())
    assert "contact" not in claims
    assert Fraction(claims["clear"]) >= Fraction(motion.duration) * Fraction(99, 100)


@pytest.mark.slow
def test_a_motion_through_the_paper_is_proved_without_a_claim_on_contact(branch):
    first = follow(branch).duration
    proof = prove(follow(branch, until=1.05 * first, frames=3))
    assert proof.status is PROVED
    assert proof.passed
    assert proof.contact.event.time[1] < 1.05 * first < proof.length[1]
    assert "contact" not in checker.check(proof.certificate())


@pytest.mark.slow
def test_a_motion_back_to_the_flat_sheet_names_where_it_ends(branch):
    proof = prove(follow(branch, until="return", through_branch_points=True, frames=3))
    assert proof.status is PROVED
    assert proof.loop.source.sign_text == "+-+"
    assert proof.to_dict()["to"] == proof.loop.target.to_dict()
    assert len(proof.certificate()) == 3  # a file of loops: its header, this loop, the claims


# --- where tubes fail ----------------------------------------------------------------------------


def holding_another(branch, held=None, **how):
    """The motion with the first triangle held, or another one."""
    held = branch.pattern.triangles[0] if held is None else held
    return follow(branch, pinned=held, **how)


@pytest.mark.parametrize("bits", [64, 128])
def test_any_triangle_can_be_held_with_any_bits(branch, bits, tmp_path):
    motion = holding_another(branch, until="40deg", frames=3)
    assert set(motion.pinned) == set(SHEET.triangles[0]) != set(follow(branch).pinned)
    proof = prove(motion, bits=bits)
    assert proof.status is PROVED
    document = proof.certificate()
    assert document["evidence"]["bits"] == bits
    assert tuple(document["evidence"]["pinned"]) == motion.pinned
    assert checker.check(document)["vertex_signs"] == [1, -1, 1]
    assert np.abs(proof.motion.coords[:, list(motion.pinned), 2]).max() == 0


@pytest.mark.slow
def test_a_loop_with_another_triangle_held_is_written_with_it(branch, tmp_path):
    back = holding_another(branch, until="return", through_branch_points=True, frames=3)
    proof = prove(back, bits=128)
    assert proof.status is PROVED
    assert proof.write(tmp_path / "loop.txt")
    assert checker.verify(tmp_path / "loop.txt")["loops"] == 1
    header = (tmp_path / "loop.txt").read_text().splitlines()[0]
    assert '"bits":128' in header
    assert f'"pinned":{list(back.pinned)}'.replace(" ", "") in header


def failing(until_attempt):
    """`prove`, whose first attempts prove nothing; and the list of those that were made."""
    made = []

    def attempt(motion, *, bits=64, progress=None):
        made.append((bits, motion.pinned))
        if len(made) < until_attempt:
            return MotionProof(UNDECIDED, "no tube", motion, (Fraction(0), Fraction(len(made))), 0)
        return prove(motion, bits=bits)

    return attempt, made


@pytest.mark.parametrize("succeeds", [1, 2, 3, 4])
def test_more_bits_and_another_triangle_are_tried(branch, succeeds, monkeypatch):
    motion = follow(branch, until="20deg", frames=2)
    attempt, made = failing(succeeds)
    monkeypatch.setattr(persistence, "prove", attempt)
    proof = persistence.prove_persistently(
        motion, lambda held: follow(branch, until="20deg", frames=2, pinned=held)
    )
    assert [bits for bits, _ in made] == [64, 128, 128][:succeeds]
    assert {pinned for _, pinned in made[:2]} == {motion.pinned}
    if succeeds == 4:
        other = made[2][1]
        assert len(set(other) & set(motion.pinned)) < 3
        assert proof.status is UNDECIDED
        faces = " and ".join("-".join(map(str, face)) for face in (motion.pinned, other))
        assert proof.reason == (
            f"no tube (tried: steps down to 1e-7, 64 and 128 bits, face {faces} held)"
        )
    else:
        assert proof.status is PROVED
        assert proof.motion.pinned == made[-1][1]


def test_nothing_more_is_tried_at_a_singular_place(branch, monkeypatch):
    motion = replace(follow(branch, until="20deg", frames=2), end="singular")
    attempt, made = failing(2)
    monkeypatch.setattr(persistence, "prove", attempt)
    proof = persistence.prove_persistently(motion, lambda held: motion)
    assert (proof.status, proof.reason, len(made)) == (UNDECIDED, "no tube", 1)


@pytest.mark.slow
def test_a_motion_through_a_node_is_proved_with_its_first_contact():
    branch = find_branch(random_square(8, seed=1), "------++")
    motion = follow(branch, until="contact", through_branch_points=True, frames=2)
    assert motion.end == "flat-fold"
    proof = prove(motion)
    assert (proof.status, proof.reason, proof.branch_point) == (PROVED, "", None)
    assert proof.through_text == (
        "through a branch point at the time 1.72875, where vertex 9 is flat and another curve "
        "crosses"
    )
    low, high = proof.contact.event.time
    assert 1.73 < low <= motion.duration <= high < low * (1 + 1e-5)
    claims = checker.check(proof.certificate())
    assert claims["vertex_signs"] == [-1] * 6 + [1, 1]
    assert (claims["through"], claims["contact"]["kind"]) == ([[9]], "flat-fold")
    # At the mirror image of the branch point, after the same time, the mirror image of the motion.
    image = prove(follow(branch, side=-1, through_branch_points=True, frames=2))
    assert image.status is PROVED
    assert image.through[0].tube.branch_point.misses(proof.through[0].tube.branch_point)
    assert not image.through[0].tube.branch_point.misses(
        proof.through[0].tube.branch_point.mirrored
    )
    assert image.contact.event.folds == proof.contact.event.folds
