"""Certificates of flat-folded states: what is found is verified, by the checker's own way."""

from __future__ import annotations

import json
from fractions import Fraction

import pytest
from flat_sheets import fan, folded_map, strip

from exactfold import checker, flat
from exactfold.errors import NotApplicableError, SolverError
from exactfold.layers import certificate as writing
from exactfold.layers.certificate import states_certificate
from exactfold.layers.proofs import Prover
from exactfold.pattern.panel_pattern import PanelPattern


def verified(found):
    return checker.check(checker.load(json.dumps(states_certificate(found))))


@pytest.mark.parametrize(
    ("sheet", "letters"),
    [
        (folded_map(1, 6), "any"),
        (folded_map(2, 3), "any"),
        (strip(4, 2, 3, 1, 2), "UUFU"),
        (strip(4, 2, 3, 1, 2), "VMUU"),
        (fan((4, 0), (4, 4), (-4, 0), (4, -4)), "any"),
        ("waterbomb", "any"),
        ("square-twist", "any"),
        ("miura", "drawn"),
        ("fish-base", "drawn"),
    ],
    ids=str,
)
def test_the_number_of_states_is_verified(sheet, letters):
    found = flat(sheet, letters)
    claims = verified(found)
    assert claims["states"] == found.count > 0
    assert claims["components"] == [component.count for component in found.components]


def test_that_there_is_no_state_is_verified():
    for sheet, letters, reason in (
        ("square-twist", "drawn", "layers"),
        ("zigzags", "drawn", "kawasaki"),
        (folded_map(2, 2), "VVVV", "maekawa"),
        (strip(3, 1, 2, 1), "VVV", "layers"),
    ):
        found = flat(sheet, letters)
        claims = verified(found)
        assert claims["reason"] == reason
        assert found.count == 0


def test_one_state_is_verified_where_there_are_too_many(monkeypatch):
    found = flat(folded_map(2, 3), "any", most=5)
    assert found.count == 60
    claims = verified(found)
    assert claims["pairs"] == len(found.pairs)
    monkeypatch.setattr(writing, "MOST_PAIRS", 0)
    drawn = flat("bird-base")
    claims = verified(drawn)
    assert claims["assignment"] == claims["letters"] == "".join(drawn.letters.values())


@pytest.mark.slow
def test_all_states_of_a_square_map():
    """A001418: three by three."""
    claims = verified(flat(folded_map(3, 3), "any", most=2000))
    assert claims["states"] == 1368


@pytest.mark.parametrize(
    ("start", "width"), [(10**12, Fraction(1, 10**6)), (1, Fraction(1, 10**18))]
)
def test_places_are_found_where_floats_are_too_coarse(start, width):
    points = [(start + x * width, start + y * width) for x in range(5) for y in (0, 1)]
    edges = [(2 * k, 2 * k + 1) for k in range(5)] + [(k, k + 2) for k in range(8)]
    found = flat(PanelPattern(points, edges))
    assert verified(found)["states"] == found.count == 16


def test_what_is_not_decided_has_no_certificate():
    found = flat("bird-base", "any", limit=0)
    with pytest.raises(NotApplicableError, match="nothing is decided"):
        states_certificate(found)


def test_what_can_be_fulfilled_is_not_refuted():
    prover = Prover(2)
    prover.add((1, 2))
    with pytest.raises(SolverError):
        prover.refute([1, 2])


def test_clauses_of_pigeons():
    """Four pigeons in three holes, which takes more than unit propagation."""
    place = {(p, h): 3 * p + h + 1 for p in range(4) for h in range(3)}
    prover = Prover(12)
    for p in range(4):
        prover.add(tuple(place[p, h] for h in range(3)))
    for h in range(3):
        for p in range(4):
            for q in range(p):
                prover.add((-place[p, h], -place[q, h]))
    prover.refute(range(1, 13))
    known = set()
    for number, clause in enumerate(prover.clauses):
        if number in prover.hints:
            true = {-x for x in clause} | known
            left = None
            for hint in prover.hints[number]:
                left = [x for x in prover.clauses[hint] if -x not in true]
                assert len(left) <= 1
                true.update(left)
            assert left == []
        if len(clause) == 1:
            known.add(clause[0])
    assert prover.clauses[-1] == ()
