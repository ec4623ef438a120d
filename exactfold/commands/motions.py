"""`exactfold motions`: how the half-branches are joined by true motions, with proof."""

from __future__ import annotations

import json
import os
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

from exactfold.commands.patterns import read
from exactfold.commands.shell import EXIT, Bar, name_of
from exactfold.count.on_dask import LOCAL
from exactfold.count.pools import dask_pool, process_pool
from exactfold.drawing.drawing import Snap
from exactfold.errors import UsageError
from exactfold.motion.matching import find_loops


@dataclass(frozen=True)
class Wanted:
    """What was asked for on the command line."""

    file: Path
    snap: Snap | None
    sheet: int | None
    workers: int | None
    dask: str | None
    as_json: bool

    def answer(self) -> int:
        """Follow all half-branches and print; the exit code.

        Raises the errors of `read`, `find_loops` and `dask_pool`.
        """
        from exactfold import report

        if self.workers is not None and self.dask not in (None, LOCAL):
            raise UsageError("the cluster has its workers: --workers goes with --dask local")
        ready = nullcontext(process_pool(self.workers or os.cpu_count() or 1))
        with Bar("reading") as bar:
            pattern = read(self.file, self.snap, self.sheet, "motions").pattern
            with ready if self.dask is None else dask_pool(self.dask, self.workers) as pool:
                found = find_loops(pattern, pool=pool, progress=bar)
        if self.as_json:
            print(json.dumps(found.report(name_of(self.file))))
        else:
            report.show(report.motions_report(found))
        return EXIT[found.status]
