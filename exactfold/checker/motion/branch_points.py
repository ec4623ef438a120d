"""Arcs through branch points, where the stars of some vertices are flat (docs/motion.md, 12).

Why it is a proof: let x* be a configuration with a flat patch, X_e its edge vectors, and w_v the
wheel stresses of the flat vertices. They are in equilibrium in x*, as they are in the flat sheet.
Let s be not 0. Then x* + s y is a configuration if X_e . y_e + (s / 2) |y_e|^2 = 0 for all edges e.
One edge for each flat vertex may be left out, if the stresses on these edges are independent: the
equations of the other edges, and sum_e w_v,e |y_e|^2 / 2 = 0 for each flat vertex v, imply those
of the edges left out. Together with T . y = 1 these equations have one analytic curve y(s) of zeros
near a polynomial, for every x* in its box.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm

from ..core.limits import MOTION_BITS
from ..core.reading import require
from .bounds import (
    INVERSE_BITS,
    WEIGHT_BITS,
    Columns,
    Vector,
    bounds,
    dot,
    norm,
    product,
    weights_of,
)
from .equations import ORDER, LengthEquations, extended, images, inverse_of, largest, rounded
from .packed import Lanes
from .patches import Patch, wheel_stress
from .tubes import ROW_BITS, Ball, Piece, near

Rows = Sequence[Sequence[int]]


class Stresses:
    """The wheel stresses of some vertices, as integers over 2^`bits`.

    `rows[k]` is {number of an edge: stress} for the k-th vertex. Its equation replaces that of the
    edge `replaced[k]`.
    """

    def __init__(self, equations: LengthEquations, flat: list[int]) -> None:
        place = {e: k for k, e in enumerate(equations.edges)}
        self.rows: list[dict[int, int]] = []
        for v in flat:
            stress = wheel_stress(equations.sheet, v)
            whole = lcm(*(w.denominator for w in stress.values()))
            self.rows.append({place[e]: int(w * whole) for e, w in stress.items() if e in place})
        sizes = [max(map(abs, row.values())).bit_length() for row in self.rows]
        self.bits = max(sizes)
        require(self.bits <= MOTION_BITS, "the stresses are out of range")
        for row, size in zip(self.rows, sizes, strict=True):
            for e in row:
                row[e] <<= self.bits - size
        self.replaced = independent(self.rows)


def independent(rows: list[dict[int, int]]) -> list[int]:
    """One column for each row such that the rows are independent on these columns.

    Raises if the rows are not independent.
    """
    left = [{k: Fraction(x) for k, x in row.items()} for row in rows]
    chosen: list[int] = []
    for n, row in enumerate(left):
        column = max(row, key=lambda k: abs(row[k]))
        require(row[column], "the stresses of flat vertices are not independent")
        chosen.append(column)
        for other in left[n + 1 :]:
            factor = other.get(column, Fraction(0)) / row[column]
            for k, x in row.items() if factor else ():
                other[k] = other.get(k, Fraction(0)) - factor * x
    return chosen


class BranchPointTube(Piece):
    """An arc of configurations x* + s y(s) through a branch point x*, of which a box is known.

    T . y(s) = 1 with T = row / 2^ROW_BITS. The curve of the base class `Piece` is y.
    """

    def __init__(
        self, patch: Patch, branch_point: Ball, centre: Vector, row: Vector, reach: Fraction
    ) -> None:
        equations, self.branch_point = patch.equations, branch_point
        bits, stresses = equations.bits, Stresses(equations, patch.flat)
        more, replaced = stresses.bits, stresses.replaced
        kept = [int(e not in replaced) for e in range(len(equations.edges))]
        x = [
            tuple(a + b for a, b in zip(u, d, strict=True))
            for u, d in zip(equations.flat, equations.along(branch_point.centre), strict=True)
        ]

        def derivative(rows: Rows, terms: Rows, last: Sequence[Sequence[int]]) -> Columns:
            """DH over 2^(bits + more), for the rows of the kept edges and of the stresses.

            `last` are the rows after these. The entries may be packed polynomials.
            """
            scaled = [[a * m << more for a in e] for m, e in zip(kept, rows, strict=True)]
            columns = equations.columns(scaled, last)
            for edge, stress in zip(replaced, stresses.rows, strict=True):
                here = [[a * stress.get(e, 0) for a in y] for e, y in enumerate(terms)]
                for column, added in zip(columns, equations.columns(here), strict=True):
                    if total := sum(value for _, value in added):
                        column.append((edge, total))
            return columns

        def residual(y: Vector, width: int) -> Vector:
            """H over 2^(2 bits + more + 1)."""
            edges = equations.along(y)
            squares = [dot(e, e) for e in edges]
            total = [
                2 * dot(a, e) + (square << width) << more
                for a, e, square in zip(x, edges, squares, strict=True)
            ]
            for edge, stress in zip(replaced, stresses.rows, strict=True):
                total[edge] = sum(w * squares[e] for e, w in stress.items())
            ties = [t << more + 1 for t in equations.tied(y)]
            last = dot(row, y) - (1 << bits + ROW_BITS)
            return [*total, *ties, last << bits + more - ROW_BITS + 1]

        last = equations.last_rows([t << bits + more - ROW_BITS for t in row], more)
        p = rounded(inverse_of(derivative(x, equations.along(centre), last), bits + more))
        curve = extended(equations, centre, p, residual, bits + more + 1)
        parts = [equations.along(a) for a in curve]
        rows: list[Rows] = [x, *parts]
        wheel = max(sum(map(abs, stress.values())) for stress in stresses.rows)
        sizes = [max(largest(x) << more, largest(last)), *(largest(y) << more for y in parts)]
        stressed_sizes = [*(wheel * largest(y) for y in parts), 0]
        sizes = list(map(max, sizes, stressed_sizes))
        lanes = Lanes(p, sizes)
        columns = derivative(lanes.table(rows), lanes.table(parts), lanes.table([last]))
        slopes = lanes.read(product(p, columns), 1 << INVERSE_BITS + bits + more)
        weights = weights_of(near(slopes, bits + more))
        sums = equations.weight_sums(weights)
        square = [dot(e, e) for e in sums]
        stressed = [0] * len(x)
        for edge, stress in zip(replaced, stresses.rows, strict=True):
            stressed[edge] = (sum(abs(w) * square[e] for e, w in stress.items()) >> more) + 1
        room = equations.beyond([*curve, *x, *last], more)
        proof = bounds(
            p,
            images(equations, curve, p, residual, room, 2 * ORDER + 1),
            2 * bits + more + 1,
            slopes,
            bits + more,
            [stressed, [a * m for a, m in zip(square, kept, strict=True)]],
            weights,
        )
        # X_e lies in a box about x_e: how much that changes the equations and their derivatives.
        spread = equations.weight_sums(branch_point.radii)
        kept_p = [[abs(a) * m for a, m in zip(line, kept, strict=False)] for line in p]

        def off(rows: Rows, places: int) -> int:
            """A bound of |P v|: v_e = spread_e . rows_e if the equation of e is kept, else 0."""
            most = [dot(r, map(abs, a)) for r, a in zip(spread, rows, strict=True)]
            return norm([dot(line, most) for line in kept_p], weights, INVERSE_BITS + places)

        for k, part in enumerate(parts):
            proof.b[k] += off(part, 2 * bits)
        proof.q[0] += off(sums, bits + WEIGHT_BITS)
        Piece.__init__(self, equations, curve, weights, proof, reach)

    def configuration(self, s: Fraction) -> tuple[Ball, Ball]:
        """Boxes that hold the displacements x* + s y and their derivative y + s y'."""
        y, rate = self.enclosure(s), self.velocity(s)
        return _sum(self.branch_point, s, y), _sum(y, s, rate)


def _sum(a: Ball, s: Fraction, b: Ball) -> Ball:
    """A box that holds a + s b."""
    return Ball(
        [x + int(s * y) for x, y in zip(a.centre, b.centre, strict=True)],
        [x + int(abs(s) * y) + 2 for x, y in zip(a.radii, b.radii, strict=True)],
    )
