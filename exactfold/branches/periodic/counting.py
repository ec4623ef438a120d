"""`count_periodic`: finds, proves and counts all branches of a periodic sheet for one direction."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.plurals import agreeing
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.periodic.exactly import ExactRay, exact_rays
from exactfold.branches.periodic.lines import (
    QuadraticLine,
    agree,
    covering,
    rational_point,
    solved_near,
)
from exactfold.branches.periodic.rays import Ray, prove_rays
from exactfold.branches.periodic.result import (
    AlgebraicLine,
    Evidence,
    HeightSpace,
    PeriodicCount,
)
from exactfold.branches.periodic.shown import Shown, sorted_branches
from exactfold.branches.periodic.spaces import Cover, Space, Spaces, combined, echelon
from exactfold.errors import NotCountedError
from exactfold.exact.linalg import nullspace
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row
from exactfold.solve.numeric.periodic_rays import PeriodicRays

MOST = 20
"""The most vertices, outside triangulated triangles, of a cell that is counted."""
_MOST_OPEN = 1000


def count_periodic(
    cell: object,
    direction: Sequence[RationalLike],
    *,
    limit: float | None = None,
    progress: Progress | None = None,
) -> PeriodicCount:
    """The proved branches of a periodic sheet that rolls up across one direction, and its pleats.

    `cell` is a `PeriodicPattern`, or what `read_cell` reads. `direction` is the vector n at right
    angles to the axis of the cylinder, in the coordinates of the points; only its direction counts.
    All solutions of second order with heights w + (b/2) (n . x)^2 are real and form linear spaces.
    Without pleats there are 2^(V - 1) with multiplicity, one for each pair of opposite vertex sign
    vectors, each 2^(number of flat vertices) times (docs/tessellations.md, Theorem 16).
    Newton's method proposes a ray for each sign vector, and Krawczyk's test, or linear algebra over
    Q, proves it. After `limit` seconds no exact test or linear algebra begins.

    Raises the errors of `read_cell`, `UsageError` for a bad direction, and `NotCountedError` for a
    cell of more than 20 vertices. UNDECIDED does not mean that the count is unusual.

    >>> result = count_periodic("resch-cell", (3, 4))
    >>> result.status, result.distinct, result.with_multiplicity, result.pleats
    (<Verdict.PROVED: 'proved'>, 8, 8, ())
    """
    start, clock = time.perf_counter(), Clock(limit)
    problem = PeriodicProblem.of(as_cell(cell), direction)
    if problem.sheet.V > MOST:
        raise NotCountedError(
            f"the cell has {problem.sheet.V} vertices outside triangulated triangles: 2^"
            f"{problem.size} branches are too many to list, at most {MOST} vertices are counted"
        )
    if progress is not None:
        progress("solving", 0, 0)
    rays = PeriodicRays(problem)
    proved = prove_rays(problem, rays.rays(), rays.signs, clock)
    missing = sorted(set(range(len(rays.signs))) - proved.keys())
    if missing and not clock.passed:
        sharper = rays.sharper(np.array(missing))
        again = prove_rays(problem, sharper, rays.signs[missing], clock)
        proved |= {missing[row]: replace(ray, row=missing[row]) for row, ray in again.items()}
        missing = sorted(set(missing) - proved.keys())
    covers, lines = _covered(problem, rays, missing, clock)
    result = _result(problem, rays, proved, covers, lines)
    if result.status is not PROVED and not clock.passed:
        exact = exact_rays(problem, clock)
        if exact is not None:
            left = [rays.signs[row].tolist() for row in missing]
            left = [s for s in left if not any(agree(cover.signs, s) for cover in covers)]
            for point in map(rational_point, exact):
                cover = None if point is None else Spaces(problem).at(point)
                if cover is not None and any(agree(cover.signs, s) for s in left):
                    covers.append(cover)
                    left = [s for s in left if not agree(cover.signs, s)]
            whole = covering(exact, left)
            found = tuple(proved.values()), tuple(covers), whole or ()
            evidence = None if whole is None else Evidence(problem, *found)
            result = replace(_of_exact(problem, exact), evidence=evidence)
    if result.status is not PROVED and clock.passed:
        result = replace(result, reason=f"{result.reason} after {clock.limit:g} seconds")
    return replace(result, seconds=time.perf_counter() - start)


def _covered(
    problem: PeriodicProblem, rays: PeriodicRays, missing: Sequence[int], clock: Clock
) -> tuple[list[Cover], list[QuadraticLine]]:
    """Spaces and lines that hold the cones of the missing sign vectors, as far as they are found.

    Spaces that are guessed from floats come first; what they leave is solved exactly.
    """
    spaces = Spaces(problem)
    covers: list[Cover] = []
    lines: list[QuadraticLine] = []
    if not missing or clock.passed:
        return covers, lines
    left: list[tuple[list[int], FloatArray]] = []
    with np.errstate(all="ignore"):
        limits = rays.limits(np.array(missing))
        for row, ray in zip(missing, limits, strict=True):
            if clock.passed:
                break
            signs = rays.signs[row].astype(int).tolist()
            if any(agree(cover.signs, signs) for cover in covers) or not np.isfinite(ray).all():
                continue
            cover = spaces.cover(ray)
            if cover is not None and agree(cover.signs, signs):
                covers.append(cover)
            else:
                left.append((signs, ray))
    solved: dict[tuple[frozenset[int], int], list[ExactRay]] = {}
    for signs, ray in left:
        if clock.passed:
            break
        known = [*(cover.signs for cover in covers), *(line.signs for line in lines)]
        if any(agree(other, signs) for other in known):
            continue
        for found in solved_near(spaces, ray, solved):
            if agree(found.signs, signs):
                if isinstance(found, Cover):
                    covers.append(found)
                else:
                    lines.append(found)
                break
    return covers, lines


def _result(
    problem: PeriodicProblem,
    rays: PeriodicRays,
    proved: dict[int, Ray],
    covers: list[Cover],
    found: list[QuadraticLine],
) -> PeriodicCount:
    shown = Shown(problem)
    branches = [shown.branch(ray.signs, ray.b, ray.letters) for ray in proved.values()]
    spaces = list(dict.fromkeys(cover.space for cover in covers))
    lines = [space for space in spaces if space.is_ray]
    branches += [shown.exact_branch(space.basis[0]) for space in lines]
    exact = [line.ray for line in found]
    branches += [shown.branch(ray.signs, ray.b, ray.letters) for ray in exact if ray.b]
    wide = [space for space in spaces if space.dimension > 1 and space.bends]
    known = [*(cover.signs for cover in covers), *(line.signs for line in found)]
    left = [
        shown.signs(signs)
        for row in range(len(rays.signs))
        if row not in proved
        for signs in [rays.signs[row].astype(int).tolist()]
        if not any(agree(other, signs) for other in known)
    ]
    number = len(rays.signs)
    total = f"{number} {agreeing(number, 'pair')} of opposite sign vectors"
    return PeriodicCount(
        problem.pattern,
        problem.direction,
        UNDECIDED if left else PROVED,
        f"{len(left)} of {total} undecided"
        if left
        else f"by theorem these are all: every one of {total} leads to one of them",
        sorted_branches(branches),
        (
            *(shown.space(basis) for basis in pleat_spaces(spaces)),
            *(shown.algebraic(ray) for ray in exact if not ray.b),
        ),
        tuple(shown.space(space.basis) for space in wide),
        tuple(left[:_MOST_OPEN]),
        evidence=Evidence(problem, tuple(proved.values()), tuple(covers), tuple(found)),
    )


def _of_exact(problem: PeriodicProblem, rays: Sequence[ExactRay]) -> PeriodicCount:
    """The count of a sheet of which all rays are known as algebraic numbers."""
    shown = Shown(problem)
    number = 1 << problem.size
    return PeriodicCount(
        problem.pattern,
        problem.direction,
        PROVED,
        f"a Groebner basis has {number} solutions with multiplicity, which are all",
        sorted_branches(shown.branch(ray.signs, ray.b, ray.letters) for ray in rays if ray.b),
        tuple(_pleat(shown, ray) for ray in rays if not ray.b),
    )


def _pleat(shown: Shown, ray: ExactRay) -> HeightSpace | AlgebraicLine:
    """The line of a ray with b = 0, as a space if it is rational."""
    point = rational_point(ray)
    return shown.algebraic(ray) if point is None else shown.space(echelon([point]))


def pleat_spaces(spaces: Iterable[Space]) -> list[tuple[Row, ...]]:
    """The maximal spaces of solutions with b = 0, each with a reduced echelon basis."""
    level = [
        echelon([combined(w, s.basis) for w in nullspace([[row[-1] for row in s.basis]])])
        for s in spaces
    ]
    kept = list(dict.fromkeys(basis for basis in level if basis))
    return [basis for basis in kept if not any(_holds(other, basis) for other in kept)]


def _holds(space: tuple[Row, ...], other: tuple[Row, ...]) -> bool:
    """Whether a space holds another one, and more."""
    return len(space) > len(other) and len(echelon([*space, *other])) == len(space)
