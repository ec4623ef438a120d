"""Certificates of torques for a branch: what they claim, and forgeries of every line."""

from __future__ import annotations

import json
import re
from functools import cache
from typing import Any

import pytest
from forge import Document, beyond, refused, verified, with_one_key_more, without

from exactfold import checker, random_square
from exactfold.certificates.entries import pattern_document
from exactfold.checker.branches import torques
from exactfold.design import actuate
from exactfold.errors import NotApplicableError
from exactfold.pattern.families import flat_vertex_square, single_vertex, two_vertex


@cache
def _text(name: str) -> str:
    sheets: dict[str, Any] = {
        "two": lambda: actuate(two_vertex(), "+-"),
        "few": lambda: actuate(two_vertex(), "--", creases=2),
        "one": lambda: actuate(single_vertex(4), "-"),
        "square": lambda: actuate(random_square(3, seed=2), "+-+"),
    }
    return json.dumps(sheets[name]().certificate())


def given(name: str) -> Document:
    document: Document = json.loads(_text(name))
    return document


def changed(name: str, **changes: Any) -> Document:
    """A certificate with other claims, or with other evidence."""
    document = given(name)
    for key, value in changes.items():
        place = "evidence" if key in document["evidence"] else "claims"
        document[place][key] = value
    return document


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without that line."""
    with without(message):
        verified(document)
    refused(document, message)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("two", r"on the ray \+- .* ray of the 3 other branches; .* is not self-foldable"),
        ("few", "on at most 2 folds have more than"),
        ("one", "on the ray - .* ray of the 1 other branch; .*; the branch is self-foldable"),
        ("square", "of the 7 other branches"),
    ],
)
def test_what_is_verified(name: str, said: str) -> None:
    claims = verified(given(name))
    assert claims == given(name)["claims"]
    assert re.search(said, checker.summary(claims))
    open_claims = checker.core.kinds.Verified(claims.kind, {**claims, "self_foldable": "undecided"})
    assert "self-foldable" not in checker.summary(open_claims)


def test_keys() -> None:
    names = "sha256 branches vertex_signs assignment self_foldable torques limit creases margin "
    document = with_one_key_more(given("one"), ("claims",))
    refused(document, f"claims: expected an object with the keys {names}bound")
    document = with_one_key_more(given("one"), ("evidence",))
    refused(document, "evidence: expected an object with the keys count branch side rays")


MARGIN = "the power on the ray does not exceed that on every rival by the margin"


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("two", {"sha256": "0" * 64}, "the digest of the pattern is {sha256}"),
        ("two", {"branches": 3}, "there are 4 branches"),
        ("two", {"vertex_signs": "++"}, "the vertex signs of the ray are +-"),
        ("two", {"assignment": "MVVVMVV"}, "the letters on the ray are MVVVMVM"),
        ("two", {"margin": "1"}, MARGIN),
        ("two", {"margin": "0"}, "the margin is not positive"),
        ("two", {"bound": "1/2"}, "the rays and their weights do not prove the bound"),
        ("two", {"limit": "1/2", "bound": "9"}, "a torque is larger than the limit"),
        ("few", {"creases": 1, "bound": "9"}, "2 folds are driven, more than 1"),
        (
            "one",
            {"self_foldable": "refuted"},
            "the ranks do not show that self-foldable is refuted",
        ),
        ("two", {"self_foldable": "proved"}, "the ranks do not show that self-foldable is proved"),
    ],
)
def test_false_claims(name: str, changes: dict[str, Any], message: str) -> None:
    right = given(name)["claims"]["sha256"]
    stopped(changed(name, **changes), message.format(sha256=right))


def test_undecided_letters_and_verdicts_claim_nothing() -> None:
    assert verified(changed("two", self_foldable="undecided", assignment="U" * 7))


def test_the_count_has_all_branches_in_boxes() -> None:
    document = given("two")
    document["evidence"]["count"]["roots"].pop()
    refused(document, "3 roots, not 2^2")
    refused(changed("two", count=[]), "the count is not an object")
    document = given("two")
    document["evidence"]["count"]["kind"] = "rigid"
    refused(document, "the branches are not isolated by boxes")


def test_a_sheet_with_more_corners_is_refused() -> None:
    document = given("one")
    five = single_vertex(5)
    document["pattern"] = pattern_document(five)
    document["claims"]["sha256"] = five.sha256
    refused(document, "the sheet has not four boundary vertices and a vertex that can pop")


def test_the_branch_and_the_side_that_are_driven() -> None:
    refused(changed("two", branch=4), "there is no branch 4")
    for side in (0, True, "1"):
        refused(changed("two", side=side), "a side is neither 1 nor -1")
    turned = -given("two")["evidence"]["side"]
    refused(changed("two", side=turned), "the vertex signs of the ray are -+")


def test_weights_and_rays() -> None:
    document = given("two")
    own = [document["evidence"]["branch"], document["evidence"]["side"], "1"]
    stopped(changed("two", rays=[own], bound="1/1000000"), "a ray is the one that is driven")
    rays = document["evidence"]["rays"]
    stopped(
        changed("two", rays=[*rays, rays[0]], bound="100"),
        "the weights of the rays do not add up to 1",
    )
    other, side, _ = rays[0]
    negative = [[other, side, "2"], [other, side, "-1"]]
    stopped(changed("two", rays=negative, bound="100"), "a weight is negative")
    refused(changed("two", rays=[[4, 1, "1"]]), "there is no branch 4")
    refused(changed("two", rays=[[other, 2, "1"]]), "a side is neither 1 nor -1")


def test_more_rays_than_are_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torques, "MOST_RAYS", 1)
    number = len(given("two")["evidence"]["rays"])
    assert number > 1
    refused(given("two"), beyond("the rays", number, 1, "TORQUE_RAYS"))


def test_what_has_no_certificate() -> None:
    other = actuate(two_vertex(), "--").torques
    with pytest.raises(NotApplicableError, match="only torques that are proved to prefer a branch"):
        actuate(two_vertex(), "+-", torques=other).certificate()
    with pytest.raises(NotApplicableError, match="only branches that are simple zeros in boxes"):
        actuate(flat_vertex_square(), up=()).certificate()
