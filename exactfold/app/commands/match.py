"""`exactfold match`: finds the branches with the mountains and valleys of a designer."""

from __future__ import annotations

import json
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace

from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, REFUTED
from exactfold.app.commands.cells import asked_cell, asked_cell_with_letters
from exactfold.app.options.branches import MatchOptions
from exactfold.app.options.choosing import given_letters
from exactfold.app.shell.patterns import located, read_any
from exactfold.app.shell.shell import EXIT, Bar, name_of, say
from exactfold.app.verbs.chosen import DRAWN
from exactfold.branches.counting.doubted import nearly_among
from exactfold.certificates.entries import write_certificate
from exactfold.design.assignments.boundary_match import can_pop, match_boundary
from exactfold.design.assignments.boundary_result import BoundaryMatch
from exactfold.design.assignments.certificate import match_certificate
from exactfold.design.assignments.nearest import nearest_branches
from exactfold.design.assignments.result import Match
from exactfold.design.assignments.search import MOST, match
from exactfold.design.panels.match import PanelMatch, match_panels
from exactfold.design.panels.vertex.vertices import open_vertices
from exactfold.errors import (
    NotApplicableError,
    NotCountedError,
    UsageError,
)
from exactfold.panels.periodic.result import PeriodicMatchDocument
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.drawing.bounds import read_text
from exactfold.pattern.opening import Opened, is_cell_file, triangles
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.pattern.periodic.cells import Side

_RIMS = 16
"""Default of --most if boundary heights are looked for: the number of sign vectors tried."""


class Asked(MatchOptions):
    """The options of one call, and how they are answered."""

    def answer(self) -> int:
        """Find the branches with the letters, print them, and return the exit code.

        If there are none, the reason and the nearest branches are printed. For sheets of panels and
        triangulated sheets with more than four corners, the question is whether they start to fold
        with the letters. The exit code is 1 if it is proved that no branch has the letters, or that
        the sheet does not start to fold with them. Raises the errors of `read_any`, `triangles` and
        `match`, and `UsageError` if the letters do not fit the folds or the file has none.
        """
        if self.periodic and self.direction is not None:
            raise UsageError("give --direction, or --periodic for rigid panels")
        if self.periodic or self.direction is not None or is_cell_file(located(self.file)):
            return self._periodic()
        if self.cell is not None:
            raise UsageError("--cell goes with --direction or --periodic")
        begin = time.perf_counter()
        clock = Clock(self.limit)
        nearest = None
        with Bar("reading") as bar:
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=self.as_json)
            letters = self._letters(opened.sheet, opened)
            if isinstance(opened.sheet, PanelPattern) or opened.sheet.Ve > 4:
                popping = isinstance(opened.sheet, CreasePattern) and can_pop(opened.sheet)
                if popping and not opened.doubt and not open_vertices(opened, letters):
                    over = match_boundary(
                        opened.sheet, letters, most=self.most or _RIMS, progress=bar
                    )
                    if over.status is PROVED:
                        over = replace(over, meant=opened.meant)
                        self._write(over, bar)
                        bar.close()
                        return self._over_a_boundary(over)
                started = match_panels(opened, letters, progress=bar, clock=clock)
                self._write(started, bar)
                bar.close()
                return self._started(started)
            pattern = triangles(opened, "match")
            _in_reach(pattern)
            bar("signs")
            matched = match(pattern, letters, most=self.most or MOST, progress=bar)
            nearly = open_vertices(opened, letters)
            nearly = nearly or nearly_among((ray.branch for ray in matched), opened)
            if nearly:
                say(f"warning: {nearly}")
            matched = matched.about(opened.meant, nearly)
            if not matched.matches and not opened.doubt and not nearly:
                bar("nearest branches")
                nearest = nearest_branches(matched, tries=self.tries, progress=bar)
            self._write(matched, bar)
        seconds = time.perf_counter() - begin
        if self.as_json:
            near = None if nearest is None else nearest.to_dict()
            print(json.dumps(matched.to_dict(name_of(self.file), nearest=near, seconds=seconds)))
        else:
            from exactfold.app import report

            report.show(report.match_report(matched, nearest, seconds, everything=self.everything))
        refuted = matched.status is PROVED and not matched.matches
        return EXIT[REFUTED if refuted else matched.status]

    def _periodic(self) -> int:
        """Whether a periodic sheet starts to fold with the letters."""
        from exactfold.branches.periodic.counting import count_periodic
        from exactfold.panels.periodic.modes import count_panel_cell

        if self.certificate is not None:
            raise UsageError("the letters of a periodic sheet have no certificate")
        given = None if self.letters in (None, DRAWN) else self.letters
        with Bar("reading") as bar:
            if given is None:
                cell, drawn = asked_cell_with_letters(
                    self.file, self.reading, self.cell, verbose=self.verbose
                )
                if not drawn:
                    raise UsageError(
                        f"{name_of(self.file)}: the cell has no letters: give them with --letters"
                    )
            else:
                cell = asked_cell(self.file, self.reading, self.cell, verbose=self.verbose)
                text = given.removeprefix("@")
                drawn, given = {}, read_text(text) if given != text else text
            bar("solving")
            if self.direction is None:
                panels = count_panel_cell(cell, limit=self.limit)
                folds, direction = panels.folds, None
                letters = _in_order(given, drawn, folds)
                answer, ways = panels.with_letters(letters)
            else:
                rolled = count_periodic(cell, self.direction, limit=self.limit, progress=bar)
                folds, direction = cell.edges, list(rolled.direction)
                letters = _in_order(given, drawn, folds)
                answer, ways = rolled.with_letters(letters)
        if self.as_json:
            document: PeriodicMatchDocument = {
                "format": "exactfold periodic-match result",
                "version": 1,
                "name": name_of(self.file),
                "letters": letters,
                "folds": [list(fold) for fold in folds],
                "direction": direction,
                "starts": str(answer),
                "ways": list(ways),
            }
            print(json.dumps(document))
        else:
            from exactfold.app import report

            report.show(report.letters_report(answer, ways, letters))
        return EXIT[answer]

    def _write(self, answer: Match | BoundaryMatch | PanelMatch, bar: Bar) -> None:
        if self.certificate is None:
            return
        if answer.status is not PROVED:
            say("no certificate was written: the answer is not proved")
            return
        bar("certificate")
        try:
            certificate = match_certificate(answer)
        except NotApplicableError as error:
            say(f"no certificate was written: {error}")
        else:
            write_certificate(certificate, self.certificate)

    def _over_a_boundary(self, boundary_match: BoundaryMatch) -> int:
        """Print whether a sheet with more corners starts to fold; return the exit code."""
        if self.as_json:
            print(json.dumps(boundary_match.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.boundary_match_report(boundary_match, everything=self.everything))
        return EXIT[boundary_match.starts]

    def _started(self, panel_match: PanelMatch) -> int:
        """Print whether rigid panels start to fold; return the exit code."""
        if self.as_json:
            print(json.dumps(panel_match.to_dict(name_of(self.file))))
        else:
            from exactfold.app import report

            report.show(report.panel_match_report(panel_match, everything=self.everything))
        return EXIT[panel_match.starts]

    def _letters(self, pattern: CreasePattern | PanelPattern, opened: Opened) -> Mapping[Edge, str]:
        if self.letters in (None, DRAWN):
            if opened.letters:
                return opened.letters
            raise UsageError(
                f"{name_of(self.file)}: the file assigns mountain or valley to no fold: give "
                "letters with --letters"
            )
        return given_letters(pattern, self.letters)


def _in_order(given: str | None, drawn: Mapping[Side, str], folds: Sequence[Side]) -> str:
    """The letters of the folds of a cell: those that are given, or else those of the drawing."""
    if given is None:
        return "".join(drawn.get(fold, "U") for fold in folds)
    return "".join(given.split())


def _in_reach(pattern: CreasePattern) -> None:
    if pattern.interior and pattern.Ve == 3:
        raise NotCountedError(
            "match needs a sheet that can fold, and this one is rigid: it has only three boundary "
            "vertices"
        )
