"""Certificates of branches on which larger triangles are flat: each forgery, and what stops it."""

from __future__ import annotations

import copy

import pytest
from forge import Document, refused, stopped, verified
from sheets import dart, larger_triangle

from exactfold import checker
from exactfold.branches import find_branch
from exactfold.branches.certificates.single import branch_certificate
from exactfold.certificates.entries import pattern_document
from exactfold.checker.branches.branch import MERGED
from exactfold.pattern.crease_pattern import CreasePattern


@pytest.fixture(scope="module")
def proved() -> Document:
    document = branch_certificate(find_branch(larger_triangle(), "++++-+"))
    assert document["version"] == MERGED
    return document


@pytest.fixture
def document(proved: Document) -> Document:
    return copy.deepcopy(proved)


def entry(document: Document, corners: set[int]) -> Document:
    """The entry of the merged triangle with these corners."""
    merged = document["evidence"]["merged"]
    return next(entry for entry in merged if set(entry["corners"]) == corners)


def test_every_sign_and_letter_is_verified(document: Document) -> None:
    verified(document)
    claims = document["claims"]
    assert claims["vertex_signs"] == [1, 1, 1, 1, -1, 0]
    assert "U" not in claims["assignment"]
    forged = []
    for k, sign in enumerate(claims["vertex_signs"]):
        values = claims["vertex_signs"]
        others = {-1, 0, 1} - {sign}
        forged += [{"vertex_signs": [*values[:k], x, *values[k + 1 :]]} for x in others]
    for k, letter in enumerate(claims["assignment"]):
        text = claims["assignment"]
        forged += [{"assignment": text[:k] + x + text[k + 1 :]} for x in "MVF" if x != letter]
    assert len(forged) == 2 * 6 + 2 * 19
    for change in forged:
        with pytest.raises(checker.CertificateError):
            checker.check({**document, "claims": {**claims, **change}})


def aside(document: Document) -> None:
    """Put vertex 7 a little inside the triangle, and claim that it stays flat."""
    moved = larger_triangle((5, "13/5"))
    document["pattern"] = pattern_document(moved)
    document["claims"]["vertex_signs"][3] = 0
    letters = dict(zip(moved.folds, document["claims"]["assignment"], strict=True))
    text = "".join("F" if 7 in fold else letter for fold, letter in letters.items())
    document["claims"]["assignment"] = text


def test_a_vertex_outside_a_triangle_is_not_merged_into_it(document: Document) -> None:
    aside(document)
    stopped(document, "vertex 7 is not in the triangle (0, 5, 4)")


def test_each_face_lies_in_a_merged_triangle(document: Document) -> None:
    aside(document)
    entry(document, {0, 4, 5})["others"] = []
    stopped(document, "a face at a merged vertex lies in no merged triangle")


def test_merged_triangles_close_no_notch() -> None:
    # The boundary has three vertices then, and flat heights would be the only ones.
    pattern = dart()
    corner = pattern.reflex_corner
    assert corner is not None
    k = pattern.boundary.index(corner)
    before, after = pattern.boundary[k - 1], pattern.boundary[(k + 1) % 4]
    document = flat_sheet(pattern)
    refused(document, "the boundary is not convex")
    document["evidence"]["merged"] = [{"corners": [before, after, corner], "others": []}]
    stopped(document, "merged triangles change the boundary")


def flat_sheet(pattern: CreasePattern) -> Document:
    """A certificate that says that all heights are 0 if those of the rim are."""
    return {
        "format": "exactfold branch",
        "version": MERGED,
        "pattern": pattern_document(pattern),
        "claims": {
            "gauge": "rim",
            "vertex_signs": [0] * pattern.Vi,
            "assignment": "F" * len(pattern.folds),
            "squared_distance": "0",
        },
        "evidence": {
            "emptied": [],
            "merged": [],
            "heights": ["0"] * len(pattern.vertices),
            "denominator": "1",
        },
    }


def test_heights_of_merged_vertices_are_left_out(document: Document) -> None:
    document["evidence"]["heights"][9] = "0"
    stopped(document, "heights must be null for the vertices that are removed, and for no others")


def test_a_side_whose_letter_is_open_says_nothing(document: Document) -> None:
    # Rough heights, which leave the letter of the side 4-5 open.
    claims, evidence = document["claims"], document["evidence"]
    heights = ["10000", "0", "0", "0", "7208", "3226", "585"]
    evidence |= {"heights": [*heights, None, None, None], "denominator": "10000"}
    claims |= {"assignment": "U" * 19, "squared_distance": "1"}
    claims["vertex_signs"] = [1, 1, -1, 0, -1, 0]
    stopped(document, "vertex 7 may be flat")


def test_older_versions_merge_nothing(document: Document) -> None:
    document["version"] = 1
    refused(document, "evidence: expected an object with the keys emptied heights denominator")


def test_a_vertex_that_does_not_exist_is_not_merged(document: Document) -> None:
    entry(document, {4, 5, 6})["others"].append(10)
    refused(document, "malformed: KeyError while checking")
