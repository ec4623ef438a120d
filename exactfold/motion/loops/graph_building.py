"""How the graph of configurations is built: branch points are recognised and arcs are followed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from fractions import Fraction
from functools import lru_cache

from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.pools import Pool
from exactfold.errors import WorkerDiedError
from exactfold.motion.contacts.fold_ranges import box_angles
from exactfold.motion.curves.framework import Framework
from exactfold.motion.loops.configuration_graph import (
    ConfigurationGraph,
    End,
    EndAtBranchPoint,
    GraphArc,
    GraphNode,
)
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.proofs import Arc, Loop
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_tube import prove_branch_point_tube
from exactfold.motion.tubes.flat_patches import FlatPatch
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.visits import LocatedBranchPoint, Visit
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.problem import Problem

_NOT_LEFT = "the arc that leaves the branch point along this line could not be enclosed"


def graph_of(
    problem: Problem,
    loops: Sequence[Loop],
    missing: str,
    pool: Pool,
    progress: Progress | None = None,
) -> ConfigurationGraph:
    """The graph of the loops of a sheet and of all other arcs that leave their branch points.

    `missing` says why not all rays are matched; it is empty if all are. Raises `WorkerDiedError`,
    and `ArithmeticError` if two proofs contradict each other, which is a defect.
    """
    census = _Census(problem, Framework.of(problem.sheet))
    for number, loop in enumerate(loops):
        census.add_loop(number, loop)
    work = _FollowArc(problem.pattern)
    while pending := census.open_ends:
        with closing(pool(work, census.jobs(pending, progress))) as results:
            for job, result in results:
                if isinstance(result, WorkerDiedError):
                    raise result
                census.add_followed(job, result)
    return census.graph(missing)


@dataclass(frozen=True)
class _Job:
    """An end at a branch point whose arc has to be followed: its place and direction,
    approximately.
    """

    end: EndAtBranchPoint
    flat: tuple[int, ...]
    branch_point: Ball
    line: Ball


@dataclass(frozen=True)
class _FollowArc:
    """Follows an arc from a branch point in a worker process; None if it cannot be
    enclosed there.
    """

    pattern: CreasePattern

    def __call__(self, job: _Job) -> Arc | None:
        """Follow the arc to the next branch point."""
        finder = _finder(self.pattern)
        framework = Framework.of(finder.problem.sheet)
        patch = FlatPatch.of(framework, job.flat)
        if patch is None:
            return None
        along = job.end.side * job.line.floats[0]
        tube = prove_branch_point_tube(framework, patch, job.branch_point.floats[0], along)
        return None if tube is None else finder.follow_from_branch_point(tube).arc


@lru_cache(maxsize=4)
def _finder(pattern: CreasePattern) -> LoopFinder:
    return LoopFinder(Problem.of(pattern))


@dataclass
class _Census:
    """The branch points and arcs that are known; 2k and 2k + 1 are mirror images of each other.

    `at` gives the arc of each end. `failed` contains the ends whose arcs could not be followed to
    the other end.
    """

    problem: Problem
    framework: Framework
    nodes: list[LocatedBranchPoint] = field(default_factory=list)
    passed: list[set[int]] = field(default_factory=list)
    arcs: list[GraphArc] = field(default_factory=list)
    at: dict[End, int] = field(default_factory=dict)
    failed: dict[End, tuple[Interval, str, int | None]] = field(default_factory=dict)
    reasons: dict[str, None] = field(default_factory=dict)

    def add_loop(self, number: int, loop: Loop) -> None:
        """Add the arcs of a loop from branch point to branch point.

        If the loop is not proved to its end, its last arc is open.
        """
        begin: End | None = loop.source
        time: Interval = Fraction(0), Fraction(0)
        for visit in loop.visits:
            left = self._side(visit)
            if left is not None:
                for branch_point in (left.branch_point, left.branch_point ^ 1):
                    self.passed[branch_point].add(number)
            reached = None if left is None else left.opposite
            self._add(begin, reached, _between(time, visit.time), "", number)
            begin, time = left, visit.time
        self._add(begin, loop.target, _between(time, loop.length), loop.reason, number)

    @property
    def open_ends(self) -> list[EndAtBranchPoint]:
        """Ends at branch points without a known arc, one of each pair of mirror images."""
        return [
            end
            for k, branch_point in enumerate(self.nodes)
            if k % 2 == 0 and branch_point.has_all_lines
            for line in range(len(branch_point.lines))
            for end in (EndAtBranchPoint(k, line, 1), EndAtBranchPoint(k, line, -1))
            if self.failed.keys().isdisjoint({end, end.mirrored}) and end not in self.at
        ]

    def jobs(
        self, pending: Sequence[EndAtBranchPoint], progress: Progress | None
    ) -> Iterator[_Job]:
        """Jobs for the pending ends, except those at which an arc has ended in the meantime."""
        for k, end in enumerate(pending):
            if progress is not None:
                progress("arcs", k, len(pending))
            if end not in self.at:
                branch_point = self.nodes[end.branch_point]
                yield _Job(
                    end, branch_point.flat, branch_point.point.ball, branch_point.lines[end.line]
                )

    def add_followed(self, job: _Job, arc: Arc | None) -> None:
        """Add an arc that was followed from an open end, if it is proved to begin there."""
        if arc is None or self._side(arc.begin) != job.end:
            self.failed[job.end] = (Fraction(0), Fraction(0)), _NOT_LEFT, None
            return
        end: End | None = None
        if isinstance(arc.end, Ray):
            end = arc.end
        elif arc.end is not None:
            left = self._side(arc.end)
            end = None if left is None else left.opposite
        self._add(job.end, end, arc.length, arc.reason, None)

    def graph(self, missing: str) -> ConfigurationGraph:
        """The whole graph. An end is no longer open if an arc has reached it from the
        other side.
        """
        for end, (length, reason, loop) in self.failed.items():
            if end not in self.at:
                self._append(end, None, length, reason, loop)
        nodes = tuple(self._branch_point(k) for k in range(len(self.nodes)))
        reasons = [missing] if missing else []
        if number := sum(branch_point.status is not PROVED for branch_point in nodes):
            reasons.append(
                f"at {counted(number, 'node')} not all curves through the branch point are proved"
            )
        if number := sum(arc.status is not PROVED for arc in self.arcs):
            reasons.append(
                f"{counted(number, 'arc')} {agreeing(number, 'is')} not proved from end to end"
            )
        reasons += self.reasons
        status = UNDECIDED if reasons else PROVED
        return ConfigurationGraph(nodes, tuple(self.arcs), status, "; ".join(reasons))

    def _branch_point(self, k: int) -> GraphNode:
        branch_point, labels = self.nodes[k], self.problem.labels
        folds = [
            (min(labels[i], labels[j]), max(labels[i], labels[j]))
            for i, j in self.framework.sheet.folds
        ]
        angles = box_angles(self.framework, branch_point.point.ball)
        return GraphNode(
            tuple(labels[v] for v in branch_point.flat),
            len(branch_point.lines),
            PROVED if branch_point.has_all_lines else UNDECIDED,
            dict(zip(folds, angles, strict=True)),
            k ^ 1,
            tuple(sorted(self.passed[k])),
        )

    def _side(self, visit: Visit) -> EndAtBranchPoint | None:
        """The end at which a curve leaves the branch point it visits; None if it is not known.

        In that case the reason is recorded.
        """
        met = [branch_point.meets(visit) for branch_point in self.nodes]
        if True not in met and None in met:
            self.reasons["it is undecided whether two branch points are the same"] = None
            return None
        if True in met:
            k = met.index(True)
        else:
            located = LocatedBranchPoint.of(self.framework, visit)
            if located is None or not located.point.ball.misses(located.mirrored.point.ball):
                self.reasons["a branch point on a loop or arc could not be located"] = None
                return None
            k = len(self.nodes)
            self.nodes += [located, located.mirrored]
            self.passed += [set(), set()]
        side = self.nodes[k].side(visit)
        if side is None:
            self.reasons["it is undecided along which line a curve passes a node"] = None
            return None
        return EndAtBranchPoint(k, *side)

    def _add(
        self, start: End | None, end: End | None, length: Interval, reason: str, loop: int | None
    ) -> None:
        """Add an arc and its mirror image, unless they are known.

        If one end is not known, the arc is recorded as failed.
        """
        if start is None or end is None:
            for known in (start, end):
                if known is not None:
                    why = reason or "the branch point at the other end could not be identified"
                    self.failed[known] = length, why, loop
            return
        if before := {self.at[e] for e in (start, end) if e in self.at}:
            arc = self.arcs[min(before)]
            if len(before) > 1 or {start, end} != {arc.start, arc.end}:
                raise ArithmeticError("two proofs contradict each other about an arc")
            return
        if start.mirrored in (start, end):
            raise ArithmeticError(
                "an arc is its own mirror image, so it would contain a flat configuration"
            )
        self._append(start, end, length, "", loop)

    def _append(
        self, start: End, end: End | None, length: Interval, reason: str, loop: int | None
    ) -> None:
        image = None if end is None else end.mirrored
        for a, b in ((start, end), (start.mirrored, image)):
            number = len(self.arcs)
            status = UNDECIDED if b is None else PROVED
            self.arcs.append(GraphArc(a, b, length, status, reason, loop, number ^ 1))
            self.at[a] = number
            if b is not None:
                self.at[b] = number


def _between(begin: Interval, end: Interval) -> Interval:
    """Bounds of the difference of two times."""
    return max(end[0] - begin[1], Fraction(0)), end[1] - begin[0]
