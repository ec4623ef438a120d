"""Certificate files: the exact pattern, the claims, and the evidence for them, without floats."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from exactfold.certify.box import IsolatingBox
from exactfold.certify.rigid_triangles import RigidTriangle
from exactfold.errors import UnwritableFileError
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.pattern.crease_pattern import CreasePattern

FORMAT = "exactfold certificate"
VERSION = 1

Document = dict[str, Any]


def document(
    pattern: CreasePattern,
    claims: Mapping[str, Any],
    evidence: Mapping[str, Any],
    provenance: Mapping[str, Any],
) -> Document:
    """The certificate as a JSON object; `docs/certificate.md` describes every key."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "pattern": {
            "vertices": [[format_rational(x), format_rational(y)] for x, y in pattern.vertices],
            "triangles": [list(t) for t in pattern.triangles],
        },
        "claims": {
            "interior": pattern.Vi,
            "boundary": pattern.Ve,
            "folds": len(pattern.folds),
            "degrees_of_freedom": pattern.degrees_of_freedom,
            "sha256": pattern.sha256,
            **claims,
        },
        "evidence": dict(evidence),
        "provenance": dict(provenance),
    }


def triangle_evidence(triangles: Iterable[RigidTriangle]) -> list[Document]:
    """The triangulated triangles with their definite stresses."""
    return [
        {
            "corners": list(t.corners),
            "inside": list(t.inside),
            "multipliers": [format_rational(m) for m in t.multipliers],
        }
        for t in triangles
    ]


def box_evidence(boxes: Sequence[IsolatingBox]) -> list[Document]:
    """Real isolating boxes, in the order of the claimed branches."""
    return [
        {
            "bits": box.bits,
            "radius": format_integer(box.radius),
            "center": [format_integer(m) for m in box.real],
        }
        for box in boxes
    ]


def write_json(path: str | os.PathLike[str], value: Mapping[str, Any]) -> None:
    """Write a JSON file whole or not at all; raises `UnwritableFileError`."""
    target = Path(path)
    try:
        handle, temporary = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    except OSError as error:
        raise UnwritableFileError(f"cannot write {target}: {error.strerror}") from None
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            json.dump(value, stream, separators=(",", ":"))
            stream.write("\n")
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, target)
    except OSError as error:
        Path(temporary).unlink(missing_ok=True)
        raise UnwritableFileError(f"cannot write {target}: {error.strerror}") from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
