"""The path of boundary heights: linear equations that keep the boundary in a given ratio.

Let the boundary be convex, with heights b, and let the condition of Theorem 5 of docs/motion.md
hold for all 2^n sign vectors. Then all configurations on the path near the flat state lie on 2^n
curves, one for each sign vector. Proof: let d_k -> 0 be configurations on the path, not flat. Their
heights z are not all 0: otherwise U_e . d_e = -|d_e|^2 / 2, which no small d but 0 satisfies, since
the map on the left is injective. With t = |z|, the displacements in the plane over t^2 are bounded,
as in the proof of Theorem 3 (b). So a subsequence has limits u, h with |h| = 1 and
U_e . u_e + h_e^2 / 2 = 0. Therefore K_v(h) = 0 at all interior v, and h = l b + a on the boundary
with a number l and an affine function a. If l = 0, then h - a is a solution that vanishes on the
boundary, so it is 0; h = a vanishes on the triangle held, so h = 0, which is false. Else h / l is,
up to an affine function, the solution with the boundary heights b of some sign vector. By Theorem
3 (b) almost all d_k of the subsequence lie on its curve.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from math import gcd

from exactfold.branches.values.branch import Branch
from exactfold.exact.numbers import format_rational, integer_row
from exactfold.motion.claims import Claim
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.framework import Framework, Tie
from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.rigidity.equations.problem import Problem, barycentric


def problem_of(branch: Branch) -> Problem:
    """The problem of the sheet of a branch; with more than four corners, with its
    boundary heights.
    """
    boundary_heights = branch.boundary_heights if branch.pattern.Ve > 4 else None
    return Problem.of(branch.pattern, boundary_heights=boundary_heights)


def boundary_claim(boundary_heights: Mapping[int, Fraction]) -> Claim:
    """That the boundary heights stay in the ratio of these (docs/motion.md, 9)."""
    return Claim({"rim": [format_rational(h) for _, h in sorted(boundary_heights.items())]})


def ties_of(problem: Problem) -> tuple[Tie, ...]:
    """The D - 1 equations of the path of boundary heights; none with four boundary vertices.

    Let b be the given boundary heights. Heights z of the boundary vertices v satisfy the equations
    if and only if z_v = l b_v + an affine function of the flat vertex U_v, for some number l
    (docs/motion.md, More than four corners). Vertices are those of `rigidity.equations.sheet`.

    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.pattern.families import single_vertex
    >>> ties_of(problem_of(find_branch(single_vertex(4), "+")))
    ()
    >>> len(ties_of(problem_of(find_branch(single_vertex(7), "+"))))
    3
    """
    sheet, boundary_heights = problem.sheet, problem.gauge.boundary_heights
    if sheet.Ve < 5:
        return ()
    base, raised = _base(sheet, boundary_heights)
    unit = level(sheet, base, raised)
    height = _value(unit, boundary_heights)
    ties = []
    for v in sorted(set(sheet.boundary).difference(base, [raised])):
        own = level(sheet, base, v)
        slope = _value(own, boundary_heights) / height
        row = dict(own)
        for w, c in unit.items():
            row[w] = row.get(w, Fraction(0)) - slope * c
        ties.append(_whole(row))
    return tuple(ties)


def framework_of(
    problem: Problem, pinned: Triangle | None = None, drive: PrescribedAngles | None = None
) -> Framework:
    """The framework of a problem, with a drive, or else with the ties of the boundary heights."""
    if drive is None:
        return Framework.of(problem.sheet, pinned, ties_of(problem))
    place = {label: v for v, label in enumerate(problem.labels)}
    coupling = drive.coupling(problem.sheet, place)
    return Framework.of(problem.sheet, pinned, coupling=coupling)


def factor_functional(
    sheet: CreasePattern, boundary_heights: Mapping[int, Fraction]
) -> dict[int, Fraction]:
    """The functional of the boundary heights whose value is l at l b + an affine function.

    >>> from exactfold.pattern.families import single_vertex
    >>> sheet = single_vertex(5)
    >>> boundary_heights = {v: Fraction(v * v) for v in sheet.boundary}
    >>> sum(c * boundary_heights[v] for v, c in factor_functional(sheet, boundary_heights).items())
    Fraction(1, 1)
    """
    base, raised = _base(sheet, boundary_heights)
    row = level(sheet, base, raised)
    height = _value(row, boundary_heights)
    return {v: c / height for v, c in row.items()}


def level(sheet: CreasePattern, base: tuple[int, ...], v: int) -> dict[int, Fraction]:
    """The height of a vertex above the plane through three other vertices, as a functional."""
    row = {w: -c for w, c in zip(base, barycentric(sheet, base, v), strict=True)}
    return row | {v: Fraction(1)}


def _base(
    sheet: CreasePattern, boundary_heights: Mapping[int, Fraction]
) -> tuple[tuple[int, ...], int]:
    """Three boundary vertices far apart, and the one whose given height above their plane is
    largest.
    """
    points, _ = sheet.integer_vertices

    def apart(v: int, w: int) -> int:
        return (points[v][0] - points[w][0]) ** 2 + (points[v][1] - points[w][1]) ** 2

    def area(v: int) -> int:
        (ax, ay), (bx, by), (x, y) = points[a], points[b], points[v]
        return abs((bx - ax) * (y - ay) - (by - ay) * (x - ax))

    ordered = sorted(sheet.boundary)
    a = ordered[0]
    b = max(ordered, key=lambda v: apart(v, a))
    base = (a, b, max(ordered, key=area))
    others = [v for v in ordered if v not in base]
    return base, max(others, key=lambda v: abs(_value(level(sheet, base, v), boundary_heights)))


def _value(row: Mapping[int, Fraction], heights: Mapping[int, Fraction]) -> Fraction:
    return sum((c * heights[v] for v, c in row.items()), Fraction(0))


def _whole(row: Mapping[int, Fraction]) -> Tie:
    """The multiple whose coefficients are integers without a common divisor."""
    vertices = sorted(v for v, c in row.items() if c)
    whole = integer_row([row[v] for v in vertices])
    common = gcd(*whole)
    return tuple((v, c // common) for v, c in zip(vertices, whole, strict=True))
