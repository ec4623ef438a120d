"""Vertices that are moved: what is claimed of the new sheet, against exact answers about it."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from sampling import slow_after
from shown import both, near_miss

import exactfold
from exactfold._support.clock import Clock
from exactfold.branches import count_branches, find_branch
from exactfold.design import actuate, designed, match
from exactfold.design.moving import search, stroke
from exactfold.design.moving.ascent import raised
from exactfold.design.moving.distances import face_distances, fold_distances
from exactfold.design.tolerance.parts import branch_part
from exactfold.errors import NotCountedError, UndecidedBranchError, UsageError
from exactfold.pattern.families import single_vertex, two_vertex


@pytest.mark.parametrize("seed", slow_after(2, range(8)))
def test_a_near_miss_is_repaired(seed):
    pattern, letters = near_miss(seed, 3)
    assert not match(pattern, letters).matches
    found = designed(pattern, letters)
    assert found.status is exactfold.PROVED
    assert found.before < 0 < found.after
    assert found.pattern.triangles == pattern.triangles
    branch = find_branch(found.pattern, found.signs)
    wanted = "".join(letters[fold] for fold in sorted(letters))
    assert wanted in both(branch)
    for v, (x, y) in enumerate(found.pattern.vertices):
        before = pattern.vertices[v]
        assert max(abs(x - before[0]), abs(y - before[1])) < Fraction(101, 1000)
        assert v in pattern.interior or (x, y) == before
        assert x.denominator < 10**9


def test_the_tolerance_of_all_ways_is_raised():
    pattern = two_vertex()
    found = designed(pattern, maximise="tolerance")
    assert found.status is exactfold.PROVED
    assert found.before == exactfold.tolerance(pattern).radius
    assert found.after == exactfold.tolerance(found.pattern).radius > found.before


def test_the_tolerance_of_one_way_is_raised():
    pattern = exactfold.random_square(3, seed=1)
    of_one = designed(pattern, branch=count_branches(pattern)[1], maximise="tolerance")
    assert of_one.after == exactfold.tolerance(of_one.pattern, of_one.signs).radius > of_one.before


@pytest.mark.slow
def test_a_stroke_is_raised(monkeypatch):
    """Against the first contacts that are proved of both sheets, with the same face held."""
    monkeypatch.setattr(stroke, "_TRIALS", 10)
    pattern = two_vertex()
    branch = find_branch(pattern, "--")
    found = designed(pattern, branch=branch, maximise="stroke")
    assert found.status is exactfold.PROVED
    held = exactfold.follow(branch, frames=2).pinned
    for sheet, value in ((pattern, found.before), (found.pattern, found.after)):
        motion = exactfold.follow(sheet, signs="--", frames=2, held=held)
        assert motion.duration == pytest.approx(value, abs=1e-4)
        [contact] = [e for e in exactfold.prove(motion).motion.events if e.kind == "contact"]
        assert contact.time[0] == pytest.approx(value, abs=1e-5)
    assert found.after > 1.05 * found.before
    assert find_branch(found.pattern, "--").assignment == branch.assignment


def test_a_stroke_that_is_interrupted_keeps_the_best_sheet(monkeypatch):
    tried = []

    def told(stage, done, total):
        tried.append(stage)
        if done == 3:
            raise KeyboardInterrupt

    branch = find_branch(two_vertex(), "--")
    found = designed(two_vertex(), branch=branch, maximise="stroke", progress=told)
    assert found.interrupted
    assert found.after >= found.before > 2.5
    assert tried[-1].startswith("stroke, at most ")


def test_a_margin_is_raised():
    pattern = exactfold.random_square(3, seed=1)
    branch = count_branches(pattern)[2]
    found = designed(pattern, branch=branch, maximise="margin")
    before, after = (actuate(sheet, branch.sign_text) for sheet in (pattern, found.pattern))
    assert found.status is exactfold.PROVED
    assert found.before == pytest.approx(float(before.margin[0]), rel=1e-9)
    assert found.after == pytest.approx(float(after.margin[0]), rel=1e-9)
    assert found.after > found.before
    assert after.branch.assignment == before.branch.assignment


def test_letters_and_then_a_tolerance():
    pattern, letters = near_miss(0, 3)
    first = designed(pattern, letters)
    found = designed(pattern, letters, maximise="tolerance")
    assert (found.goal, found.status) == ("tolerance", exactfold.PROVED)
    assert found.original == pattern
    assert found.after > exactfold.tolerance(first.pattern, first.signs).radius
    assert match(found.pattern, letters).matches


def test_vertices_that_are_fixed_stay_and_a_small_box_is_kept():
    pattern = exactfold.random_square(3, seed=1)
    found = designed(pattern, maximise="tolerance", fixed=[4], within=Fraction(1, 100))
    moved = [v for v in range(7) if found.pattern.vertices[v] != pattern.vertices[v]]
    assert moved
    assert set(moved) <= {5, 6}
    assert found.largest_move < 0.0142


def test_letters_that_are_not_reached_name_the_fold_and_the_box():
    pattern, letters = near_miss(4, 3)
    found = designed(pattern, letters, within=Fraction(1, 10**5))
    assert found.status is exactfold.UNDECIDED
    assert found.before < found.after < 0
    assert "keeps another letter" in found.reason
    assert "at the limit of their box" in found.reason
    assert 0 < found.largest_move < 2e-5
    assert designed(pattern, letters, clock=Clock(0)).reason.endswith("(the time is over)")


def test_letters_that_no_sheet_has_are_refuted():
    found = designed(two_vertex(), dict.fromkeys(two_vertex().folds, "M"))
    assert (found.status, found.before, found.largest_move) == (exactfold.REFUTED, None, 0)
    assert found.reason.startswith("vertex 4 has these letters on no sheet with these folds")


def test_an_interruption_keeps_the_best_sheet(monkeypatch):
    calls = []

    def interrupted(*arguments):
        for place in raised(*arguments):
            calls.append(place)
            yield place
            if len(calls) == 3:
                raise KeyboardInterrupt

    monkeypatch.setattr(search, "raised", interrupted)
    found = designed(exactfold.random_square(3, seed=1), maximise="tolerance")
    assert found.interrupted
    assert found.status is exactfold.PROVED
    assert found.after > found.before
    assert found.reason.endswith("the search was interrupted")


def test_distances_are_how_far_vertices_may_move_to_first_order():
    pattern = two_vertex()
    part = branch_part(count_branches(pattern).branches)
    points = np.repeat(part.conditions.points[None], 4, axis=0)
    found, zeros = fold_distances(part.conditions, part.zeros, points)
    assert np.allclose(zeros, part.zeros)
    for row, zero in zip(found, part.zeros, strict=True):
        densities, slopes = part.conditions.slopes(zero, part.conditions.points)
        lengths = np.linalg.norm(slopes, axis=2).sum(axis=1)
        assert np.allclose(row, densities / lengths)
    triangle = np.array([[0.0, 0], [4, 0], [0, 3]])
    assert face_distances(triangle, [(0, 1, 2), (0, 2, 1)]) == pytest.approx([1.2, -1.2])


@pytest.mark.parametrize(
    ("sheet", "options", "error", "words"),
    [
        ("two-vertex", {}, UsageError, "nothing is asked for"),
        ("two-vertex", {"letters": {}}, UsageError, "no fold has the letter M or V"),
        ("two-vertex", {"letters": {(0, 4): "M", (1, 4): "F"}}, UsageError, "fold 1-4 cannot"),
        ("two-vertex", {"maximise": "margin"}, UsageError, "the margin is that of one way"),
        ("two-vertex", {"maximise": "tolerance", "fixed": [9]}, UsageError, "no vertex 9"),
        ("two-vertex", {"maximise": "tolerance", "fixed": [4, 5]}, UsageError, "no vertex may"),
        ("flat-vertex", {"maximise": "tolerance"}, UndecidedBranchError, "is flat"),
        ("waterbomb", {"maximise": "tolerance"}, NotCountedError, "four corners"),
    ],
)
def test_what_is_refused(sheet, options, error, words):
    pattern = single_vertex(5) if sheet == "waterbomb" else exactfold.pattern.load(sheet)
    with pytest.raises(error) as caught:
        designed(pattern, **options)
    assert words in str(caught.value)


def test_a_branch_of_another_sheet_is_refused():
    branch = count_branches(exactfold.random_square(2, seed=1))[0]
    with pytest.raises(UsageError, match="is none of this sheet"):
        designed(exactfold.random_square(3, seed=1), branch=branch, maximise="margin")
