"""`exactfold view` and `serve`: write or serve the page of a sheet and its ways to fold."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.text import Text

from exactfold._support.clock import Clock
from exactfold._support.plurals import counted, visible
from exactfold._support.processes import available_cores
from exactfold._support.verdict import PROVED
from exactfold.app.commands.cells import asked_cell
from exactfold.app.options.choosing import choice_of
from exactfold.app.options.pictures import ServeOptions, ViewOptions
from exactfold.app.report.terminal import show
from exactfold.app.shell.patterns import located, read_any
from exactfold.app.shell.shell import Bar, apart, interruptible, say, tell, wrote
from exactfold.app.verbs.choosing import choose
from exactfold.app.verbs.counting import count
from exactfold.app.verbs.showing import shown
from exactfold.app.viewer.checking import PageChecker, page_checker, policy_source
from exactfold.app.viewer.page import checked_page, write_view
from exactfold.app.viewer.rolling import write_rolling_view
from exactfold.certificates.entries import certificate_text
from exactfold.errors import NotApplicableError, UsageError
from exactfold.motion.periodic.patch import CELLS
from exactfold.pattern.opening import Opened, is_cell_file


class Wanted(ViewOptions):
    """The options of one call, and how they are answered."""

    def run(self) -> None:
        """Write the page and say where; raises the errors of `read_any` and `write_view`."""
        name = "sheet" if str(self.file) == "/dev/stdin" else self.file.stem
        output = self.output or Path(f"{name}.view.html")
        apart(output, self.file)
        checked_page(output)  # before the work
        clock = Clock(self.limit)
        if self.direction is not None or is_cell_file(located(self.file)):
            self._rolling(output, visible(name), clock)
            return
        for option, value in (("--patch", self.patch), ("--cell", self.cell)):
            if value is not None:
                raise UsageError(f"{option} goes with --direction X,Y")
        with Bar("reading") as bar, interruptible():
            opened = read_any(self.file, self.reading, verbose=self.verbose, doubted=False)
            document = write_view(
                opened,
                output,
                name=visible(name),
                **self._only(opened, bar),
                frames=self.frames,
                proving=self.proving,
                workers=self.workers or available_cores(),
                limit=clock,
                progress=bar,
                checker=self._checker(opened),
            )
        show(Text(document["answer"]))
        wrote(output, _contents(document))

    def _checker(self, opened: Opened) -> PageChecker | None:
        """The checker for the page, with the certificate of the count; None if not asked for.

        Raises `NotApplicableError` if the count has no certificate.
        """
        if self.pyodide is None:
            return None
        policy_source(self.pyodide)  # before the work
        try:
            certificate = count(opened, limit=self.limit).certificate()
        except NotApplicableError as error:
            reason = f"--with-checker: {error}; without it the page can be written"
            raise NotApplicableError(reason) from None
        return page_checker(certificate_text(certificate), self.pyodide)

    def _rolling(self, output: Path, name: str, clock: Clock) -> None:
        """Write the page of a periodic sheet."""
        if self.direction is None:
            raise UsageError(
                f"{self.file} is the cell of a periodic sheet: give --direction X,Y, across which "
                "it rolls up"
            )
        if self.pyodide is not None:
            raise UsageError("--with-checker does not go with --direction")
        if self.is_named and self.way is None:
            raise UsageError("only --way N, --patch, --frames and --prove go with --direction")
        with Bar("reading") as bar, interruptible():
            cell = asked_cell(self.file, self.reading, self.cell, verbose=self.verbose)
            document = write_rolling_view(
                cell,
                self.direction,
                output,
                name=name,
                ways=None if self.way is None else [self.way],
                cells=self.patch or CELLS,
                frames=self.frames,
                proving=self.proving,
                limit=clock,
                progress=bar,
            )
        show(Text(document["answer"]))
        wrote(output, _contents(document))

    def _only(self, opened: Opened, bar: Bar) -> dict[str, Any]:
        """The way that is shown, as arguments of `write_view`; empty if none was named."""
        if not self.is_named:
            return {}
        return shown(choose(opened, choice_of(self, opened), bar))


class Served(ServeOptions):
    """The options of one call of `exactfold serve`, and how they are answered."""

    def run(self) -> None:
        """Serve the page until Ctrl-C; raises the errors of `located` and `view_server`."""
        from exactfold.app.serving import view_server

        sheet = None if self.file is None else located(self.file)
        name = "" if self.file is None else visible(self.file.stem)
        limit, frames = float(self.limit), self.frames
        try:
            server = view_server(
                sheet,
                name=name,
                reading=self.reading,
                frames=frames,
                port=self.port or 0,
                limit=limit,
            )
        except OSError as error:
            raise UsageError(f"port {self.port or 0}: {error.strerror}") from None
        with server:
            tell(f"{name or 'the page'} is at {server.address} (Ctrl-C ends it)")
            try:
                with interruptible():
                    server.serve_forever(poll_interval=0.2)
            except KeyboardInterrupt:
                say("the server has ended")


def _contents(document: Mapping[str, Any]) -> str:
    """What the page shows besides the pattern, in words."""
    ways = document["ways"]
    if not ways:
        return "the pattern only: no single way to fold is known"
    numbered = [way for way in ways if way["number"]]  # as `count` lists them
    drawn = ", and the motion with the letters of the file" * (0 < len(numbered) < len(ways))
    listed = numbered or ways
    left = sum(way["motion"] is None for way in listed)
    why = " not followed (the page says why)"
    if document["kind"] == "branches":
        return counted(len(listed), "branch") + (f", {left}{why}" if left else "") + drawn
    text = counted(len(listed) - left, "way") + " to fold"
    if left:
        return f"{text}, {counted(left, 'way')}{why}{drawn}"
    if document["status"] == str(PROVED) and not document["complete"] and not drawn:
        return f"{text}, those of which a motion is known"
    return f"{text}{drawn}"
