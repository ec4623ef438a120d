"""Certificates that are written in lines: a digest chains each line to the line before it."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from typing import IO, Any

from .limits import MOST_LINE
from .reading import FormatError, read_json


def digest(previous: str, body: str) -> str:
    """The digest of a line: SHA-256 of the previous line's digest followed by the JSON text."""
    return hashlib.sha256((previous + body).encode()).hexdigest()


def chained(texts: Iterable[str]) -> str:
    """The contents of a file: each JSON text on one line, with its digest."""
    previous, rows = "", []
    for text in texts:
        previous = digest(previous, text)
        rows.append(f"{text}\t{previous}\n")
    return "".join(rows)


def lines(stream: IO[bytes], first: bytes = b"") -> Iterator[str]:
    """Yield the JSON text of each line; raises `FormatError` where the chain of digests breaks.

    `first` is the first line, if the caller has already read it from the stream.
    """
    previous, number = "", 0
    while raw := first or stream.readline(MOST_LINE):
        first, number = b"", number + 1
        body, _, tail = raw.partition(b"\t")
        text = body.decode("ascii", "replace")
        previous = digest(previous, text)
        if not body.isascii() or tail != f"{previous}\n".encode():
            raise FormatError(f"line {number} is cut off or was altered")
        yield text


def read_object(text: str, what: str) -> dict[str, Any]:
    """Read one JSON object; floats and repeated keys are refused with `FormatError`."""
    try:
        data = read_json(text)
    except FormatError as error:
        raise FormatError(f"{what}: {error}") from None
    if not isinstance(data, dict):
        raise FormatError(f"{what} is not an object")
    return data
