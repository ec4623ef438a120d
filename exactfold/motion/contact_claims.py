"""The first contact in the certificate of a motion, for `exactfold.checker` (docs/contacts.md)."""

from __future__ import annotations

from fractions import Fraction

from exactfold.checker.motion_lengths import Path
from exactfold.evidence.entries import Document
from exactfold.exact.numbers import format_rational
from exactfold.motion.contacts import FirstContact
from exactfold.motion.links import Link
from exactfold.motion.piece import PARAMETER_BITS, REACH_BITS
from exactfold.motion.tracks import Track
from exactfold.motion.tube_start import ROOT_BITS
from exactfold.verdict import PROVED

_PLACES = 40
_SLACK = Fraction(1, 10**6)
"""Of a length: the checker takes tubes to be a little wider, or narrower, than they are here."""


def certificate_with_contact(track: Track, contact: FirstContact) -> Document:
    """`Track.certificate` with what is proved of the first contact on this track.

    It claims a time before which no two faces touch and, if the contact is enclosed, which faces
    touch, and by when. The times are those of `contact` with a little room, as the checker has
    coarser bounds of lengths. Where nothing is known near the flat state, or the track has no tube,
    nothing is claimed of contacts.

    >>> from exactfold import checker
    >>> from exactfold.count.find import find_branch
    >>> from exactfold.motion.contacts import first_contact
    >>> track, contact = first_contact(find_branch("two-vertex", "+-"))
    >>> claims = checker.check(certificate_with_contact(track, contact))["contact"]
    >>> claims["kind"], claims["folds"]
    ('flat-fold', [[3, 5]])
    """
    document = track.certificate()
    if contact.parameters is None:
        return document
    until, begin, end = contact.parameters
    paths = [_start_path(track), *(_tube_path(link) for link in track.links)]
    exits = [Fraction(track.start.last, 1 << ROOT_BITS)]
    exits += [Fraction(link.exit, 1 << PARAMETER_BITS) for link in track.links]
    entries = [(Fraction(0), Fraction(0))]
    for link in track.links:
        low, high = (Fraction(x, 1 << PARAMETER_BITS) for x in link.entry)
        entries.append((low, high))
    shortest = longest = Fraction(0)
    for path, (low, high), last in zip(paths[:-1], entries[:-1], exits[:-1], strict=True):
        shortest += path.shortest(path.above(high), path.below(last))
        longest += path.longest(path.below(low), path.above(last))
    path, (low, high) = paths[-1], entries[-1]
    at = Fraction(until, 1 << PARAMETER_BITS)
    shortest += path.shortest(path.above(high), path.below(at))
    clear = _rounded(shortest * (1 - _SLACK) * track.framework.unit)
    document["claims"]["clear"] = format_rational(clear)
    contacts = {"tube": len(track.links), "clear": until}
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


def _rounded(value: Fraction, direction: int = -1) -> Fraction:
    """A dyadic number near a rational one, not above it (-1) or not below it (1)."""
    scaled = value * (1 << _PLACES)
    whole = -(-scaled // 1) if direction > 0 else scaled // 1
    return Fraction(int(whole), 1 << _PLACES)
