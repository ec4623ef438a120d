"""A sheet with a circle round each vertex: how far it may move."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_drawing import CreaseDrawing, natural_size
from exactfold.app.pictures.crease_lines import crease_lines

if TYPE_CHECKING:
    from exactfold.design.tolerance.result import Tolerance

_ALONE, _TOGETHER = svg.COLOURS[5], svg.COLOURS[2]
_LINE: Final = 16.0


def tolerance_picture(tolerance: Tolerance) -> str:
    """A crease pattern as an SVG file, with two circles round each vertex.

    A vertex may move within its larger circle if the others stay, and all vertices may move at once
    within their smaller circles. All circles are drawn larger by one factor if they are small; a
    line below says by which. Circles have `data-vertex`.

    >>> import exactfold
    >>> text = tolerance_picture(exactfold.tolerance("two-vertex"))
    >>> text.count('class="alone"'), text.count('class="together"')
    (6, 6)
    """
    lines = crease_lines(tolerance.pattern, None)
    drawing = CreaseDrawing(lines, {}, {}, natural_size(lines))
    points = [[float(c) for c in point] for point in tolerance.pattern.vertices]
    spans = [max(column) - min(column) for column in zip(*points, strict=True)]
    pixels = drawing.size / max(spans)
    largest = max(tolerance.vertices.values(), default=0.0) * pixels
    factor = 1.0
    while 0 < largest * factor < drawing.room / 8 and factor < 1e12:
        factor *= 10
    parts = []
    for name, colour in (("alone", _ALONE), ("together", _TOGETHER)):
        for v, (x, y) in enumerate(drawing.places.tolist()):
            own = tolerance.vertices[v] if name == "alone" else tolerance.radius
            parts.append(
                svg.element(
                    "circle",
                    class_=name,
                    data_vertex=str(v),
                    cx=x,
                    cy=y,
                    r=own * pixels * factor,
                    fill=colour,
                    fill_opacity="0.35",
                    stroke=colour,
                )
            )
    # Circles round corners reach over the margin.
    beyond = max(0.0, largest * factor - drawing.margin + 2)
    width, height = (side + 2 * beyond for side in drawing.extent)
    place = f"translate({svg.number(beyond)} {svg.number(beyond)})"
    sheet = svg.element("g", "\n".join([drawing.body(), *parts]), transform=place)
    scale = "" if factor == 1 else f", drawn {factor:g} times as large"
    said = [f"one vertex moves (yellow), all move (green){scale}"]
    if not largest:
        said = ["no radius is positive"]
    notes = [svg.text(text, 8, height + _LINE * (k + 0.5), size=11) for k, text in enumerate(said)]
    return svg.picture(
        max(width, 340.0),
        height + _LINE * (len(said) + 0.5),
        [sheet, *notes],
        "how far vertices may move",
    )
