"""`exactfold export`: a branch, found by its signs or its place in the listing, as FOLD."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from exactfold.branches.branch import Branch
from exactfold.branches.export import AMOUNT, BranchExport, exported
from exactfold.commands.branch import chosen
from exactfold.commands.given import NOTHING, Given
from exactfold.commands.patterns import read
from exactfold.commands.shell import EXIT, Bar, name_of, say
from exactfold.drawing.drawing import Snap
from exactfold.errors import UndecidedBranchError, UsageError
from exactfold.pattern.described import described
from exactfold.pattern.near_degeneracy import warnings
from exactfold.schemas import headed
from exactfold.verdict import UNDECIDED


@dataclass(frozen=True)
class Wanted:
    """What was asked for on the command line; exactly one of `signs`, `up` and `place` is given."""

    file: Path
    snap: Snap | None
    sheet: int | None
    signs: str | None
    up: str | None
    place: int | None
    output: Path | None
    amount: float | None
    force: bool
    as_json: bool
    given: Given = NOTHING

    def answer(self) -> int:
        """Find the branch, write it and say so; the exit code.

        Raises the errors of `read`, `chosen` and `exported`, but for
        `UndecidedBranchError`, which is said on stderr with what `BranchFinder` gave as a reason.
        """
        output = None if self.output is None or str(self.output) == "-" else self.output
        if output is None and self.as_json:
            raise UsageError("--json describes the file that is written: name it with -o")
        with Bar("reading") as bar:
            pattern = read(self.file, self.snap, self.sheet, "export").pattern
            branch = chosen(pattern, self.signs, self.up, self.place, bar, self.given)
            bar("writing")
            try:
                export = exported(
                    branch,
                    amount=AMOUNT if self.amount is None else self.amount,
                    title=self._title,
                    force=self.force,
                )
            except UndecidedBranchError as error:
                say(f"not written: {error}; {branch.reason}".rstrip("; "))
                return EXIT[UNDECIDED]
            if output is not None:
                export.write(output)
        if output is None:
            sys.stdout.write(export.text)
        elif self.as_json:
            print(json.dumps(_summary(branch, export, output, name_of(self.file))))
        else:
            from exactfold import report

            report.show(report.export_report(str(output), branch, export))
        return EXIT[export.status]

    @property
    def _title(self) -> str | None:
        return None if str(self.file) == "/dev/stdin" else self.file.stem


def _summary(
    branch: Branch, export: BranchExport, output: Path, name: str | None
) -> dict[str, Any]:
    """The object that --json prints: `schema("export")`."""
    return {
        **headed("export"),
        "pattern": described(branch.pattern, name),
        "output": str(output),
        "status": str(export.status),
        "vertex_signs": {str(v): s for v, s in sorted(branch.vertex_signs.items())},
        "assignment": {f"{i}-{j}": a for (i, j), a in sorted(branch.assignment.items())},
        "gauge": branch.gauge,
        "angles": {f"{i}-{j}": angle for (i, j), angle in sorted(export.angles.items())},
        "length_error": export.length_error,
        "warnings": warnings(branch.pattern),
    }
