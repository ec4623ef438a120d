"""`Motion`: a sheet that folds along a branch, with frames, fold angles and events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.export import AMOUNT
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.exact.numbers import format_rational
from exactfold.motion.curves.angles import fold_angles_of, hinges_of
from exactfold.motion.curves.boundary_path import problem_of
from exactfold.motion.curves.curve import Curve
from exactfold.motion.curves.drive import PrescribedAngles
from exactfold.motion.curves.events import Event
from exactfold.motion.curves.in_motion import FrameBounds, SheetInMotion
from exactfold.motion.curves.motion_document import MotionDocument
from exactfold.motion.curves.stops import Stops
from exactfold.pattern.crease_pattern import CreasePattern, Edge, Triangle
from exactfold.pattern.described import described
from exactfold.pattern.near_degeneracy import warnings
from exactfold.rigidity.equations.problem import Problem

_SAMPLES = 4
_LONGEST: Final = 40
"""Most characters of signs in a name."""


@dataclass(frozen=True, repr=False, eq=False)
class Motion(SheetInMotion):
    """A sheet that folds along a branch; the motion is followed in floats.

    If `bounds` is given, the frames are proved: `prove(motion).motion` is such a motion. Events,
    `at` and `sampled` are in floats in any case.

    Faces stay rigid: every edge keeps its length with a relative error of about 1e-13. Time is the
    arclength of the curve of configurations in the length unit of the pattern, that is, the length
    of the path of the coordinates of all moving corners while the triangle `pinned` is held.

    `times` has shape (frames,) and starts with 0. `coords` has shape (frames, V, 3); the first
    frame is the flat sheet, and the triangle `pinned` stays in its place in the plane z = 0.
    `angles`, in radians, has shape (frames, folds), in the order of `pattern.folds`; an angle is
    positive for a valley and continues past +-pi. `events` are sorted by time. `end` is the kind of
    event at which the motion stops, or "length". `side` is 1 for the ray that `branch` describes,
    -1 for its mirror image. `drive` has the driven folds, or is None.
    """

    branch: Branch
    side: int
    curve: Curve = field(compare=False)
    times: FloatArray
    coords: FloatArray
    angles: FloatArray
    events: tuple[Event, ...]
    end: str
    seconds: float = field(default=0.0, compare=False)
    bounds: FrameBounds | None = None
    drive: PrescribedAngles | None = None
    stops: Stops | None = None

    @property
    def status(self) -> Verdict:
        """PROVED if the frames are enclosed (`bounds`), else UNDECIDED."""
        return UNDECIDED if self.bounds is None else PROVED

    @property
    def reason(self) -> str:
        """How the frames were found, or how near they are to true configurations."""
        if self.bounds is not None:
            return f"every frame is within {max(self.bounds.radii):.1e} of a proved configuration"
        if self.branch.status is PROVED:
            return "followed in floats along a proved branch"
        return f"the branch is not proved: {self.branch.reason}"

    @property
    def pattern(self) -> CreasePattern:
        """The flat sheet."""
        return self.branch.pattern

    @property
    def boundary_heights(self) -> Mapping[int, Fraction] | None:
        """With more than four corners, the heights whose ratio the boundary keeps; else None."""
        return self.branch.boundary_heights if self.curve.framework.ties else None

    @property
    def _boundary_heights_reported(self) -> dict[str, str] | None:
        boundary_heights = self.boundary_heights
        return (
            None
            if boundary_heights is None
            else {str(v): format_rational(h) for v, h in boundary_heights.items()}
        )

    @property
    def name(self) -> str:
        """A name made of the signs, shortened if there are many, and "mirror side" for side -1."""
        signs = self.branch.sign_text
        short = signs if len(signs) <= _LONGEST else f"{signs[: _LONGEST - 3]}..."
        return f"branch {short}" if self.side > 0 else f"branch {short}, mirror side"

    @property
    def time_name(self) -> str:
        """What the time measures."""
        return "arclength"

    @property
    def assignment(self) -> Mapping[Edge, str]:
        """The letter of each fold on the side that is followed: "M", "V", "F" or "U"."""
        letters = self.branch.assignment
        if self.side > 0:
            return letters
        return {fold: letter.translate(UPSIDE_DOWN) for fold, letter in letters.items()}

    @property
    def leading_angles(self) -> Mapping[Edge, float]:
        """The first-order fold angles, scaled to a largest angle of 30 degrees.

        See docs/viewer.md, Fold angles.
        """
        letters = self.assignment
        return {
            fold: self.side * angle if letters[fold] in "MV" else 0.0
            for fold, angle in self.branch.fold_angles.degrees(AMOUNT).items()
        }

    @property
    def leading_angles_are(self) -> str:
        """What the leading angles are, in words."""
        return "the first-order fold angles"

    @property
    def pinned(self) -> Triangle:
        """The corners of the triangle that is held."""
        a, b, c = (self._problem.labels[v] for v in self.curve.framework.pinned)
        return a, b, c

    @cached_property
    def _problem(self) -> Problem:
        return problem_of(self.branch)

    def _positions(self, time: float) -> FloatArray:
        unknowns = self.curve.at(time / float(self.curve.framework.unit))
        return np.asarray(in_space(self._problem, self.curve, unknowns[None], self.side)[0])

    def sampled(self, least: int = 200) -> tuple[FloatArray, FloatArray]:
        """Times and all fold angles in radians at `least` points or more, for plots.

        The shapes are (times,) and (times, folds). The angles continue past +-pi.
        """
        each = max(_SAMPLES, -(-least // len(self.curve.pieces)))
        times, unknowns = self.curve.samples(each)
        coords = _from_the_pin(self._problem, self.curve, unknowns, self.side)
        angles = np.unwrap(fold_angles_of(coords, hinges_of(self.branch.pattern)), axis=0)
        return times * float(self.curve.framework.unit), angles

    def angles_at(self, times: FloatArray) -> FloatArray:
        """All fold angles in radians at the given times, shape (times, folds), past +-pi."""
        unit = float(self.curve.framework.unit)
        unknowns = np.array([self.curve.at(time / unit) for time in times])
        return angles_at(self._problem, self.curve, times, unknowns, self.side)

    def to_dict(self, name: str | None = None, written: Sequence[str] = ()) -> MotionDocument:
        """The object printed by `exactfold fold --json`: `schema("motion")`.

        `name` is the name of the pattern, and `written` lists the files that hold the motion.
        """
        branch = self.branch
        return {
            "format": "exactfold motion result",
            "version": 3,
            "pattern": described(branch.pattern, name),
            "theory": "branches",
            "vertex_signs": {str(v): s for v, s in sorted(branch.vertex_signs.items())},
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(branch.assignment.items())},
            "side": self.side,
            "rim": self._boundary_heights_reported,
            "drive": None if self.drive is None else self.drive.to_dict(),
            "modes": None,
            "way": None,
            "plates": None,
            "stops": None if self.stops is None else self.stops.to_dict(self.pattern.folds),
            **self.frames_reported(written),
            "warnings": warnings(branch.pattern),
            "seconds": round(self.seconds, 3),
            "proof": None,
        }

    @property
    def facts(self) -> dict[str, Any]:
        """The facts about the motion that files contain, as JSON."""
        boundary_heights = self._boundary_heights_reported
        return {
            "vertex_signs": self.branch.sign_text,
            "vertices": list(self.pattern.interior),
            "side": self.side,
            **({} if boundary_heights is None else {"rim": boundary_heights}),
            **({} if self.drive is None else {"drive": self.drive.to_dict()}),
            **self.facts_of_frames(),
        }

    def __repr__(self) -> str:
        name = self.branch.sign_text
        short = name if len(name) <= 32 else f"{name[:29]}..."
        return (
            f"<Motion: branch {short}, {len(self.times)} frames to {self.end} at "
            f"{self.duration:.6g}>"
        )


def in_space(problem: Problem, curve: Curve, unknowns: FloatArray, side: int) -> FloatArray:
    """The positions of all vertices at given unknowns of the framework, shape (times, V, 3).

    Vertices inside a triangulated triangle move with it. The positions are in the unit and at the
    place of the pattern.
    """
    framework, pattern = curve.framework, problem.pattern
    x, y = pattern.vertices[problem.labels[framework.pinned[0]]]
    place = np.array([float(x), float(y), 0.0])
    near = _from_the_pin(problem, curve, unknowns, side)
    return np.asarray(near * float(framework.unit) + place)


def _from_the_pin(problem: Problem, curve: Curve, unknowns: FloatArray, side: int) -> FloatArray:
    """The same positions relative to the first pinned corner, in the unit of the framework.

    Angles are computed from these positions. Coordinates of the pattern itself can be far from the
    origin or in very large or small units, so that they, or their squares, have no digits left.
    """
    framework, pattern = curve.framework, problem.pattern
    coords = np.zeros((len(unknowns), len(pattern.vertices), 3))
    coords[:, problem.labels] = framework.positions(unknowns)
    for vertex, cycle, weights in problem.flat_inside:
        for corner, weight in zip(cycle, weights, strict=True):
            coords[:, vertex] += float(weight) * coords[:, corner]
    coords[:, :, 2] *= side
    return coords


def angles_at(
    problem: Problem, curve: Curve, times: FloatArray, unknowns: FloatArray, side: int
) -> FloatArray:
    """The fold angles of frames, shape (times, folds), continued without jumps along the curve.

    `unknowns` has the unknowns of the framework at the times. The curve is also sampled between the
    frames, so that the angles are continued rightly even if there are few frames.
    """
    hinges = hinges_of(problem.pattern)
    between, there = curve.samples(_SAMPLES)
    unit = float(curve.framework.unit)
    whole = np.concatenate([between * unit, times])
    both = np.concatenate([there, unknowns])
    angles = fold_angles_of(_from_the_pin(problem, curve, both, side), hinges)
    order = np.argsort(whole, kind="stable")
    continued = np.empty_like(angles)
    continued[order] = np.unwrap(angles[order], axis=0)
    return np.asarray(continued[len(between) :])
