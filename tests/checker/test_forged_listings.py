"""Forged listings: claims, boxes, charts and triangulated triangles that are not what they say."""

from __future__ import annotations

from fractions import Fraction
from itertools import permutations
from typing import Any

import pytest
from forge import (
    Document,
    completed,
    drop_roots,
    entry_of,
    given,
    refused,
    sealed,
    stopped_by,
    verified,
    without,
)

from exactfold.checker import stress
from exactfold.checker.boxes import Box, check_disjoint, read_box
from exactfold.checker.reading import CertificateError
from exactfold.checker.sheet import Sheet

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
    refused(forged, "corners has not 3 entries")
    forged = given(TWO)
    del forged["evidence"]["roots"][0]["bits"]
    refused(forged, "root: expected an object with the keys bits radius center")
    forged = given("algebraic-flat-vertex")
    forged["evidence"]["classes"][0]["flat"] = [[]]
    refused(forged, "malformed: TypeError while checking")
    forged["evidence"]["classes"][0] = {**forged["evidence"]["classes"][0], "flat": ["\ud800"]}
    refused(forged, "the flat vertices are no inner vertices, or appear twice")


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
                    with pytest.raises(CertificateError, match=f"branch {k}: not .* as shown by "):
                        verified(forged)
            for other in (text + text[-1:], text[:-1], "", text + "U"):
                if other == text:
                    continue
                forged = given(name)
                forged["claims"]["branches"][k][key] = other
                with pytest.raises(CertificateError, match=f"branch {k}: not .* as shown by "):
                    verified(forged)


def test_messages_say_what_is_shown() -> None:
    forged = given(ONE)
    forged["claims"]["branches"][0]["assignment"] = "MMMM"
    true = given(ONE)["claims"]["branches"][0]
    shown = f"{true['vertex_signs']} {true['assignment']}"
    refused(forged, f"branch 0: not {shown} as shown by its positive saddle")
    forged = given(EITHER)
    place = next(
        k for k, b in enumerate(forged["claims"]["branches"]) if b["representative"] == "either"
    )
    forged["claims"]["branches"][place]["assignment"] = "MMMM"
    flip = str.maketrans("+-MV", "-+VM")
    true = given(EITHER)["claims"]["branches"][place]
    one = f"{true['vertex_signs']} {true['assignment']}"
    said = {
        f"branch {place}: not {a} or {b} as shown by either side"
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
        with pytest.raises(CertificateError, match=f"branch {k}: not"):
            verified(both)
        both["claims"]["branches"][k]["assignment"] = letters.translate(flip)
        if branch["representative"] == "either":
            verified(both)
        else:
            with pytest.raises(CertificateError, match=f"branch {k}: not"):
                verified(both)
        other = {"either": "saddle", "saddle": "either"}[branch["representative"]]
        forged = given(name)
        forged["claims"]["branches"][k]["representative"] = other
        with pytest.raises(CertificateError, match=f"branch {k}: not"):
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
    with pytest.raises(CertificateError, match=f"branch {number}: not"):
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
    made = stopped_by(forged, "branch 1: signs are open")
    assert "?" in made["claims"]["branches"][1]["vertex_signs"]


# --- sheets of other kinds -----------------------------------------------------------------------


def test_a_sheet_that_folds_is_not_rigid() -> None:
    forged = given(TWO)
    forged["evidence"] = {"kind": "rigid", "triangles": []}
    forged["claims"]["branches"] = []
    made = stopped_by(forged, "the sheet is no triangulated triangle")
    assert made["claims"]["distinct"] == 0


def test_a_triangle_that_is_not_emptied_is_not_rigid() -> None:
    for name in ("rigid-triangle", "rigid-nested"):
        forged = given(name)
        forged["evidence"]["triangles"] = []
        stopped_by(forged, "the sheet is no triangulated triangle")


def test_a_triangle_without_inner_vertices_is_no_sheet_to_count() -> None:
    forged = given("rigid-triangle")
    forged["pattern"] = {
        "vertices": [["0", "0"], ["1", "0"], ["0", "1"]],
        "triangles": [[0, 1, 2]],
    }
    forged["evidence"]["triangles"] = []
    stopped_by(sealed(forged), "the sheet is no triangulated triangle")


def test_branches_where_none_are_listed() -> None:
    branch = given(TWO)["claims"]["branches"][0]
    forged = given("rigid-triangle")
    forged["claims"]["branches"] = [branch]
    stopped_by(forged, "a rigid sheet has no branches")
    forged = given("single-vertex-waterbomb")
    forged["claims"]["branches"] = [branch]
    stopped_by(forged, "a branch of dimension two or more is not listed")


NO_SINGLE = "the emptied sheet is no single vertex of degree 5 or more"


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
        refused(forged, "the sheet has not D = 1")
        forged = given("rigid-triangle")
        forged["evidence"] |= {"kind": kind, "chart": None, "roots": []}
        refused(forged, "the sheet has not D = 1")
    forged = given("listing-chord")
    square = [["0", "0"], ["1", "0"], ["1", "1"], ["0", "1"]]
    forged["pattern"] = {"vertices": square, "triangles": [[0, 1, 2], [0, 2, 3]]}
    forged["evidence"]["triangles"] = []
    stopped_by(sealed(forged), "the sheet has not D = 1")


def test_the_form_of_a_flat_vertex_is_lorentzian(monkeypatch: pytest.MonkeyPatch) -> None:
    """It always is; the check stands in case a sheet that is none got so far."""
    true = Sheet.curvature
    monkeypatch.setattr(
        Sheet, "curvature", lambda sheet, v: {ij: -w for ij, w in true(sheet, v).items()}
    )
    refused(
        given("single-vertex-nine-folds"),
        "the curvature form of vertex 9 has not inertia (1, 6, 3)",
    )
    refused(given("rigid-nested"), "the curvature form of vertex 5 has not inertia (1, 0, 3)")


# --- boxes ---------------------------------------------------------------------------------------


def test_a_root_left_out() -> None:
    for name in (ONE, TWO, "listing-reflex"):
        forged = given(name)
        n = forged["claims"]["interior"]
        drop_roots(forged, lambda root: True, 1)
        made = stopped_by(forged, f"{(1 << n) - 1} roots, not 2^{n}")
        assert made["claims"]["distinct"] == (1 << n) - 1
    forged = given("listing-chord")
    drop_roots(forged, lambda root: True, 1)
    stopped_by(forged, "0 roots, not 2^0")


def test_a_root_too_many() -> None:
    forged = given("listing-chord")
    forged["evidence"]["roots"] *= 2
    assert stopped_by(forged, "2 roots, not 2^0")["claims"]["distinct"] == 2


def test_one_root_in_two_boxes() -> None:
    for name in (ONE, TWO, "listing-isolated"):
        count = len(given(name)["evidence"]["roots"])
        for k in range(1, count):
            forged = given(name)
            roots = forged["evidence"]["roots"]
            roots[k] = dict(roots[0])
            made = stopped_by(forged, "two boxes meet")
            assert made["claims"]["distinct"] == count


def test_one_root_in_two_boxes_of_different_precision() -> None:
    forged = given(TWO)
    roots = forged["evidence"]["roots"]
    first = read_box(roots[0], 2)
    finer = Box([16 * m + 5 for m in first.center], 16 * first.radius + 1, first.bits + 4)
    for k in (1, 3):
        for order in ((0, k), (k, 0)):
            roots[order[0]], roots[order[1]] = entry_of(first), entry_of(finer)
            refused(forged, "two boxes meet")


def meet(a: Box, b: Box) -> bool:
    return all(
        abs(Fraction(x, 1 << a.bits) - Fraction(y, 1 << b.bits))
        <= Fraction(a.radius, 1 << a.bits) + Fraction(b.radius, 1 << b.bits)
        for x, y in zip(a.center, b.center, strict=True)
    )


def test_boxes_that_meet_are_found_as_by_comparing_all_pairs() -> None:
    import random

    source, seen = random.Random(5), {True: 0, False: 0}
    for _ in range(3000):
        size = source.randint(1, 3)
        boxes = []
        for _ in range(source.randint(2, 4)):
            bits = source.randint(0, 3)
            center = [source.randint(-9 << bits, 9 << bits) for _ in range(size)]
            boxes.append(Box(center, source.randint(1, 3 << bits), bits))
        expected = any(meet(a, b) for k, a in enumerate(boxes) for b in boxes[:k])
        seen[expected] += 1
        try:
            check_disjoint(boxes)
        except CertificateError:
            assert expected
        else:
            assert not expected
    assert min(seen.values()) > 300
    check_disjoint([])
    touching = [Box([0], 1, 0), Box([2], 1, 0)]
    with pytest.raises(CertificateError):
        check_disjoint(touching)


def test_numbers_of_a_box_are_bounded() -> None:
    """As large as they may be, they are checked; one more is refused before any arithmetic."""
    most = 1 << 14
    for bits, message in ((most, None), (most + 1, "bits are out of range")):
        forged = given(ONE)
        root = forged["evidence"]["roots"][0]
        box = read_box(root, 1)
        by = bits - box.bits
        with_more = Box([m << by for m in box.center], box.radius << by, bits)
        import sys

        limit = sys.get_int_max_str_digits()
        sys.set_int_max_str_digits(0)
        try:
            root.update(entry_of(with_more))
        finally:
            sys.set_int_max_str_digits(limit)
        if message is None:
            verified(forged)
        else:
            stopped_by(forged, message)
    for key in ("radius", "center"):
        for length in (most, most + 1):
            forged = given(ONE)
            root = forged["evidence"]["roots"][0]
            text = root[key] if key == "radius" else root[key][0]
            sign, rest = ("-", text[1:]) if text.startswith("-") else ("", text)
            longer = sign + rest.rjust(length - len(sign), "0")
            root[key] = longer if key == "radius" else [longer]
            if length == most:
                verified(forged)
            else:
                stopped_by(forged, "a number of a box is out of range")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"radius": "0"}, "the radius is not positive"),
        ({"radius": "-1"}, "the radius is not positive"),
        ({"radius": 1}, "1 is not a number in quotes"),
        ({"radius": "1/2"}, "'1/2' is not an integer"),
        ({"center": [1]}, "1 is not a number in quotes"),
        ({"center": ["0", "0"]}, "center has not 1 entries"),
        ({"center": []}, "center has not 1 entries"),
        ({"center": "0"}, "center is not a list"),
        ({"bits": -1}, "bits is not a natural number"),
        ({"bits": True}, "bits is not a natural number"),
        ({"bits": "64"}, "bits is not a natural number"),
        ({"more": 1}, "root: expected an object with the keys bits radius center"),
    ],
)
def test_boxes_that_are_none(change: Document, message: str) -> None:
    forged = given(ONE)
    forged["evidence"]["roots"][1].update(change)
    refused(forged, message)
    forged = given(ONE)
    forged["evidence"]["roots"] = {}
    refused(forged, "roots is not a list")


# --- charts --------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("chart", "message"),
    [
        ({"4": "-2/3"}, "the chart functional does not fix the height of its corner"),
        ({"1": "0"}, "the chart functional does not fix the height of its corner"),
        ({"1": "1", "0": "1"}, "a bad chart functional"),
        ({"1": "1", "9": "1"}, "a bad chart functional"),
        ({"1": "1", "01": "1"}, "a vertex appears twice in the chart"),
        ([["1", "1"]], "the chart is neither null nor a functional"),
        ("", "the chart is neither null nor a functional"),
        (False, "the chart is neither null nor a functional"),
        ({"x": "1"}, "'x' is not an integer"),
        ({"1": "1/0"}, "'1/0' has no positive denominator"),
        ({"1": 1}, "1 is not a rational number in quotes"),
    ],
)
def test_charts_that_are_none(chart: Any, message: str) -> None:
    forged = given(EITHER)
    forged["evidence"]["chart"] = chart
    refused(forged, message)


def test_a_chart_needs_a_reflex_corner() -> None:
    for name in (ONE, "listing-straight-side"):
        forged = given(name)
        forged["evidence"]["chart"] = {"0": "1"}
        refused(forged, "a chart other than the saddle's needs a reflex corner")


# --- triangulated triangles ----------------------------------------------------------------------

NESTED = "listing-nested-triangles"


def test_triangles_that_are_left_out_are_missed() -> None:
    forged = given(NESTED)
    forged["evidence"]["triangles"] = []
    with pytest.raises(CertificateError, match="center has not 6 entries"):
        verified(forged)


def test_corners_are_vertices() -> None:
    for corner in (99, -1, True, "4", None):
        for key in ("corners", "inside"):
            forged = given(NESTED)
            forged["evidence"]["triangles"][0][key][0] = corner
            refused(forged, f"{corner!a} is no vertex")


def test_corners_go_round_counter_clockwise() -> None:
    entry = given(NESTED)["evidence"]["triangles"][0]
    a, b, c = entry["corners"]
    for corners in ([a, c, b], [a, a, b]):
        forged = given(NESTED)
        forged["evidence"]["triangles"][0]["corners"] = corners
        refused(forged, f"the 3-cycle {corners} is not counter-clockwise")
    for corners in ([b, c, a], [c, a, b]):
        true = given(NESTED)
        true["evidence"]["triangles"][0]["corners"] = corners
        verified(true)


def test_all_three_sides_are_edges() -> None:
    """Three corners around the vertices inside, of which two are not joined."""
    sheet, entry = given(NESTED)["pattern"], given(NESTED)["evidence"]["triangles"][0]
    edges = {frozenset(e) for t in sheet["triangles"] for e in zip(t, t[1:] + t[:1], strict=True)}
    points = [tuple(Fraction(x) for x in pair) for pair in sheet["vertices"]]
    found = 0
    for corners in permutations(range(len(points)), 3):
        a, b, c = (points[v] for v in corners)
        missing = [
            p
            for p in zip(corners, corners[1:] + corners[:1], strict=True)
            if frozenset(p) not in edges
        ]
        if len(missing) != 1 or (b[0] - a[0]) * (c[1] - a[1]) <= (b[1] - a[1]) * (c[0] - a[0]):
            continue
        forged = given(NESTED)
        forged["evidence"]["triangles"][0]["corners"] = list(corners)
        refused(forged, f"{list(corners)} is no 3-cycle of edges")
        found += 1
    assert found > 30
    assert entry["corners"]


def test_all_vertices_inside_and_no_others() -> None:
    entry = given(NESTED)["evidence"]["triangles"][0]
    inside = entry["inside"]
    assert len(inside) >= 2
    for other in (
        inside[1:],
        inside[:-1],
        [],
        [*inside, inside[0]],
        [*inside, entry["corners"][0]],
    ):
        forged = given(NESTED)
        forged["evidence"]["triangles"][0] |= {"inside": other, "multipliers": ["1"] * len(other)}
        refused(forged, f"not the vertices inside {entry['corners']}")
    true = given(NESTED)
    changed = true["evidence"]["triangles"][0]
    changed["inside"], changed["multipliers"] = inside[::-1], changed["multipliers"][::-1]
    verified(true)
    face = given(TWO)["pattern"]["triangles"][0]
    forged = given(TWO)
    forged["evidence"]["triangles"] = [{"corners": face, "inside": [], "multipliers": []}]
    refused(forged, f"not the vertices inside {face}")


def test_multipliers_are_positive_and_definite() -> None:
    for name in (NESTED, "rigid-triangle"):
        count = len(given(name)["evidence"]["triangles"][0]["inside"])
        for k in range(count):
            for weight in ("0", "-1/1000000000"):
                forged = given(name)
                forged["evidence"]["triangles"][0]["multipliers"][k] = weight
                refused(forged, "a multiplier is not positive")
        forged = given(name)
        forged["evidence"]["triangles"][0]["multipliers"].pop()
        refused(forged, f"multipliers has not {count} entries")
        for key in ("corners", "inside", "multipliers"):
            forged = given(name)
            del forged["evidence"]["triangles"][0][key]
            wanted = "corners inside multipliers"
            refused(forged, f"triangle: expected an object with the keys {wanted}")
    forged = given(NESTED)
    forged["evidence"]["triangles"] = {}
    refused(forged, "triangles is not a list")
    forged = given("rigid-triangle")
    forged["evidence"]["triangles"][0]["multipliers"] = [str(10 ** (9 * k)) for k in range(4)]
    refused(forged, "a stress is not definite")


def test_a_stress_that_is_not_definite_hides_motions() -> None:
    """A multiplier that is 0: the vertex may be anywhere."""
    with without("a multiplier is not positive"):
        forged = given("rigid-triangle")
        forged["evidence"]["triangles"][0]["multipliers"][0] = "0"
        refused(forged, "a stress is not definite")
    form = stress.inertia(stress.matrix_of({(0, 0): Fraction(1)}, [0, 1]))
    assert form == (1, 0, 1)


def test_completing_needs_evidence_that_holds() -> None:
    forged = given(ONE)
    forged["evidence"]["roots"][0]["radius"] = "0"
    with pytest.raises(CertificateError, match="radius"):
        completed(forged)
