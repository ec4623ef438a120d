"""Panels as plates: prisms over the panels, cut back from the folds.

The kinematics is that of the sheet without thickness, which is one plane in every plate: T. Tachi,
"Rigid-foldable thick origami", Origami 5 (2011), 253-263. All hinges lie in this plane, so that all
vertices close as they do in the sheet. Each plate keeps a distance `trim` from the folds of its
panel, as two plates at a hinge could not turn otherwise. Let `depth` be how far the plates reach
from the sheet on the side on which a fold closes. In a plane across the fold, the nearest points of
both plates on this side are at the angle arctan(depth / trim) from the panels. They meet if the
fold angle is pi - 2 arctan(depth / trim) = 2 arctan(trim / depth), if the edges of the plates face
each other there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from math import atan, pi
from typing import Final

import numpy as np
from flint import arb, ctx, fmpq

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.errors import StuckPlatesError, UsageError
from exactfold.exact.numbers import decimal_above, format_rational
from exactfold.exact.surds import Number, ball, sign
from exactfold.motion.curves.motion_document import PlatesDocument
from exactfold.motion.solid.ears import Spot, ears, may_cross, turned
from exactfold.panels.vertex.stars import dot
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

MIDDLE: Final = "middle"
VALLEY: Final = "valley"
HINGES: Final = (MIDDLE, VALLEY)

BITS: Final = 128
NEAR: Final = 1 - Fraction(1, 1 << 40)
"""Plates are proved to be farther from a fold than this part of the trim."""


@dataclass(frozen=True)
class Solid:
    """How thick panels are, where their hinges lie, and how far they are cut back from the folds.

    `thickness` and `trim` are in the unit of the pattern. The hinges are in the `middle` of the
    plates, or in their upper surface, where valleys close (`valley`). Raises `UsageError` for a
    thickness that is not positive, a negative trim, and another hinge.

    >>> half = Solid(Fraction(1, 2), "middle", Fraction(1, 4))
    >>> half.heights
    (Fraction(-1, 4), Fraction(1, 4))
    >>> round(half.limit("V") * 180 / pi, 9)
    90.0
    """

    thickness: Fraction
    hinge: str
    trim: Fraction

    def __post_init__(self) -> None:
        if self.hinge not in HINGES:
            raise UsageError(f"the hinge {self.hinge!r} is neither {MIDDLE} nor {VALLEY}")
        if self.thickness <= 0:
            raise UsageError(
                f"the thickness is {format_rational(self.thickness)}: give a positive number"
            )
        if self.trim < 0:
            raise UsageError(
                f"the trim is {format_rational(self.trim)}: give a positive number, or 0"
            )

    @property
    def heights(self) -> tuple[Fraction, Fraction]:
        """The lowest and the highest point of the plates of the flat sheet, over the sheet."""
        if self.hinge == VALLEY:
            return -self.thickness, Fraction(0)
        return -self.thickness / 2, self.thickness / 2

    def depth(self, letter: str) -> Fraction:
        """How far plates reach from the sheet on the side on which a fold closes."""
        low, high = self.heights
        return high if letter == "V" else -low

    def limit(self, letter: str) -> float:
        """The angle, in radians, at which the two plates at a mountain or a valley meet."""
        depth = self.depth(letter)
        return 2 * atan(self.trim / depth) if depth else pi

    def refuse_stuck(self, letters: dict[Edge, str]) -> None:
        """Raise `StuckPlatesError` if the plates of the flat sheet stop a fold at once.

        `letters` are those of all folds. Without trim, plates that reach beyond the sheet on the
        side on which a fold closes would run into each other at any angle.
        """
        if self.trim:
            return
        for (i, j), letter in letters.items():
            if letter in "MV" and self.depth(letter):
                raise StuckPlatesError(
                    f"the flat sheet is stuck: plates of thickness {_text(self.thickness)} with "
                    f"hinges in {_PLACE[self.hinge]} meet at fold {i}-{j}, "
                    f"a {_NAME[letter]}, as soon as it turns; cut them back from the folds (--trim)"
                )
        raise UsageError(
            "plates that are not cut back from the folds touch in the flat sheet already, so that "
            "no first contact can be told: give a small --trim"
        )

    def to_dict(self) -> PlatesDocument:
        """The object of the plates in the output of `exactfold fold --json`."""
        return {
            "thickness": format_rational(self.thickness),
            "hinge": "valley" if self.hinge == VALLEY else "middle",
            "trim": format_rational(self.trim),
        }

    @property
    def text(self) -> str:
        """The plates in words."""
        return (
            f"{_text(self.thickness)} thick, hinges in {_PLACE[self.hinge]}, "
            f"cut back by {_text(self.trim)} from the folds"
        )


_PLACE: Final = {MIDDLE: "the middle", VALLEY: "the upper surface"}
_NAME: Final = {"M": "mountain", "V": "valley"}


def _text(value: Fraction) -> str:
    return format_rational(value) if value.denominator < 1000 else decimal_above(value, 6)


@dataclass(frozen=True)
class Plates:
    """The plates of a sheet, cut into prisms over triangles.

    The corners of a plate are where the sides of its panel meet after all folds among them were
    moved inwards by the trim; sides on the boundary of the sheet stay. Where a fold and a part of
    the boundary are in one line, both ends of the step between them are corners.

    Raises `StuckPlatesError` if nothing is left of a panel: if a side turns round or two sides
    cross; and `NotApplicableError` for a sheet whose positions are known only nearly.
    """

    pattern: PanelPattern
    solid: Solid

    def __post_init__(self) -> None:
        self.pattern.check_positions()

    @cached_property
    def outlines(self) -> tuple[tuple[tuple[int, Spot], ...], ...]:
        """For each panel the corners of its plate in order, as a vertex and the way from there."""
        with ctx.workprec(BITS):
            return tuple(tuple(self._outline(face)) for face in self.pattern.faces)

    def _outline(self, face: Sequence[int]) -> Iterator[tuple[int, Spot]]:
        count = len(face)
        directions = [self.pattern.direction(face[k], face[(k + 1) % count]) for k in range(count)]
        units = [_unit(d) for d in directions]
        widths = [self._width(face[k], face[(k + 1) % count]) for k in range(count)]
        for k, v in enumerate(face):
            (px, py), (qx, qy) = units[k - 1], units[k]
            before, after = widths[k - 1], widths[k]
            if sign(_cross(directions[k - 1], directions[k])):
                turn = px * qy - py * qx
                a, b = before / turn, after / turn
                yield v, (a * qx - b * px, a * qy - b * py)
                continue
            yield v, (-py * before, px * before)
            if before != after:
                yield v, (-qy * after, qx * after)

    def _width(self, i: int, j: int) -> arb:
        inner = (i, j) in self.pattern.sides and (j, i) in self.pattern.sides
        return _arb(self.solid.trim) if inner else arb(0)

    @cached_property
    def triangles(self) -> tuple[tuple[tuple[int, int, int], ...], ...]:
        """For each panel the triangles into which its plate is cut, by numbers of its corners."""
        with ctx.workprec(BITS):
            return tuple(self._cut(panel) for panel in range(len(self.pattern.faces)))

    def _cut(self, panel: int) -> tuple[tuple[int, int, int], ...]:
        """The triangles of one plate; refuses an outline that is not simple."""
        spots, face = self._spots(panel), self.pattern.faces[panel]
        outline = self.outlines[panel]
        for i, j in pairwise([*range(len(spots)), 0]):
            (v, _), (w, _) = outline[i], outline[j]
            if v != w and not _along(self.pattern, (v, w), spots[i], spots[j]):
                raise self._gone(panel, f"its side {v}-{w} is used up")
        triangles = None if may_cross(spots) else ears(spots)
        if triangles is None:
            raise self._gone(panel, "its sides cross")
        if not turned(*(spots[k] for k in triangles[-1])) > 0:
            raise self._gone(panel, f"its side {face[0]}-{face[1]} is used up")
        return triangles

    def _gone(self, panel: int, why: str) -> StuckPlatesError:
        name = "-".join(map(str, self.pattern.faces[panel]))
        return StuckPlatesError(
            f"panel {name} cannot be cut back by {_text(self.solid.trim)} from its folds: {why}; "
            "give a smaller --trim, which is the thickness by default"
        )

    def _spots(self, panel: int) -> list[Spot]:
        """The corners of a plate relative to the first corner of its panel."""
        first = self.pattern.faces[panel][0]
        spots = []
        for v, (x, y) in self.outlines[panel]:
            (px, py), (qx, qy) = self.pattern.vertices[first], self.pattern.vertices[v]
            spots.append((ball(qx - px, BITS) + x, ball(qy - py, BITS) + y))
        return spots

    # --- numbers of corners and prisms -----------------------------------------------------------

    @cached_property
    def corners(self) -> tuple[tuple[int, int, Spot], ...]:
        """All corners of all plates: the panel, a vertex, and the way from this vertex."""
        return tuple(
            (panel, v, way) for panel, outline in enumerate(self.outlines) for v, way in outline
        )

    @cached_property
    def prisms(self) -> IndexArray:
        """The six corners of each prism, shape (prisms, 6): three below, and those above them.

        Corner k of `corners` has the number 2 k below and 2 k + 1 above.
        """
        rows, first = [], 0
        for outline, triangles in zip(self.outlines, self.triangles, strict=True):
            for triangle in triangles:
                below = [2 * (first + k) for k in triangle]
                rows.append([*below, *(k + 1 for k in below)])
            first += len(outline)
        return np.array(rows, dtype=np.intp)

    @cached_property
    def surface(self) -> IndexArray:
        """The closed surfaces of all plates: triangles of corners, counter-clockwise from outside.

        The corners have the numbers that `prisms` gives them; shape (triangles, 3).
        """
        rows, first = [], 0
        for outline, triangles in zip(self.outlines, self.triangles, strict=True):
            for a, b, c in triangles:
                rows += [[2 * (first + k) for k in (a, c, b)]]
                rows += [[2 * (first + k) + 1 for k in (a, b, c)]]
            count = len(outline)
            for k in range(count):
                i, j = 2 * (first + k), 2 * (first + (k + 1) % count)
                rows += [[i, j, j + 1], [i, j + 1, i + 1]]
            first += count
        return np.array(rows, dtype=np.intp)

    @cached_property
    def panel_of(self) -> IndexArray:
        """The panel of each prism."""
        return np.repeat(
            np.arange(len(self.triangles)), [len(triangles) for triangles in self.triangles]
        )

    def pairs(self, letters: dict[Edge, str]) -> IndexArray:
        """The pairs of prisms that can meet: in panels that no flat folds join, shape (pairs, 2).

        `letters` are those of the folds.
        """
        body = list(range(len(self.pattern.faces)))
        sides = self.pattern.sides
        for i, j in self.pattern.folds:
            if letters[i, j] == "F":
                one, two = body[sides[i, j]], body[sides[j, i]]
                body = [one if b == two else b for b in body]
        bodies = np.array(body)[self.panel_of]
        rows = np.stack(np.triu_indices(len(bodies), 1), axis=1)
        return np.asarray(rows[bodies[rows[:, 0]] != bodies[rows[:, 1]]])

    def hinged(self, pairs: IndexArray) -> dict[int, Edge]:
        """The rows of pairs of prisms on both sides of a fold, with this fold.

        All corners of these prisms are proved to be farther from the line of the fold, on their
        side, than a part `NEAR` of the trim.
        """
        at = {
            (self.pattern.sides[i, j], self.pattern.sides[j, i]): (i, j)
            for i, j in self.pattern.folds
        }
        rows: dict[int, Edge] = {}
        with ctx.workprec(BITS):
            for row, pair in enumerate(pairs.tolist()):
                one, two = self.panel_of[pair].tolist()
                (one, two), pair = (
                    ((two, one), pair[::-1])
                    if (two, one) in at
                    else (
                        (one, two),
                        pair,
                    )
                )
                if (one, two) in at:
                    i, j = at[one, two]
                    if self._far(pair[0], i, j) and self._far(pair[1], j, i):
                        rows[row] = (i, j)
        return rows

    def _far(self, prism: int, i: int, j: int) -> bool:
        """Whether a prism lies to the left of a line, farther than a part of the trim."""
        ux, uy = _unit(self.pattern.direction(i, j))
        x, y = self.pattern.vertices[i]
        least = _arb(self.solid.trim * NEAR)
        for corner in self.prisms[prism][:3].tolist():
            _, v, (dx, dy) = self.corners[corner // 2]
            p, q = self.pattern.vertices[v]
            across = ux * (ball(q - y, BITS) + dy) - uy * (ball(p - x, BITS) + dx)
            if not across > least:
                return False
        return True

    @cached_property
    def flat(self) -> FloatArray:
        """All corners, below and above in turn, in the flat sheet, in floats; shape (2 k, 3)."""
        points = []
        for _, v, (x, y) in self.corners:
            a, b = (float(c) for c in self.pattern.vertices[v])
            for height in self.solid.heights:
                points.append((a + float(x.mid()), b + float(y.mid()), float(height)))
        return np.array(points)

    @cached_property
    def local(self) -> FloatArray:
        """The same corners relative to the first corners of their panels, in floats."""
        points = []
        with ctx.workprec(BITS):
            for panel in range(len(self.pattern.faces)):
                for x, y in self._spots(panel):
                    a, b = float(x.mid()), float(y.mid())
                    points += [(a, b, float(height)) for height in self.solid.heights]
        return np.array(points)

    @cached_property
    def _bases(self) -> tuple[IndexArray, FloatArray]:
        """For each panel three of its corners, and the coordinates of its plate with respect to
        them.

        The coordinates are along two sides of a triangle, and its unit normal.
        """
        points = np.array([(float(x), float(y)) for x, y in self.pattern.vertices])
        triples: list[list[int]] = []
        rows: list[FloatArray] = []
        owners = np.repeat([panel for panel, _, _ in self.corners], 2)
        for panel, face in enumerate(self.pattern.faces):
            corners = points[list(face)]
            one = int(np.linalg.norm(corners - corners[0], axis=1).argmax())
            side = corners[one] - corners[0]
            off = side[0] * (corners - corners[0])[:, 1] - side[1] * (corners - corners[0])[:, 0]
            two = int(np.abs(off).argmax())
            frame = np.stack([side, corners[two] - corners[0]], axis=1)
            flat = self.flat[owners == panel]
            along = np.linalg.solve(frame, (flat[:, :2] - corners[0]).T).T
            turn = np.sign(off[two])
            rows.append(np.column_stack([along, turn * flat[:, 2]]))
            triples.append([face[0], face[one], face[two]])
        return np.array(triples)[owners], np.concatenate(rows)

    def places(self, coords: FloatArray) -> FloatArray:
        """The corners of all plates in space, shape (times, 2 k, 3), given all vertices.

        `coords` has the shape (times, V, 3).
        """
        triples, rows = self._bases
        a, b, c = (coords[:, triples[:, k]] for k in range(3))
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=2, keepdims=True)
        return np.asarray(a + rows[:, :1] * (b - a) + rows[:, 1:2] * (c - a) + rows[:, 2:] * normal)


def _arb(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))


def _unit(direction: Point) -> Spot:
    x, y = (ball(c, BITS) for c in direction)
    length = ball(dot(direction, direction), BITS).sqrt()
    return x / length, y / length


def _cross(a: Point, b: Point) -> Number:
    return a[0] * b[1] - a[1] * b[0]


def _along(pattern: PanelPattern, edge: Edge, p: Spot, q: Spot) -> bool:
    """Whether the way from one corner to the next has the direction of an edge, for certain."""
    x, y = (ball(c, BITS) for c in pattern.direction(*edge))
    return bool((q[0] - p[0]) * x + (q[1] - p[1]) * y > 0)
