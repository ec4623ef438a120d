"""Directions and margins by other formulas than exactfold's: geometry in space, dual programs."""

from __future__ import annotations

import json
from itertools import combinations

import numpy as np
from bar_hinge import Model
from scipy.optimize import linprog

from exactfold import Branch, CreasePattern
from exactfold.pattern.writing.fold_writing import fold_text


def model_of(pattern: CreasePattern) -> Model:
    """The bar-and-hinge model of the flat sheet with a hinge on every fold, without springs."""
    document = json.loads(fold_text(pattern))
    document["edges_assignment"] = ["B" if a == "B" else "M" for a in document["edges_assignment"]]
    return Model.of(document, [0.0] * len(document["edges_assignment"]))


def hinges(model: Model) -> list[tuple[int, int]]:
    """The folds in the order of the hinges."""
    return [(min(i, j), max(i, j)) for i, j, *_ in model.hinges.tolist()]


def direction(branch: Branch) -> dict[tuple[int, int], float]:
    """The unit vector of fold angles from dihedral angles of the sheet with small heights."""
    model = model_of(branch.pattern)
    points = model.points.copy()
    heights = branch.approx_heights
    points[:, 2] = [1e-6 * heights[v] for v in range(len(points))]
    theta, _ = model.angles(points)
    return dict(zip(hinges(model), theta / np.linalg.norm(theta), strict=True))


def directions(branches: list[Branch]) -> np.ndarray:
    """The unit vectors as rows, in the order of the folds."""
    rows = [direction(branch) for branch in branches]
    return np.array([[row[fold] for fold in branches[0].pattern.folds] for row in rows])


def gaps(units: np.ndarray, chosen: int) -> np.ndarray:
    """u - u' for every ray u' but the chosen one."""
    rays = [sign * u for b, u in enumerate(units) for sign in (1, -1) if (b, sign) != (chosen, 1)]
    return units[chosen] - np.array(rays)


def dual_optimum(rows: np.ndarray) -> float:
    """The least 1-norm of a convex combination of rows, which is the largest margin."""
    count, folds = rows.shape
    found = linprog(
        [*np.zeros(count), *np.ones(folds)],
        A_ub=np.block([[rows.T, -np.eye(folds)], [-rows.T, -np.eye(folds)]]),
        b_ub=np.zeros(2 * folds),
        A_eq=[[*np.ones(count), *np.zeros(folds)]],
        b_eq=[1.0],
        method="highs-ipm",
    )
    return float(found.fun)


def best_choice(rows: np.ndarray, most: int) -> float:
    """The largest margin over all sets of `most` folds, one program for each."""
    folds = range(rows.shape[1])
    return max(dual_optimum(rows[:, list(chosen)]) for chosen in combinations(folds, most))
