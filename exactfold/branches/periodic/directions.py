"""`count_directions`: how the branches of a periodic sheet hang together over all directions."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from exactfold._support.clock import Clock
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.crossings import Crossings, OpenVertexError, Place, RealPlace
from exactfold.branches.periodic.directions_result import (
    BranchCrossing,
    DirectionsCount,
    RollingBranch,
)
from exactfold.branches.periodic.families import Families, OpenFamiliesError
from exactfold.branches.periodic.result import PeriodicCount
from exactfold.branches.periodic.shown import Shown
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern
from exactfold.rigidity.equations.all_directions import AllDirections
from exactfold.rigidity.equations.periodic import PeriodicProblem

DIRECTIONS: Final = ((31, 17), (-13, 29), (5, 47), (-43, 8))
"""Directions that are tried until one is found at which no vertex is flat."""
_BITS: Final = (64, 128, 256, 512, 1024, 4096)
_FAR: Final = Fraction(1 << 80)

Label = tuple[int, ...]
"""The signs of the vertices on the side with b > 0."""


def count_directions(
    cell: object, *, limit: float | None = None, progress: Progress | None = None
) -> DirectionsCount:
    """The branches of a periodic sheet over all directions: signs of b, crossings, permutation.

    Without pleats each pair of opposite vertex sign vectors is one branch for every direction n,
    continuous in n, with one sign of b (docs/tessellations.md, Theorem 16). Branches cross where
    stars go flat. There all of them are analytic in n, and if the tangents are proved not to be
    flat, the vertices that were flat have changed their signs on each (Theorem 19). So following
    the branches analytically through a half turn of n, after which the equations are the same
    again, permutes the sign vectors. The solutions with flat stars are found for all n together, as
    algebraic numbers.

    If the sheet has pleats, only the directions with families are proved (Theorem 21), and the rest
    is UNDECIDED; so it is if one of these steps is not proved; `reason` says which.
    Raises the errors of `count_periodic`.

    >>> result = count_directions("waterbomb-cell")
    >>> [(str(c.direction), c.vertices) for c in result.crossings], result.cycles
    ([('0,1', (2,))], ((1,), (2,), (3, 4)))
    """
    start, clock = time.perf_counter(), Clock(limit)
    pattern = as_cell(cell)
    result = _directions(pattern, clock, progress)
    return replace(result, seconds=time.perf_counter() - start)


def _directions(
    pattern: PeriodicPattern, clock: Clock, progress: Progress | None
) -> DirectionsCount:
    problem = AllDirections.of(pattern)
    always = set(problem.parts.rigid)
    base = None
    for direction in DIRECTIONS:
        found = count_periodic(pattern, direction, limit=clock.left, progress=progress)
        if found.status is not PROVED:
            return _open(pattern, f"direction {direction[0]},{direction[1]}: {found.reason}")
        if found.pleats:
            return _with_pleats(problem, found, clock)
        if all(branch.multiplicity == 1 << len(always) for branch in found):
            base = found
            break
    if base is None:
        reason = "in all directions that were tried some branch has a flat vertex"
        return replace(_open(pattern, reason), families=())
    branches = tuple(RollingBranch(branch.vertex_signs, branch.b) for branch in base)
    labels = [_label(problem, branch) for branch in branches]
    places: list[Place] = []
    reasons: list[str] = []
    for vertex in range(problem.sheet.V):
        if progress is not None:
            progress("crossings", vertex, problem.sheet.V)
        name = problem.labels[vertex]
        try:
            for place in Crossings(problem, clock).places(vertex):
                places.append(place)
                if not place.flips:
                    reasons.append(f"at a crossing at vertex {name}, a tangent may be flat, too")
        except OpenVertexError as error:
            reasons.append(f"vertex {name}: {error}")
    events = _sorted(problem, [real for place in places for real in place.real()])
    if events is None:
        reasons.append("two crossings are too close to each other")
        events = []
    crossings = tuple(_crossing(problem, base, event) for event in events)
    if reasons:
        return replace(
            _open(pattern, "; ".join(reasons)), branches=branches, crossings=crossings, families=()
        )
    number = len(crossings)
    return DirectionsCount(
        pattern,
        PROVED,
        f"{counted(number, 'crossing')}, found as algebraic numbers; there are no others"
        if number
        else "no star is flat in any direction: no two branches meet",
        branches,
        crossings,
        _permutation(labels, [(event.signs, event.place.flat) for event in events]),
        families=(),
    )


def _with_pleats(problem: AllDirections, base: PeriodicCount, clock: Clock) -> DirectionsCount:
    """The answer for a sheet with pleats: only the directions with families are known."""
    reason = (
        f"the sheet has {counted(len(base.pleats), 'space')} of pleats: where branches meet them, "
        "b is 0, and they are not followed; count one direction"
    )
    try:
        families = Families(problem, base, clock).directions()
    except OpenFamiliesError as error:
        return _open(problem.pattern, f"{reason}; in which directions there are families: {error}")
    return replace(_open(problem.pattern, reason), families=families)


def _open(pattern: PeriodicPattern, reason: str) -> DirectionsCount:
    return DirectionsCount(pattern, UNDECIDED, reason, (), (), None)


def _label(problem: AllDirections, branch: RollingBranch) -> Label:
    values = {"+": 1, "-": -1, "0": 0}
    return tuple(branch.b * values[branch.vertex_signs[v]] for v in problem.labels)


@dataclass(frozen=True)
class _Event:
    """A real solution with b > 0 and flat vertices, and bounds of -x/y of its direction (x, y).

    There are none for the direction (1, 0), which is taken for the last one.
    """

    place: Place
    real: RealPlace
    signs: Label
    bounds: tuple[Fraction, Fraction] | None

    def clashes(self, other: _Event) -> bool:
        """Whether a branch may meet both, and the bounds do not say which comes first."""
        if any(a * b < 0 for a, b in zip(self.signs, other.signs, strict=True)):
            return False
        if self.bounds is None or other.bounds is None:
            return self.bounds == other.bounds
        return self.bounds[1] >= other.bounds[0] and other.bounds[1] >= self.bounds[0]


def _sorted(problem: AllDirections, found: Sequence[RealPlace]) -> list[_Event] | None:
    """The events by direction, counter-clockwise from (1, 0); None if the order is not known.

    Events with common branches have different directions, and get disjoint bounds. The order of
    others does not matter.
    """
    _, c_12, c_22 = problem.bend_rows()
    events: list[_Event] = []
    for real in found:
        signs = tuple(real.sign(row) for row in problem.vertices)
        events.append(_Event(real.place, real, signs, None))
    for bits in _BITS:
        for k, event in enumerate(events):
            if event.real.sign(c_22):
                ratio = event.real.quotient(c_12, c_22, bits)
                known = (-_FAR, _FAR) if ratio is None else (-ratio[1], -ratio[0])
                events[k] = replace(event, bounds=known)
        events.sort(key=_place)
        if not any(a.clashes(b) for k, a in enumerate(events) for b in events[:k]):
            return events
    return None


def _place(event: _Event) -> tuple[bool, Fraction]:
    """Sorts events by the middle of their bounds; those without bounds come last."""
    bounds = event.bounds
    return (bounds is None, Fraction(0) if bounds is None else (bounds[0] + bounds[1]) / 2)


def _crossing(problem: AllDirections, base: PeriodicCount, event: _Event) -> BranchCrossing:
    shown = Shown(PeriodicProblem(problem.pattern, problem.parts, base.direction))
    branch = shown.branch(event.signs, 1, "F" * len(problem.sheet.edges))
    exact = event.real.direction(problem)
    vertices = tuple(problem.labels[v] for v in event.place.flat)
    return BranchCrossing(exact, exact.angle, branch.vertex_signs, branch.b, vertices)


def _permutation(
    labels: Sequence[Label], events: Sequence[tuple[Label, tuple[int, ...]]]
) -> tuple[int, ...]:
    """For each branch the place of that one as which it comes back after a half turn."""
    place = {label: k for k, label in enumerate(labels)}
    ends = []
    for label in labels:
        at = label
        for signs, flat in events:
            if all(s in (0, a) for s, a in zip(signs, at, strict=True)):
                at = tuple(-a if v in flat else a for v, a in enumerate(at))
        ends.append(place[at])
    return tuple(ends)
