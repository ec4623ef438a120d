"""A bar-and-hinge model: what a simulator does with the fold angles of a FOLD file.

Stiff bars on all edges, a spring on every fold that pulls its angle to a share of the target, with
the stiffnesses that Origami Simulator starts with (axial 20 / L, fold 0.7 L, sheet of radius 1).
Folds with the letter U are free there, and here. It reads the file as such a program does, and
shares no formula with exactfold.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import least_squares

AXIAL, FOLD = 20.0, 0.7


@dataclass(frozen=True)
class Model:
    """A flat sheet: `points` (V, 3), `edges` (E, 2), `hinges` (F, 4) as ends, left, right."""

    points: np.ndarray
    edges: np.ndarray
    lengths: np.ndarray
    hinges: np.ndarray
    targets: np.ndarray
    springs: np.ndarray

    @classmethod
    def of(cls, document: dict[str, Any], targets: list[float] | None = None) -> Model:
        """From a FOLD object; `targets` in degrees replace its `edges_foldAngle`."""
        flat = np.array(document["vertices_coords"], dtype=float)
        assert flat.shape[1] == 2
        flat = flat - (flat.max(axis=0) + flat.min(axis=0)) / 2
        flat /= np.max(np.linalg.norm(flat, axis=1))
        third = {}
        for a, b, c in document["faces_vertices"]:
            third |= {(a, b): c, (b, c): a, (c, a): b}
        angles = document["edges_foldAngle"] if targets is None else targets
        edges = np.array(document["edges_vertices"])
        lengths = np.linalg.norm(flat[edges[:, 0]] - flat[edges[:, 1]], axis=1)
        rows, wanted, springs = [], [], []
        for k, (i, j) in enumerate(document["edges_vertices"]):
            letter = document["edges_assignment"][k]
            if letter != "B":
                rows.append((i, j, third[i, j], third[j, i]))
                wanted.append(np.radians(angles[k]))
                springs.append(0.0 if letter == "U" else FOLD * lengths[k])
        points = np.column_stack([flat, np.zeros(len(flat))])
        hinges, targets_ = np.array(rows), np.array(wanted)
        return cls(points, edges, lengths, hinges, targets_, np.array(springs))

    def angles(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Fold angles in radians, a valley positive, and their gradients (F, 4, 3)."""
        i, j, left, right = (points[self.hinges[:, k]] for k in range(4))
        along = j - i
        length = np.linalg.norm(along, axis=1, keepdims=True)
        along = along / length
        normals, arms, shares = [], [], []
        for wing, side in ((left, 1), (right, -1)):
            normal = side * np.cross(along, wing - i)
            arm = np.linalg.norm(normal, axis=1, keepdims=True)
            normals.append(normal / arm)
            arms.append(arm)
            shares.append(np.sum(along * (wing - i), axis=1, keepdims=True) / length)
        sine = np.sum(np.cross(normals[0], along) * normals[1], axis=1)
        theta = np.arctan2(sine, np.sum(normals[0] * normals[1], axis=1))
        a, b = normals[0] / arms[0], normals[1] / arms[1]
        first = -(1 - shares[0]) * a - (1 - shares[1]) * b
        second = -shares[0] * a - shares[1] * b
        return theta, np.stack([first, second, a, b], axis=1)

    def forces(self, x: np.ndarray, share: float) -> np.ndarray:
        """Residuals whose squares add up to twice the energy, targets scaled by `share`."""
        points = x.reshape(-1, 3)
        d = points[self.edges[:, 0]] - points[self.edges[:, 1]]
        stretch = np.linalg.norm(d, axis=1) - self.lengths
        off = self.angles(points)[0] - share * self.targets
        return np.concatenate(
            [np.sqrt(AXIAL / self.lengths) * stretch, np.sqrt(self.springs) * off]
        )

    def slopes(self, x: np.ndarray, share: float) -> np.ndarray:
        """The derivative of `forces`; it does not depend on `share`."""
        points = x.reshape(-1, 3)
        bars, hinges = len(self.edges), len(self.hinges)
        jacobian = np.zeros((bars + hinges, len(points), 3))
        i, j = self.edges[:, 0], self.edges[:, 1]
        d = points[i] - points[j]
        d *= (np.sqrt(AXIAL / self.lengths) / np.linalg.norm(d, axis=1))[:, None]
        rows = np.arange(bars)
        jacobian[rows, i], jacobian[rows, j] = d, -d
        bends = np.sqrt(self.springs)[:, None, None] * self.angles(points)[1]
        for k in range(4):
            jacobian[bars + np.arange(hinges), self.hinges[:, k]] = bends[:, k]
        return jacobian.reshape(bars + hinges, -1)

    def folded(self, steps: int = 10) -> np.ndarray:
        """The points after folding from the flat sheet to the targets in `steps` equal steps."""
        x = self.points.ravel()
        for k in range(1, steps + 1):
            x = least_squares(self.forces, x, self.slopes, method="lm", args=(k / steps,)).x
        return x.reshape(-1, 3)


@dataclass(frozen=True)
class State:
    """What is seen of a folded model: letters by edge, signs of the interior vertices."""

    letters: dict[tuple[int, int], str]
    signs: dict[int, int]


def state(model: Model, points: np.ndarray) -> State:
    """A vertex is up where its fold angles add up to less than 0: the sheet bends down from it."""
    theta, _ = model.angles(points)
    letters, sums = {}, dict.fromkeys(range(len(points)), 0.0)
    for (i, j, *_), angle in zip(model.hinges.tolist(), theta, strict=True):
        letters[i, j] = "V" if angle > 0 else "M"
        sums[i] += angle
        sums[j] += angle
    return State(letters, {v: -int(np.sign(total)) for v, total in sums.items()})


def read(path: Path) -> dict[str, Any]:
    """The file as JSON, as programs other than exactfold read it."""
    document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return document
