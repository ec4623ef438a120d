"""Certificates of the connected components of a sheet with more than four corners.

`exactfold.checker` verifies them.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Final

from exactfold import checker
from exactfold.branches.connected_components.result import (
    ConnectedComponents,
    PartProof,
    RegularPoint,
)
from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.branches.connected_components import MOST_VERTICES, PIECES, PiecesClaims
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.solve.certify.box import IsolatingBox

_BITS: Final = 60
_RADIUS: Final = 1 << 28


def components_certificate(
    pattern: PatternLike, connected_components: ConnectedComponents
) -> Document:
    """The proof of what `find_connected_components` found, as a JSON object (docs/any_border.md).

    For each joint it contains a box with exactly one solution. For each vertex whose joints are all
    known, it contains the proof that there are no others. Raises `NotApplicableError` if no vertex
    can pop, if too many can, or if the checker refuses the proof.

    >>> from exactfold.branches.connected_components.joining import find_connected_components
    >>> from exactfold.pattern.families import single_vertex
    >>> pattern = single_vertex(6)
    >>> evidence = components_certificate(pattern, find_connected_components(pattern))
    >>> checker.check(evidence)["at_least"]
    2
    """
    sheet = as_pattern(pattern)
    if not 0 < len(connected_components.vertices) <= MOST_VERTICES:
        number = len(connected_components.vertices)
        raise NotApplicableError(
            f"a certificate of connected components needs 1 to {MOST_VERTICES} vertices that can "
            f"pop; this sheet has {number}"
        )
    complete = {v for proof in connected_components.proofs for v in proof.complete}
    claims: PiecesClaims = {
        "vertices": list(connected_components.vertices),
        "at_least": connected_components.low,
        "at_most": connected_components.high,
        "joints": sorted({joint.sign_text for joint in connected_components.joints}),
        "complete": sorted(complete),
    }
    document: Document = {
        "format": PIECES.format,
        "version": PIECES.version,
        "pattern": pattern_document(sheet),
        "claims": claims,
        "evidence": {
            "emptied": emptied_evidence(sheet),
            "chord": None
            if connected_components.chord is None
            else sorted(connected_components.chord),
            "flat": [
                {
                    "held": list(proof.held),
                    "complete": list(proof.complete),
                    "parts": [_part(part) for part in proof.parts],
                }
                for proof in connected_components.proofs
            ],
        },
    }
    try:
        checker.check(document)
    except (CertificateError, LimitError) as error:
        raise NotApplicableError(f"the checker refuses the proof: {error}") from None
    return document


def _part(part: PartProof) -> Document:
    folds = [list(fold) for fold in part.folds]
    if part.points:
        return {"folds": folds, "points": [_point(point) for point in part.points]}
    return {
        "folds": folds,
        "chart": [format_rational(c) for c in part.chart],
        "roots": [_box(box) for box in part.boxes],
    }


def _box(box: IsolatingBox) -> Document:
    """A box of the real parts, followed by the imaginary parts if the zero is not real."""
    return {
        "bits": box.bits,
        "radius": format_integer(box.radius),
        "center": [format_integer(m) for m in (*box.real, *box.imag)],
    }


def _point(point: RegularPoint) -> Document:
    near = [round(Fraction(x) * (1 << _BITS)) for x in point.coordinates]
    rest = [k for k in range(len(near)) if k not in point.free]
    return {
        "free": list(point.free),
        "fixed": [format_rational(Fraction(near[k], 1 << _BITS)) for k in rest],
        "root": {
            "bits": _BITS,
            "radius": format_integer(_RADIUS),
            "center": [format_integer(near[k]) for k in point.free],
        },
    }
