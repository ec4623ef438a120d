"""The conditions of a sheet in the gradients of its panels, quadratic in gradients and vertices.

A panel f has the gradient g_f, a vector of the plane. Two panels meet along the fold from a to b if
(g_f - g_f') . (U_b - U_a) = 0, and a vertex closes if the polygon of the gradients around it has
the signed area 0. These conditions are all of second order (docs/tolerance.md, 1). The
first are bilinear in gradients and vertices, the second have no vertex in them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from networkx.utils import UnionFind

from exactfold._support.arrays import ComplexArray, FloatArray, inverses
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_STEPS = 12

Zeros: TypeAlias = npt.NDArray[Any]
"""Gradients of zeros, doubles that are real or complex."""


@dataclass(frozen=True, eq=False)
class Gradients:
    """The conditions of a part of a sheet, with one gradient for all panels that move as one.

    `folds` are the folds of the part, with the `left` and `right` region of each, seen from its
    smaller end to the larger. `around` has the regions around each vertex of `vertices`,
    counter-clockwise. `points` are the vertices of the whole sheet, nearly, with shape (V, 2).
    """

    points: FloatArray
    folds: tuple[Edge, ...]
    left: tuple[int, ...]
    right: tuple[int, ...]
    vertices: tuple[int, ...]
    around: tuple[tuple[int, ...], ...]
    regions: int

    @classmethod
    def of(cls, pattern: PanelPattern, moving: Mapping[int, Star]) -> Gradients:
        """The conditions of the vertices of `moving`, whose stars have the folds of the part.

        >>> from exactfold.panels.vertex.stars import stars
        >>> from exactfold.pattern.families import two_vertex
        >>> from exactfold.pattern.opening import panels
        >>> sheet = panels(two_vertex())
        >>> part = Gradients.of(sheet, stars(sheet))
        >>> part.regions, len(part.folds), part.is_square
        (6, 7, True)
        """
        folds = tuple(sorted({fold for star in moving.values() for fold in star.folds}))
        joined = UnionFind(range(len(pattern.faces)))
        for i, j in set(pattern.folds) - set(folds):
            joined.union(pattern.sides[i, j], pattern.sides[j, i])
        names = {
            root: k for k, root in enumerate(sorted({joined[f] for f in range(len(pattern.faces))}))
        }

        def region(i: int, j: int) -> int:
            return names[joined[pattern.sides[i, j]]]

        around = tuple(
            tuple(region(v, i + j - v) for i, j in star.folds) for v, star in moving.items()
        )
        return cls(
            np.array([[float(x), float(y)] for x, y in pattern.vertices]),
            folds,
            tuple(region(i, j) for i, j in folds),
            tuple(region(j, i) for i, j in folds),
            tuple(moving),
            around,
            len(names),
        )

    @property
    def is_square(self) -> bool:
        """Whether there are as many conditions as unknowns, a shift and a factor left out."""
        return len(self.folds) == 3 * len(self.vertices) + 1

    @property
    def size(self) -> int:
        """The number of unknowns, two for each region."""
        return 2 * self.regions

    @cached_property
    def ends(self) -> FloatArray:
        """Row e has 1 at the larger end of fold e and -1 at the smaller; shape (E, V)."""
        rows = np.zeros((len(self.folds), len(self.points)))
        for k, (i, j) in enumerate(self.folds):
            rows[k, i], rows[k, j] = -1.0, 1.0
        return rows

    @cached_property
    def jumps(self) -> FloatArray:
        """Row e has 1 at the left region of fold e and -1 at the right; shape (E, R)."""
        rows = np.zeros((len(self.folds), self.regions))
        for k, (left, right) in enumerate(zip(self.left, self.right, strict=True)):
            rows[k, left] += 1.0
            rows[k, right] -= 1.0
        return rows

    @cached_property
    def forms(self) -> FloatArray:
        """The matrices H_v with the area g H_v g / 2 of the gradients around v; (m, 2R, 2R)."""
        forms = np.zeros((len(self.vertices), self.size, self.size))
        for form, ring in zip(forms, self.around, strict=True):
            for a, b in zip(ring, (*ring[1:], ring[0]), strict=True):
                for p, q, half in ((0, 1, 0.5), (1, 0, -0.5)):
                    form[2 * a + p, 2 * b + q] += half
                    form[2 * b + q, 2 * a + p] += half
        return forms

    def directions(self, points: FloatArray) -> FloatArray:
        """The vectors along the folds from the smaller end to the larger; (..., E, 2)."""
        along: FloatArray = self.ends @ points
        return along

    def linear(self, along: FloatArray) -> FloatArray:
        """The rows of the conditions of the folds, with these vectors along the folds; (E, 2R)."""
        rows: FloatArray = self.jumps[:, :, None] * along[:, None, :]
        return rows.reshape(len(self.folds), self.size)

    @cached_property
    def shift(self) -> FloatArray:
        """Two rows that say that the gradients add up to 0; (2, 2R)."""
        return np.tile(np.eye(2), self.regions)

    def from_densities(self, densities: Mapping[Edge, complex]) -> ComplexArray:
        """The gradients of a motion with these fold densities, of length 1."""
        along = self.directions(self.points)
        across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
        jumps = np.array([[densities[fold]] for fold in self.folds]) * across
        gradients = np.linalg.lstsq(self.jumps, jumps, rcond=None)[0]
        gradients = gradients - gradients.mean(axis=0)
        unit: ComplexArray = gradients.ravel() / np.linalg.norm(gradients)
        return unit

    def newton(self, zeros: Zeros, points: FloatArray) -> Zeros:
        """Zeros near the given ones for vertices at `points`, by Newton's method; (B, 2R).

        `points` may have one sheet for each zero. Zeros have the length 1. What does not converge
        is not a number.
        """
        count = len(zeros)
        along = self.directions(points)
        rows = self.jumps[:, :, None] * along[..., :, None, :]
        linear = rows.reshape(*along.shape[:-1], self.size)
        fixed = [np.broadcast_to(x, (count, *x.shape[-2:])) for x in (linear, self.shift)]
        one = zeros.conj()[:, None]
        now = zeros.copy()
        moved = np.full(count, np.inf)
        areas = slice(len(self.folds) + 2, -1)
        for _ in range(_STEPS):
            forms = (now[:, None, None, :] @ self.forms[None])[:, :, 0]
            matrix = np.concatenate([*fixed, forms, one], axis=1)
            value = (matrix @ now[:, :, None])[:, :, 0]
            value[:, areas] /= 2
            value[:, -1] -= 1
            step = (inverses(matrix) @ value[:, :, None])[:, :, 0]
            now = now - step
            moved = np.abs(step).max(axis=1)
            if not np.nanmax(moved) >= 1e-13:
                break
        now[~(moved < 1e-9)] = np.nan
        return np.asarray(now / np.linalg.norm(now, axis=1, keepdims=True))

    def bends(self, gradients: Zeros, points: FloatArray) -> Zeros:
        """The densities of the folds, positive for valleys; shape (B, E)."""
        along = self.directions(points)
        across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
        jumps = self.jumps @ gradients.reshape(*gradients.shape[:-1], self.regions, 2)
        return np.asarray((jumps * across).sum(axis=-1) / (along**2).sum(axis=-1))

    def slopes(self, zero: FloatArray, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The densities at a zero and their derivatives by the vertices; (E,) and (E, V, 2)."""
        along = self.directions(points)
        across = np.stack([-along[:, 1], along[:, 0]], axis=1)
        across /= (along**2).sum(axis=1, keepdims=True)
        jump = self.jumps @ zero.reshape(self.regions, 2)
        matrix = np.concatenate([self.linear(along), self.shift, self.forms @ zero, zero[None]])
        by_place = np.zeros((self.size, len(points), 2))
        by_place[: len(self.folds)] = self.ends[:, :, None] * jump[:, None, :]
        moved = -(inverses(matrix[None])[0] @ by_place.reshape(self.size, -1))
        jumped = self.jumps @ moved.reshape(self.regions, -1)
        by_axis = jumped.reshape(len(self.folds), 2, -1)
        slopes = (across[:, :, None] * by_axis).sum(axis=1)
        return (across * jump).sum(axis=1), slopes.reshape(len(self.folds), len(points), 2)
