"""The study of Table I against counts of branches one by one, and against known squares."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from exactfold import PROVED, random_square
from exactfold.branches import count_branches
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.pattern.data import example_path
from exactfold.pattern.loading import as_pattern
from exactfold.studies import run_study, table1
from exactfold.studies.closest import closest_lines, closest_pair
from exactfold.studies.running.lines import Lines
from exactfold.studies.running.statistics import decay, interval, same_probability

SQUARES = (
    (2, 0),
    (5, 534),
    *(
        pytest.param(*square, marks=pytest.mark.slow)
        for square in ((3, 1), (4, 2), (5, 80), (4, 1312), (3, 30000011))
    ),
)
"""Sizes and seeds: with shared letters, shared signs, a triangle that stays flat, a flat vertex."""


def row(size, seed):
    return table1.row({"interior": size, "seed": seed, "denominator": 1024})


def names(branch):
    """Letters and signs of a branch together, seen from the side where the smaller text is."""
    letters, signs = branch.assignment_text, branch.sign_text
    return min((letters, signs), (letters.translate(UPSIDE_DOWN), signs.translate(UPSIDE_DOWN)))


@pytest.mark.parametrize(("size", "seed"), SQUARES)
def test_rows_are_what_a_count_of_branches_says(size, seed):
    found = row(size, seed)
    count = count_branches(random_square(size, seed))
    assert found["status"] == str(count.status) == "proved"
    assert found["distinct"] == count.distinct
    assert found["with_multiplicity"] == count.with_multiplicity
    assert found["with_letters"] == count.repeated_assignments
    both = Counter(map(names, count.branches))
    assert found["with_signs"] == sum(n for n in both.values() if n > 1)
    assert found["rigid"] == count.pattern.Vt
    signs = [branch.vertex_signs for branch in count]
    inside = {v for _, group in count.pattern.triangulated_triangles for v in group}
    flat = {v for s in signs for v in s if s[v] == 0} - inside
    assert found["flat"] == len(flat)


@pytest.mark.parametrize(
    ("size", "seed", "letters", "signs", "rigid", "flat", "pairs"),
    [
        (5, 80, 2, 0, 0, 0, True),
        (5, 534, 2, 2, 0, 0, True),
        (4, 1312, 0, 0, 3, 0, True),
        (3, 30000011, 0, 0, 0, 2, False),
    ],
)
def test_known_squares(size, seed, letters, signs, rigid, flat, pairs):
    found = row(size, seed)
    assert (found["with_letters"], found["with_signs"]) == (letters, signs)
    assert (found["rigid"], found["flat"], found["pairs_of_signs"]) == (rigid, flat, pairs)


@pytest.mark.parametrize(
    "name",
    [
        "two-vertex",
        "flat-octahedron",
        *(pytest.param(name, marks=pytest.mark.slow) for name in ("flat-vertex", "h1-4")),
    ],
)
def test_directions_are_those_of_the_fold_angles(name):
    lines = Lines.of(as_pattern(example_path(name)))
    count = count_branches(name)
    assert lines.status is PROVED
    found = {
        (tuple(s), tuple(x)): d
        for s, x, d in zip(
            lines.signs.tolist(), lines.letters.tolist(), lines.directions, strict=True
        )
    }
    values = {"+": 1, "-": -1, "0": 0, "V": 1, "M": -1, "F": 0}
    for branch in count:
        bends = branch.sharpened(80).fold_angles.bends
        unit = np.array([float(bends[fold]) for fold in lines.pattern.folds])
        unit /= np.linalg.norm(unit)
        texts = branch.sign_text, branch.assignment_text
        key = tuple(tuple(values[x] for x in text) for text in texts)
        turned = tuple(tuple(-x for x in part) for part in key)
        direction = found[key] if key in found else -found[turned]
        assert np.linalg.norm(unit - direction) <= lines.errors.max() + 1e-13
    assert lines.errors.max() < 1e-7
    assert len(found) == count.distinct


def test_errors_of_directions_grow_with_the_boxes():
    from exactfold.branches.counting.branch_blocks import BranchBlocks
    from exactfold.studies.running.lines import _directions

    branch_blocks = BranchBlocks.of(random_square(4, 0))
    boxes = branch_blocks.prove(0).boxes
    points = np.hstack([boxes.points, np.ones((len(boxes.points), 1))])
    radii = np.full(len(points), 1e-5)
    exact, _ = _directions(branch_blocks.problem, points, radii)
    _, errors = _directions(branch_blocks.problem, points, radii)
    source = np.random.default_rng(0)
    for _ in range(20):
        moved = points.copy()
        moved[:, :-1] += source.choice([-1e-5, 1e-5], size=boxes.points.shape)
        other, _ = _directions(branch_blocks.problem, moved, radii)
        assert (np.linalg.norm(other - exact, axis=1) <= errors).all()
    assert errors.max() < 1e-2


@pytest.mark.parametrize("count", [2, 3, 40, 700])
def test_the_closest_pair_is_that_of_all_pairs(count):
    source = np.random.default_rng(count)
    vectors = source.normal(size=(count, 5))
    vectors /= np.linalg.norm(vectors, axis=1)[:, None]
    least = min(
        min(np.linalg.norm(u - v, axis=-1).min(), np.linalg.norm(u + v, axis=-1).min())
        for k, u in enumerate(vectors[:-1])
        for v in [vectors[k + 1 :]]
    )
    found = closest_pair(vectors, np.full(count, 1e-9))
    assert found.low < least < found.high < found.low + 1e-8
    assert 10.0**-found.digits < found.low <= 10.0 ** (1 - found.digits)


def test_lines_that_may_be_one_have_no_digits():
    vectors = np.array([[1.0, 0.0], [-1.0, 1e-12], [0.0, 1.0]])
    found = closest_pair(vectors, np.full(3, 1e-9))
    assert (found.low, found.digits, found.pair) == (0.0, None, (0, 1))
    assert closest_pair(vectors[:1], np.zeros(1)) is None


def paper_rows(size, number, rigid, letters, signs):
    """Rows that add up to the numbers of the paper."""
    return [
        {
            "interior": size,
            "seed": k,
            "status": "proved",
            "rigid": 3 * (k < rigid),
            "distinct": 1 << (size - 3 * (k < rigid)),
            "with_multiplicity": 1 << size,
            "pairs_of_signs": True,
            "flat": 0,
            "with_letters": 2 * (k < letters),
            "with_signs": 2 * (k < signs),
            "closest": 0.01 / (k + 1),
            "digits": 3,
        }
        for k in range(number)
    ]


@pytest.mark.slow
def test_the_table_adds_up_to_that_of_the_paper():
    rows = [row for size, counts in table1.PAPER.items() for row in paper_rows(size, *counts)]
    main, comparison, distances = table1.tables(rows)
    assert main.rows == tuple(
        (size, n, n, n, rigid, letters, signs, 0)
        for size, (n, rigid, letters, signs) in table1.PAPER.items()
    )
    assert {line[-1] for line in comparison.rows} == {"agree"}
    assert {line[-2] for line in comparison.rows} == {"1"}
    assert all(line[2:4] == line[4:6] for line in comparison.rows)
    assert distances.rows[0] == (2, "1.00e-04", 99, 3, 3)


def test_the_numbers_of_the_paper_are_those_of_its_table():
    """Table I and Section III.C, as they are printed."""
    assert [table1.PAPER[size][0] for size in range(2, 9)] == [100, 5000, 1000, 1000, 1000, 300, 50]
    assert [table1.PAPER[size][1] for size in range(2, 9)] == [0, 0, 2, 1, 1, 0, 0]
    assert [table1.PAPER[size][2] for size in range(2, 9)] == [0, 0, 0, 17, 28, 17, 8]
    assert [table1.PAPER[size][3] for size in range(2, 9)] == [0, 0, 0, 1, 2, 1, 0]


def test_samples_that_are_far_off_differ():
    rows = paper_rows(8, 50, 0, 40, 0)
    lines = {line[1]: line[-1] for line in table1.tables(rows)[1].rows}
    assert lines == {"Vt > 0": "agree", "same MV": "differ", "and signs": "agree"}


def test_what_is_not_proved_counts_nowhere():
    proved, undecided = paper_rows(3, 2, 0, 0, 0)
    none = ("distinct", "with_multiplicity", "pairs_of_signs", "flat", "with_letters", "digits")
    undecided |= {"status": "undecided", "closest": None, "with_signs": None}
    undecided |= dict.fromkeys(none)
    unclear = {**proved, "with_letters": None, "with_signs": None}
    main, comparison, _ = table1.tables([proved, undecided, unclear])
    assert main.rows == ((3, 3, 2, 2, 0, 0, 0, 0),)
    assert main.notes[-1] == "squares with an undecided letter, which are not counted there: 1."
    assert [line[4] for line in comparison.rows] == ["0/2", "0/1", "0/1"]


def test_an_undecided_count_makes_an_undecided_row(monkeypatch):
    from dataclasses import replace

    from exactfold import UNDECIDED
    from exactfold.studies.running import lines

    count = replace(count_branches(random_square(3, 30000011)), status=UNDECIDED)
    monkeypatch.setattr(lines, "count_branches", lambda _: count)
    found = row(3, 30000011)
    assert found["status"] == "undecided"
    assert {found[key] for key in found if key not in ("status", "rigid")} == {None}


def test_intervals_hold_their_probability():
    """Clopper and Pearson: at each end the sample is just as unlikely as the level says."""
    from scipy.stats import binom

    low, high = interval(17, 1000)
    assert binom.sf(16, 1000, low) == pytest.approx(0.025)
    assert binom.cdf(17, 1000, high) == pytest.approx(0.025)
    assert interval(0, 0) == (0.0, 1.0)
    assert same_probability((0, 50), (50, 50)) < 1e-20


def test_decay_is_fitted():
    assert decay({1: (250, 1000)}) is None
    assert decay({1: (0, 10), 2: (0, 10)}) is None
    exact = decay({k: (round(10**6 * 0.4**k), 10**6) for k in range(1, 6)})
    assert exact.ratio == pytest.approx(0.4, abs=1e-4)
    assert exact.p > 0.9
    assert decay({1: (600, 1000), 2: (60, 1000)}).p < 1e-6


@pytest.mark.survey
def test_the_whole_table_agrees_with_the_paper():
    run = run_study("table1", workers=2)
    assert {line[-1] for line in run.tables[1].rows} == {"agree"}


def test_close_branches_are_told_apart_by_sharper_roots():
    """A box of this square is wider than two of its branches are apart."""
    lines = Lines.of(random_square(6, 60003620))
    assert closest_pair(lines.directions, lines.errors).low == 0
    found = closest_lines(lines)
    rows = found.pair
    exact = [branch.sharpened(200).fold_angles for branch in _branches(lines, rows)]
    u, v = (np.array([float(a.bends[fold]) for fold in lines.pattern.folds]) for a in exact)
    u, v = u / np.linalg.norm(u), v / np.linalg.norm(v)
    distance = min(np.linalg.norm(u - v), np.linalg.norm(u + v))
    assert found.low - 1e-14 <= distance <= found.high + 1e-14
    assert found.low > (1 - 1e-6) * found.high
    assert table1.row({"interior": 6, "seed": 60003620, "denominator": 1024})["digits"] == 5


def _branches(lines, rows):
    """The branches of rows, by their vertex signs from either side."""
    counted = count_branches(lines.pattern).branches
    signs = [tuple(b.vertex_signs[v] for v in lines.pattern.interior) for b in counted]
    for row in rows:
        wanted = tuple(lines.signs[row].tolist())
        yield counted[signs.index(wanted)]


def test_squares_that_are_not_told_apart_are_named():
    row = {"interior": 6, "status": "proved", "rigid": 0, "flat": 0, "distinct": 64}
    row |= {"with_multiplicity": 64, "pairs_of_signs": True, "with_letters": 0, "with_signs": 0}
    measured = row | {"closest": 0.1, "digits": 1, "seed": 1}
    table = table1.STUDY.tables([measured, row | {"closest": None, "digits": None}])[-1]
    assert table.notes[-1] == "squares whose branches are not all told apart, not counted here: 1."
    assert len(table1.STUDY.tables([measured])[-1].notes) == len(table.notes) - 1


def test_squares_with_too_many_branches_for_the_memory_are_undecided():
    (recipe,) = table1.STUDY.recipes(0, {21: 1})
    row = table1.row(recipe)
    assert (row["status"], row["distinct"]) == ("undecided", None)
