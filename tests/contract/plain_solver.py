"""A solver as a user might write it: Newton's method from random starts, with NumPy alone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from exactfold.rigidity import Chart
from exactfold.solve import Candidates

_AT_ONCE = 256
_ROUNDS = 10
_STEPS = 60


def random_newton(
    chart: Chart, seed: int, progress: Callable[[int, int], None] | None
) -> Candidates:
    """Zeros that Newton's method reaches from random complex starts, until there are 2^n."""
    forms = chart.system.float_tensor
    size, wanted = chart.system.size, chart.system.bezout_number
    source = np.random.default_rng(seed)
    found: list[np.ndarray] = []
    for _ in range(_ROUNDS):
        spread = 10.0 ** source.uniform(-2, 1, (_AT_ONCE, 1))
        parts = source.standard_normal((2, _AT_ONCE, size))
        x = spread * (parts[0] + 1j * parts[1])
        for _ in range(_STEPS):
            z = np.hstack([x, np.ones((_AT_ONCE, 1))])
            rows = np.einsum("pij,bj->bpi", forms, z)
            values = np.einsum("bpi,bi->bp", rows, z) / 2
            step = (np.linalg.pinv(rows[:, :, :-1]) @ values[:, :, None])[:, :, 0]
            x = x - step
        size_of = 1 + np.abs(x).max(axis=1)
        for k in np.flatnonzero(np.abs(step).max(axis=1) < 1e-12 * size_of):
            if all(np.abs(x[k] - other).max() > 1e-6 * size_of[k] for other in found):
                found.append(x[k])
        if progress is not None:
            progress(min(len(found), wanted), wanted)
        if len(found) >= wanted:
            break
    lost = (f"{wanted - len(found)} zeros were not reached",) if len(found) < wanted else ()
    points = np.array(found, dtype=complex).reshape(-1, size)
    return Candidates("random newton", points, lost, {"seed": seed})
