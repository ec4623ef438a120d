"""Panels as plates: prisms over panels that are cut back from their folds.

A sheet without thickness is a plane in each plate, and all hinges lie in it. In the flat sheet the
plates reach from -thickness / 2 to thickness / 2, or, with the hinges on the side of valleys, from
-thickness to 0.

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
from typing import Any

from ...core.intervals import Interval
from ...core.limits import MOST_TESTS
from ...core.reading import items, parse_rational
from ...sheets.panels import Edge, PanelSheet
from ..boxes import Boxes, Curved, Direction, Point, crossed, middle_of, minus, parted, unit, whole
from ..claims import Document
from ..faces import FacePairs
from ..lengths import GRID
from .cut import from_least, panels_of
from .drive import DrivenModes
from .outlines import NEAR, Outlines, Solid
from .places import Carried, Places
from .series import BITS, thin
from .times import Clock


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
        x, trim = Interval.of(last, BITS), self.solid.trim * NEAR
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
