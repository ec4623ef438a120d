"""A motion of panels and its first contact in a certificate (docs/panel_motion.md, 6)."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, cos, floor, sin

from exactfold.certificates.entries import Document
from exactfold.checker.motion.panels.certificate import PANEL_MOTION, PLAIN, RATED
from exactfold.checker.motion.panels.times import OneRate, Rates, time_of
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.exact.surds import Number, Surd, SurdField, simple
from exactfold.motion.curves.events import CONTACT
from exactfold.motion.panels.clearance import PanelClearance
from exactfold.motion.panels.motion import PanelMotion
from exactfold.panels.certificate import number_document, panels_document
from exactfold.panels.densities import split
from exactfold.panels.local import LocalMode
from exactfold.pattern.panel_pattern import Edge

_PARAMETER_BITS = 40
_SLACK = Fraction(1, 1 << 22)
"""Of the parameter, before what is not proved: the checker has coarser directions of planes."""
_PLACES = 44
"""Binary places of times."""


def certificate_of_panel_motion(motion: PanelMotion, contacts: PanelClearance) -> Document:
    """The motion and what is proved of its contacts as a JSON object for `exactfold.checker`.

    It claims that the panels fold so, and a time before which none touch; and by when some do, if
    that is proved. Times are those of `contacts` with a little room.

    Raises `NotApplicableError` where a vertex needs more than one square root beside those of the
    coordinates.

    >>> from exactfold import checker
    >>> from exactfold.motion.panels.clearance import prove_contacts
    >>> from exactfold.motion.panels.following import follow_panels
    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.pattern.opening import panels
    >>> motion = follow_panels(panels(single_vertex(4)), until="90deg", frames=2)
    >>> checker.check(certificate_of_panel_motion(motion, prove_contacts(motion)))["drivers"]
    [[0, 4]]
    """
    pattern = motion.pattern
    letters = motion.assignment
    drivers = [list(fold) for fold in (*motion.drivers, *motion.free_rates)]
    sizes = [Fraction(abs(rate)) for rate in (*motion.rates, *motion.free_rates.values())]
    rates = [format_rational(size) for size in sizes]
    rated = min(sizes) < 1
    clock = Rates(drivers, rates) if rated else OneRate()
    parameter = _time_itself if rated else _tangent
    last = max(_at_most(parameter(contacts.clear)) - _SLACK, Fraction(0))
    if contacts.clear >= motion.duration:
        last = _at_least(parameter(motion.duration))
        clear = min(Fraction(motion.duration), clock.time(last)[0])
    else:
        clear = _rounded(clock.time(last)[0], -1)
    document: Document = {
        "format": PANEL_MOTION.format,
        "version": RATED if rated else PLAIN,
        "pattern": panels_document(pattern),
        "claims": {
            "assignment": "".join(letters[fold] for fold in pattern.folds),
            "drivers": drivers,
            **({"rates": rates} if rated else {}),
            "clear": format_rational(clear),
        },
        "evidence": {
            "vertices": [
                _vertex(pattern.field, mode, folds)
                for curve in motion.curves
                for mode, folds in zip(curve.mode.choice, curve.mode.vertices, strict=True)
            ],
            "clear": _in_places(last),
        },
    }
    event = contacts.event
    if event is None:
        return document
    latest = time_of(Fraction(1))[1]
    if event.kind == CONTACT:
        end = _at_least(parameter(event.time[1]))
        latest = clock.time(end)[1]
        document["evidence"]["contact"] = _in_places(end)
    document["claims"]["contact"] = {
        "kind": event.kind,
        "time": [format_rational(clear), format_rational(_rounded(latest, 1))],
        "faces": [list(face) for face in event.faces],
        "folds": [list(fold) for fold in event.folds],
    }
    return document


def _vertex(field: SurdField, mode: LocalMode, v: int) -> Document:
    """The densities of the active folds at a vertex, in the field of the sheet or one root more."""
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
    """Numbers in a field, or in it with the root of a number that is returned."""
    found: list[Surd | tuple[Surd, Surd]] = []
    radicand: Surd | None = None
    for value in map(simple, values):
        if not isinstance(value, Surd) or _extends(field, value.field):
            found.append(field.number(value))
            continue
        square, low, high = split(value)
        if not _extends(field, square.field) or radicand not in (None, field.number(square)):
            raise NotApplicableError("a vertex needs more than one square root of its own")
        radicand = field.number(square)
        found.append((field.number(low), field.number(high)))
    if radicand is None:
        return None, [value for value in found if isinstance(value, Surd)]
    root = field.square_root(radicand)
    above = field if root is not None else field.adjoined(radicand)
    root = above.square_root(radicand)
    if root is None:
        raise ArithmeticError("no root in the field made for it")
    pairs = (value if isinstance(value, tuple) else (value, 0) for value in found)
    numbers = [above.number(low + root * high) for low, high in pairs]
    return None if above is field else radicand, numbers


def _extends(field: SurdField, below: SurdField) -> bool:
    return field.radicands[: len(below.radicands)] == below.radicands


def _other(fold: Edge, v: int) -> int:
    return sum(fold) - v


def _at_most(x: float) -> Fraction:
    """A number with few digits, not above a parameter."""
    return Fraction(floor(x * 2.0**_PARAMETER_BITS) - 1, 1 << _PARAMETER_BITS)


def _at_least(x: float) -> Fraction:
    return Fraction(ceil(x * 2.0**_PARAMETER_BITS) + 1, 1 << _PARAMETER_BITS)


def _tangent(time: float) -> float:
    """x / (1 - x) = tan(time / 2)."""
    s, c = sin(time / 2), cos(time / 2)
    return s / (s + c)


def _time_itself(time: float) -> float:
    return time / 4


def _in_places(x: Fraction) -> int:
    return int(x * (1 << _PARAMETER_BITS))


def _rounded(value: Fraction, direction: int) -> Fraction:
    """A number near another with few digits, below (-1) or above it (1)."""
    scaled = value * (1 << _PLACES)
    return Fraction(floor(scaled) if direction < 0 else ceil(scaled), 1 << _PLACES)
