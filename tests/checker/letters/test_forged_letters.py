"""Forged certificates of letters: for each refusing line, a false proof that it alone stops."""

from __future__ import annotations

import random
from typing import Any

import pytest
from forge import Document, given, refused, verified, with_one_key_more, without

from exactfold import CreasePattern, checker
from exactfold.branches import find_branch
from exactfold.branches.certificates.single import heights_evidence
from exactfold.checker.branches.branch import Place
from exactfold.checker.letters import letters
from exactfold.checker.letters.refuted import Stars
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.design import match, match_boundary, match_certificate
from exactfold.pattern.families import single_vertex
from exactfold.solve.certify import enclosed

RANDOM, BOWL, REFLEX, RIGID = "letters-random", "letters-bowl", "letters-reflex", "letters-rigid"


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and without that line accepted with the halves that it finds."""
    with without(message):
        claimed(document)
        verified(document)
    refused(document, message)


def claimed(document: Document) -> None:
    """Claim the halves that the evidence seems to show."""
    sheet, _ = read_sheet(document["pattern"])
    evidence = document["evidence"]
    place = Place(sheet, evidence["emptied"])
    place.fix_boundary()
    wanted = dict(zip(sheet.folds, document["claims"]["letters"], strict=True))
    found = letters._LetterSearch(place, wanted).rays(
        evidence["refuted"], evidence["tree"], evidence["leaves"]
    )
    document["claims"]["halves"] = [
        {"vertex_signs": list(signs), "side": side} for signs, side in found
    ]


def none_left(document: Document, refuted: list[Any], tree: list[Any]) -> Document:
    """The claim that no half has the letters."""
    document["claims"]["halves"] = []
    document["evidence"] |= {"refuted": refuted, "tree": tree, "leaves": []}
    return document


def star(vertex: int, heights: dict[int, int], document: Document) -> list[Any]:
    """The heights of a star as a certificate has them."""
    sheet, _ = read_sheet(document["pattern"])
    return [vertex, [str(heights.get(w, 0)) for w in sheet.star(vertex)]]


def lettered(document: Document, vertex: int, letter: str) -> int | None:
    """A neighbour over a fold with this letter, if there is one."""
    sheet, _ = read_sheet(document["pattern"])
    own = dict(zip(sheet.folds, document["claims"]["letters"], strict=True))
    folds = ((min(vertex, w), max(vertex, w)) for w in sheet.star(vertex))
    return next((sum(fold) - vertex for fold in folds if own[fold] == letter), None)


# --- what is read, and what is said --------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (RANDOM, "exactly 2 halves of branches have the 7 letters asked for on 16 folds"),
        (BOWL, "no branch has the 4 letters asked for on 4 folds"),
        (REFLEX, "exactly 8 halves of branches have the 0 letters asked for on 10 folds"),
        (RIGID, "no branch has the 1 letter asked for on 10 folds"),
    ],
)
def test_what_is_said(name: str, text: str) -> None:
    document = given(name)
    claims = verified(document)
    sheet, digest = read_sheet(document["pattern"])
    assert claims == {"sha256": digest, "interior": len(sheet.interior), **document["claims"]}
    assert checker.summary(claims) == f"VALID: {text}; sha256 {digest}"


def test_one_half_and_one_letter() -> None:
    claims = {"letters": "MU", "halves": [{}], "sha256": "0"}
    said = "VALID: exactly 1 half of a branch has the 1 letter asked for on 2 folds; sha256 0"
    assert letters.summary(claims) == said


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (("claims",), "claims: expected an object with the keys letters halves"),
        (
            ("evidence",),
            "evidence: expected an object with the keys emptied refuted tree leaves",
        ),
        (
            ("claims", "halves", 0),
            "half: expected an object with the keys vertex_signs side",
        ),
        (
            ("evidence", "leaves", 0, 1),
            "half of a leaf: expected an object with the keys heights denominator",
        ),
        (
            ("evidence", "refuted", 1),
            "refuted set 1: expected an object with the keys signs heights",
        ),
    ],
)
def test_keys(place: tuple[str | int, ...], message: str) -> None:
    refused(with_one_key_more(given(RANDOM), place), message)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("refuted", None, "refuted is not a list"),
        ("tree", {}, "tree is not a list"),
        ("leaves", "", "leaves is not a list"),
        ("tree", ["leaf"], "a step is not a list"),
        ("tree", [[]], "malformed: ValueError while checking"),
        ("tree", [["split", [4]]], "a number of a step is not a natural number"),
        ("tree", [["refuted", True]], "a number of a step is not a natural number"),
        ("refuted", [{"signs": [[True, 1]], "heights": None}], "a vertex is not a natural number"),
        ("refuted", [{"signs": [[4, True]], "heights": None}], "refuted set 0: True is not a sign"),
        (
            "refuted",
            [{"signs": [[4, 1]], "heights": [[True, []]]}],
            "a vertex is not a natural number",
        ),
        ("tree", [["force", 9, 4]], "malformed: IndexError while checking"),
        ("tree", [["force", 0, 5]], "malformed: KeyError while checking"),
        ("emptied", None, "emptied is not a list"),
    ],
)
def test_values_of_another_kind(key: str, value: Any, message: str) -> None:
    document = given(RANDOM)
    document["evidence"][key] = value
    refused(document, message)


def test_letters_fit_the_folds() -> None:
    document = given(RANDOM)
    for text in ("", document["claims"]["letters"] + "U", list(document["claims"]["letters"])):
        document["claims"]["letters"] = text
        refused(document, "the letters are not one of M, V, F, U for each fold")
    document = given(RIGID)
    assert document["claims"]["letters"] == "UUUUUMUUUU"
    document["claims"]["letters"] = "UVFUUMUUUU"
    verified(document)
    document = given(REFLEX)
    document["claims"]["letters"] = "X" * 10
    stopped(document, "the letters are not one of M, V, F, U for each fold")


# --- the halves that are claimed -----------------------------------------------------------------


def test_halves_are_those_found() -> None:
    first, second = given(RANDOM)["claims"]["halves"]
    other = {**first, "side": -1}
    for halves, message in (
        ([first, first], "a half of a branch is listed twice"),
        ([first, other], "a listed half of a branch does not have these letters"),
        ([first], "a half of a branch with these letters is not listed"),
    ):
        document = given(RANDOM)
        document["claims"]["halves"] = halves
        with without(message):
            verified(document)
        refused(document, message)
    document = given(RANDOM)
    document["claims"]["halves"] = [second, first]
    verified(document)
    document["claims"]["halves"][0]["side"] = True
    refused(document, "True is not an integer")


# --- the tree ------------------------------------------------------------------------------------


def test_a_leaf_has_all_signs() -> None:
    document = given(RANDOM)
    evidence = document["evidence"]
    evidence["tree"] = [*evidence["tree"][:4], ["leaf"]]
    del evidence["leaves"][1]
    stopped(document, "a leaf does not have the signs of all interior vertices")


def test_a_sign_is_forced_by_all_others() -> None:
    document = given(RANDOM)
    tree = document["evidence"]["tree"]
    assert tree[3] == ["force", 3, 7]
    tree[0], tree[3] = tree[3], tree[0]
    stopped(document, "set 3 does not force the sign of vertex 7")


def test_a_refuted_set_is_contained() -> None:
    document = given(RANDOM)
    document["evidence"]["tree"][-2] = ["refuted", 3]
    del document["evidence"]["leaves"][0]
    stopped(document, "the signs of set 3 are not among those of the case")


def test_a_step_has_a_known_kind() -> None:
    document = given(RIGID)
    document["evidence"]["tree"][0][0] = "level"
    stopped(document, "a step of the tree is 'level'")


def test_what_stays_flat_is_rigid_and_has_a_letter() -> None:
    message = "can fold, or no mountain or valley is asked for there"
    document = given(RANDOM)
    other = lettered(document, 4, "M")
    assert other is not None
    i, j = min(4, other), max(4, other)
    stopped(none_left(document, [], [["flat", i, j]]), f"fold {i}-{j} {message}")
    for letter in "UF":
        document = none_left(given(RIGID), [], [["flat", 2, 5]])
        document["claims"]["letters"] = letter * 10
        stopped(document, f"fold 2-5 {message}")


def test_the_tree_covers_all_signs() -> None:
    document = given(RANDOM)
    evidence = document["evidence"]
    del evidence["tree"][-1], evidence["leaves"][-1]
    stopped(document, "the tree does not cover all sign vectors")


def test_there_are_as_many_leaves_as_in_the_tree() -> None:
    document = given(RANDOM)
    leaves = document["evidence"]["leaves"]
    leaves.append(leaves[0])
    stopped(document, "the evidence has more leaves than the tree")
    del leaves[1:]
    refused(document, "a leaf is not a list")
    document["evidence"]["tree"].append(["leaf"])
    document["evidence"]["leaves"] = given(RANDOM)["evidence"]["leaves"]
    refused(document, "malformed: IndexError while checking")


# --- the leaves ----------------------------------------------------------------------------------


def test_the_halves_of_a_leaf_have_its_signs() -> None:
    document = given(RANDOM)
    leaves = document["evidence"]["leaves"]
    leaves[0] = leaves[1]
    stopped(document, "vertex 5 does not have the sign of its leaf, 1")
    document = given(RANDOM)
    document["evidence"]["leaves"][0].reverse()
    refused(document, "vertex 4 does not have the sign of its leaf, 1")


def test_a_letter_that_is_not_known_is_not_taken_for_the_one_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    points = [(4, -4), ("1/10", 0), (4, 4), (-4, 0), (0, "1/1000")]
    pattern = CreasePattern(points, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    monkeypatch.setattr(enclosed, "_LEVELS", (6,))  # too rough for one fold
    rough = find_branch(pattern, "-")
    monkeypatch.undo()
    document = match_certificate(match(pattern, find_branch(pattern, "-").assignment))
    verified(document)
    heights, denominator = heights_evidence(rough, [])
    (leaf,) = document["evidence"]["leaves"]
    leaf[0] = {"heights": heights, "denominator": denominator}
    stopped(document, "a letter of a leaf that is asked for is not known")


def test_letters_are_turned_round_on_the_other_side() -> None:
    """Halves of both sides, each by its own letters and by no others."""
    sheet = given(REFLEX)["pattern"]
    pattern = CreasePattern(
        [tuple(p) for p in sheet["vertices"]], [tuple(t) for t in sheet["triangles"]]
    )
    seen = set()
    for half in match(pattern, {}).matches:
        document = match_certificate(match(pattern, half.assignment))
        claims = verified(document)
        own = {"vertex_signs": list(half.vertex_signs.values()), "side": half.side}
        assert own in claims["halves"]
        seen.add(half.side)
        document["claims"]["letters"] = claims["letters"].translate(str.maketrans("MV", "VM"))
        with pytest.raises(checker.CertificateError):
            verified(document)
    assert seen == {1, -1}


# --- refuted sets --------------------------------------------------------------------------------


def test_signs_are_up_or_down() -> None:
    """A zero would be its own opposite."""
    document = given(RANDOM)
    [entry, *_] = document["evidence"]["refuted"]
    entry["signs"] = [[4, 0]]
    none_left(document, [entry], [["force", 0, 4], ["refuted", 0]])
    stopped(document, "refuted set 0: 0 is not a sign")


CROSS = {
    "vertices": [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"], ["1/2", "1/2"]],
    "triangles": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [0, 4, 3]],
}


@pytest.mark.parametrize(
    ("text", "sign"),
    [("MFMF", 1), ("VFVF", -1), ("MFFF", 1), ("MUMM", 1), ("MVMM", 1), ("VMVV", -1)],
)
def test_a_star_is_a_reason_only_if_it_is_curved(text: str, sign: int) -> None:
    document = given(BOWL) | {"pattern": CROSS}
    document["claims"]["letters"] = text
    bowl = {"signs": [[4, sign]], "heights": None}
    true = {"signs": [[4, -sign]], "heights": [star(4, {0: sign}, document)]}
    none_left(document, [bowl, true], [["force", 0, 4], ["refuted", 1]])
    stopped(document, "refuted set 0: the letters round vertex 4 do not contradict its sign")


def test_a_star_is_the_reason_for_one_sign() -> None:
    for names in ([], [[4, 1], [5, 1]]):
        document = given(RANDOM)
        document["evidence"]["refuted"][0] = {"signs": names, "heights": None}
        refused(document, "malformed: ValueError while checking")


def test_valleys_alone_do_not_pop_down() -> None:
    document = given(BOWL)
    bowl, other = document["evidence"]["refuted"]
    bowl["signs"], other["signs"] = other["signs"], bowl["signs"]
    [[_, heights]] = other["heights"]
    heights[:] = [str(-int(text)) for text in heights]
    document["claims"]["letters"] = "VVVV"
    verified(document)


def test_a_star_without_a_sign_is_in_one_plane() -> None:
    document = given(RANDOM)
    entry = document["evidence"]["refuted"][3]
    assert [v for v, _ in entry["signs"]] == [4, 6, 7, 8]
    (at,) = [k for k, (v, _) in enumerate(entry["heights"]) if v == 5]
    sheet, _ = read_sheet(document["pattern"])
    own = dict(zip(sheet.folds, document["claims"]["letters"], strict=True))
    for k, w in enumerate(sheet.star(5)):
        letter = own[min(5, w), max(5, w)]
        if letter in "MV":
            heights = entry["heights"][at][1]
            heights[k] = str(int(heights[k]) + (1 if letter == "M" else -1))
            break
    else:
        raise AssertionError
    stopped(document, "refuted set 3: the star of 5 has no sign, but is not flat")


def test_forms_are_those_of_the_other_formula() -> None:
    sheet, _ = read_sheet(given(RANDOM)["pattern"])
    stars, rng = Stars(sheet, {}), random.Random(1)
    for v in sheet.interior:
        heights = {w: rng.randint(-9, 9) for w in sheet.star(v)} | {v: 0}
        value = sum(c * heights[i] * heights[j] for (i, j), c in sheet.curvature(v).items())
        assert stars.form(v, heights) == 2 * value


def test_a_star_is_in_its_closed_nappe() -> None:
    """One neighbour alone above or below the others."""
    seen = set()
    for true in given(RANDOM)["evidence"]["refuted"][:3]:
        [[vertex, sign]] = true["signs"]
        document = given(RANDOM)
        other = lettered(document, vertex, "V" if sign < 0 else "M")
        if other is None:
            continue
        false = {"signs": [[vertex, -sign]], "heights": [star(vertex, {other: sign}, document)]}
        none_left(document, [true, false], [["force", 0, vertex], ["refuted", 1]])
        stopped(document, f"refuted set 1: K is negative at vertex {vertex}")
        seen.add(vertex)
    assert seen


def test_a_star_is_on_its_own_side() -> None:
    document = given(RANDOM)
    entry = document["evidence"]["refuted"][0]
    turned = {**entry, "signs": [[4, 1]]}
    none_left(document, [entry, turned], [["force", 0, 4], ["refuted", 1]])
    stopped(document, "refuted set 1: the star of 4 does not have the sign 1")
    for second in ([], [star(4, {}, document)]):
        document["evidence"]["refuted"][1] = {"signs": [[4, 1]], "heights": second}
        stopped(document, "refuted set 1: no fold contradicts its letter")


def test_folds_that_stay_flat_contradict_nothing() -> None:
    document = given(BOWL)
    document["claims"]["letters"] = "FFFF"
    entry = document["evidence"]["refuted"][1]
    none_left(document, [entry], [["split", 4], ["refuted", 0], ["refuted", 0]])
    refused(document, "refuted set 0: no fold contradicts its letter")


def test_sums_are_on_the_side_of_their_letters() -> None:
    sheet, _ = read_sheet(given(RANDOM)["pattern"])
    text = given(RANDOM)["claims"]["letters"]
    seen = set()
    for k, (fold, letter) in enumerate(zip(sheet.folds, text, strict=True)):
        for wrong in {"M": "VU", "V": "MU", "U": ""}[letter]:
            document = given(RANDOM)
            document["claims"]["letters"] = text[:k] + wrong + text[k + 1 :]
            where = [
                number
                for number, entry in enumerate(document["evidence"]["refuted"])
                if sum(
                    int(z)
                    for v, heights in entry["heights"]
                    for w, z in zip(sheet.star(v), heights, strict=True)
                    if {v, w} == set(fold)
                )
            ]
            if len(where) == 1:
                message = f"refuted set {where[0]}: the sum at fold {fold} has the wrong sign"
                stopped(document, message)
                seen.add(letter + wrong)
    assert seen == {"MV", "MU", "VM", "VU"}


def test_a_leaf_is_no_proof_with_five_corners() -> None:
    """Over each rim there is another branch: those over one rim have not the letters of others."""
    pattern = single_vertex(5)
    document = match_certificate(match_boundary(pattern, "MMVVV"))
    assert isinstance(document, dict)
    up, down = (
        dict(zip(("heights", "denominator"), heights_evidence(branch, []), strict=True))
        for branch in (find_branch(pattern, "+"), find_branch(pattern, "-"))
    )
    occurring = "MMVMV"
    assert match_boundary(pattern, occurring).branch is not None
    none_left(document, [], [["split", 5], ["leaf"], ["leaf"]])
    document["claims"]["letters"] = occurring
    document["evidence"]["leaves"] = [[up, down], [down, up]]
    with without("a leaf needs a sheet with four corners"):
        verified(document)
    refused(document, "a leaf needs a sheet with four corners")
