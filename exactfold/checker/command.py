"""One command for certificates of every kind: which kind a file is, and what its check says."""

from __future__ import annotations

import json
import re
import sys
import traceback
from collections import defaultdict
from concurrent.futures import BrokenExecutor
from contextlib import suppress
from io import BytesIO
from os import PathLike
from types import ModuleType
from typing import Any

from .branches import branch, compact, listing
from .branches import connected_components as pieces
from .core.formats import (
    ASSIGNMENTS,
    BRANCH,
    COMPACT,
    LETTERS,
    LISTING,
    LOOPS,
    MOTION,
    PANEL_LETTERS,
    PANEL_MOTION,
    PIECES,
)
from .core.limits import MOST_BYTES, MOST_LINE
from .core.lines import lines
from .core.reading import (
    CertificateError,
    FormatError,
    LimitError,
    UnfinishedError,
    at_most,
    plain,
    read_json,
)
from .letters import assignments, letters
from .letters import panels as panel_letters
from .motion import certificate as motion
from .motion import loops as motion_loops
from .motion.panels import certificate as panel_motion
from .panels import certificate as panels

USAGE = "usage: python exactfold/checker CERTIFICATE [WORKERS]"

_COMPACT = re.compile(rb'"format"\s*:\s*"' + COMPACT.encode() + b'"')
_LOOPS = re.compile(rb'"format"\s*:\s*"' + LOOPS.encode() + b'"')

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
"""What to give instead, by the kind of result."""


def load(text: str) -> dict[str, Any]:
    """The JSON object of a certificate of any kind but the compact; raises `FormatError`."""
    try:
        data = read_json(text)
        known: dict[str, Any] = _reader(data if isinstance(data, dict) else {}).read(data)
        return known
    except LimitError:
        raise
    except FormatError as error:
        raise FormatError(_stranger(text) or error) from None


def check(data: dict[str, Any] | tuple[str, ...]) -> dict[str, Any]:
    """Verify every claim of a certificate: a JSON object, or the lines of a compact certificate.

    Returns the claims; raises `CertificateError` at the first that is not supported.
    """
    if isinstance(data, tuple):
        return compact.check_lines(iter(data))
    claims: dict[str, Any] = _reader(data).check(data)
    return claims


_READERS = {
    ASSIGNMENTS: assignments,
    BRANCH: branch,
    LETTERS: letters,
    MOTION: motion,
    PANEL_LETTERS: panel_letters,
    PANEL_MOTION: panel_motion,
    PIECES: pieces,
}
"""The modules of formats that are a JSON object; `LISTING` has two more."""


def _reader(data: dict[str, Any]) -> ModuleType:
    """The module that reads and checks a JSON object."""
    found = _READERS.get(str(data.get("format")))
    if found is not None:
        return found
    if data.get("format") == LISTING and "kind" in data:
        return panels
    return listing


def verify(
    path: str | PathLike[str], workers: int = 1, engine: compact.Engine = compact.INTEGERS
) -> dict[str, Any]:
    """Verify every claim of a certificate of any kind; returns the claims.

    `workers` processes share the blocks of a compact certificate, which `engine` verifies, and the
    loops of a certificate of these. Raises `CertificateError` if a claim is not supported,
    `FormatError` if the file is no certificate, `OSError`, `BrokenExecutor` if a process died.
    """
    with open(path, "rb") as stream:
        first = stream.readline(MOST_LINE)
        if _LOOPS.search(first[:4096]):
            return motion_loops.check_lines(lines(stream, first), workers, engine.share)
        if _is_compact(first):
            return compact.check_lines(lines(stream, first), workers, engine)
        try:
            text = (first + stream.read(MOST_BYTES + 1 - len(first))).decode()
        except UnicodeDecodeError as error:
            raise FormatError(error) from None
    at_most(len(text), MOST_BYTES, "the bytes of the file")
    return check(load(text))


def is_compact(path: str | PathLike[str]) -> bool:
    """Whether a file is a compact certificate, to go by its first line; raises `OSError`."""
    with open(path, "rb") as stream:
        return _is_compact(stream.readline(MOST_LINE))


def _is_compact(first: bytes) -> bool:
    """By its format, else by its digest."""
    if _COMPACT.search(first[:4096]):
        return True
    if _LOOPS.search(first[:4096]):
        return False
    with suppress(FormatError):
        return b"\t" in first and next(lines(BytesIO(first)), None) is not None
    return False


def _stranger(text: str) -> str | None:
    """What a file that is no certificate is, if it is one of those that are taken for one."""
    try:
        data, end = json.JSONDecoder().raw_decode(text.lstrip())
    except (ValueError, RecursionError):
        return None
    if not isinstance(data, dict):
        return None
    if data.keys() & {"vertices_coords", "faces_vertices", "edges_vertices", "file_spec"}:
        return "this is a FOLD file, a crease pattern and no certificate"
    several = bool(text.lstrip()[end:].strip())
    kind = _PRINTED.fullmatch(str(data.get("format")))
    if kind is None:
        return None
    return f"this is {_printed(kind[1], several)}, and not a certificate; {_ADVICE[kind[1]]}"


def _printed(kind: str, several: bool) -> str:
    """What printed a result."""
    if kind == "batch-line" or (several and kind.startswith("count")):
        return "a file of results, as count --jsonl writes it"
    if kind == "error":
        return "an error that a command printed with --json"
    command = "count" if kind in ("count-stream", "batch") else kind
    return f"the result printed by {command} --json"


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    if "assignments" in claims:
        return assignments.summary(claims)
    if "supports" in claims:
        return panels.summary(claims)
    if "loops" in claims:
        return motion_loops.summary(claims)
    if "starts" in claims:
        return panel_letters.summary(claims)
    if "halves" in claims:
        return letters.summary(claims)
    if "at_most" in claims:
        return pieces.summary(claims)
    if "drivers" in claims:
        return panel_motion.summary(claims)
    if "tubes" in claims:
        return motion.summary(claims)
    return branch.summary(claims) if "gauge" in claims else listing.summary(claims)


def refusal(error: CertificateError) -> str:
    """One line for a file whose claims do not all hold, or that is not finished."""
    unfinished = isinstance(error, UnfinishedError)
    return f"{'UNFINISHED' if unfinished else 'INVALID'}: {plain(error)}"


def main(arguments: list[str]) -> int:
    """Check one file and print the verdict; the exit code.

    0: every claim holds; 1: some claim is not supported, or the file is not finished; 2: wrong
    usage; 3: not a certificate, or one beyond the limits; 70: a worker process died, memory is
    short, or a defect of this program.
    """
    workers = arguments[1] if len(arguments) == 2 else "1"
    usable = workers.isascii() and workers.isdecimal() and len(workers) < 5
    if len(arguments) not in (1, 2) or not usable:
        print(USAGE, file=sys.stderr)
        return 2
    try:
        claims = verify(arguments[0], int(workers))
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
    except Exception:  # never to be read as one of the other codes
        traceback.print_exc()
        return 70
    print(summary(claims))
    return 0
