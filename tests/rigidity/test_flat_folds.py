"""Folds deduced to be flat: everything deduced is true, and crosses are decided."""

from fractions import Fraction
from itertools import product

import pytest
from sheets import dart, random_wheel, wheel, with_point

from exactfold import random_square
from exactfold.branches import count_branches
from exactfold.checker.sheets.flat_folds import close_flat
from exactfold.checker.sheets.sheet import Sheet
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import flat_vertex_square, hypar, single_vertex, two_vertex
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.flat_folds import flat_folds
from exactfold.rigidity.functionals import fold_functional

CROSS = wheel([(2, 0), (0, 3), (-2, 0), (0, -1)])
SPOKES = [(0, 4), (1, 4), (2, 4), (3, 4)]


def test_cross_folds_along_one_line_at_a_time():
    assert flat_folds(CROSS, dict(zip(SPOKES, (1, None, 1, None), strict=True))) == {(1, 4), (3, 4)}
    assert flat_folds(CROSS, dict(zip(SPOKES, (None, -1, None, None), strict=True))) == {
        (0, 4),
        (2, 4),
    }


def test_cross_without_a_known_fold_is_open():
    assert flat_folds(CROSS, dict.fromkeys(SPOKES)) == frozenset()


def test_cross_with_one_line_flat_says_nothing_of_the_other():
    """With both folds of one line known flat the other may bend or not: the form vanishes."""
    known = dict(zip(SPOKES, (0, None, 0, None), strict=True))
    assert flat_folds(CROSS, known) == {(0, 4), (2, 4)}


def test_flat_fold_beside_a_straight_crease_makes_the_folds_across_flat():
    """Two folds on one side of a line, one flat fold on the other: the form is minus a square."""
    pattern = wheel([(2, 0), (1, 2), (-1, 3), (-2, 0), (0, -2)])
    known = dict.fromkeys(pattern.folds) | {(4, 5): 0}
    assert flat_folds(pattern, known) == {(1, 5), (2, 5), (4, 5)}


@pytest.mark.parametrize("spokes", [4, pytest.param(5, marks=pytest.mark.slow)])
def test_the_checker_deduces_as_much(spokes):
    """By code of its own, on wheels of small integers, where creases are often collinear."""
    deduced = 0
    for seed in range(8):
        pattern = random_wheel(seed, spokes, reach=2)
        sheet = Sheet(dict(enumerate(pattern.vertices)), pattern.triangles)
        for values in product((None, 1), repeat=spokes - 1):
            for flat in range(spokes):
                signs = dict(zip(pattern.folds, (*values[:flat], 0, *values[flat:]), strict=True))
                found = flat_folds(pattern, signs)
                close_flat(sheet, signs)
                assert {fold for fold, sign in signs.items() if sign == 0} == found
                deduced += len(found) > 1
    assert deduced > 100


def test_three_flat_folds_at_a_vertex_make_the_fourth_flat():
    pattern = single_vertex(4)
    assert flat_folds(pattern, dict(zip(SPOKES, (0, 0, 0, None), strict=True))) == set(SPOKES)


def test_one_flat_fold_of_a_generic_vertex_makes_all_flat():
    # Off a cross no fold can be flat alone: the remaining bends form a definite line.
    pattern = single_vertex(4)
    assert flat_folds(pattern, dict(zip(SPOKES, (0, None, None, None), strict=True))) == set(SPOKES)


def test_signs_that_exclude_nothing_leave_everything_open():
    pattern = single_vertex(6)
    folds = dict.fromkeys(pattern.folds)
    assert flat_folds(pattern, folds) == frozenset()
    assert flat_folds(pattern, folds | {(0, 6): 1}) == frozenset()


def test_a_vertex_of_degree_three_is_flat():
    pattern = with_point(two_vertex(), 1, (1, 1, 1))
    spokes = {fold for fold in pattern.folds if 6 in fold}
    assert len(spokes) == 3
    known = dict.fromkeys(pattern.folds, 1) | dict.fromkeys(spokes)
    assert flat_folds(pattern, known) == spokes


def test_deductions_spread_from_vertex_to_vertex():
    """Along a fold that is flat at one end the knowledge reaches the other."""
    pattern = two_vertex()
    known = dict.fromkeys(pattern.folds) | {(0, 4): 0}
    assert flat_folds(pattern, known) == set(pattern.folds)


def test_known_folds_are_kept_as_they_are():
    signs = dict.fromkeys(two_vertex().folds, -1)
    assert flat_folds(two_vertex(), signs) == frozenset()
    assert flat_folds(two_vertex(), signs | {(0, 4): 0}) == {(0, 4)}


@pytest.mark.parametrize(
    "pattern",
    [flat_vertex_square(), hypar(1, twist=0), two_vertex(), dart(), random_square(3, seed=4)],
)
def test_what_is_deduced_holds_on_every_branch(pattern):
    """Hide the signs of a branch's folds in turn: no fold that bends is ever called flat."""
    for branch in count_branches(pattern).branches:
        right = {fold: {"M": -1, "V": 1, "F": 0}[x] for fold, x in branch.assignment.items()}
        truly = {fold for fold, sign in right.items() if sign == 0}
        for step in (2, 3):
            for start in range(step):
                hidden = pattern.folds[start::step]
                assert flat_folds(pattern, right | dict.fromkeys(hidden)) <= truly
        assert flat_folds(pattern, dict.fromkeys(pattern.folds)) <= truly


@pytest.mark.parametrize("seed", range(5))
def test_bends_of_a_star_determine_it_up_to_a_plane(seed):
    """The ground of every deduction: no bend at a vertex, no curvature, and conversely flat."""
    pattern = random_wheel(seed, 6)
    bends = [fold_functional(pattern, (j, 6)) for j in range(6)]
    plane = {v: 2 * x - 3 * y + 1 for v, (x, y) in enumerate(pattern.vertices)}
    assert all(sum(c * plane[v] for v, c in bend.items()) == 0 for bend in bends)
    assert curvature_form(pattern, 6)(plane) == 0
    raised = plane | {2: plane[2] + Fraction(1, 10**9)}
    assert any(sum(c * raised[v] for v, c in bend.items()) != 0 for bend in bends)


def test_hypar_proper_has_a_branch_along_its_diagonal():
    pattern = hypar(1, twist=0)
    flat = [
        {fold for fold, letter in branch.assignment.items() if letter == "F"}
        for branch in count_branches(pattern).branches
    ]
    most = max(flat, key=len)
    bent = set(pattern.folds) - most
    points = {pattern.vertices[v] for fold in bent for v in fold}
    assert len({x - y for x, y in points}) == 1 or len({x + y for x, y in points}) == 1


def test_pattern_with_a_chord_only():
    pattern = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)])
    assert flat_folds(pattern, {(0, 2): None}) == frozenset()
