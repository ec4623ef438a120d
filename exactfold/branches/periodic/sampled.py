"""Branches of a periodic sheet over the circle of directions in floating point, for pictures."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.progress import Progress
from exactfold.branches.periodic.shown import Shown
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.pattern.validate import orientation
from exactfold.rigidity.equations.periodic import PeriodicProblem, bend_of
from exactfold.solve.numeric.periodic_rays import PeriodicRays, floats

_DENOMINATOR = 2000


@dataclass(frozen=True)
class SampledBranch:
    """A pair of opposite sign vectors: b and all folds by direction, in floats.

    The largest fold is 1 in each direction. `b` has shape (m,): the curvature of the cylinder times
    the square root of the area of a cell. `folds` has shape (m, edges), positive for valleys.
    """

    vertex_signs: str
    b: FloatArray
    folds: FloatArray


def sampled_directions(
    pattern: PeriodicPattern, number: int, progress: Progress | None = None
) -> tuple[FloatArray, list[SampledBranch]]:
    """The angles of `number` directions in degrees, between 0 and 180, and all branches there.

    Nothing here is proved. Where the sheet has pleats, a sign vector may lead to one (b = 0).

    >>> from exactfold.pattern.periodic.cell_files import read_cell
    >>> angles, branches = sampled_directions(read_cell("waterbomb-cell"), 2)
    >>> angles.tolist(), [branch.vertex_signs for branch in branches]
    ([45.0, 135.0], ['+--', '+-+', '++-', '+++'])
    """
    angles = np.array([(k + 0.5) * 180 / number for k in range(number)])
    names: list[str] = []
    bends: list[FloatArray] = []
    folds: list[FloatArray] = []
    for k, angle in enumerate(np.radians(angles).tolist()):
        if progress is not None:
            progress("directions", k, number)
        direction = [
            Fraction(float(x)).limit_denominator(_DENOMINATOR)
            for x in (np.cos(angle), np.sin(angle))
        ]
        problem = PeriodicProblem.of(pattern, direction)
        rays = PeriodicRays(problem)
        z = rays.rays()
        jumps = z @ _slopes(problem).T
        size = np.abs(jumps).max(axis=1)
        p, q = problem.direction
        scale = float(problem.unit) * (p * p + q * q) * float(problem.sheet.area) ** 0.5
        bends.append(z[:, -1] * scale / size)
        folds.append(jumps / size[:, None])
        if not names:
            shown = Shown(problem)
            names = [shown.signs(row) for row in rays.signs.astype(int).tolist()]
    curves = np.array(bends), np.array(folds)
    order = sorted(range(len(names)), key=lambda k: names[k].translate(_ORDER))
    return angles, [SampledBranch(names[k], curves[0][:, k], curves[1][:, k]) for k in order]


_ORDER = str.maketrans("-0+", "012")


def _slopes(problem: PeriodicProblem) -> FloatArray:
    """Rows on z: the jump of the slope across each fold, which is its angle to first order."""
    sheet = problem.sheet
    rows = []
    for edge in sheet.edges:
        u, v, i, j = edge
        left, right = sheet.opposite(edge)
        a, b, c, d = map(sheet.place, ((u, 0, 0), (v, i, j), left, right))
        length = float((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2) ** 0.5
        share = length / float(orientation(a, b, c) * abs(orientation(a, b, d)))
        rows.append(floats([bend_of(sheet, edge, problem.height)])[0] * share)
    return np.array(rows)
