"""The certificate of a motion of panels and of its first contact (docs/motion.md, 22)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil, cos, floor, pi, sin, tan

from exactfold.certificates.entries import Document
from exactfold.checker.motion.panels.certificate import (
    BUILT,
    CLOSING,
    LAYERED,
    PANEL_MOTION,
    PLAIN,
    RATED,
)
from exactfold.checker.motion.panels.times import Clock, OneRate, Rates, time_of
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.exact.surds import Number, Surd, SurdField, simple
from exactfold.motion.claims import Claim, joined
from exactfold.motion.curves.events import CONTACT, STOP, Event
from exactfold.motion.panels.clearance import PanelClearance
from exactfold.motion.panels.motion import PanelMotion
from exactfold.motion.panels.thick import ThickContacts
from exactfold.motion.solid.plates import Solid
from exactfold.panels.modes.densities import split
from exactfold.panels.vertex.local import LocalMode
from exactfold.pattern.panel_entries import number_document, panels_document
from exactfold.pattern.panel_pattern import Edge

_PARAMETER_BITS = 40
_SLACK = Fraction(1, 1 << 22)
"""The claim ends this much of the parameter early, because the checker has coarser separating
planes.
"""
_TRIES = 20
_PLACES = 44
"""Times are rounded to this many binary places."""


def certificate_of_panel_motion(
    motion: PanelMotion, contacts: PanelClearance, layers: Claim | None = None
) -> Document:
    """The certificate of a motion and its contacts, as a JSON object for `exactfold.checker`.

    It claims that the panels fold in this way, and a time before which no two of them touch. If a
    contact is proved, it also claims a time by which some panels touch; or if it is proved that
    none touch before all folds close together, it claims this, and the order of `layers` then, if
    that is given. Of plates it claims all this of the plates; with stops, which fold reaches its
    stop first, and when. The times are those of `contacts`, made slightly weaker.

    Raises `NotApplicableError` if a vertex needs more than one square root besides those of the
    coordinates, and for a sheet with holes.

    >>> from exactfold import checker
    >>> from exactfold.motion.panels.clearance import prove_contacts
    >>> from exactfold.motion.panels.following import follow_panels
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> motion = follow_panels(panels(single_vertex(4)), until="90deg", frames=2)
    >>> checker.check(certificate_of_panel_motion(motion, prove_contacts(motion)))["drivers"]
    [[0, 4]]
    """
    if motion.pattern.holes:
        raise NotApplicableError("no certificate states that panels close round a hole")
    if motion.solid is not None or motion.stops is not None:
        return _certificate_of_built(motion, contacts)
    timing = Timing.of(motion)
    claims = [driven_claim(motion)]
    if timing.rates is not None:
        claims.append(Claim({"rates": timing.rates}))
    version = PLAIN if timing.rates is None else RATED
    if contacts.closes_from is not None:
        version = CLOSING
        claims.append(closed_claim(motion, contacts.closes_from, timing))
        if layers is not None:
            version = LAYERED
            claims.append(layers)
    else:
        clear, clear_claimed = clear_claim(motion, contacts, timing)
        claims.append(clear_claimed)
        if contacts.event is not None:
            claims.append(contact_claim(contacts.event, clear, timing))
    return _document(motion, version, claims)


def _certificate_of_built(motion: PanelMotion, contacts: PanelClearance) -> Document:
    """The certificate of a motion of plates, or with stops."""
    timing = Timing.of(motion, rated=True)
    claims = [driven_claim(motion), Claim({"rates": timing.rates})]
    if motion.solid is not None:
        claims.append(Claim({"plates": motion.solid.to_dict()}))
    clear, clear_claimed = clear_claim(motion, contacts, timing)
    claims.append(clear_claimed)
    event = contacts.event
    if event is not None and (motion.solid is None or event.kind != CONTACT):
        claims.append(contact_claim(event, clear, timing))
    elif event is not None and motion.solid is not None:
        claims.append(overlap_claim(motion, motion.solid, event, clear, timing))
    claims += [stop_claim(motion, event, timing) for event in motion.events if event.kind == STOP]
    return _document(motion, BUILT, claims)


def _document(motion: PanelMotion, version: int, claims: list[Claim]) -> Document:
    return {
        "format": PANEL_MOTION.format,
        "version": version,
        "pattern": panels_document(motion.pattern),
        **joined(claims),
    }


@dataclass(frozen=True)
class Timing:
    """The parameter of the times of a motion, as the checker has it.

    `rates` are those of the drivers, None if all are 1.
    """

    clock: Clock
    rates: list[str] | None

    @classmethod
    def of(cls, motion: PanelMotion, *, rated: bool = False) -> Timing:
        """That of a motion; with rates in any case if `rated`."""
        drivers = _drivers(motion)
        sizes = [Fraction(abs(rate)) for rate in (*motion.rates, *motion.free_rates.values())]
        if min(sizes) >= 1 and not rated:
            return cls(OneRate(), None)
        rates = [format_rational(size) for size in sizes]
        return cls(Rates(drivers, rates), rates)

    def parameter(self, time: float) -> float:
        """A quarter of the time, or x with x / (1 - x) = tan(time / 2)."""
        if self.rates is not None:
            return time / 4
        s, c = sin(time / 2), cos(time / 2)
        return s / (s + c)


def driven_claim(motion: PanelMotion) -> Claim:
    """How the panels fold, and what drives them."""
    pattern, letters = motion.pattern, motion.assignment
    vertices = [
        _vertex(pattern.field, mode, folds)
        for curve in motion.curves
        for mode, folds in zip(curve.mode.choice, curve.mode.vertices, strict=True)
    ]
    return Claim(
        {
            "assignment": "".join(letters[fold] for fold in pattern.folds),
            "drivers": _drivers(motion),
        },
        {"vertices": vertices},
    )


def clear_claim(
    motion: PanelMotion, contacts: PanelClearance, timing: Timing
) -> tuple[Fraction, Claim]:
    """A time before which no two panels touch, and the claim that states it."""
    last = max(_at_most(timing.parameter(contacts.clear)) - _SLACK, Fraction(0))
    if contacts.clear >= motion.duration and contacts.event is None:
        last = _at_least(timing.parameter(motion.duration))
        clear = min(Fraction(motion.duration), timing.clock.time(last)[0])
    else:
        clear = _rounded(timing.clock.time(last)[0], -1)
    return clear, Claim({"clear": format_rational(clear)}, {"clear": _in_places(last)})


def closed_claim(motion: PanelMotion, closes_from: float, timing: Timing) -> Claim:
    """That no two panels touch before all folds that move close together, at the time pi.

    The time `clear`, which divides the motion in two parts that the checker verifies in different
    ways, is later than `closes_from`, because the checker has coarser bounds.
    """
    last = _at_least(1 / (1 + tan((pi - closes_from) / 2) / 2))
    clear = _rounded(timing.clock.time(last)[0], -1)
    moving = [fold for curve in motion.curves for fold in curve.folds]
    closed = sorted([*moving, *motion.free_rates])
    return Claim(
        {"clear": format_rational(clear), "closed": [list(fold) for fold in closed]},
        {"clear": _in_places(last)},
    )


def contact_claim(event: Event, clear: Fraction, timing: Timing) -> Claim:
    """The claim that states the first contact.

    It names the panels that touch or the folds that close, and an interval of times: the contact is
    not before the time `clear`, and not after the other end.
    """
    latest, evidence = time_of(Fraction(1))[1], {}
    if event.kind == CONTACT:
        end = _at_least(timing.parameter(event.time[1]))
        latest, evidence = timing.clock.time(end)[1], {"contact": _in_places(end)}
    return Claim(
        {
            "contact": {
                "kind": event.kind,
                "time": [format_rational(clear), format_rational(_rounded(latest, 1))],
                "faces": [list(face) for face in event.faces],
                "folds": [list(fold) for fold in event.folds],
            }
        },
        evidence,
    )


def overlap_claim(
    motion: PanelMotion, solid: Solid, event: Event, clear: Fraction, timing: Timing
) -> Claim:
    """The claim that states the first contact of plates, with a point of both.

    The point is looked for at the parameter of the file, a little later than the contact. Raises
    `NotApplicableError` if none is found soon.
    """
    thick = ThickContacts(motion, solid)
    for k in range(_TRIES):
        later = (event.time[0], event.time[1] + (1 << k) * 2.0**-_PARAMETER_BITS)
        claim = contact_claim(replace(event, time=later), clear, timing)
        end = Fraction(claim.evidence["contact"], 1 << _PARAMETER_BITS)
        found = thick.crossed(float(timing.clock.time(end)[1]))
        if found is None:
            continue
        crossed, (_, point) = found
        faces = {"faces": [list(face) for face in crossed.faces], "folds": []}
        return Claim(
            {"contact": {**claim.claims["contact"], **faces}},
            {**claim.evidence, "point": [format_rational(c) for c in point]},
        )
    raise NotApplicableError("no certificate: no point of both plates is found")


def stop_claim(motion: PanelMotion, event: Event, timing: Timing) -> Claim:
    """The claim that states which fold is the first at its stop, and when."""
    angles = {} if motion.stops is None else motion.stops.of(motion.pattern.folds)
    begin = _at_most(timing.parameter(event.time[0]))
    end = _at_least(timing.parameter(event.time[1]))
    low, high = timing.clock.time(begin)[0], timing.clock.time(end)[1]
    return Claim(
        {
            "stop": {
                "angles": [[i, j, format_rational(a)] for (i, j), a in sorted(angles.items())],
                "fold": list(event.folds[0]),
                "time": [format_rational(_rounded(low, -1)), format_rational(_rounded(high, 1))],
            }
        },
        {"stop": [_in_places(begin), _in_places(end)]},
    )


def _drivers(motion: PanelMotion) -> list[list[int]]:
    """The folds that drive it: those of the modes, then those that are free."""
    return [list(fold) for fold in (*motion.drivers, *motion.free_rates)]


def _vertex(field: SurdField, mode: LocalMode, v: int) -> Document:
    """The densities of the active folds at a vertex, in the sheet's field or with one root more."""
    radicand, values = _in_field(field, mode.values)
    return {
        "vertex": v,
        "radicand": None if radicand is None else number_document(radicand, radicand.field),
        "densities": [
            [_other(fold, v), number_document(value, value.field)]
            for fold, value in zip(mode.folds, values, strict=True)
        ],
    }


def _in_field(field: SurdField, values: tuple[Number, ...]) -> tuple[Surd | None, list[Surd]]:
    """The numbers in a field, or in the field with the square root of a number; also this
    number.
    """
    members: list[Surd | tuple[Surd, Surd]] = []
    radicand: Surd | None = None
    for value in map(simple, values):
        if not isinstance(value, Surd) or _extends(field, value.field):
            members.append(field.number(value))
            continue
        square, low, high = split(value)
        if not _extends(field, square.field) or radicand not in (None, field.number(square)):
            raise NotApplicableError(
                "no certificate: a vertex needs more than one square root of its own"
            )
        radicand = field.number(square)
        members.append((field.number(low), field.number(high)))
    if radicand is None:
        return None, [value for value in members if isinstance(value, Surd)]
    root = field.square_root(radicand)
    above = field if root is not None else field.adjoined(radicand)
    root = above.square_root(radicand)
    if root is None:
        raise ArithmeticError("a field does not contain the square root that was adjoined to it")
    pairs = (value if isinstance(value, tuple) else (value, 0) for value in members)
    numbers = [above.number(low + root * high) for low, high in pairs]
    return None if above is field else radicand, numbers


def _extends(field: SurdField, below: SurdField) -> bool:
    return field.radicands[: len(below.radicands)] == below.radicands


def _other(fold: Edge, v: int) -> int:
    return sum(fold) - v


def _at_most(x: float) -> Fraction:
    """A number with few digits that is at most a parameter."""
    return Fraction(floor(x * 2.0**_PARAMETER_BITS) - 1, 1 << _PARAMETER_BITS)


def _at_least(x: float) -> Fraction:
    return Fraction(ceil(x * 2.0**_PARAMETER_BITS) + 1, 1 << _PARAMETER_BITS)


def _in_places(x: Fraction) -> int:
    return int(x * (1 << _PARAMETER_BITS))


def _rounded(value: Fraction, direction: int) -> Fraction:
    """A number with few digits near another: at most (-1) or at least (1) that number."""
    scaled = value * (1 << _PLACES)
    return Fraction(floor(scaled) if direction < 0 else ceil(scaled), 1 << _PLACES)
