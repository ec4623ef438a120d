"""The first contact of a motion of panels, with proved bounds of its time."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import floor, inf, nextafter, pi

import numpy as np
from flint import arb, ctx

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.errors import NotApplicableError
from exactfold.exact.surds import ball
from exactfold.motion.contacts.face_pairs import AnyPairs, Open
from exactfold.motion.contacts.separation import (
    Swept,
    Test,
    clear_until,
    not_separated,
    through,
)
from exactfold.motion.curves.events import CONTACT, FLAT_FOLD, Event
from exactfold.motion.panels.contacts import PanelContacts
from exactfold.motion.panels.curves import LinearCurve
from exactfold.motion.panels.last_stretch import LastStretch
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.pieces import PanelPieces
from exactfold.motion.panels.thick import ThickContacts
from exactfold.panels.vertex.stars import dot

Panel = tuple[int, ...]

_BITS = 128
_FINEST = 2.0**-24
_STEPS = 40
_PARTS = 8
"""Pieces begin at such a part of a radian, so that no sum of their times is rounded."""
_FIRST = 1e-12
"""The search for a crossing begins this long, in radians, after the contact found in floats."""
_NARROW = 1e-3
"""A first contact counts as enclosed if its time is known to within this, in radians."""


@dataclass(frozen=True, repr=False)
class PanelClearance:
    """What is proved of the contacts of a motion of panels, without thickness or of its plates.

    From time 0 until before `clear`, no two panels touch except in the folds and corners they
    share. `event` is a contact, or folds that close, that is proved to happen in `event.time` =
    (not before, at the latest). It is None if the motion ends earlier or nothing is proved to
    touch. The first contact of all lies between these times, too. It is not proved that the same
    panels meet in it; other panels may touch shortly before. `open_panels` are pairs that are not
    proved to stay apart right after `clear`.

    `closes_from` is a time from which on planes part the panels until all folds close together at
    time pi (docs/motion.md, 21); None if this is not proved.

    `status` is PROVED if the whole motion is clear, or if the time of its first contact is known to
    within a thousandth of a radian. Otherwise `reason` says what is missing.
    """

    status: Verdict
    clear: float
    event: Event | None
    open_panels: tuple[tuple[Panel, Panel], ...]
    reason: str
    closes_from: float | None = None

    def __repr__(self) -> str:
        what = "" if self.event is None else f", {self.event.kind} by {self.event.time[1]:.6g}"
        return f"<PanelClearance: {self.status}, clear until {self.clear:.6g}{what}>"


def prove_contacts(motion: PanelMotion, clock: Clock = UNLIMITED) -> PanelClearance:
    """The first contact of a motion of panels, proved (docs/motion.md, 20 and 21).

    The positions of all vertices are enclosed over intervals of time, computed from the exact
    motion. Planes are found that separate all panels (docs/motion.md, Theorem 7). Panels touch
    where an edge runs through a panel, or at time pi, where all folds close. When the clock has
    passed, the rest of the motion is UNDECIDED.

    Raises `NotApplicableError` for a motion that is not proved to exist (`motion.exists`), and for
    a sheet whose positions are known only nearly.

    >>> from exactfold.motion.panels.following import follow_panels
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> motion = follow_panels(panels(single_vertex(4)), until="90deg", frames=3)
    >>> clearance = prove_contacts(motion)
    >>> clearance.status, clearance.event, clearance.clear >= motion.duration
    (<Verdict.PROVED: 'proved'>, None, True)
    """
    if motion.exists is not PROVED:
        raise NotApplicableError(
            "nothing is proved of contacts, because the motion is not proved to exist"
        )
    motion.pattern.check_positions()
    if motion.solid is not None:
        thick = ThickContacts(motion, motion.solid)

        def overlap(time: float) -> Event | None:
            crossed = thick.crossed(time)
            return None if crossed is None else crossed[0]

        return _enclosed(
            motion, thick.pieces, thick.phases(), thick.left, thick.named, overlap, inf, clock
        )
    contacts = PanelContacts(motion.pattern)
    pieces = PanelPieces(motion)
    pairs = PanelPairs(contacts, pieces.unit)
    stretch = LastStretch(motion)
    end, _ = stretch.clear_from(pairs) if stretch.applies else (inf, None)

    def run_through(time: float) -> Event | None:
        panels = _crossed(contacts, pieces, time)
        if panels is None:
            return None
        faces = tuple(contacts.pattern.faces[panel] for panel in panels)
        return Event(CONTACT, (time, time), faces=faces, detail="an edge runs through a face")

    every = [(inf, Open.all_of(pairs))]
    left = partial(not_separated, pairs)
    return _enclosed(motion, pieces, every, left, pairs.named, run_through, end, clock)


def _enclosed(
    motion: PanelMotion,
    pieces: PanelPieces,
    phases: Sequence[tuple[float, Open]],
    test: Test,
    named: Callable[[Open], tuple[tuple[Panel, Panel], ...]],
    touching: Callable[[float], Event | None],
    end: float,
    clock: Clock,
) -> PanelClearance:
    """The first contact, from a test that bodies stay apart and one that some touch at a time.

    `phases` are times until which these pairs are tested, the last of them infinite. `end` is the
    time from which on they are known to stay apart until all folds close.
    """
    clear, left = 0.0, Open.none()
    for until, asked in phases:
        until = min(end, motion.duration, until)
        for piece in pieces.between(floor(clear * _PARTS) / _PARTS, until):
            first = max(-piece.half, nextafter(clear - piece.middle, -inf))
            if first >= piece.half:
                continue
            last = min(piece.half, nextafter(until - piece.middle, inf))
            at, left = clear_until(
                test, piece.coefficients, piece.radius, first, last, among=asked, finest=_FINEST
            )
            clear = nextafter(piece.middle + at, 0.0)  # this covers the rounding of the sum
            if left or clock.passed:
                break
        if left or clock.passed or clear < nextafter(until, 0.0):
            break
    if clock.passed and not left:
        return PanelClearance(UNDECIDED, clear, None, (), clock.said)
    if not left:
        if clear >= nextafter(end, 0.0):
            return PanelClearance(PROVED, motion.duration, _closing(motion, pi), (), "", end)
        if clear >= nextafter(motion.duration, 0.0):
            return PanelClearance(PROVED, motion.duration, _closing(motion, clear), (), "")
    event = _crossing(motion, touching, clear) or _closing(motion, clear)
    if event is None:
        reason = "some panels are proved neither to stay apart nor to touch"
        return PanelClearance(UNDECIDED, clear, None, named(left), reason)
    low, high = event.time
    if high - low > _NARROW:
        reason = "some panels are not proved to stay apart long before others are proved to touch"
        return PanelClearance(UNDECIDED, clear, event, named(left), reason)
    return PanelClearance(PROVED, clear, event, (), "")


def with_proved_contact(motion: PanelMotion) -> tuple[PanelMotion, PanelClearance]:
    """The motion in which the proved first contact replaces the one found in floats.

    Raises the errors of `prove_contacts`. An event that is not proved stays as it is.
    """
    clearance = prove_contacts(motion)
    event = clearance.event
    if clearance.status is not PROVED or event is None:
        return motion, clearance
    kept = [e for e in motion.events if e.kind != event.kind]
    if event.kind == FLAT_FOLD:  # name the folds that close in floats
        folds = next((e.folds for e in motion.events if e.kind == FLAT_FOLD), event.folds)
        event = replace(event, folds=folds)
    events = tuple(sorted((event, *kept), key=lambda e: e.time))
    return replace(motion, events=events), clearance


@dataclass(frozen=True, repr=False)
class PanelPairs(AnyPairs):
    """Pairs of triangles of different panels, in units of `unit`; cuts inside panels are
    no folds.
    """

    contacts: PanelContacts
    unit: float

    @cached_property
    def triangles(self) -> IndexArray:
        """The triangles into which the panels are cut."""
        return np.array(self.contacts.cut.faces, dtype=np.intp)

    @cached_property
    def hinges(self) -> IndexArray:
        """The folds of the panels, with the opposite corners of the triangles on both sides."""
        cut, rows = self.contacts.cut, []
        for i, j in self.contacts.pattern.folds:
            sides = (cut.faces[cut.sides[i, j]], cut.faces[cut.sides[j, i]])
            left, right = (next(v for v in face if v not in (i, j)) for face in sides)
            rows.append([i, j, left, right])
        return np.array(rows, dtype=np.intp).reshape(-1, 4)

    @cached_property
    def closed(self) -> FloatArray:
        """Upper bounds of the squared distance of the opposite corners of each fold when closed.

        Arb computes them.
        """
        points = self.contacts.pattern.vertices
        squared_distances = []
        for i, j, left, right in self.hinges.tolist():
            (ix, iy), (jx, jy), (lx, ly), (rx, ry) = (points[v] for v in (i, j, left, right))
            e = (jx - ix, jy - iy)
            along = (lx - rx) * e[0] + (ly - ry) * e[1]
            across = e[0] * (ly - iy) - e[1] * (lx - ix) + e[0] * (ry - iy) - e[1] * (rx - ix)
            with ctx.workprec(_BITS):
                square = ball(dot(e, e), _BITS) * arb(self.unit) ** 2
                value = (ball(along, _BITS) ** 2 + ball(across, _BITS) ** 2) / square
                squared_distances.append(float(value.upper()) * (1 + 1e-12))
        return np.array(squared_distances)

    def one_body(self, i: int, j: int) -> bool:
        """Whether two triangles belong to one panel."""
        return self.contacts.panel_of[i] == self.contacts.panel_of[j]

    def named(self, left: Open) -> tuple[tuple[Panel, Panel], ...]:
        """The pairs of panels among the pairs that are left, each once."""
        rows = [self.apart[left.apart], self.corner[left.corner]]
        pairs = {self._panels(i, j) for row in rows for i, j in row.tolist()}
        sides = self.contacts.cut.sides
        for i, j, _, _ in self.hinges[left.folds].tolist():
            pairs.add(self._panels(sides[i, j], sides[j, i]))
        return tuple(sorted(pairs))

    def _panels(self, i: int, j: int) -> tuple[Panel, Panel]:
        faces, panel = self.contacts.pattern.faces, self.contacts.panel_of
        a, b = sorted((faces[panel[i]], faces[panel[j]]))
        return a, b

    def __repr__(self) -> str:
        return f"<PanelPairs: {len(self.contacts.pattern.faces)} panels>"


def _crossing(
    motion: PanelMotion, touching: Callable[[float], Event | None], clear: float
) -> Event | None:
    """A contact that is proved to happen shortly after `clear`; None if none is found."""
    known = [event.time[1] for event in motion.events if event.kind == CONTACT]
    if not known:
        return None
    begin, most = known[0], pi
    step = _FIRST
    while begin + step < most:
        event = touching(begin + step)
        if event is not None:
            good, bad = begin + step, begin + step / 2 if step > _FIRST else begin
            break
        step *= 2
    else:
        return None
    for _ in range(_STEPS):
        middle = 0.5 * (good + bad)
        if not bad < middle < good:
            break
        other = touching(middle)
        event, good, bad = (event, good, middle) if other is None else (other, middle, bad)
    return replace(event, time=(clear, good))


def _crossed(contacts: PanelContacts, pieces: PanelPieces, time: float) -> tuple[int, int] | None:
    """Two panels, where an edge of one is proved to run through the other at a time; or None."""
    piece = pieces.around(time)
    if piece is None:
        return None
    point = Swept.of(piece.coefficients, piece.radius, 0.0, 0.0)
    # The search for crossings works on a sheet of size one.
    scale = piece.unit / contacts.unit
    crossings = contacts.crossings
    for crossing in map(crossings.named, crossings.pairs(point.start * scale)):
        if through(point, crossing.edge, crossing.face):
            return contacts.who(crossing)
    return None


def _closing(motion: PanelMotion, clear: float) -> Event | None:
    """The event that folds close at time pi, exactly, or None if the motion ends earlier.

    It names all folds of linear modes with rate 1, and all free folds with rate 1. In other modes
    some fold has closed by then, but it is not named.
    """
    if motion.duration < pi:
        return None
    folds: list[Iterable[tuple[int, int]]] = [
        curve.folds
        for curve, rate in zip(motion.curves, motion.rates, strict=True)
        if abs(rate) == 1.0 and isinstance(curve, LinearCurve)
    ]
    folds += [[fold] for fold, rate in motion.free_rates.items() if abs(rate) == 1.0]
    closed = tuple(sorted(fold for some in folds for fold in some))
    return Event(FLAT_FOLD, (clear, nextafter(pi, inf)), folds=closed)
