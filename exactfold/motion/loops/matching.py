"""`find_loops`: which rays at the flat state true motions connect with each other."""

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
from exactfold._support.results import Ways
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
from exactfold.motion.loops.rays import Ray
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.near_degeneracy import WarningDocument, warnings
from exactfold.rigidity.equations.problem import Problem


class LoopsDocument(TypedDict):
    """The loops through the flat state of a sheet."""

    format: Literal["exactfold motions result"]
    version: Literal[2]
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
    """The configurations that can be reached from the flat state."""
    skipped: dict[str, str]
    """Branches that are not simple, by their signs, with the reason."""
    warnings: list[WarningDocument]
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class Loops(Ways[Loop]):
    """The loops of true configurations through the flat state of a sheet.

    If contact is ignored, every ray is the beginning of a curve that comes back along another ray.
    `loops` contains one loop of each pair of mirror images, in the order of their sources; a loop
    run through backwards is not listed again. `skipped` gives the reason for each ray that is not
    simple; nothing is claimed about these. Curves that do not pass the flat state are not looked
    for.

    `status` is PROVED if all 2^(n + 1) rays are matched, with proof. `graph` consists of the flat
    state, the branch points that can be reached from it, and all arcs between them, including
    mirror images.
    """

    pattern: CreasePattern
    loops: tuple[Loop, ...]
    skipped: Mapping[str, str]
    status: Verdict
    reason: str
    graph: ConfigurationGraph
    seconds: float = field(default=0.0, compare=False)

    def listed(self) -> tuple[Loop, ...]:
        """`loops`."""
        return self.loops

    @cached_property
    def matching(self) -> Mapping[Ray, Ray]:
        """For every ray of a proved loop, the ray with which it is matched.

        Every loop gives four entries: there and back, and the mirror images of both.
        """
        partners: dict[Ray, Ray] = {}
        for loop in self.loops:
            if loop.target is not None:
                for a, b in ((loop.source, loop.target), (loop.target, loop.source)):
                    partners[a], partners[a.mirrored] = b, b.mirrored
        return partners

    def to_dict(self, name: str | None = None) -> LoopsDocument:
        """The object printed by `exactfold motions --json`: `schema("motions")`."""
        return {
            "format": "exactfold motions result",
            "version": 2,
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
    """Follow every ray of a sheet through true configurations back to the flat state.

    Each loop is one analytic curve. Tubes prove it from end to end (docs/motion.md), also through
    branch points. Of two mirror images and of the two directions only one is followed. Then the
    arcs that leave the branch points on other lines are followed and proved in the same way. The
    sheet needs four boundary vertices. `processes` share the work; on small sheets one process does
    all of it, because others would hardly have started before the end.

    The file `certificate` gets the proof of each loop as it is found, and finally the claims, for
    `exactfold.checker` (docs/motion.md, 15). With `resume`, a file left by an interrupted run is
    continued: the loops that its digests show to be complete are taken over without being verified
    again. Otherwise the file is replaced, or refused if `replace` is false.

    Raises `NotCountedError` for sheets that are not counted or have no branches, and
    `ArithmeticError` if two proofs contradict each other, which is a defect. For the file it raises
    `ForeignJournalError`, `JournalInUseError`, `UnwritableFileError` and `UsageError`. It raises
    `WorkerDiedError` if a process dies.

    >>> loops = find_loops("two-vertex")
    >>> loops
    <Loops: proved, 2 of 2 loops proved>
    """
    begun = time.perf_counter()
    sheet = as_pattern(pattern)
    problem = Problem.of(sheet)
    problem.require_foldable()
    ways = count_branches(sheet)
    if ways.status is not PROVED:
        raise NotCountedError(f"loops need all branches proved, and some are not: {ways.reason}")
    skipped = {
        branch.sign_text: _why_skipped(branch)
        for branch in ways.branches
        if any(not branch.vertex_signs[v] for v in problem.foldable)
    }
    runs = pool or process_pool(processes if len(problem.foldable) > _ALONE else 1)
    if certificate is None:
        distinct_loops = _matching(_followed(sheet, problem, runs, progress, None))
    else:
        with closing(LoopFile.opened(certificate, problem, resume, replace)) as file:
            distinct_loops = _matching(
                [*file.known, *_followed(sheet, problem, runs, progress, file)]
            )
            file.finish()
    reasons = []
    if many := len(skipped):
        reasons.append(f"{counted(many, 'branch')} {agreeing(many, 'is')} not simple")
    if left := sum(loop.target is None for loop in distinct_loops):
        reasons.append(f"{counted(left, 'loop')} {agreeing(left, 'is')} not proved to its end")
    reason = "; ".join(reasons)
    loops = Loops(
        sheet,
        tuple(distinct_loops),
        skipped,
        UNDECIDED if reasons else PROVED,
        reason,
        graph_of(problem, distinct_loops, reason, runs, progress),
        time.perf_counter() - begun,
    )
    if not reasons and len(loops.matching) != 2 ** (len(problem.foldable) + 1):
        raise ArithmeticError("rays are missing from a matching that should be complete")
    return loops


def _why_skipped(branch: Branch) -> str:
    """Why the rays of a branch on which a vertex is flat are not followed."""
    line = straight_fold(branch)
    if not line:
        return "a vertex is flat on it"
    return (
        "a vertex is flat on it: the sheet turns exactly about the straight line "
        f"{'-'.join(map(str, line))}, and at 180 degrees, where it is folded flat, motions may "
        "branch"
    )


_ALONE = 3
"""With at most this many foldable vertices, one process finishes before others would have
started.
"""

Job = tuple[Ray, bool]
"""A ray on which the saddle or the reflex corner is positive; and whether to certify its loop."""


@dataclass(frozen=True)
class _Follow:
    """The loop from a ray, and its line in a certificate; None if a vertex is flat on the ray.

    The line is empty for a loop that is not proved to its end.
    """

    pattern: CreasePattern

    def __call__(self, job: Job) -> tuple[Loop, str] | None:
        """Follow the loop; this runs in a worker process."""
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
    """The sorting key of the ray with these signs: rays with an even number of `+` come first.

    Most loops flip one sign (docs/matching.md). If it is the sign of a vertex, one end has an even
    number of `+` and the other an odd number. So loops that are followed at the same time are
    seldom equal.
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
    """The loops. A ray is not followed if a loop, or its mirror image, has ended at it."""
    ended: set[Ray] = set() if file is None else set(file.matched)
    number = len(problem.foldable)

    def left() -> Iterator[Job]:
        for k, signs in enumerate(sorted(product((-1, 1), repeat=number), key=_turn)):
            if progress is not None:
                progress("rays", k, 1 << number)
            if (named := Ray(signs, 1)) not in ended:
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


def _matching(loops: Iterable[Loop]) -> list[Loop]:
    """The loops, each once, in the order of their sources; raises the errors of `_check`."""
    ordered = sorted(loops, key=lambda loop: loop.source)
    _check(ordered)
    return _once(ordered)


def _once(loops: Iterable[Loop]) -> list[Loop]:
    """The first of several loops that are equal, mirrored, or run through backwards."""
    seen: set[Ray] = set()
    kept = []
    # Proved loops come first: the source of an unproved loop may be the target of a proved one.
    for loop in sorted(
        loops, key=lambda loop: (loop.target is None, _turn(loop.source.vertex_signs))
    ):
        if loop.source not in seen:
            kept.append(loop)
        seen |= {loop.source, loop.source.mirrored}
        if loop.target is not None:
            seen |= {loop.target, loop.target.mirrored}
    return sorted(kept, key=lambda loop: loop.source)


def _check(loops: Iterable[Loop]) -> None:
    """Raise `ArithmeticError` unless the proved loops are a matching of rays.

    Loops that were followed from both ends have to agree. No ray is matched with itself or with two
    others, because a simple ray has only one curve. Modulo 2, each loop flips one sign more than
    the number of stars that are flat at its branch points (docs/matching.md, Theorem 1a).
    """
    partner: dict[Ray, Ray] = {}
    for loop in loops:
        if loop.target is None:
            continue
        signs = zip(loop.source.vertex_signs, loop.target.vertex_signs, strict=True)
        flips = sum(a != b for a, b in signs) + (loop.source.saddle != loop.target.saddle)
        if (flips - 1 - sum(map(len, loop.through))) % 2:
            raise ArithmeticError(f"the loop from {loop.source} contradicts the law of parity")
        for a, b in ((loop.source, loop.target), (loop.source.mirrored, loop.target.mirrored)):
            if a == b or partner.setdefault(a, b) != b or partner.setdefault(b, a) != a:
                raise ArithmeticError(f"two proofs contradict each other at the ray {a}")
