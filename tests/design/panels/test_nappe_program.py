"""Letters refuted by the nappes of several vertices, against samples, with certificates."""

import json

import numpy as np
import pytest

from exactfold._support.verdict import REFUTED
from exactfold.checker import check, load
from exactfold.design import match_certificate, match_panels
from exactfold.design.panels.block_letters import BlockLetters
from exactfold.design.panels.nappe_program import NappeCases, _cone
from exactfold.design.panels.refutation import PanelRefutation, in_nappe
from exactfold.design.refutations.asked import by_fold
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.vertex.stars import stars
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import PanelPattern

POINTS = [(0, 0), (4, 0), (2, 3), (-3, -2), (2, -3), (7, -2), (6, 3), (2, 7), (-2, 4)]
SPOKES = "01 02 12 03 04 14 15 16 26 27 28 08"
TRIANGLE = PanelPattern(
    POINTS, [(int(i), int(j)) for i, j in f"{SPOKES} 34 45 56 67 78 38".split()]
)
"""Three vertices, each joined to both others."""


@pytest.mark.parametrize("letters", ["MMMVVVVMMVVV", "MMMMVVVMMVMV", "MVVVMMVMMMVM"])
def test_letters_that_each_vertex_has_are_refuted_together(letters):
    moving, wanted = stars(TRIANGLE), by_fold(TRIANGLE.folds, letters)
    assert all(Fan(s).folds([wanted[f] for f in s.folds]) for s in moving.values())
    found = match_panels(TRIANGLE, letters)
    assert (found.starts, found.truly) == (REFUTED, REFUTED)
    assert "in each nappe of the forms of these vertices" in found.reason
    assert len(found.refutations) > 1
    assert all(r.holds(TRIANGLE, wanted) for r in found.refutations)
    claims = check(load(json.dumps(match_certificate(found))))
    assert (claims["starts"], claims["truly"]) == ("refuted", "refuted")
    refutation = found.refutations[0]
    turned = PanelRefutation(
        refutation.planes, {v: -s for v, s in refutation.signs.items()}, refutation.heights
    )
    assert not turned.holds(TRIANGLE, wanted)
    free = wanted | {(0, 1): "U", (0, 2): "U", (1, 2): "U"}
    cases = NappeCases(moving, free)
    assert cases.refute() == (letters != "MMMMVVVMMVMV")
    assert all(r.holds(TRIANGLE, free) for r in cases.refutations)


def test_no_letters_of_a_sampled_motion_are_refuted():
    moving = stars(TRIANGLE)
    rows, _ = first_order(moving)
    sampled = list(_letters_of_samples(rows, moving))
    assert len(sampled) > 20
    for letters in sampled:
        assert not NappeCases(moving, letters).refute()


def _letters_of_samples(rows, moving):
    block = object.__new__(BlockLetters)
    block.stars, block.folds, block.answers = moving, sorted(rows), {}
    block.clock = type("Open", (), {"passed": False})
    for number, text in enumerate(block._sampled(rows)):
        if number == 40:
            return
        yield dict(zip(block.folds, text, strict=True))


def test_the_cone_of_a_star_is_its_up_nappe():

    random = np.random.default_rng(1)
    star = stars(TRIANGLE)[0]
    cone, inside = _cone(star), 0
    for _ in range(300):
        z = [int(x) for x in random.integers(-9, 9, len(star.folds))]
        first, *others = cone @ np.array(z, dtype=float)
        if abs(first - np.linalg.norm(others)) > 1e-6:
            up = first > np.linalg.norm(others)
            assert up == in_nappe(star, 1, z)
            inside += up
    assert 10 < inside < 290
