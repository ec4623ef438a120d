"""Where curves pass nodes, and which of them pass the same one along the same line."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.arclength import Interval
from exactfold.motion.tubes.branch_point_stresses import directions_at
from exactfold.motion.tubes.branch_point_tube import NodeTube, prove_node_tube
from exactfold.motion.tubes.flat_patches import FlatPatch, FlatPoint
from exactfold.motion.tubes.piece import Ball

Side = tuple[int, int]
"""One of the two halves of an arc that goes through a node: the number of its line, and 1 or -1."""


@dataclass(frozen=True, repr=False)
class Visit:
    """That a curve passes a node.

    In the box `node` lies a configuration at which the stars of `flat`, vertices of the framework,
    are flat; the curve goes through it in a direction that is a multiple > 0 of one in the box
    `direction`. `time` bounds when, in the unit of the framework.
    """

    flat: tuple[int, ...]
    node: Ball
    direction: Ball
    time: Interval

    @classmethod
    def of(cls, tube: NodeTube, time: Interval) -> Visit:
        """The passage of the middle of an arc."""
        return cls(tube.patch.flat, tube.node, tube.enclosure(0), time)

    @property
    def mirrored(self) -> Visit:
        """The visit of the mirror image."""
        return replace(self, node=self.node.mirrored, direction=self.direction.mirrored)

    def __repr__(self) -> str:
        return f"<Visit: flat at {self.flat}, time {float(self.time[0]):.4g}>"


@dataclass(frozen=True, repr=False)
class LocatedNode:
    """A node in its box, with the lines along which curves go through it, one for each.

    There is exactly one configuration with this flat patch in the box of `point`. `lines` are boxes
    of directions that are proved to be no multiples of each other, each with its curve. If they are
    2^|flat|, they are all: the directions are zeros of |flat| quadrics in a projective space of
    this dimension, and these are simple (docs/motions.md, The graph).
    """

    point: FlatPoint
    lines: tuple[Ball, ...]

    @classmethod
    def of(cls, framework: Framework, visit: Visit) -> LocatedNode | None:
        """The node of a visit; None if it is not proved to be the one that is found."""
        patch = FlatPatch.of(framework, visit.flat)
        near = visit.node.floats[0]
        point = None if patch is None else patch.point(near, visit.node.bits)
        if patch is None or point is None or not point.is_in(visit.node):
            return None
        lines: list[Ball] = []
        for along in directions_at(framework, patch, near):
            tube = prove_node_tube(framework, patch, near, along)
            if tube is None or not point.is_in(tube.node):
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
        """Whether no other curves go through the node."""
        return len(self.lines) == 1 << len(self.flat)

    @property
    def mirrored(self) -> LocatedNode:
        """The mirror image."""
        point = self.point
        signs = (1, 1, -1) * (len(point.centre) // 3)
        centre = tuple(s * x for s, x in zip(signs, point.centre, strict=True))
        image = replace(point, ball=point.ball.mirrored, centre=centre)
        return LocatedNode(image, tuple(line.mirrored for line in self.lines))

    def meets(self, visit: Visit) -> bool | None:
        """Whether a visit is one of this node; None if that is not decided."""
        if self.point.ball.misses(visit.node):
            return False
        return True if visit.flat == self.flat and self.point.is_in(visit.node) else None

    def side(self, visit: Visit) -> Side | None:
        """Along which line a visit of this node leaves it, and to which side; None if open.

        All lines are known, so it is the one that is not proved to be another.
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
    # |a_i b_j - a_j b_i| less what the radii can change it by, exactly.
    minor = one.centre[i] * two.centre[j] - one.centre[j] * two.centre[i]
    off = sum(
        abs(one.centre[k]) * two.radii[m]
        + one.radii[k] * abs(two.centre[m])
        + one.radii[k] * two.radii[m]
        for k, m in ((i, j), (j, i))
    )
    return abs(minor) > off


def _sign(one: Ball, two: Ball) -> int:
    """The sign of the scalar product of all vectors in two boxes, 0 if it is not certain."""
    rows = zip(one.centre, one.radii, two.centre, two.radii, strict=True)
    middle, off = 0, 0
    for x, r, y, s in rows:
        middle += x * y
        off += abs(x) * s + r * abs(y) + r * s
    return 0 if abs(middle) <= off else 1 if middle > 0 else -1
