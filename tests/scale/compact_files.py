"""Compact certificates taken apart and put together again, with right digests whatever they say."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from exactfold import compact_checker
from exactfold.evidence.check import CertificateError, check_compact

Lines = list[dict[str, Any]]


def bodies(data: bytes) -> Lines:
    return [json.loads(line.partition(b"\t")[0]) for line in data.splitlines()]


def chained_texts(texts: list[str]) -> bytes:
    digest, data = "", ""
    for text in texts:
        digest = compact_checker.digest(digest, text)
        data += f"{text}\t{digest}\n"
    return data.encode()


def chained(lines: Lines) -> bytes:
    return chained_texts([json.dumps(line, separators=(",", ":")) for line in lines])


def raw(line: dict[str, Any], key: str) -> bytearray:
    return bytearray(base64.b64decode(line[key]))


def put(line: dict[str, Any], key: str, data: bytes | bytearray) -> None:
    line[key] = base64.b64encode(data).decode()


def listed_exactly(lines: Lines, **changes: Any) -> None:
    """The first root of the file moved to `exact`, as it is but for the changes."""
    chambers = compact_checker.Chambers(lines[0])
    block = chambers.decode(json.dumps(lines[1]), 0)
    entry = {
        "root": 0,
        "bits": block.bits,
        "radius": str(1 << block.radii[0]),
        "center": [str(m) for m in block.center(0, chambers.size)],
        "assignment": chambers.letters(block, 0),
    }
    radii = raw(lines[1], "radii")
    radii[0] = compact_checker.UNPROVED
    put(lines[1], "radii", radii)
    lines[1]["exact"] = [entry | changes]


def refused(data: bytes, path: Path, match: str) -> None:
    path.write_bytes(data)
    for fast in (True, False):
        with pytest.raises(CertificateError, match=match):
            check_compact(path, fast=fast)
