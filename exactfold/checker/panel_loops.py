"""Whether modes truly fold: the transmissions round loops of vertices, as exact power series.

With tau = tan(angle / 2) / length one tau at a vertex with four folds determines the others along a
line of motions, tau_end = tau_start u(tau_start^2), and u solves (p + q s) u^2 + b u + c = 0. If k
of the transmissions round a loop are not linear and their composite agrees with the identity up to
the order 2^k + 1, it is the identity (docs/panels.md, 3 and 4).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from .intervals import Interval
from .panel_modes import Joined, Modes, corners_of, name
from .panel_sheet import cross, dot
from .reading import require
from .towers import Number

MOST_BENT = 6  # transmissions that are not linear, round one loop
MOST_ORDER = 2**MOST_BENT + 1
_BITS = (256, 1024)
Series = list[Any]
"""Coefficients of a power series: numbers or intervals."""


@dataclass
class Step:
    """The transmission at one vertex of a loop: its gain u(0), and (p, q, b), None if linear."""

    vertex: int
    gain: Number
    quadratic: tuple[Number, Number, Number] | None


def step(modes: Modes, chosen: Mapping[int, int], v: int, start: int, end: int) -> Step:
    """From the fold v-start to the fold v-end, on the line of motions that is chosen at v."""
    gain = modes.gain(v, chosen[v], start, end)
    if len(modes.lines[v][chosen[v]].densities) == 2:
        return Step(v, gain, None)
    near = modes.near[v]
    first = near.index(start)
    ring = near[first:] + near[:first]
    if ring[3] == end:  # seen in a mirror, which turns all brackets, of which even numbers occur
        ring = [start, *ring[:0:-1]]
    d = [modes.sheet.vector(v, u) for u in ring]

    def c(i: int, j: int) -> Number:
        return cross(d[i - 1], d[j - 1])

    two = modes.sheet.tower.number(2)
    if ring[1] == end:
        q = c(1, 2) * (c(3, 4) * dot(d[0], d[1]) + c(1, 2) * dot(d[2], d[3]))
        found = (c(2, 3) * c(2, 4), q, -(two * c(2, 3) * c(4, 1)))
    else:
        near_start, far = c(1, 2) * c(4, 1), c(2, 3) * c(3, 4)
        q = far * dot(d[0], d[0]) - near_start * dot(d[2], d[2])
        found = (far, q, modes.sheet.tower.number(0))
    return Step(v, gain, found if q.sign() else None)


def steps_of(modes: Modes, chosen: Mapping[int, int], loop: Sequence[int]) -> list[Step]:
    """The transmissions round a loop."""
    return [step(modes, chosen, *corner) for corner in corners_of(loop)]


def closes(modes: Modes, chosen: Mapping[int, int], loop: tuple[int, ...]) -> bool:
    """Whether the composite round a loop, which closes at first order, is the identity."""
    steps = steps_of(modes, chosen, loop)
    bent = sum(found.quadratic is not None for found in steps)
    if not bent:
        return True
    require(bent <= MOST_BENT, f"the loop {name(loop)} has too many transmissions not linear")
    order = 2**bent + 1
    if any(_differs(steps, order, bits) is not None for bits in _BITS):
        return False
    joined = Joined(modes, loop, chosen)
    zero = joined.tower.number(0)
    composite = composed(steps, order, joined.of, zero, joined.tower.number(1))
    return not any(value.sign() for value in composite[1:])


def fails(modes: Modes, chosen: Mapping[int, int], loop: tuple[int, ...], order: int) -> bool:
    """Whether the composite round a loop differs from the identity at just this odd order."""
    steps = steps_of(modes, chosen, loop)
    for bits in _BITS:
        if _differs(steps, order, bits) == order:
            return True
    joined = Joined(modes, loop, chosen)
    zero = joined.tower.number(0)
    composite = composed(steps, order, joined.of, zero, joined.tower.number(1))
    return bool(composite[order // 2].sign())


def _differs(steps: Sequence[Step], order: int, bits: int) -> int | None:
    """The last order up to this at which intervals prove the composite not to be the identity."""
    zero, one = Interval.of(Fraction(0), bits), Interval.of(Fraction(1), bits)
    try:
        found = composed(steps, order, lambda _, value: value.enclosed(bits), zero, one)
    except ZeroDivisionError:  # too coarse
        return None
    return next((2 * n + 1 for n in range(order // 2, 0, -1) if found[n].sign()), None)


def composed(
    steps: Sequence[Step], order: int, of: Callable[[int, Number], Any], zero: Any, one: Any
) -> Series:
    """f with tau = t f(t^2) after all steps, up to that order of tau; `of` converts numbers."""
    terms = order // 2 + 1
    f: Series = [one] + [zero] * (terms - 1)
    for found in steps:
        square = _times(f, f, zero)
        argument = [zero, *square[:-1]]
        u = _series(found, terms, of, zero)
        value = [zero] * terms
        for coefficient in reversed(u):
            value = _times(value, argument, zero)
            value[0] = value[0] + coefficient
        f = _times(f, value, zero)
    return f


def _series(found: Step, terms: int, of: Callable[[int, Number], Any], zero: Any) -> Series:
    """u with (p + q s) u^2 + b u + c = 0: the coefficient of s^n gives u_n."""
    u: Series = [of(found.vertex, found.gain)]
    if found.quadratic is None:
        return u
    p, q, b = (of(found.vertex, value) for value in found.quadratic)
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
