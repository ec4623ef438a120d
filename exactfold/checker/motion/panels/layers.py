"""The order of layers in which a motion of panels ends whose folds all close together.

Near closing, the levelled heights of the panels tend to affine functions of the points of the
folded image, and their order becomes that of the layers (docs/motion.md, Theorem 11).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TypedDict

from ...core.intervals import Interval
from ...core.reading import counted, keys, require
from ...layers.folding import FoldedSheet, read_pieces, sides
from ...layers.overlaps import Overlaps
from ...layers.state import read_bits
from ...sheets.panels import Edge
from ..claims import Document
from .closing import LastStretch
from .folding import Folding, PanelClaim
from .series import BITS

_NIL = Interval(0, 0, BITS)
Place = Sequence[Interval]
"""The levelled coordinates x, y and z of a vertex at the end."""


class LayersDocument(TypedDict):
    """An order of layers, as it stands in a file."""

    pieces: list[list[int]]
    order: str


class Layers(PanelClaim):
    """The motion ends in the flat-folded state with the order of layers `layers`.

    It has the keys `pieces` and `order` of the evidence of a flat-folded state
    (`exactfold/checker/layers/state.py`): the first piece keeps its place, face up.
    """

    names = ("layers",)
    always = True

    def check(self, folding: Folding) -> None:
        """Refuse an order that is not that of the heights; `Closed` has verified the rest."""
        claim, drive = self.claims["layers"], folding.drive
        keys(claim, "pieces order", "layers")
        pieces = read_pieces(drive.sheet, claim["pieces"])
        overlaps = Overlaps(FoldedSheet(drive.sheet, drive.letters, pieces))
        bits = read_bits(claim["order"], len(overlaps.pairs), "the order")
        heights = Heights(folding, overlaps)
        for (i, j), bit in zip(overlaps.pairs, bits, strict=True):
            folding.panels.spend(len(pieces[i]) * len(pieces[j]))
            side, word = (-1, "below") if bit == "1" else (1, "above")
            proved = heights.sign(i, j) == side
            require(proved, f"piece {i} is not proved to end {word} piece {j}")

    @staticmethod
    def said(claims: Document) -> str:
        """That the motion ends in a flat-folded state."""
        layers = claims.get("layers")
        if layers is None:
            return ""
        number = counted(len(layers["pieces"]), "piece", "pieces")
        return f"; it ends in the flat-folded state with the given order of layers of its {number}"


class Heights:
    """The heights of the pieces of a folded sheet over its image, as a motion closes.

    They are those of `LastStretch`, which holds another panel than the folded sheet. This moves the
    image and adds one affine function to all heights, so that differences at a point are the same;
    if it turns the image over, their signs change.
    """

    def __init__(self, folding: Folding, overlaps: Overlaps) -> None:
        self.pieces, self.plane = overlaps.pieces, overlaps.plane
        places = LastStretch(folding).series(_NIL)
        self.places: list[Place] = [[c.coefficients[0] for c in place] for place in places]
        self._corners = [self._spread(piece) for piece in self.pieces]
        a, b, c = (self.places[v] for v in self._corners[0])
        self._up = _cross(a, b, c).sign()  # -1 if the held panel is turned over

    def sign(self, one: int, two: int) -> int:
        """1 if a piece that overlaps another ends above it, -1 if below; 0 if that is not known.

        Both heights are affine where the images overlap, which is a convex polygon. A difference
        that is not 0 at a corner of it has the same sign at points inside of both images.
        """
        for place in self._common(one, two):
            sign = (self._height(one, place) - self._height(two, place)).sign()
            if sign:
                return sign * self._up
        return 0

    def _common(self, one: int, two: int) -> Iterator[Place]:
        """The corners of the common part of two images."""
        yield from (self.places[v] for v in self.pieces[one] if self._covers(two, v))
        yield from (self.places[v] for v in self.pieces[two] if self._covers(one, v))
        for (p, q), (r, s) in product(sides(self.pieces[one]), sides(self.pieces[two])):
            if self._parts((p, q), (r, s)) and self._parts((r, s), (p, q)):
                a, b, c, d = (self.places[v] for v in (p, q, r, s))
                from_a, from_b = _cross(c, d, a), _cross(c, d, b)
                share = from_a / (from_a - from_b)
                yield [x + share * (y - x) for x, y in zip(a, b, strict=True)]

    def _covers(self, piece: int, v: int) -> bool:
        """Whether a corner lies in the image of a piece, or on its border."""
        plane = self.plane
        spot = plane.spots[plane.spot_of[v]]
        halves = (plane.half(side) for side in sides(self.pieces[piece]))
        return all(plane.side(line, spot) * inner >= 0 for line, inner in halves)

    def _parts(self, edge: Edge, other: Edge) -> bool:
        """Whether the ends of an edge lie on different sides of the line of another."""
        plane = self.plane
        p, q = (plane.side(plane.line(other), plane.spots[plane.spot_of[v]]) for v in edge)
        return p * q < 0

    def _height(self, piece: int, place: Place) -> Interval:
        """The height of a piece over a point of the image."""
        a, b, c = (self.places[v] for v in self._corners[piece])
        whole = _cross(a, b, c)
        first, second = _cross(a, place, c) / whole, _cross(a, b, place) / whole
        return a[2] + first * (b[2] - a[2]) + second * (c[2] - a[2])

    def _spread(self, piece: tuple[int, ...]) -> tuple[int, int, int]:
        """Three corners of a piece, not on one line, counter-clockwise in the sheet."""
        plane, (first, second) = self.plane, piece[:2]
        line = plane.line((first, second))
        off = (v for v in piece if plane.side(line, plane.spots[plane.spot_of[v]]))
        return first, second, next(off)


def _cross(a: Place, b: Place, c: Place) -> Interval:
    """Twice the signed area of the triangle of three points of the image."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
