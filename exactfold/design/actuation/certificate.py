"""Certificates of torques that drive a triangulated sheet along one branch."""

from __future__ import annotations

from contextlib import suppress
from fractions import Fraction

import numpy as np

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.result import BranchCount
from exactfold.branches.values.roots import BoxRoot
from exactfold.certificates.entries import (
    Document,
    box_entry,
    chart_evidence,
    pattern_document,
    triangle_evidence,
)
from exactfold.checker.branches.torques import (
    BRANCH_TORQUES,
    BranchTorqueClaims,
    BranchTorqueEvidence,
)
from exactfold.checker.core.reading import CertificateError
from exactfold.design.actuation.directions import Directions
from exactfold.design.actuation.powers import Powers, exact_weights, margin_bound, rivals
from exactfold.design.actuation.programs import largest_margin
from exactfold.design.actuation.result import Actuation, outward
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational

_BITS = 80
"""The boxes of the branches are sharpened to so many bits after the point."""

_SLACK = Fraction(1, 10**12)
"""What the claims leave for the rounding of the checker."""


def torques_certificate(found: Actuation) -> Document:
    """The certificate of torques for one branch, as a JSON object for `exactfold.checker`.

    It holds boxes of all branches, what the torques do, a bound of the margin of all torques, and
    where ranks show it whether the branch is self-foldable (docs/actuation.md, 10). The branches
    are counted again. Raises `NotApplicableError` if the margin is not proved to be positive, and
    where not all branches are simple and in boxes.

    >>> from exactfold import checker
    >>> from exactfold.design.actuation.actuate import actuate
    >>> checker.check(torques_certificate(actuate("two-vertex", "+-")))["self_foldable"]
    'refuted'
    """
    if found.status is not PROVED:
        raise NotApplicableError(
            f"only torques that are proved to prefer a branch have a certificate: {found.reason}"
        )
    if found.hinges is not None:
        raise NotApplicableError(
            "no certificate: torques for a branch have one for springs of the same stiffness only"
        )
    count = count_branches(found.pattern)
    branches, boxes = _in_boxes(count)
    directions = Directions.of(branches)
    meeting = directions.meeting(Directions.of([found.branch]))
    if len(meeting) != 1 or count.proof is None or count.proof.chart is None:
        raise NotApplicableError("no certificate: two branches are too close to be told apart")
    [(place, side)] = meeting
    directions = directions.with_row(place, directions.alone(place, side))
    folds = found.pattern.folds
    torques = [found.torques[fold] for fold in folds]
    limit = max(map(abs, torques)) if found.given else Fraction(1)
    weights, bound = _bounded(directions, place, found.creases)
    margin = Powers.of(directions, torques).margin(place)[0]
    claims: BranchTorqueClaims = {
        "sha256": found.pattern.sha256,
        "branches": len(branches),
        "vertex_signs": found.branch.sign_text,
        "assignment": found.branch.assignment_text,
        "self_foldable": str(found.self_foldable),
        "torques": [format_rational(torque) for torque in torques],
        "limit": format_rational(limit),
        "creases": found.creases,
        "margin": format_rational(outward((margin - _SLACK, margin))[0]),
        "bound": format_rational(outward((bound, (bound + _SLACK) * limit))[1]),
    }
    sides = [root.side for root in boxes]
    sides[place] *= side
    evidence: BranchTorqueEvidence = {
        "count": {
            "kind": "isolated",
            "triangles": triangle_evidence(count.proof.triangles),
            "chart": chart_evidence(count.proof.chart, count.proof.labels),
            "roots": [box_entry(root.box) for root in boxes],
        },
        "branch": place,
        "side": sides[place],
        "rays": [[b, sign * sides[b], format_rational(w)] for (b, sign), w in weights],
    }
    document: Document = {
        "format": BRANCH_TORQUES.format,
        "version": BRANCH_TORQUES.version,
        "kind": BRANCH_TORQUES.named,
        "pattern": pattern_document(found.pattern),
        "claims": claims,
        "evidence": evidence,
    }
    try:
        BRANCH_TORQUES.check(document)
    except CertificateError:  # the checker knows fewer proofs of ranks
        document["claims"] = {**claims, "self_foldable": str(UNDECIDED)}
    return document


def _in_boxes(count: BranchCount) -> tuple[list[Branch], list[BoxRoot]]:
    """All branches of a count and their boxes, sharpened where that succeeds."""
    branches: list[Branch] = []
    boxes: list[BoxRoot] = []
    for branch in count.branches:
        sharper = branch
        with suppress(NotApplicableError):
            sharper = branch.sharpened(_BITS)
        if not isinstance(sharper.root, BoxRoot):
            break
        branches.append(sharper)
        boxes.append(sharper.root)
    kinds = ("chambers", "isolated")
    if count.proof is None or count.proof.kind not in kinds or len(boxes) < len(count.branches):
        raise NotApplicableError(
            "no certificate: only branches that are simple zeros in boxes have one"
        )
    return branches, boxes


def _bounded(
    directions: Directions, place: int, creases: int | None
) -> tuple[list[tuple[tuple[int, int], Fraction]], Fraction]:
    """Weights of rivals, and the bound that they show of torques on so many folds."""
    rays = rivals(directions, place)
    units = directions.middles
    gaps = units[place] - np.array([sign * units[b] for b, sign in rays])
    allowed = directions.moving
    if creases is None:
        weights = exact_weights(rays, largest_margin(gaps, allowed).weights)
        return weights, margin_bound(directions, place, weights)
    proposal = largest_margin(gaps, allowed, allowed, creases)
    weights = exact_weights(rays, proposal.weights)
    every = [True] * len(directions.folds)
    return weights, margin_bound(directions, place, weights, every, creases)
