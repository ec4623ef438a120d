"""What a count hands out: JSON, notebook displays, heights that solve the equations."""

import json
from collections import Counter
from dataclasses import replace
from fractions import Fraction

import pytest
from sheets import (
    DENTED,
    HEXAGON,
    TRIANGLE,
    dart,
    nested_triangles,
    reflex_corners,
    scrambled,
    straight_side,
)

from exactfold import PROVED, UNDECIDED, random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import flat_vertex_square, hypar, single_vertex, two_vertex
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import saddle_functional

PATTERNS = {
    "one vertex": single_vertex(4),
    "two vertices": two_vertex(),
    "random": random_square(4, seed=9),
    "reflex": scrambled(5, reflex_corners(5), 3),
    "dart": dart(),
    "straight side": straight_side(smallest=True),
    "flat vertex": flat_vertex_square(),
    "hypar": hypar(1, twist=0),
    "nested": nested_triangles(),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())

KEYS = {
    *("pattern", "status", "reason", "method", "distinct", "with_multiplicity", "real"),
    *("nonreal", "true_branches", "dimension", "degree", "certificate", "seconds", "branches"),
    *("true_bounds", "pieces"),
}


def product(a, b):
    ends = [x * y for x in a for y in b]
    return min(ends), max(ends)


def curvature_interval(pattern, vertex, heights):
    """Bounds of K_v over a box of heights, term by term."""
    form = curvature_form(pattern, vertex)
    low = high = Fraction(0)
    for u, row in zip(form.labels, form.matrix, strict=True):
        for w, c in zip(form.labels, row, strict=True):
            a, b = product((c, c), product(heights[u], heights[w]))
            low, high = low + a, high + b
    return low, high


@patterns
def test_heights_satisfy_the_curvature_equations(pattern):
    for branch in count_branches(pattern).branches:
        for v in pattern.interior:
            low, high = curvature_interval(pattern, v, branch.heights)
            scale = max(abs(x) for row in curvature_form(pattern, v).matrix for x in row)
            assert low <= 0 <= high
            assert high - low < scale / 10**9


@patterns
def test_heights_are_narrow_and_not_flat(pattern):
    for branch in count_branches(pattern).branches:
        assert all(0 <= high - low < Fraction(1, 10**8) for low, high in branch.heights.values())
        sharp = branch.sharpened(64).heights
        assert all(0 <= high - low < Fraction(1, 10**12) for low, high in sharp.values())
        assert all(
            a <= c <= d <= b
            for (a, b), (c, d) in zip(branch.heights.values(), sharp.values(), strict=True)
            if a < b
        )
        assert any(low > 0 or high < 0 for low, high in branch.heights.values())


@patterns
def test_boundary_saddle_is_positive(pattern):
    functional = saddle_functional(pattern)
    for branch in count_branches(pattern).branches:
        ends = [product((c, c), branch.heights[v]) for v, c in functional.items()]
        assert sum(low for low, _ in ends) > 0


@patterns
def test_three_boundary_vertices_are_pinned_exactly(pattern):
    for branch in count_branches(pattern).branches:
        data = branch.entry()
        pinned = [v for v in pattern.boundary if data["heights"][str(v)] == ["0", "0"]]
        assert len(pinned) == 3
        assert all(branch.heights[v] == (0, 0) for v in pinned)


@patterns
def test_different_branches_have_different_heights(pattern):
    branches = count_branches(pattern).branches
    for k, one in enumerate(branches):
        for other in branches[:k]:
            assert any(
                one.heights[v][1] < other.heights[v][0] or other.heights[v][1] < one.heights[v][0]
                for v in one.heights
            )


@patterns
def test_to_dict_is_json_with_exact_numbers(pattern):
    result = count_branches(pattern)
    data = result.to_dict("c.json")
    assert set(data) >= KEYS
    assert json.loads(json.dumps(data)) == data
    assert data["certificate"] == "c.json"
    assert result.to_dict()["certificate"] is None
    assert data["status"] == "proved"
    assert len(data["branches"]) == data["distinct"] == data["real"] + data["nonreal"]
    total = sum(branch["multiplicity"] for branch in data["branches"])
    assert total == data["with_multiplicity"]


def test_keys_of_the_json_are_fixed():
    data = count_branches(two_vertex()).to_dict()
    more = {"ways", "format", "version", "by", "why", "open_questions", "settings", "warnings"}
    more |= {"theory", "rigid", "components", "modes_count", "modes", "flat_folds", "free_folds"}
    more |= {"exceptional_vertices", "freedom", "drawn", "way_list"}
    more |= {"letters", "near_misses", "read", "still_folds", "meant", "as_written", "proposal"}
    assert set(data) - KEYS == more
    assert set(data["pattern"]) == {
        *("name", "interior", "boundary", "folds", "degrees_of_freedom", "sha256", "snapped"),
        *("vertices", "faces"),
    }
    keys = {"vertex_signs", "assignment", "multiplicity", "representative", "heights"}
    assert set(data["branches"][0]) == keys


@pytest.mark.parametrize("key", ["distinct", "with_multiplicity", "real", "nonreal"])
def test_a_proved_count_without_its_numbers_is_a_defect(key):
    found = count_branches(two_vertex())
    with pytest.raises(ArithmeticError, match="numbers are missing"):
        replace(found, **{key: None}).to_dict()


def test_sign_vectors_take_opposite_ones_together():
    result = count_branches(random_square(3, seed=0))
    assert result.sign_vectors == Counter({"+++": 2, "++-": 2, "+-+": 2, "+--": 2})
    assert sum(result.sign_vectors.values()) == result.distinct


def test_repeated_assignments_are_counted_up_to_reflection():
    result = count_branches(random_square(4, seed=9))
    table = str.maketrans("MV", "VM")
    texts = [branch.assignment_text for branch in result.branches]
    shared = sum(
        any(k != m and other in (text, text.translate(table)) for m, other in enumerate(texts))
        for k, text in enumerate(texts)
    )
    assert result.repeated_assignments == shared


def test_repr_names_the_status_and_the_count():
    assert repr(count_branches(two_vertex())) == (
        "<BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>"
    )
    dented = scrambled(1, DENTED, 2, loose=True)
    assert "undecided, ? branches" in repr(count_branches(dented))
    hexagon = scrambled(1, HEXAGON, 2, loose=True)
    assert "<BranchCount: proved, <Pieces: proved, 1 of 4 graphs>" in repr(count_branches(hexagon))


def test_html_lists_branches():
    html = count_branches(two_vertex())._repr_html_()
    assert html.startswith("<p>4 branches, <b>proved</b>")
    assert html.count("<tr>") == 5
    assert html.count("<td>") == 20
    assert "more</p>" not in html


def test_html_of_many_branches_is_cut():
    html = count_branches(random_square(7, seed=0))._repr_html_()
    assert html.count("<tr>") == 31
    assert "and 98 more" in html


def test_latex():
    assert count_branches(two_vertex())._repr_latex_() == (
        r"$B = 4\ \text{(proved)},\quad V_i = 2,\ V_e = 4,\ V_t = 0$"
    )
    assert count_branches(scrambled(1, HEXAGON, 2, loose=True))._repr_latex_() is None
    undecided = count_branches(scrambled(1, DENTED, 2, loose=True))
    assert undecided._repr_latex_() == r"$B = {?}\quad \text{(undecided)}$"


def test_rigid_sheet_displays_no_branches():
    result = count_branches(scrambled(1, TRIANGLE, 2))
    assert result._repr_html_().startswith("<p>0 branches, <b>proved</b>")
    assert r"B = 0\ " in result._repr_latex_()
    assert result.sign_vectors == Counter()


def test_status_is_never_a_truth_value():
    result = count_branches(two_vertex())
    assert result.status is PROVED
    with pytest.raises(TypeError, match="no truth value"):
        bool(result.true_branches)
    assert count_branches(scrambled(1, DENTED, 2)).true_branches is UNDECIDED
