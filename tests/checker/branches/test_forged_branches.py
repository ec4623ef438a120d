"""Forged certificates of one branch: other signs, other letters, heights that prove nothing."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import pytest
from forge import FIXTURES, Document, given, refused, sealed, verified

from exactfold import checker
from exactfold.checker.branches import branch
from exactfold.checker.branches.branch_proof import Proof
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.sheet import Sheet, read_sheet

BRANCHES = sorted(path.stem for path in FIXTURES.glob("branch-*.json"))
SMALL = [name for name in BRANCHES if name not in ("branch-random", "branch-thin-triangles")]
CONVEX, REFLEX, TRIANGLES = "branch-convex", "branch-reflex", "branch-triangles"


def test_claims_come_with_the_pattern() -> None:
    document = given(REFLEX)
    claims = verified(document)
    assert claims == {
        **document["claims"],
        "interior": 3,
        "sha256": read_sheet(document["pattern"])[1],
    }
    assert checker.summary(claims) == (
        "VALID: exactly one branch has the vertex signs +0- (3); 10 of 10 letters decided; sha256 "
        + claims["sha256"]
    )
    long = {**claims, "vertex_signs": [1] * 61, "assignment": "UUM"}
    assert branch.summary(long).startswith(
        f"VALID: exactly one branch has the vertex signs {'+' * 60}... (61); 1 of 3 letters"
    )
    assert checker.summary(verified(given("branch-rim"))).startswith(
        "VALID: exactly one solution over the boundary in the file has the vertex signs +-+ (3);"
    )
    exact = {**claims, "vertex_signs": [-1] * 60}
    assert f"signs {'-' * 60} (60);" in branch.summary(exact)


def test_keys() -> None:
    for part, keys in (
        ("claims", "gauge vertex_signs assignment squared_distance"),
        ("evidence", "emptied heights denominator"),
    ):
        forged = given(CONVEX)
        forged[part]["more"] = 1
        refused(forged, f"{part}: expected an object with the keys {keys}")
    forged = given(TRIANGLES)
    forged["evidence"]["emptied"][0]["multipliers"] = []
    refused(forged, "3-cycle: expected an object with the keys corners inside")
    for change, message in (
        ({"heights": {}}, "heights is not a list"),
        ({"heights": []}, "heights does not have 10 entries"),
        ({"emptied": None}, "emptied is not a list"),
        ({"denominator": "0"}, "the denominator is not positive"),
        ({"denominator": "-5"}, "the denominator is not positive"),
        ({"denominator": "x"}, "'x' is not an integer"),
        ({"denominator": 5}, "malformed: TypeError while checking"),
    ):
        forged = given(CONVEX)
        forged["evidence"] |= change
        refused(forged, message)


# --- signs, letters, distance --------------------------------------------------------------------


@pytest.mark.parametrize("name", SMALL)
def test_every_sign_and_letter_is_compared(name: str) -> None:
    claims = given(name)["claims"]
    folds = read_sheet(given(name)["pattern"])[0].folds
    interior = read_sheet(given(name)["pattern"])[0].interior
    places = range(len(interior)) if len(interior) < 5 else (0, 1, len(interior) - 1)
    for k in places:
        sign = claims["vertex_signs"][k]
        for other in [x for x in (-1, 0, 1) if x != sign] + [bool(sign), str(sign), None]:
            forged = given(name)
            forged["claims"]["vertex_signs"][k] = other
            refused(forged, f"vertex {interior[k]} does not have the claimed sign")
    seen = set()
    for k, letter in enumerate(claims["assignment"]):
        if letter in seen and k > 4:
            continue
        seen.add(letter)
        for other in {*"MVF?"} - {letter}:
            forged = given(name)
            text = claims["assignment"]
            forged["claims"]["assignment"] = text[:k] + other + text[k + 1 :]
            refused(forged, f"fold {folds[k]} is not known to be {other!a}")
    true = given(name)
    true["claims"]["assignment"] = "U" * len(folds)
    verified(true)


def test_signs_and_letters_are_as_many_as_there_are() -> None:
    for letters in ("", "M" * 99, None, ["M"] * 19):
        forged = given(CONVEX)
        forged["claims"]["assignment"] = letters
        refused(forged, "the assignment does not have one letter for each fold")
    text = given(CONVEX)["claims"]["assignment"]
    for letters in (text + "U", text[:-1], list(text)):
        forged["claims"]["assignment"] = letters
        refused(forged, "the assignment does not have one letter for each fold")
    forged = given(CONVEX)
    forged["claims"]["vertex_signs"].append(1)
    refused(forged, "vertex_signs does not have 6 entries")
    forged["claims"]["vertex_signs"] = "+-++-+"
    refused(forged, "vertex_signs is not a list")


@pytest.mark.parametrize("name", SMALL)
def test_distances_are_compared(name: str) -> None:
    """The smallest true claim is accepted, anything less is not."""
    document = given(name)
    sheet_of: list[Proof] = []
    true = Proof.__init__

    def kept(self: Proof, *arguments: Any) -> None:
        true(self, *arguments)
        sheet_of.append(self)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Proof, "__init__", kept)
        verified(document)
    least = sheet_of[0].squared_distance
    document["claims"]["squared_distance"] = str(least)
    verified(document)
    for less in (least * (1 - Fraction(1, 10**20)), -least - 1, least - Fraction(1, 10**300)):
        if less != least:
            document["claims"]["squared_distance"] = str(less)
            refused(document, "the distance is larger than claimed")


def independent(document: Document) -> Fraction:
    """sum_v m_v (sqrt K_v - sqrt k_v)^2 for the heights of a convex sheet, K_v by its form.

    m_v = (R^2 - |v - c|^2), c the middle of the bounding box and R its distance to the farthest
    corner, both in the coordinates of the certificate times their common denominator.
    """
    sheet, _ = read_sheet(document["pattern"])
    unit = math.lcm(*(x.denominator for p in sheet.points.values() for x in p))
    points = {v: (x * unit, y * unit) for v, (x, y) in sheet.points.items()}
    whole = Sheet(points, [sheet.face(t) for t in sheet.triangles])
    q = int(document["evidence"]["denominator"])
    h = {v: Fraction(int(t), q) for v, t in enumerate(document["evidence"]["heights"])}
    middle = [(min(c) + max(c)) / 2 for c in zip(*points.values(), strict=True)]

    def squared(v: int) -> Fraction:
        return sum(((a - b) ** 2 for a, b in zip(points[v], middle, strict=True)), Fraction(0))

    radius = max(squared(v) for v in whole.boundary)
    total = Fraction(0)
    for v in whole.interior:
        k = sum((w * h[i] * h[j] for (i, j), w in whole.curvature(v).items()), Fraction(0))
        total += (radius - squared(v)) * k
    return total


@pytest.mark.parametrize("name", [CONVEX, "branch-rim", "branch-low-rim", "branch-flat-vertex"])
def test_distances_are_those_of_the_theorem(name: str) -> None:
    """From above, and nearly: the forms of the listing checker and Fractions throughout."""
    document = given(name)
    exact = independent(document)
    claimed = Fraction(document["claims"]["squared_distance"])
    assert 0 < exact <= claimed * (1 + Fraction(1, 10**9))
    for factor, right in ((1 + Fraction(1, 10**9), True), (1 - Fraction(1, 10**9), False)):
        document["claims"]["squared_distance"] = str(exact * factor)
        if right:
            verified(document)
        else:
            refused(document, "the distance is larger than claimed")


def test_the_curvature_of_the_reflex_corner_counts() -> None:
    """Heights twice as high have K_v > 0 elsewhere as before, but K = 4 at the corner."""
    for factor in (2, Fraction(1, 2), 1 + Fraction(1, 10**6)):
        forged = given(REFLEX)
        evidence, claims = forged["evidence"], forged["claims"]
        factor = Fraction(factor)
        evidence["heights"] = [h and str(int(h) * factor.numerator) for h in evidence["heights"]]
        evidence["denominator"] = str(int(evidence["denominator"]) * factor.denominator)
        claims["assignment"] = "U" * len(claims["assignment"])
        claims["squared_distance"] = str(Fraction(claims["squared_distance"]) * 1000)
        refused(forged, "the distance is larger than claimed")


def test_letters_need_more_than_the_distance() -> None:
    """omega L > (distance^2 (2/c + 2/d))^(1/2): at the limit a letter is open, below it is not."""
    document = given(CONVEX)
    kept: list[Proof] = []
    true = Proof._letters

    def seen(self: Proof) -> dict[tuple[int, int], str]:
        kept.append(self)
        return true(self)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Proof, "_letters", seen)
        verified(document)
    (proof,) = kept
    sheet = proof.sheet
    for fold, letter in zip(sheet.folds, document["claims"]["assignment"], strict=True):
        i, j = fold
        k, m = sheet.next[i][j], sheet.next[j][i]
        p, q, r, s = (sheet.points[v] for v in (i, j, k, m))
        c = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        d = (p[0] - q[0]) * (s[1] - q[1]) - (p[1] - q[1]) * (s[0] - q[0])
        bend = sum(w * proof.heights[v] for v, w in sheet.bend(fold).items())
        omega = Fraction(bend) / (c * d * proof.q)
        square = (q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2
        limit = omega**2 * square / (Fraction(2) / c + Fraction(2) / d)
        for factor, expected in ((1, None), (1 - Fraction(1, 10**9), {"M": -1, "V": 1}[letter])):
            proof.squared_distance = limit * factor
            assert proof._side(fold) == expected


# --- heights -------------------------------------------------------------------------------------


def test_heights_are_those_of_the_vertices_that_are_left() -> None:
    for change in (None, "x"):
        forged = given(CONVEX)
        forged["evidence"]["heights"][5] = change
        message = (
            "heights must be null for the vertices that are removed, and for no others"
            if change is None
            else "'x' is not an integer"
        )
        refused(forged, message)
    forged = given(TRIANGLES)
    place = forged["evidence"]["heights"].index(None)
    forged["evidence"]["heights"][place] = "0"
    refused(forged, "heights must be null for the vertices that are removed, and for no others")


def test_heights_that_solve_nothing() -> None:
    forged = given(CONVEX)
    for v in range(4, 10):
        forged = given(CONVEX)
        unit = int(forged["evidence"]["denominator"])
        heights = forged["evidence"]["heights"]
        heights[v] = str(int(heights[v]) + unit // 50)
        with pytest.raises(CertificateError, match=r"^K is not positive at vertex "):
            verified(forged)


@pytest.mark.parametrize("name", ["branch-exact", "branch-hypar-exact"])
def test_heights_that_are_almost_exact(name: str) -> None:
    for bits in (20, 300, 900):
        true = given(name)
        evidence = true["evidence"]
        evidence["denominator"] = str(int(evidence["denominator"]) << bits)
        finer = [h and str(int(h) << bits) for h in evidence["heights"]]
        evidence["heights"] = finer
        verified(true)
        v = next(v for v, h in enumerate(finer) if v > 4 and h is not None)
        for by in (1, -1):
            forged = given(name)
            forged["evidence"]["denominator"] = evidence["denominator"]
            changed = str(int(finer[v]) + by)
            forged["evidence"]["heights"] = [*finer[:v], changed, *finer[v + 1 :]]
            with pytest.raises(CertificateError, match=r"^K is not positive at vertex "):
                verified(forged)


def test_a_side_that_is_not_certain(monkeypatch: pytest.MonkeyPatch) -> None:
    """A form whose bounds have 0 between them leaves the side open."""
    true = Proof.form

    def about_zero(self: Proof, v: int, a: Any, b: Any) -> tuple[int, int]:
        low, high = true(self, v, a, b)
        return (0, high) if a is not b and v == 7 else (low, high)

    monkeypatch.setattr(Proof, "form", about_zero)
    refused(given(CONVEX), "the sign of vertex 7 is not certain")


# --- the gauge -----------------------------------------------------------------------------------


def test_other_gauges() -> None:
    for gauge in ("none", "", None, "Saddle"):
        forged = given(CONVEX)
        forged["claims"]["gauge"] = gauge
        refused(forged, "the gauge is neither saddle nor rim")
    forged = given("branch-rim")
    forged["claims"]["gauge"] = "saddle"
    refused(forged, "there are not four boundary vertices")
    true = given(CONVEX)
    true["claims"]["gauge"] = "rim"
    verified(true)
    for name in ("branch-dart", REFLEX):
        forged = given(name)
        forged["claims"]["gauge"] = "rim"
        refused(forged, "the boundary is not convex")


def test_the_saddle_is_positive() -> None:
    """The other side of the same branch: all signs and letters would be exchanged."""
    flip = str.maketrans("MV", "VM")
    for name in (CONVEX, "branch-flat-vertex", "branch-several-triangles"):
        forged = given(name)
        forged["evidence"]["heights"] = [h and str(-int(h)) for h in forged["evidence"]["heights"]]
        forged["claims"]["vertex_signs"] = [-s for s in forged["claims"]["vertex_signs"]]
        forged["claims"]["assignment"] = forged["claims"]["assignment"].translate(flip)
        refused(forged, "the saddle is not positive")
        forged["claims"]["gauge"] = "rim"
        verified(forged)
    flat = given(CONVEX)
    for v in range(4):
        flat["evidence"]["heights"][v] = "0"
    refused(flat, "the saddle is not positive")


def test_the_saddle_whatever_the_first_corner() -> None:
    """The labels of the corners turned about: the side that counts stays."""
    for turn in range(4):
        document = given(CONVEX)
        order = [*(list(range(turn, 4)) + list(range(turn))), *range(4, 10)]
        place = {v: k for k, v in enumerate(order)}
        pattern, evidence = document["pattern"], document["evidence"]
        pattern["vertices"] = [pattern["vertices"][v] for v in order]
        pattern["triangles"] = [[place[v] for v in t] for t in pattern["triangles"]]
        evidence["heights"] = [evidence["heights"][v] for v in order]
        document["claims"]["assignment"] = "U" * len(document["claims"]["assignment"])
        if turn % 2 == 0:
            verified(document)
        else:
            refused(document, "the saddle is not positive")


def test_the_rim_of_a_reflex_sheet_is_flat() -> None:
    for name in ("branch-dart", REFLEX):
        corners = read_sheet(given(name)["pattern"])[0].boundary
        for v in corners:
            forged = given(name)
            if forged["evidence"]["heights"][v] != "0":
                continue
            forged["evidence"]["heights"][v] = "1"
            refused(forged, "the boundary vertices are not all at height 0")


def test_the_reflex_corner_pops_up() -> None:
    flip = str.maketrans("MV", "VM")
    for name in ("branch-dart", REFLEX):
        forged = given(name)
        forged["evidence"]["heights"] = [h and str(-int(h)) for h in forged["evidence"]["heights"]]
        forged["claims"]["vertex_signs"] = [-s for s in forged["claims"]["vertex_signs"]]
        forged["claims"]["assignment"] = forged["claims"]["assignment"].translate(flip)
        refused(forged, "the reflex corner does not pop up")


# --- triangulated triangles ----------------------------------------------------------------------


def test_three_cycles_are_of_edges() -> None:
    true = given(TRIANGLES)["evidence"]["emptied"][0]
    a, b, c = true["corners"]
    triangles = given(TRIANGLES)["pattern"]["triangles"]
    edges = {frozenset(e) for t in triangles for e in zip(t, t[1:] + t[:1], strict=True)}
    far = (
        next(
            v
            for v in range(10)
            if not any(frozenset((v, u)) in edges or v == u for u in (a, b, c))
            or (v not in (a, b, c) and sum(frozenset((v, u)) in edges for u in (a, b, c)) == 0)
        )
        if any(
            v not in (a, b, c) and not any(frozenset((v, u)) in edges for u in (a, b, c))
            for v in range(10)
        )
        else 99
    )
    for corners, i, j in (([far, b, c], far, b), ([a, far, c], a, far), ([a, b, far], b, far)):
        forged = given(TRIANGLES)
        forged["evidence"]["emptied"][0]["corners"] = corners
        refused(forged, f"{i}-{j} is not an edge")
    for corners in ([b, c, a], [c, a, b]):
        turned = given(TRIANGLES)
        turned["evidence"]["emptied"][0]["corners"] = corners
        verified(turned)
    for corner in (True, -1, "4"):
        forged = given(TRIANGLES)
        forged["evidence"]["emptied"][0]["corners"][0] = corner
        refused(forged, "corner is not a natural number")
    forged["evidence"]["emptied"][0]["corners"] = [a, b]
    refused(forged, "corners does not have 3 entries")


def test_only_the_third_side_is_missing() -> None:
    """Each of the three sides in turn is the one that is no edge."""
    triangles = given(TRIANGLES)["pattern"]["triangles"]
    edges = {frozenset(e) for t in triangles for e in zip(t, t[1:] + t[:1], strict=True)}
    found = set()
    for x in range(10):
        for y in range(10):
            for z in range(10):
                sides = [(x, y), (y, z), (x, z)]
                missing = [k for k, s in enumerate(sides) if frozenset(s) not in edges]
                if len({x, y, z}) == 3 and len(missing) == 1 and missing[0] not in found:
                    forged = given(TRIANGLES)
                    forged["evidence"]["emptied"][0]["corners"] = [x, y, z]
                    i, j = sides[missing[0]]
                    refused(forged, f"{i}-{j} is not an edge")
                    found.add(missing[0])
    assert found == {0, 1, 2}


def test_vertices_inside_are_inside() -> None:
    true = given(TRIANGLES)["evidence"]["emptied"][0]
    corners = tuple(true["corners"])
    for vertex in (*corners, 0, 1, 2, 3):
        forged = given(TRIANGLES)
        forged["evidence"]["emptied"][0]["inside"].append(vertex)
        refused(forged, f"vertex {vertex} is not inside {corners}")
    forged = given(TRIANGLES)
    forged["evidence"]["emptied"][0]["corners"] = [corners[0], corners[2], corners[1]]
    inside = true["inside"][0]
    refused(forged, f"vertex {inside} is not inside {(corners[0], corners[2], corners[1])}")
    forged = given(TRIANGLES)
    forged["evidence"]["emptied"][0]["inside"][0] = True
    refused(forged, "vertex inside is not a natural number")
    forged = given(TRIANGLES)
    forged["evidence"]["emptied"][0]["inside"].pop(0)
    with pytest.raises(CertificateError):
        verified(forged)


def test_vertices_of_emptied_triangles_are_flat_and_their_folds_too() -> None:
    document = given(TRIANGLES)
    removed = {v for entry in document["evidence"]["emptied"] for v in entry["inside"]}
    sheet, _ = read_sheet(document["pattern"])
    for k, fold in enumerate(sheet.folds):
        assert (document["claims"]["assignment"][k] == "F") == bool(removed & set(fold))


# --- flat vertices -------------------------------------------------------------------------------


def test_a_vertex_that_may_be_flat(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither M nor V at any of its folds: its sign is not shown."""
    true = Proof._letters

    def open_at(self: Proof) -> dict[tuple[int, int], str]:
        return {fold: "U" if 7 in fold else x for fold, x in true(self).items()}

    monkeypatch.setattr(Proof, "_letters", open_at)
    refused(given(CONVEX), "vertex 7 may be flat")


def test_exact_heights_show_flat_folds_and_others_do_not() -> None:
    document = given("branch-open-fold")
    folds = read_sheet(document["pattern"])[0].folds
    k = document["claims"]["assignment"].index("U")
    for letter in "MVF":
        text = document["claims"]["assignment"]
        document["claims"]["assignment"] = text[:k] + letter + text[k + 1 :]
        refused(document, f"fold {folds[k]} is not known to be {letter!a}")
        document["claims"]["assignment"] = text


def test_another_pattern_is_another_claim() -> None:
    document = given(CONVEX)
    document["pattern"]["vertices"][2] = ["1/2", "1/2"]
    with pytest.raises(CertificateError):
        verified(document)
    document = given(CONVEX)
    document["pattern"]["triangles"].pop()
    with pytest.raises(CertificateError):
        verified(document)
    assert branch.BRANCH.read(given(CONVEX)) == given(CONVEX)
    assert "sha256" not in given(CONVEX)["claims"]
    assert sealed(given("listing-cross")) == given("listing-cross")
