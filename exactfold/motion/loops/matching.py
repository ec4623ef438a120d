"""`find_loops`: how the half-branches at the flat state are joined by true motions."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import product
from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import Keywords, Natural, NotNegative, ProvedOrNot
from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.counting.pools import Pool, process_pool
from exactfold.branches.values.branch import Branch
from exactfold.errors import (
    FlatVertexError,
    NotCountedError,
    NotProvedAtTheFlatStateError,
    UsageError,
    WorkerDiedError,
)
from exactfold.motion.curves.straight_folds import straight_fold
from exactfold.motion.loops.configuration_graph import ConfigurationGraph, GraphDocument
from exactfold.motion.loops.file import LoopFile
from exactfold.motion.loops.graph_building import graph_of
from exactfold.motion.loops.loops import LoopFinder
from exactfold.motion.loops.proofs import Loop, LoopDocument
from exactfold.motion.loops.rays import HalfBranch
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.near_degeneracy import WarningDocument, warnings
from exactfold.rigidity.equations.problem import Problem


class LoopsDocument(TypedDict):
    """The loops through the flat state of a sheet."""

    format: Literal["exactfold motions result"]
    version: Literal[1]
    pattern: PatternDocument
    status: ProvedOrNot
    """Proved: all rays are matched."""
    reason: str
    """What is missing, empty if proved."""
    vertices: list[Natural]
    """The foldable vertices, in the order of the signs."""
    half_branches: Annotated[int, Keywords(minimum=4)]
    """How many rays there are: 2^(n + 1), n the number of foldable vertices."""
    matched: Natural
    """Rays whose partner is proved."""
    loops: list[LoopDocument]
    """One of each pair of mirror images, in one of its two directions."""
    graph: GraphDocument
    skipped: dict[str, str]
    """Branches that are not simple, by their signs, with the reason."""
    warnings: list[WarningDocument]
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class Loops:
    """The loops of true configurations through the flat state of a sheet.

    Ignoring contact, every half-branch is the beginning of a curve that comes back along another
    one. `loops` holds one loop of each pair of mirror images, in the order of their sources; the
    same loop run through backwards is not listed again. `skipped`: half-branches that are not
    simple, by the reason, of which nothing is claimed. Curves that do not pass the flat state are
    not looked for.

    `status` is PROVED if all 2^(n + 1) half-branches are matched, with proof. `graph`: the flat
    state, the nodes that can be reached from it, and all arcs between them, mirror images as well.
    """

    pattern: CreasePattern
    loops: tuple[Loop, ...]
    skipped: Mapping[str, str]
    status: Verdict
    reason: str
    graph: ConfigurationGraph
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

    def report(self, name: str | None = None) -> LoopsDocument:
        """The object printed by `exactfold motions --json`: `schema("motions")`."""
        return {
            "format": "exactfold motions result",
            "version": 1,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "vertices": list(self.pattern.foldable_vertices),
            "half_branches": 2 ** (len(self.pattern.foldable_vertices) + 1),
            "matched": len(self.matching),
            "loops": [loop.to_dict() for loop in self.loops],
            "graph": self.graph.to_dict(),
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
    certificate: str | os.PathLike[str] | None = None,
    resume: bool = False,
    replace: bool = True,
) -> Loops:
    """Follow every half-branch of a sheet through true configurations back to the flat state.

    Each loop is one analytic curve, proved from end to end by tubes (docs/motion.md), through nodes
    as well; of mirror images and of the two directions one is followed. Then the arcs that leave
    the nodes on other lines are followed, likewise proved. Four boundary vertices. `processes`
    share the work, or one does it, where others would hardly have started before the end.

    The file `certificate` takes the proof of each loop as it is found, and at last the claims, for
    `exactfold.checker` (docs/motions.md). With `resume`, a file left by an interrupted run is
    continued: the loops in it are taken over, as far as its digests show that they are whole, and
    are not verified anew. Otherwise it is replaced, or refused without `replace`.

    Raises `NotCountedError` for sheets that are not counted or have no branches, `ArithmeticError`
    if two proofs contradict each other, which is a defect; for the file `ForeignJournalError`,
    `JournalInUseError`, `UnwritableFileError`, `UsageError`; `WorkerDiedError`.

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
        branch.sign_text: _why_skipped(branch)
        for branch in ways.branches
        if any(not branch.vertex_signs[v] for v in problem.foldable)
    }
    runs = pool or process_pool(processes if len(problem.foldable) > _ALONE else 1)
    if certificate is None:
        found = _matching(_followed(sheet, problem, runs, progress, None))
    else:
        with closing(LoopFile.opened(certificate, problem, resume, replace)) as file:
            found = _matching([*file.known, *_followed(sheet, problem, runs, progress, file)])
            file.finish()
    reasons = []
    if many := len(skipped):
        reasons.append(f"{counted(many, 'branch')} {agreeing(many, 'is')} not simple")
    if left := sum(loop.target is None for loop in found):
        reasons.append(f"{counted(left, 'loop')} {agreeing(left, 'is')} not proved to the end")
    reason = "; ".join(reasons)
    loops = Loops(
        sheet,
        tuple(found),
        skipped,
        UNDECIDED if reasons else PROVED,
        reason,
        graph_of(problem, found, reason, runs, progress),
        time.perf_counter() - begun,
    )
    if not reasons and len(loops.matching) != 2 ** (len(problem.foldable) + 1):
        raise ArithmeticError("half-branches are missing from a matching that should be whole")
    return loops


def _why_skipped(branch: Branch) -> str:
    """Why the half-branches of a branch on which a vertex is flat are not followed."""
    line = straight_fold(branch)
    if not line:
        return "a vertex is flat on it"
    return (
        "a vertex is flat on it: the sheet turns about the straight line "
        f"{'-'.join(map(str, line))}, exactly, and at 180 degrees, folded flat, motions may branch"
    )


_ALONE = 3
"""With at most so many foldable vertices all is done before other processes would have started."""

Job = tuple[HalfBranch, bool]
"""A half-branch on which the saddle, or the reflex corner, is positive; and whether to certify."""


@dataclass(frozen=True)
class _Follow:
    """The loop from a half-branch, and its line in a certificate; None if a vertex is flat on it.

    The line is empty for a loop that is not proved to its end.
    """

    pattern: CreasePattern

    def __call__(self, job: Job) -> tuple[Loop, str] | None:
        """Follow it; run in a worker process."""
        (source, certified), (finder, loops) = job, _finders(self.pattern)
        signs = dict(zip(loops.problem.foldable, source.vertex_signs, strict=True))
        try:
            proof = loops.follow_from(finder.find(finder.signs(signs, None)), source)
        except FlatVertexError:
            return None
        except (NotProvedAtTheFlatStateError, UsageError) as error:
            nothing = Fraction(0), Fraction(0)
            return Loop(source, None, (), nothing, UNDECIDED, str(error), 0), ""
        return proof.loop, proof.line() if certified and proof.landing else ""


def _turn(signs: tuple[int, ...]) -> tuple[int, tuple[int, ...]]:
    """When the half-branch with these signs is followed: first those with an even number of `+`.

    Most loops flip one sign (docs/matching.md). If it is that of a vertex, one end has an even
    number and the other an odd one; so loops that are followed at one time are seldom the same.
    """
    return signs.count(1) % 2, signs


@lru_cache(maxsize=4)
def _finders(pattern: CreasePattern) -> tuple[BranchFinder, LoopFinder]:
    return BranchFinder(pattern), LoopFinder(Problem.of(pattern))


def _followed(
    sheet: CreasePattern,
    problem: Problem,
    pool: Pool,
    progress: Progress | None,
    file: LoopFile | None,
) -> Iterator[Loop]:
    """The loops; a half-branch at which one has ended, or its mirror image, is not followed."""
    ended: set[HalfBranch] = set() if file is None else set(file.matched)
    number = len(problem.foldable)

    def left() -> Iterator[Job]:
        for k, signs in enumerate(sorted(product((-1, 1), repeat=number), key=_turn)):
            if progress is not None:
                progress("half-branches", k, 1 << number)
            if (named := HalfBranch(signs, 1)) not in ended:
                yield named, file is not None

    with closing(pool(_Follow(sheet), left())) as results:
        for _, result in results:
            if isinstance(result, WorkerDiedError):
                raise result
            if result is None:
                continue
            loop, line = result
            if loop.target is not None:
                ended |= {loop.target, loop.target.mirrored}
                if file is not None:
                    file.add(loop, line)
            yield loop


def _matching(found: Iterable[Loop]) -> list[Loop]:
    """The loops, each once, in the order of their sources; raises as `_check`."""
    ordered = sorted(found, key=lambda loop: loop.source)
    _check(ordered)
    return _once(ordered)


def _once(found: Iterable[Loop]) -> list[Loop]:
    """Of loops that are the same, run through backwards or mirrored, the first one."""
    seen: set[HalfBranch] = set()
    kept = []
    # First those that are proved: one that is not may be the end of another.
    for loop in sorted(
        found, key=lambda loop: (loop.target is None, _turn(loop.source.vertex_signs))
    ):
        if loop.source not in seen:
            kept.append(loop)
        seen |= {loop.source, loop.source.mirrored}
        if loop.target is not None:
            seen |= {loop.target, loop.target.mirrored}
    return sorted(kept, key=lambda loop: loop.source)


def _check(found: Iterable[Loop]) -> None:
    """Raise `ArithmeticError` unless the proved loops are a matching of half-branches.

    Loops that were followed from both ends agree, no half-branch is matched with itself, and none
    with two others: as two curves of a simple half-branch would have to be. Each flips one sign
    more than stars are flat at its nodes, modulo 2 (docs/matching.md, Theorem 1a).
    """
    partner: dict[HalfBranch, HalfBranch] = {}
    for loop in found:
        if loop.target is None:
            continue
        signs = zip(loop.source.vertex_signs, loop.target.vertex_signs, strict=True)
        flips = sum(a != b for a, b in signs) + (loop.source.saddle != loop.target.saddle)
        if (flips - 1 - sum(map(len, loop.through))) % 2:
            raise ArithmeticError(f"the loop from {loop.source} contradicts the law of parity")
        for a, b in ((loop.source, loop.target), (loop.source.mirrored, loop.target.mirrored)):
            if a == b or partner.setdefault(a, b) != b or partner.setdefault(b, a) != a:
                raise ArithmeticError(f"two proofs contradict each other at the half-branch {a}")
