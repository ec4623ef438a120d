"""Frames of a proved motion: float coordinates with proved bounds of their errors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import float_bounds
from exactfold.motion.curves.angles import fold_angles_of, hinges_of
from exactfold.motion.curves.boundary_path import problem_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.curves.in_motion import FrameBounds
from exactfold.motion.curves.motion import Motion
from exactfold.motion.tubes.arclength import in_floats
from exactfold.motion.tubes.tracks import Frame
from exactfold.rigidity.equations.problem import Problem

_NEAR = 1e-4
"""A motion in floats may differ from the proved one by this, in the unit of the framework."""


@dataclass(frozen=True, repr=False)
class EnclosedPositions:
    """Coordinates of all vertices of a pattern, shape (V, 3), with an error bound for each vertex.

    `from_the_pin` are the same points relative to the first pinned corner, in the unit of the
    framework, in floats without a bound; angles are computed from them.
    """

    coords: FloatArray
    radii: tuple[Fraction, ...]
    from_the_pin: FloatArray

    @property
    def radius(self) -> float:
        """An error bound for all vertices, rounded up."""
        return float_bounds(max(self.radii))[1]

    def __repr__(self) -> str:
        return f"<EnclosedPositions: {len(self.coords)} vertices, radius {self.radius:.1e}>"


def positions_in(problem: Problem, framework: Framework, frame: Frame) -> EnclosedPositions:
    """The vertices at a frame as the nearest floats, with bounds of their errors.

    In the unit and at the place of the pattern, a coordinate is X + unit d. X is that of the flat
    vertex, exactly, and |d - centre| <= radius in the box of the frame. A vertex inside a
    triangulated triangle is a convex combination of the corners of the triangle. Everything is
    rational until the last step.
    """
    pattern, ball = problem.pattern, frame.ball
    one = 1 << ball.bits
    scale = framework.unit / one
    place = {int(v): 3 * k for k, v in enumerate(framework.free)}
    exact: dict[int, tuple[list[Fraction], Fraction]] = {}
    for v, label in enumerate(problem.labels):
        x, y = pattern.vertices[label]
        spot, radius = [Fraction(x), Fraction(y), Fraction(0)], Fraction(0)
        if v in place:
            k = place[v]
            spot = [a + scale * c for a, c in zip(spot, ball.centre[k : k + 3], strict=True)]
            radius = scale * max(ball.radii[k : k + 3])
        exact[label] = spot, radius
    for vertex, cycle, weights in problem.flat_inside:
        corners = [exact[c] for c in cycle]
        spot = [
            sum((w * at[a] for w, (at, _) in zip(weights, corners, strict=True)), Fraction(0))
            for a in range(3)
        ]
        exact[vertex] = spot, max(radius for _, radius in corners)
    coords = np.array([[float(x) for x in exact[v][0]] for v in range(len(pattern.vertices))])
    radii = tuple(
        max(abs(Fraction(f) - x) for f, x in zip(row, exact[v][0], strict=True)) + exact[v][1]
        for v, row in enumerate(coords.tolist())
    )
    x, y = pattern.vertices[problem.labels[framework.pinned[0]]]
    pin, unit = (Fraction(x), Fraction(y), Fraction(0)), framework.unit
    near = np.array(
        [
            [float((a - b) / unit) for a, b in zip(exact[v][0], pin, strict=True)]
            for v in range(len(pattern.vertices))
        ]
    )
    return EnclosedPositions(coords, radii, near)


def with_enclosed_frames(
    motion: Motion, framework: Framework, frames: Sequence[Frame]
) -> Motion | None:
    """The motion with the frames of the proved motion, one for each time of the motion.

    None if these are not near the frames in floats, which means that the floats have left the
    branch.
    """
    problem = problem_of(motion.branch)
    enclosures = [positions_in(problem, framework, frame) for frame in frames]
    coords = np.array([positions.coords for positions in enclosures])
    if np.abs(coords - motion.coords).max() > _NEAR * float(framework.unit):
        return None
    near = np.array([positions.from_the_pin for positions in enclosures])
    angles = fold_angles_of(near, hinges_of(motion.pattern))
    angles = angles + 2 * np.pi * np.rint((motion.angles - angles) / (2 * np.pi))
    times = [
        in_floats((min(low, Fraction(time)), max(high, Fraction(time))))
        for (low, high), time in zip(
            (frame.time for frame in frames), motion.times.tolist(), strict=True
        )
    ]
    bounds = FrameBounds(tuple(positions.radius for positions in enclosures), tuple(times))
    return replace(motion, coords=coords, angles=angles, bounds=bounds)
