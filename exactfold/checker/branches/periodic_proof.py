"""How each pair of opposite sign vectors of a periodic sheet is covered; see `periodic`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from itertools import product
from typing import Any, TypedDict

from ..core.krawczyk import Krawczyk
from ..core.limits import PERIODIC_VERTICES
from ..core.linear import echelon, kernel
from ..core.reading import (
    at_most,
    digits,
    items,
    keys,
    natural,
    parse_rational,
    require,
)
from ..sheets.boxes import Box, read_box
from ..sheets.cell import Cell, CellChart, CellForms, Corner, Row, read_corners
from ..sheets.sheet import turn
from .listing import UPSIDE_DOWN
from .periodic_lines import LineClaim, QuadraticLine

_SIGNS = {1: "+", -1: "-", 0: "0"}
_LETTERS = {1: "V", -1: "M", 0: "F", None: "U"}


class PeriodicBranchClaim(TypedDict):
    """A branch, on the side on which its first vertex that is not flat pops up."""

    vertex_signs: str
    multiplicity: int
    b: int
    letters: str


class SpaceClaim(TypedDict):
    """A linear space of solutions, with heights w and b."""

    dimension: int
    basis: list[list[str]]


class PeriodicProof:
    """What the evidence shows: each sign vector is covered, and by which branches and spaces."""

    def __init__(
        self, cell: Cell, direction: tuple[int, int], unit: Fraction, evidence: dict[str, Any]
    ) -> None:
        self.cell = cell
        self.rings = [self._ring(entry) for entry in items(evidence["triangles"], "triangles")]
        sheet = cell.emptied(self.rings)
        number = len(sheet.points)
        at_most(number, PERIODIC_VERTICES, "the vertices of the cell", "PERIODIC_VERTICES")
        self.forms = CellForms(sheet, direction, unit)
        self.partners = [
            self.forms.partners(edge, row)
            for edge, row in zip(sheet.edges, self.forms.folds, strict=True)
        ]
        self.covered: set[tuple[int, ...]] = set()
        self.simple: set[tuple[int, ...]] = set()  # the sign vectors of rays
        self.branches: list[PeriodicBranchClaim] = []
        self.pleats: list[list[Row]] = []
        self.families: list[list[Row]] = []
        self._rays(items(evidence["rays"], "rays"))
        self._spaces(items(evidence["spaces"], "spaces"))
        self.lines: list[LineClaim] = []
        self._lines(items(evidence.get("lines", []), "lines"))
        missing = (1 << self.forms.size) - len(self.covered)
        require(not missing, f"{missing} pairs of opposite sign vectors are not covered")
        self.branches.sort(key=lambda branch: branch["vertex_signs"].translate(_ORDER))

    def _ring(self, entry: Any) -> tuple[tuple[Corner, ...], list[Corner]]:
        keys(entry, "ring inside", "triangle")
        ring = read_corners(entry["ring"], "ring", len(self.cell.points))
        require(len(ring) == 3, "a ring does not have 3 corners")
        return tuple(ring), read_corners(entry["inside"], "inside", len(self.cell.points))

    # --- simple rays ------------------------------------------------------------------------------

    def _rays(self, rays: list[Any]) -> None:
        forms, charts = self.forms, dict[int, CellChart]()
        tests = dict[int, Krawczyk]()
        bend = [Fraction(0)] * forms.size + [Fraction(1)]
        for entry in rays:
            keys(entry, "place bits radius center", "ray")
            place = natural(entry["place"], "place")
            require(place <= forms.size, "there is no such place")
            if place not in charts:
                charts[place] = CellChart(forms, place)
                if forms.size:
                    tests[place] = Krawczyk(charts[place])
            box = read_box({k: v for k, v in entry.items() if k != "place"}, forms.size)
            if forms.size:
                tests[place].check(box.center, box.radius, box.bits)
            integers = charts[place].integers
            signs = [box.sign(integers(row)) for row in forms.vertices.values()]
            require(all(signs), "a vertex of a simple ray has no sign")
            b = box.sign(integers(bend))
            require(b, "the sign of b of a ray is open")
            letters = [self._letter(box, integers, k) for k in range(len(forms.folds))]
            self.simple.add(self._cover([s or 0 for s in signs]))
            self._branch([s or 0 for s in signs], b or 0, letters)

    def _letter(self, box: Box, integers: Callable[[Row], list[int]], fold: int) -> str:
        """The letter of a fold; it is flat if another factor of a form is not 0."""
        sign = box.sign(integers(self.forms.folds[fold]))
        if sign is None and any(box.sign(integers(m)) for m in self.partners[fold]):
            sign = 0
        return _LETTERS[sign]

    def _cover(self, signs: Sequence[int]) -> tuple[int, ...]:
        """Enter a sign vector, without zeros, as that of its pair with + at the first vertex.

        The cone of the signs of a ray is this ray. Another entry would be the same branch again.
        """
        pair = tuple(signs[0] * s for s in signs)
        require(pair not in self.simple, "another ray has these signs")
        self.covered.add(pair)
        return pair

    def _branch(self, signs: Sequence[int], b: int, letters: Sequence[str]) -> None:
        sheet, places = self.forms.cell, dict(zip(self.forms.labels, signs, strict=True))
        text = "".join(_SIGNS[places.get(v, 0)] for v in sorted(self.cell.points))
        known = dict(zip(sheet.edges, letters, strict=True))
        full = "".join(known.get(edge, "F") for edge in self.cell.edges)
        if text.lstrip("0")[:1] == "-":
            text, full, b = text.translate(UPSIDE_DOWN), full.translate(UPSIDE_DOWN), -b
        branch: PeriodicBranchClaim = {
            "vertex_signs": text,
            "multiplicity": 1 << text.count("0"),
            "b": b,
            "letters": full,
        }
        self.branches.append(branch)

    # --- spaces over Q ----------------------------------------------------------------------------

    def _spaces(self, spaces: list[Any]) -> None:
        known: list[list[Row]] = []
        for entry in spaces:
            keys(entry, "basis points", "space")
            basis = [self._vector(row) for row in items(entry["basis"], "basis")]
            canonical = _canonical(basis)
            require(basis and canonical == basis, "a basis is not in reduced echelon form")
            require(canonical not in known, "a space is listed twice")
            known.append(canonical)
            for form in self.forms.forms.values():
                images = [_image(form, row) for row in basis]
                zero = not any(_dot(image, row) for image in images for row in basis)
                require(zero, "a form does not vanish on a space")
            points = items(entry["points"], "points")
            require(points, "a space has no point")
            for point in points:
                self._point(self._vector(point), basis)
            if len(basis) == 1 and basis[0][-1]:
                self._line(basis[0])
            elif any(row[-1] for row in basis):
                self.families.append(basis)
        level = [self._level(basis) for basis in known]
        kept = [basis for k, basis in enumerate(level) if basis and basis not in level[:k]]
        self.pleats = [basis for basis in kept if not any(_more(basis, other) for other in kept)]

    def _vector(self, value: Any) -> Row:
        return [parse_rational(x) for x in items(value, "vector", self.forms.size + 1)]

    def _point(self, point: Row, space: list[Row]) -> None:
        """Cover all sign vectors that agree with a point of a space off its flat vertices."""
        forms = self.forms
        inside = any(point) and len(echelon([*space, point])) == len(space)
        require(inside, "a point is 0, or not in its space")
        flat = [v for v in forms.labels if not any(_dot(r, point) for r in forms.bends_at[v])]
        fixed = [_image(forms.forms[v], point) for v in forms.labels if v not in flat]
        normal = kernel(fixed, forms.size + 1)
        around = self._radical(flat, normal)
        while squares := [
            smaller for v in flat if len(smaller := self._radical([v], around)) == len(around) - 1
        ]:
            around = squares[0]  # the form is a multiple of a square
        require(_canonical(around) == space, "a point of a space lies in a larger one")
        signs = [_sign(_dot(row, point)) for row in forms.vertices.values()]
        for completed in product(*((s,) if s else (1, -1) for s in signs)):
            self._cover(completed)

    def _radical(self, vertices: list[int], space: list[Row]) -> list[Row]:
        """The radical of the sum of the forms of some vertices on a space."""
        forms = [self.forms.forms[v] for v in vertices]
        sums = [
            [sum((_dot(_image(form, a), c) for form in forms), Fraction(0)) for c in space]
            for a in space
        ]
        return [_combined(weights, space) for weights in kernel(sums, len(space))]

    def _line(self, ray: Row) -> None:
        signs = [_sign(_dot(row, ray)) for row in self.forms.vertices.values()]
        letters = [_LETTERS[_sign(_dot(row, ray))] for row in self.forms.folds]
        self._branch(signs, _sign(ray[-1]), letters)

    def _lines(self, entries: list[Any]) -> None:
        """Cover the sign vectors of lines over quadratic fields.

        The solutions with the signs of a line are this line alone, as it is a component. So signs
        that are covered before belong to the same line, whatever its numbers look like.
        """
        for entry in entries:
            line = QuadraticLine(self.forms, entry)
            signs = [line.sign(row) for row in self.forms.vertices.values()]
            for completed in product(*((s,) if s else (1, -1) for s in signs)):
                pair = tuple(completed[0] * s for s in completed)
                require(pair not in self.covered, "the signs of a line are covered before")
                self.covered.add(pair)
            bend = [Fraction(0)] * self.forms.size + [Fraction(1)]
            if b := line.sign(bend):
                letters = [_LETTERS[line.sign(row)] for row in self.forms.folds]
                self._branch(signs, b, letters)
            else:
                heights = zip(self._heights(line.whole), self._heights(line.roots), strict=True)
                shown = [[_text(x) for x in pair] for pair in heights]
                self.lines.append({"radicand": line.radicand, "line": shown})

    def _level(self, basis: list[Row]) -> list[Row]:
        """The part of a space with b = 0."""
        weights = kernel([[row[-1] for row in basis]], len(basis))
        return _canonical([_combined(w, basis) for w in weights])

    def shown(self, basis: list[Row]) -> SpaceClaim:
        """A space by the heights w of all vertices of the cell, and b."""
        return {
            "dimension": len(basis),
            "basis": [[_text(x) for x in self._heights(row)] for row in basis],
        }

    def _heights(self, row: Row) -> Row:
        x, y = self.forms.direction
        b = row[-1] * self.forms.unit

        def bent(place: tuple[Fraction, Fraction]) -> Fraction:
            return b * (x * place[0] + y * place[1]) ** 2 / 2

        w = dict(zip(self.forms.labels, [Fraction(0), *row[:-1]], strict=True))
        for ring, inside in self.rings:
            spots = [self.cell.place(corner) for corner in ring]
            for corner in inside:
                point = self.cell.place(corner)
                height = -bent(point)
                for k, (v, _, _) in enumerate(ring):
                    share = turn(spots[k - 2], spots[k - 1], point) / turn(*spots)
                    height += share * (w[v] + bent(spots[k]))
                w[corner[0]] = height
        return [*(w[v] - w[0] for v in sorted(w)), b]


_ORDER = str.maketrans("-0+", "012")


def _canonical(rows: list[Row]) -> list[Row]:
    lines = echelon(rows)
    return [lines[pivot] for pivot in sorted(lines)]


def _more(basis: list[Row], other: list[Row]) -> bool:
    """Whether another space holds a space, and more."""
    return len(other) > len(basis) and len(echelon([*other, *basis])) == len(other)


def _dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def _image(form: list[Row], vector: Row) -> Row:
    return [_dot(row, vector) for row in form]


def _combined(weights: Row, vectors: list[Row]) -> Row:
    return [_dot(weights, column) for column in zip(*vectors, strict=True)]


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)


def _text(x: Fraction) -> str:
    whole = digits(x.numerator)
    return whole if x.denominator == 1 else f"{whole}/{digits(x.denominator)}"
