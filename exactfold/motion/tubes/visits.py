"""Where curves pass branch points, and which of them pass the same one along the same line."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_stresses import directions_at
from exactfold.motion.tubes.branch_point_tube import BranchPointTube, prove_branch_point_tube
from exactfold.motion.tubes.flat_patches import FlatPatch, FlatPoint
from exactfold.motion.tubes.piece import Ball

Side = tuple[int, int]
"""A half of an arc through a branch point: the number of the arc's line there, and 1 or -1."""


@dataclass(frozen=True, repr=False)
class Visit:
    """The fact that a curve passes a branch point (branch point).

    The box `branch_point` contains a configuration at which the stars of `flat`, vertices of the
    framework, are flat. The curve passes through it in a direction that is a positive multiple of a
    vector in the box `direction`. `time` bounds when, in the unit of the framework.
    """

    flat: tuple[int, ...]
    branch_point: Ball
    direction: Ball
    time: Interval

    @classmethod
    def of(cls, tube: BranchPointTube, time: Interval) -> Visit:
        """The passage of the middle of an arc."""
        return cls(tube.patch.flat, tube.branch_point, tube.enclosure(0), time)

    @property
    def mirrored(self) -> Visit:
        """The visit of the mirror image of the curve."""
        return replace(
            self, branch_point=self.branch_point.mirrored, direction=self.direction.mirrored
        )

    def __repr__(self) -> str:
        return f"<Visit: flat at {self.flat}, time {float(self.time[0]):.4g}>"


@dataclass(frozen=True, repr=False)
class LocatedBranchPoint:
    """A branch point in its box, and the lines along which curves pass through it.

    Each curve has one line. The box of `point` contains exactly one configuration with this flat
    patch. `lines` are boxes of directions; it is proved that none is a multiple of another, and
    that a curve belongs to each. If there are 2^|flat| lines, there are no others: the directions
    are zeros of |flat| quadrics in a projective space of this dimension, and these zeros are simple
    (docs/motion.md, 12).
    """

    point: FlatPoint
    lines: tuple[Ball, ...]

    @classmethod
    def of(cls, framework: Framework, visit: Visit) -> LocatedBranchPoint | None:
        """The branch point of a visit; None if the point found is not proved to be that of the
        visit.
        """
        patch = FlatPatch.of(framework, visit.flat)
        near = visit.branch_point.floats[0]
        point = None if patch is None else patch.point(near, visit.branch_point.bits)
        if patch is None or point is None or not point.is_in(visit.branch_point):
            return None
        lines: list[Ball] = []
        for along in directions_at(framework, patch, near):
            tube = prove_branch_point_tube(framework, patch, near, along)
            if tube is None or not point.is_in(tube.branch_point):
                continue
            line = tube.enclosure(0)
            if all(crosses(line, other) for other in lines):
                lines.append(line)
        return cls(point, tuple(lines))

    @property
    def flat(self) -> tuple[int, ...]:
        """The vertices of the framework whose stars are flat."""
        return self.point.patch.flat

    @property
    def has_all_lines(self) -> bool:
        """Whether it is proved that no other curves pass through the branch point."""
        return len(self.lines) == 1 << len(self.flat)

    @property
    def mirrored(self) -> LocatedBranchPoint:
        """The mirror image of the branch point."""
        point = self.point
        signs = (1, 1, -1) * (len(point.centre) // 3)
        centre = tuple(s * x for s, x in zip(signs, point.centre, strict=True))
        image = replace(point, ball=point.ball.mirrored, centre=centre)
        return LocatedBranchPoint(image, tuple(line.mirrored for line in self.lines))

    def meets(self, visit: Visit) -> bool | None:
        """Whether a visit is a visit of this branch point; None if that is undecided."""
        if self.point.ball.misses(visit.branch_point):
            return False
        return True if visit.flat == self.flat and self.point.is_in(visit.branch_point) else None

    def side(self, visit: Visit) -> Side | None:
        """The line along which a visit leaves this branch point, and the direction on it.

        None if that is undecided. All lines are known. So the line is the only one of which the
        visit's direction is not proved to be different.
        """
        if not self.has_all_lines:
            return None
        left = [k for k, line in enumerate(self.lines) if not crosses(line, visit.direction)]
        if len(left) != 1:
            return None
        sign = _sign(self.lines[left[0]], visit.direction)
        return (left[0], sign) if sign else None

    def __repr__(self) -> str:
        return f"<LocatedNode: flat at {self.flat}, {len(self.lines)} lines>"


def crosses(one: Ball, two: Ball) -> bool:
    """Whether vectors in two boxes are proved not to be multiples of each other.

    >>> crosses(Ball(0, (9, 0), (1, 1)), Ball(0, (0, 9), (1, 1)))
    True
    """
    a, b = one.floats[0], two.floats[0]
    i = int(np.argmax(np.abs(a)))
    j = int(np.argmax(np.abs(a[i] * b - b[i] * a)))
    # |a_i b_j - a_j b_i| has to exceed the most by which the radii can change it; all is exact.
    minor = one.centre[i] * two.centre[j] - one.centre[j] * two.centre[i]
    off = sum(
        abs(one.centre[k]) * two.radii[m]
        + one.radii[k] * abs(two.centre[m])
        + one.radii[k] * two.radii[m]
        for k, m in ((i, j), (j, i))
    )
    return abs(minor) > off


def _sign(one: Ball, two: Ball) -> int:
    """The sign of the scalar products of all vectors in two boxes; 0 if it is uncertain."""
    rows = zip(one.centre, one.radii, two.centre, two.radii, strict=True)
    middle, off = 0, 0
    for x, r, y, s in rows:
        middle += x * y
        off += abs(x) * s + r * abs(y) + r * s
    return 0 if abs(middle) <= off else 1 if middle > 0 else -1
