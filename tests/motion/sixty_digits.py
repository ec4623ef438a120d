"""Configurations of tubes, and nodes, with 60 digits, by Newton's method."""

from __future__ import annotations

from fractions import Fraction

import mpmath
from flint import arb, arb_mat, fmpq

from exactfold.motion.flat_patches import FlatPatch
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


def assert_holds_the_node(patch: FlatPatch, box: Ball) -> None:
    """The framework with a rigid patch, written down anew and solved by mpmath."""
    framework = patch.framework
    with mpmath.workdps(60):
        one = mpmath.mpf(1 << framework.bits)
        flat = [
            (mpmath.mpf(x) / one, mpmath.mpf(y) / one, mpmath.mpf(0)) for x, y in framework.points
        ]
        moving = list(patch.moving)
        weights = {
            v: [mpmath.mpf(w.numerator) / w.denominator for w in row]
            for v, row in patch.weights.items()
        }

        def places(unknowns):
            x = {v: flat[v] for v in framework.pinned}
            for k, v in enumerate(moving):
                x[v] = tuple(flat[v][a] + unknowns[3 * k + a] for a in range(3))
            for v, row in weights.items():
                x[v] = tuple(
                    sum(w * x[b][a] for w, b in zip(row, patch.base, strict=True)) for a in range(3)
                )
            return x

        def equations(*unknowns):
            x = places(unknowns)
            return [
                sum((x[i][a] - x[j][a]) ** 2 - (flat[i][a] - flat[j][a]) ** 2 for a in range(3))
                for i, j in patch.bars.tolist()
            ]

        free = {int(v): k for k, v in enumerate(framework.free)}
        centre = [mpmath.mpf(c) / (1 << box.bits) for c in box.centre]
        start = [centre[3 * free[v] + a] for v in moving for a in range(3)]
        root = list(mpmath.findroot(equations, start, tol=1e-100))
        x = places(root)
        for v, k in free.items():
            for a in range(3):
                off = abs(x[v][a] - flat[v][a] - centre[3 * k + a])
                assert off <= mpmath.mpf(box.radii[3 * k + a]) / (1 << box.bits)
        # All edges, those of the patch included, have their lengths.
        for i, j in framework.sheet.edges:
            change = sum(
                (x[i][a] - x[j][a]) ** 2 - (flat[i][a] - flat[j][a]) ** 2 for a in range(3)
            )
            assert abs(change) < mpmath.mpf(10) ** -50
