"""`exactfold draw`: draws a crease pattern, one way to fold it, or all ways."""

from __future__ import annotations

import sys
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from exactfold._support.clock import LIMIT
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.app.commands.cells import asked_cell
from exactfold.app.options.choosing import choice_of
from exactfold.app.options.pictures import DrawOptions
from exactfold.app.pictures.crease_drawing import pattern_picture
from exactfold.app.pictures.drawn_ways import branch_way
from exactfold.app.pictures.folded import Amount, Folded, folded
from exactfold.app.pictures.multiples import MOST
from exactfold.app.pictures.picture_files import checked_picture, write_picture
from exactfold.app.pictures.way_sheets import number_listed, sheet_of_ways, why_no_way
from exactfold.app.shell.given import Given
from exactfold.app.shell.patterns import located, read_any, verdict
from exactfold.app.shell.shell import EXIT, STDIN, Bar, apart, say, sheet_written, wrote
from exactfold.app.verbs.choosing import choose
from exactfold.app.verbs.chosen import ChosenBranch, ChosenPanels
from exactfold.app.verbs.moving import along, along_panels
from exactfold.app.verbs.showing import drawn_panels
from exactfold.branches.counting.ways import count_opened, decompose_opened
from exactfold.branches.values.result import BranchCount
from exactfold.errors import (
    FoldError,
    NotCountedError,
    PatternError,
    SeveralSheetsError,
    UndecidedBranchError,
    UsageError,
)
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.drawing import Drawing
from exactfold.pattern.opening import Opened, has_branches, is_cell_file

if TYPE_CHECKING:
    from exactfold.panels.result import Decomposition


class Wanted(DrawOptions):
    """The options of one call, and how they are answered."""

    @property
    def given(self) -> Given:
        """The file with boundary heights."""
        return Given(self.boundary_heights)

    @cached_property
    def amount(self) -> Amount | None:
        """How far the sheet is folded in the picture; None if it is drawn flat."""
        return None if self.folded is None else Amount.of(self.folded)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.amount  # noqa: B018 - a bad value raises before the work

    def answer(self) -> int:
        """Draw, write the picture, say where, and return the exit code.

        The exit code is 4 if the drawn way is not proved. Without `output`, the picture goes to
        standard output, or to a new file if standard output is a terminal. Raises the errors of
        `read_any`, `choose`, `count_opened`, `along`, `along_panels` and `write_picture`.
        """
        target = self._target()
        if target is not None:
            checked_picture(target)  # before the work
            apart(target, self.file)
        with Bar("reading") as bar:
            try:
                text, status, what = self._drawn(bar)
            except UndecidedBranchError as error:
                say(f"not drawn: {error}")
                return EXIT[UNDECIDED]
            bar("writing")
            if target is not None:
                write_picture(text, target)
        if target is None:
            sys.stdout.write(text)
        else:
            wrote(target, what)
        return EXIT[status]

    def _target(self) -> Path | None:
        """The file to write; None for standard output."""
        if self.output is not None:
            return None if str(self.output) == "-" else self.output
        if not on_a_terminal():
            return None
        if self.direction:
            kind = "directions"
        else:
            kind = "ways" if self.everything else "drawn" if self._is_plain else "way"
        return Path(f"{self._title or 'pattern'}-{kind}.svg")

    @property
    def _title(self) -> str:
        return "" if self.file == STDIN else self.file.stem

    @property
    def _first(self) -> int:
        """The number of ways that are drawn on one page."""
        return MOST if self.most is None else self.most

    @property
    def _is_plain(self) -> bool:
        return not self.is_named and not self.everything

    def _drawn(self, bar: Bar) -> tuple[str, Verdict, str]:
        """The picture, the verdict on the way that it shows, and what it shows in words."""
        if self.direction is not None:
            return self._directions(bar)
        if is_cell_file(located(self.file)):
            raise UsageError(f"{self.file} is the cell of a periodic sheet: give --direction all")
        try:
            opened = read_any(self.file, self.reading, verbose=self.verbose)
        except (FoldError, PatternError, SeveralSheetsError) as error:
            if not self._is_plain or self.sheet is not None:
                raise
            drawing = self._raw()
            if drawing is None:
                raise
            say(f"drawn as it is, because it is not a sheet that can be counted: {error}")
            lines = counted(len(drawing.lines), "line")
            return pattern_picture(drawing, title=self._title), PROVED, f"{lines}, no sheet"
        what = sheet_written(opened.sheet)
        if self._is_plain:
            picture = pattern_picture(opened.sheet, opened.assignment, title=self._title)
            return picture, PROVED, what
        text, status = self._way(opened, bar)
        return text, verdict(opened, status), what

    def _directions(self, bar: Bar) -> tuple[str, Verdict, str]:
        """The branches of a periodic sheet over the circle of directions."""
        from exactfold.app.pictures.directions_plot import FIRST, directions_plot
        from exactfold.branches.periodic.directions import count_directions

        cell = asked_cell(self.file, self.reading, self.cell, verbose=self.verbose)
        bar("solving")
        result = count_directions(cell, limit=LIMIT, progress=bar)
        if result.status is not PROVED:
            say(f"the crossings are not all known: {result.reason}")
        text = directions_plot(result, self._title, self.most or FIRST, bar)
        return text, result.status, f"a periodic sheet, {counted(cell.V, 'vertex')} in the cell"

    def _way(self, opened: Opened, bar: Bar) -> tuple[str, Verdict]:
        """The picture of the ways that were named, and the verdict on them."""
        if self.everything:
            return self._all(opened, bar)
        bar("solving")
        chosen = choose(opened, choice_of(self, opened, self.given, side=self.side), bar)
        if isinstance(chosen, ChosenBranch):
            return self._branch(chosen, bar)
        return self._panels(chosen, bar)

    def _raw(self) -> Drawing | None:
        """The drawing in a file that is not a sheet; None if there is none.

        Standard input cannot be read twice, so it gives None, too.
        """
        from exactfold.pattern.drawing.formats.read import read_drawing

        if self.file == STDIN:
            return None
        try:
            return read_drawing(located(self.file), self.reading.svg)
        except (FoldError, PatternError):
            return None

    # --- ways ------------------------------------------------------------------------------------

    def _branch(self, chosen: ChosenBranch, bar: Bar) -> tuple[str, Verdict]:
        branch = chosen.branch
        if branch.status is not PROVED:
            say(f"the branch is not proved: {branch.reason}")
        if self.amount is None:
            way = branch_way(branch, chosen.number).turned(chosen.side)
            return way.picture(self._title), branch.status
        bar("following")
        motion = along(chosen, progress=bar)
        return self._folded(folded(motion, self.amount, self._title)), branch.status

    def _panels(self, chosen: ChosenPanels, bar: Bar) -> tuple[str, Verdict]:
        """The picture of a way of panels, and the verdict on whether it provably folds."""
        warning = chosen.answer.known.warning
        if warning is not None:
            say(f"warning: {warning}")
        way = drawn_panels(chosen)
        verdict = PROVED if chosen.way is None else chosen.way.verdict
        if self.amount is None:
            if chosen.way is not None and verdict is not PROVED:
                say(chosen.way.why_not_followed)
            return way.picture(self._title), verdict
        bar("following")
        return self._folded(folded(along_panels(chosen), self.amount, self._title)), verdict

    def _folded(self, still: Folded) -> str:
        if not still.reached:
            say(
                f"the sheet folds only to {still.degrees:.1f} degrees, where its motion ends "
                f"({still.end}): it is drawn there"
            )
        return still.text

    def _counted(self, opened: Opened, bar: Bar) -> BranchCount | Decomposition:
        bar("solving")
        if isinstance(opened.sheet, CreasePattern) and has_branches(opened.sheet):
            return count_opened(opened, progress=bar).known
        # triangulated sheets, too: their modes can be drawn
        ways = decompose_opened(opened, progress=bar).known
        if ways.warning is not None:
            say(f"warning: {ways.warning}")
        return ways

    def _all(self, opened: Opened, bar: Bar) -> tuple[str, Verdict]:
        """The picture of all listed ways, each of them small, and the verdict on the count."""
        result = self._counted(opened, bar)
        bar("drawing")
        number = number_listed(result)
        if not number:
            raise NotCountedError(f"{why_no_way(result)}: draw the pattern without --all")
        if number > self._first:
            say(f"the first {self._first} of {number} are drawn: --most N draws more")
        return sheet_of_ways(result, self._title, self._first), result.status


def on_a_terminal() -> bool:
    """Whether standard output is a terminal, which would show a picture as text."""
    return sys.stdout.isatty()
