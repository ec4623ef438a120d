"""Compact certificates: proved blocks as lines of text (docs/compact-certificate.md)."""

from __future__ import annotations

import base64
import json
import platform
from typing import Any

import numpy as np
import numpy.typing as npt

from exactfold.certify.certificate import pattern_document
from exactfold.checker.formats import COMPACT, COMPACT_VERSION, UNPROVED
from exactfold.exact.numbers import format_integer
from exactfold.scale.chambers import Chambers, ProvedBlock


def header_line(chambers: Chambers) -> str:
    """The first line: the pattern and what its roots are proved with."""
    return _text(
        {
            "format": COMPACT,
            "version": COMPACT_VERSION,
            "pattern": pattern_document(chambers.pattern),
            "evidence": chambers.evidence(),
            "provenance": {"method": "nappes", "python": platform.python_version()},
        }
    )


def block_line(block: ProvedBlock) -> str:
    """One block; centres take as many bytes as the largest needs."""
    boxes = block.boxes
    largest = int(np.abs(boxes.centers).max(initial=0))
    width = largest.bit_length() // 8 + 1
    raw = np.ascontiguousarray(boxes.centers.astype("<i8")).view(np.uint8)
    centers = raw.reshape(*boxes.centers.shape, 8)[:, :, :width]
    radii = np.where(boxes.proved, boxes.exponents, UNPROVED).astype(np.uint8)
    return _text(
        {
            "block": block.index,
            "bits": boxes.bits,
            "width": width,
            "centers": _base64(centers),
            "radii": _base64(radii),
            "folds": _base64(np.packbits(block.valleys, axis=1, bitorder="little")),
            "exact": [
                {
                    "root": j,
                    "bits": root.box.bits,
                    "radius": format_integer(root.box.radius),
                    "center": [format_integer(m) for m in root.box.real],
                    "assignment": root.assignment,
                }
                for j, root in sorted(block.exact.items())
            ],
            "open": [[j, end.reason] for j, end in sorted(block.open.items())],
        }
    )


def claims_line(chambers: Chambers) -> str:
    """The last line of a file without open roots."""
    return _text({"claims": chambers.claims()})


def _text(data: dict[str, Any]) -> str:
    return json.dumps(data, separators=(",", ":"))


def _base64(array: npt.NDArray[np.uint8]) -> str:
    return base64.b64encode(array.tobytes()).decode("ascii")
