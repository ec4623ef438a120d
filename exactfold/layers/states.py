"""All flat-folded states of a sheet, or why there is none."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import prod
from typing import Literal, TypeAlias

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.errors import UsageError
from exactfold.exact.surds import Number, exact, sign
from exactfold.layers.constraints import Constraint
from exactfold.layers.document import ConflictDocument, FailureDocument, FlatDocument
from exactfold.layers.images import Images
from exactfold.layers.vertices import Failure
from exactfold.pattern.described import described_panels
from exactfold.pattern.meant import Meant
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

Pair: TypeAlias = tuple[int, int]
Used: TypeAlias = Literal["drawn", "any", "given"]


@dataclass(frozen=True)
class Component:
    """Overlapping pairs whose orders depend on each other, and on no other pair.

    `pairs` are indices of `FlatStates.pairs`. `count` is the number of ways to order them, None if
    it is not known; there are at least `least`. `states` has the first of these ways: 1 for each
    pair whose second piece lies above the first, else -1.
    """

    pairs: tuple[int, ...] = field(repr=False)
    count: int | None
    states: tuple[tuple[int, ...], ...] = field(repr=False)
    least: int = 0


@dataclass(frozen=True)
class Conflict:
    """A condition of a set that no order of layers satisfies, with a point where it holds.

    `point` lies in the folded image, in the coordinates of the sheet, where panel 0 keeps its
    place.
    """

    constraint: Constraint
    point: Point


@dataclass(frozen=True)
class Near:
    """A corner and a line of the folded image that nearly meet: their distance by the size.

    The size is the larger side of the rectangle round the sheet.

    `states` is the number of states if everything that is as near is taken to meet, computed in
    floats; None if it is not known.
    """

    distance: float
    vertex: int
    edge: Edge
    states: int | None = None

    @property
    def text(self) -> str:
        """The near miss in words."""
        by = f"{self.distance:.1g}" if self.distance else "less than 1e-300"
        return (
            f"in the folded image vertex {self.vertex} misses the line of edge {self.edge[0]}-"
            f"{self.edge[1]} by {by} of the size"
        )


@dataclass(frozen=True)
class State:
    """One flat-folded state: for each overlapping pair of pieces, which one lies above.

    `orders[i, j]`, i < j, is 1 if piece j lies above piece i, and -1 if below. "Above" is towards
    the viewer who sees the top side of panel 0.
    """

    images: Images = field(repr=False)
    orders: Mapping[Pair, int] = field(repr=False)

    def above(self, piece: int, other: int) -> bool:
        """Whether a piece lies above another one; raises `KeyError` if they do not overlap."""
        if piece > other:
            return self.orders[other, piece] > 0
        return self.orders[piece, other] < 0

    @cached_property
    def letters(self) -> Mapping[Edge, str]:
        """The letter of each fold in this state: M or V if it is folded, else F."""
        known = dict.fromkeys(self.images.pieces.sheet.folds, "F")
        for crease, (left, right) in self.images.pieces.creases.items():
            on_top = self.above(right, left) != self.images.maps[left].flipped
            known[crease] = "V" if on_top else "M"
        return known

    def stack(self, point: Sequence[Number]) -> tuple[int, ...]:
        """The pieces at a point of the folded image, from top to bottom.

        The point is in the coordinates of the sheet; pieces that have it on their border are left
        out.
        """
        scale = self.images.scale
        place = [exact(c) * exact(scale) for c in point]
        here = [k for k in range(len(self.images.maps)) if _inside(self.images, k, place)]
        return tuple(sorted(here, key=lambda k: sum(self.above(j, k) for j in here if j != k)))


@dataclass(frozen=True, repr=False)
class FlatStates:
    """What is known of the flat-folded states of a sheet (docs/flat.md).

    `status` is PROVED if there is a state, and REFUTED if there is none. `letters` has M, V, U
    (folded, either way) or F (not folded) for every fold, and `letters_used` says whose they are:
    "drawn" in the file, "any" or "given". `failures` are the vertices that do not fold flat by
    themselves. Otherwise `images` has the exact folded image of each convex piece of the paper, and
    `pairs` the pieces (i, j), i < j, that overlap there. `fixed` has 1 or -1 for a pair that all
    states order alike (1: j above i), else 0. Each state takes one way of each of `components`.

    If there is no state, `conflict` is the smallest set found of conditions that contradict each
    other. `stopped` says why not everything is known. `doubt` says why the answer is one about the
    digits of the drawing only; then the status is UNDECIDED, and `as_written` is that answer.
    With `cuts`, it is an answer about the sheet whose cuts are opened.
    """

    pattern: PanelPattern
    letters: Mapping[Edge, str]
    letters_used: Used
    failures: tuple[Failure, ...] = ()
    images: Images | None = field(default=None, hash=False)
    pairs: tuple[Pair, ...] = ()
    fixed: tuple[int, ...] = ()
    components: tuple[Component, ...] = ()
    conflict: tuple[Conflict, ...] = ()
    stopped: str = ""
    doubt: str = ""
    near: Near | None = None
    meant: Meant | None = None
    cuts: bool = False
    seconds: float = field(default=0.0, compare=False)

    @property
    def as_written(self) -> Verdict:
        """The answer for exactly the coordinates of `pattern`."""
        if self.failures or self.conflict:
            return REFUTED
        if self.images is None or any(not component.states for component in self.components):
            return UNDECIDED
        return PROVED if self.fixed or not self.pairs else UNDECIDED

    @property
    def status(self) -> Verdict:
        """PROVED if there is a state, REFUTED if there is none, else UNDECIDED."""
        return UNDECIDED if self.doubt else self.as_written

    @property
    def locally_flat(self) -> Verdict:
        """Whether each vertex satisfies the conditions of Kawasaki and Maekawa."""
        if self.doubt and self.meant is not None and self.meant.doubt:
            return UNDECIDED
        return REFUTED if self.failures else PROVED

    @property
    def count(self) -> int | None:
        """The number of states; None if it is not known. It is one for the digits in doubt."""
        if self.as_written is REFUTED:
            return 0
        counts = [component.count for component in self.components]
        if self.as_written is UNDECIDED or None in counts:
            return None
        return prod(count for count in counts if count is not None)

    @property
    def at_least(self) -> int:
        """A lower bound of the number of states, which is `count` if this is known."""
        if self.as_written is not PROVED:
            return 0
        return prod(component.least for component in self.components)

    @property
    def listed(self) -> int:
        """The number of states that `state` makes."""
        if self.as_written is not PROVED:
            return 0
        return prod(len(component.states) for component in self.components)

    def state(self, number: int = 0) -> State:
        """A state by its number, from 0 to `listed` - 1: the last component changes fastest.

        Raises `UsageError` if there is no such state, or if it is not listed.
        """
        if self.images is None or not 0 <= number < self.listed:
            raise UsageError(f"there is no state {number}: {self.listed} are listed, from 0")
        orders = list(self.fixed)
        for component in reversed(self.components):
            number, which = divmod(number, len(component.states))
            for pair, value in zip(component.pairs, component.states[which], strict=True):
                orders[pair] = value
        return State(self.images, dict(zip(self.pairs, orders, strict=True)))

    def __iter__(self) -> Iterator[State]:
        """The listed states, in order of their numbers."""
        return (self.state(number) for number in range(self.listed))

    @cached_property
    def overlaps(self) -> int:
        """The number of pairs of pieces that overlap."""
        return len(self.pairs)

    @property
    def reason(self) -> str:
        """Why there is no state, or why that is not known; empty if there is one."""
        if self.doubt:
            known = f"{self.as_written}{': ' if self.why else ''}{self.why}"
            return f"{self.doubt}; the coordinates as they were read: {known}"
        return self.why

    @property
    def why(self) -> str:
        """The reason for exactly the coordinates of `pattern`."""
        if self.failures:
            more = len(self.failures) - 1
            rest = f", and at {counted(more, 'more vertex')} a condition fails" if more else ""
            return self.failures[0].text + rest
        if self.conflict:
            panels = sorted({p for one in self.conflict for p in self.panels_of(one.constraint)})
            return (
                f"panels {_listed(panels)} cross whatever the order of layers: "
                f"{counted(len(self.conflict), 'condition')} contradict each other"
            )
        return self.stopped

    def panels_of(self, constraint: Constraint) -> tuple[int, ...]:
        """A panel of each piece of a constraint."""
        if self.images is None:
            return ()
        return tuple(self.images.pieces.panels[piece][0] for piece in constraint.pieces)

    def to_dict(self, name: str | None = None) -> FlatDocument:
        """The object that `exactfold flat --json` prints: `schema("flat")`."""
        return _document(self, name)

    def __repr__(self) -> str:
        number = "" if self.count is None else f", {counted(self.count, 'state')}"
        return f"<FlatStates: {self.status}{number}, {self.pattern!r}>"


def _listed(numbers: Sequence[int], most: int = 12) -> str:
    if len(numbers) > most:
        return f"{', '.join(map(str, numbers[:most]))} and {len(numbers) - most} more"
    return f"{', '.join(map(str, numbers[:-1]))} and {numbers[-1]}"


def _inside(images: Images, piece: int, point: Sequence[Number]) -> bool:
    corners = [images.points[v] for v in images.pieces.polygons[piece]]
    side = -1 if images.maps[piece].flipped else 1
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        turn = (bx - ax) * (point[1] - ay) - (by - ay) * (point[0] - ax)
        if sign(turn) * side <= 0:
            return False
    return True


def _document(found: FlatStates, name: str | None) -> FlatDocument:
    doubted = bool(found.doubt)
    near = found.near
    return {
        "format": "exactfold flat result",
        "version": 1,
        "pattern": described_panels(found.pattern, name),
        "status": str(found.status),
        "locally_flat": str(found.locally_flat),
        "states": None if doubted else found.count,
        "at_least": 0 if doubted else found.at_least,
        "components": [] if doubted else [one.count for one in found.components],
        "letters": {_name(fold): letter for fold, letter in found.letters.items()},
        "letters_used": found.letters_used,
        "pieces": 0 if found.images is None else len(found.images.maps),
        "overlaps": len(found.pairs),
        "vertices": [_failure(one) for one in found.failures],
        "conflict": [_conflict(found, one) for one in found.conflict],
        "reason": found.reason,
        "near": None
        if near is None
        else {
            "distance": near.distance,
            "vertex": near.vertex,
            "edge": _name(near.edge),
            "states": near.states,
        },
        "meant": None if found.meant is None else found.meant.to_dict(),
        "cuts_opened": found.cuts,
        "as_written": {
            "status": str(found.as_written),
            "states": found.count,
            "reason": found.why,
        }
        if doubted
        else None,
        "ways": None,
        "seconds": round(found.seconds, 3),
    }


def _failure(one: Failure) -> FailureDocument:
    return {
        "vertex": one.vertex,
        "condition": one.condition,
        "off": one.off,
        "excess": one.excess,
    }


def _conflict(found: FlatStates, one: Conflict) -> ConflictDocument:
    return {
        "kind": one.constraint.kind,
        "edges": [_name(edge) for edge in one.constraint.edges],
        "panels": list(found.panels_of(one.constraint)),
        "point": [str(c) for c in one.point],
    }


def _name(fold: tuple[int, int]) -> str:
    return f"{fold[0]}-{fold[1]}"
