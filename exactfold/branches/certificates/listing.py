"""The certificate of a count: claims and evidence, from a proved result."""

from __future__ import annotations

import platform
from typing import Any

from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.connected_components.certificate import pieces_certificate
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, FlatBoxRoot
from exactfold.certificates.entries import (
    Document,
    algebraic_evidence,
    box_entry,
    chart_evidence,
    class_entry,
    document,
    flat_box_entry,
    triangle_evidence,
)
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import shown


def certificate(result: BranchCount) -> Document:
    """The certificate of a proved count, as a JSON object for `exactfold.checker`.

    With more than four corners it is that of the pieces (`pieces_certificate`). Raises
    `NotApplicableError` if the count is not proved, or was proved in a stream, whose file is the
    certificate.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.pattern.families import two_vertex
    >>> certificate(count_branches(two_vertex()))["claims"]["distinct"]
    4
    """
    if not isinstance(result, BranchCount):
        raise UsageError(f"{shown(result)} is not a count: give what `count_branches` returns")
    if result.pieces is not None and result.proof is None:
        return pieces_certificate(result.pattern, result.pieces)
    if result.status is not PROVED or result.proof is None:
        raise NotApplicableError(f"no certificate: the count is {result.status} ({result.reason})")
    claims: dict[str, Any] = {
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
    provenance = {
        "method": result.method,
        "settings": dict(result.settings),
        "python": platform.python_version(),
    }
    return document(result.pattern, claims, _evidence(result.proof, result.branches), provenance)


def _true_branches(result: BranchCount) -> Verdict:
    """What simple solutions prove; that multiple ones fold once is left to the theorem."""
    simple = result.proof is None or result.proof.algebraic is None or _all_simple(result)
    return result.true_branches if simple else UNDECIDED


def _all_simple(result: BranchCount) -> bool:
    return result.distinct == (result.with_multiplicity or 0) >> result.pattern.Vt


def _evidence(proof: Proof, branches: tuple[Branch, ...]) -> Document:
    """What the checker verifies the claims by."""
    found: Document = {"kind": proof.kind, "triangles": triangle_evidence(proof.triangles)}
    if proof.chart is None:
        return found
    roots = [_entry(proof, branch) for branch in branches]
    found["chart"] = chart_evidence(proof.chart, proof.labels)
    if proof.algebraic is None:
        return {**found, "roots": roots}
    return {**found, **algebraic_evidence(proof.algebraic, roots, proof.labels)}


def _entry(proof: Proof, branch: Branch) -> Document:
    """A root as the certificate shows it."""
    root = branch.root
    if isinstance(root, BoxRoot):
        return box_entry(root.box)
    if isinstance(root, FlatBoxRoot):
        return flat_box_entry(root.sheets, root.box, proof.labels)
    if isinstance(root, AlgebraicRoot) and proof.algebraic is not None:
        return class_entry(proof.algebraic, root.root_class, root.index)
    raise TypeError(f"no evidence for {type(root).__name__}")
