"""Certificates of motions of rigid panels: how they fold, and what touches first.

All positions are analytic functions of a parameter x of the time (`panel_times`), and planes are
found that part all panels until a parameter. At a later one an edge of a panel runs through
another, or folds are closed (docs/panel_motion.md, 5 and 6).
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ...core.kinds import DocumentKind
from ...core.limits import MOST_TESTS
from ...core.reading import (
    counted,
    items,
    keys,
    natural,
    parse_rational,
    refusing,
    require,
    rounded,
)
from ...sheets.panels import read_panels
from ..faces import FacePairs
from ..lengths import GRID
from .cut import Triangle, cut
from .drive import Drive
from .places import Piece, Places, shrunk
from .times import Clock, OneRate, Rates, time_of

_NARROWEST = 1 << GRID - 15
_NAMED = 3
_KINDS = "contact", "flat-fold"
_PARAMETER_BITS = 40


PLAIN, RATED = 1, 2
"""The versions: of folds that are driven alike, and of folds that move at rates of their own."""


@refusing()
def check(data: dict[str, Any]) -> dict[str, Any]:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The claims are: from the flat sheet on the
    panels fold with the mountains and valleys of `assignment` and no other fold, the folds
    `drivers` having the angle t at the time t, or t times their `rates`, until a fold is closed; no
    two panels touch beyond what they share at any time from 0 until before `clear`; with `contact`,
    some do at or before its second time, and none before its first (docs/panel_motion.md, 6).
    """
    sheet, digest = read_panels(data["pattern"])
    claims, evidence = data["claims"], data["evidence"]
    more = " contact" if isinstance(claims, dict) and "contact" in claims else ""
    rated = data["version"] == RATED
    keys(claims, f"assignment drivers{' rates' * rated} clear{more}", "claims")
    contact = claims.get("contact")
    through = contact is not None and contact["kind"] == "contact"
    keys(evidence, "vertices clear" + (" contact" if through else ""), "evidence")
    shrunk(sheet)
    drive = Drive(sheet, claims["assignment"], claims["drivers"], evidence["vertices"])
    clock = Rates(claims["drivers"], claims["rates"]) if rated else OneRate()
    places = Places(drive, clock)
    last = _parameter(clock, evidence["clear"])
    clear = parse_rational(claims["clear"])
    require(clear <= clock.time(last)[0], "what is clear is shorter than claimed")
    panels = Panels(drive, places)
    if contact is not None:
        keys(contact, "kind time faces folds", "contact")
        require(contact["kind"] in _KINDS, "the contact is of no known kind")
        first, latest = map(parse_rational, items(contact["time"], "time", 2))
        require(first == clear, "a contact is not claimed from where the motion is clear")
        if through:
            end = _parameter(clock, evidence["contact"])
            by = clock.time(end)[1]
            _check_crossing(panels, places, end, contact)
        else:
            by = time_of(Fraction(1))[1]
            _check_closing(drive, clock, contact)
        require(by <= latest, "the contact may be later than claimed")

    def touching(piece: Piece | None) -> str:
        panels.spend(places.work)
        if piece is None:
            return "the panels"
        return panels.may_touch(piece, -1 << GRID, 1 << GRID, _NARROWEST)

    places.each(Fraction(0), last, touching)
    return {"sha256": digest, **claims}


def _parameter(clock: Clock, value: Any) -> Fraction:
    found = Fraction(natural(value, "a parameter"), 1 << _PARAMETER_BITS)
    require(found < clock.last, "a parameter is out of range")
    return found


class Panels(FacePairs):
    """The pairs of triangles of different panels, and which triangles a panel has.

    Folds need no test: before the time pi none is closed.
    """

    def __init__(self, drive: Drive, places: Places) -> None:
        sheet = drive.sheet
        faces: list[Triangle] = []
        names: list[tuple[int, ...]] = []
        self.triangles: dict[tuple[int, ...], list[Triangle]] = {}
        for panel in sheet.panels:
            some = cut(sheet, panel)
            self.triangles[_from_least(panel)] = some
            faces += some
            names += [panel] * len(some)
        body = dict(zip(sheet.panels, places.bodies, strict=True))
        still = [0, 0, 0]
        flat = dict.fromkeys(range(len(sheet.points)), still)
        place = {v: 3 * v for v in flat}
        super().__init__(faces, names, [body[n] for n in names], {}, flat, place, MOST_TESTS)


def _check_crossing(panels: Panels, places: Places, end: Fraction, claim: Any) -> None:
    """An edge of one of two panels runs through the other at the parameter `end`.

    Each has its corners, counter-clockwise from any of them.
    """
    require(claim["folds"] == [], "a contact has no folds")
    touching = []
    for face in items(claim["faces"], "faces", 2):
        corners = _from_least(tuple(natural(v, "corner") for v in items(face, "face")))
        touching.append(panels.triangles.get(corners, []))
    piece = places.piece(end - end / (1 << 20), end)
    through = piece is not None and any(
        panels.crossing(piece, end, a, b) for a in touching[0] for b in touching[1]
    )
    require(through, "no side runs through the other panel")


def _from_least(corners: tuple[int, ...]) -> tuple[int, ...]:
    """The same corners in the same order round a panel, the one with the smallest number first."""
    first = corners.index(min(corners))
    return corners[first:] + corners[:first]


def _check_closing(drive: Drive, clock: Clock, claim: Any) -> None:
    """The folds named are closed when the drivers are; some fold is by then, in any motion."""
    require(claim["faces"] == [], "folds that close have no faces")
    folds = [
        tuple(natural(v, "vertex") for v in items(fold, "fold", 2))
        for fold in items(claim["folds"], "folds")
    ]
    require(len(set(folds)) == len(folds), "a fold that closes is named twice")
    modes = [mode for mode in drive.modes if mode.linear and clock.closes(mode.driver)]
    closed = {fold for mode in modes for fold in mode.folds}
    require(closed.issuperset(folds), "a fold is not known to close")


def summary(claims: dict[str, Any]) -> str:
    """One line for verified claims."""
    letters, contact = claims["assignment"], claims.get("contact")
    number = counted(len(letters) - letters.count("F"), "fold moves", "folds move")
    drivers = ", ".join(f"{i}-{j}" for i, j in claims["drivers"][:_NAMED])
    more = f" and {len(claims['drivers']) - _NAMED} more" if claims["drivers"][_NAMED:] else ""
    rates = " at rates of their own" if "rates" in claims else ""
    times = [parse_rational(t) for t in ([claims["clear"]] if contact is None else contact["time"])]
    pi = time_of(Fraction(1))
    turns = [
        bound(180 * t / end for end in pi) for t, bound in zip(times, (min, max), strict=False)
    ]
    angles = [
        f"{t} ({a} degrees)" for t, a in zip(_told_apart(times), _told_apart(turns), strict=True)
    ]
    text = (
        f"VALID: the panels fold, {number} of {len(letters)}, driven by {drivers}{more}{rates}; "
        f"no two panels touch before the time {angles[0]}"
    )
    if contact is not None:
        what = "the folds are closed" if contact["folds"] else "a fold is closed"
        if contact["kind"] == "contact":
            what = " and ".join("-".join(map(str, face)) for face in contact["faces"]) + " do"
        text += f", {what} by {angles[1]}"
    return f"{text}; sha256 {claims['sha256']}"


def _told_apart(values: list[Fraction]) -> list[str]:
    """Numbers with six digits, or as many as make them different: the first rounded down, then up.

    They are bounds, from below and from above.
    """
    for digits in range(6, 17):
        found = [rounded(value, digits, up=k > 0) for k, value in enumerate(values)]
        if len(set(found)) == len(found):
            break
    return found


PANEL_MOTION = DocumentKind(
    format="exactfold panel motion",
    versions=(PLAIN, RATED),
    names="format version pattern claims evidence",
    check=check,
    summary=summary,
)
"""A motion of rigid panels, and what touches first (docs/panel_motion.md)."""
