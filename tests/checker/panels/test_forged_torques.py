"""Certificates of torques for rigid panels: what they claim, and forgeries of every line."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from forge import Document, beyond, refused, verified, with_one_key_more, without
from forge_panels import bent
from panel_sheets import grid, miura, tiling

from exactfold import checker
from exactfold.checker.panels import torques, unit_motions
from exactfold.design import Hinges, actuate_panels
from exactfold.errors import NotApplicableError
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.pattern.families import single_vertex
from exactfold.pattern.opening import panels

SLACK = Fraction(1, 10**15)


@cache
def _text(name: str) -> str:
    sheets: dict[str, Any] = {
        "miura": lambda: actuate_panels(decompose(miura(2, 2)), 1),
        "rows": lambda: actuate_panels(decompose(miura(2, 2)), 4),
        "few": lambda: actuate_panels(decompose(miura(2, 1)), 2, creases=3),
        "tiling": lambda: actuate_panels(decompose(tiling(1, 1)), 1),
        "bent": lambda: actuate_panels(decompose(bent()), 1),
        "lengths": lambda: actuate_panels(
            decompose(tiling(1, 1)), 2, hinges=Hinges(Fraction(1), Fraction(1))
        ),
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
        ("miura", "an isolated way .* among which 3 other ways are; .* is not self-foldable"),
        ("rows", "a family of dimension 2 .* among which 3 other ways are; .* is self-foldable"),
        ("few", "on at most 3 folds have more than"),
        ("bent", "an isolated way .* among which 2 other ways are"),
        ("tiling", "no torques of size at most 1 have more than .*; the way is self-foldable"),
        ("lengths", "an isolated way .* among which 1 other way is"),
    ],
)
def test_what_is_verified(name: str, said: str) -> None:
    claims = verified(given(name))
    assert claims == given(name)["claims"]
    assert re.search(said, checker.summary(claims))
    open_claims = checker.core.kinds.Verified(claims.kind, {**claims, "self_foldable": "undecided"})
    assert "self-foldable" not in checker.summary(open_claims)


def test_a_rational_margin_leaves_room_for_the_rounding_of_the_checker() -> None:
    """A single straight fold: the power is 1 on it, and the only rival is the opposite ray."""
    sheet = grid(2, 1, lambda i, j: (Fraction(i), Fraction(j)))
    found = actuate_panels(decompose(sheet), 1)
    assert found.margin == (2, 2)
    claims = verified(json.loads(json.dumps(found.certificate())))
    assert (claims["margin"], claims["bound"]) == (str(2 - SLACK), str(2 + SLACK))


def test_keys() -> None:
    names = "sha256 ways way assignment self_foldable springs torques limit creases margin bound"
    document = with_one_key_more(given("tiling"), ("claims",))
    refused(document, f"claims: expected an object with the keys {names}")
    document = with_one_key_more(given("tiling"), ("evidence",))
    refused(document, "evidence: expected an object with the keys count turned rays")


def test_the_count_is_verified_and_complete() -> None:
    document = given("tiling")
    document["evidence"]["count"]["true"] = {"1": 3}
    refused(document, "claim true = {'1': 3}, but it is {'1': 2}")
    document = given("bent")
    document["evidence"]["count"] |= {"true": None, "rigid": "undecided"}
    for support in document["evidence"]["count"]["supports"]:
        if support["by"] == "loops":
            support["extending"] = None
    stopped(document, "it is not known which ways truly fold")


class Unsaid(tuple[tuple[int, int], ...]):
    """Folds that the author of a certificate does not see."""

    def __bool__(self) -> bool:
        return False


def test_no_way_is_lost_because_folds_are_held_flat() -> None:
    """With one fold held, the sheet has two ways, and rivals of the first are no ways of it."""
    sheet = miura(2, 2)
    held = actuate_panels(decompose(sheet, flat=[(4, 5)]), 1)
    with pytest.raises(NotApplicableError, match="about sheets with no fold held flat"):
        held.certificate()
    hidden = replace(held, decomposition=replace(held.decomposition, held=Unsaid([(4, 5)])))
    document = json.loads(json.dumps(hidden.certificate()))
    stopped(document, "folds are held flat: the ways are not those of the sheet")


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        ("tiling", {"sha256": "0" * 64}, "the digest of the pattern is {sha256}"),
        ("tiling", {"ways": 3}, "there are 2 ways"),
        (
            "tiling",
            {"margin": "2"},
            "the power on the ray does not exceed that on every rival by the margin",
        ),
        ("tiling", {"margin": "0"}, "the margin is not positive"),
        ("tiling", {"bound": "1"}, "the rays and their weights do not prove the bound"),
        ("tiling", {"limit": "1/2"}, "a torque is larger than the limit"),
        ("few", {"creases": 2}, "3 folds are driven, more than 2"),
        ("tiling", {"self_foldable": "refuted"}, "that the way is self-foldable is proved"),
        ("miura", {"self_foldable": "proved"}, "that the way is self-foldable is refuted"),
    ],
)
def test_false_claims(name: str, changes: dict[str, Any], message: str) -> None:
    right = given(name)["claims"]["sha256"]
    document = changed(name, **changes)
    if "creases" in changes or "limit" in changes:
        document["claims"]["bound"] = "100"
    stopped(document, message.format(sha256=right))


def test_undecided_claims_nothing() -> None:
    assert verified(changed("miura", self_foldable="undecided"))["self_foldable"] == "undecided"


def test_springs_are_of_a_kind_that_is_known() -> None:
    stopped(changed("tiling", springs="soft"), "the springs are of no kind that is known")
    refused(
        changed("lengths", springs="equal", bound="100", margin="3"),
        "the power on the ray does not exceed that on every rival by the margin",
    )


def test_the_letters_are_those_of_the_ray() -> None:
    letters = given("tiling")["claims"]["assignment"]
    turned = letters.translate(str.maketrans("MV", "VM"))
    refused(
        changed("tiling", assignment=turned),
        "the power on the ray does not exceed that on every rival by the margin",
    )
    other = letters[:-1] + ("M" if letters[-1] == "V" else "V")
    stopped(changed("tiling", assignment=other), f"the letters on this ray are {letters}")
    for wrong in (letters[:-1], list(letters)):
        refused(changed("tiling", assignment=wrong), "there is not one letter for each fold")


def test_the_way_is_a_way_and_is_named_once() -> None:
    way = given("rows")["claims"]["way"]
    message = "the motions that are driven are not those of a way"
    refused(changed("rows", way=way[:1]), message)
    refused(changed("rows", way=[*way, way[0]]), "the way names a motion twice")
    for name in (["0", "00"], [0, "zz"], [0, ["0"]], [True, "00"]):
        refused(changed("rows", way=[name]), f"{name!a} is no motion that truly folds")


def test_weights_are_a_convex_combination() -> None:
    document = given("tiling")
    document["evidence"]["turned"] = ["-1"]
    refused(document, "a weight is negative")
    document = given("tiling")
    rays = document["evidence"]["rays"]
    rays.append([rays[0][0], "1/100"])
    stopped(changed("tiling", rays=rays, bound="100"), "the weights of the rays do not add up to 1")


def test_rays_are_rivals() -> None:
    own, letters = given("tiling")["claims"]["way"][0], given("tiling")["claims"]["assignment"]
    rays = [[[[own, "1" if letters[0] == "V" else "-1"]], "1"]]
    message = "a ray lies on no other way"
    stopped(changed("tiling", turned=["0"], rays=rays, bound="1/1000000"), message)
    [[other, _]] = given("tiling")["evidence"]["rays"][0][0]
    long = [[[[other, "-5"]], "1"]]
    stopped(changed("tiling", turned=["0"], rays=long, bound="100"), "a ray is longer than 1")
    twice = [[[[other, "3/5"], [other, "3/5"]], "1"]]
    stopped(changed("tiling", turned=["0"], rays=twice, bound="100"), "a ray names a motion twice")


def test_more_rays_or_ways_than_are_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torques, "MOST_RAYS", 1)
    number = len(given("tiling")["evidence"]["rays"])
    assert number > 1
    refused(given("tiling"), beyond("the rays", number, 1, "TORQUE_RAYS"))
    monkeypatch.setattr(unit_motions, "MOST_WAYS", 1)
    refused(given("tiling"), beyond("the ways", 2, 1, "TORQUE_WAYS"))


# --- what has no certificate ---------------------------------------------------------------------


def test_what_has_no_certificate() -> None:
    result = decompose(tiling(1, 1))
    other = actuate_panels(result, 2).torques
    with pytest.raises(NotApplicableError, match="only torques that are proved to prefer a way"):
        actuate_panels(result, 1, torques=other).certificate()
    cone = actuate_panels(decompose(miura(1, 1)), 1)
    with pytest.raises(NotApplicableError, match="only ways that modes span have one"):
        replace(cone, motions=replace(cone.motions, by_structure=False)).certificate()


def test_ways_that_modes_do_not_span_are_not_taken() -> None:
    document = given("tiling")
    cone = certificate_of_panels(decompose(panels(single_vertex(5))))
    document["pattern"] = json.loads(json.dumps(cone["pattern"]))
    document["evidence"]["count"] = json.loads(json.dumps(cone["claims"]))
    refused(document, "the ways are not all spanned by modes")
