"""The flat folding map of a sheet: where each piece of it comes to lie if its folds close.

Folds with the letters M, V and U are folded by 180 degrees, and folds with F stay flat. Between
folded folds the sheet is divided into convex pieces. The first piece keeps its place, face up.
Across each folded fold the map is reflected. So it is an isometry on each piece, and it exists if
and only if the reflections round each interior vertex multiply to the identity: any two paths
between two pieces differ by turns round such vertices, as the sheet is a disk.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from ..core.limits import IMAGE_BITS
from ..core.reading import at_most, counted, items, natural, require
from ..core.towers import Number
from ..sheets.panels import Edge, PanelSheet, Vector, cross, pair


class FoldedSheet:
    """A sheet in convex pieces, with its flat folding map.

    `letters` has one of M, V, U and F for each fold of `sheet`. `pieces` has the corners of each
    piece, counter-clockwise, and `folds` all segments (i, j), i < j, between two pieces, with their
    letters in `letters`. `points` holds the image of each corner, and `up` tells for each piece
    whether it keeps its face up. Raises `CertificateError` if the pieces do not tile the sheet, or
    if the folds do not close.
    """

    def __init__(
        self, sheet: PanelSheet, letters: Mapping[Edge, str], pieces: list[tuple[int, ...]]
    ) -> None:
        self.sheet, self.tower, self.pieces = sheet, sheet.tower, pieces
        self.beside = _beside(sheet, letters, pieces)
        self.folds = sorted((i, j) for i, j in self.beside if i < j and (j, i) in self.beside)
        self.letters = {fold: letters.get(fold, "F") for fold in self.folds}
        for v in sheet.interior:
            require(closes(sheet, letters, v), f"the folds do not close at vertex {v}")
        self.up: list[bool] = [True] * len(pieces)
        self.points: dict[int, Vector] = {}
        self._fold()

    def pieces_of(self, fold: Edge) -> tuple[int, int]:
        """The two pieces of a fold: the one on the left of i-j, with i < j, first."""
        i, j = fold
        return self.beside[i, j], self.beside[j, i]

    def is_folded(self, edge: Edge) -> bool:
        """Whether an edge is a fold that is folded."""
        return self.letters[edge] != "F"

    @cached_property
    def lettered(self) -> dict[Edge, Edge]:
        """For each fold with M or V its two pieces, the lower one first.

        A valley brings the pieces on its two sides face to face, so that the one that is turned
        over lies above the other. A mountain brings them back to back.
        """
        orders = {}
        for fold, letter in self.letters.items():
            if letter in ("M", "V"):
                one, other = self.pieces_of(fold)
                orders[fold] = (one, other) if self.up[one] == (letter == "V") else (other, one)
        return orders

    def _fold(self) -> None:
        """Find the images, piece by piece, from the first.

        With complex numbers the map is w = u z + t where a piece has its face up, and
        w = u conj(z) + t where it is turned over. Across a fold with direction d the factor u
        becomes u r, or u conj(r) for a piece that was turned over, where r = d^2 / |d|^2.
        """
        sheet = self.sheet
        one, zero = self.tower.number(1), self.tower.number(0)
        factors = {0: (one, zero)}
        start = self.pieces[0]
        self.points[start[0]] = sheet.points[start[0]]
        waiting = [(0, start[0])]
        while waiting:
            k, known = waiting.pop()
            self._place(k, known, factors[k])
            for i, j in sides(self.pieces[k]):
                other = self.beside.get((j, i))
                if other is None or other in factors:
                    continue
                factors[other], self.up[other] = factors[k], self.up[k]
                if self.is_folded(pair(i, j)):
                    turn = _turn(sheet.vector(i, j))
                    over = turn if self.up[k] else (turn[0], -turn[1])
                    factors[other] = _times(factors[k], over)
                    self.up[other] = not self.up[k]
                for part in (c for number in factors[other] for c in number.parts):
                    bits = max(part.numerator.bit_length(), part.denominator.bit_length())
                    at_most(bits, IMAGE_BITS, "the bits of an image", "IMAGE_BITS")
                waiting.append((other, i))

    def _place(self, k: int, known: int, factor: Vector) -> None:
        """Find the images of the corners of a piece, one of which is known."""
        x, y = self.points[known]
        for v in self.pieces[k]:
            if v not in self.points:
                a, b = self.sheet.vector(known, v)
                dx, dy = _times(factor, (a, b if self.up[k] else -b))
                self.points[v] = x + dx, y + dy


def read_letters(sheet: PanelSheet, text: Any) -> dict[Edge, str]:
    """The letter of each fold: a text of M, V, U and F, in the order of the folds."""
    fits = isinstance(text, str) and len(text) == len(sheet.folds) and set(text) <= set("MVUF")
    require(fits, "the letters are not one of M, V, U, F for each fold")
    return dict(zip(sheet.folds, text, strict=True))


def asked(letters: str) -> str:
    """The letters that are asked for, in words."""
    given, folds = len(letters.replace("U", "")), counted(len(letters), "fold", "folds")
    some = f"the {counted(given, 'letter', 'letters')} asked for" if given else "any letters"
    return f"with {some} on {folds}"


def read_pieces(sheet: PanelSheet, value: Any) -> list[tuple[int, ...]]:
    """Read convex polygons, with corners at vertices of the sheet, counter-clockwise.

    All corners lie on the left of each side or on its line, so that the sides lie on the border of
    the convex hull. The corners differ, so that the sides run round it once.
    """
    pieces = []
    for k, entry in enumerate(items(value, "the pieces")):
        piece = tuple(natural(v, "a corner") for v in items(entry, f"piece {k}"))
        known = len(piece) > 2 and max(piece) < len(sheet.points)
        require(known and len(set(piece)) == len(piece), f"piece {k} is not a polygon")
        for i, j in sides(piece):
            along = sheet.vector(i, j)
            on = [cross(along, sheet.vector(i, v)).sign() for v in piece if v not in (i, j)]
            convex = min(on) >= 0 < max(on)
            require(convex, f"piece {k} is not convex, or not counter-clockwise")
        pieces.append(piece)
    return pieces


def _beside(
    sheet: PanelSheet, letters: Mapping[Edge, str], pieces: list[tuple[int, ...]]
) -> dict[Edge, int]:
    """The piece on the left of each directed side; raises unless the pieces tile the sheet.

    No side appears twice, and what has no piece on its right is the boundary of the sheet. So at
    each point the number of pieces that cover it, which is the sum of their winding numbers, is the
    winding number of the boundary: 1 inside of the sheet, and 0 outside. Each folded fold is a side
    of two pieces, so that it does not run through a piece.
    """
    owned = [(side, k) for k, piece in enumerate(pieces) for side in sides(piece)]
    beside = dict(owned)
    require(len(beside) == len(owned), "two pieces lie on one side of an edge")
    rim = {(i, j) for i, j in beside if (j, i) not in beside}
    around = {side for panel in sheet.panels for side in sides(panel)}
    boundary = {(i, j) for i, j in around if (j, i) not in around}
    require(rim == boundary, "the pieces do not have the boundary of the sheet")
    for (i, j), letter in letters.items():
        whole = letter == "F" or {(i, j), (j, i)} <= beside.keys()
        require(whole, f"fold {i}-{j} is not a side of two pieces")
    return beside


def sides(piece: tuple[int, ...]) -> list[Edge]:
    """The directed sides of a piece, which lies on the left of each."""
    return list(zip(piece, (*piece[1:], piece[0]), strict=True))


def closes(sheet: PanelSheet, letters: Mapping[Edge, str], v: int) -> bool:
    """Whether the reflections across the folded folds round an interior vertex give the identity.

    Two reflections, across lines at the angles a and b, give a rotation by 2 (a - b). So the number
    of folded folds has to be even, and a_1 - a_2 + a_3 - ... a multiple of pi: the product of their
    directions, with every other one conjugated, is a real number (Kawasaki's theorem).
    """
    near = [u for u in sheet.around[v] if letters[pair(v, u)] != "F"]
    if len(near) % 2:
        return False
    one, zero = sheet.tower.number(1), sheet.tower.number(0)
    product = (one, zero)
    for k, u in enumerate(near):
        x, y = sheet.vector(v, u)
        product = _times(product, (x, y if k % 2 else -y))
    return product[1].sign() == 0


def _times(a: Vector, b: Vector) -> Vector:
    """The product of two complex numbers."""
    return a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]


def _turn(d: Vector) -> tuple[Number, Number]:
    """The complex number d^2 / |d|^2: reflected across the line of d, z becomes this by conj(z)."""
    x, y = d
    square = x * x + y * y
    return (x * x - y * y) / square, (x * y + x * y) / square
