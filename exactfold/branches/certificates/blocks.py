"""Writes proved blocks as lines of a certificate that has one root for each sign vector.

The module of the checker that reads blocks, `compact_blocks`, describes every key.
"""

from __future__ import annotations

import base64
import json
import platform
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from exactfold.certificates.entries import chart_evidence, pattern_document, triangle_evidence
from exactfold.checker.branches.compact import CHAMBERS, COMPACT
from exactfold.checker.branches.compact_blocks import UNPROVED
from exactfold.checker.branches.listing import CountClaims, Counts
from exactfold.exact.numbers import format_integer
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.box import IsolatingBox

if TYPE_CHECKING:  # sheets with few vertices do without NumPy
    from exactfold.branches.values.blocks import ProvedBlock


def header_line(problem: Problem, block_size: int) -> str:
    """The first line: the pattern, and the evidence that all blocks share."""
    return line_text(
        {
            "format": COMPACT.format,
            "version": CHAMBERS,
            "pattern": pattern_document(problem.pattern),
            "evidence": {
                "kind": "chambers",
                "triangles": triangle_evidence(problem.triangles or ()),
                "chart": chart_evidence(problem.chart, problem.labels),
                "block": block_size,
            },
            "provenance": {"method": "newton", "python": platform.python_version()},
        }
    )


def block_line(block: ProvedBlock) -> str:
    """The line of a block; each centre takes as many bytes as the largest centre needs."""
    import numpy as np

    boxes = block.boxes
    width = _width(int(np.abs(boxes.centers).max(initial=0)))
    raw = np.ascontiguousarray(boxes.centers.astype("<i8")).view(np.uint8)
    centers = raw.reshape(*boxes.centers.shape, 8)[:, :, :width]
    radii = np.where(boxes.proved, boxes.exponents, UNPROVED).astype(np.uint8)
    return _line(
        block.index,
        boxes.bits,
        width,
        (centers.tobytes(), radii.tobytes()),
        np.packbits(block.valleys, axis=1, bitorder="little").tobytes(),
        [
            {
                "root": j,
                "bits": root.box.bits,
                "radius": format_integer(root.box.radius),
                "center": [format_integer(m) for m in root.box.real],
                "assignment": root.assignment,
            }
            for j, root in sorted(block.exact.items())
        ],
        [[j, end.reason] for j, end in sorted(block.open.items())],
    )


def few_line(boxes: Sequence[IsolatingBox], letters: Sequence[str]) -> str:
    """The line of block 0 from a proved box for each sign vector, and the letters M and V there.

    All centres have the same number of bits, and each radius is a power of two.
    """
    width = _width(max(abs(m) for box in boxes for m in box.real))
    centers = [m.to_bytes(width, "little", signed=True) for box in boxes for m in box.real]
    radii = bytes(box.radius.bit_length() - 1 for box in boxes)
    folds = [
        sum((x == "V") << k for k, x in enumerate(text)).to_bytes((len(text) + 7) // 8, "little")
        for text in letters
    ]
    return _line(0, boxes[0].bits, width, (b"".join(centers), radii), b"".join(folds), [], [])


def _width(largest: int) -> int:
    """How many bytes a signed integer of this size takes."""
    return largest.bit_length() // 8 + 1


def _line(
    index: int,
    bits: int,
    width: int,
    boxes: tuple[bytes, bytes],
    folds: bytes,
    exact: list[dict[str, Any]],
    open_: list[list[Any]],
) -> str:
    centers, radii = boxes
    return line_text(
        {
            "block": index,
            "bits": bits,
            "width": width,
            "centers": _base64(centers),
            "radii": _base64(radii),
            "folds": _base64(folds),
            "exact": exact,
            "open": open_,
        }
    )


def compact_lines(problem: Problem, block_size: int, blocks: Sequence[str]) -> tuple[str, ...]:
    """All lines of a certificate, from the lines of its proved blocks, still without digests."""
    claims = claims_line(problem.pattern, chamber_counts(problem))
    return (header_line(problem, block_size), *blocks, claims)


def chamber_counts(problem: Problem) -> Counts:
    """The counts that one root for each sign vector proves."""
    return {
        "distinct": 1 << problem.size,
        "with_multiplicity": 1 << problem.pattern.Vi,
        "real": 1 << problem.size,
        "nonreal": 0,
        "true_branches": "proved",
    }


def claims_line(pattern: CreasePattern, counts: Counts) -> str:
    """The last line of a file without open roots: its claims."""
    claims: CountClaims = {
        "interior": pattern.Vi,
        "boundary": pattern.Ve,
        "folds": len(pattern.folds),
        "degrees_of_freedom": pattern.degrees_of_freedom,
        "sha256": pattern.sha256,
        **counts,
    }
    return line_text({"claims": claims})


def line_text(data: Mapping[str, Any]) -> str:
    """The JSON text of one line."""
    return json.dumps(data, separators=(",", ":"))


def _base64(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
