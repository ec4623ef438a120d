"""The flat-folded state that a motion of panels reaches, and whether it does so without contact.

docs/motion.md, 21, proves that the order of layers is that of the heights near closing, to first
order.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from math import ceil, degrees, pi
from typing import Final, TypeAlias

import numpy as np
from flint import arb, ctx

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import LIMIT, UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.errors import NotApplicableError, NotFollowedError, TooManyModesError
from exactfold.exact.surds import ball
from exactfold.layers.certificate import MOST_PAIRS, digits_of
from exactfold.layers.document import WayEndDocument
from exactfold.layers.images import Images, images_of
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import pieces_of
from exactfold.layers.states import FlatStates, Pair, State
from exactfold.motion.claims import Claim
from exactfold.motion.curves.events import CONTACT
from exactfold.motion.panels.clearance import PanelClearance, prove_contacts
from exactfold.motion.panels.following import follow_panels
from exactfold.motion.panels.last_stretch import LastStretch
from exactfold.motion.panels.listing import PanelWay, panel_ways
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.proving import PanelProof
from exactfold.panels.result import Decomposition
from exactfold.pattern.panel_pattern import Edge

_BITS: Final = 128
_INSIDE: Final = 1 - 2.0**-8
"""Heights are compared at corners of the common part, moved inside by this share."""

Height: TypeAlias = tuple[arb, arb, arb]
"""(a, b, c): the height of a piece over a point (x, y) of the image is a x + b y + c."""


@dataclass(frozen=True)
class Reached:
    """The end of a motion of panels of which all folds close together (docs/motion.md, 21).

    `state` is the flat-folded state that the motion ends in, None if it is not known; it is correct
    if `status` is PROVED: then no two panels touch before all folds are closed. If the status is
    REFUTED, some panels touch or pass through each other before. `contacts` says which and when, as
    far as that is proved, or `crossing` has two pieces that pass through each other at the end.
    `heights` has the height of each vertex over the folded image near closing, to first order and
    up to a common factor, in floats.
    """

    status: Verdict
    reason: str
    motion: PanelMotion = field(repr=False)
    contacts: PanelClearance = field(repr=False)
    images: Images = field(repr=False)
    state: State | None = field(repr=False)
    crossing: Pair | None = None
    heights: FloatArray | None = field(default=None, repr=False, compare=False)

    def number_in(self, states: FlatStates, *, mirrored: bool = False) -> int | None:
        """The number of the state among those listed of the same sheet; None if it is not there.

        If `mirrored`, it is that of the state of the same motion to the other side of the sheet.
        """
        if self.state is None or states.images is None or states.as_written is not PROVED:
            return None
        if states.images.pieces.polygons != self.images.pieces.polygons:
            return None
        turn = -1 if mirrored else 1
        orders = [turn * self.state.orders[pair] for pair in states.pairs]
        known = zip(states.fixed, orders, strict=True)
        if any(fixed and fixed != order for fixed, order in known):
            return None
        number = 0
        for component in states.components:
            row = tuple(orders[pair] for pair in component.pairs)
            if row not in component.states:
                return None
            number = number * len(component.states) + component.states.index(row)
        return number


def reached(
    motion: PanelMotion, contacts: PanelClearance | None = None, clock: Clock = UNLIMITED
) -> Reached:
    """The flat-folded state that a motion of panels ends in, and the proof that it gets there.

    As all folds close, panels lie above each other in the order of their heights to first order:
    docs/motion.md, Theorem 11. `contacts` is what `prove_contacts` says of the motion, if that is
    known; else the proof ends with the clock.

    Raises `NotApplicableError` for a motion of which not all folds close at the same time, at its
    end.

    >>> import exactfold
    >>> end = reached(exactfold.follow("square-twist", 1, until="180deg", frames=2))
    >>> end.status, len(end.state.orders)
    (<Verdict.PROVED: 'proved'>, 36)
    """
    stretch = LastStretch(motion)
    if not stretch.applies:
        raise NotApplicableError(
            "not all folds that move are known to close together, so that nothing is known of an "
            "order of layers"
        )
    if contacts is None:
        contacts = prove_contacts(motion, clock)
    images = images_of(pieces_of(motion.pattern, motion.assignment))
    if images.torn:
        raise ArithmeticError("a motion that closes all its folds has no folded image")
    pairs = [(int(i), int(j)) for i, j in Overlaps(images).pairs]
    with ctx.workprec(_BITS):
        heights = _Heights(images, stretch)
        signs = {pair: heights.signs(*pair) for pair in pairs}
    crossing = next((pair for pair, found in signs.items() if len(found) == 2), None)
    state = None
    if all(len(found) == 1 for found in signs.values()):
        state = State(images, {pair: -next(iter(found)) for pair, found in signs.items()})
    status, reason = _judged(contacts, crossing, images, state)
    return Reached(status, reason, motion, contacts, images, state, crossing, heights.of_vertices())


def with_layers(proof: PanelProof) -> PanelProof:
    """A proof whose certificate also states the flat-folded state that the motion ends in.

    It is the same proof if no state is proved, or if more than 65,536 pairs of pieces overlap.

    >>> import exactfold
    >>> from exactfold.motion import prove_panels
    >>> proof = prove_panels(exactfold.follow("square-twist", 1, until="180deg", frames=2))
    >>> with_layers(proof).certificate()["claims"]["layers"]["order"]
    'dd0027d21'
    """
    contacts = proof.contacts
    if not proof.certified or contacts is None or contacts.closes_from is None:
        return proof
    end = reached(proof.motion, contacts)
    if end.status is not PROVED or end.state is None or len(end.state.orders) > MOST_PAIRS:
        return proof
    orders = sorted(end.state.orders.items())
    layers = {
        "pieces": [list(polygon) for polygon in end.images.pieces.polygons],
        "order": digits_of([above > 0 for _, above in orders]),
    }
    return replace(proof, layers=Claim({"layers": layers}))


@dataclass(frozen=True)
class WayEnd:
    """Where one way of a sheet of rigid panels ends, and what is proved of it.

    `way` is its number in the list of `exactfold count`, and `letters` are those of its folds, F
    where they stay flat. `status` is PROVED if the way folds rigidly from the flat sheet to a
    flat-folded state, without contact. It is REFUTED if panels touch before; `reason` says which.
    `state` is the number of the state among those asked about, and `mirrored` that of the state
    that the way reaches to the other side of the sheet. They are None for a state that is not one
    of those: it may have other letters.
    """

    way: int
    letters: Mapping[Edge, str] = field(repr=False, hash=False)
    status: Verdict
    reason: str
    state: int | None = None
    mirrored: int | None = None
    reached: Reached | None = field(default=None, repr=False, hash=False)

    def to_dict(self) -> WayEndDocument:
        """The object for the way in the output of `exactfold flat --ways --json`."""
        clear = None if self.reached is None else self.reached.contacts.clear
        return {
            "way": self.way,
            "letters": {f"{i}-{j}": letter for (i, j), letter in self.letters.items()},
            "status": str(self.status),
            "reason": self.reason,
            "state": self.state,
            "mirrored": self.mirrored,
            "clear": clear,
        }


def way_ends(
    answer: Decomposition,
    states: FlatStates,
    *,
    limit: float | None = LIMIT,
    progress: Progress | None = None,
) -> tuple[WayEnd, ...]:
    """Where each listed way ends along which a sheet of rigid panels provably folds.

    Several modes, and the folds from boundary to boundary where there is no mode, fold by equal
    angles of their drivers. Ways in spaces of motions are left out, as none of their motions is
    named. After `limit` seconds the ways that are left are UNDECIDED. If the answer on `states` is
    in doubt, all are.

    >>> import exactfold
    >>> vertex = "single-vertex-4"
    >>> ends = way_ends(exactfold.decompose(vertex), exactfold.flat(vertex, "any"))
    >>> [end.state for end in ends if end.status is PROVED]
    [0, 1]
    """
    clock = Clock(limit)
    ways = [way for way in panel_ways(answer.known) if way.verdict is PROVED and not way.spaces]
    ends = []
    for k, way in enumerate(ways):
        if progress is not None:
            progress("ways", k, len(ways))
        ends.append(way_end(answer, way, states, clock))
    return tuple(ends)


def way_end(answer: Decomposition, way: PanelWay, states: FlatStates, clock: Clock) -> WayEnd:
    """Where one way ends, one of those of `way_ends`; UNDECIDED if the clock passes before."""
    folds = answer.known.pattern.folds
    letters = {fold: way.letters.get(fold, "F") for fold in folds}
    if states.doubt:
        return WayEnd(way.number, letters, UNDECIDED, states.doubt)
    try:
        clock.check()
        motion = follow_panels(answer, way=way.number, until="180deg", frames=2)
        letters = dict(motion.assignment)
        end = reached(motion, clock=clock)
    except (NotApplicableError, NotFollowedError, TooManyModesError) as error:
        return WayEnd(way.number, letters, UNDECIDED, str(error))
    if end.status is not PROVED:
        return WayEnd(way.number, letters, end.status, end.reason, reached=end)
    state, mirrored = (end.number_in(states, mirrored=turned) for turned in (False, True))
    return WayEnd(way.number, letters, PROVED, "", state, mirrored, end)


def _judged(
    contacts: PanelClearance, crossing: Pair | None, images: Images, state: State | None
) -> tuple[Verdict, str]:
    event = contacts.event
    if event is not None and event.kind == CONTACT:
        names = " and ".join("-".join(map(str, face)) for face in event.faces)
        by = ceil(degrees(event.time[1]) * 100) / 100
        return REFUTED, f"panels {names} run into each other by {by:g} degrees of the driving folds"
    if crossing is not None:
        faces = images.pieces.sheet.faces
        names = " and ".join(
            "-".join(map(str, faces[images.pieces.panels[piece][0]])) for piece in crossing
        )
        return REFUTED, f"panels {names} pass through each other before the folds close"
    if contacts.status is not PROVED or contacts.clear < pi:
        why = "some panels are not proved to stay apart until all folds are closed"
        return UNDECIDED, contacts.reason or why
    if state is None:
        return UNDECIDED, "some panels have the same height to first order"
    return PROVED, ""


class _Heights:
    """The heights of all pieces over the folded image, near closing and to first order.

    Piece 0 has the height 0. Across a crease, the height changes by 2 / |g| times the distance from
    its image, where tan(angle / 2) = g / s and s tends to 0.
    """

    def __init__(self, images: Images, stretch: LastStretch) -> None:
        self.images = images
        pieces, maps = images.pieces, images.maps
        points = {v: [ball(c, _BITS) for c in point] for v, point in images.points.items()}
        self.corners = [[points[v] for v in polygon] for polygon in pieces.polygons]
        self.turned = [-1 if place.flipped else 1 for place in maps]
        around: list[list[tuple[int, Edge, int]]] = [[] for _ in maps]
        for (i, j), (left, right) in pieces.creases.items():
            around[right].append((left, (i, j), 1))
            around[left].append((right, (i, j), -1))
        for left, right in pieces.joints.values():
            around[right].append((left, (0, 0), 0))
            around[left].append((right, (0, 0), 0))
        known: dict[int, Height] = {0: (arb(0), arb(0), arb(0))}
        waiting = [0]
        for piece in waiting:
            for other, (i, j), side in around[piece]:
                if other in known:
                    continue
                known[other] = known[piece]
                if side:
                    (px, py), (qx, qy) = points[i], points[j]
                    dx, dy = qx - px, qy - py
                    length = (dx * dx + dy * dy).sqrt()
                    steep = -2 * side / (stretch.gains[i, j] * length)
                    # The height over (x, y) grows by steep (d x (p - P)).
                    a, b, c = known[piece]
                    across = dx * py - dy * px
                    known[other] = a - steep * dy, b + steep * dx, c - steep * across
                waiting.append(other)
        self.heights = [known[piece] for piece in range(len(maps))]
        self.floats = [
            np.array([[float(c.mid()) for c in point] for point in polygon])
            for polygon in self.corners
        ]

    def of_vertices(self) -> FloatArray:
        """The height over each vertex of the sheet, in its unit, rounded to floats."""
        sheet, scale = self.images.pieces.sheet, float(self.images.scale)
        found = np.zeros(len(sheet.vertices))
        for panel, face in enumerate(sheet.faces):
            a, b, c = (float(x.mid()) for x in self.heights[self.images.pieces.of_panel[panel][0]])
            for v in face:
                x, y = self.images.places[v]
                found[v] = a * x + b * y + c / scale
        return found

    def signs(self, one: int, two: int) -> dict[int, tuple[Fraction, Fraction]]:
        """The proved signs of the height of one piece minus that of another, where both lie.

        Each sign, 1 or -1, comes with a point at which it is proved.
        """
        ours = self.floats[one][:: self.turned[one]]
        theirs = self.floats[two][:: self.turned[two]]
        common = _clipped(ours, theirs)
        if not len(common):
            return {}
        a, b, c = (p - q for p, q in zip(self.heights[one], self.heights[two], strict=True))
        middle = common.mean(axis=0)
        inner = np.vstack([middle, middle + _INSIDE * (common - middle)])
        values = inner @ [float(a.mid()), float(b.mid())] + float(c.mid())
        found: dict[int, tuple[Fraction, Fraction]] = {}
        for k in {int(values.argmax()), int(values.argmin())}:
            x, y = inner[k].tolist()
            height = a * arb(x) + b * arb(y) + c
            sign = int(bool(height > 0)) - int(bool(height < 0))
            if sign and self._inside(one, x, y) and self._inside(two, x, y):
                found[sign] = Fraction(x), Fraction(y)
        return found

    def _inside(self, piece: int, x: float, y: float) -> bool:
        """Whether a point is proved to lie inside the image of a piece."""
        corners = self.corners[piece]
        for (ax, ay), (bx, by) in pairwise([*corners, corners[0]]):
            turn = (bx - ax) * (arb(y) - ay) - (by - ay) * (arb(x) - ax)
            if not turn * self.turned[piece] > 0:
                return False
        return True


def _clipped(polygon: FloatArray, other: FloatArray) -> FloatArray:
    """The common part of two convex polygons, counter-clockwise, in floats (Sutherland-Hodgman)."""
    for a, b in pairwise([*other, other[0]]):
        side = (b[0] - a[0]) * (polygon[:, 1] - a[1]) - (b[1] - a[1]) * (polygon[:, 0] - a[0])
        kept = []
        for k, here in enumerate(side):
            before = side[k - 1]
            if here * before < 0:
                share = before / (before - here)
                kept.append(polygon[k - 1] + share * (polygon[k] - polygon[k - 1]))
            if here >= 0:
                kept.append(polygon[k])
        polygon = np.array(kept).reshape(-1, 2)
        if not len(polygon):
            break
    return polygon
