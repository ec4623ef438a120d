"""The name of a half-branch: the vertex signs and the side at the beginning of a motion."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from ..core.reading import require
from ..sheets.reduced import closed
from ..sheets.sheet import Sheet, turn
from .boundary import Rim
from .tubes import Start


def names(
    given: Sheet, removed: set[int], start: Start, rim: Rim | None = None
) -> tuple[list[int], int]:
    """The vertex signs, 0 for vertices that were removed, and the side of a half-branch.

    With a rim the side is the sign of its factor, with a drive 1. They are those of the heights at
    the flat state.
    """
    box, place = start.enclosure(Fraction(0)), start.equations.place

    def sign(functional: Mapping[int, Fraction]) -> int:
        """The sign of a functional of the heights, 0 if it is not certain."""
        terms = [(c, place[v] + 2) for v, c in functional.items() if v in place]
        middle = sum((c * box.centre[k] for c, k in terms), Fraction(0))
        spread = sum((abs(c) * box.radii[k] for c, k in terms), Fraction(0))
        return 0 if abs(middle) <= spread else 1 if middle > 0 else -1

    sheet = start.equations.sheet
    signs = [0 if v in removed else sign(sheet.sign_of_vertex(v)) for v in given.interior]
    for v, found in zip(given.interior, signs, strict=True):
        require(found or v in removed, f"vertex {v} may be flat")
    drive = start.equations.drive
    if drive is not None:
        for fold, q in zip(drive.folds, drive.squares, strict=True):
            right = sign(sheet.bend(fold)) * q > 0
            require(right, f"the driven fold {fold} may start the other way")
        return signs, 1
    if rim is not None:
        side = sign(rim.factor)
    else:
        whole, corner = closed(sheet)
        side = sign(saddle_of(sheet) if corner is None else whole.sign_of_vertex(corner))
    require(side, "the side of the branch is not certain")
    return signs, side


def saddle_of(sheet: Sheet) -> dict[int, Fraction]:
    """The functional of the boundary heights that vanishes on planes, as docs/conventions.md."""
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (turn(q, r, s), -turn(p, r, s), turn(p, q, s), -turn(p, q, r))
    first = next(w for w in weights if w)
    return {v: w / first for v, w in zip(sheet.boundary, weights, strict=True)}
