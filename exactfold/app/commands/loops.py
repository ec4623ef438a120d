"""`exactfold motions`: finds which rays true motions connect, with proof."""

from __future__ import annotations

import json
import os
import shlex
from contextlib import ExitStack

from exactfold.app.options.motions import MotionsOptions
from exactfold.app.options.reading import overruling
from exactfold.app.shell.patterns import in_doubt, read, tell_doubt, verdict
from exactfold.app.shell.resuming import require_file, resumable
from exactfold.app.shell.shell import EXIT, Bar, apart, interruptible, name_of
from exactfold.branches.counting.doubted import about
from exactfold.branches.counting.on_dask import LOCAL
from exactfold.branches.counting.pools import dask_pool
from exactfold.errors import NotCountedError, UsageError
from exactfold.motion.loops.matching import find_loops

_FEW = 4
"""A sheet with at most this many foldable vertices is followed in this process, by default."""


class Wanted(MotionsOptions):
    """The options of one call, and how they are answered."""

    @property
    def again(self) -> str:
        """The command that continues the certificate."""
        words = ["exactfold", "motions", str(self.file), "--certificate", str(self.certificate)]
        words.append("--resume")
        for name in ("workers", "dask", "snap", "sheet"):
            if value := getattr(self, name):
                words += [f"--{name}", str(value)]
        words += overruling(self.reading)
        return shlex.join(words)

    def answer(self) -> int:
        """Follow all rays, print the answer, and return the exit code.

        Raises the errors of `read`, `find_loops` and `dask_pool`, and `UsageError`.
        """
        from exactfold.app import report

        if self.workers is not None and self.dask not in (None, LOCAL):
            raise UsageError(
                "a running cluster has its own workers: leave out --workers, or use --dask local"
            )
        if self.resume and self.certificate is None:
            raise UsageError("--resume continues a file: it goes with --certificate")
        apart(self.certificate, self.file)
        with Bar("reading") as bar:
            read_sheet = read(self.file, self.reading, "motions", verbose=self.verbose)
            pattern, opened = read_sheet.pattern, about(read_sheet.opened)
            if len(pattern.boundary) > 4:
                raise NotCountedError(
                    "motions takes sheets with four boundary vertices, and this one has "
                    f"{len(pattern.boundary)}: its ways to fold form families, and "
                    "`exactfold fold` follows one of them"
                )
            with ExitStack() as stack:
                if self.certificate is not None:
                    require_file(self.certificate, self.resume)
                    stack.enter_context(resumable(self.certificate, self.again))
                stack.enter_context(interruptible())
                pool = None
                if self.dask is not None:
                    pool = stack.enter_context(dask_pool(self.dask, self.workers))
                few = len(pattern.foldable_vertices) <= _FEW
                loops = find_loops(
                    pattern,
                    processes=self.workers or (1 if few else os.cpu_count() or 1),
                    pool=pool,
                    progress=bar,
                    certificate=self.certificate,
                    resume=self.resume,
                    replace=False,
                )
        if self.as_json:
            print(json.dumps(in_doubt(opened, loops.to_dict(name_of(self.file)))))
        else:
            tell_doubt(opened)
            report.show(report.motions_report(loops))
        return EXIT[verdict(opened, loops.status)]
