"""`exactfold count` of one pattern: in memory or streamed, with a certificate if asked for."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app import report
from exactfold.app.commands.cells import asked_cell
from exactfold.app.commands.stream import Streaming, advice
from exactfold.app.options.patterns import CountOptions
from exactfold.app.shell.given import Given
from exactfold.app.shell.parsers import ALL
from exactfold.app.shell.patterns import located, read, read_any
from exactfold.app.shell.shell import EXIT, STDIN, Bar, apart, name_of, say
from exactfold.app.verbs.completing import counted_with_letters
from exactfold.branches.values.result import BranchCount
from exactfold.certificates.entries import write_certificate
from exactfold.errors import NotApplicableError, SeveralSheetsError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.opening import Opened, is_cell_file

if TYPE_CHECKING:  # counting branches does not need it
    from exactfold.branches.counting.stream import StreamedCount
    from exactfold.panels.result import Decomposition


class Asked(CountOptions):
    """The options of one call, and how they are answered."""

    @property
    def pattern(self) -> Path:
        """The only pattern of the call."""
        return self.patterns[0]

    @property
    def given(self) -> Given:
        """The files with boundary heights and angle deficits."""
        return Given(self.boundary_heights, self.curvature)

    def run(self) -> int:
        """Count, write the requested files, print the answer, and return the exit code.

        Raises the errors of `read_any`, `count_branches` and `Streaming`, and `UsageError`.
        """
        apart(self.certificate, self.pattern, self.stream)
        apart(self._components, self.pattern, self.stream)
        if self.direction is not None or self.periodic or is_cell_file(located(self.pattern)):
            return self._periodic()
        if self.cell is not None:
            raise UsageError("--cell goes with --direction or --periodic")
        if self.given:
            return self._shapes()
        streamed = None if self.stream is None else self._streamed(self.stream)
        opened = None
        result: BranchCount | Decomposition
        if streamed is not None:
            result = streamed
        else:
            try:
                opened, result = self._counted()
            except SeveralSheetsError as error:
                if not self._takes_all(error):
                    raise
                return self._each(error.known)
        near = result.nearly_flat if isinstance(result, BranchCount) else None
        if near and not result.doubt and not near_degenerate(result.pattern):
            say(f"warning: {near.text}")  # of near relations the reader has warned
        written = self._certified(result, streamed)
        if self.as_json:
            print(json.dumps(result.to_dict(written, name_of(self.pattern))))
        elif not isinstance(result, BranchCount):
            panels = report.panels_report(
                result, written, everything=self.everything, verbose=self.verbose
            )
            report.show(panels)
            self._of_digits(result)
        else:
            shown = report.count_report(
                result,
                written,
                everything=self.everything,
                streamed=streamed,
                verbose=self.verbose,
            )
            report.show(shown)
            self._of_digits(result)
        if opened is not None and result.status is UNDECIDED and not self.as_json:
            from exactfold.design.panels.vertex.vertices import vertices

            report.show(report.vertices_line(vertices(opened)))
        if result.proposal and not self.as_json:
            report.show("")
            for line in report.proposal_lines(result.proposal):
                report.show(line)
        return EXIT[result.status]

    def _takes_all(self, error: SeveralSheetsError) -> bool:
        """Whether the sheets of a drawing are all counted, as none was chosen.

        A certificate is about one sheet, and standard input is read once.
        """
        return not (not error.sheets or self.certificate or self.pattern == STDIN)

    def _each(self, known: str) -> int:
        """Count every sheet of the drawing, and say so; with --json each has a line."""
        from exactfold.app.commands.several.batch import Batch

        say(f"{known}: each is counted, as with --sheet all; --sheet N chooses one")
        options = {option.name: getattr(self, option.name) for option in fields(self)}
        return Batch(**{**options, "sheet": "all"}).run()

    def _of_digits(self, result: BranchCount | Decomposition) -> None:
        if result.as_written is not None:
            report.show(report.digits_line(result.as_written))

    def _shapes(self) -> int:
        """Count the shapes with given angle deficits."""
        from exactfold.branches.counting.shapes import count_shapes

        if self.given.curvature is None:
            raise UsageError(
                "--boundary-heights goes with --curvature: without it, all boundary heights are "
                "covered"
            )
        for option, value in (
            ("--certificate", self.certificate),
            ("--stream", self.stream),
            ("--method", None if self.method == "auto" else self.method),
        ):
            if value is not None:
                raise UsageError(
                    f"{option} does not go with --curvature; `exactfold branch --curvature` writes "
                    "a certificate of one shape"
                )
        with Bar("reading") as bar:
            pattern = read(self.pattern, self.reading, "count", verbose=self.verbose).pattern
            finder = self.given.finder(pattern)
            result = count_shapes(
                pattern,
                finder.curvature or {},
                boundary_heights=finder.boundary_heights,
                progress=bar,
            )
        if self.as_json:
            print(json.dumps(result.to_dict(name_of(self.pattern))))
        else:
            report.show(report.shapes_report(result, everything=self.everything))
        return EXIT[result.status]

    def _periodic(self) -> int:
        """Count the branches of a periodic sheet for one direction, or for all."""
        from exactfold.branches.periodic.certificate import periodic_certificate
        from exactfold.branches.periodic.counting import count_periodic

        for option, value in (
            ("--stream", self.stream),
            ("--method", None if self.method == "auto" else self.method),
            ("--curvature", self.curvature),
            ("--boundary-heights", self.boundary_heights),
        ):
            if value is not None:
                raise UsageError(f"{option} does not go with periodic sheets")
        if self.direction is None:
            return self._panel_cell()
        if self.periodic:
            raise UsageError("give --direction, or --periodic for rigid panels")
        if self.direction == ALL:
            return self._all_directions()
        with Bar("reading") as bar:
            cell = asked_cell(self.pattern, self.reading, self.cell, verbose=self.verbose)
            result = count_periodic(cell, self.direction, limit=self.limit, progress=bar)
        written = self._written(lambda: periodic_certificate(result))
        if self.as_json:
            print(json.dumps(result.to_dict(written, name_of(self.pattern))))
        else:
            report.show(report.periodic_report(result, written, everything=self.everything))
        return EXIT[result.status]

    def _written(self, certificate: Callable[[], dict[str, Any]]) -> str | None:
        """Write the certificate if it was asked for, and there is one; returns its name."""
        if self.certificate is None:
            return None
        try:
            write_certificate(certificate(), self.certificate)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
            return None
        return str(self.certificate)

    def _panel_cell(self) -> int:
        """Count the motions of a tessellation of rigid panels."""
        from exactfold.panels.periodic.certificate import panel_cell_certificate
        from exactfold.panels.periodic.modes import count_panel_cell

        with Bar("reading") as bar:
            cell = asked_cell(self.pattern, self.reading, self.cell, verbose=self.verbose)
            bar("solving")
            result = count_panel_cell(cell, limit=self.limit)
        written = self._written(lambda: panel_cell_certificate(result))
        if self.as_json:
            print(json.dumps(result.to_dict(written, name_of(self.pattern))))
        else:
            report.show(report.panel_cell_report(result, written, everything=self.everything))
        return EXIT[result.status]

    def _all_directions(self) -> int:
        """The branches of a periodic sheet over all directions."""
        from exactfold.branches.periodic.directions import count_directions

        if self.certificate is not None:
            raise UsageError("--direction all has no certificate; that of one direction has")
        with Bar("reading") as bar:
            cell = asked_cell(self.pattern, self.reading, self.cell, verbose=self.verbose)
            result = count_directions(cell, limit=self.limit, progress=bar)
        if self.as_json:
            print(json.dumps(result.to_dict(name_of(self.pattern))))
        else:
            report.show(report.directions_report(result, everything=self.everything))
        return EXIT[result.status]

    def _streamed(self, file: Path) -> StreamedCount:
        if self.method != "auto":
            raise UsageError("--stream has a method of its own: leave out --method")
        return Streaming(self, file).run()

    def _counted(self) -> tuple[Opened, BranchCount | Decomposition]:
        if self.resume or self.workers is not None or self.dask is not None:
            raise UsageError("--resume, --workers and --dask go with --stream")
        clock = Clock(self.limit)
        with Bar("reading") as bar:
            opened = read_any(
                self.pattern, self.reading, verbose=self.verbose, doubted=self.as_json
            )
            sheet = opened.sheet
            if isinstance(sheet, CreasePattern) and (better := advice(sheet)) is not None:
                say(better)
            bar("solving")
            return opened, counted_with_letters(opened, self.method, self.seed, clock, bar)

    def _certified(
        self, result: BranchCount | Decomposition, streamed: StreamedCount | None
    ) -> str | None:
        """Write the certificate and return its path; if there is none, say why and return None."""
        if self.certificate is None:
            return None
        from exactfold.branches.certificates.listing import certificate as certificate_of

        if not isinstance(result, BranchCount):
            return self._certified_panels(result, self.certificate)
        if result.connected_components is not None and result.proof is None:
            return self._certified_components(result, self.certificate)
        if result.families is not None:
            return self._certified_panels(result.families, self.certificate)
        if result.status is not PROVED:
            say("no certificate was written: the count is not proved")
        elif streamed is not None and result.proof is None:
            say(f"the proof is in {self.stream}; no other was written")
        else:
            write_certificate(certificate_of(result), self.certificate)
            return str(self.certificate)
        return None

    @property
    def _components(self) -> Path | None:
        """The path for the certificate of irreducible components, beside `certificate`."""
        file = self.certificate
        return None if file is None else file.with_suffix(f".components{file.suffix}")

    def _certified_components(self, result: BranchCount, file: Path) -> str | None:
        """Write the certificate of the connected components, and that of the irreducible ones."""
        from exactfold.branches.certificates.listing import certificate as certificate_of

        written = None
        try:
            write_certificate(certificate_of(result), file)
            written = str(file)
        except NotApplicableError as error:
            say(f"no certificate of the connected components was written: {error}")
        if result.families is not None and result.families.status is PROVED:
            more = file if written is None else self._components or file
            panels_file = self._certified_panels(result.families, more)
            if panels_file is not None:
                say(f"the list of irreducible components has a certificate of its own: {more}")
            written = written or panels_file
        return written

    def _certified_panels(self, ways: Decomposition, file: Path) -> str | None:
        from exactfold.design.panels.freedom_certificate import freedom_certificate
        from exactfold.panels.certificate import certificate_of_panels

        try:
            write_certificate(certificate_of_panels(ways), file)
        except NotApplicableError as error:
            if ways.second_order is not None or ways.freedom is None:
                say(f"no certificate was written: {error}")
                return None
        else:
            return str(file)
        try:
            document = freedom_certificate(ways)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
            return None
        write_certificate(document, file)
        claims = document["claims"]
        say(
            "the certificate proves bounds of the degrees of freedom only: at least "
            f"{claims['least']}, at most {claims['most']}"
        )
        return str(file)
