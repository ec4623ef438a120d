"""Claims of motions as objects: the tables, their types, and a claim that is added."""

from __future__ import annotations

from fractions import Fraction
from typing import get_type_hints

import pytest
from forge import given, refused, verified, without

from exactfold import checker
from exactfold.checker.core.reading import parse_rational, require
from exactfold.checker.motion import certificate as motion
from exactfold.checker.motion.chain import Chain
from exactfold.checker.motion.claims import BranchClaim, Document
from exactfold.checker.motion.panels import certificate as panel_motion

TABLES = {
    "branch": (motion.CLAIMS, motion.VerifiedMotion, {"sha256", "tubes", "pinned"}),
    "panels": (panel_motion.CLAIMS, panel_motion.VerifiedPanelMotion, {"sha256"}),
}


@pytest.mark.parametrize("name", TABLES)
def test_the_type_of_what_is_verified_has_the_keys_of_the_table(name: str) -> None:
    table, verified_type, facts = TABLES[name]
    keys = [key for kind in table for key in kind.names]
    assert len(set(keys)) == len(keys)
    assert facts.isdisjoint(keys)
    assert set(get_type_hints(verified_type)) == {*keys, *facts}


class ConnectedComponents(BranchClaim):
    """The motion has at most so many pieces, and the evidence says why."""

    names = ("pieces",)
    needs = ("why",)

    def check(self, chain: Chain) -> None:
        """Count them."""
        most = parse_rational(self.claims["pieces"])
        require(1 + len(chain.steps) <= most, f"there are more: {self.evidence['why']}")

    @staticmethod
    def said(claims: Document) -> str:
        """How many."""
        return f", in {claims['pieces']} pieces or fewer"


def test_a_class_in_the_table_is_a_claim(monkeypatch: pytest.MonkeyPatch) -> None:
    document = given("motion-convex")
    pieces = 1 + len(document["evidence"]["tubes"])
    document["claims"]["pieces"] = str(pieces)
    unknown = "claims: expected an object with the keys vertex_signs side length"
    refused(document, unknown)
    monkeypatch.setattr(motion, "CLAIMS", (*motion.CLAIMS, ConnectedComponents))
    names = "emptied pinned bits start tubes"
    refused(document, f"evidence: expected an object with the keys {names} why")
    document["evidence"]["why"] = "they were counted"
    claims = verified(document)
    assert claims["pieces"] == str(pieces)
    assert f" or more, in {pieces} pieces or fewer; " in motion.summary(claims.claims)
    document["claims"]["pieces"] = str(pieces - Fraction(1, 2))
    refused(document, "there are more: they were counted")
    del document["claims"]["pieces"]
    refused(document, f"evidence: expected an object with the keys {names}")


OTHERS = "the motion passes other branch points than those claimed"
NONE = "a motion passes branch points and claims none, or the other way round"


@pytest.mark.parametrize(
    ("name", "through", "message"),
    [
        ("motion-through", [], OTHERS),
        ("motion-through", [[5]], OTHERS),
        ("motion-through", [[6], [6]], OTHERS),
        ("motion-through", [[6, 6]], OTHERS),
        ("motion-convex", [], NONE),
        ("motion-node", [], NONE),
    ],
)
def test_other_branch_points_are_refused(name: str, through: list[list[int]], message: str) -> None:
    document = given(name)
    document["claims"]["through"] = through
    refused(document, message)
    with without(message):
        assert verified(document)["through"] == through


def test_branch_points_are_not_passed_in_silence() -> None:
    document = given("motion-through")
    assert document["claims"].pop("through") == [[6]]
    refused(document, NONE)


def test_a_summary_says_along_which_ray_a_motion_comes_back() -> None:
    said = checker.summary(checker.check(given("motion-rim-return")))
    assert ", and back to the flat state along -, side +, with the boundary in the ratio " in said
