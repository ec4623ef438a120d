"""Branches are found by their own letters, and letters with one changed are refuted or others'."""

from __future__ import annotations

import random
from collections import Counter

import pytest

from exactfold import checker, random_square
from exactfold._support.verdict import PROVED
from exactfold.branches import find_branch
from exactfold.design import match, match_certificate
from exactfold.design.assignments.result import Match
from exactfold.errors import NotApplicableError

TURNED = {"M": "V", "V": "M"}


def outcome(found: Match) -> str:
    """What a match says of letters of which one was changed."""
    if found.status is not PROVED:
        return "undecided"
    return "corrected" if found.matches else "refuted"


def figures(n: int, seed: int, most: int | None = None) -> Counter[str]:
    """Of one random branch: whether its letters are found, and what becomes of changed ones.

    `most`: how many of its folds are changed, one after the other; by default all.
    """
    rng = random.Random(seed)
    branch = find_branch(random_square(n, seed=seed), "".join(rng.choice("+-") for _ in range(n)))
    assert branch.status is PROVED
    letters = branch.assignment
    own = match(branch.pattern, letters)
    if own.status is PROVED:
        assert (branch.sign_text, 1) in {half.names for half in own.matches}
    counts = Counter({f"own letters {own.status}": 1, "leaves": own.leaves})
    folds = [fold for fold in branch.pattern.folds if letters[fold] in TURNED]
    counts["letters not proved"] = len(letters) - len(folds)  # "U", which is free
    for fold in folds if most is None else rng.sample(folds, min(most, len(folds))):
        found = match(branch.pattern, letters | {fold: TURNED[letters[fold]]})
        for half in found.matches:
            assert half.assignment[fold] != letters[fold]
        counts[outcome(found)] += 1
    return counts


def test_own_letters_and_each_with_one_changed() -> None:
    counts = figures(8, 1)
    assert counts["own letters proved"] == 1
    assert counts["refuted"] + counts["corrected"] == 25
    assert counts["refuted"] > 0


@pytest.mark.slow
def test_both_outcomes_occur_and_both_have_certificates() -> None:
    pattern, seen = random_square(20, seed=2), set()
    branch = find_branch(pattern, "+-" * 10)
    for fold in pattern.folds:
        letters = branch.assignment | {fold: TURNED[branch.assignment[fold]]}
        found = match(pattern, letters)
        if outcome(found) in seen:
            continue
        seen.add(outcome(found))
        claims = checker.check(match_certificate(found))
        assert len(claims["halves"]) == len(found.matches)
    assert seen >= {"refuted"}


def test_what_is_undecided_has_no_certificate() -> None:
    with pytest.raises(NotApplicableError, match="this match is undecided"):
        match_certificate(match(random_square(3, seed=4), {}, most=2))


@pytest.mark.survey
@pytest.mark.parametrize("n", [8, 20, 50, 100])
def test_survey_of_random_squares(n: int) -> None:
    total: Counter[str] = Counter()
    for seed in range(200):
        total += figures(n, seed)
    print(n, dict(total))  # for whoever runs it
    assert total["own letters proved"] == 200
    assert total["refuted"] + total["corrected"] + total["undecided"] > 0
