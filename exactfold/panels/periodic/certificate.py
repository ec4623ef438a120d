"""Writes certificates of the periodic motions of tessellations of rigid panels."""

from __future__ import annotations

from typing import Any

from exactfold._support.verdict import PROVED
from exactfold.checker.panels.cell import PANEL_CELL, CellMotionClaim
from exactfold.errors import NotApplicableError
from exactfold.panels.periodic.result import PanelCell, PeriodicMotion
from exactfold.pattern.periodic.cell_files import cell_document


def panel_cell_certificate(result: PanelCell) -> dict[str, Any]:
    """The statement of all periodic motions of rigid panels, for `exactfold check`.

    It has no evidence: the checker finds all components again. The docstring of
    `exactfold.checker.panels.cell` says what stands in it. Raises `NotApplicableError` if the
    motions are not all known.

    >>> import exactfold
    >>> from exactfold.panels import count_panel_cell
    >>> exactfold.check(panel_cell_certificate(count_panel_cell("miura-cell"))).status
    <Verdict.PROVED: 'proved'>
    """
    if result.status is not PROVED:
        raise NotApplicableError(f"the motions are not all known: {result.reason}")
    cell = cell_document(result.pattern)
    return {
        "format": PANEL_CELL.format,
        "version": PANEL_CELL.version,
        "pattern": {
            "lattice": cell["lattice"],
            "vertices": cell["points"],
            "faces": cell["faces"],
            "diagonals": [list(edge) for edge in result.pattern.diagonals],
        },
        "claims": {
            "folds": len(result.folds),
            "motions": [_claim(motion) for motion in result.motions],
            "sha256": result.pattern.sha256,
        },
    }


def _claim(motion: PeriodicMotion) -> CellMotionClaim:
    n = motion.direction
    x, y = n if n is not None else (None, None)
    return {
        "dimension": motion.dimension,
        "sizes": sorted(part.size for part in motion.parts),
        "letters": sorted(part.letters for part in motion.parts if part.letters is not None),
        "planar": motion.planar,
        "direction": [x, y] if isinstance(x, int) and isinstance(y, int) else None,
        "folds": motion.folds is PROVED,
    }
