"""A proof that configurations exist in which the faces at some vertices form one flat panel.

Why it is a proof: three corners of the panel are its base, and all its other corners are affine
combinations of these. A zero of the equations of the bars keeps the lengths of the sides of the
base. So the affine map from the flat panel is an isometry, and all edges keep their lengths
(docs/motion.md, 12).
"""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from math import lcm

from ..core.reading import require
from ..sheets.sheet import Edge, Sheet, turn
from .bounds import (
    INVERSE_BITS,
    WEIGHT_BITS,
    Columns,
    Rounded,
    Vector,
    bounds,
    dot,
    less_one,
    product,
)
from .equations import LengthEquations, inverse_of, rounded
from .tubes import Ball


class Patch:
    """The faces at the vertices `flat`, which are kept flat as one panel.

    The unknowns z are the displacements of the vertices `moving`. `rows[v]` gives the displacement
    of any vertex v in terms of z: integers over `denominator`, by index in `moving`. `bars` are the
    pairs of vertices whose distances give the equations: the edges that are not in the panel, and
    the sides of its base.
    """

    def __init__(self, equations: LengthEquations, flat: list[int]) -> None:
        sheet, pinned = equations.sheet, equations.pinned
        inner = bool(flat) and flat == sorted(set(flat)) and set(flat) <= set(sheet.interior)
        require(
            inner, "the flat vertices of a branch point are none, or not sorted interior vertices"
        )
        self.equations, self.flat = equations, flat
        self.vertices = set[int]().union(*(t for t in sheet.triangles if not t.isdisjoint(flat)))
        self.base = _base(sheet, [v for v in pinned if v in self.vertices], self.vertices)
        weights = _weights(sheet, self.base, self.vertices)
        self.denominator = lcm(*(w.denominator for row in weights.values() for w in row))
        self.moving = [v for v in equations.free if v not in weights]
        place = {v: k for k, v in enumerate(self.moving)}
        self.rows: dict[int, dict[int, int]] = {v: {} for v in sheet.points}
        for v, k in place.items():
            self.rows[v][k] = self.denominator
        for v, row in weights.items():
            for corner, w in zip(self.base, row, strict=True):
                if corner in place:
                    self.rows[v][place[corner]] = int(w * self.denominator)
        self.bars = [e for e in equations.edges if not self.vertices.issuperset(e)]
        self.bars += [e for e in combinations(self.base, 2) if not set(pinned).issuperset(e)]
        number = len(self.bars) + len(equations.ties)
        square = bool(self.moving) and number == 3 * len(self.moving)
        require(
            square, "with a flat patch there are no unknowns, or not as many equations as these"
        )

    def branch_point(self, near: Vector) -> Ball:
        """A box that holds a configuration with a flat patch; `near` is an approximation of it.

        Newton's test is applied to the equations D^2 (|X_i - X_j|^2 - |U_i - U_j|^2) / 2^(k + 1)
        with the denominator D and D^2 about 2^k, and to those of the ties times D / 2^(k / 2).
        """
        equations, bits, size = self.equations, self.equations.bits, 3 * len(self.moving)
        k = 2 * (self.denominator.bit_length() - 1)
        z = [near[self.equations.place[v] + a] for v in self.moving for a in range(3)]
        columns: Columns = [[] for _ in range(size)]
        residual, squares = [], []
        for e, (i, j) in enumerate(self.bars):
            flat, row = self._side(i, j), self._difference(i, j)
            x = [
                u * self.denominator + sum(c * z[3 * m + a] for m, c in row.items())
                for a, u in enumerate(flat)
            ]
            residual.append(dot(x, x) - dot(flat, flat) * self.denominator**2)
            for m, c in row.items():
                for a in range(3):
                    columns[3 * m + a].append((e, c * x[a]))
            most = sum(map(abs, row.values())) << WEIGHT_BITS
            squares.append((3 * most * most >> k) + 1)
        for e, tie in enumerate(equations.ties, len(self.bars)):
            line = self._tie(tie)
            residual.append(sum(c * z[3 * m + 2] for m, c in line.items()) << k // 2 + 1)
            for m, c in line.items():
                columns[3 * m + 2].append((e, c << k // 2))
        p = rounded(inverse_of(columns, bits + k))
        slope = less_one(product(p, columns), 1 << INVERSE_BITS + bits + k)
        proof = bounds(
            p,
            [[dot(row, residual) for row in p]],
            2 * bits + k + 1,
            [Rounded(slope, 0)],
            bits + k,
            [squares],
            [1 << WEIGHT_BITS] * size,
        )
        return self._all(z, proof.radius(Fraction(0)))

    def _all(self, z: Vector, radius: Fraction) -> Ball:
        """The box of the displacements of all free vertices, from the box of the unknowns."""
        centre, radii, whole = [], [], self.denominator
        for v in self.equations.free:
            row = self.rows[v]
            spread = radius * Fraction(sum(map(abs, row.values())) << self.equations.bits, whole)
            for a in range(3):
                centre.append(sum(c * z[3 * m + a] for m, c in row.items()) // whole)
                radii.append(int(spread) + 2)
        return Ball(centre, radii)

    def _tie(self, tie: Vector) -> dict[int, int]:
        """A tie as {index in `moving`: coefficient}, over 2^bits times `denominator`."""
        row: dict[int, int] = {}
        for v, k in self.equations.place.items():
            for m, c in self.rows[v].items() if tie[k + 2] else ():
                row[m] = row.get(m, 0) + tie[k + 2] * c
        return row

    def _side(self, i: int, j: int) -> Vector:
        """The flat edge vector U_i - U_j, over 2^bits."""
        equations = self.equations
        one = Fraction(1 << equations.bits) / equations.unit
        (ax, ay), (bx, by) = (equations.sheet.points[v] for v in (i, j))
        return [int((ax - bx) * one), int((ay - by) * one), 0]

    def _difference(self, i: int, j: int) -> dict[int, int]:
        """The row of the displacement of i minus the row of the displacement of j."""
        row = dict(self.rows[i])
        for m, c in self.rows[j].items():
            row[m] = row.get(m, 0) - c
        return {m: c for m, c in row.items() if c}


def _base(sheet: Sheet, pinned: list[int], vertices: set[int]) -> list[int]:
    """Three corners of a panel that are not on one line; its pinned corners are among them."""
    base, others = list(pinned), sorted(vertices)
    if not base:
        base.append(others[0])
    if len(base) == 1:
        x, y = sheet.points[base[0]]
        far = [(a - x) ** 2 + (b - y) ** 2 for a, b in map(sheet.points.__getitem__, others)]
        base.append(others[far.index(max(far))])
    if len(base) == 2:
        p, q = (sheet.points[v] for v in base)
        areas = [abs(turn(p, q, sheet.points[v])) for v in others]
        base.append(others[areas.index(max(areas))])
    return base


def _weights(sheet: Sheet, base: list[int], vertices: set[int]) -> dict[int, list[Fraction]]:
    """The affine coordinates, with respect to the base, of the other corners of a panel."""
    a, b, c = (sheet.points[v] for v in base)
    whole = turn(a, b, c)
    weights = {}
    for v in sorted(vertices.difference(base)):
        p = sheet.points[v]
        weights[v] = [turn(p, b, c) / whole, turn(a, p, c) / whole, turn(a, b, p) / whole]
    return weights


def wheel_stress(sheet: Sheet, vertex: int) -> dict[Edge, Fraction]:
    """The stress densities of an equilibrium on the wheel of an interior vertex.

    Let a_j be the spokes, counter-clockwise. The rim edge from j to j + 1 has the stress
    1 / (a_j x a_{j+1}). At each corner of the rim the forces along its two rim edges have opposite
    moments about the hub. So their sum is along the spoke, and the stress of the spoke balances it.
    """
    ring, (x, y) = sheet.star(vertex), sheet.points[vertex]
    spokes = [(sheet.points[j][0] - x, sheet.points[j][1] - y) for j in ring]
    stress: dict[Edge, Fraction] = {}
    boundary = [
        1 / Fraction(ax * by - ay * bx)
        for (ax, ay), (bx, by) in zip(spokes, spokes[1:] + spokes[:1], strict=True)
    ]
    for k, (j, (ax, ay)) in enumerate(zip(ring, spokes, strict=True)):
        after = (k + 1) % len(ring)
        stress[_pair(j, ring[after])] = boundary[k]
        force = [Fraction(0), Fraction(0)]
        for w, (bx, by) in ((boundary[k], spokes[after]), (boundary[k - 1], spokes[k - 1])):
            force = [force[0] + w * (bx - ax), force[1] + w * (by - ay)]
        stress[_pair(vertex, j)] = (force[0] * ax + force[1] * ay) / (ax * ax + ay * ay)
    return stress


def _pair(i: int, j: int) -> Edge:
    return min(i, j), max(i, j)
