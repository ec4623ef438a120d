"""Forged certificates of shapes with angle deficits: each is stopped by one line alone."""

from __future__ import annotations

from fractions import Fraction

import pytest
from forge import Document, given, refused, verified, without

from exactfold import checker
from exactfold.branches import find_branch
from exactfold.branches.certificates.single import branch_certificate
from exactfold.pattern import load

SHAPE, TRIANGLES, SQUARE = "branch-deficits", "branch-deficits-triangles", "two-vertex"


def stopped(document: Document, message: str) -> None:
    """Refused with this message, and accepted without the line that says it."""
    refused(document, message)
    with without(message):
        assert verified(document)["curvature"] == document["claims"]["curvature"]


def test_shapes_are_accepted() -> None:
    for name in (SHAPE, TRIANGLES):
        claims = verified(given(name))
        assert claims["gauge"] == "rim"
        what = "shape over the boundary in the file, with these angle deficits,"
        assert checker.summary(claims).startswith(f"VALID: exactly one {what} has the vertex ")


def test_a_negative_deficit() -> None:
    forged = given(SHAPE)
    forged["claims"]["curvature"][0] = "-1/7"
    stopped(forged, "the angle deficit of vertex 6 is negative")


def test_a_deficit_at_a_vertex_that_stays_flat() -> None:
    forged = given(TRIANGLES)
    [entry] = forged["evidence"]["emptied"]
    vertex = entry["inside"][0]
    forged["claims"]["curvature"][vertex - 4] = "1"  # the boundary has four vertices, the first
    stopped(forged, f"vertex {vertex} has an angle deficit, so that it is not flat in a triangle")


def test_deficits_without_a_given_rim() -> None:
    document = branch_certificate(
        find_branch(SQUARE, "+-", boundary_heights=saddle(), curvature={4: 1, 5: Fraction(1, 3)})
    )
    verified(document)
    document["claims"]["gauge"] = "saddle"
    stopped(document, 'angle deficits need the gauge "rim"')


def saddle() -> dict[int, Fraction]:
    plain = find_branch(SQUARE, "+-")
    return {v: plain.centres[v] for v in load(SQUARE).boundary}


@pytest.mark.parametrize("factor", [Fraction(1, 2), 1 + Fraction(1, 10**6), Fraction(2)])
def test_other_deficits(factor: Fraction) -> None:
    forged = given(SHAPE)
    forged["claims"]["curvature"][1] = str(Fraction(forged["claims"]["curvature"][1]) * factor)
    refused(forged, "the distance is larger than claimed")


def test_one_deficit_for_each_vertex() -> None:
    forged = given(SHAPE)
    forged["claims"]["curvature"].append("0")
    refused(forged, "curvature does not have 3 entries")
    forged["claims"]["curvature"] = {}
    refused(forged, "curvature is not a list")


def test_a_vertex_without_a_deficit_may_be_flat_and_one_with_a_deficit_is_not() -> None:
    document = given(SHAPE)
    document["claims"]["assignment"] = "U" * len(document["claims"]["assignment"])
    verified(document)
    for k in range(3):
        for other in (0, -document["claims"]["vertex_signs"][k]):
            forged = given(SHAPE)
            forged["claims"]["vertex_signs"][k] = other
            refused(forged, f"vertex {6 + k} does not have the claimed sign")
