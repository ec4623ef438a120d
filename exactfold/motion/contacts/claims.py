"""The first contact in the certificate of a motion, for `exactfold.checker` (docs/contacts.md)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest

from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.motion.lengths import Path
from exactfold.exact.numbers import format_rational
from exactfold.motion.contacts.contacts import FirstContact
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.passages import Passage
from exactfold.motion.tubes.piece import PARAMETER_BITS, REACH_BITS
from exactfold.motion.tubes.tracks import Track
from exactfold.motion.tubes.tube_start import ROOT_BITS

_PLACES = 40
_SLACK = Fraction(1, 10**6)
"""A share of a length: the bounds of the checker may be wider than those here by this much."""


def certificate_with_contact(track: Track, contact: FirstContact) -> Document:
    """`Track.certificate` together with what is proved of the first contact on this track.

    The certificate claims a time before which no two faces touch. If the contact is enclosed, it
    also claims which faces touch, and a time by which they do. The times are those of `contact`,
    made slightly weaker because the checker has coarser bounds of lengths. For a track that ends at
    a branch point, the certificate claims whether no two faces touch before it and at it. If
    nothing is known near the flat state, or if the track has no tube, nothing is claimed of
    contacts.

    >>> from exactfold import checker
    >>> from exactfold.branches.counting.find import find_branch
    >>> from exactfold.motion.contacts.contacts import first_contact
    >>> track, contact = first_contact(find_branch("two-vertex", "+-"))
    >>> claims = checker.check(certificate_with_contact(track, contact))["contact"]
    >>> claims["kind"], claims["folds"]
    ('flat-fold', [[3, 5]])
    """
    document = track.certificate()
    if contact.parameters is None:
        return document
    until, begin, end = contact.parameters
    parts = _parts(track)
    if contact.before_the_arc:
        del parts[-1]
    shortest = longest = Fraction(0)
    for part in parts[:-1]:
        low, high = part.entry
        shortest += part.path.shortest(part.path.above(high), part.path.below(part.exit[0]))
        longest += part.path.longest(part.path.below(low), part.path.above(part.exit[1]))
    path, (low, high) = parts[-1].path, parts[-1].entry
    at = Fraction(until, 1 << PARAMETER_BITS)
    shortest += path.shortest(path.above(high), path.below(at))
    clear = _rounded(shortest * (1 - _SLACK) * track.framework.unit)
    document["claims"]["clear"] = format_rational(clear)
    if track.node is not None:
        document["claims"]["node"]["clear"] = contact.clear_to_the_end
    contacts = {"tube": len(parts) - 1, "clear": until}
    event = contact.event
    if contact.status is PROVED and event is not None:
        at = Fraction(end, 1 << PARAMETER_BITS)
        longest += path.longest(path.below(low), path.above(at))
        latest = _rounded(longest * (1 + _SLACK) * track.framework.unit, 1)
        contacts |= {"from": begin, "to": end}
        document["claims"]["contact"] = {
            "kind": event.kind,
            "time": [format_rational(clear), format_rational(latest)],
            "faces": [list(face) for face in event.faces],
            "folds": [list(fold) for fold in event.folds],
        }
    document["evidence"]["contacts"] = contacts
    return document


@dataclass(frozen=True)
class _Part:
    """A piece of a track, with bounds of the parameters at which the motion enters and
    leaves it.
    """

    path: Path
    entry: tuple[Fraction, Fraction]
    exit: tuple[Fraction, Fraction]


def _parts(track: Track) -> list[_Part]:
    """The start tube, the tubes, and the arcs through branch points, in the order of the track."""
    zero, last = Fraction(0), Fraction(track.start.last, 1 << ROOT_BITS)
    parts = [_Part(_start_path(track), (zero, zero), (last, last))]
    for step, after in zip_longest(track.steps, track.steps[1:]):
        ends = step.exit, step.exit
        if isinstance(step, Passage):
            begin = step.entry, step.entry
            parts.append(_Part(_arc_path(step), _parameters(begin), _parameters(ends)))
            continue
        if isinstance(after, Passage):
            ends = after.met
        parts.append(_Part(_tube_path(step), _parameters(step.entry), _parameters(ends)))
    return parts


def _parameters(ends: tuple[int, int]) -> tuple[Fraction, Fraction]:
    return Fraction(ends[0], 1 << PARAMETER_BITS), Fraction(ends[1], 1 << PARAMETER_BITS)


def _start_path(track: Track) -> Path:
    start = track.start
    square = start.last * start.last  # over 2^PARAMETER_BITS
    return Path.of_start(
        [list(row) for row in start.coefficients],
        start.bits,
        start.halvings,
        Fraction(start.last, 1 << ROOT_BITS),
        list(start.enclosure(square).radii),
        list(start.velocity(square).radii),
    )


def _tube_path(link: Link) -> Path:
    tube = link.tube
    return Path.of_tube(
        [list(row) for row in tube.coefficients],
        tube.bits,
        Fraction(tube.reach, 1 << REACH_BITS),
        list(tube.enclosure(tube.longest).radii),
        list(tube.velocity(tube.longest).radii),
    )


def _arc_path(node: Passage) -> Path:
    arc, far = node.tube, max(-node.entry, node.exit)
    return Path.of_tube(
        [list(row) for row in (arc.node.finer(arc.bits).centre, *arc.coefficients)],
        arc.bits,
        Fraction(far, 1 << PARAMETER_BITS),
        list(arc.ball(far).radii),
        list(arc.ball_velocity(far).radii),
    )


def _rounded(value: Fraction, direction: int = -1) -> Fraction:
    """A dyadic number near a rational one: at most (-1) or at least (1) the rational number.

    It has about `_PLACES` significant binary places, whatever the unit is.
    """
    size = value.numerator.bit_length() - value.denominator.bit_length() if value else 0
    unit = Fraction(2) ** (min(size, 0) - _PLACES)
    scaled = value / unit
    whole = -(-scaled // 1) if direction > 0 else scaled // 1
    return int(whole) * unit
