"""Forged listings: claims, boxes, charts and triangulated triangles that are not what they say."""

from __future__ import annotations

from itertools import permutations
from typing import Any

import pytest
from forge import (
    given,
    refused,
    sealed,
    stopped_by,
    verified,
)

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.sheet import Sheet

TWO, ONE, EITHER = "listing-two-vertices", "listing-one-vertex", "listing-reflex-either-side"
FEW = ["rigid-nested", "single-vertex-waterbomb", "listing-triangles", "algebraic-flat-vertex"]


# --- claims --------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", FEW)
def test_every_claim_is_compared(name: str) -> None:
    """By value and by type."""
    for key, fact in given(name)["claims"].items():
        if key == "branches":
            continue
        others: list[Any] = [None, [fact]]
        if type(fact) is int:
            others += [fact + 1, fact - 1, -fact - 1, str(fact)]
            others += [bool(fact)] if fact in (0, 1) else []
        else:
            others += [fact + " ", fact[:-1], "undecided" if fact == "proved" else "proved"]
        for other in others:
            forged = given(name)
            forged["claims"][key] = other
            refused(forged, f"claim {key} = {other!a}, but it is {fact!a}")


def test_keys_of_claims_and_evidence_are_these() -> None:
    claims = "interior boundary folds degrees_of_freedom sha256 distinct with_multiplicity real "
    claims += "nonreal true_branches branches"
    for name, keys in (
        ("listing-cross", "kind triangles chart roots"),
        ("rigid-nested", "kind triangles"),
        ("single-vertex-waterbomb", "kind triangles"),
        (
            "algebraic-flat-vertex",
            "kind triangles chart multipliers separating classes roots",
        ),
    ):
        for part, wanted in (("claims", claims), ("evidence", keys)):
            forged = given(name)
            forged[part]["more"] = 1
            refused(forged, f"{part}: expected an object with the keys {wanted}")
    forged = given(TWO)
    forged["claims"] = []
    refused(forged, f"claims: expected an object with the keys {claims}")
    for evidence in ([], None, "isolated", 1):
        forged = given(TWO)
        forged["evidence"] = evidence
        refused(forged, "the evidence is not an object")
    for what, key in (("vertices", "vertices triangles"), ("triangles", "vertices triangles")):
        forged = given(TWO)
        del forged["pattern"][what]
        refused(forged, f"pattern: expected an object with the keys {key}")
    for value in (None, "", {}, 1):
        forged = given(TWO)
        forged["claims"]["branches"] = value
        refused(forged, "branches is not a list")


@pytest.mark.parametrize("kind", ["chambers", "", None, 1, ["isolated"], {}])
def test_other_kinds_are_unknown(kind: Any) -> None:
    forged = given(TWO)
    forged["evidence"]["kind"] = kind
    refused(forged, f"unknown kind of evidence {kind!a}")


def test_values_that_nothing_else_refuses_are_malformed() -> None:
    forged = given(TWO)
    forged["evidence"]["triangles"] = [{"corners": [], "inside": [], "multipliers": []}]
    refused(forged, "corners does not have 3 entries")
    forged = given(TWO)
    del forged["evidence"]["roots"][0]["bits"]
    refused(forged, "root: expected an object with the keys bits radius center")
    forged = given("algebraic-flat-vertex")
    forged["evidence"]["classes"][0]["flat"] = [[]]
    refused(forged, "malformed: TypeError while checking")
    forged["evidence"]["classes"][0] = {**forged["evidence"]["classes"][0], "flat": ["\ud800"]}
    refused(forged, "a flat vertex is not an interior vertex, or appears twice")


# --- branches ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [*FEW, EITHER, "listing-cross"])
def test_every_letter_and_sign_is_compared(name: str) -> None:
    """In the first branch, the last, and the first that is shown from either side."""
    true = given(name)
    branches = true["claims"]["branches"]
    either = [k for k, b in enumerate(branches) if b["representative"] == "either"]
    for k in sorted({0, len(branches) - 1, *either[:1]}) if branches else ():
        for key, alphabet in (("vertex_signs", "+-0?"), ("assignment", "MVF?")):
            text = branches[k][key]
            for place, letter in enumerate(text):
                for other in alphabet:
                    if other == letter or (letter == "U" and key == "assignment"):
                        continue
                    forged = given(name)
                    changed = text[:place] + other + text[place + 1 :]
                    forged["claims"]["branches"][k][key] = changed
                    with pytest.raises(
                        CertificateError, match=f"branch {k}: .* shows .*, not what is"
                    ):
                        verified(forged)
            for other in (text + text[-1:], text[:-1], "", text + "U"):
                if other == text:
                    continue
                forged = given(name)
                forged["claims"]["branches"][k][key] = other
                with pytest.raises(CertificateError, match=f"branch {k}: .* shows .*, not what is"):
                    verified(forged)


def test_messages_say_what_is_shown() -> None:
    forged = given(ONE)
    forged["claims"]["branches"][0]["assignment"] = "MMMM"
    true = given(ONE)["claims"]["branches"][0]
    shown = f"{true['vertex_signs']} {true['assignment']}"
    refused(forged, f"branch 0: its positive saddle shows {shown}, not what is claimed")
    forged = given(EITHER)
    place = next(
        k for k, b in enumerate(forged["claims"]["branches"]) if b["representative"] == "either"
    )
    forged["claims"]["branches"][place]["assignment"] = "MMMM"
    flip = str.maketrans("+-MV", "-+VM")
    true = given(EITHER)["claims"]["branches"][place]
    one = f"{true['vertex_signs']} {true['assignment']}"
    said = {
        f"branch {place}: either side shows {a} or {b}, not what is claimed"
        for a, b in permutations((one, one.translate(flip)))
    }
    with pytest.raises(CertificateError) as caught:
        verified(forged)
    assert str(caught.value) in said


@pytest.mark.parametrize("name", [ONE, EITHER, "listing-reflex", "algebraic-either-side"])
def test_mirror_images(name: str) -> None:
    """Allowed where both sides may be shown, for signs and letters at once."""
    flip = str.maketrans("+-MV", "-+VM")
    for k, branch in enumerate(given(name)["claims"]["branches"]):
        signs, letters = branch["vertex_signs"], branch["assignment"]
        both = given(name)
        both["claims"]["branches"][k]["vertex_signs"] = signs.translate(flip)
        with pytest.raises(CertificateError, match=f"branch {k}: .* shows "):
            verified(both)
        both["claims"]["branches"][k]["assignment"] = letters.translate(flip)
        if branch["representative"] == "either":
            verified(both)
        else:
            with pytest.raises(CertificateError, match=f"branch {k}: .* shows "):
                verified(both)
        other = {"either": "saddle", "saddle": "either"}[branch["representative"]]
        forged = given(name)
        forged["claims"]["branches"][k]["representative"] = other
        with pytest.raises(CertificateError, match=f"branch {k}: .* shows "):
            verified(forged)


def test_a_letter_may_be_left_open_and_an_open_one_may_not_be_claimed() -> None:
    true = given("listing-triangles")
    for branch in true["claims"]["branches"]:
        branch["assignment"] = "U" * len(branch["assignment"])
    verified(true)
    forged = given("listing-open-folds")
    number, branch = next(
        (k, b) for k, b in enumerate(forged["claims"]["branches"]) if "U" in b["assignment"]
    )
    branch["assignment"] = branch["assignment"].replace("U", "M", 1)
    with pytest.raises(CertificateError, match=f"branch {number}: .* shows "):
        verified(forged)


@pytest.mark.parametrize("name", [TWO, "listing-triangles", "algebraic-bent-off-path"])
def test_multiplicities_are_compared(name: str) -> None:
    for k, branch in enumerate(given(name)["claims"]["branches"]):
        true = branch["multiplicity"]
        others = [true + 1, true - 1, 2 * true, str(true), None]
        for other in [*others, True] if true == 1 else others:
            forged = given(name)
            forged["claims"]["branches"][k]["multiplicity"] = other
            refused(forged, f"branch {k}: multiplicity is {true}")


def test_keys_of_branches_are_these() -> None:
    forged = given(TWO)
    forged["claims"]["branches"][2]["more"] = 1
    keys = "vertex_signs assignment multiplicity representative"
    refused(forged, f"branch 2: expected an object with the keys {keys}")
    forged = given(TWO)
    forged["claims"]["branches"][2]["assignment"] = 1
    forged["claims"]["branches"][2]["vertex_signs"] = "+-"
    with pytest.raises(CertificateError):
        verified(forged)


def test_as_many_branches_as_roots() -> None:
    for change in (lambda b: b.pop(), lambda b: b.append(b[0])):
        forged = given(TWO)
        change(forged["claims"]["branches"])
        count = len(forged["claims"]["branches"])
        refused(forged, f"{count} branches for 4 roots")


def test_signs_that_are_open_on_the_box() -> None:
    """A wide box passes Krawczyk's test, and the plane between up and down cuts it."""
    forged = given(TWO)
    forged["evidence"]["roots"][1]["radius"] = str(5 << 57)
    made = stopped_by(forged, "branch 1: the sign of a vertex is open")
    assert "?" in made["claims"]["branches"][1]["vertex_signs"]


# --- sheets of other kinds -----------------------------------------------------------------------


def test_a_sheet_that_folds_is_not_rigid() -> None:
    forged = given(TWO)
    forged["evidence"] = {"kind": "rigid", "triangles": []}
    forged["claims"]["branches"] = []
    made = stopped_by(forged, "the sheet is not a triangulated triangle")
    assert made["claims"]["distinct"] == 0


def test_a_triangle_that_is_not_emptied_is_not_rigid() -> None:
    for name in ("rigid-triangle", "rigid-nested"):
        forged = given(name)
        forged["evidence"]["triangles"] = []
        stopped_by(forged, "the sheet is not a triangulated triangle")


def test_a_triangle_without_inner_vertices_is_no_sheet_to_count() -> None:
    forged = given("rigid-triangle")
    forged["pattern"] = {
        "vertices": [["0", "0"], ["1", "0"], ["0", "1"]],
        "triangles": [[0, 1, 2]],
    }
    forged["evidence"]["triangles"] = []
    stopped_by(sealed(forged), "the sheet is not a triangulated triangle")


def test_branches_where_none_are_listed() -> None:
    branch = given(TWO)["claims"]["branches"][0]
    forged = given("rigid-triangle")
    forged["claims"]["branches"] = [branch]
    stopped_by(forged, "a rigid sheet has no branches")
    forged = given("single-vertex-waterbomb")
    forged["claims"]["branches"] = [branch]
    stopped_by(forged, "a branch of dimension two or more is not listed")


NO_SINGLE = "the emptied sheet is not the star of a single vertex of degree 5 or more"


@pytest.mark.parametrize(
    ("points", "faces"),
    [
        # a hub of degree 4 with an ear: two planes of sheets, not one cone
        (
            [(0, 0), (4, 0), (4, 4), (0, 4), (6, 2), ("3/2", "7/5")],
            [*((k, (k + 1) % 4, 5) for k in range(4)), (1, 4, 2)],
        ),
        # a hub of degree 3 with two ears: one plane of sheets that counts twice
        (
            [(0, 0), (4, 0), (2, 4), (4, -3), (6, 3), (2, 1)],
            [(0, 1, 5), (1, 2, 5), (2, 0, 5), (0, 3, 1), (1, 4, 2)],
        ),
    ],
)
def test_a_hub_not_joined_to_all_corners(points: list[Any], faces: list[Any]) -> None:
    forged = given("single-vertex-nine-folds")
    forged["pattern"] = {
        "vertices": [[str(x), str(y)] for x, y in points],
        "triangles": [list(face) for face in faces],
    }
    assert stopped_by(sealed(forged), NO_SINGLE)["claims"]["distinct"] == 1


def test_a_vertex_of_degree_four_is_no_cone() -> None:
    forged = given(ONE)
    forged["evidence"] = {"kind": "single vertex", "triangles": []}
    forged["claims"]["branches"] = []
    made = stopped_by(forged, NO_SINGLE)
    assert made["claims"]["distinct"] == 1
    forged = given(TWO)
    forged["evidence"] = {"kind": "single vertex", "triangles": []}
    forged["claims"]["branches"] = []
    refused(forged, NO_SINGLE)


def test_lines_need_four_boundary_vertices_and_an_inner_one() -> None:
    for kind in ("isolated", "algebraic"):
        forged = given("single-vertex-nine-folds")
        forged["evidence"] = {"kind": kind, "triangles": [], "chart": None, "roots": []}
        refused(forged, "the sheet does not have four boundary vertices and an interior vertex")
        forged = given("rigid-triangle")
        forged["evidence"] |= {"kind": kind, "chart": None, "roots": []}
        refused(forged, "the sheet does not have four boundary vertices and an interior vertex")
    forged = given("listing-chord")
    square = [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"]]
    forged["pattern"] = {"vertices": square, "triangles": [[0, 1, 2], [0, 2, 3]]}
    forged["evidence"]["triangles"] = []
    stopped_by(
        sealed(forged), "the sheet does not have four boundary vertices and an interior vertex"
    )


def test_the_form_of_a_flat_vertex_is_lorentzian(monkeypatch: pytest.MonkeyPatch) -> None:
    """It always is; the check stands in case a sheet that is none got so far."""
    true = Sheet.curvature
    monkeypatch.setattr(
        Sheet, "curvature", lambda sheet, v: {ij: -w for ij, w in true(sheet, v).items()}
    )
    refused(
        given("single-vertex-nine-folds"),
        "the curvature form of vertex 9 does not have the inertia (1, 6, 3)",
    )
    refused(
        given("rigid-nested"), "the curvature form of vertex 5 does not have the inertia (1, 0, 3)"
    )
