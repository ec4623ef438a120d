"""Forged triangulated triangles: other corners, other vertices, stresses that prove nothing."""

from __future__ import annotations

from fractions import Fraction
from itertools import permutations

import pytest
from forge import (
    completed,
    given,
    refused,
    verified,
    without,
)

from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets import stress

TWO, ONE, EITHER = "listing-two-vertices", "listing-one-vertex", "listing-reflex-either-side"


NESTED = "listing-nested-triangles"


def test_triangles_that_are_left_out_are_missed() -> None:
    forged = given(NESTED)
    forged["evidence"]["triangles"] = []
    with pytest.raises(CertificateError, match="center does not have 6 entries"):
        verified(forged)


def test_corners_are_vertices() -> None:
    for corner in (99, -1, True, "4", None):
        for key in ("corners", "inside"):
            forged = given(NESTED)
            forged["evidence"]["triangles"][0][key][0] = corner
            refused(forged, f"{corner!a} is not a vertex")


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
        refused(forged, f"{list(corners)} is not a 3-cycle of edges")
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
        refused(forged, f"multipliers does not have {count} entries")
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
