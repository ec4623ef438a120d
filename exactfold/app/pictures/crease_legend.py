"""The legend of a crease pattern: the kinds of lines and vertices that occur in the picture."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np

from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_style import Style, mark

_NAMES: Final = {"M": "mountain", "V": "valley", "F": "flat"}
_OPEN: Final = {
    (False, False): "unassigned",
    (True, False): "undecided",
    (True, True): "mountain or valley",
}
"""What folds without a letter are, by `of_way` and `of_family`."""
_SIGNS: Final = {1: "up", -1: "down", 0: "flat vertex"}
_FONT: Final = 11.0
_ROW: Final = 18.0
_SIGN: Final = 5.0
_SAMPLE: Final = 24.0
_LETTER: Final = 0.52
"""The mean width of a letter as a share of the font size."""


@dataclass(frozen=True)
class _Item:
    """A sample that is `wide` pixels wide, drawn at 0, and its meaning."""

    sample: str
    wide: float
    name: str

    @property
    def width(self) -> float:
        return self.wide + 5 + _LETTER * _FONT * len(self.name) + 14


@dataclass(frozen=True)
class Legend:
    """The items of a legend, which are set in rows."""

    items: tuple[_Item, ...]

    @property
    def natural(self) -> float:
        """The width of all items in a single row."""
        return sum(item.width for item in self.items) + 12

    def extended(self, samples: Iterable[tuple[str, float, str]]) -> Legend:
        """The legend with more items: a sample, its width in pixels, and its meaning."""
        return Legend((*self.items, *(_Item(*sample) for sample in samples)))

    def placed(self, width: float, top: float) -> tuple[list[str], float]:
        """Elements in rows of this width below `top`, and the place where the last row ends."""
        if not self.items:
            return [], top
        rows: list[list[_Item]] = [[]]
        used = 0.0
        for item in self.items:
            if rows[-1] and used + item.width > width - 12:
                rows.append([])
                used = 0.0
            rows[-1].append(item)
            used += item.width
        parts = []
        for k, row in enumerate(rows):
            x = max(6.0, (width - sum(item.width for item in row) + 14) / 2)
            y = top + (k + 0.5) * _ROW
            for item in row:
                at = f"translate({svg.number(x)} {svg.number(y)})"
                name = svg.text(item.name, item.wide + 5, 0.35 * _FONT, size=_FONT)
                parts.append(svg.element("g", item.sample + name, transform=at))
                x += item.width
        group = svg.element("g", "\n".join(["", *parts, ""]), class_="legend")
        return [group], top + len(rows) * _ROW + 6


def legend(
    letters: Iterable[str],
    signs: Iterable[int],
    style: Style,
    *,
    by_angle: bool = False,
    of_way: bool = True,
    of_family: bool = False,
) -> Legend:
    """The legend of a picture with these letters and signs.

    With `by_angle`, the widths of lines show angles. With `of_way`, the letters are those of a way
    to fold, and a missing letter is undecided. With `of_family`, they are those of a family, and
    the folds without a letter are mountains in some of its ways and valleys in others.

    >>> shown = legend("BMV", [1], Style.of(50))
    >>> [item.name for item in shown.items]
    ['mountain', 'valley', 'up']
    """
    there = set(letters)
    names = {**_NAMES, "U": _OPEN[of_way, of_family]}
    items = [_line(letter, name) for letter, name in names.items() if letter in there]
    if not there & set("MV") and not (
        of_family and "U" in there
    ):  # without mountains and valleys the lines need no explanation
        items = []
    if by_angle and items:
        items.append(_Item(_wedge(), _SAMPLE, "wide: folds more"))
    if style.marker:
        used_signs = set(signs)
        items += [
            _Item(mark(np.array([_SIGN, 0.0]), sign, _SIGN), 2 * _SIGN, name)
            for sign, name in _SIGNS.items()
            if sign in used_signs
        ]
    return Legend(tuple(items))


def _line(letter: str, name: str) -> _Item:
    attributes = Style.of(100.0).attributes(letter)
    sample = svg.element("path", "", d=f"M0 0L{svg.number(_SAMPLE)} 0", fill="none", **attributes)
    return _Item(sample, _SAMPLE, name)


def _wedge() -> str:
    return svg.path([(0, 0.5), (_SAMPLE, 2), (_SAMPLE, -2), (0, -0.5)], closed=True, fill=svg.INK)
