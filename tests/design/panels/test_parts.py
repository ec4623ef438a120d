"""The answer for one part: letterings that the search from a single point does not find."""

import random

import pytest
from panel_letters import HEXAGON, around, crane_base, random_directions, random_letters
from sampling import slow_after

from exactfold._support.verdict import PROVED, REFUTED
from exactfold.checker import check
from exactfold.design import match_certificate, match_panels
from exactfold.design.panels.first_order_program import FirstOrderProgram
from exactfold.design.panels.parts import _found
from exactfold.panels.vertex.stars import stars
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import PanelPattern

HARD = [
    (HEXAGON, "MVMVMV"),
    (HEXAGON, "MVVMVV"),
    (((-1, -1), (0, -1), (1, 0), (1, 2), (0, 1), (-1, 1)), "VVMVVM"),
    (((1, -8), (2, -6), (9, -4), (1, 2), (1, 4), (-8, 1), (-9, 1)), "MVVMMMV"),
    (((-5, -5), (6, -8), (8, 5), (6, 5), (-4, 0)), "MVMVV"),
    (((-8, -7), (2, -5), (6, -7), (8, 0), (5, 1), (-6, 2)), "VMVMVM"),
    (((-7, -3), (1, -6), (1, -4), (3, -5), (8, -3), (0, 3), (-5, 7), (-8, 6)), "MMVVMVVM"),
]
"""Letterings that fold and that the search from one point misses."""


@pytest.mark.parametrize(("directions", "letters"), slow_after(3, HARD))
def test_letters_that_need_several_starts_are_found(directions, letters):
    sheet = around(directions)
    program = FirstOrderProgram(stars(sheet), dict(zip(sheet.folds, letters, strict=True)))
    found = _found(program, program.motion())
    assert found.folds
    assert all((x > 0) == (program.letters[fold] == "V") for fold, x in found.densities.items())


def test_random_letters_of_a_vertex_that_fold_are_found():
    """`tests/benchmarks/random_letters.py` asks the same of 666."""
    rng = random.Random(3)
    for _ in range(60):
        directions = random_directions(rng, rng.choice((5, 6, 7, 8)))
        found = match_panels(around(directions), random_letters(rng, directions))
        assert (found.starts, found.truly) == (PROVED, PROVED)
        assert check(match_certificate(found))["truly"] == "proved"


def test_two_vertices_joined_by_one_fold_have_their_letters_one_by_one():
    points = [(0, 0), (4, 0), (6, 1), (4, 4), (0, 4), (-3, 1), (-3, -2), (1, -4), (6, -3)]
    spokes = [(0, 1), (0, 3), (0, 4), (0, 5), (0, 6), (0, 7), (1, 2), (1, 3), (1, 7), (1, 8)]
    rim = [(2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 8), (2, 8)]
    sheet = PanelPattern(points, spokes + rim)
    fans, rng, answers = {v: (s, Fan(s)) for v, s in stars(sheet).items()}, random.Random(2), []
    for _ in range(48):
        letters = {fold: rng.choice("MV") for fold in sheet.folds}
        able = all(fan.folds([letters[f] for f in star.folds]) for star, fan in fans.values())
        found = match_panels(sheet, letters)
        assert found.starts is found.truly is (PROVED if able else REFUTED)
        assert check(match_certificate(found))["truly"] == str(found.truly)
        assert found.assignment == (letters if able else {})
        answers.append(able)
    assert 12 < sum(answers) < 36


def test_the_letters_of_a_bird_base_with_seventeen_ways_are_found():
    found = match_panels(crane_base(), "MMVMMVMMMMMMMMVV")
    assert (found.starts, found.truly) == (PROVED, PROVED)
    assert check(match_certificate(found))["truly"] == "proved"
