"""Tessellations over all directions: where branches cross, and the inertia of the Jacobian."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from fractions import Fraction
from itertools import product
from math import cos, radians, sin
from pathlib import Path
from typing import Any, Final

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import numpy as np
from sympy import QQ
from sympy.polys.fields import field

from exactfold._support.verdict import PROVED
from exactfold.branches import DirectionsCount, PeriodicCount, count_directions, count_periodic
from exactfold.branches.periodic.rays import Ray
from exactfold.exact.linalg import inertia_by_elimination
from exactfold.pattern import PeriodicPattern, random_cell, read_cell
from exactfold.pattern.periodic.cells import Corner
from exactfold.rigidity.curvature import star_matrix
from exactfold.rigidity.equations.all_directions import AllDirections
from exactfold.rigidity.equations.periodic import PeriodicProblem
from proofs.cells import TWO, Vector, polars
from proofs.framework import Proof, Script, run

NAME = "periodic_directions"
TITLE = "Tessellations over all directions: crossings, and the inertia of the Jacobian"
DIRECTIONS = ((3, 4), (1, 0), (-2, 5))
_STEP: Final = 0.4
"""Degrees between the directions at which a branch is looked at on both sides of a crossing."""
_GRID: Final = 1 << 20


def prove(change: str | None = None) -> Proof:
    """Machine steps of Theorems 19 to 21 of docs/tessellations.md."""
    script = Script(
        NAME,
        TITLE,
        (
            "a straight-line triangulation of the plane that repeats under a lattice; loops and "
            "repeated edges in the cell are allowed; without pleats except in Theorem 21",
        ),
        change,
    )
    place = "docs/tessellations.md, Theorem"
    script.state(
        "T.19",
        f"{place} 19",
        r"\text{branches are analytic in }n\text{; where stars }F\text{ go flat, and no tangent is "
        r"flat at one of them, all signs on }F\text{ change on each of }2^{|F|}\text{ branches}",
        note="each crossing exchanges sign vectors in pairs",
        code="count_directions",
        words=f"{place} 19",
    )
    script.state(
        "T.20",
        f"{place} 20",
        r"\text{at a simple solution with }b=1\text{ without flat stars, }J\text{ on periodic "
        r"heights has }\#\mathrm{up}\text{ positive and }\#\mathrm{down}-1\text{ negative "
        r"eigenvalues}",
        note="the Jacobian of the periodic heights; constants are its kernel",
        words=f"{place} 20",
    )
    script.state(
        "T.22",
        f"{place} 21",
        r"\text{a pleat without flat vertices is in families of one direction at most}",
        note="a linear space of solutions for all directions together",
        code="count_directions",
        words=f"{place} 21",
    )
    _ramification(script)
    _flat_stars(script)
    _waterbomb(script)
    _continued(script)
    _symmetry(script)
    _inertia(script)
    _singular(script)
    _families(script)
    return script.proof()


# --- crossings ------------------------------------------------------------------------------------


def _ramification(script: Script) -> None:
    """Powers of a root of unity are numbers modulo 1: j / e, and j / (2 e) for tau < 0."""
    bound = script.alter("all powers", 1, 0)
    script.cases(
        "c tau^j with tau^e = t and e not a divisor of j: if all its values are real for t > 0, "
        "those for t < 0 are not (all 0 < j < e <= 40)",
        (
            (2 * (j * k + Fraction(j, 2))) % e != 0 and bound == 1
            for e in range(2, 41)
            for j in range(1, e)
            if (2 * j) % e == 0
            for k in range(e)
        ),
        of="T.19",
    )


def _flat_stars(script: Script) -> None:
    """A flat star gives no term of first order, and K_v(z) in second order."""
    _, *s = field("a1 a2 b1 b2 c1 c2 d1 d2 p q", QQ)
    spokes = [(s[0], s[1]), (s[2], s[3]), (s[4], s[5]), (s[6], s[7])]
    p, q = s[8:]
    matrix = star_matrix(spokes, lambda a, b: a / b)
    square = script.alter("a bent star", 0, 1)
    h = [p * 0, *(p * u + q * v + square * u * u for u, v in spokes)]
    script.identity(
        "the heights h of a flat star have K_v(h, z) = 0 for all z, so K_v(h + t z + t^2 y) is t^2 "
        "K_v(z) and terms of order t^3, for all stars with four folds",
        *(sum((m * x for m, x in zip(row, h, strict=True)), p * 0) for row in matrix),
        of="T.19",
    )


def _waterbomb(script: Script) -> None:
    """Both solutions that meet at n = (0, 1), where vertex 2 is flat, for n = (t, 1)."""
    problem = AllDirections.of(read_cell("waterbomb-cell"))
    _, t, r = field("t r", QQ)
    unit = QQ(problem.unit.numerator, problem.unit.denominator)
    side = script.alter("one sign of the root", -1, 1)
    roots = []
    for sign in (1, side):
        w = (t * t + 1 + sign * t * r) / 2
        z = [t * 0, w, t * t / unit, t / unit, 1 / unit]
        roots.append(
            [sum((c * x for c, x in zip(row, z, strict=True)), t * 0) for row in problem.vertices]
        )
    at_2 = [values[2] / t for values in roots]
    script.identity(
        "on the waterbomb the row of vertex 2 is t times a function of n = (t, 1) on both "
        "branches, and these have opposite values at t = 0",
        (at_2[0] + at_2[1]).numer.evaluate(t.numer, 0),
        of="T.19",
    )
    others = [value for values in roots for value in values[:2]]
    script.certificate(
        "they have no pole there and are not 0, as t^2 + 4 is the square of r = 2, and the rows of "
        "the other vertices are not 0 either",
        all(value.denom(0, 2) and value.numer(0, 2) for value in (*at_2, *others)),
        of="T.19",
    )


def _continued(script: Script) -> None:
    """Counts on both sides of crossings: which branch goes on as which."""
    same = script.alter("signs are kept", False, True)
    script.cases(
        "the solution that continues a branch beyond a crossing has the other signs on F: it is "
        "the nearest one to the extrapolated heights, on the waterbomb and on random cells",
        (
            outcome
            for cell in (read_cell("waterbomb-cell"), random_cell(3, 4, 16), random_cell(3, 8, 16))
            for outcome in _outcomes(cell, count_directions(cell), same)
        ),
        of="T.19",
    )


def _outcomes(cell: PeriodicPattern, known: DirectionsCount, same: bool) -> Iterator[bool]:
    if known.status is not PROVED:
        yield False
    for crossing in known.crossings:
        at = [_heights(cell, crossing.angle + k * _STEP) for k in (-3, -2, -1, 1)]
        values = {"+": 1, "-": -1, "0": 0}
        shown = [crossing.b * values[sign] for sign in crossing.vertex_signs]
        for signs in product((1, -1), repeat=len(crossing.vertices)):
            choice = dict(zip(crossing.vertices, signs, strict=True))
            before = tuple(choice.get(v, sign) for v, sign in enumerate(shown))
            after = tuple(-choice[v] if v in choice else s for v, s in enumerate(shown))
            x, y, z = (heights[before] for heights in at[:3])
            # through three equal steps, to the point four steps after the first
            guess = 3 * x - 8 * y + 6 * z
            near = min(at[3], key=lambda label: float(np.linalg.norm(at[3][label] - guess)))
            yield near == (before if same else after)


def _heights(cell: PeriodicPattern, angle: float) -> dict[tuple[int, ...], np.ndarray[Any, Any]]:
    """The heights w with b = 1 / |n|^2, in floats, by vertex signs on the side with b > 0."""
    n = round(cos(radians(angle)) * _GRID), round(sin(radians(angle)) * _GRID)
    found = {}
    for problem, ray in _rays(count_periodic(cell, n)):
        scale = float(problem.unit * sum(x * x for x in problem.direction))
        heights = np.array([float(x) for x in _point(ray)]) / scale
        found[tuple(ray.b * s for s in ray.signs)] = heights
    return found


# --- the Jacobian ---------------------------------------------------------------------------------


def _rays(result: PeriodicCount) -> Iterator[tuple[PeriodicProblem, Ray]]:
    evidence = result.evidence
    if evidence is not None:
        yield from ((evidence.problem, ray) for ray in evidence.rays)


def _point(ray: Ray) -> list[Fraction]:
    """The middle of the box of a ray: z = (w, c) with c = 1."""
    box = ray.root.box
    x = [Fraction(c, 1 << box.bits) for c in box.real]
    z = [*x[: ray.place], Fraction(1), *x[ray.place :]]
    return [value / z[-1] for value in z]


def _symmetry(script: Script) -> None:
    _, a1, a2, b1, b2, x, y, p, q, n1, n2, w = field("a1 a2 b1 b2 x y p q n1 n2 w", QQ)
    lattice, points = [(a1, a2), (b1, b2)], [(p, q), (x, y)]
    bend = script.alter("heights that are not periodic", 0, 1)

    def height(corner: Corner, place: Vector) -> Any:
        return w * corner[0] + (n1 * place[0] + n2 * place[1]) ** 2 / 2

    def unit(v: int) -> Any:
        return lambda corner, place: (corner[0] == v) + bend * place[0] ** 2

    rows = [polars(TWO, lattice, points, height, unit(v)) for v in (0, 1)]
    script.identity(
        "the Jacobian on periodic heights is symmetric, and its columns add up to 0: for all "
        "cells of two vertices and all heights",
        rows[0][1] - rows[1][0],
        rows[0][0] + rows[0][1],
        rows[1][0] + rows[1][1],
        of="T.20",
    )


def _inertia(script: Script) -> None:
    less = script.alter("one eigenvalue for each vertex that is down", 1, 0)
    script.cases(
        "J at the middle of the box of each branch of random cells: #up positive and #down - 1 "
        "negative eigenvalues on the side with b > 0",
        (
            _signature(problem, _point(ray)) == (ups, downs - less)
            for vertices in (2, 3, 4, 5)
            for seed in range(4)
            for n in DIRECTIONS
            for problem, ray in _rays(count_periodic(random_cell(vertices, seed, flips=seed), n))
            for signs in [[ray.b * s for s in ray.signs]]
            for ups, downs in [(signs.count(1), signs.count(-1))]
        ),
        of="T.20",
    )


def _signature(problem: PeriodicProblem, z: list[Fraction]) -> tuple[int, int]:
    """The inertia of the Jacobian on the heights w of all vertices but the first."""
    rows = [
        [sum((a * b for a, b in zip(row, z, strict=True)), Fraction(0)) for row in star.form]
        for star in problem.stars
    ]
    square = [row[: problem.size] for row in rows[1:]]
    symmetric = [
        [(a + b) / 2 for a, b in zip(row, column, strict=True)]
        for row, column in zip(square, zip(*square, strict=True), strict=True)
    ]
    positive, negative, *_ = inertia_by_elimination(symmetric)
    return positive, negative


# --- families -------------------------------------------------------------------------------------


def _singular(script: Script) -> None:
    """B = n n^T and C, with det (B + t C) = 0 for all t: then C n' = 0 for n' at right angles."""
    _, x, y, a, b, c = field("x y a b c", QQ)
    polar = x * x * c - 2 * x * y * b + y * y * a  # the coefficient of t
    square = a * c - b * b
    part = script.alter("the first entry of C n'", 0, 1)
    first, second = a * y - b * x + part, b * y - c * x
    script.identity(
        "if det (n n^T + t C) = 0 for all t, then C n' = 0 for the n' at right angles to n, so "
        "that C is a multiple of n n^T",
        first * first - a * polar + square * x * x,
        second * second - c * polar + square * y * y,
        of="T.22",
    )


def _families(script: Script) -> None:
    """Cells with pleats: the directions that are found, beside counts for single directions."""
    extra = script.alter("no other direction", False, True)
    cells = [read_cell("miura-cell"), read_cell("yoshimura-cell")]
    cells += [random_cell(v, seed, 64, flips=f) for v, seed, f in ((3, 461, 3), (5, 1150, 0))]
    script.cases(
        "families of cells with pleats are at the directions found from the pleats, and at none "
        "of five others",
        (
            bool(count_periodic(cell, n).families) == (n in found or extra)
            for cell in cells
            for found in [[(k.x[0], k.y[0]) for k in count_directions(cell).families or ()]]
            for n in {*found, (3, 4), (-1, 3), (5, 2), (1, 1), (7, -1)}
        ),
        of="T.22",
    )


if __name__ == "__main__":
    raise SystemExit(run(prove()))
