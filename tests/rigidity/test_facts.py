"""The exact facts reported by `info`."""

import json
from itertools import combinations

import pytest
from sheets import (
    TRIANGLE,
    dart,
    nested_triangles,
    random_wheel,
    scrambled,
    straight_side,
    two_triangles,
)

from exactfold.interop.graphs import to_networkx
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.families import hypar, waterbomb
from exactfold.pattern.triangulating.random_squares import random_square, sample_random_square
from exactfold.rigidity.facts import pattern_facts

PATTERNS = {
    "random": random_square(6, seed=2),
    "dart": dart(),
    "nested": nested_triangles(),
    "two triangles": two_triangles(),
    "straight side": straight_side(smallest=False),
    "triangle": scrambled(1, TRIANGLE, 4),
    "hypar": hypar(2),
    "waterbomb": waterbomb(),
    "wheel": random_wheel(3, 12),
    "chord": CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1, 2), (0, 2, 3)]),
}
patterns = pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())


@patterns
def test_rank_stresses_and_inertias(pattern):
    facts = pattern_facts(pattern)
    assert (facts.rigidity_rank, facts.rank_by) == (2 * len(pattern.vertices) - 3, "elimination")
    assert facts.self_stresses == pattern.Vi
    assert set(facts.inertias) == set(pattern.interior)
    for v, inertia in facts.inertias.items():
        assert inertia == (1, pattern.degree(v) - 3, 3)


@patterns
def test_to_dict_agrees_with_the_pattern(pattern):
    data = json.loads(json.dumps(pattern_facts(pattern).to_dict()))
    assert data["edges"] == len(pattern.edges) == 3 * len(pattern.vertices) - 3 - pattern.Ve
    assert data["triangles"] == 2 * len(pattern.vertices) - 2 - pattern.Ve
    shape = data["pattern"]
    assert shape["folds"] == data["edges"] - shape["boundary"]
    assert shape["interior"] + shape["boundary"] == len(pattern.vertices) == len(shape["vertices"])
    assert shape["degrees_of_freedom"] == shape["boundary"] - 3
    assert shape["sha256"] == pattern.sha256
    inside = [v for entry in data["triangulated_triangles"] for v in entry["inside"]]
    assert sorted(inside + data["foldable_vertices"]) == list(pattern.interior)


def test_chords_and_straight_vertices_are_named():
    assert pattern_facts(PATTERNS["chord"]).to_dict()["chords"] == ["0-2"]
    data = pattern_facts(PATTERNS["straight side"]).to_dict()
    assert data["straight_boundary_vertices"] == [1]
    assert data["convex"] is True
    assert pattern_facts(PATTERNS["dart"]).to_dict()["convex"] is False


def test_degree_counts():
    pattern = PATTERNS["random"]
    counts = pattern_facts(pattern).degree_counts
    neighbours = [sum(v in edge for edge in pattern.edges) for v in pattern.interior]
    assert counts == {d: neighbours.count(d) for d in sorted(set(neighbours))}


@pytest.mark.slow
def test_large_patterns_cost_what_their_vertices_cost():
    # A dense matrix of this sheet has 6 * 10^7 entries; curvature forms are asked for one by one.
    asked = []
    pattern = sample_random_square(2000, 1, 1 << 20, redraw=True).pattern
    facts = pattern_facts(pattern, lambda stage, done, total: asked.append((stage, done, total)))
    assert (facts.rigidity_rank, facts.rank_by, facts.self_stresses) == (4005, "theorem", 2000)
    assert facts.to_dict()["rigidity_rank_by"] == "theorem"
    assert asked[0] == ("curvature forms", 0, 2000)
    assert len(asked) == 20


def test_foldable_vertices_lie_outside_every_three_cycle():
    pattern = PATTERNS["two triangles"]
    graph = to_networkx(pattern)
    cycles = [
        t for t in combinations(graph, 3) if all(graph.has_edge(*e) for e in combinations(t, 2))
    ]
    assert len(cycles) == len(pattern.triangles) + 2
    assert pattern.foldable_vertices == tuple(v for v in pattern.interior if pattern.degree(v) > 3)
