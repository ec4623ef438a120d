"""What singles out one curve of configurations: four boundary vertices, or further equations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from ..sheets.reduced import closed
from ..sheets.sheet import Edge, Sheet, turn
from .bounds import Vector

Tie = dict[int, int]
"""An equation sum c_v z_v = 0 of the heights, as integers c_v without a common divisor."""

Sign = Callable[[Mapping[int, Fraction]], int]
"""A function that gives the sign of a functional of the heights at the flat state, 0 if uncertain.
"""


class Restriction:
    """The equations beside those of the lengths, and on which side of the flat state a curve is.

    With four boundary vertices there are no further equations. With more, a claim adds some. `ties`
    are linear equations of the heights, with integers below 2^`tie_bits`. `rows` are equations
    between the values of the `diagonals`, which are further bars, with integers over 2^`row_bits`.
    """

    ties: Sequence[Tie] = ()
    tie_bits = 0
    diagonals: Sequence[Edge] = ()
    rows: Sequence[Vector] = ()
    row_bits = 0

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet

    def side(self, sign: Sign) -> int:
        """The sign of the boundary saddle of the heights at the flat state.

        With a reflex corner it is the vertex sign of this corner in the sheet with its notch
        closed. It is 0 if the sign is not certain.
        """
        whole, corner = closed(self.sheet)
        return sign(saddle_of(self.sheet) if corner is None else whole.sign_of_vertex(corner))


def saddle_of(sheet: Sheet) -> dict[int, Fraction]:
    """The boundary saddle: the functional of boundary heights that vanishes on planes.

    Its scale is that of docs/mathematics.md, The boundary saddle.
    """
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (turn(q, r, s), -turn(p, r, s), turn(p, q, s), -turn(p, q, r))
    first = next(w for w in weights if w)
    return {v: w / first for v, w in zip(sheet.boundary, weights, strict=True)}
