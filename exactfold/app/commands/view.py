"""`exactfold view` and `serve`: write or serve the page that shows a sheet and its ways to fold."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.text import Text

from exactfold._support.plurals import counted, visible
from exactfold._support.processes import available_cores
from exactfold._support.verdict import PROVED
from exactfold.app.options.pictures import ServeOptions, ViewOptions
from exactfold.app.report.terminal import show
from exactfold.app.shell.patterns import located, read_any
from exactfold.app.shell.shell import Bar, apart, interruptible, name_of, say, tell
from exactfold.app.viewer.page import checked_page, write_view
from exactfold.errors import UsageError
from exactfold.pattern.reading import Reading


class Wanted(ViewOptions):
    """The options of one call, and how they are answered."""

    def run(self) -> None:
        """Write the page and say where, or serve it until Ctrl-C.

        Raises the errors of `read_any`, `write_view` and `view_server`.
        """
        name = "sheet" if str(self.file) == "/dev/stdin" else self.file.stem
        output = self.output or Path(f"{name}.view.html")
        if self.serve:
            sheet, port = located(self.file), self.port or 0
            how = {"branches": self.branches, "frames": self.frames, "proving": self.proving}
            serve(sheet, visible(name), self.reading, port=port, **how)
            return
        apart(output, self.file)
        checked_page(output)  # before the work
        with Bar("reading") as bar, interruptible():
            document = write_view(
                read_any(self.file, self.reading),
                output,
                name=visible(name),
                branches=self.branches,
                frames=self.frames,
                proving=self.proving,
                workers=self.workers or available_cores(),
                progress=bar,
            )
        show(Text(document["answer"]))
        tell(f"written: {name_of(output)}, with {_contents(document)}")


class Served(ServeOptions):
    """The options of one call of `exactfold serve`, and how they are answered."""

    def run(self) -> None:
        """Serve the page until Ctrl-C; raises the errors of `located` and `view_server`."""
        name = "" if self.file is None else self.file.stem
        sheet = None if self.file is None else located(self.file)
        serve(sheet, name, self.reading, port=self.port or 0, limit=float(self.limit))


def serve(sheet: Path | None, name: str, reading: Reading, **how: Any) -> None:
    """Serve the page with a sheet, or without one, until Ctrl-C."""
    from exactfold.app.serving import view_server

    try:
        server = view_server(sheet, name=visible(name), reading=reading, **how)
    except OSError as error:
        raise UsageError(f"port {how.get('port', 0)}: {error.strerror}") from None
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
    if document["kind"] == "branches":
        return counted(len(ways), "branch")
    folding = sum(way["motion"] is not None for way in ways)
    left = len(ways) - folding
    text = counted(folding, "way") + " to fold"
    if not left and document["status"] == str(PROVED) and not document["complete"]:
        return f"{text}, those of which a motion is known"
    return f"{text}, and {counted(left, 'mode')} not followed" if left else text
