"""What is raised by moving vertices: distances to other letters, or the margin of torques."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.design.actuation.programs import largest_margin
from exactfold.design.moving.distances import face_distances, fold_distances
from exactfold.design.tolerance.gradients import Gradients
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_NEAREST = 48
"""So many branches, the nearest to other letters, are looked at in each step."""
_THIN = 0.1
"""A triangle keeps this share of its least height, and a fold this share of its density."""


@dataclass(eq=False)
class Sheets:
    """Sheets with the folds of one pattern, by the places of the vertices that may move."""

    pattern: CreasePattern
    part: Gradients
    movable: tuple[int, ...]

    @property
    def start(self) -> FloatArray:
        """The places of the movable vertices; (2 k,)."""
        return self.part.points[list(self.movable)].ravel()

    def points(self, places: FloatArray) -> FloatArray:
        """All vertices of sheets; (B, 2 k) to (B, V, 2)."""
        points = np.repeat(self.part.points[None], len(places), axis=0)
        points[:, list(self.movable)] = places.reshape(len(places), -1, 2)
        return points

    def faces(self, points: FloatArray) -> FloatArray:
        """Half the least height of each triangle; (B, F)."""
        return face_distances(points, self.pattern.triangles)


class Distances:
    """Signed distances of the folds of some branches from other letters than the wanted ones.

    `signs` has 1 for a valley, -1 for a mountain and 0 for a fold that may have any letter; (B, E).
    If `with_faces`, the distances of triangles are raised, too.
    """

    def __init__(
        self, sheets: Sheets, zeros: FloatArray, signs: FloatArray, *, with_faces: bool
    ) -> None:
        self.sheets, self.zeros, self.signs = sheets, zeros, signs
        self.with_faces = with_faces
        self.floor = _THIN * sheets.faces(sheets.points(sheets.start[None]))[0]
        self.chosen: IndexArray = np.arange(len(zeros))
        self.accept(sheets.start)

    def accept(self, places: FloatArray) -> None:
        """Follow the zeros to these places, and choose the branches that are looked at next."""
        points = np.repeat(self.sheets.points(places[None]), len(self.zeros), axis=0)
        distances, self.zeros = fold_distances(self.sheets.part, self.zeros, points)
        least = np.where(self.signs != 0, self.signs * distances, np.inf).min(axis=1)
        self.chosen = np.argsort(least)[:_NEAREST]

    def __call__(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The distances at these places; and how much higher triangles are than they have to be."""
        points = self.sheets.points(places)
        number, few = len(places), len(self.chosen)
        zeros = np.tile(self.zeros[self.chosen], (number, 1))
        found, _ = fold_distances(self.sheets.part, zeros, np.repeat(points, few, axis=0))
        signed = found.reshape(number, few, -1) * self.signs[self.chosen]
        wanted = signed[:, self.signs[self.chosen] != 0]
        faces = self.sheets.faces(points)
        raised = np.concatenate([wanted, faces], axis=1) if self.with_faces else wanted
        return raised, faces - self.floor


class Margin:
    """The power of torques on one ray less that on each rival, with the best torques for it.

    `signs` are those of the densities on the ray, which are kept. If `is_free`, the torques of each
    place are the best there, and only the least margin is a function; otherwise they are those of
    the last accepted place.
    """

    is_free = False

    def __init__(self, sheets: Sheets, zeros: FloatArray, target: int, signs: FloatArray) -> None:
        self.sheets, self.zeros, self.target, self.signs = sheets, zeros, target, signs
        self.floor = _THIN * sheets.faces(sheets.points(sheets.start[None]))[0]
        bends = sheets.part.bends(zeros[[target]], sheets.part.points)[0]
        self.flattest = _THIN * bends * signs
        self.torques: FloatArray = np.zeros(len(sheets.part.folds))
        self.accept(sheets.start)

    def accept(self, places: FloatArray) -> None:
        """Follow the zeros to these places, and choose the best torques there."""
        points = np.repeat(self.sheets.points(places[None]), len(self.zeros), axis=0)
        self.zeros = self.sheets.part.newton(self.zeros, points)
        gaps = self._gaps(self.zeros, points)
        self.torques = self._best(gaps)

    def _best(self, gaps: FloatArray) -> FloatArray:
        if not np.isfinite(gaps).all():
            return self.torques
        return largest_margin(gaps, np.ones(gaps.shape[1], dtype=bool)).torques

    def __call__(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The margins over all rivals; and how much larger densities on the ray and heights of
        triangles are than they have to be.
        """
        rows, kept = [], []
        for points in self.sheets.points(places):
            many = np.repeat(points[None], len(self.zeros), axis=0)
            found = self.sheets.part.newton(self.zeros, many)
            bends = self.sheets.part.bends(found[self.target][None], points)[0]
            gaps = self._gaps(found, many)
            if self.is_free:
                rows.append((gaps @ self._best(gaps)).min(keepdims=True))
            else:
                rows.append(gaps @ self.torques)
            heights = self.sheets.faces(points[None])[0] - self.floor
            kept.append(np.concatenate([bends * self.signs - self.flattest, heights]))
        return np.array(rows), np.array(kept)

    def _gaps(self, zeros: FloatArray, points: FloatArray) -> FloatArray:
        """u - u_r for the unit vectors of fold angles of the ray and its rivals; (2 B - 1, E)."""
        part = self.sheets.part
        lengths = np.linalg.norm(part.directions(points), axis=2)
        angles = part.bends(zeros, points) * lengths
        units = angles / np.linalg.norm(angles, axis=1, keepdims=True)
        side = np.sign(float((units[self.target] * self.signs).sum()))
        own = side * units[self.target]
        others = np.delete(units, self.target, axis=0)
        rivals = np.concatenate([others, -others, -own[None]])
        return np.asarray(own[None] - rivals)


def signs_of(part: Gradients, letters: Mapping[Edge, str]) -> FloatArray:
    """1 for a valley, -1 for a mountain, 0 for every other fold, in the order of the folds."""
    values = {"V": 1.0, "M": -1.0}
    return np.array([values.get(letters.get(fold, "U"), 0.0) for fold in part.folds])
