"""`exactfold tolerance`: how far vertices may move before the answer changes, with proof."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold.app.options.choosing import choice_of
from exactfold.app.options.tolerances import ToleranceOptions
from exactfold.app.pictures.circles import tolerance_picture
from exactfold.app.pictures.picture_files import checked_picture, write_picture
from exactfold.app.shell.patterns import in_doubt, read_any, tell_doubt, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say, wrote
from exactfold.app.verbs.tolerating import tolerance_opened
from exactfold.certificates.entries import write_certificate
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import parse_rational
from exactfold.pattern.writing.fold_writing import require_folder

if TYPE_CHECKING:
    from exactfold.design.tolerance.result import Tolerance


class Asked(ToleranceOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find the radii, draw and print them, and return the exit code.

        Raises the errors of `read_any`, `tolerance_opened` and `write_picture`.
        """
        if self.output is not None:
            checked_picture(self.output)  # before the work
        if self.certificate is not None:
            require_folder(self.certificate)
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
            found = tolerance_opened(opened, choice_of(self, opened), self.seed, bar)
            if self.output is not None:
                write_picture(tolerance_picture(found), self.output)
            if self.certificate is not None:
                self._certify(found, self.certificate, bar)
        if self.as_json:
            print(json.dumps(in_doubt(opened, found.to_dict(name_of(self.file)))))
        else:
            from exactfold.app import report

            tell_doubt(opened)
            report.show(report.tolerance_report(found, everything=self.everything))
        if self.output is not None:
            wrote(self.output, "the sheet with a circle round each vertex")
        return EXIT[verdict(opened, found.status)]

    def _certify(self, found: Tolerance, file: Path, bar: Bar) -> None:
        """Write the certificate of the radius, or say why there is none."""
        from exactfold.design.tolerance.certificate import tolerance_certificate

        try:
            document = tolerance_certificate(found, bar)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
            return
        write_certificate(document, file)
        radius = float(parse_rational(document["claims"]["radius"]))
        less = "" if radius == found.radius else f", of the smaller radius {radius:.6g}"
        wrote(file, f"the evidence for `exactfold check`{less}")
