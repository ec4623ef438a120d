"""The cell of a periodic sheet, verified to cover the plane once, and its exact forms.

A corner (v, i, j) is point v moved by i and j lattice vectors. The heights of a sheet that rolls up
across a direction n are w + (b/2) (n . x)^2, modulo linear functions, with w the same at all
translates and 0 at the first vertex. They are the numbers z = (w_1, ..., w_m, c) with b = c times
`unit`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from fractions import Fraction
from math import gcd, isqrt, lcm
from typing import Any

from ..core.reading import Coordinates, digits, integer, items, keys, require
from .sheet import Point, turn

Corner = tuple[int, int, int]
Side = tuple[int, int, int, int]
Row = list[Fraction]


class Cell:
    """A periodic triangulation; the constructor verifies that it covers the plane once."""

    def __init__(
        self, lattice: list[Point], points: dict[int, Point], faces: list[tuple[Corner, ...]]
    ) -> None:
        self.lattice, self.points, self.faces = lattice, points, faces
        (ax, ay), (bx, by) = lattice
        require(ax * by != ay * bx, "the lattice vectors are parallel")
        self.next: dict[int, dict[Corner, Corner]] = {v: {} for v in points}
        total = Fraction(0)
        for face in faces:
            area = turn(*map(self.place, face))
            require(area > 0, f"face {face} is not positive")
            total += area
            for a, b, c in (face, face[1:] + face[:1], face[2:] + face[:2]):
                turns = self.next[a[0]]
                spoke = _seen(a, b)
                require(spoke not in turns, f"two faces on one side of the edge {a}-{b}")
                turns[spoke] = _seen(a, c)
        for v, turns in self.next.items():
            require(turns, f"vertex {v} is on no face")
            for u, i, j in turns:
                require((v, -i, -j) in self.next[u], f"edge {v}-{(u, i, j)} has one face only")
        require(total == 2 * abs(ax * by - ay * bx), "the faces do not cover each point once")
        self.edges: list[Side] = sorted(
            (v, u, i, j)
            for v, turns in self.next.items()
            for u, i, j in turns
            if (v, 0, 0) < (u, i, j)
        )

    def place(self, corner: Corner) -> Point:
        """The point of the plane at a corner."""
        v, i, j = corner
        (ax, ay), (bx, by), (x, y) = *self.lattice, self.points[v]
        return x + i * ax + j * bx, y + i * ay + j * by

    def sha256(self) -> str:
        """The digest of the cell; it does not depend on the order of the faces."""

        def text(numbers: Sequence[Fraction]) -> str:
            parts = [f"{digits(x.numerator)}/{digits(x.denominator)}" for x in numbers]
            return " ".join(part.removesuffix("/1") for part in parts)

        lines = ["exactfold periodic pattern 1"]
        lines += [f"l {text(vector)}" for vector in self.lattice]
        lines += [f"v {text(point)}" for _, point in sorted(self.points.items())]
        turned = [min(f, f[1:] + f[:1], f[2:] + f[:2]) for f in self.faces]
        seen = sorted([_seen(face[0], corner) for corner in face] for face in turned)
        lines += ["f " + " ".join(f"{v} {i} {j}" for v, i, j in face) for face in seen]
        return hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()

    def opposite(self, edge: Side) -> tuple[Corner, Corner]:
        """The third corners of the faces to the left and to the right of an edge."""
        u, v, i, j = edge
        w, k, m = self.next[v][u, -i, -j]
        return self.next[u][v, i, j], (w, k + i, m + j)

    def emptied(self, rings: list[tuple[tuple[Corner, ...], list[Corner]]]) -> Cell:
        """The cell with rings of three edges as faces, without the vertices inside them.

        By the key lemma (docs/theorem.md), what is inside such a ring stays flat.
        """
        gone: set[int] = set()
        for ring, inside in rings:
            require(inside, "a ring has no vertex inside")
            spots = [self.place(corner) for corner in ring]
            for k in range(3):
                known = _seen(ring[k - 2], ring[k]) in self.next[ring[k - 2][0]]
                require(known, f"{ring[k - 2]}-{ring[k]} is not an edge")
                for corner in inside:
                    within = turn(spots[k - 1], spots[k], self.place(corner)) > 0
                    require(within, f"{corner} is not inside the ring")
            gone |= {v for v, _, _ in inside}
        faces = [face for face in self.faces if not gone & {v for v, _, _ in face}]
        points = {v: p for v, p in self.points.items() if v not in gone}
        require(all(v in points for ring, _ in rings for v, _, _ in ring), "a ring lost a corner")
        return Cell(self.lattice, points, [*faces, *(ring for ring, _ in rings)])


def _seen(origin: Corner, corner: Corner) -> Corner:
    """A corner, seen from another one."""
    return corner[0], corner[1] - origin[1], corner[2] - origin[2]


def read_corners(value: Any, what: str, count: int) -> list[Corner]:
    """Corners [v, i, j] with v below `count`."""
    corners: list[Corner] = []
    for entry in items(value, what):
        v, i, j = map(integer, items(entry, "corner", 3))
        require(0 <= v < count, f"{what} uses vertex {v}")
        corners.append((v, i, j))
    return corners


def read_cell(data: Any) -> Cell:
    """Read and verify the cell of a certificate."""
    keys(data, "lattice vertices faces", "pattern")
    coordinate = Coordinates()

    def pair(value: Any) -> Point:
        x, y = items(value, "point", 2)
        return coordinate(x), coordinate(y)

    lattice = [pair(vector) for vector in items(data["lattice"], "lattice", 2)]
    points = dict(enumerate(map(pair, items(data["vertices"], "vertices"))))
    faces = []
    for entry in items(data["faces"], "faces"):
        face = read_corners(entry, "face", len(points))
        require(len(face) == 3, "a face does not have 3 corners")
        faces.append(tuple(face))
    return Cell(lattice, points, faces)


class CellForms:
    """The forms K_v, and the functionals of signs and letters, as rows on z."""

    def __init__(self, cell: Cell, direction: tuple[int, int], unit: Fraction) -> None:
        self.cell, self.direction, self.unit = cell, direction, unit
        self.labels = sorted(cell.points)
        self.size = len(self.labels) - 1
        self.forms: dict[int, list[Row]] = {}
        self.vertices: dict[int, Row] = {}
        for v in self.labels:
            self.forms[v], self.vertices[v] = self._star(v)
        self.folds = [self._bend(edge) for edge in cell.edges]
        self.bends_at = {
            v: [row for edge, row in zip(cell.edges, self.folds, strict=True) if v in edge[:2]]
            for v in self.labels
        }

    def row(self, vertex: int, place: Point) -> Row:
        """The height of a translate of a vertex that lies at a place."""
        along = self.direction[0] * place[0] + self.direction[1] * place[1]
        row = [Fraction(0)] * self.size + [along * along * self.unit / 2]
        if vertex != self.labels[0]:
            row[self.labels.index(vertex) - 1] = Fraction(1)
        return row

    def _star(self, vertex: int) -> tuple[list[Row], Row]:
        """The form K_v on z, and its polar form with a cone that points up and has K_v > 0."""
        turns, (x, y) = self.cell.next[vertex], self.cell.points[vertex]
        places = {spoke: self.cell.place(spoke) for spoke in turns}
        spokes = {spoke: (px - x, py - y) for spoke, (px, py) in places.items()}
        hub = self.row(vertex, (Fraction(0), Fraction(0)))
        rise = {
            spoke: [a - b for a, b in zip(self.row(spoke[0], d), hub, strict=True)]
            for spoke, d in spokes.items()
        }
        squares = {spoke: dx * dx + dy * dy for spoke, (dx, dy) in spokes.items()}
        terms: list[tuple[Corner, Corner, Fraction]] = []  # the sum of weight * x_i * x_j is K_v
        for i, j in turns.items():
            (ax, ay), (bx, by) = spokes[i], spokes[j]
            cross, dot = ax * by - ay * bx, ax * bx + ay * by
            terms.append((i, j, 1 / cross))
            terms += [(k, k, -dot / (2 * cross * squares[k])) for k in (i, j)]
        bits = 16
        while True:
            cone = {
                k: -Fraction(isqrt(s.numerator * s.denominator << 2 * bits), s.denominator << bits)
                for k, s in squares.items()
            }
            if sum(w * cone[i] * cone[j] for i, j, w in terms) > 0:
                break
            bits *= 2
        width = range(self.size + 1)
        form = [[Fraction(0) for _ in width] for _ in width]
        functional = [Fraction(0) for _ in width]
        for i, j, w in terms:
            for p in width:
                functional[p] += w * (cone[i] * rise[j][p] + cone[j] * rise[i][p]) / 2
                for q in width:
                    form[p][q] += w * (rise[i][p] * rise[j][q] + rise[j][p] * rise[i][q]) / 2
        return form, functional

    def partners(self, edge: Side, row: Row) -> list[Row]:
        """The rows m with K_v = m times the row of a fold, at an end v of it.

        On a solution the fold is flat wherever such an m is not 0.
        """
        found: list[Row] = []
        pivot = next((k for k, c in enumerate(row) if c), None)
        if pivot is None:
            return found
        for v in sorted({*edge[:2]}):
            form = self.forms[v]
            lead = form[pivot][pivot] / row[pivot]
            m = [(2 * x - c * lead) / row[pivot] for x, c in zip(form[pivot], row, strict=True)]
            places = [(i, j) for i in range(len(row)) for j in range(i + 1)]
            if all(2 * form[i][j] == row[i] * m[j] + row[j] * m[i] for i, j in places):
                found.append(m)
        return found

    def _bend(self, edge: Side) -> Row:
        """The bend of a fold, which is positive at a valley."""
        u, v, i, j = edge
        corners = [(u, 0, 0), (v, i, j), *self.cell.opposite(edge)]
        p, q, r, s = (self.cell.place(corner) for corner in corners)
        weights = (-turn(q, r, s), turn(p, r, s), -turn(p, q, s), turn(p, q, r))
        rows = [self.row(c[0], self.cell.place(c)) for c in corners]
        return [
            sum((w * row[k] for w, row in zip(weights, rows, strict=True)), Fraction(0))
            for k in range(self.size + 1)
        ]


class CellChart:
    """The forms of all vertices but the first, in the chart z_place = 1, with coprime integers."""

    def __init__(self, forms: CellForms, place: int) -> None:
        self.size, self.place = forms.size, place
        self.order = [k for k in range(forms.size + 1) if k != place] + [place]
        self.quadrics = [self._quadric(forms.forms[v]) for v in forms.labels[1:]]

    def _quadric(self, form: list[Row]) -> dict[tuple[int, int], int]:
        rows = [[form[p][q] for q in self.order] for p in self.order]
        scale = lcm(*(x.denominator for row in rows for x in row))
        whole = {
            (p, q): int(x * scale) for p, row in enumerate(rows) for q, x in enumerate(row) if x
        }
        common = gcd(*whole.values())
        return {pq: x // common for pq, x in whole.items()}

    def integers(self, row: Sequence[Fraction]) -> list[int]:
        """A row on z as integers on (x, 1), times a positive number."""
        moved = [row[k] for k in self.order]
        scale = lcm(*(x.denominator for x in moved))
        return [int(x * scale) for x in moved]
