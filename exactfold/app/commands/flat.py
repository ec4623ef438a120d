"""`exactfold flat`: the flat-folded states of a sheet."""

from __future__ import annotations

import json
from collections.abc import Mapping

from exactfold.app.options.branches import FlatOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of
from exactfold.app.verbs.chosen import DRAWN
from exactfold.layers.folding import fold_flat
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
        if self.as_json:
            print(json.dumps(found.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.flat_report(found, everything=self.everything))
        return EXIT[found.status]

    def _letters(self, opened: Opened) -> Mapping[Edge, str] | str | None:
        if self.free:
            return "any"
        if self.letters is None or self.letters == DRAWN:
            return self.letters
        from exactfold.app.options.choosing import given_letters

        return given_letters(opened.sheet, self.letters)
