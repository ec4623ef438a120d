"""The curve of true configurations that leaves the flat state along a branch, as a power series."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.errors import NotFollowedError
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.bordered import DENSE, Bordered, factors_of
from exactfold.motion.curves.framework import Framework
from exactfold.solve.numeric.least_squares import least_squares

if TYPE_CHECKING:  # as in `framework`
    from scipy.sparse import csc_array

_NEWTON = 30
_SINGULAR = 2.0**48
"""A matrix is invertible if the largest entries of it and of its inverse have a product
below this.
"""


@dataclass(frozen=True, repr=False, eq=False)
class Start:
    """The blown-up series at the flat state: d = (t^2 u_x, t^2 u_y, t h) with u, h series in t^2.

    The equations g_e = 0 of `Framework`, divided by t^2, are

        U_e . u_e + h_e^2 / 2 + t^2 |u_e|^2 / 2 = 0.

    Together with the coupling and the ties of the framework, and with one height held fixed, they
    are regular at t = 0 if the branch is simple. So their solution is an analytic curve in s = t^2,
    and each of its coefficients solves a linear system with the same matrix. `coefficients[k]` is
    the coefficient of s^k, shape (order + 1, unknowns); each triple of unknowns is (u_x, u_y, h) of
    one free vertex. `held` is the unknown that is fixed.
    """

    framework: Framework
    coefficients: FloatArray
    held: int

    @classmethod
    def of(cls, framework: Framework, heights: FloatArray, order: int = 6) -> Start:
        """The series from approximate heights of all vertices on a branch, shape (V,).

        The heights are scaled so that the largest fold angle is t to first order. Raises
        `NotFollowedError` if Newton's method does not converge: then the branch is not simple, or
        the numbers leave the range of floats.
        """
        first = _scaled(framework, heights_above_the_pin(framework, heights))
        guess = np.zeros((len(framework.free), 3))
        guess[:, 2] = first[framework.free]
        y = guess.reshape(-1)
        held = int(np.argmax(np.abs(guess[:, 2]))) * 3 + 2
        y = _with_plane(framework, y)
        with np.errstate(all="ignore"):
            y, factors = _newton(framework, y, held)
        series = np.zeros((order + 1, framework.size))
        series[0] = y
        along = np.zeros((order + 1, len(framework.bars), 3))
        along[0] = framework.along(y)
        none = np.zeros(len(framework.ties) + 1)
        for k in range(1, order + 1):
            right = sum(
                (along[m, :, 2] * along[k - m, :, 2] for m in range(1, k)),
                start=np.zeros(len(framework.bars)),
            ) + sum((along[m, :, :2] * along[k - 1 - m, :, :2]).sum(axis=1) for m in range(k))
            right = framework.coupling.combined(-0.5 * right)
            series[k] = factors.solve(np.append(right, none))
            along[k] = framework.along(series[k])
        if not np.isfinite(series).all():
            raise NotFollowedError("the series of the motion leaves the range of floats")
        return cls(framework, series, held)

    def in_t(self) -> FloatArray:
        """The displacement as a polynomial in t, with coefficients of shape (2 order + 3,
        unknowns).
        """
        order = len(self.coefficients) - 1
        whole = np.zeros((2 * order + 3, self.framework.size))
        heights = np.zeros(self.framework.size, dtype=bool)
        heights[2::3] = True
        for k, row in enumerate(self.coefficients):
            whole[2 * k + 1, heights] = row[heights]
            whole[2 * k + 2, ~heights] = row[~heights]
        return whole

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Start):
            return NotImplemented
        same = (self.framework, self.held) == (other.framework, other.held)
        return same and np.array_equal(self.coefficients, other.coefficients)

    __hash__ = None  # type: ignore[assignment]  # arrays have no hash

    def __repr__(self) -> str:
        return f"<Start: order {len(self.coefficients) - 1}, {self.framework!r}>"


def blown_up(framework: Framework, y: FloatArray, s: float = 0.0) -> FloatArray:
    """The left sides U_e . u_e + h_e^2 / 2 + s |u_e|^2 / 2, followed by those of the ties."""
    e = framework.along(y)
    flat = (framework.flat_edges[:, :2] * e[:, :2]).sum(axis=1)
    bent = flat + 0.5 * e[:, 2] ** 2 + 0.5 * s * (e[:, :2] ** 2).sum(axis=1)
    return np.concatenate([framework.coupling.combined(bent), framework.tie_rows @ y])


def blown_up_jacobian(framework: Framework, y: FloatArray, s: float = 0.0) -> csc_array:
    """The derivative of `blown_up` with respect to the unknowns, sparse."""
    return framework.matrix(blown_up_rows(framework, y, s))


def blown_up_rows(framework: Framework, y: FloatArray, s: float = 0.0) -> FloatArray:
    """The vectors of the bars in the derivative of `blown_up`, shape (bars, 3)."""
    rows = framework.along(y)
    rows[:, :2] = framework.flat_edges[:, :2] + s * rows[:, :2]
    return rows


def _newton(framework: Framework, y: FloatArray, held: int) -> tuple[FloatArray, Bordered]:
    last = np.inf
    for _ in range(_NEWTON):
        try:
            factors = factors_of(framework, blown_up_rows(framework, y), held, _SINGULAR)
        except np.linalg.LinAlgError:
            break
        step = factors.solve(np.append(-blown_up(framework, y), 0.0))
        y = y + step
        size = float(np.max(np.abs(step)) / max(1.0, float(np.max(np.abs(y)))))
        if not np.isfinite(size):
            break
        if size < 1e-9 and size > last / 4:
            return y, factors
        if size < 1e-15:
            return y, factors
        last = size
    raise NotFollowedError(
        "no curve was found that leaves the flat state along this branch: the branch is not "
        "simple, or floats cannot distinguish it from another one"
    )


def heights_above_the_pin(framework: Framework, heights: FloatArray) -> FloatArray:
    """The heights above the plane through the pinned triangle."""
    corners = list(framework.pinned)
    affine = np.column_stack([np.ones(len(framework.flat)), framework.flat])
    plane = np.linalg.solve(affine[corners], heights[corners])
    above = np.asarray(heights - affine @ plane)
    above[corners] = 0.0
    return above


def _scaled(framework: Framework, heights: FloatArray) -> FloatArray:
    tiny = 1e-6 / max(float(np.max(np.abs(heights))), 1e-300)
    space = np.column_stack([framework.flat, tiny * heights])
    largest = float(np.max(np.abs(fold_angles_of(space, framework.hinges)), initial=0.0)) / tiny
    if not (np.isfinite(largest) and largest > 0):
        raise NotFollowedError("in floating point, no fold bends on this branch")
    return heights / largest


def _with_plane(framework: Framework, y: FloatArray) -> FloatArray:
    """The unknowns with the u that solves the equations for their heights in least squares."""
    e = framework.along(y)
    rows = framework.flat_edges
    columns = np.arange(framework.size) % 3 != 2
    bent = framework.coupling.combined(-0.5 * e[:, 2] ** 2)
    right = np.append(bent, np.zeros(len(framework.ties)))
    y = y.copy()
    if framework.size > DENSE:
        y[columns] = least_squares(framework.matrix(rows)[:, columns], right)
    else:
        y[columns] = np.linalg.lstsq(framework.dense(rows)[:, columns], right)[0]
    return y
