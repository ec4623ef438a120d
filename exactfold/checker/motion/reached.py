"""That driven angles reach their sizes: they are larger at the end (docs/motion.md, 10)."""

from __future__ import annotations

from fractions import Fraction

from ..core.reading import require
from .boxes import Boxes, volume_sign
from .drive import Drive
from .equations import LengthEquations
from .tubes import Ball


def check_reached(equations: LengthEquations, drive: Drive, here: Ball) -> None:
    """Raise unless all driven folds are bent as far as claimed, or farther, in a box at the end.

    There g <= -2 w for one of them, and so for all, and they are valleys or mountains as claimed.
    So at some time before all of these angles have exactly the sizes claimed. Nothing is said of
    the side to which the folds are bent at that time.
    """
    bits, k = equations.bits, len(equations.edges) + drive.most
    u, e = equations.flat[k], equations.along(here.centre)[k]
    (wide,) = equations.weight_sums(here.radii)[k : k + 1]
    g = sum(2 * a * x + x * x for a, x in zip(u, e, strict=True))
    g += sum((2 * abs(a) + 2 * abs(x) + r) * r for a, x, r in zip(u, e, wide, strict=True))
    beyond = Fraction(g, 2 << 2 * bits) * equations.unit**2 <= -2 * drive.weight
    require(beyond, "the driven folds are not proved to reach the sizes of their angles")
    boxes = _boxes(equations, here)
    for fold, pair, q in zip(drive.folds, drive.diagonals, drive.squares, strict=True):
        right = volume_sign(boxes, *fold, *pair) * q > 0
        require(right, f"the driven fold {fold} may end on the other side")


def _boxes(equations: LengthEquations, here: Ball) -> Boxes:
    """The places of all vertices, over 2^bits."""
    one = Fraction(1 << equations.bits) / equations.unit
    points, error = equations.sheet.points, max(here.radii) + 1
    x, y = points[equations.pinned[0]]
    found: Boxes = {}
    for v, (a, b) in points.items():
        at = [int((a - x) * one), int((b - y) * one), 0]
        if v in equations.place:
            k = equations.place[v]
            at = [p + d for p, d in zip(at, here.centre[k : k + 3], strict=True)]
        found[v] = at, at, error
    return found
