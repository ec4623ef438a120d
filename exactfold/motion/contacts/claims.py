"""The first contact in the certificate of a motion, for the checker (docs/motion.md, 17)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import zip_longest

from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.motion.lengths import Path
from exactfold.exact.numbers import format_rational
from exactfold.motion.claims import Claim
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
    claim = contacts_claim(track, contact)
    if claim is None:
        return track.certificate()
    return track.certificate(claim, clear=contact.clear_to_the_end)


def contacts_claim(track: Track, contact: FirstContact) -> Claim | None:
    """How long no two faces touch and, if the contact is enclosed, which faces do, and by when."""
    if contact.parameters is None:
        return None
    until, begin, end = contact.parameters
    parts, unit = _parts(track), track.framework.unit
    if contact.before_the_arc:
        del parts[-1]
    clear = _rounded(_shortest(parts, until) * (1 - _SLACK) * unit)
    claims: Document = {"clear": format_rational(clear)}
    evidence = {"tube": len(parts) - 1, "clear": until}
    event = contact.event
    if contact.status is PROVED and event is not None:
        latest = _rounded(_longest(parts, end) * (1 + _SLACK) * unit, 1)
        evidence |= {"from": begin, "to": end}
        claims["contact"] = {
            "kind": event.kind,
            "time": [format_rational(clear), format_rational(latest)],
            "faces": [list(face) for face in event.faces],
            "folds": [list(fold) for fold in event.folds],
        }
    return Claim(claims, {"contacts": evidence})


@dataclass(frozen=True)
class _Part:
    """A piece of a track, with bounds of the parameters at which the motion enters and
    leaves it.
    """

    path: Path
    entry: tuple[Fraction, Fraction]
    exit: tuple[Fraction, Fraction]


def _shortest(parts: list[_Part], parameter: int) -> Fraction:
    """A lower bound of the length up to a parameter of the last part."""
    total = Fraction(0)
    for part in parts[:-1]:
        path = part.path
        total += path.shortest(path.above(part.entry[1]), path.below(part.exit[0]))
    path, at = parts[-1].path, Fraction(parameter, 1 << PARAMETER_BITS)
    return total + path.shortest(path.above(parts[-1].entry[1]), path.below(at))


def _longest(parts: list[_Part], parameter: int) -> Fraction:
    """An upper bound of the same."""
    total = Fraction(0)
    for part in parts[:-1]:
        path = part.path
        total += path.longest(path.below(part.entry[0]), path.above(part.exit[1]))
    path, at = parts[-1].path, Fraction(parameter, 1 << PARAMETER_BITS)
    return total + path.longest(path.below(parts[-1].entry[0]), path.above(at))


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


def _arc_path(branch_point: Passage) -> Path:
    arc, far = branch_point.tube, max(-branch_point.entry, branch_point.exit)
    return Path.of_tube(
        [list(row) for row in (arc.branch_point.finer(arc.bits).centre, *arc.coefficients)],
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
