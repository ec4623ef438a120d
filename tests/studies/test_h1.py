"""The study of H1 triangulations against the proofs, plantri and Brown's formula."""

from __future__ import annotations

from math import factorial

import pytest

from exactfold import random_square
from exactfold.pattern.families import hypar, sample_h1_sequence
from exactfold.studies import h1, run_study
from exactfold.studies.triangulations import (
    _search,
    has_chord,
    has_low_vertex,
    low_corners,
    reverse_moves,
    triangulation,
    turns,
    types,
)
from proofs import h1_triangulations as proof


def rooted(triangles):
    """How many rooted triangulations are of one type: different searches from its sides."""
    turn = turns(triangles)
    mirror = {(b, a): c for (a, b), c in turn.items()}
    sides = [(s, w) for w in (turn, mirror) for s in w if s[::-1] not in w]
    return len({_search(*side) for side in sides})


@pytest.mark.parametrize("n", range(4))
def test_types_are_as_many_as_brown_says(n):
    """Brown counts those with a root: each type as often as its sides can be told apart."""
    brown = 40 * factorial(4 * n + 3) // (factorial(n) * factorial(3 * n + 5))
    assert sum(map(rooted, types(n))) == brown


@pytest.mark.parametrize("n", [1, 2, 3, pytest.param(4, marks=pytest.mark.slow)])
def test_types_are_as_many_as_plantri_says(n):
    found = h1.row({"kind": "all types", "interior": n})
    assert (found["types"], found["types_without_chords"]) == h1.PLANTRI[n]


@pytest.mark.survey
@pytest.mark.parametrize("n", range(5, 8))
def test_more_types_are_as_many_as_plantri_says(n):
    found = h1.row({"kind": "all types", "interior": n})
    assert (found["types"], found["types_without_chords"]) == h1.PLANTRI[n]


@pytest.mark.parametrize("n", [1, 2, 3])
def test_types_are_h1_as_in_the_proof(n):
    for triangles in types(n):
        assert (reverse_moves(triangles) == n) == proof.is_h1(triangles)
        assert has_low_vertex(triangles) == (
            min(d for v, d in proof.degrees(triangles).items() if v > 3) == 3
        )
        chord = any({0, 2} <= set(t) or {1, 3} <= set(t) for t in triangles)
        assert has_chord(triangles) == chord


@pytest.mark.parametrize(("size", "seed"), [(3, 0), (4, 1), (5, 3), (6, 1), (8, 2), (8, 5)])
def test_squares_are_reduced_as_in_the_proof(size, seed):
    triangles = triangulation(random_square(size, seed).triangles)
    assert (reverse_moves(triangles) == size) == proof.is_h1(triangles)
    assert bool(low_corners(triangles)) == any(True for _ in proof.reverse_moves(triangles))


def test_sheets_that_are_known_to_be_h1_or_not():
    sheet = sample_h1_sequence(12, seed=1).pattern
    assert reverse_moves(triangulation(sheet.triangles)) == 12
    twisted = triangulation(hypar(1).triangles)
    assert (reverse_moves(twisted), low_corners(twisted)) == (0, 0)


def test_all_small_types_are_h1_unless_there_are_chords():
    found = [h1.row({"kind": "all types", "interior": n}) for n in (1, 2, 3)]
    kept = ("kept", "kept_h1", "kept_with_chords", "kept_with_chords_h1")
    assert [[row[key] for key in kept] for row in found] == [[1] * 4, [1] * 4, [2, 2, 3, 2]]


def test_the_tables():
    run = run_study("h1", numbers={3: 6, 8: 6})
    shares, moves, decay, every, sentences = run.tables
    assert [line[:4] for line in shares.rows[:3:2]] == [
        ("irreducible", 3, "0/6", "0.00"),
        ("H1", 3, "6/6", "100.00"),
    ]
    assert [line[-1] for line in shares.rows] == ["agree"] * 4
    assert moves.rows[0][:5] == (3, 6, 6, 6, 6)
    assert moves.rows[1][:2] == (8, 6)
    assert (decay.rows, every.rows) == ((), ((3, 18, 8, "yes", 2, 2, 3, 2),))
    assert run.total == 13
    verdicts = {line[0]: line[1:] for line in sentences.rows}
    assert verdicts["up to Vi = 3 all types without chords are H1"] == ("2 of 2", "agreed")


def test_factors_from_size_to_size():
    rows = [
        {"kind": "random square", "interior": n, "low_corners": 1, "moves": n, "h1": k % 2**n == 0}
        for n in (4, 5)
        for k in range(64)
    ]
    assert h1.tables(rows)[2].rows == (("4 to 5", "0.500"),)


def squares_with_moves(size, counts):
    """Random squares of which `counts[k]` have k reverse moves at most."""
    return [
        {
            "kind": "random square",
            "interior": size,
            "low_corners": int(moves > 0),
            "moves": moves,
            "h1": moves == size,
        }
        for moves, count in enumerate(counts)
        for _ in range(count)
    ]


@pytest.mark.parametrize(
    ("counts", "said"),
    [((500, 250, 125, 0, 0, 0, 125), "agreed"), ((900, 10, 10, 0, 0, 0, 80), "not agreed")],
)
def test_the_decay_from_move_to_move_is_judged(counts, said):
    rows = squares_with_moves(6, counts) + squares_with_moves(5, (100, 0, 0, 0, 0, 900))
    verdicts = {line[0]: line[-1] for line in h1.tables(rows)[-1].rows}
    assert verdicts["Vi = 6: the share with more moves falls exponentially"] == said
    assert verdicts["more and more squares are irreducible"] == "agreed"
    fewer = squares_with_moves(7, (100, 0, 0, 0, 0, 0, 0, 900))
    verdicts = {line[0]: line[-1] for line in h1.tables(rows + fewer)[-1].rows}
    assert verdicts["more and more squares are irreducible"] == "not agreed"


def test_the_numbers_of_the_paper_are_those_of_section_four():
    assert h1.STUDY.numbers == {1: 0, 2: 0} | dict.fromkeys(range(3, 9), 20_000)
    assert h1.PAPER_IRREDUCIBLE[8] / h1.PAPER_NUMBER == 0.885
    assert h1.PAPER_H1[8] / h1.PAPER_NUMBER == 0.0077
    assert (h1.PAPER_IRREDUCIBLE[3], h1.PAPER_H1[3]) == (0, h1.PAPER_NUMBER)


def test_shares_that_are_far_off_differ():
    rows = [
        {"kind": "random square", "interior": 8, "low_corners": 1, "moves": 1, "h1": False}
        for _ in range(50)
    ]
    shares = h1.tables(rows)[0]
    assert [line[-1] for line in shares.rows] == ["differ", "agree"]
