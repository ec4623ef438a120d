"""The flat folding map: where each piece of a sheet lies once all creases are folded."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

from exactfold._support.verdict import PROVED, REFUTED, Verdict
from exactfold.exact.surds import Number, Surd, exact
from exactfold.layers.pieces import Pieces
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

Complex: TypeAlias = tuple[Surd, Surd]
"""A complex number with its real and its imaginary part in the field of the sheet."""


@dataclass(frozen=True)
class Isometry:
    """A map z -> turn z + shift of the plane, or z -> turn conj(z) + shift if `flipped`.

    `turn` is a complex number of absolute value 1.
    """

    turn: Complex
    shift: Complex
    flipped: bool

    def __call__(self, point: Sequence[Number]) -> Complex:
        """The image of a point."""
        x, y = point
        z = (self.turn[0] * x, self.turn[1] * x)
        w = (self.turn[1] * y, self.turn[0] * y)
        if self.flipped:
            return z[0] + w[0] + self.shift[0], z[1] - w[1] + self.shift[1]
        return z[0] - w[0] + self.shift[0], z[1] + w[1] + self.shift[1]

    @property
    def matrix(self) -> tuple[tuple[Surd, Surd], tuple[Surd, Surd]]:
        """The linear part by rows."""
        c, s = self.turn
        return ((c, s), (s, -c)) if self.flipped else ((c, -s), (s, c))

    def after_reflection(self, direction: Complex, through: Point) -> Isometry:
        """The map that first reflects in a line through a point, and then is this one.

        `direction` is d / conj(d) for a vector d along the line.
        """
        turn = _times(self.turn, _conjugate(direction) if self.flipped else direction)
        bare = Isometry(turn, (turn[0] * 0, turn[0] * 0), not self.flipped)
        (ax, ay), (bx, by) = self(through), bare(through)
        return Isometry(turn, (ax - bx, ay - by), not self.flipped)


@dataclass(frozen=True, repr=False)
class Images:
    """The exact images of all pieces, where one piece keeps its place and faces up.

    `maps` has the isometry of each piece, for the coordinates `scaled_vertices` of the sheet.
    `torn` has the creases and joints whose two pieces disagree about the image: if there are any,
    no flat folding map exists, and the condition of Kawasaki fails at a vertex. The sheet is a
    disk, so that the conditions at its interior vertices are sufficient for the map to exist, too.
    """

    pieces: Pieces
    maps: tuple[Isometry, ...]
    torn: tuple[Edge, ...] = field(default=())

    @property
    def exists(self) -> Verdict:
        """Whether the flat folding map exists."""
        return REFUTED if self.torn else PROVED

    @cached_property
    def points(self) -> Mapping[int, Complex]:
        """The image of each vertex of the pieces; only if the map exists."""
        points: dict[int, Complex] = {}
        vertices = self.pieces.sheet.scaled_vertices
        for polygon, place in zip(self.pieces.polygons, self.maps, strict=True):
            for v in polygon:
                if v not in points:
                    points[v] = place(vertices[v])
        return points

    @cached_property
    def places(self) -> tuple[tuple[float, float], ...]:
        """The image of each vertex of the sheet, in its coordinates, rounded to floats."""
        sheet, scale = self.pieces.sheet, exact(self.scale)
        found = dict(self.points)
        for panel, face in enumerate(sheet.faces):
            place = self.maps[self.pieces.of_panel[panel][0]]
            for v in face:
                if v not in found:
                    found[v] = place(sheet.scaled_vertices[v])
        ordered = (found[v] for v in range(len(sheet.vertices)))
        return tuple((float(x / scale), float(y / scale)) for x, y in ordered)

    @property
    def scale(self) -> Number:
        """By how much the coordinates of `maps` are larger than those of the sheet."""
        sheet = self.pieces.sheet
        for point, scaled in zip(sheet.vertices, sheet.scaled_vertices, strict=True):
            for c, s in zip(point, scaled, strict=True):
                if c:
                    return exact(s) / exact(c)
        return 1

    def __repr__(self) -> str:
        return f"<Images: {self.exists}, {self.pieces!r}>"


def images_of(pieces: Pieces) -> Images:
    """The flat folding map of a sheet, found piece by piece, nearest first, and then compared.

    The map of a piece is that of its neighbour after a reflection in the crease between them
    (docs/flat.md, Where the paper lies).

    >>> from exactfold.layers.pieces import pieces_of
    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> strip = PanelPattern([(0, 0), (1, 0), (3, 0), (3, 1), (1, 1), (0, 1)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (0, 5), (1, 4)])
    >>> found = images_of(pieces_of(strip, {}))
    >>> found.exists, found.points[2]
    (<Verdict.PROVED: 'proved'>, (-1, 0))
    """
    sheet = pieces.sheet
    number = sheet.field.number
    zero, one = number(0), number(1)
    around: list[list[tuple[Edge, int, bool]]] = [[] for _ in pieces.polygons]
    for known, folded in ((pieces.creases, True), (pieces.joints, False)):
        for edge, (left, right) in known.items():
            around[left].append((edge, right, folded))
            around[right].append((edge, left, folded))
    directions = doubled_directions(sheet)
    maps: dict[int, Isometry] = {0: Isometry((one, zero), (zero, zero), False)}
    torn: set[Edge] = set()
    waiting = deque([0])
    while waiting:
        piece = waiting.popleft()
        for edge, other, folded in around[piece]:
            if other in maps and other < piece:
                continue  # compared from the other side
            place = maps[piece]
            if folded:
                place = place.after_reflection(directions[edge], sheet.scaled_vertices[edge[0]])
            if other not in maps:
                maps[other] = place
                waiting.append(other)
            elif maps[other] != place:
                torn.add(edge)
    return Images(pieces, tuple(maps[k] for k in range(len(pieces.polygons))), tuple(sorted(torn)))


def _times(a: Complex, b: Complex) -> Complex:
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _conjugate(a: Complex) -> Complex:
    return a[0], -a[1]


def doubled_directions(sheet: PanelPattern) -> dict[Edge, Complex]:
    """For each fold d / conj(d), where d is its direction: the reflection in the fold turns by it.

    >>> from exactfold.pattern.opening import panels
    >>> from exactfold.pattern.families import single_vertex
    >>> doubled_directions(panels(single_vertex(4)))[0, 4]
    (1, 0)
    """
    number = sheet.field.number
    found: dict[Edge, Complex] = {}
    for fold in sheet.folds:
        x, y = map(number, sheet.direction(*fold))
        scale = 1 / (x * x + y * y)
        found[fold] = (x * x - y * y) * scale, 2 * x * y * scale
    return found


def closes(around: Sequence[Complex]) -> bool:
    """Whether the reflections in folds round a vertex multiply to the identity.

    `around` has d / conj(d) for each fold, in cyclic order. Two reflections are a rotation by their
    quotient; this is Kawasaki's condition (docs/flat.md, Where the paper lies).
    """
    if len(around) % 2:
        return False
    even = odd = None
    for first, second in zip(around[0::2], around[1::2], strict=True):
        even = first if even is None else _times(even, first)
        odd = second if odd is None else _times(odd, second)
    return even == odd
