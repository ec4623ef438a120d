"""The first contact of a motion of panels: until when none touch, and by when some do.

Up to some parameter planes part all panels. At a later parameter an edge of one panel runs through
another panel, or folds are closed (docs/motion.md, 22).
"""

from __future__ import annotations

from fractions import Fraction

from ...core.reading import items, keys, natural, parse_rational, require, rounded
from ..claims import Document
from ..lengths import GRID
from .cut import from_least
from .drive import DrivenModes
from .folding import Folding, PanelClaim
from .places import Piece
from .times import Clock, time_of

_NARROWEST = 1 << GRID - 15
_KINDS = "contact", "flat-fold"


class Clear(PanelClaim):
    """From the time 0 until before the time `clear`, no two panels touch beyond what they share."""

    names = ("clear",)
    needs = ("clear",)
    always = True

    def check(self, folding: Folding) -> None:
        """Refuse a motion unless planes part the panels until then."""
        last = folding.parameter(self.evidence["clear"])
        clear = parse_rational(self.claims["clear"])
        long = clear <= folding.clock.time(last)[0]
        require(long, "the clear part of the motion is shorter than claimed")
        places, panels = folding.places, folding.panels
        panels.until(last)

        def touching(piece: Piece | None) -> str:
            panels.spend(places.work)
            if piece is None:
                return "the panels"
            return panels.may_touch(piece, -1 << GRID, 1 << GRID, _NARROWEST)

        places.each(Fraction(0), last, touching)

    @staticmethod
    def said(claims: Document) -> str:
        """The time until which no panels touch."""
        return f"; no two panels touch before the time {_times(claims)[0]}"


class Contact(PanelClaim):
    """Some panels touch at or before the second `time`, and none touch before the first.

    Either an edge of one of the two `faces` runs through the other face, or the plates of both have
    a common `point`, or the `folds` are closed.
    """

    names = ("contact",)

    @classmethod
    def needed_by(cls, claims: Document) -> tuple[str, ...]:
        """The parameter at which an edge runs through a panel, if one does; for plates also a point
        of both.
        """
        if "contact" not in claims or claims["contact"]["kind"] != "contact":
            return ()
        return ("contact", "point") if "plates" in claims else ("contact",)

    def check(self, folding: Folding) -> None:
        """Refuse a motion in which the panels are not proved to touch by then."""
        contact, clock = self.claims["contact"], folding.clock
        keys(contact, "kind time faces folds", "contact")
        require(contact["kind"] in _KINDS, "the contact is of no known kind")
        first, latest = map(parse_rational, items(contact["time"], "time", 2))
        clear = parse_rational(self.claims["clear"])
        require(first == clear, 'the first "time" of a contact differs from "clear"')
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
        """Which panels touch or which folds close, and by when."""
        contact = claims["contact"]
        what = "the folds are closed" if contact["folds"] else "a fold is closed"
        if contact["kind"] == "contact":
            what = " and ".join("-".join(map(str, face)) for face in contact["faces"]) + " do"
        return f", {what} by {_times(claims)[1]}"


def _times(claims: Document) -> list[str]:
    """The claimed times, each also in degrees."""
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
    """A lower bound, and an upper bound if there is one, in six digits or more.

    The lower bound is rounded down and the upper bound up. They have as many digits, up to 16, as
    are needed to tell them apart.
    """
    for digits in range(6, 17):
        texts = [rounded(value, digits, up=k > 0) for k, value in enumerate(values)]
        if len(set(texts)) == len(texts):
            break
    return texts


def _check_crossing(folding: Folding, end: Fraction, claim: Document) -> None:
    """Raise unless an edge of one of two panels runs through the other at the parameter `end`,
    or a point is in the plates of both.

    Each panel is given by its corners, counter-clockwise from any of them.
    """
    require(claim["folds"] == [], "a contact of two faces names folds")
    places, panels = folding.places, folding.panels
    touching = []
    for face in items(claim["faces"], "faces", 2):
        corners = from_least(tuple(natural(v, "corner") for v in items(face, "face")))
        touching.append(panels.triangles.get(corners, []))
    piece = places.piece(end - end / (1 << 20), end)
    through = piece is not None and any(
        panels.crossing(piece, end, a, b) for a in touching[0] for b in touching[1]
    )
    thick = "no point is proved to be in the plates of both panels"
    thin = "no side of one panel is proved to run through the other panel"
    require(through, thick if "point" in folding.evidence else thin)


def _check_closing(drive: DrivenModes, clock: Clock, claim: Document) -> None:
    """Raise unless the named folds are closed at the time pi, at which their driver is closed.

    If no fold is named, the claim only says that some fold is closed by then. This holds in every
    motion.
    """
    require(claim["faces"] == [], "a contact at folds that close names faces")
    folds = [
        tuple(natural(v, "vertex") for v in items(fold, "fold", 2))
        for fold in items(claim["folds"], "folds")
    ]
    require(len(set(folds)) == len(folds), "a fold that closes is named twice")
    modes = [mode for mode in drive.modes if mode.linear and clock.closes(mode.driver)]
    closed = {fold for mode in modes for fold in mode.folds}
    require(closed.issuperset(folds), "a named fold is not proved to close")
