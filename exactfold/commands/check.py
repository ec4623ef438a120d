"""`exactfold check`: which checker a file needs, and what it says."""

from __future__ import annotations

import re
from contextlib import suppress
from io import BytesIO
from pathlib import Path
from typing import Any

from exactfold import branch_checker, checker, compact_checker
from exactfold.commands.shell import regular
from exactfold.errors import CertificateFormatError, UnreadableFileError

LONG = ("branches", "vertex_signs", "assignment")
"""Claims that grow with the pattern, left out of `check --json`."""

_COMPACT = re.compile(rb'"format"\s*:\s*"' + compact_checker.FORMAT.encode() + b'"')


def verified(path: Path, workers: int | None) -> tuple[dict[str, Any] | None, str]:
    """The claims of a file and what to print; None and the reason if one does not hold.

    Raises `CertificateFormatError`, `UnreadableFileError`, `WorkerDiedError`.
    """
    with regular(path) as file:
        return _verified(file, workers)


def _verified(path: Path, workers: int | None) -> tuple[dict[str, Any] | None, str]:
    try:
        with open(path, "rb") as stream:
            first = stream.readline(compact_checker.MOST_LINE)
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
    try:
        if _is_compact(first):
            from exactfold.evidence.check import (
                check_compact,  # needs NumPy, as no other kind does
            )
            from exactfold.workers import available_cores

            claims = check_compact(path, workers=workers or available_cores())
            return claims, checker.summary(claims)
        data, judge = _load(path)
        claims = judge.check(data)
        return claims, judge.summary(claims)
    except checker.CertificateError as error:
        return None, checker.plain(error)


def _is_compact(first: bytes) -> bool:
    """Whether a first line is of a compact certificate: by its format, else by its digest."""
    if _COMPACT.search(first[:4096]):
        return True
    with suppress(checker.FormatError):
        return b"\t" in first and next(compact_checker.lines(BytesIO(first)), None) is not None
    return False


def _load(path: Path) -> tuple[Any, Any]:
    """The certificate and the module that checks its kind."""
    try:
        text = path.read_text(encoding="utf-8")
        try:
            return branch_checker.load(text), branch_checker
        except checker.FormatError:
            return checker.load(text), checker
    except OSError as error:
        raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
    except (checker.FormatError, UnicodeDecodeError) as error:
        raise CertificateFormatError(f"{path}: {checker.plain(error)}") from None
