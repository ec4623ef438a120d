"""`roll`: follows a branch of a periodic sheet, shown as a patch of cells that rolls up."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import pi, radians
from types import MappingProxyType
from typing import Any, Final, cast

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold._support.plurals import counted as in_words
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.result import PeriodicCount
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.motion.curves.angles import fold_angles_of, hinges_of
from exactfold.motion.curves.crossings import Crossings
from exactfold.motion.curves.events import ANGLE, CONTACT, FLAT_FOLD, SINGULAR, Event
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.curves.motion_document import RollingMotionDocument
from exactfold.motion.following import Goal
from exactfold.motion.periodic.patch import CELLS, Patch
from exactfold.motion.periodic.tubes import prove_curve
from exactfold.motion.periodic.wrapping import Wrapping
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import described
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.rigidity.equations.periodic import PeriodicProblem
from exactfold.solve.numeric.periodic_rays import PeriodicRays

_STEP: Final = 0.02
_LEAST: Final = 1e-7
_TURN: Final = radians(3.0)
_MOST_STEPS: Final = 4000
_HALVINGS: Final = 40


@dataclass(frozen=True, repr=False, eq=False)
class RollingMotion(SheetInMotion):
    """A patch of a periodic sheet of rigid triangles that rolls up along a branch.

    All cells fold equally, and two commuting screw motions leave the whole sheet invariant. The
    ratio of their angles is that of n . l for the two lattice vectors l, for the direction n. `way`
    is the number of the branch in `counted`. Times are lengths of the curve of solutions from the
    flat sheet, in units of its own. `screws` has, for each frame, the angle in radians and the
    advance of both screws. The motion was followed in floats; if `tubes` is a number, so many tubes
    prove that one curve of true motions leads from the flat sheet past all frames, and each unknown
    of a frame is within `radius` of a point of it. The first contact of faces is computed in
    floats, and not proved.
    """

    counted: PeriodicCount
    way: int
    cells: tuple[int, int]
    patch: Patch
    times: FloatArray
    coords: FloatArray
    angles: FloatArray
    screws: FloatArray
    events: tuple[Event, ...]
    end: str
    seconds: float = field(default=0.0, compare=False)
    bounds: None = None
    tubes: int | None = None
    radius: float = field(default=0.0, compare=False)

    @property
    def pattern(self) -> CreasePattern:
        """The flat patch."""
        return self.patch.pattern

    @property
    def status(self) -> Verdict:
        """PROVED if tubes prove the motion, else UNDECIDED."""
        return UNDECIDED if self.tubes is None else PROVED

    @property
    def reason(self) -> str:
        """How the frames were found."""
        if self.tubes is not None:
            return (
                f"one curve of true motions without a gap, {in_words(self.tubes, 'tube')}; each "
                f"frame is within {self.radius:.1e} of it; the first contact is not proved"
            )
        branch = self.counted[self.way - 1]
        if "0" not in branch.vertex_signs and not self.counted.pleats:
            return (
                "a true motion begins with this branch (docs/tessellations.md, Theorem 18); the "
                "frames and the first contact were computed in floats"
            )
        return "the frames and the first contact were computed in floats"

    @property
    def name(self) -> str:
        """The direction and the number of the way."""
        x, y = self.counted.direction
        return f"way {self.way} across {x},{y}"

    @property
    def time_name(self) -> str:
        """What the time measures."""
        return "length of the curve of solutions"

    @property
    def assignment(self) -> Mapping[Edge, str]:
        """The letter of each fold of the patch on the side that is followed."""
        letters = self.counted[self.way - 1].letters
        return MappingProxyType(self.patch.letters(self.counted.pattern, letters))

    @property
    def leading_angles(self) -> Mapping[Edge, float]:
        """The fold angles in degrees of the second frame."""
        return dict(zip(self.pattern.folds, np.degrees(self.angles[1]).tolist(), strict=True))

    @property
    def leading_angles_are(self) -> str:
        """What the leading angles are."""
        return "the fold angles of the second frame"

    @property
    def pinned(self) -> tuple[int, ...]:
        """The corners of the face in the middle, which is held."""
        return self.pattern.triangles[_middle(self.pattern)]

    @property
    def facts(self) -> dict[str, Any]:
        """The facts about the motion that files contain."""
        branch = self.counted[self.way - 1]
        return {
            "direction": list(self.counted.direction),
            "way": self.way,
            "vertex_signs": branch.vertex_signs,
            "cells": list(self.cells),
            "screws": self.screws[-1].tolist(),
            **self.facts_of_frames(),
        }

    def _positions(self, time: float) -> FloatArray:
        k = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        low, high = self.times[k - 1], self.times[k]
        share = (time - low) / (high - low)
        return np.asarray((1 - share) * self.coords[k - 1] + share * self.coords[k])

    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """The times and angles of the frames."""
        return self.times, self.angles

    def to_dict(
        self, name: str | None = None, written: Sequence[str] = ()
    ) -> RollingMotionDocument:
        """The object printed by `exactfold fold CELL --direction X,Y --json`."""
        return {
            "format": "exactfold motion result",
            "version": 3,
            "pattern": described(self.pattern, name),
            "theory": "periodic",
            "direction": list(self.counted.direction),
            "cells": list(self.cells),
            "screws": self.screws.tolist(),
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.assignment.items())},
            "way": self.way,
            **self.frames_reported(written),
            "seconds": round(self.seconds, 3),
            "proof": None,
        }

    def __repr__(self) -> str:
        return (
            f"<RollingMotion: {self.name}, {self.cells[0]} x {self.cells[1]} cells, "
            f"{len(self.times)} frames to {self.end}>"
        )


def roll(
    cell: object,
    direction: Sequence[RationalLike],
    *,
    way: int = 1,
    cells: tuple[int, int] = CELLS,
    until: str | float = CONTACT,
    frames: int = 60,
    proving: bool = False,
    progress: Progress | None = None,
) -> RollingMotion:
    """The motion of a periodic sheet along a branch, shown as n x m cells.

    The equations of a sheet wrapped on a cylinder are followed from the flat sheet by steps of
    pseudo-arclength (docs/tessellations.md, Theorem 18). `way` is the number in the list of
    `count_periodic`; `cells` are the numbers of cells along both lattice vectors, and `until` is
    "contact", when two faces of the patch meet or a fold closes, or a fold angle such as "90deg".
    Lengths are those of the pattern. The middle face of the patch is held. With `proving`, the
    curve is proved, too (`prove_curve`); if that fails, the `status` stays UNDECIDED.

    Raises the errors of `count_periodic`, `UsageError` for a way that is not in the list or a bad
    goal, and `NotApplicableError` for a branch with flat vertices, at which the motion is not
    known to be one curve.

    >>> motion = roll("waterbomb-cell", (1, 2), way=2, cells=(2, 2), until="60deg", frames=4)
    >>> motion.coords.shape, motion.end, bool(motion.length_error < 1e-9)
    ((4, 20, 3), 'angle', True)
    """
    pattern = as_cell(cell)
    _goal(until)  # before the work
    patch = Patch.of(pattern, cells)
    counted = count_periodic(pattern, direction, progress=progress)
    return rolled(
        counted,
        way,
        patch,
        cells=cells,
        until=until,
        frames=frames,
        proving=proving,
        progress=progress,
    )


def _goal(until: str | float) -> Goal:
    goal = Goal.of(until)
    if goal.time is not None or goal.kinds.isdisjoint({CONTACT, ANGLE, FLAT_FOLD}):
        raise UsageError(f"until {until!r}: give contact, or an angle such as 90deg")
    return goal


def rolled(
    counted: PeriodicCount,
    way: int,
    patch: Patch,
    *,
    cells: tuple[int, int],
    until: str | float = CONTACT,
    frames: int = 60,
    proving: bool = False,
    progress: Progress | None = None,
) -> RollingMotion:
    """The motion of a branch that was counted; `patch` has the given number of cells. See `roll`.

    Raises `UsageError` and `NotApplicableError`.
    """
    begin = time.perf_counter()
    if frames < 2:
        raise UsageError(f"{frames} frames: a motion has at least 2")
    goal = _goal(until)
    if not 1 <= way <= len(counted):
        raise UsageError(f"way {way}: `count` lists {len(counted)} ways in this direction")
    wrapping = _wrapping(counted, way)
    path = _Path(wrapping, counted, patch, goal)
    path.follow(progress)
    places = path.frames(frames)
    proof = prove_curve(wrapping, places) if proving else None
    coords = np.array([path.held(place) for place in places])
    hinges = hinges_of(patch.pattern)
    angles = np.unwrap(fold_angles_of(coords, hinges), axis=0)
    times = np.linspace(0.0, path.length, frames)
    return RollingMotion(
        counted,
        way,
        cells,
        patch,
        times,
        coords,
        angles,
        np.array([wrapping.screws(place) for place in places]),
        path.events,
        path.end,
        time.perf_counter() - begin,
        tubes=None if proof is None else proof.tubes,
        radius=0.0 if proof is None else max(proof.radii),
    )


def _wrapping(counted: PeriodicCount, way: int) -> Wrapping:
    """The equations, with the ray of the branch in floats, on the side that is listed."""
    branch = counted[way - 1]
    problem = PeriodicProblem.of(counted.pattern, counted.direction)
    signs = [{"+": 1, "-": -1, "0": 0}[branch.vertex_signs[v]] for v in problem.labels]
    if 0 in signs:
        raise NotApplicableError(
            f"way {way} has flat vertices: other branches cross there, and no motion is known"
        )
    rays = PeriodicRays(problem)
    wanted = np.array(signs) * signs[0]
    row = int(np.flatnonzero((rays.signs == wanted).all(axis=1))[0])
    ray = rays.rays()[row] * signs[0]
    return Wrapping(problem, ray)


@dataclass
class _Faces:
    """What `Crossings` needs of a sheet of triangles."""

    sheet: CreasePattern
    triangles: IndexArray
    flat: FloatArray


@dataclass
class _Path:
    """The curve of solutions (z, t), followed by steps."""

    wrapping: Wrapping
    counted: PeriodicCount
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
        middle = list(pattern.triangles[_middle(pattern)])
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


def _middle(pattern: CreasePattern) -> int:
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
