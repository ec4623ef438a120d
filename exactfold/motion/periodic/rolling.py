"""`roll`: follows a branch of a periodic sheet, shown as a patch of cells that rolls up."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted as in_words
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.periodic.counting import count_periodic
from exactfold.branches.periodic.result import PeriodicCount
from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.motion.curves.angles import fold_angles_of, hinges_of
from exactfold.motion.curves.events import ANGLE, CONTACT, FLAT_FOLD, Event
from exactfold.motion.curves.in_motion import SheetInMotion
from exactfold.motion.curves.motion_document import RollingMotionDocument
from exactfold.motion.following import Goal
from exactfold.motion.periodic.patch import CELLS, Patch
from exactfold.motion.periodic.rolling_path import RollingPath, middle_face
from exactfold.motion.periodic.tubes import prove_curve
from exactfold.motion.periodic.wrapping import Wrapping
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import described
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.rigidity.equations.periodic import PeriodicProblem
from exactfold.solve.numeric.periodic_rays import PeriodicRays


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
        return self.pattern.triangles[middle_face(self.pattern)]

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
    path = RollingPath(wrapping, patch, goal)
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
