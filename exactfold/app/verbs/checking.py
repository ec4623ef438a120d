"""`check`: what the stand-alone checker says of a certificate."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from exactfold import checker
from exactfold._support.processes import available_cores
from exactfold._support.verdict import PROVED, REFUTED, Verdict
from exactfold.certificates.entries import CertificateLines
from exactfold.certificates.sharing import shared
from exactfold.checker.branches.compact import COMPACT
from exactfold.checker.command import refusal
from exactfold.checker.core.kinds import LineKind, Verified
from exactfold.checker.core.parts import Engine
from exactfold.checker.core.reading import plain
from exactfold.errors import CertificateFormatError, UnreadableFileError, WorkerDiedError


@dataclass(frozen=True, repr=False)
class Checked:
    """What the checker says of a certificate.

    `status` is PROVED if every claim holds, and `claims` has them. It is REFUTED if the certificate
    does not support some claim: then `reason` says which, `claims` is empty, and nothing is known
    of the sheet. `text` says it in words.
    """

    status: Verdict
    reason: str
    text: str
    claims: Mapping[str, Any] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return self.status is PROVED

    def __repr__(self) -> str:
        return f"<Checked: {self.text.partition(chr(10))[0]}>"


def check(
    certificate: str | os.PathLike[str] | Mapping[str, Any] | CertificateLines,
    *,
    workers: int | None = None,
) -> Checked:
    """Verify every claim of a certificate by the stand-alone checker, which believes nothing.

    `certificate`: the path of a file of any kind, or what `certificate()` of a result returned.
    `workers`: processes that share a long one; by default as many as there are cores.

    Raises `CertificateFormatError` for what is no certificate, `UnreadableFileError`,
    `WorkerDiedError`.

    >>> import exactfold
    >>> from exactfold.branches import branch_certificate
    >>> evidence = branch_certificate(exactfold.branch("two-vertex", "+-"))
    >>> exactfold.check(evidence).status
    <Verdict.PROVED: 'proved'>
    >>> forged = evidence | {"claims": evidence["claims"] | {"vertex_signs": [1, 1]}}
    >>> exactfold.check(forged).status
    <Verdict.REFUTED: 'refuted'>
    """
    if isinstance(certificate, Mapping | CertificateLines):
        name = "the certificate"
    else:
        name = os.fspath(certificate)
    try:
        claims = _verified(certificate, workers or available_cores())
    except checker.CertificateError as error:
        return Checked(REFUTED, plain(error), refusal(error))
    except checker.FormatError as error:
        raise CertificateFormatError(f"{name}: {plain(error)}") from None
    except WorkerDiedError as error:
        raise type(error)(f"{error}; nothing is known of the file") from None
    except OSError as error:
        raise UnreadableFileError(f"cannot read {name}: {error.strerror}") from None
    return Checked(PROVED, "every claim holds", checker.summary(claims), dict(claims))


def _verified(
    certificate: str | os.PathLike[str] | Mapping[str, Any] | CertificateLines, workers: int
) -> Verified[Any]:
    """The claims of an object, of lines, or of a file."""
    if isinstance(certificate, Mapping):
        return checker.check(checker.load(json.dumps(certificate)))
    if isinstance(certificate, CertificateLines):
        return checker.check(certificate, workers, quickest)
    return checker.verify(certificate, workers, quickest)


def quickest(kind: LineKind[Any]) -> Engine:
    """How the lines of a file are verified: on processes, and where it can be in floats first."""
    if kind is COMPACT:
        from exactfold.branches.certificates.check import FLOATS  # needs NumPy, as no other does

        return FLOATS
    return kind.engine._replace(share=shared)
