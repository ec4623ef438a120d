"""The first contact of two faces along a track.

It is proved that no two faces touch before a time, and that some touch by a later time.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.motion.contacts.face_pairs import FacePairs, Open
from exactfold.motion.contacts.separation import Swept, bends, clear_until, through
from exactfold.motion.contacts.stretches import on_branch_point_tube
from exactfold.motion.curves.crossings import Crossing, Crossings
from exactfold.motion.curves.events import CONTACT, FLAT_FOLD, Event
from exactfold.motion.tubes.arclength import in_floats
from exactfold.motion.tubes.chain import Step
from exactfold.motion.tubes.contraction import SCALE, WEIGHT_BITS
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.piece import PARAMETER_BITS, Piece
from exactfold.motion.tubes.tracks import Track, follow_proved
from exactfold.motion.tubes.tube_start import ROOT_BITS, StartTube
from exactfold.pattern.crease_pattern import Triangle

_FINEST = 2.0**-22
_STEPS = 20
_ROOM, _MORE = 4.0, 1e-10
"""Tubes are widened by this factor and this length, so that a checker with its own
weights agrees.
"""
_FIRST = "the first contact"
_NEITHER = "some faces are proved neither to stay apart nor to touch"
_AFTER = 1 << 14
"""Over 2^PARAMETER_BITS: the search for a contact begins this much after the entry of its tube."""


@dataclass(frozen=True, repr=False)
class FirstContact:
    """What is proved of the first contact of a motion, ignoring thickness.

    Before the time `clear`, in the unit of the sheet, no two faces touch except in the folds and
    corners they share. `event` is a contact or a closed fold that is proved to happen, with
    `event.time` = (not before, at the latest). It is the first one if its lower bound is `clear`.
    It is None if the track ended earlier or nothing was proved to touch; then `open_faces` are the
    pairs that are not proved to stay apart after `clear`. `status` is PROVED if the first contact
    is enclosed.

    `parameters` are on the last step of the track, over 2^PARAMETER_BITS: the end of the clear
    part, and two parameters between which the contact is proved. The last two are equal if an edge
    runs through a face. `parameters` is None if nothing is proved to be clear. If the last step is
    an arc through a branch point and `before_the_arc` is true, they are on the tube before the arc.
    """

    status: Verdict
    clear: Fraction
    event: Event | None
    open_faces: tuple[tuple[Triangle, Triangle], ...]
    reason: str
    parameters: tuple[int, int, int] | None = None
    before_the_arc: bool = False

    @property
    def clear_to_the_end(self) -> bool:
        """Whether no two faces touch on the whole track, including its last configuration."""
        return self.event is None and not self.open_faces

    def __repr__(self) -> str:
        what = "" if self.event is None else f", {self.event.kind} by {self.event.time[1]:.6g}"
        return f"<FirstContact: {self.status}, clear until {float(self.clear):.6g}{what}>"


def first_contact(branch: Branch, side: int = 1, *, most: int = 1000) -> tuple[Track, FirstContact]:
    """Follow a branch, with proof, to its first contact, and enclose the time of the contact.

    Raises the errors of `follow_proved`. If the contact is UNDECIDED, it is still proved that
    nothing touches before `clear`.

    >>> from exactfold.branches.counting.find import find_branch
    >>> track, contact = first_contact(find_branch("two-vertex", "+-"))
    >>> print(contact.status, contact.event.kind, contact.event.faces)
    proved flat-fold ((3, 5, 2), (3, 4, 5))
    """
    watch = ContactWatch()
    track = follow_proved(branch, side, stop=watch, most=most)
    return track, watch.result(track)


@dataclass
class ContactWatch:
    """Looks for the first contact on each step of a track in turn.

    Times are in the unit of the framework.
    """

    clear: Fraction = Fraction(0)
    touching: _Touching | None = None
    open_pairs: Open | None = None
    parameters: tuple[int, int, int] | None = None
    before_the_arc: bool = False
    _pairs: FacePairs | None = field(default=None, repr=False)

    def __call__(self, step: Step) -> str | None:
        """Return why the track may end, or None to go on.

        The reason is a contact, or pairs of faces that are not separated.
        """
        pairs = self._pairs = self._pairs or FacePairs(step.tube.framework)
        if isinstance(step, Passage):
            return self._at_a_branch_point(step, pairs)
        return self._on_a_tube(step, pairs)

    def _on_a_tube(self, link: Link, pairs: FacePairs) -> str | None:
        coefficients, radius = positions_of(link.tube)
        radius = _ROOM * radius + _MORE
        low, high, longest = (
            x / (1 << PARAMETER_BITS) for x in (link.entry[0], link.exit, link.tube.longest)
        )
        at, left = clear_until(pairs, coefficients, radius, low, high, finest=_FINEST)
        if not left:
            self.clear = link.left[0]
            self.parameters = link.exit, link.exit, link.exit
            return None
        self.open_pairs = left
        # The clear part ends at `at`, a float; subtracting one unit makes up for its rounding.
        parameter = max(link.entry[1], int(at * (1 << PARAMETER_BITS)) - 1)
        self.clear = link.time(parameter)[0] if parameter > link.entry[1] else link.entered[0]
        self.parameters = parameter, parameter, parameter
        after = (max(link.entry) + _AFTER) / (1 << PARAMETER_BITS)
        contact = _touching(pairs, coefficients, radius, (after, max(at, after), longest))
        if contact is None:
            return _NEITHER
        begin, end = (int(s * (1 << PARAMETER_BITS)) for s in (contact.begin, contact.end))
        self.parameters = parameter, begin, end
        self.touching = replace(contact, latest=link.time(end)[1])
        return _FIRST

    def _at_a_branch_point(self, branch_point: Passage, pairs: FacePairs) -> str | None:
        """Look for a contact on the arc through a branch point.

        The tube before is clear up to its exit, and the arc may begin a little later. If the arc
        ends at the branch point, contacts are looked for before that point but not at it, because
        there the contacts of the other arcs begin, too.
        """
        link = branch_point.before
        coefficients, radius = positions_of(link.tube)
        low, high = (
            x / (1 << PARAMETER_BITS) for x in (link.exit, max(link.exit, branch_point.met[1]))
        )
        left = _clear(pairs, coefficients, radius, low, high)[1]
        if left:
            self.open_pairs, self.before_the_arc = left, True
            self.clear, self.parameters = link.left[0], (link.exit, link.exit, link.exit)
            return _NEITHER
        arc = on_branch_point_tube(branch_point.tube, branch_point.entry, branch_point.exit)
        at, left = _clear(pairs, arc.coefficients, arc.radius, arc.begin, arc.end)
        # `at` is a float: round it down to a whole number of units.
        parameter = (
            max(branch_point.entry, math.floor(at * (1 << PARAMETER_BITS)))
            if left
            else branch_point.exit
        )
        self.clear, self.parameters = (
            branch_point.time(parameter)[0],
            (parameter, parameter, parameter),
        )
        if not left:
            return None
        self.open_pairs = left
        where = arc.begin, max(at, arc.begin), arc.end
        contact = _touching(pairs, arc.coefficients, _ROOM * arc.radius + _MORE, where)
        if contact is None:
            return _NEITHER
        begin, end = (int(s * (1 << PARAMETER_BITS)) for s in (contact.begin, contact.end))
        self.parameters = parameter, begin, end
        self.touching = replace(contact, latest=branch_point.time(end)[1])
        return _FIRST

    def result(self, track: Track) -> FirstContact:
        """What was found on a track that was followed with this object as its `stop`."""
        pairs = self._pairs = self._pairs or FacePairs(track.framework)
        coefficients, radius = planar_positions_of(track.start)
        reach = (track.start.last / (1 << ROOT_BITS)) ** 2
        _, left = _clear(pairs, coefficients, radius, 0.0, reach, planar=True)
        if left:
            reason = "near the flat state, some faces are not proved to stay apart"
            return FirstContact(UNDECIDED, Fraction(0), None, _named(track, pairs, left), reason)
        clear = self.clear * track.framework.unit
        if self.touching is None:
            left = self.open_pairs or left
            return FirstContact(
                UNDECIDED,
                clear,
                None,
                _named(track, pairs, left),
                track.reason,
                self.parameters,
                self.before_the_arc,
            )
        event = _event(track, self.touching, clear)
        return FirstContact(PROVED, clear, event, (), "", self.parameters)


@dataclass(frozen=True)
class _Touching:
    """Faces that touch between two parameters, and a time by which they do.

    The parameters are whole numbers over 2^PARAMETER_BITS.
    """

    begin: float
    end: float
    crossing: Crossing | None = None
    fold: int | None = None
    latest: Fraction = Fraction(0)


def _clear(
    pairs: FacePairs,
    coefficients: FloatArray,
    radius: FloatArray,
    low: float,
    high: float,
    planar: bool = False,
) -> tuple[float, Open]:
    """The result of `clear_until` in tubes that are widened."""
    radius = _ROOM * radius + _MORE
    return clear_until(pairs, coefficients, radius, low, high, planar=planar, finest=_FINEST)


def positions_of(tube: Piece) -> tuple[FloatArray, FloatArray]:
    """The positions of the vertices on a tube: coefficients (order + 1, V, 3), and error bounds (V,
    3).
    """
    framework = tube.framework
    one = float(1 << tube.bits)
    rows = np.array([[x / one for x in row] for row in tube.coefficients])
    coefficients = framework.displacement(rows)
    coefficients[0, :, :2] += framework.flat
    return coefficients, framework.displacement(_radii(tube))


def planar_positions_of(start: StartTube) -> tuple[FloatArray, FloatArray]:
    """The same on a start tube, as polynomials in s = tau^2; only x and y are bounded."""
    framework, scale = start.framework, 0.25**start.halvings
    one = float(1 << start.bits)
    rows = np.array([[scale * (x / one) for x in row] for row in start.coefficients])
    coefficients = np.concatenate(
        [np.zeros((1, len(framework.points), 3)), framework.displacement(rows)]
    )
    coefficients[0, :, :2] = framework.flat
    reach = (start.last / (1 << ROOT_BITS)) ** 2
    radius = framework.displacement(_radii(start)) * scale * reach
    coefficients[..., 2] = 0.0
    return coefficients, radius


def _radii(piece: Piece) -> FloatArray:
    radius = piece.radius / float(1 << SCALE)
    weights = np.array([w / float(1 << WEIGHT_BITS) for w in piece.weights])
    return np.asarray(radius * weights * (1 + 1e-9) + 1e-15)


def _touching(
    pairs: FacePairs,
    coefficients: FloatArray,
    radius: FloatArray,
    where: tuple[float, float, float],
) -> _Touching | None:
    """Parameters between which faces are proved to touch, and how; None if none are found.

    `where` holds three parameters: the first that may be used, the one after which to look, and the
    last. If a fold is a valley at one parameter and a mountain at another, and its two other
    corners are near each other in between, the fold is closed at some time in between. Otherwise an
    edge runs through a face.
    """
    crossings = Crossings(pairs.framework)
    first, low, high = where

    def closed(s: float) -> _Touching | None:
        begin, end = _whole(max(first, low - (s - low))), _whole(s)
        ends = [Swept.of(coefficients, radius, at, at) for at in (begin, end)]
        signs = [bends(swept, pairs.framework.hinges) for swept in ends]
        for fold in np.flatnonzero(signs[0] * signs[1] == -1).tolist():
            if _closes(pairs, Swept.of(coefficients, radius, begin, end), fold):
                return _Touching(begin, end, fold=fold)
        return None

    def crossed(s: float) -> _Touching | None:
        end = _whole(s)
        point = Swept.of(coefficients, radius, end, end)
        for crossing in map(crossings.named, crossings.pairs(point.start)):
            if through(point, crossing.edge, crossing.face):
                return _Touching(end, end, crossing)
        return None

    def earliest(test: Callable[[float], _Touching | None], good: float) -> _Touching | None:
        contact, bad = test(good), low
        for _ in range(_STEPS if contact else 0):
            middle = 0.5 * (bad + good)
            other = test(middle)
            contact, bad, good = (contact, middle, good) if other is None else (other, bad, middle)
        return contact

    step = 1e-9 * (high - low)
    while closed(low + step) is None and crossed(low + step) is None:
        if low + step >= high:
            return None
        step = min(2.0 * step, high - low)
    # Where a fold closes, faces beside it touch at the same time, and are often found earlier.
    later = min(16.0 * step, high - low)
    return earliest(closed, low + later) or earliest(crossed, low + step)


def _whole(s: float) -> float:
    """A parameter rounded down to a whole number over 2^PARAMETER_BITS."""
    return math.floor(s * (1 << PARAMETER_BITS)) / (1 << PARAMETER_BITS)


def _closes(pairs: FacePairs, swept: Swept, fold: int) -> bool:
    """Whether a fold reaches 180 degrees; it is a valley at one end and a mountain at the other."""
    _, _, left, right = pairs.framework.hinges[fold]
    gap = np.abs(swept.start[left] - swept.start[right])
    gap = gap + swept.half * np.abs(swept.slope[left] - swept.slope[right])
    gap = gap + swept.error[left] + swept.error[right]
    # At 90 degrees the squared distance is the mean of those of the closed and of the open fold.
    flat = pairs.framework.flat[left] - pairs.framework.flat[right]
    mean = 0.5 * (pairs.closed[fold] + float(flat @ flat))
    return bool((gap * gap).sum() < mean * (1 - 1e-9) - 1e-11)


def _event(track: Track, touching: _Touching, clear: Fraction) -> Event:
    framework = track.framework
    time = in_floats((clear, touching.latest * framework.unit))
    if touching.fold is not None:
        i, j, left, right = (track.labels[v] for v in framework.hinges[touching.fold])
        return Event(FLAT_FOLD, time, ((i, j, left), (i, right, j)), ((i, j),))
    if touching.crossing is None:
        raise ArithmeticError("a contact without faces")
    edge, face = touching.crossing.edge, touching.crossing.face
    faces = [t for t in framework.sheet.triangles if set(edge) <= set(t)]
    own = min(faces, key=lambda t: len(set(t) & set(face)))
    return Event(CONTACT, time, (_labelled(track, own), _labelled(track, face)))


def _labelled(track: Track, face: Triangle) -> Triangle:
    a, b, c = (track.labels[v] for v in face)
    return a, b, c


def _named(track: Track, pairs: FacePairs, left: Open) -> tuple[tuple[Triangle, Triangle], ...]:
    """The pairs of faces that are left, with the pattern's numbers of the vertices."""
    open_pairs = [pairs.names(int(k), "apart") for k in left.apart]
    open_pairs += [pairs.names(int(k), "corner") for k in left.corner]
    for fold in left.folds:
        i, j, a, b = (int(v) for v in track.framework.hinges[fold])
        open_pairs.append(((i, j, a), (i, b, j)))
    return tuple((_labelled(track, one), _labelled(track, two)) for one, two in open_pairs)
