"""Certificates of loops: a header, a line for each loop, then the claims (docs/motion.md, 15)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.motion.loops import LOOPS, LoopsClaims
from exactfold.pattern.crease_pattern import CreasePattern

OPENING = '{"from":'
"""The line of a loop begins with this text."""


def header_line(pattern: CreasePattern, pinned: Sequence[int], bits: int) -> str:
    """The first line: the sheet, the triangle that is held, and the unit 2^-bits of all numbers."""
    return _text(
        {
            "format": LOOPS.format,
            "version": LOOPS.version,
            "pattern": pattern_document(pattern),
            "emptied": emptied_evidence(pattern),
            "pinned": list(pinned),
            "bits": bits,
        }
    )


def loop_line(
    source: Document, target: Document, length: str, evidence: Document, provenance: Document
) -> str:
    """The line of one loop."""
    return _text(
        {
            "from": source,
            "to": target,
            "length": length,
            "evidence": evidence,
            "provenance": provenance,
        }
    )


def claims_line(pattern: CreasePattern, loops: int, matched: int) -> str:
    """The last line, with the claims."""
    rays = 2 << len(pattern.foldable_vertices)
    claims: LoopsClaims = {
        "sha256": pattern.sha256,
        "loops": loops,
        "matched": matched,
        "half_branches": rays,
        "complete": matched == rays,
    }
    return _text({"claims": claims})


def _text(data: dict[str, Any]) -> str:
    return json.dumps(data, separators=(",", ":"))
