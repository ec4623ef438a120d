"""What leaves one curve of configurations: four boundary vertices, or equations in their place."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from ..sheets.reduced import closed
from ..sheets.sheet import Edge, Sheet, turn
from .bounds import Vector

Tie = dict[int, int]
"""Integers c_v, without a common divisor, of an equation sum c_v z_v = 0."""

Sign = Callable[[Mapping[int, Fraction]], int]
"""The sign of a functional of the heights at the flat state, 0 if it is not certain."""


class Restriction:
    """The equations beside those of the lengths, and which side of the flat state a curve is on.

    With four boundary vertices there are none. A claim about more of them adds some: `ties`,
    linear equations of the heights whose integers are less than 2^`tie_bits`; or `rows`, integers
    over 2^`row_bits`, of equations between the values of `diagonals`, which are further bars.
    """

    ties: Sequence[Tie] = ()
    tie_bits = 0
    diagonals: Sequence[Edge] = ()
    rows: Sequence[Vector] = ()
    row_bits = 0

    def __init__(self, sheet: Sheet) -> None:
        self.sheet = sheet

    def side(self, sign: Sign) -> int:
        """Of the heights at the flat state the sign of the boundary saddle.

        With a reflex corner it is the vertex sign of this corner in the sheet with its notch
        closed. 0 if it is not certain.
        """
        whole, corner = closed(self.sheet)
        return sign(saddle_of(self.sheet) if corner is None else whole.sign_of_vertex(corner))


def saddle_of(sheet: Sheet) -> dict[int, Fraction]:
    """The functional of the boundary heights that vanishes on planes, as docs/conventions.md."""
    p, q, r, s = (sheet.points[v] for v in sheet.boundary)
    weights = (turn(q, r, s), -turn(p, r, s), turn(p, q, s), -turn(p, q, r))
    first = next(w for w in weights if w)
    return {v: w / first for v, w in zip(sheet.boundary, weights, strict=True)}
