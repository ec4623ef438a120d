"""The curve of solutions of a sheet wrapped on a cylinder, followed in floats to an event."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi, radians
from typing import Any, Final, cast

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold._support.progress import Progress
from exactfold.errors import NotApplicableError
from exactfold.motion.curves.angles import fold_angles_of, hinges_of
from exactfold.motion.curves.crossings import Crossings
from exactfold.motion.curves.events import ANGLE, CONTACT, FLAT_FOLD, SINGULAR, Event
from exactfold.motion.following import Goal
from exactfold.motion.periodic.patch import Patch
from exactfold.motion.periodic.wrapping import Wrapping
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_STEP: Final = 0.02
_LEAST: Final = 1e-7
_TURN: Final = radians(3.0)
_MOST_STEPS: Final = 4000
_HALVINGS: Final = 40


@dataclass
class _Faces:
    """What `Crossings` needs of a sheet of triangles."""

    sheet: CreasePattern
    triangles: IndexArray
    flat: FloatArray


@dataclass
class RollingPath:
    """The curve of solutions (z, t) from the flat sheet, followed by steps of pseudo-arclength."""

    wrapping: Wrapping
    patch: Patch
    goal: Goal
    places: list[FloatArray] = field(default_factory=list)
    end: str = SINGULAR
    events: tuple[Event, ...] = ()

    def __post_init__(self) -> None:
        sheet = self.wrapping.problem.sheet
        labels = {v: k for k, v in enumerate(self.wrapping.problem.labels)}
        inside = {
            corner[0]: (ring, corner)
            for ring, group in self.wrapping.problem.parts.triangles
            for corner in group
        }
        pattern = self.patch.pattern
        self._own = [k for k, (v, _, _) in enumerate(self.patch.corners) if v in labels]
        self._corners = np.array(
            [(labels[v], i, j) for v, i, j in self.patch.corners if v in labels], dtype=np.intp
        )
        self._inside: list[tuple[int, IndexArray, FloatArray]] = []
        for k, (v, i, j) in enumerate(self.patch.corners):
            if v in inside:
                ring, (_, p, q) = inside[v]
                moved = [(labels[u], a - p + i, b - q + j) for u, a, b in ring]
                rows = [[*map(float, sheet.place(c)), 1.0] for c in moved]
                here = [*map(float, pattern.vertices[k]), 1.0]
                weights = np.linalg.solve(np.array(rows).T, np.array(here))
                self._inside.append((k, np.array(moved, dtype=np.intp), weights))
        self._hinges = hinges_of(pattern)
        self.flat = np.array([[*map(float, point), 0.0] for point in pattern.vertices])
        scale = self.wrapping.scale
        faces = _Faces(pattern, np.array(pattern.triangles, dtype=np.intp), self.flat / scale)
        self._crossings = Crossings(cast("Any", faces))
        middle = list(pattern.triangles[middle_face(pattern)])
        self._base, self._frame = self.flat[middle[0]], _axes(self.flat[middle])
        self._held = middle

    def coords(self, place: FloatArray) -> FloatArray:
        """The places of all vertices of the patch, in the frame of the cylinder."""
        found = np.empty((len(self.patch.corners), 3))
        found[self._own] = self.wrapping.coordinates(place, self._corners)
        for k, corners, weights in self._inside:
            found[k] = weights @ self.wrapping.coordinates(place, corners)
        return found

    def held(self, place: FloatArray) -> FloatArray:
        """The same, moved so that the middle face stays at its place."""
        coords = self.coords(place)
        axes = _axes(coords[self._held])
        return np.asarray((coords - coords[self._held[0]]) @ axes.T @ self._frame + self._base)

    def follow(self, progress: Progress | None) -> None:
        """Steps until the goal; the last place is where it is reached."""
        z = self.wrapping.start()
        if z is None:
            raise NotApplicableError("the branch is not simple in floats: no motion was followed")
        place = np.append(z, 0.0)
        self.places.append(place)
        tangent = np.append(np.zeros(len(z)), 1.0)
        angles = np.zeros(len(self._hinges))
        step = _STEP
        for count in range(_MOST_STEPS):
            if progress is not None and count % 20 == 0:
                progress("following", count, 0)
            tangent = self.wrapping.tangent(place, tangent)
            new = self.wrapping.corrected(place + step * tangent, tangent)
            turned = None if new is None else self._turned(new, angles)
            if new is None or turned is None or np.abs(turned - angles).max() > 2 * _TURN:
                step /= 2
                if step < _LEAST:
                    self.events = (Event(SINGULAR, (self.length, self.length)),)
                    return
                continue
            kind = self._reached(new, turned)
            if kind is not None:
                self._finish(place, tangent, step, angles, kind)
                return
            size = float(np.abs(turned - angles).max())
            place, angles = new, turned
            self.places.append(place)
            step *= float(np.clip(_TURN / max(size, 1e-12), 0.3, 1.5))

    def _turned(self, place: FloatArray, before: FloatArray) -> FloatArray:
        """The fold angles at a place, continued from those before."""
        raw = fold_angles_of(self.coords(place), self._hinges)
        return np.asarray(np.unwrap(np.vstack([before, raw]), axis=0)[1])

    def _reached(self, place: FloatArray, angles: FloatArray) -> str | None:
        largest = float(np.abs(angles).max())
        if self.goal.angle is not None and largest >= self.goal.angle - 1e-12:
            return ANGLE if self.goal.angle < pi else FLAT_FOLD
        if largest >= pi:
            return FLAT_FOLD
        if CONTACT in self.goal.kinds:
            coords = self.coords(place) / self.wrapping.scale
            if bool(self._crossings.any_of(coords[None])[0]):
                return CONTACT
        return None

    def _finish(
        self,
        place: FloatArray,
        tangent: FloatArray,
        step: float,
        angles: FloatArray,
        kind: str,
    ) -> None:
        """Halves the last step until the place of the event is known."""
        low, high = 0.0, step
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            new = self.wrapping.corrected(place + middle * tangent, tangent)
            if new is None:
                break
            found = self._reached(new, self._turned(new, angles))
            if found is None:
                low = middle
            else:
                high, kind = middle, found
        # just before a contact or a closed fold, so that no faces meet in the last frame
        last = self.wrapping.corrected(place + low * tangent, tangent)
        if last is not None:
            self.places.append(last)
        self.end = kind
        at = self.length
        folds = self._largest(self.places[-1]) if kind in (ANGLE, FLAT_FOLD) else ()
        faces: tuple[tuple[int, ...], ...] = ()
        beyond = self.wrapping.corrected(place + high * tangent, tangent)
        if kind == CONTACT and beyond is not None:
            pairs = self._crossings.pairs(self.coords(beyond) / self.wrapping.scale)
            if len(pairs):
                crossing = self._crossings.named(pairs[0])
                side = next(
                    face for face in self.patch.pattern.triangles if set(crossing.edge) <= set(face)
                )
                faces = (tuple(side), crossing.face)
        self.events = (Event(kind, (at, at + high - low), faces=faces, folds=folds),)

    def _largest(self, place: FloatArray) -> tuple[Edge, ...]:
        sizes = np.abs(fold_angles_of(self.coords(place), self._hinges))
        return (self.patch.pattern.folds[int(np.argmax(sizes))],)

    @property
    def length(self) -> float:
        """The length of the polygon through all places."""
        return float(self._lengths[-1])

    @property
    def _lengths(self) -> FloatArray:
        places = np.array(self.places)
        steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def frames(self, number: int) -> list[FloatArray]:
        """Solutions at equal steps of this length; the first is the flat sheet."""
        lengths, places = self._lengths, np.array(self.places)
        found = [self.places[0]]
        for at in np.linspace(0.0, self.length, number)[1:-1]:
            k = int(np.clip(np.searchsorted(lengths, at), 1, len(lengths) - 1))
            chord = places[k] - places[k - 1]
            size = float(np.linalg.norm(chord))
            guess = places[k - 1] + (at - lengths[k - 1]) / size * chord
            new = self.wrapping.corrected(guess, chord / size)
            found.append(guess if new is None else new)
        return [*found, self.places[-1]]


def middle_face(pattern: CreasePattern) -> int:
    """The face whose middle is the nearest to that of the sheet."""
    points = np.array([[float(x) for x in point] for point in pattern.vertices])
    middles = points[np.array(pattern.triangles)].mean(axis=1)
    centre = (points.min(axis=0) + points.max(axis=0)) / 2
    return int(np.argmin(((middles - centre) ** 2).sum(axis=1)))


def _axes(corners: FloatArray) -> FloatArray:
    """Three orthonormal axes of a triangle, as rows."""
    first = corners[1] - corners[0]
    first = first / np.linalg.norm(first)
    normal = np.cross(first, corners[2] - corners[0])
    normal /= np.linalg.norm(normal)
    return np.array([first, np.cross(normal, first), normal])
