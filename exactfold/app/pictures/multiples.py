"""All ways to fold in one picture: small crease patterns in the order in which they are listed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, sqrt
from typing import Final

from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_legend import legend
from exactfold.app.pictures.crease_style import Style
from exactfold.app.pictures.drawn_ways import DrawnWay, shortened
from exactfold.errors import UsageError

MOST: Final = 64
"""The default for the largest number of ways in one picture."""

_CELL: Final = 148.0
_INNER: Final = 132.0
"""The longer side of a crease pattern."""
_GAP: Final = 8.0
_CAPTION: Final = 34.0
_NOTE: Final = 12.0
_HEAD: Final = 30.0
_TITLE: Final = 14.0
_LETTER: Final = 0.5
"""The mean width of a letter as a share of the size of the title, slightly overestimated."""
_FRAME: Final = 18.0
"""Room for the words on the frame round ways with the same letters."""
_MOST_COLUMNS: Final = 8
_FAINT: Final = 0.45
"""The opacity of a way that is not known to truly fold."""
_GREY: Final = "#666666"
_EVEN: Final = {"font_family": "monospace"}
"""A fixed-width font for signs and letters, which are compared place by place."""


@dataclass(frozen=True)
class _Block:
    """Ways side by side: a single one, or all that share their letters, in a frame."""

    ways: tuple[DrawnWay, ...]

    def shape(self, columns: int) -> tuple[int, int]:
        """Columns and rows."""
        wide = min(len(self.ways), columns)
        return wide, ceil(len(self.ways) / wide)


def sheet_of_multiples(ways: Sequence[DrawnWay], title: str, *, number: int | None = None) -> str:
    """Ways to fold one pattern as small multiples, with numbers, signs and letters, as SVG.

    They stand in the given order. Ways that share their mountain-valley letters, possibly seen from
    opposite sides, stand in one frame at the place of the first of them. `number` is the number of
    all ways, if these are only the first; then the picture says how many are left out. Each way is
    a group with `data-way`. Raises `UsageError` if there are no ways.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> from exactfold.app.pictures.drawn_ways import ways_of
    >>> text = sheet_of_multiples(ways_of(count_branches("two-vertex")), "two-vertex")
    >>> text.count("data-way=")
    4
    """
    if not ways:
        raise UsageError(f"{title}: there is no way to draw")
    blocks = _blocks(ways)
    first = ways[0].drawing(_INNER, small=True)
    high = first.extent[1] + _CAPTION + (_NOTE if any(way.note for way in ways) else 0)
    columns = _columns(len(ways), high)
    parts = []
    inside = max(columns * _CELL, _LETTER * _TITLE * len(title))
    top, width, margin = _HEAD, inside + 2 * _GAP, _GAP + (inside - columns * _CELL) / 2
    for row in _rows(blocks, columns):
        framed = any(len(block.ways) > 1 for block in row)
        inner = top + (_FRAME if framed else 0)
        left, rows = margin, 0
        for block in row:
            wide, deep = block.shape(columns)
            if len(block.ways) > 1:
                parts.append(_frame(block, left, inner, wide * _CELL, deep * high))
            for k, way in enumerate(block.ways):
                x, y = left + k % wide * _CELL, inner + k // wide * high
                parts.append(_cell(way, x, y, high))
            left, rows = left + wide * _CELL, max(rows, deep)
        top = inner + rows * high + _GAP
    if number is not None and number > len(ways):
        more = f"and {number - len(ways)} more"
        parts.append(svg.text(more, width / 2, top + 12, anchor="middle", fill=_GREY))
        top += 20
    letters = {letter for way in ways for letter in way.letters.values()}
    signs = {sign for way in ways for sign in way.signs.values()}
    key = legend(
        letters,
        signs,
        Style.of(100),
        by_angle=any(way.angles for way in ways),
        of_family=any(way.is_open_family for way in ways),
    )
    below, height = key.placed(width, top)
    head = svg.text(title, width / 2, 19, anchor="middle", size=_TITLE)
    return svg.picture(width, height, [head, *parts, *below], title)


def _columns(number: int, high: float) -> int:
    """The number of columns for cells of this height.

    The picture is about as high as wide; if possible, the last row is full.
    """
    usual = min(max(ceil(sqrt(number * high / _CELL)), 3), _MOST_COLUMNS)
    near = range(max(2, usual - 1), min(usual + 1, _MOST_COLUMNS) + 1)
    return 1 if number == 1 else min(near, key=lambda c: (-number % c, abs(c - usual), -c))


def _blocks(ways: Sequence[DrawnWay]) -> list[_Block]:
    """Ways with the same letters in one block; a way with an undecided letter has its own block."""
    groups: dict[str, list[DrawnWay]] = {}
    for k, way in enumerate(ways):
        groups.setdefault(str(k) if "U" in way.text else way.shared, []).append(way)
    return [_Block(tuple(group)) for group in groups.values()]


def _rows(blocks: Sequence[_Block], columns: int) -> list[list[_Block]]:
    """Blocks in rows that are full or nearly full, in the given order."""
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
    """A small crease pattern with two lines of text below it."""
    drawing = way.drawing(_INNER, small=True)
    aside = x + (_CELL - drawing.extent[0]) / 2
    at = f"translate({svg.number(aside)} {svg.number(y)})"
    body = svg.element("g", drawing.body(), transform=at, opacity=_FAINT if way.note else None)
    middle, below = x + _CELL / 2, y + drawing.extent[1]
    name = way.name.removeprefix("branch ") if way.signs else way.name
    name = name.replace("a family of dimension", "dim.")
    letters = shortened(way.text, 22)
    lines = [
        svg.text(shortened(name, 18), middle, below + 12, anchor="middle", size=12, **_EVEN),
        svg.text(letters, middle, below + 25, anchor="middle", size=9.5, fill=_GREY, **_EVEN),
    ]
    if way.note:
        lines.append(svg.text(way.note, middle, below + 37, anchor="middle", size=10.5))
    return svg.element("g", "".join([body, *lines]), class_="way", data_way=str(way.number or 1))


def _frame(block: _Block, x: float, y: float, width: float, height: float) -> str:
    """A frame round ways with the same letters, with the words on it."""
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
