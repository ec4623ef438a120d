"""Configurations of tubes, and branch points, with 60 digits, by Newton's method."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

import mpmath
from flint import arb, arb_mat, fmpq

from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball
from exactfold.motion.tubes.tube import ROW_BITS, Tube


def newton(
    framework: Framework, tube: Tube, parameter: int, rim: Mapping[int, Fraction] | None = None
) -> list[Fraction]:
    """x(s) with 60 digits, from the middle of the tube; at 240 bits of precision or more.

    With a rim there are four more unknowns: the boundary heights are (l, a, b, c) times
    (rim, x, y, 1).
    """
    place = {int(v): 3 * k for k, v in enumerate(framework.free)}
    flat = [[fmpq(x, 1 << framework.bits) for x in (*p, 0)] for p in framework.points]
    one = 1 << tube.bits
    centre = [fmpq(x, one) for x in tube.coefficients[0]]
    row = [fmpq(t, 1 << ROW_BITS) for t in tube.row]
    s = fmpq(parameter, 1 << PARAMETER_BITS)
    n = len(centre)
    x = [arb(fmpq(c, one)) for c in tube.enclosure(parameter).centre]
    x += [arb(0)] * (0 if rim is None else 4)
    size = len(x)
    for _ in range(5):
        matrix, right = [[arb(0)] * size for _ in range(size)], []
        for e, (i, j) in enumerate(framework.edges.tolist()):
            ends = [(place[v], sign) for v, sign in ((i, 1), (j, -1)) if v in place]
            d = [sum((sign * x[k + a] for k, sign in ends), arb(0)) for a in range(3)]
            u = [arb(p - q) for p, q in zip(flat[i], flat[j], strict=True)]
            right.append([sum((a * b + b * b / 2 for a, b in zip(u, d, strict=True)), arb(0))])
            for k, sign in ends:
                for a in range(3):
                    matrix[e][k + a] = sign * (u[a] + d[a])
        for v, height in () if rim is None else rim.items():
            line = matrix[len(right)]
            height = fmpq(height.numerator, height.denominator)
            line[n:] = [arb(c) for c in (height, *flat[v][:2], 1)]
            if v in place:
                line[place[v] + 2] = arb(-1)
            right.append([sum((a * b for a, b in zip(line, x, strict=True)), arb(0))])
        matrix[-1][:n] = [arb(t) for t in row]
        gap = sum((arb(t) * (a - c) for t, a, c in zip(row, x[:n], centre, strict=True)), arb(0))
        right.append([gap - s])
        step = arb_mat(matrix).solve(arb_mat(right))
        x = [(a - step[k, 0]).mid() for k, a in enumerate(x)]
    assert max(abs(float(step[k, 0])) for k in range(size)) < 1e-55
    return [Fraction(int(q.p), int(q.q)) for q in (a.mid().fmpq() for a in x[:n])]


def driven_newton(
    framework: Framework, tube: Tube, parameter: int, drive: PrescribedAngles
) -> list[Fraction]:
    """x(s) with 60 digits, of a driven motion: lengths, and cosines of angles between normals.

    One more unknown is the factor m: the squares are in the ratio of the drive iff
    cos a = 1 - 2 m |q| for all driven folds.
    """
    place = {int(v): 3 * k for k, v in enumerate(framework.free)}
    scale = mpmath.mpf(1 << framework.bits)
    flat = [
        (mpmath.mpf(x) / scale, mpmath.mpf(y) / scale, mpmath.mpf(0)) for x, y in framework.points
    ]
    one = mpmath.mpf(1 << tube.bits)
    centre = [c / one for c in map(mpmath.mpf, tube.coefficients[0])]
    row = [mpmath.mpf(t) / (1 << ROW_BITS) for t in tube.row]
    s = mpmath.mpf(parameter) / (1 << PARAMETER_BITS)
    sheet = framework.sheet

    def minus(a, b):
        return [p - q for p, q in zip(a, b, strict=True)]

    def normal(x, i, j, k):
        (a, b, c), (p, q, r) = minus(x[j], x[i]), minus(x[k], x[i])
        return [b * r - c * q, c * p - a * r, a * q - b * p]

    def dot(a, b):
        return sum((p * q for p, q in zip(a, b, strict=True)), mpmath.mpf(0))

    def equations(*unknowns):
        x = {v: flat[v] for v in framework.pinned}
        x |= {v: tuple(flat[v][a] + unknowns[k + a] for a in range(3)) for v, k in place.items()}
        found = [
            dot(minus(x[i], x[j]), minus(x[i], x[j]))
            - dot(minus(flat[i], flat[j]), minus(flat[i], flat[j]))
            for i, j in framework.edges.tolist()
        ]
        for (i, j), q in zip(drive.folds, drive.squares, strict=True):
            left, right = sheet.opposite((i, j))
            one, two = normal(x, i, j, left), normal(x, j, i, right)
            cosine = dot(one, two) / mpmath.sqrt(dot(one, one) * dot(two, two))
            found.append(
                cosine - 1 + 2 * unknowns[-1] * abs(mpmath.mpf(q.numerator) / q.denominator)
            )
        return [*found, dot(row, minus(unknowns[:-1], centre)) - s]

    near = [c / one for c in map(mpmath.mpf, tube.enclosure(parameter).centre)]
    root = mpmath.findroot(equations, [*near, mpmath.mpf("0.01")], tol=1e-100)
    return [Fraction(int(mpmath.floor(x * 2**240)), 1 << 240) for x in list(root)[:-1]]


def holds(ball: Ball, x: list[Fraction]) -> bool:
    one = 1 << ball.bits
    return all(abs(a * one - c) <= r for a, c, r in zip(x, ball.centre, ball.radii, strict=True))


def assert_holds_the_node(
    patch: FlatPatch, box: Ball, rim: Mapping[int, Fraction] | None = None
) -> None:
    """The framework with a rigid patch, written down anew and solved by mpmath.

    With a rim the heights of five vertices of the boundary are always dependent on (rim, x, y, 1).
    """
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

        border = list(rim or ())
        fives = [[*border[:4], v] for v in border[4:]]
        row = {
            v: [1, *flat[v][:2], mpmath.mpf(rim[v].numerator) / rim[v].denominator] for v in border
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
            lengths = [
                sum((x[i][a] - x[j][a]) ** 2 - (flat[i][a] - flat[j][a]) ** 2 for a in range(3))
                for i, j in patch.bars.tolist()
            ]
            return [*lengths, *(mpmath.det([[*row[v], x[v][2]] for v in five]) for five in fives)]

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
