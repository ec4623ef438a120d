"""`exactfold check`: what the checker says of a file, the quick way."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, Literal, TypedDict

from exactfold import checker
from exactfold.app.shell.shell import Bar, name_of, regular, said
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.command import refusal
from exactfold.checker.core.kinds import LineKind, Verified
from exactfold.checker.core.parts import Engine
from exactfold.checker.core.reading import UnfinishedError, plain
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError

_LISTS = ("supports", "flat", "letters", "halves", "joints", "together", "never")
LONG = ("branches", "vertex_signs", "assignment", *_LISTS)
"""Claims that grow with the pattern, left out of `check --json`."""


class CheckDocument(TypedDict):
    """What the checker says of a file."""

    format: Literal["exactfold check result"]
    version: Literal[1]
    name: str
    valid: bool
    reason: str
    claims: dict[str, Any]
    """Those of the certificate that do not grow with the pattern; empty if it is invalid."""


def valid(path: Path, workers: int | None, as_json: bool) -> bool:
    """Whether every claim of a file holds, which is printed; raises the errors of `verified`."""
    with Bar("checking"):
        claims, text, reason = verified(path, workers)
    if as_json:
        short = {k: v for k, v in (claims or {}).items() if k not in LONG}
        document: CheckDocument = {
            "format": "exactfold check result",
            "version": 1,
            "name": name_of(path),
            "valid": claims is not None,
            "reason": reason,
            "claims": short,
        }
        print(json.dumps(document))
    else:
        print(text)
    return claims is not None


def verified(path: Path, workers: int | None) -> tuple[Verified[Any] | None, str, str]:
    """The claims of a file, what to print, and the reason; None if one does not hold.

    Raises `CertificateFormatError`, `UnreadableFileError`, `WorkerDiedError`.
    """
    from exactfold._support.processes import available_cores

    with regular(path) as file:
        try:
            claims = checker.verify(file, workers or available_cores(), _quickest)
        except checker.CertificateError as error:
            unfinished = "unfinished: " if isinstance(error, UnfinishedError) else ""
            return None, refusal(error), unfinished + plain(error)
        except checker.FormatError as error:
            raise CertificateFormatError(f"{said(path)}: {plain(error)}") from None
        except WorkerDiedError as error:
            raise type(error)(f"{error}; nothing is known of the file") from None
        except OSError as error:
            raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
    return claims, checker.summary(claims), "every claim holds"


def _quickest(kind: LineKind[Any]) -> Engine:
    """How the lines of a file are verified: on processes, and where it can be in floats first."""
    if kind is COMPACT:
        from exactfold.branches.certificates.check import FLOATS  # needs NumPy, as no other does

        return FLOATS
    from exactfold.certificates.sharing import shared

    return kind.engine._replace(share=shared)
