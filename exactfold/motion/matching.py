"""`find_loops`: how the half-branches at the flat state are joined by true motions."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any

from exactfold.count.collect import count_branches
from exactfold.count.find import BranchFinder
from exactfold.count.pools import Pool, process_pool
from exactfold.errors import (
    NotCountedError,
    NotProvedAtTheFlatStateError,
    UsageError,
    WorkerDiedError,
)
from exactfold.motion.half_branches import HalfBranch
from exactfold.motion.loops import Loop, LoopFinder
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import described
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.near_degeneracy import warnings
from exactfold.problem.problem import Problem
from exactfold.progress import Progress
from exactfold.schemas import headed
from exactfold.verdict import PROVED, UNDECIDED, Verdict
from exactfold.wording import agreeing, counted


@dataclass(frozen=True, repr=False)
class Loops:
    """The loops of true configurations through the flat state of a sheet.

    Ignoring contact, every half-branch is the beginning of a curve that comes back along another
    one. `loops` holds one loop of each pair of mirror images, in the order of their sources; the
    same loop run through backwards is not listed again. `skipped`: half-branches that are not
    simple, by the reason, of which nothing is claimed. Curves that do not pass the flat state are
    not looked for.

    `status` is PROVED if all 2^(n + 1) half-branches are matched, with proof.
    """

    pattern: CreasePattern
    loops: tuple[Loop, ...]
    skipped: Mapping[str, str]
    status: Verdict
    reason: str
    seconds: float = field(default=0.0, compare=False)

    @cached_property
    def matching(self) -> Mapping[HalfBranch, HalfBranch]:
        """The half-branch that each half-branch is joined with, for all that are proved.

        Every loop gives four entries: there and back, and the mirror image of both.
        """
        found: dict[HalfBranch, HalfBranch] = {}
        for loop in self.loops:
            if loop.target is not None:
                for a, b in ((loop.source, loop.target), (loop.target, loop.source)):
                    found[a], found[a.mirrored] = b, b.mirrored
        return found

    def report(self, name: str | None = None) -> dict[str, Any]:
        """The object printed by `exactfold motions --json`: `schema("motions")`."""
        return {
            **headed("motions"),
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "vertices": list(self.pattern.foldable_vertices),
            "half_branches": 2 ** (len(self.pattern.foldable_vertices) + 1),
            "matched": len(self.matching),
            "loops": [loop.to_dict() for loop in self.loops],
            "skipped": dict(self.skipped),
            "warnings": warnings(self.pattern),
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        proved = sum(loop.target is not None for loop in self.loops)
        return f"<Loops: {self.status}, {proved} of {len(self.loops)} loops proved>"


def find_loops(
    pattern: PatternLike,
    *,
    processes: int = 1,
    pool: Pool | None = None,
    progress: Progress | None = None,
) -> Loops:
    """Follow every half-branch of a sheet through true configurations back to the flat state.

    Each loop is one analytic curve, proved from end to end by tubes (docs/motion.md), through nodes
    as well; of mirror images and of the two directions one is followed. Four boundary vertices.

    Raises `NotCountedError` for sheets that are not counted or have no branches, `ArithmeticError`
    if two proofs contradict each other, which is a defect.

    >>> found = find_loops("two-vertex")
    >>> found
    <Loops: proved, 2 of 2 loops proved>
    """
    begun = time.perf_counter()
    sheet = as_pattern(pattern)
    problem = Problem.of(sheet)
    problem.require_foldable()
    ways = count_branches(sheet)
    if ways.status is not PROVED:
        raise NotCountedError(f"the branches are not all proved: {ways.reason}")
    skipped = {
        branch.sign_text: "a vertex is flat on it"
        for branch in ways.branches
        if any(not branch.vertex_signs[v] for v in problem.foldable)
    }
    sources = [branch.sign_text for branch in ways.branches if branch.sign_text not in skipped]
    found = sorted(
        _followed(sheet, problem, sources, pool or process_pool(processes), progress),
        key=lambda loop: loop.source,
    )
    _check(found)
    found = _once(found)
    reasons = []
    if skipped:
        reasons.append(
            f"{counted(len(skipped), 'branch')} {agreeing(len(skipped), 'is')} not simple"
        )
    if left := sum(loop.target is None for loop in found):
        reasons.append(f"{counted(left, 'loop')} {agreeing(left, 'is')} not proved to the end")
    return Loops(
        sheet,
        tuple(found),
        skipped,
        UNDECIDED if reasons else PROVED,
        "; ".join(reasons),
        time.perf_counter() - begun,
    )


@dataclass(frozen=True)
class _Follow:
    """The loop from the half-branch with given signs, as `find_branch` shows it."""

    pattern: CreasePattern

    def __call__(self, signs: str) -> Loop:
        """Follow it; run in a worker process."""
        finder, loops = _finders(self.pattern)
        branch = finder.find(finder.signs(signs, None))
        try:
            return loops.follow(branch).loop
        except (NotProvedAtTheFlatStateError, UsageError) as error:
            source = HalfBranch(tuple(branch.vertex_signs[v] for v in loops.problem.foldable), 1)
            nothing = Fraction(0), Fraction(0)
            return Loop(source, None, (), nothing, UNDECIDED, str(error), 0)


@lru_cache(maxsize=4)
def _finders(pattern: CreasePattern) -> tuple[BranchFinder, LoopFinder]:
    return BranchFinder(pattern), LoopFinder(Problem.of(pattern))


def _followed(
    sheet: CreasePattern,
    problem: Problem,
    sources: list[str],
    pool: Pool,
    progress: Progress | None,
) -> Iterator[Loop]:
    """The loops; a half-branch at which one has ended, or its mirror image, is not followed."""
    ended: set[HalfBranch] = set()
    places = [k for k, v in enumerate(problem.pattern.interior) if v in problem.foldable]

    def left() -> Iterator[str]:
        for k, signs in enumerate(sources):
            if progress is not None:
                progress("half-branches", k, len(sources))
            named = HalfBranch(tuple(1 if signs[p] == "+" else -1 for p in places), 1)
            if named not in ended:
                yield signs

    for _, loop in pool(_Follow(sheet), left()):
        if isinstance(loop, WorkerDiedError):
            raise loop
        if loop.target is not None:
            ended |= {loop.target, loop.target.mirrored}
        yield loop


def _once(found: Iterable[Loop]) -> list[Loop]:
    """Of loops that are the same, run through backwards or mirrored, the first one."""
    seen: set[HalfBranch] = set()
    kept = []
    for loop in found:
        if loop.source not in seen:
            kept.append(loop)
        seen |= {loop.source, loop.source.mirrored}
        if loop.target is not None:
            seen |= {loop.target, loop.target.mirrored}
    return kept


def _check(found: Iterable[Loop]) -> None:
    """Raise `ArithmeticError` unless the proved loops are a matching of half-branches.

    Loops that were followed from both ends agree, no half-branch is matched with itself, and none
    with two others: as two curves of a simple half-branch would have to be.
    """
    partner: dict[HalfBranch, HalfBranch] = {}
    for loop in found:
        if loop.target is None:
            continue
        for a, b in ((loop.source, loop.target), (loop.source.mirrored, loop.target.mirrored)):
            if a == b or partner.setdefault(a, b) != b or partner.setdefault(b, a) != a:
                raise ArithmeticError(f"two proofs contradict each other at the half-branch {a}")
