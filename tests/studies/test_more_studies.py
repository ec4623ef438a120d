"""The studies of exceptions, of letters and of perturbed systems, beside counts made one by one."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from rivals.hermite import hermite_counts

from exactfold import random_square
from exactfold.branches import count_branches
from exactfold.design import actuate
from exactfold.rigidity import BranchSystem, perturbed
from exactfold.rigidity.functionals import saddle_functional
from exactfold.solve.algebraic.groebner_bases import quotient_algebra
from exactfold.studies import loops as motions
from exactfold.studies import mv, run_study, selffold
from exactfold.studies import perturbed as perturbed_study
from exactfold.studies.flat import has_straight_folds
from exactfold.studies.running.lines import Lines
from exactfold.studies.running.squares import square_of

TURNED = str.maketrans("MV", "VM")


def columns(run, name):
    """A table of a run as a mapping from its columns to tuples; the first of equal names."""
    (table,) = [table for table in run.tables if table.name == name]
    found = {}
    for k, column in enumerate(table.columns):
        found.setdefault(column, tuple(row[k] for row in table.rows))
    return found


def test_exceptions_are_those_of_the_counts():
    run = run_study("flat", numbers={3: 8})
    assert columns(run, "exceptions")["squares"] == (2, 2, 2, 2)
    coarse = [row for row in run.rows if row["denominator"] == 16]
    for row in coarse:
        result = count_branches(square_of(row))
        assert bool(row["flat"]) == bool(result.exceptional_vertices)
        assert row["distinct"] == result.distinct
    assert sum(bool(row["flat"]) for row in run.rows) == sum(
        columns(run, "exceptions")["exceptions"]
    )


@pytest.mark.survey
def test_degrees_of_flat_vertices_and_what_causes_them():
    run = run_study("flat", numbers={2: 200, 4: 200})
    exceptional = [row for row in run.rows if row["flat"]]
    assert exceptional
    for row in exceptional:
        pattern = square_of(row)
        vertices = count_branches(pattern).exceptional_vertices
        reduced, labels = pattern.without_rigid_parts()
        degrees = {reduced.degree(labels.index(v)) for v in vertices}
        assert {degree for part in row["flat"] for degree in part} == degrees
        assert row["straight"] == has_straight_folds(pattern)
        assert row["path"] <= row["straight"]
    assert all(row["straight"] for row in exceptional)  # of these; not of all, see test_nearest


def test_letters_are_those_of_the_counts():
    chosen = {"interior": 5, "denominator": 1024}
    rows = [{**chosen, "seed": seed} for seed in (50000058, 50000527)]
    study = replace(mv.STUDY, recipes=lambda *_: iter([{**chosen, "seed": 0}, *rows]))
    run = run_study(study, numbers={5: 3})
    assert [row["least_degree"] for row in run.rows] == [None, 6, None]
    for row in run.rows:
        result = count_branches(square_of(row))
        assert row["with_letters"] == result.repeated_assignments
        known = {min(b.assignment_text, b.assignment_text.translate(TURNED)) for b in result}
        assert row["assignments"] == len(known)
        assert row["separated"]
        groups = {}
        for branch in result:
            texts = branch.assignment_text, branch.sign_text
            turned = texts[0].translate(TURNED), texts[1].translate(str.maketrans("+-", "-+"))
            letters, signs = min(texts, turned)
            groups.setdefault(letters, []).append(signs)
        numbers = Counter(
            sum(a != b for a, b in zip(*pair, strict=True))
            for group in groups.values()
            for pair in combinations(group, 2)
        )
        assert dict(map(tuple, row["differing"])) == dict(numbers)
        saddle = saddle_functional(result.pattern)  # signs are those of this side
        for branch in result:
            assert sum(c * branch.approx_heights[v] for v, c in saddle.items()) > 0
    occurring = columns(run, "occurring")
    assert (occurring["Vi"], columns(run, "pairs")["none"]) == ((5,), (1,))
    assert float(occurring["of all"][0]) <= 1.001 * 4.0**-5
    assert set(columns(run, "sentences")["verdict"]) == {"agreed", "not decided"}


def contact(end, shared=None):
    return {"signs": "+", "end": end, "time": None if shared is None else [1, 1], "shared": shared}


def test_loops_are_counted_by_the_rules_they_follow():
    loop = {"nodes": 0, "stars": 0, "length": [1, 2], "winding": 2, "winding_there": None}
    row = {"status": "proved", "interior": 2, "half_branches": 8, "rule": 1, "h1": True}
    row["loops"] = [
        {**loop, "flipped": [1], "winding_there": 2},
        {**loop, "flipped": [0], "winding_there": 3},
        {**loop, "flipped": [0, 1], "nodes": 1, "stars": 1},
        {**loop, "flipped": [2]},
        {**loop, "flipped": [0, 2]},
    ]
    row["contacts"] = [
        contact("contact", 0),
        contact("contact", 1),
        contact("node"),
        contact("open"),
    ]
    found = {table.name: table for table in motions.tables([row])}
    assert found["rules"].rows == ((2, "4/5", "1/5", "3/5", "3/4", "1/3", "1/2", "0/1"),)
    assert found["ends"].rows == ((2, 4, 0, "0", 1, 1, 1, 1),)
    assert found["loops"].rows == ((2, 1, 1, 2, 5, 1, 3, 2, 0, 0),)


@pytest.mark.slow
def test_the_square_with_shared_letters_of_the_documentation():
    """Square 50000058 has two pairs of branches with equal letters."""
    run = run_study("mv", numbers={5: 59})
    assert columns(run, "shared")["first seed"] == (50000058,)
    assert count_branches(random_square(5, 50000058)).repeated_assignments > 0


@pytest.mark.slow
def test_real_zeros_are_counted_by_hermite_forms_as_well():
    run = run_study("perturbed", numbers={2: 5, 3: 10})
    for row in run.rows:
        system = BranchSystem(square_of(row)).chart.system
        other = perturbed(system, row["size"], row["seed"])
        assert hermite_counts(quotient_algebra(other)) == (
            row["zeros"],
            row["zeros"] - row["nonreal"],
        )
        if row["size"] == "0":
            assert (row["nonreal"], row["two_for_each_pair"]) == (0, True)
    assert columns(run, "real")["systems"] == (1,) * 5 + (2,) * 5
    assert sum(row["nonreal"] for row in run.rows) > 0


@pytest.mark.parametrize(("lost", "says"), [(10, "agreed"), (0, "not agreed"), (5, "not decided")])
def test_what_the_paper_says_of_most_systems_is_judged_by_the_largest_change(lost, says):
    row = {"interior": 3, "status": "proved", "zeros": 8, "nonreal": 0, "two_for_each_pair": True}
    changed = [{"nonreal": 2, "two_for_each_pair": False}] * lost + [{}] * (10 - lost)
    rows = [row | {"size": "0"}] * 10 + [row | {"size": "1/2"} | change for change in changed]
    _, sentences = perturbed_study.STUDY.tables(rows)
    assert [(line[1], line[3], line[-1]) for line in sentences.rows] == [
        ("1/2", f"{10 * lost}", says)
    ] * 2


def test_margins_of_all_branches_are_those_of_one_at_a_time():
    """Against the linear programs of `actuate`; torques along the branch do no better."""
    run = run_study("selffold", numbers={2: 1, 3: 1})
    for row in run.rows:
        branches = count_branches(square_of(row)).branches
        lines = Lines.of(square_of(row))
        assert row["dimensions"] == [[0, 0, len(branches)]]
        weakest = row["margins"].index(min(row["margins"]))
        assert row["weakest"] == branches[weakest].sign_text
        for branch, margin in zip(branches, row["margins"], strict=True):
            one = actuate(branch.pattern, branch.vertex_signs)
            assert float(one.margin[0]) * (1 - 1e-4) <= margin + row["gap"]
            assert margin <= float(one.bound)
            assert float(one.bound) * (1 - row["share"]) <= margin * (1 + 1e-4)
            signs = list(branch.vertex_signs.values())
            (own,) = np.flatnonzero((lines.signs == signs).all(axis=1))
            direction = lines.directions[own]
            powers = np.abs(lines.directions @ direction) / np.abs(direction).max()
            assert powers[own] - np.delete(powers, own).max() <= float(one.bound) + 1e-9
    table = columns(run, "margins")
    for k, row in enumerate(run.rows):
        ordered = sorted(row["margins"])
        assert table["branches"][k] == len(ordered)
        assert float(table["least"][k]) == pytest.approx(ordered[0], rel=0.01)
        assert float(table["largest"][k]) == pytest.approx(ordered[-1], rel=0.01)
        assert columns(run, "weakest")["least"][k] == table["least"][k]
    assert columns(run, "dimensions")["positive"] == (0, 0)


def test_branches_that_torques_can_drive_alone_are_counted():
    rows = [
        {
            "interior": 4,
            "status": "proved",
            "dimensions": [[0, 0, 2], [0, 1, 1], [1, 1, 1]],
            "margins": [0.1, 0.2, 0.3, 0.4],
            "gap": 1e-9,
            "share": 1e-8,
        },
        {"interior": 4, "status": "undecided"},
    ]
    dimensions, _, weakest = selffold.tables(rows)
    assert dimensions.rows == ((4, 2, 1, 4, 2, 1, "25", 1),)
    assert weakest.rows[0][1:3] == (1, "0.1")


@pytest.mark.slow
def test_loops_flip_one_sign_on_single_vertices_and_every_branch_ends():
    """Theorem 3 of docs/matching.md for one vertex of degree four, which is an H1 sheet."""
    run = run_study("motions", numbers={1: 2, 2: 1})
    for row in run.rows:
        n = row["interior"]
        assert row["status"] == "proved"
        assert [loop["flipped"] for loop in row["loops"]] == [[row["rule"]]] * 2 ** (n - 1)
        assert [contact["end"] for contact in row["contacts"]] == ["flat-fold"] * 2**n
        assert len({contact["signs"] for contact in row["contacts"]}) == 2**n
        for contact in row["contacts"]:
            assert 0 < contact["time"][0] <= contact["time"][1]
    assert columns(run, "loops")["followed"] == (2, 2)
    assert columns(run, "rules")["fans"] == columns(run, "rules")["H1"] == ("2/2", "2/2")
    for loop in run.rows[0]["loops"]:
        assert 0 < loop["length"][0] < loop["length"][1]


def test_motions_of_a_branch_with_a_flat_vertex_are_not_decided():
    branches = count_branches("flat-vertex").branches
    (flat,) = [branch for branch in branches if 0 in branch.vertex_signs.values()]
    assert motions._proof_of(flat) is None


@pytest.mark.slow
def test_what_the_figures_show():
    run = run_study("figures")
    rows = {row["figure"]: row for row in run.rows}
    assert {row["status"] for row in rows.values()} == {"proved"}
    ends = {(c["signs"], c["side"]): np.array(c["angles"][-1]) for c in rows[1]["curves"]}
    for signs, _ in ends:  # mirror images
        np.testing.assert_allclose(ends[signs, 1], -ends[signs, -1], atol=1e-5)
    for ray in rows[3]["rays"]:
        for form in rows[3]["forms"].values():
            heights = np.array(ray["heights"])
            assert abs(heights @ np.array(form) @ heights) < 1e-4
        values = [np.array(row) @ ray["heights"] for row in rows[3]["functionals"].values()]
        assert [value > 0 for value in values] == [sign == "+" for sign in ray["signs"]]
    first, second = np.array(rows[4]["signs"])
    assert (first != second).sum() == 1
    assert rows[5]["signs"][0] == rows[5]["signs"][1]
    assert len(run.figures) == 5
