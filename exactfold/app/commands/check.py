"""`exactfold check`: what the checker says of a file, the quick way, and what it lists."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exactfold import checker
from exactfold.app.shell.shell import Bar, name_of, regular, said
from exactfold.app.verbs.checking import quickest
from exactfold.checker.command import refusal
from exactfold.checker.core.kinds import Verified
from exactfold.checker.core.reading import UnfinishedError, plain
from exactfold.errors import (
    CertificateFormatError,
    NotApplicableError,
    UnreadableFileError,
    WorkerDiedError,
)

if TYPE_CHECKING:
    from exactfold.app.commands.check_document import BranchWithAngles, CheckDocument
    from exactfold.branches.values.branch import Branch

_LISTS = ("supports", "flat", "letters", "halves", "joints", "together", "never")
LONG = ("branches", "vertex_signs", "assignment", *_LISTS)
"""Claims that grow with the pattern, left out of `check --json`."""


def valid(
    path: Path,
    workers: int | None,
    as_json: bool,
    *,
    listed: bool = False,
    heights: bool = False,
) -> bool:
    """Whether every claim of a file holds, which is printed; raises the errors of `verified`.

    With `listed` also the branches of a certificate of all branches, `heights` included.
    """
    branches: list[Branch] | None = None
    with Bar("checking"):
        if listed or heights:
            (claims, text, reason), branches = verified_branches(path, workers)
        else:
            claims, text, reason = verified(path, workers)
    if as_json:
        print(json.dumps(_document(path, claims, reason, branches, heights)))
        return claims is not None
    print(text)
    if branches is not None:
        from exactfold.app.report.listing import listing_report
        from exactfold.app.report.terminal import show

        show(listing_report(branches, heights=heights))
    return claims is not None


Said = tuple[Verified[Any] | None, str, str]
"""The claims of a file, what to print, and the reason; None if a claim does not hold."""


def verified(path: Path, workers: int | None) -> Said:
    """What is said of a file.

    Raises `CertificateFormatError`, `UnreadableFileError`, `WorkerDiedError`.
    """
    cores = _cores(workers)
    with regular(path) as file:
        return _said_of(path, lambda: checker.verify(file, cores, quickest))


def verified_branches(path: Path, workers: int | None) -> tuple[Said, list[Branch] | None]:
    """What is said of a certificate of all branches, and the branches as `count` lists them.

    The file is read once: what is listed is what was verified. Raises as `verified`, and
    `CertificateFormatError` for other certificates, `NotApplicableError` for too many branches.
    """
    from exactfold.branches.certificates.read import branches_of, read_listing
    from exactfold.branches.counting.by_theorem import IN_MEMORY
    from exactfold.branches.values.branch import Branch

    cores, read = _cores(workers), []

    def verify() -> Verified[Any]:
        read.append(read_listing(file))
        claims = checker.check(read[0], cores, quickest)
        if claims["real"] > 1 << IN_MEMORY:
            raise NotApplicableError(
                f"{claims['real']} branches are too many to list here, though every claim holds; "
                "`exactfold.branches.read_branches` reads them one by one"
            )
        return claims

    with regular(path) as file:
        found = _said_of(path, verify)
    if found[0] is None:
        return found, None
    return found, sorted(branches_of(read[0]), key=Branch.sort_key)


def _said_of(path: Path, verify: Callable[[], Verified[Any]]) -> Said:
    try:
        claims = verify()
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


def _document(
    path: Path,
    claims: Verified[Any] | None,
    reason: str,
    branches: list[Branch] | None,
    heights: bool,
) -> CheckDocument:
    """What `check --json` prints."""
    document: CheckDocument = {
        "format": "exactfold check result",
        "version": 1,
        "name": name_of(path),
        "valid": claims is not None,
        "reason": reason,
        "claims": {k: v for k, v in (claims or {}).items() if k not in LONG},
    }
    if branches is None:
        return document
    from exactfold.app.report.listing import angles_of

    if heights:
        bent: list[BranchWithAngles] = [
            {**branch.to_dict(), "angles": angles_of(branch)} for branch in branches
        ]
        return {**document, "branches": bent}
    return {**document, "branches": [branch.to_dict() for branch in branches]}


def _cores(workers: int | None) -> int:
    from exactfold._support.processes import available_cores

    return workers or available_cores()
