"""`exactfold check`: what the checker says of a file, the quick way."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from exactfold import checker
from exactfold.checker.reading import plain
from exactfold.commands.shell import regular, said
from exactfold.errors import CertificateFormatError, UnreadableFileError

LONG = ("branches", "vertex_signs", "assignment")
"""Claims that grow with the pattern, left out of `check --json`."""


def verified(path: Path, workers: int | None) -> tuple[dict[str, Any] | None, str]:
    """The claims of a file and what to print; None and the reason if one does not hold.

    Raises `CertificateFormatError`, `UnreadableFileError`, `WorkerDiedError`.
    """
    with regular(path) as file:
        try:
            claims = _claims(file, workers, path)
        except checker.CertificateError as error:
            return None, plain(error)
        except checker.FormatError as error:
            raise CertificateFormatError(f"{said(path)}: {plain(error)}") from None
        except OSError as error:
            raise UnreadableFileError(f"cannot read {path}: {error.strerror}") from None
    return claims, checker.summary(claims)


def _claims(file: Path, workers: int | None, name: Path) -> dict[str, Any]:
    if not checker.is_compact(file):
        return checker.verify(file)
    from exactfold.evidence.check import check_compact  # needs NumPy, as no other kind does
    from exactfold.workers import available_cores

    return check_compact(file, workers=workers or available_cores(), name=name)
