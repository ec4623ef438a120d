"""`prove`: what is proved of a motion that was followed in floats, and its certificate."""

from fractions import Fraction

import pytest

from exactfold import checker, find_branch, follow, random_square
from exactfold.motion import prove
from exactfold.verdict import PROVED

SHEET = random_square(3, seed=1)


@pytest.fixture(scope="module")
def branch():
    return find_branch(SHEET, "+-+")


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


def test_a_motion_through_the_paper_is_proved_without_a_claim_on_contact(branch):
    first = follow(branch).duration
    proof = prove(follow(branch, until=1.05 * first, frames=3))
    assert proof.status is PROVED
    assert proof.passed
    assert proof.contact.event.time[1] < 1.05 * first < proof.length[1]
    assert "contact" not in checker.check(proof.certificate())


def test_a_motion_back_to_the_flat_sheet_names_where_it_ends(branch):
    proof = prove(follow(branch, until="return", through_nodes=True, frames=3))
    assert proof.status is PROVED
    assert proof.loop.source.sign_text == "+-+"
    assert proof.to_dict()["to"] == proof.loop.target.to_dict()
    assert proof.certificate() is None
