"""The look of lines and vertices of a crease pattern, by letter, sign and available room."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Final

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures import svg

UNKNOWN: Final = "#5c6670"
"""The colour of folds without a letter, or with an undecided letter."""
COLOUR: Final = {
    "M": svg.MOUNTAIN,
    "V": svg.VALLEY,
    "F": svg.FLAT,
    "U": UNKNOWN,
    "B": "#000000",
}
DASH: Final = {"V": (5.0, 3.0), "F": (0.1, 2.6), "U": (7.0, 2.2, 1.2, 2.2)}
"""Lengths of dashes and gaps; mountains are solid."""
_NARROW, _WIDE, _USUAL = 0.9, 3.8, 1.9
"""The widths of a fold that hardly folds, of the one that folds most, and of one with unknown
angle.
"""
_THIN: Final = {"F": 1.1, "B": 1.4, "U": 1.4}
FULL, LEAST = 28.0, 0.3
"""With this many pixels between neighbours, lines have their full width; and the least
share of it.
"""


@dataclass(frozen=True)
class Style:
    """Sizes in a picture: `scale` multiplies all widths, `marker` is the radius of a sign."""

    scale: float
    marker: float

    @classmethod
    def of(cls, room: float) -> Style:
        """The style of a picture in which neighbouring points are about `room` pixels apart."""
        marker = min(0.17 * room, 7.0)
        return cls(min(max(room / FULL, LEAST), 1.0), marker if marker >= 1.4 else 0.0)

    def width(self, letter: str, share: float | None) -> float:
        """The width of a line that folds by `share` of the largest angle; None means not known.

        >>> style = Style.of(100)
        >>> style.width("M", 0.0) < style.width("V", 0.5) < style.width("M", 1.0)
        True
        """
        if letter in "FB" or share is None:
            return round(self.scale * _THIN.get(letter, _USUAL), 2)
        return round(self.scale * (_NARROW + share * (_WIDE - _NARROW)), 2)

    def attributes(self, letter: str, *, alone: bool = False) -> dict[str, str | float | None]:
        """The attributes of a group of lines; `alone` means that no other letters occur."""
        dash = () if alone and letter == "U" else DASH.get(letter, ())
        scale = max(self.scale, 0.5)
        return {
            "stroke": COLOUR[letter],
            "stroke_width": self.width(letter, None),
            "stroke_dasharray": " ".join(svg.number(scale * x) for x in dash) or None,
            "stroke_linecap": "round" if letter in "FMB" else "butt",
            "stroke_linejoin": "round" if letter == "B" else None,
        }


def mark(place: FloatArray, sign: int | None, radius: float) -> str:
    """A filled triangle that points up or down; a ring for a flat vertex; a dot without a sign.

    >>> import numpy as np
    >>> mark(np.array([10.0, 10.0]), 1, 4)
    '<path d="M10 6L6.54 12L13.46 12Z" fill="#222222" stroke="#ffffff" stroke-width="0.8"/>'
    """
    x, y = float(place[0]), float(place[1])
    if sign is None:
        return svg.element("circle", cx=x, cy=y, r=radius, fill=svg.INK)
    line = round(0.2 * radius, 2)
    if not sign:
        ring = max(0.8, line)
        return svg.element(
            "circle", cx=x, cy=y, r=0.7 * radius, fill="#ffffff", stroke=svg.INK, stroke_width=ring
        )
    turns = [pi / 2 + 2 * pi * k / 3 for k in range(3)]
    corners = [(x + radius * cos(t), y - sign * radius * sin(t)) for t in turns]
    return svg.path(corners, closed=True, fill=svg.INK, stroke="#ffffff", stroke_width=line)
