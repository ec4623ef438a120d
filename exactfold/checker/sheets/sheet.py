"""The flat sheet, rebuilt from vertices and triangles and verified to be one triangulated disk."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from fractions import Fraction
from math import isqrt, lcm
from typing import Any, TypedDict

from ..core.limits import MOST_ABOVE, MOST_MEETINGS
from ..core.reading import Coordinates, at_most, digits, items, keys, natural, require

Point = tuple[Fraction, Fraction]
Edge = tuple[int, int]
Form = dict[tuple[int, int], Fraction]


class SheetFacts(TypedDict):
    """What claims say of the sheet itself: numbers of vertices and folds, and its digest."""

    interior: int
    boundary: int
    folds: int
    degrees_of_freedom: int
    sha256: str


def turn(a: Point, b: Point, c: Point) -> Fraction:
    """Twice the signed area of the triangle abc."""
    scale = lcm(*(x.denominator for x in (*a, *b, *c)))
    ax, ay, bx, by, cx, cy = (x.numerator * (scale // x.denominator) for x in (*a, *b, *c))
    return Fraction((bx - ax) * (cy - ay) - (by - ay) * (cx - ax), scale * scale)


class Sheet:
    """A flat triangulated disk; the constructor verifies that it is one."""

    def __init__(self, points: dict[int, Point], triangles: Iterable[tuple[int, ...]]) -> None:
        self.points = points
        self.next: dict[int, dict[int, int]] = {v: {} for v in points}
        self._forms: dict[int, Form] = {}
        self._signs: dict[int, dict[int, Fraction]] = {}
        self.forced_flat: dict[tuple[object, ...], list[Edge]] = {}  # kept by `flat_folds.flat_at`
        for a, b, c in triangles:
            require(len({a, b, c}) == 3 and {a, b, c} <= points.keys(), f"bad face {(a, b, c)}")
            require(turn(points[a], points[b], points[c]) > 0, f"face {(a, b, c)} is not positive")
            for i, j, k in ((a, b, c), (b, c, a), (c, a, b)):
                require(j not in self.next[i], f"two faces on one side of edge {i}-{j}")
                self.next[i][j] = k
        require(len(set(points.values())) == len(points), "two vertices at one point")
        self.triangles = {frozenset(t) for t in triangles}
        self.edges = sorted(
            {(min(i, j), max(i, j)) for t in self.triangles for i in t for j in t if i != j}
        )
        self._disk()
        self.interior = sorted(set(points) - set(self.boundary))
        boundary = set(zip(self.boundary, self.boundary[1:] + self.boundary[:1], strict=True))
        self.folds = [
            (i, j) for i, j in self.edges if (i, j) not in boundary and (j, i) not in boundary
        ]

    def _disk(self) -> None:
        follow = {}
        for v, fan in self.next.items():
            require(fan, f"vertex {v} is on no face")
            ends = [a for a in fan if v not in self.next[a]]
            at, steps = (ends or list(fan))[0], 0
            start = at
            while at in fan:
                at, steps = fan[at], steps + 1
                if at == start:
                    break
            require(len(ends) <= 1 and steps == len(fan), f"the sheet is pinched at vertex {v}")
            if ends:
                follow[v] = ends[0]
        require(follow, "the sheet has no boundary")
        cycle = [min(follow)]
        while follow[cycle[-1]] != cycle[0]:
            cycle.append(follow[cycle[-1]])
        require(len(cycle) == len(follow), "the boundary is not one cycle")
        euler = len(self.points) - len(self.edges) + len(self.triangles)
        seen, stack = {cycle[0]}, [cycle[0]]
        while stack:
            for a, b in self.next[stack.pop()].items():
                stack += [v for v in (a, b) if v not in seen]
                seen |= {a, b}
        require(euler == 1 and len(seen) == len(self.points), "the sheet is not one disk")
        self.boundary = cycle
        self._check_simple(list(zip(cycle, cycle[1:] + cycle[:1], strict=True)))

    def _check_simple(self, sides: list[Edge]) -> None:
        """Raise if two sides meet; two sides are compared only if their x- and y-ranges overlap."""
        boxes = []
        for side in sides:
            (left, right), (low, high) = (sorted(self.points[v][k] for v in side) for k in (0, 1))
            boxes.append((left, right, low, high, side))
        above = meetings = 0
        active: list[tuple[Fraction, Fraction, Fraction, Fraction, Edge]] = []
        for box in sorted(boxes):
            active = [other for other in active if other[1] >= box[0]]
            near = [other[4] for other in active if other[2] <= box[3] and box[2] <= other[3]]
            above, meetings = above + len(active), meetings + len(near)
            at_most(
                above,
                MOST_ABOVE,
                "the pairs of boundary edges whose x-ranges overlap",
                "MOST_ABOVE",
            )
            at_most(
                meetings,
                MOST_MEETINGS,
                "the pairs of boundary edges whose boxes meet",
                "MOST_MEETINGS",
            )
            for other in near:
                require(not self._meet(box[4], other), f"boundary edges {box[4]}, {other} meet")
            active.append(box)

    def _meet(self, first: Edge, second: Edge) -> bool:
        shared = set(first) & set(second)
        if shared:
            apex, end, other = shared, set(first) - shared, set(second) - shared
            p, q, r = (self.points[min(only)] for only in (apex, end, other))
            along = sum((q[k] - p[k]) * (r[k] - p[k]) for k in (0, 1))
            return turn(p, q, r) == 0 and along > 0
        a, b, c, d = (self.points[v] for v in first + second)
        abc, abd, cda, cdb = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
        if abc == abd == 0:
            return all(
                min(a[k], b[k]) <= max(c[k], d[k]) and min(c[k], d[k]) <= max(a[k], b[k])
                for k in (0, 1)
            )
        return abc * abd <= 0 and cda * cdb <= 0

    def star(self, vertex: int) -> list[int]:
        """The neighbours of an interior vertex, counter-clockwise."""
        fan = self.next[vertex]
        cycle = [min(fan)]
        while fan[cycle[-1]] != cycle[0]:
            cycle.append(fan[cycle[-1]])
        return cycle

    def curvature(self, vertex: int) -> Form:
        """The curvature form K_v as {(i, j): coefficient}, symmetric, over all pairs of the star.

        K_v(h) = sum_j x_j x_{j+1} / c_j - (s_j / 2 c_j) (x_j^2 / L_j^2 + x_{j+1}^2 / L_{j+1}^2)
        with x_j = h_j - h_v. Here L_j is the length of spoke j, and c_j and s_j are the cross
        product and the scalar product of the spokes j and j + 1. The form is computed once for each
        vertex; callers must not change it.
        """
        if vertex not in self._forms:
            self._forms[vertex] = self._curvature(vertex)
        return self._forms[vertex]

    def _curvature(self, vertex: int) -> Form:
        ring = self.star(vertex)
        scale = lcm(*(c.denominator for v in (vertex, *ring) for c in self.points[v]))
        whole = {
            v: [c.numerator * (scale // c.denominator) for c in self.points[v]]
            for v in (vertex, *ring)
        }
        (x, y), unit = whole[vertex], scale * scale
        form: Form = {(j, j): Fraction(0) for j in ring}
        away = dict.fromkeys(ring, Fraction(0))
        for i, j in zip(ring, ring[1:] + ring[:1], strict=True):
            ax, ay, bx, by = whole[i][0] - x, whole[i][1] - y, whole[j][0] - x, whole[j][1] - y
            c, s = 2 * (ax * by - ay * bx), (ax * bx + ay * by) * unit
            off = Fraction(unit, c)
            form[i, j] = form[j, i] = form.get((i, j), 0) + off
            form[i, i] -= Fraction(s, c * (ax * ax + ay * ay))
            form[j, j] -= Fraction(s, c * (bx * bx + by * by))
            away[i], away[j] = away[i] + off, away[j] + off
        for j in ring:  # heights that are all the same bend nothing: each row adds up to 0
            form[j, vertex] = form[vertex, j] = -form[j, j] - away[j]
        form[vertex, vertex] = -sum((form[j, vertex] for j in ring), Fraction(0))
        return form

    def sign_of_vertex(self, vertex: int) -> dict[int, Fraction]:
        """The functional h -> K_v(t, h), as coefficients; its sign is the sign of the vertex.

        t is a rational cone that points up, with K_v(t) > 0.
        """
        if vertex not in self._signs:
            self._signs[vertex] = self._sign_of_vertex(vertex)
        return self._signs[vertex]

    def _sign_of_vertex(self, vertex: int) -> dict[int, Fraction]:
        form, (x, y) = self.curvature(vertex), self.points[vertex]
        bits = 16
        while True:
            cone = {vertex: Fraction(0)}
            for j in self.star(vertex):
                square = (self.points[j][0] - x) ** 2 + (self.points[j][1] - y) ** 2
                product = square.numerator * square.denominator << 2 * bits
                cone[j] = -Fraction(isqrt(product), square.denominator << bits)
            if sum(w * cone[i] * cone[j] for (i, j), w in form.items()) > 0:
                row: dict[int, Fraction] = {}
                for (i, j), w in form.items():
                    row[j] = row.get(j, 0) + w * cone[i]
                return row
            bits *= 2

    def bend(self, fold: Edge) -> dict[int, Fraction]:
        """The coefficients of the bend of a fold, which is positive at a valley."""
        i, j = fold
        k, m = self.next[i][j], self.next[j][i]
        p, q, r, s = (self.points[v] for v in (i, j, k, m))
        return {i: -turn(q, r, s), j: turn(p, r, s), k: -turn(p, q, s), m: turn(p, q, r)}

    def emptied(self, corners: list[int], inside: list[int]) -> Sheet:
        """The sheet without the vertices inside a 3-cycle, whose corners become one face."""
        faces = [self.face(t) for t in self.triangles if not t & set(inside)]
        points = {v: p for v, p in self.points.items() if v not in set(inside)}
        return Sheet(points, [*faces, tuple(corners)])

    def face(self, triangle: frozenset[int]) -> tuple[int, int, int]:
        """The corners of a triangle, counter-clockwise from the smallest vertex."""
        a = min(triangle)
        b = next(v for v in triangle - {a} if self.next[a].get(v) in triangle)
        return a, b, self.next[a][b]


def read_sheet(data: Any) -> tuple[Sheet, str]:
    """Read and verify the sheet of a pattern; return the sheet and the SHA-256 of the pattern."""
    keys(data, "vertices triangles", "pattern")
    points: dict[int, Point] = {}
    coordinate = Coordinates()
    for k, pair in enumerate(items(data["vertices"], "vertices")):
        x, y = items(pair, f"vertex {k}", 2)
        points[k] = (coordinate(x), coordinate(y))
    triangles = []
    for face in items(data["triangles"], "triangles"):
        triangles.append(tuple(natural(v, "vertex") for v in items(face, "face", 3)))
    require(len(set(map(frozenset, triangles))) == len(triangles), "a face appears twice")
    sheet = Sheet(points, triangles)

    def text(x: Fraction) -> str:
        whole = digits(x.numerator)
        return whole if x.denominator == 1 else f"{whole}/{digits(x.denominator)}"

    rotated = sorted(min((t[k:] + t[:k]) for k in range(3)) for t in triangles)
    lines = ["exactfold pattern 1"]
    lines += [f"v {text(x)} {text(y)}" for x, y in points.values()]
    lines += [f"t {a} {b} {c}" for a, b, c in rotated]
    digest = hashlib.sha256("".join(line + "\n" for line in lines).encode()).hexdigest()
    return sheet, digest


def facts_of(sheet: Sheet, sha256: str) -> SheetFacts:
    """What claims say of the sheet itself."""
    return {
        "interior": len(sheet.interior),
        "boundary": len(sheet.boundary),
        "folds": len(sheet.folds),
        "degrees_of_freedom": len(sheet.boundary) - 3,
        "sha256": sha256,
    }
