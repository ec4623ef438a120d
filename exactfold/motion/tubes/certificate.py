"""Certificates of motions along branches: a chain of pieces, and what is claimed of it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.motion.certificate import MOTION
from exactfold.exact.numbers import format_rational
from exactfold.motion.claims import Claim, joined
from exactfold.motion.tubes.chain import Step, chords, step_documents
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.piece import Ball
from exactfold.motion.tubes.tube_start import StartTube
from exactfold.pattern.crease_pattern import CreasePattern


def motion_certificate(
    pattern: CreasePattern,
    labels: Sequence[int],
    start: StartTube,
    steps: Sequence[Step],
    claims: Iterable[Claim] = (),
    *,
    landing: Ball | None = None,
) -> Document:
    """The proof of a motion as a JSON object (docs/motion.md, The certificate).

    It claims the ray of `start` and a length a little smaller than that of the motion, as
    far as straight chords show it; and `claims`, in this order. `labels[v]` is the vertex of the
    pattern that vertex v of the framework is. A last step that ends at a branch point is the
    evidence of a claim of its own. With `landing` the motion goes on inside the last tube, to the
    configuration in this box, and back to the flat state.
    """
    leaves = landing is None
    tubes = step_documents(steps, leaves)
    if steps and isinstance(steps[-1], Passage) and steps[-1].ends_at_the_node:
        del tubes[-1]
    length = chords(start, steps, leaves, landing) * start.framework.unit
    own = half_branch_claim(pattern, labels, start), Claim({"length": format_rational(length)})
    return {
        "format": MOTION.format,
        "version": MOTION.version,
        "pattern": pattern_document(pattern),
        **joined(
            [*own, *claims],
            emptied=emptied_evidence(pattern),
            pinned=[labels[v] for v in start.framework.pinned],
            bits=start.bits,
            start=first_document(labels, start),
            tubes=tubes,
        ),
    }


def half_branch_claim(pattern: CreasePattern, labels: Sequence[int], start: StartTube) -> Claim:
    """The vertex signs, 0 for vertices that cannot fold, and the side of a start tube."""
    interior = (labels[v] for v in start.framework.sheet.interior)
    signs = dict(zip(interior, start.vertex_signs, strict=True))
    return Claim({"vertex_signs": [signs.get(v, 0) for v in pattern.interior], "side": start.side})


def first_document(labels: Sequence[int], start: StartTube) -> Document:
    """The first piece, and where the motion leaves it."""
    return {**flat_document(labels, start), "exit": start.last}


def flat_document(labels: Sequence[int], start: StartTube) -> Document:
    """A start tube, at one end of a motion or at the other."""
    return {
        "centre": list(start.coefficients[0]),
        "halvings": start.halvings,
        "held": labels[int(start.framework.free[start.held // 3])],
        "reach": start.reach,
    }
