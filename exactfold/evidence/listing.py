"""The claims of a certificate, from a proved count."""

from __future__ import annotations

import platform
from typing import Any

from exactfold.branches.result import BranchCount
from exactfold.errors import NotApplicableError
from exactfold.evidence.entries import Document, document
from exactfold.verdict import PROVED


def certificate(result: BranchCount) -> Document:
    """The certificate of a proved count, as a JSON object for `exactfold.checker`.

    Raises `NotApplicableError` if the count is not proved: there is nothing to certify.
    """
    if result.status is not PROVED or result.evidence is None:
        raise NotApplicableError(f"no certificate: the count is {result.status} ({result.reason})")
    claims: dict[str, Any] = {
        "distinct": result.distinct,
        "with_multiplicity": result.with_multiplicity,
        "real": result.real,
        "nonreal": result.nonreal,
        "true_branches": str(result.true_branches),
        "branches": [
            {
                "vertex_signs": branch.sign_text,
                "assignment": branch.assignment_text,
                "multiplicity": branch.multiplicity,
                "representative": branch.representative,
            }
            for branch in result.branches
        ],
    }
    provenance = {
        "method": result.method,
        "settings": dict(result.settings),
        "python": platform.python_version(),
    }
    return document(result.pattern, claims, result.evidence, provenance)
