"""`exactfold design`: moves vertices until a sheet folds as it is wanted to, with proof."""

from __future__ import annotations

import json
from pathlib import Path

from exactfold._support.clock import Clock
from exactfold.app.options.choosing import choice_of, indices
from exactfold.app.options.tolerances import DesignOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of, sheet_written, tell, wrote
from exactfold.app.verbs.choosing import the_branch
from exactfold.app.verbs.chosen import asked_letters
from exactfold.branches.counting.find import find_branch
from exactfold.branches.counting.ways import decompose_opened
from exactfold.branches.values.branch import Branch
from exactfold.design.moving.order import designed
from exactfold.design.moving.result import Designed
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import UsageError
from exactfold.motion.panels.listing import panel_ways, require_listed
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.writing.fold_writing import (
    checked_target,
    document_text,
    write_fold,
    write_text,
)
from exactfold.pattern.writing.panel_writing import converted

_SNAP = (
    "other commands need --snap exact to take its coordinates as they are: some relations between "
    "its creases hold nearly, not exactly"
)


class Asked(DesignOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Move the vertices, write and print the new sheet, and return the exit code.

        A sheet that was found is written, also if it is only the closest one, and after Ctrl-C.
        Raises the errors of `read_any`, `the_branch`, `designed` and `write_fold`.
        """
        if self.output is not None:
            checked_target(self.output, (".fold",), "a sheet")  # before the work
        fixed = [] if self.fixed is None else indices("--fixed", self.fixed)
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            letters = self._letters(opened, bar)
            found = designed(
                opened.sheet,
                letters,
                branch=None if letters is not None else self._branch(opened, bar),
                maximise=self.maximise,
                within=self.within,
                fixed=fixed,
                symmetric=self.symmetric,
                border=self.border,
                clock=Clock(self.limit),
                progress=bar,
            )
            if self.output is not None:
                _write(found, self.output)
        if self.as_json:
            output = None if self.output is None else str(self.output)
            print(json.dumps(found.to_dict(name_of(self.file), output)))
        else:
            from exactfold.app import report

            report.show(report.design_report(found))
            if self.output is not None:
                wrote(self.output, sheet_written(found.pattern))
                if Opened(found.pattern, {}).left:
                    tell(_SNAP)
        return EXIT[found.status]

    def _letters(self, opened: Opened, bar: Bar) -> dict[tuple[int, int], str] | None:
        """The letters that are asked for: of panels also those of a way."""
        of_panels = isinstance(opened.sheet, PanelPattern)
        if self.letters is None and (self.way is None or not of_panels):
            if self.maximise is None:
                raise UsageError("give --letters that are wanted, or --maximise, or both")
            return None
        if self.letters is None:
            known = decompose_opened(opened, progress=bar, clock=Clock(self.limit)).known
            ways = panel_ways(known)
            require_listed(ways, self.way or 0)
            return by_fold(
                opened.sheet.folds,
                dict.fromkeys(opened.sheet.folds, "F") | dict(ways[(self.way or 0) - 1].letters),
            )
        asked = choice_of(self, opened).letters
        return by_fold(opened.sheet.folds, asked_letters(opened, asked))

    def _branch(self, opened: Opened, bar: Bar) -> Branch | None:
        if not self.is_named:
            return None
        # Both sides of a branch have the same tolerance, and the same largest margin.
        return the_branch(opened, choice_of(self, opened), bar, needs="design").branch


def _write(found: Designed, output: Path) -> None:
    """Write the new sheet, with the letters that were asked for or those of the branch."""
    if isinstance(found.pattern, CreasePattern):
        write_fold(found.pattern, output, _drawn(found))
        return
    written = converted(Opened(found.pattern, dict(found.letters)))
    write_text(output, document_text(written.document()))


def _drawn(found: Designed) -> dict[tuple[int, int], str] | None:
    """The letters in the new file: those asked for, or those of the branch."""
    if found.letters or not isinstance(found.pattern, CreasePattern):
        return dict(found.letters)
    return dict(find_branch(found.pattern, found.signs).assignment) if found.signs else None
