"""How the fold angles of a vertex with four folds depend on each other, for angles of any size."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from exactfold.exact.surds import Number, Surd
from exactfold.panels.vertex.local import LocalMode
from exactfold.panels.vertex.stars import Star, bracket, dot
from exactfold.pattern.panel_pattern import Edge

Series: TypeAlias = list[Any]
"""The coefficients of a power series in s, as exact numbers or as balls."""


class Transmission:
    """The function u with tau_end = tau_start * u(tau_start^2) along one mode of a vertex.

    Here tau = tan(angle / 2) / length. Let four folds have directions d_1, ..., d_4, let x = tau_1,
    y = tau_2, z = tau_3, c_ij = [d_i, d_j] and s_ij = d_i . d_j. Then (docs/panels.md, All fold
    angles)

        c_41 c_13 x^2 + 2 c_23 c_41 x y - c_23 c_24 y^2 = Q x^2 y^2,
        Q = c_12 (c_34 s_12 + c_12 s_34);
        c_12 c_41 x^2 (1 + |d_3|^2 z^2) = c_23 c_34 z^2 (1 + |d_1|^2 x^2).

    So for neighbouring folds u is a root of (c_23 c_24 + Q s) u^2 - 2 c_23 c_41 u - c_41 c_13 = 0.
    For opposite folds u is a root of c_12 c_41 = u^2 (c_23 c_34 + (c_23 c_34 |d_1|^2 - c_12 c_41
    |d_3|^2) s). Both equations have the form `(a0 + a1 s) u^2 + b u + c = 0`. If a straight crease
    folds alone, u is constant. `gain` is u(0).
    """

    def __init__(self, star: Star, mode: LocalMode, start: Edge, end: Edge) -> None:
        self.gain = mode.gain(start, end)
        self.quadratic: tuple[Number, Number, Number, Number] | None = None
        if len(mode.folds) == 2:
            return
        i, j = star.folds.index(start), star.folds.index(end)
        turn = -1 if (j - i) % 4 == 3 else 1  # a reflection makes the previous fold the next one
        d = [star.directions[(i + turn * k) % 4] for k in range(4)]

        def c(p: int, q: int) -> Number:
            return turn * bracket(d[p - 1], d[q - 1])

        if (j - i) % 2:
            q = c(1, 2) * (c(3, 4) * dot(d[0], d[1]) + c(1, 2) * dot(d[2], d[3]))
            self.quadratic = (c(2, 3) * c(2, 4), q, -2 * c(2, 3) * c(4, 1), -c(4, 1) * c(1, 3))
        else:
            near, far = c(1, 2) * c(4, 1), c(2, 3) * c(3, 4)
            self.quadratic = (far, far * dot(d[0], d[0]) - near * dot(d[2], d[2]), 0, -near)

    @property
    def key(self) -> tuple[object, ...]:
        """A value that is equal for two transmissions only if the transmissions are equal."""
        numbers = (self.gain, *(self.quadratic or ()))
        return tuple(
            (x.field.radicands, x.coefficients) if isinstance(x, Surd) else x for x in numbers
        )

    @property
    def is_linear(self) -> bool:
        """Whether u is constant: tau_end is a multiple of tau_start."""
        return self.quadratic is None or self.quadratic[1] == 0

    def series(self, terms: int, number: Callable[[Number], Any]) -> Series:
        """The first coefficients of u; `number` converts exact numbers to the number type to use.

        The coefficient of s^n in the quadratic equation is linear in u_n. Its factor 2 a0 u_0 + b
        is not 0, because the two modes of the vertex differ.
        """
        u: Series = [number(self.gain)]
        if self.is_linear or self.quadratic is None:
            return u + [number(0)] * (terms - 1)
        a0, a1, b, _ = (number(value) for value in self.quadratic)
        divisor = 2 * a0 * u[0] + b
        for n in range(1, terms):
            known = sum((u[k] * u[n - k] for k in range(1, n)), number(0))
            before = sum((u[k] * u[n - 1 - k] for k in range(n)), number(0))
            u.append(-(a0 * known + a1 * before) / divisor)
        return u


def composed(steps: Sequence[Series], number: Callable[[Number], Any]) -> Series:
    """The coefficients of f, where tau = t f(t^2) after all these transmissions in turn."""
    terms = len(steps[0])
    f: Series = [number(1)] + [number(0)] * (terms - 1)
    for u in steps:
        square = _times(f, f)
        argument = [number(0), *square[:-1]]  # s = tau^2 = t^2 f^2
        value: Series = [number(0)] * terms
        for coefficient in reversed(u):
            value = _times(value, argument)
            value[0] = value[0] + coefficient
        f = _times(f, value)
    return f


def _times(a: Series, b: Series) -> Series:
    return [sum((a[k] * b[n - k] for k in range(1, n + 1)), a[0] * b[n]) for n in range(len(a))]
