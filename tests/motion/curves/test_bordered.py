"""Dense and sparse factors of a Jacobian with one unknown held are the same matrix."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.linalg import LinAlgError

from exactfold.motion.curves import bordered
from exactfold.motion.curves.bordered import factors_of, sign_of
from exactfold.motion.curves.framework import Framework
from exactfold.pattern.triangulating.random_squares import random_square


@pytest.fixture(params=[0, 10**6])
def limit(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> int:
    """All matrices are sparse, or all are dense."""
    monkeypatch.setattr(bordered, "DENSE", request.param)
    return int(request.param)


@pytest.mark.parametrize("seed", range(4))
def test_solutions_and_the_sign_are_those_of_the_matrix(limit: int, seed: int) -> None:
    framework = Framework.of(random_square(3 + seed, seed=seed))
    source = np.random.default_rng(seed)
    rows = framework.flat_edges + framework.along(source.normal(size=framework.size))
    for held in source.integers(framework.size, size=4).tolist():
        matrix = np.vstack([framework.matrix(rows).toarray(), np.eye(framework.size)[held]])
        right = source.normal(size=framework.size)
        factors = factors_of(framework, rows, held)
        assert np.allclose(matrix @ factors.solve(right), right)
        sign = round(float(np.linalg.slogdet(matrix)[0]))
        assert factors.sign == sign_of(framework, rows, held) == sign != 0


def test_a_singular_matrix_has_no_factors_and_no_sign(limit: int) -> None:
    framework = Framework.of(random_square(2, seed=0))
    rows = np.zeros((len(framework.bars), 3))
    with pytest.raises(LinAlgError):
        factors_of(framework, rows, 0)
    assert sign_of(framework, rows, 0) == 0


def test_a_dense_matrix_may_be_too_badly_conditioned() -> None:
    framework = Framework.of(random_square(2, seed=0))
    rows = framework.flat_edges + framework.along(np.linspace(-1, 1, framework.size))
    factors_of(framework, rows, 0, 2.0**48)
    with pytest.raises(LinAlgError, match="precision"):
        factors_of(framework, rows, 0, 1.0)
