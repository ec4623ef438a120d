"""`exactfold check`: what the checker says of a file, the quick way."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from exactfold import checker
from exactfold._support.schemas import headed
from exactfold.app.shell.shell import Bar, name_of, regular, said
from exactfold.app.verbs.checking import quickest
from exactfold.checker.command import refusal
from exactfold.checker.core.kinds import Verified
from exactfold.checker.core.reading import UnfinishedError, plain
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError

_LISTS = ("supports", "flat", "letters", "halves", "joints", "together", "never")
LONG = ("branches", "vertex_signs", "assignment", *_LISTS)
"""Claims that grow with the pattern, left out of `check --json`."""


def valid(path: Path, workers: int | None, as_json: bool) -> bool:
    """Whether every claim of a file holds, which is printed; raises the errors of `verified`."""
    with Bar("checking"):
        claims, text, reason = verified(path, workers)
    if as_json:
        short = {k: v for k, v in (claims or {}).items() if k not in LONG}
        head = {**headed("check"), "name": name_of(path)}
        print(json.dumps({**head, "valid": claims is not None, "reason": reason, "claims": short}))
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
            claims = checker.verify(file, workers or available_cores(), quickest)
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
