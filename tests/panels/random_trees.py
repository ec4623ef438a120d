"""Stars of vertices on random trees."""

import random
from fractions import Fraction
from math import atan2

import networkx as nx

from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge


def random_tree(rng: random.Random, count: int) -> dict[int, Star]:
    """Vertices on a random tree; small directions, so that there are many straight pairs."""
    tree = nx.random_labeled_tree(count, seed=rng.randrange(10**9))
    made: dict[int, Star] = {}
    for v in tree:
        number = max(rng.choice((4, 4, 5, 6)), tree.degree(v))
        around: dict[float, tuple[int, int]] = {}
        while len(around) < number:
            x, y = rng.randint(-3, 3), rng.randint(-3, 3)
            if (x, y) != (0, 0):
                around[round(atan2(y, x), 9)] = (x, y)
        ends = [*tree[v], *(100 * (v + 1) + k for k in range(number - tree.degree(v)))]
        rng.shuffle(ends)
        folds = tuple((min(v, u), max(v, u)) for u in ends)
        directions = tuple((Fraction(x), Fraction(y)) for _, (x, y) in sorted(around.items()))
        made[v] = Star(v, folds, directions)
    return made


def closed(made: dict[int, Star]) -> dict[int, Star]:
    """The stars after the flat closure, as `stars` makes them of a pattern."""
    while True:
        flat: set[Edge] = set()
        for star in made.values():
            kept = star.foldable() if star.folds else ()
            flat |= {edge for k, edge in enumerate(star.folds) if k not in kept}
        if not flat:
            return {v: star for v, star in made.items() if star.folds}
        made = {v: star.only(set(star.folds) - flat) for v, star in made.items()}
