"""SVG pictures without dependencies: elements as text, short numbers, axes with round ticks."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Final

COLOURS: Final = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#4d4d4d")
"""Colours that people with any kind of colour blindness can distinguish (Okabe and Ito, 2008)."""
VALLEY, MOUNTAIN, FLAT = COLOURS[0], "#c8202f", "#999999"
"""Blue and red are of about the same grey; where both are drawn, valleys are also dashed."""

INK, FAINT = "#222222", "#dddddd"

_NOT_IN_XML: Final = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

Point = tuple[float, float]


def escape(text: str) -> str:
    """Text for an element or an attribute; characters that XML does not allow are replaced by a
    mark.

    >>> escape('<a & "b">')
    '&lt;a &amp; &quot;b&quot;&gt;'
    """
    text = _NOT_IN_XML.sub("\N{REPLACEMENT CHARACTER}", text)
    for character, name in (("&", "amp"), ("<", "lt"), (">", "gt"), ('"', "quot")):
        text = text.replace(character, f"&{name};")
    return text


def number(value: float) -> str:
    """A coordinate, rounded to a hundredth.

    >>> number(1.0), number(-0.001), number(2.126)
    ('1', '0', '2.13')
    """
    shown = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if shown == "-0" else shown


def element(name: str, content: str = "", **attributes: str | float | None) -> str:
    """An element; in names of attributes `_` stands for `-`, and a final `_` is dropped.

    >>> element("rect", width=2.5, stroke_width=1, class_="a")
    '<rect width="2.5" stroke-width="1" class="a"/>'
    >>> element("g", "x")
    '<g>x</g>'
    """
    parts = [name]
    for key, value in attributes.items():
        if value is not None:
            shown = value if isinstance(value, str) else number(value)
            parts.append(f'{key.rstrip("_").replace("_", "-")}="{escape(shown)}"')
    opening = " ".join(parts)
    return f"<{opening}>{content}</{name}>" if content else f"<{opening}/>"


def text(
    content: str, x: float, y: float, *, anchor: str = "start", size: float = 12, **more: str
) -> str:
    """A line of text with its baseline at y; `anchor` is start, middle or end.

    >>> text("a < b", 1, 2)
    '<text x="1" y="2" text-anchor="start" font-size="12">a &lt; b</text>'
    """
    return element("text", escape(content), x=x, y=y, text_anchor=anchor, font_size=size, **more)


def line(start: Point, end: Point, colour: str = INK, width: float = 1, **more: str) -> str:
    """A straight line."""
    (x1, y1), (x2, y2) = start, end
    return element("line", x1=x1, y1=y1, x2=x2, y2=y2, stroke=colour, stroke_width=width, **more)


def path(points: Sequence[Point], *, closed: bool = False, **more: str | float) -> str:
    """A polygon or, if not `closed`, a line through points.

    >>> path([(0, 0), (1, 0.5)], fill="none")
    '<path d="M0 0L1 0.5" fill="none"/>'
    """
    steps = "L".join(f"{number(x)} {number(y)}" for x, y in points)
    return element("path", "", d=f"M{steps}{'Z' if closed else ''}", **more)


def picture(width: float, height: float, parts: Iterable[str], title: str) -> str:
    """A whole SVG file with a white background; screen readers read `title`."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{number(width)}" '
        f'height="{number(height)}" viewBox="0 0 {number(width)} {number(height)}" '
        f'role="img" font-family="Helvetica, Arial, sans-serif" fill="{INK}">'
    )
    ground = element("rect", width=width, height=height, fill="#ffffff")
    return "\n".join([head, element("title", escape(title)), ground, *parts, "</svg>"]) + "\n"


def ticks(low: float, high: float, most: int, steps: Sequence[float] = ()) -> list[float]:
    """Round numbers from low to high, at most `most` of them, in equal steps.

    The step is the first of `steps` that fits, or else 1, 2 or 5 times a power of ten.

    >>> ticks(-100, 190, 8, (30, 45, 90))
    [-90, -45, 0, 45, 90, 135, 180]
    >>> ticks(0, 2.9, 7)
    [0.0, 0.5, 1.0, 1.5, 2.0, 2.5]
    """
    span = high - low
    if not span > 0:
        return [low]
    size = 10.0 ** floor(log10(span / most))
    for step in (*steps, *(size * m for m in (1, 2, 5, 10, 20, 50))):
        first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
        if last - first + 1 <= most:
            return [k * step for k in range(first, last + 1)]
    return [low]


def spread(places: Sequence[float], gap: float, low: float, high: float) -> list[float]:
    """Places moved as little as necessary, so that they are at least `gap` apart.

    They lie between low and high if they fit. The order is kept. Neighbours that are too close are
    spread around their mean place.

    >>> spread([5, 5, 20], 4, 0, 30)
    [3.0, 7.0, 20]
    """
    order = sorted(range(len(places)), key=lambda k: (places[k], k))
    groups: list[tuple[float, list[int]]] = []  # centre, members
    for k in order:
        groups.append((places[k], [k]))
        while len(groups) > 1 and _top(groups[-1], gap) - _bottom(groups[-2], gap) < gap:
            (_, upper), (_, lower) = groups[-2], groups[-1]
            members = upper + lower
            wanted = [places[m] - gap * n for n, m in enumerate(members)]
            centre = sum(wanted) / len(members) + gap * (len(members) - 1) / 2
            half = gap * (len(members) - 1) / 2
            groups[-2:] = [(min(max(centre, low + half), high - half), members)]
    moved = [0.0] * len(places)
    for centre, members in groups:
        for n, k in enumerate(members):
            moved[k] = centre + gap * (n - (len(members) - 1) / 2) if len(members) > 1 else centre
    return moved


def _top(group: tuple[float, list[int]], gap: float) -> float:
    return group[0] - gap * (len(group[1]) - 1) / 2


def _bottom(group: tuple[float, list[int]], gap: float) -> float:
    return group[0] + gap * (len(group[1]) - 1) / 2


@dataclass(frozen=True)
class Scale:
    """A linear map from numbers to places in a picture: `low` to `start`, `high` to `end`.

    >>> Scale(0, 10, 100, 200)(5)
    150.0
    """

    low: float
    high: float
    start: float
    end: float

    def __call__(self, value: float) -> float:
        """The place of a number."""
        return self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)
