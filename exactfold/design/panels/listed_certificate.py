"""Certificates of all assignments of a sheet of rigid panels, for `exactfold.checker`."""

from __future__ import annotations

import platform
from collections.abc import Iterable

from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.letters.panels_listed import (
    PANEL_ASSIGNMENTS,
    ForcingClaim,
    PanelAssignmentsClaims,
)
from exactfold.design.panels.panel_assignments import PanelAssignments
from exactfold.design.refutations.forcing import Forcing
from exactfold.errors import NotApplicableError
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import Edge, PanelPattern


def panel_assignments_certificate(
    listed: PanelAssignments, forcing: Forcing | None = None
) -> Document:
    """The certificate of a list of all assignments of rigid panels, as a JSON object.

    If a forcing set is given, and no smaller one forces its letters, it is among the claims
    (docs/assignment.md, All assignments of a sheet). The checker computes all the claims again, and
    it does so here, because it does not know all proofs. Raises `NotApplicableError` for a list
    that is not proved, and where the checker does not find it again.

    >>> from exactfold import checker
    >>> from exactfold.design.panels.panel_assignments import panel_assignments
    >>> document = panel_assignments_certificate(panel_assignments("square-twist"))
    >>> checker.check(document)["number"]
    12
    """
    if listed.status is not PROVED:
        raise NotApplicableError(
            f"this list is {listed.status}; only a list that is proved has a certificate"
        )
    claims: PanelAssignmentsClaims = {
        "number": listed.number or 0,
        "parts": [
            {"folds": _pairs(part.folds), "assignments": list(part.assignments)}
            for part in listed.parts
        ],
        "free": _pairs(listed.free),
        "flat": _pairs(listed.flat),
        "forcing": None if forcing is None else _forcing(listed.pattern, forcing),
    }
    document = {
        "format": PANEL_ASSIGNMENTS.format,
        "version": PANEL_ASSIGNMENTS.version,
        "kind": PANEL_ASSIGNMENTS.named,
        "pattern": panels_document(listed.pattern),
        "claims": claims,
        "provenance": {"python": platform.python_version()},
    }
    try:
        PANEL_ASSIGNMENTS.check(document)
    except (CertificateError, LimitError) as error:
        raise NotApplicableError(f"the checker does not find the list again: {error}") from None
    return document


def _forcing(pattern: PanelPattern, forcing: Forcing) -> ForcingClaim | None:
    if forcing.status is not PROVED:
        return None
    letters = "".join(forcing.letters.get(fold, "F") for fold in pattern.folds)
    return {"letters": letters, "folds": _pairs(forcing.folds)}


def _pairs(folds: Iterable[Edge]) -> list[list[int]]:
    return [[i, j] for i, j in folds]
