"""Opens the pattern that the command line names: a file, `-`, or a shipped example."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from exactfold._support.plurals import either
from exactfold._support.verdict import UNDECIDED, Verdict
from exactfold.app.shell.shell import STDIN, said, say, tell
from exactfold.errors import UnreadableFileError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.data import CELLS, EXAMPLES, cell_path, example_path
from exactfold.pattern.near_degeneracy import near_degenerate
from exactfold.pattern.opening import Opened, open_pattern, triangles
from exactfold.pattern.reading import PLAIN, Reading

_NEAR = 0.6
"""How similar a name must be to that of a shipped pattern that is meant, from 0 to 1."""


@dataclass(frozen=True)
class Triangulated:
    """A triangulated sheet, and the record of how it was read."""

    pattern: CreasePattern
    opened: Opened


def located(path: Path) -> Path:
    """The file for a path or for the name of a shipped example.

    Raises `UnreadableFileError` for a bare name that is neither a file nor an example.
    """
    name = str(path)
    if name in EXAMPLES:
        return example_path(name)
    if name in CELLS:
        return cell_path(name)
    if path == STDIN or path.exists() or path.suffix or len(path.parts) != 1:
        return path  # reading raises an error that says what is wrong
    near = get_close_matches(name.lower(), (*EXAMPLES, *CELLS), cutoff=_NEAR)
    known = f"did you mean {either(near)}?" if near else f"shipped are {', '.join(EXAMPLES)}"
    raise UnreadableFileError(
        f"{name} is neither a file nor a shipped pattern: {known} (see `exactfold examples`)"
    )


def read(
    path: Path, reading: Reading, needs: str, *, verbose: bool = False, doubted: bool = True
) -> Triangulated:
    """Open a triangulated sheet for the command `needs`, and print warnings as `read_any` does.

    Raises the errors of `located`, `open_pattern` and `triangles`.
    """
    opened = read_any(path, reading, verbose=verbose, doubted=doubted)
    return Triangulated(triangles(opened, needs), opened)


def read_any(
    path: Path, reading: Reading = PLAIN, *, verbose: bool = False, doubted: bool = True
) -> Opened:
    """Open a sheet in any format; print to stderr what was read and repaired, and warnings.

    This is one line, and a line for each thing that nobody should miss; or, with `verbose`, a line
    for each step of reading and each kind of repair.

    The doubt about a sheet is a warning unless `doubted` is False: then the answer says it.

    Raises the errors of `located` and `open_pattern`.
    """
    opened = open_pattern(located(path), reading, name=said(path))
    if opened.brief and not verbose:
        say(f"read {Path(said(path)).name}: {', '.join(opened.brief)}; -v for more")
    for line in opened.lines if verbose else opened.seen:
        say(line)
    if opened.doubt and doubted:
        say(f"warning: {opened.doubt}; --snap exact takes the digits as written")
    elif (
        not opened.doubt
        and isinstance(opened.sheet, CreasePattern)
        and (near := near_degenerate(opened.sheet))
    ):
        say(f"warning: {near.text}")
    return opened


def verdict(opened: Opened, status: Verdict) -> Verdict:
    """The verdict of an answer about the sheet: UNDECIDED if it holds for its digits only."""
    return UNDECIDED if opened.doubt else status


def tell_doubt(opened: Opened) -> None:
    """Print, above an answer that holds for the digits of the sheet only, that it does."""
    if opened.doubt:
        why = f", as {opened.nearly}" if opened.nearly else ""  # the others are said before
        tell(
            f"UNDECIDED for the sheet that was meant{why}; for the digits as written (--snap "
            "exact):\n"
        )


def in_doubt(opened: Opened, document: Mapping[str, object]) -> Mapping[str, object]:
    """The JSON of an answer: undecided, with the doubt, if it holds for its digits only."""
    if not opened.doubt or document["status"] == str(UNDECIDED):
        return document
    known = {"status": str(UNDECIDED)}
    if reason := document.get("reason"):
        known["reason"] = f"{opened.doubt}; the digits as written: {document['status']}, {reason}"
    return {**document, **known}
