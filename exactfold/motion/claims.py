"""The claims about motions in certificates. Each claim is made in the module that proves it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Claim:
    """The keys that one claim adds to the claims and to the evidence of a certificate.

    The class of the checker that reads these keys has the same name (`exactfold/checker/motion`).
    """

    claims: Mapping[str, Any]
    evidence: Mapping[str, Any] = field(default_factory=dict)


def joined(claims: Iterable[Claim], **evidence: Any) -> dict[str, dict[str, Any]]:
    """The "claims" and the "evidence" of a certificate.

    `evidence` has the evidence that every certificate of a motion contains.
    """
    parts: dict[str, dict[str, Any]] = {"claims": {}, "evidence": evidence}
    for claim in claims:
        parts["claims"].update(claim.claims)
        parts["evidence"].update(claim.evidence)
    return parts
