"""The parts of the proof of Theorem 4, against independent constructions."""

import random
from collections.abc import Sequence
from fractions import Fraction

import networkx as nx
import pytest

from exactfold import random_square
from exactfold.exact.linalg import inertia_by_elimination
from exactfold.pattern.families import flat_vertex_square
from exactfold.rigidity import curvature_form
from proofs.chambers import counted, inertia_at, jacobian, vertex_signs
from proofs.level_pairs import alternating, partners
from proofs.patterns import hostile_patterns
from proofs.tutte import (
    drawing,
    equal_weights,
    fold_weight,
    lifting,
    own_weights,
)


def partners_by_graph(values: Sequence[int]) -> list[int | None]:
    """Components of the graph of all level pairs, cut at the critical values."""
    count = len(values)
    top = count  # levels k..k+1 of the critical values 0, 1, ..., count - 1; -1 is below all
    ends = [float("inf"), *values, float("inf")]
    pieces = [(min(ends[k], ends[k + 1]), max(ends[k], ends[k + 1])) for k in range(count + 1)]
    graph: nx.Graph = nx.Graph()
    covers = {
        (a, b, level)
        for level in range(top)
        for a in range(count + 1)
        for b in range(a + 1, count + 1)
        if all(low <= level < high for low, high in (pieces[a], pieces[b]))
    }
    graph.add_nodes_from(covers)
    for a, b, level in covers:
        if (a, b, level + 1) in covers:
            graph.add_edge((a, b, level), (a, b, level + 1))
    for crit, value in enumerate(values):
        side = value if crit % 2 == 0 else value - 1  # the level next to the critical point
        for other in range(count + 1):
            low, high = pieces[other]
            if other not in (crit, crit + 1) and low < value < high:
                left, right = ((*sorted((piece, other)), side) for piece in (crit, crit + 1))
                graph.add_edge(left, right)
        graph.add_edge(("meet", crit), (crit, crit + 1, side))
    found: list[int | None] = [None] * count
    for part in nx.connected_components(graph):
        meets = [node[1] for node in part if node[0] == "meet"]
        if len(meets) == 2:
            found[meets[0]], found[meets[1]] = meets[1], meets[0]
    return found


@pytest.mark.parametrize("count", [1, 3, 5, 7])
def test_partners_are_components_of_the_level_pairs(count: int) -> None:
    for values in alternating(count):
        assert partners(values) == partners_by_graph(values)


def test_number_of_alternating_orders() -> None:
    assert [sum(1 for _ in alternating(n)) for n in (1, 3, 5, 7)] == [1, 2, 16, 272]


def test_sum_over_critical_points_is_one_up_to_sign() -> None:
    source = random.Random(0)
    for values in alternating(7):
        found = partners(values)
        chord = [source.choice((1, -1)) for _ in values]
        for k, other in enumerate(found):
            chord[k] = chord[k if other is None else min(k, other)]
        assert abs(sum((-1) ** k * c for k, c in enumerate(chord))) == 1


def test_own_weights_reproduce_the_pattern() -> None:
    pattern = next(p for p in hostile_patterns(24) if p.Vi > 3 and not p.chords)
    weights = own_weights(pattern)
    assert all(sum(row.values()) == 1 for row in weights.values())
    assert all(set(row) == set(pattern.star(v)) for v, row in weights.items())
    assert drawing(pattern, weights) == pattern


def test_the_lifting_of_another_drawing_is_no_lifting() -> None:
    pattern = random_square(4, 0)
    tutte = drawing(pattern, equal_weights(pattern))
    for sheet, right in ((tutte, True), (pattern, False)):
        heights = lifting(sheet)
        assert all(fold_weight(sheet, f, heights) == 1 for f in sheet.folds) is right


def test_a_single_peak_need_not_have_positive_curvature() -> None:
    """Why J is not positive on e_v: raising the hub alone can have K < 0 in a spiky star."""
    pattern = next(
        p
        for p in hostile_patterns(60)
        if any(curvature_form(p, v).matrix[0][0] < 0 for v in p.interior)
    )
    assert pattern.is_convex


def test_inertia_at_is_not_decided_on_a_wide_box() -> None:
    pattern = random_square(2, 0)
    branch = counted(pattern).branches[0]
    narrow = branch.heights
    wide = {v: (low - 1, high + 1) for v, (low, high) in narrow.items()}
    assert inertia_at(pattern, narrow, set()) is not None
    assert inertia_at(pattern, wide, set()) is None


def test_inertia_at_counts_flat_vertices_as_zero() -> None:
    pattern = flat_vertex_square()
    found = set()
    for branch in counted(pattern).branches:
        flat = {v for v, s in branch.vertex_signs.items() if s == 0}
        found.add((branch.sign_text, inertia_at(pattern, branch.heights, flat)))
    assert found == {("+0", (1, 0, 1)), ("-+", (1, 1, 0)), ("--", (0, 2, 0))}


def test_inertia_of_a_pyramid_and_its_reflection() -> None:
    pattern = random_square(1, 0)
    up = {v: Fraction(int(v in pattern.interior)) for v in range(5)}
    down = {v: -h for v, h in up.items()}
    assert vertex_signs(pattern, up) == (1,)
    assert inertia_by_elimination(jacobian(pattern, up)) == (1, 0, 0)
    assert inertia_by_elimination(jacobian(pattern, down)) == (0, 1, 0)
