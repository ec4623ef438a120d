"""The first contact of the plates of a motion of panels, with proved bounds of its time.

The corners of all prisms are carried by their panels (`PanelPieces`). Two prisms do not touch on a
stretch if a plane parts them; they touch at a time if a point is inside both.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import inf

import numpy as np
from flint import arb, ctx, fmpq

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import ball
from exactfold.motion.contacts.face_pairs import Open
from exactfold.motion.contacts.separation import Swept
from exactfold.motion.curves.events import Event
from exactfold.motion.curves.zeros import zero_of
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.pieces import BITS, PanelPieces
from exactfold.motion.panels.places import Placing
from exactfold.motion.panels.reaching import all_below, clear_before
from exactfold.motion.solid.contacts import PlateContacts
from exactfold.motion.solid.overlaps import common_point, inside, not_parted, overlapping
from exactfold.motion.solid.plates import NEAR, Plates, Solid
from exactfold.pattern.panel_pattern import Edge

Material = tuple[int, tuple[Fraction, Fraction, Fraction]]
"""A panel, and a point of its plate in the flat sheet: the way (x, y) from the first corner of the
panel, and the height.
"""

_POINT_BITS = 44


@dataclass(frozen=True)
class PlatePieces(PanelPieces):
    """The pieces of a motion that carry the corners of all plates, and a point of a plate."""

    plates: Plates | None = None
    extra: Material | None = None

    @property
    def at_rest(self) -> Swept:
        """The points in the flat sheet."""
        points = [point for _, point in self._carried]
        there = np.array([vector for vector, _ in points])
        off = np.array([[off] * 3 for _, off in points])
        return Swept.of(there[None], off, 0.0, 0.0)

    @cached_property
    def _carried(self) -> list[tuple[int, tuple[FloatArray, float]]]:
        if self.plates is None:
            raise ValueError("pieces of plates need plates")
        pattern, points = self.motion.pattern, []
        with ctx.workprec(BITS):
            heights = [_arb(height) for height in self.plates.solid.heights]
            for panel, v, (dx, dy) in self.plates.corners:
                x, y = (ball(c, BITS) for c in self._from_origin(pattern.vertices[v]))
                points += [(panel, self._vector(x + dx, y + dy, z)) for z in heights]
            if self.extra is not None:
                panel, (dx, dy, height) = self.extra
                first = self._from_origin(pattern.vertices[pattern.faces[panel][0]])
                x, y = (ball(c, BITS) for c in first)
                points.append((panel, self._vector(x + _arb(dx), y + _arb(dy), _arb(height))))
        return points


@dataclass(frozen=True)
class ThickContacts:
    """The proofs about the plates of a motion."""

    motion: PanelMotion
    solid: Solid

    @cached_property
    def contacts(self) -> PlateContacts:
        """The plates, and the pairs of prisms that can meet."""
        letters: dict[Edge, str] = dict(self.motion.assignment)
        return PlateContacts(Plates(self.motion.pattern, self.solid), letters)

    @cached_property
    def pieces(self) -> PlatePieces:
        """The motion of all corners."""
        return PlatePieces(self.motion, None, self.contacts.plates)

    @cached_property
    def _placing(self) -> Placing:
        return Placing(self.motion.pattern, self.motion.held)

    def _places(self, times: FloatArray) -> FloatArray:
        return self._placing.positions(self.motion.angles_at(times))[0]

    def phases(self) -> list[tuple[float, Open]]:
        """Until when which pairs have to be proved to stay apart: at first without the neighbours.

        The plane that bisects the angle between two panels parts their plates until the fold has
        the angle of `Solid.limit`; all angles are smaller until the first of these times.
        """
        rows = np.arange(len(self.contacts.pairs), dtype=np.intp)
        others = np.setdiff1d(rows, list(self.contacts.plates.hinged(self.contacts.pairs)))
        none = np.zeros(0, dtype=np.intp)
        every = Open(rows, none, none)
        if all_below(self.pieces, self.motion.duration, self.sizes):
            return [(inf, Open(others, none, none))]
        first = clear_before(self.pieces, self._limit, self.sizes)
        return [(first, Open(others, none, none)), (inf, every)]

    @cached_property
    def sizes(self) -> dict[Edge, arb]:
        """tan(angle / 2) of the angles until which neighbours are proved to stay apart."""
        with ctx.workprec(BITS):
            return {
                fold: _arb(self.solid.trim * NEAR / self.solid.depth(letter))
                for fold, letter in self.motion.assignment.items()
                if letter in "MV" and self.solid.depth(letter)
            }

    @property
    def _limit(self) -> float:
        """The time at which the first fold has its limit, in floats."""
        limits = np.array(
            [
                self.solid.limit(letter) if letter in "MV" else inf
                for letter in self.motion.assignment.values()
            ]
        )

        def over(time: float) -> float:
            return float((np.abs(self.motion.angles_at(np.array([time]))[0]) - limits).max())

        last = self.motion.duration
        return last if over(last) <= 0 else zero_of(over, 0.0, last)

    def left(self, swept: Swept, among: Open) -> Open:
        """The pairs that are not proved to stay apart on a stretch."""
        return not_parted(self.contacts.pairs, self.contacts.plates.prisms, swept, among)

    def named(self, left: Open) -> tuple[tuple[tuple[int, ...], tuple[int, ...]], ...]:
        """The pairs of panels among the pairs that are left, each once."""
        faces, panel_of = self.motion.pattern.faces, self.contacts.plates.panel_of
        pairs = {
            tuple(sorted(faces[panel] for panel in panel_of[row].tolist()))
            for row in self.contacts.pairs[left.apart]
        }
        return tuple(sorted((one, two) for one, two in pairs))

    def crossed(self, time: float) -> tuple[Event, Material] | None:
        """Two plates that are proved to overlap at a time, and a point of both; or None.

        The point is given where it is in the flat sheet, as a point of the first plate.
        """
        there = self.contacts.plates.places(self._places(np.array([time])))[0]
        rows = overlapping(there, self.contacts.plates.prisms, self.contacts.pairs)
        if not len(rows):
            return None
        one, two = self.contacts.deepest(time, self._places, rows)
        point = self.shared(there, one, two)
        if point is None or not self.proves(time, point, two):
            return None
        return self.contacts.event((time, time), (one, two)), point

    def shared(self, there: FloatArray, one: int, two: int) -> Material | None:
        """A point inside two prisms, in floats, where it is in the plate of the first."""
        plates = self.contacts.plates
        corners = plates.prisms[[one, two]]
        found = common_point(there[corners[0]], there[corners[1]])
        if found is None:
            return None
        first, *others = corners[0][:4]
        edges = [(p[others] - p[first]).T for p in (there, plates.local)]
        along = np.linalg.solve(edges[0], found - there[first])
        scale = Fraction(self.pieces.unit) / (1 << _POINT_BITS)
        x, y, z = (
            round(float(c) / float(scale)) * scale for c in edges[1] @ along + plates.local[first]
        )
        return int(plates.panel_of[one]), (x, y, z)

    def proves(self, time: float, point: Material, two: int) -> bool:
        """Whether a point of a plate is proved to be in it, and in another prism at a time."""
        plates = self.contacts.plates
        pieces = PlatePieces(self.motion, None, plates, point)
        piece, last = pieces.around(time), 2 * len(plates.corners)
        if piece is None:
            return False
        own = plates.prisms[plates.panel_of == point[0]]
        moving = Swept.of(piece.coefficients, piece.radius, 0.0, 0.0)
        return any(inside(pieces.at_rest, last, prism) for prism in own) and inside(
            moving, last, plates.prisms[two]
        )


def _arb(value: Fraction) -> arb:
    return arb(fmpq(value.numerator, value.denominator))
