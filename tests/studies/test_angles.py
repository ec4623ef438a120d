"""The study of angles between branches against angles computed in exact numbers."""

from __future__ import annotations

from dataclasses import replace
from math import acos, pi

import mpmath
import numpy as np
import pytest

from exactfold import PROVED, random_square
from exactfold.branches import count_branches
from exactfold.studies.angles import pairs as counting
from exactfold.studies.angles import statistics as angle_statistics
from exactfold.studies.angles import study as angles
from exactfold.studies.angles.pairs import BINS, pair_angles
from exactfold.studies.angles.statistics import distance, uniform
from exactfold.studies.running.lines import Lines


@pytest.fixture(autouse=True)
def few(monkeypatch):
    """Few samples are drawn again: a p-value of 1/151 is still below 0.01."""
    monkeypatch.setattr(angle_statistics, "RESAMPLED", 150)


def row(size, seed):
    return angles.row({"interior": size, "seed": seed, "denominator": 1024})


def exact_bins(pattern):
    """The bin of each pair, from bounds of 200 bits of every branch, with mpmath."""
    with mpmath.workdps(50):
        vectors = []
        for branch in count_branches(pattern):
            sharp = branch.sharpened(200).fold_angles
            bends = []
            points, _ = pattern.integer_vertices
            for fold, (low, high) in sharp.densities.items():
                (ax, ay), (bx, by) = points[fold[0]], points[fold[1]]
                squared = (bx - ax) ** 2 + (by - ay) ** 2
                middle = (low + high) / 2
                bends.append(
                    mpmath.mpf(middle.numerator) / middle.denominator * mpmath.sqrt(squared)
                )
            length = mpmath.sqrt(sum(x * x for x in bends))
            vectors.append([x / length for x in bends])
        bins = [0] * BINS
        squares = []
        for k, u in enumerate(vectors):
            for v in vectors[:k]:
                cosine = abs(sum(x * y for x, y in zip(u, v, strict=True)))
                bins[int(mpmath.acos(cosine) / (mpmath.pi / 2 / BINS))] += 1
                squares.append(cosine**2)
        return bins, float(sum(squares) / len(squares))


@pytest.mark.parametrize(
    ("size", "seed"),
    [
        (2, 0),
        pytest.param(3, 30000011, marks=pytest.mark.slow),  # with a flat vertex
        pytest.param(4, 1312, marks=pytest.mark.slow),  # with a triangle that stays flat
        pytest.param(5, 80, marks=pytest.mark.slow),
    ],
)
def test_angles_are_those_of_exact_numbers(size, seed):
    found = row(size, seed)
    bins, square = exact_bins(random_square(size, seed))
    assert (found["status"], found["angles"], found["unclear"]) == ("proved", bins, 0)
    assert found["mean_square"] == pytest.approx(square, rel=1e-5)
    assert sum(bins) == found["lines"] * (found["lines"] - 1) // 2


def test_a_square_with_seven_vertices_is_counted_as_from_its_branches():
    """Bends of listed branches, to nine digits; on this square no pair is so near an edge."""
    pattern = random_square(7, 90000000)
    bends = [list(branch.fold_angles.bends.values()) for branch in count_branches(pattern)]
    vectors = np.array(bends, dtype=float)
    vectors /= np.linalg.norm(vectors, axis=1)[:, None]
    cosines = np.minimum(np.abs(vectors @ vectors.T), 1)[np.triu_indices(128, 1)]
    places = np.arccos(cosines) / (pi / 2 / BINS)
    inner = (places > 0.5) & (places < BINS - 0.5)
    assert np.abs(places - np.rint(places))[inner].min() > 1e-6
    found = row(7, 90000000)
    assert found["angles"] == np.bincount(places.astype(int), minlength=BINS).tolist()
    assert (found["lines"], found["unclear"]) == (128, 0)
    assert found["mean_square"] == pytest.approx(float((cosines**2).mean()), rel=1e-5)


def lines_of(vectors, errors, sharp=None):
    vectors = np.array(vectors, dtype=float)
    none = np.zeros((len(vectors), 0), dtype=np.int8)
    pattern = random_square(2, 0)
    return Lines(pattern, PROVED, none, none, vectors, np.array(errors), None, sharp)


def at(angle):
    return [np.cos(angle), np.sin(angle)]


def test_pairs_are_counted_in_their_bins():
    width = pi / 2 / BINS
    given = [0.5, 1.5, 20.5, 63.5, 64.5, 100.5]
    for place in given:
        found = pair_angles(lines_of([at(0), at(place * width)], [1e-10, 1e-10]))
        folded = place if place < BINS else 2 * BINS - place
        assert found.bins[int(folded)] == 1
        assert (sum(found.bins), found.unclear) == (1, 0)


@pytest.mark.parametrize("place", [1, 2, 33, 63])
def test_a_pair_that_may_be_in_two_bins_is_unclear(place):
    width = pi / 2 / BINS
    for off in (-1e-12, 1e-12):
        near = lines_of([at(0), at(place * width + off)], [1e-10, 1e-10])
        assert (sum(pair_angles(near).bins), pair_angles(near).unclear) == (1, 1)
    for off in (-1e-6, 1e-6):
        clear = pair_angles(lines_of([at(0), at(place * width + off)], [1e-10, 1e-10]))
        assert (clear.bins[place - (off < 0)], clear.unclear) == (1, 0)


def test_equal_and_orthogonal_lines_are_never_unclear():
    found = pair_angles(lines_of([at(0), at(pi), at(pi / 2)], [1e-10] * 3))
    assert (found.bins[0], found.bins[-1], found.unclear) == (1, 2, 0)


@pytest.mark.parametrize(
    ("size", "seed"),
    [
        (3, 0),
        (4, 1312),  # with a triangle that stays flat
        pytest.param(5, 80, marks=pytest.mark.slow),
    ],
)
def test_doubtful_pairs_are_decided_by_sharper_roots(size, seed):
    """With bounds that are useless every pair is computed anew, and the result is the same."""
    lines = Lines.of(random_square(size, seed))
    blurred = replace(lines, errors=np.full(len(lines.errors), 0.1))
    assert pair_angles(blurred).bins == pair_angles(lines).bins
    assert pair_angles(blurred).unclear == 0
    assert pair_angles(replace(blurred, sharp=None)).unclear > 0


def test_sharper_directions_are_within_the_bounds_of_the_first():
    lines = Lines.of(random_square(4, 7))
    rows = [0, 5, 11, 15]
    sharp, errors = lines.sharper(rows)
    first = lines.directions[rows]
    first = first * np.sign((first * sharp).sum(axis=1))[:, None]
    assert (np.linalg.norm(first - sharp, axis=1) <= lines.errors[rows] + errors).all()
    assert errors.max() < 1e-13


@pytest.mark.parametrize("number", [2, 7, 8, 9, 40, 41, 100])
def test_pairs_are_counted_once_however_they_are_tiled(monkeypatch, number):
    """Small tiles, and pairs put off that are decided a few at a time."""
    monkeypatch.setattr(counting, "_ROWS", 8)
    monkeypatch.setattr(counting, "_COLUMNS", 32)
    monkeypatch.setattr(counting, "_PENDING", 3)
    vectors = np.random.default_rng(number).normal(size=(number, 5))
    vectors /= np.linalg.norm(vectors, axis=1)[:, None]
    cosines = np.abs(vectors @ vectors.T)[np.triu_indices(number, 1)]
    places = (np.arccos(cosines) / (pi / 2 / BINS)).astype(int)
    expected = tuple(np.bincount(places, minlength=BINS).tolist())
    for error, unclear in ((1e-12, 0), (1e-3, None), (np.inf, len(places))):
        found = pair_angles(lines_of(vectors, [error] * number))
        assert found.bins == expected
        assert unclear is None or found.unclear == unclear


def test_errors_of_both_lines_tell_whether_a_pair_is_clear():
    """One vague line makes its own pairs unclear, and no other ones."""
    width = pi / 2 / BINS
    vectors = [at(0), at(5 * width + 1e-7), at(7 * width + 2e-7)]
    for errors, unclear in (([1e-9] * 3, 0), ([1e-6, 1e-9, 1e-9], 2), ([1e-9, 1e-9, 1e-6], 2)):
        found = pair_angles(lines_of(vectors, errors))
        assert (found.bins[5], found.bins[7], found.bins[2]) == (1, 1, 1)
        assert found.unclear == unclear


def test_a_single_line_has_no_angles():
    assert pair_angles(lines_of([at(0)], [0.0])).bins == (0,) * BINS


@pytest.mark.slow
@pytest.mark.parametrize("size", [1, 2, 6])
def test_the_uniform_prediction_is_that_of_random_directions(size):
    source = np.random.default_rng(size)
    vectors = source.normal(size=(2, 200_000, size + 1))
    vectors /= np.linalg.norm(vectors, axis=2)[:, :, None]
    cosines = np.abs((vectors[0] * vectors[1]).sum(axis=1))
    found = np.bincount((np.arccos(cosines) / (pi / 2 / BINS)).astype(int), minlength=BINS)
    assert distance(found / found.sum(), uniform(size)) < 0.01


def sample(size, number, power, seed):
    """Rows with angles whose density is exp(-b x^power), x the distance from a right angle."""
    source = np.random.default_rng(seed)
    x = pi / 2 - (np.arange(BINS) + 0.5) * pi / 2 / BINS
    shares = np.exp(-4 * x**power)
    shares /= shares.sum()
    return [
        {
            "interior": size,
            "status": "proved",
            "angles": source.multinomial(20_000, shares).tolist(),
            "unclear": 0,
            "mean_square": float((np.sin(x) ** 2 * shares).sum()),
        }
        for _ in range(number)
    ]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("power", "gaussian", "exponential"),
    [(0.5, "agreed", "not agreed"), (1.0, "agreed", "agreed"), (2.0, "not agreed", "not agreed")],
)
def test_tails_are_told_apart(power, gaussian, exponential):
    _, _, tails, _, sentences = angles.tables(sample(6, 30, power, 1))
    assert float(tails.rows[0][1]) == pytest.approx(power, abs=0.11)
    verdicts = {line[0]: line[-1] for line in sentences.rows}
    assert verdicts["Vi = 6: tails decay exponentially"] == exponential
    if power < 2:
        assert verdicts["Vi = 6: tails do not decay as a Gaussian"] == gaussian


@pytest.mark.slow
def test_sizes_that_differ_are_told_from_those_that_do_not():
    rows = sample(6, 20, 1.0, 1) + sample(7, 20, 1.0, 2) + sample(8, 20, 2.0, 3)
    neighbours, sentences = angles.tables(rows)[3:]
    assert [float(line[4]) < 0.01 for line in neighbours.rows] == [False, True]
    verdicts = {line[0]: line[-1] for line in sentences.rows}
    assert verdicts["Vi = 6 and 7 very nearly coincide"] == "agreed"
    assert verdicts["Vi = 7 and 8 differ significantly"] == "agreed"
    same = {line[0]: line[-1] for line in angles.tables(rows[:20] + sample(7, 20, 2.0, 4))[4].rows}
    assert same["Vi = 6 and 7 very nearly coincide"] == "not agreed"


@pytest.mark.slow
def test_orthogonality_is_judged_by_the_mean_of_squares():
    rows = sample(6, 20, 1.0, 1)
    more = [{**row, "mean_square": 0.01} for row in rows]
    less = [{**row, "interior": 7, "mean_square": 0.2} for row in rows]
    verdicts = [angles.tables(x)[4].rows[0][-1] for x in (more, less, more + less)]
    assert verdicts == ["not agreed", "agreed", "agreed in part"]


def test_rows_that_are_not_proved_count_nowhere():
    rows = sample(6, 3, 1.0, 1)
    none = {**rows[0], "status": "undecided", "angles": None, "mean_square": None}
    assert angles.tables([*rows, none]) == angles.tables(rows)
    assert angles.tables([none]) == []
    assert list(angles.figures([none])) == []


def test_the_cosine_of_a_bin_is_that_of_its_edge():
    assert acos(np.cos(3 * pi / 2 / BINS)) == pytest.approx(3 * pi / 2 / BINS)


def test_pairs_of_a_branch_with_itself_are_told():
    """Vi = 2: 4 of the 16 ordered pairs are those of a branch with itself."""
    rows = [{**row, "angles": [0] * (BINS - 1) + [6]} for row in sample(2, 3, 1.0, 1)]
    rows += [{**row, "angles": [0] * (BINS - 1) + [28]} for row in sample(3, 3, 1.0, 1)]
    last = angles.tables(rows)[4].rows[-1]
    assert last[1:] == (
        "Vi = 2: 25 % of pairs, others there 0 %; Vi = 3: 12 % and 0 %",
        "agreed",
    )
    near = [{**row, "angles": [6] + [0] * (BINS - 1)} for row in sample(2, 3, 1.0, 1)]
    assert angles.tables(near + rows[3:])[4].rows[-1][-1] == "not agreed"


def verdicts_of(rows):
    return {line[0]: line[1:] for line in angles.tables(rows)[4].rows}


def test_sentences_are_judged_with_sizes_that_the_paper_does_not_have():
    rows = sample(6, 12, 1.0, 1) + sample(7, 12, 1.0, 2) + sample(8, 12, 2.0, 3)
    more = rows + sample(9, 12, 2.0, 4) + sample(11, 3, 2.0, 5)
    before, after = verdicts_of(rows), verdicts_of(more)
    assert before.keys() == after.keys()
    changed = {name for name in before if before[name] != after[name]}
    assert changed == {
        "branches are less orthogonal than uniform ones",
        "small Vi: angles near 0 and pi, of each branch with itself",
    }
    number, _ = after["branches are less orthogonal than uniform ones"]
    assert number == "less for Vi = 9, 11; more for 6 to 8"
    assert after["Vi = 6 and 8 differ significantly"][1] == "agreed"
    assert after["Vi = 8 stands out, not 7"][1] == "agreed"
    pairs = [line[0] for line in angles.tables(more)[3].rows]
    assert pairs == ["6 and 7", "7 and 8", "8 and 9"]


def test_seven_stands_out_where_its_tails_fall_most():
    rows = sample(6, 12, 1.0, 1) + sample(7, 12, 2.0, 2) + sample(8, 12, 2.0, 3)
    assert verdicts_of(rows)["Vi = 8 stands out, not 7"][1] == "not agreed"
    rows = sample(6, 12, 1.0, 1) + sample(7, 12, 1.0, 2) + sample(8, 12, 1.0, 3)
    assert verdicts_of(rows)["Vi = 8 stands out, not 7"][1] == "not decided"


def test_sizes_differ_whose_tails_do():
    """Squares that are alike in the bulk differ at random; tails that are twice as high tell."""
    source = np.random.default_rng(0)

    def rows(size, tail):
        bins = source.integers(50, 2000, size=(12, BINS))
        bins[:, : BINS // 4] = tail
        lines = sample(size, 12, 1.0, 1)
        return [{**line, "angles": b.tolist()} for line, b in zip(lines, bins, strict=True)]

    made = rows(7, 10) + rows(8, 20)
    number, found = verdicts_of(made)["Vi = 7 and 8 differ significantly"]
    line = angles.tables(made)[3].rows[0]
    assert float(line[4]) > 0.01 > float(line[7])
    assert (found, f"p = {line[4]};" in number) == ("agreed", True)


def test_data_are_judged_by_the_numbers_of_squares_in_the_paper():
    """300 squares and 50; with four times as many pairs in a square, as two sizes have."""

    def sized(number, power, seed):
        rows = sample(8, number, power, seed)
        return [{**row, "angles": [4 * x for x in row["angles"]]} for row in rows]

    lack = "Vi = 8 differs not for lack of data"
    enough = "Vi = 7 and 8 have comparable numbers of pairs"
    seven = sample(7, 300, 1.0, 1)
    assert verdicts_of(seven + sized(60, 2.0, 2))[lack][1] == "agreed"
    same = verdicts_of(seven + sized(60, 1.0, 2))
    assert same[lack][1] == "not agreed"
    assert same[enough] == ("0.67 as many, with 50 squares and 300", "agreed")
    assert verdicts_of(seven + sample(8, 60, 1.0, 2))[enough][1] == "not agreed"
    assert lack not in verdicts_of(seven + sized(49, 2.0, 2))


def test_sizes_beyond_the_paper_have_a_panel_of_their_own():
    rows = [line for n in (6, 8) for line in sample(n, 2, 1.0, n)]
    assert [figure.panels for figure in angles.figures(rows)] == [(1, 1), (1, 1)]
    wide = angles.figures(rows + sample(9, 2, 1.0, 9))[1]
    assert (wide.panels, wide.width) == ((1, 2), 10.0)


def test_an_extended_run_goes_on_to_fourteen_vertices():
    assert set(angles.STUDY.chosen(extend=True)) == set(range(2, 15))
    assert set(angles.STUDY.chosen()) == set(range(2, 9))
