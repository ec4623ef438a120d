"""The first contact of a motion of panels: how long none touch, and by when some do.

Planes are found that part all panels until a parameter. At a later one an edge of a panel runs
through another, or folds are closed (docs/panel_motion.md, 6).
"""

from __future__ import annotations

from fractions import Fraction

from ...core.reading import items, keys, natural, parse_rational, require, rounded
from ..claims import Document
from ..lengths import GRID
from .drive import DrivenModes
from .folding import Folding, PanelClaim, from_least
from .places import Piece
from .times import Clock, time_of

_NARROWEST = 1 << GRID - 15
_KINDS = "contact", "flat-fold"


class Clear(PanelClaim):
    """No two panels touch beyond what they share at any time from 0 until before `clear`."""

    names = ("clear",)
    needs = ("clear",)
    always = True

    def check(self, folding: Folding) -> None:
        """Planes part them."""
        last = folding.parameter(self.evidence["clear"])
        clear = parse_rational(self.claims["clear"])
        require(clear <= folding.clock.time(last)[0], "what is clear is shorter than claimed")
        places, panels = folding.places, folding.panels

        def touching(piece: Piece | None) -> str:
            panels.spend(places.work)
            if piece is None:
                return "the panels"
            return panels.may_touch(piece, -1 << GRID, 1 << GRID, _NARROWEST)

        places.each(Fraction(0), last, touching)

    @staticmethod
    def said(claims: Document) -> str:
        """Until when."""
        return f"; no two panels touch before the time {_times(claims)[0]}"


class Contact(PanelClaim):
    """Some panels touch at or before the second `time`, and none before the first.

    An edge of one of the two `faces` runs through the other, or the `folds` are closed.
    """

    names = ("contact",)

    @classmethod
    def needed_by(cls, claims: Document) -> tuple[str, ...]:
        """The parameter at which an edge runs through a panel."""
        through = "contact" in claims and claims["contact"]["kind"] == "contact"
        return ("contact",) if through else ()

    def check(self, folding: Folding) -> None:
        """By then they touch."""
        contact, clock = self.claims["contact"], folding.clock
        keys(contact, "kind time faces folds", "contact")
        require(contact["kind"] in _KINDS, "the contact is of no known kind")
        first, latest = map(parse_rational, items(contact["time"], "time", 2))
        clear = parse_rational(self.claims["clear"])
        require(first == clear, "a contact is not claimed from where the motion is clear")
        if contact["kind"] == "contact":
            end = folding.parameter(self.evidence["contact"])
            by = clock.time(end)[1]
            _check_crossing(folding, end, contact)
        else:
            by = time_of(Fraction(1))[1]
            _check_closing(folding.drive, clock, contact)
        require(by <= latest, "the contact may be later than claimed")

    @staticmethod
    def said(claims: Document) -> str:
        """What touches, and by when."""
        contact = claims["contact"]
        what = "the folds are closed" if contact["folds"] else "a fold is closed"
        if contact["kind"] == "contact":
            what = " and ".join("-".join(map(str, face)) for face in contact["faces"]) + " do"
        return f", {what} by {_times(claims)[1]}"


def _times(claims: Document) -> list[str]:
    """The times claimed, each also in degrees."""
    contact = claims.get("contact")
    times = [parse_rational(t) for t in ([claims["clear"]] if contact is None else contact["time"])]
    pi = time_of(Fraction(1))
    turns = [
        bound(180 * t / end for end in pi) for t, bound in zip(times, (min, max), strict=False)
    ]
    return [
        f"{t} ({a} degrees)" for t, a in zip(_told_apart(times), _told_apart(turns), strict=True)
    ]


def _told_apart(values: list[Fraction]) -> list[str]:
    """Numbers with six digits, or as many as make them different: the first rounded down, then up.

    They are bounds, from below and from above.
    """
    for digits in range(6, 17):
        found = [rounded(value, digits, up=k > 0) for k, value in enumerate(values)]
        if len(set(found)) == len(found):
            break
    return found


def _check_crossing(folding: Folding, end: Fraction, claim: Document) -> None:
    """An edge of one of two panels runs through the other at the parameter `end`.

    Each has its corners, counter-clockwise from any of them.
    """
    require(claim["folds"] == [], "a contact has no folds")
    places, panels = folding.places, folding.panels
    touching = []
    for face in items(claim["faces"], "faces", 2):
        corners = from_least(tuple(natural(v, "corner") for v in items(face, "face")))
        touching.append(panels.triangles.get(corners, []))
    piece = places.piece(end - end / (1 << 20), end)
    through = piece is not None and any(
        panels.crossing(piece, end, a, b) for a in touching[0] for b in touching[1]
    )
    require(through, "no side runs through the other panel")


def _check_closing(drive: DrivenModes, clock: Clock, claim: Document) -> None:
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
