"""Certificates of matches, for `exactfold.checker`."""

from __future__ import annotations

from math import lcm

from exactfold._support.verdict import PROVED
from exactfold.branches.certificates.single import branch_certificate, heights_evidence
from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.letters.letters import LETTERS
from exactfold.design.assignments.boundary_match import RimMatch
from exactfold.design.assignments.search import Match, Matched
from exactfold.design.circles.certificate import assignments_certificate
from exactfold.design.circles.circles import all_assignments
from exactfold.design.panels.certificate import starting_certificate
from exactfold.design.panels.match import PanelMatch
from exactfold.design.refutations.clauses import Refuted
from exactfold.design.refutations.sign_tree import Step
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_integer


def match_certificate(found: Match | RimMatch | PanelMatch) -> Document:
    """The proof of a match, as a JSON object (docs/assignment.md, Certificates).

    It shows that a match has all halves; of a sheet with more than four corners, that no solution
    has the letters, or, as a certificate of one branch, that one has; of rigid panels, that they
    start to fold with the letters, or do not. Where letters of all folds are refuted by the list of
    all assignments, it is that of the list. `write_certificate` writes it to a file. Raises
    `NotApplicableError` unless the answer is proved, where letters of some folds were refuted by
    the list, and if a motion of panels was found by splitting forms.

    >>> from exactfold import checker
    >>> from exactfold.design.assignments.search import match
    >>> from exactfold.pattern.families import two_vertex
    >>> certificate = match_certificate(match(two_vertex(), {(4, 5): "V"}))
    >>> len(checker.check(certificate)["halves"])
    4
    """
    if isinstance(found, PanelMatch):
        return starting_certificate(found)
    if found.status is not PROVED:
        raise NotApplicableError(f"there is no certificate of a match that is {found.status}")
    if isinstance(found, Match):
        emptied = emptied_evidence(found.pattern)
        leaves = [[_half(half, emptied) for half in both] for _, both in found.tree.leaves]
        return _letters(found, found.matches, leaves)
    if found.branch is not None:
        return branch_certificate(found.branch)
    if found.listed:
        return _list(found)
    return _letters(found, (), [])


def _list(found: RimMatch) -> Document:
    """The certificate of a list in which the letters are not."""
    pattern, labels = found.pattern, found.labels
    moving = [tuple(sorted((labels[i], labels[j]))) for i, j in found.sheet.folds]
    if any(found.letters[i, j] == "U" for i, j in moving):
        raise NotApplicableError(
            "the list of all assignments says nothing of letters that are free"
        )
    return assignments_certificate(all_assignments(pattern))


def _letters(
    found: Match | RimMatch, matches: tuple[Matched, ...], leaves: list[list[Document]]
) -> Document:
    pattern = found.pattern
    return {
        "format": LETTERS.format,
        "version": LETTERS.version,
        "pattern": pattern_document(pattern),
        "claims": {
            "letters": "".join(found.letters[fold] for fold in pattern.folds),
            "halves": [
                {
                    "vertex_signs": [half.vertex_signs[v] for v in pattern.interior],
                    "side": half.side,
                }
                for half in matches
            ],
        },
        "evidence": {
            "emptied": emptied_evidence(pattern),
            "refuted": [_refuted(found, each) for each in found.tree.refuted],
            "tree": [_step(found, step) for step in found.tree.steps],
            "leaves": leaves,
        },
    }


def _refuted(found: Match | RimMatch, refuted: Refuted) -> Document:
    """The signs and the integer heights of the stars that are not flat."""
    signs = [[found.labels[v], sign] for v, sign in sorted(refuted.signs.items())]
    if refuted.refutation is None:
        return {"signs": signs, "heights": None}
    heights = refuted.refutation.heights
    unit = lcm(*(z.denominator for z in heights.values()))
    stars = []
    for v in sorted({v for v, _ in heights}):
        ring = found.sheet.star(v)
        first = ring.index(min(ring))
        star = [heights.get((v, w), 0) * unit for w in ring[first:] + ring[:first]]
        stars.append([found.labels[v], [format_integer(int(z)) for z in star]])
    return {"signs": signs, "heights": stars}


def _step(found: Match | RimMatch, step: Step) -> list[str | int]:
    """A step of the tree, its vertices named as in the pattern."""
    kind, *at = step
    if kind in ("split", "force"):
        at[-1] = found.labels[at[-1]]
    return [kind, *at]


def _half(half: Matched, emptied: list[Document]) -> Document:
    heights, denominator = heights_evidence(half.branch, emptied)
    return {"heights": heights, "denominator": denominator}
