"""Coordinates rounded while a FOLD file is read, before anything is checked."""

import json
from fractions import Fraction

import pytest
from fold_files import SQUARE, parse

from exactfold.errors import (
    DegenerateFaceError,
    FoldError,
    MalformedPatternError,
    OverlapError,
    UsageError,
)
from exactfold.pattern.families import collinear_folds
from exactfold.pattern.fold import parse_fold


def test_snapping_comes_before_validation_and_is_recorded():
    noisy = {
        "vertices_coords": [[0, 0], [0.5000000000000001, 0, 1e-17], [1, 0], [0.5, 1]],
        "faces_vertices": [[0, 1, 3], [1, 2, 3]],
    }
    with pytest.raises(FoldError, match="plane"):
        parse_fold(json.dumps(noisy))
    file = parse_fold(json.dumps(noisy), snap=1024)
    assert file.pattern.vertices[1] == (Fraction(1, 2), 0)
    assert file.snapped == Fraction(1, 10**16)


def test_snapping_makes_noisy_creases_straight_again():
    noisy = {
        "vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1], [0.24999999999999994, 0.25]],
        "faces_vertices": SQUARE["faces_vertices"],
    }
    assert collinear_folds(parse_fold(json.dumps(noisy)).pattern) == ()
    file = parse_fold(json.dumps(noisy), snap=64)
    assert collinear_folds(file.pattern) == ((0, 4, 2),)
    assert file.snapped == Fraction(1, 4) - Fraction("0.24999999999999994")


def test_what_is_checked_is_the_snapped_pattern():
    noisy = {
        "vertices_coords": [[0, 0], [1, 0], [1, 1], [0, 1], [-1e-16, 0.5]],
        "faces_vertices": [[0, 1, 4], [1, 2, 4], [2, 3, 4]],
    }
    assert parse_fold(json.dumps(noisy)).pattern.boundary_turns == (1, 1, 1, 1, 1)
    assert parse_fold(json.dumps(noisy), snap=10).pattern.boundary_turns == (1, 1, 1, 1, 0)
    noisy["faces_vertices"].append([0, 4, 3])
    with pytest.raises(OverlapError, match="clockwise"):
        parse_fold(json.dumps(noisy))
    with pytest.raises(DegenerateFaceError, match="face 3"):
        parse_fold(json.dumps(noisy), snap=10)
    noisy["vertices_coords"][4] = [1e-16, 1e-16]
    with pytest.raises(MalformedPatternError, match="vertices 0 and 4"):
        parse_fold(json.dumps(noisy), snap=10)


@pytest.mark.parametrize("drop", [("faces_vertices",), ("edges_vertices", "edges_assignment")])
def test_an_error_that_snapping_makes_mentions_it(drop):
    near = [[0, 0], [1, 0], [1, 1], [0, 1], [0.75, 0.625]]
    collapsed = r"vertices 2 and 4 .*, after coordinates were rounded to multiples of 1/1$"
    with pytest.raises(MalformedPatternError, match=collapsed) as caught:
        parse(*drop, vertices_coords=near, snap=1)
    assert caught.value.vertices == (2, 4)
    with pytest.raises(MalformedPatternError, match=collapsed) as caught:
        parse(*drop, vertices_coords=near).pattern.snapped(1)
    assert caught.value.vertices == (2, 4)


@pytest.mark.parametrize("snap", [None, 4])
def test_an_error_without_snapping_does_not_mention_it(snap):
    with pytest.raises(FoldError, match="sides") as caught:
        parse(faces_vertices=[[0, 1, 2, 3]], snap=snap)
    assert "rounded" not in str(caught.value)


def test_snapping_everything_in_place_moves_nothing():
    assert parse(snap=4).snapped == 0
    assert parse(snap=4).pattern == parse().pattern
    assert parse(snap=3).snapped == Fraction(1, 6)


def test_snap_usage_error():
    with pytest.raises(UsageError, match="multiples of 1/n"):
        parse(snap=0)
