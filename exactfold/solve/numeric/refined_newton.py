"""Single zeros of the nappe equations in higher precision, if doubles do not separate them.

Rows and method are those of `dense_newton`, for one sign vector at a time. The Jacobian also has
high precision, as it depends on the direction of A_v h, which doubles lose next to a flat star.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from exactfold.solve.numeric.dense_newton import NappeSystem

_STEPS = 60
_HALVINGS = 60
_GUARD = 40


@dataclass(frozen=True)
class RefinedEnd:
    """A zero to `bits` bits: point / 2^bits in the chart, and the vertices that look flat there.

    `flat` lists the places in the sign vector with |A_v h| below 2^-(bits/2). Nothing is proved.
    """

    point: tuple[int, ...]
    bits: int
    flat: tuple[int, ...]


def refined_end(system: NappeSystem, signs: Sequence[int], bits: int) -> RefinedEnd | None:
    """The zero of g for one sign vector, to `bits` bits after the point; None if not found.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.rigidity.equations.branch_system import chamber_chart
    >>> refined_end(NappeSystem(chamber_chart(single_vertex(4))), [1], 10)
    RefinedEnd(point=(512,), bits=10, flat=())
    """
    e = system.full_signs(np.array([signs], dtype=np.float64))
    (start,), _, _ = system.unknowns(e)
    if not np.isfinite(start).all():
        return None
    newton = _Newton(system, [int(sign) for sign in e[0]], bits)
    x = newton.run([newton.ctx.mpf(value) for value in start.tolist()])
    if x is None:
        return None
    _, _, norms = newton.values(x)
    tiny = newton.ctx.ldexp(1, -(bits // 2))
    flat = tuple(k for k, norm in enumerate(norms) if norm < tiny)
    if system.gauge.corner is not None:
        weights = [system.chart.functional.get(v, 0) for v in system.gauge.unknowns]
        value = sum(newton.rational(w) * a for w, a in zip(weights, x, strict=True))
        if not value:
            return None
        x = [a / value for a in x[:-1]]
    return RefinedEnd(tuple(int(newton.ctx.nint(a * 2**bits)) for a in x), bits, flat)


class _Newton:
    """Damped Newton steps in mpmath, in its own context."""

    def __init__(self, system: NappeSystem, e: list[int], bits: int) -> None:
        import mpmath  # here: few paths need it

        self.ctx: Any = mpmath.mp.clone()
        self.ctx.prec = bits + _GUARD
        self.e = e
        self.small = self.ctx.ldexp(1, -bits - _GUARD // 2)
        self.lines = [[self.rational(c) for c in nappe.line] for nappe in system.nappes]
        self.roots = [
            [[self.ctx.sqrt(self.rational(d)) * self.rational(c) for c in row] for d, row in n]
            for n in (nappe.squares for nappe in system.nappes)
        ]

    def rational(self, value: Any) -> Any:
        """A rational number, rounded to the precision of the context."""
        return self.ctx.mpf(value.numerator) / value.denominator

    def values(self, x: list[Any]) -> tuple[list[Any], list[list[Any]], list[Any]]:
        """g, the products A_v h, and the norms |A_v h|."""
        z = [*x, self.ctx.mpf(1)]
        products = [[self.ctx.fdot(row, z) for row in root] for root in self.roots]
        norms = [self.ctx.sqrt(self.ctx.fdot(p, p)) for p in products]
        lines = [self.ctx.fdot(line, z) for line in self.lines]
        g = [a - s * b for a, s, b in zip(lines, self.e, norms, strict=True)]
        return g, products, norms

    def run(self, x: list[Any]) -> list[Any] | None:
        """The zero near x; None if the steps do not become shorter than the precision."""
        n, ctx = len(x), self.ctx
        g, products, norms = self.values(x)
        for _ in range(_STEPS):
            rows = ctx.matrix(n, n)
            for v in range(n):
                weights = [-self.e[v] * p / norms[v] if norms[v] else 0 * p for p in products[v]]
                for k in range(n):
                    column = [row[k] for row in self.roots[v]]
                    rows[v, k] = self.lines[v][k] + ctx.fdot(weights, column)
            try:
                change = list(ctx.lu_solve(rows, ctx.matrix(g)))
            except ZeroDivisionError:
                return None
            before, length = max(map(abs, g)), ctx.mpf(1)
            for _ in range(_HALVINGS):
                moved = [a - length * b for a, b in zip(x, change, strict=True)]
                g, products, norms = self.values(moved)
                if max(map(abs, g)) <= max((1 - length / 10) * before, self.small):
                    break
                length /= 2
            else:
                return None
            x = moved
            if length == 1 and max(map(abs, change)) < self.small * (1 + max(map(abs, x))):
                return x
        return None
