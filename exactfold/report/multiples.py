"""All ways to fold on one sheet: small crease patterns in the order in which they are listed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from typing import Final

from exactfold.errors import UsageError
from exactfold.report import svg
from exactfold.report.crease_legend import legend
from exactfold.report.crease_style import Style
from exactfold.report.drawn_ways import DrawnWay, shortened

MOST: Final = 64
"""Ways on one sheet, unless more are asked for."""

_CELL: Final = 148.0
_INNER: Final = 132.0
"""The longer side of a crease pattern."""
_GAP: Final = 8.0
_CAPTION: Final = 34.0
_HEAD: Final = 30.0
_FRAME: Final = 18.0
"""Room for the words on the frame of ways with the same letters."""
_MOST_COLUMNS: Final = 8
_GREY: Final = "#666666"


@dataclass(frozen=True)
class _Block:
    """Ways side by side: one alone, or all that share their letters, in a frame."""

    ways: tuple[DrawnWay, ...]

    def shape(self, columns: int) -> tuple[int, int]:
        """Columns and rows."""
        wide = min(len(self.ways), columns)
        return wide, ceil(len(self.ways) / wide)


def sheet_of_multiples(ways: Sequence[DrawnWay], title: str, *, most: int = MOST) -> str:
    """Ways to fold one pattern as small multiples, with their numbers, signs and letters, as SVG.

    They stand in the order given. Ways that share their mountain-valley letters, maybe seen from
    opposite sides, stand in one frame where the first of them belongs. Of more than `most` ways
    the first are drawn, and the sheet says how many there are. Each is a group with `data-way`.

    Raises `UsageError` if there are none.

    >>> from exactfold.count.collect import count_branches
    >>> from exactfold.report.drawn_ways import ways_of
    >>> text = sheet_of_multiples(ways_of(count_branches("two-vertex")), "two-vertex")
    >>> text.count("data-way=")
    4
    """
    if not ways:
        raise UsageError(f"{title}: there is no way to draw")
    drawn = ways[:most]
    blocks = _blocks(drawn)
    first = drawn[0].drawing(_INNER, small=True)
    high = first.extent[1] + _CAPTION
    columns = min(max(ceil(sqrt(len(drawn) * high / _CELL)), min(3, len(drawn))), _MOST_COLUMNS)
    parts = []
    top, width = _HEAD, columns * _CELL + 2 * _GAP
    for row in _rows(blocks, columns):
        framed = any(len(block.ways) > 1 for block in row)
        inner = top + (_FRAME if framed else 0)
        left, rows = _GAP, 0
        for block in row:
            wide, deep = block.shape(columns)
            if len(block.ways) > 1:
                parts.append(_frame(block, left, inner, wide * _CELL, deep * high))
            for k, way in enumerate(block.ways):
                x, y = left + k % wide * _CELL, inner + k // wide * high
                parts.append(_cell(way, x, y, high))
            left, rows = left + wide * _CELL, max(rows, deep)
        top = inner + rows * high + _GAP
    if len(ways) > most:
        more = f"and {len(ways) - most} more"
        parts.append(svg.text(more, width / 2, top + 12, anchor="middle", fill=_GREY))
        top += 20
    letters = {letter for way in drawn for letter in way.drawing(_INNER, small=True).lines.letters}
    signs = {sign for way in drawn for sign in way.signs.values()}
    key = legend(letters, signs, Style.of(100), any(way.angles for way in drawn))
    below, height = key.placed(width, top)
    head = svg.text(title, width / 2, 19, anchor="middle", size=14)
    return svg.picture(width, height, [head, *parts, *below], title)


def _blocks(ways: Sequence[DrawnWay]) -> list[_Block]:
    """Ways with the same letters together; where a letter is undecided none is taken for shared."""
    groups: dict[str, list[DrawnWay]] = {}
    for k, way in enumerate(ways):
        groups.setdefault(str(k) if "U" in way.text else way.shared, []).append(way)
    return [_Block(tuple(group)) for group in groups.values()]


def _rows(blocks: Sequence[_Block], columns: int) -> list[list[_Block]]:
    """Blocks in rows that are full or nearly so, in their order."""
    rows: list[list[_Block]] = []
    used = columns
    for block in blocks:
        wide, _ = block.shape(columns)
        if used + wide > columns:
            rows.append([])
            used = 0
        rows[-1].append(block)
        used += wide
    return rows


def _cell(way: DrawnWay, x: float, y: float, high: float) -> str:
    """A small crease pattern and two lines below it."""
    drawing = way.drawing(_INNER, small=True)
    aside = x + (_CELL - drawing.extent[0]) / 2
    body = svg.element(
        "g", drawing.body(), transform=f"translate({svg.number(aside)} {svg.number(y)})"
    )
    middle, below = x + _CELL / 2, y + high - _CAPTION
    signs = way.name.partition(": ")[2] or way.name
    number = "" if way.number is None or signs == way.name else f"{way.number}:  "
    lines = [
        svg.text(f"{number}{shortened(signs, 18)}", middle, below + 12, anchor="middle", size=12),
        svg.text(
            shortened(way.text, 19), middle, below + 25, anchor="middle", size=9.5, fill=_GREY
        ),
    ]
    return svg.element("g", "".join([body, *lines]), class_="way", data_way=str(way.number or 1))


def _frame(block: _Block, x: float, y: float, width: float, height: float) -> str:
    """A frame round ways with the same letters, and the words on it."""
    numbers = ", ".join(str(way.number) for way in block.ways[:6])
    numbers += ", ..." if len(block.ways) > 6 else ""
    same = len({way.text for way in block.ways}) == 1
    words = f"{numbers}: the same letters" + ("" if same else " from opposite sides")
    frame = svg.element(
        "rect",
        x=x + 2,
        y=y - _FRAME + 2,
        width=width - 4,
        height=height + _FRAME - 3,
        rx=4,
        fill="#f3f3f3",
        stroke="#8a8a8a",
        stroke_width=1,
    )
    return frame + svg.text(words, x + 9, y - 4, size=10, fill="#333333")
