"""Compact certificates taken apart and put together again, with right digests whatever they say."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from exactfold.branches.certificates.check import check_compact
from exactfold.checker import CertificateError
from exactfold.checker.branches.compact_blocks import UNPROVED, CompactSheet
from exactfold.checker.core.lines import digest

Lines = list[dict[str, Any]]


def bodies(data: bytes) -> Lines:
    return [json.loads(line.partition(b"\t")[0]) for line in data.splitlines()]


def chained_texts(texts: list[str]) -> bytes:
    last, data = "", ""
    for text in texts:
        last = digest(last, text)
        data += f"{text}\t{last}\n"
    return data.encode()


def chained(lines: Lines) -> bytes:
    return chained_texts([json.dumps(line, separators=(",", ":")) for line in lines])


def raw(line: dict[str, Any], key: str) -> bytearray:
    return bytearray(base64.b64decode(line[key]))


def put(line: dict[str, Any], key: str, data: bytes | bytearray) -> None:
    line[key] = base64.b64encode(data).decode()


def listed_exactly(lines: Lines, **changes: Any) -> None:
    """The first root of the file moved to `exact`, as it is but for the changes."""
    sheet = CompactSheet(lines[0])
    block = sheet.decode(json.dumps(lines[1]), 0)
    entry = {
        "root": 0,
        "bits": block.bits,
        "radius": str(1 << block.radii[0]),
        "center": [str(m) for m in block.center(0, sheet.size)],
        "assignment": sheet.letters(block, 0),
    }
    radii = raw(lines[1], "radii")
    radii[0] = UNPROVED
    put(lines[1], "radii", radii)
    lines[1]["exact"] = [entry | changes]


def refused(data: bytes, path: Path, match: str) -> None:
    path.write_bytes(data)
    for fast in (True, False):
        with pytest.raises(CertificateError, match=match):
            check_compact(path, fast=fast)
