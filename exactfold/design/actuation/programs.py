"""Linear programs that propose torques. Their solutions are floating point and prove nothing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog

from exactfold._support.arrays import BoolArray, FloatArray


@dataclass(frozen=True)
class Proposal:
    """The proposed `torques` by fold, their `margin`, and the dual solution: `weights` of the
    rivals.
    """

    torques: FloatArray
    margin: float
    weights: FloatArray


def largest_margin(
    gaps: FloatArray, allowed: BoolArray, limited: BoolArray | None = None, most: int = 0
) -> Proposal:
    """Maximise m with gaps @ tau >= m and |tau_e| <= 1, where tau_e = 0 unless e is allowed.

    Row r of `gaps` is u - u_r for rival r. If `limited` is given, the sizes of the torques on these
    folds add up to at most `most`. This admits all torques that drive at most `most` of these
    folds, and others.
    """
    count, folds = gaps.shape
    reach = allowed.astype(float)
    # tau = up - down, then m.
    rows = np.column_stack([-gaps, gaps, np.ones(count)])
    limits = np.zeros(count)
    if limited is not None:
        rows = np.vstack([rows, [*limited.astype(float), *limited.astype(float), 0.0]])
        limits = np.append(limits, most)
    solution = linprog(
        [*np.zeros(2 * folds), -1.0],
        A_ub=rows,
        b_ub=limits,
        bounds=[*((0.0, r) for r in [*reach, *reach]), (None, None)],
        method="highs-ds",
    )
    if solution.x is None:
        return Proposal(np.zeros(folds), 0.0, np.full(count, 1 / count))
    weights = np.maximum(-solution.ineqlin.marginals[:count], 0.0)
    total = weights.sum()
    weights = weights / total if total > 0 else np.full(count, 1 / count)
    return Proposal(
        solution.x[:folds] - solution.x[folds : 2 * folds], float(solution.x[-1]), weights
    )


def strongest_within(
    target: FloatArray, silent: FloatArray, allowed: BoolArray
) -> FloatArray | None:
    """Maximise target . tau with silent @ tau = 0 and |tau_e| <= 1; None if the solver fails."""
    reach = allowed.astype(float)
    solution = linprog(
        -target,
        A_eq=silent if len(silent) else None,
        b_eq=np.zeros(len(silent)) if len(silent) else None,
        bounds=[(-r, r) for r in reach],
        method="highs-ds",
    )
    return None if solution.x is None else np.asarray(solution.x, dtype=np.float64)
