"""A flat sheet of stiff bars whose folds have springs that are driven by torques.

The energy is the sum of (c/L) (stretch)^2 / 2 over the bars, plus that of (theta_e - a tau_e)^2 / 2
over the folds (radians, a sheet of radius 1). It shares no formula with exactfold. Run as a
program, it prints how often the sheet ends on the branch that was meant:
`python tests/design/actuation/springs.py 20 2 3 4 6`.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.optimize import least_squares

if __name__ == "__main__":
    sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[2] / "interop")]

from driving import hinges, model_of

from exactfold import CreasePattern, random_square
from exactfold.design import Actuation, actuate

AMOUNT = 0.02
"""a: the angle in radians to which a torque of 1 drives a fold that is alone."""

STIFFNESSES = tuple(10.0**k for k in range(2, 11))
"""c, raised step by step, each time from where the sheet is."""

NOISE = 1e-5
"""Of the heights with which the sheet starts, as it would never leave the exact flat state."""


@dataclass(frozen=True)
class Springs:
    """A sheet and the torques on it."""

    pattern: CreasePattern
    torques: Mapping[tuple[int, int], Fraction]

    @cached_property
    def model(self):
        """Bars and hinges."""
        return model_of(self.pattern)

    @cached_property
    def targets(self) -> np.ndarray:
        """a tau, by hinge."""
        return AMOUNT * np.array([float(self.torques[fold]) for fold in hinges(self.model)])

    def energy(self, x: np.ndarray, stiffness: float) -> float:
        """The energy of the points x."""
        return float(np.sum(self._forces(x, stiffness) ** 2) / 2)

    def _forces(self, x: np.ndarray, stiffness: float) -> np.ndarray:
        model, points = self.model, x.reshape(-1, 3)
        d = points[model.edges[:, 0]] - points[model.edges[:, 1]]
        stretch = np.linalg.norm(d, axis=1) - model.lengths
        off = model.angles(points)[0] - self.targets
        return np.concatenate([np.sqrt(stiffness / model.lengths) * stretch, off])

    def _slopes(self, x: np.ndarray, stiffness: float) -> np.ndarray:
        model, points = self.model, x.reshape(-1, 3)
        bars, count = len(model.edges), len(model.hinges)
        jacobian = np.zeros((bars + count, len(points), 3))
        i, j = model.edges[:, 0], model.edges[:, 1]
        d = points[i] - points[j]
        d *= (np.sqrt(stiffness / model.lengths) / np.linalg.norm(d, axis=1))[:, None]
        rows = np.arange(bars)
        jacobian[rows, i], jacobian[rows, j] = d, -d
        bends = model.angles(points)[1]
        for k in range(4):
            jacobian[bars + np.arange(count), model.hinges[:, k]] = bends[:, k]
        return jacobian.reshape(bars + count, -1)

    def relaxed(self, points: np.ndarray, stiffness: float) -> np.ndarray:
        """A minimum of the energy, from these points."""
        found = least_squares(
            self._forces,
            points.ravel(),
            self._slopes,
            method="trf",
            xtol=1e-13,
            ftol=1e-13,
            gtol=1e-13,
            max_nfev=1000,
            args=(stiffness,),
        )
        return found.x.reshape(-1, 3)

    def driven(self, seed: int) -> np.ndarray:
        """The points to which the flat sheet is driven while the bars become stiffer."""
        points = self.model.points.copy()
        points[:, 2] = NOISE * np.random.default_rng(seed).normal(size=len(points))
        for stiffness in STIFFNESSES:
            points = self.relaxed(points, stiffness)
        return points

    def folds(self, points: np.ndarray) -> dict[tuple[int, int], float]:
        """The fold angles of the sheet in radians."""
        return dict(zip(hinges(self.model), self.model.angles(points)[0], strict=True))


def nearest_ray(found: Actuation, angles: Mapping[tuple[int, int], float]) -> tuple[int, int]:
    """(place, sign) of the ray whose fold angles are nearest in direction to these."""
    theta = np.array([angles[fold] for fold in found.directions.folds])
    cosines = found.directions.middles @ theta
    place = int(np.argmax(np.abs(cosines)))
    return place, int(np.sign(cosines[place]))


def ends_on_the_branch(found: Actuation, torques: Mapping[tuple[int, int], Fraction]) -> bool:
    """Whether the flat sheet that is driven by these torques ends on the ray of `found`."""
    springs = Springs(found.pattern, torques)
    return nearest_ray(found, springs.folds(springs.driven(0))) == (found.place, 1)


def asked(inside: int, seed: int) -> tuple[CreasePattern, str]:
    """A random square with random signs."""
    signs = np.random.default_rng(seed).choice(["+", "-"], inside)
    return random_square(inside, seed=seed), "".join(signs)


def three_torques(found: Actuation) -> dict[str, dict[tuple[int, int], Fraction]]:
    """Those with the best margin, those like the fold angles, and one size by the letters."""
    unit = found.directions.middles[found.place]
    along = dict(zip(found.directions.folds, unit / np.abs(unit).max(), strict=True))
    letter = {"V": Fraction(1), "M": Fraction(-1), "F": Fraction(0)}
    return {
        "best margin": dict(found.torques),
        "fold angles": {fold: Fraction(x) for fold, x in along.items()},
        "letters": {fold: letter[a] for fold, a in found.branch.assignment.items()},
    }


def main(squares: int, *sizes: int) -> None:
    """Print how many of so many squares end on the branch that was meant."""
    for inside in sizes:
        ends: dict[str, int] = {}
        for seed in range(squares):
            found = actuate(*asked(inside, seed))
            for name, torques in three_torques(found).items():
                ends[name] = ends.get(name, 0) + ends_on_the_branch(found, torques)
        told = ", ".join(f"{name} {count}" for name, count in ends.items())
        print(f"Vi = {inside}, {squares} squares: {told}", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
