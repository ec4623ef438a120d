"""The rules of docs/matching.md for one vertex and for fans, and H1 sheets, exactly."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import atan2, pi

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import spokes
from exactfold.rigidity.functionals import saddle_functional, vertex_sign_functional


def is_h1(sheet: CreasePattern) -> bool:
    """Whether boundary vertices of degree 3 can be removed one by one until two faces are left."""
    faces, rim = set(map(tuple, sheet.triangles)), list(sheet.boundary)

    def removable() -> int | None:
        for v in rim:
            mine = [t for t in faces if v in t]
            neighbours = {u for t in mine for u in t} - {v}
            if len(mine) == 2 and len(neighbours - set(rim)) == 1:
                return v
        return None

    while len(faces) > 2:
        v = removable()
        if v is None:
            return False
        mine = [t for t in faces if v in t]
        faces -= set(mine)
        (new,) = {u for t in mine for u in t} - set(rim)
        rim[rim.index(v)] = new
    return True


def sectors(sheet: CreasePattern) -> list[float]:
    """The sector angles of a sheet with one interior vertex, in floats."""
    (hub,) = sheet.interior
    hx, hy = sheet.vertices[hub]
    around = [
        atan2(float(sheet.vertices[v][1] - hy), float(sheet.vertices[v][0] - hx))
        for v in sheet.star(hub)
    ]
    return [(b - a) % (2 * pi) for a, b in zip(around, around[1:] + around[:1], strict=True)]


def without(sheet: CreasePattern, x: int) -> CreasePattern:
    """The sheet without a boundary vertex of degree 3; its interior neighbour is then a corner."""
    kept = [v for v in range(len(sheet.vertices)) if v != x]
    place = {v: k for k, v in enumerate(kept)}
    faces = [tuple(place[v] for v in t) for t in sheet.triangles if x not in t]
    return CreasePattern([sheet.vertices[v] for v in kept], faces)


def last_functional(sheet: CreasePattern) -> dict[int, Fraction]:
    """Of the last sign: the boundary saddle, or the sign of a reflex corner in the closed sheet."""
    corner = sheet.reflex_corner
    if corner is None:
        return saddle_functional(sheet)
    closed = vertex_sign_functional(sheet.with_notch_closed(), corner)
    return {v: Fraction(c) for v, c in closed.items()}


@dataclass(frozen=True)
class FourBar:
    """One vertex: the curve a x^2 + 2 b x y + c y^2 = q x^2 y^2 in the tangents of folds 1 and 2.

    With v = y / x it doubly covers the interval of the v with (a + 2 b v + c v^2) / q >= 0, which
    ends at the two modes. From one mode to the other x changes its sign iff it passes v = 0, where
    x is infinite: the fold is closed.
    """

    sheet: CreasePattern
    a: Fraction
    b: Fraction
    c: Fraction
    q: Fraction

    @classmethod
    def of(cls, sheet: CreasePattern) -> FourBar:
        (hub,) = sheet.interior
        _, d = spokes(sheet, hub)

        def bracket(i: int, j: int) -> Fraction:
            return d[i][0] * d[j][1] - d[i][1] * d[j][0]

        def dot(i: int, j: int) -> Fraction:
            return d[i][0] * d[j][0] + d[i][1] * d[j][1]

        c12, c23, c34, c41 = bracket(0, 1), bracket(1, 2), bracket(2, 3), bracket(3, 0)
        q = c12 * (c34 * dot(0, 1) + c12 * dot(2, 3))
        return cls(sheet, c41 * bracket(0, 2), c23 * c41, -c23 * bracket(1, 3), q)

    @property
    def singular(self) -> bool:
        """Whether there is a singular configuration other than the flat one."""
        return not self.a * self.c * self.q

    def signs(self, mode: int) -> tuple[int, ...]:
        """The two signs of the ray x > 0 of a mode, +-1 for the two roots v."""
        (hub,) = self.sheet.interior
        ring, d = spokes(self.sheet, hub)
        found = []
        # The face between spokes 1 and 2 is at height 0, fold 1 lifts 4 and fold 2 lifts 3.
        lift4 = d[3][0] * d[0][1] - d[3][1] * d[0][0]
        lift3 = d[1][0] * d[2][1] - d[1][1] * d[2][0]
        for f in (vertex_sign_functional(self.sheet, hub), last_functional(self.sheet)):
            constant, slope = f.get(ring[3], 0) * lift4, f.get(ring[2], 0) * lift3
            # constant + slope v, v = (-b +- sqrt(b^2 - a c)) / c
            rest = Fraction(constant - slope * self.b / self.c)
            root = Fraction(mode * slope / self.c)
            square = rest * rest - root * root * (self.b * self.b - self.a * self.c)
            found.append(_sign(rest) if square > 0 else _sign(root))
        return tuple(found)

    def flipped(self) -> tuple[int, ...]:
        """The places of the signs that differ between the ends of each loop."""
        turn = -1 if self.a * self.q > 0 else 1
        start, end = self.signs(1), tuple(turn * s for s in self.signs(-1))
        return tuple(k for k in range(2) if start[k] != end[k])


def _sign(value: Fraction) -> int:
    return (value > 0) - (value < 0)
