"""Why a sheet has no flat-folded state, marked in its crease pattern."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_drawing import CreaseDrawing, natural_size
from exactfold.app.pictures.crease_legend import legend
from exactfold.app.pictures.crease_lines import crease_lines
from exactfold.app.pictures.painting import area
from exactfold.layers.pieces import convex_parts

if TYPE_CHECKING:
    from exactfold.layers.states import FlatStates

_MARKED: Final = "#e69f00"
_FONT, _LINE, _LETTER = 11.0, 15.0, 0.5
_NARROWEST: Final = 420.0
_SMALL: Final = 0.6
"""The share of the usual size for a picture beside its reasons."""


def conflict_picture(
    found: FlatStates, reasons: Sequence[str], title: str = "", *, written: bool = True
) -> str:
    """The crease pattern with the vertices that fail, or the conditions that contradict, as SVG.

    `reasons` has a line for each of `found.failures`, or else of `found.conflict`, or for the first
    ones. They stand below the picture, if `written`, with their numbers, which also mark their
    places: a ring at a vertex, or a thick line along each crease. The panels that take part are
    shaded. Everything that is marked has the class `marked`.

    >>> from exactfold.layers.folding import fold_flat
    >>> found = fold_flat("zigzags")
    >>> text = conflict_picture(found, [one.text for one in found.failures])
    >>> text.count('class="marked"'), "1. at vertex 9" in text
    (4, True)
    """
    lines = crease_lines(found.pattern, found.letters)
    drawing = CreaseDrawing(lines, {}, {}, natural_size(lines) * (1.0 if written else _SMALL))
    below, above = _failures(found, drawing) if found.failures else _conditions(found, drawing)
    numbers = _numbers(found, drawing, len(reasons))
    width, height = drawing.extent
    key = legend(lines.letters, (), drawing.style, of_way=False)
    wide = max(width, min(key.natural, 320.0), _NARROWEST if written else 0.0)
    keyed, y = key.placed(wide, height)
    rest = len(found.failures or found.conflict) - len(reasons)
    texts = [f"{k}. {reason}" for k, reason in enumerate(reasons, 1)]
    if rest > 0:
        texts.append(f"and {rest} more")
    words = []
    for one in texts if written else ():
        for k, part in enumerate(wrap(one, int((wide - 40) / (_LETTER * _FONT)))):
            y += _LINE
            words.append(svg.text(part, 20 if k == 0 else 33, y, size=_FONT))
    at = f"translate({svg.number((wide - width) / 2)} 0)"
    body = svg.element(
        "g", "\n".join(["", *below, drawing.body(), *above, *numbers, ""]), transform=at
    )
    return svg.picture(wide, y + 14, [body, *keyed, *words], title or "no flat-folded state")


def _failures(found: FlatStates, drawing: CreaseDrawing) -> tuple[list[str], list[str]]:
    """What is drawn below and above the lines: a ring at each vertex that fails."""
    radius = max(6.0, 1.6 * drawing.style.marker)
    rings = [
        svg.element(
            "circle",
            class_="marked",
            cx=float(drawing.places[one.vertex][0]),
            cy=float(drawing.places[one.vertex][1]),
            r=radius,
            fill=_MARKED,
            fill_opacity=0.35,
            stroke=_MARKED,
            stroke_width=2,
        )
        for one in found.failures
    ]
    return rings, []


def _conditions(found: FlatStates, drawing: CreaseDrawing) -> tuple[list[str], list[str]]:
    """What is drawn below and above the lines: shaded panels and thick creases; their numbers."""
    panels = sorted({p for one in found.conflict for p in found.panels_of(one.constraint)})
    edges = sorted({edge for one in found.conflict for edge in one.constraint.edges})
    shaded = [
        svg.path(
            _pixels(drawing.places[list(found.pattern.faces[panel])]),
            closed=True,
            class_="marked",
            fill=_MARKED,
            fill_opacity=0.18,
        )
        for panel in panels
    ]
    thick = [
        svg.path(
            _pixels(drawing.places[list(edge)]),
            class_="marked",
            fill="none",
            stroke=_MARKED,
            stroke_opacity=0.75,
            stroke_width=8,
            stroke_linecap="round",
        )
        for edge in edges
    ]
    names = []
    for panel in panels:
        x, y = _middle(found, drawing, panel)
        names.append(svg.text(f"panel {panel}", x, y + 4, anchor="middle", size=_FONT))
    return [*shaded, *thick], names


def _numbers(found: FlatStates, drawing: CreaseDrawing, count: int) -> list[str]:
    """The numbers of the reasons at their places; those at one place stand together."""
    places: dict[tuple[float, float], list[int]] = {}
    beside = max(6.0, 1.6 * drawing.style.marker) + 16
    for number, failure in enumerate(found.failures[:count], 1):
        x, y = drawing.places[failure.vertex]
        places.setdefault((float(x), float(y) + beside), []).append(number)
    if not found.failures:
        for number, one in enumerate(found.conflict[:count], 1):
            spots = [drawing.places[list(edge)].mean(axis=0) for edge in one.constraint.edges]
            if not spots:  # transitivity: at the panels
                for panel in found.panels_of(one.constraint):
                    x, y = _middle(found, drawing, panel)
                    places.setdefault((x, y + 14), []).append(number)
            for x, y in spots:
                places.setdefault((float(x), float(y)), []).append(number)
    return [_plate(x, y, ", ".join(map(str, some))) for (x, y), some in places.items()]


def _plate(x: float, y: float, words: str) -> str:
    """A number on a white plate."""
    wide = 8 + 0.56 * 10 * len(words)
    plate = svg.element(
        "rect",
        x=x - wide / 2,
        y=y - 7,
        width=wide,
        height=14,
        rx=7,
        fill="#ffffff",
        stroke=svg.INK,
        stroke_width=0.8,
    )
    return plate + svg.text(words, x, y + 3.5, anchor="middle", size=10)


def _middle(found: FlatStates, drawing: CreaseDrawing, panel: int) -> tuple[float, float]:
    """A point well inside a panel: the middle of the largest of its convex parts."""
    parts = convex_parts(found.pattern.scaled_vertices, found.pattern.faces[panel])
    corners = max((drawing.places[list(part)] for part in parts), key=lambda c: abs(area(c)))
    x, y = corners.mean(axis=0)
    return float(x), float(y)


def _pixels(points: FloatArray) -> list[svg.Point]:
    return [(float(x), float(y)) for x, y in np.asarray(points)]
