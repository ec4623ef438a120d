"""Whether modes extend to true motions: transmissions round loops, as exact power series.

Let tau = tan(angle / 2) / length. Along a line of motions of a vertex with four folds, one tau
determines the others: tau_end = tau_start u(tau_start^2), and u solves
(p + q s) u^2 + b u + c = 0. Suppose that k of the transmissions round a loop are not linear. If
their composite agrees with the identity up to the order 2^k + 1, it is the identity
(docs/panels.md, 3 and 4).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most
from ..core.towers import Number
from ..sheets.panels import cross, dot
from .modes import Joined, Modes, corners_of, name

MOST_BENT = limits.MOST_BENT
MOST_ORDER = 2**MOST_BENT + 1
_BITS = (256, 1024)
Series = list[Any]
"""The coefficients of a power series, as numbers or as intervals."""


@dataclass
class Step:
    """The transmission at one vertex of a loop.

    `gain` is u(0). `quadratic` is (p, q, b), or None if the transmission is linear.
    """

    vertex: int
    gain: Number
    quadratic: tuple[Number, Number, Number] | None


class Loops:
    """The transmissions of a sheet, and which loops they close; all results are remembered."""

    def __init__(self, modes: Modes) -> None:
        self.modes = modes
        self._steps: dict[tuple[int, int, int, int], Step] = {}
        self._closing: dict[object, bool] = {}

    def step(self, v: int, line: int, start: int, end: int) -> Step:
        """The transmission from the fold v-start to the fold v-end, on one line of motions at v."""
        key = (v, line, start, end)
        if key not in self._steps:
            self._steps[key] = self._made(*key)
        return self._steps[key]

    def _made(self, v: int, line: int, start: int, end: int) -> Step:
        modes = self.modes
        gain = modes.gain(v, line, start, end)
        if len(modes.lines[v][line].densities) == 2:
            return Step(v, gain, None)
        near = modes.near[v]
        first = near.index(start)
        ring = near[first:] + near[:first]
        if ring[3] == end:
            # Mirrored: all brackets change sign, but each product has an even number of them.
            ring = [start, *ring[:0:-1]]
        d = [modes.sheet.vector(v, u) for u in ring]

        def c(i: int, j: int) -> Number:
            return cross(d[i - 1], d[j - 1])

        if ring[1] == end:
            q = c(1, 2) * (c(3, 4) * dot(d[0], d[1]) + c(1, 2) * dot(d[2], d[3]))
            half = c(2, 3) * c(4, 1)
            return Step(v, gain, (c(2, 3) * c(2, 4), q, -half - half) if q.sign() else None)
        by_start, by_end = c(1, 2) * c(4, 1), c(2, 3) * c(3, 4)
        q = by_end * dot(d[0], d[0]) - by_start * dot(d[2], d[2])
        return Step(v, gain, (by_end, q, modes.sheet.tower.number(0)) if q.sign() else None)

    def steps(self, chosen: Mapping[int, int], loop: Sequence[int]) -> list[Step]:
        """The transmissions round a loop."""
        return [self.step(v, chosen[v], u, w) for v, u, w in corners_of(loop)]

    def closes(self, chosen: Mapping[int, int], loop: tuple[int, ...]) -> bool:
        """Whether the composite of the transmissions round a loop is the identity.

        The loop must close at first order.
        """
        key = (loop, tuple(chosen[v] for v in loop))
        if key not in self._closing:
            self._closing[key] = self._closes(chosen, loop)
        return self._closing[key]

    def _closes(self, chosen: Mapping[int, int], loop: tuple[int, ...]) -> bool:
        steps = self.steps(chosen, loop)
        bent = sum(step.quadratic is not None for step in steps)
        if not bent:
            return True
        what = f"the transmissions of the loop {name(loop)} that are not linear"
        at_most(bent, MOST_BENT, what, "MOST_BENT")
        order = 2**bent + 1
        if any(_differs(steps, order, bits) is not None for bits in _BITS):
            return False
        return not any(value.sign() for value in self._exact(chosen, loop, order)[1:])

    def fails(self, chosen: Mapping[int, int], loop: tuple[int, ...], order: int) -> bool:
        """Whether the composite round a loop differs from the identity at this odd order."""
        steps = self.steps(chosen, loop)
        if any(_differs(steps, order, bits) == order for bits in _BITS):
            return True
        return bool(self._exact(chosen, loop, order)[order // 2].sign())

    def _exact(self, chosen: Mapping[int, int], loop: tuple[int, ...], order: int) -> Series:
        joined = Joined(self.modes, loop, chosen)
        zero, one = joined.tower.number(0), joined.tower.number(1)
        return composed(self.steps(chosen, loop), order, joined.of, zero, one)


def _differs(steps: Sequence[Step], order: int, bits: int) -> int | None:
    """The highest order up to `order` at which intervals prove that the composite is not the
    identity; None if there is none."""
    zero, one = Interval.of(Fraction(0), bits), Interval.of(Fraction(1), bits)
    try:
        series = composed(steps, order, lambda _, value: value.enclosed(bits), zero, one)
    except ZeroDivisionError:  # the intervals are too wide
        return None
    return next((2 * n + 1 for n in range(order // 2, 0, -1) if series[n].sign()), None)


def composed(
    steps: Sequence[Step], order: int, of: Callable[[int, Number], Any], zero: Any, one: Any
) -> Series:
    """The series f with tau = t f(t^2) after all steps, where t is the first tau.

    It is computed up to the given order of tau; `of` converts the numbers of a vertex.
    """
    terms = order // 2 + 1
    f: Series = [one] + [zero] * (terms - 1)
    for step in steps:
        square = _times(f, f, zero)
        argument = [zero, *square[:-1]]
        u = _series(step, terms, of, zero)
        value = [zero] * terms
        for coefficient in reversed(u):
            value = _times(value, argument, zero)
            value[0] = value[0] + coefficient
        f = _times(f, value, zero)
    return f


def _series(step: Step, terms: int, of: Callable[[int, Number], Any], zero: Any) -> Series:
    """The series u(s) with (p + q s) u^2 + b u + c = 0; the coefficient of s^n gives u_n."""
    u: Series = [of(step.vertex, step.gain)]
    if step.quadratic is None:
        return u
    p, q, b = (of(step.vertex, value) for value in step.quadratic)
    divisor = p * u[0] + p * u[0] + b
    for n in range(1, terms):
        rest = zero
        for k in range(1, n):
            rest = rest + p * u[k] * u[n - k]
        for k in range(n):
            rest = rest + q * u[k] * u[n - 1 - k]
        u.append(-(rest / divisor))
    return u


def _times(a: Series, b: Series, zero: Any) -> Series:
    product = []
    for n in range(len(a)):
        total = zero
        for k in range(n + 1):
            total = total + a[k] * b[n - k]
        product.append(total)
    return product
