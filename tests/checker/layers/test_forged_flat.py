"""Forged certificates of flat-folded states, each of which one line of the checker alone stops."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from typing import Any

import pytest
from flat_files import roofs, strip
from forge import Document, beyond, given, refused, stopped, verified, with_one_key_more, without

from exactfold.checker import CertificateError
from exactfold.checker.layers import folding, orders, overlaps, places, refutation
from exactfold.checker.layers.folding import FoldedSheet
from exactfold.checker.layers.overlaps import Overlaps
from exactfold.checker.sheets.panels import read_panels
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import PanelPattern

FORMAT = "exactfold flat-folded states"


def document(kind: str, sheet: PanelPattern, claims: Document, **evidence: Any) -> Document:
    head = {"format": FORMAT, "version": 1, "kind": kind, "pattern": panels_document(sheet)}
    return {**head, "claims": claims, "evidence": evidence}


def digits(bits: Sequence[int]) -> str:
    text = "".join(map(str, bits))
    text += "0" * (-len(text) % 4)
    return "".join(f"{int(text[k : k + 4], 2):x}" for k in range(0, len(text), 4))


def state(
    sheet: PanelPattern, letters: str, bits: Sequence[int], pieces: Any = None, said: str = ""
) -> Document:
    """A state by the bits of its pairs; the pieces are the panels if none are given."""
    polygons = [list(face) for face in sheet.faces] if pieces is None else pieces
    claims = {"letters": letters, "assignment": said, "pieces": len(polygons), "pairs": len(bits)}
    return document("flat-state", sheet, claims, pieces=polygons, order=digits(bits))


def told(sheet: PanelPattern, letters: str, bits: Sequence[int], pieces: Any = None) -> Document:
    """A state with the letters that its orders have."""
    forged = state(sheet, letters, bits, pieces)
    try:
        verified(forged)
    except CertificateError as error:
        message = str(error)
        if message.startswith("claim assignment"):
            forged["claims"]["assignment"] = message.rpartition("'")[0].rpartition("'")[2]
    return forged


def accepted_without(
    message: str, sheet: PanelPattern, letters: str, pieces: Any = None
) -> Document:
    """The first state that is accepted if the line with this message is taken out."""
    with without(message):
        read, _ = read_panels(panels_document(sheet))
        polygons = read.panels if pieces is None else [tuple(piece) for piece in pieces]
        folded = FoldedSheet(read, dict(zip(read.folds, letters, strict=True)), polygons)
        pairs = len(Overlaps(folded).pairs)
        for bits in product((0, 1), repeat=pairs):
            forged = told(sheet, letters, bits, pieces)
            try:
                verified(forged)
            except CertificateError:
                continue
            return forged
    raise AssertionError("every state is stopped by another line, too")


def refutation_of(sheet: PanelPattern, letters: str, **evidence: Any) -> Document:
    claims = {"letters": letters, "reason": "layers", "vertex": None}
    pieces = [list(face) for face in sheet.faces]
    return document(
        "flat-refuted",
        sheet,
        claims,
        **{"pieces": pieces, "places": [], "clauses": [], "steps": [], **evidence},
    )


def count_of(
    sheet: PanelPattern, letters: str, states: int, *components: Document, **evidence: Any
) -> Document:
    ways = [len(component["states"]) for component in components]
    claims = {"letters": letters, "states": states, "components": ways}
    given = {
        "pieces": [list(face) for face in sheet.faces],
        "places": [],
        "clauses": [],
        "steps": [],
    }
    return document(
        "flat-count", sheet, claims, **{**given, **evidence}, components=list(components)
    )


ZIGZAG = strip(1, 3, 1)  # two folds that know nothing of each other


def test_the_certificates_verify() -> None:
    assert verified(given("flat-count-map"))["states"] == 56
    assert verified(given("flat-count-twist"))["components"] == [2, 2]
    assert verified(given("flat-count-bird-base"))["states"] == 1
    assert verified(given("flat-count-strip"))["states"] == 8
    assert verified(given("flat-count-roofs"))["states"] == 4
    assert verified(given("flat-state-yoshimura"))["pairs"] == 51
    reasons = {"twist": ("layers", None), "kawasaki": ("kawasaki", 9), "maekawa": ("maekawa", 9)}
    for name, (reason, vertex) in reasons.items():
        claims = verified(given(f"flat-refuted-{name}"))
        assert (claims["reason"], claims["vertex"]) == (reason, vertex)


@pytest.mark.parametrize(
    ("name", "place", "names"),
    [
        ("state-yoshimura", "claims", "letters assignment pieces pairs"),
        ("state-yoshimura", "evidence", "pieces order"),
        ("refuted-twist", "claims", "letters reason vertex"),
        ("refuted-twist", "evidence", "pieces places clauses steps"),
        ("refuted-maekawa", "evidence", ""),
        ("count-map", "claims", "letters states components"),
        ("count-map", "evidence", "pieces places clauses steps components"),
    ],
)
def test_keys(name: str, place: str, names: str) -> None:
    forged = with_one_key_more(given(f"flat-{name}"), (place,))
    refused(forged, f"{place}: expected an object with the keys {names}")


def test_keys_of_a_component() -> None:
    forged = with_one_key_more(given("flat-count-map"), ("evidence", "components", 0))
    refused(forged, "a component: expected an object with the keys pairs states steps")


# --- the folding map -----------------------------------------------------------------------------


def test_letters_that_are_none() -> None:
    message = "the letters are not one of M, V, U, F for each fold"
    stopped(accepted_without(message, strip(1, 1), "B"), message)
    for letters in ("", "UU", None, ["U"]):
        refused(state(strip(1, 1), letters, [1], said="V"), message)  # type: ignore[arg-type]


def test_folds_that_do_not_close() -> None:
    skew = PanelPattern(
        [(0, 0), (4, 0), (1, 4), (-3, 2), (-1, -4)],
        [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (2, 3), (3, 4), (1, 4)],
    )
    message = "the folds do not close at vertex 0"
    stopped(accepted_without(message, skew, "UUUU"), message)


def test_an_odd_number_of_folds_does_not_close() -> None:
    """Nor where the sum of the angles is right, as with one fold on a line of two others."""
    ring = [(1, 4), (2, 4), (2, 5), (5, 6), (3, 6), (3, 7), (1, 7)]
    points = [(0, 0), (1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (-1, -1), (1, -1)]
    sheet = PanelPattern(points, [*ring, (0, 1), (0, 2), (0, 3)])
    refused(state(sheet, "UUU", [1, 1, 1], said="VVV"), "the folds do not close at vertex 0")


def test_pieces_that_are_no_polygons() -> None:
    for piece in ([0, 1], [0, 2, 3, 0], [0, 2, 99], [0, 2, 6]):
        forged = state(strip(1, 1), "U", [1], [[0, 2, 3, 1], piece], "V")
        refused(forged, "piece 1 is not a polygon")


def test_pieces_that_are_not_convex() -> None:
    message = "piece 0 is not convex, or not counter-clockwise"
    stopped(accepted_without(message, roofs(), "UU"), message)
    refused(state(strip(1, 1), "U", [1], [[0, 1, 3, 2], [2, 4, 5, 3]], "V"), message)
    flat = PanelPattern(
        [(0, 0), (1, 0), (2, 0), (2, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4)]
    )
    refused(state(flat, "", [], [[0, 1, 2], [0, 2, 3, 4]]), message)


def test_a_piece_that_is_listed_twice() -> None:
    message = "two pieces lie on one side of an edge"
    twice = [[0, 2, 3, 1], [2, 4, 5, 3], [0, 2, 3, 1]]
    stopped(accepted_without(message, strip(1, 1), "U", twice), message)


def test_a_piece_that_is_left_out() -> None:
    message = "the pieces do not have the boundary of the sheet"
    stopped(state(strip(1, 1), "F", [], [[0, 2, 3, 1]], "F"), message)


def test_a_piece_across_a_fold() -> None:
    forged = count_of(strip(1, 1), "U", 1, pieces=[[0, 2, 4, 5, 3, 1]])
    stopped(forged, "fold 2-3 is not a side of two pieces")


# --- crossings -----------------------------------------------------------------------------------


def test_another_letter() -> None:
    forged = state(strip(1, 1), "M", [1], said="V")
    verified({**forged, "claims": {**forged["claims"], "letters": "V"}})
    stopped(forged, "fold 2-3 does not have its letter M")


def test_a_circle() -> None:
    """Stamps 0, 1, 2 with 0 below 1, 1 below 2, and 2 below 0."""
    stopped(
        told(strip(1, 1, 1), "UU", [1, 0, 1]), "pieces 0, 1 and 2 lie in a circle"
    ) if False else None
    message = "pieces 0, 1 and 2 lie in a circle"
    with without(message):
        forged = told(strip(1, 1, 1), "UU", [1, 0, 1])
    stopped(forged, message)


def test_a_piece_between() -> None:
    """Stamp 2 goes through the fold of stamps 0 and 1, between them."""
    message = "piece 2 crosses fold 2-3"
    with without(message):
        forged = told(strip(2, 1, 3), "UU", [1, 1, 0])
    stopped(forged, message)


def test_folds_that_interleave() -> None:
    message = "fold 2-3 and fold 6-7 cross"
    with without(message):  # 0 < 2 < 1 < 3
        forged = told(strip(1, 1, 1, 1), "UUU", [1, 1, 1, 0, 1, 1])
    stopped(forged, message)


def test_flat_folds_that_cross() -> None:
    message = "fold 2-3 and fold 6-7 cross"
    with without(message):  # the pairs 0, 3 and 1, 2
        forged = told(strip(1, 1, 1, 1), "FUF", [0, 1])
    stopped(forged, message)


def test_a_flat_fold_between_two_pieces() -> None:
    """The flat fold of 0 and 1 lies along the fold of 2 and 3; piece 1 is between them."""
    sheet = strip(1, 1, 1, 1)
    message = "piece 1 crosses fold 6-7"
    with without(message):  # pairs 1 2, 1 3, 2 3
        forged = told(sheet, "FUU", [0, 1, 1])
    stopped(forged, message)


# --- one state -----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["assignment", "pieces", "pairs"])
def test_other_claims_of_a_state(name: str) -> None:
    forged = given("flat-state-yoshimura")
    fact, wrong = forged["claims"][name], "M" * 17 if name == "assignment" else 99
    forged["claims"][name] = wrong
    stopped(forged, f"claim {name} = {wrong!r}, but it is {fact!r}")


@pytest.mark.parametrize("text", ["", "80", "x", "8 ", "A", "-8"])
def test_bits_that_are_none(text: str) -> None:
    forged = state(strip(1, 1), "U", [1], said="V")
    forged["evidence"]["order"] = text
    refused(forged, "the order does not have 1 bit in hexadecimal digits")


def test_more_bits_than_pairs() -> None:
    forged = state(strip(1, 1), "U", [1], said="V")
    forged["evidence"]["order"] = "9"
    stopped(forged, "the order has more bits than pairs")


# --- no state ------------------------------------------------------------------------------------


def test_a_vertex_beside_layers() -> None:
    forged = given("flat-refuted-twist")
    forged["claims"]["vertex"] = 4
    stopped(forged, "a reason about layers names a vertex")


def test_another_reason() -> None:
    forged = given("flat-refuted-maekawa")
    forged["claims"]["reason"] = "big-little-big"
    stopped(forged, 'the reason \'big-little-big\' is not "kawasaki", "maekawa" or "layers"')


def test_a_vertex_on_the_boundary() -> None:
    forged = given("flat-refuted-kawasaki")
    forged["claims"]["vertex"] = 0
    refused(forged, "vertex 0 is not inside the sheet")


def test_a_vertex_that_folds_flat() -> None:
    forged = given("flat-refuted-maekawa")
    forged["claims"] |= {"reason": "kawasaki"}
    stopped(forged, "the folds close at vertex 9")
    forged = given("flat-refuted-maekawa")
    forged["claims"]["letters"] = given("flat-count-map")["claims"]["letters"]
    stopped(forged, "a fold at vertex 9 has no letter")
    forged["claims"]["letters"] = "VMMMMMMMMM"
    stopped(forged, "the letters at vertex 9 fulfil Maekawa's condition")
    forged["claims"]["letters"] = "F" * 10
    stopped(forged, "the letters at vertex 9 fulfil Maekawa's condition")


# --- clauses -------------------------------------------------------------------------------------

POINT = ["1/2", "1/2"]


def test_clauses_that_do_not_hold() -> None:
    steps = [[[], [0]]]
    forged = refutation_of(strip(1, 1), "V", places=[POINT], clauses=[[0, [[1, 0]]]], steps=steps)
    stopped(forged, "1 below 0 does not hold at place 0")
    forged["evidence"]["clauses"] = [[1, [[1, 0]]]]
    refused(forged, "there is no place 1")


def test_a_piece_that_is_not_there() -> None:
    """Stamp 2 does not reach the fold of stamps 0 and 1; it may lie between them."""
    forged = count_of(
        strip(2, 3, 2),
        "VV",
        1,
        places=[[2, 3, "1/2"]],
        clauses=[[0, [[2, 0], [1, 2]]]],
        steps=[[[[2, 0]], [0]]],
    )
    stopped(forged, "piece 2 does not lie at place 0")


@pytest.mark.parametrize("place", [["0", "1/2"], ["1/2", "0"], ["1", "0"], [2, 3, "0"]])
def test_a_piece_with_a_place_on_its_border(place: list[Any]) -> None:
    """A crease may run along a side of a piece; any other place lies inside."""
    forged = refutation_of(strip(1, 1), "V", places=[place], clauses=[[0, [[0, 1]]]])
    refused(forged, "piece 0 does not lie at place 0")


def test_the_end_of_a_side() -> None:
    """A corner at which the border is straight."""
    flat = PanelPattern(
        [(0, 0), (1, 0), (2, 0), (2, 1), (0, 1), (2, -1), (1, -1), (0, -1)],
        [(0, 1), (1, 2), (2, 3), (3, 4), (0, 4), (2, 5), (5, 6), (6, 7), (0, 7)],
    )
    forged = refutation_of(flat, "UU", places=[[0, 2, "1/2"]], clauses=[[0, [[0, 1]]]])
    refused(forged, "place 0 is the end of a side of piece 0")


def test_orders_of_no_two_pieces() -> None:
    for a, b in ((0, 0), (0, 2), (2, 0)):
        forged = refutation_of(strip(1, 1), "V", places=[POINT], clauses=[[0, [[a, b]]]])
        refused(forged, f"[{a}, {b}] is not an order of two pieces")


# --- steps ---------------------------------------------------------------------------------------


def test_steps_that_do_not_follow() -> None:
    stopped(refutation_of(strip(1, 1), "V", steps=[[[], []]]), "the empty clause does not follow")
    refused(refutation_of(strip(1, 1), "V", steps=[[[[1, 0]], []]]), "1 below 0 does not follow")
    refused(refutation_of(strip(1, 1), "V", steps=[[[], [0]]]), "there is no clause 0")


def test_steps_without_an_end() -> None:
    stopped(refutation_of(strip(1, 1), "V"), "the steps do not lead to a contradiction")
    forged = given("flat-refuted-twist")
    del forged["evidence"]["steps"][-1]
    refused(forged, "the steps do not lead to a contradiction")


PAIRS = [[0, 1], [1, 2]]


def test_a_state_that_is_not_listed() -> None:
    """Of four states three are listed; a clause with two open orders is used as if it had one."""
    whole = {
        "pairs": PAIRS,
        "states": ["0", "4", "8", "c"],
        "steps": [[[[0, 1]], [0, 1]], [[], [2, 3]]],
    }
    verified(count_of(ZIGZAG, "UU", 4, whole))
    forged = count_of(
        ZIGZAG, "UU", 3, {"pairs": PAIRS, "states": ["0", "4", "8"], "steps": [[[], [2, 0, 1]]]}
    )
    stopped(forged, "clause 2 leaves 2 orders open")


# --- the number of states ------------------------------------------------------------------------


def either(pair: list[int]) -> Document:
    return {"pairs": [pair], "states": ["0", "8"], "steps": [[[], [1]]]}


def test_a_component_twice() -> None:
    verified(count_of(ZIGZAG, "UU", 4, *map(either, PAIRS)))
    forged = count_of(ZIGZAG, "UU", 8, *map(either, [*PAIRS, PAIRS[0]]))
    stopped(forged, "the pair 0, 1 is not open, or no pair")
    forged = count_of(ZIGZAG, "VU", 4, *map(either, PAIRS))
    refused(forged, "the pair 0, 1 is not open, or no pair")
    forged = count_of(ZIGZAG, "UU", 8, *map(either, [*PAIRS, [0, 2]]))
    refused(forged, "the pair 0, 2 is not open, or no pair")


def test_a_state_twice() -> None:
    twice = {"pairs": [[0, 1]], "states": ["0", "8", "8"], "steps": [[[], [1]]]}
    stopped(count_of(strip(1, 1), "U", 3, twice), "a state is listed twice")


def test_a_component_left_out() -> None:
    message = "the order of the pieces (1, 2) is open"
    stopped(count_of(ZIGZAG, "UU", 2, either([0, 1])), message)


def test_choices_that_do_not_go_together() -> None:
    """The four choices for stamps 0, 1, 2 on top of each other have two circles."""
    three = [either(pair) for pair in ([0, 1], [0, 2], [1, 2])]
    refused(count_of(strip(1, 1, 1), "UU", 8, *three), "pieces 0, 1 and 2 lie in a circle")


@pytest.mark.parametrize("name", ["states", "components"])
def test_other_numbers(name: str) -> None:
    forged = given("flat-count-twist")
    fact, wrong = forged["claims"][name], [4] if name == "components" else 5
    forged["claims"][name] = wrong
    stopped(forged, f"claim {name} = {wrong!r}, but it is {fact!r}")


# --- limits --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("module", "limit", "what", "found"),
    [
        (folding, "IMAGE_BITS", "the bits of an image", 1),
        (overlaps, "FLAT_SIDES", "the sides of points beside lines", 40),
        (overlaps, "FLAT_PAIRS", "the pairs of pieces that overlap", 15),
        (orders, "FLAT_TESTS", "the tests of orders of layers", 1),
    ],
)
def test_limits(
    monkeypatch: pytest.MonkeyPatch, module: Any, limit: str, what: str, found: int
) -> None:
    made_here = given("flat-count-strip")
    verified(made_here)
    monkeypatch.setattr(module, limit, 0)
    with pytest.raises(Exception, match=what) as caught:
        verified(made_here)
    refused(made_here, str(caught.value))
    assert f", are more than the limit, 0 ({limit} in checker/core/limits.py)" in str(caught.value)


def test_the_limit_of_folds_along_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four stamps; two folds that come to lie along each other have seven parts each."""
    lines = [(0, 7), range(8), (0, 7), range(8), (0, 7)]
    points = [(x, y) for x, ys in enumerate(lines) for y in ys]
    number = {point: k for k, point in enumerate(points)}
    edges = [(number[x, y], number[x + 1, y]) for x in range(4) for y in (0, 7)]
    edges += [(k, k + 1) for k, (x, _) in enumerate(points[:-1]) if points[k + 1][0] == x]
    sheet = PanelPattern(points, edges)
    stack = state(sheet, "U" * 15, [1] * 6, said="V" * 7 + "M" + "V" * 7)
    verified(stack)
    monkeypatch.setattr(overlaps, "FLAT_PAIRS", 6)
    refused(stack, beyond("the pairs of folds along each other", 7, 6, "FLAT_PAIRS"))


def test_the_limit_of_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(refutation, "FLAT_STEPS", 1)
    found = given("flat-refuted-twist")
    refused(found, beyond("the orders in steps", 2, 1, "FLAT_STEPS"))


def test_the_limit_of_layers(monkeypatch: pytest.MonkeyPatch) -> None:
    clause = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]
    five = refutation_of(strip(1, 1, 1, 1, 1), "UUUU", places=[POINT], clauses=[[0, clause]])
    refused(five, beyond("the layers at the place of a clause", 5, 4, "FLAT_LAYERS"))
    monkeypatch.setattr(places, "FLAT_LAYERS", 5)
    refused(five, "the steps do not lead to a contradiction")
