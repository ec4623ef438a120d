"""Forged certificates of pieces: for each refusing line, a false proof that it alone stops."""

from __future__ import annotations

import json
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
from forge import Document, beyond, given, refused, stopped, verified, with_one_key_more, without
from sheets import HEXAGON, scrambled, wheel, with_point

from exactfold import CreasePattern, checker, random_square
from exactfold.branches import components_certificate, find_connected_components
from exactfold.branches.connected_components.cubes import components
from exactfold.certificates.entries import pattern_document
from exactfold.checker.branches import connected_components as pieces
from exactfold.checker.branches import flat_stars as pieces_flat
from exactfold.checker.branches.ranks import have_no_common_zero
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.sheet import read_sheet
from exactfold.errors import NotApplicableError

ANTIPRISM = CreasePattern(
    [
        *((-6, -5), (0, -9), (6, -6), (6, 6), (-6, 6)),
        *((0, -3), (3, 0), (0, 3), (-3, 1), (0, "1/3"), (0, -5)),
    ],
    [
        *((2, 6, 5), (2, 3, 6), (3, 7, 6), (3, 4, 7), (4, 8, 7), (4, 0, 8), (0, 5, 8)),
        *((5, 6, 9), (6, 7, 9), (7, 8, 9), (8, 5, 9)),
        *((0, 1, 10), (1, 2, 10), (2, 5, 10), (5, 0, 10)),
    ],
)
"""With the star of vertex 10 flat a square antiprism with a centre is left, in a square."""
INNER = wheel([(0, 0), (4, 0), (4, 4), (0, 4)], (1, 2))
SHEETS = {
    "pentagon": scrambled(0, HEXAGON[:5], 2, loose=True),
    "complex": scrambled(2, HEXAGON[:5], 4, loose=True),
    "family": scrambled(2, HEXAGON, 2, loose=True),
    "roots": scrambled(0, HEXAGON, 3, loose=True),
    "chord": CreasePattern([*INNER.vertices, (7, 2)], [*INNER.triangles, (1, 5, 2)]),
    "antiprism": ANTIPRISM,
    "triangle": with_point(scrambled(1, HEXAGON[:5], 3, loose=True), 2, (1, 1, 1)),
}


def piece(name: str) -> Document:
    """A fresh copy of a certificate."""
    return given(f"pieces-{name}")


def needed(document: Document, line: str, message: str) -> None:
    """Accepted without a line that evidence has to pass, and refused with it."""
    with without(line):
        verified(document)
    refused(document, message)


def sealed(document: Document, joints: list[str], low: int, high: int) -> Document:
    """With other claims."""
    document["claims"] |= {"joints": joints, "at_least": low, "at_most": high}
    return document


def proof(document: Document, vertex: int) -> Document:
    """The evidence by which all joints at a vertex are shown."""
    found: Document = next(e for e in document["evidence"]["flat"] if vertex in e["complete"])
    return found


def with_parts(document: Document, parts: list[Any]) -> Document:
    """The same parts in all sets of flat stars that have any."""
    for entry in document["evidence"]["flat"]:
        if entry["parts"]:
            entry["parts"] = json.loads(json.dumps(parts))
    return document


# --- what is said --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("pentagon", "4 graphs in 2 pieces, with 1 joint shown"),
        ("complex", "16 graphs in 6 pieces, with 6 joints shown"),
        ("family", "4 graphs in 2 pieces, with 1 joint shown"),
        ("roots", "8 graphs in 2 pieces, with 1 joint shown"),
        pytest.param(
            "antiprism", "64 graphs in 12 pieces, with 40 joints shown", marks=pytest.mark.slow
        ),
        ("chord", "2 graphs in 1 piece, joined by the fold 1-2 from boundary to boundary"),
        ("triangle", "8 graphs in 4 pieces, with 2 joints shown"),
    ],
)
def test_what_is_said(name: str, text: str) -> None:
    document = piece(name)
    claims = verified(document)
    digest = read_sheet(document["pattern"])[1]
    assert checker.summary(claims) == f"VALID: the solutions are {text}; sha256 {digest}"


@pytest.mark.parametrize(
    "name",
    [
        "pentagon",
        "family",
        "chord",
        *(pytest.param(x, marks=pytest.mark.slow) for x in ("complex", "roots", "triangle")),
    ],
)
def test_certificates_are_written_alike(name: str) -> None:
    found = find_connected_components(SHEETS[name])
    assert components_certificate(SHEETS[name], found)["claims"] == piece(name)["claims"]


def test_a_pattern_by_name() -> None:
    document = components_certificate("waterbomb", find_connected_components("waterbomb"))
    assert verified(document)["at_least"] == 2


def test_bounds_are_said_as_such() -> None:
    claims = {"vertices": [5, 6], "at_least": 1, "at_most": 3, "joints": [], "sha256": "0"}
    said = "VALID: the solutions are 4 graphs in 1 to 3 pieces, with 0 joints shown; sha256 0"
    assert pieces.summary(claims) == said


def test_no_certificate_without_vertices_or_of_too_many() -> None:
    fan = CreasePattern(HEXAGON[:5], [(0, 1, 2), (0, 2, 3), (0, 3, 4)])
    with pytest.raises(NotApplicableError, match="1 to 16 vertices that can pop; this sheet has 0"):
        components_certificate(fan, find_connected_components(fan))


def test_keys() -> None:
    for place, what, names in (
        (("claims",), "claims", "vertices at_least at_most joints complete"),
        (("evidence",), "evidence", "emptied chord flat"),
        (("evidence", "flat", 0), "a set of flat stars", "held complete parts"),
    ):
        message = f"{what}: expected an object with the keys {names}"
        refused(with_one_key_more(piece("pentagon"), place), message)


# --- the sheet, and what is claimed --------------------------------------------------------------


def foreign(pattern: CreasePattern) -> Document:
    """The claim that nothing is known of the pieces of another sheet."""
    count = len(pattern.interior)
    return {
        **piece("pentagon"),
        "pattern": pattern_document(pattern),
        "claims": {
            "vertices": list(pattern.interior),
            "at_least": 1,
            "at_most": 1 << count,
            "joints": [],
            "complete": [],
        },
        "evidence": {"emptied": [], "chord": None, "flat": []},
    }


def test_five_corners_or_more() -> None:
    message = "there are fewer than five boundary vertices"
    stopped(foreign(random_square(2, seed=1)), message)


def test_the_border_is_convex() -> None:
    rim = [(4, -4), ("1/10", 0), (4, 4), (-4, 4), (-4, -4)]
    stopped(foreign(wheel(rim, (0, 0))), "the boundary is not convex")


def test_how_many_vertices_can_pop(monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(pieces, "MOST_VERTICES", 1)
        message = beyond("the vertices that can pop", 2, 1, "PIECE_VERTICES")
        stopped(foreign(SHEETS["pentagon"]), message)
    fan = foreign(CreasePattern(HEXAGON[:5], [(0, 1, 2), (0, 2, 3), (0, 3, 4)]))
    fan["evidence"]["chord"] = [0, 2]
    stopped(fan, "no vertex can pop")


def test_the_vertices_that_can_pop() -> None:
    document = piece("pentagon")
    document["claims"]["vertices"] = [5]
    stopped(document, "the vertices that can pop are [5, 6]")


def test_a_fold_from_border_to_border_is_shown() -> None:
    document = sealed(piece("pentagon"), [], 1, 1)
    document["claims"]["complete"] = []
    document["evidence"]["chord"] = [0, 5]
    stopped(document, "0-5 is not a fold from boundary to boundary")


def test_a_fold_from_border_to_border_is_not_kept_quiet() -> None:
    document = sealed(piece("chord"), [], 2, 2)
    document["claims"]["complete"] = [4]
    document["evidence"] |= {"chord": None, "flat": [{"held": [4], "complete": [4], "parts": []}]}
    stopped(document, "a fold goes from boundary to boundary, and no chord is named")


def test_joints_bounds_and_complete_vertices() -> None:
    document = piece("pentagon")
    document["claims"]["joints"] = ["0-", "-0"]
    stopped(document, "the joint '-0' is not shown, or another one joins more")
    stopped(sealed(piece("pentagon"), ["0-"], 3, 3), "the evidence shows 2 to 2 pieces")
    stopped(sealed(piece("pentagon"), ["0-"], 2, 3), "the evidence shows 2 to 2 pieces")
    document = piece("pentagon")
    document["claims"]["complete"] = [5]
    stopped(document, "the evidence is complete at the vertices [5, 6]")
    turned = piece("pentagon")
    turned["claims"]["joints"] = ["0+"]
    verified(turned)


def test_the_joints_are_all_that_are_shown() -> None:
    stopped(sealed(piece("pentagon"), [], 2, 2), "the joint ['0+'] is not listed")
    document = piece("triangle")
    document["claims"]["joints"].remove("-0-")
    stopped(document, "the joint ['+0+'] is not listed")


@pytest.mark.parametrize("again", ["0-", "0+"])
def test_a_joint_is_listed_once_up_to_reflection(again: str) -> None:
    document = sealed(piece("pentagon"), ["0-", again], 2, 2)
    stopped(document, f"the joint {again!r} is listed twice, or with its reflection")


def test_a_joint_that_joins_less_than_another_is_not_listed() -> None:
    """With vertex 6 flat alone a solution has these signs, but 00- and 00+ join more."""
    document = piece("roots")
    document["claims"]["joints"].append("0+-")
    stopped(document, "the joint '0+-' is not shown, or another one joins more")


def test_numbers_are_not_truth_values() -> None:
    """Python takes True for 1."""
    document = piece("chord")
    document["claims"]["at_least"] = True
    refused(document, "the evidence shows 1 to 1 pieces")
    document["claims"] |= {"at_least": 1, "at_most": True}
    refused(document, "the evidence shows 1 to 1 pieces")
    document = piece("chord")
    document["evidence"]["chord"] = [True, 2]
    refused(document, "a vertex is not a natural number")


# --- stars held flat -----------------------------------------------------------------------------


def test_a_star_that_is_held_flat() -> None:
    for held in ([], [0]):
        document = piece("pentagon")
        document["evidence"]["flat"].append({"held": held, "complete": [], "parts": []})
        refused(document, f"{held}, held flat, are not one or more vertices that can pop")
    document["evidence"]["flat"][-1]["held"] = []
    stopped(document, "[], held flat, are not one or more vertices that can pop")


def test_a_vertex_is_complete_by_what_can_bend_without_it_alone() -> None:
    """Vertex 6 is never flat, and that is no reason why vertex 5 is not."""
    document = sealed(piece("pentagon"), [], 4, 4)
    document["evidence"]["flat"] = [{"held": [6], "complete": [5, 6], "parts": []}]
    stopped(document, "other folds may bend with vertex 5 flat")


# --- zeros in boxes ------------------------------------------------------------------------------

OPEN = "not all solutions with vertex 10 flat are shown"


def boxes(change: Callable[[Document], object] = lambda part: None) -> Document:
    """What is shown with vertex 10 flat: a part of six unknowns, with its boxes changed."""
    document = piece("antiprism")
    entry = proof(document, 10)
    change(entry["parts"][0])
    document["evidence"]["flat"] = [entry]
    document["claims"]["complete"] = [10]
    joints = [text for text in document["claims"]["joints"] if text.endswith("0")]
    return sealed(document, joints, 1, 32)


@pytest.mark.slow
def test_boxes_are_what_shows_that_there_is_nothing_else() -> None:
    """Splitting leaves forms of inertia (1, 2) over a field with a root."""
    verified(boxes())
    document = boxes()
    document["evidence"]["flat"][0]["parts"] = []
    stopped(sealed(document, [], 2, 64), OPEN)


@pytest.mark.slow
def test_all_zeros_are_there() -> None:
    needed(boxes(lambda part: part["roots"].pop()), "31 zeros, not 2^5", OPEN)


@pytest.mark.slow
def test_no_zero_is_counted_twice() -> None:
    def change(part: Document) -> None:
        part["roots"][0] = part["roots"][1]

    needed(boxes(change), "two boxes meet", OPEN)


@pytest.mark.slow
def test_a_real_zero_is_not_passed_for_another() -> None:
    def change(part: Document) -> None:
        root = part["roots"][0]
        root["center"] += ["0"] * len(root["center"])

    needed(boxes(change), "a box may hold a real zero", OPEN)


@pytest.mark.parametrize("change", ["center", "radius"])
def test_a_box_holds_a_zero(change: str) -> None:
    def changed(part: Document) -> None:
        root = part["roots"][0]
        if change == "radius":
            root["radius"] = str(1 << root["bits"] + 20)
        else:
            root["center"][0] = str(int(root["center"][0]) + (1 << root["bits"]))

    refused(boxes(changed), OPEN)


class Squares:
    """x^2 = value as a part whose signs do not matter."""

    def __init__(self, value: int) -> None:
        self.quadric = {(0, 0): 1, (1, 1): -value}

    def system(self, _: Any) -> pieces_flat.System:
        return pieces_flat.System(1, [self.quadric])

    def signs(self, box: Any, _: Any) -> dict[int, int]:
        return {4: 1 if box.center[0] > 0 else -1}


def root(*center: int) -> Document:
    return {"bits": 10, "radius": "64", "center": [str(x) for x in center]}


def test_zeros_that_are_not_real() -> None:
    """Of x^2 = 4 and x^2 = -4, in boxes of two and of four unknowns."""
    two: Any = Squares(4)
    assert pieces_flat._all_zeros(two, [], [root(2048), root(-2048)]) == [{4: 1}, {4: -1}]
    none: Any = Squares(-4)
    assert pieces_flat._all_zeros(none, [], [root(0, 2048), root(0, -2048)]) == []
    for pair, message in (
        ([root(0, 2048)] * 2, "two boxes meet"),
        ([root(0, 2048), root(0, -1024)], "Krawczyk's test fails for the box about"),
        ([root(0, 2048), root(64, -2176)], "Krawczyk's test fails for the box about"),
    ):
        with pytest.raises(CertificateError, match=message):
            pieces_flat._all_zeros(none, [], pair)
    with pytest.raises(CertificateError, match="a box may hold a real zero"):
        pieces_flat._all_zeros(two, [], [root(2048, 0), root(-2048, 0)])


def test_as_many_forms_as_the_chart_needs() -> None:
    """One form in three unknowns has more zeros than two boxes."""
    document = piece("family")
    (entry,) = (e for e in document["evidence"]["flat"] if e["complete"] and e["parts"])
    (part,) = entry["parts"]
    forged = {"folds": part["folds"], "chart": ["1", "1"], "roots": [root(1, 1)]}
    with_parts(document, [forged])
    refused(document, f"not all solutions with vertex {entry['complete'][0]} flat are shown")
    with without("the forms are not one less than the unknowns"):
        refused(document, "malformed: ValueError while checking")


@pytest.mark.slow
def test_limits_and_open_signs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pieces_flat, "MOST_UNKNOWNS", 5)
    needed(boxes(), "a part has more than 5 unknowns", OPEN)
    found = find_connected_components(ANTIPRISM)
    with pytest.raises(NotApplicableError, match="refuses the proof: not all solutions"):
        components_certificate(ANTIPRISM, found)
    monkeypatch.undo()
    monkeypatch.setattr(pieces_flat, "signs_of", lambda *_: None)
    refused(boxes(), OPEN)


def test_the_coordinates_are_independent() -> None:
    def change(part: Document) -> None:
        part["folds"][0] = part["folds"][1]

    refused(boxes(change), OPEN)


# --- points of families, and what has no zero ----------------------------------------------------


def test_points_are_zeros() -> None:
    document = piece("family")
    for entry in document["evidence"]["flat"]:
        for part in entry["parts"]:
            for point in part["points"]:
                point["fixed"][0] = "1"
    refused(document, "not all solutions with vertex 7 flat are shown")
    document = piece("family")
    entry = next(e for e in document["evidence"]["flat"] if e["complete"] and e["parts"])
    entry["parts"][0]["points"][0]["more"] = 1
    refused(document, "not all solutions with vertex 7 flat are shown")


def test_forms_without_a_common_zero() -> None:
    one = [[Fraction(int(i == j == 0)) for j in range(2)] for i in range(2)]
    two = [[Fraction(int(i == j == 1)) for j in range(2)] for i in range(2)]
    product = [[Fraction(int(i != j)) for j in range(2)] for i in range(2)]
    assert have_no_common_zero([one, two])
    assert not have_no_common_zero([one])
    assert not have_no_common_zero([one, product])
    assert not have_no_common_zero([one, one])


def test_components_are_those_of_the_package() -> None:
    for cubes in ([], [(0b01, 0b01)], [(1, 1), (2, 0)], [(1, 0), (1, 1)], [(7, 5), (3, 1), (4, 4)]):
        assert pieces.components(3, set(cubes)) == components(3, cubes)[0]
