"""All branches of a pattern, proved block by block and streamed to a compact certificate."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from contextlib import closing
from dataclasses import dataclass, field, fields
from dataclasses import replace as changed
from typing import TYPE_CHECKING, cast

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.certificates.blocks import chamber_counts, claims_line, header_line
from exactfold.branches.certificates.check import FastChecker
from exactfold.branches.counting.collect import check_countable, count_branches
from exactfold.branches.counting.conveyor import Conveyor
from exactfold.branches.counting.engines import Engine, processes
from exactfold.branches.counting.open_roots import OpenRoot, Tally, by_limit
from exactfold.branches.values.result import BranchCount
from exactfold.certificates.journal import Journal
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.branches.compact_blocks import CompactSheet
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern

if TYPE_CHECKING:
    from exactfold.branches.values.count_document import StreamDocument, StreamedDocument

HANDED_OVER = 12
"""Most foldable vertices of a pattern with open sign vectors that is also counted otherwise."""


@dataclass(frozen=True, repr=False)
class StreamedCount(BranchCount):
    """What a run of `stream_branches` proved: a `BranchCount`, and the file.

    If `path` holds a complete certificate (`unproved` is 0), the branches are in the file and not
    listed here: `read_branches` reads them. Otherwise the roots that are in the file are proved
    nevertheless, `open_roots` names the sign vectors without one (1000 at most; their number is
    `unproved`), and up to 12 foldable vertices the pattern was counted otherwise as well, which may
    prove the count. `exact` counts roots that needed integers, `resumed` the blocks taken over from
    an earlier run, verified again. `cpu_seconds` is processor time by stage, of all workers.
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
        """The open roots whose paths seem to meet others, by the sign vector they share there."""
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
        found = {**super().to_dict(certificate, name), "stream": stream}
        return cast("StreamedDocument", found)


def stream_branches(
    pattern: PatternLike,
    path: str | os.PathLike[str],
    *,
    workers: int = 1,
    resume: bool = False,
    replace: bool = True,
    seed: int = 0,
    hand_over: bool = True,
    progress: Progress | None = None,
    engine: Engine | None = None,
) -> StreamedCount:
    """Prove all branches of a pattern with four boundary vertices, streaming them to `path`.

    Each of the 2^n sign vectors leads to one candidate; a box around it with one zero whose signs
    are those asked for makes the zeros pairwise different, and by refined Bezout complete
    (docs/mathematics.md, Completeness and Nappes). Memory does not grow with 2^n: a block of 1024
    roots, and two waiting for each worker. Where sign vectors stay open, as at multiple roots, the
    pattern is handed over to `count_branches` if it has at most 12 foldable vertices; not without
    `hand_over`.

    Up to `workers` processes share the blocks, fewer if there is little to do; a script that asks
    for several needs the usual `if __name__ == "__main__"`. With `resume`, a file left by an
    interrupted run is verified and continued; otherwise it is replaced, or refused without
    `replace`. `progress(stage, done, total)` counts sign vectors. An `engine`, such as
    `dask_engine`, takes the place of the `workers`.

    Raises `NotApplicableError` unless D = 1 and some vertex is foldable, 40 at most,
    `NotCountedError`, `ForeignJournalError`, `JournalInUseError` while another run writes the
    file, `UnwritableFileError`, `UsageError`, `WorkerDiedError`. An interruption leaves a file that
    can be resumed. UNDECIDED does not mean that the count is unusual.

    >>> import os, tempfile
    >>> from exactfold.pattern.random_squares import random_square
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     result = stream_branches(random_square(4, seed=0), os.path.join(folder, "c.txt"))
    >>> result.status, result.distinct, result.unproved
    (<Verdict.PROVED: 'proved'>, 16, 0)
    """
    start, pattern = time.perf_counter(), as_pattern(pattern)
    check_countable(pattern)
    conveyor = Conveyor.of(pattern)
    problem, total = conveyor.problem, 1 << conveyor.size
    header = header_line(problem, conveyor.block_size)
    tally = Tally()
    if resume:
        known = FastChecker(CompactSheet(COMPACT.header(header)))

        def refusal(text: str, number: int) -> str | None:
            if progress is not None:
                progress("verifying", number * conveyor.block_size, total)
            return known.refusal(text, number)

        journal = Journal.resumed(path, header, refusal)
    else:
        journal = Journal(path, header, replace=replace)
    resumed = journal.blocks
    left = range(resumed, conveyor.blocks)
    with closing(journal), closing((engine or processes(workers))(conveyor, left)) as blocks:
        for block, line in blocks:
            tally.add(conveyor, block)
            journal.append(line)
            if progress is not None:
                progress("proving", journal.blocks * conveyor.block_size, total)
        if not tally.unproved:
            journal.finish(claims_line(pattern, chamber_counts(problem)))
        else:
            journal.sync()
    if journal.complete:
        found = _proved(pattern, total)
    else:
        found = _open(pattern, conveyor, tally)
        if hand_over and conveyor.size <= HANDED_OVER:
            found = _handed_over(found, seed, progress)
    given = {f.name: getattr(found, f.name) for f in fields(BranchCount)}
    given["seconds"] = time.perf_counter() - start
    return StreamedCount(
        **given,
        path=journal.path,
        open_roots=tuple(tally.open_roots),
        unproved=tally.unproved,
        exact=tally.exact,
        blocks=conveyor.blocks,
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


def _open(pattern: CreasePattern, conveyor: Conveyor, tally: Tally) -> BranchCount:
    total = 1 << conveyor.size
    culprits = tally.culprits(conveyor.problem.foldable)
    if conveyor.size > HANDED_OVER and "flat" in culprits:
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


def _handed_over(found: BranchCount, seed: int, progress: Progress | None) -> BranchCount:
    """The count by other means, with what the run left open if that proves nothing either."""
    other = count_branches(found.pattern, seed=seed, progress=progress)
    if other.status is PROVED:
        return other
    return changed(other, open_questions=(*found.open_questions, *other.open_questions))
