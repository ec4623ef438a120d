"""`exactfold vertices`: what is known of each vertex of a sheet by itself."""

from __future__ import annotations

import json
from collections.abc import Mapping

from exactfold.app.options.branches import VerticesOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of
from exactfold.design.panels.vertex.vertices import vertices
from exactfold.pattern.crease_pattern import Edge
from exactfold.pattern.opening import Opened


class Asked(VerticesOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Print the facts, and return the exit code: 1 if a vertex cannot have its letters.

        Raises the errors of `read_any`, and `UsageError` for letters that do not fit the folds.
        """
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            bar("vertices")
            found = vertices(opened, self._letters(opened))
        if self.as_json:
            print(json.dumps(found.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.vertices_report(found, everything=self.everything))
        return EXIT[found.starts]

    def _letters(self, opened: Opened) -> Mapping[Edge, str] | None:
        if self.letters is None:
            return None
        from exactfold.app.options.choosing import given_letters

        return given_letters(opened.sheet, self.letters)
