"""Panels as plates: prisms over panels that are cut back from their folds.

A sheet without thickness is a plane in each plate, and all hinges lie in it. The corners of a plate
are where the sides of its panel meet after all folds among them were moved inwards by `trim`;
where two sides in one line are moved by different widths, both ends of the step are corners. In the
flat sheet the plates reach from -thickness / 2 to thickness / 2, or, with the hinges on the side of
valleys, from -thickness to 0.

Two prisms do not touch if a plane parts them. At a fold the plane that bisects the angle between
the panels does. Proof: let all corners of both be farther than w from the line of the fold, in
their panels, and at most h beyond them, on the side on which the fold closes. In a plane across the
fold, with the panel along the positive u-axis and this side above it, the bisecting plane is at the
angle (pi - a) / 2 for the fold angle a, and all points of the plate have u > w and z <= h. They are
below the bisecting plane if h < w cot(a / 2). The size of each fold angle grows until a fold is
closed (docs/motion.md, 18 and 19), so that this may be tested at the last time.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import partial
from itertools import combinations
from typing import Any

from ...core.intervals import Interval
from ...core.limits import MOST_TESTS
from ...core.reading import items, keys, parse_rational, require
from ...sheets.panels import Edge, PanelSheet, cross, pair
from ..boxes import Boxes, Curved, Direction, Point, crossed, middle_of, minus, parted, unit, whole
from ..claims import Document
from ..faces import FacePairs
from ..lengths import GRID
from .cut import from_least
from .drive import DrivenModes, length
from .places import Carried, Places, panels_of
from .series import BITS, thin
from .times import Clock

Spot = tuple[Interval, Interval]
HINGES = "middle", "valley"
_NEAR = 1 - Fraction(1, 1 << 30)
"""Corners are proved to be farther from a fold than this part of the trim."""


class Solid:
    """The thickness of the plates of a file, where their hinges lie, and how far they are cut back.

    All lengths are in the unit of the shrunk sheet, of which `factor` is one.
    """

    def __init__(self, given: Any, factor: Fraction) -> None:
        keys(given, "thickness hinge trim", "plates")
        thickness, trim = (parse_rational(given[name]) for name in ("thickness", "trim"))
        require(thickness > 0, "the thickness is not positive")
        require(trim > 0, "the trim is not positive")
        require(given["hinge"] in HINGES, "the hinges are neither in the middle nor on one side")
        self.thickness, self.trim = thickness * factor, trim * factor
        upper = Fraction(0) if given["hinge"] == "valley" else self.thickness / 2
        self.heights = upper - self.thickness, upper

    def depth(self, letter: str) -> Fraction:
        """How far plates reach beyond the sheet on the side on which a fold closes."""
        return self.heights[1] if letter == "V" else -self.heights[0]


class Outlines:
    """The corners of all plates, and the triangles into which they are cut."""

    def __init__(self, sheet: PanelSheet, solid: Solid) -> None:
        self.sheet, self.solid = sheet, solid
        self.points: list[tuple[int, Spot]] = []
        self.triangles: list[list[tuple[int, int, int]]] = []
        self._folds = set(sheet.folds)
        for panel, corners in enumerate(sheet.panels):
            first = len(self.points)
            outline = self._outline(corners)
            self.points += [(panel, spot) for _, spot in outline]
            cut = self._cut(corners, outline)
            self.triangles.append([(a + first, b + first, c + first) for a, b, c in cut])

    def _width(self, i: int, j: int) -> Interval:
        trim = self.solid.trim if pair(i, j) in self._folds else Fraction(0)
        return Interval.of(trim, BITS)

    def _outline(self, corners: tuple[int, ...]) -> list[tuple[int, Spot]]:
        """The corners of a plate, each with the vertex from which it was moved."""
        sheet, outline = self.sheet, []
        for k, v in enumerate(corners):
            u, w = corners[k - 1], corners[(k + 1) % len(corners)]
            (px, py), (qx, qy) = self.direction(u, v), self.direction(v, w)
            before, after = self._width(u, v), self._width(v, w)
            x, y = map(thin, sheet.points[v])
            if cross(sheet.vector(u, v), sheet.vector(v, w)).sign():
                turn = px * qy - py * qx
                a, b = before / turn, after / turn
                outline.append((v, (x + a * qx - b * px, y + a * qy - b * py)))
                continue
            outline.append((v, (x - py * before, y + px * before)))
            if before.low != after.low:
                outline.append((v, (x - qy * after, y + qx * after)))
        return outline

    def direction(self, i: int, j: int) -> Spot:
        """The unit vector from one vertex to another."""
        size = length(self.sheet, i, j)
        x, y = (thin(c) / size for c in self.sheet.vector(i, j))
        return x, y

    def _cut(
        self, corners: tuple[int, ...], outline: list[tuple[int, Spot]]
    ) -> list[tuple[int, int, int]]:
        """Ears of an outline that is proved to be simple, with sides that point as before.

        As in the panel, they turn once, counter-clockwise.
        """
        spots, count = [spot for _, spot in outline], len(outline)
        sides = [(k, (k + 1) % count) for k in range(count)]
        gone = f"the panel {corners} cannot be cut back so far"
        for i, j in sides:
            v, w = outline[i][0], outline[j][0]
            if v != w:
                (px, py), (x, y) = self.direction(v, w), _way(spots[i], spots[j])
                require((px * x + py * y).sign() > 0, gone)
        for (a, b), (c, d) in combinations(sides, 2):
            p, q, r, s = (spots[k] for k in (a, b, c, d))
            apart = {a, b} & {c, d} or _one_side(p, q, r, s) or _one_side(r, s, p, q)
            require(apart, gone)
        left, triangles = list(range(count)), []
        while len(left) > 3:  # every simple polygon has an ear (`cut`)
            k = min(k for k in range(len(left)) if _is_ear(spots, left, k))
            triangles.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
            del left[k]
        a, b, c = left
        return [*triangles, (a, b, c)]

    @property
    def carried(self) -> list[Carried]:
        """Each corner below and above: its panel, its place in the flat sheet, and an error."""
        return [
            (panel, (*spot, Interval.of(height, BITS)))
            for panel, spot in self.points
            for height in self.solid.heights
        ]

    def far(self, triangle: tuple[int, int, int], i: int, j: int) -> bool:
        """Whether a triangle lies to the left of a line, farther than a part of the trim."""
        ux, uy = self.direction(i, j)
        x, y = map(thin, self.sheet.points[i])
        least = Interval.of(self.solid.trim * _NEAR, BITS)
        return all(
            (ux * (q - y) - uy * (p - x) - least).sign() > 0
            for p, q in (self.points[k][1] for k in triangle)
        )


class Plates(FacePairs):
    """The pairs of prisms of plates that can meet, and the prisms of each panel.

    `given` are the claims, and `evidence` may have the `point` of a contact: the way from the first
    corner of the first face of the contact, and a height.
    """

    def __init__(
        self,
        drive: DrivenModes,
        clock: Clock,
        factor: Fraction,
        given: Document,
        evidence: Document,
    ) -> None:
        sheet = drive.sheet
        self.solid = Solid(given["plates"], factor)
        self.outlines = outlines = Outlines(sheet, self.solid)
        carried = outlines.carried
        self.shared = len(carried)
        if "point" in evidence:
            carried.append(_material(sheet, factor, given["contact"]["faces"], evidence["point"]))
        self.places = Places(drive, clock, carried)
        prisms: list[tuple[int, ...]] = []
        owners: list[int] = []
        self.triangles: dict[tuple[int, ...], list[tuple[int, ...]]] = {}
        for panel, triangles in enumerate(outlines.triangles):
            some = [(*(2 * k for k in t), *(2 * k + 1 for k in t)) for t in triangles]
            self.triangles[from_least(sheet.panels[panel])] = some
            prisms += some
            owners += [panel] * len(some)
        body = self.places.bodies
        flat = {k: [0, 0, 0] for k in range(len(carried))}
        names = [sheet.panels[panel] for panel in owners]
        bodies = [body[panel] for panel in owners]
        super().__init__(prisms, names, bodies, {}, flat, {k: 3 * k for k in flat}, MOST_TESTS)
        self._owners, self._drive, self._clock = owners, drive, clock
        self._every = self.apart

    def until(self, last: Fraction) -> None:
        """Leave out the pairs at folds whose angles are small enough until the parameter `last`."""
        x, trim = Interval.of(last, BITS), self.solid.trim * _NEAR
        try:
            tangents = self._drive.tangents(partial(self._clock.driven, x))
        except ZeroDivisionError:
            return
        sides, letters = panels_of(self._drive.sheet), self._drive.letters
        at: dict[tuple[int, int], Edge] = {}
        for (i, j), (below, above) in tangents.items():
            c, s = below.coefficients[0], above.coefficients[0]
            depth = Interval.of(self.solid.depth(letters[i, j]), BITS)
            size = max(abs(s.low), abs(s.high))
            room = Interval.of(trim, BITS) * c - depth * Interval(size, size, BITS)
            if c.sign() > 0 and room.sign() > 0:
                at[sides[i, j], sides[j, i]] = (i, j)
        self.apart = [row for row in self._every if not self._parted(at, *row)]

    def _parted(self, at: dict[tuple[int, int], Edge], one: int, two: int) -> bool:
        """Whether the plane that bisects the angle at a fold parts two prisms."""
        for a, b in ((one, two), (two, one)):
            fold = at.get((self._owners[a], self._owners[b]))
            if fold is not None:
                i, j = fold
                return self._far(a, i, j) and self._far(b, j, i)
        return False

    def _far(self, prism: int, i: int, j: int) -> bool:
        a, b, c = (k // 2 for k in self.faces[prism][:3])
        return self.outlines.far((a, b, c), i, j)

    def _apart(self, boxes: Boxes, i: int, j: int, planar: bool) -> bool:
        """Whether a plane parts two prisms. The direction that parted them last is tried first."""
        one, two = self.faces[i], self.faces[j]
        known = self.known.get((i, j))
        if known and parted(boxes, one, two, known):
            return True
        self.spend(6)
        best = self.known[i, j] = _widest(boxes, one, two)
        return parted(boxes, one, two, best)

    def crossing(self, path: Curved, s: Fraction, one: Sequence[int], two: Sequence[int]) -> bool:
        """Whether the point of the contact is in the first prism, and at a parameter in the second.

        It belongs to the plate of the first prism.
        """
        boxes = self.at(path, s, s)

        def there(k: int) -> list[Interval]:
            a, b, error = boxes[k]
            ends = zip(a, b, strict=True)
            return [Interval(min(e) - error, max(e) + error, GRID) for e in ends]

        def flat(k: int) -> list[Interval]:
            return list(self.places.carried[k][1])

        return _inside(*(list(map(flat, (self.shared, *one))))) and _inside(
            *(list(map(there, (self.shared, *two))))
        )


def _material(sheet: PanelSheet, factor: Fraction, faces: Any, point: Any) -> Carried:
    """The point of a contact: it is carried by the first of the two panels that touch."""
    first = tuple(items(faces, "faces", 2)[0])
    panels = {from_least(panel): k for k, panel in enumerate(sheet.panels)}
    way = [parse_rational(c) * factor for c in items(point, "point", 3)]
    corner = (*map(thin, sheet.points[first[0]]), Interval.of(Fraction(0), BITS))
    x, y, z = (a + Interval.of(b, BITS) for a, b in zip(corner, way, strict=True))
    return panels[from_least(first)], (x, y, z)


def _inside(p: list[Interval], *corners: list[Interval]) -> bool:
    """Whether a point is inside a prism: between its two ends, and inside its three walls.

    With the sides d and e from a corner of the lower end, the wall along d has the normal
    d x (d x e) = d (d.e) - e (d.d), up to its sign.
    """
    a, b, c, above = *corners[:3], corners[3]
    up = _product(_less(b, a), _less(c, a))
    if not (_dot(up, _less(p, a)).sign() > 0 > _dot(up, _less(p, above)).sign()):
        return False
    for k in range(3):
        a, b, c = corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]
        d, e, to = _less(b, a), _less(c, a), _less(p, a)
        if (_dot(d, d) * _dot(e, to) - _dot(d, e) * _dot(d, to)).sign() <= 0:
            return False
    return True


def _less(a: list[Interval], b: list[Interval]) -> list[Interval]:
    return [x - y for x, y in zip(a, b, strict=True)]


def _dot(a: list[Interval], b: list[Interval]) -> Interval:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _product(a: list[Interval], b: list[Interval]) -> list[Interval]:
    return [a[k - 2] * b[k - 1] - a[k - 1] * b[k - 2] for k in range(3)]


def _way(p: Spot, q: Spot) -> Spot:
    return q[0] - p[0], q[1] - p[1]


def _turn(p: Spot, q: Spot, r: Spot) -> Interval:
    (a, b), (c, d) = _way(p, q), _way(p, r)
    return a * d - b * c


def _one_side(p: Spot, q: Spot, r: Spot, s: Spot) -> bool:
    return _turn(p, q, r).sign() * _turn(p, q, s).sign() > 0


def _is_ear(spots: list[Spot], left: list[int], k: int) -> bool:
    a, b, c = (spots[m] for m in (left[k - 1], left[k], left[(k + 1) % len(left)]))
    if _turn(a, b, c).sign() <= 0:
        return False
    others = [
        spots[m] for n, m in enumerate(left) if (n - k) % len(left) not in (0, 1, len(left) - 1)
    ]
    return all(
        any(_turn(p, q, other).sign() < 0 for p, q in ((a, b), (b, c), (c, a))) for other in others
    )


# --- directions, chosen in floats: the tests are valid with any direction -------------------------


def _widest(boxes: Boxes, one: Sequence[int], two: Sequence[int]) -> Direction:
    """The direction with the widest gap between two prisms.

    If the prisms are disjoint, the normal of a face of one of them parts them, or the cross product
    of an edge of each.
    """
    p, q = ([middle_of(boxes[v]) for v in prism] for prism in (one, two))
    edges: list[list[Point]] = []
    made: list[Point] = []
    for t in (p, q):
        normal = unit(minus(t[3], t[0]))
        sides = [unit(minus(t[(k + 1) % 3], t[k])) for k in range(3)]
        edges.append([*sides, normal])
        made += [normal, *(crossed(side, normal) for side in sides)]
    made += [crossed(s, t) for s in edges[0] for t in edges[1]]
    best, width = [0.0, 0.0, 0.0], 0.0
    for n in map(unit, made):
        a, b = ([sum(x * y for x, y in zip(n, z, strict=True)) for z in t] for t in (p, q))
        for gap, sign in ((min(a) - max(b), 1), (min(b) - max(a), -1)):
            if gap > width:
                best, width = [sign * c for c in n], gap
    return whole(best)
