"""Listings in one JSON object, as exactfold wrote them up to 2026: the checker reads them for ever.

The forgeries of the evidence start from these: `compact_roots` hands the same evidence to the same
lines of the checker.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from exactfold import BranchCount
from exactfold.branches.certificates.blocks import line_text
from exactfold.branches.certificates.listing import _root, _true_branches
from exactfold.certificates.entries import (
    CertificateLines,
    Document,
    algebraic_evidence,
    chart_evidence,
    pattern_document,
    triangle_evidence,
)
from exactfold.checker.branches.compact import COMPACT, ROOTS
from exactfold.checker.branches.listing import LISTING
from exactfold.pattern.crease_pattern import CreasePattern


def old_listing(result: BranchCount) -> Document:
    """The listing of a proved count."""
    claims = {
        "distinct": result.distinct,
        "with_multiplicity": result.with_multiplicity,
        "real": result.real,
        "nonreal": result.nonreal,
        "true_branches": str(_true_branches(result)),
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
    provenance = {"method": result.method, "settings": dict(result.settings), "python": "3.11.9"}
    return assembled(result.pattern, claims, _evidence(result), provenance)


def assembled(
    pattern: CreasePattern,
    claims: Mapping[str, Any],
    evidence: Mapping[str, Any],
    provenance: Mapping[str, Any],
) -> Document:
    """The listing as a JSON object."""
    return {
        "format": LISTING.format,
        "version": LISTING.version,
        "pattern": pattern_document(pattern),
        "claims": {
            "interior": pattern.Vi,
            "boundary": pattern.Ve,
            "folds": len(pattern.folds),
            "degrees_of_freedom": pattern.degrees_of_freedom,
            "sha256": pattern.sha256,
            **claims,
        },
        "evidence": dict(evidence),
        "provenance": dict(provenance),
    }


def _evidence(result: BranchCount) -> Document:
    proof = result.proof
    assert proof is not None
    kind = "isolated" if proof.kind == "chambers" else proof.kind
    found: Document = {"kind": kind, "triangles": triangle_evidence(proof.triangles)}
    if proof.chart is None:
        return found
    found["chart"] = chart_evidence(proof.chart, proof.labels)
    if proof.algebraic is not None:
        found |= algebraic_evidence(proof.algebraic, proof.labels)
    return {**found, "roots": [_root(proof, branch) for branch in result.branches]}


def as_lines(old: Document, block: int = 256) -> CertificateLines:
    """The same claims and the same evidence as a compact certificate of version 2."""
    claims, evidence = dict(old["claims"]), dict(old["evidence"])
    branches, roots = claims.pop("branches"), evidence.pop("roots", None)
    entries: Sequence[Document] = []
    if roots is not None:
        evidence |= {"roots": len(roots), "block": block}
        entries = [{"root": r, **b} for r, b in zip(roots, branches, strict=True)]
    header = {
        "format": COMPACT.format,
        "version": ROOTS,
        "pattern": old["pattern"],
        "evidence": evidence,
        "provenance": old["provenance"],
    }
    blocks = [
        {"block": k, "roots": entries[start : start + block]}
        for k, start in enumerate(range(0, len(entries), block))
    ]
    return CertificateLines(line_text(line) for line in (header, *blocks, {"claims": claims}))
