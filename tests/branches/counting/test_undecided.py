"""What is not proved is UNDECIDED: a missing lemma is never papered over."""

import dataclasses
import json

import pytest
from counting import counts
from old_listing import old_listing
from sheets import TRIANGLE, scrambled, two_triangles

from exactfold import PROVED, UNDECIDED, checker
from exactfold.branches import count_branches
from exactfold.branches.counting import in_chart, multiple_roots
from exactfold.branches.values import classify
from exactfold.checker.branches import listing
from exactfold.pattern.degenerate import DEGENERATE
from exactfold.pattern.families import FAMILIES, hypar, two_vertex
from exactfold.rigidity import rigid_triangles
from exactfold.solve.algebraic import groebner_bases
from exactfold.solve.certify import algebraic


def test_undecided_without_a_stress_for_a_triangulated_triangle(monkeypatch):
    monkeypatch.setattr(rigid_triangles, "definite_stress", lambda pattern: None)
    for pattern in (scrambled(1, TRIANGLE, 2), two_triangles()):
        result = count_branches(pattern)
        assert result.status is UNDECIDED
        assert "no definite stress" in result.reason
        assert counts(result) == (None,) * 4


def test_undecided_without_a_proof_of_finiteness(monkeypatch):
    monkeypatch.setattr(algebraic, "definite_stress", lambda pattern: None)
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert "finiteness is not proved" in result.reason
    assert counts(result) == (None,) * 4


def test_undecided_where_a_multiplicity_is_too_small(monkeypatch):
    monkeypatch.setattr(algebraic, "flat_equations", lambda chart, root_class: ())
    result = count_branches(FAMILIES["flat-vertex"]())
    assert result.status is UNDECIDED
    assert counts(result) == (None,) * 4
    assert result.proof is None


def test_undecided_where_the_engine_finds_a_curve_of_solutions(monkeypatch):
    real = groebner_bases.groebner
    monkeypatch.setattr(
        groebner_bases, "groebner", lambda system: dataclasses.replace(real(system), dimension=None)
    )
    result = count_branches(two_vertex(), method="groebner")
    assert result.status is UNDECIDED
    assert "infinitely many" in result.reason


def test_undecided_where_signs_stay_open(monkeypatch):
    monkeypatch.setattr(classify.BoxRoot, "sign", lambda self, row: None)
    monkeypatch.setattr(multiple_roots, "recognise", lambda system, boxes: None)
    result = count_branches(two_vertex(), method="popping")
    assert result.status is UNDECIDED
    assert "all 4 solutions isolated, but signs are undecided on 4" in result.reason
    assert "vertex 4" in result.open_questions[0]
    assert result.branches == ()


@pytest.mark.parametrize(
    "name",
    [
        "cross",
        "straight-path",
        pytest.param("ring", marks=pytest.mark.survey),
        pytest.param("waterbomb-pair", marks=pytest.mark.slow),
    ],
)
def test_open_folds_cost_their_letters_and_not_the_count(monkeypatch, name):
    pattern = DEGENERATE[name]()
    known = count_branches(pattern)
    assert not known.undecided_folds
    monkeypatch.setattr(in_chart, "recognised", lambda chart, found, undecided: None)
    monkeypatch.setattr(classify, "flat_folds", lambda pattern, signs: frozenset())
    result = count_branches(pattern, method="popping")
    assert result.status is PROVED
    assert counts(result) == counts(known)
    assert result.true_branches is known.true_branches
    open_folds = result.undecided_folds
    assert open_folds
    assert result.repeated_assignments is None
    for fold in open_folds:
        assert any(f"{fold[0]}-{fold[1]}" in question for question in result.open_questions)
    shown = {(b.sign_text, b.assignment_text) for b in known.branches}
    for branch in result.branches:
        agreeing = [
            text
            for signs, text in shown
            if signs == branch.sign_text
            and all(a in (b, "U") for a, b in zip(branch.assignment_text, text, strict=True))
        ]
        assert agreeing
    document = json.loads(json.dumps(old_listing(result)))
    assert checker.check(document) == document["claims"]
    monkeypatch.setattr(listing, "close_flat", lambda sheet, signs: None)
    assert checker.check(document) == document["claims"]
    place = next(b for b in document["claims"]["branches"] if "U" in b["assignment"])
    for letter in "MVF?":
        forged = dict(place, assignment=place["assignment"].replace("U", letter, 1))
        branches = [forged if b is place else b for b in document["claims"]["branches"]]
        claims = dict(document["claims"], branches=branches)
        with pytest.raises(checker.CertificateError, match="not what is claimed"):
            checker.check(dict(document, claims=claims))
    monkeypatch.setattr(classify, "flat_folds", lambda pattern, signs: frozenset())
    assert not count_branches(pattern).undecided_folds  # "auto" asks the exact engine
    monkeypatch.setattr(algebraic, "definite_stress", lambda pattern: None)
    for method in ("auto", "groebner"):  # which cannot prove multiple roots, but simple ones
        result = count_branches(pattern, method=method)
        simple = known.distinct == known.with_multiplicity
        assert result.status is (PROVED if simple else UNDECIDED)
        assert bool(result.undecided_folds) == (result.status is PROVED)


@pytest.mark.survey
def test_largest_straight_hypar_is_proved_but_for_one_letter():
    """Vi = 12: the folds across the middle square are flat on some simple roots."""
    result = count_branches(hypar(3, 0))
    assert result.status is PROVED
    assert (result.with_multiplicity, result.nonreal) == (4096, 0)
    assert set(result.undecided_folds) <= {(13, 15)}
