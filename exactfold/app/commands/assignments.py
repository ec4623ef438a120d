"""`exactfold assignments`: every mountain-valley assignment of a sheet with five corners."""

from __future__ import annotations

import json

from exactfold.app.options.branches import AssignmentsOptions
from exactfold.app.shell.patterns import read, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.certificates.entries import write_certificate
from exactfold.design.circles.assignment_list import AllAssignments
from exactfold.design.circles.certificate import assignments_certificate
from exactfold.design.circles.circles import all_assignments
from exactfold.errors import NotApplicableError


class Listed(AssignmentsOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """List the assignments, print the answer, and return the exit code.

        Raises the errors of `read` and `all_assignments`.
        """
        with Bar("reading") as bar:
            read_sheet = read(self.file, self.reading, "assignments")
            assignments = all_assignments(read_sheet.pattern, progress=bar)
            self._write(assignments, bar)
        if self.as_json:
            print(json.dumps(assignments.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.assignments_report(assignments, everything=self.everything))
        return EXIT[verdict(read_sheet.opened, assignments.status)]

    def _write(self, assignments: AllAssignments, bar: Bar) -> None:
        if self.certificate is None:
            return
        bar("certificate")
        try:
            document = assignments_certificate(assignments, progress=bar)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
        else:
            write_certificate(document, self.certificate)
