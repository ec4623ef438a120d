"""`exactfold assignments`: every mountain-valley assignment with which a sheet starts to fold."""

from __future__ import annotations

import json

from exactfold._support.clock import Clock
from exactfold.app.options.branches import AssignmentsOptions
from exactfold.app.options.choosing import given_letters
from exactfold.app.shell.patterns import read_any, verdict
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.certificates.entries import write_certificate
from exactfold.design.assignments.forcing import forcing_set
from exactfold.design.circles.assignment_list import AllAssignments
from exactfold.design.circles.certificate import assignments_certificate
from exactfold.design.circles.circles import all_assignments
from exactfold.design.panels.listed_certificate import panel_assignments_certificate
from exactfold.design.panels.panel_assignments import PanelAssignments, panel_assignments
from exactfold.design.refutations.forcing import Forcing
from exactfold.errors import NotApplicableError, NotCountedError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import Opened


class Listed(AssignmentsOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """List the assignments, print the answer, and return the exit code.

        Raises the errors of `read_any`, and `UsageError` if the letters do not fit.
        """
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=self.as_json)
            listed = self._listed(opened, bar)
            forcing = self._forcing(listed, opened) if self.forcing else None
            self._write(listed, forcing, bar)
        if self.as_json:
            print(json.dumps(listed.to_dict(name_of(self.file), forcing=forcing)))
        else:
            from exactfold.app import report

            shown = report.assignments_report(listed, forcing, everything=self.everything)
            report.show(shown)
        return EXIT[verdict(opened, listed.status)]

    def _listed(self, opened: Opened, bar: Bar) -> AllAssignments | PanelAssignments:
        """The list for a sheet with five corners if there is one, else that for rigid panels."""
        if isinstance(opened.sheet, CreasePattern) and not opened.doubt:
            try:
                return all_assignments(opened.sheet, progress=bar)
            except NotCountedError:
                pass  # the boundary is another one, or too many vertices can pop
        return panel_assignments(opened, progress=bar, clock=Clock(self.limit))

    def _forcing(self, listed: AllAssignments | PanelAssignments, opened: Opened) -> Forcing | None:
        """The least forcing set of the letters given, of those drawn, or of all assignments."""
        try:
            if self.letters is not None:
                return forcing_set(listed, given_letters(opened.sheet, self.letters))
            if opened.letters:
                try:
                    return forcing_set(listed, opened.letters)
                except NotApplicableError as error:
                    say(f"the letters of the file have no forcing set: {error}")
            return forcing_set(listed)
        except NotApplicableError as error:
            say(f"no forcing set: {error}")
            return None

    def _write(
        self, listed: AllAssignments | PanelAssignments, forcing: Forcing | None, bar: Bar
    ) -> None:
        if self.certificate is None:
            return
        bar("certificate")
        try:
            if isinstance(listed, PanelAssignments):
                document = panel_assignments_certificate(listed, forcing)
            else:
                document = assignments_certificate(listed, progress=bar)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
        else:
            write_certificate(document, self.certificate)
