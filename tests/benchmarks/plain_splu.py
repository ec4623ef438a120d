"""One branch by the obvious program: the popping path of its signs with SciPy's `splu`.

Runge and Kutta's predictor, Newton's corrector, a general sparse factorisation for every Jacobian,
floats throughout and no proof. It shares no code with `exactfold.branches.counting.find`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu

from exactfold.pattern.crease_pattern import CreasePattern

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Equations:
    """K_p(h) = sum c h_i h_j and l_p(h) over entries (p, i, j, c) and (p, i, c)."""

    forms: tuple[npt.NDArray[np.intp], FloatArray]
    lines: csc_matrix
    unknowns: npt.NDArray[np.intp]

    @classmethod
    def of(cls, pattern: CreasePattern) -> Equations:
        """By docs/mathematics.md, 1: scaled so that l_v has coefficient 1 at the hub."""
        where = np.array([[float(x), float(y)] for x, y in pattern.vertices])
        form_at, form, line_at, line = [], [], [], []
        for p, v in enumerate(pattern.interior):
            ring = pattern.star(v)
            d = where[list(ring)] - where[v]
            e = np.roll(d, -1, axis=0)
            c = d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0]
            cotangent = (d * e).sum(axis=1) / c
            squares = (d * d).sum(axis=1)
            n = len(ring)
            matrix = np.zeros((n, n))
            for j in range(n):
                k = (j + 1) % n
                matrix[j, k] += 0.5 / c[j]
                matrix[k, j] += 0.5 / c[j]
                matrix[j, j] -= 0.5 * cotangent[j] / squares[j]
                matrix[k, k] -= 0.5 * cotangent[j] / squares[k]
            # From x_j = h_j - h_v to heights: a row and column of minus the sums for the hub.
            spread = np.hstack([-np.ones((n, 1)), np.eye(n)])
            whole = spread.T @ matrix @ spread
            cone = np.concatenate([[0.0], -np.sqrt(squares)])
            polar = whole @ cone
            whole *= (cone @ polar) / polar[0] ** 2
            labels = (v, *ring)
            form_at += [(p, i, j) for i in labels for j in labels]
            form += whole.ravel().tolist()
            line_at += [(p, i) for i in labels]
            line += (polar / polar[0]).tolist()
        size = (pattern.Vi, len(where))
        lines = coo_matrix((line, np.array(line_at).T), shape=size).tocsc()
        return cls((np.array(form_at), np.array(form)), lines, np.array(pattern.interior))

    def at(self, h: FloatArray) -> tuple[FloatArray, FloatArray, csc_matrix]:
        """K and l, and the Jacobian of K in all heights."""
        (p, i, j), c = self.forms[0].T, self.forms[1]
        half = coo_matrix((c * h[j], (p, i)), shape=self.lines.shape).tocsc()
        return half @ h, self.lines @ h, 2.0 * half

    def residual(self, h: FloatArray, t: float, level: float) -> tuple[FloatArray, csc_matrix]:
        """(1 - T) (l^2 - k) + T K and its Jacobian in the unknowns."""
        K, line, slope = self.at(h)
        jacobian = t * slope + self.lines.multiply((2.0 * (1.0 - t) * line)[:, None])
        return (1.0 - t) * (line * line - level) + t * K, csc_matrix(jacobian)[:, self.unknowns]

    def direction(self, h: FloatArray, t: float, level: float) -> FloatArray:
        """dx/dT along the path."""
        K, line, _ = self.at(h)
        _, jacobian = self.residual(h, t, level)
        return np.asarray(splu(jacobian).solve(line * line - level - K))


def plain_branch(pattern: CreasePattern, signs: FloatArray, rim: int) -> tuple[FloatArray, int]:
    """Heights with boundary vertex `rim` at 1 and the others at 0; and the number of steps."""
    equations = Equations.of(pattern)
    h = np.zeros(len(pattern.vertices))
    h[rim] = 1.0
    free = equations.unknowns
    lines = splu(equations.lines[:, free])
    offset = equations.lines @ h
    level = max(float(np.abs(lines.solve(offset)).max()), 1e-3) ** 2 / 16
    h[free] = lines.solve(signs * np.sqrt(level) - offset)

    def moved(step: FloatArray) -> FloatArray:
        result = h.copy()
        result[free] += step
        return result

    t, size, steps = 0.0, 0.05, 0
    while t < 1.0:
        steps += 1
        if size < 1e-10:
            raise ArithmeticError(f"the path stalled at T = {t}")
        s = min(size, 1.0 - t)
        k1 = equations.direction(h, t, level)
        k2 = equations.direction(moved(s / 2 * k1), t + s / 2, level)
        k3 = equations.direction(moved(s / 2 * k2), t + s / 2, level)
        # At T = 1 the Jacobian of a nearly flat star is nearly singular: the last slope is k3 then.
        k4 = equations.direction(moved(s * k3), t + s, level) if t + s < 1.0 else k3
        new = moved(s / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
        changes = []
        for _ in range(4):
            value, jacobian = equations.residual(new, t + s, level)
            change = splu(jacobian).solve(value)
            new[free] -= change
            changes.append(float(np.abs(change).max() / (1.0 + np.abs(new).max())))
            if changes[-1] < 1e-11:
                break
        good = changes[0] < 0.02 and changes[-1] < 1e-9
        if good and (signs * (equations.lines @ new) > 0.0).all():
            h, t = new, t + s
            size *= 2.0 if changes[0] < 1e-3 else 1.2
        else:
            size = s / 2
    return h, steps
