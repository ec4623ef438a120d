"""Configurations of tubes with 60 digits, by Newton's method in ball arithmetic."""

from __future__ import annotations

from fractions import Fraction

from flint import arb, arb_mat, fmpq

from exactfold.motion.framework import Framework
from exactfold.motion.piece import PARAMETER_BITS, Ball
from exactfold.motion.tube import ROW_BITS, Tube


def newton(framework: Framework, tube: Tube, parameter: int) -> list[Fraction]:
    """x(s) with 60 digits, from the middle of the tube; at 240 bits of precision or more."""
    place = {int(v): 3 * k for k, v in enumerate(framework.free)}
    flat = [[fmpq(x, 1 << framework.bits) for x in (*p, 0)] for p in framework.points]
    one = 1 << tube.bits
    centre = [fmpq(x, one) for x in tube.coefficients[0]]
    row = [fmpq(t, 1 << ROW_BITS) for t in tube.row]
    s = fmpq(parameter, 1 << PARAMETER_BITS)
    n = len(centre)
    x = [arb(fmpq(c, one)) for c in tube.enclosure(parameter).centre]
    for _ in range(5):
        matrix, right = [[arb(0)] * n for _ in range(n)], []
        for e, (i, j) in enumerate(framework.edges.tolist()):
            ends = [(place[v], sign) for v, sign in ((i, 1), (j, -1)) if v in place]
            d = [sum((sign * x[k + a] for k, sign in ends), arb(0)) for a in range(3)]
            u = [arb(p - q) for p, q in zip(flat[i], flat[j], strict=True)]
            right.append([sum((a * b + b * b / 2 for a, b in zip(u, d, strict=True)), arb(0))])
            for k, sign in ends:
                for a in range(3):
                    matrix[e][k + a] = sign * (u[a] + d[a])
        matrix[n - 1] = [arb(t) for t in row]
        gap = sum((arb(t) * (a - c) for t, a, c in zip(row, x, centre, strict=True)), arb(0))
        right.append([gap - s])
        step = arb_mat(matrix).solve(arb_mat(right))
        x = [(a - step[k, 0]).mid() for k, a in enumerate(x)]
    assert max(abs(float(step[k, 0])) for k in range(n)) < 1e-55
    return [Fraction(int(q.p), int(q.q)) for q in (a.mid().fmpq() for a in x)]


def holds(ball: Ball, x: list[Fraction]) -> bool:
    one = 1 << ball.bits
    return all(abs(a * one - c) <= r for a, c, r in zip(x, ball.centre, ball.radii, strict=True))
