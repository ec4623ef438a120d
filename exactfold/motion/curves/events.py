"""What happens along a motion: contacts, closed folds, creases that turn back, branch points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Annotated, TypedDict

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.documents import Face, FoldText, Keywords, Natural, NotNegative, Pair
from exactfold.motion.curves.angles import angle_rates, fold_angles_of
from exactfold.motion.curves.crossing_curves import crossing_in, flat_star_in, flat_vertices
from exactfold.motion.curves.crossings import Crossings
from exactfold.motion.curves.curve import Piece
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.zeros import least_of, zero_of
from exactfold.pattern.crease_pattern import Edge, Triangle

CONTACT, FLAT_FOLD, TURNING, CHANGE = "contact", "flat-fold", "turning", "change"
NODE, SINGULAR, RETURN = "node", "singular", "return"
ANGLE, LENGTH = "angle", "length"
DRIVEN, DEAD_POINT, STOP = "driven", "dead-point", "stop"

KINDS = (
    CONTACT,
    FLAT_FOLD,
    TURNING,
    CHANGE,
    NODE,
    SINGULAR,
    RETURN,
    ANGLE,
    DRIVEN,
    DEAD_POINT,
    STOP,
)
"""All kinds of events."""

CHANGES = "from mountain to valley", "from valley to mountain"
"""What a fold does that passes through flat: its angle grows, or falls."""

PASSED = TURNING, CHANGE
"""Kinds of events at which no motion ends."""

ENDS = (*(kind for kind in KINDS if kind not in PASSED), LENGTH)
"""Where motions end: at an event of these kinds, or at a time without an event."""

_SAMPLES = 8
_NEAR_FLAT = 0.3
_FLAT = 1e-5
_STILL = 1e-9
_HINGE = np.arange(4)[None]


class EventDocument(TypedDict):
    """Something that happens between two times of a motion."""

    kind: Annotated[str, Keywords(enum=[*KINDS])]
    time: Pair[NotNegative]
    """Lower and upper bound, in floating point."""
    faces: list[Face]
    """By their corners."""
    folds: list[FoldText]
    vertices: list[Natural]
    detail: str
    """What happens, in words."""


@dataclass(frozen=True)
class Event:
    """Something that happens between two times of a motion.

    `kind` is one of the following. "contact": two `faces` meet. "flat-fold": a fold reaches 180
    degrees. "turning": a fold angle has a critical point, so the crease turns back. "change": a
    fold passes through flat, so that a mountain becomes a valley or the other way round. "node":
    another curve of configurations crosses, often where the stars of `vertices` are flat.
    "singular": the curve could not be followed further. "return": the sheet is flat again. "angle":
    the requested angle is reached. "driven": the driven folds have their angles. "dead-point": they
    turn back before. "stop": a fold reaches its hard stop. `time` is a lower and an upper bound of
    the time of the event. `faces` are given by their corners. `detail` says more in words.
    """

    kind: str
    time: tuple[float, float]
    faces: tuple[tuple[int, ...], ...] = ()
    folds: tuple[Edge, ...] = ()
    vertices: tuple[int, ...] = ()
    detail: str = ""

    def to_dict(self) -> EventDocument:
        """The object of this event in the output of `exactfold fold --json`."""
        return {
            "kind": self.kind,
            "time": list(self.time),
            "faces": [list(face) for face in self.faces],
            "folds": [f"{i}-{j}" for i, j in self.folds],
            "vertices": list(self.vertices),
            "detail": self.detail,
        }


@dataclass(repr=False)
class Watch:
    """Looks for events on the pieces of a curve in turn.

    Vertices are those of the framework; times are its arclength. `angles` are the fold angles at
    the end of the last piece, continued beyond +-pi. `driven` are folds with the sizes, in radians,
    of the angles to which they are driven; all of them are reached at the same time.
    """

    framework: Framework
    largest_angle: float | None = None
    look_for_contacts: bool = True
    driven: tuple[tuple[Edge, float], ...] = ()
    angles: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.angles = np.zeros(len(self.framework.hinges))
        self._crossings = Crossings(self.framework)
        self._before: Piece | None = None

    def events(self, piece: Piece) -> list[tuple[float, Event]]:
        """The events of a piece with their parameters, sorted by parameter."""
        grid = np.linspace(0.0, piece.reach, _SAMPLES + 1)
        positions = self.framework.positions(piece.at(grid))
        raw = fold_angles_of(positions, self.framework.hinges)
        angles = np.unwrap(np.vstack([self.angles, raw]), axis=0)[1:]
        events = [
            *self._branch_point(piece),
            *self._angle_events(piece, grid, angles),
            *self._turnings(piece, grid, positions, angles),
            *self._changes(piece, grid, angles),
            *self._returns(piece, grid, raw),
        ]
        if self.look_for_contacts:
            events += self._contacts(piece, grid, positions)
        self.angles = angles[-1]
        return sorted(events, key=lambda item: item[0])

    def _event(
        self, piece: Piece, kind: str, low: float, high: float, **more: object
    ) -> tuple[float, Event]:
        times = piece.time + piece.length_to(low), piece.time + piece.length_to(high)
        return high, Event(kind, times, **more)  # type: ignore[arg-type]

    def _branch_point(self, piece: Piece) -> list[tuple[float, Event]]:
        """A crossing of curves on the previous piece: its orientation changes, or a star
        is flat.
        """
        before, self._before = self._before, piece
        if before is None or not before.orientation:
            return []
        turns = before.orientation * piece.orientation < 0
        ends = (crossing_in if turns else flat_star_in)(self.framework, before)
        if ends is None:
            return []
        low, high = (before.time + before.length_to(s) for s in ends)
        flat = flat_vertices(self.framework, before.at(ends[1]))
        return [(0.0, Event(NODE, (low, high), vertices=flat))]

    def _angle_events(
        self, piece: Piece, grid: FloatArray, angles: FloatArray
    ) -> list[tuple[float, Event]]:
        events = []
        goals = [(np.pi, FLAT_FOLD)]
        if self.largest_angle is not None and self.largest_angle < np.pi:
            goals.append((self.largest_angle, ANGLE))
        every = list(range(angles.shape[1]))
        watched = [(goal, kind, every) for goal, kind in goals]
        if self.driven:
            # Choose a fold that does not close at its goal: there its angle changes at some rate.
            driven, goal = min(self.driven, key=lambda item: abs(item[1] - np.pi / 2))
            watched.append((goal, DRIVEN, [self.framework.sheet.folds.index(driven)]))
        for goal, kind, columns in watched:
            beyond = np.abs(angles) >= goal
            for k, e in np.argwhere(beyond[1:] & ~beyond[:-1]):
                if e not in columns:
                    continue
                reaching = _FoldOnPiece.of(self.framework, piece, e)

                def excess(
                    s: float,
                    fold: _FoldOnPiece = reaching,
                    near: float = angles[k + 1, e],
                    goal: float = goal,
                ) -> float:
                    return abs(fold.angle(s, near)) - goal

                low, high = _bracket(excess, grid[k], grid[k + 1])
                i, j, left, right = (int(v) for v in self.framework.hinges[e])
                faces = ((i, j, left), (i, right, j)) if kind == FLAT_FOLD else ()
                folds = tuple(f for f, _ in self.driven) if kind == DRIVEN else ((i, j),)
                events.append(self._event(piece, kind, low, high, faces=faces, folds=folds))
        return events

    def _turnings(
        self, piece: Piece, grid: FloatArray, positions: FloatArray, angles: FloatArray
    ) -> list[tuple[float, Event]]:
        framework = self.framework
        rates = angle_rates(positions, framework.displacement(piece.speed(grid)), framework.hinges)
        events = []
        # The rates of folds that stay flat are only rounding errors.
        sizes = np.abs(rates)
        moving = np.maximum(sizes[1:], sizes[:-1]) > _STILL * sizes.max(initial=0.0)
        for k, e in np.argwhere((rates[1:] * rates[:-1] < 0) & moving):
            fold = _FoldOnPiece.of(framework, piece, e)
            low, high = _bracket(fold.rate, grid[k], grid[k + 1])
            i, j = (int(v) for v in framework.hinges[e, :2])
            size = abs(np.degrees(fold.angle(high, angles[k + 1, e])))
            events.append(
                self._event(
                    piece, TURNING, low, high, folds=((i, j),), detail=f"at {size:.4g} degrees"
                )
            )
            if self.driven and (i, j) == self.driven[0][0]:
                folds = tuple(fold for fold, _ in self.driven)
                events.append(self._event(piece, DEAD_POINT, low, high, folds=folds))
        return events

    def _changes(
        self, piece: Piece, grid: FloatArray, angles: FloatArray
    ) -> list[tuple[float, Event]]:
        """Folds that pass through flat; `detail` is for the side of the branch that was named."""
        events = []
        bent = np.abs(angles) > _FLAT  # smaller angles may be rounding errors
        for k, e in np.argwhere((angles[1:] * angles[:-1] < 0) & bent[1:] & bent[:-1]):
            fold = _FoldOnPiece.of(self.framework, piece, e)
            low, high = _bracket(partial(fold.angle, near=0.0), grid[k], grid[k + 1])
            folds = (tuple(int(v) for v in self.framework.hinges[e, :2]),)
            detail = CHANGES[int(angles[k, e] > 0)]
            events.append(self._event(piece, CHANGE, low, high, folds=folds, detail=detail))
        return events

    def _returns(
        self, piece: Piece, grid: FloatArray, raw: FloatArray
    ) -> list[tuple[float, Event]]:
        """The return to the flat sheet, where all fold angles vanish at once."""
        if piece.time == 0.0:
            return []
        sizes = np.max(np.abs(raw), axis=1, initial=0.0)
        k = int(np.argmin(sizes))
        if sizes[k] > _NEAR_FLAT:
            return []

        def bend(s: float) -> float:
            positions = self.framework.positions(piece.at(s))
            return float(np.abs(fold_angles_of(positions, self.framework.hinges)).max(initial=0.0))

        # Near the flat sheet pieces are short; the polynomial is accurate slightly beyond its end.
        ends = grid[max(k - 1, 0)], grid[k + 1] if k < _SAMPLES else 2.5 * piece.reach
        s, least = least_of(bend, *ends, within=1e-13)
        if least > _FLAT:
            return []
        return [self._event(piece, RETURN, s, s)]

    def _contacts(
        self, piece: Piece, grid: FloatArray, positions: FloatArray
    ) -> list[tuple[float, Event]]:
        """The first contact: the first parameter at which an edge runs through a face, by
        bisection.
        """
        hits = self._crossings.any_of(positions)
        if not hits.any() or hits[0]:
            return []
        k = int(np.argmax(hits))
        low, high = grid[k - 1], grid[k]
        pair = pairs = self._crossings.pairs(positions[k])
        while len(pairs):  # other pairs may cross earlier than those that cross at the end
            start, pair = low, pairs
            while high - start > 1e-13 * max(piece.reach, 1e-300):
                middle = 0.5 * (start + high)
                if not start < middle < high:
                    break
                there = self.framework.positions(piece.at(middle))
                if self._crossings.cross(there[None], pairs).any():
                    high = middle
                else:
                    start = middle
            pairs = self._crossings.pairs(self.framework.positions(piece.at(start)))
            if len(pairs):
                high = start
        low = start
        there = self.framework.positions(piece.at(high))
        first = pair[self._crossings.cross(there[None], pair)[0]][0]
        crossing = self._crossings.named(first)
        faces = (self._face_at(crossing.edge, crossing.face), crossing.face)
        detail = self._crossings.kind(crossing, there)
        return [self._event(piece, CONTACT, low, high, faces=faces, detail=detail)]

    def _face_at(self, edge: Edge, other: Triangle) -> Triangle:
        """A face with this edge; a face that shares no corner with the other face is preferred."""
        faces = [t for t in self.framework.sheet.triangles if set(edge) <= set(t)]
        return min(faces, key=lambda t: len(set(t) & set(other)))


@dataclass(frozen=True)
class _FoldOnPiece:
    """One fold on a piece of a curve; only its four corners are computed.

    `corners` is the piece with the displacements of the corners as its twelve unknowns. `flat` are
    their places in the flat sheet, shape (4, 3).
    """

    corners: Piece
    flat: FloatArray

    @classmethod
    def of(cls, framework: Framework, piece: Piece, fold: int) -> _FoldOnPiece:
        """The fold with this number in a framework."""
        hinge = framework.hinges[fold]
        rows = framework.displacement(piece.coefficients)[:, hinge].reshape(-1, 12)
        return cls(
            replace(piece, coefficients=rows), np.pad(framework.flat[hinge], ((0, 0), (0, 1)))
        )

    def _positions(self, s: float) -> FloatArray:
        return np.asarray(self.corners.at(s).reshape(4, 3) + self.flat)

    def angle(self, s: float, near: float) -> float:
        """The angle of the fold plus the multiple of 2 pi that makes it closest to `near`."""
        raw = float(fold_angles_of(self._positions(s), _HINGE)[0])
        return raw + 2 * np.pi * round((near - raw) / (2 * np.pi))

    def rate(self, s: float) -> float:
        """The rate at which the angle changes."""
        speed = self.corners.speed(s).reshape(4, 3)
        return float(angle_rates(self._positions(s), speed, _HINGE)[0])


def _bracket(function: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    """Two close parameters between which a function changes its sign, from two distant ones."""
    at_low, at_high = function(low), function(high)
    if at_low * at_high > 0:
        return low, high
    if at_low == 0 or at_high == 0:
        s = low if at_low == 0 else high
        return s, s
    s = zero_of(function, low, high)
    gap = 1e-12 * (high - low)
    return max(low, s - gap), min(high, s + gap)
