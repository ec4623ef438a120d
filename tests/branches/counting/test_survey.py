"""The ensemble of the literature at full size: a hundred random squares a size, all proved."""

import pytest

from exactfold import PROVED, checker, random_square
from exactfold.branches import certificate, count_branches


@pytest.mark.parametrize(
    "interior",
    [
        pytest.param(k, marks=getattr(pytest.mark, "slow" if k < 6 else "survey"))
        for k in range(2, 9)
    ],
)
def test_hundred_random_squares_are_proved(interior: int) -> None:
    for seed in range(100):
        pattern = random_square(interior, seed)
        result = count_branches(pattern)
        assert result.status is PROVED, (seed, result.reason)
        assert result.true_branches is PROVED
        free = pattern.Vi - pattern.Vt
        assert result.distinct == result.real == 1 << free, seed
        assert result.with_multiplicity == 1 << interior
        pairs = result.sign_vectors
        assert set(pairs.values()) == {2}, seed
        assert len(pairs) == 1 << (free - 1)
        if seed % 10 == 0:
            claims = checker.check(certificate(result))
            assert claims["distinct"] == result.distinct
