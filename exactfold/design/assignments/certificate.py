"""Certificates of matches, for `exactfold.checker`."""

from __future__ import annotations

from math import lcm

from exactfold._support.verdict import PROVED
from exactfold.branches.certificates.single import branch_certificate, heights_evidence
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.roots import EnclosedRoot
from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.letters.letters import LETTERS, LettersClaims
from exactfold.design.assignments.boundary_result import BoundaryMatch
from exactfold.design.assignments.result import Match, MatchedRay
from exactfold.design.circles.certificate import assignments_certificate
from exactfold.design.circles.circles import all_assignments
from exactfold.design.panels.certificate import starting_certificate
from exactfold.design.panels.match import PanelMatch
from exactfold.design.refutations.clauses import Refuted
from exactfold.design.refutations.sign_tree import Step
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_integer


def match_certificate(matched: Match | BoundaryMatch | PanelMatch) -> Document:
    """The proof of a match, as a JSON object (docs/assignment.md, Certificates).

    For a sheet with four corners the certificate shows that the match lists all rays with the
    letters. For a sheet with more corners it shows that no solution has the letters, or it is the
    certificate of one branch that has them. For rigid panels it shows that they start to fold with
    the letters, or that they do not. Where the list of all assignments refutes letters of all
    folds, the certificate is that of the list. `write_certificate` writes it to a file.

    Raises `NotApplicableError` in three cases: the answer is not proved; the list refuted letters
    that leave some folds free; a motion of panels was found by splitting forms.

    >>> from exactfold import checker
    >>> from exactfold.design.assignments.search import match
    >>> from exactfold.pattern.families import two_vertex
    >>> certificate = match_certificate(match(two_vertex(), {(4, 5): "V"}))
    >>> len(checker.check(certificate)["halves"])
    4
    """
    if isinstance(matched, PanelMatch):
        return starting_certificate(matched)
    if matched.status is not PROVED:
        raise NotApplicableError(
            f"this match is {matched.status}; only a match that is proved has a certificate"
        )
    if isinstance(matched, Match):
        emptied = emptied_evidence(matched.pattern)
        finder = BranchFinder(matched.pattern)
        leaves = [[_ray(ray, finder, emptied) for ray in both] for _, both in matched.tree.leaves]
        return _letters(matched, matched.matches, leaves)
    if matched.branch is not None:
        return branch_certificate(matched.branch)
    if matched.listed:
        return _list(matched)
    return _letters(matched, (), [])


def _list(matched: BoundaryMatch) -> Document:
    """The certificate of the list of all assignments, none of which has the letters."""
    pattern, labels = matched.pattern, matched.labels
    moving = [tuple(sorted((labels[i], labels[j]))) for i, j in matched.sheet.folds]
    if any(matched.letters[i, j] == "U" for i, j in moving):
        raise NotApplicableError(
            "no certificate: these letters were refuted by the list of all assignments, whose "
            "certificate covers only letters of all folds; give every fold a letter M, V or F"
        )
    return assignments_certificate(all_assignments(pattern))


def _letters(
    matched: Match | BoundaryMatch, matches: tuple[MatchedRay, ...], leaves: list[list[Document]]
) -> Document:
    pattern = matched.pattern
    claims: LettersClaims = {
        "letters": "".join(matched.letters[fold] for fold in pattern.folds),
        "halves": [
            {"vertex_signs": [ray.vertex_signs[v] for v in pattern.interior], "side": ray.side}
            for ray in matches
        ],
    }
    return {
        "format": LETTERS.format,
        "version": LETTERS.version,
        "pattern": pattern_document(pattern),
        "claims": claims,
        "evidence": {
            "emptied": emptied_evidence(pattern),
            "refuted": [_refuted(matched, each) for each in matched.tree.refuted],
            "tree": [_step(matched, step) for step in matched.tree.steps],
            "leaves": leaves,
        },
    }


def _refuted(matched: Match | BoundaryMatch, refuted: Refuted) -> Document:
    """The signs, and as integers the heights of the stars that are not flat."""
    signs = [[matched.labels[v], sign] for v, sign in sorted(refuted.signs.items())]
    if refuted.refutation is None:
        return {"signs": signs, "heights": None}
    heights = refuted.refutation.heights
    unit = lcm(*(z.denominator for z in heights.values()))
    stars = []
    for v in sorted({v for v, _ in heights}):
        ring = matched.sheet.star(v)
        first = ring.index(min(ring))
        star = [heights.get((v, w), 0) * unit for w in ring[first:] + ring[:first]]
        stars.append([matched.labels[v], [format_integer(int(z)) for z in star]])
    return {"signs": signs, "heights": stars}


def _step(matched: Match | BoundaryMatch, step: Step) -> list[str | int]:
    """A step of the tree with the pattern's names of the vertices."""
    kind, *at = step
    if kind in ("split", "force"):
        at[-1] = matched.labels[at[-1]]
    return [kind, *at]


def _ray(ray: MatchedRay, finder: BranchFinder, emptied: list[Document]) -> Document:
    """The heights of the branch; one that was proved with many others is proved by itself first."""
    branch = ray.branch
    if not isinstance(branch.root, EnclosedRoot):
        branch = finder.find({v: branch.vertex_signs[v] for v in finder.poppable})
    heights, denominator = heights_evidence(branch, emptied)
    return {"heights": heights, "denominator": denominator}
