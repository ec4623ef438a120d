"""Bounds of the degrees of freedom: against known sheets, and forged."""

from __future__ import annotations

from typing import Any

import pytest
from forge import Document, given, refused, verified, with_one_key_more, without
from panel_sheets import mesh, miura, tiling

from exactfold import checker
from exactfold.checker.letters.panels_freedom import bounds
from exactfold.checker.sheets.panels import read_panels
from exactfold.design.panels.freedom_certificate import freedom_certificate
from exactfold.errors import NotApplicableError
from exactfold.panels.decomposition import decompose
from exactfold.panels.spaces.freedom import most_freedom
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import PanelPattern

SHEETS = {
    "miura": miura(2, 3),
    "tiling": tiling(3, 3),
    "mesh": mesh(2, 1, seed=1),
    "larger mesh": mesh(1, 4, seed=3),
}


@pytest.mark.parametrize("sheet", SHEETS.values(), ids=list(SHEETS))
def test_bounds_hold_for_sheets_whose_motions_are_all_known(sheet: PanelPattern) -> None:
    known = decompose(sheet)
    assert known.true is not None
    claims = verified(freedom_certificate(known))
    assert claims["least"] <= max(known.true) <= claims["most"]
    moving = stars(sheet)
    assert claims["most"] == most_freedom(moving, *first_order(moving)) + len(known.free)


def test_a_sheet_with_folds_that_are_held_has_no_certificate() -> None:
    sheet = miura(2, 2)
    with pytest.raises(NotApplicableError, match="only where no fold is held flat"):
        freedom_certificate(decompose(sheet, flat=[sheet.folds[0]]))


def forged(name: str, **changes: Any) -> Document:
    """A certificate with other evidence."""
    document = given(f"freedom-{name}")
    document["evidence"] |= changes
    return document


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without that line, with the claims it then shows."""
    sheet, _ = read_panels(document["pattern"])
    with without(message):
        document["claims"] = dict(bounds(sheet, document["evidence"]))
        verified(document)
    refused(document, message)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("mesh", "with 40 folds and 9 interior vertices are between 13 and 18; sha256 "),
        ("root", "with 20 folds and 5 interior vertices are between 0 and 6; sha256 "),
    ],
)
def test_what_is_said(name: str, said: str) -> None:
    claims = verified(given(f"freedom-{name}"))
    pattern, digest = read_panels(given(f"freedom-{name}")["pattern"])
    size = {"interior": len(pattern.interior), "folds": len(pattern.folds)}
    assert claims == {"sha256": digest, **size, **given(f"freedom-{name}")["claims"]}
    shown = checker.summary(claims)
    assert shown.startswith("VALID: the degrees of freedom of the sheet of rigid panels ")
    assert said in shown
    assert " are 7; sha256 " in checker.summary(
        checker.core.kinds.Verified(claims.kind, {**claims, "least": 7, "most": 7})
    )


def test_keys() -> None:
    document = with_one_key_more(given("freedom-boxes"), ("claims",))
    refused(document, "claims: expected an object with the keys least most")
    document = with_one_key_more(given("freedom-boxes"), ("evidence",))
    names = "letters motion apart modulus roots"
    refused(document, f"evidence: expected an object with the keys {names}")


@pytest.mark.parametrize(("name", "least", "most"), [("mesh", 13, 18), ("boxes", 7, 18)])
def test_bounds_are_those_shown(name: str, least: int, most: int) -> None:
    for key, value, message in (
        ("least", least + 1, f"the lower bound is {least}"),
        ("most", most - 1, f"the upper bound is {most}"),
        ("least", str(least), f"the lower bound is {least}"),
        ("most", True, f"the upper bound is {most}"),
    ):
        document = given(f"freedom-{name}")
        document["claims"][key] = value
        with without(message):
            verified(document)
        refused(document, message)


def test_letters_fit_the_folds() -> None:
    message = "the letters are not one of M, V, F for each fold"
    letters = given("freedom-mesh")["evidence"]["letters"]
    stopped(forged("mesh", letters="U" + letters[1:]), message)
    for wrong in (letters[1:], letters + "F", list(letters)):
        refused(forged("mesh", letters=wrong), message)


def test_families_truly_fold() -> None:
    letters = given("freedom-boxes")["evidence"]["letters"]
    refused(forged("boxes", motion=[]), "motion does not have 5 entries")
    turned = ("M" if letters[0] == "V" else "V") + letters[1:]
    with pytest.raises(checker.CertificateError, match="does not have the letter asked for"):
        verified(forged("boxes", letters=turned))


def test_chosen_vertices_have_four_folds_and_share_none() -> None:
    stopped(forged("mesh", apart=[6, 7]), "vertex 7 shares a fold with another chosen vertex")
    stopped(forged("mesh", apart=[6, 6]), "vertex 6 shares a fold with another chosen vertex")
    document = forged("root", letters="FFF", motion=[], apart=[4], roots=[])
    document["pattern"] = given("starting-flat")["pattern"]
    stopped(document, "vertex 4 has fewer than four folds")
    refused(forged("mesh", apart=[0]), "malformed: KeyError while checking")


def test_roots_have_the_squares_of_their_radicands() -> None:
    [root] = given("freedom-root")["evidence"]["roots"]
    stopped(forged("root", roots=[root + 1]), f"{root + 1} is no root of 2")
    modulus = given("freedom-root")["evidence"]["modulus"]
    verified(forged("root", roots=[modulus - root]))
    refused(forged("root", roots=[]), "roots does not have 1 entries")


def test_other_moduli_show_no_better_bounds() -> None:
    """The modulus need not be a prime. All residues modulo 1 are 0."""
    document = forged("mesh", modulus=1)
    sheet, _ = read_panels(document["pattern"])
    assert bounds(sheet, document["evidence"])["most"] > 18
    refused(forged("mesh", modulus=0), "malformed: ValueError while checking")
    refused(forged("mesh", modulus=-7), "the modulus is not a natural number")
    verified(forged("mesh", modulus=(2**61 - 1) * (2**89 - 1)))
