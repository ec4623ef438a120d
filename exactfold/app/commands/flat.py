"""`exactfold flat`: the flat-folded states of a sheet."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold._support.clock import Clock
from exactfold.app.options.branches import FlatOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.app.verbs.chosen import DRAWN
from exactfold.errors import NotApplicableError, TooManyModesError, UsageError
from exactfold.layers.folding import fold_flat
from exactfold.layers.states import FlatStates
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.opening import Opened, has_branches

if TYPE_CHECKING:
    from exactfold.layers.ends import WayEnd


class Asked(FlatOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Print the answer, and return the exit code: 1 if it is proved that there is no state.

        Raises the errors of `read_any`, and `UsageError` for letters that do not fit the folds.
        """
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=False)
            found = fold_flat(opened, self._letters(opened), limit=self.limit, progress=bar)
            ends = self._ends(opened, found, bar) if self.ways else None
            if self.certificate is not None:
                bar("certificate", 0, 0)
                self._write(found, self.certificate)
        if self.as_json:
            document = found.to_dict(name_of(self.file))
            if ends is not None:
                document["ways"] = [end.to_dict() for end in ends]
            print(json.dumps(document))
        else:
            from exactfold.app import report

            report.show(report.flat_report(found, ends, everything=self.everything))
        return EXIT[found.status]

    def _ends(self, opened: Opened, found: FlatStates, bar: Bar) -> tuple[WayEnd, ...]:
        from exactfold.branches.counting.ways import decompose_opened
        from exactfold.layers.ends import way_ends

        if isinstance(opened.sheet, CreasePattern) and has_branches(opened.sheet):
            raise UsageError(
                "--ways is for sheets of rigid panels: this one is triangulated, and its ways are "
                "branches, which `exactfold fold` and `exactfold motions` follow"
            )
        answer = decompose_opened(opened, clock=Clock(self.limit), progress=bar)
        return way_ends(answer, found, limit=self.limit, progress=bar)

    def _write(self, found: FlatStates, path: Path) -> None:
        """Write the certificate, or say why there is none."""
        from exactfold.certificates.entries import write_certificate
        from exactfold.layers.certificate import states_certificate

        try:
            document = states_certificate(found, Clock(self.limit))
        except (NotApplicableError, TooManyModesError) as error:
            say(f"no certificate was written: {error}")
        else:
            write_certificate(document, path)

    def _letters(self, opened: Opened) -> Mapping[Edge, str] | str | None:
        if self.free:
            return "any"
        if self.letters is None or self.letters == DRAWN:
            return self.letters
        from exactfold.app.options.choosing import given_letters

        return given_letters(opened.sheet, self.letters)
