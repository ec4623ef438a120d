"""The code of the checker against that of the package, which is another."""

import json
from fractions import Fraction

import pytest
from listed import EVIDENCE, SHEETS, checked_sheet, proof, sheets
from sheets import (
    DENTED,
    scrambled,
)

from exactfold import checker
from exactfold.branches import certificate, count_branches
from exactfold.checker.core import linear, polynomials, reading
from exactfold.checker.sheets import stress
from exactfold.errors import NotApplicableError
from exactfold.exact.linalg import inertia, nullspace
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import fold_functional

# --- every kind of evidence ----------------------------------------------------------------------


@sheets
def test_certificate_is_valid(name):
    document = proof(name)
    assert document["evidence"]["kind"] == EVIDENCE[name]
    assert checker.check(checker.load(json.dumps(document))) == document["claims"]


@sheets
def test_certificate_has_the_documented_keys_and_no_floats(name):
    document = proof(name)
    assert list(document) == ["format", "version", "pattern", "claims", "evidence", "provenance"]

    def check_no_float(value):
        assert not isinstance(value, float)
        for part in value.values() if isinstance(value, dict) else value:
            if isinstance(part, dict | list):
                check_no_float(part)
            else:
                assert not isinstance(part, float)

    check_no_float(document)


def test_no_certificate_of_an_undecided_count():
    result = count_branches(scrambled(1, DENTED, 2, loose=True))
    with pytest.raises(NotApplicableError, match="no certificate: the count is undecided"):
        certificate(result)


# --- its own code against the package ------------------------------------------------------------


@sheets
def test_sheet_agrees_with_the_pattern(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    assert tuple(sheet.boundary) == pattern.boundary
    assert tuple(sheet.interior) == pattern.interior
    assert tuple(sheet.folds) == pattern.folds
    assert tuple(sheet.edges) == pattern.edges
    assert {sheet.face(t) for t in sheet.triangles} == set(pattern.triangles)


@sheets
def test_curvature_agrees_with_the_package(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    for v in pattern.interior:
        form = curvature_form(pattern, v)
        assert linear.matrix_of(sheet.curvature(v), list(form.labels)) == [
            list(row) for row in form.matrix
        ]
        stress.check_lorentzian(sheet, v)


@sheets
def test_bends_agree_with_the_package(name):
    pattern = SHEETS[name]
    sheet = checked_sheet(pattern)
    for fold in pattern.folds:
        ours, theirs = fold_functional(pattern, fold), sheet.bend(fold)
        assert set(ours) == set(theirs)
        v = fold[0]
        factor = theirs[v] / ours[v] if ours[v] else theirs[fold[1]] / ours[fold[1]]
        assert factor > 0
        assert all(theirs[u] == factor * ours[u] for u in ours)


@pytest.mark.parametrize(
    "matrix",
    [
        [[0, 1, 0], [1, 0, 0], [0, 0, 0]],
        [[0, 1, 1], [1, 0, 1], [1, 1, 0]],
        [[2, 1], [1, 2]],
        [[-1, 0], [0, 0]],
        [[0, 0], [0, 0]],
    ],
)
def test_inertia_agrees_with_the_package(matrix):
    assert linear.inertia([[Fraction(x) for x in row] for row in matrix]) == inertia(matrix)


def test_kernel_agrees_with_the_package():
    rows = [
        [Fraction(x) for x in row] for row in ([0, 0, 2, 4, 1], [0, 3, 1, 0, 0], [0, 3, 3, 4, 1])
    ]
    assert linear.kernel(rows, 5) == nullspace(rows)
    assert linear.kernel([], 2) == [[1, 0], [0, 1]]


def test_long_integers_survive():
    for n in (0, -7, 10**4000, -(10**9001) + 3, 7**20000):
        assert reading.parse_integer(reading.digits(n)) == n


@pytest.mark.parametrize("text", ["", "-", "+1", "1 ", "1_0", "0x1", "--1", "\u0661", "1.0"])
def test_other_text_is_no_integer(text):
    with pytest.raises(checker.CertificateError):
        reading.parse_integer(text)


@pytest.mark.parametrize("text", ["1/0", "1/-2", "1/", "/2", "1/2/3", 1, None, 0.5, True])
def test_other_values_are_no_rational(text):
    with pytest.raises(checker.CertificateError):
        reading.parse_rational(text)


def test_real_roots_are_counted_by_sturm():
    def expanded(*roots):
        p = [Fraction(1)]
        for root in roots:
            p = polynomials.times(p, [Fraction(-root), Fraction(1)])
        return p

    assert polynomials.count_real_roots(expanded(1, -2, 3)) == 3
    assert polynomials.count_real_roots([Fraction(1), Fraction(0), Fraction(1)]) == 0
    mixed = polynomials.times(expanded(5), [Fraction(2), Fraction(1), Fraction(1)])
    assert polynomials.count_real_roots(mixed) == 1
    assert polynomials.are_coprime(expanded(1, 2), expanded(3))
    assert not polynomials.are_coprime(expanded(1, 2), expanded(2, 3))
