"""Proves all branches of a pattern block by block and streams them to a compact certificate."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field, fields
from dataclasses import replace as changed
from typing import TYPE_CHECKING, cast

from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.certificates.blocks import chamber_counts, claims_line, header_line
from exactfold.branches.certificates.check import FastChecker
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.collect import check_countable, count_branches
from exactfold.branches.counting.engines import Engine, processes
from exactfold.branches.values.blocks import OpenEnd, ProvedBlock
from exactfold.branches.values.nearly_flat import Bends
from exactfold.branches.values.result import BranchCount
from exactfold.certificates.journal import Journal
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.branches.compact_blocks import CompactSheet
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern

if TYPE_CHECKING:
    from exactfold.branches.values.count_document import StreamDocument, StreamedDocument

HANDED_OVER = 12
"""The fallback `count_branches` is tried for patterns with at most this many foldable vertices."""

MOST_LISTED = 1000
"""Most open sign vectors that the result of a run names."""


@dataclass(frozen=True)
class OpenRoot:
    """A sign vector whose branch was not proved, and the reason.

    `signs` has one character for each foldable vertex. `limit` is the same text with 0 for each
    vertex that looks flat at the end of the path: paths with the same `limit` seem to end at one
    point. None of this is proved.
    """

    signs: str
    reason: str
    limit: str


@dataclass(frozen=True, repr=False)
class StreamedCount(BranchCount):
    """The result of `stream_branches`: a `BranchCount`, and facts about the file and the run.

    If `unproved` is 0, the file at `path` is a complete certificate. The branches are in the file
    and not listed here; `read_branches` reads them. If `unproved` is positive, the roots in the
    file are still proved, `open_roots` names up to 1000 of the `unproved` sign vectors without a
    root, and `count_branches` has also counted a pattern with at most 12 foldable vertices, which
    may prove the count. `exact` is the number of roots that needed integers, `resumed` the number
    of blocks that an earlier run left and this run verified again. `cpu_seconds` is the processor
    time of all workers by stage.
    """

    path: str = ""
    open_roots: tuple[OpenRoot, ...] = ()
    unproved: int = 0
    exact: int = 0
    blocks: int = 0
    resumed: int = 0
    steps: int = 0
    cpu_seconds: Mapping[str, float] = field(default_factory=dict, compare=False)

    @property
    def complete(self) -> bool:
        """Whether the file is a complete certificate."""
        return self.unproved == 0

    @property
    def foldable(self) -> int:
        """n, the number of foldable vertices."""
        return self.pattern.Vi - self.pattern.Vt

    @property
    def groups(self) -> dict[str, list[OpenRoot]]:
        """The open roots whose paths seem to meet, grouped by the sign vector where they meet."""
        return by_limit(self.open_roots)

    def to_dict(self, certificate: str | None = None, name: str | None = None) -> StreamedDocument:
        """The object printed by `exactfold count --stream --json`."""
        stream: StreamDocument = {
            "file": self.path,
            "blocks": self.blocks,
            "resumed": self.resumed,
            "unproved": self.unproved,
            "exact": self.exact,
            "open": [
                {"signs": root.signs, "reason": root.reason, "limit": root.limit}
                for root in self.open_roots
            ],
            "groups": {
                limit: [root.signs for root in group] for limit, group in self.groups.items()
            },
            "cpu_seconds": {name: round(value, 3) for name, value in self.cpu_seconds.items()},
        }
        document = {**super().to_dict(certificate, name), "stream": stream}
        return cast("StreamedDocument", document)


def stream_branches(
    pattern: PatternLike,
    path: str | os.PathLike[str],
    *,
    workers: int = 1,
    resume: bool = False,
    replace: bool = True,
    seed: int = 0,
    fallback: bool = True,
    progress: Progress | None = None,
    engine: Engine | None = None,
) -> StreamedCount:
    """Prove all branches of a pattern with four boundary vertices, streaming them to `path`.

    Each of the 2^n sign vectors leads to one candidate. A box around the candidate is proved to
    hold one zero with exactly these signs. So the zeros are pairwise different, and by refined
    Bezout they are all (docs/mathematics.md, Completeness and Nappes). Memory does not grow with
    2^n: it holds a block of 1024 roots, and two blocks for each worker. If sign vectors stay open,
    as at multiple roots, and the pattern has at most 12 foldable vertices, `count_branches` counts
    the pattern as a fallback, unless `fallback` is False.

    Up to `workers` processes share the blocks, fewer if little is left to do; a script that asks
    for several needs the usual `if __name__ == "__main__"`. An `engine`, such as `dask_engine`,
    replaces these processes. With `resume`, a file that an interrupted run left is verified and
    continued. Without it, a file at `path` is replaced, or refused if `replace` is False.
    `progress(stage, done, total)` counts sign vectors.

    Raises `NotApplicableError` unless D = 1 and 1 to 40 vertices are foldable, `NotCountedError`,
    `ForeignJournalError`, `JournalInUseError` while another run writes the file,
    `UnwritableFileError`, `UsageError`, `WorkerDiedError`. An interruption leaves a file that can
    be resumed. UNDECIDED does not mean that the count is unusual.

    >>> import os, tempfile
    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = stream_branches(random_square(4, seed=0), os.path.join(folder, "c.txt"))
    >>> result.status, result.distinct, result.unproved
    (<Verdict.PROVED: 'proved'>, 16, 0)
    """
    start, pattern = time.perf_counter(), as_pattern(pattern)
    check_countable(pattern)
    branch_blocks = BranchBlocks.of(pattern)
    problem, total = branch_blocks.problem, 1 << branch_blocks.size
    header = header_line(problem, branch_blocks.block_size)
    tally = Tally()
    if resume:
        known = FastChecker(CompactSheet(COMPACT.header(header)))

        def refusal(text: str, number: int) -> str | None:
            if progress is not None:
                progress("verifying", number * branch_blocks.block_size, total)
            return known.refusal(text, number)

        journal = Journal.resumed(path, header, refusal)
    else:
        journal = Journal(path, header, replace=replace)
    resumed = journal.blocks
    left = range(resumed, branch_blocks.blocks)
    for index in range(resumed):  # the file does not have the angles of folds
        tally.measure(branch_blocks.bends(index))
    with closing(journal), closing((engine or processes(workers))(branch_blocks, left)) as blocks:
        for block, line in blocks:
            tally.add(branch_blocks, block)
            journal.append(line)
            if progress is not None:
                progress("proving", journal.blocks * branch_blocks.block_size, total)
        if not tally.unproved:
            journal.finish(claims_line(pattern, chamber_counts(problem)))
        else:
            journal.sync()
    if journal.complete:
        count = _proved(pattern, total)
    else:
        count = _open(pattern, branch_blocks, tally)
        if fallback and branch_blocks.size <= HANDED_OVER:
            count = _handed_over(count, seed, progress)
    given = {f.name: getattr(count, f.name) for f in fields(BranchCount)}
    given["seconds"] = time.perf_counter() - start
    given["bends"] = count.bends or tally.bends
    return StreamedCount(
        **given,
        path=journal.path,
        open_roots=tuple(tally.open_roots),
        unproved=tally.unproved,
        exact=tally.exact,
        blocks=branch_blocks.blocks,
        resumed=resumed,
        steps=tally.steps,
        cpu_seconds=dict(tally.seconds),
    )


def _proved(pattern: CreasePattern, total: int) -> BranchCount:
    weight = 1 << pattern.Vi
    return BranchCount(
        pattern,
        PROVED,
        "streaming",
        f"{counted(total, 'solution')} isolated; by refined Bezout there are no others",
        why="a block of sign vectors at a time",
        distinct=total,
        with_multiplicity=weight,
        real=total,
        nonreal=0,
        true_branches=PROVED,
        true_bounds=(total, total),
        dimension=pattern.degrees_of_freedom,
        degree=weight,
    )


def _open(pattern: CreasePattern, branch_blocks: BranchBlocks, tally: Tally) -> BranchCount:
    total = 1 << branch_blocks.size
    culprits = tally.culprits(branch_blocks.problem.foldable)
    if branch_blocks.size > HANDED_OVER and "flat" in culprits:
        culprits += ": count without --stream also looks for multiple roots"
    return BranchCount(
        pattern,
        UNDECIDED,
        "streaming",
        f"{total - tally.unproved} of {counted(total, 'solution')} isolated; {culprits}",
        true_bounds=(max(1, total - tally.unproved), total),
        why="a block of sign vectors at a time",
        open_questions=tuple(tally.questions()),
    )


def _handed_over(streamed: BranchCount, seed: int, progress: Progress | None) -> BranchCount:
    """The count by `count_branches`; if undecided, with the open questions of the run, too."""
    other = count_branches(streamed.pattern, seed=seed, progress=progress)
    if other.status is PROVED:
        return other
    return changed(other, open_questions=(*streamed.open_questions, *other.open_questions))


# --- sign vectors whose branch was not proved are collected, grouped, and put into words ---------


def open_root(branch_blocks: BranchBlocks, number: int, end: OpenEnd) -> OpenRoot:
    """The open root of the sign vector with this number."""
    signs = "".join("+-"[number >> k & 1] for k in range(branch_blocks.size))
    limit = "".join("0" if k in end.flat else sign for k, sign in enumerate(signs))
    return OpenRoot(signs, end.reason, limit)


def by_limit(roots: Sequence[OpenRoot]) -> dict[str, list[OpenRoot]]:
    """The open roots whose paths seem to meet, grouped by the sign vector where they meet."""
    groups: dict[str, list[OpenRoot]] = {}
    for root in roots:
        if "0" in root.limit:
            groups.setdefault(root.limit, []).append(root)
    return groups


class Tally:
    """Sums over the blocks of a run, and the first `MOST_LISTED` open roots."""

    def __init__(self) -> None:
        self.open_roots: list[OpenRoot] = []
        self.unproved = self.exact = self.steps = 0
        self.seconds: Counter[str] = Counter()
        self.bends: Bends | None = None

    def add(self, branch_blocks: BranchBlocks, block: ProvedBlock) -> None:
        """Add one block to the sums."""
        self.exact += len(block.exact)
        self.unproved += len(block.open)
        self.steps += block.steps
        self.seconds.update(block.seconds)
        self.measure(block.bends)
        for j, end in block.open.items():
            if len(self.open_roots) < MOST_LISTED:
                number = block.index * branch_blocks.block_size + j
                self.open_roots.append(open_root(branch_blocks, number, end))

    def measure(self, bends: Bends | None) -> None:
        """Add the angles of folds in one block; None if coordinates are exact."""
        if bends is not None:
            self.bends = bends if self.bends is None else self.bends + bends

    def culprits(self, foldable: Sequence[int]) -> str:
        """Why sign vectors are open, in words; `foldable` names the vertices of their signs."""
        zeros = {k for root in self.open_roots for k, s in enumerate(root.limit) if s == "0"}
        if not zeros:
            return "the reasons for the others are below"
        flat = ", ".join(str(foldable[k]) for k in sorted(zeros))
        noun, verb = agreeing(len(zeros), "vertex"), agreeing(len(zeros), "looks")
        return f"on the others {noun} {flat} {verb} flat"

    def questions(self) -> Iterator[str]:
        """In words: groups of sign vectors that seem to meet, then single open sign vectors."""
        for limit, group in by_limit(self.open_roots).items():
            signs = ", ".join(root.signs for root in group[:8])
            more = f" and {len(group) - 8} more" if len(group) > 8 else ""
            yield f"sign vectors {signs}{more} seem to meet at {limit}: {group[0].reason}"
        for root in self.open_roots:
            if "0" not in root.limit:
                yield f"sign vector {root.signs}: {root.reason}"
        if (rest := self.unproved - len(self.open_roots)) > 0:
            yield f"{counted(rest, 'more sign vector')}, not listed"
