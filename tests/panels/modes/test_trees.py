"""Components counted along a tree of vertices, against the list of all linear spaces."""

import random
from collections import Counter
from fractions import Fraction

import pytest
from panel_sheets import miura, outlined
from random_trees import closed, random_tree

from exactfold import checker
from exactfold._support.verdict import PROVED
from exactfold.errors import TooManyModesError
from exactfold.panels import by_spaces
from exactfold.panels.certificate import certificate_of_panels
from exactfold.panels.decomposition import decompose
from exactfold.panels.modes.trees import tree_components
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.panel_pattern import Edge, PanelPattern


@pytest.mark.parametrize("seed", range(8))
def test_random_trees_against_the_list_of_spaces(seed: int) -> None:
    rng = random.Random(seed)
    compared = 0
    while compared < 12:
        made = closed(random_tree(rng, rng.randint(2, 4)))
        counted = tree_components(made)
        if counted is None:  # the flat closure has cut the tree, or nothing is left
            continue
        listed = Counter(leaf.dimension for leaf in leaves(made, *first_order(made), 10**6))
        assert counted == (dict(sorted(listed.items())) or {0: 1})
        compared += 1


@pytest.mark.parametrize("count", [2, 7, 60])
def test_a_chain_of_vertices_with_five_folds_is_one_cone_with_choices_at_its_ends(
    count: int,
) -> None:
    """Each vertex of five folds adds 2 dimensions less a joint; each of four folds 2 choices."""
    five = ((-3, 1), (-1, -2), (1, -3), (3, 1), (1, 2))
    four = ((-3, 1), (-1, -4), (3, 1), (-1, 5))
    made = {}
    for v in range(count):
        rim = [(v, 1000 + 10 * v + k) for k in range(5)]
        ends = {0: (v - 1, v), 3: (v, v + 1)}
        folds = [ends.get(k, rim[k]) if 0 < v < count - 1 else rim[k] for k in range(5)]
        if v in (0, count - 1):
            folds = [(0, 1) if v == 0 else (v - 1, v), *rim[1:4]]
        directions = five if 0 < v < count - 1 else four
        made[v] = Star(v, tuple(folds), tuple((Fraction(x), Fraction(y)) for x, y in directions))
    assert tree_components(made) == {1 + count - 2: 4}


def test_vertices_round_a_face_are_no_tree() -> None:
    assert tree_components(stars(miura(2, 2))) is None
    assert tree_components({}) is None


def test_too_many_neighbours_are_refused() -> None:
    hub = [(0, k + 1) for k in range(9)]
    around = [(8, 1), (6, 5), (2, 7), (-3, 7), (-7, 4), (-8, -1), (-6, -6), (0, -8), (5, -7)]
    made = {0: Star(0, tuple(hub), tuple((Fraction(x), Fraction(y)) for x, y in around))}
    for k in range(9):
        made[k + 1] = Star(k + 1, ((0, k + 1), (k + 1, 100 + k)), ((1, 0), (-1, 0)))
    with pytest.raises(TooManyModesError, match="vertex 0 has 9 neighbours that fold"):
        tree_components(made)


def two_hubs(*more: Edge) -> PanelPattern:
    """Two vertices with four folds, joined by a fold, and more folds."""
    rim = [(-6, -7), (13, -7), (13, 8), (-2, 9), (-9, 3)]
    points = [(Fraction(x), Fraction(y)) for x, y in [(0, 0), (5, 1), *rim]]
    return outlined(points, [(0, 1), (0, 2), (0, 6), (0, 5), (1, 3), (1, 4), (1, 5), *more], 2)


@pytest.mark.parametrize("more", [[], [(0, 3)]], ids=["four and four", "five and four"])
def test_a_sheet_whose_list_is_too_long_is_counted_along_its_tree(
    monkeypatch: pytest.MonkeyPatch, more: list[Edge]
) -> None:
    listed = decompose(two_hubs(*more))
    assert listed.status is PROVED
    monkeypatch.setattr(by_spaces, "MOST_STEPS", 0)
    monkeypatch.setattr("exactfold.panels.modes.elementary._MOST_STEPS", 0)
    counted = decompose(two_hubs(*more))
    assert (counted.status, counted.second_order) == (PROVED, listed.second_order)
    assert (counted.true is None) is bool(more)
    assert counted.found_true == (listed.second_order if more else None)
    assert (counted.modes_count, counted.rigid) == (None, listed.rigid)
    bounds, known = counted.freedom, listed.freedom
    assert bounds is not None
    assert known is not None
    assert bounds.least == bounds.most == known.least <= known.most
    claims = checker.check(certificate_of_panels(counted))
    expected = {str(d): n for d, n in counted.second_order.items()}
    assert claims["trees"] == [{"vertices": [0, 1], "components": expected}]
    assert (claims["second_order"], claims["supports"]) == (expected, [])
