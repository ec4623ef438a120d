"""Loops of true configurations, followed in floats by dense linear algebra: evidence, not proof.

Independent of `exactfold.motion.following`: what they share is the list of bars and the series at
the flat state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from exactfold._support.arrays import FloatArray
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.curve import Piece, leaving_piece
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.start import Start
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.functionals import saddle_functional, vertex_sign_functional

Signs = tuple[int, ...]

ORDER, TOLERANCE, MOST = 16, 1e-11, 3000
NEAR = 0.3
"""Fold angles below which the flat state is looked for."""


class LostError(Exception):
    """The curve could not be followed."""


@dataclass(frozen=True)
class Loop:
    """From one ray of the flat state to another.

    `start` and `end`: the n vertex signs and the last sign, as the moving sheet shows them.
    `crossings`: for each change of sign of det [J; T], the vertices whose star is flat there.
    `flat_stars`: the vertices whose star is flat, for each configuration of the loop that is not
    flat and has such vertices, the nodes. `turns`: by how many turns each fold winds. `length`:
    arclength.
    """

    start: Signs
    end: Signs
    crossings: tuple[tuple[int, ...], ...]
    flat_stars: tuple[tuple[int, ...], ...]
    turns: tuple[int, ...]
    length: float

    @property
    def flipped(self) -> tuple[int, ...]:
        """Places of the signs that differ."""
        pairs = zip(self.start, self.end, strict=True)
        return tuple(k for k, (a, b) in enumerate(pairs) if a != b)


class Tracker:
    """Follows rays of one sheet with four boundary vertices."""

    def __init__(self, sheet: CreasePattern) -> None:
        self.sheet = sheet
        self.framework = f = Framework.of(sheet)
        self.incidence = np.zeros((len(f.edges), len(f.points)))
        for e, (i, j) in enumerate(f.edges):
            self.incidence[e, i], self.incidence[e, j] = 1.0, -1.0
        self.incidence = self.incidence[:, f.free]

    @cached_property
    def rows(self) -> FloatArray:
        """The functionals of the signs, the last that of the saddle or of the reflex corner."""
        sheet = self.sheet
        corner = sheet.reflex_corner
        last = (
            saddle_functional(sheet)
            if corner is None
            else vertex_sign_functional(sheet.with_notch_closed(), corner)
        )
        functionals = [*(vertex_sign_functional(sheet, v) for v in sheet.interior), last]
        rows = np.zeros((len(functionals), len(sheet.vertices)))
        for row, functional in zip(rows, functionals, strict=True):
            for v, c in functional.items():
                row[v] = float(c / max(abs(c) for c in functional.values()))
        return rows

    def signs(self, heights: FloatArray) -> Signs:
        """The n + 1 signs of a ray with these heights of all vertices."""
        return tuple(int(s) for s in np.sign(self.rows @ heights))

    def jacobian(self, x: FloatArray) -> FloatArray:
        """Of the stretches, dense."""
        along = self.framework.flat_edges + self.incidence @ x.reshape(-1, 3)
        return np.asarray((self.incidence[:, :, None] * along[:, None, :]).reshape(len(along), -1))

    def orientation(self, x: FloatArray, direction: FloatArray) -> float:
        """The sign of det [J; direction]."""
        return float(np.linalg.slogdet(np.vstack([self.jacobian(x), direction]))[0])

    def _piece(self, x: FloatArray, direction: FloatArray, time: float) -> Piece:
        """The Taylor polynomial at the configuration next to x, by the parameter direction . d."""
        f = self.framework
        size = np.inf
        inverse = np.zeros((f.size, f.size))
        for _ in range(8):
            inverse = np.linalg.inv(np.vstack([self.jacobian(x), direction]))
            step = -inverse[:, :-1] @ f.stretch(x)
            x = x + step
            last, size = size, float(np.max(np.abs(step)))
            if not size < 1e-6:
                raise LostError("Newton's method fails")
            if size < 1e-12 or (size < 1e-10 and size > last / 4):
                break
        series = np.zeros((ORDER + 1, f.size))
        along = np.zeros((ORDER + 1, len(f.edges), 3))
        series[0], series[1] = x, inverse[:, -1]
        along[1] = self.incidence @ series[1].reshape(-1, 3)
        for k in range(2, ORDER + 1):
            products = (along[1:k] * along[k - 1 : 0 : -1]).sum(axis=(0, 2))
            series[k] = -0.5 * (inverse[:, :-1] @ products)
            along[k] = self.incidence @ series[k].reshape(-1, 3)
        sizes = np.max(np.abs(series), axis=1)
        bounds = [(TOLERANCE / sizes[k]) ** (1 / k) for k in (ORDER - 1, ORDER) if sizes[k]]
        reach = min(bounds, default=1.0)
        if not reach > 1e-8:
            raise LostError("steps become too short")
        piece = Piece(series, reach, time, int(self.orientation(x, series[1])))
        # Close to another strand the last terms do not show how short the step must be.
        while np.abs(f.stretch(piece.at(piece.reach))).max() > TOLERANCE:
            piece = piece.cut(0.7 * piece.reach)
        return piece

    def _landing(self, x: FloatArray) -> tuple[Signs, float] | None:
        """The signs of the ray on which x lies, if its series reaches x; and its length."""
        heights = self.framework.displacement(x)[:, 2]
        try:
            start = Start.of(self.framework, heights)
            leaving = leaving_piece(start)
        except Exception:
            return None
        held, goal = start.held, x[start.held]
        if abs(leaving.at(leaving.reach)[held]) < abs(goal):
            return None
        t = float(brentq(lambda t: leaving.at(t)[held] - goal, 0, leaving.reach, xtol=1e-15))
        if np.max(np.abs(leaving.at(t) - x)) > 1e-8:
            return None
        tangent = self.framework.displacement(leaving.coefficients[1])[:, 2]
        return self.signs(tangent), leaving.cut(t).length

    def follow(self, heights: FloatArray, seen: Callable[[FloatArray], None] | None = None) -> Loop:
        """The loop that leaves the flat state with these heights. Raises `LostError`.

        `seen` is called with the positions, shape (times, V, 3), of each step after the first.
        """
        f = self.framework
        begin = Start.of(f, heights)
        piece = leaving_piece(begin)
        start = self.signs(f.displacement(piece.coefficients[1])[:, 2])
        angles = np.zeros(len(f.hinges))
        crossings: list[tuple[int, ...]] = []
        flat_stars: list[tuple[int, ...]] = []
        before: Piece | None = None
        for _ in range(MOST):
            if before is not None and before.orientation * piece.orientation < 0:
                crossings.append(self._crossing(before))
            grid = np.linspace(0, piece.reach, 17)
            positions = f.positions(piece.at(grid))
            if seen is not None and piece.orientation:
                seen(positions * float(f.unit))
            raw = fold_angles_of(positions, f.hinges)
            largest = np.abs(raw).max(axis=1)
            unwrapped = np.unwrap(np.vstack([angles, raw]), axis=0)[1:]
            for k in range(16):
                if not piece.orientation or largest[k] > NEAR or largest[k + 1] > largest[k]:
                    continue
                landed = self._landing(piece.at(grid[k]))
                if landed is None:
                    continue
                flat_stars += self._flat_stars(piece, grid[: k + 1], raw[: k + 1], largest)
                whole = unwrapped[k] / (2 * np.pi)
                turns = tuple(round(w) for w in whole)
                if np.abs(whole - turns).max() > NEAR:
                    raise LostError("fold angles jump")
                length = (piece.time + piece.length_to(grid[k]) + landed[1]) * float(f.unit)
                return Loop(start, landed[0], tuple(crossings), tuple(flat_stars), turns, length)
            flat_stars += self._flat_stars(piece, grid, raw, largest)
            angles = unwrapped[-1]
            before = piece if piece.orientation else None
            x, direction = piece.at(piece.reach), piece.speed(piece.reach)
            direction = direction / np.linalg.norm(direction)
            piece = self._piece(x, direction, piece.time + piece.length)
        raise LostError("too many pieces")

    def _star_sizes(self, raw: FloatArray) -> FloatArray:
        """The largest fold angle at each interior vertex, shape (times, n)."""
        ends = self.framework.hinges[:, :2]
        stars = [(ends == v).any(axis=1) for v in self.sheet.interior]
        return np.column_stack([np.abs(raw[:, star]).max(axis=1) for star in stars])

    def _angles(self, x: FloatArray) -> FloatArray:
        """All fold angles at one configuration, shape (1, folds)."""
        return fold_angles_of(self.framework.positions(x)[None], self.framework.hinges)

    def _flat_stars(
        self, piece: Piece, grid: FloatArray, raw: FloatArray, largest: FloatArray
    ) -> list[tuple[int, ...]]:
        """The vertices whose stars are flat at one time of the piece, for each such time."""
        sizes = self._star_sizes(raw)
        found: dict[float, set[int]] = {}
        for k, v in enumerate(self.sheet.interior):
            at = int(np.argmin(sizes[:, k]))
            if sizes[at, k] > 0.1 * largest[at] or largest[at] < 0.02:
                continue
            ends = grid[max(at - 1, 0)], grid[min(at + 1, len(grid) - 1)]

            def size(s: float, k: int = k) -> float:
                return float(self._star_sizes(self._angles(piece.at(s)))[0, k])

            least = minimize_scalar(size, bounds=ends, method="bounded", options={"xatol": 1e-10})
            inside = 0 <= least.x < piece.reach * (1 - 1e-8)
            # A star that is only nearly flat, along a nearly straight path of folds, is no node.
            around = sizes[max(at - 1, 0) : at + 2, k].max()
            if inside and least.fun < 1e-4 * around:
                near = next((t for t in found if abs(t - least.x) < 1e-6), float(least.x))
                found.setdefault(near, set()).add(v)
        return [tuple(sorted(found[t])) for t in sorted(found)]

    def _crossing(self, piece: Piece) -> tuple[int, ...]:
        """Flat stars where the orientation changes on a piece or at its very end."""
        low, high = 0.0, piece.reach
        for _ in range(45):
            middle = 0.5 * (low + high)
            if self.orientation(piece.at(middle), piece.speed(middle)) == piece.orientation:
                low = middle
            else:
                high = middle
        sizes = self._star_sizes(self._angles(piece.at(high)))[0]
        return tuple(v for v, size in zip(self.sheet.interior, sizes, strict=True) if size < 1e-4)
