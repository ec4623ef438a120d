"""The graph of true configurations: the flat state, the branch points, the arcs between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypedDict

from exactfold._support.documents import (
    Fold,
    Natural,
    NotNegative,
    Pair,
    ProvedOrNot,
    Several,
    Side,
)
from exactfold._support.verdict import PROVED, Verdict
from exactfold.motion.contacts.fold_ranges import angle_in_floats
from exactfold.motion.curves.motion_document import RayDocument
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.arclength import Interval, in_floats
from exactfold.pattern.crease_pattern import Edge

if TYPE_CHECKING:
    import networkx as nx

FLAT = "flat"


class BranchPointEnd(TypedDict):
    """An end of an arc at a branch point."""

    node: Natural
    line: Natural
    """Which of the lines along which curves go through the branch point."""
    side: Side
    """The straight continuation is the other side of the same line."""


class FlatEnd(TypedDict):
    """An end of an arc in the flat state."""

    half_branch: RayDocument


class AngleDocument(TypedDict):
    """A fold angle."""

    fold: Fold
    angle: Pair[float]
    """Proved bounds, in degrees."""


class BranchPointDocument(TypedDict):
    """A configuration in which curves cross."""

    flat: Several[Natural]
    """The vertices whose stars are flat."""
    curves: Natural
    """How many curves are proved to go through it."""
    status: ProvedOrNot
    """Proved: no other curve goes through it."""
    angles: list[AngleDocument]
    """Its fold angles."""
    mirror: Natural
    """The number of its mirror image."""
    loops: list[Natural]
    """The loops that pass it or its mirror image."""


_ArcFrom = TypedDict("_ArcFrom", {"from": FlatEnd | BranchPointEnd | None})


class ArcOfGraph(_ArcFrom):
    """A curve without branch points on it."""

    to: FlatEnd | BranchPointEnd | None
    length: Pair[NotNegative]
    """Proved bounds, in the unit of the sheet."""
    status: ProvedOrNot
    reason: str
    loop: Natural | None
    """The loop of which it, or its mirror image, is a part; null for an arc on no loop."""
    mirror: Natural
    """The number of its mirror image."""


class GraphDocument(TypedDict):
    """The configurations that can be reached from the flat state."""

    status: ProvedOrNot
    """Proved: this is the whole connected component of the flat state."""
    reason: str
    """What is missing, empty if proved."""
    nodes: list[BranchPointDocument]
    """Different configurations in which curves cross, mirror images next to each other."""
    arcs: list[ArcOfGraph]
    """Curves without branch points on them, mirror images next to each other."""
    closed_curves: list[Several[Natural]]
    """Closed curves that go straight on at their branch points and do not pass the flat state, by
    their arcs."""
    independent_cycles: Natural | None
    """The first Betti number of the component of the flat state, null if undecided."""


@dataclass(frozen=True, order=True)
class EndAtBranchPoint:
    """One end of an arc at a branch point: one of the two sides of the line of a curve.

    If an arc ends on one side of the line, its straight, that is analytic, continuation begins on
    the other side. `side` is 1 or -1.
    """

    branch_point: int
    line: int
    side: int

    @property
    def mirrored(self) -> EndAtBranchPoint:
        """The end in the mirror image. Nodes 2k and 2k + 1 are mirror images of each other."""
        return EndAtBranchPoint(self.branch_point ^ 1, self.line, self.side)

    @property
    def opposite(self) -> EndAtBranchPoint:
        """The end at which the straight continuation begins."""
        return EndAtBranchPoint(self.branch_point, self.line, -self.side)

    def to_dict(self) -> BranchPointEnd:
        """The object of this end in JSON."""
        return {"node": self.branch_point, "line": self.line, "side": self.side}


End = Ray | EndAtBranchPoint
"""An end of an arc: a ray at the flat state, or an end at a branch point."""


@dataclass(frozen=True, repr=False)
class GraphNode:
    """A branch point: the stars of the vertices `flat` are flat there, and curves cross.

    `curves` is the number of curves that are proved to pass through it; `status` is PROVED if there
    are no others. `angles` are bounds of its fold angles in degrees. `mirror` is the number of its
    mirror image. `loops` are the numbers of the loops that pass it or its mirror image.
    """

    flat: tuple[int, ...]
    curves: int
    status: Verdict
    angles: Mapping[Edge, Interval]
    mirror: int
    loops: tuple[int, ...]

    def to_dict(self) -> BranchPointDocument:
        """The object of this branch point in the output of `exactfold motions --json`."""
        return {
            "flat": list(self.flat),
            "curves": self.curves,
            "status": str(self.status),
            "angles": [
                {"fold": list(fold), "angle": list(angle_in_floats(angle))}
                for fold, angle in self.angles.items()
            ],
            "mirror": self.mirror,
            "loops": list(self.loops),
        }

    def __repr__(self) -> str:
        return f"<GraphNode: flat at {self.flat}, {self.curves} curves, {self.status}>"


@dataclass(frozen=True, repr=False)
class GraphArc:
    """A curve of regular configurations from one end to another.

    `length` are bounds of its length in the unit of the sheet. If an end is None, it is not known,
    for the given `reason`, and `status` is UNDECIDED. `loop` is the number of the loop of which
    this arc or its mirror image is a part, or None. `mirror` is the number of its mirror image.
    """

    start: End | None
    end: End | None
    length: Interval
    status: Verdict
    reason: str
    loop: int | None
    mirror: int

    def to_dict(self) -> ArcOfGraph:
        """The object of this arc in the output of `exactfold motions --json`."""
        return {
            "from": _named(self.start),
            "to": _named(self.end),
            "length": list(in_floats(self.length)),
            "status": str(self.status),
            "reason": self.reason,
            "loop": self.loop,
            "mirror": self.mirror,
        }

    def __repr__(self) -> str:
        return f"<GraphArc: {_vertex(self.start)} to {_vertex(self.end)}, {self.status}>"


@dataclass(frozen=True, repr=False)
class ConfigurationGraph:
    """The true configurations that can be reached from the flat state when contact is ignored.

    `nodes` are different branch points; mirror images are neighbours in the list. The ends of
    `arcs` at a branch point are the sides of the lines of the curves through it. Nothing is said
    about curves that cannot be reached. `status` is PROVED if the graph is the whole connected
    component of the flat state. This means that all rays are matched, no other curve passes through
    a branch point, and every arc is followed from end to end. Otherwise `reason` says what is
    missing; each arc and each branch point is still proved.
    """

    nodes: tuple[GraphNode, ...]
    arcs: tuple[GraphArc, ...]
    status: Verdict
    reason: str

    def to_networkx(self) -> nx.MultiGraph[int | str]:
        """The graph as a frozen networkx graph.

        Its vertices are "flat" and the numbers of the branch points. Its edges are the arcs with
        two known ends. The key of an edge is the number of the arc, and its attribute `arc` is the
        `GraphArc`.

        >>> from exactfold.motion.loops.matching import find_loops
        >>> graph = find_loops("two-vertex").graph
        >>> graph
        <ConfigurationGraph: proved, 0 branch points, 4 arcs>
        >>> graph.to_networkx().degree("flat")
        8
        """
        import networkx as nx

        graph: nx.MultiGraph[int | str] = nx.MultiGraph()
        graph.add_node(FLAT)
        graph.add_nodes_from(
            (k, {"node": branch_point}) for k, branch_point in enumerate(self.nodes)
        )
        for k, arc in enumerate(self.arcs):
            if arc.start is not None and arc.end is not None:
                graph.add_edge(_vertex(arc.start), _vertex(arc.end), key=k, arc=arc)
        return nx.freeze(graph)

    @property
    def independent_cycles(self) -> int | None:
        """The first Betti number of the connected component of the flat state; None if undecided.

        It is the number of arcs minus the number of vertices plus 1.
        """
        return len(self.arcs) - len(self.nodes) if self.status is PROVED else None

    @cached_property
    def closed_curves(self) -> tuple[tuple[int, ...], ...]:
        """The closed curves that pass branch points but not the flat state; each is a list of arcs.

        They go straight on at every branch point. A motion reaches them if it turns off at one.
        """
        after = {
            end: (k, other)
            for k, arc in enumerate(self.arcs)
            for end, other in ((arc.start, arc.end), (arc.end, arc.start))
            if end is not None
        }
        seen: set[int] = set()
        curves = []
        for k, arc in enumerate(self.arcs):
            if k in seen:
                continue
            curve, end = [k], arc.end
            while isinstance(end, EndAtBranchPoint) and end != _opposite(arc.start):
                number, end = after.get(end.opposite, (k, None))
                curve.append(number)
            seen.update(curve)
            if isinstance(end, EndAtBranchPoint):
                curves.append(tuple(curve))
        return tuple(curves)

    def to_dict(self) -> GraphDocument:
        """The object of the graph in the output of `exactfold motions --json`."""
        return {
            "status": str(self.status),
            "reason": self.reason,
            "nodes": [branch_point.to_dict() for branch_point in self.nodes],
            "arcs": [arc.to_dict() for arc in self.arcs],
            "closed_curves": [list(curve) for curve in self.closed_curves],
            "independent_cycles": self.independent_cycles,
        }

    def __repr__(self) -> str:
        return (
            f"<ConfigurationGraph: {self.status}, {len(self.nodes)} branch points, "
            f"{len(self.arcs)} arcs>"
        )


def _opposite(end: End | None) -> EndAtBranchPoint | None:
    return end.opposite if isinstance(end, EndAtBranchPoint) else None


def _vertex(end: End | None) -> int | str:
    """The vertex of the graph at an end of an arc."""
    return (
        "open" if end is None else end.branch_point if isinstance(end, EndAtBranchPoint) else FLAT
    )


def _named(end: End | None) -> FlatEnd | BranchPointEnd | None:
    if end is None:
        return None
    return end.to_dict() if isinstance(end, EndAtBranchPoint) else {"half_branch": end.to_dict()}
