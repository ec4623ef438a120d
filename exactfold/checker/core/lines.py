"""Files of lines: each is chained to the one before it by a digest."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator
from typing import IO, Any

from .limits import MOST_LINE
from .reading import FormatError, read_json


def digest(previous: str, body: str) -> str:
    """The digest of a line: SHA-256 of the digest before it and its JSON text."""
    return hashlib.sha256((previous + body).encode()).hexdigest()


def chained(texts: Iterable[str]) -> str:
    """The file with these JSON texts as its lines, each with its digest."""
    previous, found = "", []
    for text in texts:
        previous = digest(previous, text)
        found.append(f"{text}\t{previous}\n")
    return "".join(found)


def lines(stream: IO[bytes], first: bytes = b"") -> Iterator[str]:
    """The JSON texts of a file, one a line; raises `FormatError` where the chain breaks.

    `first` is the first line, if it has been read from the stream already.
    """
    previous, number = "", 0
    while raw := first or stream.readline(MOST_LINE):
        first, number = b"", number + 1
        body, _, found = raw.partition(b"\t")
        text = body.decode("ascii", "replace")
        previous = digest(previous, text)
        if not body.isascii() or found != f"{previous}\n".encode():
            raise FormatError(f"line {number} is cut off or was altered")
        yield text


def read_object(text: str, what: str) -> dict[str, Any]:
    """One JSON object without floats or repeated keys."""
    try:
        data = read_json(text)
    except FormatError as error:
        raise FormatError(f"{what}: {error}") from None
    if not isinstance(data, dict):
        raise FormatError(f"{what} is not an object")
    return data
