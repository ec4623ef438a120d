"""Crease patterns as SVG pictures: mountains red, valleys blue and dashed, width by fold angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.app.pictures import svg
from exactfold.app.pictures.crease_labels import Label, gaps, labels
from exactfold.app.pictures.crease_legend import legend
from exactfold.app.pictures.crease_lines import CreaseLines, Drawable, crease_lines
from exactfold.app.pictures.crease_style import Style, mark
from exactfold.pattern.crease_pattern import Edge

SIZE, LARGEST = 440.0, 960.0
"""The longer side of the sheet in a picture; up to the second size if there are many lines."""
_APART: Final = 30.0
"""A picture grows until neighbouring points are this many pixels apart."""
MOST: Final = 4000
"""If there are more lines than this, lines of the same kind are one element."""
_STEPS: Final = 8
"""The number of different widths if lines are joined."""
_LABELLED: Final = 1500
"""If there are more vertices than this, no vertex has its number, because no font is
small enough.
"""
_ORDER: Final = "FUVMB"
"""Lines whose letter comes later in this order are drawn over earlier ones."""


def pattern_picture(
    pattern: Drawable,
    letters: Mapping[Edge, str] | None = None,
    *,
    signs: Mapping[int, int] | None = None,
    angles: Mapping[Edge, float] | None = None,
    title: str = "",
    size: float | None = None,
    labelled: bool = True,
    keyed: bool = True,
    joined: bool | None = None,
) -> str:
    """A crease pattern as an SVG file: lines by their letters, and vertices by their signs.

    `letters` are those of the folds (i, j), i < j. Folds without an entry are drawn as folds
    without a letter, and J is drawn as flat. `signs` are those of interior vertices: 1, -1 or 0.
    `angles` are those of the folds, in any unit; a line is the wider, the larger its angle. A
    `Drawing`, which need not be a sheet, has its own letters. `labelled` adds the numbers of
    vertices where there is room, and `keyed` adds a legend below. `size` is the longer side of the
    sheet in pixels; by default it is between 440 and 960, depending on how close the lines are.

    Every line is an element with the class M, V, F, U or B, and with `data-edge`, its place in
    `pattern.edges`; folds also have `data-fold`, such as "4-9". Interior vertices are groups with
    the class up, down, flat or vertex, and with `data-vertex`. If `joined` is true, all lines of
    one kind and width form one element without these attributes; this is the default beyond 4000
    lines.

    >>> from exactfold.pattern.families import single_vertex
    >>> text = pattern_picture(single_vertex(4), {(0, 4): "M", (1, 4): "V"}, signs={4: 1})
    >>> text.count('class="M"'), text.count('class="B"'), text.count("data-fold=")
    (1, 4, 4)
    >>> '<g class="up" data-vertex="4">' in text
    True
    """
    lines = crease_lines(pattern, letters)
    wide = size or natural_size(lines)
    drawing = CreaseDrawing(lines, signs or {}, angles or {}, wide, labelled, joined)
    return drawing.picture(title or "crease pattern", keyed=keyed)


def natural_size(lines: CreaseLines) -> float:
    """The longer side of a sheet at which its lines can be distinguished."""
    return min(max(SIZE, _APART / max(lines.spacing, 1e-9)), LARGEST)


@dataclass(frozen=True)
class CreaseDrawing:
    """Lines at their places in a picture, and everything that depends on how many there are."""

    lines: CreaseLines
    signs: Mapping[int, int]
    angles: Mapping[Edge, float]
    size: float = SIZE
    labelled: bool = True
    joined: bool | None = None
    of_family: bool = False

    @cached_property
    def margin(self) -> float:
        """The margin round the sheet, which has room for the numbers of the boundary vertices."""
        return 20.0 if self.labelled and self.font else max(4.0, 0.02 * self.size)

    @cached_property
    def extent(self) -> tuple[float, float]:
        """Width and height of the picture, without a legend."""
        width, height = self.lines.extent
        return width * self.size + 2 * self.margin, height * self.size + 2 * self.margin

    @cached_property
    def places(self) -> FloatArray:
        """The points in the picture, y downwards, shape (V, 2)."""
        height = self.lines.extent[1]
        x, y = self.lines.points[:, 0], height - self.lines.points[:, 1]
        return np.column_stack([x, y]) * self.size + self.margin

    @property
    def room(self) -> float:
        """The distance of neighbouring points in the picture."""
        return self.lines.spacing * self.size

    @cached_property
    def style(self) -> Style:
        """Widths, dashes and sizes of markers."""
        return Style.of(self.room)

    @cached_property
    def font(self) -> float:
        """The font size of the numbers; 0 if they would be illegible."""
        wanted = min(0.3 * self.room, 12.0)
        few = len(self.lines.points) <= _LABELLED and self.lines.vertices
        return max(wanted, 7.0) if self.labelled and few and wanted >= 5.0 else 0.0

    def width(self, edge: Edge, letter: str) -> float:
        """The width of a line."""
        return self.style.width(letter, self._share(edge))

    def _share(self, edge: Edge) -> float | None:
        """The relative width for a fold angle, from 0 to 1; None if the angle is not known.

        It is the square root of the angle over the largest angle. Without the root, one narrow
        triangle would make all other lines look alike.
        """
        if not self.largest or edge not in self.angles:
            return None
        return sqrt(min(abs(self.angles[edge]) / self.largest, 1.0))

    @cached_property
    def largest(self) -> float:
        """The size of the largest fold angle, in the unit in which angles are given."""
        return max((abs(a) for a in self.angles.values()), default=0.0)

    # --- elements --------------------------------------------------------------------------------

    def picture(self, title: str, *, keyed: bool = True) -> str:
        """The whole SVG file, with a legend if `keyed`."""
        width, height = self.extent
        body = self.body()
        if not keyed:
            return svg.picture(width, height, [body], title)
        key = legend(
            self.lines.letters,
            self.signs.values(),
            self.style,
            by_angle=bool(self.largest),
            of_way=bool(self.signs or self.angles) or self.of_family,
            of_family=self.of_family,
        )
        wide = max(width, min(key.natural, 320.0))
        parts, below = key.placed(wide, height)
        aside = (wide - width) / 2
        shifted = body if aside < 0.5 else _moved(body, aside)
        return svg.picture(wide, below, [shifted, *parts], title)

    def body(self) -> str:
        """All lines and vertices, in one group."""
        joined = len(self.lines.edges) > MOST if self.joined is None else self.joined
        groups = [self._group(letter, joined) for letter in _ORDER if letter in self.lines.letters]
        vertices = self._vertices()
        if vertices:
            groups.append(svg.element("g", vertices, class_="vertices"))
        return svg.element("g", "\n".join(["", *groups, ""]), class_="pattern")

    def _group(self, letter: str, joined: bool) -> str:
        """The lines with one letter."""
        plain = not self.of_family and not set(self.lines.letters) - {"B", "U"}
        chosen = [k for k, other in enumerate(self.lines.letters) if other == letter]
        content = self._few(letter, chosen) if joined else self._each(letter, chosen)
        style = self.style.attributes(letter, alone=plain)
        name = {"B": "border"}.get(letter, "folds")
        return svg.element("g", f"\n{content}\n", class_=name, fill="none", **style)

    def _each(self, letter: str, chosen: list[int]) -> str:
        usual = self.style.width(letter, None)
        paths = []
        for k in chosen:
            edge = self.lines.edges[k]
            width = self.width(edge, letter)
            paths.append(
                svg.element(
                    "path",
                    class_=letter,
                    data_fold=f"{edge[0]}-{edge[1]}" if letter != "B" else None,
                    data_edge=str(k),
                    stroke_width=width if abs(width - usual) > 1e-9 else None,
                    d=self._line(edge),
                )
            )
        return "\n".join(paths)

    def _few(self, letter: str, chosen: list[int]) -> str:
        """The same lines, where those of nearly the same width form one element."""
        rows: dict[float, list[str]] = {}
        for k in chosen:
            edge = self.lines.edges[k]
            share = self._share(edge)
            step = None if share is None else round(share * _STEPS) / _STEPS
            rows.setdefault(self.style.width(letter, step), []).append(self._short(edge))
        return "\n".join(
            svg.element("path", class_=letter, stroke_width=width, d="".join(steps))
            for width, steps in sorted(rows.items())
        )

    def _line(self, edge: Edge) -> str:
        (a, b), (c, d) = self.places[list(edge)].tolist()
        return f"M{svg.number(a)} {svg.number(b)}L{svg.number(c)} {svg.number(d)}"

    def _short(self, edge: Edge) -> str:
        """The same line to a tenth of a pixel, with the second end relative to the first."""
        (a, b), (c, d) = self.places[list(edge)].round(1).tolist()
        return f"M{svg.number(a)} {svg.number(b)}l{svg.number(c - a)} {svg.number(d - b)}"

    def _vertices(self) -> str:
        """A group for each interior vertex that has room, and the numbers of the boundary
        vertices.
        """
        marked = self._marked
        numbers = {label.vertex: label for label in self._numbers(marked)}
        groups = []
        for v in self.lines.interior:
            content = mark(self.places[v], self.signs.get(v), marked[v]) if v in marked else ""
            if v in numbers:
                content += self._number(numbers[v], svg.INK)
            if content:
                groups.append(svg.element("g", content, class_=self._class(v), data_vertex=str(v)))
        inside = set(self.lines.interior)
        groups += [
            svg.element("g", self._number(n, "#777777"), class_="rim", data_vertex=str(v))
            for v, n in sorted(numbers.items())
            if v not in inside
        ]
        return "\n".join(groups)

    def _class(self, vertex: int) -> str:
        return {1: "up", -1: "down", 0: "flat"}.get(self.signs.get(vertex, 2), "vertex")

    @cached_property
    def _marked(self) -> dict[int, float]:
        """The interior vertices with a marker, and its radius.

        A vertex has no marker if markers would meet. With more than 4000 lines there are no
        markers, in order to keep the file small.
        """
        from scipy.spatial import cKDTree

        radius = self.style.marker
        if not radius or not self.lines.interior or len(self.lines.edges) > MOST:
            return {}
        apart, _ = cKDTree(self.places).query(self.places, k=2)
        radii = {}
        for v in self.lines.interior:
            wanted = radius if v in self.signs else radius / 2
            if apart[v, 1] >= 2.2 * wanted:
                radii[v] = wanted
        return radii

    def _numbers(self, marked: Mapping[int, float]) -> list[Label]:
        """The numbers that find room: near interior vertices, and outside the sheet for boundary
        vertices.
        """
        if not self.font:
            return []
        inside, outward = set(self.lines.interior), {}
        for v, near in self.lines.neighbours.items():
            if v not in inside:
                outward[v] = self._outward(v, near)
        asked = [*self.lines.interior, *sorted(outward)]
        return labels(self.places, self.lines.edges, marked, asked, self.font, outward)

    def _outward(self, vertex: int, near: Sequence[int]) -> float:
        """The middle direction of the widest sector between two border lines at a vertex.

        It is in radians, with y downwards.
        """
        boundary = self._boundary
        around = gaps(self.places, vertex, near)
        sectors = []
        for n, (k, wide, middle) in enumerate(around):
            after = near[around[(n + 1) % len(around)][0]]
            if {(vertex, near[k]), (vertex, after)} <= boundary:
                sectors.append((wide, middle))
        return max(sectors)[1]

    @cached_property
    def _boundary(self) -> frozenset[Edge]:
        """The lines of the boundary, in both directions."""
        pairs = zip(self.lines.edges, self.lines.letters, strict=True)
        sides = [edge for edge, letter in pairs if letter == "B"]
        return frozenset([*sides, *((j, i) for i, j in sides)])

    def _number(self, label: Label, colour: str) -> str:
        x, y = label.place
        return svg.text(
            str(label.vertex), x, y + 0.35 * self.font, anchor="middle", size=self.font, fill=colour
        )


def _moved(content: str, x: float, y: float = 0.0) -> str:
    return svg.element("g", content, transform=f"translate({svg.number(x)} {svg.number(y)})")
