"""Sheets with flat vertices: multiple roots, found by paths and by the exact engine."""

import json
from collections import Counter

import pytest
from counting import counts
from old_listing import old_listing
from sheets import wheel

from exactfold import PROVED, UNDECIDED, CreasePattern, checker
from exactfold.branches import count_branches
from exactfold.branches.certificates.listing import certificate
from exactfold.branches.counting import in_chart, multiple_roots
from exactfold.pattern.families import FAMILIES, hypar


@pytest.mark.parametrize("method", ["auto", "groebner"])
def test_flat_vertex_example(method):
    result = count_branches(FAMILIES["flat-vertex"](), method=method)
    assert counts(result) == (3, 4, 3, 0)
    assert (result.true_branches, result.true_bounds) == (PROVED, (3, 3))
    # What a certificate shows of a multiple root is less.
    assert checker.check(certificate(result))["true_branches"] == "undecided"
    assert sorted(branch.multiplicity for branch in result.branches) == [1, 1, 2]
    (double,) = (branch for branch in result.branches if branch.multiplicity == 2)
    assert list(double.vertex_signs.values()).count(0) == 1
    # The sheet folds along the diagonal 0-4-2 alone.
    bent = {fold for fold, letter in double.assignment.items() if letter != "F"}
    assert bent == {(0, 4), (2, 4)}


def test_paths_that_meet_are_proved_by_flat_vertices():
    result = count_branches(FAMILIES["flat-vertex"](), method="popping")
    assert result.status is PROVED
    assert result.method == "popping"
    assert counts(result) == (3, 4, 3, 0)
    assert sorted(branch.multiplicity for branch in result.branches) == [1, 1, 2]


@pytest.mark.parametrize("method", ["popping", "homotopy"])
def test_multiple_roots_are_undecided_without_the_exact_engine(monkeypatch, method):
    monkeypatch.setattr(in_chart, "flat_vertices", lambda chart, points: iter(()))
    result = count_branches(FAMILIES["flat-vertex"](), method=method)
    assert result.status is UNDECIDED
    assert result.distinct is result.with_multiplicity is result.real is None
    assert "2 of 4 solutions isolated" in result.reason
    assert result.open_questions


def test_multiple_roots_of_a_large_pattern_are_undecided(monkeypatch):
    monkeypatch.setattr(in_chart, "GROEBNER_LIMIT", 1)
    monkeypatch.setattr(in_chart, "flat_vertices", lambda chart, points: iter(()))
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert "the exact engine is tried up to 1 unknown, not with 2" in result.reason


def test_flat_vertices_and_the_exact_engine_agree():
    """Two independent ways: flat vertices found by paths, and the whole quotient algebra."""
    for pattern in (FAMILIES["flat-vertex"](), hypar(1, twist=0)):
        paths = count_branches(pattern, method="popping")
        exact = count_branches(pattern, method="groebner")
        assert counts(paths) == counts(exact)
        assert [b.entry()["vertex_signs"] for b in paths.branches] == [
            b.entry()["vertex_signs"] for b in exact.branches
        ]
        assert [b.multiplicity for b in paths.branches] == [b.multiplicity for b in exact.branches]


@pytest.mark.survey
def test_flat_vertices_by_boxes_and_by_exact_classes_agree(monkeypatch):
    pattern = hypar(2, twist=0)
    exact = count_branches(pattern)
    monkeypatch.setattr(multiple_roots, "GROEBNER_LIMIT", 0)
    boxes = count_branches(pattern)
    assert counts(exact) == counts(boxes) == (205, 256, 205, 0)
    assert Counter(b.multiplicity for b in exact.branches) == {1: 192, 4: 12, 16: 1}
    assert [(b.sign_text, b.assignment_text, b.multiplicity) for b in exact.branches] == [
        (b.sign_text, b.assignment_text, b.multiplicity) for b in boxes.branches
    ]
    for result in (exact, boxes):
        document = json.loads(json.dumps(old_listing(result)))
        checker.check(document)
        checker.check(certificate(result))
    roots = document["evidence"]["roots"]
    place = next(k for k, root in enumerate(roots) if "flat" in root)
    for flat in ([], [9], [11, 9], [9, 11, 11], [0, 9], [5, 7, 9, 11], ["9", 11], None):
        if flat != roots[place]["flat"]:
            roots[place]["flat"] = flat
            with pytest.raises(checker.CertificateError):
                checker.check(document)


def test_flat_vertices_among_nearly_flat_ones_are_found():
    """Five vertices are flat on one branch; paths that end near it make others seem flat too."""
    inner = [(3, 3), (2, 4), (4, 4), (4, 1), (3, 4), (3, 1), (3, 2), (2, 2)]
    faces = [(0, 1, 9), (0, 11, 3), (1, 2, 7), (1, 7, 9), (2, 3, 8), (2, 6, 7), (2, 8, 6)]
    faces += [(3, 5, 8), (3, 11, 5), (4, 5, 11), (4, 6, 8), (4, 8, 5), (4, 10, 6), (4, 11, 10)]
    faces += [(6, 10, 7), (7, 10, 9), (0, 9, 10), (0, 10, 11)]
    result = count_branches(CreasePattern([(0, 0), (5, 0), (5, 5), (0, 5), *inner], faces))
    assert counts(result) == (225, 256, 225, 0)
    assert Counter(b.multiplicity for b in result.branches) == {1: 224, 32: 1}
    checker.check(certificate(result))


def test_hypar_with_a_straight_diagonal():
    pattern = hypar(1, twist=0)
    result = count_branches(pattern)
    assert result.status is PROVED
    assert result.with_multiplicity == sum(b.multiplicity for b in result.branches) == 16
    assert result.distinct == len(result.branches) == 13
    multiple = [branch for branch in result.branches if branch.multiplicity > 1]
    assert [branch.vertex_signs[v] for branch in multiple for v in pattern.interior].count(0) > 0


def pleated(rings, *, turning=True):
    """Concentric squares about a centre.

    The diagonals between squares all turn the same way, or every second one the other way.
    """
    sizes = range(rings + 1, 0, -1)
    points = [(s * x, s * y) for s in sizes for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    faces = []
    for k in range(rings):
        for j in range(4):
            a, b = 4 * k + j, 4 * k + (j + 1) % 4
            if turning or j % 2 == 0:
                faces += [(a, b, b + 4), (a, b + 4, a + 4)]
            else:
                faces += [(a, b, a + 4), (b, b + 4, a + 4)]
    centre, last = len(points), 4 * rings
    faces += [(last + j, last + (j + 1) % 4, centre) for j in range(4)]
    return CreasePattern([*points, (0, 0)], faces)


def test_flat_sheets_with_more_conditions_than_unknowns(monkeypatch):
    """With a flat centre the inner square is rigid: four conditions, and three unknowns."""
    exact = count_branches(pleated(1))
    monkeypatch.setattr(multiple_roots, "GROEBNER_LIMIT", 2)
    monkeypatch.setattr(in_chart, "GROEBNER_LIMIT", 2)
    boxes = count_branches(pleated(1))
    assert counts(exact) == counts(boxes) == (25, 32, 25, 0)
    assert Counter(b.multiplicity for b in boxes.branches) == {1: 22, 2: 1, 4: 2}
    assert [(b.sign_text, b.assignment_text) for b in exact.branches] == [
        (b.sign_text, b.assignment_text) for b in boxes.branches
    ]
    monkeypatch.setattr(multiple_roots, "_MOST_TOGETHER", 0)
    assert count_branches(pleated(1)).status is UNDECIDED


@pytest.mark.parametrize(
    ("turning", "simple", "distinct"),
    [
        pytest.param(True, 352, 394, marks=pytest.mark.slow),
        pytest.param(False, 192, 257, marks=pytest.mark.survey),
    ],
)
def test_a_pleated_hypar_with_nine_vertices(turning, simple, distinct):
    """The branches that are not simple fold a diagonal, or leave the centre or corners flat."""
    result = count_branches(pleated(2, turning=turning))
    assert counts(result) == (distinct, 512, distinct, 0)
    assert Counter(b.multiplicity for b in result.branches)[1] == simple
    assert checker.check(certificate(result))["distinct"] == distinct


def test_flat_vertices_in_a_non_convex_sheet():
    """A straight crease 3-4-6 in a non-convex quadrilateral: multiple branches again."""
    points = [(7, -1), (5, -6), (9, 2), (0, -8), ("23/5", "-16/5"), ("23/3", "-1/3")]
    points += [("92/15", "-8/5"), ("923/165", "-122/55")]
    faces = [(2, 3, 4), (0, 1, 5), (1, 2, 5), (2, 4, 6), (0, 6, 7), (4, 7, 6), (0, 5, 6)]
    pattern = CreasePattern(points, [*faces, (2, 6, 5), (0, 7, 3), (3, 7, 4)])
    assert not pattern.is_convex
    result = count_branches(pattern)
    assert counts(result) == (12, 16, 12, 0)
    assert (result.true_branches, result.true_bounds) == (PROVED, (12, 12))
    for branch in result.branches:
        assert branch.multiplicity == (2 if "0" in branch.sign_text else 1)


def test_degree_four_cross_folds_along_its_lines():
    result = count_branches(wheel([(1, 0), (0, 2), (-3, 0), (0, -1)]))
    assert counts(result) == (2, 2, 2, 0)
    assert {branch.assignment_text for branch in result.branches} == {"FVFV", "MFMF"}
