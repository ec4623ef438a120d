"""Least forcing sets, against all sets of folds tried one by one."""

import random
from itertools import combinations

import pytest

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.design import all_assignments, forcing_set, panel_assignments
from exactfold.design.refutations.forcing import forcing_folds, least_of_all, min_hitting
from exactfold.errors import NotApplicableError, UsageError
from exactfold.pattern.families import single_vertex


def forces(places, text, others):
    return not any(all(other[k] == text[k] for k in places) for other in others if other != text)


def least(text, others):
    """The size of a least forcing set."""
    sizes = range(len(text) + 1)
    return next(
        size
        for size in sizes
        if any(forces(places, text, others) for places in combinations(range(len(text)), size))
    )


@pytest.mark.parametrize("seed", range(6))
def test_forcing_sets_of_random_lists_are_least(seed):
    rng = random.Random(seed)
    texts = sorted({"".join(rng.choice("MV") for _ in range(7)) for _ in range(4 + 4 * seed)})
    for text in texts:
        places, lower = forcing_folds(text, texts)
        assert forces(places, text, texts)
        assert len(places) == lower == least(text, texts)
    text, places, lower = least_of_all(texts)
    assert len(places) == lower == min(least(t, texts) for t in texts if t[0] == "V")
    assert forces(places, text, texts)


def test_undecided_assignments_are_avoided():
    places, lower = forcing_folds("VVV", ["VVV", "MMM"], ["VMM", "MVM", "MMV"])
    assert (len(places), lower) == (2, 1)
    assert forces(places, "VVV", ["MMM", "VMM", "MVM", "MMV"])


def test_the_forcing_set_of_a_sheet_is_that_of_its_list():
    listed = panel_assignments("square-twist")
    (part,) = listed.parts
    found = forcing_set(listed, part.assignments[0])
    assert found.status is PROVED
    assert len(found.folds) == found.at_least == least(part.assignments[0], part.assignments)
    assert "".join(found.letters.values()) == part.assignments[0]
    best = forcing_set(listed)
    assert len(best.folds) == min(least(text, part.assignments) for text in part.assignments)


def test_parts_add_up_and_free_folds_are_in_every_forcing_set():
    listed = panel_assignments("fish-base")
    found = forcing_set(listed)
    assert set(listed.free) <= set(found.folds)
    assert len(found.folds) == 5


def test_a_sheet_with_five_corners_has_forcing_sets():
    listed = all_assignments(single_vertex(5))
    found = forcing_set(listed, listed.assignments[3])
    assert len(found.folds) == least(listed.assignments[3], listed.assignments)
    assert listed.to_dict(forcing=found)["forcing"]["status"] == "proved"


def test_letters_that_do_not_fold_have_no_forcing_set():
    listed = panel_assignments("square-twist")
    with pytest.raises(NotApplicableError, match="not among the assignments"):
        forcing_set(listed, "M" * 12)
    with pytest.raises(UsageError):
        forcing_set(listed, "M")
    with pytest.raises(NotApplicableError, match="no assignment"):
        forcing_set(panel_assignments("map-fold"))
    with pytest.raises(NotApplicableError, match="21 folds"):
        min_hitting([1], 21)
    with pytest.raises(NotApplicableError, match="give one of them"):
        least_of_all([f"V{k:019b}".replace("0", "V").replace("1", "M") for k in range(1100)])


def test_a_set_that_may_be_too_large_is_undecided():
    listed = panel_assignments("square-twist")
    found = forcing_set(listed)
    assert type(found)(found.letters, found.folds, 1).status is UNDECIDED
