"""Writes certificates of single branches."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import lcm
from typing import Any

from exactfold._support.verdict import PROVED
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.roots import EnclosedRoot
from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.branches.branch import BRANCH, CURVED, FLAT, MERGED, CurvedClaims
from exactfold.errors import UsageError
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.rigidity.equations.gauge import RIM, SADDLE


def branch_certificate(branch: Branch) -> dict[str, Any]:
    """The proof of a branch as a JSON object (docs/branch.md, Certificates).

    Raises `UsageError` unless the branch is proved.

    >>> from exactfold import checker
    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> certificate = branch_certificate(find_branch(random_square(3, seed=0), "+-+"))
    >>> checker.check(certificate)["vertex_signs"]
    [1, -1, 1]
    """
    pattern, root, curvature = branch.pattern, _enclosed(branch), branch.curvature
    emptied = emptied_evidence(pattern, curvature)
    heights, denominator = _heights(root, emptied)
    claims: CurvedClaims = {
        "gauge": RIM if branch.gauge == RIM else SADDLE,
        "vertex_signs": [branch.vertex_signs[v] for v in pattern.interior],
        "assignment": branch.assignment_text,
        "squared_distance": format_rational(root.squared_distance),
    }
    if curvature:
        deficits = (curvature.get(v, Fraction(0)) for v in pattern.interior)
        claims["curvature"] = list(map(format_rational, deficits))
    evidence: Document = {"emptied": emptied, "heights": heights, "denominator": denominator}
    if root.merged:
        evidence["merged"] = [{"corners": list(c), "others": list(v)} for c, v in root.merged]
    return {
        "format": BRANCH.format,
        "version": CURVED if curvature else MERGED if root.merged else FLAT,
        "pattern": pattern_document(pattern),
        "claims": claims,
        "evidence": evidence,
    }


def heights_evidence(branch: Branch, emptied: Sequence[Document]) -> tuple[list[str | None], str]:
    """The heights of all vertices, as numerators and one common denominator.

    The numerator is None for a vertex inside one of the triangulated triangles `emptied`.

    Raises `UsageError` unless the branch was proved by `find_branch`, on a sheet without merged
    faces.
    """
    root = _enclosed(branch)
    if root.merged:
        raise UsageError(
            "this branch is folded along the sides of larger triangles, which only a certificate "
            "of a single branch can say"
        )
    return _heights(root, emptied)


def _heights(root: EnclosedRoot, emptied: Sequence[Document]) -> tuple[list[str | None], str]:
    gone = {v for entry in emptied for v in entry["inside"]}
    gone.update(v for _, others in root.merged for v in others)
    heights = [None if v in gone else h for v, h in sorted(root.centres.items())]
    denominator = lcm(*{h.denominator for h in heights if h is not None})
    numerators = [
        None if h is None else format_integer(h.numerator * (denominator // h.denominator))
        for h in heights
    ]
    return numerators, format_integer(denominator)


def _enclosed(branch: Branch) -> EnclosedRoot:
    root = branch.root
    if branch.status is not PROVED or not isinstance(root, EnclosedRoot):
        raise UsageError("a branch has a certificate only if `find_branch` has proved it")
    return root
