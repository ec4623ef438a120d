"""A flat-folded state as a picture: its translucent layers from both sides."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_legend import legend
from exactfold.app.pictures.crease_style import Style
from exactfold.app.pictures.flat_layers import Layer, bottom_to_top, clipped, edges_on
from exactfold.pattern.panel_pattern import Edge

if TYPE_CHECKING:
    from exactfold.layers.states import State

FRONT, BACK = "#a9d8f2", "#f8f0a0"
"""The two sides of the paper: blue is the side that the crease pattern shows, as in stills."""
OPAQUE: Final = 0.7
"""How much of what lies below a layer it hides."""
_SIZE, _MARGIN, _GAP, _CAPTION = 380.0, 14.0, 30.0, 24.0
_SWATCH: Final = 16.0


def state_picture(state: State, title: str = "") -> str:
    """A flat-folded state from above and from below, side by side, as an SVG file.

    Each layer is drawn over those that lie below it, and 30 % of them are seen through it. The
    front of the paper, which the crease pattern shows, is blue, and its back is yellow. From above
    panel 0 shows its front; from below the sheet is turned over from left to right. Mountains and
    valleys are those of the state, on the front. Each layer is a group with `data-piece` and
    `data-panels`.

    >>> from exactfold.layers.folding import fold_flat
    >>> text = state_picture(fold_flat("single-vertex-4", "MMMV").state())
    >>> text.count('data-panels="0"'), ">from below<" in text
    (2, True)
    """
    drawing = _Drawing(state)
    wide, high = drawing.extent
    parts = []
    for k, caption in enumerate(("from above", "from below")):
        left = k * (wide + _GAP) + _MARGIN
        at = f"translate({svg.number(left)} {svg.number(_MARGIN)})"
        parts.append(svg.element("g", drawing.view(below=k == 1), transform=at))
        parts.append(
            svg.text(caption, left + wide / 2, high + 2 * _MARGIN + 8, anchor="middle", size=13)
        )
    width = 2 * (wide + _MARGIN) + _GAP
    key = legend(drawing.letters, (), drawing.style).extended(_papers())
    across = max(width, min(key.natural, 420.0))
    keyed, below = key.placed(across, high + 2 * _MARGIN + _CAPTION)
    body = svg.element("g", "\n".join(["", *parts, ""]))
    if across > width:
        body = svg.element("g", body, transform=f"translate({svg.number((across - width) / 2)} 0)")
    return svg.picture(across, below, [body, *keyed], title or "flat-folded state")


def _papers() -> list[tuple[str, float, str]]:
    """The samples of the two sides of the paper: drawing, width, and name."""
    return [
        (
            svg.element(
                "rect",
                x=0,
                y=-_SWATCH / 2,
                width=_SWATCH,
                height=_SWATCH,
                fill=colour,
                stroke="#999999",
                stroke_width=0.6,
            ),
            _SWATCH,
            name,
        )
        for colour, name in ((FRONT, "front of the paper"), (BACK, "back"))
    ]


@dataclass(frozen=True)
class _Drawing:
    """The places of the layers of a state in a picture."""

    state: State

    @cached_property
    def layers(self) -> list[Layer]:
        return bottom_to_top(self.state)

    @cached_property
    def places(self) -> FloatArray:
        """The image of each vertex in the sheet's coordinates, shape (V, 2)."""
        return np.array(self.state.images.places, dtype=np.float64)

    @cached_property
    def scale(self) -> float:
        """Pixels for each unit of the sheet."""
        return _SIZE / float(np.ptp(self.places, axis=0).max())

    @cached_property
    def extent(self) -> tuple[float, float]:
        """Width and height of one view."""
        width, height = np.ptp(self.places, axis=0) * self.scale
        return float(width), float(height)

    @cached_property
    def lines(self) -> list[list[tuple[str, Edge]]]:
        """For each piece the lines of the sheet on it, each with its letter."""
        letters = self.state.letters
        return [
            sorted((letters.get(edge, "B"), edge) for edge in edges)
            for edges in edges_on(self.state.images)
        ]

    @cached_property
    def letters(self) -> set[str]:
        """The letters that occur."""
        return {letter for some in self.lines for letter, _ in some}

    @cached_property
    def style(self) -> Style:
        """Widths and dashes of the lines."""
        i, j = np.array(self.state.images.pieces.sheet.edges, dtype=np.intp).T
        lengths = np.linalg.norm(self.places[i] - self.places[j], axis=1)
        return Style.of(float(np.quantile(lengths, 0.3)) * self.scale)

    def view(self, *, below: bool) -> str:
        """All layers as they are seen from above or below, the farthest first."""
        layers = self.layers[::-1] if below else self.layers
        return "\n".join(["", *(self._layer(layer, below=below) for layer in layers), ""])

    def _layer(self, layer: Layer, *, below: bool) -> str:
        """A piece or a part of one, with the lines on it."""
        images = self.state.images
        front = images.maps[layer.piece].flipped == below
        outline = svg.path(
            self._seen(layer.corners, below=below),
            closed=True,
            fill=FRONT if front else BACK,
            fill_opacity=OPAQUE,
            shape_rendering="crispEdges",
        )
        drawn: dict[str, list[str]] = {}
        for letter, edge in self.lines[layer.piece]:
            ends = clipped(self.places[list(edge)], layer.corners)
            if ends is not None:
                (a, b), (c, d) = self._seen(ends, below=below)
                step = f"M{svg.number(a)} {svg.number(b)}L{svg.number(c)} {svg.number(d)}"
                drawn.setdefault(letter, []).append(step)
        lines = [
            svg.element(
                "path",
                "",
                class_=letter,
                d="".join(drawn[letter]),
                fill="none",
                **self.style.attributes(letter),
            )
            for letter in "FVMB"
            if letter in drawn
        ]
        panels = " ".join(map(str, images.pieces.panels[layer.piece]))
        return svg.element(
            "g", "".join([outline, *lines]), data_piece=str(layer.piece), data_panels=panels
        )

    def _seen(self, points: FloatArray, *, below: bool) -> list[svg.Point]:
        """Points as pixels, y downwards; from below, left and right change places."""
        low, high = self.places.min(axis=0), self.places.max(axis=0)
        x = high[0] - points[:, 0] if below else points[:, 0] - low[0]
        return [
            (float(a), float(b))
            for a, b in zip(x * self.scale, (high[1] - points[:, 1]) * self.scale, strict=True)
        ]
