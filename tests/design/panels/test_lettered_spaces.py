"""Motions with given letters in linear spaces, against the list of all spaces."""

import random
from itertools import product

import pytest
from panel_letters import HEXAGON, crane_base, star_of

from exactfold import checker
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.design import match_certificate, match_panels
from exactfold.design.panels.lettered_spaces import LetteredSpaces, truly_begin
from exactfold.design.panels.vertex.reasons import vertex_reason
from exactfold.exact.surds import sign
from exactfold.motion.panels.listing import panel_ways
from exactfold.panels import decompose
from exactfold.panels.vertex.stars import stars


@pytest.fixture(scope="module")
def crane():
    sheet = crane_base()
    result = decompose(sheet)
    assert dict(result.second_order) == {1: 17}
    lines = [
        {fold: side * sign(row[0]) for fold, row in leaf.rows.items()}
        for leaf in result.parts[0].spaces
        for side in (1, -1)
    ]
    return sheet, stars(sheet), lines


def has(line, letters, least):
    """Whether a motion on a line, given by its signs, bends each fold the way of its letter."""
    sides = {"M": -1, "V": 1}
    return all(line.get(f, 0) * sides[x] >= least for f, x in letters.items() if x in sides)


def is_motion(moving, motion):
    for star in moving.values():
        w = [motion.get(fold, 0) for fold in star.folds]
        sums = [
            sum(x * d[axis] for x, d in zip(w, star.directions, strict=True)) for axis in (0, 1)
        ]
        if sums != [0, 0] or star.form(w) != 0:
            return False
    return True


@pytest.mark.slow
def test_each_line_of_the_list_is_found_by_its_letters(crane):
    sheet, moving, lines = crane
    for line in lines:
        letters = {f: "FVM"[line.get(f, 0)] if line.get(f, 0) else "U" for f in sheet.folds}
        verdict, motion = LetteredSpaces(moving, letters).motion()
        assert verdict is PROVED
        assert is_motion(moving, motion)
        assert truly_begin(sheet, moving, motion)
        assert all(sign(motion.get(f, 0)) == side for f, side in line.items())


def test_each_line_of_the_list_is_a_way_with_a_number(crane):
    """Sixteen lines bend the same folds: a list that told them apart by folds had only seven."""
    sheet, _, lines = crane
    ways = panel_ways(decompose(sheet))
    assert len(ways) == 17
    drawn = {tuple(sorted(line.items())) for line in lines}
    listed = {
        tuple(sorted((fold, {"V": 1, "M": -1}[x]) for fold, x in way.letters.items()))
        for way in ways
    }
    assert len(listed) == 17
    assert listed <= {tuple((f, s) for f, s in line if s) for line in drawn}


@pytest.mark.slow
def test_random_letters_are_found_or_refuted_as_the_list_says(crane):
    sheet, moving, lines = crane
    rng, answers = random.Random(29), set()
    for _ in range(40):
        line = rng.choice(lines)
        letters = {f: "MUV"[line.get(f, 0) + 1] for f in sheet.folds}
        for fold in rng.sample(sheet.folds, rng.choice((1, 2, 9, 12))):
            letters[fold] = rng.choice("UUMV")
        strict = any(has(x, letters, 1) for x in lines)
        weak = any(has(x, letters, 0) for x in lines)
        found = LetteredSpaces(moving, letters)
        assert found.motion()[0] is (PROVED if strict else REFUTED)
        assert found.moves_weakly() == weak
        answers.add((strict, weak))
    assert answers == {(True, True), (False, True), (False, False)}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("letters", "truly"), [("VVMVVVMMMMVVVVVV", REFUTED), ("VMVVVVMMMMMMVMVV", UNDECIDED)]
)
def test_match_refutes_by_the_complete_list(crane, letters, truly):
    """The second letters agree with the straight crease, which folds with all others flat."""
    sheet, _, lines = crane
    wanted = dict(zip(sheet.folds, letters, strict=True))
    assert not any(has(line, wanted, 1) for line in lines)
    found = match_panels(sheet, letters)
    assert (found.starts, found.truly) == (REFUTED, truly)
    said = "the list of its motions to second order is complete, and none has these letters"
    claims = checker.check(match_certificate(found))
    assert (claims["starts"], claims["truly"]) == ("refuted", str(truly))
    assert found.reason == f"the part of 5 vertices with vertex 2: {said}"


@pytest.mark.parametrize("directions", [HEXAGON, ((3, 1), (1, 4), (-3, 1), (-2, -3), (2, -3))])
def test_one_form_that_is_left_vanishes_between_two_points(directions):
    star = star_of(directions)
    answers = set()
    for letters in product("MV", repeat=len(star.folds)):
        wanted = dict(zip(star.folds, letters, strict=True))
        verdict, motion = LetteredSpaces({0: star}, wanted).motion()
        assert (verdict is PROVED) == (vertex_reason(star, wanted) is None)
        assert is_motion({0: star}, motion)
        assert all((sign(x) > 0) == (wanted[f] == "V") for f, x in motion.items())
        answers.add(verdict)
    assert PROVED in answers
    assert REFUTED in answers
