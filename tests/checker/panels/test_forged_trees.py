"""Components counted along trees of vertices: against the package, and forged."""

from __future__ import annotations

import random

import pytest
from forge import beyond, given, refused, stopped, verified, with_one_key_more, without
from random_trees import closed, random_tree

from exactfold import checker
from exactfold.checker.core.towers import Tower
from exactfold.checker.panels import trees
from exactfold.checker.sheets.panels import Near, PanelSheet, Vector, connected, read_panels
from exactfold.panels.modes.trees import tree_components
from exactfold.panels.vertex.stars import Star


class Stars(PanelSheet):
    """Stars that need not fit together in the plane."""

    def __init__(self, made: dict[int, Star]) -> None:
        self.tower = Tower()
        self.vectors: dict[tuple[int, int], Vector] = {}
        for v, star in made.items():
            for edge, (x, y) in zip(star.folds, star.directions, strict=True):
                self.vectors[v, sum(edge) - v] = self.tower.number(x), self.tower.number(y)

    def vector(self, v: int, u: int) -> Vector:
        return self.vectors[v, u]


@pytest.mark.parametrize("seed", range(8))
def test_random_trees_as_the_package_counts_them(seed: int) -> None:
    rng = random.Random(seed)
    compared = 0
    while compared < 20:
        made = closed(random_tree(rng, rng.randint(1, 8)))
        expected = tree_components(made)
        if expected is None:
            continue
        near: Near = {v: [sum(e) - v for e in made[v].folds] for v in sorted(made)}
        assert trees.tree_components(Stars(made), near) == expected
        compared += 1


def test_what_is_said() -> None:
    assert "4 of dimension 1 to second order, and those of the true motions are the same" in (
        checker.summary(verified(given("panels-tree")))
    )
    assert "are not decided (at least 2 components of its parts extend to true motions)" in (
        checker.summary(verified(given("panels-tree-cone")))
    )
    claims = verified(given("panels-tree-cone"))
    assert (claims["true"], claims["modes"], claims["rigid"]) == (None, None, "refuted")


def test_keys() -> None:
    document = with_one_key_more(given("panels-tree"), ("claims", "trees", 0))
    refused(document, "a tree: expected an object with the keys vertices components")
    document = given("panels-crossing")
    document["claims"]["trees"] = []
    refused(
        document,
        "claims: expected an object with the keys interior border folds sha256 held flat free "
        "second_order true rigid modes supports",
    )


def test_components_are_counted() -> None:
    for forged in ({"1": 3}, {"1": True}, {"1": 4, "2": 0}):
        document = given("panels-tree")
        document["claims"]["trees"][0]["components"] = forged
        stopped(document, "the tree of vertex 0 has the components {'1': 4}")


def test_vertices_are_those_of_a_part() -> None:
    for forged in ([0], [1, 0], [0, 1, 2]):
        document = given("panels-tree")
        document["claims"]["trees"][0]["vertices"] = forged
        refused(document, "the vertices of a tree are not those of a part")
    document = given("panels-tree")
    document["claims"]["trees"] *= 2
    stopped(document, "the tree of vertex 0 appears twice")


def test_vertices_round_a_face_are_no_tree() -> None:
    document = given("panels-tiling")
    sheet, _ = read_panels(document["pattern"])
    [part] = connected(sheet.live([]))
    message = f"the vertices of the part of vertex {min(part)} do not form a tree"
    with without(message):
        counts = {str(d): n for d, n in trees.tree_components(sheet, part).items()}
    claims = document["claims"]
    claims |= {"trees": [{"vertices": list(part), "components": counts}], "supports": []}
    claims |= {"second_order": counts, "true": counts, "modes": None, "rigid": "undecided"}
    stopped(document, message)


def test_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trees, "MOST_JOINTS", 0)
    stopped(given("panels-tree"), beyond("the joints of one vertex of a tree", 1, 0, "TREE_JOINTS"))
    monkeypatch.setattr(trees, "MOST_JOINTS", 1)
    monkeypatch.setattr(trees, "MOST_CASES", 0)
    stopped(given("panels-tree"), beyond("the cases of a tree of vertices", 1, 0, "TREE_CASES"))
