"""All methods find the same branches."""

import pytest
from counting import check_generic, summary
from sheets import SQUARE, reflex_corners, scrambled, straight_side

from exactfold import random_square
from exactfold.branches import count_branches
from exactfold.pattern.families import h1_sequence

AGREEMENT = {
    **{f"random square {n}-{s}": random_square(n, seed=s) for n in (1, 2, 3, 4) for s in (5, 6)},
    "h1": h1_sequence(3, seed=4),
    "scrambled": scrambled(9, SQUARE, 4),
    "reflex": scrambled(7, reflex_corners(7), 3, loose=True),
    "straight side": straight_side(smallest=False),
}


@pytest.mark.parametrize("pattern", AGREEMENT.values(), ids=AGREEMENT.keys())
def test_methods_agree(pattern):
    results = [
        count_branches(pattern, method=m) for m in ("newton", "popping", "homotopy", "groebner")
    ]
    for result in results:
        check_generic(pattern, result)
        assert summary(result) == summary(results[0])
        for one, other in zip(result.branches, results[0].branches, strict=True):
            for v in range(len(pattern.vertices)):
                (a, b), (c, d) = one.heights[v], other.heights[v]
                assert max(a, c) <= min(b, d)


@pytest.mark.parametrize("seed", [0, 1, 12345])
def test_seed_of_the_homotopy_does_not_matter(seed):
    pattern = random_square(3, seed=2)
    result = count_branches(pattern, method="homotopy", seed=seed)
    assert summary(result) == summary(count_branches(pattern))
