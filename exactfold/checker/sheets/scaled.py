"""A sheet of panels moved to one of its corners and scaled, for sums over a fixed power of two."""

from __future__ import annotations

from fractions import Fraction

from .panels import PanelSheet, Vector


def scaled(sheet: PanelSheet) -> tuple[Fraction, list[Vector]]:
    """A power of two, and the way from a corner of the sheet to each vertex, times this power.

    All coordinates of these ways are below 1 in size, and one of them is not much smaller than 1/2.
    """
    x, y = sheet.points[sheet.panels[0][0]]
    moved = [(a - x, b - y) for a, b in sheet.points]
    bits, most = 32, 0
    while most < 1 << 16:  # until the largest coordinate is known to some digits
        bits += bits
        ends = [c.enclosed(bits) for point in moved for c in point]
        most = max(max(abs(c.low), abs(c.high)) for c in ends)
    scale = Fraction(1 << bits, 1 << most.bit_length())
    factor = sheet.tower.number(scale)
    return scale, [(a * factor, b * factor) for a, b in moved]
