r"""Newton's method on nappes l_v = e_v |A_v z|, for a block of sign vectors e at once.

Every zero of these equations has K_v = l_v^2 - |A_v z|^2 = 0 and the signs e. `dense_newton` states
them for sheets with four boundary vertices, `periodic_rays` for periodic sheets. All this is
floating point; nothing here is proved.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from exactfold._support.arrays import BoolArray, FloatArray
from exactfold.solve.numeric.linear_start import start_size

_ITERATIONS = 100
_HALVINGS = 40
_DECREASE = 0.1
_CONVERGED = 1e-13
_NOISE, _RESIDUAL = 1e-14, 1e-15
_COLD = 64
_CHUNK = 256


def sign_vectors(first: int, count: int, size: int) -> FloatArray:
    """The sign vectors number `first`, ...: sign k is -1 if bit k of the number is set.

    >>> sign_vectors(1, 2, 2).tolist()
    [[-1.0, 1.0], [1.0, -1.0]]
    """
    bits = (np.arange(first, first + count)[:, None] >> np.arange(size)) & 1
    return np.where(bits == 0, 1.0, -1.0)


@dataclass(frozen=True, eq=False)
class NappeNewton:
    """The equations l_v(x) = e_v |A_v (x, 1)| in as many unknowns x, as rows on (x, 1).

    `lines` holds the functionals l_v, one row for each, and `roots` the matrices A_v, with one row
    for each square.
    """

    lines: FloatArray
    roots: tuple[FloatArray, ...]

    @cached_property
    def _stacked(self) -> FloatArray:
        """The matrices A_v below each other."""
        return np.vstack(self.roots)

    @cached_property
    def _owners(self) -> FloatArray:
        """One column for every v, which is 1 at the squares of v."""
        return np.repeat(np.eye(len(self.roots)), [len(a) for a in self.roots], axis=0)

    def swept(self, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """The zeros for the rows of e, a power of two many, in fewer steps than `ends` takes.

        Row r + bit must differ from row r, for every power of two `bit` above r, in the same sign.
        The zeros of the first few rows are found from the linear start. Write x(r) for the zero of
        row r. Row r + bit starts from x(r), moved as `bit` moved the zero of an earlier row: from
        x(r) + x(q + bit) - x(q), where q is r without its top bit.
        """
        count = len(e)
        x, converged = np.empty_like(e), np.zeros(count, dtype=bool)
        bit = min(_COLD, count)
        x[:bit], converged[:bit], steps = self.ends(e[:bit])
        while bit < count:
            low = 0
            while low < bit:
                high = min(low + _CHUNK, max(2 * low, _COLD), bit)
                start = x[low:high].copy()
                if low:
                    top = 1 << (low.bit_length() - 1)
                    start += x[bit + low - top : bit + high - top] - x[low - top : high - top]
                rows = slice(bit + low, bit + high)
                x[rows], converged[rows], more = self.continued(start, e[rows])
                steps, low = steps + more, high
            bit *= 2
        return x, converged, steps

    @cached_property
    def rest(self) -> FloatArray:
        """The heights at which all l_v are 0, from which the linear start is made."""
        n = len(self.lines)
        return np.asarray(np.linalg.solve(self.lines[:, :n], -self.lines[:, n]))

    def ends(self, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """The zero for each row of signs, which rows converged, and the number of steps.

        Damped Newton steps start from the solution of the linear system l_v = e_v c.
        """
        n = e.shape[1]
        lines = self.lines
        right = e * start_size(self.rest) - lines[:, n]
        start = np.linalg.solve(lines[:, :n], right.T).T
        return self.continued(np.array(start, dtype=np.float64), e)

    def continued(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, BoolArray, int]:
        """`ends` from given points, which are overwritten."""
        converged, steps = np.zeros(len(x), dtype=bool), 0
        live = np.arange(len(x))
        with np.errstate(all="ignore"):
            for _ in range(_ITERATIONS):
                steps += live.size
                x[live], done, stuck = self._step(x[live], e[live])
                converged[live[done]] = True
                live = live[~done & ~stuck]
                if not live.size:
                    break
        return x, converged, steps

    def values(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """g, the products A h, and the norms |A_v h|."""
        z = np.hstack([x, np.ones((len(x), 1))])
        products = z @ self._stacked.T
        norms = np.sqrt((products * products) @ self._owners)
        return z @ self.lines.T - e * norms, products, norms

    def _step(self, x: FloatArray, e: FloatArray) -> tuple[FloatArray, BoolArray, BoolArray]:
        """One damped step of every row: the new points, which rows converged, which are stuck."""
        n = x.shape[1]
        g, products, norms = self.values(x, e)
        weights = products * ((-e / np.maximum(norms, 1e-300)) @ self._owners.T)
        jacobian = np.empty((n, len(x), n))  # vertex first, so that each vertex is written at once
        column = 0
        for v, root in enumerate(self.roots):
            np.matmul(weights[:, column : column + len(root)], root[:, :n], out=jacobian[v])
            jacobian[v] += self.lines[v, :n]
            column += len(root)
        change = solve_each(jacobian.transpose(1, 0, 2), g)
        before = np.abs(g).max(axis=1)
        length = np.ones(len(x))
        moved = x - change
        after = np.abs(self.values(moved, e)[0]).max(axis=1)
        size = 1.0 + np.abs(x).max(axis=1)
        noise = _NOISE * size
        bad = np.flatnonzero(~(after <= (1 - _DECREASE) * before) & ~(after <= noise))
        for _ in range(_HALVINGS):
            if not bad.size:
                break
            length[bad] /= 2
            moved[bad] = x[bad] - length[bad, None] * change[bad]
            after[bad] = np.abs(self.values(moved[bad], e[bad])[0]).max(axis=1)
            enough = after[bad] <= (1 - _DECREASE * length[bad]) * before[bad]
            bad = bad[~enough & ~(after[bad] <= noise[bad])]
        stuck = np.zeros(len(x), dtype=bool)
        stuck[bad] = True
        moved[bad] = x[bad]
        small = np.abs(change).max(axis=1) <= _CONVERGED * size
        return moved, (length == 1.0) & (small | (after <= _RESIDUAL * size)) & ~stuck, stuck


def solve_each(matrices: FloatArray, right: FloatArray) -> FloatArray:
    """The solutions of m systems of shape (m, n, n), (m, n); not finite for a singular system."""
    try:
        return np.asarray(np.linalg.solve(matrices, right[:, :, None])[:, :, 0])
    except np.linalg.LinAlgError:
        if len(matrices) == 1:
            return np.full_like(right, np.nan)
        half = len(matrices) // 2
        return np.concatenate(
            [solve_each(matrices[:half], right[:half]), solve_each(matrices[half:], right[half:])]
        )
