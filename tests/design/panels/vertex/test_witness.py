"""Motions of one vertex with given letters, made exactly, against the theorem and the checker."""

import random
from itertools import product

import pytest
from panel_letters import around, random_directions, star_of

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.checker import check
from exactfold.checker.core.towers import Tower
from exactfold.checker.letters.vertices import can_fold
from exactfold.design import match_certificate, match_panels
from exactfold.design.panels.vertex.reasons import vertex_reason
from exactfold.design.panels.vertex.witness import vertex_witness
from exactfold.exact.surds import sign
from exactfold.panels.vertex.vertex_motions import Fan

SIDES = {"M": -1, "V": 1}


@pytest.mark.parametrize(
    ("count", "choice", "seed"), [(4, "MVU", 1), (5, "MVU", 2), (5, "MVU", 6), (6, "MV", 3)]
)
def test_a_vertex_has_a_motion_exactly_if_the_theorem_says_so(count, choice, seed):
    rng, tower = random.Random(seed), Tower()
    star = star_of(random_directions(rng, count))
    fan = Fan(star)
    drawn = [(tower.number(x), tower.number(y)) for x, y in star.directions]
    answers = set()
    for text in product(choice, repeat=count):
        if not {"M", "V"} & set(text):
            continue
        letters = dict(zip(star.folds, text, strict=True))
        motion = vertex_witness(star, letters)
        assert fan.folds(text) == (motion is not None) == can_fold(drawn, "".join(text))
        reason = vertex_reason(star, letters)
        assert reason is None or motion is None
        answers.add((motion is None, reason is None))
        if motion is None:
            continue
        w = [motion[fold] for fold in star.folds]
        pairs = list(zip(w, star.directions, strict=True))
        assert [sum(x * d[axis] for x, d in pairs) for axis in (0, 1)] == [0, 0]
        assert star.form(w) == 0
        assert all(sign(x) == SIDES.get(letters[f], sign(x)) for f, x in motion.items())
    assert answers >= {(False, True), (True, False)}


def test_a_free_fold_that_would_have_to_do_two_things_is_refuted():
    """Either the free fold is a mountain, and all are; or the mountains lie in a half-plane."""
    found = match_panels(around([(-2, -1), (1, -1), (2, 1), (1, 1), (-1, 1)]), "MUMMM")
    assert (found.starts, found.truly, found.refutations) == (REFUTED, REFUTED, ())
    assert found.reason == "vertex 0 cannot have its letters, whatever its free folds do"
    assert check(match_certificate(found))["truly"] == "refuted"


def test_a_straight_crease_bends_alone():
    directions = [(1, 0), (1, 2), (-1, 1), (-2, 0), (-1, -3), (2, -1)]
    motion = vertex_witness(star_of(directions), {(0, 1): "M"})
    assert [x for x in motion.values() if x] == [-1, -0.5]
    found = match_panels(around(directions), "VUUVUU")
    assert (found.starts, found.truly) == (PROVED, PROVED)


def test_letters_that_no_motion_has_are_refuted_for_true_motions():
    found = match_panels(around([(2, 1), (1, 2), (-1, 1), (-1, -1), (1, -2)]), "MMVVV")
    assert found.starts is found.truly is REFUTED
    assert check(match_certificate(found))["truly"] == "refuted"
