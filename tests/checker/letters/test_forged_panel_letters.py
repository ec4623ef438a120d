"""Forged certificates of letters on panels: for each refusing line one that it alone stops."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import pytest
from forge import Document, beyond, given, refused, stopped, verified, with_one_key_more

from exactfold import checker
from exactfold.checker.letters import panels_motion as panel_letters_motion
from exactfold.checker.letters.panels_refuted import SIDES
from exactfold.checker.letters.panels_spaces import Exclusion
from exactfold.checker.sheets.panels import read_panels

NOTHING: dict[str, Any] = {"together": [], "never": []}
LOOP = [["at", 5], ["at", 6], ["at", 9], ["at", 10], ["loop", [10, 9, 5, 6]]]


def sheet(name: str) -> Document:
    """A certificate by the last part of its name, without what it says of the first order."""
    document = given(f"starting-{name}")
    document["claims"] |= NOTHING
    document["evidence"] |= {"flat": [], "densities": []}
    return document


def refuting(name: str, tree: list[Any], letters: str | None = None, **claims: str) -> Document:
    """The claim that a sheet does not start to fold, with these cases."""
    document = sheet(name)
    document["claims"] |= {"starts": "refuted", "truly": "undecided"} | claims
    if letters is not None:
        document["claims"]["letters"] = letters
    sets = document["evidence"].get("refuted", [])
    document["evidence"] = {"refuted": sets, "tree": tree, "flat": [], "densities": []}
    return document


def moving(name: str, motion: Any, letters: str | None = None, truly: str = "proved") -> Document:
    """The claim that a sheet starts to fold, with this motion."""
    document = sheet(name)
    document["claims"] |= {"starts": "proved", "truly": truly}
    if letters is not None:
        document["claims"]["letters"] = letters
    document["evidence"] = {"motion": motion, "flat": [], "densities": []}
    return document


# --- what is read, and what is said --------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("twist", "does not start to fold with the 12 letters asked for on 12 folds, and no true "),
        ("curved", "does not start to fold with the 5 letters asked for on 5 folds, of true motio"),
        ("root", "starts to fold with the 20 letters asked for on 20 folds, and true motions begi"),
        ("order", "starts to fold with the 12 letters asked for on 12 folds, and no true motion b"),
    ],
)
def test_what_is_said(name: str, text: str) -> None:
    document = given(f"starting-{name}")
    claims = verified(document)
    pattern, digest = read_panels(document["pattern"])
    assert claims == {"sha256": digest, "interior": len(pattern.interior), **document["claims"]}
    assert checker.summary(claims).startswith(f"VALID: the sheet of rigid panels {text}")


def test_what_is_said_of_the_first_order_and_of_no_letter() -> None:
    claims = verified(given("starting-part"))
    assert (
        "; to first order 2 are proved to fold together, and 2 never to fold; sha256"
        in checker.summary(claims)
    )
    claims = verified(moving("flat", [None], "UFU"))
    assert checker.summary(claims).startswith("VALID: none of 3 folds is asked to fold; sha256")


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (
            ("claims",),
            "claims: expected an object with the keys letters starts truly together never",
        ),
        (("evidence",), "evidence: expected an object with the keys flat densities refuted tree"),
        (
            ("evidence", "refuted", 0),
            "refuted set 0: expected an object with the keys signs planes heights",
        ),
    ],
)
def test_keys(place: tuple[str | int, ...], message: str) -> None:
    refused(with_one_key_more(given("starting-twist"), place), message)


def test_keys_of_motions() -> None:
    names = "densities bits unit unknowns inverse shift radius"
    for name, keys in (("sides", "sides"), ("regular", names)):
        document = with_one_key_more(sheet(name), ("evidence", "motion", 0))
        refused(document, f"a motion: expected an object with the keys {keys}")


@pytest.mark.parametrize(
    ("tree", "error"),
    [
        ([["refuted", 7]], "malformed: IndexError while checking"),
        ([["at", 0]], "malformed: KeyError while checking"),
        ([["at", [9]]], "a vertex is not a natural number"),
        ([["at", True]], "a vertex is not a natural number"),
        ([["split", True]], "a vertex is not a natural number"),
        ([["curved", True]], "a vertex is not a natural number"),
        ([["flat", True, 4]], "a vertex is not a natural number"),
        ([[]], "malformed: ValueError while checking"),
        (["at"], "a step is not a list"),
        ([["level", 9]], "a step of the tree is 'level'"),
        ([["refuted", -1]], "a set is not a natural number"),
    ],
)
def test_steps_of_another_kind(tree: list[Any], error: str) -> None:
    if "level" in error:
        tree = [["level", 1, 4]]
        stopped(refuting("flat", tree), error)
        return
    refused(refuting("zigzags", tree), error)


# --- the claims ----------------------------------------------------------------------------------


def test_claims_are_known_words() -> None:
    document = sheet("twist")
    document["claims"]["starts"] = "undecided"
    stopped(document, '"starts" is \'undecided\', not "proved" or "refuted"')
    document = sheet("twist")
    document["claims"]["truly"] = "no"
    stopped(document, '"truly" is \'no\', not "proved", "refuted" or "undecided"')


def test_letters_fit_the_folds() -> None:
    message = "the letters are not one of M, V, F, U for each fold"
    document = sheet("flat")
    assert document["claims"]["letters"] == "UMU"
    document["claims"]["letters"] = "XMX"
    stopped(document, message)
    for text in ("UM", "UMUU", ["U", "M", "U"]):
        document["claims"]["letters"] = text
        refused(document, message)


def test_true_motions_are_motions() -> None:
    document = sheet("twist")
    document["claims"]["truly"] = "proved"
    stopped(document, "true motions are claimed, but no motion to second order")


def test_several_vertices_with_more_than_four_folds_say_nothing_of_true_motions() -> None:
    cases = "the cases name several vertices, not all with at most four folds"
    message = f"{cases}: true motions are open"
    document = sheet("several")
    document["claims"]["truly"] = "refuted"
    stopped(document, message)
    document = given("starting-never")
    verified(document)
    document["claims"] |= NOTHING
    document["evidence"] |= {"flat": [], "densities": []}
    refused(document, message)


def test_strict_sums_exclude_true_motions_and_others_do_not() -> None:
    document = sheet("nappes")
    assert verified(document)["truly"] == "refuted"
    document["claims"]["letters"] = "U" + document["claims"]["letters"][1:]
    refused(document, "refuted set 0: the sum at fold 0-1 has the wrong sign")


def test_one_vertex_alone_excludes_true_motions() -> None:
    document = sheet("curved")
    document["claims"]["truly"] = "refuted"
    assert verified(document)["truly"] == "refuted"


def test_a_vertex_cannot_have_letters_that_it_can_have() -> None:
    for letters in ("MUMMU", "UMMUU", "MMVMV"):
        document = refuting("vertex", [["vertex", 0]], letters, truly="refuted")
        stopped(document, "vertex 0 can have its letters")
    for letters in ("MUMMM", "VUVVV"):
        verified(refuting("vertex", [["vertex", 0]], letters, truly="refuted"))
    free = refuting("vertex", [["vertex", 0]], "UUUUU", truly="refuted")
    refused(free, "vertex 0 can have its letters")


# --- cases ---------------------------------------------------------------------------------------


def test_all_cases_end() -> None:
    message = "the tree does not cover all cases"
    stopped(refuting("zigzags", [["split", 9], ["refuted", 0]]), message)
    stopped(refuting("loop", LOOP[:-1]), message)


def test_a_set_is_contained_in_the_signs() -> None:
    stopped(
        refuting("zigzags", [["refuted", 0]]), "the signs of set 0 are not among those of the case"
    )
    document = refuting("zigzags", [["split", 9], ["refuted", 1], ["refuted", 0]])
    refused(document, "the signs of set 1 are not among those of the case")


@pytest.mark.parametrize("letters", ["MMMMV", "MMMMU", "VVVVM"])
def test_a_star_is_curved_if_all_letters_are_one(letters: str) -> None:
    stopped(
        refuting("curved", [["curved", 5]], letters),
        "the letters round vertex 5 do not show that its star is curved",
    )


def test_valleys_alone_are_curved_and_a_straight_crease_is_not() -> None:
    verified(refuting("curved", [["curved", 5]], "VVVVV"))
    stopped(
        refuting("flat", [["curved", 4]], "MUM"),
        "the letters round vertex 4 do not show that its star is curved",
    )


@pytest.mark.parametrize(("letters", "fold"), [("UUU", [1, 4]), ("MUM", [0, 4])])
def test_a_fold_stays_flat_and_has_a_letter(letters: str, fold: list[int]) -> None:
    message = f"fold {fold[0]}-{fold[1]} may fold, or is not asked to fold"
    stopped(refuting("flat", [["flat", *fold]], letters), message)


def test_a_fold_from_border_to_border_may_fold() -> None:
    document = refuting("flat", [["flat", 0, 2]], "M")
    document["pattern"] = {
        "radicands": [],
        "vertices": [[["0"], ["0"]], [["1"], ["0"]], [["1"], ["1"]], [["0"], ["1"]]],
        "edges": [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]],
    }
    stopped(document, "fold 0-2 may fold, or is not asked to fold")


def test_a_loop_does_not_close() -> None:
    stopped(refuting("sides", LOOP), "the loop 10-9-5-6 closes")


def test_a_loop_is_one_of_folds_that_move() -> None:
    for loop, error in (([10, 5, 6], "KeyError"), ([], ""), ([10, 11], "KeyError")):
        message = f"malformed: {error} while checking" if error else "the loop  closes"
        refused(refuting("loop", [*LOOP[:-1], ["loop", loop]]), message)


def test_vertices_with_more_folds_have_no_lines() -> None:
    document = refuting("curved", [["at", 5]], "MMMMV")
    refused(document, "malformed: ValueError while checking")
    refused(moving("curved", [{"sides": "MMMMV"}], "MMMMV"), "malformed: ValueError while checking")


def truly(name: str, loop: list[int], order: int) -> Document:
    """The claim that no true motion begins like the one in a certificate."""
    document = sheet(name)
    document["claims"]["truly"] = "refuted"
    document["evidence"] |= {"refuted": [], "tree": [*LOOP[:-1], ["loop", loop, order]]}
    return document


def test_a_loop_fails_at_an_order() -> None:
    loop = LOOP[-1][1]
    verified(truly("order", loop, 3))
    stopped(truly("sides", loop, 3), "the loop 10-9-5-6 is not proved to fail at order 3")
    stopped(truly("sides", loop, 1), "there is no order 1")
    stopped(truly("order", [10, 9, 10, 9], 3), "the loop 10-9-10-9 turns back")


def test_a_loop_that_fails_at_a_higher_order_says_nothing_of_the_second() -> None:
    document = refuting("order", [*LOOP[:-1], [*LOOP[-1], 3]])
    stopped(document, "a loop that fails at a higher order refutes only true motions")


# --- spaces of motions ---------------------------------------------------------------------------


@pytest.mark.slow
def test_spaces_of_motions_are_excluded_by_sets_of_folds() -> None:
    """Theorem 5; the letters of the second file agree with a straight crease, all else flat."""
    message = "the sets of folds do not exclude all spaces of motions"
    for name, truly in (("spaces", "refuted"), ("spaces-weakly", "undecided")):
        document = sheet(name)
        [[kind, vertices, sets]] = document["evidence"]["tree"]
        assert (kind, document["claims"]["truly"]) == ("spaces", truly)
        verified(refuting(name, [["spaces", vertices, sets]]))
        for few in ([], sets[:1]):
            stopped(refuting(name, [["spaces", vertices, few]]), message)
        stopped(refuting(name, [["spaces", [], sets]]), message)
        free = "U" * len(document["claims"]["letters"])
        stopped(refuting(name, [["spaces", vertices, sets]], free), message)


@pytest.mark.parametrize("letters", ["MVVMMMMMMMVVMVVV", "VVVVVVMMMMVVVVVV"])
def test_no_sets_of_folds_exclude_letters_that_occur(letters: str) -> None:
    pattern = read_panels(sheet("spaces")["pattern"])[0]
    sets = [*((fold,) for fold in pattern.folds), *combinations(pattern.folds, 2)]
    sides = {fold: SIDES[x] for fold, x in zip(pattern.folds, letters, strict=True)}
    near = pattern.live([])
    assert not Exclusion(pattern, near, sides, sets).shown()
    other = sides | {fold: -sides[fold] for fold in pattern.folds[:1]}
    assert Exclusion(pattern, near, other, sets).shown()


def test_motions_that_follow_their_letters_in_part_leave_true_motions_open() -> None:
    document = sheet("spaces-weakly")
    document["claims"]["truly"] = "refuted"
    cases = "the cases name several vertices, not all with at most four folds"
    stopped(document, f"{cases}: true motions are open")


def test_two_steps_about_spaces_leave_true_motions_open() -> None:
    document = sheet("spaces")
    step = document["evidence"]["tree"][0]
    cases = "the cases name several vertices, not all with at most four folds"
    truly = refuting("spaces", [["split", 2], step, step], truly="refuted")
    stopped(truly, f"{cases}: true motions are open")


# --- heights of stars ----------------------------------------------------------------------------


@pytest.mark.parametrize("letters", ["MVMV", "MVUV"])
def test_sums_are_on_the_side_of_no_letter(letters: str) -> None:
    document = sheet("part")
    document["claims"]["letters"] = letters
    stopped(document, "refuted set 0: the sum at fold 2-4 has the wrong sign")


def test_some_fold_contradicts_its_letter() -> None:
    document = sheet("twist")
    document["evidence"]["refuted"][0]["planes"] = []
    stopped(document, "refuted set 0: no fold contradicts its letter")


def test_a_star_with_heights_has_a_sign_and_nappes() -> None:
    document = sheet("zigzags")
    document["evidence"]["refuted"][0]["signs"] = []
    refused(document, "malformed: KeyError while checking")
    document = refuting("flat", [["split", 4], ["refuted", 0], ["refuted", 0]], "MUM")
    entry = {"signs": [[4, 1]], "planes": [], "heights": [[4, [["1"], ["0"]]]]}
    document["evidence"]["refuted"] = [entry]
    refused(document, "malformed: ZeroDivisionError while checking")


def lifted(letters: str, heights: list[int], sign: int) -> Document:
    """One height at a star with five folds, where the other sign is refuted truly or not at all."""
    document = refuting("curved", [["refuted", 0]], letters)
    entry = {"signs": [[5, sign]], "planes": [], "heights": [[5, [[str(z)] for z in heights]]]}
    document["evidence"] |= {"refuted": [entry, entry | {"signs": [[5, -sign]]}]}
    both = [["refuted", 0], ["refuted", 1]]
    document["evidence"]["tree"] = [["split", 5], *(both if sign > 0 else both[::-1])]
    return document


@pytest.mark.parametrize("sign", [1, -1])
def test_a_star_is_on_its_own_side(sign: int) -> None:
    document = lifted("MMMMM" if sign < 0 else "VVVVV", [-sign] * 5, sign)
    stopped(document, f"refuted set 1: the star of 5 does not have the sign {-sign}")


def test_a_star_is_in_a_closed_nappe() -> None:
    document = sheet("zigzags")
    [[_, heights]] = document["evidence"]["refuted"][0]["heights"]
    assert heights == [["0"], ["-10400"], ["0"], ["0"]]
    heights[1:] = [["-20800"], ["0"], ["10400"]]
    stopped(document, "refuted set 0: K is negative at vertex 9")


# --- motions -------------------------------------------------------------------------------------


def test_a_fold_with_a_letter_does_not_stay_flat() -> None:
    stopped(moving("flat", [None]), "fold 1-4 has a letter, but stays flat in every motion")


def test_a_part_with_letters_does_not_rest() -> None:
    stopped(moving("twist", [None]), "the part of vertex 4 has letters, but is given no motion")
    refused(moving("twist", []), "motion does not have 1 entries")


def test_sides_are_those_of_the_letters() -> None:
    document = sheet("sides")
    text = document["claims"]["letters"]
    document["claims"]["letters"] = ("V" if text[0] == "M" else "M") + text[1:]
    stopped(document, "fold 1-5 does not have the letter asked for")


def test_a_vertex_has_a_line_with_its_sides() -> None:
    document = moving("part", [{"sides": "MVVV"}])
    stopped(document, "vertex 4 has no motion with these sides")


def test_sides_fit_round_all_loops() -> None:
    letters = sheet("loop")["claims"]["letters"]
    document = moving("loop", [{"sides": letters}], truly="undecided")
    stopped(document, "the loop 5-9-10-6 does not close")


def test_a_mode_truly_folds() -> None:
    document = moving("order", sheet("order")["evidence"]["motion"])
    stopped(document, "the loop 5-9-10-6 does not close for true motions")


def regular(**changes: Any) -> Document:
    """The motion of a vertex with five folds, changed."""
    document = sheet("regular")
    document["evidence"]["motion"][0] |= changes
    return document


def test_numbers_of_a_motion_are_not_too_long() -> None:
    [motion] = sheet("regular")["evidence"]["motion"]
    message = "the densities have more than 128 bits"
    longer = 129 - motion["bits"]
    densities = [c << longer for c in motion["densities"]]
    stopped(regular(bits=129, densities=densities, radius=motion["radius"] << longer), message)
    inverse = [[x << 1100 for x in row] for row in motion["inverse"]]
    shift = motion["shift"] + 1100
    message = beyond("the bits by which numbers are shifted", shift, 1024, "MOST_SHIFT")
    stopped(regular(shift=shift, inverse=inverse), message)


def test_conditions_are_not_too_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panel_letters_motion, "MOST_CONDITIONS", 2)
    stopped(regular(), beyond("the conditions", 3, 2, "MOST_CONDITIONS"))


def test_a_fold_is_shown_to_go_its_way() -> None:
    document = regular()
    document["claims"]["letters"] = "V" + document["claims"]["letters"][1:]
    stopped(document, "fold 0-5 is not proved to follow its letter")
    [motion] = sheet("regular")["evidence"]["motion"]
    wide = min(map(abs, motion["densities"])) * 17 // 16
    refused(regular(radius=wide), "fold 1-5 is not proved to follow its letter")


def test_there_are_as_many_unknowns_as_conditions() -> None:
    message = "there are 3 conditions and 0 unknowns"
    stopped(regular(unknowns=[], inverse=[]), message)
    refused(regular(unknowns=[1, 1, 4]), "Krawczyk's test fails in row 0")
    refused(regular(unknowns=[1, 2, 99]), "Krawczyk's test fails in row 2")
    refused(
        regular(inverse=[[1, 0], [0, 1], [0, 0]]), "a row of the inverse does not have 3 entries"
    )


def test_krawczyk() -> None:
    [motion] = sheet("regular")["evidence"]["motion"]
    densities = list(motion["densities"])
    densities[0] += 1 << 40
    one_off = regular(densities=densities)
    with pytest.raises(checker.CertificateError) as caught:
        verified(one_off)
    rows = [f"Krawczyk's test fails in row {n}" for n in range(3)]
    assert str(caught.value) in rows
    for radius in (0, motion["radius"] >> 30):
        refused(regular(radius=radius), rows[0])
    inverse = [[0] * 3, *motion["inverse"][1:]]
    stopped(regular(inverse=inverse), rows[0])


# --- to first order ------------------------------------------------------------------------------


def part(**changes: Any) -> Document:
    """A right-angled cross of which one straight crease can fold and one cannot."""
    document = given("starting-part")
    for key, value in changes.items():
        document["claims" if key in NOTHING else "evidence"][key] = value
    return document


def test_folds_that_never_fold_are_shown_to_stay_flat() -> None:
    claims = part()["claims"]
    assert (claims["together"], claims["never"]) == ([[1, 4], [3, 4]], [[0, 4], [2, 4]])
    stopped(part(never=[[0, 4], [1, 4], [2, 4]]), "fold 1-4 is not proved to stay flat")
    stopped(part(flat=[], never=[[0, 4]]), "fold 0-4 is not proved to stay flat")
    flat = [[[4, [["0"], ["1"]]]]]
    document = part(flat=flat, never=[[1, 4], [3, 4]], together=[], densities=[])
    stopped(document, "step 0: the sum at fold 1-4 has the wrong sign")


@pytest.mark.parametrize("letters", ["UFU", "UUU"])
def test_folds_that_are_not_asked_to_fold_are_none_that_never_do(letters: str) -> None:
    document = moving("flat", [None], letters)
    document["claims"]["never"] = [[1, 4]]
    stopped(document, "fold 1-4 is not asked to be a mountain or a valley")


@pytest.mark.parametrize(
    "claims",
    [
        {"together": [[1, 4]]},
        {"together": []},
        {"never": [[2, 4]]},
        {"never": []},
    ],
)
def test_all_folds_are_listed_that_are_shown_to_go_together_or_never(claims: Document) -> None:
    stopped(
        part(**claims), "a fold that is shown to go together with others, or never, is not listed"
    )
    verified(part(**NOTHING))


def test_a_motion_shows_that_folds_go_together() -> None:
    densities = part()["evidence"]["densities"]
    turned = [[i, j, [str(-int(x))]] for i, j, [x] in densities]
    document = part(densities=turned, together=[[1, 4]])
    document["claims"]["letters"] = "MVVU"
    stopped(document, "fold 1-4 goes against its letter")
    [i, j, [x]] = densities[0]
    longer = [[i, j, [str(2 * int(x))]], *densities[1:]]
    stopped(part(densities=longer), "the folds at vertex 4 do not close")
    stopped(part(densities=[], together=[[1, 4]]), "fold 1-4 does not follow its letter")
    stopped(part(together=[[0, 4], [1, 4], [3, 4]]), "fold 0-4 does not follow its letter")
    document = part(together=[[1, 4]])
    document["claims"]["letters"] = "MUVU"
    stopped(document, "fold 1-4 does not follow its letter")


def test_a_fold_that_stays_flat_has_no_density() -> None:
    document = given("starting-flat")
    assert document["claims"]["never"] == [[1, 4]]
    document["claims"]["together"] = [[1, 4]]
    document["evidence"]["densities"] = [[1, 4, ["-1"]]]
    stopped(document, "fold 1-4 has a density, but is flat or in no condition")


def test_folds_are_sorted() -> None:
    refused(part(never=[[2, 4], [0, 4]]), "never are not sorted")
    refused(part(together=[[1, 4], [1, 4]]), "together are not sorted")


def test_numbers_are_not_truth_values() -> None:
    """Python takes True for 1."""
    message = "a vertex is not a natural number"
    refused(part(densities=[[True, 4, ["1"]], [3, 4, ["1"]]]), message)
    refused(part(flat=[[[True, [["1"], ["0"]]]]]), message)
    for key in ("planes", "heights"):
        entry = {"signs": [], "planes": [], "heights": [], key: [[True, [["1"], ["0"]]]]}
        refused(part(refuted=[entry]), message)
    refused(
        part(refuted=[{"signs": [[4, True]], "planes": [], "heights": []}]),
        "True is not an integer",
    )
    refused(part(refuted=[{"signs": [[True, 1]], "planes": [], "heights": []}]), message)
