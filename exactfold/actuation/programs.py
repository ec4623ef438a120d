"""Linear programs that propose torques; what they return is floating point and proves nothing."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from scipy.optimize import Bounds, LinearConstraint, linprog, milp

from exactfold.arrays import BoolArray, FloatArray

_JOINING = 8
"""Rivals that join the mixed-integer program at once."""

_SHORT = 1e-7
"""A rival that falls short of the margin by less is not added: the solver's tolerance."""


@dataclass(frozen=True)
class Proposal:
    """`torques` by fold, and `weights` of the rivals: the solution of the dual program."""

    torques: FloatArray
    weights: FloatArray


def largest_margin(gaps: FloatArray, allowed: BoolArray, most: int | None = None) -> Proposal:
    """Maximise m with gaps @ tau >= m, |tau_e| <= 1, tau_e = 0 unless allowed, |tau|_1 <= most.

    Row r of `gaps` is u - u_r for rival r. The bound of the sum replaces, with `most`, the bound of
    the number of folds driven: it admits more, so that the dual solution is a bound for both.
    """
    count, folds = gaps.shape
    reach = allowed.astype(float)
    # tau = up - down, then m.
    rows = np.column_stack([-gaps, gaps, np.ones(count)])
    limits = np.zeros(count)
    if most is not None:
        rows = np.vstack([rows, [*np.ones(2 * folds), 0.0]])
        limits = np.append(limits, most)
    found = linprog(
        [*np.zeros(2 * folds), -1.0],
        A_ub=rows,
        b_ub=limits,
        bounds=[*((0.0, r) for r in [*reach, *reach]), (None, None)],
        method="highs-ds",
    )
    if found.x is None:
        return Proposal(np.zeros(folds), np.full(count, 1 / count))
    weights = np.maximum(-found.ineqlin.marginals[:count], 0.0)
    total = weights.sum()
    weights = weights / total if total > 0 else np.full(count, 1 / count)
    return Proposal(found.x[:folds] - found.x[folds : 2 * folds], weights)


def chosen_folds(gaps: FloatArray, allowed: BoolArray, most: int, seconds: float) -> BoolArray:
    """At most `most` folds on which the largest margin is as large as found within `seconds`.

    A mixed-integer program: z_e is 1 where fold e is driven, |tau_e| <= z_e, sum z_e <= most. Few
    rivals decide: it is solved for some, and those that the solution leaves below its margin join
    them. Where the time is over, the folds with the largest torques so far are taken, or those of
    the linear program if these do better.
    """
    end = time.monotonic() + seconds
    relaxed = largest_margin(gaps, allowed, most)
    known = np.flatnonzero(relaxed.weights > 0)
    supports = [_largest(relaxed.torques, allowed, most)]
    while True:
        left = end - time.monotonic()
        found = None if left <= 0 else _mixed(gaps[known], allowed, most, left)
        if found is None:
            break
        torques, margin = found
        supports.append(_largest(torques, allowed, most))
        values = gaps @ torques
        worst = np.argsort(values, kind="stable")[:_JOINING]
        joining = np.setdiff1d(worst[values[worst] < margin - _SHORT], known)
        if not len(joining):
            break
        known = np.union1d(known, joining)
    margins = [(gaps @ largest_margin(gaps, support).torques).min() for support in supports]
    return supports[int(np.argmax(margins))]


def _largest(torques: FloatArray, allowed: BoolArray, most: int) -> BoolArray:
    """The folds with the largest torques, `most` of those allowed."""
    chosen = np.zeros(len(torques), dtype=np.bool_)
    sizes = np.where(allowed, np.abs(torques), -1.0)
    chosen[np.argsort(-sizes, kind="stable")[:most]] = True
    return chosen & allowed


def _mixed(
    gaps: FloatArray, allowed: BoolArray, most: int, seconds: float
) -> tuple[FloatArray, float] | None:
    """Torques on at most `most` folds and their margin over the rivals of `gaps`."""
    count, folds = gaps.shape
    one, column = np.eye(folds), np.zeros((folds, 1))
    rows = np.vstack(
        [
            np.column_stack([gaps, np.zeros((count, folds)), -np.ones(count)]),
            np.column_stack([-one, one, column]),
            np.column_stack([one, one, column]),
            [*np.zeros(folds), *-np.ones(folds), 0.0],
        ]
    )
    least = [*np.zeros(count + 2 * folds), -float(most)]
    reach = allowed.astype(float)
    found = milp(
        [*np.zeros(2 * folds), -1.0],
        constraints=LinearConstraint(rows, least, np.inf),
        integrality=[*np.zeros(folds), *np.ones(folds), 0],
        bounds=Bounds([*-reach, *np.zeros(folds), 0.0], [*reach, *reach, np.inf]),
        options={"time_limit": seconds},
    )
    if found.x is None:
        return None
    return np.asarray(found.x[:folds], dtype=np.float64), float(found.x[-1])


def strongest_within(
    target: FloatArray, silent: FloatArray, allowed: BoolArray
) -> FloatArray | None:
    """Maximise target . tau with silent @ tau = 0, |tau_e| <= 1; None if that fails."""
    reach = allowed.astype(float)
    found = linprog(
        -target,
        A_eq=silent if len(silent) else None,
        b_eq=np.zeros(len(silent)) if len(silent) else None,
        bounds=[(-r, r) for r in reach],
        method="highs-ds",
    )
    return None if found.x is None else np.asarray(found.x, dtype=np.float64)
