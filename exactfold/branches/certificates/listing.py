"""Writes the certificate of a proved count: its claims and its evidence."""

from __future__ import annotations

import platform
from typing import Any, cast

from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.certificates.blocks import claims_line, line_text
from exactfold.branches.connected_components.certificate import components_certificate
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, FlatBoxRoot
from exactfold.certificates.entries import (
    CertificateLines,
    Document,
    algebraic_evidence,
    box_entry,
    chart_evidence,
    class_entry,
    flat_box_entry,
    pattern_document,
    triangle_evidence,
)
from exactfold.checker.branches.compact import COMPACT, ROOTS
from exactfold.checker.branches.listing import Counts
from exactfold.checker.core.limits import MOST_LINE
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import shown

MOST_ROOTS = 256
"""Most roots in a line; fewer if their numbers are so long that the line would be too long."""

_DIGEST = 66
"""Bytes that the file adds to each line: a tab, the digest, and the line feed."""


def certificate(result: BranchCount) -> Document | CertificateLines:
    """The certificate of a proved count, which `checker.check` and `write_certificate` take.

    It consists of lines. For a sheet with more than four corners it is instead one JSON object, the
    certificate of the connected components (`components_certificate`). Raises `NotApplicableError`
    if the count is not proved, or if `stream_branches` proved it: then its file is the certificate.

    >>> from exactfold import checker
    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.pattern.families import two_vertex
    >>> made = certificate(count_branches(two_vertex()))
    >>> made, checker.check(made)["distinct"]
    (<CertificateLines: 3 lines>, 4)
    """
    if not isinstance(result, BranchCount):
        raise UsageError(f"{shown(result)} is not a count: give what `count_branches` returns")
    if result.connected_components is not None and result.proof is None:
        return components_certificate(result.pattern, result.connected_components)
    if result.status is not PROVED or result.proof is None:
        raise NotApplicableError(f"no certificate: the count is {result.status} ({result.reason})")
    return CertificateLines(result.proof.lines or _root_lines(result, result.proof))


def _root_lines(result: BranchCount, proof: Proof) -> list[str]:
    """The lines of a certificate that lists its roots one by one.

    This is for counts that do not have one simple root for each sign vector. Raises
    `NotApplicableError` if a line would be longer than the checker reads.
    """
    evidence: Document = {"kind": proof.kind, "triangles": triangle_evidence(proof.triangles)}
    blocks: list[str] = []
    if proof.chart is not None:
        evidence["chart"] = chart_evidence(proof.chart, proof.labels)
        if proof.algebraic is not None:
            evidence |= algebraic_evidence(proof.algebraic, proof.labels)
        entries = [_entry(proof, branch) for branch in result.branches]
        longest = max(len(line_text(entry)) for entry in entries)
        block = max(1, min(MOST_ROOTS, MOST_LINE // (2 * longest)))
        evidence |= {"roots": len(entries), "block": block}
        blocks = [
            line_text({"block": number, "roots": entries[start : start + block]})
            for number, start in enumerate(range(0, len(entries), block))
        ]
    lines = [_header(result, evidence), *blocks, claims_line(result.pattern, _counts(result))]
    longest = max(map(len, lines))
    if longest + _DIGEST > MOST_LINE:
        raise NotApplicableError(
            f"no certificate: it would have a line of {longest} characters, which is too long"
        )
    return lines


def _header(result: BranchCount, evidence: Document) -> str:
    """The first line of the certificate."""
    return line_text(
        {
            "format": COMPACT.format,
            "version": ROOTS,
            "pattern": pattern_document(result.pattern),
            "evidence": evidence,
            "provenance": {
                "method": result.method,
                "settings": dict(result.settings),
                "python": platform.python_version(),
            },
        }
    )


def _counts(result: BranchCount) -> Counts:
    """The claims about the branches; a proved count knows all these numbers."""
    counts = {
        "distinct": result.distinct,
        "with_multiplicity": result.with_multiplicity,
        "real": result.real,
        "nonreal": result.nonreal,
        "true_branches": str(_true_branches(result)),
    }
    return cast("Counts", counts)


def _entry(proof: Proof, branch: Branch) -> Document:
    """A branch and its root, as entries of the certificate."""
    return {
        "root": _root(proof, branch),
        "vertex_signs": branch.sign_text,
        "assignment": branch.assignment_text,
        "multiplicity": branch.multiplicity,
        "representative": branch.representative,
    }


def _root(proof: Proof, branch: Branch) -> dict[str, Any]:
    root = branch.root
    if isinstance(root, BoxRoot):
        return box_entry(root.box)
    if isinstance(root, FlatBoxRoot):
        return flat_box_entry(root.sheets, root.box, proof.labels)
    if isinstance(root, AlgebraicRoot) and proof.algebraic is not None:
        return class_entry(proof.algebraic, root.root_class, root.index)
    raise TypeError(f"no evidence for {type(root).__name__}")


def _true_branches(result: BranchCount) -> Verdict:
    """The verdict on true branches that the checker can verify: it needs simple solutions.

    The certificate holds no evidence that exactly one true branch starts at a multiple solution.
    """
    simple = result.proof is None or result.proof.algebraic is None or _all_simple(result)
    return result.true_branches if simple else UNDECIDED


def _all_simple(result: BranchCount) -> bool:
    return result.distinct == (result.with_multiplicity or 0) >> result.pattern.Vt
