"""The verified motion of a sheet of panels, and the claims that say which motion it is."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ...core.limits import MOST_TESTS
from ...core.reading import counted, natural, require
from ...sheets.panels import PanelSheet
from ...sheets.scaled import scaled
from ..claims import Claim, Document
from ..faces import FacePairs
from .cut import Triangle, cut, from_least
from .drive import DrivenModes
from .places import Places
from .plates import Plates
from .times import Clock, OneRate, Rates

_NAMED = 3
_PARAMETER_BITS = 40


class Folding:
    """A motion of panels that is verified to exist until its clock ends.

    `drive` gives its fold angles, `clock` the time at a parameter, and `places` the positions of
    the panels. `panels` tests which panels may touch.
    """

    def __init__(self, sheet: PanelSheet, claims: Document, evidence: Document) -> None:
        self.evidence = evidence
        scale, sheet.points = scaled(sheet)
        self.drive = DrivenModes(
            sheet, claims["assignment"], claims["drivers"], evidence["vertices"]
        )
        rated = "rates" in claims
        self.clock: Clock = Rates(claims["drivers"], claims["rates"]) if rated else OneRate()
        self.panels: Panels | Plates
        if "plates" in claims:
            self.panels = Plates(self.drive, self.clock, scale, claims, evidence)
            self.places = self.panels.places
        else:
            self.places = Places(self.drive, self.clock)
            self.panels = Panels(self.drive, self.places)

    def parameter(self, value: Any) -> Fraction:
        """Read a parameter of the motion."""
        x = Fraction(natural(value, "a parameter"), 1 << _PARAMETER_BITS)
        require(x < self.clock.last, "a parameter is out of range")
        return x


class Panels(FacePairs):
    """The pairs of triangles of different panels, and the triangles of each panel.

    Folds need no test, because no fold is closed before the time pi.
    """

    def __init__(self, drive: DrivenModes, places: Places) -> None:
        sheet = drive.sheet
        faces: list[Triangle] = []
        names: list[tuple[int, ...]] = []
        self.triangles: dict[tuple[int, ...], list[Triangle]] = {}
        for panel in sheet.panels:
            some = cut(sheet, panel)
            self.triangles[from_least(panel)] = some
            faces += some
            names += [panel] * len(some)
        body = dict(zip(sheet.panels, places.bodies, strict=True))
        still = [0, 0, 0]
        flat = dict.fromkeys(range(len(sheet.points)), still)
        place = {v: 3 * v for v in flat}
        super().__init__(faces, names, [body[n] for n in names], {}, flat, place, MOST_TESTS)

    def until(self, last: Fraction) -> None:
        """All pairs of panels are to be parted until the parameter `last`."""


class PanelClaim(Claim):
    """A claim of a motion of panels; the motion itself is already verified to exist."""

    def check(self, folding: Folding) -> None:
        """Refuse a motion for which the claim does not hold."""


class Thick(PanelClaim):
    """The panels are `plates` of some `thickness`, with a `hinge` and a `trim`.

    All that is claimed of contacts is about these plates. `Plates` reads this claim.
    """

    names = ("plates",)

    @staticmethod
    def said(claims: Document) -> str:
        """What plates the panels are."""
        plates = claims["plates"]
        where = "in the middle" if plates["hinge"] == "middle" else "on the side of valleys"
        return (
            f"; as plates {plates['thickness']} thick, with hinges {where}, cut back by "
            f"{plates['trim']} from the folds"
        )


class Driven(PanelClaim):
    """From the flat sheet on, the panels fold with the mountains and valleys of `assignment`.

    No other fold moves. Until some fold is closed, each fold of `drivers` has the angle t at the
    time t, or t times its rate. `DrivenModes` verifies this claim.
    """

    names = ("assignment", "drivers")
    needs = ("vertices",)
    always = True

    @staticmethod
    def said(claims: Document) -> str:
        """The number of folds that move, and their drivers."""
        letters, drivers = claims["assignment"], claims["drivers"]
        number = counted(len(letters) - letters.count("F"), "fold moves", "folds move")
        names = ", ".join(f"{i}-{j}" for i, j in drivers[:_NAMED])
        more = f" and {len(drivers) - _NAMED} more" if drivers[_NAMED:] else ""
        return f"the panels fold, {number} of {len(letters)}, driven by {names}{more}"


class OwnRates(PanelClaim):
    """The drivers move at these `rates`, the largest of which is 1.

    Without this key all rates are 1. `Rates` verifies this claim.
    """

    names = ("rates",)
    always = True

    @staticmethod
    def said(claims: Document) -> str:
        """The words that say that there are rates."""
        own = any(rate != "1" for rate in claims.get("rates", ()))
        return " at rates of their own" if own else ""
