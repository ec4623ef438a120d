"""The flat folding map of a sheet: where each panel comes to lie if its folds close.

Folds with the letters M, V and U are folded by 180 degrees, and folds with F stay flat. The first
panel keeps its place, face up. Across each folded fold the map is reflected. So it is an isometry
on each panel, and it exists if and only if the reflections round each interior vertex multiply to
the identity: any two paths between two panels differ by turns round such vertices, as the sheet is
a disk.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

from ..core.limits import IMAGE_BITS
from ..core.reading import at_most, require
from ..core.towers import Number
from ..sheets.panels import Edge, PanelSheet, Vector, cross, pair, read_edges


class FoldedSheet:
    """A sheet of convex panels with its flat folding map.

    `letters` has one of M, V, U and F for each fold. `points` holds the image of each vertex, and
    `up` tells for each panel whether it keeps its face up. Raises `CertificateError` if some panel
    is not convex, or if the folds do not close.
    """

    def __init__(self, sheet: PanelSheet, letters: Mapping[Edge, str]) -> None:
        self.sheet, self.tower, self.letters = sheet, sheet.tower, letters
        for panel in sheet.panels:
            name = "-".join(map(str, panel))
            require(is_convex(sheet, panel), f"panel {name} is not convex: cut it")
        for v in sheet.interior:
            require(closes(sheet, letters, v), f"the folds do not close at vertex {v}")
        self.beside: dict[Edge, int] = {}
        for k, panel in enumerate(sheet.panels):
            for i, j in sides(panel):
                self.beside[i, j] = k
        self.up: list[bool] = [True] * len(sheet.panels)
        self.points: dict[int, Vector] = {}
        self._fold()

    def panels_of(self, fold: Edge) -> tuple[int, int]:
        """The two panels of a fold: the one on the left of i-j, with i < j, first."""
        i, j = fold
        return self.beside[i, j], self.beside[j, i]

    def is_folded(self, edge: Edge) -> bool:
        """Whether an edge is a fold that is folded."""
        return self.letters.get(edge, "F") != "F"

    @cached_property
    def lettered(self) -> dict[Edge, Edge]:
        """For each fold with M or V its two panels, the lower one first.

        A valley brings the panels on its two sides face to face, so that the one that is turned
        over lies above the other. A mountain brings them back to back.
        """
        orders = {}
        for fold, letter in self.letters.items():
            if letter in ("M", "V"):
                one, other = self.panels_of(fold)
                orders[fold] = (one, other) if self.up[one] == (letter == "V") else (other, one)
        return orders

    def _fold(self) -> None:
        """Find the images, panel by panel, from the first.

        With complex numbers the map is w = u z + t where a panel has its face up, and
        w = u conj(z) + t where it is turned over. Across a fold with direction d the factor u
        becomes u r, or u conj(r) for a panel that was turned over, where r = d^2 / |d|^2.
        """
        sheet = self.sheet
        one, zero = self.tower.number(1), self.tower.number(0)
        factors = {0: (one, zero)}
        start = sheet.panels[0]
        self.points[start[0]] = sheet.points[start[0]]
        waiting = [(0, start[0])]
        while waiting:
            k, known = waiting.pop()
            self._place(k, known, factors[k])
            for i, j in sides(sheet.panels[k]):
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
        """Find the images of the corners of a panel, one of which is known."""
        x, y = self.points[known]
        for v in self.sheet.panels[k]:
            if v not in self.points:
                a, b = self.sheet.vector(known, v)
                dx, dy = _times(factor, (a, b if self.up[k] else -b))
                self.points[v] = x + dx, y + dy


def read_letters(sheet: PanelSheet, text: Any) -> dict[Edge, str]:
    """The letter of each fold: a text of M, V, U and F, in the order of the folds."""
    fits = isinstance(text, str) and len(text) == len(sheet.folds) and set(text) <= set("MVUF")
    require(fits, "the letters are not one of M, V, U, F for each fold")
    return dict(zip(sheet.folds, text, strict=True))


def read_folded(sheet: PanelSheet, letters: Mapping[Edge, str], cuts: Any) -> FoldedSheet:
    """The folded sheet, once its panels that are not convex are cut along the given edges.

    A cut is a flat fold: the states of the sheet and of the cut sheet are the same.
    """
    more = read_edges(cuts, "the cuts")
    if not more:
        return FoldedSheet(sheet, letters)
    cut = PanelSheet(sheet.tower, sheet.points, sorted([*sheet.edges, *more]))
    inside = set(cut.folds).issuperset(more)
    require(inside, "a cut runs outside of the sheet")
    return FoldedSheet(cut, {**letters, **dict.fromkeys(more, "F")})


def sides(panel: tuple[int, ...]) -> list[Edge]:
    """The directed edges round a panel, which lies on the left of each."""
    return list(zip(panel, (*panel[1:], panel[0]), strict=True))


def is_convex(sheet: PanelSheet, panel: tuple[int, ...]) -> bool:
    """Whether no corner of a panel is reflex; straight corners are allowed."""
    before = (panel[-1], *panel[:-1])
    after = (*panel[1:], panel[0])
    return all(
        cross(sheet.vector(a, v), sheet.vector(v, b)).sign() >= 0
        for a, v, b in zip(before, panel, after, strict=True)
    )


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
