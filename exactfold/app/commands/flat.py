"""`exactfold flat`: the flat-folded states of a sheet."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from exactfold._support.clock import Clock
from exactfold.app.options.branches import FlatOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.app.verbs.chosen import DRAWN
from exactfold.errors import NotApplicableError, TooManyModesError
from exactfold.layers.folding import fold_flat
from exactfold.layers.states import FlatStates
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.opening import Opened


class Asked(FlatOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Print the answer, and return the exit code: 1 if it is proved that there is no state.

        Raises the errors of `read_any`, and `UsageError` for letters that do not fit the folds.
        """
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=False)
            found = fold_flat(opened, self._letters(opened), limit=self.limit, progress=bar)
            if self.certificate is not None:
                bar("certificate", 0, 0)
                self._write(found, self.certificate)
        if self.as_json:
            print(json.dumps(found.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.flat_report(found, everything=self.everything))
        return EXIT[found.status]

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
