"""Claims of motions as certificates have them. Each is made next to what proves it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Claim:
    """What one claim adds to a certificate: its keys among the claims, and in the evidence.

    The class of the checker that reads them has the same name (`exactfold/checker/motion`).
    """

    claims: Mapping[str, Any]
    evidence: Mapping[str, Any] = field(default_factory=dict)


def joined(claims: Iterable[Claim], **evidence: Any) -> dict[str, dict[str, Any]]:
    """The "claims" and the "evidence" of a certificate; `evidence` is what every motion has."""
    found: dict[str, dict[str, Any]] = {"claims": {}, "evidence": evidence}
    for claim in claims:
        found["claims"].update(claim.claims)
        found["evidence"].update(claim.evidence)
    return found
