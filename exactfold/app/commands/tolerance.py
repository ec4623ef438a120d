"""`exactfold tolerance`: how far vertices may move before the answer changes, with proof."""

from __future__ import annotations

import json

from exactfold.app.options.choosing import choice_of
from exactfold.app.options.tolerances import ToleranceOptions
from exactfold.app.pictures.circles import tolerance_picture
from exactfold.app.pictures.picture_files import checked_picture, write_picture
from exactfold.app.shell.patterns import in_doubt, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, wrote
from exactfold.app.verbs.tolerating import tolerance_opened


class Asked(ToleranceOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find the radii, draw and print them, and return the exit code.

        Raises the errors of `read_any`, `tolerance_opened` and `write_picture`.
        """
        if self.output is not None:
            checked_picture(self.output)  # before the work
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            found = tolerance_opened(opened, choice_of(self, opened), self.seed, bar)
            if self.output is not None:
                write_picture(tolerance_picture(found), self.output)
        if self.as_json:
            print(json.dumps(in_doubt(opened, found.to_dict(name_of(self.file)))))
        else:
            from exactfold.app import report

            tell_doubt(opened)
            report.show(report.tolerance_report(found, everything=self.everything))
        if self.output is not None:
            wrote(self.output, "the sheet with a circle round each vertex")
        return EXIT[verdict(opened, found.status)]
