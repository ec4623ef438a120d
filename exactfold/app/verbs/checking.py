"""`check`: verifies a certificate with the stand-alone checker."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from exactfold import checker
from exactfold._support.verdict import PROVED, REFUTED, Verdict
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.command import refusal
from exactfold.checker.core.kinds import LineKind, Verified
from exactfold.checker.core.parts import Engine
from exactfold.checker.core.reading import UnfinishedError, plain
from exactfold.checker.motion.loops import LOOPS
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError

if TYPE_CHECKING:
    from exactfold.app.verbs.check_document import CheckDocument

_LISTS = ("supports", "flat", "letters", "halves", "joints", "together", "never")
_LONG = ("branches", "vertex_signs", "assignment", *_LISTS)
"""Claims that grow with the pattern; the JSON document leaves them out."""


@dataclass(frozen=True, repr=False)
class Checked:
    """The verdict of the checker on a certificate.

    `status` is PROVED if every claim holds; `claims` has the claims. It is REFUTED if the
    certificate does not support some claim: then `reason` says which claim, `claims` is empty, and
    nothing is known about the sheet. `text` states the verdict in words. `name` is the name of the
    file.
    """

    status: Verdict
    reason: str
    text: str
    claims: Mapping[str, Any] = field(default_factory=dict)
    name: str = ""

    def __bool__(self) -> bool:
        return self.status is PROVED

    def to_dict(self, name: str | None = None) -> CheckDocument:
        """The object printed by `exactfold check --json`: `schema("check")`."""
        return {
            "format": "exactfold check result",
            "version": 1,
            "name": self.name if name is None else name,
            "valid": self.status is PROVED,
            "reason": self.reason,
            "claims": {key: claim for key, claim in self.claims.items() if key not in _LONG},
        }

    def __repr__(self) -> str:
        return f"<Checked: {self.text.partition(chr(10))[0]}>"


def check(
    certificate: str | os.PathLike[str] | Mapping[str, Any] | tuple[str, ...],
    *,
    workers: int | None = None,
) -> Checked:
    """Verify every claim of a certificate with the stand-alone checker, which trusts no solver.

    `certificate` is the path of a certificate of any kind, or what the method `certificate()` of a
    result returned. `workers` is the number of processes that share the check of a long
    certificate, by default the number of cores.

    Raises `CertificateFormatError` for anything that is not a certificate, `UnreadableFileError`,
    `WorkerDiedError`.

    >>> import exactfold
    >>> evidence = exactfold.branch("two-vertex", "+-").certificate()
    >>> exactfold.check(evidence).status
    <Verdict.PROVED: 'proved'>
    >>> forged = evidence | {"claims": evidence["claims"] | {"vertex_signs": [1, 1]}}
    >>> exactfold.check(forged).status
    <Verdict.REFUTED: 'refuted'>
    """
    if isinstance(certificate, Mapping):
        text = json.dumps(certificate)
        return judged("the certificate", lambda: checker.check(checker.load(text)))
    many = workers or cores()
    if isinstance(certificate, tuple):
        lines = certificate
        return judged("the certificate", lambda: checker.check(lines, many, quickest))
    path = certificate
    return judged(os.fspath(path), lambda: checker.verify(path, many, quickest))


def judged(name: str, verify: Callable[[], Verified[Any]]) -> Checked:
    """Run `verify` on the certificate with this name; raises the errors of `check`."""
    try:
        claims = verify()
    except checker.CertificateError as error:
        unfinished = "unfinished: " if isinstance(error, UnfinishedError) else ""
        return Checked(REFUTED, unfinished + plain(error), refusal(error), name=name)
    except checker.FormatError as error:
        raise CertificateFormatError(f"{name}: {plain(error)}") from None
    except WorkerDiedError as error:
        raise type(error)(f"{error}; nothing is known of the file") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {name}: {error.strerror}") from None
    return Checked(PROVED, "every claim holds", checker.summary(claims), dict(claims), name)


def quickest(kind: LineKind[Any]) -> Engine:
    """The fastest engine for a kind of file: in processes, and in floats first if possible."""
    if kind is COMPACT:
        from exactfold.branches.certificates.check import (
            FLOATS,
        )  # imported here: only this needs NumPy

        return FLOATS
    if kind is LOOPS:
        from exactfold.motion.loops.check import TUBES_IN_FLOATS

        return TUBES_IN_FLOATS
    from exactfold.certificates.sharing import shared

    return kind.engine._replace(share=shared)


def cores() -> int:
    """The default number of processes for a check."""
    from exactfold._support.processes import available_cores

    return available_cores()
