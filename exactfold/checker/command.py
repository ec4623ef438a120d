"""The command that checks a certificate: it finds the kind of the file and prints a verdict."""

from __future__ import annotations

import json
import re
import sys
import traceback
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from io import BytesIO
from os import PathLike
from typing import Any

from .branches.branch import BRANCH
from .branches.compact import COMPACT
from .branches.connected_components import PIECES
from .branches.listing import LISTING
from .branches.periodic import PERIODIC
from .branches.torques import BRANCH_TORQUES
from .core.kinds import DocumentKind, LineKind, Verified
from .core.limits import MOST_BYTES, MOST_LINE
from .core.lines import lines, read_object
from .core.parts import Engine
from .core.reading import (
    CertificateError,
    FormatError,
    LimitError,
    UnfinishedError,
    at_most,
    plain,
    read_json,
)
from .layers.counted import FLAT_COUNT
from .layers.refuted import FLAT_REFUTED
from .layers.state import FLAT_STATE
from .letters.assignments import ASSIGNMENTS
from .letters.letters import LETTERS
from .letters.panels import PANEL_LETTERS
from .letters.panels_freedom import PANEL_FREEDOM
from .letters.panels_listed import PANEL_ASSIGNMENTS
from .motion.certificate import MOTION
from .motion.loops import LOOPS
from .motion.panels.certificate import PANEL_MOTION
from .panels.cell import PANEL_CELL
from .panels.certificate import PANELS
from .panels.torques import PANEL_TORQUES
from .sheets.meant import MEANT
from .tolerance.certificate import TOLERANCE

USAGE = "usage: python exactfold/checker CERTIFICATE [WORKERS]"

DOCUMENTS: tuple[DocumentKind[Any], ...] = (
    LISTING,
    BRANCH,
    PIECES,
    PERIODIC,
    PANELS,
    PANEL_CELL,
    LETTERS,
    ASSIGNMENTS,
    PANEL_LETTERS,
    PANEL_ASSIGNMENTS,
    PANEL_FREEDOM,
    PANEL_TORQUES,
    BRANCH_TORQUES,
    MOTION,
    PANEL_MOTION,
    TOLERANCE,
    MEANT,
    FLAT_STATE,
    FLAT_REFUTED,
    FLAT_COUNT,
)
"""The kinds with one JSON object in each file."""

IN_LINES: tuple[LineKind[Any], ...] = (COMPACT, LOOPS)
"""The kinds whose files are written line by line."""

KINDS = (*DOCUMENTS, *IN_LINES)

_PRINTED = re.compile("exactfold ([a-z-]+) result")

_ADVICE = defaultdict(
    lambda: "give a certificate: count and branch write one with --certificate",
    {
        "count": "write a certificate with --certificate or --stream",
        "count-stream": "check the file that --stream wrote",
        "batch-line": "count one pattern with --certificate or --stream",
        "branch": "write a certificate with --certificate",
    },
)
"""What the user should give instead of a printed result, by the kind of this result."""


def load(text: str) -> dict[str, Any]:
    """Read a certificate that is one JSON object; raises `FormatError`."""
    try:
        data = read_json(text)
        return _kind_of(data).read(data)
    except FormatError as error:
        raise FormatError(_stranger(text) or error) from None


def check(
    data: dict[str, Any] | tuple[str, ...],
    workers: int = 1,
    engine_of: Callable[[LineKind[Any]], Engine] = lambda kind: kind.engine,
) -> Verified[Any]:
    """Verify every claim of a certificate, given its JSON object or the texts of its lines.

    `workers` and `engine_of` are used for lines only, as in `verify`. Raises `CertificateError` at
    the first claim that is not supported, and `FormatError` if the object, or the first line, does
    not belong to a known kind, in a known version.
    """
    if isinstance(data, tuple):
        in_lines = _kind_in_lines(data[0] if data else "{}")
        return Verified(in_lines, in_lines.check(iter(data), workers, engine_of(in_lines)))
    kind = _kind_of(data)
    return Verified(kind, kind.check(kind.read(data)))


def _kind_of(data: Any) -> DocumentKind[Any]:
    """The kind of a JSON object.

    The kind follows from the object's "format". If several kinds share this format, the object's
    "kind" tells them apart.
    """
    document = data if isinstance(data, dict) else {}
    kinds = [kind for kind in DOCUMENTS if kind.format == document.get("format")]
    if not kinds:
        raise FormatError('the object has no "format" that this checker knows')
    named = document.get("kind")
    for kind in kinds:
        if kind.named == named:
            return kind
    raise FormatError(f"the kind {named!a} is not known to this checker")


def verify(
    path: str | PathLike[str],
    workers: int = 1,
    engine_of: Callable[[LineKind[Any]], Engine] = lambda kind: kind.engine,
) -> Verified[Any]:
    """Verify every claim of a certificate of any kind.

    If the certificate is written line by line, `workers` processes share its lines. The first line
    shows the kind, and `engine_of(kind)` is the engine that verifies the lines. Raises
    `CertificateError` if a claim is not supported, `FormatError` if the file is not a certificate,
    `OSError` if it cannot be read, and `BrokenExecutor` if a process died.
    """
    with open(path, "rb") as stream:
        first = stream.readline(MOST_LINE)
        if _sealed(first):
            kind = _kind_of_file(first)
            return Verified(kind, kind.check(lines(stream, first), workers, engine_of(kind)))
        try:
            text = (first + stream.read(MOST_BYTES + 1 - len(first))).decode()
        except UnicodeDecodeError as error:
            raise FormatError(error) from None
    at_most(len(text), MOST_BYTES, "the bytes of the file", "MOST_BYTES")
    return check(load(text))


def kind_in_lines(path: str | PathLike[str]) -> LineKind[Any] | None:
    """The kind of a file that is written in lines; None for any other file; raises `OSError`."""
    with open(path, "rb") as stream:
        first = stream.readline(MOST_LINE)
    try:
        return _kind_of_file(first) if _sealed(first) else None
    except FormatError:
        return None


def _sealed(line: bytes) -> bool:
    """Whether a line ends with a tab and a digest, as in certificates that are written in lines."""
    return re.fullmatch(rb"[0-9a-f]{64}\n", line.rpartition(b"\t")[2]) is not None


def _kind_of_file(first: bytes) -> LineKind[Any]:
    """The kind of a certificate in lines, by the bytes of its first line; raises `FormatError`."""
    (text,) = lines(BytesIO(first))
    return _kind_in_lines(text)


def _kind_in_lines(text: str) -> LineKind[Any]:
    """The kind of a certificate in lines, by the "format" in its first line's text.

    Raises `FormatError`.
    """
    form = read_object(text, "the first line").get("format")
    for kind in IN_LINES:
        if kind.format == form:
            return kind
    raise FormatError('the first line has no "format" of a certificate that is written in lines')


def _stranger(text: str) -> str | None:
    """What a file is that is not a certificate, for files that people often mistake for one.

    None for any other file.
    """
    try:
        data, end = json.JSONDecoder().raw_decode(text.lstrip())
    except (ValueError, RecursionError):
        return None
    if not isinstance(data, dict):
        return None
    if data.get("format") in [kind.format for kind in IN_LINES]:
        return "line 1 is cut off or was altered"
    if data.keys() & {"vertices_coords", "faces_vertices", "edges_vertices", "file_spec"}:
        return "this is a FOLD file, which is a crease pattern and not a certificate"
    several = bool(text.lstrip()[end:].strip())
    kind = _PRINTED.fullmatch(str(data.get("format")))
    if kind is None:
        return None
    return f"this is {_printed(kind[1], several)}, and not a certificate; {_ADVICE[kind[1]]}"


def _printed(kind: str, several: bool) -> str:
    """Which command printed a result of this kind; `several` results may stand in one file."""
    if kind == "batch-line" or (several and kind.startswith("count")):
        return "a file of results, as count --jsonl writes it"
    if kind == "error":
        return "an error that a command printed with --json"
    command = "count" if kind in ("count-stream", "batch") else kind
    return f"the result printed by {command} --json"


def summary(verified: Verified[Any]) -> str:
    """One line that states the verified claims."""
    return verified.kind.summary(verified.claims)


def refusal(error: CertificateError) -> str:
    """One line that says which claim of a file does not hold, or that the file is not finished."""
    unfinished = isinstance(error, UnfinishedError)
    return f"{'UNFINISHED' if unfinished else 'INVALID'}: {plain(error)}"


def main(arguments: list[str]) -> int:
    """Check one file, print the verdict, and return the exit code.

    0: every claim holds. 1: some claim is not supported, or the file is not finished. 2: the
    arguments are wrong. 3: the file is not a certificate, or asks for more than the limits allow.
    70: a worker process died, memory is short, or this program has a defect.
    """
    workers = arguments[1] if len(arguments) == 2 else "1"
    usable = workers.isascii() and workers.isdecimal() and len(workers) < 5
    if len(arguments) not in (1, 2) or not usable:
        print(USAGE, file=sys.stderr)
        return 2
    try:
        verified = verify(arguments[0], int(workers))
    except CertificateError as error:
        print(refusal(error))
        return 1
    except LimitError as error:
        print(plain(error), file=sys.stderr)
        return 3
    except (FormatError, OSError) as error:
        print(f"not a certificate: {plain(error)}", file=sys.stderr)
        return 3
    except (BrokenExecutor, MemoryError):
        message = "a worker process died, or memory is short: nothing is known of the file"
        print(message, file=sys.stderr)
        return 70
    except Exception:  # a defect of this program must not end with one of the other codes
        traceback.print_exc()
        return 70
    print(summary(verified))
    return 0
