"""Forged algebraic evidence: invented zeros, zeros listed twice, multiplicities made up."""

from __future__ import annotations

import json
from fractions import Fraction
from typing import Any

import pytest
from forge import (
    Document,
    completed,
    cross,
    drop_roots,
    given,
    in_box,
    product,
    refused,
    shifted,
    stopped_by,
    verified,
    without,
)
from old_listing import old_listing
from sheets import relabelled

from exactfold.branches import count_branches
from exactfold.checker.branches.flat_sheets import FlatSheets
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.equations import BranchSystem
from exactfold.checker.sheets.sheet import Sheet, read_sheet
from exactfold.checker.sheets.stress import check_finite
from exactfold.pattern.families import flat_vertex_square

PATH, VERTEX = "algebraic-bent-off-path", "algebraic-flat-vertex-groebner"
BOXES, FLAT = "algebraic-grid", "algebraic-flat-box"


def point(at: list[Fraction], separating: list[int]) -> tuple[Document, Document]:
    """A class of one point, and its root."""
    t = sum((s * x for s, x in zip(separating, at, strict=True)), Fraction(0))
    entry = {"polynomial": [str(-t.numerator), str(t.denominator)], "flat": []}
    return (
        {**entry, "numerators": [[str(x * t.denominator)] for x in at]},
        {"interval": [str(t), str(t)]},
    )


def texts(p: list[Fraction]) -> list[str]:
    return [str(c) for c in p]


def test_the_cross_has_a_class_of_two_rational_zeros() -> None:
    assert verified(cross())["distinct"] == 2


# --- classes -------------------------------------------------------------------------------------


def test_invented_points_miss_a_quadric() -> None:
    """Four points that solve nothing in place of the four simple zeros."""
    forged = given(PATH)
    drop_roots(forged, in_box, 4)
    evidence = forged["evidence"]
    for k in range(4):
        entry, root = point([Fraction(3 + k), Fraction(1, 2 + k), Fraction(k + 7, 5)], [0, 0, 1])
        evidence["roots"].append({"class": len(evidence["classes"]), **root})
        evidence["classes"].append(entry)
    made = stopped_by(forged, "the parametrisation misses a quadric")
    assert made["claims"]["distinct"] == 5


def test_one_quadric_missed_of_three_is_enough() -> None:
    """The class is right but for the numerator of one unknown."""
    for place in range(3):
        forged = given(PATH)
        forged["evidence"]["classes"][0]["numerators"][place] = ["2"]
        forged["evidence"]["separating"] = [0, 0, 0]
        refused(forged, "the parametrisation misses a quadric")


def test_one_zero_in_two_classes() -> None:
    """The double zero twice instead of two simple ones."""
    forged = given(VERTEX)
    first = forged["evidence"]["classes"][0]
    forged["evidence"]["classes"] = [first, first]
    forged["evidence"]["roots"] = [{"class": k, "interval": ["3/10", "3/10"]} for k in range(2)]
    made = stopped_by(forged, "two classes share a root")
    assert made["claims"]["distinct"] == 2


def test_one_zero_among_others_in_two_classes() -> None:
    """A class inside another: simple zeros of the second are lost."""
    forged = given("algebraic-grid-groebner")
    classes = forged["evidence"]["classes"]
    degrees = [len(entry["polynomial"]) - 1 for entry in classes]
    assert degrees == [1, 2, 8]
    for first, second in ((0, 1), (1, 2), (0, 2)):
        made = given("algebraic-grid-groebner")
        a, b = (made["evidence"]["classes"][k] for k in (first, second))
        p, q = ([Fraction(c) for c in entry["polynomial"]] for entry in (a, b))
        a["polynomial"] = texts(product(p, q))  # now both have the zeros of the second
        top = len(p) + len(q) - 2
        numerators = []
        for v, w in zip(a["numerators"], b["numerators"], strict=True):
            terms = [Fraction(0)] * top
            for factor, other in ((v, q), (w, p)):
                whole = product([Fraction(x) for x in factor] or [Fraction(0)], other)
                for k, c in enumerate(whole):
                    terms[k] += c
            numerators.append(texts(terms))
        a["numerators"], a["flat"] = numerators, []
        with without("two classes share a root"), pytest.raises(CertificateError, match="add up"):
            verified(made)
        total = sum(
            (len(entry["polynomial"]) - 1) << len(entry["flat"])
            for entry in made["evidence"]["classes"]
        )
        refused(made, f"multiplicities add up to {total}, not 2^4")


def test_one_class_in_two_parametrisations() -> None:
    """Moved by 1, its polynomial has no root in common with itself."""
    forged = given(VERTEX)
    first = forged["evidence"]["classes"][0]
    moved = dict(first)
    moved["polynomial"] = texts(shifted([Fraction(c) for c in first["polynomial"]], 1))
    moved["numerators"] = [texts(shifted([Fraction(c) for c in w], 1)) for w in first["numerators"]]
    forged["evidence"]["classes"] = [first, moved]
    forged["evidence"]["roots"] = [
        {"class": 0, "interval": ["3/10", "3/10"]},
        {"class": 1, "interval": ["13/10", "13/10"]},
    ]
    made = stopped_by(forged, "the separating form is not the root of its polynomial")
    assert made["claims"]["distinct"] == 2


def test_the_separating_form_is_that_of_all_classes() -> None:
    for separating in ([1, 1], [0, 2], [0, -1], [0, 0]):
        forged = given(VERTEX)
        forged["evidence"]["separating"] = separating
        refused(forged, "the separating form is not the root of its polynomial")
    for separating in ([], [0], [0, 1, 0]):
        forged = given(VERTEX)
        forged["evidence"]["separating"] = separating
        refused(forged, "the separating form has a wrong length")
    forged["evidence"]["separating"] = [0, True]
    refused(forged, "True is not an integer")


def test_a_double_root_parametrises_any_point() -> None:
    """p' vanishes there, and so does everything that is to vanish modulo p."""
    forged = given(PATH)
    drop_roots(forged, in_box, 2)
    forged["evidence"]["classes"].append(
        {
            "polynomial": ["4", "-4", "1"],
            "numerators": [["-12", "6"], ["-20", "10"], ["-8", "4"]],
            "flat": [],
        }
    )
    forged["evidence"]["roots"].append({"class": 1, "interval": ["2", "2"]})
    refused(forged, "a class polynomial has a double root")


def test_a_leading_zero_would_raise_the_degree() -> None:
    for polynomial in (["-3", "8", "0"], ["3"], ["0"], []):
        forged = given(PATH)
        forged["evidence"]["classes"][0]["polynomial"] = polynomial
        drop_roots(forged, in_box, 4)
        if len(polynomial) == 3:
            refused(forged, "a class polynomial is constant")
        else:
            total = 4 * (len(polynomial) - 1)
            refused(forged, f"multiplicities add up to {total}, not 2^3")
    forged = given(PATH)
    forged["evidence"]["classes"].append(
        {"polynomial": ["3"], "numerators": [[], [], []], "flat": []}
    )
    refused(forged, "a class polynomial is constant")


def test_numerators_of_high_degree_could_cost_as_much_as_one_likes() -> None:
    forged = given(VERTEX)
    entry = forged["evidence"]["classes"][0]
    p = [Fraction(c) for c in entry["polynomial"]]
    longer = product(p, [Fraction(1)] * 3)
    longer[0] += Fraction(entry["numerators"][1][0])
    entry["numerators"][1] = texts(longer)
    assert stopped_by(forged, "a numerator has too high a degree")["claims"]["distinct"] == 3
    forged = given(VERTEX)
    forged["evidence"]["classes"][1]["numerators"][0] += ["0"]
    refused(forged, "a numerator has too high a degree")


FLAT_VERTICES = "a flat vertex is not an interior vertex, or appears twice"


@pytest.mark.parametrize(
    ("flat", "message"),
    [
        ([5, 5], FLAT_VERTICES),
        ([5, 0], FLAT_VERTICES),
        ([5, 9], FLAT_VERTICES),
        ([5, "4"], FLAT_VERTICES),
        ([4, 5], "vertex 4 is listed as flat, but its quadric has order 1"),
        ([5, 4], "vertex 4 is listed as flat, but its quadric has order 1"),
    ],
)
def test_flat_vertices_made_up(flat: list[Any], message: str) -> None:
    """Each doubles the multiplicity, so that the simple zeros need not be listed."""
    forged = given(VERTEX)
    forged["evidence"]["classes"] = forged["evidence"]["classes"][:1]
    forged["evidence"]["classes"][0]["flat"] = flat
    drop_roots(forged, lambda root: root["class"] == 1, 2)
    made = stopped_by(forged, message)
    assert made["claims"]["distinct"] == 1


def test_a_flat_vertex_is_a_number() -> None:
    """Python takes True for 1."""
    sheet = relabelled(flat_vertex_square(), (0, 5, 2, 3, 4, 1))
    forged = json.loads(json.dumps(old_listing(count_branches(sheet))))
    verified(forged)
    [entry] = forged["evidence"]["classes"]
    assert entry["flat"] == [1]
    entry["flat"] = [True]
    stopped_by(forged, FLAT_VERTICES)


def test_the_order_is_that_of_the_vertex() -> None:
    forged = given(VERTEX)
    forged["evidence"]["classes"][0]["flat"] = [4]
    refused(forged, "vertex 4 is listed as flat, but its quadric has order 1")


# --- how zeros are listed ------------------------------------------------------------------------


def test_roots_of_no_class_and_no_objects() -> None:
    forged = given(VERTEX)
    forged["evidence"]["roots"][0]["class"] = 2
    refused(forged, "there is no class 2")
    forged["evidence"]["roots"][0]["class"] = -1
    refused(forged, "class is not a natural number")
    forged["evidence"]["roots"][0]["class"] = False
    refused(forged, "class is not a natural number")
    for entry in (0, "class", ["class"], None):
        forged["evidence"]["roots"][0] = entry
        refused(forged, "a root is not an object")


@pytest.mark.parametrize("name", [PATH, BOXES, FLAT])
def test_a_zero_left_out(name: str) -> None:
    forged = given(name)
    n = forged["claims"]["interior"]
    drop_roots(forged, in_box, 1)
    stopped_by(forged, f"multiplicities add up to {(1 << n) - 1}, not 2^{n}")


def test_a_class_too_many() -> None:
    forged = given(PATH)
    entry, _ = point([Fraction(1)] * 3, [0, 0, 1])
    forged["evidence"]["classes"].append(entry)
    refused(forged, "multiplicities add up to 9, not 2^3")


def test_long_lists_of_flat_vertices_cost_nothing() -> None:
    forged = given(PATH)
    forged["evidence"]["classes"][0]["flat"] = [5] * 5000
    refused(forged, "multiplicities add up to 12, not 2^3")
    forged = given(FLAT)
    root = next(root for root in forged["evidence"]["roots"] if "flat" in root)
    root["flat"] = [6] * 5000
    refused(forged, "multiplicities add up to 30, not 2^4")


def test_a_zero_in_two_boxes() -> None:
    forged = given(BOXES)
    boxes = [root for root in forged["evidence"]["roots"] if in_box(root)]
    boxes[1].update(boxes[0])
    made = stopped_by(forged, "two boxes meet")
    assert made["claims"] == {**given(BOXES)["claims"], "branches": made["claims"]["branches"]}


def test_a_zero_in_two_boxes_on_flat_sheets() -> None:
    forged = given(FLAT)
    first, second = (root for root in forged["evidence"]["roots"] if "flat" in root)
    first.update(second)
    stopped_by(forged, "two boxes meet")


@pytest.mark.parametrize("flat", [False, True])
def test_boxes_are_tested_on_their_own_sheets(flat: bool) -> None:
    """The last box of each kind, moved away from its zero."""
    forged = given(FLAT)
    boxes = [root for root in forged["evidence"]["roots"] if "bits" in root]
    root = [root for root in boxes if ("flat" in root) == flat][-1]
    root["center"][0] = str(int(root["center"][0]) + (1 << 40))
    center = [int(m) for m in root["center"]]
    refused(forged, f"Krawczyk's test fails for the box about {center[:2]}.../2^64")


def test_a_zero_in_a_class_and_in_a_box_on_flat_sheets() -> None:
    """Four simple zeros left out in favour of a second listing of two double ones."""
    forged, other = given(BOXES), given(FLAT)
    drop_roots(forged, in_box, 4)
    forged["evidence"]["roots"] += [r for r in other["evidence"]["roots"] if "flat" in r]
    made = stopped_by(forged, "two entries may be the same root")
    assert made["claims"]["distinct"] == 9


# --- sheets that are flat at given vertices ------------------------------------------------------


@pytest.mark.parametrize(
    ("flat", "message"),
    [
        ([], "a flat vertex is not a vertex of the sheet, or none is given"),
        (["6"], "a flat vertex is not a vertex of the sheet, or none is given"),
        ([True], "a flat vertex is not a vertex of the sheet, or none is given"),
        ([0], "the flat vertices are not sorted inner vertices"),
        ([9], "the flat vertices are not sorted inner vertices"),
        ([6, 6], "the flat vertices are not sorted inner vertices"),
        ([6, 5], "the flat vertices are not sorted inner vertices"),
        ([4, 5, 6, 7], "no heights in the chart are flat at the flat vertices"),
        ([4], "quadrics and unknowns on flat sheets differ in number"),
        ([5, 6], "quadrics and unknowns on flat sheets differ in number"),
    ],
)
def test_boxes_on_sheets_that_are_not_there(flat: list[Any], message: str) -> None:
    forged = given(FLAT)
    evidence = forged["evidence"]
    first = next(root for root in evidence["roots"] if "flat" in root)
    box = next(root for root in evidence["roots"] if in_box(root))
    evidence["classes"] = []
    evidence["roots"] = [{**first, "flat": flat}, *[box] * (16 - (1 << len(flat)))]
    refused(forged, message)


def test_sheets_with_one_unknown_left_are_sheets() -> None:
    sheet, _ = read_sheet(given(BOXES)["pattern"])
    system = BranchSystem(sheet, None)
    assert [FlatSheets(system, flat).size for flat in ([5], [6])] == [1, 2]


# --- finitely many zeros -------------------------------------------------------------------------


def test_multipliers_show_that_zeros_are_finitely_many() -> None:
    for change in ("0", "-1"):
        for place in range(3):
            forged = given(PATH)
            forged["evidence"]["multipliers"][place] = change
            refused(forged, "a multiplier is not positive")
    forged = given(PATH)
    forged["evidence"]["multipliers"] = ["1/1000000", "1", "1"]
    refused(forged, "a stress is not definite")
    forged["evidence"]["multipliers"].pop()
    refused(forged, "multipliers does not have 3 entries")


def test_multipliers_of_reflex_sheets_are_verified_too() -> None:
    for name in ("algebraic-either-side", "algebraic-reflex"):
        count = len(given(name)["evidence"]["multipliers"])
        for weight in ("0", "-1"):
            forged = given(name)
            forged["evidence"]["multipliers"][count - 1] = weight
            refused(forged, "a multiplier is not positive")
        forged = given(name)
        forged["evidence"]["multipliers"].pop()
        refused(forged, f"multipliers does not have {count} entries")


def test_only_reflex_corners_are_closed() -> None:
    """Not a straight one, nor a convex one of a small sheet."""
    straight, _ = read_sheet(given("listing-straight-side")["pattern"])
    check_finite(straight, ["1", "1"])
    document = given(PATH)
    sheet, _ = read_sheet(document["pattern"])
    small = {v: (x / 1000, y / 1000) for v, (x, y) in sheet.points.items()}
    faces = [sheet.face(t) for t in sheet.triangles]
    check_finite(Sheet(small, faces), document["evidence"]["multipliers"])


def test_completing_claims_finds_what_is_true() -> None:
    """What `stopped_by` rests on: from the evidence alone it restores the claims."""
    for name in (PATH, VERTEX, BOXES, FLAT, "listing-reflex-either-side", "listing-triangles"):
        assert verified(completed(given(name))) == given(name)["claims"]


def test_keys_of_classes() -> None:
    keys = "class: expected an object with the keys polynomial numerators flat"
    for change in ("polynomial", "numerators", "flat"):
        forged = given(PATH)
        del forged["evidence"]["classes"][0][change]
        refused(forged, keys)
    forged = given(PATH)
    forged["evidence"]["classes"][0]["more"] = 1
    refused(forged, keys)
    for entry in (None, [], "class"):
        forged["evidence"]["classes"][0] = entry
        refused(forged, keys)
    forged = given(PATH)
    forged["evidence"]["classes"][0]["flat"] = {"5": 1, "6": 1}
    refused(forged, "flat vertices is not a list")
    forged = given(PATH)
    next(r for r in forged["evidence"]["roots"] if "class" in r)["more"] = 1
    refused(forged, "root: expected an object with the keys class interval")
    forged = given(FLAT)
    next(r for r in forged["evidence"]["roots"] if "flat" in r)["more"] = 1
    refused(forged, "root: expected an object with the keys bits radius center")
    forged = given(FLAT)
    next(r for r in forged["evidence"]["roots"] if "flat" in r)["center"] += ["0"]
    refused(forged, "center does not have 2 entries")


def test_a_class_that_shares_a_root_of_ten_digits_with_another() -> None:
    """The double zero once more among the simple ones: with floats 3/10 is no common root."""
    forged = given(VERTEX)
    evidence, branches = forged["evidence"], forged["claims"]["branches"]
    simple = next(entry for entry in evidence["classes"] if not entry["flat"])
    double = next(entry for entry in evidence["classes"] if entry["flat"])
    p, q = ([Fraction(c) for c in entry["polynomial"]] for entry in (simple, double))
    both = [
        [a + b for a, b in zip(one, two, strict=True)]
        for one, two in zip(
            (product([Fraction(c) for c in w], q) for w in simple["numerators"]),
            (product([Fraction(c) for c in w], p) for w in double["numerators"]),
            strict=True,
        )
    ]
    at = str(-q[0] / q[1])
    roots, listed = [], []
    for root, branch in zip(evidence["roots"], branches, strict=True):
        if evidence["classes"][root["class"]]["flat"]:
            roots += [{"class": k, "interval": [at, at]} for k in (0, 1)]
            listed += [{**branch, "multiplicity": 1}] * 2
        else:
            roots.append({**root, "class": 0})
            listed.append(branch)
    evidence["classes"] = [
        {"polynomial": texts(product(p, q)), "numerators": list(map(texts, both)), "flat": []},
        {**double, "flat": []},
    ]
    evidence["roots"], forged["claims"]["branches"] = roots, listed
    forged["claims"].update(distinct=4, real=4, nonreal=0, true_branches="proved")
    stopped_by(forged, "two classes share a root")
